//! Interior grids: cells that lie in an operand as a whole, for a first, coarse answer to where a triangle lies.
//!
//! A grid is laid over the operand. The boxes of its triangles mark the cells that its surface may pass. Cells that are
//! not marked are filled from the border of the grid, through common sides, as far as outside reaches; what is left
//! lies in the operand or in a hollow of it, and one ray from each connected part tells which. A row of cells is one
//! word.

use super::operand::Operands;
use super::winding::winding;
use crate::numeric::bounds::Bounds;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition};
use glam::DVec3;

/// Most cells along an axis: the bits of a row.
const MOST: usize = u64::BITS as usize;
/// Connected parts of the inside that are asked for; more count as unknown.
const PARTS: usize = 64;

/// Rows of cells along x, for each y, for each z.
#[derive(Clone, Debug)]
struct Rows {
    /// Number of cells along each axis.
    size: [usize; 3],
    rows: Vec<u64>,
}

/// First and last cell along each axis.
type Range = [[usize; 2]; 3];

impl Rows {
    fn none(size: [usize; 3]) -> Rows {
        Rows { size, rows: vec![0; size[1] * size[2]] }
    }

    /// The rows, for each z, that have some of these cells.
    fn rows([_, y, z]: Range, width: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
        (z[0]..z[1] + 1).map(move |z| z * width + y[0]..z * width + y[1] + 1)
    }

    /// The bits of these cells in a row.
    fn bits([x, ..]: Range) -> u64 {
        (u64::MAX >> (MOST - 1 - (x[1] - x[0]))) << x[0]
    }

    fn set(&mut self, range: Range) {
        let bits = Self::bits(range);
        Self::rows(range, self.size[1]).for_each(|rows| self.rows[rows].iter_mut().for_each(|row| *row |= bits));
    }

    fn has_all(&self, range: Range) -> bool {
        let bits = Self::bits(range);
        Self::rows(range, self.size[1]).all(|rows| self.rows[rows].iter().all(|row| row & bits == bits))
    }

    fn has_any(&self, range: Range) -> bool {
        let bits = Self::bits(range);
        Self::rows(range, self.size[1]).any(|rows| self.rows[rows].iter().any(|row| row & bits != 0))
    }

    /// The first cell that is set.
    fn first(&self) -> Option<[usize; 3]> {
        let row = self.rows.iter().position(|row| *row != 0)?;
        Some([self.rows[row].trailing_zeros() as usize, row % self.size[1], row / self.size[1]])
    }

    /// All cells of this that are connected with cells of `seeds` through common sides.
    fn flooded(&self, seeds: &Rows) -> Rows {
        let [_, width, height] = self.size;
        let mut wet = Rows::none(self.size);
        let mut fresh = seeds.rows.clone();
        loop {
            let mut is_calm = true;
            // There and back again, so that the flood runs far in each turn.
            for step in 0..2 * fresh.len() {
                let row = if step < fresh.len() { step } else { 2 * fresh.len() - 1 - step };
                let new = fresh[row] & self.rows[row] & !wet.rows[row];
                if new == 0 {
                    continue;
                }
                is_calm = false;
                wet.rows[row] = along(wet.rows[row] | new, self.rows[row]);
                let (y, z, wet) = (row % width, row / width, wet.rows[row]);
                if y > 0 {
                    fresh[row - 1] |= wet;
                }
                if y + 1 < width {
                    fresh[row + 1] |= wet;
                }
                if z > 0 {
                    fresh[row - width] |= wet;
                }
                if z + 1 < height {
                    fresh[row + width] |= wet;
                }
            }
            if is_calm {
                return wet;
            }
        }
    }
}

/// Spreads bits to both sides as long as they stay within `free`, all at once by doubling the stride.
fn along(bits: u64, free: u64) -> u64 {
    let (mut up, mut down) = (bits & free, bits & free);
    let (mut above, mut below) = (free, free);
    for stride in [1, 2, 4, 8, 16, 32] {
        up |= above & (up << stride);
        above &= above << stride;
        down |= below & (down >> stride);
        below &= below >> stride;
    }
    up | down
}

/// The interior grid of an operand.
#[derive(Clone, Debug)]
pub struct InteriorGrid {
    min: DVec3,
    /// Cells per unit of length.
    density: f64,
    /// Cells that lie in the operand as a whole.
    inside: Rows,
    /// The box around these; empty if there are none.
    bounds: Bounds,
    /// Cells that were marked.
    marked: Rows,
}

