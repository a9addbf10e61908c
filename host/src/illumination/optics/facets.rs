//! A metal of facets: Fresnel's term for each, and for what they reflect to one another.

use super::lobe::{Flags, Lobe};
use super::polished::reflectance;
use super::sighting::{Onward, Sighting};
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
pub(super) enum Shape {
    /// Reflects once.
    Once(Arc<dyn Distribution>),
    /// With all reflections between facets.
    All(Arc<Compensated>),
}

impl Shape {
    fn as_distribution(&self) -> &dyn Distribution {
        match self {
            Shape::Once(distribution) => distribution.as_ref(),
            Shape::All(compensated) => compensated.as_ref(),
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
pub(super) struct Metallic {
    shape: Shape,
    conductors: Arc<Vec<[Conductor; LANES]>>,
    /// K of further reflections, for each comb.
    further: Vec<Channels>,
}

impl Metallic {
    /// - `conductors`: for each comb, lane by lane.
    pub(super) fn new(shape: Shape, conductors: Arc<Vec<[Conductor; LANES]>>) -> Metallic {
        let further = match &shape {
            Shape::Once(_) => Vec::new(),
            Shape::All(compensated) => {
                let left = 1.0 - compensated.mean_lost();
                let factor = |mean: f64| mean * mean * left / (1.0 - mean * (1.0 - left));
                conductors
                    .iter()
                    .map(|lanes| Channels(lanes.map(|conductor| factor(mean_reflectance(&conductor)))))
                    .collect()
            }
        };
        Metallic { shape, conductors, further }
    }
}

impl Lobe for Metallic {
    fn flags(&self) -> Flags {
        Flags::of_density(self.shape.as_distribution().sample_density(DVec3::Z, DVec3::Z))
    }

    /// D K / (N·V), 1/sr, for light above the horizon.
    fn value(&self, sighting: &Sighting, light: DVec3) -> Channels {
        if sighting.is_behind(light) {
            return Channels::ZERO;
        }
        let Sighting { view, comb, .. } = *sighting;
        let comb = comb.min(self.conductors.len() - 1);
        let Some(half) = (light + view).try_normalize() else { return Channels::ZERO };
        let first = reflectance(&self.conductors[comb], half.dot(view));
        match &self.shape {
            Shape::Once(distribution) => first * (distribution.density(light, view) / view.z),
            Shape::All(compensated) => {
                let [once, further] = compensated.parts(light, view);
                first * (once / view.z) + self.further[comb] * (further / view.z)
            }
        }
    }

    fn density(&self, sighting: &Sighting, light: DVec3) -> f64 {
        match sighting.is_behind(light) {
            true => 0.0,
            false => self.shape.as_distribution().sample_density(sighting.view, light),
        }
    }

    fn sample(&self, sighting: &Sighting, _: f64, point: [f64; 2]) -> Option<Onward> {
        self.shape.as_distribution().sample(sighting.view, point).map(Onward::spread)
    }

    fn strength(&self, _: &Sighting) -> f64 {
        1.0
    }

    /// Fresnel's term of a facet that faces halfway.
    fn shown(&self, sighting: &Sighting) -> Channels {
        reflectance(&self.conductors[sighting.comb.min(self.conductors.len() - 1)], sighting.view.z)
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
