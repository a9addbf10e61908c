//! Heights at the points of a lattice over a rectangle, and of the surface between them.

use super::error::TerrainError;
use super::field::HeightField;
use crate::memory;
use glam::DVec2;
use rayon::prelude::*;

/// Places along a side that vertices of triangles may have.
pub(super) const SIDE: u32 = 1 << 22;
/// Cells along a side of the coarsest lattice.
const LEAST_CELLS: u32 = 8;
/// Cells along a side of the finest one.
const MOST_CELLS: u32 = 1 << 11;
/// Cells along the legs of triangles in which the points of the lattice are enough to tell how near the surface is.
const ENOUGH: u32 = 8;
/// Parts of the sides of smaller triangles, between which the surface is looked at.
const STEPS: u32 = 6;

/// A place on the rectangle: parts of its sides, up to [`SIDE`].
pub(super) type Vertex = [u32; 2];

/// Heights at the points of a lattice, and the function that tells those between.
pub(super) struct HeightLattice<'a> {
    field: &'a HeightField,
    region: [DVec2; 2],
    footprint: f64,
    /// Cells along a side.
    cells: u32,
    heights: Vec<f64>,
    /// Whether the surface between the points need not be looked at.
    is_fine: bool,
}

impl<'a> HeightLattice<'a> {
    /// The first lattice, of one twice as fine as the other, whose cells are flat, or the finest.
    ///
    /// - `footprint`: what is finer is left out.
    /// - `between`: how far the heights of the last lattice may be from straight lines between those of the one before.
    ///
    /// # Errors
    /// [`TerrainError::Memory`].
    pub(super) fn new(
        field: &'a HeightField,
        region: [DVec2; 2],
        footprint: f64,
        between: f64,
    ) -> Result<HeightLattice<'a>, TerrainError> {
        let least =
            ((region[1] - region[0]).max_element() / field.coarsest_spacing()).clamp(1.0, f64::from(MOST_CELLS));
        let mut cells = (least.ceil() as u32).next_power_of_two().clamp(LEAST_CELLS, MOST_CELLS);
        loop {
            let points = (cells as usize + 1) * (cells as usize + 1);
            memory::reserve(8 * points as u64, || format!("{points} heights of terrain"))?;
            let mut lattice = HeightLattice { field, region, footprint, cells, heights: Vec::new(), is_fine: false };
            let step = SIDE / cells;
            let row = |z: u32| (0..=cells).map(move |x| [x * step, z * step]);
            lattice.heights = (0..=cells)
                .into_par_iter()
                .flat_map_iter(|z| row(z).map(|vertex| field.height(lattice.place(vertex), footprint)))
                .collect();
            lattice.is_fine = lattice.distance_from_coarser() <= between;
            if lattice.is_fine || cells == MOST_CELLS {
                return Ok(lattice);
            }
            cells *= 2;
        }
    }

    /// x and z of a place.
    pub(super) fn place(&self, [x, z]: Vertex) -> DVec2 {
        let part = DVec2::new(f64::from(x), f64::from(z)) / f64::from(SIDE);
        let [from, to] = self.region;
        // Exact at both ends.
        from * (DVec2::ONE - part) + to * part
    }

    /// The height at a place.
    pub(super) fn height(&self, vertex: Vertex) -> f64 {
        let step = SIDE / self.cells;
        let is_known = vertex.iter().all(|axis| axis % step == 0);
        if is_known {
            self.at(vertex.map(|axis| axis / step))
        } else {
            self.field.height(self.place(vertex), self.footprint)
        }
    }

    /// The height at a point of the lattice.
    fn at(&self, [x, z]: [u32; 2]) -> f64 {
        self.heights[z as usize * (self.cells as usize + 1) + x as usize]
    }

    /// How far the heights are at the most from straight lines between those with even numbers, along the cells and
    /// across them.
    fn distance_from_coarser(&self) -> f64 {
        let off = |x: u32, z: u32| {
            let mean = |a: [u32; 2], b: [u32; 2]| 0.5 * (self.at(a) + self.at(b));
            let height = self.at([x, z]);
            match (x % 2, z % 2) {
                (0, 0) => 0.0,
                (1, 0) => (height - mean([x - 1, z], [x + 1, z])).abs(),
                (0, _) => (height - mean([x, z - 1], [x, z + 1])).abs(),
                _ => {
                    let one = (height - mean([x - 1, z - 1], [x + 1, z + 1])).abs();
                    one.max((height - mean([x + 1, z - 1], [x - 1, z + 1])).abs())
                }
            }
        };
        let row = |z: u32| (0..=self.cells).map(|x| off(x, z)).fold(0.0, f64::max);
        (0..=self.cells).into_par_iter().map(row).reduce(|| 0.0, f64::max)
    }

    /// Whether the surface is within a distance above or below a triangle, where it is looked at.
    ///
    /// - `triangle`: the ends of its longest side, and the corner between the others, which are equally long.
    pub(super) fn is_near(&self, triangle: [Vertex; 3], distance: f64) -> bool {
        let [a, b, c] = triangle;
        let step = SIDE / self.cells;
        let leg = a[0].abs_diff(c[0]).max(a[1].abs_diff(c[1]));
        let is_on_lattice = triangle.as_flattened().iter().all(|axis| axis % step == 0);
        if is_on_lattice && (self.is_fine || leg >= ENOUGH * step) {
            return self.is_near_points(triangle.map(|vertex| vertex.map(|axis| axis / step)), distance);
        }
        if self.is_fine {
            return true;
        }
        let corners = [a, b, c].map(|vertex| (self.place(vertex), self.height(vertex)));
        for k in 0..=STEPS {
            for l in 0..=STEPS - k {
                let parts = [STEPS - k - l, k, l].map(|part| f64::from(part) / f64::from(STEPS));
                let mixed = corners.iter().zip(parts).map(|((at, height), part)| (*at * part, height * part));
                let (at, plane) = mixed.fold((DVec2::ZERO, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
                // What is no number is not near.
                let is_near = (self.field.height(at, self.footprint) - plane).abs() <= distance;
                if parts[0].max(parts[1]).max(parts[2]) < 1.0 && !is_near {
                    return false;
                }
            }
        }
        true
    }

    /// Whether the heights at all points of the lattice in a triangle between such points are within a distance of it.
    fn is_near_points(&self, [a, b, c]: [[u32; 2]; 3], distance: f64) -> bool {
        let of = |point: [u32; 2]| point.map(i64::from);
        let (pa, pb, pc) = (of(a), of(b), of(c));
        let cross =
            |p: [i64; 2], q: [i64; 2], at: [i64; 2]| (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
        let area = cross(pa, pb, pc);
        let turn = area.signum();
        let heights = [a, b, c].map(|point| self.at(point) / area as f64);
        let least = |axis: usize| pa[axis].min(pb[axis]).min(pc[axis]);
        let most = |axis: usize| pa[axis].max(pb[axis]).max(pc[axis]);
        for z in least(1)..=most(1) {
            for x in least(0)..=most(0) {
                let at = [x, z];
                let parts = [cross(pb, pc, at), cross(pc, pa, at), cross(pa, pb, at)];
                if parts.iter().any(|part| part * turn < 0) {
                    continue;
                }
                let plane: f64 = parts.iter().zip(heights).map(|(part, height)| *part as f64 * height).sum();
                let off = (self.at([x as u32, z as u32]) - plane).abs();
                // What is no number is not near.
                let is_near = off <= distance;
                if !is_near {
                    return false;
                }
            }
        }
        true
    }
}
