//! The rays of the benchmark.

use std::f64::consts::TAU;

use glam::DVec3;
use host::octree::{Octree, Ray};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::shapes::Shape;

/// Rays with a name, and how far they go.
pub struct RaySet {
    /// What they are called in the tables.
    pub name: &'static str,
    /// Each number is exact in single precision.
    pub rays: Vec<Ray>,
    /// Exclusive upper bound of `t`.
    pub t_max: f64,
    /// Whether any hit will do.
    pub any: bool,
}

/// Primary rays of a pinhole camera, diffuse ones from where those hit, shadow rays from there, and random chords.
pub fn sets(shape: &Shape, octree: &Octree, side: usize) -> Vec<RaySet> {
    let (centre, radius) = shape.bounds();
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let eye = centre + DVec3::new(0.55, 0.45, 1.0).normalize() * radius * 2.2;
    let forward = (centre - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let primary: Vec<Ray> = (0..side * side)
        .map(|pixel| {
            let place = |i: usize| ((i as f64 + 0.5) / side as f64 * 2.0 - 1.0) * 0.42;
            let (x, y) = (place(pixel % side), -place(pixel / side));
            single(eye, forward + right * x + up * y)
        })
        .collect();

    let hits: Vec<(DVec3, DVec3)> = primary
        .iter()
        .filter_map(|ray| {
            let hit = octree.closest(ray, 0.0, f64::INFINITY)?;
            let [a, b, c] = shape.triangles[hit.triangle as usize].map(|i| shape.vertices[i as usize]);
            let normal = (b - a).cross(c - a).normalize();
            let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
            Some((ray.at(hit.t) + normal * radius * 1e-4, normal))
        })
        .collect();
    let mut unit = || {
        let z = random.random::<f64>() * 2.0 - 1.0;
        let (sin, cos) = (random.random::<f64>() * TAU).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(r * cos, r * sin, z)
    };
    let count = primary.len();
    let diffuse = (0..count).map(|i| {
        let (point, normal) = hits[i % hits.len()];
        single(point, normal * 1.0001 + unit())
    });
    let diffuse: Vec<Ray> = diffuse.collect();
    let lamp = centre + DVec3::new(-1.0, 1.5, 0.8) * radius;
    let shadow = (0..count).map(|i| {
        let point = hits[i % hits.len()].0;
        single(point, lamp - point)
    });
    let shadow = shadow.collect();
    let random = (0..count).map(|_| {
        let (from, to) = (centre + unit() * radius, centre + unit() * radius);
        single(from, to - from)
    });
    let random = random.collect();
    let set = |name, rays, t_max, any| RaySet { name, rays, t_max, any };
    vec![
        set("primary", primary, f64::INFINITY, false),
        set("diffuse", diffuse, f64::INFINITY, false),
        set("shadow", shadow, 1.0, true),
        set("random", random, f64::INFINITY, false),
    ]
}

fn single(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin: origin.as_vec3().as_dvec3(), direction: direction.as_vec3().as_dvec3() }
}
