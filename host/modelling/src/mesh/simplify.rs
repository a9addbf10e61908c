//! A mesh with fewer triangles: edges collapse to points, those first with which least changes.
//!
//! # Model
//! Each vertex knows the planes of the triangles that went into it; the error of a position is the sum of squared
//! distances to them, by their areas. Planes that stand on the border hold it. A part of the distances to the vertices
//! themselves counts too, which keeps triangles compact where the surface is flat. An edge does not collapse if that
//! would join the surface to itself elsewhere, or turn a triangle over.
//!
//! # Source
//! Garland and Heckbert 1997, Surface simplification using quadric error metrics; link condition of Dey et al. 1999.
//!
//! # Cost
//! n log n for n triangles.

use super::Mesh;
use glam::{DMat3, DVec3};
use std::{
    cmp::Ordering,
    collections::{BinaryHeap, HashMap},
    ops::AddAssign,
};

/// What the distance to a vertex counts, of that to a plane.
const COMPACTNESS: f64 = 1e-3;
/// What a plane on the border counts, of one of the surface.
const BORDER: f64 = 10.0;
/// Least cosine between the normals of a triangle before and after.
const LEAST_COSINE: f64 = 0.2;

impl Mesh {
    /// The mesh with at most so many triangles, if that can be had without changing how it is connected. Vertices at
    /// one position become one; normals, parameters and surfaces are dropped.
    pub fn simplified(&self, triangles: usize) -> Mesh {
        let mut collapse = Collapse::new(self.welded());
        while collapse.left > triangles {
            let Some(candidate) = collapse.candidates.pop() else { break };
            collapse.carry_out(&candidate);
        }
        let left = collapse.triangles.iter().filter(|t| **t != GONE).copied().collect();
        let mesh = Mesh { vertices: collapse.vertices, triangles: left, ..Mesh::default() };
        mesh.welded()
    }
}

/// A triangle that is there no longer.
const GONE: [u32; 3] = [u32::MAX; 3];

/// Sum of weighted squared distances: x·Ax + 2 b·x + c.
#[derive(Clone, Copy, Debug)]
struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Quadric {
    const ZERO: Quadric = Quadric { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 };

    /// The distance to the plane through a point.
    fn plane(normal: DVec3, point: DVec3, weight: f64) -> Quadric {
        let d = -normal.dot(point);
        let a = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        Quadric { a: a * weight, b: normal * (d * weight), c: d * d * weight }
    }

    fn point(point: DVec3, weight: f64) -> Quadric {
        Quadric {
            a: DMat3::from_diagonal(DVec3::splat(weight)),
            b: -point * weight,
            c: point.length_squared() * weight,
        }
    }

    fn at(&self, x: DVec3) -> f64 {
        x.dot(self.a * x) + 2.0 * self.b.dot(x) + self.c
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Quadric) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
    }
}

/// An edge that may collapse.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    error: f64,
    ends: [u32; 2],
    /// How often its ends had moved when it was weighed.
    moves: [u32; 2],
    position: DVec3,
}

