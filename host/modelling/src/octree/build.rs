//! From triangles to terminal nodes: cells are divided where small triangles are many.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::clip::{FAT, LocalBounds, clipped_bounds};
use super::code::{LocationalCode, MAX_DEPTH};
use super::cube::Cube;

/// Work on more triangles than this is shared among threads.
pub const PARALLEL_TRIANGLES: usize = 4096;

/// A cell is not divided if so many times more triangles touch it than have their home in it.
///
/// Bounds the size of the octree where many large triangles pass through a crowd of small ones.
const CROWD: usize = 32;

/// A triangle in a cell, with the bounds of its part there.
#[derive(Clone, Copy)]
pub struct TriangleReference {
    /// Index of the triangle.
    pub triangle: u32,
    bounds: LocalBounds,
}

/// Terminal nodes in the order of their codes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Leaves {
    /// Codes of the nodes, sorted; none contains another.
    pub codes: Vec<LocationalCode>,
    /// Ends of the triangles of each node in `triangles`; the next one begins there.
    pub ends: Vec<usize>,
    /// Triangles, leaf by leaf, ascending in each.
    pub triangles: Vec<u32>,
}

impl Leaves {
    /// Adds a terminal node behind all others.
    pub fn push(&mut self, code: LocationalCode, triangles: impl Iterator<Item = u32>) {
        self.codes.push(code);
        self.triangles.extend(triangles);
        self.ends.push(self.triangles.len());
    }

    /// Adds some terminal nodes of another sequence behind all others.
    pub fn append(&mut self, other: &Self, nodes: Range<usize>) {
        let first = other.range(nodes.clone()).start;
        let offset = self.triangles.len();
        self.codes.extend(&other.codes[nodes.clone()]);
        self.triangles.extend(&other.triangles[other.range(nodes.clone())]);
        self.ends.extend(other.ends[nodes].iter().map(|end| end - first + offset));
    }

    /// The range of the triangles of some successive nodes in `triangles`.
    pub fn range(&self, nodes: Range<usize>) -> Range<usize> {
        let end = |node: usize| if node == 0 { 0 } else { self.ends[node - 1] };
        end(nodes.start)..end(nodes.end)
    }

    /// The triangles of one node.
    pub fn of(&self, node: usize) -> &[u32] {
        &self.triangles[self.range(node..node + 1)]
    }

    /// The nodes that name one of some successive triangles, in order.
    pub fn naming(&self, triangles: &Range<usize>) -> Vec<usize> {
        let names = |&node: &usize| self.of(node).iter().any(|&triangle| triangles.contains(&(triangle as usize)));
        (0..self.codes.len()).filter(names).collect()
    }

    /// The nodes in a cube, among some successive ones.
    pub fn within(&self, cube: LocationalCode, nodes: Range<usize>) -> Range<usize> {
        let part = &self.codes[nodes.clone()];
        let first = part.partition_point(|&code| code < cube);
        let count = part[first..].partition_point(|&code| code.begins_before_end_of(cube));
        nodes.start + first..nodes.start + first + count
    }
}

/// The terminal nodes, and what tells which cells are divided.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    /// The homes of all triangles, sorted.
    pub homes: Vec<LocationalCode>,
    /// The terminal nodes.
    pub leaves: Leaves,
}

/// Builder of terminal nodes: the cube, the triangles and the limits of division.
#[derive(Clone, Copy)]
pub struct OctreeBuilder<'a> {
    /// The modelling cube.
    pub cube: Cube,
    /// Vertices, world units.
    pub vertices: &'a [DVec3],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// No cell is divided at this level.
    pub depth: u32,
    /// No cell that is home to so few triangles is divided.
    pub leaf_triangles: usize,
    /// Work on more triangles than this is shared among threads: [`PARALLEL_TRIANGLES`], or no number that there is.
    pub grain: usize,
}

