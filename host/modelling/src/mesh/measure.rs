//! Sizes and directions of a mesh: bounds, area, volume, normals.

use std::collections::HashMap;

use glam::DVec3;

use super::Mesh;
use crate::numeric::bounds::Bounds;

impl Mesh {
    /// The smallest axis-parallel box around all vertices; `None` without vertices.
    pub fn bounds(&self) -> Option<Bounds> {
        let bounds = Bounds::of(self.vertices.iter().copied());
        (!bounds.is_empty()).then_some(bounds)
    }

    /// Half the cross product of two sides of a triangle: along its normal, as long as its area.
    pub fn area_vector(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a) * 0.5
    }

    /// The unit normal of the plane of a triangle; `None` if the triangle has no area.
    pub fn face_normal(&self, triangle: usize) -> Option<DVec3> {
        let [a, b, c] = self.corners(triangle);
        unit_normal(a, b, c)
    }

    /// Total area of the triangles, square units.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|triangle| self.area_vector(triangle).length()).sum()
    }

    /// Volume inside a closed mesh, cubic units; negative if its triangles face inwards.
    ///
    /// V = sum of (a - o) . ((b - o) x (c - o)) / 6, where o is the middle of the bounds, so that a mesh far from the
    /// origin loses no digits.
    pub fn signed_volume(&self) -> f64 {
        let Some(bounds) = self.bounds() else { return 0.0 };
        let center = bounds.center();
        let sixfold: f64 = (0..self.triangles.len())
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle).map(|corner| corner - center);
                a.dot(b.cross(c))
            })
            .sum();
        sixfold / 6.0
    }

    /// For each vertex the lowest index among the vertices at its position (same bits, and -0 equal to 0).
    pub fn first_of_each_position(&self) -> Vec<u32> {
        let mut first_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(self.vertices.len());
        let index_of = |(index, position): (usize, &DVec3)| *first_at.entry(bits(*position)).or_insert(index as u32);
        self.vertices.iter().enumerate().map(index_of).collect()
    }
}

/// A position as a key: equal bits for equal coordinates, with -0 taken as 0.
pub(crate) fn bits(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// Angle between two directions of any length, radians, accurate near 0 and pi.
pub(super) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let [a, b] = [a, b].map(scaled);
    a.cross(b).length().atan2(a.dot(b))
}

/// The unit normal of the triangle a b c; `None` if it has no area. Does not underflow for tiny triangles.
pub(super) fn unit_normal(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec3> {
    scaled(scaled(b - a).cross(scaled(c - a))).try_normalize()
}

/// `vector` divided by its largest component; the zero vector stays.
fn scaled(vector: DVec3) -> DVec3 {
    let size = vector.abs().max_element();
    if size > 0.0 { vector / size } else { vector }
}
