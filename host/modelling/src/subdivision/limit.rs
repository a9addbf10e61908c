//! The limit surface: where the faces shrink to, and its normals there.
//!
//! In every step a smooth face shrinks towards its centroid, which stays where it is: it is a point of the limit
//! surface. A face at a crease or a border shrinks towards the middle of that side, a face at a sharp vertex towards
//! the vertex. So the limit points are the vertices of a mesh with a face for each vertex of the polyhedron.

use glam::DVec3;
use rayon::prelude::*;

use super::creases::{CornerSets, Creases};
use super::polyhedron::{NONE, Polyhedron};
use super::rings::{Rings, by_face};
use super::weights::{Pinning, held, step, waves};
use crate::mesh::Mesh;

/// So many steps bring the corners of a face that is pinned in several places to the limit within rounding.
const PINNED_STEPS: usize = 80;

/// A limit point and a vector along the surface normal there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Limit {
    pub point: DVec3,
    pub normal: DVec3,
}

/// The triangles between the limit points of all faces of a polyhedron without finite sharpness.
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
    let creases = Creases::of(polyhedron);
    let Limits { of_corners, names, count } = Limits::of(&creases);
    let mut mesh = Mesh { vertices: vec![DVec3::ZERO; count], ..Mesh::default() };
    for (limit, &name) in of_corners.iter().zip(&names).rev().filter(|(_, name)| **name != NONE) {
        mesh.vertices[name as usize] = limit.point;
    }
    creases.each_face(|face, owners| {
        let run = distinct(face, owners, &names);
        for pair in run.get(1..).unwrap_or_default().windows(2) {
            let triangle = [run[0], pair[0], pair[1]];
            mesh.triangles.push(triangle.map(|(name, _)| name));
            mesh.corner_normals.push(triangle.map(|(_, owner)| of_corners[owner as usize].normal));
        }
    });
    mesh
}

/// The names of a closed run of corners, and their owners, without those that bear the name of the one before.
pub(super) fn distinct(face: &[u32], owners: &[u32], names: &[u32]) -> Vec<(u32, u32)> {
    let mut run: Vec<(u32, u32)> =
        face.iter().zip(owners).map(|(&corner, &owner)| (names[corner as usize], owner)).collect();
    run.dedup_by_key(|corner| corner.0);
    while run.len() > 1 && run[0].0 == run[run.len() - 1].0 {
        run.pop();
    }
    run
}

/// Where all corners of a polyhedron without finite sharpness go, and which of them to the same point.
pub(super) struct Limits {
    pub of_corners: Vec<Limit>,
    /// For each corner the number of its point; none for corners that are cut.
    pub names: Vec<u32>,
    /// How many points.
    pub count: usize,
}

impl Limits {
    pub fn of(creases: &Creases<'_>) -> Limits {
        let mesh = creases.mesh;
        let mut joined = CornerSets::new(mesh.corners.len());
        creases.join(&mut joined);
        let rims: Vec<SharpRim> = (0..mesh.face_count()).map(|face| SharpRim::of(creases, face)).collect();
        for (face, rim) in rims.iter().enumerate() {
            let first = mesh.starts[face];
            if rim.is_smooth() {
                (first..mesh.starts[face + 1]).for_each(|corner| joined.join(corner, first));
                continue;
            }
            let attractors = rim.attractors();
            for (corner, &target) in (first..).zip(&attractors.targets) {
                match target {
                    Target::Free if attractors.is_one => joined.join(corner, first),
                    Target::Corner(other) if !creases.cut[corner as usize] => joined.join(corner, first + other as u32),
                    Target::Side(side) if !creases.cut[corner as usize] => {
                        let [start, end] = creases.ends(first + side as u32);
                        joined.join(start, end);
                        joined.join(corner, start);
                    }
                    _ => {}
                }
            }
        }
        let of_corners = by_face(mesh, &|face, limits: &mut [Limit]| {
            let corners: Vec<DVec3> = mesh.face_points(face).collect();
            rims[face].limits(&corners, limits);
        });
        let (names, count) = joined.names(&creases.cut);
        Limits { of_corners, names, count }
    }
}

/// What is sharp for ever around a face; both empty for a smooth face.
#[derive(Clone, Debug, Default)]
pub(super) struct SharpRim {
    /// Whether the side behind each corner is a crease or a border.
    pub creases: Vec<bool>,
    /// Whether each corner is pinned.
    pub pinned: Vec<bool>,
}

