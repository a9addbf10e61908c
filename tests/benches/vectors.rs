//! How many vectors a second the emulator transforms, clips and draws. Each figure's result is checked first.

use glam::{DMat4, DVec4};
use ps340::{
    calligraphic::{self, Beam},
    matrices,
    traversal::{Clipper, State, Stroke},
};
use std::time::Instant;

/// Vectors of `length` (screen units) at places and angles that fill the screen.
fn vectors(count: usize, length: f32) -> Vec<[f32; 4]> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1 << 24) as f32
    };
    let mut points = Vec::with_capacity(2 * count);
    for _ in 0..count {
        let (x, y, z, angle) = (1.8 * random() - 0.9, 1.8 * random() - 0.9, random(), std::f32::consts::TAU * random());
        points.push([x, y, z, 1.0]);
        points.push([x + length * angle.cos(), y + length * angle.sin(), z, 1.0]);
    }
    points
}

/// The shortest of several runs, seconds.
fn best(mut work: impl FnMut()) -> f64 {
    let run = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..7).map(|_| run(&mut work)).fold(f64::INFINITY, f64::min)
}

fn rows(count: usize) {
    let points = vectors(count, 0.02);
    let view = matrices::window([-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]).unwrap_or(DMat4::IDENTITY);
    let mut clip: Vec<DVec4> = Vec::with_capacity(points.len());
    let transform = best(|| {
        clip.clear();
        Clipper::transform(&view, &points, &mut clip);
    });
    for (p, c) in points.iter().zip(&clip) {
        assert!((f64::from(p[0]) - c.x).abs() < 1e-12 && (f64::from(p[2]) - c.z).abs() < 1e-12 && c.w == 1.0);
    }
    let clipper = Clipper::new(&State::default());
    let mut strokes: Vec<Stroke> = Vec::with_capacity(count);
    let clipping = best(|| {
        strokes.clear();
        strokes.extend(clip.chunks_exact(2).filter_map(|ends| clipper.line(ends[0], ends[1], [1.0; 2])));
    });
    assert_eq!(strokes.len(), count, "all lie on the screen");
    // The light of all strokes is their length times their intensity.
    let beam = Beam::default();
    let threads = rayon_threads();
    let mut total = 0.0;
    let drawing = best(|| total = calligraphic::draw(&beam, &strokes).total()[0]);
    let one = calligraphic::draw(&beam, &strokes[..1]).total()[0];
    let mean = |s: &Stroke| f64::from(s.intensity[0] + s.intensity[1]) / 2.0;
    let length = |s: &Stroke| f64::from(s.end[0] - s.start[0]).hypot(f64::from(s.end[1] - s.start[1]));
    let expected: f64 = strokes.iter().map(|s| mean(s) * length(s)).sum::<f64>();
    let first = mean(&strokes[0]) * length(&strokes[0]);
    let error = (total / one) / (expected / first) - 1.0;
    assert!(error.abs() < 2e-3, "the light is off by {error}");
    let million = |seconds: f64| count as f64 / seconds / 1e6;
    println!(
        "{count:>10} vectors of 10 pixels: transform {:6.1} M/s, clip {:6.1} M/s (one thread), draw {:6.2} M/s ({threads} threads)",
        million(transform),
        million(clipping),
        million(drawing),
    );
}

fn rayon_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn main() {
    println!("vectors of the emulator, 1024 x 1024 pixels");
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        rows(count);
    }
}
