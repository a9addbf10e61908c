//! The light of lights at random points of leaves: with errors of chance only, which are not of one sign.

use super::hierarchy::Hierarchy;
use super::sample_guide::{GuidedSample, SampleGuide};
use super::visibility::VisibilityTester;
use crate::color::Channels;
use crate::numeric::ray::Ray;
use crate::numeric::sequence::SobolSequence;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Light samples at random points of a leaf: at first, and at the most; and of all leaves that need more.
const FEW_SAMPLES: u32 = 16;
const MOST_SAMPLES: u32 = 512;
const SAMPLES: usize = 1 << 21;
/// The standard error of the irradiance of a leaf by light samples, as a part of it, that needs no more.
const SAMPLED_ERROR: f64 = 0.05;
/// A neighbourhood tells how many light samples each of its leaves needs, and where their light comes from. It has so many
/// leaves and samples that brought light, or so many leaves at the most, of which light may come to none.
const NEIGHBOURS: u32 = 16;
const LIT_SAMPLES: u32 = 32;
const MOST_NEIGHBOURS: u32 = 512;
/// Cells of a light along a side.
const SIDE: usize = 8;
/// Numbers of what is sampled, beyond those of what looks around.
const OF_LIGHT: u64 = 1 << 41;
const OF_PILOT: u64 = 1 << 45;
const OF_GUIDED: u64 = 1 << 46;

/// Sums over light samples, each of which stands for all light.
#[derive(Clone, Copy, Default)]
struct LightSums {
    irradiance: Channels,
    /// Of all lanes together, and of its square.
    total: f64,
    squares: f64,
    samples: u32,
    lit: u32,
}

impl LightSums {
    fn with(mut self, samples: impl Iterator<Item = Channels>) -> LightSums {
        for light in samples {
            let of_lanes: f64 = light.0.iter().sum();
            self.irradiance += light;
            self.total += of_lanes;
            self.squares += of_lanes * of_lanes;
            self.lit += u32::from(of_lanes > 0.0);
            self.samples += 1;
        }
        self
    }

    fn light(&self) -> RandomLight {
        let LightSums { samples, lit, .. } = *self;
        let all = f64::from(samples);
        let mean = self.total / all;
        let variance = (self.squares / all - mean * mean).max(0.0) / (all - 1.0);
        RandomLight { irradiance: self.irradiance * all.recip(), variance, samples, lit }
    }
}

/// The irradiance of a leaf by light samples at random points of it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct RandomLight {
    /// The mean, W/m².
    pub(super) irradiance: Channels,
    /// The variance of the mean in all lanes together.
    pub(super) variance: f64,
    pub(super) samples: u32,
    /// Samples that brought light.
    lit: u32,
}

impl RandomLight {
    fn total(&self) -> f64 {
        self.irradiance.0.iter().sum()
    }
}

/// The mean irradiance of each leaf by light samples at random points of it, without what comes through openings. The
/// less a few samples tell, the more are taken, mostly where samples of neighbours found light.
///
/// - `leaves`: their nodes. `importance`: how many samples each is worth, as a part of those of one that is shown, 0..=1.
pub(super) fn random_light(
    visibility: &VisibilityTester<'_>,
    hierarchy: &Hierarchy,
    leaves: &[u32],
    importance: impl Fn(u32) -> f64 + Sync,
    shadows: bool,
) -> Vec<RandomLight> {
    let sampler = LeafSampler { visibility, hierarchy, shadows };
    let lights = visibility.world.appearance.sources.len();
    let mut light: Vec<RandomLight> = visibility.map(leaves, |number, leaf| {
        let place = |index, uniform| hierarchy.place(*leaf, index, uniform);
        let sequence = SobolSequence::new(visibility.seed, OF_LIGHT + number as u64);
        let samples = (0..FEW_SAMPLES).map(|index| {
            let at = place(index, sequence.point(index, 0));
            let by = |light: usize| {
                let purpose = 1 + visibility.world.appearance.sources[light].0 as u64;
                sampler.brought(at, light, sequence.point(index, purpose))
            };
            (0..lights).map(by).fold(Channels::ZERO, |sum, light| sum + light)
        });
        LightSums::default().with(samples).light()
    });
    let around = around(hierarchy, leaves, &light);
    // What is of little importance may have larger errors.
    let worth = |number: usize, samples: u32| (f64::from(samples) * importance(leaves[number]).powi(2)).ceil() as u32;
    let needed = needed_samples(hierarchy.nodes.len(), &around, &light);
    let is_unsure = |number: &usize| worth(*number, needed[*number]) > FEW_SAMPLES;
    let unsure = (0..leaves.len()).filter(is_unsure).count();
    let most = (SAMPLES / (unsure * lights).max(1)).clamp(FEW_SAMPLES as usize, MOST_SAMPLES as usize) as u32;
    let lights = lights as u32;
    let mut neighbourhoods = vec![Vec::new(); hierarchy.nodes.len()];
    around.iter().enumerate().for_each(|(number, around)| neighbourhoods[*around].push(number));
    neighbourhoods.retain(|numbers| numbers.iter().any(&is_unsure));
    let guided = visibility.map(&neighbourhoods, |_, numbers| {
        let guide = sampler.guide(leaves, numbers);
        let with = |sums: LightSums, number: usize, range: Range<u32>| {
            let samples = sampler.samples(&guide, leaves[number], OF_GUIDED + number as u64, range);
            sums.with(samples.map(|(sample, light)| light * sample.weight))
        };
        // A few guided samples tell how many of them are needed.
        let few = FEW_SAMPLES * lights;
        let sums: Vec<LightSums> = numbers.iter().map(|number| with(LightSums::default(), *number, 0..few)).collect();
        let guided: Vec<RandomLight> = sums.iter().map(LightSums::light).collect();
        let needed = needed_samples(1, &vec![0; numbers.len()], &guided);
        let all = |((number, sums), needed): ((&usize, LightSums), u32)| {
            let count = worth(*number, needed.min(most * lights)).max(few);
            (*number, with(sums, *number, few..count).light())
        };
        let all = numbers.iter().zip(sums).zip(needed).map(all);
        all.filter(|(number, _)| is_unsure(number)).collect::<Vec<(usize, RandomLight)>>()
    });
    for (number, guided) in guided.into_iter().flatten() {
        light[number] = guided;
    }
    light
}

