//! Triangulation of planar polygons: star, plate with holes, comb, beside the crates `earcut` and `i_triangle`.
//!
//! Each result is checked first: the count, the area, and for ours that no triangle is turned over, so that the areas
//! cannot hide an overlap. Then the best of several runs counts, in processor seconds of one thread. Only `host` and
//! the first `i_triangle` check the polygon for crossings; the second one and `earcut` trust it.
//! `cargo bench -p tests --bench polygons`

use std::f64::consts::TAU;
use std::hint::black_box;

use glam::DVec2;
use host::polygon::{TriangulationKind, triangulate};
use i_triangle::float::triangulatable::Triangulatable;
use i_triangle::float::unchecked::UncheckedTriangulatable;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Runs of each case at most; fewer where one takes longer than a second.
const RUNS: usize = 9;

fn main() {
    // `cargo bench` passes `--bench`; without it only small polygons are checked.
    let largest = if std::env::args().any(|argument| argument == "--bench") { usize::MAX } else { 2_000 };
    println!("milliseconds; `ratio`: ours to the better of earcut and i_triangle; `growth`: exponent of ours\n");
    print!("{:<22}", "polygon");
    RIVALS.iter().for_each(|rival| print!(" {:>14}", rival.name));
    println!(" {:>7} {:>7}", "ratio", "growth");
    for family in FAMILIES {
        let mut before: Option<(usize, f64)> = None;
        for size in family.sizes.iter().copied().filter(|&size| size <= largest) {
            let polygon = (family.make)(size);
            let corners = polygon.corners();
            let times: Vec<Option<f64>> = RIVALS.iter().map(|rival| measure(rival, &polygon)).collect();
            let ours = times[0].unwrap_or(f64::NAN);
            print!("{:<22}", format!("{}, {corners}", family.name));
            for time in &times {
                print!(" {:>14}", time.map_or("wrong".to_owned(), |seconds| format!("{:.3}", seconds * 1e3)));
            }
            let better = [times[2], times[3]].into_iter().flatten().fold(f64::INFINITY, f64::min);
            let growth = before.map_or("".to_owned(), |(fewer, faster)| {
                format!("{:.2}", (ours / faster).ln() / (corners as f64 / fewer as f64).ln())
            });
            println!(" {:>7.2} {growth:>7}", ours / better);
            before = Some((corners, ours));
        }
    }
}

struct Polygon {
    contours: Vec<Vec<DVec2>>,
    /// The contours as `i_triangle` takes them.
    pairs: Vec<Vec<[f64; 2]>>,
    /// The points of all contours as `earcut` takes them.
    flat: Vec<[f64; 2]>,
    holes: Vec<u32>,
    area: f64,
}

impl Polygon {
    /// The first contour is outside and runs counter-clockwise, the others are holes and run clockwise.
    fn new(contours: Vec<Vec<DVec2>>) -> Polygon {
        let pairs: Vec<Vec<[f64; 2]>> =
            contours.iter().map(|contour| contour.iter().map(|point| point.to_array()).collect()).collect();
        let mut holes = Vec::new();
        let mut count = 0;
        for contour in &contours {
            count += contour.len() as u32;
            holes.push(count);
        }
        holes.pop();
        let area = contours.iter().map(|contour| signed_area(contour)).sum();
        Polygon { flat: pairs.concat(), pairs, holes, area, contours }
    }

    fn corners(&self) -> usize {
        self.flat.len()
    }

    fn expected(&self) -> usize {
        self.corners() + 2 * self.holes.len() - 2
    }
}

