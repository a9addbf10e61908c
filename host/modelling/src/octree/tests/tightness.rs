//! A closed mesh lets no ray out.

use rayon::prelude::*;

use super::*;

/// Rays from inside aimed exactly at corners, at points of edges and at centres of triangles.
fn aimed(shape: &Shape, inside: impl Fn(&mut RandomStream) -> DVec3 + Sync, index: u64) -> Ray {
    let mut stream = RandomStream::new(21, index);
    let [a, b, c] = shape.corners(stream.below(shape.triangles.len()));
    let target = match index % 4 {
        0 => a,
        1 => (a + b) * 0.5,
        2 => b + (c - b) * stream.uniform(),
        _ => (a + b + c) / 3.0,
    };
    let origin = inside(&mut stream);
    Ray { origin, direction: target - origin }
}

fn escapes(shape: &Shape, octree: &Octree, count: u64, inside: impl Fn(&mut RandomStream) -> DVec3 + Sync) -> usize {
    (0..count)
        .into_par_iter()
        .filter(|&i| octree.closest(&aimed(shape, &inside, i), 0.0, f64::INFINITY).is_none())
        .count()
}

#[test]
fn a_closed_mesh_lets_no_ray_out() {
    let long = std::env::var("PERIS_LONG").is_ok_and(|value| value == "1");
    let (count, divisions) = if long { (10_000_000, 8) } else { (100_000, 5) };
    let shape = ball(divisions);
    let [leading, index] = walks(&shape);
    let inside = |stream: &mut RandomStream| sphere(stream.point()) * 0.9 * stream.uniform();
    assert_eq!(escapes(&shape, &index, count, inside), 0);
    assert_eq!(escapes(&shape, &leading, count / 10, inside), 0);
    let from_centre = |_: &mut RandomStream| DVec3::ZERO;
    assert_eq!(escapes(&shape, &index, count, from_centre), 0);
}

#[test]
fn no_ray_leaves_a_torus_or_a_block() {
    let shape = torus(48);
    let on_ring = |stream: &mut RandomStream| {
        let (sin, cos) = (stream.uniform() * TAU).sin_cos();
        DVec3::new(cos, 0.0, sin)
    };
    for octree in walks(&shape) {
        assert_eq!(escapes(&shape, &octree, 20_000, on_ring), 0);
    }
    let shape = block(16);
    for octree in walks(&shape) {
        assert_eq!(escapes(&shape, &octree, 20_000, |s| sphere(s.point()) * 0.7), 0);
        assert_eq!(escapes(&shape, &octree, 2_000, |_| DVec3::ZERO), 0);
    }
}

#[test]
fn small_large_and_distant_meshes_are_as_tight() {
    let shape = ball(4);
    for (scale, offset) in [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e7), (1e-3, 1e7), (1e-100, 0.0), (1e100, 0.0)] {
        let place = |p: DVec3| p * scale + DVec3::splat(offset);
        let moved = shape.moved(place);
        for octree in walks(&moved) {
            assert_eq!(escapes(&moved, &octree, 10_000, |s| place(sphere(s.point()) * 0.8)), 0, "{scale} {offset}");
        }
    }
}
