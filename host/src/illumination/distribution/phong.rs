//! Phong's highlight: a lobe around the mirrored light direction.

use super::{Directions, Distribution};
use std::f64::consts::TAU;

/// Phong's distribution, D = (n + 2)/(2 pi) (R·V)^n (N·V)/(N·L) for R·V > 0.
///
/// The factor (n + 2)/(2 pi) is ours: with it D integrates to 1 at normal incidence, so that K is the fraction
/// reflected there. At other angles the integral departs from 1, as the division by N·L makes any lobe of
/// fixed shape do; near grazing incidence it exceeds 1.
///
/// # Source
/// The 1988 paper, table of D; Phong 1975. The factor follows from the integral of cos^(n+1) over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub struct Phong {
    /// The exponent n, 1 and more.
    pub exponent: f64,
}

impl Distribution for Phong {
    fn name(&self) -> &'static str {
        "Phong"
    }

    fn density(&self, directions: &Directions) -> f64 {
        if directions.r_v <= 0.0 {
            return 0.0;
        }
        let lobe = directions.r_v.min(1.0).powf(self.exponent);
        (self.exponent + 2.0) / TAU * lobe * directions.n_v / directions.n_l
    }
}

#[cfg(test)]
mod tests {
    use super::super::hemisphere_integral;
    use super::*;

    #[test]
    fn the_lobe_is_highest_in_the_mirror_direction_and_half_at_its_half_angle() {
        let phong = Phong { exponent: 20.0 };
        let at = |r_v| phong.density(&Directions { n_l: 0.5, n_v: 0.5, r_v });
        assert!((at(1.0) - 22.0 / TAU).abs() < 1e-12);
        assert!((at(0.5f64.powf(1.0 / 20.0)) / at(1.0) - 0.5).abs() < 1e-12);
        assert_eq!(at(-0.3), 0.0);
    }

    #[test]
    fn the_lobe_keeps_its_energy_within_two_percent_up_to_45_degrees() {
        for incidence in [0.0, 0.3, 0.785] {
            let share = hemisphere_integral(&Phong { exponent: 100.0 }, incidence, 400);
            assert!((share - 1.0).abs() < 0.02, "{incidence}: {share}");
        }
    }
}
