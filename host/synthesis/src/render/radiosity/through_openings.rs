//! Light through openings: rays from points of them.
//!
//! Few rays from a wall find a small window. Rays from points of the window find both what is outside and what it lights
//! inside. So light that crosses an opening is found from there, all other light from the elements: each path of light
//! is counted once, wherever the openings are. A few rays tell first where most of it comes from.

use super::direct::LightAtPoint;
use super::exchange::{ExchangeLink, OpeningExchange};
use super::node::NONE;
use super::sample_guide::{GuidedSample, SampleGuide};
use super::visibility::{RayTarget, VisibilityTester};
use crate::color::Channels;
use crate::memory::{self, MemoryExceeded};
use crate::numeric::ray::Ray;
use crate::numeric::sampling::cosine_hemisphere;
use crate::numeric::sequence::SobolSequence;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Rays through all openings together, on either side, and through each at the least.
const RAYS: u32 = 1 << 19;
const FEWEST_RAYS: u32 = 1 << 10;
/// Rays that tell what is exchanged through openings: at first, and at the most.
const FIRST_RAYS: u32 = 1 << 17;
const MOST_RAYS: u32 = 1 << 21;
/// The standard error of what is exchanged, as a part of it, that needs no more rays.
const ENOUGH: f64 = 0.0015;
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
const OF_EXCHANGE_GUIDE: u64 = 1 << 48;

/// Light that comes through an opening to a side of a triangle.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct LightThroughOpening {
    pub(super) at: RayTarget,
    /// W, the mean over all wavelength sets.
    pub(super) flux: Channels,
}

/// Finds the number of the leaf where a ray ends, and the weights of its corners there; none where no leaf is.
type FindLeaf<'f> = &'f (dyn Fn(RayTarget) -> Option<(u32, [f64; 3])> + Sync);

/// Rays of an opening that are one piece of work.
struct RayBatch {
    opening: usize,
    first: u32,
}

