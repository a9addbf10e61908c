//! Back-face and hidden-line removal of a cube, of the bunny and of open surfaces against a z-buffer of this test's
//! own.
//!
//! A z-buffer with its samples in the middles of pixels can say little about lines near an outline. Here the samples
//! are points of the edges themselves, wherever they fall on the screen; cells only list which triangles may cover
//! them.
//!
//! # Source
//! Samples at places of their own: Johnson, Lee, Burns and Mark 2005, The irregular Z-buffer.

use glam::{DVec2, DVec3};
use host::mesh;
use protocol::command::{Polygon, PolygonVertex};
use ps340::{
    functions::devices::shading::ShadingEnvironment,
    port::Rendering,
    rendering::{RenderingResult, Segment, render},
};
use std::collections::{HashMap, HashSet};
use tests::facets::{facets, matrix, polygons, to_screen, view};

/// Steps of the beam's grid across the screen.
const STEPS: usize = 1 << 24;
/// Cells of the z-buffer along a side.
const CELLS: usize = 512;
/// What lies this many steps inside all sides of a triangle, and as much behind, must be hidden.
const SURELY: f64 = 3.0;
/// What lies this many steps outside a side, or as much before, must not. Rests of lines that are shorter may be left
/// out.
const AT_LEAST: f64 = 18.0;
/// Points on each edge, besides those this many steps before and behind each end of a line.
const POINTS: usize = 4;
const CLOSE: f64 = 200.0;

/// The lines of a rendering, each in the hue of a polygon at it.
fn lines(polygons: &[Polygon], solid: bool, from: DVec3, kind: Rendering) -> Vec<Segment> {
    let named = |(number, polygon): (usize, &Polygon)| Polygon { outline: Some(number as f64), ..polygon.clone() };
    let facets = facets(polygons.iter().enumerate().map(named).collect(), solid, &view(from));
    match render(kind, facets, &ShadingEnvironment::default()) {
        Ok(RenderingResult::Lines(lines)) => lines,
        other => panic!("{other:?}"),
    }
}

/// A point of an edge on the screen.
struct Sample {
    /// In steps from the lower left corner, and 1/w.
    place: DVec3,
    /// By how much 1/w changes along the edge in a step.
    slope: f64,
    edge: [u32; 2],
    /// Whether a line is drawn there.
    drawn: bool,
    /// Whether a triangle surely hides it, and whether one might.
    hidden: bool,
    in_doubt: bool,
}

/// Polygons on the screen.
struct Screen {
    /// Corners in the coordinates of the polygons.
    corners: Vec<DVec3>,
    /// In steps, and 1/w.
    places: Vec<DVec3>,
    /// The corners of each polygon.
    polygons: Vec<Vec<u32>>,
}

impl Screen {
    fn new(polygons: &[Polygon], from: DVec3) -> Screen {
        let matrix = matrix(&view(from));
        let mut known = HashMap::new();
        let mut screen = Screen { corners: Vec::new(), places: Vec::new(), polygons: Vec::new() };
        for polygon in polygons {
            let corner = |v: &PolygonVertex| {
                *known.entry(v.position.map(f32::to_bits)).or_insert_with(|| {
                    screen.corners.push(DVec3::from(v.position.map(f64::from)));
                    screen.corners.len() as u32 - 1
                })
            };
            screen.polygons.push(polygon.vertices.iter().map(corner).collect());
        }
        screen.places = screen.corners.iter().map(|corner| to_screen(&matrix, *corner, STEPS)).collect();
        screen
    }

