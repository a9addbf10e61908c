//! The limit surface against closed forms: B-splines, averages, symmetry.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::*;
use crate::numeric::sampling::RandomStream;

mod creases;

/// A cube of side 2 around the origin.
fn cube() -> Polyhedron {
    let points = (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * 2.0 - 1.0);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Polyhedron::new(points.collect(), &faces).unwrap()
}

/// A torus of `m` by `n` quadrangles with random positions: regular everywhere.
fn torus(m: u32, n: u32) -> Polyhedron {
    let mut stream = RandomStream::new(5, 0);
    let points = (0..m * n).map(|_| DVec3::new(stream.uniform(), stream.uniform(), stream.uniform())).collect();
    let at = |i: u32, j: u32| i % m + m * (j % n);
    let faces: Vec<[u32; 4]> = (0..m * n)
        .map(|k| (k % m, k / m))
        .map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect();
    Polyhedron::new(points, &faces).unwrap()
}

/// A sheet of `m` by `n` vertices with random heights.
fn sheet(m: u32, n: u32) -> Polyhedron {
    let mut stream = RandomStream::new(6, 0);
    let points = (0..m * n).map(|k| DVec3::new(f64::from(k % m), f64::from(k / m), stream.uniform())).collect();
    let faces: Vec<[u32; 4]> =
        (0..(m - 1) * (n - 1)).map(|k| k % (m - 1) + m * (k / (m - 1))).map(|k| [k, k + 1, k + 1 + m, k + m]).collect();
    Polyhedron::new(points, &faces).unwrap()
}

/// Two pyramids over a polygon of `n` corners, so that vertices of valence n and of 4, and triangles, occur; with
/// `prism` a prism: faces of n corners.
fn solid(n: u32, prism: bool) -> Polyhedron {
    let rim = |z: f64| {
        (0..n).map(move |k| {
            let (y, x) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            DVec3::new(x, y, z)
        })
    };
    if prism {
        let mut faces: Vec<Vec<u32>> = (0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]).collect();
        faces.push((0..n).rev().collect());
        faces.push((n..2 * n).collect());
        return Polyhedron::new(rim(-1.0).chain(rim(1.0)).collect(), &faces).unwrap();
    }
    let points: Vec<DVec3> = rim(0.0).chain([DVec3::Z, DVec3::NEG_Z]).collect();
    let faces: Vec<[u32; 3]> = (0..n).flat_map(|k| [[k, (k + 1) % n, n], [(k + 1) % n, k, n + 1]]).collect();
    Polyhedron::new(points, &faces).unwrap()
}

/// A cube whose upper rim is sharp.
fn cup(sharpness: f64) -> Polyhedron {
    let mut start = cube();
    for ends in [[4, 5], [5, 7], [7, 6], [6, 4]] {
        start.sharpen_edge(ends, sharpness).unwrap();
    }
    start
}

/// One step of a quadratic B-spline curve without ends.
fn chaikin(points: &[DVec3]) -> Vec<DVec3> {
    let ends = points.iter().zip(points.iter().cycle().skip(1));
    ends.flat_map(|(a, b)| [*a * 0.75 + *b * 0.25, *a * 0.25 + *b * 0.75]).collect()
}

/// One step of a quadratic B-spline curve that begins and ends in its end points.
fn chaikin_with_ends(points: &[DVec3]) -> Vec<DVec3> {
    let mut new = chaikin(points);
    new.truncate(2 * points.len() - 2);
    let last = new.len() - 1;
    (new[0], new[last]) = (points[0], points[points.len() - 1]);
    new[1] = (points[0] + points[1]) * 0.5;
    new[last - 1] = (points[points.len() - 1] + points[points.len() - 2]) * 0.5;
    new
}

/// A step in both directions of a grid of `m` columns.
fn in_both(points: &[DVec3], m: usize, rule: fn(&[DVec3]) -> Vec<DVec3>) -> (Vec<DVec3>, usize) {
    let rows: Vec<Vec<DVec3>> = points.chunks(m).map(rule).collect();
    let columns: Vec<Vec<DVec3>> =
        (0..rows[0].len()).map(|i| rule(&rows.iter().map(|row| row[i]).collect::<Vec<_>>())).collect();
    let flat = (0..columns[0].len()).flat_map(|j| columns.iter().map(move |column| column[j])).collect();
    (flat, rows[0].len())
}

