//! The D family: how what a surface element emits is distributed over the outgoing hemisphere.

mod lambert;
mod phong;

pub use lambert::Lambert;
pub use phong::Phong;

use glam::DVec3;

/// Cosines between the directions at a surface element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions {
    /// Normal and light.
    pub n_l: f64,
    /// Normal and viewer.
    pub n_v: f64,
    /// Mirrored light direction and viewer.
    pub r_v: f64,
}

impl Directions {
    /// From the unit vectors normal, towards the light, towards the viewer.
    pub fn new(normal: DVec3, light: DVec3, view: DVec3) -> Directions {
        let n_l = normal.dot(light);
        let reflected = 2.0 * n_l * normal - light;
        Directions { n_l, n_v: normal.dot(view), r_v: reflected.dot(view) }
    }
}

/// A distribution D of emitted flux over the outgoing hemisphere; the luminance is D K E / (N·V).
pub trait Distribution {
    /// Its name in tables.
    fn name(&self) -> &'static str;

    /// Emitted share per solid angle, 1/sr, for light and viewer above the horizon.
    fn density(&self, directions: &Directions) -> f64;
}

/// Integrates D over the outgoing hemisphere by the midpoint rule.
///
/// - `incidence`: angle between normal and light, radians, 0..pi/2.
/// - `steps`: cells in the polar angle; four times as many in azimuth.
/// - Returns the share of the flux that is emitted; 1 if D is normalised.
pub fn hemisphere_integral(distribution: &dyn Distribution, incidence: f64, steps: u32) -> f64 {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let light = DVec3::new(incidence.sin(), incidence.cos(), 0.0);
    let (d_theta, d_phi) = (FRAC_PI_2 / f64::from(steps), TAU / f64::from(4 * steps));
    let mut sum = 0.0;
    for i in 0..steps {
        let theta = (f64::from(i) + 0.5) * d_theta;
        for j in 0..4 * steps {
            let phi = (f64::from(j) + 0.5) * d_phi;
            let view = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            sum += distribution.density(&Directions::new(DVec3::Y, light, view)) * theta.sin();
        }
    }
    sum * d_theta * d_phi
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family() -> Vec<Box<dyn Distribution>> {
        vec![Box::new(Lambert), Box::new(Phong { exponent: 1.0 }), Box::new(Phong { exponent: 40.0 })]
    }

    #[test]
    fn every_distribution_emits_at_normal_incidence_what_arrives() {
        for member in family() {
            let share = hemisphere_integral(member.as_ref(), 0.0, 200);
            assert!((share - 1.0).abs() < 1e-3, "{}: {share}", member.name());
        }
    }

    #[test]
    fn every_density_is_finite_and_not_negative() {
        for member in family() {
            for i in 1..20 {
                for j in 1..20 {
                    for r_v in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                        let directions = Directions { n_l: f64::from(i) / 20.0, n_v: f64::from(j) / 20.0, r_v };
                        let density = member.density(&directions);
                        assert!(density.is_finite() && density >= 0.0, "{}: {directions:?}", member.name());
                    }
                }
            }
        }
    }
}
