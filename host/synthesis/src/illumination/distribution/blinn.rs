//! Blinn's highlight: a lobe of facets by a power of their cosine.

use super::phong::{checked_exponent, lobe, power_of_cosine};
use super::{Distribution, DistributionError};
use glam::DVec3;
use std::f64::consts::{LN_2, TAU};

/// Blinn's distribution, D = c (N·H)ⁿ (N·V)/(N·L), H half way between light and viewer.
///
/// c = (n + 2)(n + 4) / (8 pi (n + 2^(−n/2))) is ours: with it D integrates to 1 at normal incidence. As Phong's it
/// departs from 1 at other angles.
///
/// # Source
/// Blinn 1977; the factor follows from the integral over the hemisphere at normal incidence.
#[derive(Clone, Copy, Debug)]
pub struct Blinn {
    exponent: f64,
}

impl Blinn {
    /// With the exponent n, 0 and more.
    ///
    /// # Errors
    /// [`DistributionError::Exponent`].
    pub fn new(exponent: f64) -> Result<Blinn, DistributionError> {
        Ok(Blinn { exponent: checked_exponent(exponent)? })
    }

    /// (N·H)ⁿ.
    fn power(&self, half: DVec3) -> f64 {
        let square = half.length_squared();
        power_of_cosine((half.x * half.x + half.y * half.y) / square, self.exponent)
    }
}

impl Distribution for Blinn {
    fn name(&self) -> &str {
        "Blinn"
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let n = self.exponent;
        let factor = (n + 2.0) * (n + 4.0) / (4.0 * TAU * (n + (-0.5 * n * LN_2).exp()));
        factor * self.power(light + view) * view.z / light.z
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        let half = lobe(point, self.exponent);
        (half * (2.0 * half.dot(light)) - light).try_normalize().filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let half = light + view;
        // A facet that turns by an angle turns the mirrored direction by twice that: 4 (L·H) in solid angle, and
        // L·H is half the length of L + V.
        (self.exponent + 1.0) / TAU * self.power(half) / (2.0 * half.length())
    }
}
