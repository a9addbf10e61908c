//! The correction of regions: what large parts of a scene exchange, as rays tell it.
//!
//! A link is kept where its error is small, but small errors of one sign add up: of two nodes that see little of each
//! other through an opening, a few rays mostly tell that they see nothing. Rays from all leaves know without such errors
//! what large regions exchange, though not what elements do. So the irradiance of all leaves of a region is multiplied by
//! one factor: with it, regions receive what rays tell that they receive of each other.
//!
//! A ray from leaf i to leaf j tells of the exchange of both: with n(i) rays from one and n(j) from the other, A F is
//! estimated as the count of rays either way over n(i) / A(i) + n(j) / A(j), which is the balance heuristic. What then
//! lacks in a row, or is too much, a leaf exchanges with itself, so that the exchange stays symmetric and no light is
//! lost where nothing escapes.
//!
//! # Source
//! Aggregation and disaggregation: Chatelin and Miranker 1982. The balance heuristic: Veach and Guibas 1995.

use super::enclosures::EnclosureTree;
use super::exchange::{LeafVisibility, OpeningExchange};
use super::hierarchy::Hierarchy;
use super::node::NONE;
use super::regions::{self, FluxEstimate, Regions};
use crate::color::{Channels, LANES};
use rustc_hash::FxHashMap as HashMap;

/// No factor is greater than this, or less than one over it.
const MOST_FACTOR: f64 = 4.0;
/// Sweeps of the solver at the most, and the greatest change that ends them.
const MOST_SWEEPS: u32 = 1000;
const CONVERGED: f64 = 1e-7;
/// So many times what chance explains of a difference within a region is taken from it.
const CAUTION: f64 = 2.0;
/// Mirrored rays over which light by mirrors is a mean.
const MIRRORED_RAYS: u64 = 128;
/// What a leaf sees counts as no smaller part of all, where a mean is taken over it.
const LEAST_SEEN_PART: f64 = 0.1;

/// What is known of each leaf, in the order of the leaves.
pub(super) struct LeafLight<'a> {
    /// What it sends without the light of other elements, W/m².
    pub(super) first: &'a [Channels],
    pub(super) reflectance: &'a [Channels],
    /// Irradiance by other elements, W/m².
    pub(super) irradiance: &'a [Channels],
    /// Of what leaves exchange through openings, how much more than in the mean each of the two sends where the ray ends;
    /// empty where that is not known.
    pub(super) brightness: &'a [[f64; 2]],
}

/// Factors by which rays correct the irradiance of leaves.
#[derive(Clone, Debug, Default)]
pub(super) struct RegionCorrection {
    /// For each leaf, the factor of its irradiance by other elements.
    pub(super) factor: Vec<Channels>,
    /// How far fluxes changed: the sum of all changes over the sum of all fluxes.
    pub(super) change: f64,
    /// The standard error of the flux that all leaves receive from each other, as a part of it.
    pub(super) standard_error: f64,
}

/// What one region receives from another.
#[derive(Clone, Copy, Default)]
struct RegionExchange {
    /// Flux of what is sent without the light of other elements, and of what is reflected of that: W.
    first: Channels,
    reflected: Channels,
}

impl RegionCorrection {
    /// - `leaves`: their nodes. `visibility`: what rays from them hit.
    pub(super) fn new(
        hierarchy: &Hierarchy,
        leaves: &[u32],
        visibility: &LeafVisibility,
        light: &LeafLight<'_>,
    ) -> RegionCorrection {
        let areas: Vec<f64> = leaves.iter().map(|leaf| hierarchy.nodes[*leaf as usize].area).collect();
        let tree = EnclosureTree::new(hierarchy, leaves, &visibility.enclosures);
        let regions = Regions::new(&tree, leaves, &flux_estimates(&areas, visibility, light));
        let region = &regions.of_leaves;
        let mut system = RegionSystem {
            pairs: exchange(&areas, region, visibility, light),
            received: vec![Channels::ZERO; regions.count],
            mirrored_sky: vec![Channels::ZERO; regions.count],
        };
        for (i, region) in region.iter().enumerate().filter(|(i, _)| !visibility.is_dark[*i]) {
            system.received[*region] += light.irradiance[i] * areas[i];
            system.mirrored_sky[*region] += visibility.mirrored_sky[i].irradiance * areas[i];
        }
        let factors = system.solve();
        let total =
            |of: &dyn Fn(usize) -> Channels| -> f64 { (0..factors.len()).map(|i| of(i).0.iter().sum::<f64>()).sum() };
        let all = total(&|i| system.received[i]);
        let change = total(&|i| system.received[i] * (factors[i] - Channels::ONE).map(f64::abs));
        let factor = region.iter().map(|region| factors[*region]);
        // Within regions, what rays tell of parts of them.
        let irradiance: Vec<Channels> =
            light.irradiance.iter().zip(factor.clone()).map(|(light, factor)| *light * factor).collect();
        let estimates = flux_estimates(&areas, visibility, &LeafLight { irradiance: &irradiance, ..*light });
        let own = regions::factors(&tree, leaves, &estimates, CAUTION);
        RegionCorrection {
            factor: factor.zip(own).map(|(factor, own)| factor * own).collect(),
            change: if all > 0.0 { change / all } else { 0.0 },
            standard_error: regions.all.relative_error(),
        }
    }
}

