//! The winding number of a surface at a point, by a ray from it.

use super::integer::Integer;
use super::predicates::{Points, cross, determinant, difference, dot};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Rays that are tried; one that meets no edge is found sooner.
const RAYS: u64 = 1000;

/// The winding number of a surface just before the centre of one of its triangles, where nothing else is.
///
/// # Panics
/// If every ray that is tried meets an edge.
pub fn before(points: &Points, triangles: &[[u32; 3]], triangle: usize) -> i32 {
    let [a, b, c] = triangles[triangle].map(|corner| points.whole(corner));
    let normal = cross(&difference(&b, &a), &difference(&c, &a));
    // Three times all coordinates, so that the centre is whole too.
    let center = [0, 1, 2].map(|k| &(&a[k] + &b[k]) + &c[k]);
    let middle = triangles[triangle].iter().map(|corner| points.at[*corner as usize] / 3.0).sum();
    let mut random = Pcg64Mcg::seed_from_u64(triangle as u64);
    for _ in 0..RAYS {
        let numbers = [0; 3].map(|_| random.random_range(-1000..=1000i32));
        let ray = numbers.map(|n| Integer::of(f64::from(n), 0));
        let facing = dot(&ray, &normal).sign();
        if facing == 0 {
            continue;
        }
        let (ray, numbers) = if facing > 0 { (ray, numbers) } else { (ray.map(|n| -n), numbers.map(|n| -n)) };
        let line = Line { center: &center, ray: &ray, middle, along: DVec3::from(numbers.map(f64::from)) };
        let others = (0..triangles.len()).filter(|other| *other != triangle);
        let crossings = others.map(|other| line.crossing(points, triangles[other])).sum::<Option<i32>>();
        if let Some(winding) = crossings {
            return winding;
        }
    }
    panic!("every ray meets an edge");
}

/// A ray, exact and rounded.
struct Line<'a> {
    /// Three times where it starts.
    center: &'a [Integer; 3],
    ray: &'a [Integer; 3],
    middle: DVec3,
    along: DVec3,
}

impl Line<'_> {
    /// 1 if the ray leaves through a triangle, -1 if it enters, 0 if it misses; `None` if it meets the border.
    fn crossing(&self, points: &Points, triangle: [u32; 3]) -> Option<i32> {
        if self.is_far(triangle.map(|corner| points.at[corner as usize])) {
            return Some(0);
        }
        let three = Integer::of(3.0, 0);
        let corners = triangle.map(|corner| {
            let thrice = points.whole(corner).map(|x| &x * &three);
            difference(&thrice, self.center)
        });
        let turns = [(0, 1), (1, 2), (2, 0)]
            .map(|(p, q)| determinant([self.ray.clone(), corners[p].clone(), corners[q].clone()]).sign());
        if turns.contains(&1) && turns.contains(&-1) {
            return Some(0);
        }
        if turns.contains(&0) {
            return None;
        }
        // The three turns are the sign of the ray against the normal; the corners', on which side of the start it lies.
        let ahead = determinant(corners).sign() * turns[0];
        Some(if ahead > 0 { turns[0] } else { 0 })
    }

    /// Whether a triangle is certainly off the ray: the line passes its box at a distance that no rounding explains.
    fn is_far(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let slack = 1e-9 * low.abs().max(high.abs()).max(self.middle.abs()).max_element();
        let (mut from, mut to) = (0.0f64, f64::INFINITY);
        for k in 0..3 {
            let [near, far] = [low[k] - slack, high[k] + slack].map(|x| x - self.middle[k]);
            if self.along[k] == 0.0 {
                if near > 0.0 || far < 0.0 {
                    return true;
                }
                continue;
            }
            let (one, two) = (near / self.along[k], far / self.along[k]);
            (from, to) = (from.max(one.min(two)), to.min(one.max(two)));
        }
        from > to * (1.0 + 1e-9) + slack
    }
}
