//! Instances in the cells of a grid, which are a function of the cell and stored nowhere.

use super::aggregates::{AggregateView, Aggregates, MOST_AGGREGATE_LEVELS};
use super::error::{InstanceError, MOST_CELLS, MOST_IN_CELL, MOST_OVERHANG};
use super::placement::Instance;
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use glam::{DAffine3, DVec2, DVec3};
use std::fmt;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// What is computed of a ray is off by less than this part of the largest coordinate.
const ROUNDING: f64 = 1e-13;
/// Bits of a number within a cell, and of the number of a cell along an axis.
const NUMBER_BITS: u32 = 22;
const CELL_BITS: u32 = 21;

/// Instances that are a function of a cell and a number.
///
/// All answers are the same whenever they are asked for.
pub trait CellInstances: fmt::Debug + Send + Sync {
    /// How many there are in each cell at the most, up to [`MOST_IN_CELL`].
    fn count(&self) -> u32;

    /// Where the one of a number is, if there is one. It costs little: rays ask for it often.
    ///
    /// - `cell`: its number along x and z.
    fn place(&self, cell: [u32; 2], number: u32) -> CellPlace;

    /// The one of a number: a rotation and a scale of its prototype, whose origin is over that place; none where the cell
    /// has none. Where it is enlarged, it is about that place.
    fn instance(&self, cell: [u32; 2], number: u32) -> Option<Instance>;

    /// How often each prototype is placed on the whole, in any unit.
    fn shares(&self) -> &[f64];

    /// Adds all that tells where instances are to a checksum.
    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher);
}

/// Where an instance in a cell is, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellPlace {
    /// x and z.
    pub at: DVec2,
    /// Its size as a part of the largest, above 0 and up to 1: it reaches so much of the overhang, and of the heights, of
    /// its grid.
    pub part: f64,
}

/// Square cells side by side in the plane y = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellGrid {
    /// How many there are along x and z, at most [`MOST_CELLS`] each.
    pub cells: [u32; 2],
    /// The least x and z.
    pub corner: DVec2,
    /// Side of a cell, above 0.
    pub side: f64,
    /// How far what is placed is from its place at the most, along x and z; up to [`MOST_OVERHANG`] sides.
    pub overhang: f64,
    /// The least and the greatest y of what is placed.
    pub heights: [f64; 2],
}

/// The instances of a grid.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    pub(super) grid: CellGrid,
    pub(super) source: Arc<dyn CellInstances>,
    /// The number by which who knows the views knows them, if aggregates may stand in for them.
    pub(super) aggregates: Option<u32>,
}

/// Cells side by side that a ray comes to about at once.
pub(super) struct CellRow {
    /// Number along the axis along which the ray goes faster.
    along: u32,
    /// Those along the other one.
    across: RangeInclusive<u32>,
    is_along_x: bool,
    /// Nothing that they place is hit at a shorter length of the ray, nor at a longer one.
    pub(super) enter: f64,
    pub(super) exit: f64,
}

impl CellGrid {
    /// The box around all that is placed.
    fn bounds(&self) -> Bounds {
        let CellGrid { corner, overhang, heights: [low, high], .. } = *self;
        let (from, to) = (corner - overhang, self.far_corner() + overhang);
        Bounds { min: DVec3::new(from.x, low, from.y), max: DVec3::new(to.x, high, to.y) }
    }

    fn far_corner(&self) -> DVec2 {
        let CellGrid { cells: [x, z], corner, side, .. } = *self;
        corner + DVec2::new(f64::from(x), f64::from(z)) * side
    }

    /// The grid of a level of aggregates: cells 2^level times as large, in which things are enlarged up to so many
    /// times, or made smaller.
    pub(super) fn of_level(&self, level: u32, enlargement: f64) -> CellGrid {
        CellGrid {
            cells: self.cells.map(|cells| cells.div_ceil(1 << level)),
            side: self.side * f64::from(1_u32 << level),
            overhang: self.overhang * enlargement,
            heights: [self.heights[0].min(0.0) * enlargement, self.heights[1].max(0.0) * enlargement],
            ..*self
        }
    }

