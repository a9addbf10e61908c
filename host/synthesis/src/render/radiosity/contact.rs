//! Contacts: where surfaces touch or pass through each other, elements end, so that none is partly inside of something.

use super::hierarchy::Hierarchy;

use super::node::{RadiosityPatch, normal_and_area};
use super::shortest_edges::ShortestEdges;
use super::visibility::VisibilityTester;
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use rayon::prelude::*;

/// The longest edge of an element that is cut and from which another surface rises, in shortest ones.
const NEAR_CREASES: f64 = 4.0;
/// The longest edge of an element that is cut, in shortest ones: light changes quickly where surfaces meet.
const NEAR_LINES: f64 = 2.0;
/// As many lines are cut along while an element may still be divided into four, and at the most.
const FEW_LINES: usize = 3;
const MOST_LINES: usize = 12;

/// Surfaces touch that are nearer than this, in diagonals of the scene.
const TOUCHING: f64 = 1e-7;
/// What two surfaces have in common is a point if it is no longer than so many times that.
const POINTLIKE: f64 = 16.0;
/// Surfaces rise steeply from others if the cosine between their normals is less.
const STEEP: f64 = 0.7;

/// Lines on triangles, each from one end to the other; the ends may lie beyond the triangle.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    /// For each triangle of the scene those that lead over it; empty if there are none at all.
    of: Vec<Vec<[DVec3; 2]>>,
    /// Those lines where another surface rises steeply, inside or at its edges.
    creases: Vec<Vec<[DVec3; 2]>>,
    tolerance: f64,
}

impl Contacts {
    /// The lines on some triangles.
    ///
    /// Rods that are thinner than elements neither have nor make any: nothing larger than an element is in them or
    /// behind.
    ///
    /// - `finest`: a length. `takes_part`: whether a triangle is asked for.
    pub(super) fn new(
        visibility: &VisibilityTester<'_>,
        diagonal: f64,
        finest: f64,
        takes_part: impl Fn(u32) -> bool + Sync,
    ) -> Contacts {
        let prepared = visibility.world.appearance.prepared;
        let tolerance = TOUCHING * diagonal;
        let is_rod: Vec<bool> = prepared.objects.iter().map(|object| is_rod(&object.bounds, finest)).collect();
        let is_of_rod = |triangle: u32| is_rod[prepared.object_of[triangle as usize] as usize];
        let takes_part = |triangle: u32| takes_part(triangle) && !is_of_rod(triangle);
        let near = DVec3::splat(tolerance);
        let lines = |triangle: u32| {
            let (mut lines, mut creases) = (Vec::new(), Vec::new());
            if takes_part(triangle) {
                let own = prepared.corners(triangle);
                let Bounds { min, max } = Bounds::of(own);
                visibility.world.each_near(Bounds { min: min - near, max: max + near }, |other| {
                    if other != triangle && !is_of_rod(other) {
                        let other = prepared.corners(other);
                        meeting(own, other, tolerance, |line| lines.push(line));
                        creases.extend(crease(own, other, tolerance));
                    }
                });
                // The order in which they are found is none of theirs.
                let key = |line: &[DVec3; 2]| line.map(|end| end.to_array().map(|x| x.to_bits()));
                for lines in [&mut lines, &mut creases] {
                    lines.sort_unstable_by_key(key);
                    lines.dedup();
                }
            }
            (lines, creases)
        };
        let (of, creases) = (0..prepared.triangles.len() as u32).into_par_iter().map(lines).unzip();
        Contacts { of, creases, tolerance }
    }

    /// The lines on a triangle where another surface rises steeply.
    pub(super) fn creases(&self, triangle: u32) -> &[[DVec3; 2]] {
        self.creases.get(triangle as usize).map_or(&[], |lines| lines)
    }

    /// Whether a line leads through a convex polygon or along an edge of it.
    pub(super) fn touches(&self, line: &[DVec3; 2], polygon: &[DVec3], normal: DVec3) -> bool {
        common(line, polygon, normal, -self.tolerance) > POINTLIKE * self.tolerance
    }

    /// The lines on a triangle.
    pub(super) fn on(&self, triangle: u32) -> &[[DVec3; 2]] {
        self.of.get(triangle as usize).map_or(&[], |lines| lines)
    }

    /// Whether a line leads through the inside of a convex polygon.
    pub(super) fn crosses(&self, line: &[DVec3; 2], polygon: &[DVec3], normal: DVec3) -> bool {
        crosses(line, polygon, normal, self.tolerance)
    }

