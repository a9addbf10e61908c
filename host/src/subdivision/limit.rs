//! The limit surface: where the faces shrink to, and its normals there.
//!
//! In every step a smooth face shrinks towards its centroid, which stays where it is: it is a point of the limit
//! surface. A face at a crease or a border shrinks towards the middle of that side, a face at a sharp vertex towards the
//! vertex. So the limit points are the vertices of a mesh with a face for each vertex of the polyhedron.

use glam::DVec3;
use rayon::prelude::*;

use super::polyhedron::Polyhedron;
use super::rings::{Rings, by_face};
use super::sharp::{Creases, Joined};
use super::weights::{held, step, waves};
use crate::mesh::Mesh;

/// So many steps bring the corners of a face that is held in several places to the limit within rounding.
const HELD_STEPS: usize = 80;

/// A limit point and a vector along the surface normal there.
#[derive(Clone, Copy, Debug, Default)]
struct Limit {
    point: DVec3,
    normal: DVec3,
}

/// The triangles between the limit points of all faces.
pub(super) fn mesh(polyhedron: &Polyhedron) -> Mesh {
    if polyhedron.is_smooth() { smooth(polyhedron) } else { creased(polyhedron) }
}

fn smooth(polyhedron: &Polyhedron) -> Mesh {
    let points_of = |face| polyhedron.face_points(face).collect::<Vec<_>>();
    let faces = 0..polyhedron.face_count();
    let limits: Vec<Limit> = faces.into_par_iter().map(|face| in_the_middle(&points_of(face))).collect();
    let rings = Rings::of(polyhedron);
    let face_of = polyhedron.face_of();
    let mut mesh = Mesh { vertices: limits.iter().map(|limit| limit.point).collect(), ..Mesh::default() };
    let triangles = rings.corners.len() - 2 * rings.starts.len().saturating_sub(1);
    mesh.triangles.reserve(triangles);
    mesh.corner_normals.reserve(triangles);
    for ends in rings.starts.windows(2) {
        let around = &rings.corners[ends[0] as usize..ends[1] as usize];
        for pair in around[1..].windows(2) {
            let triangle = [around[0], pair[0], pair[1]].map(|corner| face_of[corner as usize]);
            mesh.triangles.push(triangle);
            mesh.corner_normals.push(triangle.map(|face| limits[face as usize].normal));
        }
    }
    mesh
}

/// The limit of a smooth face.
fn in_the_middle(corners: &[DVec3]) -> Limit {
    let point = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let [cosine, sine] = waves(corners);
    Limit { point, normal: cosine.cross(sine).normalize_or_zero() }
}

fn creased(polyhedron: &Polyhedron) -> Mesh {
    let (lasting, positions) = settled(polyhedron);
    let creases = Creases::of(&lasting);
    let mut joined = Joined::new(lasting.corners.len());
    creases.join(&mut joined);
    let settled: Vec<Attractors> = (0..lasting.face_count()).map(|face| Attractors::of(&creases, face)).collect();
    for (face, attractors) in settled.iter().enumerate() {
        attractors.join(lasting.starts[face], &mut joined);
    }
    let limits: Vec<Limit> = by_face(&lasting, &|face, limits: &mut [Limit]| {
        let first = lasting.starts[face] as usize;
        settled[face].limits(&creases, face, &positions[first..first + limits.len()], limits);
    });
    let (names, count) = joined.names();
    let mut mesh = Mesh { vertices: vec![DVec3::ZERO; count], ..Mesh::default() };
    for (corner, limit) in limits.iter().enumerate().rev() {
        mesh.vertices[names[corner] as usize] = limit.point;
    }
    creases.each_face(|face| {
        let mut run: Vec<u32> = face.to_vec();
        run.dedup_by_key(|corner| names[*corner as usize]);
        while run.len() > 1 && names[run[0] as usize] == names[run[run.len() - 1] as usize] {
            run.pop();
        }
        for pair in run.get(1..).unwrap_or_default().windows(2) {
            let triangle = [run[0], pair[0], pair[1]];
            mesh.triangles.push(triangle.map(|corner| names[corner as usize]));
            mesh.corner_normals.push(triangle.map(|corner| limits[corner as usize].normal));
        }
    });
    mesh
}