    /// How far off, at the most, what is computed of a ray is from where things are.
    pub(super) fn rounding(&self, ray: &Ray) -> f64 {
        let largest = self.corner.abs().max(self.far_corner().abs()).max_element().max(ray.origin.abs().max_element());
        largest * ROUNDING
    }

    /// The lengths of a ray within which it may hit anything.
    pub(super) fn chord(&self, ray: &Ray, limits: [f64; 2]) -> Option<[f64; 2]> {
        let Bounds { min, max } = self.bounds();
        let margin = self.rounding(ray);
        ray.within(&Bounds { min: min - margin, max: max + margin }, limits)
    }

    /// The rows of cells that a ray comes to between two lengths that are finite, by their numbers along the axis along
    /// which it goes faster.
    pub(super) fn rows_between(&self, ray: &Ray, [from, to]: [f64; 2]) -> Option<[u32; 2]> {
        let AlongRay { origin, rate, .. } = self.along(ray);
        self.along(ray).within(0, [origin[0] + rate[0] * from, origin[0] + rate[0] * to])
    }

    /// The rows of cells along a ray, the nearer ones first; each cell is in one of them.
    ///
    /// - `chord`: between which lengths, finite ones.
    pub(super) fn rows(&self, ray: &Ray, chord: [f64; 2]) -> impl Iterator<Item = CellRow> + use<> {
        let (line, side, [from, to]) = (self.along(ray), self.side, chord);
        let AlongRay { is_along_x, origin: [origin, beside], rate: [rate, drift], corner, reach, .. } = line;
        let along = self.rows_between(ray, chord);
        let [first, last] = along.unwrap_or([1, 0]);
        let count = if along.is_some() { last - first + 1 } else { 0 };
        (0..count).filter_map(move |step| {
            let along = if rate >= 0.0 { first + step } else { last - step };
            let low = corner[0] + f64::from(along) * side - reach;
            let [one, other] = [low, low + side + 2.0 * reach].map(|at| (at - origin) / rate);
            // Along a ray that goes down they are at any length.
            let (enter, exit) = match one.is_finite() && other.is_finite() {
                true => (one.min(other).max(from), one.max(other).min(to)),
                false => (from, to),
            };
            if enter > exit {
                return None;
            }
            let [least, most] = line.within(1, [beside + drift * enter, beside + drift * exit])?;
            Some(CellRow { along, across: least..=most, is_along_x, enter, exit })
        })
    }

    fn along(&self, ray: &Ray) -> AlongRay {
        let CellGrid { cells: [x, z], corner, side, overhang, .. } = *self;
        let is_along_x = ray.direction.x.abs() >= ray.direction.z.abs();
        let turned = |[x, z]: [f64; 2]| if is_along_x { [x, z] } else { [z, x] };
        AlongRay {
            is_along_x,
            origin: turned([ray.origin.x, ray.origin.z]),
            rate: turned([ray.direction.x, ray.direction.z]),
            corner: turned(corner.to_array()),
            cells: turned([f64::from(x), f64::from(z)]),
            side,
            reach: overhang + self.rounding(ray),
        }
    }
}

/// A ray and a grid, by the axis along which the ray goes faster and the other one.
#[derive(Clone, Copy)]
struct AlongRay {
    is_along_x: bool,
    origin: [f64; 2],
    rate: [f64; 2],
    corner: [f64; 2],
    cells: [f64; 2],
    side: f64,
    /// How far from its place anything can be hit by the ray, rounding included.
    reach: f64,
}

impl AlongRay {
    /// The cells of an axis, what is placed by which comes into a part of it.
    #[inline]
    fn within(&self, axis: usize, [one, other]: [f64; 2]) -> Option<[u32; 2]> {
        let at = |x: f64| ((x - self.corner[axis]) / self.side).floor();
        let from = at(one.min(other) - self.reach).max(0.0);
        let to = at(one.max(other) + self.reach).min(self.cells[axis] - 1.0);
        (from <= to).then_some([from as u32, to as u32])
    }
}

