//! Cuts at the sectioning plane: the cross-section, and what lies behind it.
//!
//! # Decided here
//! A point exactly in the plane counts as before it: the plane acts as if it stood a hair farther back. So every cut of
//! a solid is closed, whether the plane goes through corners or along faces: a face in the plane with the solid behind
//! it is the cross-section, one with the solid before it leaves none.

use super::{Facets, Segment};
use crate::traversal::Plane;
use glam::{DVec3, DVec4};

/// Distances below this part of the largest coordinate count as 0.
const FLAT: f64 = 1e-12;

/// The distances of all points before the plane, in multiples of the length of its normal.
fn distances(facets: &Facets, plane: &Plane) -> Vec<f64> {
    let normal = plane.normal.normalize();
    let size = facets.points.iter().map(|p| (p.eye - plane.point).abs().max_element()).fold(0.0, f64::max);
    let distance = |p: DVec3| (p - plane.point).dot(normal);
    let flat = |d: f64| if d.abs() <= FLAT * size { 0.0 } else { d };
    facets.points.iter().map(|point| flat(distance(point.eye))).collect()
}

/// Where the plane cuts the faces.
pub fn cross_section(facets: &Facets, plane: &Plane) -> Vec<Segment> {
    let distances = distances(facets, plane);
    let mut segments = Vec::new();
    let mut crossings: Vec<(DVec3, DVec4)> = Vec::new();
    for face in &facets.faces {
        crossings.clear();
        for contour in face.contours.clone() {
            let points: Vec<u32> = facets.contour(contour).collect();
            let befores = points.iter().skip(points.len() - 1).chain(&points);
            crossings.extend(befores.zip(&points).filter_map(|(from, to)| crossing(facets, &distances, [*from, *to])));
        }
        // Along the line in which face and plane meet, inside and outside take turns.
        let along = face.normal.cross(plane.normal);
        crossings.sort_by(|a, b| a.0.dot(along).total_cmp(&b.0.dot(along)));
        for pair in crossings.chunks_exact(2) {
            let ends = [pair[0].1, pair[1].1].map(|p| p.truncate() / p.w);
            if ends[0] != ends[1] && ends.iter().all(|end| end.is_finite()) {
                segments.push(Segment { ends, color: face.color });
            }
        }
    }
    segments
}

/// The edges behind the plane, and the cross-section.
pub fn sectioned(facets: &Facets, plane: &Plane) -> Vec<Segment> {
    let distances = distances(facets, plane);
    let mut segments = Vec::new();
    for edge in &facets.edges {
        let [a, b] = edge.ends;
        let before = edge.ends.map(|end| distances[end as usize] >= 0.0);
        let cut = crossing(facets, &distances, edge.ends).map(|cut| cut.1);
        let point = |end: u32| facets.points[end as usize].local;
        let ends = match (before, cut) {
            ([false, false], _) => [point(a), point(b)],
            ([false, true], Some(cut)) => [point(a), cut],
            ([true, false], Some(cut)) => [cut, point(b)],
            _ => continue,
        };
        let ends = ends.map(|p| p.truncate() / p.w);
        if ends[0] != ends[1] && ends.iter().all(|end| end.is_finite()) {
            segments.push(Segment { ends, color: facets.color_of(edge) });
        }
    }
    segments.extend(cross_section(facets, plane));
    segments
}

/// Where an edge goes through the plane, in eye coordinates and homogeneous in those of the node.
fn crossing(facets: &Facets, distances: &[f64], ends: [u32; 2]) -> Option<(DVec3, DVec4)> {
    // The same for both directions of an edge.
    let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|end| end as usize);
    let (from, to) = (distances[a], distances[b]);
    if (from >= 0.0) == (to >= 0.0) {
        return None;
    }
    let (p, q) = (&facets.points[a], &facets.points[b]);
    if from == 0.0 || to == 0.0 {
        let end = if from == 0.0 { p } else { q };
        return Some((end.eye, end.local));
    }
    let t = from / (from - to);
    Some((p.eye.lerp(q.eye, t), p.local.lerp(q.local, t)))
}
