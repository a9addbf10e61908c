//! Irradiance cache: light that diffuse surfaces send each other, gathered by rays at few places and interpolated.
//!
//! Records are placed on a grid over the picture that becomes finer where no record reaches: how far one reaches is a
//! part of the harmonic mean of the distances of what is around it, so that they are dense in corners and where bodies
//! touch. Records of one grid do not know of one another, so that no picture depends on the number of threads.
//!
//! # Source
//! Ward, Rubinstein and Clear 1988, a ray tracing solution for diffuse interreflection; weights that fall to 0 where a
//! record ends, and bounds in pixels, after Tabellion and Lamorlette 2004.

use crate::color::Channels;
use crate::render::RayCounts;
use crate::render::ray_tracing::{PathScratch, RayFinisher};
use crate::render::world::{BoundedRay, CameraRays, RayHit, SurfaceElement, World};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Cells of the coarsest grid along the longer side of the picture.
const COARSEST: usize = 24;
/// Pixels from one place of the finest grid to the next.
const FINEST: usize = 2;
/// The least and the most directions of a record; the most for each sample of a pixel.
const LEAST_DIRECTIONS: u32 = 16;
const MOST_DIRECTIONS: u32 = 1024;
const MOST_OF_SAMPLE: u32 = 16;
/// How far a record reaches, as a part of the harmonic mean distance.
const REACH: f64 = 0.3;
/// How far a record reaches at the least, pixels; and at the most, as a part of the diagonal of the scene.
const LEAST_PIXELS: f64 = 4.0;
const MOST_OF_SCENE: f64 = 0.05;
/// Cosine between normals at which a record ends.
const LEAST_COSINE: f64 = 0.95;
/// How far behind a record a place may be, as a part of its reach: what is around it, is not around the other.
const BEHIND: f64 = 0.15;
/// Sum of the weights of records that is enough.
const ENOUGH: f64 = 0.25;
/// Most passable surfaces before what is seen, on each of which records are placed.
const MOST_LAYERS: usize = 8;

/// A record: irradiance at a place.
#[derive(Clone, Copy, Debug)]
struct IrradianceRecord {
    position: DVec3,
    /// Unit length, on the side of the viewer.
    normal: DVec3,
    /// How far it reaches, scene units.
    reach: f64,
    irradiance: Channels,
    /// From how many directions it is known.
    directions: f64,
}

/// Where records are placed: what is seen of what.
pub(super) struct RecordPlaces<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) finisher: &'a RayFinisher<'a>,
    /// With cones that are a pixel wide.
    pub(super) eye: &'a CameraRays,
    /// Columns and rows of the picture.
    pub(super) size: [usize; 2],
    /// Whether a triangle needs the light of other surfaces.
    pub(super) needs: &'a (dyn Fn(u32) -> bool + Sync),
    /// Samples of a pixel.
    pub(super) samples: u32,
}

/// Records of irradiance, found by their places.
#[derive(Debug, Default)]
pub(super) struct IrradianceCache {
    records: Vec<IrradianceRecord>,
    /// The sides of cells are 2 to the power of a level, and reach at least twice as far as the records in them.
    cells: FxHashMap<(i32, [i64; 3]), Vec<u32>>,
    levels: Vec<i32>,
}

