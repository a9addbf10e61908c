//! Smooth surfaces: which triangles continue each other, and the edges where they end.
//!
//! A photon on one side of a smooth surface tells nothing of its other side or of another surface, however near. And
//! where a surface ends, the visible part of a disc around a place is less than the disc: by how much tells an integral
//! along the edges.

use crate::mesh::Mesh;
use crate::mesh::edges::EdgeTable;
use crate::numeric::bounds::Bounds;
use crate::octree::TriangleBvh;
use crate::scene::Prepared;
use glam::{DVec2, DVec3};

/// Where planes turn by more, degrees, a surface ends.
const CREASE: f64 = 30.0;
/// Less than this part of a disc is taken for this: next to a corner nothing is left to tell light from none.
pub(super) const LEAST_PART: f64 = 1e-3;

/// The smooth surfaces of a scene.
pub(super) struct SmoothSurfaces {
    /// For each triangle which surface it belongs to.
    of: Vec<u32>,
    /// The edges where surfaces end, the surface on their left as it is seen from outside.
    borders: Vec<Border>,
    near: TriangleBvh,
}

#[derive(Clone, Copy, Debug)]
struct Border {
    surface: u32,
    ends: [DVec3; 2],
}

impl SmoothSurfaces {
    /// Finds those of the objects that are asked for; what is left is one surface without an end.
    pub(super) fn new(prepared: &Prepared, is_asked_for: impl Fn(usize) -> bool) -> SmoothSurfaces {
        let mut of = vec![0; prepared.triangles.len()];
        let mut borders = Vec::new();
        let mut next = 1;
        let asked_for = prepared.objects.iter().enumerate().filter(|(index, o)| o.count > 0 && is_asked_for(*index));
        for (_, object) in asked_for {
            let triangles = object.first as usize..(object.first + object.count) as usize;
            let mesh = mesh_of(prepared, &prepared.triangles[triangles.clone()]);
            let table = EdgeTable::of(&mesh);
            let mut group = Groups::new(mesh.triangles.len());
            for edge in &table.edges {
                if let [a, b] = table.uses(edge)
                    && a.forward != b.forward
                    && table.dihedral_degrees(&mesh, edge).is_some_and(|angle| angle <= CREASE)
                {
                    group.join(a.triangle, b.triangle);
                }
            }
            for (triangle, of) in of[triangles].iter_mut().enumerate() {
                *of = next + group.first(triangle as u32);
            }
            for edge in &table.edges {
                let uses = table.uses(edge);
                if let [a, b] = uses
                    && group.first(a.triangle) == group.first(b.triangle)
                    && a.forward != b.forward
                {
                    continue;
                }
                for place in uses {
                    let [from, to] = if place.forward { edge.ends } else { [edge.ends[1], edge.ends[0]] };
                    let ends = [from, to].map(|vertex| mesh.vertices[vertex as usize]);
                    borders.push(Border { surface: next + group.first(place.triangle), ends });
                }
            }
            next += mesh.triangles.len() as u32;
        }
        let vertices: Vec<DVec3> = borders.iter().flat_map(|border| border.ends).collect();
        let segments: Vec<[u32; 3]> = (0..borders.len() as u32).map(|i| [2 * i, 2 * i + 1, 2 * i + 1]).collect();
        SmoothSurfaces { of, near: TriangleBvh::new(&vertices, &segments), borders }
    }

    /// The surface that a triangle belongs to.
    pub(super) fn of(&self, triangle: u32) -> u32 {
        self.of[triangle as usize]
    }

    /// The borders of a surface within a distance of a place, as its plane shows them, the place in the middle, in
    /// units of the distance.
    ///
    /// - `axes`: of the plane. As seen from outside, turning from the first to the second is counter-clockwise.
    pub(super) fn around(&self, surface: u32, place: DVec3, [x, y]: [DVec3; 2], reach: f64) -> Vec<[DVec2; 2]> {
        let mut found = Vec::new();
        let flat = |p: DVec3| DVec2::new((p - place).dot(x), (p - place).dot(y)) / reach;
        let around = Bounds { min: place - DVec3::splat(reach), max: place + DVec3::splat(reach) };
        self.near.touching(around, |number| {
            let border = &self.borders[number as usize];
            if border.surface == surface {
                found.push(border.ends.map(flat));
            }
        });
        found
    }
}

/// How much of a weighted disc is on the surface: 1 where no border is near.
///
/// The weight falls with the distance d from the middle as 1 − d²/r²; of all of it (1 − d²/r²)² lies beyond d. A border
/// that is seen under a small angle from the middle takes away what lies beyond it under this angle, or gives it back
/// if the surface is on its other side, so that the sum over all borders is what is missing. Along a straight border at
/// height h, d = h / cos φ, and the integral over φ is one of tangents.
///
/// # Source
/// Ours: Green's theorem in polar coordinates.
pub(super) fn part_of_disc(borders: &[[DVec2; 2]], radius: f64) -> f64 {
    let missing: f64 = borders.iter().map(|ends| beyond(*ends, radius)).sum();
    (1.0 - missing / std::f64::consts::TAU).clamp(LEAST_PART, 1.0)
}