impl OctreeBuilder<'_> {
    /// Some triangles in the modelling cube, in order.
    pub fn references(&self, triangles: Range<usize>) -> Vec<TriangleReference> {
        triangles.into_par_iter().with_min_len(self.grain).filter_map(|t| self.reference(t as u32)).collect()
    }

    fn reference(&self, triangle: u32) -> Option<TriangleReference> {
        let bounds = || LocalBounds::of(&self.corners(triangle).map(|corner| corner.to_array()));
        self.is_extended(triangle as usize).then(|| TriangleReference { triangle, bounds: bounds() })
    }

    /// Some triangles, ascending, in a cell; those that do not touch it are left out.
    pub fn references_in(&self, cell: LocationalCode, triangles: &[u32]) -> Vec<TriangleReference> {
        let mut references: Vec<TriangleReference> = triangles.iter().filter_map(|&t| self.reference(t)).collect();
        for level in 0..cell.level() {
            let octants = self.distribute(cell.ancestor(level), &references);
            references =
                cell.digit(level + 1).and_then(|digit| octants.into_iter().nth(digit.into())).unwrap_or_default();
        }
        references
    }

    /// The homes of some triangles, sorted.
    ///
    /// The home of a triangle is the smallest cube that holds the middle of its box and is as large as the box. Unlike
    /// the cells that it touches it is one, whatever else there is; it depends on nothing but the triangle.
    pub fn homes(&self, triangles: Range<usize>) -> Vec<LocationalCode> {
        let home = |index: usize| {
            let [a, b, c] = self.corners(index as u32);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let voxels = f64::from(1_u32 << MAX_DEPTH);
            let size = ((high - low).max_element() * voxels).ceil().max(1.0) as u32;
            let last = DVec3::splat(voxels - 1.0);
            let middle = ((low + high) * (0.5 * voxels)).clamp(DVec3::ZERO, last).to_array().map(|x| x as u32);
            let above = size.next_power_of_two().trailing_zeros();
            self.is_extended(index).then(|| LocationalCode::containing(middle, MAX_DEPTH.saturating_sub(above)))
        };
        let mut homes: Vec<_> = triangles.into_par_iter().with_min_len(self.grain).filter_map(home).collect();
        if homes.len() > self.grain {
            homes.par_sort_unstable()
        } else {
            homes.sort_unstable()
        }
        homes
    }

    /// Divides the modelling cube; the result does not depend on the number of threads.
    pub fn nodes(&self) -> Nodes {
        let all = 0..self.triangles.len();
        let homes = self.homes(all.clone());
        let mut leaves = Leaves::default();
        self.divide(LocationalCode::ROOT, self.references(all), &homes, &mut leaves);
        Nodes { homes, leaves }
    }

    /// A triangle with two corners in one point is never hit.
    pub fn is_extended(&self, triangle: usize) -> bool {
        let [a, b, c] = self.triangles[triangle].map(|i| self.vertices[i as usize]);
        a != b && b != c && c != a
    }

    /// Local coordinates of the corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|i| self.cube.local(self.vertices[i as usize]))
    }

    /// Says whether a cell is divided, by nothing but what is in it: so a change elsewhere does not matter.
    ///
    /// - `homes`: number of triangles that have their home in it.
    /// - `references`: number of triangles that touch it.
    pub fn is_divided(&self, cell: LocationalCode, homes: usize, references: usize) -> bool {
        cell.level() < self.depth && homes > self.leaf_triangles && references <= homes.saturating_mul(CROWD)
    }

    /// Adds the terminal nodes of a cell.
    ///
    /// - `homes`: those in the cell, sorted.
    pub fn divide(
        &self,
        cell: LocationalCode,
        references: Vec<TriangleReference>,
        homes: &[LocationalCode],
        leaves: &mut Leaves,
    ) {
        let count = references.len();
        if count == 0 {
            return;
        }
        if !self.is_divided(cell, homes.len(), count) {
            leaves.push(cell, references.iter().map(|r| r.triangle));
            return;
        }
        let octants = octants(cell).zip(self.distribute(cell, &references));
        drop(references);
        if count > self.grain {
            let parts: Vec<Leaves> = octants
                .collect::<Vec<_>>()
                .into_par_iter()
                .map(|(octant, references)| {
                    let mut part = Leaves::default();
                    self.divide(octant, references, within(homes, octant), &mut part);
                    part
                })
                .collect();
            parts.iter().for_each(|part| leaves.append(part, 0..part.codes.len()));
        } else {
            octants.for_each(|(octant, references)| self.divide(octant, references, within(homes, octant), leaves));
        }
    }

    /// Gives the triangles of a cell to its octants, each to all that it touches.
    pub fn distribute(&self, cell: LocationalCode, references: &[TriangleReference]) -> [Vec<TriangleReference>; 8] {
        let mut octants: [Vec<TriangleReference>; 8] = Default::default();
        let (low, half) = place(cell);
        let middle = low.map(|x| x + half);
        for reference in references {
            // Bit `axis` is set where the part reaches below, or above, the middle plane.
            let (mut below, mut above) = (0, 0);
            let sides = reference.bounds.low.iter().zip(&reference.bounds.high).zip(&middle);
            for (axis, ((&low, &high), &middle)) in sides.enumerate() {
                below |= usize::from(f64::from(low) <= middle + FAT) << axis;
                above |= usize::from(f64::from(high) >= middle - FAT) << axis;
            }
            if below & above == 0 {
                octants[above].push(*reference);
                continue;
            }
            let corners = self.corners(reference.triangle);
            for (digit, octant) in octants.iter_mut().enumerate() {
                if (digit & !above) | (!digit & 7 & !below) != 0 {
                    continue;
                }
                let corner = [0, 1, 2].map(|axis| if digit >> axis & 1 == 1 { middle[axis] } else { low[axis] });
                if let Some(bounds) = clipped_bounds(corners, corner, corner.map(|x| x + half)) {
                    octant.push(TriangleReference { triangle: reference.triangle, bounds });
                }
            }
        }
        octants
    }

    /// Bounds of the part of a triangle in a cell; `None` if it does not touch the cell.
    pub fn part(&self, triangle: u32, cell: LocationalCode) -> Option<LocalBounds> {
        let (low, half) = place(cell);
        clipped_bounds(self.corners(triangle), low, low.map(|x| x + 2.0 * half))
    }
}

/// Lowest corner of a cell and half its side, local coordinates.
pub fn place(cell: LocationalCode) -> ([f64; 3], f64) {
    const VOXEL: f64 = 1.0 / (1_u32 << MAX_DEPTH) as f64;
    (cell.corner().map(|c| f64::from(c) * VOXEL), f64::from(cell.side()) * VOXEL * 0.5)
}

/// The octants of a cell in order.
pub fn octants(cell: LocationalCode) -> impl Iterator<Item = LocationalCode> {
    (0..8).filter_map(move |digit| cell.child(digit))
}

/// The codes in a cube, among sorted ones.
pub fn within(codes: &[LocationalCode], cube: LocationalCode) -> &[LocationalCode] {
    let first = codes.partition_point(|&code| code < cube);
    let count = codes[first..].partition_point(|&code| code.begins_before_end_of(cube));
    &codes[first..first + count]
}
