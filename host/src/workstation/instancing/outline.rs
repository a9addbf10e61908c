//! The simplest drawings of something: its outline in two planes that cross, and a stroke.

use crate::mesh::Polylines;
use crate::numeric::bounds::Bounds;
use glam::{DVec2, DVec3};

/// Directions in which the farthest points are kept.
const DIRECTIONS: usize = 96;
/// Corners of an outline at the most.
const MOST_CORNERS: usize = 6;
/// Something is upright unless it is so many times longer along another axis.
const UPRIGHT: f64 = 1.5;

/// Of some points those that are farthest in one of many directions.
pub(super) fn extremes(points: &[DVec3]) -> Vec<DVec3> {
    let mut kept: Vec<usize> = (0..DIRECTIONS)
        .filter_map(|number| {
            // Evenly over the sphere, by the golden angle.
            let y = 1.0 - (2 * number + 1) as f64 / DIRECTIONS as f64;
            let (sin, cos) = (number as f64 * 2.399_963_229_728_653).sin_cos();
            let direction = DVec3::new(cos, 0.0, sin) * (1.0 - y * y).sqrt() + DVec3::Y * y;
            let along = |index: &usize| direction.dot(points[*index]);
            (0..points.len()).max_by(|a, b| along(a).total_cmp(&along(b)))
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| points[index]).collect()
}

/// The hull of points seen along two axes, in the two planes through their middle that cross in their longest axis.
pub(super) fn outlines(points: &[DVec3]) -> [Vec<DVec3>; 2] {
    let bounds = Bounds::of(points.iter().copied());
    let (center, [along, second, third]) = (bounds.center(), axes_by_length(&bounds));
    [[along, second], [along, third]].map(|[u, v]| {
        let flat = points.iter().map(|point| DVec2::new(u.dot(*point - center), v.dot(*point - center)));
        let hull = simplified(hull(flat.collect()));
        hull.into_iter().map(|corner| center + u * corner.x + v * corner.y).collect()
    })
}

/// Outlines as closed runs of lines.
pub(super) fn closed(outlines: &[Vec<DVec3>]) -> Polylines {
    let mut runs = Polylines::default();
    for outline in outlines.iter().filter(|outline| outline.len() > 1) {
        runs.starts.push(runs.points.len());
        runs.points.extend(outline);
        // Two corners are a line, not there and back.
        runs.points.extend(outline.first().filter(|_| outline.len() > 2));
    }
    runs
}

/// A stroke through the middle of points, along their longest axis.
pub(super) fn stroke(points: &[DVec3]) -> Polylines {
    let bounds = Bounds::of(points.iter().copied());
    let [along, ..] = axes_by_length(&bounds);
    let half = along * (along.dot(bounds.size()) / 2.0);
    Polylines { points: vec![bounds.center() - half, bounds.center() + half], starts: vec![0] }
}

/// The axes, the longest side first; y counts for more than the others.
fn axes_by_length(bounds: &Bounds) -> [DVec3; 3] {
    let size = bounds.size();
    let mut axes = [DVec3::Y, DVec3::X, DVec3::Z];
    axes.sort_by(|a, b| {
        let length = |axis: &DVec3| axis.dot(size) * if *axis == DVec3::Y { UPRIGHT } else { 1.0 };
        length(b).total_cmp(&length(a))
    });
    axes
}

/// The convex hull of points, counter-clockwise.
///
/// # Source
/// Andrew 1979, the monotone chain.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut whole = chain(&mut points.iter().copied());
    whole.extend(chain(&mut points.iter().rev().copied()));
    whole
}

/// A polygon without the corners that change its area least.
fn simplified(mut polygon: Vec<DVec2>) -> Vec<DVec2> {
    while polygon.len() > MOST_CORNERS {
        let count = polygon.len();
        let area = |k: usize| {
            let [a, b, c] = [k + count - 1, k, k + 1].map(|index| polygon[index % count]);
            (b - a).perp_dot(c - b).abs()
        };
        let least = (0..count).min_by(|a, b| area(*a).total_cmp(&area(*b))).unwrap_or(0);
        polygon.remove(least);
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_becomes_two_triangles_that_cross_in_its_axis_and_an_upright_stroke() {
        let ring = (0..40).map(|k| f64::from(k) * 0.157_079_632_679).map(|a| DVec3::new(a.cos(), 0.0, a.sin()));
        let points: Vec<DVec3> = ring.chain([DVec3::Y * 3.0, DVec3::Y]).collect();
        let far = extremes(&points);
        assert!(far.len() < points.len() && far.contains(&(DVec3::Y * 3.0)) && !far.contains(&DVec3::Y));
        let [first, second] = outlines(&far);
        for (outline, flat) in [(&first, DVec3::Z), (&second, DVec3::X)] {
            assert!(outline.len() <= MOST_CORNERS && outline.iter().all(|corner| flat.dot(*corner).abs() < 1e-6));
            let top = outline.iter().filter(|corner| corner.y > 2.9).count();
            assert_eq!(top, 1, "{outline:?}");
        }
        assert_eq!(closed(std::slice::from_ref(&first)).lines(), first.len());
        let stroke = stroke(&far);
        assert!(stroke.points[0].distance(DVec3::ZERO) < 0.1 && stroke.points[1].distance(DVec3::Y * 3.0) < 0.1);
    }

    #[test]
    fn points_in_a_plane_on_a_line_or_alone_have_outlines_too() {
        let flat = [DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::X + DVec3::Z];
        let [lying, edge] = outlines(&flat);
        assert_eq!([lying.len(), edge.len()], [4, 2]);
        assert_eq!(closed(&[lying, edge]).lines(), 5);
        assert!(closed(&outlines(&[DVec3::ONE])).points.is_empty());
        assert!(closed(&outlines(&[])).points.is_empty() && extremes(&[]).is_empty());
    }
}
