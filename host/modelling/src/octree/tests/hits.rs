//! The octree hits what all triangles together hit.

use super::*;
use crate::octree::brute_force::{Agreement, agreement, closest_many};

/// Compares with an independent formula, hit for hit; returns how many answers tie.
fn compare(shape: &Shape, rays: &[Ray]) -> usize {
    let octrees = walks(shape);
    let expected = closest_many(&shape.vertices, &shape.triangles, rays, 0.0, f64::INFINITY);
    let hits = expected.iter().flatten().count();
    assert!(hits * 10 > rays.len(), "only {hits} hits");
    let mut ties = 0;
    for (ray, expected) in rays.iter().zip(expected) {
        let [leading, index] = octrees.each_ref().map(|octree| octree.closest(ray, 0.0, f64::INFINITY));
        assert_eq!(leading, index, "{ray:?}");
        match agreement(index, expected) {
            Agreement::Same => {}
            Agreement::Tie => ties += 1,
            Agreement::Differ => panic!("{ray:?}: {index:?} is not {expected:?}"),
        }
    }
    ties
}

fn chords(count: usize, centre: DVec3, radius: f64, seed: u64) -> Vec<Ray> {
    let mut stream = RandomStream::new(seed, 1);
    (0..count).map(|_| chord(centre, radius, &mut stream)).collect()
}

#[test]
fn random_soups_agree_with_brute_force() {
    let mut stream = RandomStream::new(11, 0);
    for (count, smallest) in [(1, 0.5), (7, 0.5), (300, 0.1), (3000, 0.01), (3000, 1e-5)] {
        let shape = soup(count, smallest, &mut stream);
        let rays = if count < 100 {
            // Few triangles: aim at them.
            (0..2000)
                .map(|i| {
                    let origin = sphere(stream.point()) * 3.0;
                    let [a, b, c] = shape.corners(i % count as usize);
                    Ray { origin, direction: (a + b + c) / 3.0 + sphere(stream.point()) * 0.1 - origin }
                })
                .collect()
        } else {
            chords(10_000, DVec3::splat(0.5), 0.8, 12)
        };
        assert!(compare(&shape, &rays) <= 2);
    }
}

#[test]
fn spheres_and_tori_agree_with_brute_force() {
    assert!(compare(&ball(5), &chords(30_000, DVec3::ZERO, 1.0, 13)) <= 2);
    assert!(compare(&torus(40), &chords(30_000, DVec3::ZERO, 1.4, 14)) <= 2);
}

#[test]
fn a_small_thing_on_a_large_one_agrees_with_brute_force() {
    let corner = |x: f64, z: f64| DVec3::new(x * 1e4, -1.0, z * 1e4);
    let ground = Shape {
        vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let shape = ground.joined(&ball(4)).joined(&ball(3).moved(|p| p * 1e-3 + DVec3::new(2.0, 0.0, 0.0)));
    let mut rays = chords(10_000, DVec3::ZERO, 1.2, 15);
    rays.extend(chords(5_000, DVec3::new(2.0, 0.0, 0.0), 1.2e-3, 16));
    rays.extend(chords(5_000, DVec3::ZERO, 1e4, 17));
    assert!(compare(&shape, &rays) <= 2);
}

#[test]
fn both_walks_find_bit_for_bit_what_all_triangles_say() {
    let mut stream = RandomStream::new(18, 0);
    for shape in [soup(400, 0.01, &mut stream), ball(3), torus(12), block(8)] {
        let octrees = walks(&shape);
        for _ in 0..1500 {
            let ray = chord(DVec3::splat(0.3), 1.0, &mut stream);
            assert_exact(&shape, &octrees, &ray, 1.5);
        }
        // At the corners exactly, where up to six triangles meet.
        for &target in shape.vertices.iter().step_by(3) {
            let origin = sphere(stream.point()) * 3.0;
            assert_exact(&shape, &octrees, &Ray { origin, direction: target - origin }, f64::INFINITY);
        }
    }
}

#[test]
fn limits_are_exclusive() {
    let shape = ball(3);
    let ray = Ray { origin: DVec3::new(0.1, 0.2, -3.0), direction: DVec3::Z };
    for octree in walks(&shape) {
        let first = octree.closest(&ray, 0.0, f64::INFINITY).expect("it hits the sphere");
        let second = octree.closest(&ray, first.t, f64::INFINITY).expect("it leaves the sphere");
        assert!(second.t > first.t);
        assert_eq!(octree.closest(&ray, second.t, f64::INFINITY), None);
        assert_eq!(octree.closest(&ray, 0.0, first.t), None);
        assert_eq!(octree.closest(&ray, first.t, second.t), None);
        assert_eq!(octree.closest(&ray, 0.0, first.t.next_up()), Some(first));
        assert!(!octree.occluded(&ray, first.t, second.t));
    }
}