/// Whether two sets of points are the same to 1e-14.
fn assert_same_points(found: &[DVec3], expected: &[DVec3]) {
    assert_eq!(found.len(), expected.len());
    let mut left: HashMap<[i64; 3], Vec<DVec3>> = HashMap::new();
    let cell = |p: DVec3| (p * 1e6).round().as_i64vec3().to_array();
    expected.iter().for_each(|&p| left.entry(cell(p)).or_default().push(p));
    for &p in found {
        let near = (0..27).map(|k| DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) - 1.0);
        let is_here = near.map(|shift| cell(p + shift * 1e-6)).any(|key| {
            let Some(list) = left.get_mut(&key) else { return false };
            let Some(at) = list.iter().position(|q| (*q - p).abs().max_element() < 1e-14) else { return false };
            list.swap_remove(at);
            true
        });
        assert!(is_here, "{p} is not expected");
    }
}

/// Euler's number: vertices - edges + faces.
fn euler(polyhedron: &Polyhedron) -> i64 {
    let borders = polyhedron.twins.iter().filter(|&&twin| twin == polyhedron::NONE).count();
    let edges = (polyhedron.corners.len() + borders) / 2;
    polyhedron.points.len() as i64 - edges as i64 + polyhedron.face_count() as i64
}

/// The polyhedron made anew of its faces: the counted links are those that a search finds.
fn assert_linked(polyhedron: &Polyhedron) {
    let faces: Vec<&[u32]> = polyhedron.faces().collect();
    let anew = Polyhedron::new(polyhedron.points.clone(), &faces).unwrap();
    assert_eq!((&anew.next, &anew.twins), (&polyhedron.next, &polyhedron.twins));
}

#[test]
fn a_step_makes_a_face_of_each_face_edge_and_vertex() {
    let once = cube().subdivided(1).unwrap();
    assert_eq!((once.points.len(), once.face_count()), (24, 6 + 12 + 8));
    assert_linked(&once);
    let mut sides: Vec<usize> = once.faces().map(<[u32]>::len).collect();
    sides.sort();
    assert_eq!(sides, [vec![3; 8], vec![4; 18]].concat());
    for n in 3..20 {
        for prism in [false, true] {
            let twice = solid(n, prism).subdivided(2).unwrap();
            assert_linked(&twice);
            assert_eq!(euler(&twice), 2);
        }
    }
}

#[test]
fn regular_meshes_are_biquadratic_b_splines() {
    let start = torus(5, 4);
    let (mut points, mut m) = (start.points.clone(), 5);
    for steps in 1..6 {
        (points, m) = in_both(&points, m, chaikin);
        assert_same_points(start.subdivided(steps).unwrap().points(), &points);
    }
    // The limit points are the spline in the middle between its control points.
    let mut limit = Vec::new();
    let n = points.len() / m;
    for k in 0..points.len() {
        let (i, j) = (k % m, k / m);
        let at = |i: usize, j: usize| points[i % m + m * (j % n)];
        limit.push((at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1)) * 0.25);
    }
    assert_same_points(&start.subdivided(5).unwrap().limit().unwrap().vertices, &limit);
}

#[test]
fn an_open_sheet_is_a_b_spline_that_begins_and_ends_at_its_border() {
    let start = sheet(5, 4);
    let (mut points, mut m) = (start.points.clone(), 5);
    for steps in 1..5 {
        (points, m) = in_both(&points, m, chaikin_with_ends);
        let found = start.subdivided(steps).unwrap();
        assert_same_points(found.points(), &points);
        assert_linked(&found);
    }
    let limit = start.subdivided(3).unwrap().limit().unwrap();
    let bounds = limit.bounds().unwrap();
    assert_eq!((bounds.min.x, bounds.max.x, bounds.min.y, bounds.max.y), (0.0, 4.0, 0.0, 3.0));
    assert!((0..4).all(|k| limit.vertices.contains(&start.points[[0, 4, 15, 19][k]])));
    assert!(limit.corner_normals.iter().flatten().all(|normal| normal.z > 0.0 && normal.is_normalized()));
}