    fn edges_of(&self, polygon: usize) -> impl Iterator<Item = [u32; 2]> + '_ {
        let corners = &self.polygons[polygon];
        corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| [*a.min(b), *a.max(b)])
    }

    /// The parts of edges that are drawn, as parameters on the screen.
    fn drawn(&self, lines: &[Segment], from: DVec3) -> HashMap<[u32; 2], Vec<[f64; 2]>> {
        let matrix = matrix(&view(from));
        let mut drawn: HashMap<[u32; 2], Vec<[f64; 2]>> = HashMap::new();
        for line in lines {
            let distance = |edge: &[u32; 2]| {
                let [a, b] = edge.map(|end| self.corners[end as usize]);
                line.ends.iter().map(|p| (p - a).cross(b - a).length() / (b - a).length()).fold(0.0, f64::max)
            };
            let edges = self.edges_of(line.color[0] as usize);
            let nearest = edges.min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("polygons have edges");
            assert!(distance(&nearest) < 1e-9, "{line:?} is on no edge");
            let [a, b] = nearest.map(|end| self.places[end as usize].truncate());
            let ends =
                line.ends.map(|p| (to_screen(&matrix, p, STEPS).truncate() - a).dot(b - a) / (b - a).length_squared());
            drawn.entry(nearest).or_default().push([ends[0].min(ends[1]), ends[0].max(ends[1])]);
        }
        drawn
    }

    /// Points of all edges that are longer than a few steps, and points close to the ends of lines.
    fn samples(&self, drawn: &HashMap<[u32; 2], Vec<[f64; 2]>>) -> Vec<Sample> {
        let mut edges: Vec<[u32; 2]> = (0..self.polygons.len()).flat_map(|polygon| self.edges_of(polygon)).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut samples = Vec::new();
        for (number, edge) in edges.into_iter().enumerate() {
            let [a, b] = edge.map(|end| self.places[end as usize]);
            let length = (b - a).truncate().length();
            let parts = drawn.get(&edge).map_or(&[][..], Vec::as_slice);
            // The fraction of the golden ratio spreads them over the edges evenly.
            let evenly = (0..POINTS).map(|k| (k as f64 + (number as f64 * 0.618_033_988_75).fract()) / POINTS as f64);
            let close = parts.iter().flatten().flat_map(|t| [t - CLOSE / length, t + CLOSE / length]);
            for t in evenly.chain(close).filter(|t| length > 2.0 * CLOSE && (0.0..=1.0).contains(t)) {
                let place = a.lerp(b, t);
                if (2.0..STEPS as f64 - 2.0).contains(&place.x) && (2.0..STEPS as f64 - 2.0).contains(&place.y) {
                    let drawn = parts.iter().any(|[from, to]| (*from..=*to).contains(&t));
                    let slope = (b.z - a.z).abs() / length;
                    samples.push(Sample { place, slope, edge, drawn, hidden: false, in_doubt: false });
                }
            }
        }
        samples
    }

    /// Tests the samples against all triangles.
    fn z_buffer(&self, samples: &mut [Sample]) {
        let cell = |c: f64| (c.clamp(0.0, STEPS as f64 - 1.0) as usize) / (STEPS / CELLS);
        let mut cells = vec![Vec::new(); CELLS * CELLS];
        for (number, sample) in samples.iter().enumerate() {
            cells[cell(sample.place.y) * CELLS + cell(sample.place.x)].push(number as u32);
        }
        for corners in &self.polygons {
            for k in 2..corners.len() {
                let names = [corners[0], corners[k - 1], corners[k]];
                let triangle = names.map(|corner| self.places[corner as usize]);
                let low = triangle[0].min(triangle[1]).min(triangle[2]) - AT_LEAST;
                let high = triangle[0].max(triangle[1]).max(triangle[2]) + AT_LEAST;
                for row in cell(low.y)..=cell(high.y) {
                    for column in cell(low.x)..=cell(high.x) {
                        for number in &cells[row * CELLS + column] {
                            let sample = &mut samples[*number as usize];
                            if !sample.edge.iter().all(|end| names.contains(end)) {
                                sample.test(&triangle);
                            }
                        }
                    }
                }
            }
        }
    }
}

impl Sample {
    fn test(&mut self, triangle: &[DVec3; 3]) {
        let [a, b, c] = triangle;
        let [u, v] = [b - a, c - a];
        let area = u.truncate().perp_dot(v.truncate());
        let side = |p: &DVec3, q: &DVec3| {
            let along = (q - p).truncate();
            area.signum() * along.perp_dot((self.place - p).truncate()) / along.length()
        };
        let inside = side(a, b).min(side(b, c)).min(side(c, a));
        let gradient = DVec2::new(u.z * v.y - v.z * u.y, v.z * u.x - u.z * v.x) / area;
        let ahead = a.z + gradient.dot((self.place - a).truncate()) - self.place.z;
        let in_a_step = gradient.length() + self.slope;
        // Seen from its side, a triangle hides nothing, and decides nothing for sure about what is close to it.
        let behind =
            a.z.max(b.z).max(c.z) < self.place.z - AT_LEAST * self.slope || ahead < -AT_LEAST * in_a_step - 1e-12;
        self.hidden |= inside > SURELY && ahead > SURELY * in_a_step + 1e-12;
        self.in_doubt |= inside.is_nan() || ahead.is_nan() || inside > -AT_LEAST && !behind;
    }
}

/// The points that were checked: seen, hidden, and those that could not be decided.
#[derive(Debug, Default)]
struct Counts {
    seen: usize,
    hidden: usize,
    in_doubt: usize,
}

/// Checks lines seen from a point: what is drawn and hidden, or seen and not drawn, is wrong.
fn judge(polygons: &[Polygon], lines: &[Segment], from: DVec3) -> (Counts, Vec<String>) {
    let screen = Screen::new(polygons, from);
    let mut samples = screen.samples(&screen.drawn(lines, from));
    screen.z_buffer(&mut samples);
    let (mut counts, mut wrong) = (Counts::default(), Vec::new());
    for sample in &samples {
        match (sample.hidden, sample.in_doubt) {
            (true, _) => counts.hidden += 1,
            (false, false) => counts.seen += 1,
            (false, true) => counts.in_doubt += 1,
        }
        let problem = match (sample.hidden, sample.in_doubt, sample.drawn) {
            (true, _, true) => "shows through",
            (false, false, false) => "is missing",
            _ => continue,
        };
        let ends = sample.edge.map(|end| screen.corners[end as usize]);
        wrong.push(format!("{ends:?} {problem} at {}", sample.place));
    }
    (counts, wrong)
}

