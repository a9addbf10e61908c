//! What the surface of a terrain is: lattices, how fine they are wanted, heights and their bounds.

use super::super::error::TerrainError;
use super::super::field::HeightField;
use super::super::parameters::in_range;
use glam::{DVec2, DVec3};

/// Cells along a side of a block.
pub(super) const SIDE: usize = 16;
/// Most levels of lattices.
const MOST_LEVELS: u32 = 44;
/// So many cells in a cell of the finest octave are enough: all of it is left at their footprint.
const FINEST: f64 = 5.0;
/// How far from the middle of a cell the control heights are that the surface over it is made of on finer lattices, in
/// sides of the cell: half a diagonal, and half a side of the next finer cells beyond.
const REACH: f64 = 1.07;

/// From where a terrain is seen, and how wide its cells are to be then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundView {
    /// An eye.
    Eye {
        /// Where it is.
        at: DVec3,
        /// Width of cells at a distance of 1, above 0.
        spacing: f64,
    },
    /// All places alike.
    Everywhere {
        /// Width of cells, units of length, above 0.
        spacing: f64,
    },
}

/// The definition of the surface.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    field: HeightField,
    views: Vec<GroundView>,
    corner: DVec2,
    /// Side of a cell of the coarsest lattice.
    spacing: f64,
    /// Number of the finest lattice, from 0.
    pub(super) finest: u32,
}

/// A control height: what is known of the surface at a point of a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Control {
    pub(super) height: f64,
    /// How wide cells are to be there.
    pub(super) wanted: f32,
}

impl Ground {
    /// # Errors
    /// [`TerrainError`] for a view whose numbers are out of range.
    pub(super) fn new(field: HeightField, views: Vec<GroundView>) -> Result<Ground, TerrainError> {
        for view in &views {
            let (spacing, is_placed) = match view {
                GroundView::Eye { at, spacing } => (*spacing, at.is_finite()),
                GroundView::Everywhere { spacing } => (*spacing, true),
            };
            in_range("spacing", spacing, [f64::MIN_POSITIVE, f64::MAX])?;
            if !is_placed {
                return Err(TerrainError::NotFinite);
            }
        }
        let [from, to] = field.region();
        let spacing = (to - from).max_element() / SIDE as f64;
        let levels = (spacing / field.finest_cell() * FINEST).log2().ceil();
        let finest = levels.clamp(0.0, f64::from(MOST_LEVELS)) as u32;
        Ok(Ground { field, views, corner: from, spacing, finest })
    }

    pub(super) fn field(&self) -> &HeightField {
        &self.field
    }

    /// Side of the cells of a lattice.
    pub(super) fn spacing(&self, level: u32) -> f64 {
        self.spacing / (1_u64 << level) as f64
    }

    /// The lower corner of a cell.
    pub(super) fn corner_of(&self, level: u32, cell: [i64; 2]) -> DVec2 {
        self.corner + DVec2::new(cell[0] as f64, cell[1] as f64) * self.spacing(level)
    }

    fn middle_of(&self, level: u32, cell: [i64; 2]) -> DVec2 {
        self.corner_of(level, cell) + 0.5 * self.spacing(level)
    }

    /// A control height of the coarsest lattice.
    pub(super) fn coarsest(&self, cell: [i64; 2]) -> Control {
        let at = self.middle_of(0, cell);
        let height = self.field.height(at, self.spacing);
        Control { height, wanted: self.wanted(at, height) as f32 }
    }

    /// A control height of a lattice.
    ///
    /// - `refined`: what corner cutting makes of the next coarser lattice.
    /// - `asked`: counts heights that the function was asked for.
    pub(super) fn finer(&self, level: u32, cell: [i64; 2], refined: Control, asked: &mut u64) -> Control {
        let at = self.middle_of(level, cell);
        let own = self.spacing(level);
        // Cells of the coarser lattice as wide as wanted: nothing is added; twice as wide: all.
        let coarseness = 2.0 * own / f64::from(refined.wanted) - 1.0;
        let mut height = refined.height;
        if coarseness > 0.0 {
            *asked += 1;
            let part = coarseness.min(1.0);
            height += (self.field.height(at, own) - height) * (part * part * (3.0 - 2.0 * part));
        }
        // Where the coarser lattice wants nothing finer, no finer one does: the surface is the same on both sides of
        // the edge of a cell that is not divided.
        let wanted = self.wanted(at, refined.height).max(0.5 * f64::from(refined.wanted));
        Control { height, wanted: wanted as f32 }
    }

    /// How wide cells are to be at a place.
    fn wanted(&self, at: DVec2, height: f64) -> f64 {
        let of = |view: &GroundView| match view {
            GroundView::Eye { at: eye, spacing } => spacing * eye.distance(DVec3::new(at.x, height, at.y)),
            GroundView::Everywhere { spacing } => *spacing,
        };
        self.views.iter().map(of).reduce(f64::min).unwrap_or(0.0)
    }

    /// Bounds of all control heights of finer lattices around a cell.
    ///
    /// - `middle`, `spacing`: of the cell.
    pub(super) fn bounds(&self, middle: DVec2, spacing: f64) -> [f64; 2] {
        // Octaves that are known over so wide a disc are there as a whole on all finer lattices; others may be there
        // in part, and are bounded by what they can be at the most.
        self.field.enclosure(middle, REACH * spacing, 0.0).range()
    }
}

/// What corner cutting makes of the control at a middle and those next to it.
///
/// - `of`: controls of the coarser lattice, by steps along x and z from the one nearest to the finer one.
/// - `towards`: on which side of that the finer one is, -1 or 1.
pub(super) fn refined(of: impl Fn(i64, i64) -> Control, [x, z]: [i64; 2]) -> Control {
    let (own, beside, behind, across) = (of(0, 0), of(x, 0), of(0, z), of(x, z));
    let height = (9.0 * own.height + 3.0 * (beside.height + behind.height) + across.height) / 16.0;
    let wanted = (9.0 * own.wanted + 3.0 * (beside.wanted + behind.wanted) + across.wanted) / 16.0;
    Control { height, wanted }
}
