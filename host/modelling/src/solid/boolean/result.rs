//! The mesh of a result.

use super::arrangement::{Arrangement, Counts};
use super::facets::Facet;
use super::merge::result_triangles;
use super::operand::Operands;
use super::parts::{FaceClassification, Parts};
use super::rounding::{self, NewTriangles, WholeTriangles};
use crate::mesh::Mesh;
use crate::numeric::triangle;
use crate::solid::cleaning::cleaned;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// What an operation gives.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Its border. Normals and parameters of the corners are there if all operands have them; surfaces too, those of
    /// the second operand counted on from those of the first.
    pub mesh: Mesh,
    /// For each triangle the operand and the triangle of that operand that it is part of.
    pub sources: Vec<[u32; 2]>,
    /// Work done.
    pub counts: Counts,
}

/// Collects whole and new triangles; points are rounded here. Returns also which are new, and whether rounding may
/// have made the surface cross itself.
pub fn assemble(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    is_whole: &[bool],
    parts: &Parts,
    counts: Counts,
) -> (Outcome, NewTriangles, bool) {
    let tables = CornerTables::of(operands.meshes());
    let mut outcome = Outcome { counts, ..Outcome::default() };
    let classifications = parts.of_triangles(operands, is_whole);
    outcome.reserve(
        classifications.iter().filter(|classification| **classification != FaceClassification::Discarded).count()
            + facets.len(),
    );
    let mut of_vertex = vec![u32::MAX; operands.vertex_count()];
    for (operand, mesh) in operands.meshes().iter().enumerate() {
        let operand = operand as u32;
        let [first_vertex, first] = [operands.first_vertex(operand), operands.first_triangle(operand)];
        for (index, (triangle, &classification)) in
            mesh.triangles.iter().zip(&classifications[first as usize..]).enumerate()
        {
            if classification == FaceClassification::Discarded {
                continue;
            }
            let corners = triangle.map(|vertex| {
                let number = &mut of_vertex[(vertex + first_vertex) as usize];
                if *number == u32::MAX {
                    *number = outcome.mesh.vertices.len() as u32;
                    outcome.mesh.vertices.push(mesh.vertices[vertex as usize]);
                }
                *number
            });
            outcome.push(corners, classification, [operand, index as u32]);
            tables.copy(&mut outcome.mesh, mesh, operand, index, classification);
        }
    }
    let first_facet = outcome.mesh.triangles.len();
    let mut of_point: FxHashMap<u32, u32> = FxHashMap::default();
    let mut is_moved = vec![false; outcome.mesh.vertices.len()];
    let first_vertex = is_moved.len() as u32;
    for piece in result_triangles(operands, arrangement, facets, parts) {
        let corners = piece.corners.map(|point| {
            let number = match arrangement.vertices[point as usize] {
                Some(vertex) => &mut of_vertex[vertex as usize],
                None => of_point.entry(point).or_insert(u32::MAX),
            };
            if *number == u32::MAX {
                *number = outcome.mesh.vertices.len() as u32;
                outcome.mesh.vertices.push(arrangement.points[point as usize].near());
                is_moved.push(!arrangement.points[point as usize].is_exact());
            }
            *number
        });
        let operand = operands.of_triangle(arrangement.triangles[piece.face as usize]);
        let place = corners.map(|corner| outcome.mesh.vertices[corner as usize]);
        let triangle_at = |face: u32, place: DVec3| {
            quad_half_at(operands, arrangement.triangles[face as usize], place) - operands.first_triangle(operand)
        };
        let source = triangle_at(piece.face, (place[0] + place[1] + place[2]) / 3.0);
        let at = [0, 1, 2].map(|k| triangle_at(piece.corner_faces[k], place[k]) as usize);
        outcome.push(corners, piece.classification, [operand, source]);
        let at = if piece.classification == FaceClassification::Reversed { [at[0], at[2], at[1]] } else { at };
        let mesh = operands.meshes()[operand as usize];
        tables.interpolate(&mut outcome.mesh, mesh, operand, source as usize, at);
    }
    let kept = WholeTriangles { classifications, of_vertex };
    let crosses = rounding::crosses(operands, &outcome.mesh, first_facet, &is_moved, &kept);
    let is_free = vec![true; is_moved.len() - first_vertex as usize];
    (outcome, NewTriangles { first: first_facet, first_vertex, is_free, whole: Some(kept) }, crosses)
}

/// The triangle of a face that a point lies in; the face is given by its lower triangle.
fn quad_half_at(operands: &Operands, triangle: u32, place: DVec3) -> u32 {
    let mut halves = operands.halves(triangle);
    let (Some(low), Some(high)) = (halves.next(), halves.next()) else { return triangle };
    let ((names, corners), (beyond, _)) = (operands.corners(low), operands.corners(high));
    let apex = names.iter().position(|name| !beyond.contains(name)).unwrap_or(0);
    let [from, to, apex] = [1, 2, 3].map(|k| corners[(apex + k) % 3]);
    // On which side of the common edge.
    let turn = |p: DVec3| (to - from).cross(p - from);
    if turn(place).dot(turn(apex)) < 0.0 { high } else { low }
}