/// The integral of (1 − d²/r²)² over the angles under which a segment is seen within a disc, signed by its direction of
/// rotation.
pub(super) fn beyond([a, b]: [DVec2; 2], radius: f64) -> f64 {
    let way = b - a;
    let length = way.length();
    let along = way / length;
    let height = along.perp_dot(-a);
    if length == 0.0 || height.abs() >= radius {
        return 0.0;
    }
    // From the foot of the perpendicular, cut off at the disc.
    let half = (radius * radius - height * height).sqrt();
    let [from, to] = [a, b].map(|p| p.dot(along).clamp(-half, half));
    let (h, square) = (height.abs(), radius * radius);
    let part = |s: f64| s.atan2(h) + h * s * (h * h + s * s / 3.0 - 2.0 * square) / (square * square);
    let angle = part(to) - part(from);
    // With the surface on the left, the border turns counter-clockwise about the middle.
    if height >= 0.0 { angle } else { -angle }
}

/// Triangles that belong together.
struct Groups(Vec<u32>);

impl Groups {
    fn new(count: usize) -> Groups {
        Groups((0..count as u32).collect())
    }

    /// The first of the group.
    fn first(&mut self, of: u32) -> u32 {
        let mut at = of;
        while self.0[at as usize] != at {
            // Each step halves the path for those that come after (Tarjan and van Leeuwen 1984).
            self.0[at as usize] = self.0[self.0[at as usize] as usize];
            at = self.0[at as usize];
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// Triangles of a scene as a mesh of their own vertices.
fn mesh_of(prepared: &Prepared, triangles: &[[u32; 3]]) -> Mesh {
    let low = triangles.iter().flatten().copied().min().unwrap_or(0);
    let high = triangles.iter().flatten().copied().max().map_or(0, |high| high + 1);
    Mesh {
        vertices: prepared.vertices[low as usize..high as usize].to_vec(),
        triangles: triangles.iter().map(|corners| corners.map(|vertex| vertex - low)).collect(),
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<[DVec2; 2]> {
        let corners = [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| DVec2::new(x, y));
        (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect()
    }

    /// The part of the weighted disc inside a square, by a fine grid.
    fn by_grid(inside: impl Fn(DVec2) -> bool, radius: f64) -> f64 {
        let count = 1000;
        let place = |i: usize| ((i as f64 + 0.5) / count as f64 * 2.0 - 1.0) * radius;
        let (mut all, mut part) = (0.0, 0.0);
        for i in 0..count {
            for j in 0..count {
                let p = DVec2::new(place(i), place(j));
                let weight = (1.0 - p.length_squared() / (radius * radius)).max(0.0);
                all += weight;
                part += if inside(p) { weight } else { 0.0 };
            }
        }
        part / all
    }

    #[test]
    fn what_borders_take_from_a_disc_is_what_lies_beyond() {
        let radius = 1.5;
        for (low, high) in [(-0.3, 0.9), (-1.0, 0.01), (-0.2, 7.0), (-0.05, 0.07), (-9.0, 0.5), (-3.0, 3.0)] {
            let inside = |p: DVec2| p.min_element() > low && p.max_element() < high;
            let (found, expected) = (part_of_disc(&square(low, high), radius), by_grid(inside, radius));
            assert!((found - expected).abs() < 2e-3, "{low} {high}: {found} {expected}");
        }
        assert_eq!(part_of_disc(&[], 1.0), 1.0);
    }

    #[test]
    fn a_hole_takes_what_lies_in_it() {
        let mut borders = square(-3.0, 3.0);
        // Clockwise, the surface around it.
        borders.extend(square(0.1, 0.6).into_iter().map(|[a, b]| [b, a]));
        let inside = |p: DVec2| !(p.min_element() > 0.1 && p.max_element() < 0.6);
        let (found, expected) = (part_of_disc(&borders, 1.0), by_grid(inside, 1.0));
        assert!((found - expected).abs() < 2e-3, "{found} {expected}");
    }

    #[test]
    fn on_an_edge_half_of_the_disc_is_left_and_in_a_corner_a_quarter() {
        let edge = square(0.0, 10.0);
        let moved = |by: DVec2| edge.iter().map(|ends| ends.map(|p| p - by)).collect::<Vec<_>>();
        let on_edge = part_of_disc(&moved(DVec2::new(5.0, 0.0)), 1.0);
        let near = part_of_disc(&moved(DVec2::new(5.0, 1e-9)), 1.0);
        let corner = part_of_disc(&moved(DVec2::splat(1e-9)), 1.0);
        assert!((near - 0.5).abs() < 1e-6 && (corner - 0.25).abs() < 1e-6, "{near} {corner}");
        assert!((on_edge - 0.5).abs() < 1e-6, "{on_edge}");
    }
}
