//! Trimmed surfaces against closed forms.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::{DVec2, DVec3};

use super::super::{Parallelogram, Sphere, Tolerance, chord_error, rational_torus, revolved};
use super::*;

/// A circle in the parameters, in four exact quarters from the x axis.
fn circle(center: DVec2, radius: f64) -> SplineCurve {
    let basis = Basis::b_spline(2, &[0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0]).unwrap();
    let square = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let points = square.map(|[x, y]| (center + DVec2::new(f64::from(x), f64::from(y)) * radius).extend(0.0));
    let weights: Vec<f64> = (0..9).map(|k| if k % 2 == 1 { FRAC_1_SQRT_2 } else { 1.0 }).collect();
    SplineCurve::new(basis, &points, &weights).unwrap()
}

fn edge(curve: SplineCurve) -> TrimEdge {
    TrimEdge { curve, shared: None }
}

fn line(from: DVec2, to: DVec2, shared: Option<usize>) -> TrimEdge {
    let ends = [from.extend(0.0), to.extend(0.0)];
    TrimEdge { curve: SplineCurve::new(Basis::bezier(1).unwrap(), &ends, &[]).unwrap(), shared }
}

/// A flat piece of 4 by 2 units.
fn plate() -> Parallelogram {
    Parallelogram::new(DVec3::new(1.0, 2.0, 3.0), DVec3::X * 4.0, DVec3::Y * 2.0)
}

#[test]
fn a_disc_in_a_plate_has_its_area_and_the_hole_lacks_it() {
    // The parameters of the plate run over the unit square: an ellipse there is a circle in space.
    let ellipse = circle(DVec2::splat(0.0), 1.0).transformed(&glam::DAffine3::from_scale_rotation_translation(
        DVec3::new(0.7 / 4.0, 0.7 / 2.0, 1.0),
        glam::DQuat::IDENTITY,
        DVec3::new(0.5, 0.5, 0.0),
    ));
    let exact = PI * 0.49;
    let holed = TrimmedSurface::with_holes(plate(), vec![vec![edge(ellipse.clone())]]).unwrap();
    let disc = TrimmedSurface::new(plate(), vec![vec![edge(ellipse)]]).unwrap();
    for chord in [0.1, 0.01, 1e-3, 1e-5] {
        let both = tessellate_trimmed(&[holed.clone(), disc.clone()], Tolerance::new(chord, 180.0)).unwrap();
        let area = |face: u32| -> f64 {
            let triangles = (0..both.triangles.len()).filter(|triangle| both.surfaces[*triangle] == face);
            triangles.map(|triangle| both.area_vector(triangle).z).sum()
        };
        // The outline is inscribed, within the chord.
        assert!(area(1) < exact && area(1) > exact - 2.0 * PI * 0.7 * chord, "{} {exact}", area(1));
        assert!((area(0) + area(1) - 8.0).abs() < 1e-13);
        let report = both.edge_report();
        assert_eq!((report.non_manifold, report.misoriented, report.degenerate), (0, 0, 0));
        assert_eq!(report.euler_characteristic(), 1);
        // Flat: no more triangles than the outline asks for.
        assert_eq!(both.vertices.len(), 4 + disc_corners(&both));
    }
}

/// The corners of the disc, face 1: a polygon of n corners has n - 2 triangles.
fn disc_corners(mesh: &crate::mesh::Mesh) -> usize {
    mesh.surfaces.iter().filter(|face| **face == 1).count() + 2
}

#[test]
fn the_inside_test_follows_the_curves_themselves() {
    let (center, radius) = (DVec2::new(0.4, 0.6), 0.25);
    let loops =
        vec![vec![edge(circle(center, radius))], vec![edge(circle(center, 0.1))], vec![edge(circle(center, 0.05))]];
    let trimmed = TrimmedSurface::new(plate(), loops).unwrap();
    for k in 0..360 {
        let ray = DVec2::from_angle(f64::from(k).to_radians());
        let there = [0.0, 0.0499999999, 0.0500000001, 0.0999999999, 0.1000000001, 0.2499999999, 0.2500000001, 0.3];
        let expected = [true, true, false, false, true, true, false, false];
        assert_eq!(there.map(|r| trimmed.contains(center + ray * r)), expected, "at {k} degrees");
    }
    // A wild rational piece: both sides of it differ.
    let points = [DVec3::ZERO, DVec3::new(0.9, 0.1, 0.0), DVec3::new(0.1, 0.9, 0.0), DVec3::new(1.0, 1.0, 0.0)];
    let wild = SplineCurve::new(Basis::bezier(3).unwrap(), &points, &[1.0, 1e6, 1e-3, 10.0]).unwrap();
    let corner = DVec2::X;
    let sides = [line(DVec2::ONE, corner, None), line(corner, DVec2::ZERO, None)];
    let trimmed = TrimmedSurface::new(plate(), vec![[vec![edge(wild.clone())], sides.to_vec()].concat()]).unwrap();
    for k in 1..50 {
        let t = f64::from(k) / 50.0;
        let (at, slope) = (wild.point(t).truncate(), wild.derivatives(t)[0].truncate().normalize());
        assert!(trimmed.contains(at - slope.perp() * 1e-7) && !trimmed.contains(at + slope.perp() * 1e-7), "{t}");
    }
}

