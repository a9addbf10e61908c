//! The D family: how what a surface element emits is distributed over the outgoing hemisphere.
//!
//! Directions are unit vectors in the frame of the element: z is its normal, x and y lie along the surface. A
//! distribution may be anything that has a density; [`measure`] says how far it is normalised and reciprocal, and
//! [`FAMILY`] lists those that ship with the program.

mod blinn;
mod compensated;
mod cook_torrance;
mod error;
pub(super) mod even_table;
mod facet_models;
mod facet_table;
mod facets;
mod frame;
mod improved;
mod lambert;
mod losses;
pub mod measure;
mod microfacet;
mod normalised_phong;
mod phong;
mod rough_facets;
mod special;
mod tabulated;
#[cfg(test)]
mod tests;

pub use blinn::Blinn;
pub use compensated::Compensated;
pub use cook_torrance::CookTorrance;
pub use error::{DistributionError, LEAST_ROUGHNESS, MOST_ROUGHNESS};
pub use facet_models::{FACET_MODELS, FacetForm, FacetModel};
pub use facet_table::{FacetError, FacetTable, TableError};
pub use facets::SlopeDistribution;
pub use frame::ShadingFrame;
pub use improved::ImprovedCookTorrance;
pub use lambert::Lambert;
pub use microfacet::Microfacet;
pub use normalised_phong::NormalisedPhong;
pub use phong::{MOST_EXPONENT, Phong, exponent_of_roughness};
pub use tabulated::{TableAccuracy, Tabulated};

pub(super) use error::checked_roughness;
use glam::{DVec2, DVec3};
pub(super) use rough_facets::RoughFacets;

/// A distribution D of emitted flux over the outgoing hemisphere; the luminance is D K E / (N·V).
///
/// Light and viewer are above the horizon: z above 0. Where the quotient D / (N·V) is the same for light and viewer
/// exchanged, the distribution is reciprocal, and the two may be exchanged in [`Distribution::sample`], too: a tracer
/// of paths from the camera gives the viewer and gets the light.
///
/// Any type that has these four functions is a member. It is measured as those that ship are, and becomes a material by
/// way of a table:
///
/// ```
/// use glam::DVec3;
/// use synthesis::illumination::distribution::measure::{check, emitted_share, light_at};
/// use synthesis::illumination::distribution::{Distribution, Tabulated};
/// use synthesis::illumination::material::DistributionForm;
/// use std::f64::consts::{PI, TAU};
///
/// /// Brighter along the normal than Lambert's: D = 3 cos²θ / 2π.
/// #[derive(Debug)]
/// struct Squared;
///
/// impl Distribution for Squared {
///     fn name(&self) -> &str {
///         "squared"
///     }
///     fn density(&self, _light: DVec3, view: DVec3) -> f64 {
///         3.0 * view.z * view.z / TAU
///     }
///     fn sample(&self, _light: DVec3, [one, two]: [f64; 2]) -> Option<DVec3> {
///         let (cosine, (sin, cos)) = ((1.0 - one).cbrt(), (TAU * two).sin_cos());
///         let sine = (1.0 - cosine * cosine).sqrt();
///         Some(DVec3::new(sine * cos, sine * sin, cosine))
///     }
///     fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
///         self.density(light, view)
///     }
/// }
///
/// check(&Squared, 1000, 1).expect("it is finite and not negative");
/// let share = emitted_share(&Squared, light_at(PI / 4.0), 1e-6, 10_000);
/// assert!((share.value - 1.0).abs() < 1e-6);
/// let table = Tabulated::new("squared", 32, |light, view| Squared.density(light, view)).expect("a table");
/// assert!(table.accuracy().rms < 0.01);
/// let form = DistributionForm::Table(table);
/// # let _ = form;
/// ```
pub trait Distribution: std::fmt::Debug + Send + Sync {
    /// Its name in tables.
    fn name(&self) -> &str;

    /// Emitted share per solid angle, 1/sr.
    fn density(&self, light: DVec3, view: DVec3) -> f64;

