//! Triangles of a polygon with holes, by clipping ears. Every corner stays a corner, so neighbours meet without gaps.
//!
//! Signs are exact (Shewchuk's predicates, in the two axes across which the polygon is widest). A contour that lies
//! inside an odd number of others is a hole of the smallest of them; each hole is joined to its contour by a pair of
//! edges. Contours that cross themselves or each other are filled somehow, but every corner is used.
//!
//! # Source
//! D. Eberly, Triangulation by Ear Clipping, 2002; holes joined from right to left.
//!
//! # Cost
//! n r for n corners, r of them reflex; [`MAX_CORNERS`] bounds it.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use std::ops::Range;

/// Most corners of a polygon with all its contours; the corners beyond are left unfilled. Ours.
pub const MAX_CORNERS: usize = 3_000;

/// The triangles of a polygon, as indices into `corners`, each running the way the outer contours run.
///
/// - `corners`: of all contours, one after the other; finite.
/// - `contours`: the ranges of the contours, at least 3 corners each.
/// - `normal`: about perpendicular to the polygon; only its largest component matters.
pub fn triangulate(corners: &[DVec3], contours: &[Range<usize>], normal: DVec3, triangles: &mut Vec<[u32; 3]>) {
    if let [Range { start, end: 3 }] = contours {
        return triangles.push([0, 1, 2].map(|k| (start + k) as u32));
    }
    let flat: Vec<DVec2> = corners.iter().map(|corner| across(*corner, normal)).collect();
    let filled = contours.iter().take_while(|contour| contour.end <= MAX_CORNERS);
    let mut rings: Vec<Ring> = filled.map(|contour| Ring::new(&flat, contour.clone())).collect();
    // Outlines before the holes in them: larger areas first.
    rings.sort_by(|a, b| b.area.abs().total_cmp(&a.area.abs()));
    let parents: Vec<Option<usize>> = (0..rings.len()).map(|ring| parent(&flat, &rings, ring)).collect();
    for (outline, parent) in parents.iter().enumerate() {
        if parent.is_some() {
            continue;
        }
        let forward = rings[outline].area >= 0.0;
        let mut loop_ = rings[outline].turned(true);
        let mut holes: Vec<Vec<u32>> = (0..rings.len())
            .filter(|ring| parents[*ring] == Some(outline))
            .map(|ring| rings[ring].turned(false))
            .collect();
        holes.sort_by(|a, b| rightmost(&flat, b).1.total_cmp(&rightmost(&flat, a).1));
        for hole in holes {
            join(&flat, &mut loop_, &hole);
        }
        clip_ears(&flat, loop_, forward, triangles);
    }
}

/// A closed contour and twice its area, positive if it runs counter-clockwise in the two axes.
struct Ring {
    corners: Range<usize>,
    area: f64,
}

impl Ring {
    fn new(flat: &[DVec2], corners: Range<usize>) -> Ring {
        let origin = flat[corners.start];
        let part = flat[corners.clone()].windows(2);
        let area = part.map(|pair| (pair[0] - origin).perp_dot(pair[1] - origin)).sum();
        Ring { corners, area }
    }

    /// Its corners, counter-clockwise or clockwise.
    fn turned(&self, counter_clockwise: bool) -> Vec<u32> {
        let corners = self.corners.clone().map(|corner| corner as u32);
        if (self.area >= 0.0) == counter_clockwise { corners.collect() } else { corners.rev().collect() }
    }
}

/// The two coordinates across which a polygon is widest.
fn across(p: DVec3, normal: DVec3) -> DVec2 {
    let size = normal.abs();
    if size.z >= size.x && size.z >= size.y {
        DVec2::new(p.x, p.y)
    } else if size.x >= size.y {
        DVec2::new(p.y, p.z)
    } else {
        DVec2::new(p.z, p.x)
    }
}

