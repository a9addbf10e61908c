//! Interfaces between transparent media: what is reflected, and what goes through.
//!
//! Indices may differ from lane to lane. A direction that one lane is refracted to is then not that of the others: it
//! is sampled for the lane of the [`ShadingContext`], and a renderer keeps that lane alone.

use super::context::{BsdfSample, ShadingContext};
use super::lobe::{Flags, Lobe};
use crate::color::{Channels, LANES};
use crate::illumination::distribution::SlopeDistribution;
use crate::illumination::fresnel::Dielectric;
use glam::{DVec2, DVec3};

/// The least chance that is given to what is reflected or to what goes through.
const LEAST_CHANCE: f64 = 0.05;
/// The chance of what there is little of is no greater than so many times its part: nothing at all takes no samples.
const MOST_CHANCE: f64 = 4.0;

/// A smooth interface.
#[derive(Clone, Debug)]
pub(super) struct SmoothDielectric;

/// A rough interface, of facets that each reflect and refract.
#[derive(Clone, Debug)]
pub(super) struct RoughDielectric {
    pub(super) facets: SlopeDistribution,
    pub(super) roughness: DVec2,
}

/// The chance that reflection is sampled and not transmission.
///
/// Neither is left to chances too small for what it may bring, unless there is next to nothing of it.
///
/// - `reflected`, `through`: the parts of light, 0..=1; the greatest of all lanes, if these differ.
fn chance_of(reflected: f64, through: f64) -> f64 {
    let least = |part: f64| f64::min(LEAST_CHANCE, MOST_CHANCE * part);
    reflected.clamp(least(reflected), 1.0 - least(through))
}

/// The interface for one lane.
pub(super) fn interface(context: &ShadingContext, lane: usize) -> Option<Dielectric> {
    Dielectric::new(context.indices.before.0[lane], context.indices.behind.0[lane]).ok()
}

/// A value for each lane, found once where all have the same indices.
fn by_lane(context: &ShadingContext, value: impl Fn(usize) -> f64) -> Channels {
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
fn radiance_scale(context: &ShadingContext) -> Channels {
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

impl RoughDielectric {
    /// The chance that a facet is taken to reflect.
    fn chance(&self, context: &ShadingContext, cosine: f64) -> f64 {
        let fraction = interface(context, context.lane).map_or(1.0, |surface| surface.reflectance(cosine).mean());
        chance_of(fraction, 1.0 - fraction)
    }

    /// The facet that would send light to the viewer, through or not, on the side of the viewer.
    fn facet(&self, context: &ShadingContext, light: DVec3, lane: usize) -> Option<DVec3> {
        let view = context.view;
        let facet = if light.z > 0.0 {
            light + view
        } else {
            // Along −(n_before V + n_behind L); towards the viewer, whichever index is greater.
            let (before, behind) = (context.indices.before.0[lane], context.indices.behind.0[lane]);
            let facet = -(view * before + light * behind);
            if facet.z < 0.0 { -facet } else { facet }
        };
        let facet = facet.try_normalize()?;
        let sees = facet.dot(view) > 0.0 && (light.z > 0.0 || facet.dot(light) < 0.0);
        (sees && facet.z > 0.0).then_some(facet)
    }

    /// How much of the directions around a facet goes to one solid angle of light.
    fn jacobian(&self, context: &ShadingContext, light: DVec3, facet: DVec3, lane: usize) -> f64 {
        let (to_view, to_light) = (facet.dot(context.view), facet.dot(light));
        if light.z > 0.0 {
            return 0.25 / to_light;
        }
        let ratio = context.indices.before.0[lane] / context.indices.behind.0[lane];
        let sum = to_light + ratio * to_view;
        to_light.abs() / (sum * sum)
    }
}

impl Lobe for RoughDielectric {
    fn flags(&self) -> Flags {
        // If all facets are seen, the pdf is a quarter of the density of their normals.
        Flags::of_pdf(0.25 * self.facets.area(DVec3::Z, self.roughness))
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        let view = context.view;
        if view.z <= 0.0 || light.z == 0.0 {
            return 0.0;
        }
        let Some(facet) = self.facet(context, light, context.lane) else { return 0.0 };
        let cosine = facet.dot(view);
        let chance = self.chance(context, cosine);
        let chance = if light.z > 0.0 { chance } else { 1.0 - chance };
        let seen = cosine * self.facets.area(facet, self.roughness) / self.facets.projected(view, self.roughness);
        let pdf = chance * seen * self.jacobian(context, light, facet, context.lane);
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// Radiance towards the viewer for a unit of flux density, 1/sr.
    ///
    /// # Source
    /// Walter et al. 2007, equations 20 and 21; heights of light and viewer correlated.
    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        let view = context.view;
        if view.z <= 0.0 || light.z == 0.0 {
            return Channels::ZERO;
        }
        let above = DVec3::new(light.x, light.y, light.z.abs());
        let [l, v] = [above, view].map(|towards| self.facets.projected(towards, self.roughness));
        // Area that shows to both over both cosines: G / (|N·L| (N·V)).
        let masking = if light.z > 0.0 {
            (view.z * l + above.z * (v - view.z)).recip()
        } else {
            // Above and below, one hides what the other does not: G is a beta function of the two Λ.
            let (lambda_v, lambda_l) = (v / view.z - 1.0, l / above.z - 1.0);
            beta(1.0 + lambda_v, 1.0 + lambda_l) / (view.z * above.z)
        };
        let of_lane = |lane: usize| {
            let Some((facet, surface)) = self.facet(context, light, lane).zip(interface(context, lane)) else {
                return 0.0;
            };
            let cosine = facet.dot(view);
            let area = self.facets.area(facet, self.roughness);
            let jacobian = self.jacobian(context, light, facet, lane);
            let value = if light.z > 0.0 {
                surface.reflectance(cosine).mean() * area * cosine * jacobian * masking
            } else {
                let ratio = context.indices.before.0[lane] / context.indices.behind.0[lane];
                surface.transmittance(cosine).mean() * area * cosine * jacobian * masking * ratio * ratio
            };
            if value.is_finite() { value } else { 0.0 }
        };
        by_lane(context, of_lane)
    }

    /// Samples a facet as the viewer sees it, and reflects or refracts there.
    fn sample(&self, context: &ShadingContext, choice: f64, point: [f64; 2]) -> Option<BsdfSample> {
        let view = context.view;
        let facet = self.facets.visible(view, self.roughness, point)?;
        let cosine = facet.dot(view);
        if cosine <= 0.0 {
            return None;
        }
        let light = if choice < self.chance(context, cosine) {
            (facet * (2.0 * cosine) - view).try_normalize().filter(|light| light.z > 0.0)
        } else {
            interface(context, context.lane)?.refracted(view, facet).filter(|light| light.z < 0.0)
        };
        light.map(BsdfSample::unweighted)
    }

    fn strength(&self, _: &ShadingContext) -> f64 {
        1.0
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        reflected(context, context.view.z)
    }
}

/// Euler's beta function.
pub(super) fn beta(a: f64, b: f64) -> f64 {
    (libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b)).exp()
}
