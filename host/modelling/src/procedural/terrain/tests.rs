//! Tests of heights, their bounds, rays and triangles against one another and against what is known.

use super::octaves::{MEAN_ABSOLUTE, MOST_BEND, MOST_NOISE, MOST_SLOPE, Octaves};
use super::*;
use crate::mesh::EdgeReport;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::RandomStream;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

const REGION: [DVec2; 2] = [DVec2::splat(-40.0), DVec2::splat(40.0)];

fn parameters() -> FractalParameters {
    FractalParameters { height: 0.3, ..FractalParameters::default() }
}

fn field(function: &HeightFunction) -> HeightField {
    HeightField::new(function, REGION).expect("sound")
}

fn fbm() -> HeightFunction {
    HeightFunction::fractal(FractalKind::Fbm, parameters())
}

fn waves() -> HeightFunction {
    let height = |k: usize| ((k % 9) as f64 * 1.3).sin() * ((k / 9) as f64 * 0.9).cos();
    let grid = HeightGrid::new([9, 7], DVec2::new(-4.0, -3.0), 1.0, (0..63).map(height).collect());
    HeightFunction::Grid(Arc::new(grid.expect("sound")))
}

/// One of each kind and of each way to put them together.
fn functions() -> Vec<HeightFunction> {
    let coarse = FractalParameters { octaves: 4.0, seed: 5.0, ..parameters() };
    let moved = |seed: f64| HeightFunction::fractal(FractalKind::Fbm, FractalParameters { seed, ..coarse });
    let mut all: Vec<HeightFunction> =
        FRACTALS.iter().map(|row| HeightFunction::fractal(row.kind, parameters())).collect();
    all.push(fbm().warped(moved(1.0), moved(2.0)));
    all.push(
        HeightFunction::fractal(FractalKind::Ridged, coarse)
            .warped(moved(3.0).warped(moved(4.0), moved(5.0)), moved(6.0)),
    );
    all.push(HeightFunction::Sum(vec![waves(), HeightFunction::Scaled(Box::new(moved(7.0)), 0.2)]));
    all.push(HeightFunction::Clamped(Box::new(fbm()), [-0.05, 0.1]));
    all.push(HeightFunction::Product(Box::new([waves(), moved(8.0)])));
    all
}

fn place(stream: &mut RandomStream, reach: f64) -> DVec2 {
    let [x, z] = stream.point();
    DVec2::new(2.0 * x - 1.0, 2.0 * z - 1.0) * reach
}

#[test]
fn noise_keeps_its_bounds_and_its_slopes_are_its_derivatives() {
    let octaves = Octaves::new(4, 1.0, 2.0, 3, 1e3).expect("sound");
    let mut stream = RandomStream::new(1, 0);
    let (mut most, mut mean, mut absolute, mut squares) = ([0.0_f64; 3], 0.0, 0.0, [0.0; 2]);
    const COUNT: usize = 40_000;
    for _ in 0..COUNT {
        let at = place(&mut stream, 500.0);
        let turn = TAU * stream.uniform();
        let along = DVec2::new(turn.cos(), turn.sin());
        let of = |at: DVec2| {
            let noise = octaves.noise_at(0, at);
            (noise.value.0[0], DVec2::new(noise.slopes[0].0[0], noise.slopes[1].0[0]))
        };
        let step = 1e-5;
        let ((value, slope), before, after) = (of(at), of(at - along * step), of(at + along * step));
        let found = (after.0 - before.0) / (2.0 * step);
        assert!((found - slope.dot(along)).abs() < 1e-7, "{at}");
        let bend = (after.1 - before.1).dot(along).abs() / (2.0 * step);
        for (most, found) in most.iter_mut().zip([value.abs(), slope.length(), bend]) {
            *most = most.max(found);
        }
        mean += value / COUNT as f64;
        absolute += value.abs() / COUNT as f64;
        squares = [squares[0] + slope.x * slope.x, squares[1] + slope.y * slope.y];
    }
    let bounds = [MOST_NOISE, MOST_SLOPE, MOST_BEND];
    assert!(most.iter().zip(bounds).all(|(found, bound)| *found <= bound && *found > 0.5 * bound), "{most:?}");
    assert!(mean.abs() < 0.01 && (absolute - MEAN_ABSOLUTE).abs() < 0.005, "{mean} {absolute}");
    assert!((squares[0] / squares[1] - 1.0).abs() < 0.05, "as rough along x as along z: {squares:?}");
}

