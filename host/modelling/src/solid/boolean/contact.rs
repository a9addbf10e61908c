//! Where two faces meet, decided exactly.
//!
//! A face is a triangle, or two in one plane that make a convex quadrilateral.
//!
//! Every common point is named by the features of lowest dimension that it lies on: a vertex, two edges, or an edge and
//! a face. The same point found from a neighbouring triangle has the same name, which is how neighbours agree.

use crate::numeric::implicit::{others, projection, side};
use crate::numeric::plane::Plane;
use glam::DVec3;
use robust::{Coord, orient2d};
use rustc_hash::FxHashMap;

/// Names an edge by its vertices, the lower first.
pub type EdgeKey = [u32; 2];

/// A face of any operand, with names that are the same for all operands.
#[derive(Clone, Copy, Debug)]
pub struct ConvexFace {
    /// Its name.
    pub id: u32,
    /// Number of its corners, 3 or 4.
    pub sides: usize,
    /// Its vertices; two at the same place have the same name. A triangle has its first once more.
    vertices: [u32; 4],
    /// Where they are.
    corners: [DVec3; 4],
    /// The axis to leave out, so that an area stays, and which way the corners then turn.
    pub axis: usize,
    /// 1.0 or -1.0.
    pub orientation: f64,
    /// The plane of it.
    plane: Plane,
}

impl ConvexFace {
    /// A triangle; `None` if its corners are on one line.
    pub fn new(id: u32, vertices: [u32; 3], corners: [DVec3; 3]) -> Option<ConvexFace> {
        let (axis, turn) = projection(corners)?;
        let ([u, v, w], [a, b, c]) = (vertices, corners);
        let plane = Plane::through(corners);
        Some(ConvexFace { id, sides: 3, vertices: [u, v, w, u], corners: [a, b, c, a], axis, orientation: turn, plane })
    }

    /// The face with a corner more, between the last and the first: in its plane, and so that it stays convex.
    pub fn with(self, vertex: u32, corner: DVec3) -> ConvexFace {
        let ([u, v, w, _], [a, b, c, _]) = (self.vertices, self.corners);
        ConvexFace { sides: 4, vertices: [u, v, w, vertex], corners: [a, b, c, corner], ..self }
    }

    /// Whether a corner more, between the last and the first, is in its plane and leaves it convex, no three corners on
    /// one line.
    pub fn is_convex_with(&self, corner: DVec3) -> bool {
        let [first, second, third] = self.plane();
        let turns = |a, b, c| planar_orientation(self.axis, a, b, c) == self.orientation;
        self.plane.side(corner) == 0.0
            && turns(second, third, corner)
            && turns(third, corner, first)
            && turns(corner, first, second)
    }