impl SharpRim {
    pub fn of(creases: &Creases<'_>, face: usize) -> SharpRim {
        let sides = creases.mesh.starts[face]..creases.mesh.starts[face + 1];
        let vertex = |corner: u32| creases.mesh.corners[corner as usize] as usize;
        let rim = SharpRim {
            creases: sides.clone().map(|side| creases.is_crease(side)).collect(),
            pinned: sides.map(|corner| creases.vertex_pinning[vertex(corner)] == 1.0).collect(),
        };
        if rim.creases.contains(&true) || rim.pinned.contains(&true) { rim } else { SharpRim::default() }
    }

    /// Whether nothing is sharp.
    pub fn is_smooth(&self) -> bool {
        self.pinned.is_empty()
    }

    /// The corners of the face after a step.
    pub fn step(&self, corners: &[DVec3]) -> Vec<DVec3> {
        let count = corners.len();
        let mut new = corners.to_vec();
        step(corners, &mut new);
        if self.is_smooth() {
            return new;
        }
        for (k, new) in new.iter_mut().enumerate() {
            let [before_last, last, next] = [count - 2, count - 1, 1].map(|shift| (k + shift) % count);
            let one = |is: bool| f64::from(u8::from(is));
            let sides = [before_last, last, k, next].map(|side| one(self.creases[side]));
            let hold = Pinning::by(sides, [last, k, next].map(|corner| one(self.pinned[corner])));
            *new = held(corners, k, hold, *new);
        }
        new
    }

    /// Where its corners shrink to; not of a smooth face.
    pub fn attractors(&self) -> Attractors {
        let count = self.pinned.len();
        let mut targets: Vec<Target> =
            (0..count).map(|k| if self.pinned[k] { Target::Corner(k) } else { Target::Free }).collect();
        for k in (0..count).filter(|&k| self.creases[k]) {
            let after = (k + 1) % count;
            match (self.pinned[k], self.pinned[after]) {
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

    /// The limit of the whole face; `None` if it has several.
    pub fn limit(&self, corners: &[DVec3]) -> Option<Limit> {
        if self.is_smooth() {
            return Some(in_the_middle(corners));
        }
        let attractors = self.attractors();
        let first = *attractors.targets.first().filter(|_| attractors.is_one)?;
        Some(first.limit(corners))
    }

    fn limits(&self, corners: &[DVec3], limits: &mut [Limit]) {
        if let Some(limit) = self.limit(corners) {
            limits.fill(limit);
            return;
        }
        let mut settled = corners.to_vec();
        (0..PINNED_STEPS).for_each(|_| settled = self.step(&settled));
        for (k, target) in self.attractors().targets.into_iter().enumerate() {
            limits[k] = target.limit(corners);
            if target == Target::Free {
                limits[k].point = settled[k];
            }
        }
    }
}

/// Where the corners of a face shrink to.
pub(super) struct Attractors {
    /// For each corner of the face; empty if it is smooth.
    pub targets: Vec<Target>,
    /// Whether there is one for the whole face.
    pub is_one: bool,
}

/// Where a corner of a face shrinks to.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Target {
    /// The limit of the smooth face, or what the other targets make of it.
    Free,
    /// The corner of this number in the face.
    Corner(usize),
    /// The middle of the side that begins at the corner of this number.
    Side(usize),
}

impl Target {
    fn limit(self, corners: &[DVec3]) -> Limit {
        let count = corners.len();
        let middle = in_the_middle(corners);
        let (point, normal) = match self {
            Target::Free => return middle,
            Target::Corner(at) => {
                let [next, last] = [corners[(at + 1) % count], corners[(at + count - 1) % count]];
                (corners[at], (next - corners[at]).cross(last - corners[at]))
            }
            Target::Side(at) => {
                let [here, next] = [corners[at], corners[(at + 1) % count]];
                let point = (here + next) * 0.5;
                let inwards = (corners[(at + 2) % count] + corners[(at + count - 1) % count]) * 0.5 - point;
                (point, (next - here).cross(inwards))
            }
        };
        Limit { point, normal: normal.try_normalize().unwrap_or(middle.normal) }
    }
}
