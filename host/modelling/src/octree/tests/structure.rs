//! The codes, location, errors, and what must not depend on threads.

use super::*;
use crate::octree::{Location, LocationalCode, MAX_DEPTH, OctreeError};

#[test]
fn codes_are_sorted_and_none_contains_another() {
    let octree = torus(30).octree();
    let codes = octree.codes();
    assert!(codes.len() > 100);
    assert!(codes.windows(2).all(|pair| pair[0] < pair[1] && !pair[0].contains(pair[1])));
}

#[test]
fn points_of_the_surface_lie_in_stored_nodes() {
    for settings in
        [OctreeSettings::default(), OctreeSettings { depth: 4, leaf_triangles: 1, ..OctreeSettings::default() }]
    {
        let shape = torus(30);
        let octree = Octree::build(&shape.vertices, &shape.triangles, &settings).expect("a sound mesh");
        for triangle in 0..shape.triangles.len() {
            let [a, b, c] = shape.corners(triangle);
            for point in [a, (a + b + c) / 3.0, a * 0.9 + b * 0.1] {
                match octree.locate(point) {
                    Location::Voxel(code) => assert_eq!(code.level(), settings.depth),
                    Location::Partial(code) => assert!(code.level() < settings.depth),
                    other => panic!("{point} is in {other:?}"),
                }
            }
        }
        let statistics = octree.statistics();
        assert_eq!(statistics.leaves, octree.codes().len());
        assert_eq!(statistics.partial_nodes + statistics.voxel_nodes, statistics.leaves);
        assert_eq!(statistics.depth_histogram.iter().sum::<usize>(), statistics.leaves);
        assert_eq!(statistics.voxel_nodes > 0, settings.depth == 4);
    }
}

#[test]
fn an_empty_region_is_the_largest_cube_without_surface() {
    let octree = ball(4).octree();
    let mut stream = RandomStream::new(41, 0);
    let mut empty = 0;
    for _ in 0..20_000 {
        let point = DVec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * 4.4 - 2.2;
        let holders: Vec<_> = octree.codes().iter().filter(|&&code| holds(&octree, code, point)).collect();
        match octree.locate(point) {
            Location::Voxel(code) | Location::Partial(code) => assert_eq!(holders, [&code]),
            Location::Outside => assert!(!holds(&octree, LocationalCode::ROOT, point)),
            Location::Empty { code, level } => {
                empty += 1;
                assert!(holds(&octree, code, point) && holders.is_empty());
                assert_eq!(code.level(), level);
                let filled = |cube: LocationalCode| octree.codes().iter().any(|&stored| cube.contains(stored));
                assert!(!filled(code));
                assert!(filled(code.parent().expect("the whole cube is not empty")));
            }
        }
        if empty > 500 {
            return;
        }
    }
    panic!("only {empty} points in empty regions");
}

fn holds(octree: &Octree, code: LocationalCode, point: DVec3) -> bool {
    let (low, high) = octree.bounds(code);
    point.cmpge(low).all() && point.cmplt(high).all()
}

#[test]
fn no_triangles_make_an_octree_without_nodes() {
    let octree = Octree::build(&[], &[], &OctreeSettings::default()).expect("nothing is fine");
    assert!(octree.codes().is_empty());
    assert_eq!(octree.closest(&Ray { origin: DVec3::ZERO, direction: DVec3::X }, 0.0, 1.0), None);
    assert_eq!(octree.statistics().triangles, 0);
    assert!(matches!(octree.locate(DVec3::ZERO), Location::Empty { level: 0, .. }));
    assert_eq!(octree.locate(DVec3::splat(f64::NAN)), Location::Outside);
}

#[test]
fn bad_input_is_named() {
    let build = |vertices: &[DVec3], triangles: &[[u32; 3]]| {
        Octree::build(vertices, triangles, &OctreeSettings::default()).map(|_| ())
    };
    let good = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert_eq!(build(&good, &[[0, 1, 2]]), Ok(()));
    assert_eq!(
        build(&good, &[[0, 1, 2], [0, 3, 1]]),
        Err(OctreeError::IndexOutOfRange { triangle: 1, index: 3, vertices: 3 })
    );
    assert_eq!(
        build(&[DVec3::ZERO, DVec3::new(0.0, f64::NAN, 0.0)], &[]),
        Err(OctreeError::NonFiniteVertex { vertex: 1 })
    );
    assert_eq!(build(&[DVec3::X * 1e200], &[]), Err(OctreeError::VertexTooFar { vertex: 0 }));
}

#[test]
fn any_depth_and_leaf_size_give_the_same_hits() {
    let shape = torus(10);
    let mut stream = RandomStream::new(42, 0);
    let rays: Vec<Ray> = (0..500).map(|_| chord(DVec3::ZERO, 1.4, &mut stream)).collect();
    for (depth, leaf_triangles) in [(0, 0), (1, 1), (3, 0), (7, 2), (MAX_DEPTH, 8), (99, 1000)] {
        for walk in [Walk::Index, Walk::LeadingDirection] {
            let settings = OctreeSettings { depth, leaf_triangles, walk, ..OctreeSettings::default() };
            let octree = Octree::build(&shape.vertices, &shape.triangles, &settings).expect("a sound mesh");
            for ray in &rays {
                let hit = octree.closest(ray, 0.0, f64::INFINITY);
                assert_eq!(hit, shape.exact(ray, &octree, f64::INFINITY), "{settings:?}");
            }
        }
    }
}

