//! Meshes that are no solids, and what becomes of them.

use super::*;
use crate::surface::{Sphere, Tolerance, box_faces, tessellate};
use glam::DVec3;

fn block(low: DVec3, high: DVec3) -> Mesh {
    let faces = tessellate(&box_faces(low, high), Tolerance::new(1.0, 90.0)).unwrap();
    Mesh { vertices: faces.vertices, triangles: faces.triangles, ..Mesh::default() }.welded()
}

fn cube(low: f64, high: f64) -> Mesh {
    block(DVec3::splat(low), DVec3::splat(high))
}

fn ball() -> Mesh {
    let ball = tessellate(&[Sphere::new(DVec3::ZERO, 1.0)], Tolerance::new(0.01, 90.0)).unwrap();
    Mesh { vertices: ball.vertices, triangles: ball.triangles, ..Mesh::default() }
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh, 0));
    all
}

/// The volume of what a mesh becomes, and what was done.
fn repaired(mesh: &Mesh) -> (f64, Repair) {
    let (solid, repair) = Solid::repaired(mesh.clone()).unwrap_or_else(|error| panic!("{error}"));
    Solid::new(solid.mesh().clone()).expect("what was repaired is a solid");
    (solid.mesh().signed_volume(), repair)
}

fn without(mesh: &Mesh, is_left_out: impl Fn([DVec3; 3]) -> bool) -> Mesh {
    let kept = (0..mesh.triangles.len()).filter(|&t| !is_left_out(mesh.corners(t)));
    Mesh { triangles: kept.map(|t| mesh.triangles[t]).collect(), ..mesh.clone() }
}

#[test]
fn holes_turned_and_double_triangles_are_put_right() {
    let ball = ball();
    let volume = ball.signed_volume();
    let mut broken = ball.clone();
    for index in (3..90).step_by(7) {
        broken.triangles[index].swap(0, 1);
    }
    broken.triangles.swap_remove(40);
    broken.triangles.push(broken.triangles[5]);
    let (found, repair) = repaired(&broken);
    assert!((found - volume).abs() < 1e-14);
    assert_eq!(repair, Repair { duplicates: 1, reoriented: 13, loops: 1, added: 1, ..Repair::default() });
    assert_eq!(repaired(&ball.clone().reversed()), (volume, Repair { bodies: 1, ..Repair::default() }));
}

#[test]
fn what_is_a_solid_is_not_touched() {
    let mut back_to_back = cube(0.0, 1.0);
    back_to_back.append(&block(DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 1.0)), 0);
    let mut touching = cube(0.0, 1.0);
    touching.append(&cube(1.0, 2.0), 0);
    let mut hollow = cube(0.0, 3.0);
    hollow.append(&cube(1.0, 2.0).reversed(), 0);
    for mesh in [back_to_back.clone(), back_to_back.welded(), touching.clone(), touching.welded(), hollow] {
        assert!(repaired(&mesh).1.is_nothing());
    }
}

#[test]
fn a_body_that_faces_inwards_is_turned_and_the_wall_of_a_cavity_is_not() {
    let beside = block(DVec3::new(5.0, 0.0, 0.0), DVec3::new(6.0, 1.0, 1.0)).reversed();
    let touching = block(DVec3::new(0.0, 3.0, 0.0), DVec3::splat(3.0) + DVec3::Y).reversed();
    let (cavity, inner) = (cube(1.0, 2.0).reversed(), cube(1.2, 1.8).reversed());
    for (mesh, volume, bodies) in [
        (joined(&[cube(0.0, 3.0), beside.clone()]), 28.0, 1),
        (joined(&[cube(0.0, 3.0), touching.clone()]), 36.0, 1),
        (joined(&[cube(0.0, 3.0), cavity.clone(), beside.clone()]), 27.0, 1),
        (joined(&[cube(0.0, 3.0), cavity.clone(), inner]), 26.0 + 0.216, 1),
        (joined(&[cube(0.0, 3.0).reversed(), beside.clone()]), 28.0, 2),
        (joined(&[cube(0.0, 3.0).reversed(), beside.reversed()]), 28.0, 1),
        (joined(&[cube(0.0, 3.0).reversed(), cavity.reversed()]), 26.0, 2),
    ] {
        let Err(refused) = Solid::resolved(mesh.clone()) else { panic!("{volume} {bodies}") };
        assert!(matches!(refused, SolidError::InsideOut { .. }), "{refused}");
        let (found, repair) = repaired(&mesh);
        assert!((found - volume).abs() < 1e-12, "{found} is not {volume}");
        assert_eq!(repair.bodies, bodies);
    }
}

