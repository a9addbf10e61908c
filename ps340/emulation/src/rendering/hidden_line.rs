//! Hidden-line removal: which parts of each edge no polygon hides.
//!
//! # Model
//! Points are rounded to a grid of 2^24 by 2^24 points on the screen, as fine as the strokes of the beam. On it every
//! sign and every quotient that locates an edge against the sides of a triangle is exact or correctly rounded, so that
//! neighbouring triangles hide up to the very same point and nothing shows through between them. A triangle is closed:
//! what lies exactly behind its side is hidden.
//!
//! An edge is never hidden by the faces it belongs to, nor by one that is nearer by less than what a step of the grid
//! changes: lines in the plane of a polygon are seen. Rests shorter than [`SHORTEST`] steps are left out, unless they
//! are whole edges.
//!
//! Of a solid that is not opened by the front of the view, triangles that show their reverse, and edges between two of
//! them, are hidden by others; they are left out from the start. Soft edges are drawn where one of the two triangles at
//! them is seen from its front and the other from its reverse, or where there is only one. So are the inner edges of a
//! polygon that is not plane, where it bends away from the eye.
//!
//! # Source
//! The visible intervals of A. Appel 1967, found edge by edge against the triangles in the cells of a uniform grid
//! (Franklin 1980) instead of along contours; grid, rounding and tolerances are ours.
//!
//! # Cost
//! Proportional to n for n triangles of equal size, since cells are about as large as they; n^2 at worst.

use super::{
    Facets, Segment,
    facets::Edge,
    project::{Projected, ProjectedEdge, project},
};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// Steps of the grid from the middle of the screen to its side.
const STEPS: f64 = (1 << 23) as f64;
/// The depth key is right to this part of the largest that is mixed.
const ROUNDING: f64 = 1e-13;
/// Rests of an edge shorter than this many steps are not drawn: a thousandth of a pixel.
const SHORTEST: f64 = 16.0;
/// Most cells of the grid across the screen, as a power of two.
const MOST_CELLS: u32 = 10;
/// Edges that are tested between two looks at the budget.
const BATCH: usize = 512;
/// What an edge costs besides its tests, in tests.
const EDGE_UNITS: u64 = 10;

/// Hidden-line removal in progress.
#[derive(Debug)]
pub struct HiddenLine {
    grid: Grid,
    edges: Vec<ScreenEdge>,
    next: usize,
    segments: Vec<Segment>,
}

/// A point on the grid of the screen; x and y are integers of at most 2^24.
#[derive(Clone, Copy, Debug, Default)]
struct GridPoint {
    x: f64,
    y: f64,
    nearness: f64,
}

/// An edge on the screen.
#[derive(Clone, Debug)]
struct ScreenEdge {
    ends: [GridPoint; 2],
    /// Numbers of its ends.
    names: [u32; 2],
    faces: [Option<u32>; 2],
    /// Its ends in the coordinates of the node and their w.
    endpoints: [(glam::DVec4, f64); 2],
    color: [f64; 2],
}

/// An occluder: a triangle on the screen, counter-clockwise.
#[derive(Clone, Copy, Debug)]
struct Occluder {
    spots: [GridPoint; 3],
    names: [u32; 3],
    face: u32,
    /// Twice its area.
    area: f64,
    /// The nearest of its corners.
    nearest: f64,
    /// How much the depth key changes in a step of the grid, with roundings.
    slack: f64,
}

/// Occluders by the cells of the screen that they may touch.
#[derive(Debug)]
struct Grid {
    occluders: Vec<Occluder>,
    /// Cells across, as a power of two.
    cells: u32,
    /// Where the list of each cell begins.
    starts: Vec<u32>,
    lists: Vec<u32>,
}

impl HiddenLine {
    /// Begins with facets.
    pub fn new(facets: &Facets) -> HiddenLine {
        let sides = sides(facets);
        let edges = drawn(facets, &sides);
        let projected = project(facets, &edges);
        let closed = facets.solid && !projected.opened;
        let spots: Vec<GridPoint> = projected.points.iter().map(GridPoint::new).collect();
        let seen = |edge: &Edge| !closed || sides.get(&edge.ends).is_none_or(|side| side.toward > 0);
        let lines = projected.lines.iter().filter(|line| seen(&edges[line.edge]));
        let edges = lines.map(|line| ScreenEdge::new(line, &edges[line.edge], &spots)).collect();
        HiddenLine {
            grid: Grid::new(occluders(facets, &projected, &spots, closed)),
            edges,
            next: 0,
            segments: Vec::new(),
        }
    }

