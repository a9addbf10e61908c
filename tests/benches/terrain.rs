//! Rays on terrain of twelve octaves per second, and how often they ask the height function, beside sphere tracing.
//!
//! A camera above the ground looks along it, and tangents of the ground are shifted by little, so that they graze it. Before
//! the figures count, every hit is compared with the height of the surface there, and the way to it is looked through for
//! places below the ground. Sphere tracing steps by the height above the ground over the steepest slope that bounds allow
//! and stops a pixel's width before it. `PASSES` sets how often the picture is looked at (4): the first pass computes
//! the cells.

use glam::{DVec2, DVec3};
use host::numeric::ray::Ray;
use host::numeric::sampling::RandomStream;
use host::procedural::terrain::{
    FractalKind, FractalParameters, GroundView, HeightField, HeightFunction, TerrainCosts, TerrainSurface,
};
use std::f64::consts::TAU;
use std::time::Instant;

const WIDTH: usize = 1280;
const HEIGHT: usize = 720;
/// Rays that graze.
const GRAZING: usize = 100_000;
/// Places on the way to a hit that are looked at.
const LOOKS: usize = 64;
/// Rays that are traced by spheres: one of so many.
const TRACED: usize = 97;
/// Steps of sphere tracing at the most.
const MOST_STEPS: usize = 100_000;

fn main() {
    let passes = std::env::var("PASSES").ok().and_then(|text| text.parse().ok()).unwrap_or(4_usize).max(1);
    let region = [DVec2::new(-6.0, -4.0), DVec2::new(6.0, 4.0)];
    let parameters =
        FractalParameters { octaves: 12.0, scale: 4.0, height: 1.0, seed: 3.0, ..FractalParameters::default() };
    let function = HeightFunction::fractal(FractalKind::Fbm, parameters);
    let field = HeightField::new(&function, region).expect("sound");
    let (eye, at) = (DVec3::new(0.0, 2.5, 4.0), DVec3::new(0.0, 0.0, -2.0));
    let pixel = 2.0 * 20_f64.to_radians().tan() / HEIGHT as f64;
    let views = vec![GroundView::Eye { at: eye, spacing: 1.5 * pixel }];
    let surface = TerrainSurface::new(field.clone(), views, u64::MAX).expect("sound");
    let primary = primary(eye, at, pixel);

    let mut seconds = Vec::new();
    for pass in 0..passes {
        let before = surface.costs();
        let start = Instant::now();
        let hits = primary.iter().filter(|ray| surface.intersect(ray, [0.0, f64::INFINITY]).is_some()).count();
        seconds.push(start.elapsed().as_secs_f64());
        if pass == 0 {
            let TerrainCosts { made, bytes, evaluations, .. } = surface.costs();
            let each = (evaluations - before.evaluations) as f64 / primary.len() as f64;
            println!("{hits} hits; {made} squares of cells in {:.1} MB; {each:.2} heights a ray", bytes as f64 / 1e6);
        }
    }
    check(&surface, &primary);
    let rate = |seconds: f64, rays: usize| rays as f64 / seconds / 1e6;
    println!(
        "primary: {:.2} million rays a second in {passes} passes, {:.2} in the first, {:.2} in the last",
        rate(seconds.iter().sum(), passes * primary.len()),
        rate(seconds[0], primary.len()),
        rate(seconds[passes - 1], primary.len())
    );

    let grazing = grazing(&surface, region);
    let mut seconds = Vec::new();
    for _ in 0..2 {
        let start = Instant::now();
        let hits = grazing.iter().filter(|ray| surface.intersect(ray, [0.0, f64::INFINITY]).is_some()).count();
        seconds.push(start.elapsed().as_secs_f64());
        assert!(hits > GRAZING / 2, "{hits}");
    }
    check(&surface, &grazing);
    println!(
        "grazing: {:.2} million rays a second, {:.2} with cells that are kept",
        rate(seconds[0], GRAZING),
        rate(seconds[1], GRAZING)
    );

    let steepest = field.enclosure(DVec2::ZERO, 1e9, 0.0).steepest();
    for (name, rays) in [("primary", &primary), ("grazing", &grazing)] {
        let some: Vec<&Ray> = rays.iter().step_by(TRACED).collect();
        let start = Instant::now();
        let asked: usize = some.iter().map(|ray| traced_by_spheres(&field, ray, pixel, steepest)).sum();
        let rate = some.len() as f64 / start.elapsed().as_secs_f64() / 1e6;
        println!(
            "sphere tracing, {name}: {:.0} heights a ray, {rate:.3} million rays a second",
            asked as f64 / some.len() as f64
        );
    }
}