#[test]
fn bounds_of_noise_are_those_of_its_formula() {
    // Sums over the corners of what unit gradients can give at the most, on a fine lattice of places and directions.
    const STEPS: usize = 120;
    let fades = |t: f64| {
        [
            t * t * t * (t * (t * 6.0 - 15.0) + 10.0),
            30.0 * t * t * (1.0 - t) * (1.0 - t),
            60.0 * t * (1.0 - t) * (1.0 - 2.0 * t),
        ]
    };
    let mut most = [0.0_f64; 3];
    for k in 0..=STEPS * STEPS + STEPS {
        let (x, z) = ((k % (STEPS + 1)) as f64 / STEPS as f64, (k / (STEPS + 1)) as f64 / STEPS as f64);
        for turn in 0..60 {
            let (b, a) = (TAU / 120.0 * f64::from(turn)).sin_cos();
            let mut sums = [0.0; 3];
            for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let of = |t: f64, side: f64| fades(t).map(|fade| if side == 0.0 { -fade } else { fade });
                let (mut wx, mut wz) = (of(x, i), of(z, j));
                wx[0] += 1.0 - i;
                wz[0] += 1.0 - j;
                let (offset, along) = (DVec2::new(x - i, z - j), DVec2::new(a, b));
                let rate = a * wx[1] * wz[0] + b * wx[0] * wz[1];
                let bend = a * a * wx[2] * wz[0] + 2.0 * a * b * wx[1] * wz[1] + b * b * wx[0] * wz[2];
                sums[0] += (wx[0] * wz[0] * offset).length();
                sums[1] += (rate * offset + wx[0] * wz[0] * along).length();
                sums[2] += (bend * offset + 2.0 * rate * along).length();
            }
            for (most, sum) in most.iter_mut().zip(sums) {
                *most = most.max(sum * 2.0_f64.sqrt());
            }
        }
    }
    for (found, bound) in most.iter().zip([MOST_NOISE, MOST_SLOPE, MOST_BEND]) {
        assert!(*found <= bound && *found > 0.995 * bound, "{most:?}");
    }
}

#[test]
fn enclosures_hold_the_heights_and_slopes_of_their_discs() {
    let mut stream = RandomStream::new(2, 0);
    for (number, function) in functions().iter().enumerate() {
        let field = field(function);
        let mut tightest = f64::INFINITY;
        for _ in 0..300 {
            let (at, radius) = (place(&mut stream, 6.0), 10.0_f64.powf(-6.0 + 7.0 * stream.uniform()));
            let footprint = if stream.uniform() < 0.5 { 0.0 } else { 0.02 * stream.uniform() };
            let over = field.enclosure(at, radius, footprint);
            tightest = tightest.min(over.error / radius);
            for _ in 0..8 {
                let (turn, part) = (TAU * stream.uniform(), stream.uniform().sqrt() * (1.0 - 1e-9));
                let offset = DVec2::new(turn.cos(), turn.sin()) * radius * part;
                let off = field.height(at + offset, footprint) - over.value - over.slope.dot(offset);
                assert!(off.abs() <= over.error, "{number}: {at} {radius} {off} {over:?}");
                let turned = field.slope(at + offset, footprint) - over.slope;
                assert!(turned.length() <= over.slope_error + 1e-9, "{number}: {at} {radius} {turned} {over:?}");
                let [low, high] = over.range();
                assert!((low..=high).contains(&(over.value + over.slope.dot(offset) + off)));
            }
        }
        assert!(tightest < 0.02, "{number}: bounds of small discs are tight: {tightest}");
    }
}

