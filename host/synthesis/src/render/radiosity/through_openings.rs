//! Light through openings: rays from points of them.
//!
//! Few rays from a wall find a small window. Rays from points of the window find both what is outside and what it lights
//! inside. So light that crosses an opening is found from there, all other light from the elements: each path of light
//! is counted once, wherever the openings are.

use super::direct::LightAtPoint;
use super::sample_guide::{GuidedSample, SampleGuide};
use super::visibility::{RayTarget, VisibilityTester};
use crate::color::Channels;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::cosine_hemisphere;
use crate::numeric::sequence::SobolSequence;
use serde::{Deserialize, Serialize};

/// Rays through all openings together, on either side, and through each at the least.
const RAYS: u32 = 1 << 19;
const FEWEST_RAYS: u32 = 1 << 10;
/// Rays that are traced as one piece of work.
const AT_ONCE: u32 = 1 << 10;
/// One ray in so many tells where light comes from before the others are traced.
const PILOT: u32 = 8;
/// Cells of a light along a side.
const SIDE: usize = 32;
/// Numbers of what is sampled, beyond those of leaves.
const OF_LIGHT: u64 = 1 << 42;
const OF_EXCHANGE: u64 = 1 << 43;
const OF_GUIDE: u64 = 1 << 44;

/// Light that comes through an opening to a side of a triangle.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct LightThroughOpening {
    pub(super) at: RayTarget,
    /// W, the mean over all wavelength sets.
    pub(super) flux: Channels,
}

/// Two sides of triangles that see each other through openings.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct SeenThroughOpening {
    pub(super) sides: [RayTarget; 2],
    /// A F that a ray stands for, square units.
    pub(super) exchange: f64,
}

/// Rays of an opening that are one piece of work.
struct RayBatch {
    opening: usize,
    first: u32,
}

impl VisibilityTester<'_> {
    fn rays_through_each(&self) -> u32 {
        let openings = self.openings.0.len().max(1) as u32;
        (RAYS / openings).max(FEWEST_RAYS).next_multiple_of(AT_ONCE)
    }

    /// All rays through all openings.
    fn rays_through(&self) -> Vec<RayBatch> {
        (0..self.openings.0.len()).flat_map(|opening| self.batches(opening, self.rays_through_each())).collect()
    }

    /// So many rays through an opening, or the multiple of a batch next to that.
    fn batches(&self, opening: usize, rays: u32) -> impl Iterator<Item = RayBatch> {
        (0..rays).step_by(AT_ONCE as usize).map(move |first| RayBatch { opening, first })
    }

    /// Light of lights through openings, as far as the first surface behind them; none where lights throw no shadows,
    /// since openings count for nothing there.
    pub(super) fn light_through_openings(&self, shadows: bool) -> Vec<LightThroughOpening> {
        let lights = self.world.appearance.sources.len();
        if lights == 0 || !shadows {
            return Vec::new();
        }
        let even = SampleGuide::even(lights, SIDE);
        let guides: Vec<SampleGuide> = (0..self.openings.0.len()).map(|opening| self.guide(opening, &even)).collect();
        let weight = f64::from(self.rays_through_each()).recip();
        let batch = |_, batch: &RayBatch| {
            let found = self.light_of(batch, &guides[batch.opening], OF_LIGHT);
            let weighted = |(sample, light): (GuidedSample, LightThroughOpening)| LightThroughOpening {
                flux: light.flux * (sample.weight * weight),
                ..light
            };
            found.into_iter().map(weighted).collect::<Vec<LightThroughOpening>>()
        };
        self.map(&self.rays_through(), batch).concat()
    }

    /// A guide to the lights, and the parts of them, that bring light through an opening.
    fn guide(&self, opening: usize, even: &SampleGuide) -> SampleGuide {
        let batches: Vec<RayBatch> = self.batches(opening, self.rays_through_each() / PILOT).collect();
        let brought = |_, batch: &RayBatch| -> Vec<(GuidedSample, f64)> {
            let found = self.light_of(batch, even, OF_GUIDE);
            found.into_iter().map(|(sample, light)| (sample, light.flux.0.iter().sum())).collect()
        };
        even.guided(self.map(&batches, brought).into_iter().flatten())
    }

    /// What light samples bring through an opening, of which each stands for all its light: to be weighted.
    fn light_of(
        &self,
        &RayBatch { opening: number, first }: &RayBatch,
        guide: &SampleGuide,
        of: u64,
    ) -> Vec<(GuidedSample, LightThroughOpening)> {
        let opening = &self.openings.0[number];
        let sequence = SobolSequence::new(self.seed, of + number as u64);
        let mut found = Vec::new();
        for index in first..first + AT_ONCE {
            let at = opening.point(sequence.point(index, 0));
            let [u, v] = sequence.point(index, 2);
            let sample = guide.sample([sequence.number(index, 1), u, v]);
            for outwards in [opening.normal, -opening.normal] {
                let Some(LightAtPoint { irradiance, towards, .. }) =
                    self.sample_light([at, outwards], sample.light, sample.uniform, true)
                else {
                    continue;
                };
                let ray = Ray { origin: at, direction: -towards };
                let target = if irradiance == Channels::ZERO { RayTarget::Nothing } else { self.trace(&ray) };
                let RayTarget::Side { t, transmittance, .. } = target else { continue };
                if self.openings.others_crossed(number, &ray, t) == 0 {
                    let flux = irradiance * (opening.area * transmittance);
                    found.push((sample, LightThroughOpening { at: target, flux }));
                }
            }
        }
        found
    }

    /// Sides of triangles that see each other through openings.
    pub(super) fn seen_through_openings(&self) -> Vec<SeenThroughOpening> {
        let count = f64::from(self.rays_through_each());
        let batch = |_, RayBatch { opening: number, first }: &RayBatch| {
            let opening = &self.openings.0[*number];
            let sequence = SobolSequence::new(self.seed, OF_EXCHANGE + *number as u64);
            let seen = |index: u32| {
                let at = opening.point(sequence.point(index, 0));
                let towards = cosine_hemisphere(sequence.point(index, 1), opening.normal);
                let (mut exchange, mut crossed) = (opening.area / count, 1);
                let mut sides = [RayTarget::Nothing; 2];
                for (side, direction) in sides.iter_mut().zip([towards, -towards]) {
                    let ray = Ray { origin: at, direction };
                    *side = self.trace(&ray);
                    let RayTarget::Side { t, transmittance, .. } = *side else { return None };
                    exchange *= transmittance;
                    crossed += self.openings.others_crossed(*number, &ray, t);
                }
                // A path through several openings is found from each.
                Some(SeenThroughOpening { sides, exchange: exchange / crossed as f64 })
            };
            (*first..*first + AT_ONCE).filter_map(seen).collect::<Vec<SeenThroughOpening>>()
        };
        self.map(&self.rays_through(), batch).concat()
    }
}
