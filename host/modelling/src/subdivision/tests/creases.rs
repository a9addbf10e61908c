//! Creases and sharp vertices: the curves that they follow, and the rounding that finite sharpness leaves.

use std::collections::HashSet;

use super::*;

#[test]
fn a_cube_of_sharp_edges_stays_a_cube() {
    let mut start = cube();
    start.sharpen_creases(30.0, f64::INFINITY).unwrap();
    for steps in 0..3 {
        let limit = start.subdivided(steps).unwrap().limit().unwrap();
        assert!(limit.is_closed());
        assert_eq!((limit.triangles.len(), limit.signed_volume()), (12, 8.0));
        assert!(limit.corner_normals.iter().flatten().all(|normal| normal.abs().max_element() == 1.0));
    }
}

#[test]
fn a_crease_is_the_b_spline_of_its_edges_and_both_sides_meet_in_it() {
    let start = cup(f64::INFINITY);
    let mut rim = [4, 5, 7, 6].map(|k| start.points[k]).to_vec();
    for steps in 1..5 {
        rim = chaikin(&rim);
        let found = start.subdivided(steps).unwrap();
        assert!(found.is_closed());
        assert_linked(&found);
        let top: Vec<DVec3> = found.points.iter().copied().filter(|p| p.z == 1.0).collect();
        assert!(rim.iter().all(|p| top.iter().any(|q| (*q - *p).length() < 1e-15)));
        let limit = found.limit().unwrap();
        assert!(limit.is_closed());
        let middle = (rim[0] + rim[1]) * 0.5;
        assert!(limit.vertices.iter().any(|p| (*p - middle).length() < 1e-15));
        // On the rim the normals are those of the flat top, and others.
        assert_eq!(euler(&found), 2);
        let at_rim = |t: usize| {
            limit.triangles[t]
                .iter()
                .zip(limit.corner_normals[t])
                .filter(|(v, _)| (limit.vertices[**v as usize] - middle).length() < 1e-15)
                .map(|(_, n)| n)
                .collect::<Vec<_>>()
        };
        let normals: Vec<DVec3> = (0..limit.triangles.len()).flat_map(at_rim).collect();
        assert!(normals.iter().any(|n| n.z == 1.0) && normals.iter().any(|n| n.z < 0.9));
    }
}

#[test]
fn finite_sharpness_comes_to_the_sharp_surface_as_it_grows() {
    let volume = |sharpness| cup(sharpness).subdivided(4).unwrap().limit().unwrap().signed_volume();
    let volumes: Vec<f64> = (0..=16).map(|k| volume(f64::from(k) * 0.25)).collect();
    assert_eq!(volumes[0], cube().subdivided(4).unwrap().limit().unwrap().signed_volume());
    // Each step that the crease lasts longer brings it nearer to the one that lasts for ever.
    let last = volume(f64::INFINITY);
    let far = |steps: usize| (volumes[4 * steps] - last).abs();
    assert!(far(1) > far(2) && far(2) > far(3) && far(3) > far(4), "{volumes:?} {last}");
}

#[test]
fn each_unit_of_sharpness_halves_the_rounding_of_a_cube() {
    for quarters in 0..=12 {
        let sharpness = f64::from(quarters) * 0.25;
        let mut start = cube();
        start.sharpen_creases(30.0, sharpness).unwrap();
        let limit = start.subdivided(sharpness.ceil() as usize + 1).unwrap().limit().unwrap();
        assert!(limit.is_closed());
        let far = |way: DVec3| limit.vertices.iter().map(|p| p.dot(way.normalize())).fold(f64::MIN, f64::max);
        // Across an edge the parabola of the middles of three points: a quarter of the way to its chord is an eighth of
        // either side. At a vertex, a third of the fourth that is cut, in three directions.
        let [edge, vertex] = [DVec3::new(1.0, 1.0, 0.0), DVec3::ONE].map(|way| way.length() - far(way));
        let scale = (-sharpness).exp2();
        assert!((edge - 2.0_f64.sqrt() / 4.0 * scale).abs() < 1e-12, "{sharpness}: {edge}");
        assert!((vertex - 3.0_f64.sqrt() / 3.0 * scale).abs() < 1e-12, "{sharpness}: {vertex}");
        // Faces are flat where the rounding has not begun.
        assert!(limit.vertices.iter().all(|p| p.abs().max_element() <= 1.0 + 1e-15));
        let is_inside = |p: &&DVec3| p.z > 0.0 && p.x.abs().max(p.y.abs()) <= 1.0 - scale;
        let flat: Vec<&DVec3> = limit.vertices.iter().filter(is_inside).collect();
        assert!(sharpness < 1.0 || sharpness.fract() > 0.0 || flat.len() > 3 && flat.iter().all(|p| p.z > 1.0 - 1e-15));
    }
}

