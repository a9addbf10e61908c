//! Facets with all reflections between them: what the first reflection loses is emitted after further ones.

use super::losses::Losses;
use super::{Distribution, DistributionError, FacetTable, Microfacet, SlopeDistribution};
use crate::numeric::cubature::unit_square;
use crate::numeric::sampling::around_z;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Error of the cubature of an entry.
const TOLERANCE: f64 = 1e-5;
/// Most evaluations for an entry.
const MOST_EVALUATIONS: u32 = 20_000;
/// Taken off what is lost, so that errors of the table never create energy.
const MARGIN: f64 = 3e-5;
/// Facets of Beckmann, GGX or the user, exactly normalised at every incidence: D + (1 − E_L)(1 − E_V)(N·V) / (π (1 − E)).
///
/// E_L is the integral of D for the light's direction, E its mean over the hemisphere, weighted with the cosine. The
/// second term is reciprocal, and its integral is what D lost, 1 − E_L, to 1e-4 for roughness up to 1, and to 2e-4 up
/// to 10; never more. It says where the light goes only roughly: over the whole hemisphere. In a metal each further
/// reflection has its own K: then the two terms are needed apart, see [`Compensated::parts`].
///
/// # Source
/// Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017. The table is ours.
#[derive(Clone, Debug)]
pub struct Compensated {
    first: Arc<dyn Distribution>,
    name: &'static str,
    losses: Losses,
}

impl Compensated {
    /// With a roughness m, 1e-8..=1000, the same along x and y. Its table takes some tenths of a second on two cores:
    /// keep what is made.
    ///
    /// # Errors
    /// [`DistributionError::Roughness`].
    pub fn new(facets: SlopeDistribution, roughness: f64) -> Result<Compensated, DistributionError> {
        let first = Microfacet::new(facets, DVec2::splat(roughness))?;
        let name = match facets {
            SlopeDistribution::Beckmann => "Beckmann, all",
            SlopeDistribution::Ggx => "GGX, all",
        };
        Ok(Compensated::of(Arc::new(first), name, roughness))
    }

    /// Facets that the user defined, with all reflections between them. Its table takes as long.
    pub fn of_table(table: FacetTable) -> Compensated {
        let roughness = table.roughness();
        Compensated::of(Arc::new(table), "user's, all", roughness)
    }

    fn of(first: Arc<dyn Distribution>, name: &'static str, roughness: f64) -> Compensated {
        let losses = Losses::new(roughness, |cosine| {
            let light = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
            // One half of the directions is the mirror image of the other.
            let weight = |[x, y]: [f64; 2]| {
                first.sample(light, [x, 0.5 * y]).map_or(0.0, |view| {
                    let (density, pdf) = (first.density(light, view), first.pdf(light, view));
                    if pdf > 0.0 { density / pdf } else { 0.0 }
                })
            };
            let share = unit_square(weight, TOLERANCE, MOST_EVALUATIONS);
            (1.0 - share.value - MARGIN).max(0.0)
        });
        Compensated { first, name, losses }
    }

    /// The part of light that the first reflection loses, 0..=1.
    ///
    /// - `cosine`: between light and normal, 0..=1.
    pub fn lost(&self, cosine: f64) -> f64 {
        self.losses.lost(cosine)
    }

    /// The mean of [`Compensated::lost`] over the hemisphere, weighted with the cosine.
    pub fn mean_lost(&self) -> f64 {
        self.losses.mean()
    }

    /// D of what is reflected once, and of what is reflected more often, 1/sr; each may have its own K.
    pub fn parts(&self, light: DVec3, view: DVec3) -> [f64; 2] {
        [self.first.density(light, view), self.losses.density(light.z, view.z)]
    }
}

impl Distribution for Compensated {
    fn name(&self) -> &str {
        self.name
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        self.parts(light, view).iter().sum()
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        // The first coordinate chooses between the two terms, and is then stretched to be used again.
        let lost = self.losses.chance(light.z);
        if point[0] < lost {
            Some(around_z(self.losses.sample(point[0] / lost), point[1])).filter(|view| view.z > 0.0)
        } else {
            self.first.sample(light, [(point[0] - lost) / (1.0 - lost), point[1]])
        }
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let lost = self.losses.chance(light.z);
        let further = if lost > 0.0 { lost * self.losses.pdf(view.z) } else { 0.0 };
        further + (1.0 - lost) * self.first.pdf(light, view)
    }
}
