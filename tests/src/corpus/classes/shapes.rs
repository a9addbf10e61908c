//! What cases are made of: bodies, and where they are put.

use super::super::CorpusCase;
use glam::{DAffine3, DVec3};
use host::mesh::Mesh;
use host::surface::{Sphere, Tolerance, box_faces, tessellate};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub(super) fn cube(low: DVec3, high: DVec3) -> Mesh {
    tessellate(&box_faces(low, high), Tolerance::new(1.0, 90.0)).expect("boxes are within all limits")
}

pub(super) fn unit() -> Mesh {
    cube(DVec3::splat(-0.5), DVec3::splat(0.5))
}

pub(super) fn ball(center: DVec3, radius: f64) -> Mesh {
    tessellate(&[Sphere::new(center, radius)], Tolerance::new(0.04 * radius, 90.0))
        .expect("spheres are within all limits")
}

pub(super) fn moved(mesh: &Mesh, by: DAffine3) -> Mesh {
    mesh.transformed(&by)
}

pub(super) fn shifted(mesh: &Mesh, by: DVec3) -> Mesh {
    moved(mesh, DAffine3::from_translation(by))
}

pub(super) fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh, 0));
    all
}

pub(super) fn pair(one: Mesh, two: Mesh) -> CorpusCase {
    CorpusCase::Pair { solids: [one, two], common: None }
}

pub(super) fn vector(random: &mut Pcg64Mcg) -> DVec3 {
    DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)))
}

pub(super) fn direction(random: &mut Pcg64Mcg) -> DVec3 {
    vector(random).normalize_or(DVec3::Z)
}

pub(super) fn power(random: &mut Pcg64Mcg, low: f64, high: f64) -> f64 {
    10f64.powf(random.random_range(low..high))
}

pub(super) fn turned(mesh: &Mesh, random: &mut Pcg64Mcg, angle: f64) -> Mesh {
    moved(mesh, DAffine3::from_axis_angle(direction(random), angle))
}