fn signed_area(contour: &[DVec2]) -> f64 {
    contour.iter().zip(contour.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum::<f64>() * 0.5
}

struct Family {
    name: &'static str,
    sizes: &'static [usize],
    make: fn(usize) -> Polygon,
}

const FAMILIES: [Family; 3] = [
    Family { name: "star", sizes: &[1_000, 10_000, 100_000, 320_000], make: star },
    Family { name: "plate", sizes: &[1_000, 10_000, 100_000, 320_000], make: plate },
    Family { name: "comb", sizes: &[1_000, 10_000, 100_000, 320_000], make: comb },
];

/// Arms of random lengths around a middle.
fn star(corners: usize) -> Polygon {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let arm = |k| DVec2::from_angle(TAU * k as f64 / corners as f64) * random.random_range(0.1..1.0);
    Polygon::new(vec![(0..corners).map(arm).collect()])
}

/// A square with round holes of 32 corners in rows.
fn plate(corners: usize) -> Polygon {
    let holes = corners / 32;
    let rows = (holes as f64).sqrt().ceil() as usize;
    let size = rows as f64;
    let mut contours = vec![vec![DVec2::ZERO, DVec2::new(size, 0.0), DVec2::splat(size), DVec2::new(0.0, size)]];
    for hole in 0..holes {
        let center = DVec2::new((hole % rows) as f64 + 0.5, (hole / rows) as f64 + 0.5);
        let corner = |k: u32| center + DVec2::from_angle(-TAU * f64::from(k) / 32.0) * 0.4;
        contours.push((0..32).map(corner).collect());
    }
    Polygon::new(contours)
}

/// Square teeth on a back.
fn comb(corners: usize) -> Polygon {
    let tips = corners - 2;
    let mut contour = vec![DVec2::new(0.0, -1.0), DVec2::new(tips.div_ceil(2) as f64 + 1.0, -1.0)];
    let tip = |k: usize| DVec2::new(k.div_ceil(2) as f64, if k % 4 < 2 { 0.0 } else { 100.0 });
    contour.extend((0..tips).rev().map(tip));
    Polygon::new(vec![contour])
}

struct Rival {
    name: &'static str,
    /// Triangles by index, or as points where the rival numbers them anew.
    run: fn(&Polygon) -> TimedTriangulation,
    is_ours: bool,
}

struct TimedTriangulation {
    triangles: Vec<u32>,
    points: Option<Vec<[f64; 2]>>,
}

const RIVALS: [Rival; 5] = [
    Rival { name: "ours", run: ours, is_ours: true },
    Rival { name: "ours, Delaunay", run: ours_delaunay, is_ours: true },
    Rival { name: "earcut", run: earcut, is_ours: false },
    Rival { name: "i_triangle", run: i_triangle, is_ours: false },
    Rival { name: "..., unchecked", run: i_triangle_unchecked, is_ours: false },
];

fn ours(polygon: &Polygon) -> TimedTriangulation {
    in_shape(polygon, TriangulationKind::Any)
}

fn ours_delaunay(polygon: &Polygon) -> TimedTriangulation {
    in_shape(polygon, TriangulationKind::Delaunay)
}

fn in_shape(polygon: &Polygon, shape: TriangulationKind) -> TimedTriangulation {
    let result = triangulate(&polygon.contours, shape).expect("the polygon is sound");
    TimedTriangulation { triangles: result.triangles.into_flattened(), points: None }
}

fn earcut(polygon: &Polygon) -> TimedTriangulation {
    let mut triangles = Vec::new();
    ::earcut::Earcut::new().earcut_slice(&polygon.flat, &polygon.holes, &mut triangles);
    TimedTriangulation { triangles, points: None }
}

fn i_triangle(polygon: &Polygon) -> TimedTriangulation {
    let found = polygon.pairs.triangulate_as::<i64>().to_triangulation::<u32>();
    TimedTriangulation { triangles: found.indices, points: Some(found.points) }
}

fn i_triangle_unchecked(polygon: &Polygon) -> TimedTriangulation {
    let found = polygon.pairs.unchecked_triangulate_as::<i64>().to_triangulation::<u32>();
    TimedTriangulation { triangles: found.indices, points: Some(found.points) }
}

/// The best time of a rival; `None` if its triangles are wrong.
fn measure(rival: &Rival, polygon: &Polygon) -> Option<f64> {
    let fault = fault(polygon, rival, &(rival.run)(polygon));
    if let Some(fault) = fault {
        assert!(!rival.is_ours, "{}: {fault}", rival.name);
        println!("{}: {fault}", rival.name);
        return None;
    }
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let begin = processor_seconds();
        black_box((rival.run)(black_box(polygon)));
        best = best.min(processor_seconds() - begin);
        if best > 1.0 {
            break;
        }
    }
    Some(best)
}

fn fault(polygon: &Polygon, rival: &Rival, found: &TimedTriangulation) -> Option<String> {
    let points = found.points.as_deref().unwrap_or(&polygon.flat);
    let (triangles, _) = found.triangles.as_chunks::<3>();
    if triangles.len() != polygon.expected() {
        return Some(format!("{} triangles, not {}", triangles.len(), polygon.expected()));
    }
    let mut area = 0.0;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| DVec2::from_array(points[corner as usize]));
        let twice = (b - a).perp_dot(c - a);
        if rival.is_ours && host::numeric::predicates::turn(a, b, c) <= 0.0 {
            return Some(format!("{triangle:?} is turned over"));
        }
        area += twice.abs() * 0.5;
    }
    let error = (area / polygon.area - 1.0).abs();
    // Rivals that round to whole numbers are off by that.
    (error > if rival.is_ours { 1e-11 } else { 1e-6 }).then(|| format!("the area is off by {error:e}"))
}

/// Seconds that this thread has had the processor.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