#[test]
fn a_whole_sphere_is_closed_and_a_hole_in_it_takes_its_part() {
    let sphere = || Sphere::new(DVec3::new(0.3, 0.1, -2.0), 1.5);
    // A loop around the pole: the part above the latitude of 30 degrees has a quarter of the area.
    let latitude = |v: f64| line(DVec2::new(0.0, v), DVec2::new(1.0, v), None);
    for chord in [0.1, 0.02, 0.004] {
        let tolerance = Tolerance::new(chord, 180.0);
        let whole = tessellate_trimmed(&[TrimmedSurface::with_holes(sphere(), vec![]).unwrap()], tolerance).unwrap();
        let report = whole.edge_report();
        assert!(report.is_closed() && report.euler_characteristic() == 2, "{report:?}");
        let error = chord_error(&whole, &[sphere()], 8).unwrap().maximum;
        assert!(error <= chord && error > 0.3 * chord, "{error} for {chord}");
        let v = 30.0 / 360.0;
        let cap = vec![
            latitude(v),
            line(DVec2::new(1.0, v), DVec2::new(1.0, 0.25), None),
            line(DVec2::new(1.0, 0.25), DVec2::new(0.0, 0.25), None),
            line(DVec2::new(0.0, 0.25), DVec2::new(0.0, v), None),
        ];
        let cap = TrimmedSurface::new(sphere(), vec![cap]).unwrap();
        let mesh = tessellate_trimmed(&[cap], tolerance).unwrap();
        let exact = PI * 1.5 * 1.5;
        assert!(mesh.area() < exact && mesh.area() > exact * (1.0 - 2.0 * chord), "{} {exact}", mesh.area());
        assert_eq!(mesh.edge_report().euler_characteristic(), 1);
        // Holes away from the seam.
        let holes = [0.3, 0.7].map(|u| vec![edge(circle(DVec2::new(u, 0.05), 0.08))]).to_vec();
        let parts = [
            TrimmedSurface::with_holes(sphere(), holes.clone()).unwrap(),
            TrimmedSurface::new(sphere(), holes).unwrap(),
        ];
        let mesh = tessellate_trimmed(&parts, tolerance).unwrap();
        let report = mesh.edge_report();
        assert!(report.is_closed() && report.euler_characteristic() == 2, "{report:?}");
        let error = chord_error(&mesh, &[sphere(), sphere()], 8).unwrap().maximum;
        assert!(error <= chord, "{error} for {chord}");
    }
}

#[test]
fn faces_of_different_surfaces_share_an_edge_by_its_number() {
    let profile = |points: [[f64; 2]; 2]| {
        let points = points.map(|[x, y]| DVec3::new(x, y, 0.0));
        revolved(&SplineCurve::new(Basis::bezier(1).unwrap(), &points, &[]).unwrap()).unwrap()
    };
    // A can of radius 2 and height 3: the side is a surface of revolution, the caps are trimmed planes.
    let side = profile([[2.0, 0.0], [2.0, 3.0]]);
    let at = |u: f64, v: f64| DVec2::new(u, v);
    let outline = vec![
        line(at(0.0, 0.0), at(4.0, 0.0), Some(7)),
        line(at(4.0, 0.0), at(4.0, 1.0), Some(9)),
        line(at(4.0, 1.0), at(0.0, 1.0), Some(8)),
        line(at(0.0, 1.0), at(0.0, 0.0), Some(9)),
    ];
    let cap = |height: f64, shared: usize, flip: f64| {
        let origin = DVec3::new(-3.0, height, 3.0 * flip);
        let plane = Parallelogram::new(origin, DVec3::X * 6.0, DVec3::NEG_Z * 6.0 * flip);
        let mut curve = circle(at(0.5, 0.5), 2.0 / 6.0);
        if flip < 0.0 {
            curve = curve.transformed(&glam::DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)));
            curve = curve.transformed(&glam::DAffine3::from_translation(DVec3::Y));
        }
        let boxed: Box<dyn Surface> = Box::new(plane);
        TrimmedSurface::new(boxed, vec![vec![TrimEdge { curve, shared: Some(shared) }]]).unwrap()
    };
    let boxed: Box<dyn Surface> = Box::new(side);
    let faces = [TrimmedSurface::new(boxed, vec![outline]).unwrap(), cap(3.0, 8, 1.0), cap(0.0, 7, -1.0)];
    for chord in [0.1, 0.003] {
        let mesh = tessellate_trimmed(&faces, Tolerance::new(chord, 180.0)).unwrap();
        let report = mesh.edge_report();
        assert!(report.is_closed() && report.euler_characteristic() == 2, "{report:?}");
        let lost = 1.0 - mesh.signed_volume() / (12.0 * PI);
        assert!(lost > 0.0 && lost < chord, "{lost} for {chord}");
    }
}