impl VisibilityTester<'_> {
    /// How many rays go through each opening, of so many through all.
    fn of_each(&self, rays: u32) -> u32 {
        let openings = self.openings.0.len().max(1) as u32;
        (rays / openings).max(FEWEST_RAYS).next_multiple_of(AT_ONCE)
    }

    /// Rays through every opening, from one number to another.
    fn of_all(&self, rays: Range<u32>) -> Vec<RayBatch> {
        (0..self.openings.0.len()).flat_map(|opening| batches(opening, rays.clone())).collect()
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
        let rays = self.of_each(RAYS);
        let weight = f64::from(rays).recip();
        let batch = |_, batch: &RayBatch| {
            let found = self.light_of(batch, &guides[batch.opening], OF_LIGHT);
            let weighted = |(sample, light): (GuidedSample, LightThroughOpening)| LightThroughOpening {
                flux: light.flux * (sample.weight * weight),
                ..light
            };
            found.into_iter().map(weighted).collect::<Vec<LightThroughOpening>>()
        };
        self.map(&self.of_all(0..rays), batch).concat()
    }

    /// A guide to the lights, and the parts of them, that bring light through an opening.
    fn guide(&self, opening: usize, even: &SampleGuide) -> SampleGuide {
        let batches: Vec<RayBatch> = batches(opening, 0..self.of_each(RAYS) / PILOT).collect();
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

    /// What leaves exchange through openings: so many rays that chance is a small part of it.
    ///
    /// - `find`: finds the leaf where a ray ends. `sent`: what each leaf sends, in any unit: where that is much, more rays
    ///   are traced. `stopped`: whether the first rays will do.
    ///
    /// # Errors
    /// [`MemoryExceeded`].
    pub(super) fn exchange_through_openings(
        &self,
        find: FindLeaf<'_>,
        sent: &[f64],
        stopped: &dyn Fn() -> bool,
    ) -> Result<Vec<OpeningExchange>, MemoryExceeded> {
        let even = SampleGuide::even(1, SIDE);
        let flux =
            |seen: &OpeningExchange| seen.link.exchange * (sent[seen.link.a as usize] + sent[seen.link.b as usize]);
        let first = self.of_each(FIRST_RAYS);
        let guide = |opening: usize| {
            let pilot: Vec<RayBatch> = batches(opening, 0..first / PILOT).collect();
            let found = self.map(&pilot, |_, batch| self.exchange_of(batch, find, &even, OF_EXCHANGE_GUIDE));
            even.guided(found.into_iter().flatten().map(|(sample, seen)| (sample, flux(&seen))))
        };
        let guides: Vec<SampleGuide> = (0..self.openings.0.len()).map(guide).collect();
        let traced = |rays: Range<u32>| -> Result<Vec<OpeningExchange>, MemoryExceeded> {
            let batches = self.of_all(rays);
            let count = batches.len() as u64 * u64::from(AT_ONCE);
            memory::reserve(2 * count * size_of::<OpeningExchange>() as u64, || {
                format!("radiosity: {count} rays through openings")
            })?;
            let weighted = |_, batch: &RayBatch| -> Vec<OpeningExchange> {
                let found = self.exchange_of(batch, find, &guides[batch.opening], OF_EXCHANGE).into_iter();
                found.map(|(sample, seen)| seen.times(sample.weight)).collect()
            };
            Ok(self.map(&batches, weighted).concat())
        };
        let mut found = traced(0..first)?;
        let (sum, squares) =
            found.iter().map(flux).fold((0.0, 0.0), |(sum, squares), flux| (sum + flux, squares + flux * flux));
        // As if all of it was by chance: the rays are spread more evenly.
        let needed = if sum > 0.0 { squares / (sum * ENOUGH).powi(2) } else { 0.0 };
        let most = if stopped() { first } else { self.of_each(MOST_RAYS) };
        let all = ((needed * f64::from(first)).min(f64::from(most)) as u32).next_multiple_of(AT_ONCE).max(first);
        found.append(&mut traced(first..all)?);
        found.iter_mut().for_each(|seen| *seen = seen.times(f64::from(all).recip()));
        Ok(found)
    }

    /// What rays through an opening connect, each of which stands for all that goes through it: to be weighted.
    ///
    /// - `find`: finds the leaf where a ray ends. `guide`: to directions, by the unit square. `of`: the number of the
    ///   sequence of the first opening.
    fn exchange_of(
        &self,
        &RayBatch { opening: number, first }: &RayBatch,
        find: FindLeaf<'_>,
        guide: &SampleGuide,
        of: u64,
    ) -> Vec<(GuidedSample, OpeningExchange)> {
        let opening = &self.openings.0[number];
        let sequence = SobolSequence::new(self.seed, of + number as u64);
        let seen = |index: u32| {
            let point = opening.point(sequence.point(index, 0));
            let [u, v] = sequence.point(index, 2);
            let sample = guide.sample([sequence.number(index, 1), u, v]);
            let towards = cosine_hemisphere(sample.uniform, opening.normal);
            let (mut exchange, mut crossed) = (opening.area, 1);
            let mut ends = [(NONE, [0.0; 3]); 2];
            for (end, direction) in ends.iter_mut().zip([towards, -towards]) {
                let ray = Ray { origin: point, direction };
                let target = self.trace(&ray);
                let RayTarget::Side { t, transmittance, .. } = target else { return None };
                *end = find(target)?;
                exchange *= transmittance;
                crossed += self.openings.others_crossed(number, &ray, t);
            }
            let [(a, at_a), (b, at_b)] = ends;
            // A path through several openings is found from each.
            let link = ExchangeLink { a, b, exchange: exchange / crossed as f64 };
            Some((sample, OpeningExchange { link, at: [at_a, at_b] }))
        };
        (first..first + AT_ONCE).filter_map(seen).collect()
    }
}

/// Rays through an opening, from one number to another: multiples of those that are traced at once.
fn batches(opening: usize, rays: Range<u32>) -> impl Iterator<Item = RayBatch> {
    rays.step_by(AT_ONCE as usize).map(move |first| RayBatch { opening, first })
}