#[test]
fn a_tube_without_ends_gets_ends_with_holes() {
    let (outer, inner) = (block(DVec3::splat(-2.0), DVec3::splat(2.0)), cube(-1.0, 1.0));
    let inner = Mesh { vertices: inner.vertices.iter().map(|v| *v * DVec3::new(1.0, 1.0, 2.0)).collect(), ..inner };
    let is_end = |corners: [DVec3; 3]| corners.iter().all(|v| v.z == corners[0].z);
    let tube = joined(&[without(&outer, is_end), without(&inner.reversed(), is_end)]);
    let (volume, repair) = repaired(&tube);
    assert!((volume - (64.0 - 16.0)).abs() < 1e-12, "{volume}");
    assert_eq!(repair, Repair { loops: 4, added: 16, ..Repair::default() });
}

#[test]
fn a_loop_that_is_not_flat_is_closed_without_meeting_the_surface() {
    // A ball that lost a saddle of its surface.
    let ball = ball();
    let open = without(&ball, |corners| {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        middle.z > 0.5 + 0.3 * (2.0 * middle.y.atan2(middle.x)).sin()
    });
    let (volume, repair) = repaired(&open);
    assert_eq!(repair.loops, 1);
    assert!(volume > 0.5 * ball.signed_volume() && volume < ball.signed_volume());
}

#[test]
fn loops_that_no_patch_closes_are_named() {
    // A sheet that is closed by itself only.
    let sheet = Mesh { vertices: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y], ..Mesh::default() };
    let sheet = Mesh { triangles: vec![[0, 1, 2]], ..sheet };
    let refused = Solid::repaired(sheet).map(|_| ()).unwrap_err();
    let SolidError::Open { loops } = &refused else { panic!("{refused}") };
    assert_eq!((loops.len(), loops[0].edges), (1, 3));
    assert!(refused.to_string().contains("3 edges"), "{refused}");
}

#[test]
fn walls_within_a_body_and_fins_are_left_out() {
    let mut walled = block(DVec3::ZERO, DVec3::new(1.0, 1.0, 1.0));
    walled.append(&block(DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 1.0)), 0);
    // The wall between two cubes once, and not back to back.
    let mut walls = 0;
    let keep: Vec<bool> = (0..walled.triangles.len())
        .map(|t| {
            let is_wall = walled.corners(t).iter().all(|v| v.x == 1.0);
            walls += usize::from(is_wall);
            !is_wall || walls <= 2
        })
        .collect();
    super::super::cleaning::retain(&mut walled, &keep);
    let (volume, repair) = repaired(&walled.welded());
    assert_eq!((volume, repair), (2.0, Repair { dangling: 2, ..Repair::default() }));
    let mut finned = cube(0.0, 1.0);
    finned.vertices.push(DVec3::splat(3.0));
    finned.triangles.push([finned.triangles[0][0], finned.triangles[0][1], finned.vertices.len() as u32 - 1]);
    assert_eq!(repaired(&finned), (1.0, Repair { dangling: 1, ..Repair::default() }));
}

#[test]
fn a_surface_that_bounds_nothing_is_refused() {
    let mut double = cube(0.0, 1.0);
    double.triangles.truncate(1);
    double.append(&double.clone().reversed(), 0);
    assert_eq!(Solid::resolved(double.clone()).map(|_| ()).unwrap_err(), SolidError::BoundsNothing);
    assert!(matches!(Solid::repaired(double), Err(SolidError::Open { .. })));
    // A cube of which each triangle is there twice, to be seen from both sides.
    let double = joined(&[cube(0.0, 1.0), cube(0.0, 1.0).reversed()]);
    assert_eq!(repaired(&double), (1.0, Repair { duplicates: 12, ..Repair::default() }));
}

#[test]
fn crossing_parts_become_one_and_a_strip_with_one_side_is_refused() {
    let (volume, repair) = repaired(&joined(&[cube(0.0, 1.0), cube(0.5, 1.5)]));
    assert!((volume - 1.875).abs() < 1e-15);
    assert_eq!(repair, Repair { is_resolved: true, ..Repair::default() });
    // Five triangles in a ring, each sharing an edge with the next: a Moebius strip.
    let vertices = (0..5).map(|k| DVec3::new(f64::from(k).cos(), f64::from(k).sin(), f64::from(k * k % 3))).collect();
    let triangles = (0..5).map(|k| [k, (k + 1) % 5, (k + 2) % 5]).collect();
    let strip = Mesh { vertices, triangles, ..Mesh::default() };
    assert!(matches!(Solid::repaired(strip), Err(SolidError::NotClosed { .. })));
}