/// Takes light samples at random points of leaves.
struct LeafSampler<'s, 'a> {
    visibility: &'s VisibilityTester<'a>,
    hierarchy: &'s Hierarchy,
    shadows: bool,
}

impl LeafSampler<'_, '_> {
    /// What a light sample brings straight to a place, W/m²; nothing through an opening.
    fn brought(&self, place: [glam::DVec3; 2], light: usize, uniform: [f64; 2]) -> Channels {
        let found = self.visibility.sample_light(place, light, uniform, self.shadows);
        let is_counted = |towards, distance| {
            let ray = Ray { origin: place[0], direction: towards };
            !self.shadows || !self.visibility.openings.are_crossed(&ray, distance)
        };
        match found {
            Some(light) if is_counted(light.towards, light.distance) => light.irradiance,
            _ => Channels::ZERO,
        }
    }

    /// Samples of a leaf by a guide, with what each brings, to be weighted.
    fn samples<'s>(
        &'s self,
        guide: &'s SampleGuide,
        leaf: u32,
        number: u64,
        range: Range<u32>,
    ) -> impl Iterator<Item = (GuidedSample, Channels)> + 's {
        let sequence = SobolSequence::new(self.visibility.seed, number);
        range.map(move |index| {
            let place = self.hierarchy.place(leaf, index, sequence.point(index, 0));
            let [u, v] = sequence.point(index, 2);
            let sample = guide.sample([sequence.number(index, 1), u, v]);
            (sample, self.brought(place, sample.light, sample.uniform))
        })
    }

    /// Where light comes from to some leaves, as a few samples of each tell.
    ///
    /// - `numbers`: of the leaves.
    fn guide(&self, leaves: &[u32], numbers: &[usize]) -> SampleGuide {
        let sources = &self.visibility.world.appearance.sources;
        let side = if sources.iter().all(|(_, source)| source.is_delta()) { 1 } else { SIDE };
        let even = SampleGuide::even(sources.len(), side);
        let count = FEW_SAMPLES * sources.len() as u32;
        let of = |number: &usize| self.samples(&even, leaves[*number], OF_PILOT + *number as u64, 0..count);
        let found = numbers.iter().flat_map(of).map(|(sample, light)| (sample, light.0.iter().sum()));
        even.guided(found)
    }
}

/// For each leaf, the node that is its neighbourhood.
fn around(hierarchy: &Hierarchy, leaves: &[u32], few: &[RandomLight]) -> Vec<usize> {
    // Of each node: leaves, and samples that brought light.
    let mut counts = vec![(0, 0); hierarchy.nodes.len()];
    leaves.iter().zip(few).for_each(|(leaf, light)| counts[*leaf as usize] = (1, light.lit));
    hierarchy.add_up(&mut counts, |a, b| (a.0 + b.0, a.1 + b.1));
    let around = hierarchy.neighbourhoods(|node| {
        let (leaves, lit) = counts[node];
        leaves >= MOST_NEIGHBOURS || (leaves >= NEIGHBOURS && lit >= LIT_SAMPLES)
    });
    leaves.iter().map(|leaf| around[*leaf as usize]).collect()
}

/// How many light samples each leaf needs, as few of its neighbours tell: if its own told, those by chance too dark
/// would stay so.
///
/// - `nodes`: how many there are. `around`: for each leaf, the node that is its neighbourhood.
fn needed_samples(nodes: usize, around: &[usize], few: &[RandomLight]) -> Vec<u32> {
    // Of each neighbourhood: irradiances, variances of one sample, and how many leaves.
    let mut sums = vec![[0.0; 3]; nodes];
    let own = |light: &RandomLight| [light.total(), light.variance * f64::from(light.samples), 1.0];
    for (around, light) in around.iter().zip(few) {
        sums[*around].iter_mut().zip(own(light)).for_each(|(sum, value)| *sum += value);
    }
    let of = |(around, light): (&usize, &RandomLight)| {
        let (all, own) = (sums[*around], own(light));
        let [irradiance, variance, count] = std::array::from_fn(|i| all[i] - own[i]);
        let needed = variance * count / (irradiance * irradiance * SAMPLED_ERROR * SAMPLED_ERROR);
        if needed.is_finite() { needed.ceil() as u32 } else { 0 }
    };
    around.iter().zip(few).map(of).collect()
}