#[test]
fn a_sharp_cube_keeps_the_symmetry_of_the_cube() {
    for sharpness in [0.5, 1.0, 2.0, 2.5] {
        let mut start = cube();
        start.sharpen_creases(30.0, sharpness).unwrap();
        let limit = start.tessellated(0.02).unwrap();
        let cells: HashSet<[i64; 3]> =
            limit.vertices.iter().map(|p| (*p * 1e9).round().as_i64vec3().to_array()).collect();
        assert!(cells.iter().all(|[x, y, z]| cells.contains(&[*y, *z, *x]) && cells.contains(&[-*y, *x, *z])));
    }
}

#[test]
fn a_cap_follows_its_rim_more_closely_with_each_unit_of_sharpness() {
    let gap = |sharpness: usize| {
        let limit = cup(sharpness as f64).subdivided(sharpness + 2).unwrap().limit().unwrap();
        assert!(limit.is_closed());
        let way = DVec3::new(0.0, 1.0, 1.0).normalize();
        limit.vertices.iter().map(|p| 2.0_f64.sqrt() - p.dot(way)).fold(f64::INFINITY, f64::min)
    };
    for sharpness in 1..3 {
        let ratio = gap(sharpness) / gap(sharpness + 1);
        assert!((1.9..3.0).contains(&ratio), "{sharpness}: {ratio}");
    }
}

#[test]
fn only_finite_sharpness_divides_a_face() {
    // One edge of a cube of sharp edges is used up: the two faces at it have strips, the four others are whole.
    let mut start = cube();
    start.sharpen_creases(30.0, f64::INFINITY).unwrap();
    start.sharpen_edge([0, 1], 1.0).unwrap();
    let once = start.subdivided(1).unwrap();
    assert_eq!(once.face_count(), 4 + 2 * 4);
    let limit = start.tessellated(1e-3).unwrap();
    assert!(limit.is_closed());
    // Two faces at the far ends of the edge are cut at the corner, which leaves a parabola.
    assert!(limit.vertices.iter().all(|p| p.y + p.z >= -2.0 + 0.125 - 1e-12));
    assert!(limit.signed_volume() > 7.7);
}

#[test]
fn a_sharp_vertex_stays() {
    let mut start = solid(6, false);
    start.sharpen_vertex(6, f64::INFINITY).unwrap();
    for steps in 0..4 {
        let found = start.subdivided(steps).unwrap();
        assert!(found.points.contains(&DVec3::Z));
        assert_eq!(euler(&found), 2);
        let limit = found.limit().unwrap();
        assert!(limit.is_closed());
        assert!(limit.vertices.contains(&DVec3::Z));
        assert!(limit.vertices.iter().all(|p| p.z > -0.99));
    }
}

#[test]
fn a_crease_may_end_within_the_surface() {
    let mut start = torus(8, 8);
    start.sharpen_edge([9, 10], f64::INFINITY).unwrap();
    start.sharpen_edge([10, 11], f64::INFINITY).unwrap();
    for steps in 1..4 {
        let found = start.subdivided(steps).unwrap();
        assert!(found.is_closed());
        assert_eq!(euler(&found), 0);
        assert!(found.limit().unwrap().is_closed());
    }
}
