//! Layers of two paints in turn, of uneven thickness.

use super::super::TextureError;
use super::sampled::{Sampled, check_turbulence, sinc};
use crate::numeric::noise::octaves;
use glam::DVec3;
use std::f64::consts::TAU;

/// The second paint covers one half.
pub(super) const MEAN: f64 = 0.5;
/// Waves that make the layers uneven, none a multiple of another: how many there are in a unit, and how strong each is.
const WAVES: [(f64, f64); 4] = [(1.0, 0.42), (1.618, 0.27), (2.732, 0.19), (5.39, 0.12)];
/// Frequencies by which layers stray.
const OCTAVES: u32 = 6;

/// Refuses layers that stray by a negative amount.
pub(super) fn check(turbulence: f64) -> Result<(), TextureError> {
    check_turbulence(turbulence)
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, turbulence: f64) -> f64 {
    // Layers stray over long ways.
    let place = sampled.at * DVec3::new(0.25, 0.25, 0.25);
    let y = sampled.at.y + turbulence * octaves(place, OCTAVES, 0.25 * sampled.width);
    let rise = sampled.sides[0].y.abs().max(sampled.sides[1].y.abs());
    let wave = |(frequency, strength): (f64, f64)| strength * (TAU * frequency * y).sin() * sinc(frequency * rise);
    (0.5 + 0.75 * WAVES.into_iter().map(wave).sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::super::TextureFootprint;
    use super::*;

    fn of(at: DVec3, turbulence: f64) -> f64 {
        let footprint = TextureFootprint::default();
        let sides = [DVec3::X * 1e-3, DVec3::Z * 1e-3];
        second(&Sampled { footprint: &footprint, at, sides, width: 1e-3, is_solid: true }, turbulence)
    }

    #[test]
    fn layers_are_level_until_they_stray_and_as_much_of_one_as_of_the_other() {
        let all = || (0..4000).map(|k| f64::from(k) * 0.013);
        let mean = all().map(|y| of(DVec3::Y * y, 0.0)).sum::<f64>() / 4000.0;
        assert!((mean - MEAN).abs() < 0.02, "{mean}");
        let moved = DVec3::new(3.0, 0.0, -7.0);
        assert!(all().take(50).all(|y| of(DVec3::Y * y, 0.0) == of(DVec3::Y * y + moved, 0.0)));
        assert!(all().take(50).any(|y| of(DVec3::Y * y, 0.5) != of(DVec3::Y * y + moved, 0.5)));
        let range = all().map(|y| of(DVec3::Y * y, 0.0)).fold([1.0_f64, 0.0_f64], |[a, b], x| [a.min(x), b.max(x)]);
        assert!(range[0] < 0.05 && range[1] > 0.95, "{range:?}");
    }
}
