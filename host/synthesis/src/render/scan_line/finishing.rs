//! Finishing by rays: samples that see what shows what is around it, as mirrors, metals, coats and glass do.
//!
//! A sample that sees such a surface, or sees anything through one, is traced as a whole, from the eye on and at its own
//! place in the pixel, so that edges are as smooth as all others; its neighbours on other surfaces are left alone.

use super::surfaces::StripPixel;
use super::visibility::{NONE, Strip};
use crate::illumination::optics::{Bsdf, Interreflection};
use crate::plan::{Plan, Stage};
use crate::render::ray_tracing::{PathScratch, RayFinisher};
use crate::render::tally::PixelSample;
use crate::render::world::Appearance;
use crate::render::{FinishedCounts, RayCounts};
use std::time::{Duration, Instant};

/// For each triangle of the scene, whether what sees it is finished by rays; nothing where that is so for none, or the
/// plan leaves reflected and refracted rays out.
pub(super) fn triangles_for_rays(appearance: &Appearance<'_>, plan: &Plan) -> Vec<bool> {
    triangles_with(appearance, plan, Bsdf::shows_surroundings)
}

/// For each triangle of the scene, whether rays gather the light of other diffuse surfaces and of skies for it; nothing
/// where that is so for none, or the plan leaves it out.
///
/// - `has_rays`: whether rays finish samples: that of skies is then gathered, too, so that it is the same everywhere.
pub(super) fn triangles_lit_by_others(appearance: &Appearance<'_>, plan: &Plan, has_rays: bool) -> Vec<bool> {
    let is_followed = appearance.prepared.settings.light.interreflection == Interreflection::Followed;
    let has_sky = appearance.sources.iter().any(|(_, source)| source.is_sky());
    if plan.needs(Stage::Radiosity) || !(is_followed || has_rays && has_sky) {
        return Vec::new();
    }
    triangles_with(appearance, plan, |bsdf| bsdf.is_diffuse() && !bsdf.shows_surroundings())
}

/// For each triangle of the scene, whether it is included and of a material of some kind; nothing where that is so for
/// none, or the plan leaves reflected and refracted rays out.
fn triangles_with(appearance: &Appearance<'_>, plan: &Plan, is_of_kind: impl Fn(&Bsdf) -> bool) -> Vec<bool> {
    let prepared = appearance.prepared;
    if !plan.needs(Stage::Reflection) || prepared.settings.light.reflection_depth == 0 {
        return Vec::new();
    }
    let is_meant = |triangle: u32| {
        let object = prepared.object_of[triangle as usize];
        let bsdf = appearance.bsdf(object, prepared.material_number(triangle));
        plan.includes_object(object as usize) && is_of_kind(bsdf)
    };
    let triangles: Vec<bool> = (0..prepared.triangles.len() as u32).map(is_meant).collect();
    if triangles.contains(&true) { triangles } else { Vec::new() }
}

/// Finishes samples by rays.
pub(super) struct Finishing<'a> {
    pub(super) finisher: &'a RayFinisher<'a>,
    /// For each triangle of the scene, whether what sees it is finished by rays.
    pub(super) triangles: &'a [bool],
    /// Whether no further sample is to be begun.
    pub(super) stopped: &'a (dyn Fn() -> bool + Sync),
}

/// Scratch of a thread: the samples of a pixel that were finished, and what a band took.
#[derive(Default)]
pub(super) struct FinishingScratch {
    /// For each sample of the pixel; empty if none was finished.
    pub(super) samples: Vec<Option<PixelSample>>,
    pub(super) path: PathScratch,
    count: u64,
    time: Duration,
}

impl Finishing<'_> {
    /// Finishes the samples of a pixel that ask for it, and tells how many these are; none if it was stopped before.
    pub(super) fn finish(&self, pixel: &StripPixel, strip: &Strip, scratch: &mut FinishingScratch) -> Option<usize> {
        scratch.samples.clear();
        if !pixel.samples().any(|sample| self.asks(sample, strip)) {
            return Some(0);
        }
        if (self.stopped)() {
            return None;
        }
        let begin = Instant::now();
        for (i, sample) in pixel.samples().enumerate() {
            let index = (pixel.begin + i) as u32;
            let by_rays = || self.finisher.sample(pixel.at, pixel.place(i), index, &mut scratch.path);
            let finished = self.asks(sample, strip).then(by_rays);
            scratch.samples.push(finished);
        }
        let finished = scratch.samples.iter().flatten().count();
        scratch.count += finished as u64;
        scratch.time += begin.elapsed();
        Some(finished)
    }

    /// Whether a sample sees anything that is finished by rays.
    fn asks(&self, sample: usize, strip: &Strip) -> bool {
        let asks = |triangle: u32| triangle != NONE && self.triangles[triangle as usize];
        asks(strip.triangles[sample]) || strip.layers_of(sample).any(|layer| asks(strip.layers[layer].triangle))
    }
}

impl FinishingScratch {
    /// Whether a sample of the pixel was finished.
    pub(super) fn has(&self, i: usize) -> bool {
        self.samples.get(i).is_some_and(Option::is_some)
    }

    /// Takes what was counted since it was taken last: rays and samples, of no pixel yet.
    pub(super) fn take_counts(&mut self) -> (RayCounts, FinishedCounts) {
        let FinishingScratch { path, count, time, .. } = self;
        let finished =
            FinishedCounts { pixels: 0, samples: std::mem::take(count), seconds: std::mem::take(time).as_secs_f64() };
        (std::mem::take(&mut path.counts), finished)
    }
}
