//! Objects put in and taken out give what building gives.

use super::*;
use crate::numeric::bounds::Bounds;
use crate::octree::{MAX_DEPTH, OctreeError};

/// The octree of some objects in a modelling cube from -2 to 2, built of each in order or of all at once.
fn built(objects: &[Shape], settings: &OctreeSettings, at_once: bool) -> Octree {
    let frame = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) };
    let mut octree = Octree::around(frame, settings).expect("a sound box");
    let joined = objects.iter().fold(Shape { vertices: vec![], triangles: vec![] }, Shape::joined);
    let joined = [joined];
    for shape in if at_once { &joined } else { objects } {
        octree.insert(&shape.vertices, &shape.triangles).expect("a sound mesh");
    }
    octree
}

fn assert_same(one: &Octree, other: &Octree) {
    assert_eq!(one.leaves(), other.leaves());
    assert_eq!(one.nodes().homes, other.nodes().homes);
    assert_eq!((&one.vertices, &one.triangles), (&other.vertices, &other.triangles));
    let packets = |octree: &Octree| {
        let index = octree.clone().with_walk(Walk::Index).index;
        index.packets.iter().map(|p| p.triangles).collect::<Vec<_>>()
    };
    assert_eq!(packets(one), packets(other));
}

/// A small object somewhere: a ball, a torus, a soup, a crowd of equal triangles, a needle.
fn object(stream: &mut RandomStream) -> Shape {
    let shape = match stream.below(5) {
        0 => ball(3),
        1 => torus(6),
        2 => soup(60, 0.05, stream),
        3 => {
            let shape = soup(1, 0.5, stream);
            Shape { triangles: vec![[0, 1, 2]; 400], ..shape }
        }
        _ => {
            Shape { vertices: vec![DVec3::NEG_ONE, DVec3::ONE, DVec3::new(0.9, 1.0, 1.0)], triangles: vec![[0, 1, 2]] }
        }
    };
    let size = 0.01_f64.powf(stream.uniform()) * 0.6;
    let place = DVec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * 2.0 - 1.0;
    shape.moved(|p| p * size + place)
}

#[test]
fn any_sequence_of_edits_gives_the_octree_of_the_final_objects() {
    for (seed, depth, leaf_triangles) in [(1, 16, 8), (2, MAX_DEPTH, 1), (3, 6, 0), (4, 16, 100)] {
        let mut stream = RandomStream::new(51, seed);
        let settings = OctreeSettings { depth, leaf_triangles, ..OctreeSettings::default() };
        let mut objects: Vec<Shape> = Vec::new();
        let mut octree = built(&objects, &settings, false);
        for step in 0..40 {
            if objects.is_empty() || stream.uniform() < if step < 20 { 0.7 } else { 0.4 } {
                let shape = object(&mut stream);
                assert_eq!(octree.insert(&shape.vertices, &shape.triangles), Ok(objects.len()));
                objects.push(shape);
            } else {
                let victim = stream.below(objects.len());
                assert!(octree.remove(victim));
                objects.remove(victim);
            }
            if step % 5 == 4 {
                assert_same(&octree, &built(&objects, &settings, false));
                assert_same(&octree, &built(&objects, &settings, true));
                assert_eq!(octree.objects(), objects.len());
            }
        }
        while octree.remove(0) {}
        assert_same(&octree, &built(&[], &settings, true));
        assert!(octree.codes().is_empty());
    }
}

#[test]
fn rays_hit_what_is_in_the_octree_after_edits() {
    let mut stream = RandomStream::new(52, 0);
    let objects: Vec<Shape> = (0..12).map(|_| object(&mut stream)).collect();
    let mut octree = built(&objects, &OctreeSettings::default(), false);
    for victim in [7, 0, 3] {
        octree.remove(victim);
    }
    let kept = [1, 2, 3, 5, 6, 8, 9, 10, 11].map(|i: usize| objects[i].clone());
    let all = kept.iter().fold(Shape { vertices: vec![], triangles: vec![] }, Shape::joined);
    let octrees = [octree.clone(), octree.with_walk(Walk::Index)];
    for _ in 0..2000 {
        let ray = chord(DVec3::ZERO, 1.5, &mut stream);
        assert_exact(&all, &octrees, &ray, f64::INFINITY);
    }
}

#[test]
fn an_edit_leaves_the_nodes_elsewhere_alone() {
    let frame = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) };
    let mut octree = Octree::around(frame, &OctreeSettings::default()).expect("a sound box");
    let large = ball(5).moved(|p| p * 0.5 - DVec3::ONE);
    octree.insert(&large.vertices, &large.triangles).expect("inside");
    let before = octree.codes().to_vec();
    let small = ball(2).moved(|p| p * 0.1 + DVec3::ONE);
    octree.insert(&small.vertices, &small.triangles).expect("inside");
    assert!(before.iter().all(|code| octree.codes().binary_search(code).is_ok()));
    assert!(octree.codes().len() > before.len());
    assert!(octree.remove(1) && !octree.remove(1));
    assert_eq!(octree.codes(), before);
}

#[test]
fn what_cannot_be_put_in_changes_nothing() {
    let objects = [ball(2)];
    let mut octree = built(&objects, &OctreeSettings::default(), false);
    let far = ball(1).moved(|p| p * 9.0);
    assert!(matches!(octree.insert(&far.vertices, &far.triangles), Err(OctreeError::VertexOutside { .. })));
    let bad = octree.insert(&[DVec3::ZERO], &[[0, 0, 1]]);
    assert_eq!(bad, Err(OctreeError::IndexOutOfRange { triangle: 0, index: 1, vertices: 1 }));
    assert_same(&octree, &built(&objects, &OctreeSettings::default(), false));
    let endless = Bounds { min: DVec3::ZERO, max: DVec3::INFINITY };
    assert!(Octree::around(endless, &OctreeSettings::default()).is_err());
}
