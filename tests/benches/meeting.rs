//! Accurate curves in which two exact surfaces meet, and rounding of edges: what they cost, and how it grows.
//!
//! Each result is checked first: every point of a curve is accurate, its residual is below the precision that was asked
//! for, and it satisfies both equations; the volume that rounding takes off is that of the parabolas along the edges.
//! Then the best of several runs counts, in processor seconds of one thread. The triangles are made before.
//! `cargo bench -p tests --bench meeting`

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use glam::{DAffine3, DVec2, DVec3};
use host::intersection::{CurvePrecision, ExactSheet, Intersection, intersect};
use host::solid::primitive::{cylinder, prism, sphere, torus};
use host::solid::{Body, EdgeChoice, ExactSolid, PrimitiveError};
use host::surface::Tolerance;

/// Runs of each case; the best counts.
const RUNS: usize = 3;
/// Tolerances of the triangles with which curves are looked for; each makes about twice as many points as that before,
/// and four times as many triangles.
const CHORDS: [f64; 6] = [4e-2, 1e-2, 2.5e-3, 6.25e-4, 1.5625e-4, 3.906_25e-5];
/// Corners of the prisms that are rounded.
const CORNERS: [usize; 4] = [4, 16, 64, 256];
/// Of the balls that roll along their edges, and how far the triangles may be from the rounding.
const RADIUS: f64 = 0.1;
const TOLERANCE: f64 = 1e-4;

/// 0 on a surface, and nowhere steeper than 1 there.
type Equation = fn(DVec3) -> f64;

/// Two bodies that meet in curves.
struct Meeting {
    name: &'static str,
    bodies: fn() -> Result<[Body; 2], PrimitiveError>,
    /// Where the second one is; the first one is at the origin.
    at: DAffine3,
    /// What holds on the first one, and on the second one at the origin.
    equations: [Equation; 2],
    /// Branches of the curve.
    branches: usize,
}

