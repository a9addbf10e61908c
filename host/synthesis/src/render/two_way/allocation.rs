//! Allocates photon paths to lamps and their photon targets.
//!
//! What a lamp sends to each target is found for each lamp by itself; only how many paths it gets depends on the
//! others. Where other lamps change, its paths thus stay the same, though there may be fewer or more of them.

use super::photon_source::{PhotonSource, PhotonTarget};
use super::photon_tracing::{PhotonDimension, PhotonSampler};
use super::projection_map::{BoundingSphere, ProjectionMap};
use super::{PathBatch, PhotonMapper};
use crate::render::world::World;
use rayon::prelude::*;

/// Photon paths that are traced first, to see where light goes: an eighth of those of a pass, within limits.
const PILOT: std::ops::RangeInclusive<u32> = 1 << 12..=1 << 14;
/// Number of the pass for which they are traced.
const PILOT_PASS: u64 = u64::MAX;
/// The least of them for each lamp and bounding sphere.
const LEAST_PILOT: u32 = 32;
/// Paths of a lamp to a bounding sphere, at the least, as a part of the mean of all, however few photons they stored.
const LEAST_PART: f64 = 0.05;
/// A spot of which the cosine of the half angle is above this has all of its cone for a target, too.
const NARROW: f64 = 0.9;

/// Result of some paths from a lamp to a bounding sphere.
struct PilotResult {
    /// Flux, W.
    stored: f64,
    /// The root mean square of what a path adds to it. With paths in proportion to this, noise is least in all
    /// together.
    ///
    /// # Source
    /// Neyman 1934, optimal allocation.
    deviation: f64,
    /// The cells of the target that are worth photons.
    map: ProjectionMap,
}

impl PhotonMapper<'_> {
    /// How many paths from each of so many lamps, and to each of so many bounding spheres, are traced first.
    pub(super) fn pilot_paths(photons: u32, lamps: usize, spheres: usize) -> u32 {
        let pilot = (photons / 8).clamp(*PILOT.start(), *PILOT.end());
        // One lamp more or less seldom changes what the others get.
        let each = pilot >> lamps.next_power_of_two().trailing_zeros().min(31);
        (each / spheres as u32).max(LEAST_PILOT)
    }

    /// Allocates the paths to lamps and bounding spheres, by what some of them stored.
    ///
    /// - `lamps`: indices into the sources. `everything`: the bounding sphere around what scatters broadly; none if
    ///   nothing does.
    pub(super) fn allocate_paths(&mut self, world: &World<'_>, lamps: &[usize], everything: Option<BoundingSphere>) {
        let photons = world.appearance.prepared.settings.photons.count;
        let wide = everything.map(|sphere| {
            self.spheres.push(sphere);
            self.spheres.len() - 1
        });
        let all = self.spheres.len();
        for lamp in lamps {
            let mut spheres: Vec<usize> = (0..all).collect();
            // In the cone of a spot, however thin it is.
            let cone = world.appearance.sources[*lamp].1.cone().filter(|(.., cosine)| *cosine > NARROW);
            if let Some((at, axis, cosine)) = cone {
                let far = world.appearance.prepared.bounds.diagonal();
                spheres.push(self.spheres.len());
                self.spheres.push(BoundingSphere::in_cone(at, axis * far, cosine));
            }
            let (part, count) =
                (1.0 / spheres.len() as f64, PhotonMapper::pilot_paths(photons, lamps.len(), spheres.len()));
            let targets = spheres
                .into_iter()
                .map(|sphere| PhotonTarget { sphere, part, count, map: ProjectionMap::even() })
                .collect();
            self.lamps.push(PhotonSource { source: *lamp, targets, stored_flux: None, name: None });
        }
        let chunks = (0..self.lamps.len())
            .flat_map(|lamp| (0..self.lamps[lamp].targets.len()).map(move |target| (lamp, target)));
        let chunks: Vec<PathBatch> = chunks.map(|(lamp, target)| PathBatch { lamp, target, number: 0 }).collect();
        let found: Vec<PilotResult> = chunks.par_iter().map(|chunk| self.trace_pilot(world, chunk, wide)).collect();
        let all: f64 = found.iter().map(|explored| explored.deviation).sum();
        if all <= 0.0 {
            self.lamps.clear();
            return;
        }
        let mut found = found.into_iter();
        let mut shares: Vec<f64> = Vec::with_capacity(self.lamps.len());
        for lamp in &mut self.lamps {
            let found: Vec<PilotResult> = found.by_ref().take(lamp.targets.len()).collect();
            let deviation: f64 = found.iter().map(|explored| explored.deviation).sum();
            lamp.stored_flux = Some(found.iter().map(|explored| explored.stored).sum()).filter(|flux| *flux > 0.0);
            let least = LEAST_PART / found.len() as f64;
            let part = |explored: &PilotResult| (explored.deviation / deviation.max(f64::MIN_POSITIVE)).max(least);
            let sum: f64 = found.iter().map(part).sum();
            for (target, explored) in lamp.targets.iter_mut().zip(found) {
                (target.part, target.map) = (part(&explored) / sum, explored.map);
            }
            shares.push((deviation / all).max(LEAST_PART / lamps.len() as f64));
        }
        let sum: f64 = shares.iter().sum();
        for (lamp, share) in self.lamps.iter_mut().zip(shares) {
            for target in &mut lamp.targets {
                target.count = (target.part * share / sum * f64::from(photons)).ceil() as u32;
            }
        }
    }

    /// Traces some paths from a lamp to a bounding sphere: what they store, and which cells are worth photons.
    fn trace_pilot(&self, world: &World<'_>, chunk: &PathBatch, wide: Option<usize>) -> PilotResult {
        let PhotonTarget { sphere, count, part, .. } = self.lamps[chunk.lamp].targets[chunk.target];
        let mut used = Vec::new();
        let (mut sum, mut squares) = (0.0, 0.0);
        for index in 0..count {
            let balance = self.trace_batch(world, PILOT_PASS, chunk, index..index + 1).balance;
            // What goes everywhere is of use everywhere: what little of it is found tells too little.
            let is_of_use = if Some(sphere) == wide { balance.sent > 0.0 } else { balance.stored > 0.0 };
            if is_of_use {
                let sampler = PhotonSampler::new(self.sequence(world, PILOT_PASS, chunk), index);
                used.push(sampler.point(PhotonDimension::Aim, 0));
            }
            sum += balance.stored;
            squares += balance.stored * balance.stored;
        }
        let count = f64::from(count);
        PilotResult {
            stored: part * sum / count,
            deviation: part * (squares / count).sqrt(),
            map: ProjectionMap::around(&used),
        }
    }
}