/// The irradiance of leaves by what mirrors show them of others and of skies, as their rays tell it, where that is more
/// than what comes straight from others: factors would have little to multiply there. None if that is nowhere.
///
/// It is the mean over so large a part of the scene that chance is little.
///
/// - `leaves`: their nodes. `visibility`: what rays from them hit.
pub(super) fn mirrored_irradiance(
    hierarchy: &Hierarchy,
    leaves: &[u32],
    visibility: &LeafVisibility,
    light: &LeafLight<'_>,
) -> Option<Vec<Channels>> {
    let is_mirrored = |i: usize| visibility.mirrored_part[i] > 0.0 || visibility.mirrored_sky[i].rays > 0;
    if !(0..leaves.len()).any(is_mirrored) {
        return None;
    }
    let nodes = &hierarchy.nodes;
    // Of each node: flux by mirrors and straight from others, the area that receives it, and rays that tell of it.
    let mut sums = vec![(Channels::ZERO, Channels::ZERO, 0.0, 0); nodes.len()];
    for (i, leaf) in leaves.iter().enumerate().filter(|(i, _)| !visibility.is_dark[*i]) {
        let area = nodes[*leaf as usize].area;
        let (mut flux, mut rays) = (visibility.mirrored_sky[i].irradiance * area, visibility.mirrored_sky[i].rays);
        for hit in visibility.hits_of(i).iter().filter(|hit| hit.is_mirrored && hit.leaf != NONE) {
            let from = hit.leaf as usize;
            let sent = light.first[from] + light.reflectance[from] * light.irradiance[from];
            flux += sent * (area * f64::from(hit.transmittance) / visibility.rays[i].len() as f64);
            rays += 1;
        }
        sums[*leaf as usize] = (flux, light.irradiance[i] * area, area, rays);
    }
    hierarchy.add_up(&mut sums, |a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2, a.3 + b.3));
    let around = hierarchy.neighbourhoods(|node| sums[node].3 >= MIRRORED_RAYS);
    let of = |(i, leaf): (usize, &u32)| match sums[around[*leaf as usize]] {
        (flux, straight, area, _) if flux.max() > straight.max() && !visibility.is_dark[i] => flux * area.recip(),
        _ => Channels::ZERO,
    };
    let irradiance: Vec<Channels> = leaves.iter().enumerate().map(of).collect();
    irradiance.iter().any(|light| *light != Channels::ZERO).then_some(irradiance)
}

/// Calls a function with all exchange that rays found, both ways: the leaf that receives, that which sends, A F, and how
/// much more than in the mean it sends there.
fn for_each_exchange(
    areas: &[f64],
    visibility: &LeafVisibility,
    brightness: &[[f64; 2]],
    mut f: impl FnMut(usize, usize, f64, f64),
) {
    for (number, OpeningExchange { link, .. }) in visibility.through_openings.iter().enumerate() {
        let [of_a, of_b] = brightness.get(number).copied().unwrap_or([1.0; 2]);
        f(link.a as usize, link.b as usize, link.exchange, of_b);
        f(link.b as usize, link.a as usize, link.exchange, of_a);
    }
    // Rays for each unit of area.
    let density: Vec<f64> = areas.iter().zip(&visibility.rays).map(|(area, rays)| rays.len() as f64 / area).collect();
    for i in (0..areas.len()).filter(|i| !visibility.is_dark[*i]) {
        for hit in visibility.hits_of(i).iter().filter(|hit| hit.leaf != NONE && !hit.through_opening) {
            let j = hit.leaf as usize;
            let exchange = f64::from(hit.transmittance) / (density[i] + density[j]);
            f(i, j, exchange, 1.0);
            f(j, i, exchange, 1.0);
        }
    }
}

