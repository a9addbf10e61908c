//! Tests of the octree against other algorithms for the same answer.

mod edits;
mod extremes;
mod files;
mod hits;
mod instructions;
mod neighbours;
mod points;
mod sides;
mod structure;
mod tightness;

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::DVec3;

use super::{Hit, Octree, OctreeSettings, Ray, Walk};
use crate::numeric::sampling::{RandomStream, sphere};
use crate::numeric::triangle::Shear;

/// Vertices and triangles.
#[derive(Clone)]
struct Shape {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    fn moved(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        Self { vertices: self.vertices.iter().map(|&p| map(p)).collect(), triangles: self.triangles.clone() }
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.vertices[i as usize])
    }

    fn joined(mut self, other: &Self) -> Self {
        let offset = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
        self
    }

    fn octree(&self) -> Octree {
        Octree::build(&self.vertices, &self.triangles, &OctreeSettings::default()).expect("a sound mesh")
    }

    /// The nearest hit among all triangles by the same exact test that the octree uses, without any cell.
    fn exact(&self, ray: &Ray, octree: &Octree, t_max: f64) -> Option<Hit> {
        let shear = Shear::new(ray, octree.cube.side.recip())?;
        let mut best: Option<Hit> = None;
        for triangle in 0..self.triangles.len() {
            if let Some(c) = shear.intersection(self.corners(triangle))
                && c.t > 0.0
                && c.t < best.map_or(t_max, |hit| hit.t)
            {
                best = Some(Hit { t: c.t, triangle: triangle as u32, u: c.u, v: c.v });
            }
        }
        best
    }
}

/// Both walks of one octree.
fn walks(shape: &Shape) -> [Octree; 2] {
    let octree = shape.octree();
    [octree.clone().with_walk(Walk::LeadingDirection), octree.with_walk(Walk::Index)]
}

/// Asserts that both walks find, bit for bit, what all triangles together say.
fn assert_exact(shape: &Shape, octrees: &[Octree; 2], ray: &Ray, t_max: f64) -> Option<Hit> {
    let expected = shape.exact(ray, &octrees[0], t_max);
    for octree in octrees {
        assert_eq!(octree.closest(ray, 0.0, t_max), expected, "{ray:?} by {:?}", octree.walk);
        assert_eq!(octree.occluded(ray, 0.0, t_max), expected.is_some(), "{ray:?} by {:?}", octree.walk);
    }
    expected
}

/// A sphere of radius 1: an icosahedron whose triangles are quartered again and again.
fn ball(divisions: u32) -> Shape {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices = Vec::new();
    for axis in 0..3 {
        for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3]) = (a, b);
            vertices.push(DVec3::from_array(p).normalize());
        }
    }
    let near = |i: usize, j: usize| vertices[i].distance_squared(vertices[j]) < 1.2;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(i, k) {
                    triangles.push([i as u32, j as u32, k as u32]);
                }
            }
        }
    }
    for _ in 0..divisions {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        let quarter = |[a, b, c]: [u32; 3]| {
            let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(quarter).collect();
    }
    Shape { vertices, triangles }
}

/// A torus around the y axis with radii 1 and 0.4: `3 n` by `n` cells.
fn torus(n: u32) -> Shape {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..3 * n {
        for j in 0..n {
            let (u, v) = (f64::from(i) / f64::from(3 * n) * TAU, f64::from(j) / f64::from(n) * TAU);
            let ring = 1.0 + 0.4 * v.cos();
            vertices.push(DVec3::new(ring * u.cos(), 0.4 * v.sin(), ring * u.sin()));
            let at = |i: u32, j: u32| (i % (3 * n)) * n + j % n;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Shape { vertices, triangles }
}

/// The surface of the cube from -1 to 1, `n` by `n` cells a side; corners are shared within a side.
fn block(n: u32) -> Shape {
    let mut shape = Shape { vertices: Vec::new(), triangles: Vec::new() };
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let start = shape.vertices.len() as u32;
            for i in 0..=n {
                for j in 0..=n {
                    let place = |k: u32| f64::from(k) / f64::from(n) * 2.0 - 1.0;
                    let mut p = [0.0; 3];
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign, place(i), place(j));
                    shape.vertices.push(DVec3::from_array(p));
                    if i < n && j < n {
                        let at = |i: u32, j: u32| start + i * (n + 1) + j;
                        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                        shape.triangles.extend([[a, b, c], [a, c, d]]);
                    }
                }
            }
        }
    }
    shape
}

/// Triangles of all sizes, from the whole unit cube down to `smallest`, anywhere in it.
fn soup(count: u32, smallest: f64, stream: &mut RandomStream) -> Shape {
    let mut vertices = Vec::new();
    for _ in 0..count {
        let centre = DVec3::new(stream.uniform(), stream.uniform(), stream.uniform());
        let size = smallest.powf(stream.uniform());
        vertices.extend([0; 3].map(|_: i32| centre + sphere(stream.point()) * size * 0.5));
    }
    Shape { vertices, triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() }
}

/// A ray from somewhere around a sphere towards somewhere in it.
fn chord(centre: DVec3, radius: f64, stream: &mut RandomStream) -> Ray {
    let origin = centre + sphere(stream.point()) * radius * (0.2 + 2.0 * stream.uniform());
    let target = centre + sphere(stream.point()) * radius * stream.uniform();
    Ray { origin, direction: target - origin }
}