impl Cells {
    /// Checks the measures.
    ///
    /// # Errors
    /// [`InstanceError`], for those that are out of range.
    pub(super) fn new(grid: CellGrid, source: Arc<dyn CellInstances>) -> Result<Cells, InstanceError> {
        let CellGrid { cells, corner, side, overhang, heights: [low, high] } = grid;
        if cells.iter().any(|cells| *cells > MOST_CELLS) {
            return Err(InstanceError::TooManyCells { cells });
        }
        if source.count() > MOST_IN_CELL {
            return Err(InstanceError::TooManyInCell { instances: source.count() });
        }
        let is_finite = corner.is_finite() && (side * f64::from(MOST_CELLS)).is_finite() && side > 0.0;
        if !(is_finite && low.is_finite() && high.is_finite()) {
            return Err(InstanceError::NotFinite { instance: 0 });
        }
        // Written so that what is not a number is too wide.
        let is_narrow = overhang <= side * MOST_OVERHANG;
        if !is_narrow {
            return Err(InstanceError::SmallCells { overhang, side });
        }
        Ok(Cells { grid, source, aggregates: None })
    }

    /// The box around all that is placed, and around all that may stand in for it.
    pub(super) fn bounds(&self) -> Bounds {
        let own = self.grid.bounds();
        match self.aggregates {
            Some(_) => own.union(self.grid.of_level(0, f64::from(1_u32 << self.levels())).bounds()),
            None => own,
        }
    }

    /// How many levels of aggregates there are, if there are any: cells of the last one are no longer than the grid.
    fn levels(&self) -> u32 {
        let most = self.grid.cells[0].max(self.grid.cells[1]).max(1);
        MOST_AGGREGATE_LEVELS.min(most.ilog2())
    }

    /// How many instances there are at the most.
    pub(super) fn count(&self) -> usize {
        let [x, z] = self.grid.cells.map(|cells| cells as usize);
        (x * z).saturating_mul(self.source.count() as usize)
    }

    /// How they are seen; a grid of a single cell as it is.
    pub(super) fn seen_by<'v>(&self, views: &'v [AggregateView]) -> Aggregates<'v> {
        match self.levels() {
            0 => Aggregates::NONE,
            levels => Aggregates { views, levels },
        }
    }

    /// Whether there is a cell.
    #[inline]
    pub(super) fn has(&self, [x, z]: [u32; 2]) -> bool {
        x < self.grid.cells[0] && z < self.grid.cells[1]
    }

    /// An instance by its number; none if there is none.
    pub(super) fn instance(&self, number: u64) -> Option<Instance> {
        let (cell, own) = cell_of(number);
        let is_within = self.has(cell) && own < self.source.count();
        is_within.then(|| self.source.instance(cell, own)).flatten()
    }

    /// An instance by its number as it is seen; none if there is none, or something else stands in for it.
    pub(super) fn instance_seen(&self, number: u64, seen: &Aggregates<'_>) -> Option<Instance> {
        let (instance, (cell, own)) = (self.instance(number)?, cell_of(number));
        let CellPlace { at, .. } = self.source.place(cell, own);
        Some(resized(&instance, at, seen.size(at, cell, own, self.source.count())?))
    }
}

/// An instance enlarged or made smaller about its place.
#[inline]
pub(super) fn resized(instance: &Instance, at: DVec2, size: f64) -> Instance {
    if size == 1.0 {
        return *instance;
    }
    let (foot, DAffine3 { matrix3, translation }) = (DVec3::new(at.x, 0.0, at.y), instance.placement);
    let placement = DAffine3 { matrix3: matrix3 * size, translation: foot + (translation - foot) * size };
    Instance { placement, ..*instance }
}

impl CellRow {
    /// Their numbers along x and z.
    pub(super) fn cells(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let (along, is_along_x) = (self.along, self.is_along_x);
        self.across.clone().map(move |across| if is_along_x { [along, across] } else { [across, along] })
    }
}

/// The number of an instance among all of a grid.
pub(super) fn number_of([x, z]: [u32; 2], own: u32) -> u64 {
    (u64::from(x) << CELL_BITS | u64::from(z)) << NUMBER_BITS | u64::from(own)
}

fn cell_of(number: u64) -> ([u32; 2], u32) {
    let cell = number >> NUMBER_BITS;
    let mask = |bits: u32| (1_u64 << bits) - 1;
    ([(cell >> CELL_BITS) as u32, (cell & mask(CELL_BITS)) as u32], (number & mask(NUMBER_BITS)) as u32)
}