impl IrradianceCache {
    /// Gathers light for the surfaces that are seen; none if it was stopped.
    pub(super) fn new(
        places: &RecordPlaces<'_>,
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Option<(IrradianceCache, RayCounts)> {
        let [width, height] = places.size;
        let mut cache = IrradianceCache::default();
        let mut rays = RayCounts::default();
        let coarsest = (width.max(height) / COARSEST).max(1);
        let mut stride = 1 << coarsest.ilog2();
        let mut before = usize::MAX;
        while stride >= FINEST || before == usize::MAX {
            let is_new = |pixel: &[usize; 2]| before == usize::MAX || pixel.iter().any(|at| !at.is_multiple_of(before));
            let pixels: Vec<[usize; 2]> = (0..height)
                .step_by(stride)
                .flat_map(|row| (0..width).step_by(stride).map(move |column| [column, row]))
                .filter(is_new)
                .collect();
            let directions = directions(places.samples, stride);
            let at_pixel = |scratch: &mut PathScratch, pixel: &[usize; 2]| {
                let mut records = Vec::new();
                if !stopped() {
                    places.each(*pixel, |element, width| {
                        if cache.weights(element.position, element.normal) < ENOUGH {
                            records.push(places.record(*pixel, element, [width, f64::from(directions)], scratch));
                        }
                    });
                }
                (records, std::mem::take(&mut scratch.counts))
            };
            let found: Vec<(Vec<IrradianceRecord>, RayCounts)> =
                pixels.par_iter().map_init(PathScratch::default, at_pixel).collect();
            if stopped() {
                return None;
            }
            for (records, taken) in found {
                records.into_iter().for_each(|record| cache.insert(record));
                rays = rays + taken;
            }
            (before, stride) = (stride, stride / 2);
        }
        Some((cache, rays))
    }

    /// The irradiance at a place, interpolated; none where no record reaches.
    ///
    /// - `normal`: unit length, on the side of the viewer.
    pub(super) fn irradiance(&self, position: DVec3, normal: DVec3) -> Option<Channels> {
        let (mut sum, mut weights) = (Channels::ZERO, 0.0);
        self.each_near(position, normal, |record, weight| {
            // What more directions tell is as much more certain.
            sum += record.irradiance * (weight * record.directions);
            weights += weight * record.directions;
        });
        (weights > 0.0).then(|| sum * weights.recip())
    }

    /// The sum of the weights of the records that reach a place.
    fn weights(&self, position: DVec3, normal: DVec3) -> f64 {
        let mut weights = 0.0;
        self.each_near(position, normal, |_, weight| weights += weight);
        weights
    }

    /// Gives the records that reach a place, and their weights.
    fn each_near(&self, position: DVec3, normal: DVec3, mut give: impl FnMut(&IrradianceRecord, f64)) {
        for &level in &self.levels {
            // A record reaches half a cell at the most: those of eight cells may reach the place.
            let at = position / side(level) - DVec3::splat(0.5);
            for corner in 0..8_i64 {
                let cell = [at.x, at.y, at.z].map(|x| x.floor() as i64);
                let cell = [cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)];
                for &number in self.cells.get(&(level, cell)).into_iter().flatten() {
                    let record = &self.records[number as usize];
                    let weight = record.weight(position, normal);
                    if weight > 0.0 {
                        give(record, weight);
                    }
                }
            }
        }
    }

    fn insert(&mut self, record: IrradianceRecord) {
        let level = (2.0 * record.reach).log2().ceil() as i32;
        let cell = (record.position / side(level)).to_array().map(|x| x.floor() as i64);
        if let Err(place) = self.levels.binary_search(&level) {
            self.levels.insert(place, level);
        }
        self.cells.entry((level, cell)).or_default().push(self.records.len() as u32);
        self.records.push(record);
    }
}

impl IrradianceRecord {
    /// Its weight at a place: 1 at its own, 0 where it ends.
    fn weight(&self, position: DVec3, normal: DVec3) -> f64 {
        let away = position - self.position;
        let turned = ((1.0 - normal.dot(self.normal)).max(0.0) / (1.0 - LEAST_COSINE)).sqrt();
        let is_behind = away.dot(normal + self.normal) < -2.0 * BEHIND * self.reach;
        if is_behind { 0.0 } else { 1.0 - turned.max(away.length() / self.reach) }
    }
}

impl RecordPlaces<'_> {
    /// Gives the elements that are seen in the middle of a pixel and need the light of others, and how wide a pixel is
    /// there, scene units.
    fn each(&self, [column, row]: [usize; 2], mut give: impl FnMut(&SurfaceElement, f64)) {
        let Some(mut bounded) = self.eye.ray([column as f64 + 0.5, row as f64 + 0.5], [0.5; 2]) else { return };
        for _ in 0..MOST_LAYERS {
            let RayHit::Surface(interaction) = self.world.intersect(&bounded, 0, 0.0) else { return };
            if (self.needs)(interaction.triangle) {
                give(&interaction.element, bounded.cone.at(interaction.distance));
            }
            if !interaction.bsdf.is_passable() {
                return;
            }
            bounded = BoundedRay { t_min: interaction.t, ..bounded };
        }
    }

    /// A record at an element.
    ///
    /// - `width`: of a pixel there. `directions`: in how many it looks around.
    fn record(
        &self,
        [column, row]: [usize; 2],
        element: &SurfaceElement,
        [width, directions]: [f64; 2],
        scratch: &mut PathScratch,
    ) -> IrradianceRecord {
        let number = (row * self.size[0] + column) as u64;
        let found = self.finisher.irradiance(element, number, directions as u32, scratch);
        let most = MOST_OF_SCENE * self.world.prepared().bounds.diagonal();
        let reach = (REACH * found.distance).min(most).max(LEAST_PIXELS * width).max(f64::MIN_POSITIVE);
        let SurfaceElement { position, normal, .. } = *element;
        IrradianceRecord { position, normal, reach, irradiance: found.irradiance, directions }
    }
}

