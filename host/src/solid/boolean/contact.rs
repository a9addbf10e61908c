//! Where two triangles meet, decided exactly.
//!
//! Every common point is named by the features of lowest dimension that it lies on: a vertex, two edges, or an edge and a
//! face. The same point found from a neighbouring triangle has the same name, which is how neighbours agree.

use crate::numeric::implicit::{others, projection, side};
use crate::numeric::plane::Plane;
use glam::DVec3;
use robust::{Coord, orient2d};

/// Names an edge by its vertices, the lower first.
pub type Edge = [u32; 2];

/// A triangle of any operand, with names that are the same for all operands.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Its name.
    pub id: u32,
    /// Its vertices; two at the same place have the same name.
    pub vertices: [u32; 3],
    /// Where they are.
    pub corners: [DVec3; 3],
    /// The axis to leave out, so that an area stays, and which way the corners then turn.
    pub axis: usize,
    /// 1.0 or -1.0.
    pub turn: f64,
    /// The plane of it.
    plane: Plane,
}

impl Face {
    /// A triangle; `None` if its corners are on one line.
    pub fn new(id: u32, vertices: [u32; 3], corners: [DVec3; 3]) -> Option<Face> {
        let (axis, turn) = projection(corners)?;
        Some(Face { id, vertices, corners, axis, turn, plane: Plane::through(corners) })
    }

    /// The edge from corner `k` to the next.
    pub fn edge(&self, k: u8) -> Edge {
        let (a, b) = (self.vertices[k as usize], self.vertices[(k as usize + 1) % 3]);
        if a < b { [a, b] } else { [b, a] }
    }

    /// Which way its corners turn, seen along an axis.
    pub fn turn_along(&self, axis: usize) -> f64 {
        let [a, b, c] = self.corners;
        flat_turn(axis, a, b, c)
    }

    fn ends(&self, k: usize) -> [DVec3; 2] {
        [self.corners[k], self.corners[(k + 1) % 3]]
    }
}

/// The name of a point that two triangles have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A vertex of the input.
    Vertex(u32),
    /// Where two edges cross, the lower one first.
    Edges(Edge, Edge),
    /// Where an edge pierces a face.
    Pierced(Edge, u32),
    /// Where three faces cross, in ascending order.
    Faces([u32; 3]),
}

/// The part of a triangle that a point lies on; edge k goes from corner k to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A corner.
    Corner(u8),
    /// Inside an edge.
    Edge(u8),
    /// Inside the triangle.
    Inside,
}

impl Feature {
    /// Whether the feature lies on the closed edge `k`.
    pub fn is_on(self, k: u8) -> bool {
        match self {
            Feature::Corner(corner) => corner == k || corner == (k + 1) % 3,
            Feature::Edge(edge) => edge == k,
            Feature::Inside => false,
        }
    }
}

/// A point that two triangles have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Common {
    /// Its name.
    pub key: Key,
    /// Where it is in the first triangle and in the second.
    pub features: [Feature; 2],
}

/// What two triangles have in common: corners of a convex set.
#[derive(Clone, Debug, Default)]
pub struct Contact {
    /// At most two if the triangles are in different planes, at most six otherwise.
    pub points: Vec<Common>,
    /// Whether they lie in one plane.
    pub coplanar: bool,
}

impl Contact {
    /// Finds what two triangles with an area have in common.
    pub fn of(one: &Face, two: &Face) -> Contact {
        let mut contact = Contact::default();
        let signs = |plane: &Face, of: &Face| of.corners.map(|corner| plane.plane.side(corner));
        let apart = |signs: &[f64; 3]| signs.iter().all(|s| *s > 0.0) || signs.iter().all(|s| *s < 0.0);
        let of_two = signs(one, two);
        if apart(&of_two) {
            return contact;
        }
        if of_two == [0.0; 3] {
            contact.coplanar = true;
            contact.corners_inside(one, two, false, [true; 3]);
            contact.corners_inside(two, one, true, [true; 3]);
            contact.crossings_in_plane(one, two);
            return contact;
        }
        let of_one = signs(two, one);
        if apart(&of_one) {
            return contact;
        }
        contact.corners_inside(one, two, false, of_one.map(|s| s == 0.0));
        contact.corners_inside(two, one, true, of_two.map(|s| s == 0.0));
        contact.piercings(one, two, of_one, false);
        contact.piercings(two, one, of_two, true);
        contact
    }

    fn push(&mut self, key: Key, of_first: Feature, of_second: Feature, swapped: bool) {
        if self.points.iter().all(|point| point.key != key) {
            let features = if swapped { [of_second, of_first] } else { [of_first, of_second] };
            self.points.push(Common { key, features });
        }
    }

    /// Corners of one triangle that lie in the plane of another, and there in the triangle.
    fn corners_inside(&mut self, one: &Face, two: &Face, swapped: bool, in_plane: [bool; 3]) {
        for k in 0..3_u8 {
            if in_plane[k as usize]
                && let Some(feature) = locate(two, one.corners[k as usize])
            {
                self.push(Key::Vertex(one.vertices[k as usize]), Feature::Corner(k), feature, swapped);
            }
        }
    }