/// What each leaf receives of others.
///
/// Rays tell how much more or less than the mean that elements have is sent by what each leaf sees: where all send the
/// same, chance tells nothing.
pub(super) fn flux_estimates(areas: &[f64], visibility: &LeafVisibility, light: &LeafLight<'_>) -> Vec<FluxEstimate> {
    let total = |channels: Channels| channels.0.iter().sum::<f64>();
    let sent: Vec<f64> =
        (0..areas.len()).map(|i| total(light.first[i] + light.reflectance[i] * light.irradiance[i])).collect();
    let received: Vec<f64> = light.irradiance.iter().map(|irradiance| total(*irradiance)).collect();
    // The mean of what is sent by all that a leaf sees.
    let mean = |i: usize| {
        let row = if visibility.seen_part[i] < 1.0 { visibility.row[i] } else { 1.0 };
        received[i] / row.clamp(LEAST_SEEN_PART, 1.0)
    };
    let mean: Vec<f64> = (0..areas.len()).map(mean).collect();
    let known = |i: usize| FluxEstimate {
        by_elements: areas[i] * received[i],
        by_rays: areas[i] * (mean[i] * visibility.part(i) + total(visibility.mirrored_sky[i].irradiance)),
        variance: areas[i] * areas[i] * visibility.mirrored_sky[i].variance,
        rays: 0,
    };
    let mut estimates: Vec<FluxEstimate> = (0..areas.len()).map(known).collect();
    for_each_exchange(areas, visibility, light.brightness, |to, from, exchange, brightness| {
        let flux = (brightness * sent[from] - mean[to]) * exchange;
        estimates[to].by_rays += flux;
        estimates[to].variance += flux * flux;
        estimates[to].rays += 1;
    });
    for (estimate, _) in estimates.iter_mut().zip(&visibility.is_dark).filter(|(_, is_dark)| **is_dark) {
        *estimate = FluxEstimate::default();
    }
    estimates
}

/// What regions exchange by all rays: the region that receives, that which sends, and how much; in the order in which
/// rays found them.
fn exchange(
    areas: &[f64],
    region: &[usize],
    visibility: &LeafVisibility,
    light: &LeafLight<'_>,
) -> Vec<([usize; 2], RegionExchange)> {
    let mut pairs: Vec<([usize; 2], RegionExchange)> = Vec::new();
    let mut place_of: HashMap<[usize; 2], usize> = HashMap::default();
    let mut row: Vec<f64> = areas.iter().enumerate().map(|(i, area)| area * visibility.part(i)).collect();
    let mut add = |to: usize, from: usize, exchange: f64, brightness: f64| {
        let key = [region[to], region[from]];
        let place = *place_of.entry(key).or_insert_with(|| {
            pairs.push((key, RegionExchange::default()));
            pairs.len() - 1
        });
        let pair = &mut pairs[place].1;
        pair.first += light.first[from] * (brightness * exchange);
        pair.reflected += light.reflectance[from] * light.irradiance[from] * (brightness * exchange);
    };
    for_each_exchange(areas, visibility, light.brightness, |to, from, exchange, brightness| {
        row[to] -= exchange;
        add(to, from, exchange, brightness);
    });
    // What rays found too little or too much.
    for (i, missing) in row.into_iter().enumerate().filter(|(i, _)| !visibility.is_dark[*i]) {
        add(i, i, missing, 1.0);
    }
    pairs
}

/// The equations of regions: what each receives is a factor times what it received before.
struct RegionSystem {
    pairs: Vec<([usize; 2], RegionExchange)>,
    /// What each receives before the correction, and what mirrors show it of skies: W.
    received: Vec<Channels>,
    mirrored_sky: Vec<Channels>,
}

impl RegionSystem {
    /// The factors of all regions.
    fn solve(&self) -> Vec<Channels> {
        let count = self.received.len();
        let mut rows: Vec<Vec<(usize, Channels)>> = vec![Vec::new(); count];
        let mut first = self.mirrored_sky.clone();
        for ([to, from], pair) in &self.pairs {
            first[*to] += pair.first;
            rows[*to].push((*from, pair.reflected));
        }
        let mut factors = vec![Channels::ONE; count];
        for _ in 0..MOST_SWEEPS {
            let mut change = 0.0f64;
            for to in 0..count {
                let flux = rows[to].iter().fold(first[to], |sum, (from, flux)| sum + *flux * factors[*from]);
                let next: [f64; LANES] = std::array::from_fn(|lane| match self.received[to].0[lane] {
                    received if received > 0.0 => (flux.0[lane] / received).clamp(MOST_FACTOR.recip(), MOST_FACTOR),
                    _ => 1.0,
                });
                change = change.max((Channels(next) - factors[to]).map(f64::abs).max());
                factors[to] = Channels(next);
            }
            if change < CONVERGED {
                break;
            }
        }
        factors
    }
}
