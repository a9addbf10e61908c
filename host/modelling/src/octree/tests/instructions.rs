//! Instructions of the processor make no difference.

use super::*;
use crate::octree::WalkCount;
use crate::octree::descend::{is_any_by, nearest_by};
use crate::octree::lanes::ScalarLanes;

#[test]
fn plain_and_wide_instructions_find_the_same() {
    let mut stream = RandomStream::new(91, 0);
    for shape in [soup(300, 0.01, &mut stream), ball(4), torus(12), block(8)] {
        let octree = shape.octree();
        let mut hits = 0;
        for i in 0..4000 {
            let chord = chord(DVec3::splat(0.2), 1.0, &mut stream);
            let corner = shape.vertices[stream.below(shape.vertices.len())];
            let ray = if i % 2 == 0 { chord } else { Ray { direction: corner - chord.origin, ..chord } };
            for t_max in [0.3, 1.0, f64::INFINITY] {
                let hit = octree.closest(&ray, 0.0, t_max);
                assert_eq!(nearest_by::<ScalarLanes>((), &octree, &ray, [0.0, t_max], &mut WalkCount::default()), hit);
                assert_eq!(octree.occluded(&ray, 0.0, t_max), hit.is_some());
                assert_eq!(is_any_by::<ScalarLanes>((), &octree, &ray, [0.0, t_max]), hit.is_some());
                hits += usize::from(hit.is_some());
            }
        }
        assert!(hits > 1000, "{hits}");
    }
}

#[test]
fn slanted_needles_are_hit_as_all_triangles_say() {
    // Long and thin: these are held as pieces.
    let mut stream = RandomStream::new(92, 0);
    let mut shape = ball(4).moved(|p| p * 0.3);
    for _ in 0..40 {
        let first = shape.vertices.len() as u32;
        let [a, b] = [sphere(stream.point()) * 2.0, sphere(stream.point()) * 2.0];
        shape.vertices.extend([a, b, b + sphere(stream.point()) * 1e-3]);
        shape.triangles.push([first, first + 1, first + 2]);
    }
    let octrees = walks(&shape);
    let needles = shape.triangles.len() - 40;
    let mut hits = 0;
    for i in 0..2000 {
        let [a, b, c] = shape.corners(needles + i % 40);
        let origin = sphere(stream.point()) * 3.0;
        let part = stream.uniform();
        let target = a * (1.0 - part) + (b + (c - b) * 0.5) * part;
        let hit = assert_exact(&shape, &octrees, &Ray { origin, direction: target - origin }, f64::INFINITY);
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 1900, "{hits}");
}
