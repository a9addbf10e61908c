//! Whether triangles of a surface have more in common than corners and edges.
//!
//! Of the triangles that are near each other in a surface most are neighbours. What they have in common is seen from
//! the names of their corners; that they have no more, from the side on which the others lie, from which way they face,
//! or from a line that separates them.

use super::contact::{Contact, ConvexFace, Feature, planar_orientation};
use crate::numeric::implicit::projection;
use crate::numeric::plane::Plane;
use glam::DVec3;
use std::borrow::Borrow;

/// Units in the last place of the largest coordinate within which a corner may lie on the other side of an edge or a
/// plane than before it was rounded.
const ROUNDINGS: f64 = 8.0;

/// A triangle of a surface.
#[derive(Clone, Copy, Debug)]
pub struct NamedTriangle {
    /// Corners with the same name are at the same place; so may others be.
    pub names: [u32; 3],
    /// Where they are.
    pub corners: [DVec3; 3],
}

/// A triangle of a surface with its plane.
#[derive(Clone, Copy, Debug)]
pub struct PlaneTriangle {
    triangle: NamedTriangle,
    plane: Plane,
}

impl NamedTriangle {
    /// The triangle with its plane.
    pub fn with_plane(self) -> PlaneTriangle {
        PlaneTriangle { triangle: self, plane: Plane::through(self.corners) }
    }

    /// The corners of another triangle that are none of this one, a bit for each.
    #[inline]
    fn others_in(&self, other: &NamedTriangle) -> u8 {
        let [a, b, c] = self.names;
        let is_other = |k: usize| other.names[k] != a && other.names[k] != b && other.names[k] != c;
        (0..3).fold(0, |all, k| all | u8::from(is_other(k)) << k)
    }
}

impl PlaneTriangle {
    /// The triangle.
    pub fn triangle(&self) -> &NamedTriangle {
        &self.triangle
    }

    /// Whether its corners are on one line.
    pub fn is_flat(&self) -> bool {
        (0..3).all(|axis| self.plane.facing(axis) == 0.0) && projection(self.triangle.corners).is_none()
    }

    /// What is near here.
    fn near(&self) -> f64 {
        let [a, b, c] = self.triangle.corners.map(DVec3::abs);
        ROUNDINGS * f64::EPSILON * a.max(b).max(c).max_element()
    }

    /// Whether a corner is near the side opposite to it, but for roundings.
    pub fn is_thin(&self) -> bool {
        let [a, b, c] = self.triangle.corners;
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        let near = self.near();
        self.plane.normal.length_squared() <= near * near * longest
    }

    /// Whether another triangle with a common edge is folded back onto this one: its third corner is near the plane, on
    /// the side of the edge where this one is.
    #[inline]
    fn is_folded_onto(&self, other: &NamedTriangle) -> bool {
        let corners = &self.triangle.corners;
        let third = self.triangle.others_in(other).trailing_zeros() as usize;
        let height = self.plane.normal.dot(other.corners[third] - corners[0]);
        let near = self.near();
        height * height <= near * near * self.plane.normal.length_squared() && {
            let apex = other.others_in(&self.triangle).trailing_zeros() as usize;
            let [from, to] = [corners[(apex + 1) % 3], corners[(apex + 2) % 3]];
            (to - from).cross(other.corners[third] - from).dot(self.plane.normal) > 0.0
        }
    }

    /// Whether all of another that is not common lies on one side of the plane.
    ///
    /// - `own`: the corners of the other that are not common, a bit for each.
    fn is_beside(&self, other: &NamedTriangle, own: u8) -> bool {
        let mut side = 0.0;
        for k in (0..3).filter(|k| own >> k & 1 == 1) {
            match self.plane.rounded_side(other.corners[k]) {
                Some(next) if next != 0.0 && side * next >= 0.0 => side = next,
                _ => return false,
            }
        }
        side != 0.0
    }

