//! Whether triangles of a surface have more in common than corners and edges.
//!
//! Of the triangles that are near each other in a surface most are neighbours. What they have in common is seen from the
//! names of their corners; that they have no more, from which way they face, or from a line that parts them.

use super::contact::{Contact, Face, Feature, flat_turn};
use crate::numeric::implicit::projection;
use crate::numeric::plane::Plane;
use glam::DVec3;

/// A triangle of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    /// Corners with the same name are at the same place; so may others be.
    names: [u32; 3],
    plane: Plane,
    /// Which way it turns, seen along each axis; 0.0 where roundings leave a doubt.
    facing: [f64; 3],
}

impl Tile {
    /// A triangle with these corners, by their names and places.
    pub fn new(names: [u32; 3], corners: [DVec3; 3]) -> Tile {
        let plane = Plane::through(corners);
        Tile { names, plane, facing: [0, 1, 2].map(|axis| plane.facing(axis)) }
    }

    /// Whether its corners are on one line.
    pub fn is_flat(&self) -> bool {
        self.facing == [0.0; 3] && projection(self.plane.corners).is_none()
    }

    /// Whether another with a common edge, and no third common corner, lies beyond that in some view, and so has no more
    /// in common with it.
    fn is_hinged(&self, other: &Tile) -> bool {
        let is_alike = |axis: usize| self.facing[axis] != 0.0 && self.facing[axis] == other.facing[axis];
        let runs_back = |k: usize| {
            let edge = [self.names[(k + 1) % 3], self.names[k]];
            (0..3).any(|j| edge == [other.names[j], other.names[(j + 1) % 3]])
        };
        (0..3).any(is_alike) && (0..3).any(runs_back)
    }

    /// Whether all of another that is not common lies on one side of the plane.
    fn is_beside(&self, other: &Tile) -> bool {
        let mut side = 0.0;
        for k in (0..3).filter(|&k| !self.names.contains(&other.names[k])) {
            match self.plane.rounded_side(other.plane.corners[k]) {
                Some(next) if next != 0.0 && side * next >= 0.0 => side = next,
                _ => return false,
            }
        }
        side != 0.0
    }

    /// Whether an edge of this triangle parts it from another where both are seen along an axis.
    fn parts(&self, other: &Tile, axis: usize) -> bool {
        let [a, b, c] = self.plane.corners;
        let facing = if self.facing[axis] != 0.0 { self.facing[axis] } else { flat_turn(axis, a, b, c) };
        facing != 0.0
            && [[0, 1], [1, 2], [2, 0]].into_iter().any(|[p, q]| {
                (0..3).all(|k| {
                    let corner = other.plane.corners[k];
                    let is_end = |end: usize| other.names[k] == self.names[end] || corner == self.plane.corners[end];
                    let [from, to] = [p, q].map(|end| self.plane.corners[end]);
                    is_end(p) || is_end(q) || flat_turn(axis, from, to, corner) * facing < 0.0
                })
            })
    }
}

/// Whether two triangles with an area have more in common than corners, and the edge between two of these.
pub fn overlap(one: &Tile, two: &Tile) -> bool {
    match two.names.iter().filter(|name| one.names.contains(name)).count() {
        3 => return true,
        2 if one.is_hinged(two) => return false,
        _ => {}
    }
    if one.is_beside(two) || two.is_beside(one) {
        return false;
    }
    // Neighbours in one plane or nearly so, of which a division is full, are mostly parted where they are seen best.
    let normal = one.plane.normal.abs();
    let axis = if normal.max_element() == normal.x { 0 } else { if normal.y >= normal.z { 1 } else { 2 } };
    if one.parts(two, axis) || two.parts(one, axis) {
        return false;
    }
    overlap_exactly(one.plane.corners, two.plane.corners)
}

#[cold]
fn overlap_exactly(one: [DVec3; 3], two: [DVec3; 3]) -> bool {
    // Which corner of the first each corner of the second is.
    let shared = two.map(|corner| one.iter().position(|&c| c == corner));
    if shared.iter().all(Option::is_some) {
        return true;
    }
    let names = [0, 1, 2].map(|k| shared[k].map_or(3 + k as u32, |own| own as u32));
    let (Some(one), Some(two)) = (Face::new(0, [0, 1, 2], one), Face::new(1, names, two)) else { return false };
    let contact = Contact::of(&one, &two);
    contact.points.len() > 2
        || contact.points.iter().any(|point| !matches!(point.features, [Feature::Corner(_), Feature::Corner(_)]))
}