    /// A direction to the viewer, sampled about in proportion to the density, from a point of the unit square.
    ///
    /// None where the sample lies below the horizon: nothing is emitted then.
    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3>;

    /// The pdf of a direction by [`Distribution::sample`], 1/sr; it integrates to the part of the unit square that
    /// gives one. Above 0 wherever D is.
    fn pdf(&self, light: DVec3, view: DVec3) -> f64;
}

/// A distribution that ships with the program.
pub struct DistributionRow {
    /// The name.
    pub name: &'static str,
    /// A summary for tables.
    pub summary: &'static str,
    /// Makes it with a roughness m, the root mean square slope of facets times root 2, 1e-8..=1000.
    pub make: fn(f64) -> Result<Box<dyn Distribution>, DistributionError>,
}

/// How much smoother along y than along x the anisotropic row of the table is.
const ANISOTROPY: f64 = 4.0;

/// The family.
pub const FAMILY: &[DistributionRow] = &[
    DistributionRow { name: "Lambert", summary: "equal luminance everywhere", make: |_| Ok(Box::new(Lambert)) },
    DistributionRow {
        name: "Phong",
        summary: "a lobe around the mirrored light",
        make: |m| Ok(Box::new(Phong::new(exponent_of_roughness(m)?)?)),
    },
    DistributionRow {
        name: "Phong, normalised",
        summary: "a lobe around the mirrored light, that emits all that it gets",
        make: |m| Ok(Box::new(NormalisedPhong::new(exponent_of_roughness(m)?)?)),
    },
    DistributionRow {
        name: "Blinn",
        summary: "a lobe of facets, by a power of their cosine",
        make: |m| Ok(Box::new(Blinn::new(exponent_of_roughness(m)?)?)),
    },
    DistributionRow {
        name: "Cook-Torrance",
        summary: "as published in 1982, with its masking",
        make: |m| Ok(Box::new(CookTorrance::new(m)?)),
    },
    DistributionRow {
        name: "improved (7)",
        summary: "the paper's formula (7)",
        make: |m| Ok(Box::new(ImprovedCookTorrance::new(m)?)),
    },
    DistributionRow {
        name: "Beckmann",
        summary: "Gaussian facets, exact, with Smith's masking; one reflection",
        make: |m| Ok(Box::new(Microfacet::new(SlopeDistribution::Beckmann, DVec2::splat(m))?)),
    },
    DistributionRow {
        name: "GGX",
        summary: "facets of an ellipsoid, exact, with Smith's masking; one reflection",
        make: |m| Ok(Box::new(Microfacet::new(SlopeDistribution::Ggx, DVec2::splat(m))?)),
    },
    DistributionRow {
        name: "Beckmann, separable",
        summary: "Beckmann with masking of light and viewer apart; one reflection",
        make: |m| Ok(Box::new(Microfacet::new(SlopeDistribution::Beckmann, DVec2::splat(m))?.separable())),
    },
    DistributionRow {
        name: "GGX, separable",
        summary: "GGX with masking of light and viewer apart; one reflection",
        make: |m| Ok(Box::new(Microfacet::new(SlopeDistribution::Ggx, DVec2::splat(m))?.separable())),
    },
    DistributionRow {
        name: "anisotropic",
        summary: "Beckmann, four times smoother along y",
        make: |m| {
            Ok(Box::new(Microfacet::new(
                SlopeDistribution::Beckmann,
                DVec2::new(m, (m / ANISOTROPY).max(LEAST_ROUGHNESS)),
            )?))
        },
    },
    DistributionRow {
        name: "Beckmann, all",
        summary: "Beckmann with all reflections between facets",
        make: |m| Ok(Box::new(Compensated::new(SlopeDistribution::Beckmann, m)?)),
    },
    DistributionRow {
        name: "GGX, all",
        summary: "GGX with all reflections between facets",
        make: |m| Ok(Box::new(Compensated::new(SlopeDistribution::Ggx, m)?)),
    },
];

/// The mirrored light direction.
fn mirrored(light: DVec3) -> DVec3 {
    DVec3::new(-light.x, -light.y, light.z)
}