    /// Goes on for about so many tests of an edge against a triangle. Returns what is seen, once it is done.
    pub fn advance(&mut self, units: u64) -> Option<Vec<Segment>> {
        let mut left = units;
        while self.next < self.edges.len() {
            if left == 0 {
                return None;
            }
            let end = (self.next + BATCH).min(self.edges.len());
            let seen = |edge: &ScreenEdge| self.grid.visible(edge);
            let parts: Vec<(Vec<Segment>, u64)> = self.edges[self.next..end].par_iter().map(seen).collect();
            for (segments, tests) in parts {
                self.segments.extend(segments);
                left = left.saturating_sub(tests + EDGE_UNITS);
            }
            self.next = end;
        }
        Some(std::mem::take(&mut self.segments))
    }
}

/// The triangles at a side: how many are seen from their front, and how many from their reverse.
#[derive(Clone, Copy, Debug, Default)]
struct Side {
    toward: u32,
    away: u32,
    /// One of the faces.
    face: u32,
}

/// The sides of all triangles, by their ends, the smaller number first.
fn sides(facets: &Facets) -> HashMap<[u32; 2], Side> {
    let mut sides: HashMap<[u32; 2], Side> = HashMap::with_capacity(facets.triangles.len() * 3 / 2);
    for triangle in &facets.triangles {
        let [a, b, c] = triangle.corners.map(|corner| facets.corners[corner as usize].point);
        // Where a hole was joined a triangle may use a point twice: it separates nothing.
        if a == b || b == c || c == a {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let side = sides.entry([from.min(to), from.max(to)]).or_default();
            side.face = triangle.face;
            *if triangle.toward { &mut side.toward } else { &mut side.away } += 1;
        }
    }
    sides
}

/// The edges that are drawn as far as nothing hides them, in a fixed order.
fn drawn(facets: &Facets, sides: &HashMap<[u32; 2], Side>) -> Vec<Edge> {
    let bends = |side: &Side| side.toward > 0 && side.away > 0;
    let is_outline = |side: &Side| bends(side) || side.toward + side.away == 1;
    let polygons = facets.edges.iter();
    let polygons = polygons.filter(|edge| !edge.soft || sides.get(&edge.ends).is_none_or(is_outline));
    let mut edges: Vec<Edge> = polygons.map(|edge| Edge { color: facets.color_of(edge), ..*edge }).collect();
    let outer: HashSet<[u32; 2]> = facets.edges.iter().map(|edge| edge.ends).collect();
    let inner = sides.iter().filter(|(ends, side)| bends(side) && !outer.contains(*ends));
    let mut inner: Vec<([u32; 2], u32)> = inner.map(|(ends, side)| (*ends, side.face)).collect();
    inner.sort_unstable();
    edges.extend(inner.into_iter().map(|(ends, face)| Edge {
        ends,
        faces: [Some(face), None],
        corners: [[0; 2]; 2],
        uses: [0; 2],
        soft: true,
        color: facets.faces[face as usize].color,
    }));
    edges
}

fn occluders(facets: &Facets, projected: &Projected, spots: &[GridPoint], closed: bool) -> Vec<Occluder> {
    let pieces = projected.pieces.iter().filter_map(|piece| {
        let triangle = &facets.triangles[piece.triangle as usize];
        let corners = piece.spots.map(|spot| spots[spot as usize]);
        let hides = triangle.toward || !closed;
        hides.then(|| Occluder::new(piece.spots, corners, triangle.face)).flatten()
    });
    pieces.collect()
}

impl GridPoint {
    fn new(spot: &super::project::ScreenPoint) -> GridPoint {
        GridPoint {
            x: (spot.position.x * STEPS).round().clamp(-STEPS, STEPS),
            y: (spot.position.y * STEPS).round().clamp(-STEPS, STEPS),
            nearness: spot.depth_key,
        }
    }

    /// Twice the area of the triangle with two other points: exact.
    fn area(&self, a: &GridPoint, b: &GridPoint) -> f64 {
        (a.x - self.x) * (b.y - self.y) - (a.y - self.y) * (b.x - self.x)
    }
}

