//! Ray hits by other means than the octree: for comparison.
//!
//! Nothing here knows cells, codes or exact signs. One ray tests all triangles; many rays share the work by halving the
//! triangles and dropping the rays that miss a half, without storing anything.

use glam::DVec3;
use rayon::prelude::*;

use super::{Hit, Ray};

/// No fewer triangles than this are halved.
const FEW_TRIANGLES: usize = 8;

/// Rays that one thread takes at a time.
const BLOCK: usize = 1 << 16;

/// Relative difference of double-precision results that count as equal.
const EQUAL: f64 = 1e-9;

/// Finds the nearest hit with `t_min < t < t_max` among all triangles.
///
/// Determinants of the edge vectors in plain double precision: where a ray passes within rounding of an edge it may
/// see another triangle than the octree, or none.
///
/// # Source
/// Möller and Trumbore 1997.
pub fn closest(vertices: &[DVec3], triangles: &[[u32; 3]], ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
    let mut best = None;
    for index in 0..triangles.len() as u32 {
        improve(&mut best, vertices, triangles, index, ray, t_min, t_max);
    }
    best
}

/// Finds the nearest hit of each of many rays, as [`closest`] does.
///
/// Costs about a logarithm of the number of triangles per ray, on all threads; the result does not depend on them.
///
/// # Source
/// Mora 2011, "Naive ray tracing: a divide-and-conquer approach".
pub fn closest_many(
    vertices: &[DVec3],
    triangles: &[[u32; 3]],
    rays: &[Ray],
    t_min: f64,
    t_max: f64,
) -> Vec<Option<Hit>> {
    let blocks = rays.par_chunks(BLOCK).map(|rays| {
        let mut block = Block { vertices, triangles, rays, t_min, t_max, best: vec![None; rays.len()] };
        let mut active: Vec<u32> = (0..rays.len() as u32).collect();
        let mut indices: Vec<u32> = (0..triangles.len() as u32).collect();
        block.halve(&mut indices, &mut active);
        block.best
    });
    blocks.flatten_iter().collect()
}

/// How two answers for the same ray compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Agreement {
    /// Both miss, or both hit the same triangle at the same place.
    Same,
    /// They differ, but only within rounding: two triangles at the same distance, or a hit on an edge.
    Tie,
    /// They contradict each other.
    Differ,
}

/// Compares two answers for the same ray.
pub fn agreement(one: Option<Hit>, other: Option<Hit>) -> Agreement {
    let on_edge = |hit: Hit| hit.u.min(hit.v).min(1.0 - hit.u - hit.v) < EQUAL;
    match (one, other) {
        (None, None) => Agreement::Same,
        (Some(a), Some(b)) => {
            let near = (a.t - b.t).abs() <= EQUAL * a.t.abs().max(b.t.abs());
            match (near, a.triangle == b.triangle) {
                (true, true) => Agreement::Same,
                (true, false) => Agreement::Tie,
                (false, _) if on_edge(if a.t < b.t { a } else { b }) => Agreement::Tie,
                (false, _) => Agreement::Differ,
            }
        }
        (Some(hit), None) | (None, Some(hit)) if on_edge(hit) => Agreement::Tie,
        _ => Agreement::Differ,
    }
}

struct Block<'a> {
    vertices: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    rays: &'a [Ray],
    t_min: f64,
    t_max: f64,
    best: Vec<Option<Hit>>,
}