/// Positive if a, b, c run counter-clockwise; the sign is exact.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// The outline whose hole a ring is; none if the ring is an outline itself.
fn parent(flat: &[DVec2], rings: &[Ring], ring: usize) -> Option<usize> {
    let point = flat[rings[ring].corners.start];
    let around = (0..ring).rev().filter(|other| encloses(&flat[rings[*other].corners.clone()], point));
    let around: Vec<usize> = around.collect();
    // Smallest first; an even number around makes it an outline.
    if around.len() % 2 == 1 { around.first().copied() } else { None }
}

/// Whether a contour goes around a point an odd number of times.
fn encloses(contour: &[DVec2], point: DVec2) -> bool {
    let mut inside = false;
    let mut from = contour[contour.len() - 1];
    for to in contour.iter().copied() {
        if (from.y > point.y) != (to.y > point.y) && (turn(from, to, point) > 0.0) == (to.y > from.y) {
            inside = !inside;
        }
        from = to;
    }
    inside
}

/// The index and x of the corner farthest to the right.
fn rightmost(flat: &[DVec2], ring: &[u32]) -> (usize, f64) {
    let x = |place: usize| flat[ring[place] as usize].x;
    let place = (0..ring.len()).max_by(|a, b| x(*a).total_cmp(&x(*b))).unwrap_or(0);
    (place, x(place))
}

/// Cuts a loop open at a corner that its hole's rightmost corner sees, and puts the hole in.
fn join(flat: &[DVec2], outline: &mut Vec<u32>, hole: &[u32]) {
    let (start, _) = rightmost(flat, hole);
    let from = flat[hole[start] as usize];
    let place = visible_corner(flat, outline, from);
    let around = hole[start..].iter().chain(&hole[..=start]).copied();
    let back = outline[place];
    let inserted: Vec<u32> = around.chain([back]).collect();
    outline.splice(place + 1..place + 1, inserted);
}

/// The index of a corner of a loop that is seen from a point inside, looking right.
fn visible_corner(flat: &[DVec2], outline: &[u32], from: DVec2) -> usize {
    let at = |place: usize| flat[outline[place % outline.len()] as usize];
    // The edge that a ray to the right meets first runs upward, as the loop is counter-clockwise.
    let mut nearest: Option<(f64, usize)> = None;
    for place in 0..outline.len() {
        let (a, b) = (at(place), at(place + 1));
        if a.y <= from.y && from.y < b.y && turn(a, b, from) >= 0.0 {
            let x = a.x + (b.x - a.x) * ((from.y - a.y) / (b.y - a.y));
            if nearest.is_none_or(|(best, _)| x < best) {
                nearest = Some((x, place));
            }
        }
    }
    let Some((x, edge)) = nearest else { return 0 };
    let hit = DVec2::new(x, from.y);
    let end = if at(edge).x > at(edge + 1).x { edge } else { (edge + 1) % outline.len() };
    // A reflex corner inside the triangle to the end of that edge hides it; the one least off the ray is seen.
    let tip = at(end);
    let mut best = (end, f64::INFINITY, f64::INFINITY);
    for place in 0..outline.len() {
        let corner = at(place);
        let before = at(place + outline.len() - 1);
        if place == end || turn(before, corner, at(place + 1)) > 0.0 || corner.x < from.x {
            continue;
        }
        let sides = [turn(from, hit, corner), turn(hit, tip, corner), turn(tip, from, corner)];
        if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
            let offset = corner - from;
            let (slope, distance) = ((offset.y / offset.x).abs(), offset.length_squared());
            if slope < best.1 || slope == best.1 && distance < best.2 {
                best = (place, slope, distance);
            }
        }
    }
    best.0
}