impl InteriorGrid {
    /// Lays a grid over an operand, finer for more triangles; `None` where numbers overflow.
    pub fn of(operands: &Operands, operand: u32) -> Option<InteriorGrid> {
        let mesh = operands.meshes()[operand as usize];
        let all = operands.bounds(operand);
        let cells = (mesh.triangles.len() as f64).sqrt().min((MOST - 1) as f64).floor();
        let density = cells / all.size().max_element();
        if !(density.is_finite() && density > 0.0 && (all.size() * density).is_finite()) {
            return None;
        }
        let size = (all.size() * density).to_array().map(|cells| (cells as usize + 1).min(MOST));
        let mut surface = Rows::none(size);
        let none = Rows::none(size);
        let mut core =
            InteriorGrid { min: all.min, density, inside: none.clone(), bounds: Bounds::EMPTY, marked: none };
        for triangle in 0..mesh.triangles.len() {
            surface.set(core.range(Bounds::of(mesh.corners(triangle)))?);
        }
        let mut free = surface;
        let full = u64::MAX >> (MOST - size[0]);
        free.rows.iter_mut().for_each(|row| *row = !*row & full);
        let mut border = Rows::none(size);
        let ends = 1 | 1 << (size[0] - 1);
        let is_end = |place: usize, count: usize| place == 0 || place + 1 == count;
        for (row, bits) in border.rows.iter_mut().enumerate() {
            *bits = if is_end(row % size[1], size[1]) || is_end(row / size[1], size[2]) { full } else { ends };
        }
        let outside = free.flooded(&border);
        let mut left = free;
        left.rows.iter_mut().zip(&outside.rows).for_each(|(left, outside)| *left &= !outside);
        for _ in 0..PARTS {
            let Some(seed) = left.first() else { break };
            let mut part = Rows::none(size);
            part.set(seed.map(|cell| [cell; 2]));
            let part = left.flooded(&part);
            left.rows.iter_mut().zip(&part.rows).for_each(|(left, part)| *left &= !part);
            let middle = all.min + DVec3::from(seed.map(|cell| cell as f64 + 0.5)) / density;
            // A middle that was rounded out of its cell tells nothing.
            let is_there = core.range(Bounds { min: middle, max: middle }) == Some(seed.map(|cell| [cell; 2]));
            let point = ImplicitPoint::new(PointDefinition::Given(middle));
            if is_there && winding(operands, operand, &point, &mut 0) > 0 {
                core.inside.rows.iter_mut().zip(&part.rows).for_each(|(inside, part)| *inside |= part);
            }
        }
        core.bounds = core.around_inside();
        Some(core)
    }

    /// The box around the cells inside; empty if there are none.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Whether a box lies in the operand as a whole; `false` where that is not known.
    #[inline]
    pub fn contains(&self, bounds: Bounds) -> bool {
        self.range(bounds).is_some_and(|range| self.inside.has_all(range))
    }

    /// Marks the cells that a box within that of the operand touches.
    pub fn mark(&mut self, bounds: Bounds) {
        if let Some(range) = self.range(bounds) {
            self.marked.set(range);
        }
    }

    /// Whether a box touches a marked cell.
    pub fn is_marked(&self, bounds: Bounds) -> bool {
        let (low, high) = (self.to_cell(bounds.min), self.to_cell(bounds.max));
        let size = self.marked.size;
        let along = |axis: usize| {
            let (low, high) = (low[axis], high[axis]);
            (low < size[axis] as f64 && high >= 0.0)
                .then(|| [low.max(0.0) as usize, (high as usize).min(size[axis] - 1)])
        };
        let (Some(x), Some(y), Some(z)) = (along(0), along(1), along(2)) else { return false };
        self.marked.has_any([x, y, z])
    }

    /// A point in cells from the first on; the whole part tells which. No coordinate ever falls when one of the point
    /// rises: whatever the roundings, a point between two others has a cell between theirs.
    fn to_cell(&self, point: DVec3) -> DVec3 {
        (point - self.min) * self.density
    }

    /// The cells that a box touches; `None` unless all are in the grid.
    fn range(&self, bounds: Bounds) -> Option<Range> {
        let (low, high) = (self.to_cell(bounds.min), self.to_cell(bounds.max));
        let size = self.marked.size;
        let is_in = |axis: usize| low[axis] >= 0.0 && low[axis] <= high[axis] && high[axis] < size[axis] as f64;
        let along = |axis: usize| [low[axis] as usize, high[axis] as usize];
        (is_in(0) && is_in(1) && is_in(2)).then(|| [along(0), along(1), along(2)])
    }

    fn around_inside(&self) -> Bounds {
        let width = self.inside.size[1];
        let mut all = Bounds::EMPTY;
        for (row, bits) in self.inside.rows.iter().enumerate().filter(|(_, bits)| **bits != 0) {
            let (y, z) = ((row % width) as f64, (row / width) as f64);
            let ends = [bits.trailing_zeros(), MOST as u32 - bits.leading_zeros()].map(f64::from);
            let min = DVec3::new(ends[0], y, z);
            all = all.union(Bounds { min, max: DVec3::new(ends[1], y + 1.0, z + 1.0) });
        }
        Bounds { min: self.min + all.min / self.density, max: self.min + all.max / self.density }
    }
}

