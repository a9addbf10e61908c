//! Cook and Torrance's highlight as it was published.
//!
//! It counts facets by their normals and forgets that the solid angle of the viewer is 4 (V·H) times that of the
//! normal. So it does not integrate to 1 over the viewer: see `peris study illumination`, and [`super::Microfacet`].

use super::{Distribution, DistributionError, SlopeDistribution, checked_roughness};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A direction to the viewer by a facet whose normal is sampled in proportion to area times cosine.
pub(super) fn sample(light: DVec3, roughness: f64, point: [f64; 2]) -> Option<DVec3> {
    let slope = roughness * (-(-point[0]).ln_1p()).sqrt();
    let (sin, cos) = (TAU * point[1]).sin_cos();
    let normal = DVec3::new(slope * cos, slope * sin, 1.0).normalize();
    (normal * (2.0 * normal.dot(light)) - light).try_normalize().filter(|view| view.z > 0.0)
}

/// The pdf of [`sample`].
pub(super) fn pdf(light: DVec3, view: DVec3, roughness: f64) -> f64 {
    let half = light + view;
    // L·H is half the length of L + V.
    let length = half.length();
    SlopeDistribution::Beckmann.area(half, DVec2::splat(roughness)) * half.z / (length * 2.0 * length)
}

/// D = G exp(−tan²α / m²) / (π m² cos⁴α (N·L)) with the masking G = min(1, 2 (N·H)(N·V)/(V·H), 2 (N·H)(N·L)/(V·H)).
///
/// Some print the masking in K. It is here, for without it D has no bound at grazing incidence.
///
/// # Source
/// The 1988 paper, table of D; Cook and Torrance 1982; the masking of Torrance and Sparrow 1967.
#[derive(Clone, Copy, Debug)]
pub struct CookTorrance {
    roughness: f64,
}

impl CookTorrance {
    /// With a roughness m, 1e-8..=1000.
    ///
    /// # Errors
    /// [`DistributionError::Roughness`].
    pub fn new(roughness: f64) -> Result<CookTorrance, DistributionError> {
        Ok(CookTorrance { roughness: checked_roughness(roughness)? })
    }
}

impl Distribution for CookTorrance {
    fn name(&self) -> &str {
        "Cook-Torrance"
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        let half = light + view;
        // 2 (N·H) / (V·H), with H = half / |half| and V·H = |half| / 2.
        let notch = 4.0 * half.z / half.length_squared();
        // The masking over N·L.
        let masking = (1.0 / light.z).min(notch * view.z / light.z).min(notch);
        SlopeDistribution::Beckmann.area(half, DVec2::splat(self.roughness)) * masking
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        sample(light, self.roughness, point)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        pdf(light, view, self.roughness)
    }
}
