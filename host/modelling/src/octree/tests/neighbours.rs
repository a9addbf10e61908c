//! Neighbours are those that a search of all finds.

use super::*;
use crate::octree::{LocationalCode, MAX_DEPTH};

/// Every direction but none.
fn directions() -> impl Iterator<Item = [i8; 3]> {
    let all = (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]);
    all.filter(|&towards| towards != [0; 3])
}

/// Whether a node lies beside a cube in a direction: it touches the side there, and overlaps it where there is no step.
fn is_beside(cube: LocationalCode, towards: [i8; 3], node: LocationalCode) -> bool {
    let (a, b) = (cube.corner(), node.corner());
    (0..3).all(|axis| {
        let (low, high) = (b[axis], b[axis] + node.side());
        match towards[axis] {
            0 => low < a[axis] + cube.side() && a[axis] < high,
            // A node that continues around the corner begins before it.
            1 => low <= a[axis] + cube.side() && a[axis] + cube.side() < high,
            _ => low < a[axis] && a[axis] <= high,
        }
    })
}

#[test]
fn neighbours_are_those_that_a_search_of_all_finds() {
    let mut stream = RandomStream::new(71, 0);
    let shape = torus(12).joined(&soup(200, 0.001, &mut stream));
    for (depth, leaf_triangles) in [(16, 4), (4, 0), (MAX_DEPTH, 1)] {
        let settings = OctreeSettings { depth, leaf_triangles, ..OctreeSettings::default() };
        let octree = Octree::build(&shape.vertices, &shape.triangles, &settings).expect("a sound mesh");
        let (mut smaller, mut larger) = (0, 0);
        for &cube in octree.codes().iter().step_by(5) {
            for towards in directions() {
                let found = octree.neighbours(cube, towards);
                let all = octree.codes().iter().copied();
                let expected: Vec<_> = all.filter(|&node| is_beside(cube, towards, node)).collect();
                assert_eq!(found, expected, "{cube} towards {towards:?}");
                smaller += found.iter().filter(|node| node.level() > cube.level()).count();
                larger += found.iter().filter(|node| node.level() < cube.level()).count();
            }
        }
        assert!(smaller > 100 && larger > 100 || depth == 4, "{smaller} {larger}");
    }
}

#[test]
fn empty_cubes_have_neighbours_too() {
    let octree = block(4).octree();
    // The middle of the block is empty.
    let middle = LocationalCode::containing([1 << (MAX_DEPTH - 1); 3], 3);
    assert!(octree.triangles_in(middle).is_empty());
    let around: usize = directions().map(|towards| octree.neighbours(middle, towards).len()).sum();
    assert!(around > 0);
    assert!(octree.neighbours(LocationalCode::ROOT, [1, 0, 0]).is_empty());
    assert!(octree.neighbours(middle, [0; 3]).is_empty());
}