#[test]
fn a_trimmed_torus_stays_within_the_tolerance_and_angle() {
    let torus = rational_torus(2.0, 0.7).unwrap();
    let hole = vec![edge(circle(DVec2::new(2.1, 1.8), 0.9))];
    let trimmed = [TrimmedSurface::with_holes(torus.clone(), vec![hole]).unwrap()];
    for (chord, angle) in [(0.05, 180.0), (0.01, 180.0), (10.0, 12.0)] {
        let mesh = tessellate_trimmed(&trimmed, Tolerance::new(chord, angle)).unwrap();
        let report = mesh.edge_report();
        assert_eq!((report.non_manifold, report.misoriented, report.euler_characteristic()), (0, 0, -1));
        let error = chord_error(&mesh, std::slice::from_ref(&torus), 6).unwrap().maximum;
        assert!(error <= chord, "{error} for {chord}");
        let turns =
            mesh.corner_normals.iter().flat_map(|n| [(0, 1), (1, 2), (2, 0)].map(|(a, b)| n[a].angle_between(n[b])));
        assert!(turns.fold(0.0, f64::max).to_degrees() <= angle * 1.001);
    }
}

#[test]
fn outlines_that_nearly_touch_are_made_finer_until_they_do_not_cross() {
    let turned = circle(DVec2::ZERO, 0.25 * (1.0 - 1e-5)).transformed(&glam::DAffine3::from_rotation_z(0.3));
    let inner = turned.transformed(&glam::DAffine3::from_translation(DVec3::new(0.5, 0.5, 0.0)));
    let loops = vec![vec![edge(circle(DVec2::splat(0.5), 0.25))], vec![edge(inner)]];
    let ring = [TrimmedSurface::new(plate(), loops).unwrap()];
    let mesh = tessellate_trimmed(&ring, Tolerance::new(0.1, 180.0)).unwrap();
    assert_eq!(mesh.edge_report().euler_characteristic(), 0);
    assert!((mesh.area() - PI / 2.0 * (1.0 - (1.0f64 - 1e-5).powi(2))).abs() < 1e-5, "{}", mesh.area());
}

#[test]
fn tolerances_too_fine_and_surfaces_that_are_not_finite_are_refused() {
    let sphere = [TrimmedSurface::with_holes(Sphere::new(DVec3::ZERO, 1.0), vec![]).unwrap()];
    for (chord, angle) in [(1e-30, 10.0), (0.1, 1e-9)] {
        let fault = tessellate_trimmed(&sphere, Tolerance::new(chord, angle)).unwrap_err();
        assert!(matches!(fault, TrimError::Tessellation(TessellationError::TooFine { surface: 0, .. })), "{fault}");
    }
    let broken = Parallelogram::new(DVec3::ZERO, DVec3::X, DVec3::splat(f64::NAN));
    let broken = [TrimmedSurface::with_holes(broken, vec![]).unwrap()];
    let fault = tessellate_trimmed(&broken, Tolerance::new(0.1, 10.0)).unwrap_err();
    assert!(matches!(fault, TrimError::Tessellation(TessellationError::NotFinite { surface: 0 })));
}

#[test]
fn bad_loops_are_refused_with_the_place() {
    let fault = |loops| TrimmedSurface::new(plate(), loops).unwrap_err().to_string();
    assert_eq!(fault(vec![vec![]]), "loop 0 has no edges");
    let open = vec![vec![edge(circle(DVec2::splat(0.5), 0.1))], vec![line(DVec2::ZERO, DVec2::X, None)]];
    assert_eq!(fault(open), "loop 1 does not close: edge 0 ends 1 away from where the next begins");
    let far = vec![vec![edge(circle(DVec2::new(0.9, 0.5), 0.2))]];
    assert!(fault(far).starts_with("edge 0 of loop 0 leaves the domain of the surface at (1.1"));
    let crossing = [0.4, 0.5].map(|u| vec![edge(circle(DVec2::new(u, 0.5), 0.2))]).to_vec();
    let crossing = [TrimmedSurface::with_holes(plate(), crossing).unwrap()];
    let fault = tessellate_trimmed(&crossing, Tolerance::new(0.01, 180.0)).unwrap_err();
    assert!(matches!(fault, TrimError::Crossing { face: 0, .. }), "{fault}");
    let fault = tessellate_trimmed(&crossing, Tolerance::new(0.0, 180.0)).unwrap_err();
    assert!(matches!(fault, TrimError::Tessellation(TessellationError::Tolerance { .. })));
}
