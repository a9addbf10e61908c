//! Points that stand for surfaces: off by about a voxel, and no hole anywhere.

use super::*;
use crate::octree::SurfacePoints;

/// All triangles are of one surface.
fn points(octree: &Octree, depth: u32) -> SurfacePoints {
    SurfacePoints::new(octree, depth, |_| Some(0), 5)
}

/// A ball whose triangles all face outwards.
fn outward(divisions: u32) -> Shape {
    let mut ball = ball(divisions);
    for triangle in 0..ball.triangles.len() {
        let [a, b, c] = ball.corners(triangle);
        if (b - a).cross(c - a).dot(a) < 0.0 {
            ball.triangles[triangle].swap(1, 2);
        }
    }
    ball
}

#[test]
fn points_are_hit_about_a_voxel_from_where_the_surface_is() {
    let ball = outward(5);
    let octree = ball.octree();
    let mut mean_before = f64::INFINITY;
    for depth in [5, 6, 7] {
        let points = points(&octree, depth);
        assert!(points.points() as f64 > 0.9 * points.voxels() as f64, "{} of {}", points.points(), points.voxels());
        let mut stream = RandomStream::new(3, 0);
        let (mut sum, mut count, mut differ) = (0.0, 0, 0);
        for _ in 0..20_000 {
            let ray = chord(DVec3::ZERO, 1.5, &mut stream);
            match (octree.closest(&ray, 0.0, f64::INFINITY), points.closest(&ray, 0.0, f64::INFINITY)) {
                (Some(exact), Some(near)) => {
                    let [a, b, c] = ball.corners(near.triangle as usize);
                    let at = a * (1.0 - near.u - near.v) + b * near.u + c * near.v;
                    // As the ray sees it; along the ray it is as far as the surface is steep.
                    let way = at - ray.origin;
                    let beside =
                        (way - ray.direction * way.dot(ray.direction) / ray.direction.length_squared()).length();
                    assert!(beside < 2.5 * points.side(), "{beside} at {depth}");
                    let steep = (exact.t - near.t).abs() * ray.direction.length() > 8.0 * points.side();
                    (sum, count, differ) = (sum + beside, count + 1, differ + usize::from(steep));
                }
                (None, None) => {}
                _ => differ += 1,
            }
        }
        // Only where rays graze the ball.
        assert!(count > 5_000 && (differ as f64) < 3.0 * points.side() * f64::from(count), "{differ} of {count}");
        let mean = sum / f64::from(count);
        assert!(mean < 0.8 * points.side() && mean < 0.7 * mean_before, "{mean} at {depth}");
        mean_before = mean;
    }
}

#[test]
fn no_ray_leaves_a_closed_room_or_a_ball() {
    for (shape, depth) in [(block(1), 6), (block(7), 5), (outward(2), 5), (outward(5), 5), (outward(5), 6)] {
        let octree = shape.octree();
        let points = points(&octree, depth);
        assert!(points.points() > 0);
        let mut stream = RandomStream::new(7, depth.into());
        for _ in 0..20_000 {
            let ray = Ray { origin: sphere(stream.point()) * 0.5, direction: sphere(stream.point()) };
            let exact = octree.closest(&ray, 0.0, f64::INFINITY).expect("it is closed");
            let near = points.closest(&ray, 0.0, f64::INFINITY).expect("it is closed");
            assert!((exact.t - near.t).abs() < 2.0 * points.side(), "{exact:?} {near:?}");
        }
    }
}

#[test]
fn rays_that_leave_a_ball_do_not_hit_it_again() {
    let ball = outward(5);
    let points = points(&ball.octree(), 6);
    let mut stream = RandomStream::new(9, 0);
    for _ in 0..20_000 {
        let inwards = chord(DVec3::ZERO, 1.5, &mut stream);
        let Some(hit) = points.closest(&inwards, 0.0, f64::INFINITY) else { continue };
        let [a, b, c] = ball.corners(hit.triangle as usize);
        let at = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let away = (sphere(stream.point()) + at).normalize();
        // Not along the ball, where planes of other points may be higher.
        if away.dot(at) > 0.1 {
            let ray = Ray { origin: at * (1.0 + 1e-9), direction: away };
            assert_eq!(points.closest(&ray, 0.0, f64::INFINITY), None, "{ray:?} after {hit:?}");
        }
    }
}

#[test]
fn voxels_that_hold_more_than_one_surface_or_one_that_bends_keep_their_triangles() {
    // Two sheets nearer to each other than a voxel; a ball smaller than one.
    let sheet = Shape { vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y], triangles: vec![[0, 1, 2]] };
    // So that no side of a voxel is near the sheets.
    let far = sheet.moved(|p| p + DVec3::Z * 1.01);
    let sheets = sheet.clone().joined(&sheet.moved(|p| p + DVec3::Z * 1e-3)).joined(&far);
    let small = outward(3).moved(|p| p * 1e-3).joined(&far);
    for (shape, of) in [(sheets, 1), (small, 1280)] {
        let octree = shape.octree();
        let last = shape.triangles.len() as u32 - 1;
        let points = SurfacePoints::new(&octree, 7, |triangle| (triangle < last).then_some(triangle < of), 1);
        let mut stream = RandomStream::new(2, 0);
        for _ in 0..2000 {
            let ray = chord(DVec3::ZERO, 0.01, &mut stream);
            assert_eq!(points.closest(&ray, 0.0, f64::INFINITY), octree.closest(&ray, 0.0, f64::INFINITY));
        }
    }
    // Points that may not stand for anything.
    let octree = outward(2).octree();
    assert_eq!(SurfacePoints::new(&octree, 5, |_| None::<u8>, 1).points(), 0);
    // Coarser than everything.
    let points = points(&octree, 1);
    let ray = Ray { origin: DVec3::new(0.1, 0.2, 5.0), direction: DVec3::NEG_Z };
    assert_eq!(points.closest(&ray, 0.0, f64::INFINITY), octree.closest(&ray, 0.0, f64::INFINITY));
}

#[test]
fn the_choice_of_points_does_not_depend_on_the_number_of_threads() {
    let octree = outward(4).octree();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    assert_eq!(one.install(|| points(&octree, 6)).points, points(&octree, 6).points);
    assert_ne!(points(&octree, 6).points, SurfacePoints::new(&octree, 6, |_| Some(0), 6).points);
}
