//! Rays and meshes at the edge of what numbers can say.

use super::*;

/// Directions along axes, with zeros of either sign, denormal and nearly denormal components.
fn odd_directions() -> Vec<DVec3> {
    let odd = [0.0, -0.0, 5e-324, -5e-324, 1e-310, 1e-30, -1e-30, 1.0, -1.0];
    let mut directions = Vec::new();
    for x in odd {
        for y in odd {
            for z in odd {
                if [x, y, z].iter().any(|c: &f64| c.abs() == 1.0) {
                    directions.push(DVec3::new(x, y, z));
                }
            }
        }
    }
    directions
}

#[test]
fn rays_along_faces_edges_and_diagonals_of_cells_lose_nothing() {
    // The modelling cube of this block goes from -2 to 2: its sides lie in faces of cells, its grid on their edges.
    let shape = block(8);
    let octrees = walks(&shape);
    let mut hits = 0;
    for direction in odd_directions() {
        for place in [[0.0, 0.0, 0.0], [0.25, 0.5, 0.0], [0.125, 0.3, -0.25], [1.0, 0.5, 0.0], [-1.0, -1.0, 0.1]] {
            let place = DVec3::from_array(place);
            for back in [0.0, 0.5, 3.0] {
                let ray = Ray { origin: place - direction * back, direction };
                hits += usize::from(assert_exact(&shape, &octrees, &ray, f64::INFINITY).is_some());
            }
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn a_ray_in_the_plane_of_triangles_hits_the_sides_across_it() {
    let shape = block(4);
    let octrees = walks(&shape);
    // Within the side y = 1: edge-on there, but the sides x = -1 and x = 1 begin at its edge.
    let ray = Ray { origin: DVec3::new(-3.0, 1.0, 0.3), direction: DVec3::X };
    let hit = assert_exact(&shape, &octrees, &ray, f64::INFINITY).expect("the side x = -1");
    assert_eq!(hit.t, 2.0);
}

#[test]
fn rays_from_far_away_hit_what_all_triangles_say() {
    let shape = ball(4);
    let octrees = walks(&shape);
    let mut stream = RandomStream::new(31, 0);
    for distance in [1e2, 1e4, 1e6, 1e9, 1e12, 1e13] {
        let mut hits = 0;
        for _ in 0..100 {
            let origin = sphere(stream.point()) * distance;
            let ray = Ray { origin, direction: -origin + sphere(stream.point()) * 0.5 };
            hits += usize::from(assert_exact(&shape, &octrees, &ray, f64::INFINITY).is_some());
            let away = Ray { origin, direction: origin };
            assert_exact(&shape, &octrees, &away, f64::INFINITY);
        }
        assert!(hits == 100, "{hits} at {distance}");
    }
    // Beyond all precision: a miss, not a guess.
    for distance in [1e18, 1e100, 1e160, 1e308] {
        let ray = Ray { origin: DVec3::X * distance, direction: DVec3::NEG_X };
        assert!(octrees.iter().all(|octree| octree.closest(&ray, 0.0, f64::INFINITY).is_none()));
    }
}

#[test]
fn the_length_of_the_direction_changes_t_only() {
    let shape = ball(3);
    let octrees = walks(&shape);
    let mut stream = RandomStream::new(32, 0);
    for _ in 0..50 {
        let ray = chord(DVec3::ZERO, 1.0, &mut stream);
        for exponent in [-1000, -100, -1, 1, 100, 900] {
            let factor = 2_f64.powi(exponent);
            let other = Ray { direction: ray.direction * factor, ..ray };
            for octree in &octrees {
                let (one, other) =
                    (octree.closest(&ray, 0.0, f64::INFINITY), octree.closest(&other, 0.0, f64::INFINITY));
                assert_eq!(one.map(|hit| Hit { t: hit.t / factor, ..hit }), other, "2^{exponent}");
            }
        }
    }
}

#[test]
fn what_is_no_ray_hits_nothing() {
    let octrees = walks(&ball(2));
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for octree in octrees {
        let misses = |origin: DVec3, direction: DVec3, t_min: f64, t_max: f64| {
            let ray = Ray { origin, direction };
            octree.closest(&ray, t_min, t_max).is_none() && !octree.occluded(&ray, t_min, t_max)
        };
        assert!(misses(DVec3::ZERO, DVec3::ZERO, 0.0, 1e9));
        assert!(misses(DVec3::ZERO, -DVec3::ZERO, 0.0, 1e9));
        for x in bad {
            assert!(misses(DVec3::new(0.0, x, 0.0), DVec3::X, 0.0, 1e9));
            assert!(misses(DVec3::ZERO, DVec3::new(1.0, x, 0.0), 0.0, 1e9));
        }
        assert!(misses(DVec3::ZERO, DVec3::X, f64::NAN, 1e9));
        assert!(misses(DVec3::ZERO, DVec3::X, 0.0, f64::NAN));
        assert!(misses(DVec3::ZERO, DVec3::X, 1e9, 0.0));
        assert!(misses(DVec3::ZERO, DVec3::X, f64::INFINITY, f64::INFINITY));
        assert!(!misses(DVec3::ZERO, DVec3::X, f64::NEG_INFINITY, f64::INFINITY));
    }
}

#[test]
fn a_power_of_two_of_scale_changes_no_digit() {
    let shape = torus(24);
    let mut stream = RandomStream::new(33, 0);
    let rays: Vec<Ray> = (0..2000).map(|_| chord(DVec3::ZERO, 1.4, &mut stream)).collect();
    let plain = shape.octree();
    for exponent in [-400, -20, -1, 1, 20, 400] {
        let factor = 2_f64.powi(exponent);
        for octree in walks(&shape.moved(|p| p * factor)) {
            assert_eq!(octree.codes(), plain.codes());
            for ray in &rays {
                let scaled = Ray { origin: ray.origin * factor, direction: ray.direction * factor };
                assert_eq!(
                    octree.closest(&scaled, 0.0, f64::INFINITY),
                    plain.closest(ray, 0.0, f64::INFINITY),
                    "2^{exponent} {ray:?}"
                );
            }
        }
    }
}

#[test]
fn other_scales_and_distant_places_hit_the_same_triangles() {
    let shape = torus(24);
    let plain = shape.octree();
    let mut stream = RandomStream::new(34, 0);
    let rays: Vec<Ray> = (0..3000).map(|_| chord(DVec3::ZERO, 1.4, &mut stream)).collect();
    for (scale, offset) in [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e7)] {
        let moved = shape.moved(|p| p * scale + DVec3::splat(offset));
        let octrees = walks(&moved);
        let mut differ = 0;
        for ray in &rays {
            let other = Ray { origin: ray.origin * scale + DVec3::splat(offset), direction: ray.direction * scale };
            let hit = octrees[1].closest(&other, 0.0, f64::INFINITY);
            assert_eq!(octrees[0].closest(&other, 0.0, f64::INFINITY), hit);
            let triangle = |hit: Option<Hit>| hit.map(|hit| hit.triangle);
            differ += usize::from(triangle(hit) != triangle(plain.closest(ray, 0.0, f64::INFINITY)));
        }
        // At 1e7 vertices are rounded to 2e-9, so about one ray in 1e7 passes an edge on the other side.
        assert!(differ <= 1, "{differ} at {scale} {offset}");
    }
}

#[test]
fn degenerate_triangles_are_never_hit_and_hide_nothing() {
    let mut shape = ball(2);
    let count = shape.triangles.len() as u32;
    let last = shape.vertices.len() as u32 - 1;
    for i in 0..last {
        shape.triangles.extend([[i, i, i], [i, last, i], [i, i + 1, i + 1]]);
    }
    // A needle: three points on a line.
    let start = shape.vertices.len() as u32;
    shape.vertices.extend([DVec3::NEG_ONE, DVec3::ZERO, DVec3::ONE]);
    shape.triangles.push([start, start + 1, start + 2]);
    let octrees = walks(&shape);
    let mut stream = RandomStream::new(35, 0);
    for _ in 0..500 {
        let ray = Ray { origin: sphere(stream.point()) * 0.5, direction: sphere(stream.point()) };
        let hit = assert_exact(&shape, &octrees, &ray, f64::INFINITY).expect("it leaves the ball");
        assert!(hit.triangle < count);
    }
    for degenerate in [vec![DVec3::ONE; 3], vec![DVec3::ZERO; 3], vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0]] {
        let shape = Shape { vertices: degenerate, triangles: vec![[0, 1, 2]; 3] };
        let octrees = walks(&shape);
        assert_exact(&shape, &octrees, &Ray { origin: DVec3::splat(-1.0), direction: DVec3::ONE }, f64::INFINITY);
    }
}

#[test]
fn identical_triangles_end_the_division_and_the_first_is_hit() {
    let shape =
        Shape { vertices: vec![DVec3::ZERO, DVec3::X, DVec3::new(0.3, 1.0, 0.2)], triangles: vec![[0, 1, 2]; 1000] };
    let octrees = walks(&shape);
    assert!(octrees[0].statistics().references < 1_000_000);
    let ray = Ray { origin: DVec3::new(0.4, 0.3, -1.0), direction: DVec3::Z };
    assert_eq!(assert_exact(&shape, &octrees, &ray, f64::INFINITY).map(|hit| hit.triangle), Some(0));
}

#[test]
fn a_fan_of_many_triangles_around_a_point_ends_the_division() {
    let n = 2000;
    let mut vertices = vec![DVec3::new(0.1, 0.2, 0.3)];
    vertices.extend((0..n).map(|i| {
        let (sin, cos) = (f64::from(i) / f64::from(n) * TAU).sin_cos();
        DVec3::new(cos, sin, 0.0)
    }));
    let triangles = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
    let shape = Shape { vertices, triangles };
    let octrees = walks(&shape);
    assert!(octrees[0].statistics().references < 200_000, "{:?}", octrees[0].statistics());
    let ray = Ray { origin: DVec3::new(0.1, 0.2, -1.0), direction: DVec3::Z };
    assert!(assert_exact(&shape, &octrees, &ray, f64::INFINITY).is_some());
}