    /// Whether a line leads through the inside of a patch.
    pub(super) fn cross(&self, patch: &RadiosityPatch) -> bool {
        let lines = self.on(patch.triangle);
        !lines.is_empty() && {
            let normal = normal_and_area(patch.corners).0;
            lines.iter().any(|line| self.crosses(line, &patch.corners, normal))
        }
    }

    /// Triangles of which a triangle consists that no line leads through.
    pub(super) fn cut(&self, corners: [DVec3; 3], lines: &[[DVec3; 2]]) -> Vec<[DVec3; 3]> {
        let normal = normal_and_area(corners).0;
        let mut cells = vec![corners.to_vec()];
        for line in lines {
            let mut next = Vec::with_capacity(cells.len() + 2);
            for cell in cells {
                match self.crosses(line, &cell, normal).then(|| split(&cell, line, normal, self.tolerance)).flatten() {
                    Some(halves) => next.extend(halves),
                    None => next.push(cell),
                }
            }
            cells = next;
        }
        cells.iter().flat_map(|cell| fan(cell)).collect()
    }
}

/// Whether what is in a box is thinner than a length in all directions but one.
fn is_rod(bounds: &Bounds, finest: f64) -> bool {
    let mut size = (bounds.max - bounds.min).to_array();
    size.sort_by(f64::total_cmp);
    size[1] < finest
}

/// Gives the lines in which a triangle intersects another; all of its edges, if it lies in the plane.
fn meeting(own: [DVec3; 3], other: [DVec3; 3], tolerance: f64, mut give: impl FnMut([DVec3; 2])) {
    let (normal, area) = normal_and_area(own);
    if area <= 0.0 {
        return;
    }
    let heights = other.map(|corner| {
        let height = (corner - own[0]).dot(normal);
        if height.abs() <= tolerance { 0.0 } else { height }
    });
    let edges = [[0, 1], [1, 2], [2, 0]];
    let mut put = |line: [DVec3; 2]| {
        // The same line whichever triangle it comes from.
        let [a, b] = line;
        let line = if a.to_array() <= b.to_array() { [a, b] } else { [b, a] };
        if crosses(&line, &own, normal, tolerance) {
            give(line);
        }
    };
    let on = heights.iter().filter(|height| **height == 0.0).count();
    if on >= 2 {
        for [i, j] in edges {
            if heights[i] == 0.0 && heights[j] == 0.0 {
                put([other[i], other[j]]);
            }
        }
        return;
    }
    let mut ends = [DVec3::ZERO; 2];
    let mut count = 0;
    let mut add = |end: DVec3| {
        if count < 2 {
            ends[count] = end;
        }
        count += 1;
    };
    for [i, j] in edges {
        if heights[i] == 0.0 {
            add(other[i]);
        }
        if heights[i] * heights[j] < 0.0 {
            add(between(other[i], other[j], heights[i], heights[j]));
        }
    }
    if count == 2 {
        put(ends);
    }
}

/// The point between two at a height of 0; the same to the last bit in whichever order they come.
fn between(a: DVec3, b: DVec3, low: f64, high: f64) -> DVec3 {
    let (a, b, low, high) = if a.to_array() <= b.to_array() { (a, b, low, high) } else { (b, a, high, low) };
    a + (b - a) * (low / (low - high))
}

/// The line in which a triangle intersects another that rises steeply from it.
fn crease(own: [DVec3; 3], other: [DVec3; 3], tolerance: f64) -> Option<[DVec3; 2]> {
    let (normal, _) = normal_and_area(own);
    let [one, two] = [normal, normal_and_area(other).0];
    if one.dot(two).abs() > STEEP {
        return None;
    }
    let on: Vec<DVec3> = other.into_iter().filter(|corner| (*corner - own[0]).dot(normal).abs() <= tolerance).collect();
    let line = <[DVec3; 2]>::try_from(on).ok()?;
    (common(&line, &own, normal, -tolerance) > POINTLIKE * tolerance).then_some(line)
}

fn crosses(line: &[DVec3; 2], polygon: &[DVec3], normal: DVec3, tolerance: f64) -> bool {
    common(line, polygon, normal, tolerance) > tolerance
}