/// A face with its neighbours, followed for so many steps; smooth parts only.
fn followed(polyhedron: &Polyhedron, face: usize, steps: usize) -> Vec<DVec3> {
    let mut corners: Vec<DVec3> = polyhedron.face_points(face).collect();
    for _ in 0..steps {
        let mut new = corners.clone();
        weights::step(&corners, &mut new);
        corners = new;
    }
    corners
}

#[test]
fn limit_points_and_normals_agree_with_twenty_steps() {
    for n in 3..=64 {
        for prism in [false, true] {
            let once = solid(n, prism).subdivided(1).unwrap();
            let limit = once.limit().unwrap();
            for face in 0..once.face_count() {
                let near = followed(&once, face, 20);
                let far = near.iter().map(|p| (*p - limit.vertices[face]).length()).fold(0.0, f64::max);
                assert!(far < 4e-6, "{n}: {far}");
                let triangle = limit.triangles.iter().position(|t| t.contains(&(face as u32))).unwrap();
                let corner = limit.triangles[triangle].iter().position(|&f| f as usize == face).unwrap();
                let normal = limit.corner_normals[triangle][corner];
                let found: DVec3 = near.windows(2).map(|e| (e[0] - near[0]).cross(e[1] - near[0])).sum();
                assert!((found.normalize() - normal).length() < 1e-6, "{n}: {found} {normal}");
                assert!(normal.dot(limit.vertices[face]) > 0.0);
            }
        }
    }
}

#[test]
fn the_first_steps_of_a_whole_mesh_come_to_its_limit_points() {
    let start = solid(7, false);
    let limit = start.limit().unwrap();
    let found = start.subdivided(6).unwrap();
    for (face, point) in limit.vertices.iter().enumerate() {
        // Face k stays the k-th.
        let near = found.face_points(face).map(|p| (p - *point).length()).fold(0.0, f64::max);
        assert!(near < 0.02);
    }
}

#[test]
fn limit_meshes_are_closed_and_converge() {
    for n in [3, 4, 5, 9, 64] {
        for prism in [false, true] {
            let start = solid(n, prism);
            let volumes: Vec<f64> = (1..6)
                .map(|steps| {
                    let limit = start.subdivided(steps).unwrap().limit().unwrap();
                    assert!(limit.is_closed());
                    limit.signed_volume()
                })
                .collect();
            // The error of flat triangles falls by four in each step.
            let ratio = (volumes[3] - volumes[2]) / (volumes[4] - volumes[3]);
            assert!((3.5..4.5).contains(&ratio), "{n}: {volumes:?}");
        }
    }
}

