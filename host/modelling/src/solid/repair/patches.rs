//! Patches that close loops of edges.

use super::super::boolean::filled;
use crate::mesh::BoundaryLoop;
use glam::DVec3;
use std::collections::HashMap;

/// Most points of a loop for which the patch of least area is looked for: time grows with the third power.
const MOST_POINTS: usize = 1000;
/// Part of the length of a loop within which its points are in one plane.
const FLAT: f64 = 1e-6;
/// A triangle is folded back onto that beside it if the cosine between their normals is less.
const FOLDED: f64 = -0.8;
/// What the squared length of a side of a triangle counts beside the area, so that of patches of about the same area
/// one with short sides is taken.
const SHAPE: f64 = 1e-6;

/// Triangles that close loops, and a vertex that some of them share if they need one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClosingPatch {
    /// Corners; the vertex that is added has the number after that of the last one.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The vertex that is added.
    pub(super) vertex: Option<DVec3>,
}

/// How patches are made, the better ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    /// Triangles that wind as the loops do, seen along the axis that is nearest to their normal.
    Projected,
    /// Of least area, through the points of one loop.
    LeastArea,
    /// Around the mean of the points of one loop.
    Fan,
}

/// The plane of a loop: its normal, whose length is twice the area that the loop encloses there, and the mean of its
/// points.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoopPlane {
    pub(super) normal: DVec3,
    pub(super) mean: DVec3,
    /// Whether all points are in it, but for a part of the length of the loop.
    pub(super) is_flat: bool,
}

impl LoopPlane {
    /// The plane that fits a loop, by the sum of the areas between its edges and a point.
    ///
    /// # Source
    /// The method of Newell, in Sutherland, Sproull and Schumacker 1974.
    pub(super) fn of(boundary: &BoundaryLoop, positions: &[DVec3]) -> LoopPlane {
        let BoundaryLoop(points) = boundary;
        let at = |point: &u32| positions[*point as usize];
        let mean = points.iter().map(at).sum::<DVec3>() / points.len() as f64;
        let normal: DVec3 = boundary.edges().map(|[p, q]| (at(&p) - mean).cross(at(&q) - mean)).sum();
        let unit = normal.normalize_or_zero();
        let near = FLAT * boundary.length(positions);
        let is_flat = unit != DVec3::ZERO && points.iter().all(|point| (at(point) - mean).dot(unit).abs() <= near);
        LoopPlane { normal, mean, is_flat }
    }

    /// Whether another plane is the same, whichever way it faces, but for a part of a length.
    pub(super) fn is_same(&self, other: &LoopPlane, length: f64) -> bool {
        let (one, two) = (self.normal.normalize_or_zero(), other.normal.normalize_or_zero());
        one.cross(two).length() <= FLAT && (other.mean - self.mean).dot(one).abs() <= FLAT * length
    }

    /// A number that differs by at most one for planes that are the same.
    pub(super) fn direction(&self) -> i64 {
        (self.normal.normalize_or_zero().abs().x / (4.0 * FLAT)) as i64
    }

    fn axis(&self) -> usize {
        self.normal.abs().max_position()
    }
}

impl Method {
    /// The methods for one loop, those that serve it best first.
    pub(super) fn of(BoundaryLoop(points): &BoundaryLoop, plane: &LoopPlane) -> &'static [Method] {
        match plane.is_flat {
            _ if points.len() == 3 => &[Method::LeastArea],
            true => &[Method::Projected, Method::LeastArea, Method::Fan],
            false => &[Method::LeastArea, Method::Projected, Method::Fan],
        }
    }

    /// A patch for loops, if there is one; only what is seen can close several at once.
    ///
    /// - `third_corners`: for edges of the loops the third corner of the triangle there.
    pub(super) fn patch(
        self,
        loops: &[&BoundaryLoop],
        plane: &LoopPlane,
        positions: &[DVec3],
        third_corners: &ThirdCorners,
    ) -> Option<ClosingPatch> {
        let points: Vec<&[u32]> = loops.iter().map(|BoundaryLoop(points)| points.as_slice()).collect();
        match (self, &points[..]) {
            (Method::Projected, _) => {
                let triangles = filled(plane.axis(), positions, &points)?;
                Some(ClosingPatch { triangles, vertex: None })
            }
            (Method::LeastArea, [points]) if points.len() <= MOST_POINTS => {
                Some(ClosingPatch { triangles: least_area(points, positions, third_corners), vertex: None })
            }
            (Method::Fan, [points]) => {
                let center = positions.len() as u32;
                let triangles = loops[0].edges().map(|[from, to]| [from, to, center]).collect();
                let mean = points.iter().map(|&point| positions[point as usize]).sum::<DVec3>() / points.len() as f64;
                Some(ClosingPatch { triangles, vertex: Some(mean) })
            }
            _ => None,
        }
    }
}

/// For an edge of a boundary loop, as it runs, the third corner of the triangle there.
pub(super) type ThirdCorners = HashMap<[u32; 2], u32>;

