//! Cook and Torrance's highlight as the 1988 paper improves it.
//!
//! The division by N·L is gone, so that it stays finite at grazing incidence. What is missing is the change 4 (V·H)
//! from the solid angle of the normal to that of the viewer: for smooth facets its integral is 4 (N·L), not 1.

use super::cook_torrance::{pdf, sample};
use super::{Distribution, DistributionError, SlopeDistribution, checked_roughness};
use glam::{DVec2, DVec3};

/// D = exp(−tan²α / m²) / (π m² cos³α) for N·V > 0.
///
/// Its integral over the normals H, not over the viewer, is 1. It has no masking and is not reciprocal.
///
/// # Source
/// The 1988 paper, equation 7.
#[derive(Clone, Copy, Debug)]
pub struct ImprovedCookTorrance {
    roughness: f64,
}

impl ImprovedCookTorrance {
    /// With a roughness m, 1e-8..=1000.
    ///
    /// # Errors
    /// [`DistributionError::Roughness`].
    pub fn new(roughness: f64) -> Result<ImprovedCookTorrance, DistributionError> {
        Ok(ImprovedCookTorrance { roughness: checked_roughness(roughness)? })
    }
}

impl Distribution for ImprovedCookTorrance {
    fn name(&self) -> &str {
        "improved (7)"
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let half = light + view;
        SlopeDistribution::Beckmann.area(half, DVec2::splat(self.roughness)) * half.z / half.length()
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        sample(light, self.roughness, point)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        pdf(light, view, self.roughness)
    }
}
