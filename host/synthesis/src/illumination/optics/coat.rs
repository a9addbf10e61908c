//! A transparent coat on a diffuse ground: plastic, varnish, glaze.

use super::context::{BsdfSample, ShadingContext};
use super::diffuse::{cosine_pdf, cosine_sample};
use super::lobe::{Flags, Lobe};
use super::prepared_textures::PreparedPaint;
use crate::color::{Channels, SpectralTable};
use crate::illumination::distribution::{Distribution, Microfacet};
use crate::illumination::fresnel::Dielectric;
use crate::numeric::cubature::{GAUSS, unit_square};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// Steps of the table of what a rough coat lets through.
const STEPS: usize = 64;
/// Error of the cubature of an entry, and the most evaluations for it.
const TOLERANCE: f64 = 1e-5;
const MOST_EVALUATIONS: u32 = 20_000;

/// The reflection of a coat.
#[derive(Clone, Debug)]
pub(super) struct CoatReflection {
    surface: Dielectric,
    /// The facets; none where it is polished.
    facets: Option<Microfacet>,
    /// Transmittance of facets, at even steps of the root of the cosine; empty where it is polished.
    through: Vec<f64>,
}

impl CoatReflection {
    pub(super) fn new(surface: Dielectric, facets: Option<Microfacet>) -> CoatReflection {
        let mut coat = CoatReflection { surface, facets, through: Vec::new() };
        if let Some(facets) = &coat.facets {
            let entry = |step: usize| {
                let cosine = (step as f64 / STEPS as f64).powi(2).max(1e-6);
                let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
                // One half of the directions is the mirror image of the other.
                let reflected = |[x, y]: [f64; 2]| {
                    let light = facets.sample(view, [x, 0.5 * y]);
                    let half = light.and_then(|light| (light + view).try_normalize());
                    light
                        .zip(half)
                        .map_or(0.0, |(light, half)| facets.weight(view, light) * coat.reflected(half.dot(view)))
                };
                1.0 - unit_square(reflected, TOLERANCE, MOST_EVALUATIONS).value.clamp(0.0, 1.0)
            };
            let through = (0..=STEPS).into_par_iter().map(entry).collect();
            coat.through = through;
        }
        coat
    }

    /// Fresnel's term.
    fn reflected(&self, cosine: f64) -> f64 {
        self.surface.reflectance(cosine).mean()
    }

    /// Transmittance to the ground.
    fn through(&self, cosine: f64) -> f64 {
        if self.through.is_empty() {
            return self.surface.transmittance(cosine).mean();
        }
        let place = cosine.clamp(0.0, 1.0).sqrt() * STEPS as f64;
        let step = (place as usize).min(STEPS - 1);
        let part = place - step as f64;
        self.through[step] * (1.0 - part) + self.through[step + 1] * part
    }

    /// 2 ∫ T μ dμ, with points that gather where T falls to 0 at the horizon.
    fn mean_through(&self) -> f64 {
        let term = |part: usize| {
            GAUSS.iter().map(move |(at, weight)| {
                let root = (part as f64 + at) / STEPS as f64;
                let cosine = root * root;
                4.0 * root * cosine * self.through(cosine) * weight / STEPS as f64
            })
        };
        (0..STEPS).flat_map(term).sum()
    }
}

impl Lobe for CoatReflection {
    fn flags(&self) -> Flags {
        match &self.facets {
            None => Flags::DELTA,
            Some(facets) => Flags::of_pdf(facets.pdf(DVec3::Z, DVec3::Z)),
        }
    }

    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        let view = context.view;
        if context.is_behind(light) {
            return Channels::ZERO;
        }
        let Some((facets, half)) = self.facets.as_ref().zip((light + view).try_normalize()) else {
            return Channels::ZERO;
        };
        Channels::splat(self.reflected(half.dot(view)) * facets.density(light, view) / view.z)
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        match &self.facets {
            Some(facets) if !context.is_behind(light) => facets.pdf(context.view, light),
            _ => 0.0,
        }
    }

    fn sample(&self, context: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        match &self.facets {
            Some(facets) => facets.sample(context.view, point).map(BsdfSample::unweighted),
            None => self.specular_samples(context)[0],
        }
    }

    fn strength(&self, context: &ShadingContext) -> f64 {
        // Where Fresnel's term vanishes, so does what is reflected; a rough coat may still show tilted facets.
        self.reflected(context.view.z).max(if self.facets.is_none() { 0.0 } else { 0.02 })
    }

    fn specular_samples(&self, context: &ShadingContext) -> [Option<BsdfSample>; 2] {
        let mirrored = || BsdfSample::specular(context.mirror_direction(), self.glossy_albedo(context));
        [self.facets.is_none().then(mirrored), None]
    }

    fn glossy_albedo(&self, context: &ShadingContext) -> Channels {
        Channels::splat(self.reflected(context.view.z))
    }
}