#[test]
fn kinds_follow_their_formulas_in_the_textbook() {
    let p = FractalParameters { octaves: 6.0, height: 1.0, offset: 0.8, hurst: 0.9, lacunarity: 2.1, ..parameters() };
    let octaves = Octaves::new(6, p.scale, p.lacunarity, 0, 40.0).expect("sound");
    let mut stream = RandomStream::new(3, 0);
    for _ in 0..200 {
        let at = place(&mut stream, 30.0);
        let noise: Vec<f64> = (0..8).map(|k| octaves.noise_at(k / 4 * 4, at).value.0[k % 4]).take(6).collect();
        let weight = |k: usize| p.lacunarity.powf(-p.hurst * k as f64);
        let fbm: f64 = (0..6).map(|k| noise[k] * weight(k)).sum();
        let mut heterogeneous = p.offset + noise[0];
        let mut hybrid = noise[0] + p.offset;
        let mut product = hybrid;
        let mut signal = (p.offset - noise[0].abs()).powi(2);
        let mut ridged = signal;
        for (k, noise) in noise.iter().enumerate().skip(1) {
            heterogeneous += (noise + p.offset) * weight(k) * heterogeneous;
            product = product.min(1.0) * (noise + p.offset) * weight(k);
            hybrid += product;
            signal = (p.offset - noise.abs()).powi(2) * (signal * p.feedback).clamp(0.0, 1.0);
            ridged += signal * weight(k);
        }
        for (row, expected) in FRACTALS.iter().zip([fbm, heterogeneous, hybrid, ridged]) {
            let found = field(&HeightFunction::fractal(row.kind, p)).height(at, 0.0);
            assert!((found - expected).abs() < 1e-7, "{}: {found} {expected}", row.name);
        }
    }
}

#[test]
fn a_footprint_leaves_out_what_is_finer_and_changes_heights_without_a_jump() {
    for row in FRACTALS {
        let field = field(&HeightFunction::fractal(row.kind, parameters()));
        let at = DVec2::new(3.21, -7.5);
        let mut last = field.height(at, 0.0);
        assert_eq!(last, field.height(at, 1e-9), "nothing is that fine");
        let mut footprint: f64 = 1e-5;
        while footprint < 2.0 {
            let next = field.height(at, footprint);
            assert!((next - last).abs() < 0.02, "{} at {footprint}: {last} {next}", row.name);
            last = next;
            footprint *= 1.02;
        }
        assert_eq!(field.height(at, 1.0), field.height(at, 50.0));
    }
    assert_eq!(field(&fbm()).height(DVec2::ONE, 1.0), 0.0);
}

/// Rays from above, from below, along the ground near it, and far away.
fn rays(field: &HeightField, stream: &mut RandomStream, count: usize) -> Vec<Ray> {
    let one = |k: usize, stream: &mut RandomStream| {
        let (at, turn) = (place(stream, 5.0), TAU * stream.uniform());
        let ground = DVec3::new(at.x, field.height(at, 0.0), at.y);
        let flat = DVec3::new(turn.cos(), 0.0, turn.sin());
        let slope = field.slope(at, 0.0);
        let tangent = flat + DVec3::Y * slope.dot(DVec2::new(flat.x, flat.z));
        let (from, direction) = match k % 6 {
            0 => (ground + DVec3::Y - flat * 3.0, flat * 3.0 - DVec3::Y),
            1 => (ground - DVec3::Y * 0.5 - flat, flat + DVec3::Y * 0.5),
            2 => (ground + DVec3::Y * 1e-3, flat + DVec3::Y * (0.2 * stream.uniform() - 0.1)),
            3 => (ground + (DVec3::Y * 3.0 - flat) * 1e7, (flat - DVec3::Y * 3.0) * 1e7),
            4 => (ground - tangent * 0.3 + DVec3::Y * 1e-5, tangent),
            _ => (ground - flat * 2.0 + DVec3::Y * (0.01 * stream.uniform()), flat),
        };
        Ray { origin: from, direction: direction.normalize() }
    };
    (0..count).map(|k| one(k, stream)).collect()
}

#[test]
fn hits_and_misses_are_proved_by_interval_arithmetic() {
    let mut stream = RandomStream::new(4, 0);
    let mut hits = 0;
    for (number, function) in functions().iter().enumerate() {
        let field = field(function);
        for ray in rays(&field, &mut stream, 30) {
            let far = [0.0, 12.0 + ray.origin.length()];
            let hit = field.intersect(&ray, far, 0.0);
            let t = hit.map(|hit| hit.t);
            // Where a ray all but touches the surface, rounding of heights moves the crossing farther along it.
            let closing = hit.map_or(1.0, |hit| (hit.normal.dot(ray.direction) / hit.normal.y).abs().clamp(1e-4, 1.0));
            let tolerance = (1e-11 + 1e-14 * ray.origin.length()) / closing;
            hits += usize::from(hit.is_some());
            let (verdict, _) = certify(&field, &ray, far, 0.0, t, tolerance, ProofBy::Intervals);
            assert_eq!(verdict, Verdict::Proved, "{number}: {ray:?} {hit:?}");
            let (verdict, _) = certify(&field, &ray, far, 0.0, t, tolerance, ProofBy::Enclosures);
            assert_eq!(verdict, Verdict::Proved, "{number}: {ray:?} {hit:?}");
            if let Some(hit) = hit {
                let slope = field.slope(DVec2::new(hit.point.x, hit.point.z), 0.0);
                let normal = DVec3::new(-slope.x, 1.0, -slope.y).normalize();
                assert!(hit.normal.distance(normal) < 1e-3 + 1e-9 * ray.origin.length(), "{number}: {hit:?} {normal}");
            }
        }
    }
    assert!(hits > 150, "{hits}");
}