#[test]
fn all_weights_are_positive_and_sum_to_one() {
    for n in 3..=64 {
        for bits in 0..81 {
            let part = |k: u32| f64::from(bits / 3_u32.pow(k) % 3) * 0.5;
            let hold = weights::Pinning {
                here_forward: part(0),
                there_forward: part(1),
                here_backward: part(2),
                there_backward: part(3),
            };
            let mut sum = 0.0;
            for k in 0..n {
                let unit: Vec<DVec3> = (0..n).map(|j| if j == k { DVec3::X } else { DVec3::ZERO }).collect();
                let mut new = unit.clone();
                weights::step(&unit, &mut new);
                let weight = weights::held(&unit, 0, hold, new[0]).x;
                assert!(weight > -1e-15, "{n} {k}: {weight}");
                sum += weight;
            }
            assert!((sum - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn a_change_stays_near_its_place() {
    let mut start = torus(12, 12);
    let before = start.subdivided(3).unwrap();
    start.points[0] += DVec3::ONE;
    let after = start.subdivided(3).unwrap();
    let same = before.points.iter().zip(&after.points).filter(|(a, b)| a == b).count();
    // Two rings of faces around the vertex: 3 by 3 spans of the spline.
    assert_eq!(before.points.len() - same, 22 * 22);
}

#[test]
fn maps_of_the_polyhedron_are_maps_of_the_surface() {
    let start = solid(5, true);
    let map = DMat3::from_cols(DVec3::new(2.0, 0.5, 0.1), DVec3::new(-0.3, 1.0, 0.2), DVec3::new(0.4, 0.1, 3.0));
    let shift = DVec3::new(5.0, -2.0, 1.0);
    let mut moved = start.clone();
    moved.points.iter_mut().for_each(|p| *p = map * *p + shift);
    let [plain, moved] = [start, moved].map(|p| p.subdivided(3).unwrap().limit().unwrap().vertices);
    assert!(plain.iter().zip(&moved).all(|(a, b)| (map * *a + shift - *b).length() < 1e-13));
}

#[test]
fn a_strip_of_one_face_is_ruled() {
    let start = sheet(6, 2);
    let limit = start.subdivided(2).unwrap().limit().unwrap();
    let bounds = limit.bounds().unwrap();
    assert_eq!((bounds.min.x, bounds.max.x, bounds.min.y, bounds.max.y), (0.0, 5.0, 0.0, 1.0));
    assert!(limit.area() > 5.0);
    let border = limit.edge_report().boundary;
    assert!(border > 0 && limit.vertices.iter().all(|p| p.y == 0.0 || p.y == 1.0));
}

#[test]
fn bad_polyhedra_are_refused_with_the_place() {
    let corners = || (0..6).map(|k| DVec3::new(f64::from(k), f64::from(k * k), 0.0)).collect::<Vec<_>>();
    let refused = |faces: &[&[u32]]| Polyhedron::new(corners(), faces).unwrap_err();
    assert_eq!(refused(&[&[0, 1]]), SubdivisionError::TooFewCorners { face: 0, corners: 2 });
    assert_eq!(refused(&[&[0, 1, 2], &[0, 1, 9]]), SubdivisionError::NoSuchVertex { face: 1, vertex: 9, vertices: 6 });
    assert_eq!(refused(&[&[0, 1, 1]]), SubdivisionError::RepeatedVertex { face: 0, vertex: 1 });
    let same_way = refused(&[&[0, 1, 2], &[0, 1, 3]]);
    assert_eq!(same_way, SubdivisionError::Orientation { ends: [0, 1], faces: [0, 1] });
    let crowded = refused(&[&[0, 1, 2], &[1, 0, 3], &[1, 0, 4]]);
    assert_eq!(crowded, SubdivisionError::CrowdedEdge { ends: [0, 1], count: 3, faces: [0, 1] });
    let mut points = corners();
    points[3].y = f64::INFINITY;
    assert_eq!(Polyhedron::new(points, &[[0, 1, 2]]).unwrap_err(), SubdivisionError::NotFinite { vertex: 3 });
    let mut start = cube();
    assert_eq!(start.sharpen_edge([0, 7], 1.0).unwrap_err(), SubdivisionError::NoSuchEdge { ends: [0, 7] });
    assert_eq!(start.sharpen_vertex(8, 1.0).unwrap_err(), SubdivisionError::Unknown { vertex: 8, vertices: 8 });
    assert!(matches!(start.sharpen_edge([0, 1], f64::NAN), Err(SubdivisionError::Sharpness { .. })));
    assert!(matches!(start.subdivided(30), Err(SubdivisionError::TooLarge { .. })));
}

#[test]
fn two_solids_that_touch_in_a_vertex_come_apart() {
    let one = cube();
    let mut faces: Vec<Vec<u32>> = one.faces().map(<[u32]>::to_vec).collect();
    let mut points = one.points.clone();
    // A second cube whose vertex 0 is vertex 7 of the first.
    let name = |vertex: u32| if vertex == 0 { 7 } else { vertex + 7 };
    points.extend(one.points[1..].iter().map(|p| *p + 2.0));
    faces.extend(one.faces().map(|face| face.iter().map(|&v| name(v)).collect::<Vec<_>>()));
    let both = Polyhedron::new(points, &faces).unwrap().subdivided(2).unwrap();
    assert_eq!(euler(&both), 4);
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn the_bunny_is_smoothed_the_same_with_any_number_of_threads() {
    let start = Polyhedron::from_mesh(&crate::mesh::bunny().expect("it ships")).unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| start.subdivided(1).unwrap())
    };
    let [one, many] = [on(1), on(3)];
    assert_eq!(one, many);
    assert_linked(&one);
    assert_eq!(one.points.len(), 3 * 69_666);
}

/// The distance of a point from a triangle.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [[a, b], [b, c], [c, a]].iter().all(|[from, to]| normal.cross(*to - *from).dot(p - *from) >= 0.0);
    if inside && normal != DVec3::ZERO {
        return normal.normalize().dot(p - a).abs();
    }
    let along = |[from, to]: [DVec3; 2]| {
        let t = ((p - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        (p - from.lerp(to, t)).length()
    };
    [[a, b], [b, c], [c, a]].into_iter().map(along).fold(f64::INFINITY, f64::min)
}

/// Tessellates, and proves that no point of a far finer limit is farther away than the tolerance.
fn assert_within(start: &Polyhedron, tolerance: f64, fine_steps: usize) -> crate::mesh::Mesh {
    let mesh = start.tessellated(tolerance).unwrap();
    let fine = start.subdivided(fine_steps).unwrap().limit().unwrap();
    let mut worst = 0.0_f64;
    for point in fine.vertices.iter().step_by(7) {
        let near = (0..mesh.triangles.len()).map(|t| distance(*point, mesh.corners(t))).fold(f64::INFINITY, f64::min);
        worst = worst.max(near);
    }
    assert!(worst <= tolerance, "{worst} is more than {tolerance}");
    assert!(mesh.triangles.iter().all(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
    mesh
}

#[test]
fn tessellation_keeps_the_tolerance_without_cracks() {
    for (start, tolerance) in [(cube(), 0.01), (solid(3, true), 0.02), (solid(9, false), 0.01), (torus(4, 3), 0.01)] {
        let mesh = assert_within(&start, tolerance, 3);
        assert!(mesh.is_closed(), "{:?}", mesh.edge_report());
        assert!(start.tessellated(tolerance / 4.0).unwrap().triangles.len() > 2 * mesh.triangles.len());
    }
    for sharpness in [0.5, 1.5, f64::INFINITY] {
        assert!(assert_within(&cup(sharpness), 0.01, 4).is_closed());
    }
    let mut pointed = solid(5, false);
    pointed.sharpen_vertex(5, f64::INFINITY).unwrap();
    assert!(assert_within(&pointed, 0.01, 4).is_closed());
    let mut slit = torus(6, 6);
    slit.sharpen_edge([9, 10], f64::INFINITY).unwrap();
    assert!(slit.tessellated(0.01).unwrap().is_closed());
    let open = assert_within(&sheet(5, 4), 0.003, 4);
    // One closed border and a disk.
    let report = open.edge_report();
    assert_eq!((report.non_manifold, report.misoriented), (0, 0));
    assert_eq!(open.vertices.len() + open.triangles.len() - report.edges, 1);
}

#[test]
fn any_valence_and_vertices_that_coincide_are_taken() {
    for n in (3..=64).step_by(7).chain([64]) {
        for (prism, sharpness) in [(false, 0.7), (false, 2.0), (true, 0.7), (true, 2.0)] {
            let mut start = solid(n, prism);
            start.sharpen_creases(2.0, sharpness).unwrap();
            // An edge without length, and all in one point.
            let mut short = start.clone();
            short.points[1] = short.points[0];
            let mut point = start.clone();
            point.points.fill(DVec3::X);
            for polyhedron in [start, short, point] {
                let mesh = polyhedron.tessellated(0.05).unwrap();
                assert_eq!(mesh.edge_report().boundary, 0, "{n} {prism} {sharpness}");
                let bounds = mesh.bounds().unwrap();
                assert!(
                    bounds.min.cmpge(DVec3::splat(-1.0 - 1e-12)).all()
                        && bounds.max.cmple(DVec3::splat(1.0 + 1e-12)).all()
                );
                assert!(mesh.corner_normals.iter().flatten().all(|n| n.is_finite() && n.length() < 1.0 + 1e-9));
            }
        }
    }
}

#[test]
fn the_distance_of_triangles_from_the_limit_is_measured() {
    for tolerance in [0.1, 0.01] {
        let start = solid(5, true);
        let found = start.distance(&start.tessellated(tolerance).unwrap(), tolerance).unwrap();
        assert!((tolerance / 10.0..=tolerance).contains(&found), "{found} of {tolerance}");
    }
    let mut start = cube();
    start.sharpen_creases(30.0, f64::INFINITY).unwrap();
    let mut wider = start.tessellated(0.1).unwrap();
    assert_eq!(start.distance(&wider, 0.1).unwrap(), 0.0);
    wider.vertices.iter_mut().for_each(|p| *p *= 1.5);
    // Its corners are farther from the cube than its faces.
    assert_eq!(start.distance(&wider, 0.1).unwrap(), 0.75_f64.sqrt());
}

#[test]
fn flat_parts_stay_coarse() {
    // A wide flat sheet with a bump in one corner.
    let mut start = sheet(30, 30);
    start.points.iter_mut().for_each(|p| p.z = 0.0);
    start.points[5 + 5 * 30].z = 1.0;
    let mesh = start.tessellated(1e-3).unwrap();
    let is_flat = |t: &usize| mesh.corners(*t).iter().all(|p| p.x > 9.0 || p.y > 9.0);
    let flat = (0..mesh.triangles.len()).filter(is_flat).count();
    // Two a vertex of the polyhedron after the first step, and hundreds for the bump.
    assert!(flat < 2 * 4 * 29 * 29 && mesh.triangles.len() > flat + 1000, "{flat} of {}", mesh.triangles.len());
}

#[test]
fn a_tolerance_must_be_positive_and_may_be_refused() {
    assert_eq!(cube().tessellated(0.0).unwrap_err(), SubdivisionError::Tolerance { tolerance: 0.0 });
    assert!(matches!(cube().tessellated(f64::NAN), Err(SubdivisionError::Tolerance { .. })));
}

#[test]
fn any_sharpness_and_any_holes_keep_the_surface_whole() {
    let mut stream = RandomStream::new(9, 0);
    for round in 0..120 {
        let whole = match round % 3 {
            0 => cube().subdivided(1).unwrap(),
            1 => solid(3 + round % 7, round % 2 == 0),
            _ => torus(4, 5),
        };
        let missing = if round % 2 == 0 { 0.0 } else { 0.2 };
        let faces: Vec<&[u32]> = whole.faces().filter(|_| stream.uniform() >= missing).collect();
        let mut start = Polyhedron::new(whole.points.clone(), &faces).unwrap();
        let sharpness = [0.5, 1.0, 1.7, f64::INFINITY];
        for face in &faces {
            if stream.uniform() < 0.3 {
                start.sharpen_edge([face[0], face[1]], sharpness[stream.below(4)]).unwrap();
            }
        }
        start.sharpen_vertex(stream.below(5) as u32, sharpness[stream.below(4)]).unwrap();
        let found = start.subdivided(2).unwrap();
        assert_eq!(found.is_closed(), start.is_closed(), "{round}");
        for mesh in [start.limit().unwrap(), found.limit().unwrap(), start.tessellated(0.05).unwrap()] {
            assert!(mesh.vertices.iter().all(|p| p.is_finite()), "{round}");
            assert!(mesh.corner_normals.iter().flatten().all(|n| n.is_finite()), "{round}");
            let mut sides = HashMap::new();
            for t in &mesh.triangles {
                (0..3).for_each(|k| *sides.entry([t[k], t[(k + 1) % 3]]).or_insert(0) += 1);
            }
            let border = sides.keys().filter(|[a, b]| !sides.contains_key(&[*b, *a])).count();
            assert!(sides.values().all(|&count| count == 1), "{round}");
            assert_eq!(border == 0, start.is_closed(), "{round}: {border}");
        }
    }
}