/// How much of a line is in a convex polygon and farther from its edges than a tolerance.
fn common([from, to]: &[DVec3; 2], polygon: &[DVec3], normal: DVec3, tolerance: f64) -> f64 {
    let along = *to - *from;
    let (mut begin, mut end) = (0.0f64, 1.0f64);
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let inwards = normal.cross(b - a).normalize_or_zero();
        // What runs along an edge divides nothing.
        let (height, slope) = ((*from - a).dot(inwards) - tolerance, along.dot(inwards));
        if slope.abs() <= f64::MIN_POSITIVE {
            if height <= 0.0 {
                return 0.0;
            }
        } else if slope > 0.0 {
            begin = begin.max(-height / slope);
        } else {
            end = end.min(-height / slope);
        }
    }
    ((end - begin) * along.length()).max(0.0)
}

/// Both parts of a convex polygon beside a line; none if one of them is next to nothing.
fn split(polygon: &[DVec3], [from, to]: &[DVec3; 2], normal: DVec3, tolerance: f64) -> Option<[Vec<DVec3>; 2]> {
    let across = normal.cross(*to - *from).try_normalize()?;
    let heights: Vec<f64> = polygon
        .iter()
        .map(|corner| (*corner - *from).dot(across))
        .map(|height| if height.abs() <= tolerance { 0.0 } else { height })
        .collect();
    let mut parts = [Vec::new(), Vec::new()];
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        let (low, high) = (heights[i], heights[j]);
        if low >= 0.0 {
            parts[0].push(polygon[i]);
        }
        if low <= 0.0 {
            parts[1].push(polygon[i]);
        }
        if low * high < 0.0 {
            let point = between(polygon[i], polygon[j], low, high);
            parts.iter_mut().for_each(|part| part.push(point));
        }
    }
    parts.iter().all(|part| part.len() >= 3).then_some(parts)
}

/// Triangles of which a convex polygon consists, about the corner that makes the least slender.
fn fan(polygon: &[DVec3]) -> Vec<[DVec3; 3]> {
    let count = polygon.len();
    let about = |first: usize| {
        let corner = move |i: usize| polygon[(first + i) % count];
        (1..count - 1).map(move |i| [corner(0), corner(i), corner(i + 1)])
    };
    let shape = |[a, b, c]: [DVec3; 3]| {
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        (b - a).cross(c - a).length() / longest
    };
    let worst = |first: usize| about(first).map(shape).fold(f64::INFINITY, f64::min);
    let best = (0..count).max_by(|a, b| worst(*a).total_cmp(&worst(*b)).then(b.cmp(a))).unwrap_or(0);
    about(best).filter(|corners| normal_and_area(*corners).1 > 0.0).collect()
}