/// A diffuse ground under a coat: light passes the coat twice, and what the coat reflects back down reaches the ground
/// again, any number of times.
///
/// D = T(N·L) T(N·V) (N·V) K (1 − R) / (π T̄ (1 − K R)), with T what the coat lets through, T̄ its mean, and R the part
/// of diffuse light from below that it reflects back, 1 − T̄/η². All that enters leaves again if K = 1.
///
/// # Source
/// The geometric series of a coat over a Lambertian ground.
#[derive(Clone, Debug)]
pub(super) struct CoatedDiffuse {
    coat: Arc<CoatReflection>,
    /// T̄ and R.
    mean: f64,
    back: f64,
    fraction: Fraction,
}

/// K (1 − R) / (π T̄ (1 − K R)), or K.
#[derive(Clone, Debug)]
enum Fraction {
    Known(SpectralTable),
    Textured(PreparedPaint),
}

impl CoatedDiffuse {
    /// - `index`: of the coat over that of what is above. `reflectance`: of the ground. `sets`: how many wavelength
    ///   sets there are.
    pub(super) fn new(
        coat: Arc<CoatReflection>,
        index: f64,
        reflectance: &PreparedPaint,
        sets: usize,
    ) -> CoatedDiffuse {
        let mean = coat.mean_through();
        // Where the coat is the thinner medium, nothing is reflected back but what Fresnel's term says.
        let back = (1.0 - mean / (index * index)).max(0.0);
        let fraction = match reflectance {
            PreparedPaint::Plain(curve) => Fraction::Known(SpectralTable::each(sets, |wavelength_set| {
                curve.of(wavelength_set).map(|k| series(k, mean, back))
            })),
            textured => Fraction::Textured(textured.clone()),
        };
        CoatedDiffuse { coat, mean, back, fraction }
    }

    fn fraction(&self, context: &ShadingContext) -> Channels {
        match &self.fraction {
            Fraction::Known(curve) => curve.of(context.wavelength_set),
            Fraction::Textured(shade) => shade.of(context).map(|k| series(k, self.mean, self.back)),
        }
    }
}

impl Lobe for CoatedDiffuse {
    fn flags(&self) -> Flags {
        let is_black = match &self.fraction {
            Fraction::Known(curve) => curve.max() <= 0.0,
            Fraction::Textured(shade) => shade.is_black(),
        };
        Flags::BROAD | Flags::DIFFUSE | Flags::BLACK.when(is_black)
    }

    fn value(&self, context: &ShadingContext, light: DVec3) -> Channels {
        if context.is_behind(light) {
            return Channels::ZERO;
        }
        self.fraction(context) * (self.coat.through(light.z) * self.coat.through(context.view.z))
    }

    fn pdf(&self, context: &ShadingContext, light: DVec3) -> f64 {
        cosine_pdf(context, light)
    }

    fn sample(&self, _: &ShadingContext, _: f64, point: [f64; 2]) -> Option<BsdfSample> {
        cosine_sample(point)
    }

    fn strength(&self, context: &ShadingContext) -> f64 {
        self.fraction(context).max() * std::f64::consts::PI * self.coat.through(context.view.z)
    }

    /// π D T̄² of the D without its two T.
    fn diffuse_albedo(&self, context: &ShadingContext) -> Channels {
        self.fraction(context) * (std::f64::consts::PI * self.mean * self.mean)
    }
}

/// K (1 − R) / (π T̄ (1 − K R)).
fn series(k: f64, mean: f64, back: f64) -> f64 {
    k * FRAC_1_PI * (1.0 - back) / (mean * (1.0 - k * back))
}
