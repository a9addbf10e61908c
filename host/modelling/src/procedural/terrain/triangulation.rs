//! Triangles of a height field to a tolerance, without cracks.

use super::error::TerrainError;
use super::field::{HeightField, normal_of};
use super::height_lattice::{HeightLattice, SIDE, Vertex};
use super::parameters::in_range;
use crate::memory;
use crate::mesh::Mesh;
use glam::{DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

/// Bytes that a triangle takes while it is made.
const BYTES_EACH: u64 = 320;
/// Memory is asked for after so many triangles.
const BATCH: usize = 1 << 16;
/// Part of the tolerance that triangles may be off at the points that are looked at; the rest is for what is between.
const PART: f64 = 0.8;

/// How triangles are made of a height field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainTriangles {
    /// The surface is above or below the triangles by this at the most, units of length, above 0.
    pub tolerance: f64,
    /// What is finer is left out, with smooth edges, units of length; 0 leaves nothing out.
    pub footprint: f64,
    /// More triangles are refused.
    pub most_triangles: usize,
    /// With a height the triangles become the top of a closed solid with walls and a flat base at it.
    pub base: Option<f64>,
}

impl HeightField {
    /// Triangles over a rectangle, large where the surface is flat and small where it bends.
    ///
    /// Right triangles are halved until the surface is within the tolerance at points in them, and those beside them as far
    /// as shared edges ask for it, so that there are no cracks. The points are those of a lattice so fine that the surface
    /// departs little from straight lines between them, or where it is too rough for one, 28 in each triangle. Normals at the corners are those of the surface;
    /// parameters are x and z.
    ///
    /// - `region`: its least and its greatest x and z, within the region of the field.
    ///
    /// # Errors
    /// [`TerrainError`] for a region or a tolerance that cannot be, too many triangles, too little memory, a base above
    /// the ground.
    ///
    /// # Source
    /// Bisection of right triangles: Lindstrom et al. 1996; Evans, Kirkpatrick and Townsend 2001.
    pub fn triangles(&self, region: [DVec2; 2], settings: &TerrainTriangles) -> Result<Mesh, TerrainError> {
        let [from, to] = self.region();
        let is_within = region[0].cmpge(from).all() && region[1].cmple(to).all() && region[0].cmplt(region[1]).all();
        if !is_within {
            return Err(TerrainError::Region);
        }
        in_range("tolerance", settings.tolerance, [f64::MIN_POSITIVE, f64::MAX])?;
        in_range("footprint", settings.footprint, [0.0, f64::MAX])?;
        let between = (1.0 - PART) * settings.tolerance;
        let lattice = HeightLattice::new(self, region, settings.footprint, between)?;
        let pending = ROOTS.to_vec();
        let mut made = Bisection { field: self, settings, lattice, halved: FxHashSet::default(), pending };
        made.refine()?;
        made.mesh()
    }
}

/// Which edges are halved. A triangle is two ends of its longest side and the corner between the others.
struct Bisection<'a> {
    field: &'a HeightField,
    settings: &'a TerrainTriangles,
    lattice: HeightLattice<'a>,
    /// Middles of longest sides that are halved.
    halved: FxHashSet<Vertex>,
    /// Triangles that are yet to be tested.
    pending: Vec<[Vertex; 3]>,
}

impl Bisection<'_> {
    /// Halves triangles until all keep the tolerance.
    fn refine(&mut self) -> Result<(), TerrainError> {
        let mut asked = 0;
        while let Some(triangle) = self.pending.pop() {
            let [a, b, _] = triangle;
            let middle = middle(a, b);
            // Whoever halved it left its children here.
            if self.halved.contains(&middle) || self.lattice.is_near(triangle, PART * self.settings.tolerance) {
                continue;
            }
            let is_odd = |axis: usize| (a[axis] ^ b[axis]) & 1 == 1;
            if is_odd(0) || is_odd(1) {
                return Err(TerrainError::Tolerance { tolerance: self.settings.tolerance });
            }
            self.halve(middle);
            if 2 * self.halved.len() > self.settings.most_triangles {
                return Err(TerrainError::TooManyTriangles { most: self.settings.most_triangles });
            }
            if self.halved.len() >= asked {
                asked = self.halved.len() + BATCH;
                memory::reserve(BATCH as u64 * 2 * BYTES_EACH, || "triangles of terrain".into())?;
            }
        }
        Ok(())
    }

    /// Halves the two triangles at a longest side, and first those that have to be there for that.
    fn halve(&mut self, middle: Vertex) {
        let mut pending = vec![middle];
        while let Some(middle) = pending.pop() {
            if self.halved.contains(&middle) {
                continue;
            }
            let (ends, corners) = diamond(middle);
            let missing: Vec<Vertex> = corners
                .into_iter()
                .flatten()
                .filter(|corner| corner.iter().any(|k| k % SIDE != 0) && !self.halved.contains(corner))
                .collect();
            if !missing.is_empty() {
                pending.push(middle);
                pending.extend(missing);
                continue;
            }
            self.halved.insert(middle);
            for corner in corners.into_iter().flatten() {
                self.pending.extend(children([ends[0], ends[1], corner], middle));
            }
        }
    }

    fn mesh(self) -> Result<Mesh, TerrainError> {
        let mut triangles = Vec::new();
        let mut pending = ROOTS.to_vec();
        while let Some(triangle) = pending.pop() {
            let middle = middle(triangle[0], triangle[1]);
            if self.halved.contains(&middle) {
                pending.extend(children(triangle, middle));
            } else {
                triangles.push(triangle);
            }
        }
        if triangles.len() > self.settings.most_triangles {
            return Err(TerrainError::TooManyTriangles { most: self.settings.most_triangles });
        }
        memory::reserve(triangles.len() as u64 * BYTES_EACH, || format!("{} triangles of terrain", triangles.len()))?;
        let mut numbers = FxHashMap::default();
        let mut mesh = Mesh::default();
        let mut normals = Vec::new();
        for triangle in &triangles {
            let indices = triangle.map(|vertex| {
                *numbers.entry(vertex).or_insert_with(|| {
                    let at = self.lattice.place(vertex);
                    mesh.vertices.push(DVec3::new(at.x, self.lattice.height(vertex), at.y));
                    normals.push(normal_of(self.field.slope(at, self.settings.footprint)));
                    mesh.vertices.len() as u32 - 1
                })
            });
            mesh.triangles.push(indices);
            mesh.corner_normals.push(indices.map(|index| normals[index as usize]));
            mesh.corner_parameters.push(triangle.map(|vertex| self.lattice.place(vertex)));
        }
        if let Some(base) = self.settings.base {
            close(&mut mesh, &numbers, base)?;
        }
        Ok(mesh)
    }
}