    /// Whether another with a common edge lies beyond that in some view, and so has no more in common with it.
    fn is_hinged(&self, other: &PlaneTriangle) -> bool {
        let (names, beyond) = (self.triangle.names, other.triangle.names);
        let runs_back = |k: usize| {
            let edge = [names[(k + 1) % 3], names[k]];
            [[0, 1], [1, 2], [2, 0]].into_iter().any(|[p, q]| edge == [beyond[p], beyond[q]])
        };
        let is_alike = |axis: usize| self.plane.facing(axis) * other.plane.facing(axis) > 0.0;
        (0..3).any(runs_back) && (0..3).any(is_alike)
    }

    /// Whether an edge of this triangle separates it from another where both are seen along an axis.
    fn separates(&self, other: &NamedTriangle, axis: usize) -> bool {
        let NamedTriangle { names, corners } = self.triangle;
        let mut facing = self.plane.facing(axis);
        if facing == 0.0 {
            facing = planar_orientation(axis, corners[0], corners[1], corners[2]);
        }
        facing != 0.0
            && [[0, 1], [1, 2], [2, 0]].into_iter().any(|[p, q]| {
                (0..3).all(|k| {
                    let is_end = |end: usize| other.names[k] == names[end] || other.corners[k] == corners[end];
                    is_end(p)
                        || is_end(q)
                        || planar_orientation(axis, corners[p], corners[q], other.corners[k]) * facing < 0.0
                })
            })
    }
}

/// Whether two triangles with an area have more in common than corners, and the edge between two of these.
///
/// - `plane_two`: gives the second with its plane, where it is needed.
pub fn overlap<P: Borrow<PlaneTriangle>>(
    one: &PlaneTriangle,
    two: &NamedTriangle,
    plane_two: impl FnOnce() -> P,
) -> bool {
    overlap_of(one, two, one.triangle.others_in(two), plane_two)
}

/// Whether two triangles with an area overlap, or the second is folded back onto the first, but for roundings.
///
/// - `plane_two`: gives the second with its plane, where it is needed.
#[inline(always)]
pub fn nearly_overlap<P: Borrow<PlaneTriangle>>(
    one: &PlaneTriangle,
    two: &NamedTriangle,
    plane_two: impl FnOnce() -> P,
) -> bool {
    let own = one.triangle.others_in(two);
    own.count_ones() == 1 && one.is_folded_onto(two) || overlap_of(one, two, own, plane_two)
}

/// Whether two triangles with an area overlap.
///
/// - `own`: the corners of the second that are none of the first, a bit for each.
#[inline(always)]
fn overlap_of<P: Borrow<PlaneTriangle>>(
    one: &PlaneTriangle,
    two: &NamedTriangle,
    own: u8,
    plane_two: impl FnOnce() -> P,
) -> bool {
    if own == 0 {
        return true;
    }
    if one.is_beside(two, own) {
        return false;
    }
    let plane_two = plane_two();
    let two = plane_two.borrow();
    let is_neighbour = own.count_ones() == 1;
    if is_neighbour && one.is_hinged(two) || two.is_beside(&one.triangle, two.triangle.others_in(&one.triangle)) {
        return false;
    }
    // Neighbours in one plane or nearly so, of which a division is full, are mostly separated where they are seen best.
    let normal = one.plane.normal.abs();
    let axis = if normal.max_element() == normal.x { 0 } else { if normal.y >= normal.z { 1 } else { 2 } };
    if (axis..axis + 3).any(|axis| one.separates(&two.triangle, axis % 3) || two.separates(&one.triangle, axis % 3)) {
        return false;
    }
    overlap_exactly(one.triangle.corners, two.triangle.corners)
}

#[cold]
fn overlap_exactly(one: [DVec3; 3], two: [DVec3; 3]) -> bool {
    // Which corner of the first each corner of the second is.
    let shared = two.map(|corner| one.iter().position(|&c| c == corner));
    if shared.iter().all(Option::is_some) {
        return true;
    }
    let names = [0, 1, 2].map(|k| shared[k].map_or(3 + k as u32, |own| own as u32));
    let (Some(one), Some(two)) = (ConvexFace::new(0, [0, 1, 2], one), ConvexFace::new(1, names, two)) else {
        return false;
    };
    let contact = Contact::of(&one, &two);
    contact.points.len() > 2
        || contact.points.iter().any(|point| !matches!(point.features, [Feature::Corner(_), Feature::Corner(_)]))
}
