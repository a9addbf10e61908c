//! Rounded edges against closed forms.

use glam::{DAffine3, DVec2, DVec3};

use super::*;
use crate::solid::primitive::{block, cylinder, prism};
use crate::solid::{Body, Expression};
use crate::surface::Tolerance;

fn solid(body: Body) -> ExactSolid {
    body.solid(Tolerance::new(0.05, 45.0)).unwrap()
}

fn turned(body: Body) -> ExactSolid {
    solid(body).transformed(&(DAffine3::from_rotation_y(0.4) * DAffine3::from_rotation_x(1.1))).unwrap()
}

fn volume(solid: &ExactSolid) -> f64 {
    solid.solid().mesh().signed_volume()
}

/// What a rounded edge takes off its section.
fn section(radius: f64, turn: f64) -> f64 {
    let setback = radius * (0.5 * turn).tan();
    setback * setback * turn.sin() / 6.0
}

#[test]
fn one_edge_of_a_block_loses_the_section_of_a_parabola() {
    let size = DVec3::new(4.0, 3.0, 2.0);
    let block = solid(block(size).unwrap());
    for (radius, edge, length) in [
        (0.5, DVec3::new(0.0, 1.5, 1.0), 4.0),
        (0.4, DVec3::new(2.0, 0.0, -1.0), 3.0),
        (0.2, DVec3::new(-2.0, 1.5, 0.0), 2.0),
    ] {
        let lost = |tolerance: f64| {
            let round = block.rounded(&EdgeChoice::Nearest(vec![edge]), radius, tolerance).unwrap();
            24.0 - volume(&round)
        };
        let exact = length * section(radius, 0.5 * std::f64::consts::PI);
        let (coarse, fine) = (lost(1e-2) - exact, lost(2e-4) - exact);
        // The triangles lie within the convex rounding.
        assert!(coarse > 0.0 && coarse < 1e-2 * 2.0 * radius * length, "{coarse}");
        assert!(fine > 0.0 && fine < 2e-4 * 2.0 * radius * length, "{fine:e}");
    }
}

#[test]
fn the_section_is_a_parabola_whose_ends_touch_the_faces() {
    let round = solid(block(DVec3::splat(4.0)).unwrap())
        .rounded(&EdgeChoice::Nearest(vec![DVec3::new(2.0, 2.0, 0.0)]), 0.5, 1e-3)
        .unwrap();
    let mesh = round.solid().mesh();
    let mut on_parabola = 0;
    for p in &mesh.vertices {
        let (x, y) = (2.0 - p.x, 2.0 - p.y);
        if x < 0.5 && y < 0.5 {
            on_parabola += 1;
            assert!(((x / 0.5).max(0.0).sqrt() + (y / 0.5).max(0.0).sqrt() - 1.0).abs() < 1e-7, "{p}");
        }
        assert!(p.abs().max_element() <= 2.0);
    }
    assert!(on_parabola > 12);
    let bounds = mesh.bounds().unwrap();
    assert_eq!([bounds.min, bounds.max], [DVec3::splat(-2.0), DVec3::splat(2.0)]);
}

#[test]
fn upright_edges_of_a_prism_are_rounded_whatever_their_angle() {
    let outline = [[0.0, 0.0], [5.0, 0.0], [6.0, 3.0], [2.5, 2.0], [0.0, 4.0]].map(DVec2::from_array);
    let body = || prism(&[outline.to_vec()], [0.0, 2.0]).unwrap();
    let radius = 0.3;
    let near: Vec<DVec3> = outline.iter().map(|p| p.extend(1.0)).collect();
    let (sharp, round) = (solid(body()), solid(body()).rounded(&EdgeChoice::Nearest(near), radius, 2e-4).unwrap());
    let lost: f64 = (0..5)
        .map(|k| {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| outline[k % 5]);
            let turn = (b - a).angle_to(c - b);
            turn.signum() * section(radius, turn.abs())
        })
        .sum();
    assert!(
        (volume(&sharp) - volume(&round) - 2.0 * lost) < 2e-4 * 10.0,
        "{} {}",
        volume(&sharp) - volume(&round),
        2.0 * lost
    );
    assert!(outline.iter().any(|_| lost > 0.0));
}