/// Adds walls below the edge and a base, so that the mesh encloses a solid.
fn close(mesh: &mut Mesh, numbers: &FxHashMap<Vertex, u32>, base: f64) -> Result<(), TerrainError> {
    let lowest = mesh.vertices.iter().map(|vertex| vertex.y).fold(f64::INFINITY, f64::min);
    let is_below = base < lowest;
    if !is_below {
        return Err(TerrainError::Base { base, lowest });
    }
    let mut edge: Vec<(u64, Vertex, u32)> =
        numbers.iter().filter_map(|(vertex, number)| Some((around(*vertex)?, *vertex, *number))).collect();
    edge.sort_unstable();
    let below = mesh.vertices.len() as u32;
    let count = edge.len() as u32;
    for (_, _, top) in &edge {
        let at = mesh.vertices[*top as usize];
        mesh.vertices.push(DVec3::new(at.x, base, at.z));
    }
    let corners = [0, count / 2].map(|k| mesh.vertices[(below + k) as usize]);
    let center = mesh.vertices.len() as u32;
    mesh.vertices.push(0.5 * (corners[0] + corners[1]));
    let mut add = |triangle: [u32; 3], normal: DVec3| {
        let at = triangle.map(|index| mesh.vertices[index as usize]);
        mesh.triangles.push(triangle);
        mesh.corner_normals.push([normal; 3]);
        mesh.corner_parameters.push(at.map(|at| DVec2::new(at.x, at.z)));
    };
    for k in 0..count {
        let next = (k + 1) % count;
        let (top, top_next) = (edge[k as usize].2, edge[next as usize].2);
        let (low, low_next) = (below + k, below + next);
        let [x, z] = edge[k as usize].1;
        // The edge is walked along x first, then along z: walls look away from the middle.
        let normal = match (x, z) {
            (x, 0) if x < SIDE => DVec3::NEG_Z,
            (SIDE, z) if z < SIDE => DVec3::X,
            (x, SIDE) if x > 0 => DVec3::Z,
            _ => DVec3::NEG_X,
        };
        add([top, top_next, low_next], normal);
        add([top, low_next, low], normal);
        add([low, low_next, center], DVec3::NEG_Y);
    }
    Ok(())
}

/// How far around the edge of the square a vertex is; none if it is not on it.
fn around([x, z]: Vertex) -> Option<u64> {
    let (side, x, z) = (u64::from(SIDE), u64::from(x), u64::from(z));
    match (x, z) {
        (x, 0) => Some(x),
        (x, z) if x == side => Some(side + z),
        (x, z) if z == side => Some(2 * side + (side - x)),
        (0, z) => Some(3 * side + (side - z)),
        _ => None,
    }
}

fn middle(a: Vertex, b: Vertex) -> Vertex {
    [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
}

/// The halves of a triangle, seen from the same side.
fn children([a, b, c]: [Vertex; 3], middle: Vertex) -> [[Vertex; 3]; 2] {
    [[c, a, middle], [b, c, middle]]
}

/// The two triangles of the whole square, counter-clockwise from above.
const ROOTS: [[Vertex; 3]; 2] = [[[0, 0], [SIDE, SIDE], [SIDE, 0]], [[SIDE, SIDE], [0, 0], [0, SIDE]]];

/// The longest side that has a middle, and the corners of the two triangles at it; none beyond the edge of the square.
fn diamond(middle: Vertex) -> ([Vertex; 2], [Option<Vertex>; 2]) {
    let [x, z] = middle;
    let step = 1 << (x | z).trailing_zeros();
    let at = |dx: i64, dz: i64| -> Option<Vertex> {
        let to =
            |from: u32, by: i64| u32::try_from(i64::from(from) + by * i64::from(step)).ok().filter(|to| *to <= SIDE);
        Some([to(x, dx)?, to(z, dz)?])
    };
    let inside = |vertex: Option<Vertex>| vertex.unwrap_or(middle);
    let (ends, corners) = match ((x / step) % 2, (z / step) % 2) {
        (1, 1) => {
            // The middle of a square: the diagonal goes between corners of which the coarser square has one as its
            // middle.
            let is_even = ((x / step) / 2 + (z / step) / 2) % 2 == 0;
            if is_even {
                ([at(-1, -1), at(1, 1)], [at(1, -1), at(-1, 1)])
            } else {
                ([at(1, -1), at(-1, 1)], [at(-1, -1), at(1, 1)])
            }
        }
        (1, _) => ([at(-1, 0), at(1, 0)], [at(0, -1), at(0, 1)]),
        _ => ([at(0, -1), at(0, 1)], [at(-1, 0), at(1, 0)]),
    };
    (ends.map(inside), corners)
}