impl Outcome {
    /// Dissolves triangles without an area; those that are left keep their sources.
    pub fn clean(&mut self) {
        let numbers = (0..self.sources.len() as u32).collect();
        let surfaces = std::mem::replace(&mut self.mesh.surfaces, numbers);
        self.mesh = cleaned(std::mem::take(&mut self.mesh));
        let numbers = std::mem::take(&mut self.mesh.surfaces);
        self.sources = numbers.iter().map(|&n| self.sources[n as usize]).collect();
        if !surfaces.is_empty() {
            self.mesh.surfaces = numbers.iter().map(|&n| surfaces[n as usize]).collect();
        }
    }

    /// Makes room for so many triangles, and half as many vertices.
    fn reserve(&mut self, triangles: usize) {
        self.mesh.triangles.reserve_exact(triangles);
        self.sources.reserve_exact(triangles);
        self.mesh.vertices.reserve(triangles / 2 + 2);
    }

    fn push(&mut self, [a, b, c]: [u32; 3], classification: FaceClassification, source: [u32; 2]) {
        self.mesh.triangles.push(if classification == FaceClassification::Reversed { [a, c, b] } else { [a, b, c] });
        self.sources.push(source);
    }
}

/// What the triangles of all operands have besides their corners.
pub struct CornerTables {
    normals: bool,
    parameters: bool,
    /// Number of the first surface of each operand; none if an operand has no surfaces.
    surfaces: Vec<u32>,
}

impl CornerTables {
    /// Tables that all of some meshes have.
    pub fn of(meshes: &[&Mesh]) -> CornerTables {
        let all = |has: fn(&Mesh) -> bool| meshes.iter().all(|mesh| mesh.triangles.is_empty() || has(mesh));
        let mut surfaces = Vec::new();
        if all(|mesh| !mesh.surfaces.is_empty()) {
            let mut first = 0;
            for mesh in meshes {
                surfaces.push(first);
                first += mesh.surfaces.iter().max().map_or(0, |last| last + 1);
            }
        }
        CornerTables {
            normals: all(|mesh| !mesh.corner_normals.is_empty()),
            parameters: all(|mesh| !mesh.corner_parameters.is_empty()),
            surfaces,
        }
    }

    /// Gives the triangles of a result the surfaces of their sources.
    pub fn name_surfaces(&self, outcome: &mut Outcome, meshes: &[&Mesh]) {
        if !self.surfaces.is_empty() {
            let name = |&[operand, triangle]: &[u32; 2]| {
                self.surfaces[operand as usize] + meshes[operand as usize].surfaces[triangle as usize]
            };
            outcome.mesh.surfaces = outcome.sources.iter().map(name).collect();
        }
    }

    /// For a whole triangle.
    fn copy(&self, result: &mut Mesh, mesh: &Mesh, operand: u32, triangle: usize, classification: FaceClassification) {
        let is_turned = classification == FaceClassification::Reversed;
        if self.normals {
            let [a, b, c] = mesh.corner_normals[triangle];
            result.corner_normals.push(if is_turned { [-a, -c, -b] } else { [a, b, c] });
        }
        if self.parameters {
            let [a, b, c] = mesh.corner_parameters[triangle];
            result.corner_parameters.push(if is_turned { [a, c, b] } else { [a, b, c] });
        }
        self.surface(result, mesh, operand, triangle);
    }

    /// For a whole triangle of a single mesh.
    pub fn take(&self, result: &mut Mesh, mesh: &Mesh, triangle: usize) {
        self.copy(result, mesh, 0, triangle, FaceClassification::Kept);
    }

    fn surface(&self, result: &mut Mesh, mesh: &Mesh, operand: u32, triangle: usize) {
        if let Some(first) = self.surfaces.get(operand as usize) {
            result.surfaces.push(first + mesh.surfaces[triangle]);
        }
    }

    /// For the part of a triangle that was pushed last.
    ///
    /// - `at`: for each corner a triangle beside that one, of one surface with it, that it lies in.
    pub fn interpolate(&self, result: &mut Mesh, mesh: &Mesh, operand: u32, triangle: usize, at: [usize; 3]) {
        self.surface(result, mesh, operand, triangle);
        let Some(last) = result.triangles.len().checked_sub(1).filter(|_| self.normals || self.parameters) else {
            return;
        };
        let corners = result.corners(last);
        let weights = [0, 1, 2].map(|k| triangle::weights(mesh.corners(at[k]), corners[k]));
        if self.normals {
            let sign = if mesh.area_vector(triangle).dot(result.area_vector(last)) >= 0.0 { 1.0 } else { -1.0 };
            let normal = |k: usize| {
                let (normals, w) = (mesh.corner_normals[at[k]], weights[k]);
                let mean = normals[0] * w[0] + normals[1] * w[1] + normals[2] * w[2];
                mean.normalize_or(normals[0]) * sign
            };
            result.corner_normals.push([0, 1, 2].map(normal));
        }
        if self.parameters {
            let parameters = |k: usize| {
                let (uv, w) = (mesh.corner_parameters[at[k]], weights[k]);
                uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2]
            };
            result.corner_parameters.push([0, 1, 2].map(parameters));
        }
    }
}
