//! The exact form of Cook and Torrance's idea: facets that are mirrors, seen and lit as Smith's masking says.

use super::{Distribution, DistributionError, SlopeDistribution, checked_roughness};
use glam::{DVec2, DVec3};

/// D = area(H) G₂ / (4 (N·L)): the facets' area, the change 4 (V·H) from their solid angle to the viewer's, and a
/// masking that matches the facets.
///
/// With A the area that the facets show to a direction, A = (N·W) (1 + Λ), and heights of light and viewer correlated,
/// G₂ = 1 / (1 + Λ_L + Λ_V). D integrates to 1 but for what strikes a second facet: that is lost here, and kept in
/// [`super::Compensated`]. It never exceeds 1, and is reciprocal. Different roughness along x and y is anisotropic.
///
/// Where heights are taken not to be correlated, as many programs do it, G₂ = 1 / ((1 + Λ_L) (1 + Λ_V)): more is lost.
///
/// # Source
/// Walter et al. 2007, equations 20 and 23; Heitz 2014, equations 98 and 99.
#[derive(Clone, Copy, Debug)]
pub struct Microfacet {
    facets: SlopeDistribution,
    roughness: DVec2,
    /// Whether heights of light and viewer are correlated.
    correlated: bool,
}

impl Microfacet {
    /// With a roughness m along x and along y, each 1e-8..=1000: the root mean square slope times root 2.
    ///
    /// # Errors
    /// [`DistributionError::Roughness`].
    pub fn new(facets: SlopeDistribution, roughness: DVec2) -> Result<Microfacet, DistributionError> {
        let roughness = DVec2::new(checked_roughness(roughness.x)?, checked_roughness(roughness.y)?);
        Ok(Microfacet { facets, roughness, correlated: true })
    }

    /// These facets, with heights that light and viewer see independently.
    pub fn separable(self) -> Microfacet {
        Microfacet { correlated: false, ..self }
    }

    /// The part of what a sampled facet reflects to a viewer that no other facet masks: the density over the pdf,
    /// 0..=1.
    pub(in crate::illumination) fn weight(&self, light: DVec3, view: DVec3) -> f64 {
        let [l, v] = [light, view].map(|towards| self.facets.projected(towards, self.roughness));
        if self.correlated { view.z * l / (view.z * l + light.z * (v - view.z)) } else { view.z / v }
    }
}

impl Distribution for Microfacet {
    fn name(&self) -> &str {
        match (self.facets, self.correlated) {
            (SlopeDistribution::Beckmann, true) => "Beckmann",
            (SlopeDistribution::Ggx, true) => "GGX",
            (SlopeDistribution::Beckmann, false) => "Beckmann, separable",
            (SlopeDistribution::Ggx, false) => "GGX, separable",
        }
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        self.weight(light, view) * self.pdf(light, view)
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        let normal = self.facets.visible(light, self.roughness, point)?;
        (normal * (2.0 * normal.dot(light)) - light).try_normalize().filter(|view| view.z > 0.0)
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        self.facets.area(light + view, self.roughness) / (4.0 * self.facets.projected(light, self.roughness))
    }
}