fn meetings() -> [Meeting; 3] {
    let ball: Equation = |p| p.length() - 1.0;
    let bar: Equation = |p| (p.x.hypot(p.z) - 0.4).abs().min((p.y.abs() - 2.0).abs());
    let ring: Equation = |p| (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.3;
    [
        Meeting {
            name: "sphere and sphere",
            bodies: || Ok([sphere(1.0)?, sphere(1.0)?]),
            at: DAffine3::from_translation(DVec3::new(0.6, 0.5, -0.4)),
            equations: [ball, ball],
            branches: 1,
        },
        Meeting {
            name: "sphere and cylinder",
            bodies: || Ok([sphere(1.0)?, cylinder(0.4, 4.0)?]),
            at: DAffine3::from_translation(DVec3::new(0.3, 0.0, 0.1)) * DAffine3::from_rotation_z(0.5),
            equations: [ball, bar],
            branches: 2,
        },
        Meeting {
            name: "torus and cylinder",
            bodies: || Ok([torus(1.0, 0.3)?, cylinder(0.4, 4.0)?]),
            at: DAffine3::from_translation(DVec3::new(0.1, 0.05, 0.0)) * DAffine3::from_rotation_x(0.5 * PI),
            equations: [ring, bar],
            branches: 4,
        },
    ]
}

fn main() {
    // `cargo bench` passes `--bench`; without it the coarsest of each proves the results.
    let most = if std::env::args().any(|argument| argument == "--bench") { usize::MAX } else { 2 };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be started");
    pool.install(|| {
        println!(
            "{:<28} {:>9} {:>9} {:>11}   microseconds a point, growth with points",
            "meeting", "points", "ms", "residual"
        );
        meetings().iter().for_each(|meeting| curves(meeting, most));
        println!("\n{:<28} {:>9} {:>9} {:>11}   microseconds an edge, growth", "rounding", "edges", "ms", "volume");
        rounding(most);
    });
}

/// One line of a table; the growth is the exponent since the line before.
fn row(name: &str, count: usize, seconds: f64, error: f64, before: &mut Option<(usize, f64)>) {
    let growth = before.replace((count, seconds)).map_or(String::new(), |(fewer, faster)| {
        format!("{:.2}", (seconds / faster).ln() / (count as f64 / fewer as f64).ln())
    });
    let each = seconds * 1e6 / count as f64;
    println!("{name:<28} {count:>9} {:>9.3} {error:>11.1e}   {each:.2} {growth}", seconds * 1e3);
}

fn curves(meeting: &Meeting, most: usize) {
    let mut before = None;
    for &chord in CHORDS.iter().take(most) {
        let [one, two] = (meeting.bodies)().expect("the bodies are sound");
        let made = |body: Body| body.solid(Tolerance::new(chord, 45.0)).expect("the tolerance can be met");
        let (one, two) = (made(one), made(two).transformed(&meeting.at).expect("a rigid motion spoils nothing"));
        let run = || intersect(ExactSheet::from(&one), ExactSheet::from(&two), &CurvePrecision::default());
        let (seconds, found) = best(run);
        let residual = prove(meeting, &found);
        row(meeting.name, found.points().count(), seconds, residual, &mut before);
    }
}

/// Checks a curve; returns the greatest residual.
fn prove(meeting: &Meeting, found: &Intersection) -> f64 {
    assert_eq!(found.branches.len(), meeting.branches, "{}", meeting.name);
    let back = meeting.at.inverse();
    for point in found.points() {
        assert_eq!(point.inaccuracy, None, "{}", meeting.name);
        // The size of the bodies is 4 at most.
        assert!(point.residual <= 4.0 * CurvePrecision::default().newton, "{}: {}", meeting.name, point.residual);
        let [one, two] = meeting.equations;
        for off in [one(point.position), two(back.transform_point3(point.position))] {
            assert!(off.abs() < 1e-11, "{}: {off:e} at {}", meeting.name, point.position);
        }
    }
    found.points().map(|point| point.residual).fold(0.0, f64::max)
}

/// Prisms over regular polygons with sides of length 1, their upright edges rounded.
fn rounding(most: usize) {
    let mut before = None;
    for &corners in CORNERS.iter().take(most) {
        let circumradius = 0.5 / (PI / corners as f64).sin();
        let at = |k: usize| DVec2::from_angle(TAU * k as f64 / corners as f64) * circumradius;
        let outline: Vec<DVec2> = (0..corners).map(at).collect();
        let body = prism(std::slice::from_ref(&outline), [0.0, 1.0]).expect("a regular polygon is simple");
        let sharp = body.solid(Tolerance::new(TOLERANCE, 45.0)).expect("the tolerance can be met");
        let edges = EdgeChoice::Nearest(outline.iter().map(|corner| corner.extend(0.5)).collect());
        let (seconds, round) = best(|| sharp.rounded(&edges, RADIUS, TOLERANCE).expect("there is place for it"));
        let lost = volume(&sharp) - volume(&round);
        let turn = TAU / corners as f64;
        let setback = RADIUS * (0.5 * turn).tan();
        let off = lost / corners as f64 - setback * setback * turn.sin() / 6.0;
        assert!(off.abs() <= TOLERANCE * 2.0 * setback + 1e-9, "{corners}: {off:e}");
        row(&format!("prism of {corners} corners"), corners, seconds, off, &mut before);
    }
}

fn volume(solid: &ExactSolid) -> f64 {
    solid.solid().mesh().signed_volume()
}

/// The best time of several runs, and the last result.
fn best<T>(mut run: impl FnMut() -> T) -> (f64, T) {
    let mut time = f64::INFINITY;
    let mut result = None;
    for _ in 0..RUNS {
        let start = processor_seconds();
        result = Some(black_box(run()));
        time = time.min(processor_seconds() - start);
    }
    (time, result.expect("there is a run"))
}

/// Seconds that this thread has had the processor.
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