#[test]
fn plain_subdivision_finds_the_same_crossings() {
    let field = field(&fbm());
    let mut stream = RandomStream::new(5, 0);
    for ray in rays(&field, &mut stream, 40) {
        let far = [0.0, 12.0 + ray.origin.length()];
        let tolerance = 1e-10 + 1e-14 * ray.origin.length();
        let found = field.intersect(&ray, far, 0.0).map(|hit| hit.t);
        let expected = crossing_by_subdivision(&field, &ray, far, 0.0, tolerance);
        match (found, expected) {
            (Some(found), Some(expected)) => assert!((found - expected).abs() <= 2.0 * tolerance, "{ray:?}"),
            (found, expected) => assert_eq!(found, expected, "{ray:?}"),
        }
    }
}

#[test]
fn a_proof_refuses_what_is_wrong() {
    let field = field(&fbm());
    let at = DVec2::new(0.3, 0.4);
    let down = Ray { origin: DVec3::new(at.x, 2.0, at.y), direction: DVec3::NEG_Y };
    let t = field.intersect(&down, [0.0, 9.0], 0.0).expect("ground below").t;
    assert!((2.0 - t - field.height(at, 0.0)).abs() < 1e-14);
    for by in [ProofBy::Intervals, ProofBy::Enclosures] {
        let verdict = |hit: Option<f64>| certify(&field, &down, [0.0, 9.0], 0.0, hit, 1e-11, by).0;
        assert_eq!(verdict(Some(t)), Verdict::Proved);
        assert_eq!(verdict(Some(t - 1e-6)), Verdict::False);
        assert_eq!(verdict(Some(t + 1e-6)), Verdict::Missed);
        assert_eq!(verdict(None), Verdict::Missed);
    }
}

#[test]
fn rays_on_the_surface_beside_it_and_along_it_end() {
    let flat = field(&HeightFunction::Constant(0.25));
    let ray = |origin: DVec3, direction: DVec3| Ray { origin, direction };
    let hit = |field: &HeightField, ray: Ray| field.intersect(&ray, [0.0, 1e3], 0.0).map(|hit| hit.t);
    let rounded = |t: f64| (t * 1e12).round() / 1e12;
    assert_eq!(hit(&flat, ray(DVec3::new(0.0, 0.25, 0.0), DVec3::X)), None, "a ray in the plane crosses it nowhere");
    assert_eq!(hit(&flat, ray(DVec3::new(0.0, 0.25, 0.0), DVec3::new(1.0, 0.1, 0.0))), None, "it leaves the surface");
    assert_eq!(hit(&flat, ray(DVec3::new(1.0, 1.25, 2.0), DVec3::new(0.0, -0.5, 0.0))).map(rounded), Some(2.0));
    assert_eq!(
        hit(&flat, ray(DVec3::new(1.0, -1.0, 2.0), DVec3::new(0.0, 1.0, 0.0))).map(rounded),
        Some(1.25),
        "from below"
    );
    assert_eq!(hit(&flat, ray(DVec3::new(41.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0))), None, "beside the region");
    assert_eq!(hit(&flat, ray(DVec3::NAN, DVec3::X)), None);
    assert_eq!(hit(&flat, ray(DVec3::ZERO, DVec3::ZERO)), None);
    // The plateau of a clamped field: a ray along it, and one that comes out of it where the ground falls away.
    let plateau = field(&HeightFunction::Clamped(Box::new(fbm()), [-0.02, 0.0]));
    let mut work = TerrainWork::default();
    let along = ray(DVec3::new(-30.0, -0.02, 0.3), DVec3::X);
    plateau.intersect_and_count(&along, [0.0, 60.0], 0.0, &mut work);
    assert!(work.evaluations < 2_000_000, "{work:?}");
    // A ray that leaves a hit does not find it again.
    let rough = field(&fbm());
    let down = ray(DVec3::new(0.1, 2.0, 0.2), DVec3::new(0.3, -1.0, 0.2));
    let first = rough.intersect(&down, [0.0, 9.0], 0.0).expect("ground below");
    let away = ray(first.point, first.normal);
    assert_eq!(hit(&rough, away), None);
}