/// In how many directions a record looks around: in half as many as there are samples in the square of the grid for which
/// it stands, so that gathering never costs more than a part of what tracing all samples does.
///
/// - `samples`: of a pixel. `stride`: pixels from one place of the grid to the next.
pub(super) fn directions(samples: u32, stride: usize) -> u32 {
    let of_square = u64::from(samples) * (stride * stride) as u64 / 2;
    let most = samples.saturating_mul(MOST_OF_SAMPLE).clamp(LEAST_DIRECTIONS, MOST_DIRECTIONS);
    of_square.clamp(u64::from(LEAST_DIRECTIONS), u64::from(most)) as u32
}

/// The side of cells of a level.
fn side(level: i32) -> f64 {
    f64::from(level).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::sphere;
    use crate::numeric::sequence::SobolSequence;

    /// Records in a cube of side 2, some of which reach a hundred times as far as others.
    fn records() -> Vec<IrradianceRecord> {
        let sequence = SobolSequence::new(3, 0);
        let record = |index: u32| {
            let [[x, y], [z, reach]] = [1, 2].map(|purpose| sequence.point(index, purpose));
            let normal = sphere(sequence.point(index, 3));
            let position = DVec3::new(x, y, z) * 2.0 - DVec3::ONE;
            IrradianceRecord {
                position,
                normal,
                reach: 0.5 * 0.01_f64.powf(reach),
                irradiance: Channels::splat(x),
                directions: 1.0,
            }
        };
        (0..400).map(record).collect()
    }

    #[test]
    fn all_records_that_reach_a_place_are_found_and_no_others() {
        let mut cache = IrradianceCache::default();
        records().into_iter().for_each(|record| cache.insert(record));
        let mut all = 0;
        for of in records() {
            for step in [DVec3::ZERO, DVec3::splat(0.004), DVec3::new(-0.1, 0.07, 0.02)] {
                let position = of.position + step;
                let mut found = 0;
                cache.each_near(position, of.normal, |_, _| found += 1);
                let reach = |record: &&IrradianceRecord| record.weight(position, of.normal) > 0.0;
                assert_eq!(found, records().iter().filter(reach).count(), "{position}");
                all += found;
            }
        }
        assert!(all > 600, "{all}");
    }

    #[test]
    fn a_record_counts_most_at_its_place_and_nothing_beyond_its_reach_or_behind_it() {
        let irradiance = Channels::splat(2.0);
        let record =
            IrradianceRecord { position: DVec3::ONE, normal: DVec3::Z, reach: 0.5, irradiance, directions: 8.0 };
        let weight = |step: DVec3, normal: DVec3| record.weight(record.position + step, normal);
        assert_eq!(weight(DVec3::ZERO, DVec3::Z), 1.0);
        assert!((weight(DVec3::X * 0.25, DVec3::Z) - 0.5).abs() < 1e-12);
        assert!(weight(DVec3::X * 0.5, DVec3::Z) <= 0.0 && weight(DVec3::ZERO, DVec3::X) <= 0.0);
        assert!(weight(DVec3::Z * -0.1, DVec3::Z) <= 0.0 && weight(DVec3::Z * 0.1, DVec3::Z) > 0.7);
        let mut cache = IrradianceCache::default();
        cache.insert(record);
        assert_eq!(cache.irradiance(DVec3::new(1.2, 0.9, 1.0), DVec3::Z), Some(Channels::splat(2.0)));
        assert_eq!(cache.irradiance(DVec3::ZERO, DVec3::Z), None);
    }
}