impl Occluder {
    /// None for a triangle that is seen from its side.
    fn new(mut names: [u32; 3], mut spots: [GridPoint; 3], face: u32) -> Option<Occluder> {
        let mut area = spots[0].area(&spots[1], &spots[2]);
        if area < 0.0 {
            names.swap(1, 2);
            spots.swap(1, 2);
            area = -area;
        }
        let [a, b, c] = spots;
        let (u, v) = (b.nearness - a.nearness, c.nearness - a.nearness);
        let slope_x = (u * (c.y - a.y) - v * (b.y - a.y)) / area;
        let slope_y = (v * (b.x - a.x) - u * (c.x - a.x)) / area;
        let largest = a.nearness.abs().max(b.nearness.abs()).max(c.nearness.abs());
        let slack = slope_x.abs() + slope_y.abs() + ROUNDING * largest;
        let nearest = a.nearness.max(b.nearness).max(c.nearness);
        (area > 0.0).then_some(Occluder { spots, names, face, area, nearest, slack })
    }

    /// The part of an edge that the occluder hides, as parameters along the edge.
    fn hidden(&self, edge: &ScreenEdge) -> Option<[f64; 2]> {
        let [a, b] = &edge.ends;
        let [p, q, r] = &self.spots;
        // Twice the areas that the ends make with the sides, opposite to each corner: exact, negative outside.
        let from = [a.area(q, r), a.area(r, p), a.area(p, q)];
        let to = [b.area(q, r), b.area(r, p), b.area(p, q)];
        let (mut begin, mut end) = (0.0_f64, 1.0_f64);
        for (from, to) in from.into_iter().zip(to) {
            if from < 0.0 && to < 0.0 {
                return None;
            }
            if from < 0.0 {
                begin = begin.max(from / (from - to));
            } else if to < 0.0 {
                end = end.min(from / (from - to));
            }
        }
        if begin >= end {
            return None;
        }
        let slack = self.slack + ROUNDING * a.nearness.abs().max(b.nearness.abs());
        // How much nearer the edge is, at both ends of that part.
        let ahead = |t: f64| {
            let plane: f64 = (0..3).map(|k| (from[k] + (to[k] - from[k]) * t) * self.spots[k].nearness).sum();
            a.nearness + (b.nearness - a.nearness) * t - plane / self.area
        };
        let meets = |name: u32| self.names.contains(&name);
        let (first, last) = (ahead(begin), ahead(end));
        // From a common corner on, the edge goes behind or before the triangle all the way.
        if begin == 0.0 && meets(edge.names[0]) {
            return (last < -slack).then_some([begin, end]);
        }
        if end == 1.0 && meets(edge.names[1]) {
            return (first < -slack).then_some([begin, end]);
        }
        match (first < -slack, last < -slack) {
            (true, true) => Some([begin, end]),
            (false, false) => None,
            (behind, _) => {
                let crossing = begin + (end - begin) * ((-slack - first) / (last - first)).clamp(0.0, 1.0);
                Some(if behind { [begin, crossing] } else { [crossing, end] })
            }
        }
    }
}