#[test]
fn all_edges_and_corners_of_a_block_are_rounded_alike() {
    for radius in [0.05, 0.2, 0.45] {
        let whole = volume(&turned(block(DVec3::splat(2.0)).unwrap()));
        let round = turned(block(DVec3::splat(2.0)).unwrap()).rounded(&EdgeChoice::All, radius, 2e-3 * radius).unwrap();
        let lost = whole - volume(&round);
        // Where three strips meet more is taken off than three edges that end there, and less than edges to the corner.
        let of_edges = |length: f64| 12.0 * length * section(radius, 0.5 * std::f64::consts::PI);
        assert!(lost > of_edges(2.0 - 2.0 * radius) && lost < of_edges(2.0), "{radius}: {lost} {}", of_edges(2.0));
        let mass = round.solid().mass();
        assert!(mass.centroid.length() < 1e-3 * radius);
        // The corner lies on the diagonal, and its normal, too.
        let diagonal = DAffine3::from_rotation_y(0.4) * DAffine3::from_rotation_x(1.1);
        let corner = diagonal.transform_vector3(DVec3::ONE).normalize();
        let mesh = round.solid().mesh();
        let farthest = mesh.vertices.iter().map(|p| p.dot(corner)).fold(0.0, f64::max);
        assert!(farthest < 3.0_f64.sqrt() - 0.5 * radius && farthest > 3.0_f64.sqrt() - 1.5 * radius, "{farthest}");
    }
}

#[test]
fn a_chain_of_edges_and_a_plate_with_a_hole_are_rounded() {
    let square =
        |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]].map(DVec2::from_array).to_vec();
    let plate = || prism(&[square(4.0), square(1.5)], [0.0, 1.0]).unwrap();
    let rim = |half: f64, z: f64| {
        let side = |x: f64, y: f64| DVec3::new(x * half, y * half, z);
        vec![side(1.0, 0.0), side(0.0, 1.0), side(-1.0, 0.0), side(0.0, -1.0)]
    };
    let quarter = section(0.2, 0.5 * std::f64::consts::PI);
    for (near, lengths, corners) in [(rim(4.0, 1.0), 32.0, 4.0), (rim(1.5, 0.0), 12.0, 4.0)] {
        let round = solid(plate()).rounded(&EdgeChoice::Nearest(near), 0.2, 3e-4).unwrap();
        let lost = 55.0 - volume(&round);
        assert!((lost - lengths * quarter).abs() < corners * 0.2_f64.powi(3), "{lost} {}", lengths * quarter);
    }
    let all = solid(plate()).rounded(&EdgeChoice::All, 0.2, 2e-3).unwrap();
    assert!(volume(&all) < 55.0);
    assert_eq!(all.solid().mesh().edge_report().euler_characteristic(), 0, "a ring stays a ring");
}

#[test]
fn what_cannot_be_rounded_is_refused_with_the_place() {
    let cube = solid(block(DVec3::splat(2.0)).unwrap());
    let fault = |radius: f64| cube.rounded(&EdgeChoice::All, radius, 1e-3).err().unwrap().to_string();
    assert!(fault(0.5).starts_with("radius 0.5 is too large beside the edge from ["), "{}", fault(0.5));
    assert!(fault(0.0).starts_with("radius 0 is not a length"));
    assert!(fault(f64::NAN).contains("not a length"));
    let tube = solid(cylinder(1.0, 2.0).unwrap());
    let error = tube.rounded(&EdgeChoice::All, 0.1, 1e-3).err().unwrap();
    assert!(error.to_string().ends_with("is not between two flat faces"), "{error}");
    let ell = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(DVec2::from_array);
    let ell = solid(prism(&[ell.to_vec()], [0.0, 1.0]).unwrap());
    let one = EdgeChoice::Nearest(vec![DVec3::new(1.5, 1.0, 1.0)]);
    assert!(ell.rounded(&one, 0.1, 1e-3).err().unwrap().to_string().contains("hollow"));
    assert!(ell.rounded(&EdgeChoice::All, 0.1, 1e-3).is_ok());
}

