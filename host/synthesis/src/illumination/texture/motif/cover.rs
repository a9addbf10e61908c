//! A second paint where the ground is neither too low, too high nor too steep: snow, grass.

use super::super::TextureError;
use super::sampled::Sampled;
use crate::numeric::noise::octaves;

/// Degrees over which it ends where the ground becomes too steep.
const STEEP_EDGE: f64 = 12.0;
/// How much larger the waves of a ragged edge are than they are high.
const RAGGED: f64 = 4.0;
/// Frequencies of a ragged edge.
const OCTAVES: u32 = 8;
/// Nobody knows how high the ground is.
pub(super) const MEAN: f64 = 0.5;

/// Where the second paint lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lying {
    /// The least and the greatest y.
    pub(super) height: [f64; 2],
    /// The height over which it ends.
    pub(super) edge: f64,
    /// How far the ends stray up and down.
    pub(super) ragged: f64,
    /// The steepest ground on which it holds, degrees.
    pub(super) steepest: f64,
}

/// Refuses edges and angles that are none.
pub(super) fn check(lying: &Lying) -> Result<(), TextureError> {
    let refused = |what, value, range| Err(TextureError::Number { what, value, range });
    for (what, value) in [("edge", lying.edge), ("ragged", lying.ragged)] {
        if !(value.is_finite() && value >= 0.0) {
            return refused(what, value, "0 or more");
        }
    }
    if !(0.0..=90.0).contains(&lying.steepest) {
        return refused("steepest", lying.steepest, "0 to 90 degrees");
    }
    let [low, high] = lying.height;
    if low <= high { Ok(()) } else { refused("height", high, "not below its least") }
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, lying: &Lying) -> f64 {
    let [one, other] = sampled.sides;
    let up = one.cross(other).try_normalize().map_or(1.0, |normal| normal.y.abs().min(1.0));
    let angle = up.acos().to_degrees();
    let mut y = sampled.at.y;
    if lying.ragged > 0.0 {
        let size = RAGGED * lying.ragged;
        y += lying.ragged * octaves(sampled.at / size, OCTAVES, sampled.width / size);
    }
    // What the footprint spans up and down smooths the ends, too.
    let edge = lying.edge.max(one.y.abs() + other.y.abs()).max(f64::MIN_POSITIVE);
    let above = |line: f64| smooth((y - line) / edge + 0.5);
    let holds = 1.0 - smooth((angle - lying.steepest) / STEEP_EDGE + 0.5);
    let holds = if lying.steepest >= 90.0 { 1.0 } else { holds };
    above(lying.height[0]) * (1.0 - above(lying.height[1])) * holds
}

/// From 0 to 1 as `t` goes from 0 to 1, with a continuous slope.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::super::super::TextureFootprint;
    use super::*;
    use glam::DVec3;

    const SNOW: Lying = Lying { height: [2.0, 8.0], edge: 1.0, ragged: 0.0, steepest: 40.0 };

    fn of(lying: &Lying, y: f64, degrees: f64) -> f64 {
        let footprint = TextureFootprint::default();
        let tilt = degrees.to_radians();
        let sides = [DVec3::new(tilt.cos(), tilt.sin(), 0.0) * 1e-3, DVec3::Z * 1e-3];
        let at = DVec3::new(0.3, y, 0.7);
        second(&Sampled { footprint: &footprint, at, sides, width: 1e-3, is_solid: true }, lying)
    }

    #[test]
    fn snow_lies_between_its_heights_and_on_no_cliff() {
        let found = [1.0, 2.0, 5.0, 8.0, 9.0].map(|y| of(&SNOW, y, 0.0));
        assert_eq!(found, [0.0, 0.5, 1.0, 0.5, 0.0]);
        assert_eq!([30.0, 40.0, 50.0].map(|degrees| (of(&SNOW, 5.0, degrees) * 1e6).round() / 1e6), [1.0, 0.5, 0.0]);
        assert_eq!(of(&Lying { steepest: 90.0, ..SNOW }, 5.0, 89.9), 1.0);
    }

    #[test]
    fn a_ragged_edge_strays_about_the_line() {
        let ragged = Lying { edge: 0.0, ragged: 0.5, ..SNOW };
        assert_eq!([of(&ragged, 1.0, 0.0), of(&ragged, 3.0, 0.0)], [0.0, 1.0]);
        let footprint = TextureFootprint::default();
        let at = |k: usize| {
            let at = DVec3::new(k as f64 * 1.7, 2.0, 0.0);
            let sides = [DVec3::X * 1e-3, DVec3::Z * 1e-3];
            second(&Sampled { footprint: &footprint, at, sides, width: 1e-3, is_solid: true }, &ragged)
        };
        let mean = (0..400).map(at).sum::<f64>() / 400.0;
        assert!((mean - 0.5).abs() < 0.15, "{mean}");
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        for wrong in [
            Lying { edge: -1.0, ..SNOW },
            Lying { ragged: f64::NAN, ..SNOW },
            Lying { steepest: 91.0, ..SNOW },
            Lying { height: [2.0, 1.0], ..SNOW },
        ] {
            assert!(check(&wrong).is_err(), "{wrong:?}");
        }
        assert!(check(&SNOW).is_ok());
    }
}