impl Grid {
    fn new(occluders: Vec<Occluder>) -> Grid {
        let mut cells = (occluders.len().max(1).ilog2() / 2 + 1).min(MOST_CELLS);
        let entries = |cells: u32| -> usize {
            occluders.iter().map(|occluder| columns_of(occluder, cells).len() * rows_of(occluder, cells).len()).sum()
        };
        // Large triangles are in many cells; there may be no more entries than this for each of them.
        while cells > 0 && entries(cells) > 64 + 16 * occluders.len() {
            cells -= 1;
        }
        let mut starts = vec![0_u32; (1 << (2 * cells)) + 1];
        let each_cell = |occluder: &Occluder, visit: &mut dyn FnMut(usize)| {
            for row in rows_of(occluder, cells) {
                columns_of(occluder, cells).for_each(|column| visit((row << cells) + column));
            }
        };
        for occluder in &occluders {
            each_cell(occluder, &mut |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut free = starts.clone();
        let mut lists = vec![0; starts.last().map_or(0, |end| *end as usize)];
        for (number, occluder) in occluders.iter().enumerate() {
            each_cell(occluder, &mut |cell| {
                lists[free[cell] as usize] = number as u32;
                free[cell] += 1;
            });
        }
        Grid { occluders, cells, starts, lists }
    }

    /// The seen parts of an edge, and the number of tests that they took.
    fn visible(&self, edge: &ScreenEdge) -> (Vec<Segment>, u64) {
        let [a, b] = &edge.ends;
        let (farthest, length) = (a.nearness.min(b.nearness), (b.x - a.x).hypot(b.y - a.y));
        let mut hidden: Vec<[f64; 2]> = Vec::new();
        let mut tests = 0;
        let rows = span(a.y, b.y, self.cells);
        for row in rows {
            for column in self.columns(a, b, row) {
                let cell = (row << self.cells) + column;
                let list = &self.lists[self.starts[cell] as usize..self.starts[cell + 1] as usize];
                tests += list.len() as u64;
                let before = hidden.len();
                for &number in list {
                    let occluder = &self.occluders[number as usize];
                    if occluder.nearest > farthest && !edge.faces.contains(&Some(occluder.face)) {
                        hidden.extend(occluder.hidden(edge));
                    }
                }
                if hidden[before..].contains(&[0.0, 1.0]) {
                    return (Vec::new(), tests);
                }
            }
        }
        hidden.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        let mut segments = Vec::new();
        let mut from = 0.0;
        for [begin, end] in hidden.into_iter().chain([[1.0, 1.0]]) {
            let whole = from == 0.0 && begin == 1.0;
            if begin > from && (whole || (begin - from) * length >= SHORTEST) {
                segments.extend(edge.part(from, begin));
            }
            from = end.max(from);
        }
        (segments, tests)
    }

    /// The columns of cells in a row that a line may touch.
    fn columns(&self, a: &GridPoint, b: &GridPoint, row: usize) -> std::ops::RangeInclusive<usize> {
        let size = 2.0 * STEPS / (1_u64 << self.cells) as f64;
        let bottom = row as f64 * size - STEPS;
        let at = |y: f64| {
            let t = if a.y == b.y { 0.0 } else { ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0) };
            a.x + (b.x - a.x) * t
        };
        let (left, right) = if a.y == b.y { (a.x, b.x) } else { (at(bottom), at(bottom + size)) };
        // A step to each side for roundings.
        span(left.min(right) - 1.0, left.max(right) + 1.0, self.cells)
    }
}

impl ScreenEdge {
    fn new(line: &ProjectedEdge, edge: &Edge, spots: &[GridPoint]) -> ScreenEdge {
        let ends = line.spots.map(|spot| spots[spot as usize]);
        ScreenEdge { ends, names: line.spots, faces: edge.faces, endpoints: line.ends, color: edge.color }
    }

    /// A part of the edge in the coordinates of the node. Parameters run evenly on the screen.
    fn part(&self, from: f64, to: f64) -> Option<Segment> {
        let [(a, wa), (b, wb)] = self.endpoints;
        let place = |t: f64| {
            if t == 0.0 || t == 1.0 {
                let end = if t == 0.0 { a } else { b };
                return end.truncate() / end.w;
            }
            let u = t * wa / ((1.0 - t) * wb + t * wa);
            let point = a + (b - a) * u;
            point.truncate() / point.w
        };
        let ends = [place(from), place(to)];
        ends.iter().all(|end| end.is_finite()).then_some(Segment { ends, color: self.color })
    }
}

/// The cells that the way from one coordinate to another touches.
fn span(from: f64, to: f64, cells: u32) -> std::ops::RangeInclusive<usize> {
    let last = (1_i64 << cells) - 1;
    let cell = |c: f64| (((c + STEPS) as i64) >> (24 - cells)).clamp(0, last) as usize;
    cell(from.min(to))..=cell(from.max(to))
}

fn rows_of(occluder: &Occluder, cells: u32) -> std::ops::Range<usize> {
    let [a, b, c] = occluder.spots.map(|spot| spot.y);
    let span = span(a.min(b).min(c), a.max(b).max(c), cells);
    *span.start()..span.end() + 1
}

fn columns_of(occluder: &Occluder, cells: u32) -> std::ops::Range<usize> {
    let [a, b, c] = occluder.spots.map(|spot| spot.x);
    let span = span(a.min(b).min(c), a.max(b).max(c), cells);
    *span.start()..span.end() + 1
}