/// Rays of a camera through the middles of all pixels.
fn primary(eye: DVec3, at: DVec3, pixel: f64) -> Vec<Ray> {
    let forward = (at - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let ray = |k: usize| {
        let (x, y) = ((k % WIDTH) as f64 + 0.5 - 0.5 * WIDTH as f64, 0.5 * HEIGHT as f64 - (k / WIDTH) as f64 - 0.5);
        Ray { origin: eye, direction: (forward + (right * x + up * y) * pixel).normalize() }
    };
    (0..WIDTH * HEIGHT).map(ray).collect()
}

/// Tangents of the surface, shifted by between 1e-8 and 1 of its height.
fn grazing(surface: &TerrainSurface, [from, to]: [DVec2; 2]) -> Vec<Ray> {
    let mut stream = RandomStream::new(4, 0);
    let ray = |_| {
        let at = from + (to - from) * DVec2::from(stream.point());
        let (height, slope) = surface.height_and_slope(at);
        let turn = TAU * stream.uniform();
        let along = DVec2::new(turn.cos(), turn.sin());
        let direction = DVec3::new(along.x, slope.dot(along), along.y);
        let off = 10_f64.powf(-8.0 * stream.uniform()) * (stream.uniform() - 0.5);
        Ray { origin: DVec3::new(at.x, height + off, at.y) - direction * (2.0 * stream.uniform()), direction }
    };
    (0..GRAZING).map(ray).collect()
}

/// Compares hits with the height of the surface, and looks for places on the other side of it before them.
fn check(surface: &TerrainSurface, rays: &[Ray]) {
    let bounds = surface.bounds();
    for ray in rays.iter().step_by(7) {
        let Some([begin, end]) = ray.within(&bounds, [0.0, f64::INFINITY]) else { continue };
        let above = |t: f64| {
            let at = ray.at(t);
            at.y - surface.height_and_slope(DVec2::new(at.x, at.z)).0
        };
        let hit = surface.intersect(ray, [0.0, f64::INFINITY]);
        if let Some(hit) = hit {
            assert!(above(hit.t).abs() < 1e-11, "{ray:?}: {}", above(hit.t));
        }
        let end = hit.map_or(end, |hit| hit.t);
        let mut side = 0.0;
        for k in 1..LOOKS {
            let height = above(begin + (end - begin) * k as f64 / LOOKS as f64);
            if height.abs() > 1e-11 {
                assert!(side * height >= 0.0, "{ray:?}: there is a crossing before {end}");
                side = height.signum();
            }
        }
    }
}

/// Follows a ray by steps that cannot cross the ground; gives how often it asked for a height.
fn traced_by_spheres(field: &HeightField, ray: &Ray, pixel: f64, steepest: f64) -> usize {
    let Some([begin, end]) = ray.within(&field.bounds(), [0.0, f64::INFINITY]) else { return 0 };
    let along = DVec2::new(ray.direction.x, ray.direction.z).length();
    let closing = steepest * along + ray.direction.y.abs();
    let mut t = begin;
    for step in 1..=MOST_STEPS {
        let at = ray.at(t);
        let above = (at.y - field.height(DVec2::new(at.x, at.z), pixel * t)).abs();
        if above < 0.5 * pixel * t {
            return step;
        }
        t += above / closing;
        if t > end {
            return step;
        }
    }
    MOST_STEPS
}