fn settings(tolerance: f64) -> TerrainTriangles {
    TerrainTriangles { tolerance, footprint: 0.05, most_triangles: 200_000, base: None }
}

#[test]
fn triangles_keep_their_tolerance_and_have_no_cracks() {
    let field = field(&fbm());
    let region = [DVec2::new(-1.0, 0.5), DVec2::new(1.5, 2.0)];
    let mesh = field.triangles(region, &settings(0.01)).expect("few triangles");
    mesh.validate().expect("sound");
    let coarse = field.triangles(region, &settings(0.05)).expect("few triangles");
    assert!(mesh.triangles.len() > 2 * coarse.triangles.len(), "{} {}", mesh.triangles.len(), coarse.triangles.len());
    let mut area = 0.0;
    let mut stream = RandomStream::new(6, 0);
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let up = (b - a).cross(c - a).y;
        assert!(up > 0.0, "seen from above");
        area += 0.5 * up;
        let [mut u, mut v] = stream.point();
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let at = a + (b - a) * u + (c - a) * v;
        let off = field.height(DVec2::new(at.x, at.z), 0.05) - at.y;
        assert!(off.abs() <= 0.01, "{at} {off}");
    }
    assert!((area - 2.5 * 1.5).abs() < 1e-9, "{area}");
    // Edges of one triangle lie on the edge of the region, and nowhere else.
    let EdgeReport { boundary, non_manifold, misoriented, .. } = mesh.edge_report();
    let on_edge = |at: &&DVec3| at.x == -1.0 || at.x == 1.5 || at.z == 0.5 || at.z == 2.0;
    assert_eq!([boundary, non_manifold, misoriented], [mesh.vertices.iter().filter(on_edge).count(), 0, 0]);
}

