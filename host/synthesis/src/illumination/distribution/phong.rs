//! Phong's highlight: a lobe around the mirrored light direction.

use super::{Distribution, DistributionError, checked_roughness, mirrored};
use glam::DVec3;
use std::f64::consts::TAU;

/// The largest exponent: that of the smallest roughness.
pub const MOST_EXPONENT: f64 = 1e17;

/// The exponent whose lobe of facets is as wide as Beckmann's of a roughness m: 2/m² − 2, and 0 at the least.
///
/// # Errors
/// [`DistributionError::Roughness`].
///
/// # Source
/// Near the normal cosⁿ⁺²α is exp(−(n + 2) α²/2), and Beckmann's density exp(−α²/m²).
pub fn exponent_of_roughness(roughness: f64) -> Result<f64, DistributionError> {
    Ok((2.0 / checked_roughness(roughness)?.powi(2) - 2.0).max(0.0))
}

/// A power of a cosine, from the square of the sine: near 1 the cosine itself has no digits left.
pub(super) fn power_of_cosine(square_of_sine: f64, exponent: f64) -> f64 {
    if exponent == 0.0 { 1.0 } else { (0.5 * exponent * (-square_of_sine.min(1.0)).ln_1p()).exp() }
}

/// A direction around z with the pdf (n + 1) / (2 pi) cosⁿ, from a point of the unit square.
pub(super) fn lobe(point: [f64; 2], exponent: f64) -> DVec3 {
    let logarithm = (-point[0]).ln_1p() / (exponent + 1.0);
    let sine = (-(2.0 * logarithm).exp_m1()).max(0.0).sqrt();
    let (sin, cos) = (TAU * point[1]).sin_cos();
    DVec3::new(sine * cos, sine * sin, logarithm.exp())
}

pub(super) fn checked_exponent(exponent: f64) -> Result<f64, DistributionError> {
    if (0.0..=MOST_EXPONENT).contains(&exponent) { Ok(exponent) } else { Err(DistributionError::Exponent(exponent)) }
}

/// Phong's distribution, D = (n + 2)/(2 pi) (R·V)ⁿ (N·V)/(N·L) for R·V > 0.
///
/// The factor (n + 2)/(2 pi) is ours: with it D integrates to 1 at normal incidence, so that K is the fraction
/// reflected there. At other angles the integral departs from 1, as the division by N·L makes any lobe of
/// fixed shape do; near grazing incidence it exceeds 1.
///
/// # Source
/// The 1988 paper, table of D; Phong 1975. The factor follows from the integral of cos^(n+1) over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub struct Phong {
    exponent: f64,
}

impl Phong {
    /// With the exponent n, 0 and more; the lobe falls to one half at acos(2^(−1/n)).
    ///
    /// # Errors
    /// [`DistributionError::Exponent`].
    pub fn new(exponent: f64) -> Result<Phong, DistributionError> {
        Ok(Phong { exponent: checked_exponent(exponent)? })
    }

    /// (R·V)ⁿ; 0 behind the mirrored light.
    fn power(&self, light: DVec3, view: DVec3) -> f64 {
        // With d = R − V, 1 − R·V is d²/2, and the square of the sine is d² − d⁴/4.
        let distance = (mirrored(light) - view).length_squared();
        if distance >= 2.0 { 0.0 } else { power_of_cosine(distance - distance * distance / 4.0, self.exponent) }
    }
}

impl Distribution for Phong {
    fn name(&self) -> &str {
        "Phong"
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        (self.exponent + 2.0) / TAU * self.power(light, view) * view.z / light.z
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        let axis = mirrored(light);
        let (one, other) = axis.any_orthonormal_pair();
        let local = lobe(point, self.exponent);
        let view = one * local.x + other * local.y + axis * local.z;
        view.try_normalize().filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        (self.exponent + 1.0) / TAU * self.power(light, view)
    }
}