/// Checks that nothing shows through and nothing is missing, and that few points cannot be decided.
fn check(polygons: &[Polygon], lines: &[Segment], from: DVec3) -> Counts {
    let (counts, wrong) = judge(polygons, lines, from);
    assert!(wrong.is_empty(), "{} wrong of {counts:?}, from {from}: {:#?}", wrong.len(), &wrong[..wrong.len().min(9)]);
    assert!(counts.in_doubt <= 4 + (counts.seen + counts.hidden) / 50, "{counts:?}");
    counts
}

fn cube() -> Vec<Polygon> {
    let at = |corner: usize| [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.7 } else { -0.7 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4]];
    let vertices =
        |face: &[usize; 4]| face.map(|k| PolygonVertex { soft: false, position: at(k), normal: None, color: None });
    let polygon = |face: &[usize; 4]| vertices(face).to_vec();
    let polygons = faces.iter().map(polygon);
    polygons.map(|vertices| Polygon { attributes: None, outline: None, coplanar: false, vertices }).collect()
}

#[test]
fn a_cube_from_all_sides_shows_three_faces_two_or_one() {
    let cases = [
        (DVec3::new(2.0, 2.5, -3.0), 9),
        (DVec3::new(-2.0, -2.5, 3.0), 9),
        (DVec3::new(2.0, 0.0, -3.0), 7),
        (DVec3::new(0.0, 0.3, -3.5), 4),
    ];
    for (from, count) in cases {
        for kind in [Rendering::BackFace, Rendering::HiddenLine] {
            let lines = lines(&cube(), true, from, kind);
            assert_eq!(lines.len(), count, "{kind:?} from {from}");
            let counts = check(&cube(), &lines, from);
            assert!(counts.seen >= 4 * count && counts.hidden >= 4 * (12 - count), "{counts:?}");
        }
    }
}

#[test]
fn a_cube_without_its_top_shows_its_inside() {
    let open: Vec<Polygon> = cube().into_iter().enumerate().filter(|(k, _)| *k != 4).map(|(_, face)| face).collect();
    for from in [DVec3::new(2.0, 2.5, -3.0), DVec3::new(0.3, 4.0, -1.0), DVec3::new(-2.0, -2.5, 3.0)] {
        let counts = check(&open, &lines(&open, false, from, Rendering::HiddenLine), from);
        assert!(counts.seen > 40, "{counts:?}");
    }
}

#[test]
fn the_judge_finds_what_is_wrong() {
    let from = DVec3::new(2.0, 2.5, -3.0);
    let good = lines(&cube(), true, from, Rendering::HiddenLine);
    let wrong = |lines: &[Segment]| judge(&cube(), lines, from).1.join("\n");
    assert_eq!(wrong(&good), "");
    let [a, b] = good[3].ends;
    let short = Segment { ends: [a, a.lerp(b, 0.9999)], ..good[3] };
    assert!(wrong(&[&good[..3], &[short], &good[4..]].concat()).contains("is missing"));
    assert!(wrong(&good[1..]).contains("is missing"));
    for line in lines(&cube(), false, from, Rendering::BackFace).iter().filter(|line| !good.contains(line)) {
        assert!(wrong(&[&good[..], &[*line]].concat()).contains("shows through"), "{line:?}");
    }
}

/// How many edges have a polygon that runs clockwise, seen from a point.
fn facing(polygons: &[Polygon], from: DVec3) -> usize {
    let screen = Screen::new(polygons, from);
    let faces = |polygon: &usize| {
        let [a, b, c] = [0, 1, 2].map(|k| screen.corners[screen.polygons[*polygon][k] as usize]);
        (b - a).cross(c - a).dot(from - a) > 0.0
    };
    let edges = (0..polygons.len()).filter(faces).flat_map(|polygon| screen.edges_of(polygon));
    edges.collect::<HashSet<_>>().len()
}

#[test]
fn of_the_bunny_no_line_shows_through_and_none_is_missing() {
    let polygons = polygons(&mesh::bunny().expect("it ships"), false);
    for from in [DVec3::new(0.8, 1.0, -3.2), DVec3::new(-2.9, -0.7, 1.9), DVec3::new(0.1, 3.3, -0.2)] {
        for solid in [true, false] {
            let counts = check(&polygons, &lines(&polygons, solid, from, Rendering::HiddenLine), from);
            assert!(counts.seen > 150_000 && counts.hidden > 150_000, "{counts:?}");
        }
        assert_eq!(lines(&polygons, true, from, Rendering::BackFace).len(), facing(&polygons, from));
    }
}

#[test]
fn of_a_bunny_with_holes_the_inside_is_seen_through_them() {
    let polygons: Vec<Polygon> = polygons(&mesh::bunny().expect("it ships"), false)
        .into_iter()
        .enumerate()
        .filter(|(k, _)| k % 7 != 0)
        .map(|(_, p)| p)
        .collect();
    for from in [DVec3::new(-0.8, 1.0, 3.2), DVec3::new(2.9, -0.7, 1.9)] {
        let counts = check(&polygons, &lines(&polygons, false, from, Rendering::HiddenLine), from);
        assert!(counts.seen > 200_000 && counts.hidden > 200_000, "{counts:?}");
    }
}