/// The polyhedron after as many steps as its finite sharpness lasts, without the faces that these steps add: what is
/// sharp for ever, and for each corner its position.
fn settled(polyhedron: &Polyhedron) -> (Polyhedron, Vec<DVec3>) {
    let mut left = polyhedron.clone();
    let mut positions: Vec<DVec3> =
        polyhedron.corners.iter().map(|&vertex| polyhedron.points[vertex as usize]).collect();
    let finite = |sharpness: &f64| *sharpness > 0.0 && *sharpness < f64::INFINITY;
    while left.edge_sharpness.iter().chain(&left.vertex_sharpness).any(finite) {
        positions = Creases::of(&left).moved(&|corner| positions[corner as usize]);
        let all = left.edge_sharpness.iter_mut().chain(&mut left.vertex_sharpness);
        all.for_each(|sharpness| *sharpness = (*sharpness - 1.0).max(0.0));
    }
    (left, positions)
}

/// Where the corners of a face shrink to.
struct Attractors {
    /// For each corner of the face.
    targets: Vec<Target>,
    /// Whether there is one for the whole face.
    is_one: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Target {
    /// The limit of the smooth face, or what the other targets make of it.
    Free,
    /// The corner of this number in the face.
    Corner(usize),
    /// The middle of the side that begins at the corner of this number.
    Side(usize),
}

impl Attractors {
    fn of(creases: &Creases<'_>, face: usize) -> Attractors {
        let mesh = creases.mesh;
        let sides = mesh.starts[face]..mesh.starts[face + 1];
        let count = sides.len();
        let is_held = |k: usize| creases.vertex_hold[mesh.corners[sides.start as usize + k] as usize] == 1.0;
        let mut targets: Vec<Target> =
            (0..count).map(|k| if is_held(k) { Target::Corner(k) } else { Target::Free }).collect();
        for (k, _) in sides.clone().enumerate().filter(|(_, side)| creases.is_crease(*side)) {
            let after = (k + 1) % count;
            match (is_held(k), is_held(after)) {
                (true, true) => {}
                (true, false) => targets[after] = Target::Corner(k),
                (false, true) => targets[k] = Target::Corner(after),
                (false, false) => (targets[k], targets[after]) = (Target::Side(k), Target::Side(k)),
            }
        }
        let mut found = targets.iter().filter(|target| **target != Target::Free);
        let first = found.next().copied().unwrap_or(Target::Free);
        let is_one = found.all(|target| *target == first);
        if is_one {
            targets.fill(first);
        }
        Attractors { targets, is_one }
    }

    fn join(&self, first: u32, joined: &mut Joined) {
        for (k, &target) in self.targets.iter().enumerate() {
            let other = match target {
                Target::Corner(other) | Target::Side(other) => other,
                Target::Free if self.is_one => 0,
                Target::Free => k,
            };
            joined.join(first + k as u32, first + other as u32);
        }
    }

    fn limits(&self, creases: &Creases<'_>, face: usize, corners: &[DVec3], limits: &mut [Limit]) {
        let count = corners.len();
        let middle = in_the_middle(corners);
        let settled = if self.is_one { Vec::new() } else { settled_corners(creases, face, corners) };
        for (k, limit) in limits.iter_mut().enumerate() {
            *limit = match self.targets[k] {
                Target::Free if self.is_one => middle,
                Target::Free => Limit { point: settled[k], ..middle },
                Target::Corner(at) => {
                    let [next, last] = [corners[(at + 1) % count], corners[(at + count - 1) % count]];
                    Limit { point: corners[at], normal: (next - corners[at]).cross(last - corners[at]) }
                }
                Target::Side(at) => {
                    let [here, next] = [corners[at], corners[(at + 1) % count]];
                    let point = (here + next) * 0.5;
                    let inwards = (corners[(at + 2) % count] + corners[(at + count - 1) % count]) * 0.5 - point;
                    Limit { point, normal: (next - here).cross(inwards) }
                }
            };
            limit.normal = limit.normal.try_normalize().unwrap_or(middle.normal);
        }
    }
}

/// The corners of a face that is held in several places, after many steps.
fn settled_corners(creases: &Creases<'_>, face: usize, corners: &[DVec3]) -> Vec<DVec3> {
    let first = creases.mesh.starts[face];
    let holds: Vec<_> = (0..corners.len() as u32).map(|k| creases.held(first + k)).collect();
    let mut positions = corners.to_vec();
    let mut new = positions.clone();
    for _ in 0..HELD_STEPS {
        step(&positions, &mut new);
        for (k, &hold) in holds.iter().enumerate() {
            new[k] = held(&positions, k, hold, new[k]);
        }
        std::mem::swap(&mut positions, &mut new);
    }
    positions
}