    /// Its vertices.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices[..self.sides]
    }

    /// Gives a vertex another name.
    pub fn rename(&mut self, k: usize, name: u32) {
        self.vertices[k] = name;
    }

    /// Where its corners are.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..self.sides]
    }

    /// Three points of its plane, which turn as it does.
    pub fn plane(&self) -> [DVec3; 3] {
        self.plane.corners
    }

    /// The number of the corner after another.
    fn after(&self, k: usize) -> usize {
        if k + 1 == self.sides { 0 } else { k + 1 }
    }

    /// The number of the corner before another.
    fn before(&self, k: usize) -> usize {
        if k == 0 { self.sides - 1 } else { k - 1 }
    }

    /// The numbers of the corners, and of the edges from each to the next.
    pub fn numbers(&self) -> std::ops::Range<u8> {
        0..self.sides as u8
    }

    /// The edge from corner `k` to the next.
    pub fn edge(&self, k: u8) -> EdgeKey {
        let (a, b) = (self.vertices[k as usize], self.vertices[self.after(k as usize)]);
        if a < b { [a, b] } else { [b, a] }
    }

    /// The way in which its corners turn, seen along an axis.
    pub fn orientation_along(&self, axis: usize) -> f64 {
        let [a, b, c] = self.plane();
        planar_orientation(axis, a, b, c)
    }

    /// The ends of the edge from corner `k` to the next.
    pub fn ends(&self, k: usize) -> [DVec3; 2] {
        [self.corners[k], self.corners[self.after(k)]]
    }

    /// Whether a feature lies on the closed edge `k`.
    pub fn is_on(&self, feature: Feature, k: u8) -> bool {
        match feature {
            Feature::Corner(corner) => corner == k || corner as usize == self.after(k as usize),
            Feature::Edge(edge) => edge == k,
            Feature::Inside => false,
        }
    }

    /// Where a point in the face is that lies on the lines of some edges, by a 0 for each of these.
    fn feature(&self, lines: &[f64; 4]) -> Feature {
        let on = |k: usize| lines[k] == 0.0;
        let corner = (0..self.sides).find(|&k| on(k) && on(self.before(k))).map(|k| Feature::Corner(k as u8));
        let edge = || (0..self.sides).find(|&k| on(k)).map(|k| Feature::Edge(k as u8));
        corner.or_else(edge).unwrap_or(Feature::Inside)
    }

    /// On which sides of it the corners of another face lie; as many as that one has, and the first once more.
    fn sides_of(&self, other: &ConvexFace) -> [f64; 4] {
        let mut sides = [0.0; 4];
        (0..other.sides).for_each(|k| sides[k] = self.plane.side(other.corners[k]));
        if other.sides == 3 {
            sides[3] = sides[0];
        }
        sides
    }
}

/// The name of a point that two faces have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PointKey {
    /// A vertex of the input.
    Vertex(u32),
    /// Where two edges cross, the lower one first.
    Edges(EdgeKey, EdgeKey),
    /// Where an edge pierces a face.
    Pierced(EdgeKey, u32),
    /// Where three faces cross, in ascending order.
    Faces([u32; 3]),
}

/// The part of a face that a point lies on; edge k goes from corner k to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A corner.
    Corner(u8),
    /// Inside an edge.
    Edge(u8),
    /// Inside the face.
    Inside,
}

/// A point that two faces have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonPoint {
    /// Its name.
    pub key: PointKey,
    /// Where it is in the first face and in the second.
    pub features: [Feature; 2],
}

/// What two faces have in common: corners of a convex set.
#[derive(Clone, Debug, Default)]
pub struct Contact {
    /// At most two if the faces are in different planes, at most eight otherwise.
    pub points: Vec<CommonPoint>,
    /// Whether they lie in one plane.
    pub coplanar: bool,
}

impl Contact {
    /// Finds what two faces have in common.
    pub fn of(one: &ConvexFace, two: &ConvexFace) -> Contact {
        let mut contact = Contact::default();
        let apart = |sides: &[f64; 4]| sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
        let of_two = one.sides_of(two);
        if apart(&of_two) {
            return contact;
        }
        if of_two == [0.0; 4] {
            contact.coplanar = true;
            contact.corners_inside(one, two, false, [0.0; 4]);
            contact.corners_inside(two, one, true, [0.0; 4]);
            contact.crossings_in_plane(one, two);
            return contact;
        }
        let of_one = two.sides_of(one);
        if apart(&of_one) {
            return contact;
        }
        contact.corners_inside(one, two, false, of_one);
        contact.corners_inside(two, one, true, of_two);
        contact.piercings(one, two, of_one, false);
        contact.piercings(two, one, of_two, true);
        contact
    }

    fn push(&mut self, key: PointKey, of_first: Feature, of_second: Feature, swapped: bool) {
        if self.points.iter().all(|point| point.key != key) {
            let features = if swapped { [of_second, of_first] } else { [of_first, of_second] };
            self.points.push(CommonPoint { key, features });
        }
    }

