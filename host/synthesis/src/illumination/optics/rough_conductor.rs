//! A metal of facets: Fresnel's term for each, and for what they reflect to one another.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use super::smooth_conductor::reflectance;
use crate::color::{Channels, LANES};
use crate::illumination::distribution::{Compensated, Distribution};
use crate::illumination::fresnel::Conductor;
use crate::numeric::cubature::GAUSS;
use glam::DVec3;
use std::sync::Arc;

/// Parts of the range of cosines over which the mean of Fresnel's term is taken.
const PARTS: usize = 8;

/// A distribution of facets: one of the family, or one whose further reflections are known apart.
#[derive(Clone, Debug)]
pub(super) enum FacetDistribution {
    /// Reflects once.
    SingleScattering(Arc<dyn Distribution>),
    /// With all reflections between facets.
    MultipleScattering(Arc<Compensated>),
}

impl FacetDistribution {
    fn as_distribution(&self) -> &dyn Distribution {
        match self {
            FacetDistribution::SingleScattering(distribution) => distribution.as_ref(),
            FacetDistribution::MultipleScattering(compensated) => compensated.as_ref(),
        }
    }
}

/// A metal of facets.
///
/// K is Fresnel's term F at the angle to the facet. What was reflected between facets has lost more: with E the mean
/// share that leaves after one reflection, and F̄ the mean of F, its K is F̄² E / (1 − F̄ (1 − E)).
///
/// # Source
/// Cook and Torrance 1982; Kulla and Conty 2017 for the further reflections, summed as a geometric series.
#[derive(Clone, Debug)]
pub(super) struct RoughConductor {
    facets: FacetDistribution,
    conductors: Arc<Vec<[Conductor; LANES]>>,
    /// K of further reflections, for each wavelength set.
    further: Vec<Channels>,
}

impl RoughConductor {
    /// - `conductors`: for each wavelength set, lane by lane.
    pub(super) fn new(shape: FacetDistribution, conductors: Arc<Vec<[Conductor; LANES]>>) -> RoughConductor {
        let further = match &shape {
            FacetDistribution::SingleScattering(_) => Vec::new(),
            FacetDistribution::MultipleScattering(compensated) => {
                let left = 1.0 - compensated.mean_lost();
                let factor = |mean: f64| mean * mean * left / (1.0 - mean * (1.0 - left));
                conductors
                    .iter()
                    .map(|lanes| Channels(lanes.map(|conductor| factor(mean_reflectance(&conductor)))))
                    .collect()
            }
        };
        RoughConductor { facets: shape, conductors, further }
    }
}

impl Lobe for RoughConductor {
    fn flags(&self) -> Flags {
        Flags::of_pdf(self.facets.as_distribution().pdf(DVec3::Z, DVec3::Z))
    }

    /// D K / (N·V), 1/sr, for light above the horizon.
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if context.is_behind(light) {
            return Channels::ZERO;
        }
        let ShadingContext { view, wavelength_set, .. } = *context;
        let wavelength_set = wavelength_set.min(self.conductors.len() - 1);
        let Some(half) = (light + view).try_normalize() else { return Channels::ZERO };
        let first = reflectance(&self.conductors[wavelength_set], half.dot(view));
        match &self.facets {
            FacetDistribution::SingleScattering(distribution) => first * (distribution.density(light, view) / view.z),
            FacetDistribution::MultipleScattering(compensated) => {
                let [once, further] = compensated.parts(light, view);
                first * (once / view.z) + self.further[wavelength_set] * (further / view.z)
            }
        }
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        match context.is_behind(light) {
            true => 0.0,
            false => self.facets.as_distribution().pdf(context.view, light),
        }
    }

    fn sample(&self, context: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        self.facets.as_distribution().sample(context.view, point).map(BsdfSample::unweighted)
    }

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    /// Fresnel's term of a facet that faces halfway.
    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        reflectance(&self.conductors[context.wavelength_set.min(self.conductors.len() - 1)], context.view.z)
    }
}

/// 2 ∫ F μ dμ
fn mean_reflectance(conductor: &Conductor) -> f64 {
    let term = |part: usize| {
        GAUSS.iter().map(move |(at, weight)| {
            let cosine = (part as f64 + at) / PARTS as f64;
            2.0 * cosine * conductor.reflectance(cosine).mean() * weight / PARTS as f64
        })
    };
    (0..PARTS).flat_map(term).sum()
}
