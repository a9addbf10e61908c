//! Touched faces, divided along all that lies in them.

use super::arrangement::Arrangement;
use super::triangulation::{IncrementalTriangulation, NONE, TYPICAL_POINTS};
use crate::numeric::implicit::{ImplicitPoint, PointDefinition, others};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

/// A triangle that nothing crosses, of one face or of several that coincide there.
#[derive(Clone, Debug)]
pub struct Facet {
    /// Points, in the order of the first face that it belongs to.
    pub corners: [u32; 3],
    /// The face that it is part of, that of the lowest operand if there are several, so that neighbours are oriented
    /// alike.
    pub face: u32,
    /// Others that it is part of.
    pub others: Vec<Covering>,
}

/// A face that a facet is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Covering {
    /// The face.
    pub face: u32,
    /// Whether it turns as the facet does.
    pub is_along: bool,
}

impl Facet {
    /// All faces that it is part of.
    pub fn cover(&self) -> impl Iterator<Item = Covering> {
        std::iter::once(Covering { face: self.face, is_along: true }).chain(self.others.iter().copied())
    }
}

/// Divides all touched faces; faces that overlap in one plane are divided together.
pub fn divide(arrangement: &Arrangement) -> Vec<Facet> {
    let mut sheets: FxHashMap<u32, usize> = FxHashMap::default();
    let mut members: Vec<Vec<u32>> = Vec::new();
    for face in arrangement.touched() {
        let sheet = *sheets.entry(arrangement.coplanar_groups.root(face)).or_insert_with(|| {
            members.push(Vec::new());
            members.len() - 1
        });
        members[sheet].push(face);
    }
    let facets: Vec<Vec<Facet>> = members
        .par_iter()
        .with_min_len(16)
        .map(|faces| match faces[..] {
            [face] => divide_face(arrangement, face),
            _ => divide_coplanar(arrangement, faces),
        })
        .collect();
    facets.into_iter().flatten().collect()
}

/// The border of a face, point by point from its first corner on.
fn border(arrangement: &Arrangement, face: u32) -> Vec<u32> {
    let mut border = Vec::new();
    for k in arrangement.faces[face as usize].numbers() {
        border.push(arrangement.face_arrangements[face as usize].corners[k as usize]);
        border.extend(arrangement.on_edge(face, k));
    }
    border
}

/// Places in a list, so that each beginning of them is spread over all of it, and goes over it in turns.
///
/// Points of a line that are inserted one after the other would exchange many diagonals in vain.
fn spread(count: usize) -> impl Iterator<Item = usize> {
    let strides = (0..usize::BITS - count.leading_zeros()).rev().map(|bit| 1_usize << bit);
    strides.flat_map(move |stride| (stride - 1..count).step_by(2 * stride))
}

/// A triangulation with the numbers that points have outside of it.
struct NumberedTriangulation<'a> {
    arrangement: &'a Arrangement,
    triangulation: IncrementalTriangulation<'a>,
    /// Number inside by point.
    inside: FxHashMap<u32, u32>,
    /// Point by number inside; [`NONE`] for helping points.
    outside: Vec<u32>,
}

impl<'a> NumberedTriangulation<'a> {
    /// Inserts points; those of each line should follow each other.
    fn insert(&mut self, points: &[u32]) {
        spread(points.len()).for_each(|place| self.insert_one(points[place]));
    }

    fn insert_one(&mut self, point: u32) {
        if self.inside.contains_key(&point) {
            return;
        }
        let number = self.triangulation.insert(&self.arrangement.points[point as usize]);
        if number as usize == self.outside.len() {
            self.outside.push(point);
        }
        self.inside.insert(point, number);
    }

    fn fix(&mut self, points: impl IntoIterator<Item = u32>) {
        let numbers: Vec<u32> = points.into_iter().map(|p| self.inside[&p]).collect();
        for pair in numbers.windows(2) {
            self.triangulation.fix(pair[0], pair[1]);
        }
    }

