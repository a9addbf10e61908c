//! From triangles to terminal nodes: cells are divided as long as that saves work.

use glam::DVec3;
use rayon::prelude::*;

use super::clip::{Bounds, FAT, clipped_bounds};
use super::code::{LocationalCode, MAX_DEPTH};

/// A cell with more references than this shares the work on its eighths among threads.
const PARALLEL_REFERENCES: usize = 4096;

/// A cell is not divided if it and the cells around it have together multiplied their references by more than this.
///
/// Bounds the size of the octree where triangles coincide, so that no division parts them.
const MOST_GROWTH: f32 = 10.0;

/// How often in a row a cell may be divided without saving work, in the hope that its eighths do.
const PATIENCE: u32 = 2;

/// Price of a visit to a divided cell, in packets of four triangles.
const VISIT_PRICE: f32 = 2.0;

/// A triangle in a cell, with the bounds of its part there.
#[derive(Clone, Copy)]
struct Reference {
    triangle: u32,
    bounds: Bounds,
}

/// What the divisions so far have come to.
#[derive(Clone, Copy)]
struct Outlook {
    /// How many more divisions may save nothing.
    patience: u32,
    /// References per reference of the modelling cube.
    growth: f32,
}

/// Terminal nodes in the order of their codes.
#[derive(Default)]
pub struct Leaves {
    /// Their codes, sorted.
    pub codes: Vec<LocationalCode>,
    /// Where the triangles of each end in `triangles`; the next one begins there.
    pub ends: Vec<usize>,
    /// Triangles, leaf by leaf, ascending in each.
    pub triangles: Vec<u32>,
    /// Bounds of the part of each of these triangles in its leaf.
    pub bounds: Vec<Bounds>,
}

impl Leaves {
    fn push(&mut self, code: LocationalCode, references: &[Reference]) {
        self.codes.push(code);
        self.triangles.extend(references.iter().map(|r| r.triangle));
        self.bounds.extend(references.iter().map(|r| r.bounds));
        self.ends.push(self.triangles.len());
    }

    fn append(&mut self, other: Self) {
        let offset = self.triangles.len();
        self.codes.extend(other.codes);
        self.bounds.extend(other.bounds);
        self.ends.extend(other.ends.into_iter().map(|end| end + offset));
        self.triangles.extend(other.triangles);
    }

    /// Where the triangles of one leaf lie in `triangles`.
    pub fn range(&self, leaf: usize) -> std::ops::Range<usize> {
        let start = if leaf == 0 { 0 } else { self.ends[leaf - 1] };
        start..self.ends[leaf]
    }
}

/// What every cell needs to know.
pub struct Division<'a> {
    /// Vertices in local coordinates.
    pub vertices: &'a [DVec3],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// No cell is divided at this level.
    pub depth: u32,
    /// No cell with so few triangles is divided.
    pub leaf_triangles: usize,
}

impl Division<'_> {
    /// Divides the modelling cube; the result does not depend on the number of threads.
    pub fn leaves(&self) -> Leaves {
        let references: Vec<Reference> = (0..self.triangles.len())
            .into_par_iter()
            .with_min_len(PARALLEL_REFERENCES)
            .filter_map(|index| {
                let [a, b, c] = self.corners(index as u32);
                // A triangle with two corners in one point is never hit.
                (a != b && b != c && c != a).then(|| Reference {
                    triangle: index as u32,
                    bounds: Bounds::of(&[a.to_array(), b.to_array(), c.to_array()]),
                })
            })
            .collect();
        let mut leaves = Leaves::default();
        if !references.is_empty() {
            self.divide(LocationalCode::ROOT, references, Outlook { patience: PATIENCE, growth: 1.0 }, &mut leaves);
        }
        leaves
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|i| self.vertices[i as usize])
    }

    fn divide(&self, cell: LocationalCode, references: Vec<Reference>, outlook: Outlook, leaves: &mut Leaves) {
        let count = references.len();
        if cell.level() >= self.depth || count <= self.leaf_triangles {
            leaves.push(cell, &references);
            return;
        }
        let eighths = self.distribute(cell, &references);
        let total: usize = eighths.iter().map(Vec::len).sum();
        let growth = outlook.growth * total as f32 / count as f32;
        let saves = saving(&references, &eighths) > 0.0;
        if growth > MOST_GROWTH || !(saves || outlook.patience > 0) {
            leaves.push(cell, &references);
            return;
        }
        let outlook = Outlook { patience: if saves { PATIENCE } else { outlook.patience - 1 }, growth };
        drop(references);
        let children = eighths.into_iter().enumerate().filter(|(_, eighth)| !eighth.is_empty());
        let children = children.filter_map(|(digit, eighth)| Some((cell.child(digit as u8)?, eighth)));
        if count > PARALLEL_REFERENCES {
            let parts: Vec<Leaves> = children
                .collect::<Vec<_>>()
                .into_par_iter()
                .map(|(child, eighth)| {
                    let mut part = Leaves::default();
                    self.divide(child, eighth, outlook, &mut part);
                    part
                })
                .collect();
            parts.into_iter().for_each(|part| leaves.append(part));
        } else {
            children.for_each(|(child, eighth)| self.divide(child, eighth, outlook, leaves));
        }
    }

    /// Gives the triangles of a cell to its eighths, each to all that it touches.
    fn distribute(&self, cell: LocationalCode, references: &[Reference]) -> [Vec<Reference>; 8] {
        const VOXEL: f64 = 1.0 / (1_u32 << MAX_DEPTH) as f64;
        let low = cell.corner().map(|c| f64::from(c) * VOXEL);
        let half = f64::from(cell.side()) * VOXEL * 0.5;
        let middle = low.map(|x| x + half);
        let mut eighths: [Vec<Reference>; 8] = Default::default();
        for reference in references {
            // Bit `axis` is set where the part reaches below, or above, the middle plane.
            let (mut below, mut above) = (0, 0);
            let sides = reference.bounds.low.iter().zip(&reference.bounds.high).zip(&middle);
            for (axis, ((&low, &high), &middle)) in sides.enumerate() {
                below |= usize::from(f64::from(low) <= middle + FAT) << axis;
                above |= usize::from(f64::from(high) >= middle - FAT) << axis;
            }
            if below & above == 0 {
                eighths[above].push(*reference);
                continue;
            }
            for (digit, eighth) in eighths.iter_mut().enumerate() {
                if (digit & !above) | (!digit & 7 & !below) != 0 {
                    continue;
                }
                let corner = [0, 1, 2].map(|axis| if digit >> axis & 1 == 1 { middle[axis] } else { low[axis] });
                let opposite = corner.map(|x| x + half);
                if let Some(bounds) = clipped_bounds(self.corners(reference.triangle), corner, opposite) {
                    eighth.push(Reference { triangle: reference.triangle, bounds });
                }
            }
        }
        eighths
    }
}

/// Work that a division saves a ray through the cell, in packets tested.
///
/// # Source
/// Surface-area heuristic: Goldsmith and Salmon 1987.
fn saving(references: &[Reference], eighths: &[Vec<Reference>; 8]) -> f32 {
    let packets = |references: &[Reference]| references.len().div_ceil(4) as f32;
    let area =
        |references: &[Reference]| references.iter().fold(Bounds::EMPTY, |all, r| all.union(&r.bounds)).half_area();
    let whole = area(references);
    if whole <= 0.0 {
        return 0.0;
    }
    let divided: f32 = eighths.iter().filter(|e| !e.is_empty()).map(|e| area(e) / whole * packets(e)).sum();
    packets(references) - VISIT_PRICE - divided
}