    /// Gives vertices other names, by their old ones. Points that are then one stay once.
    pub fn rename(&mut self, names: &FxHashMap<u32, u32>) {
        let name = |vertex: u32| names.get(&vertex).copied().unwrap_or(vertex);
        let edge = |[a, b]: EdgeKey| {
            let (a, b) = (name(a), name(b));
            if a < b { [a, b] } else { [b, a] }
        };
        for point in std::mem::take(&mut self.points) {
            let key = match point.key {
                PointKey::Vertex(vertex) => PointKey::Vertex(name(vertex)),
                PointKey::Edges(one, two) => crossing(edge(one), edge(two)),
                PointKey::Pierced(one, face) => PointKey::Pierced(edge(one), face),
                PointKey::Faces(faces) => PointKey::Faces(faces),
            };
            if self.points.iter().all(|point| point.key != key) {
                self.points.push(CommonPoint { key, ..point });
            }
        }
    }

    /// Corners of one face that lie in the plane of another, and there in the face.
    fn corners_inside(&mut self, one: &ConvexFace, two: &ConvexFace, swapped: bool, sides: [f64; 4]) {
        for k in one.numbers() {
            if sides[k as usize] == 0.0
                && let Some(feature) = locate(two, one.corners[k as usize])
            {
                self.push(PointKey::Vertex(one.vertices[k as usize]), Feature::Corner(k), feature, swapped);
            }
        }
    }

    /// Points where edges of one face pass through the plane of another, inside that face.
    fn piercings(&mut self, one: &ConvexFace, two: &ConvexFace, sides: [f64; 4], swapped: bool) {
        for k in 0..one.sides {
            if sides[k] * sides[one.after(k)] >= 0.0 {
                continue;
            }
            let [p, q] = one.ends(k);
            // On which side of each edge of the other face the line passes.
            let mut passes = [0.0; 4];
            let is_beside = (0..two.sides).any(|j| {
                let [a, b] = two.ends(j);
                passes[j] = side(p, q, a, b);
                passes[..j].iter().any(|other| other * passes[j] < 0.0)
            });
            if is_beside {
                continue;
            }
            let edge = one.edge(k as u8);
            let feature = two.feature(&passes);
            let key = match feature {
                Feature::Corner(j) => PointKey::Vertex(two.vertices[j as usize]),
                Feature::Edge(j) => crossing(edge, two.edge(j)),
                Feature::Inside => PointKey::Pierced(edge, two.id),
            };
            self.push(key, Feature::Edge(k as u8), feature, swapped);
        }
    }

    /// Proper crossings of the edges of two faces in one plane.
    fn crossings_in_plane(&mut self, one: &ConvexFace, two: &ConvexFace) {
        let turn = |a: DVec3, b: DVec3, c: DVec3| planar_orientation(one.axis, a, b, c);
        for k in one.numbers() {
            let [p, q] = one.ends(k.into());
            for j in two.numbers() {
                let [a, b] = two.ends(j.into());
                if turn(p, q, a) * turn(p, q, b) < 0.0 && turn(a, b, p) * turn(a, b, q) < 0.0 {
                    self.push(crossing(one.edge(k), two.edge(j)), Feature::Edge(k), Feature::Edge(j), false);
                }
            }
        }
    }
}

/// The name of the point where two edges cross.
pub fn crossing(one: EdgeKey, two: EdgeKey) -> PointKey {
    if one < two { PointKey::Edges(one, two) } else { PointKey::Edges(two, one) }
}

/// The way in which three given points turn, seen along an axis.
pub fn planar_orientation(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
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

/// Where in a face a point of its plane lies; `None` outside.
fn locate(face: &ConvexFace, point: DVec3) -> Option<Feature> {
    let mut turns = [0.0; 4];
    for (k, turn) in turns[..face.sides].iter_mut().enumerate() {
        let [a, b] = face.ends(k);
        *turn = planar_orientation(face.axis, a, b, point) * face.orientation;
        if *turn < 0.0 {
            return None;
        }
    }
    Some(face.feature(&turns))
}