impl Ord for Candidate {
    /// The smallest error is the greatest; equal ones by their ends, so that the order is always the same.
    fn cmp(&self, other: &Candidate) -> Ordering {
        other.error.total_cmp(&self.error).then_with(|| other.ends.cmp(&self.ends))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

struct Collapse {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The triangles at each vertex; some may be gone.
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    moves: Vec<u32>,
    candidates: BinaryHeap<Candidate>,
    left: usize,
}

impl Collapse {
    fn new(mesh: Mesh) -> Collapse {
        let Mesh { vertices, mut triangles, .. } = mesh;
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        let mut around = vec![Vec::new(); vertices.len()];
        let mut quadrics = vec![Quadric::ZERO; vertices.len()];
        let mut sides: HashMap<[u32; 2], (usize, u32)> = HashMap::new();
        for (number, triangle) in (0..).zip(&triangles) {
            let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
            let cross = (b - a).cross(c - a);
            let (normal, area) = (cross.normalize_or_zero(), cross.length() / 2.0);
            for (k, corner) in triangle.iter().enumerate() {
                around[*corner as usize].push(number);
                let quadric = &mut quadrics[*corner as usize];
                *quadric += Quadric::plane(normal, a, area);
                *quadric += Quadric::point(vertices[*corner as usize], area * COMPACTNESS);
                let next = triangle[(k + 1) % 3];
                sides.entry([*corner.min(&next), *corner.max(&next)]).or_insert((0, number)).0 += 1;
            }
        }
        let mut sides: Vec<([u32; 2], (usize, u32))> = sides.into_iter().collect();
        sides.sort_unstable();
        for (ends, (_, triangle)) in sides.iter().filter(|(_, (count, _))| *count == 1) {
            let [a, b, c] = triangles[*triangle as usize].map(|corner| vertices[corner as usize]);
            let [from, to] = ends.map(|end| vertices[end as usize]);
            let upright = (b - a).cross(c - a).cross(to - from).normalize_or_zero();
            for end in ends {
                quadrics[*end as usize] += Quadric::plane(upright, from, BORDER * (to - from).length_squared());
            }
        }
        let (left, moves) = (triangles.len(), vec![0; vertices.len()]);
        let mut collapse =
            Collapse { vertices, triangles, around, quadrics, moves, candidates: BinaryHeap::new(), left };
        sides.iter().for_each(|(ends, _)| collapse.weigh(*ends));
        collapse
    }

    fn weigh(&mut self, ends: [u32; 2]) {
        let [a, b] = ends.map(|end| end as usize);
        let mut sum = self.quadrics[a];
        sum += self.quadrics[b];
        let (from, to) = (self.vertices[a], self.vertices[b]);
        let middle = (from + to) / 2.0;
        // Where nothing pulls, as at triangles without area, the middle is as good.
        let best = Some(sum.a.inverse() * -sum.b).filter(|p| p.distance(middle) <= 2.0 * from.distance(to));
        let place = best.unwrap_or(middle);
        let moves = [self.moves[a], self.moves[b]];
        self.candidates.push(Candidate { error: sum.at(place), ends, moves, position: place });
    }

    fn corners_around(&self, vertex: u32) -> Vec<u32> {
        let triangles = self.around[vertex as usize].iter().map(|t| self.triangles[*t as usize]);
        let mut corners: Vec<u32> = triangles.filter(|t| *t != GONE).flatten().filter(|c| *c != vertex).collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    }

    /// Whether a surface stays the surface it was: the ends have no neighbours in common but those across the edge,
    /// no two borders grow together, and what is left is more than one triangle or two back to back.
    fn preserves_topology(&self, [a, b]: [u32; 2]) -> bool {
        let [near_a, near_b] = [a, b].map(|end| self.corners_around(end));
        let common = near_a.iter().filter(|corner| near_b.binary_search(corner).is_ok()).count();
        let triangles = |vertex: u32| self.around[vertex as usize].iter().map(|t| self.triangles[*t as usize]);
        let at_edge = triangles(a).filter(|t| t.contains(&b)).count();
        let is_border = |vertex: u32, near: &[u32]| {
            near.iter().any(|other| triangles(vertex).filter(|t| t.contains(other)).count() == 1)
        };
        common == at_edge
            && (at_edge == 1 || at_edge == 2 && !(is_border(a, &near_a) && is_border(b, &near_b)))
            && near_a.len() + near_b.len() - common > at_edge + 2
    }

    /// Whether no triangle at a vertex turns over when it moves, but those that go with the other end.
    fn preserves_orientation(&self, vertex: u32, other: u32, place: DVec3) -> bool {
        let triangles = self.around[vertex as usize].iter().map(|t| self.triangles[*t as usize]);
        let mut staying = triangles.filter(|t| *t != GONE && !t.contains(&other));
        staying.all(|t| {
            let before = t.map(|corner| self.vertices[corner as usize]);
            let after = t.map(|corner| if corner == vertex { place } else { self.vertices[corner as usize] });
            let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
            normal(before).dot(normal(after)) > LEAST_COSINE
        })
    }

    fn carry_out(&mut self, candidate: &Candidate) {
        let &Candidate { ends: [a, b], moves, position: place, .. } = candidate;
        let (from, to) = (a as usize, b as usize);
        let is_old = [self.moves[from], self.moves[to]] != moves;
        if is_old
            || !self.preserves_topology([a, b])
            || !self.preserves_orientation(a, b, place)
            || !self.preserves_orientation(b, a, place)
        {
            return;
        }
        for number in std::mem::take(&mut self.around[to]) {
            let triangle = &mut self.triangles[number as usize];
            if triangle.contains(&a) {
                *triangle = GONE;
                self.left -= 1;
            } else if *triangle != GONE {
                triangle.iter_mut().filter(|corner| **corner == b).for_each(|corner| *corner = a);
                self.around[from].push(number);
            }
        }
        self.around[from].retain(|t| self.triangles[*t as usize] != GONE);
        self.vertices[from] = place;
        let absorbed = self.quadrics[to];
        self.quadrics[from] += absorbed;
        self.moves[from] += 1;
        self.moves[to] += 1;
        for corner in self.corners_around(a) {
            self.weigh([a.min(corner), a.max(corner)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn a_bunny_of_two_thousand_triangles_is_still_closed_and_as_large() {
        let bunny = mesh::bunny().expect("it ships");
        let small = bunny.simplified(2_000);
        assert_eq!(small.triangles.len(), 2_000);
        assert!(small.is_closed() && small.validate().is_ok());
        assert_eq!(small.vertices.len(), 1_002, "Euler: as many handles as before");
        assert!((small.signed_volume() / bunny.signed_volume() - 1.0).abs() < 0.01);
        assert_eq!(small, bunny.simplified(2_000));
    }

    #[test]
    fn a_flat_square_keeps_its_border() {
        let n = 20;
        let at = |i: u32, k: u32| i * (n + 1) + k;
        let vertices = (0..=n).flat_map(|i| (0..=n).map(move |k| DVec3::new(f64::from(i), f64::from(k), 0.0)));
        let cell = |i, k| [[at(i, k), at(i + 1, k), at(i + 1, k + 1)], [at(i, k), at(i + 1, k + 1), at(i, k + 1)]];
        let triangles = (0..n).flat_map(|i| (0..n).flat_map(move |k| cell(i, k)));
        let square = Mesh { vertices: vertices.collect(), triangles: triangles.collect(), ..Mesh::default() };
        let small = square.simplified(40);
        assert!(small.triangles.len() <= 40);
        let areas = (0..small.triangles.len()).map(|t| {
            let [a, b, c] = small.corners(t);
            (b - a).cross(c - a).z / 2.0
        });
        let areas: Vec<f64> = areas.collect();
        assert!(areas.iter().all(|area| *area > 0.0), "none is turned over");
        assert!((areas.iter().sum::<f64>() - 400.0).abs() < 4.0, "{}", areas.iter().sum::<f64>());
    }

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn what_cannot_be_made_smaller_stays() {
        let tetrahedron = Mesh {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
            ..Mesh::default()
        };
        assert_eq!(tetrahedron.simplified(0), tetrahedron.simplified(4));
        assert_eq!(tetrahedron.simplified(0).triangles.len(), 4);
        assert_eq!(Mesh::default().simplified(0), Mesh::default());
        let bunny = mesh::bunny().expect("it ships");
        assert_eq!(bunny.simplified(100_000).triangles.len(), bunny.triangles.len());
    }
}
