//! Interfaces between transparent media: what is reflected, and what goes through.
//!
//! Indices may differ from lane to lane. A direction that one lane is refracted to is then not that of the others: it
//! is sampled for the lane of the [`ShadingContext`], and a renderer keeps that lane alone.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use crate::color::{Channels, LANES};
use crate::illumination::fresnel::Dielectric;
use glam::DVec3;

/// The least chance that is given to what is reflected or to what goes through.
const LEAST_CHANCE: f64 = 0.05;
/// The chance of what there is little of is no greater than so many times its part: nothing at all takes no samples.
const MOST_CHANCE: f64 = 4.0;

/// A smooth interface.
#[derive(Clone, Debug)]
pub(super) struct SmoothDielectric;

/// The chance that reflection is sampled and not transmission.
///
/// Neither is left to chances too small for what it may bring, unless there is next to nothing of it.
///
/// - `reflected`, `through`: the parts of light, 0..=1; the greatest of all lanes, if these differ.
pub(super) fn chance_of(reflected: f64, through: f64) -> f64 {
    let least = |part: f64| f64::min(LEAST_CHANCE, MOST_CHANCE * part);
    reflected.clamp(least(reflected), 1.0 - least(through))
}

/// The interface for one lane.
pub(super) fn interface(context: &ShadingContext, lane: usize) -> Option<Dielectric> {
    Dielectric::new(context.indices.before.0[lane], context.indices.behind.0[lane]).ok()
}

/// A value for each lane, found once where all have the same indices.
pub(super) fn by_lane(context: &ShadingContext, value: impl Fn(usize) -> f64) -> Channels {
    let [before, behind] = [context.indices.before.0, context.indices.behind.0];
    match before == [before[0]; LANES] && behind == [behind[0]; LANES] {
        true => Channels::splat(value(0)),
        false => Channels(std::array::from_fn(value)),
    }
}

/// Reflectance of a facet in the lanes.
pub(super) fn reflected(context: &ShadingContext, cosine: f64) -> Channels {
    by_lane(context, |lane| interface(context, lane).map_or(0.0, |s| s.reflectance(cosine).mean()))
}

/// By how much radiance falls as it leaves what is behind: it grows by the square of the index on its way in.
pub(super) fn radiance_scale(context: &ShadingContext) -> Channels {
    let side = &context.indices;
    by_lane(context, |lane| (side.before.0[lane] / side.behind.0[lane]).powi(2))
}

impl Lobe for SmoothDielectric {
    fn flags(&self) -> Flags {
        Flags::DELTA | Flags::CLEAR
    }

    fn value(&self, _: &ShadingContext, _: DVec3) -> Channels {
        Channels::ZERO
    }

    fn pdf(&self, _: &ShadingContext, _: DVec3) -> f64 {
        0.0
    }

    /// One of the two, by its part.
    fn sample(&self, context: &ShadingContext, choice: f64, _: [f64; 2]) -> Option<BsdfSample> {
        let [reflection, refraction] = self.specular_samples(context);
        let (Some(reflection), Some(refraction)) = (reflection, refraction) else { return reflection.or(refraction) };
        let least = reflection.weight.0.into_iter().fold(1.0, f64::min);
        let chance = chance_of(reflection.weight.max(), 1.0 - least);
        Some(if choice < chance {
            BsdfSample { weight: reflection.weight * chance.recip(), ..reflection }
        } else {
            BsdfSample { weight: refraction.weight * (1.0 - chance).recip(), ..refraction }
        })
    }

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    /// Specular samples of reflection and of transmission.
    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        let view = context.view;
        let fraction = reflected(context, view.z);
        let reflection = BsdfSample::specular(DVec3::new(-view.x, -view.y, view.z), fraction);
        let through = by_lane(context, |lane| {
            interface(context, lane).map_or(0.0, |surface| surface.transmittance(view.z).mean())
        });
        let refracted = interface(context, context.lane).and_then(|surface| surface.refracted(view, DVec3::Z));
        let refraction = refracted
            .filter(|light| light.z < 0.0)
            .map(|light| BsdfSample::specular(light, through * radiance_scale(context)));
        [Some(reflection).filter(|sample| sample.weight.max() > 0.0), refraction.filter(|o| o.weight.max() > 0.0)]
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        reflected(context, context.view.z)
    }

    fn clear_transmittance(&self, context: &ShadingContext) -> Channels {
        Channels::ONE - reflected(context, context.view.z)
    }
}

/// Euler's beta function.
pub(super) fn beta(a: f64, b: f64) -> f64 {
    (libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b)).exp()
}