#[test]
fn a_base_closes_the_ground_to_a_solid() {
    let field = field(&fbm());
    let region = [DVec2::ZERO, DVec2::splat(2.0)];
    let solid = field.triangles(region, &TerrainTriangles { base: Some(-1.0), ..settings(0.03) }).expect("sound");
    assert!(solid.edge_report().is_closed());
    assert_eq!(solid.edge_report().euler_characteristic(), 2);
    let volume: f64 =
        (0..solid.triangles.len()).map(|k| solid.corners(k)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
    let mut mean = 0.0;
    for k in 0..10_000 {
        let at = DVec2::new(f64::from(k % 100) + 0.5, f64::from(k / 100) + 0.5) / 50.0;
        mean += field.height(at, 0.05) / 1e4;
    }
    assert!((volume - 4.0 * (1.0 + mean)).abs() < 0.03, "{volume} {mean}");
    for (triangle, normals) in solid.triangles.iter().zip(&solid.corner_normals) {
        let [a, b, c] = triangle.map(|index| solid.vertices[index as usize]);
        assert!((b - a).cross(c - a).dot(normals[0]) > 0.0, "{triangle:?}");
    }
    let above = TerrainTriangles { base: Some(0.0), ..settings(0.03) };
    assert!(matches!(field.triangles(region, &above), Err(TerrainError::Base { .. })));
    let few = TerrainTriangles { most_triangles: 50, ..settings(0.01) };
    assert_eq!(field.triangles(region, &few), Err(TerrainError::TooManyTriangles { most: 50 }));
    let outside = [DVec2::ZERO, DVec2::splat(41.0)];
    assert_eq!(field.triangles(outside, &settings(0.1)), Err(TerrainError::Region));
}

#[test]
fn a_grid_is_met_at_its_heights_and_goes_on_beyond_its_edge() {
    let field = field(&waves());
    for k in 0..63 {
        let at = DVec2::new((k % 9) as f64 - 4.0, (k / 9) as f64 - 3.0);
        let expected = (f64::from(k % 9) * 1.3).sin() * (f64::from(k / 9) * 0.9).cos();
        assert!((field.height(at, 0.0) - expected).abs() < 1e-14, "{at}");
    }
    assert_eq!(field.height(DVec2::new(20.0, 0.0), 0.0), field.height(DVec2::new(6.0, 0.0), 0.0));
    assert!(matches!(HeightGrid::new([2, 2], DVec2::ZERO, 1.0, vec![0.0; 3]), Err(TerrainError::GridSize { .. })));
    assert!(HeightGrid::new([2, 2], DVec2::ZERO, 0.0, vec![0.0; 4]).is_err());
    let refused = HeightGrid::new([2, 2], DVec2::ZERO, 1.0, vec![0.0, 0.0, 0.0, f64::NAN]);
    assert!(matches!(refused, Err(TerrainError::Cell { column: 1, row: 1, .. })));
}

#[test]
fn regions_of_midpoint_displacement_agree_at_every_level() {
    let terrain = MidpointDisplacement { hurst: 0.8, scale: 4.0, height: 1.0, seed: 9 };
    let whole = terrain.region(5, [-20, 7], [60, 50]).expect("sound");
    let part = terrain.region(5, [-3, 11], [17, 20]).expect("sound");
    for z in 0..20 {
        let row = &whole.heights()[(z + 4) * 60 + 17..][..17];
        assert_eq!(row, &part.heights()[z * 17..][..17], "row {z}");
    }
    // Points of a level stay where they are at the next one.
    let finer = terrain.region(6, [-6, 22], [33, 39]).expect("sound");
    for k in 0..17 * 20 {
        assert_eq!(part.heights()[k], finer.heights()[k / 17 * 2 * 33 + k % 17 * 2]);
    }
    assert_eq!(finer.spacing(), 4.0 / 64.0);
    // Corners of level 0 have the deviation that was asked for.
    let corners = terrain.region(0, [0, 0], [100, 100]).expect("sound");
    let square = corners.heights().iter().map(|height| height * height).sum::<f64>() / 1e4;
    assert!((square - 1.0).abs() < 0.05, "{square}");
    let rough = MidpointDisplacement { hurst: 0.2, ..terrain };
    let steps = |terrain: &MidpointDisplacement| {
        let grid = terrain.region(6, [0, 0], [64, 64]).expect("sound");
        grid.heights().windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>()
    };
    assert!(steps(&rough) > 2.0 * steps(&terrain), "the lower H, the rougher");
    assert!(terrain.region(33, [0, 0], [4, 4]).is_err());
    assert!(terrain.region(3, [0, 0], [1, 4]).is_err());
    assert!(MidpointDisplacement { hurst: 1.5, ..terrain }.check().is_err());
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let mut p = FractalParameters::default();
    for row in FRACTAL_PARAMETERS {
        assert_eq!((row.get)(&p), row.default, "{}", row.name);
        let refused = p.set(row.name, row.range[1] * 2.0 + 1.0).unwrap_err().to_string();
        assert!(refused.starts_with(row.name), "{refused}");
        assert!(p.set(row.name, f64::NAN).is_err());
        p.set(row.name, row.default).expect("in range");
    }
    assert!(p.set("colour", 1.0).unwrap_err().to_string().contains("colour"));
    for row in FRACTALS {
        assert!(row.parameters.iter().all(|name| FRACTAL_PARAMETERS.iter().any(|row| row.name == *name)));
    }
    let new = |function: &HeightFunction, region| HeightField::new(function, region).unwrap_err();
    let fine = FractalParameters { octaves: 32.0, lacunarity: 8.0, ..p };
    let fine = HeightFunction::fractal(FractalKind::Fbm, fine);
    assert!(matches!(new(&fine, REGION), TerrainError::TooFine { .. }));
    assert_eq!(new(&fbm(), [DVec2::ONE, DVec2::ZERO]), TerrainError::Region);
    assert_eq!(new(&fbm(), [DVec2::NAN, DVec2::ZERO]), TerrainError::Region);
    let deep = (0..20).fold(fbm(), |function, _| HeightFunction::Scaled(Box::new(function), 1.0));
    assert_eq!(new(&deep, REGION), TerrainError::TooDeep { most: MOST_NESTED });
    let mut powers = HeightFunction::Constant(1e9);
    for _ in 0..12 {
        powers = HeightFunction::Product(Box::new([powers.clone(), powers]));
    }
    assert_eq!(new(&powers, REGION), TerrainError::NotFinite);
}