impl Hierarchy {
    /// Divides patches so that no line leads through an element, where that can be had with elements as short as the
    /// finest.
    pub(super) fn cut(&mut self, contacts: &Contacts, edges: &ShortestEdges) {
        let on = |patch: &u32| contacts.on(self.patches[*patch as usize].triangle).to_vec();
        let is_alone = |patch: &u32| self.nodes[self.node_of[*patch as usize] as usize].patch == *patch;
        let alone = (0..self.patches.len() as u32).filter(is_alone);
        let lined = alone.map(|patch| (self.node_of[patch as usize], on(&patch)));
        let mut waiting: Vec<(u32, Vec<[DVec3; 2]>)> = lined.collect();
        while let Some((place, mut lines)) = waiting.pop() {
            let node = self.nodes[place as usize];
            lines.retain(|line| contacts.crosses(line, &node.corners, node.normal));
            let (length, finest) = (node.longest_edge(), edges.of(&node));
            let creases = contacts.creases(self.patches[node.patch as usize].triangle);
            let is_at_crease = || creases.iter().any(|line| contacts.touches(line, &node.corners, node.normal));
            if lines.is_empty() {
                if length > NEAR_CREASES * finest && is_at_crease() {
                    self.divide(place);
                    waiting.extend(self.nodes[place as usize].children().map(|child| (child as u32, Vec::new())));
                }
                continue;
            }
            if length >= 2.0 * finest && (length > NEAR_LINES * finest || lines.len() > FEW_LINES) {
                self.divide(place);
                waiting.extend(self.nodes[place as usize].children().map(|child| (child as u32, lines.clone())));
            } else if lines.len() <= MOST_LINES {
                let parts = contacts.cut(node.corners, &lines);
                if parts.len() > 1 {
                    self.divide_into(place, &parts);
                    self.nodes[place as usize].is_cut = true;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [DVec3; 3] = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];

    fn lines(other: [DVec3; 3]) -> Vec<[DVec3; 2]> {
        let mut found = Vec::new();
        meeting(FLOOR, other, 1e-9, |line| found.push(line));
        found
    }

    #[test]
    fn triangles_that_touch_cross_or_lie_on_each_other_meet_in_lines_and_others_in_none() {
        let at = DVec3::new;
        let wall = [at(1.0, 1.0, 0.0), at(2.0, 1.0, 0.0), at(1.0, 1.0, 3.0)];
        assert_eq!(lines(wall), [[wall[0], wall[1]]]);
        let through = [at(1.0, 1.0, -1.0), at(2.0, 1.0, -1.0), at(1.0, 1.0, 1.0)];
        assert_eq!(lines(through), [[at(1.0, 1.0, 0.0), at(1.5, 1.0, 0.0)]]);
        let flat = [at(1.0, 1.0, 0.0), at(1.0, 1.5, 0.0), at(1.5, 1.0, 0.0)];
        assert_eq!(lines(flat).len(), 3);
        let nothing = [
            [at(1.0, 1.0, 0.1), at(2.0, 1.0, 0.1), at(1.0, 1.0, 3.0)],
            // On a corner, along an edge, beside it.
            [at(1.0, 1.0, 0.0), at(2.0, 1.0, 1.0), at(1.0, 1.0, 3.0)],
            [at(1.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(1.0, 0.0, 3.0)],
            [at(3.0, 3.0, 0.0), at(3.5, 3.0, 0.0), at(3.0, 3.0, 3.0)],
        ];
        nothing.into_iter().for_each(|other| assert!(lines(other).is_empty(), "{other:?}"));
    }

    #[test]
    fn rods_are_thin_in_all_directions_but_one() {
        let size = |x: f64, y: f64, z: f64| Bounds { min: DVec3::ZERO, max: DVec3::new(x, y, z) };
        assert!(is_rod(&size(6.0, 0.01, 0.02), 0.1) && is_rod(&size(0.01, 0.01, 0.01), 0.1));
        // A sheet is none.
        assert!(!is_rod(&size(6.0, 0.01, 6.0), 0.1));
    }

    #[test]
    fn steep_neighbours_make_creases_and_flat_ones_do_not() {
        let at = DVec3::new;
        let [a, b] = [at(1.0, 0.0, 0.0), at(3.0, 0.0, 0.0)];
        assert_eq!(crease(FLOOR, [a, b, at(1.0, 0.0, 2.0)], 1e-9), Some([a, b]));
        assert_eq!(crease(FLOOR, [a, b, at(1.0, -2.0, 0.5)], 1e-9), None);
        // At a corner only, and beyond one.
        let beyond = [at(4.0, 0.0, 0.0), at(6.0, 0.0, 0.0), at(4.0, 0.0, 2.0)];
        assert_eq!(crease(FLOOR, beyond, 1e-9), None);
    }

    #[test]
    fn parts_of_a_cut_triangle_are_all_of_it_and_no_line_leads_through_one() {
        let contacts = Contacts { tolerance: 1e-9, ..Contacts::default() };
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let foot = [at(0.5, 0.5), at(1.7, 0.6), at(1.6, 1.6), at(0.4, 1.5)];
        let lines: Vec<[DVec3; 2]> = (0..4).map(|i| [foot[i], foot[(i + 1) % 4]]).collect();
        let parts = contacts.cut(FLOOR, &lines);
        let area: f64 = parts.iter().map(|part| normal_and_area(*part).1).sum();
        assert!((area - 8.0).abs() < 1e-9, "{area}");
        for part in &parts {
            assert!(normal_and_area(*part).0.z > 0.99, "it faces the same way");
            assert!(lines.iter().all(|line| !contacts.crosses(line, part, DVec3::Z)));
        }
        let is_in = |point: DVec3| lines.iter().all(|[a, b]| (*b - *a).cross(point - *a).z > 0.0);
        let inside: f64 = parts
            .iter()
            .filter(|part| is_in((part[0] + part[1] + part[2]) / 3.0))
            .map(|part| normal_and_area(*part).1)
            .sum();
        let [a, b, c, d] = foot;
        let exact = 0.5 * ((c - a).cross(d - b)).z.abs();
        assert!((inside - exact).abs() < 1e-9, "{inside} {exact}");
    }
}