    /// Puts in lines, and what lies in faces.
    fn fill(&mut self, mut lines: Vec<Vec<u32>>, faces: &[u32]) {
        let contents = faces.iter().map(|&face| &self.arrangement.face_arrangements[face as usize]);
        lines.extend(contents.clone().flat_map(|content| &content.segments).map(|s| self.arrangement.pieces(s)));
        let inner = contents.flat_map(|content| &content.inner).map(|&point| self.arrangement.point(point));
        let points: Vec<u32> = lines.iter().flatten().copied().chain(inner).collect();
        self.insert(&points);
        lines.into_iter().for_each(|line| self.fix(line));
    }

    fn facet(&self, triangle: usize, turn: f64) -> [u32; 3] {
        let [a, b, c] = self.triangulation.triangles[triangle].map(|p| self.outside[p as usize]);
        if turn > 0.0 { [a, b, c] } else { [a, c, b] }
    }
}

fn divide_face(arrangement: &Arrangement, face: u32) -> Vec<Facet> {
    let (content, shape) = (&arrangement.face_arrangements[face as usize], &arrangement.faces[face as usize]);
    let is_turned = shape.orientation < 0.0;
    let mut corners = content.corners;
    if is_turned {
        corners[1..shape.sides].reverse();
    }
    let places = corners.map(|p| &arrangement.points[p as usize]);
    let mut sheet = NumberedTriangulation {
        arrangement,
        triangulation: IncrementalTriangulation::new(shape.axis, &places[..shape.sides]),
        inside: FxHashMap::with_capacity_and_hasher(TYPICAL_POINTS, Default::default()),
        outside: corners[..shape.sides].to_vec(),
    };
    sheet.inside.extend(sheet.outside.iter().copied().zip(0..));
    for k in shape.numbers() {
        // Sides in the order of the corners here.
        let side = if is_turned { shape.sides as u8 - 1 - k } else { k };
        let mut points = arrangement.on_edge(face, side);
        if is_turned {
            points.reverse();
        }
        sheet.triangulation.insert_on_side(k, points.iter().map(|&p| &arrangement.points[p as usize]));
        sheet.inside.extend(points.iter().copied().zip(sheet.outside.len() as u32..));
        sheet.outside.extend(points);
    }
    sheet.fill(Vec::new(), &[face]);
    let facet = |triangle| Facet { corners: sheet.facet(triangle, shape.orientation), face, others: Vec::new() };
    (0..sheet.triangulation.triangles.len()).map(facet).collect()
}

fn divide_coplanar(arrangement: &Arrangement, faces: &[u32]) -> Vec<Facet> {
    let first = &arrangement.faces[faces[0] as usize];
    let helpers = around(first.axis, faces.iter().flat_map(|&f| arrangement.faces[f as usize].corners().to_vec()));
    let mut sheet = NumberedTriangulation {
        arrangement,
        triangulation: IncrementalTriangulation::new(first.axis, &helpers.each_ref()),
        inside: FxHashMap::default(),
        outside: vec![NONE; 3],
    };
    let borders: Vec<Vec<u32>> = faces.iter().map(|&face| border(arrangement, face)).collect();
    let closed = |border: &Vec<u32>| border.iter().chain(&border[..1]).copied().collect();
    sheet.fill(borders.iter().map(closed).collect(), faces);
    // Faces of one plane may have been seen along different axes.
    let turn = |face: u32| arrangement.faces[face as usize].orientation_along(first.axis);
    // Triangles are counted operand by operand.
    let mut ordered: Vec<(u32, &[u32])> = faces.iter().copied().zip(borders.iter().map(Vec::as_slice)).collect();
    ordered.sort_unstable_by_key(|&(face, _)| arrangement.triangles[face as usize]);
    let mut covers: Vec<Vec<u32>> = vec![Vec::new(); sheet.triangulation.triangles.len()];
    for (face, border) in ordered {
        let sides = (0..border.len()).map(|k| [border[k], border[(k + 1) % border.len()]]);
        for triangle in inside_of(&sheet, turn(face), sides) {
            covers[triangle as usize].push(face);
        }
    }
    let mut facets = Vec::new();
    for (triangle, faces) in covers.into_iter().enumerate() {
        if let Some((&face, others)) = faces.split_first() {
            let others = others.iter().map(|&other| Covering { face: other, is_along: turn(other) == turn(face) });
            facets.push(Facet { corners: sheet.facet(triangle, turn(face)), face, others: others.collect() });
        }
    }
    facets
}