#[cfg(test)]
mod tests {
    use super::super::operand::Operand;
    use super::*;
    use crate::mesh::Mesh;
    use crate::octree::TriangleBvh;
    use crate::surface::{Sphere, Tolerance, tessellate};
    use rand::{RngExt, SeedableRng};

    fn core_of(mesh: &Mesh) -> Option<InteriorGrid> {
        let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
        InteriorGrid::of(
            &Operands::new(vec![Operand { mesh, sorted: &sorted, quad_partners: &[], overlaps: &[] }], true),
            0,
        )
    }

    /// A ball of radius 1 with a hollow of radius 0.4, stretched and moved.
    fn shell(stretch: DVec3, shift: DVec3) -> Mesh {
        let sphere = |radius| tessellate(&[Sphere::new(DVec3::ZERO, radius)], Tolerance::new(0.003, 90.0)).unwrap();
        let (mut mesh, hollow) = (sphere(1.0), sphere(0.4));
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(hollow.vertices);
        mesh.triangles.extend(hollow.triangles.iter().map(|&[a, b, c]| [a + first, c + first, b + first]));
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = *vertex * stretch + shift);
        mesh
    }

    #[test]
    fn boxes_that_are_held_lie_between_the_hollow_and_the_surface() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        for (stretch, shift) in [
            (DVec3::ONE, DVec3::ZERO),
            (DVec3::new(1.0, 0.3, 1e-3), DVec3::new(1e6, -7.0, 0.1)),
            (DVec3::new(1e-150, 1e-150, 1e-151), DVec3::ZERO),
            (DVec3::splat(1e150), DVec3::ZERO),
        ] {
            let core = core_of(&shell(stretch, shift)).unwrap();
            let (mut held, mut missed) = (0, 0);
            for _ in 0..20_000 {
                let middle = DVec3::from([0; 3].map(|_| random.random_range(-1.1..1.1)));
                let half = DVec3::from([0; 3].map(|_| random.random_range(0.0..0.1)));
                let corners = Bounds { min: middle - half, max: middle + half };
                let farthest = corners.corners().map(DVec3::length).into_iter().fold(0.0, f64::max);
                let nearest = DVec3::ZERO.clamp(corners.min, corners.max).length();
                let place = |point: DVec3| point * stretch + shift;
                if core.contains(Bounds { min: place(corners.min), max: place(corners.max) }) {
                    assert!(farthest < 1.0 + 1e-8 && nearest > 0.39, "{corners:?}");
                    held += 1;
                } else {
                    missed += u32::from(farthest < 0.85 && nearest > 0.55);
                }
            }
            // A stretched grid has few cells along its short sides.
            assert!(stretch != DVec3::ONE || (held > 1000 && missed < held / 10), "{stretch}: {held} {missed}");
        }
    }

    #[test]
    fn marked_cells_are_found_by_what_touches_them() {
        let mut core = core_of(&shell(DVec3::ONE, DVec3::ZERO)).unwrap();
        let around = |x: f64, half: f64| {
            let middle = DVec3::new(x, 0.0, 0.0);
            Bounds { min: middle - half, max: middle + half }
        };
        assert!(!core.is_marked(around(0.0, 5.0)));
        core.mark(around(0.5, 0.1));
        for (bounds, expected) in [
            (around(0.5, 0.01), true),
            (around(0.65, 0.06), true),
            (around(0.0, 5.0), true),
            (around(-0.5, 0.1), false),
            (around(0.8, 0.05), false),
            (around(3.0, 1.0), false),
            (around(-3.0, 1.0), false),
        ] {
            assert_eq!(core.is_marked(bounds), expected, "{bounds:?}");
        }
    }

    #[test]
    fn what_has_no_size_or_too_much_has_no_core() {
        for size in [0.0, 1e-310, f64::MAX] {
            let mut mesh = shell(DVec3::ONE, DVec3::ZERO);
            mesh.vertices.iter_mut().for_each(|vertex| *vertex *= size);
            assert!(core_of(&mesh).is_none(), "{size}");
        }
    }

    #[test]
    fn bits_spread_as_far_as_they_can() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        for _ in 0..1000 {
            let free: u64 = random.random::<u64>() | random.random::<u64>() | random.random::<u64>();
            let bits = random.random::<u64>() & random.random::<u64>() & random.random::<u64>();
            let mut slow = bits & free;
            (0..64).for_each(|_| slow |= (slow << 1 | slow >> 1) & free);
            assert_eq!(along(bits, free), slow, "{bits:x} {free:x}");
        }
    }
}
