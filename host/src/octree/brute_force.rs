//! What rays hit, by other means than the octree: for comparison.

use glam::DVec3;

use super::{Hit, Ray};

/// Finds the nearest hit with `t_min < t < t_max` among all triangles.
///
/// Determinants of the edge vectors in plain double precision, no cells, no exact signs: where a ray passes within
/// rounding of an edge it may see another triangle than the octree, or none.
///
/// # Source
/// Möller and Trumbore 1997.
pub fn closest(vertices: &[DVec3], triangles: &[[u32; 3]], ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for (index, &corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|i| vertices[i as usize]);
        let limit = best.map_or(t_max, |hit| hit.t);
        if let Some(hit) = hit(a, b, c, ray, index as u32)
            && hit.t > t_min
            && hit.t < limit
        {
            best = Some(hit);
        }
    }
    best
}

fn hit(a: DVec3, b: DVec3, c: DVec3, ray: &Ray, triangle: u32) -> Option<Hit> {
    let (e1, e2) = (b - a, c - a);
    let p = ray.direction.cross(e2);
    let determinant = e1.dot(p);
    let from_a = ray.origin - a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(e1);
    let v = ray.direction.dot(q) / determinant;
    let t = e2.dot(q) / determinant;
    (determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t.is_finite()).then_some(Hit { t, triangle, u, v })
}