#[test]
fn the_octree_does_not_depend_on_the_number_of_threads() {
    let shape = ball(6);
    let built = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let octree = pool.install(|| shape.octree());
        let packets: Vec<_> = octree.index.packets.iter().map(|packet| packet.triangles).collect();
        let starts: Vec<_> = octree.index.nodes.iter().map(|node| node.children).collect();
        (octree.leaves().clone(), octree.nodes().homes.clone(), packets, starts)
    });
    assert_eq!(built[0], built[1]);
    assert_eq!(built[0], built[2]);
}

#[test]
fn no_cell_is_smaller_than_the_least_side_of_a_leaf() {
    let shape = torus(30);
    let side = shape.octree().cube.side;
    for (leaf_side, level) in [(side / 20.0, 4), (side / 16.0, 4), (side / 15.9, 3), (2.0 * side, 0), (f64::NAN, 16)] {
        let settings = OctreeSettings { leaf_side, leaf_triangles: 0, ..OctreeSettings::default() };
        let octree = Octree::build(&shape.vertices, &shape.triangles, &settings).expect("a sound mesh");
        assert_eq!(octree.depth, level, "{leaf_side}");
        assert!(octree.codes().iter().all(|code| code.level() <= level));
    }
}

#[test]
fn the_deepest_octree_is_as_exact_as_any() {
    // A ball on the side of a large triangle, a hundred thousandth of its size: it needs the last levels.
    let floor = Shape {
        vertices: vec![DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.5)],
        triangles: vec![[0, 1, 2]],
    };
    let place = |p: DVec3| p * 2e-5 + DVec3::new(0.1, 1e-5, 0.2);
    let shape = floor.joined(&ball(4).moved(place));
    let mut stream = RandomStream::new(43, 0);
    for depth in [19, 20, 21] {
        let settings = OctreeSettings { depth, leaf_triangles: 1, ..OctreeSettings::default() };
        let octree = Octree::build(&shape.vertices, &shape.triangles, &settings).expect("a sound mesh");
        assert_eq!(octree.codes().iter().map(|code| code.level()).max(), Some(depth));
        assert!(octree.statistics().voxel_nodes > 50);
        let octrees = [octree.clone().with_walk(Walk::LeadingDirection), octree];
        for i in 0..1500 {
            let target = if i % 2 == 0 { shape.vertices[3 + i] } else { place(sphere(stream.point()) * 0.9) };
            let origin = place(sphere(stream.point()) * [2.0, 1e6][i / 2 % 2]);
            let ray = Ray { origin, direction: target - origin };
            assert!(assert_exact(&shape, &octrees, &ray, f64::INFINITY).is_some());
        }
    }
}

#[test]
fn every_triangle_is_named_where_it_lies() {
    let shape = soup(500, 0.01, &mut RandomStream::new(44, 0));
    let octree = shape.octree();
    let mut stream = RandomStream::new(44, 1);
    for triangle in 0..shape.triangles.len() {
        let [a, b, c] = shape.corners(triangle);
        for _ in 0..10 {
            let [u, v] = crate::numeric::sampling::triangle(stream.point());
            let point = a + (b - a) * u + (c - a) * v;
            let (Location::Partial(node) | Location::Voxel(node)) = octree.locate(point) else {
                panic!("{point} is in no node");
            };
            let named = octree.triangles_in(node);
            assert!(named.is_sorted() && named.binary_search(&(triangle as u32)).is_ok());
        }
    }
    assert_eq!(octree.triangles_in(LocationalCode::ROOT), &[] as &[u32]);
}

#[test]
fn large_triangles_through_a_crowd_of_small_ones_stay_few_in_the_nodes() {
    // Two thousand times the same large triangle, and a ball of five thousand in the midst of it.
    let mut shape = ball(4).moved(|p| p * 0.1);
    let first = shape.vertices.len() as u32;
    shape.vertices.extend([DVec3::new(-9.0, 0.0, -9.0), DVec3::new(9.0, 0.0, -9.0), DVec3::new(0.0, 0.01, 12.0)]);
    shape.triangles.extend([[first, first + 1, first + 2]; 2000]);
    let statistics = shape.octree().statistics();
    assert!(statistics.leaves > 0 && statistics.references < 100 * shape.triangles.len(), "{statistics:?}");
}

#[test]
fn a_walk_counts_what_it_visits() {
    let shape = ball(5);
    let [leading, index] = walks(&shape);
    let ray = Ray { origin: DVec3::new(-3.0, 0.1, 0.2), direction: DVec3::X };
    for octree in [leading, index] {
        let (hit, count) = octree.closest_counted(&ray, 0.0, f64::INFINITY);
        assert!(hit.is_some());
        assert!((1..100).contains(&count.cells) && (1..200).contains(&count.triangles), "{count:?}");
    }
}
