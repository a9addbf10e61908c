//! Surfaces that are simple, and each way in which one is not.

use super::*;
use glam::DAffine3;
use host::surface::{Sphere, Tolerance, box_faces, tessellate};

fn cube(low: f64, high: f64) -> Mesh {
    tessellate(&box_faces(DVec3::splat(low), DVec3::splat(high)), Tolerance::new(1.0, 90.0)).expect("a cube")
}

fn joined(one: &Mesh, two: &Mesh) -> Mesh {
    let mut both = one.clone();
    both.append(two, 0);
    both
}

fn shifted(mesh: &Mesh, by: DVec3) -> Mesh {
    mesh.transformed(&DAffine3::from_translation(by))
}

#[test]
fn solids_are_simple_where_they_touch_themselves_too() {
    let ball = tessellate(&[Sphere::new(DVec3::ZERO, 1.0)], Tolerance::new(0.02, 90.0)).expect("a ball");
    assert_eq!(check(&ball), Ok(()));
    let unit = cube(0.0, 1.0);
    for by in [DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::new(3.0, 0.0, 0.0)] {
        assert_eq!(check(&joined(&unit, &shifted(&unit, by))), Ok(()), "{by}");
    }
    // A cavity, and a body in it.
    let hollow = joined(&cube(-3.0, 3.0), &cube(-2.0, 2.0).reversed());
    assert_eq!(check(&hollow), Ok(()));
    assert_eq!(check(&joined(&hollow, &unit)), Ok(()));
    let tiny = unit.transformed(&DAffine3::from_scale(DVec3::splat(1e-200)));
    assert!(check(&joined(&unit, &tiny)).is_err());
}

#[test]
fn every_fault_is_found() {
    let unit = cube(0.0, 1.0);
    let mut open = unit.clone();
    open.triangles.pop();
    assert!(matches!(check(&open), Err(NotSimple::Open(_))));
    let mut flat = unit.clone();
    flat.vertices.push(DVec3::ZERO.midpoint(DVec3::X));
    flat.vertices.push(DVec3::ZERO);
    flat.vertices.push(DVec3::X);
    let last = flat.vertices.len() as u32;
    flat.triangles.push([last - 3, last - 2, last - 1]);
    assert!(matches!(check(&flat), Err(NotSimple::Flat(_))));
    // Into each other by much, by a rounding, at a corner and at an edge only; over half of a face; twice the same.
    for by in [
        DVec3::new(0.5, 0.4, 0.3),
        DVec3::splat(1.0 - f64::EPSILON),
        DVec3::new(1.0 - f64::EPSILON, 1.0 - f64::EPSILON, 0.0),
        DVec3::new(1.0, 0.5, 0.5),
        DVec3::X,
        DVec3::ZERO,
    ] {
        let both = joined(&unit, &shifted(&unit, by));
        assert!(matches!(check(&both), Err(NotSimple::Crossing { .. })), "{by}");
    }
    assert!(matches!(check(&joined(&cube(-1.0, 2.0), &unit)), Err(NotSimple::Winding { winding: 1, .. })));
    assert!(matches!(check(&unit.clone().reversed()), Err(NotSimple::Winding { winding: -1, .. })));
    let beside = joined(&unit, &shifted(&unit, DVec3::X * 3.0).reversed());
    assert!(matches!(check(&beside), Err(NotSimple::Winding { winding: -1, .. })));
}