/// A part of the plane of a face.
pub struct PlanarRegion<'a> {
    /// The face.
    pub face: u32,
    /// All points in it and on its borders.
    pub points: &'a [u32],
    /// Its borders, piece by piece, as the face turns.
    pub borders: &'a [[u32; 2]],
}

impl PlanarRegion<'_> {
    /// Triangles that cover it, oriented as the face.
    pub fn triangles(&self, arrangement: &Arrangement) -> Vec<[u32; 3]> {
        let face = &arrangement.faces[self.face as usize];
        let places = self.points.iter().map(|&p| arrangement.points[p as usize].near());
        let helpers = around(face.axis, places);
        let mut sheet = NumberedTriangulation {
            arrangement,
            triangulation: IncrementalTriangulation::new(face.axis, &helpers.each_ref()),
            inside: FxHashMap::default(),
            outside: vec![NONE; 3],
        };
        sheet.insert(self.points);
        self.borders.iter().for_each(|&border| sheet.fix(border));
        let found = inside_of(&sheet, face.orientation, self.borders.iter().copied());
        found.into_iter().map(|triangle| sheet.facet(triangle as usize, face.orientation)).collect()
    }
}

/// A triangle far around some points, seen along an axis.
pub fn around(axis: usize, points: impl Iterator<Item = DVec3>) -> [ImplicitPoint; 3] {
    let [x, y] = others(axis);
    let reach = points.fold(0.0_f64, |reach, p| reach.max(p.abs().max_element())).max(f64::MIN_POSITIVE);
    [(-8.0, -4.0), (8.0, -4.0), (0.0, 8.0)].map(|(right, up)| {
        let mut at = DVec3::ZERO;
        (at[x], at[y]) = (right * reach, up * reach);
        ImplicitPoint::new(PointDefinition::Given(at))
    })
}

/// The triangles inside borders that turn one way or the other.
fn inside_of(sheet: &NumberedTriangulation, turn: f64, borders: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let numbers = borders.map(|border| border.map(|p| sheet.inside[&p]));
    let sides: Vec<(u32, u32)> = numbers.map(|[a, b]| if turn > 0.0 { (a, b) } else { (b, a) }).collect();
    let triangulation = &sheet.triangulation;
    let is_border: FxHashSet<(u32, u32)> = sides.iter().copied().collect();
    let mut found = Vec::new();
    let mut seen = FxHashSet::default();
    let mut stack: Vec<u32> = sides.iter().filter_map(|&(a, b)| Some(triangulation.along(a, b)?.0)).collect();
    while let Some(triangle) = stack.pop() {
        if !seen.insert(triangle) {
            continue;
        }
        found.push(triangle);
        let corners = triangulation.triangles[triangle as usize];
        for k in 0..3 {
            let next = triangulation.beyond[triangle as usize][k];
            if next != NONE && !is_border.contains(&(corners[k], corners[(k + 1) % 3])) {
                stack.push(next);
            }
        }
    }
    found.sort_unstable();
    found
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_spread_order_has_each_place_once() {
        for count in [0, 1, 2, 3, 7, 8, 100] {
            let mut places: Vec<usize> = super::spread(count).collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..count));
        }
        assert!(super::spread(7).eq([3, 1, 5, 0, 2, 4, 6]));
    }
}
