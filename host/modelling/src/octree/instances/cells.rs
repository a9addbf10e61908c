//! Instances in the cells of a grid, which are a function of the cell and stored nowhere.

use super::error::{InstanceError, MOST_CELLS, MOST_IN_CELL, MOST_OVERHANG};
use super::placement::Instance;
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use glam::{DVec2, DVec3};
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
    /// has none.
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
    grid: CellGrid,
    pub(super) source: Arc<dyn CellInstances>,
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
        Ok(Cells { grid, source })
    }

    /// The box around all that is placed.
    pub(super) fn bounds(&self) -> Bounds {
        let CellGrid { corner, overhang, heights: [low, high], .. } = self.grid;
        let (from, to) = (corner - overhang, self.far_corner() + overhang);
        Bounds { min: DVec3::new(from.x, low, from.y), max: DVec3::new(to.x, high, to.y) }
    }

    /// How many instances there are at the most.
    pub(super) fn count(&self) -> usize {
        let [x, z] = self.grid.cells.map(|cells| cells as usize);
        (x * z).saturating_mul(self.source.count() as usize)
    }

    fn far_corner(&self) -> DVec2 {
        let CellGrid { cells: [x, z], corner, side, .. } = self.grid;
        corner + DVec2::new(f64::from(x), f64::from(z)) * side
    }

    /// How far from its place anything can be hit by a ray, rounding included.
    pub(super) fn reach(&self, ray: &Ray) -> f64 {
        let CellGrid { corner, overhang, .. } = self.grid;
        let largest = corner.abs().max(self.far_corner().abs()).max_element().max(ray.origin.abs().max_element());
        overhang + largest * ROUNDING
    }

    /// How far what is placed is from its place at the most, along x and z.
    pub(super) fn overhang(&self) -> f64 {
        self.grid.overhang
    }

    /// The least and the greatest y of what is placed.
    pub(super) fn heights(&self) -> [f64; 2] {
        self.grid.heights
    }

    /// The rows of cells along a ray, the nearer ones first; each cell is in one of them.
    pub(super) fn rows(&self, ray: &Ray, [t_min, t_max]: [f64; 2]) -> impl Iterator<Item = CellRow> + '_ {
        let CellGrid { cells, corner, side, .. } = self.grid;
        let reach = self.reach(ray);
        let mut bounds = self.bounds();
        let margin = DVec3::splat(reach - self.grid.overhang);
        (bounds.min, bounds.max) = (bounds.min - margin, bounds.max + margin);
        let chord = ray.within(&bounds, [t_min, t_max]);
        let is_along_x = ray.direction.x.abs() >= ray.direction.z.abs();
        let (axes, corner) = if is_along_x { ([0, 2], corner.to_array()) } else { ([2, 0], [corner.y, corner.x]) };
        let counts = if is_along_x { cells } else { [cells[1], cells[0]] };
        let [(origin, rate), (beside, drift)] = axes.map(|axis| (ray.origin[axis], ray.direction[axis]));
        // The cells of an axis, what is placed by which comes into a part of it.
        let within = move |which: usize, one: f64, other: f64| -> Option<[u32; 2]> {
            let from = ((one.min(other) - reach - corner[which]) / side).floor().max(0.0);
            let to = ((one.max(other) + reach - corner[which]) / side).floor().min(f64::from(counts[which]) - 1.0);
            (from <= to).then_some([from as u32, to as u32])
        };
        let along = chord.and_then(|[from, to]| within(0, origin + rate * from, origin + rate * to));
        let [first, last] = along.unwrap_or([1, 0]);
        let count = if along.is_some() { last - first + 1 } else { 0 };
        (0..count).filter_map(move |step| {
            let [from, to] = chord?;
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
            let [least, most] = within(1, beside + drift * enter, beside + drift * exit)?;
            Some(CellRow { along, across: least..=most, is_along_x, enter, exit })
        })
    }

    /// An instance by its number; none if there is none.
    pub(super) fn instance(&self, number: u64) -> Option<Instance> {
        let (cell, own) = cell_of(number);
        let is_within = cell.iter().zip(&self.grid.cells).all(|(at, cells)| at < cells) && own < self.source.count();
        is_within.then(|| self.source.instance(cell, own)).flatten()
    }
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
