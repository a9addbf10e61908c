//! Places that are tried in turn, and of which those count that have room and are allowed.

use super::super::ShapeError;
use super::super::object::Scatter;
use super::standing::Standing;
use super::surface::{ScatterSurface, SurfacePlace};
use crate::illumination::texture::NumberTexture;
use crate::memory;
use crate::numeric::sampling::RandomStream;
use crate::octree::Instance;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// So many places are tried for each instance that is asked for, before those that were found are all.
const MOST_TRIES: usize = 200;
/// So many places are tried at once, at the least.
const BATCH: usize = 1 << 14;
/// Bytes of the number of a place that was found.
const NUMBER_BYTES: u64 = 8;
/// Bytes of a place that others keep away from.
const NEIGHBOUR_BYTES: u64 = 64;

/// The places that were found.
pub(in crate::scene) struct FoundPlaces {
    standing: Standing,
    surface: ScatterSurface,
    density: NumberTexture,
    slope: [f64; 2],
    height: [f64; 2],
    /// Their numbers.
    found: Vec<u64>,
    /// How many there should be.
    pub(in crate::scene) asked: usize,
}

impl FoundPlaces {
    /// Finds places; fewer than are asked for where there is no room for more.
    ///
    /// They do not depend on the number of threads. Cost: as the number of instances, by what of the surface counts.
    ///
    /// # Errors
    /// [`ShapeError`], if the surface cannot be tessellated, or for too little memory.
    pub(in crate::scene) fn new(
        scatter: &Scatter,
        scene_tolerance: Option<f64>,
        angle: f64,
    ) -> Result<FoundPlaces, ShapeError> {
        let Scatter { on, count, distance, density, slope, height, .. } = scatter;
        let surface = ScatterSurface::new(on, density, scene_tolerance, angle)?;
        let standing = Standing::new(scatter);
        let count = if surface.areas.is_empty() || standing.places_nothing() { 0 } else { *count };
        let (density, slope, height) = (density.clone(), *slope, *height);
        let mut places =
            FoundPlaces { standing, surface, density, slope, height, found: Vec::new(), asked: scatter.count };
        places.find(count, *distance)?;
        Ok(places)
    }

    pub(in crate::scene) fn count(&self) -> usize {
        self.found.len()
    }

    /// An instance by its number.
    pub(in crate::scene) fn instance(&self, number: usize) -> Instance {
        let (SurfacePlace { at, normal, .. }, random) = self.place(self.found[number]);
        self.standing.instance(at, normal, DVec3::Y, random)
    }

    /// The place of a number, whether it counts or not, and what more is drawn for it.
    fn place(&self, number: u64) -> (SurfacePlace, RandomStream) {
        let mut random = RandomStream::new(self.standing.seed, number);
        let part = random.uniform();
        (self.surface.place(part, random.point()), random)
    }

    /// The point of a place, if slope, height and density let something be there.
    fn allowed(&self, number: u64) -> Option<DVec3> {
        let FoundPlaces { density, slope: [flattest, steepest], height: [lowest, highest], .. } = self;
        let (SurfacePlace { at, normal, footprint }, _) = self.place(number);
        let slope = normal.y.clamp(-1.0, 1.0).acos().to_degrees();
        let is_within = (*flattest..=*steepest).contains(&slope) && (*lowest..=*highest).contains(&at.y);
        // Numbers of its own, so that a place stays where it is when the density changes.
        let chance = || RandomStream::new(!self.standing.seed, number).uniform();
        (is_within && chance() < density.at(&footprint)).then_some(at)
    }

    /// Finds the places that count, in the order of their numbers.
    fn find(&mut self, count: usize, distance: f64) -> Result<(), ShapeError> {
        let bytes = NUMBER_BYTES + if distance > 0.0 { NEIGHBOUR_BYTES } else { 0 };
        memory::reserve(count as u64 * bytes, || format!("finding {count} places"))?;
        let most = count.saturating_mul(MOST_TRIES).saturating_add(BATCH);
        let (mut tried, mut found) = (0, Vec::with_capacity(count));
        let mut neighbours = Neighbours { distance, by_cell: FxHashMap::default() };
        while found.len() < count && tried < most {
            let next = tried + (count - found.len()).clamp(BATCH, 64 * BATCH);
            let allowed = |number: usize| Some((number as u64, self.allowed(number as u64)?));
            let batch: Vec<(u64, DVec3)> = (tried..next).into_par_iter().filter_map(allowed).collect();
            tried = next;
            found.extend(batch.into_iter().filter(|(_, at)| neighbours.take(*at)).map(|(number, _)| number));
        }
        found.truncate(count);
        self.found = found;
        Ok(())
    }
}

/// The places so far, by the cells of a grid.
struct Neighbours {
    distance: f64,
    by_cell: FxHashMap<[i64; 3], Vec<DVec3>>,
}

impl Neighbours {
    /// Takes a place, if none that was taken is nearer than the distance; says whether it did.
    fn take(&mut self, at: DVec3) -> bool {
        if self.distance <= 0.0 {
            return true;
        }
        let cell = (at / self.distance).floor().as_i64vec3().to_array();
        for offset in 0..27 {
            let near = [offset % 3, offset / 3 % 3, offset / 9];
            let near: [i64; 3] = std::array::from_fn(|axis| cell[axis].saturating_add(near[axis] - 1));
            let is_near = |other: &DVec3| other.distance_squared(at) < self.distance * self.distance;
            if self.by_cell.get(&near).is_some_and(|all| all.iter().any(is_near)) {
                return false;
            }
        }
        self.by_cell.entry(cell).or_default().push(at);
        true
    }
}