/// Cuts ears off a counter-clockwise loop until nothing is left.
///
/// - `forward`: whether the triangles run like the loop, or the other way.
fn clip_ears(flat: &[DVec2], corners: Vec<u32>, forward: bool, triangles: &mut Vec<[u32; 3]>) {
    let n = corners.len();
    let mut next: Vec<usize> = (1..n).chain([0]).collect();
    let mut previous: Vec<usize> = std::iter::once(n - 1).chain(0..n - 1).collect();
    let at = |place: usize| flat[corners[place] as usize];
    let is_reflex = |a: usize, b: usize, c: usize| turn(at(a), at(b), at(c)) <= 0.0;
    let mut reflex: Vec<bool> = (0..n).map(|b| is_reflex(previous[b], b, next[b])).collect();
    let mut hollow: Vec<usize> = (0..n).filter(|place| reflex[*place]).collect();
    let (mut place, mut left, mut refused) = (0, n, 0);
    while left > 2 {
        let (a, b, c) = (previous[place], place, next[place]);
        // After a whole round without an ear the contour is not simple, or flat: then any corner goes.
        let is_ear = left == 3
            || refused > left
            || !reflex[b] && {
                let (pa, pb, pc) = (at(a), at(b), at(c));
                let (low, high) = (pa.min(pb).min(pc), pa.max(pb).max(pc));
                !hollow.iter().any(|&other| {
                    let p = at(other);
                    reflex[other]
                        && (p.cmpge(low) & p.cmple(high)).all()
                        && (p != pa && p != pb && p != pc)
                        && turn(pa, pb, p) >= 0.0
                        && turn(pb, pc, p) >= 0.0
                        && turn(pc, pa, p) >= 0.0
                })
            };
        if !is_ear {
            refused += 1;
            place = c;
            continue;
        }
        let [a_, b_, c_] = [a, b, c].map(|place| corners[place]);
        triangles.push(if forward { [a_, b_, c_] } else { [c_, b_, a_] });
        (next[a], previous[c]) = (c, a);
        reflex[b] = false;
        left -= 1;
        refused = 0;
        for at in [a, c] {
            reflex[at] = reflex[at] && is_reflex(previous[at], at, next[at]);
        }
        if hollow.len() > 16 && left % 16 == 0 {
            hollow.retain(|place| reflex[*place]);
        }
        // Every other corner, so that triangles are fewer fans.
        place = next[c];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect()
    }

    /// Triangles of contours in the plane z = 0, and the sum of their areas.
    fn of(contours: &[Vec<DVec3>]) -> (Vec<DVec3>, Vec<[u32; 3]>, f64) {
        let corners: Vec<DVec3> = contours.concat();
        let mut ranges = Vec::new();
        for contour in contours {
            let start = ranges.last().map_or(0, |range: &Range<usize>| range.end);
            ranges.push(start..start + contour.len());
        }
        let mut triangles = Vec::new();
        triangulate(&corners, &ranges, DVec3::Z, &mut triangles);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| corners[k as usize].truncate());
            (b - a).perp_dot(c - a) / 2.0
        };
        let sum = triangles.iter().map(area).sum();
        let least = triangles.iter().map(area).fold(f64::INFINITY, f64::min);
        assert!(least >= 0.0 || triangles.iter().map(area).all(|a| a <= 0.0), "all run the same way");
        (corners, triangles, sum)
    }

    fn circle(n: usize, radius: f64, at: [f64; 2], way: f64) -> Vec<DVec3> {
        let angle = |k: usize| way * std::f64::consts::TAU * k as f64 / n as f64;
        (0..n).map(|k| DVec3::new(at[0] + radius * angle(k).cos(), at[1] + radius * angle(k).sin(), 0.0)).collect()
    }

    fn area_of_circle(n: usize, radius: f64) -> f64 {
        n as f64 / 2.0 * radius * radius * (std::f64::consts::TAU / n as f64).sin()
    }

    #[test]
    fn a_comb_and_its_mirror_have_two_triangles_less_than_corners() {
        let mut comb = vec![[0.0, -1.0], [20.0, -1.0]];
        for tooth in (0..10).rev() {
            comb.extend([[2.0 * f64::from(tooth) + 1.0, 5.0], [2.0 * f64::from(tooth), 0.0]]);
        }
        let (_, triangles, area) = of(&[ring(&comb)]);
        assert_eq!(triangles.len(), comb.len() - 2);
        let twice: f64 = (0..comb.len())
            .map(|k| {
                let ([ax, ay], [bx, by]) = (comb[k], comb[(k + 1) % comb.len()]);
                ax * by - ay * bx
            })
            .sum();
        assert!((area - twice / 2.0).abs() < 1e-9, "{area} {twice}");
        comb.reverse();
        assert!((of(&[ring(&comb)]).2 + twice / 2.0).abs() < 1e-9, "clockwise stays clockwise");
    }

    #[test]
    fn holes_islands_in_holes_and_further_outlines_are_told_apart() {
        for way in [1.0, -1.0] {
            let contours = [
                circle(40, 10.0, [0.0, 0.0], 1.0),
                circle(12, 2.0, [-4.0, 0.0], way),
                circle(13, 3.0, [4.0, 0.5], way),
                circle(7, 1.0, [4.0, 0.5], 1.0),
                circle(9, 2.0, [30.0, 0.0], 1.0),
            ];
            let expected = area_of_circle(40, 10.0) - area_of_circle(12, 2.0) - area_of_circle(13, 3.0)
                + area_of_circle(7, 1.0)
                + area_of_circle(9, 2.0);
            let (_, triangles, area) = of(&contours);
            assert!((area - expected).abs() < 1e-9, "{area} {expected}");
            // Each hole adds two corners to its outline.
            assert_eq!(triangles.len(), 40 + 12 + 13 + 4 - 2 + 7 - 2 + 9 - 2);
        }
    }

    #[test]
    fn a_hundred_holes_are_cut_out() {
        let mut contours = vec![circle(4, 100.0, [0.0, 0.0], 1.0)];
        for k in 0..100 {
            contours.push(circle(6, 2.0, [f64::from(k % 10) * 9.0 - 40.5, f64::from(k / 10) * 9.0 - 40.5], -1.0));
        }
        let (_, triangles, area) = of(&contours);
        assert!((area - area_of_circle(4, 100.0) + 100.0 * area_of_circle(6, 2.0)).abs() < 1e-7);
        assert_eq!(triangles.len(), 4 + 100 * 8 - 2);
    }

    #[test]
    fn corners_on_straight_edges_stay_corners() {
        let (_, triangles, area) =
            of(&[ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 1.0]])]);
        assert_eq!(area, 4.0);
        assert!((0..6).all(|corner| triangles.iter().any(|t| t.contains(&corner))));
        assert_eq!(triangles.len(), 4);
    }

    #[test]
    fn degenerate_contours_end() {
        let point = ring(&[[1.0, 1.0]; 5]);
        assert_eq!(of(&[point]).2, 0.0);
        let line = ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
        assert_eq!(of(std::slice::from_ref(&line)).1.len(), 2);
        // A contour that crosses itself, and a hole that is its outline again.
        let bow = ring(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0], [-1.0, 1.0]]);
        let mut triangles = Vec::new();
        triangulate(&bow, std::slice::from_ref(&(0..5)), DVec3::Z, &mut triangles);
        assert_eq!(triangles.len(), 3);
        let twice = [circle(5, 1.0, [0.0, 0.0], 1.0), circle(5, 1.0, [0.0, 0.0], 1.0)].concat();
        triangulate(&twice, &[0..5, 5..10], DVec3::Z, &mut triangles);
    }

    #[test]
    fn polygons_in_any_plane_keep_their_sense() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        for (normal, place) in [
            (DVec3::X, (|a, b| DVec3::new(5.0, a, b)) as fn(f64, f64) -> DVec3),
            (DVec3::Y, |a, b| DVec3::new(b, 5.0, a)),
            (DVec3::Z, |a, b| DVec3::new(a, b, 5.0)),
        ] {
            for sign in [1.0, -1.0] {
                let corners: Vec<DVec3> = square.iter().map(|p| place(p[0], sign * p[1])).collect();
                let mut triangles = Vec::new();
                triangulate(&corners, std::slice::from_ref(&(0..4)), normal, &mut triangles);
                for t in triangles {
                    let [a, b, c] = t.map(|k| corners[k as usize]);
                    assert!((b - a).cross(c - a).dot(normal * sign) > 0.0);
                }
            }
        }
    }
}
