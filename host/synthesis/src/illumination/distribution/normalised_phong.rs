//! Phong's highlight, exactly normalised and reciprocal.

use super::losses::Losses;
use super::phong::{checked_exponent, lobe, power_of_cosine};
use super::{Distribution, DistributionError, mirrored};
use crate::numeric::cubature::GAUSS;
use crate::numeric::sampling::around_z;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Parts of an integral over the lobe.
const PARTS: usize = 12;

/// Phong's lobe, D = (n + 2)/(2 pi) (R·V)ⁿ (N·V), and what of it lies below the horizon or is dimmed there, emitted over
/// the whole hemisphere: its integral is 1 at every incidence.
///
/// Without the division by N·L of the paper's form, [`super::Phong`], it is reciprocal and never creates light.
///
/// # Source
/// Lafortune and Willems 1994 for the lobe; [`super::Compensated`] for the rest.
#[derive(Clone, Debug)]
pub struct NormalisedPhong {
    exponent: f64,
    losses: Losses,
}

impl NormalisedPhong {
    /// With the exponent n, 0 and more; the lobe falls to one half at acos(2^(−1/n)).
    ///
    /// # Errors
    /// [`DistributionError::Exponent`].
    pub fn new(exponent: f64) -> Result<NormalisedPhong, DistributionError> {
        let exponent = checked_exponent(exponent)?;
        let losses = Losses::new((2.0 / (exponent + 2.0)).sqrt(), |cosine| (1.0 - share(exponent, cosine)).max(0.0));
        Ok(NormalisedPhong { exponent, losses })
    }

    /// (R·V)ⁿ; 0 behind the mirrored light.
    fn power(&self, light: DVec3, view: DVec3) -> f64 {
        // With d = R − V, 1 − R·V is d²/2, and the square of the sine is d² − d⁴/4.
        let distance = (mirrored(light) - view).length_squared();
        if distance >= 2.0 { 0.0 } else { power_of_cosine(distance - distance * distance / 4.0, self.exponent) }
    }
}

/// The integral of the lobe times the cosine over what lies above the horizon.
///
/// With a part u of the lobe within an angle α of its axis, cosⁿ⁺¹α = 1 − u, it is (n + 2)/(n + 1) times the mean over u
/// of the positive part of the cosine, averaged over the turn about the axis.
fn share(exponent: f64, cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let turned = |rest: f64| {
        let upright = (rest.ln() / (exponent + 1.0)).exp();
        let aside = (-(2.0 * rest.ln() / (exponent + 1.0)).exp_m1()).max(0.0).sqrt();
        let (level, swing) = (cosine * upright, sine * aside);
        if level >= swing {
            return level;
        }
        let limit = (-level / swing).acos();
        FRAC_1_PI * (level * limit + swing * limit.sin())
    };
    // The lobe reaches the horizon where cos α is the sine of the incidence: a kink.
    let kink = sine.powf(exponent + 1.0);
    let over = |from: f64, to: f64| {
        let term = |part: usize| {
            GAUSS.iter().map(move |(at, weight)| {
                // Points gather at both ends.
                let x = (part as f64 + at) / PARTS as f64;
                (from + (to - from) * x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) * weight / PARTS as f64)
            })
        };
        (to - from) * (0..PARTS).flat_map(term).map(|(rest, weight)| weight * turned(rest)).sum::<f64>()
    };
    (exponent + 2.0) / (exponent + 1.0) * (over(0.0, kink) + over(kink, 1.0))
}

impl Distribution for NormalisedPhong {
    fn name(&self) -> &str {
        "Phong, normalised"
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let lobe = (self.exponent + 2.0) / TAU * self.power(light, view) * view.z;
        lobe + self.losses.density(light.z, view.z)
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        // The first coordinate chooses between the two terms, and is then stretched to be used again.
        let lost = self.losses.chance(light.z);
        if point[0] < lost {
            return Some(around_z(self.losses.sample(point[0] / lost), point[1])).filter(|view| view.z > 0.0);
        }
        let axis = mirrored(light);
        let (one, other) = axis.any_orthonormal_pair();
        let local = lobe([(point[0] - lost) / (1.0 - lost), point[1]], self.exponent);
        let view = one * local.x + other * local.y + axis * local.z;
        view.try_normalize().filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let lost = self.losses.chance(light.z);
        let again = if lost > 0.0 { lost * self.losses.pdf(view.z) } else { 0.0 };
        again + (1.0 - lost) * (self.exponent + 1.0) / TAU * self.power(light, view)
    }
}

#[cfg(test)]
mod tests {
    use super::super::measure::{emitted_share, light_at, reciprocity_residual};
    use super::*;

    #[test]
    fn a_highlight_emits_all_of_its_light_at_every_incidence() {
        for exponent in [0.0, 1.0, 5.0, 50.0, 1e3, 1e6] {
            let phong = NormalisedPhong::new(exponent).expect("an exponent");
            for degrees in [0.0f64, 30.0, 60.0, 80.0, 88.0, 89.9] {
                let share = emitted_share(&phong, light_at(degrees.to_radians()), 1e-5, 100_000).value;
                assert!((share - 1.0).abs() < 2e-4, "{exponent} at {degrees}: {share}");
            }
            assert!(reciprocity_residual(&phong, 1000, 5) < 1e-9, "{exponent}");
        }
    }
}