    /// Points where edges of one triangle pass through the plane of another, inside that triangle.
    fn piercings(&mut self, one: &Face, two: &Face, signs: [f64; 3], swapped: bool) {
        for k in 0..3_usize {
            if signs[k] * signs[(k + 1) % 3] >= 0.0 {
                continue;
            }
            let [p, q] = one.ends(k);
            // On which side of each edge of the other triangle the line passes.
            let mut passes = [0.0; 3];
            let is_beside = (0..3).any(|j| {
                let [a, b] = two.ends(j);
                passes[j] = side(p, q, a, b);
                passes[..j].iter().any(|other| other * passes[j] < 0.0)
            });
            if is_beside {
                continue;
            }
            let edge = one.edge(k as u8);
            let zeros = |j: usize| passes[j] == 0.0;
            let on = (0..3).find(|&j| zeros(j) && zeros((j + 2) % 3)).map(|j| Feature::Corner(j as u8));
            let on = on.or_else(|| (0..3).find(|&j| zeros(j)).map(|j| Feature::Edge(j as u8)));
            let (key, feature) = match on {
                Some(Feature::Corner(j)) => (Key::Vertex(two.vertices[j as usize]), Feature::Corner(j)),
                Some(Feature::Edge(j)) => (crossing(edge, two.edge(j)), Feature::Edge(j)),
                _ => (Key::Pierced(edge, two.id), Feature::Inside),
            };
            self.push(key, Feature::Edge(k as u8), feature, swapped);
        }
    }

    /// Proper crossings of the edges of two triangles in one plane.
    fn crossings_in_plane(&mut self, one: &Face, two: &Face) {
        let turn = |a: DVec3, b: DVec3, c: DVec3| flat_turn(one.axis, a, b, c);
        for k in 0..3_u8 {
            let [p, q] = one.ends(k.into());
            for j in 0..3_u8 {
                let [a, b] = two.ends(j.into());
                if turn(p, q, a) * turn(p, q, b) < 0.0 && turn(a, b, p) * turn(a, b, q) < 0.0 {
                    self.push(crossing(one.edge(k), two.edge(j)), Feature::Edge(k), Feature::Edge(j), false);
                }
            }
        }
    }
}

/// Whether two triangles with an area have more in common than corners, and the edge between two of these.
pub fn overlap(one: [DVec3; 3], two: [DVec3; 3]) -> bool {
    // Which corner of the first each corner of the second is.
    let shared = two.map(|corner| one.iter().position(|&c| c == corner));
    if shared.iter().all(Option::is_some) {
        return true;
    }
    let is_own = |of: [DVec3; 3], corner: &DVec3| !of.contains(corner);
    // Whether all of a triangle that is not common lies on one side of the other.
    let is_beside = |plane: &Plane, corners: [DVec3; 3]| {
        let mut sides = corners.iter().filter(|c| is_own(plane.corners, c)).map(|&corner| plane.rounded_side(corner));
        let first = sides.next().flatten().filter(|side| *side != 0.0);
        first.is_some() && sides.all(|side| side == first)
    };
    let plane = Plane::through(one);
    if is_beside(&plane, two) || is_beside(&Plane::through(two), one) || are_apart_in_view(plane.normal, one, two) {
        return false;
    }
    let names = [0, 1, 2].map(|k| shared[k].map_or(3 + k as u32, |own| own as u32));
    let (Some(one), Some(two)) = (Face::new(0, [0, 1, 2], one), Face::new(1, names, two)) else { return false };
    let contact = Contact::of(&one, &two);
    contact.points.len() > 2
        || contact.points.iter().any(|point| !matches!(point.features, [Feature::Corner(_), Feature::Corner(_)]))
}

/// Whether an edge of one of two triangles parts them where both are seen along an axis, so that they have no more in
/// common than corners, and the edge between two of these.
///
/// Neighbours in one plane or nearly so, of which a division is full, mostly are.
///
/// - `normal`: of the first, to see it from the side where it is largest.
fn are_apart_in_view(normal: DVec3, one: [DVec3; 3], two: [DVec3; 3]) -> bool {
    let normal = normal.abs();
    let axis = if normal.max_element() == normal.x { 0 } else { if normal.y >= normal.z { 1 } else { 2 } };
    let parts = |one: [DVec3; 3], two: [DVec3; 3]| {
        let facing = flat_turn(axis, one[0], one[1], one[2]);
        facing != 0.0
            && [(0, 1), (1, 2), (2, 0)].into_iter().any(|(p, q)| {
                let (p, q) = (one[p], one[q]);
                two.into_iter().all(|c| c == p || c == q || flat_turn(axis, p, q, c) * facing < 0.0)
            })
    };
    parts(one, two) || parts(two, one)
}

/// The name of the point where two edges cross.
pub fn crossing(one: Edge, two: Edge) -> Key {
    if one < two { Key::Edges(one, two) } else { Key::Edges(two, one) }
}

/// Which way three given points turn, seen along an axis.
fn flat_turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [x, y] = others(axis);
    let coord = |p: DVec3| Coord { x: p[x], y: p[y] };
    let turn = orient2d(coord(a), coord(b), coord(c));
    if turn > 0.0 {
        1.0
    } else if turn < 0.0 {
        -1.0
    } else {
        0.0
    }
}

/// Where in a triangle a point of its plane lies; `None` outside.
fn locate(face: &Face, point: DVec3) -> Option<Feature> {
    let turns = [0, 1, 2].map(|k| {
        let [a, b] = face.ends(k);
        flat_turn(face.axis, a, b, point) * face.turn
    });
    if turns.iter().any(|t| *t < 0.0) {
        return None;
    }
    let on = |k: usize| turns[k] == 0.0;
    let corner = (0..3).find(|&k| on(k) && on((k + 2) % 3)).map(|k| Feature::Corner(k as u8));
    corner.or_else(|| (0..3).find(|&k| on(k)).map(|k| Feature::Edge(k as u8))).or(Some(Feature::Inside))
}