#[test]
fn faces_keep_their_surfaces_and_each_rounded_edge_has_its_own() {
    let block = turned(block(DVec3::new(4.0, 3.0, 2.0)).unwrap());
    let count = block.surfaces().len();
    let round = block.rounded(&EdgeChoice::All, 0.3, 1e-3).unwrap();
    let mesh = round.solid().mesh();
    assert_eq!((count, round.surfaces().len()), (6, 6 + 12));
    let mut areas = vec![0.0; round.surfaces().len()];
    for triangle in 0..mesh.triangles.len() {
        let surface = mesh.surfaces[triangle] as usize;
        areas[surface] += mesh.area_vector(triangle).length();
        let Some(exact) = &round.surfaces()[surface] else { continue };
        for (corner, point) in mesh.corners(triangle).into_iter().enumerate() {
            let (uv, normal) = (mesh.corner_parameters[triangle][corner], mesh.corner_normals[triangle][corner]);
            assert!(exact.point(uv).distance(point) < 1e-9 && exact.normal(uv).distance(normal) < 1e-12);
        }
    }
    // What the rounding leaves of two faces of 4 by 3, 4 by 2 and 3 by 2; less at the corners.
    let mut faces = areas[..6].to_vec();
    faces.sort_by(f64::total_cmp);
    for (area, whole) in faces.iter().zip([2.4 * 1.4, 2.4 * 1.4, 3.4 * 1.4, 3.4 * 1.4, 3.4 * 2.4, 3.4 * 2.4]) {
        assert!(*area <= whole * (1.0 + 1e-9) && *area > 0.9 * whole, "{area} {whole}");
    }
    assert!(areas[6..].iter().all(|area| *area > 0.2));
}

#[test]
fn curved_faces_that_stay_keep_their_normals() {
    let drill = solid(cylinder(0.5, 4.0).unwrap());
    let whole = solid(block(DVec3::splat(3.0)).unwrap());
    let expression = Expression::difference(Expression::Operand(0), Expression::Operand(1));
    let (drilled, _) = ExactSolid::evaluate(&[&whole, &drill], &expression).unwrap();
    let upright = [[1.5, 1.5], [1.5, -1.5], [-1.5, 1.5], [-1.5, -1.5]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let round = drilled.rounded(&EdgeChoice::Nearest(upright.to_vec()), 0.2, 1e-3).unwrap();
    let mesh = round.solid().mesh();
    let mut curved = 0;
    for (normals, triangle) in mesh.corner_normals.iter().zip(0..) {
        for (normal, point) in normals.iter().zip(mesh.corners(triangle)) {
            let flat = DVec2::new(point.x, point.z);
            if flat.length() < 0.51 && normal.y.abs() < 0.5 {
                curved += 1;
                let exact = -flat.normalize();
                assert!(DVec2::new(normal.x, normal.z).distance(exact) < 1e-9, "{normal} {point}");
            }
        }
    }
    assert!(curved > 50);
}

#[test]
fn there_are_no_triangles_without_width() {
    let block = solid(block(DVec3::new(4.0, 0.5, 2.8)).unwrap());
    let upright = [[2.0, 1.4], [2.0, -1.4], [-2.0, 1.4], [-2.0, -1.4]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let round = block.rounded(&EdgeChoice::Nearest(upright.to_vec()), 0.6, 1e-3).unwrap();
    let mesh = round.solid().mesh();
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!(mesh.area_vector(triangle).length() > 1e-9 * longest * longest, "{a} {b} {c}");
    }
}