impl Block<'_> {
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|i| self.vertices[i as usize])
    }

    fn halve(&mut self, triangles: &mut [u32], rays: &mut [u32]) {
        let (low, high) = triangles.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &triangle| {
            let [a, b, c] = self.corners(triangle);
            (low.min(a).min(b).min(c), high.max(a).max(b).max(c))
        });
        let mut kept = 0;
        for i in 0..rays.len() {
            if self.may_meet(rays[i], low, high) {
                rays.swap(i, kept);
                kept += 1;
            }
        }
        let rays = &mut rays[..kept];
        if rays.is_empty() {
            return;
        }
        if triangles.len() <= FEW_TRIANGLES {
            for &ray in rays.iter() {
                for &triangle in triangles.iter() {
                    let (t_min, t_max) = (self.t_min, self.t_max);
                    let best = &mut self.best[ray as usize];
                    improve(best, self.vertices, self.triangles, triangle, &self.rays[ray as usize], t_min, t_max);
                }
            }
            return;
        }
        let extent = (high - low).to_array();
        let axis = (0..3).max_by(|&i, &j| extent[i].total_cmp(&extent[j])).unwrap_or(0);
        let middle = triangles.len() / 2;
        let place = |triangle: u32| self.corners(triangle).iter().map(|p| p[axis]).sum::<f64>();
        triangles.select_nth_unstable_by(middle, |&i, &j| place(i).total_cmp(&place(j)).then(i.cmp(&j)));
        let (first, second) = triangles.split_at_mut(middle);
        self.halve(first, rays);
        self.halve(second, rays);
    }

    /// Whether a ray may hit a box before its best hit so far; in doubt it may.
    fn may_meet(&self, ray: u32, low: DVec3, high: DVec3) -> bool {
        let Ray { origin, direction } = self.rays[ray as usize];
        let scale = origin.abs().max(low.abs()).max(high.abs()).max_element();
        let margin = DVec3::splat(scale * 1e-12);
        let (low, high) = (low - margin - origin, high + margin - origin);
        let limit = self.best[ray as usize].map_or(self.t_max, |hit| hit.t);
        let (mut enter, mut exit) = (self.t_min, limit);
        for axis in 0..3 {
            if direction[axis] == 0.0 {
                if low[axis] > 0.0 || high[axis] < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low[axis] / direction[axis], high[axis] / direction[axis]);
            enter = enter.max(a.min(b));
            exit = exit.min(a.max(b));
        }
        let slack = scale * EQUAL / direction.length();
        let apart = enter - enter.abs() * EQUAL > exit + exit.abs() * EQUAL + slack;
        !apart
    }
}

fn improve(
    best: &mut Option<Hit>,
    vertices: &[DVec3],
    triangles: &[[u32; 3]],
    index: u32,
    ray: &Ray,
    t_min: f64,
    t_max: f64,
) {
    let [a, b, c] = triangles[index as usize].map(|i| vertices[i as usize]);
    let Some(hit) = hit(a, b, c, ray, index) else { return };
    let nearer = match *best {
        Some(best) => hit.t < best.t || (hit.t == best.t && index < best.triangle),
        None => hit.t < t_max,
    };
    if nearer && hit.t > t_min {
        *best = Some(hit);
    }
}

fn hit(a: DVec3, b: DVec3, c: DVec3, ray: &Ray, triangle: u32) -> Option<Hit> {
    let (e1, e2) = (b - a, c - a);
    let p = ray.direction.cross(e2);
    let determinant = e1.dot(p);
    let from_a = ray.origin - a;
    let u = from_a.dot(p) / determinant;
    if determinant == 0.0 || !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = from_a.cross(e1);
    let v = ray.direction.dot(q) / determinant;
    let t = e2.dot(q) / determinant;
    (v >= 0.0 && u + v <= 1.0 && t.is_finite()).then_some(Hit { t, triangle, u, v })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::{RandomStream, sphere};

    #[test]
    fn many_rays_hit_what_each_hits_alone() {
        let mut stream = RandomStream::new(1, 0);
        let vertices: Vec<DVec3> = (0..900).map(|_| sphere(stream.point()) * stream.uniform()).collect();
        let triangles: Vec<[u32; 3]> = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let rays: Vec<Ray> = (0..500)
            .map(|i| {
                let origin = sphere(stream.point()) * 2.0;
                let target = sphere(stream.point()) * 0.5;
                Ray { origin, direction: if i % 5 == 0 { DVec3::X } else { target - origin } }
            })
            .collect();
        let many = closest_many(&vertices, &triangles, &rays, 0.0, 2.5);
        let alone: Vec<_> = rays.iter().map(|ray| closest(&vertices, &triangles, ray, 0.0, 2.5)).collect();
        assert_eq!(many, alone);
        assert!(many.iter().flatten().count() > 50);
    }

    #[test]
    fn only_rounding_counts_as_a_tie() {
        let hit = |t, triangle, u| Some(Hit { t, triangle, u, v: 0.25 });
        assert_eq!(agreement(hit(1.0, 3, 0.5), hit(1.0, 3, 0.5)), Agreement::Same);
        assert_eq!(agreement(hit(1.0, 3, 0.5), hit(1.0, 4, 0.5)), Agreement::Tie);
        assert_eq!(agreement(hit(1.0, 3, 0.5), hit(1.1, 4, 0.5)), Agreement::Differ);
        assert_eq!(agreement(hit(1.0, 3, 0.0), None), Agreement::Tie);
        assert_eq!(agreement(hit(1.0, 3, 0.5), None), Agreement::Differ);
    }
}