/// The triangles through the points of a loop whose areas have the least sum, of those that are folded back onto
/// triangles beside the loop as seldom as can be.
///
/// # Source
/// Barequet and Sharir 1995, by the recursion of Klincsek 1980.
fn least_area(points: &[u32], positions: &[DVec3], third_corners: &ThirdCorners) -> Vec<[u32; 3]> {
    let count = points.len();
    let at = |k: usize| positions[points[k] as usize];
    // The unit normal of the triangle beside each edge of the loop.
    let normal_beside: Vec<DVec3> = (0..count)
        .map(|k| {
            let (from, to) = (points[k], points[(k + 1) % count]);
            let Some(&third) = third_corners.get(&[from, to]) else { return DVec3::ZERO };
            let [p, q, r] = [to, from, third].map(|point| positions[point as usize]);
            (q - p).cross(r - p).normalize_or_zero()
        })
        .collect();
    // More than all areas that do not fold.
    let fold = (0..count).map(|k| at(k).distance(at((k + 1) % count))).sum::<f64>().powi(2);
    let folded = |normal: DVec3, from: usize, to: usize, size: f64| {
        let edge = if to == (from + 1) % count { from } else { return 0.0 };
        if normal.dot(normal_beside[edge]) < FOLDED * size { fold } else { 0.0 }
    };
    // The least sum for the part of the loop from one point to another, and the third corner of the triangle there.
    let mut least = vec![0.0; count * count];
    let mut third = vec![0; count * count];
    for span in 2..count {
        for from in 0..count - span {
            let to = from + span;
            let (p, q) = (at(from), at(to));
            let chord = SHAPE * p.distance_squared(q);
            let mut best = (f64::INFINITY, 0);
            for between in from + 1..to {
                let normal = (at(between) - p).cross(q - p);
                let size = normal.length();
                let back = [(from, between), (between, to), (to, from)].map(|(p, q)| folded(normal, p, q, size));
                let sum = least[from * count + between]
                    + least[between * count + to]
                    + 0.5 * size
                    + chord
                    + back.iter().sum::<f64>();
                if sum < best.0 {
                    best = (sum, between);
                }
            }
            (least[from * count + to], third[from * count + to]) = best;
        }
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut open = vec![(0, count - 1)];
    while let Some((from, to)) = open.pop() {
        if to - from > 1 {
            let between = third[from * count + to];
            triangles.push([points[from], points[between], points[to]]);
            open.extend([(from, between), (between, to)]);
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(count: u32, height: impl Fn(f64) -> f64) -> (BoundaryLoop, Vec<DVec3>) {
        let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let place = |k: u32| DVec3::new(angle(k).cos(), angle(k).sin(), height(angle(k)));
        (BoundaryLoop((0..count).collect()), (0..count).map(place).collect())
    }

    /// Every edge of the loop once, as it runs, and all others both ways.
    fn closes(boundary: &BoundaryLoop, patch: &ClosingPatch) -> bool {
        let mut net = std::collections::BTreeMap::<[u32; 2], i32>::new();
        for &[a, b, c] in &patch.triangles {
            for [p, q] in [[a, b], [b, c], [c, a]] {
                *net.entry([p.min(q), p.max(q)]).or_default() += if p < q { 1 } else { -1 };
            }
        }
        for [p, q] in boundary.edges() {
            *net.entry([p.min(q), p.max(q)]).or_default() -= if p < q { 1 } else { -1 };
        }
        net.values().all(|net| *net == 0)
    }

    #[test]
    fn every_method_closes_the_loop_that_it_is_given() {
        for (height, is_flat) in [(0.0, true), (0.3, false)] {
            for back in [false, true] {
                let (mut boundary, positions) = ring(40, |angle| height * (2.0 * angle).sin());
                if back {
                    boundary.0.reverse();
                }
                let plane = LoopPlane::of(&boundary, &positions);
                assert_eq!(plane.is_flat, is_flat);
                assert_eq!(plane.normal.z > 0.0, !back);
                for method in Method::of(&boundary, &plane) {
                    let patch = method
                        .patch(&[&boundary], &plane, &positions, &ThirdCorners::new())
                        .expect("the loop is plain");
                    assert!(closes(&boundary, &patch), "{method:?}");
                    assert_eq!(patch.triangles.len(), if *method == Method::Fan { 40 } else { 38 });
                }
            }
        }
    }

    #[test]
    fn of_the_patches_of_a_bent_loop_the_least_has_the_least_area() {
        // Two unit squares at a right angle, with a common side that the loop leaves out.
        let positions: Vec<DVec3> = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1], [0, 1, 0]]
            .map(|[x, y, z]: [i32; 3]| glam::IVec3::new(x, y, z).as_dvec3())
            .to_vec();
        let boundary = BoundaryLoop((0..6).collect());
        let triangles = least_area(&boundary.0, &positions, &ThirdCorners::new());
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|p| positions[p as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        let sum: f64 = triangles.iter().map(|corners| area(*corners)).sum();
        assert!((sum - 2.0).abs() < 1e-12, "{sum}");
    }

    #[test]
    fn a_loop_that_is_long_has_no_patch_of_least_area() {
        let (boundary, positions) = ring(2 * MOST_POINTS as u32, |angle| angle.sin());
        let plane = LoopPlane::of(&boundary, &positions);
        assert!(Method::LeastArea.patch(&[&boundary], &plane, &positions, &ThirdCorners::new()).is_none());
        assert!(Method::Projected.patch(&[&boundary], &plane, &positions, &ThirdCorners::new()).is_some());
    }

    #[test]
    fn a_patch_is_not_folded_back_onto_the_triangle_beside_it() {
        // A loop around a unit square, but that a point above one side is between its ends.
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let positions = [&positions[..], &[DVec3::new(-0.1, 0.5, 0.5)]].concat();
        let boundary = BoundaryLoop(vec![0, 1, 2, 3, 4]);
        let is_ear = |corners: &&[u32; 3]| [3, 4, 0].iter().all(|corner| corners.contains(corner));
        let free = least_area(&boundary.0, &positions, &ThirdCorners::new());
        assert_eq!(free.iter().filter(is_ear).count(), 1);
        // The triangle of the surface that has two sides of the loop and lies where that ear would.
        let third_corners = ThirdCorners::from([([3, 4], 0), ([4, 0], 3)]);
        let bound = least_area(&boundary.0, &positions, &third_corners);
        assert_eq!((bound.len(), bound.iter().filter(is_ear).count()), (3, 0));
    }
}
