//! Spline surfaces: their patches, joints, locality, extremes, and how they are joined.

use glam::{DAffine3, DVec2, DVec3};

use super::join::Smoothness;
use super::*;
use crate::curve::{Basis, SplineError};

fn net(rows: usize, columns: usize) -> Vec<Vec<DVec3>> {
    let height = |i: usize, j: usize| ((i * 3 + j * 5) % 7) as f64 * 0.3;
    (0..rows).map(|i| (0..columns).map(|j| DVec3::new(i as f64, j as f64, height(i, j))).collect()).collect()
}

fn weights(rows: usize, columns: usize, spread: f64) -> Vec<Vec<f64>> {
    let weight = |i: usize, j: usize| spread.powf(((i * 5 + j * 3) % 7) as f64 / 3.0 - 1.0);
    (0..rows).map(|i| (0..columns).map(|j| weight(i, j)).collect()).collect()
}

fn bbb(count: usize, shift: usize) -> Basis {
    let list = |low: f64, step: f64, more: usize| -> Vec<f64> {
        (0..count + more).map(|k| low + step * ((k + shift) * 7 % 5) as f64).collect()
    };
    Basis::bbb(&list(0.5, 0.4, 0), &list(0.0, 2.0, 0), &list(0.5, 0.5, 1)).unwrap()
}

fn bbb_surface(spread: f64) -> SplineSurface {
    let weights = if spread == 1.0 { Vec::new() } else { weights(7, 8, spread) };
    SplineSurface::new(bbb(7, 0), bbb(8, 2), &net(7, 8), &weights).unwrap()
}

fn samples(surface: &dyn Surface, count: usize) -> Vec<DVec2> {
    let [low, high] = surface.domain();
    let at = |k: usize| DVec2::new((k % count) as f64, (k / count) as f64) / (count - 1) as f64;
    (0..count * count).map(|k| low + (high - low) * at(k)).collect()
}

#[test]
fn bbb_patches_meet_with_the_same_tangent_plane_and_curvature() {
    for spread in [1.0, 10.0] {
        let surface = bbb_surface(spread);
        let joints = continuity(surface.patches(), 17);
        let [rows, columns] = surface.patch_counts();
        assert_eq!(joints.len(), (rows - 1) * columns + rows * (columns - 1));
        for joint in joints {
            assert!(joint.gap == 0.0 && joint.angle < 1e-12_f64.to_degrees(), "{joint:?}");
            assert!(joint.curvature_difference < 1e-12 * joint.curvature.max(1.0), "{joint:?}");
        }
    }
}

#[test]
fn the_patches_of_the_teapot_meet_with_common_tangent_planes_but_not_with_common_curvatures() {
    let patches: Vec<TensorPatch> = teapot().iter().map(TensorPatch::from).collect();
    let joints = continuity(&patches, 9);
    assert_eq!(joints.len(), 52);
    assert!(joints.iter().all(|joint| joint.gap < 1e-15 && joint.angle < 1e-12), "{joints:?}");
    let differing = joints.iter().filter(|joint| joint.curvature_difference > 0.1 * joint.curvature);
    assert_eq!(differing.count(), 20);
}

#[test]
fn a_parameter_changes_the_patches_beside_its_joint_and_no_others() {
    let before = bbb_surface(3.0);
    let parameters = |changed: usize| {
        let mut bias = vec![1.0; 12];
        let tension = vec![0.5; 12];
        bias[changed] = 4.0;
        (bias, tension)
    };
    let (bias, tension) = parameters(6);
    let surface = |bias: &[f64]| {
        let u = Basis::bbb(bias, &tension, &[1.0; 13]).unwrap();
        SplineSurface::new(u, bbb(8, 2), &net(12, 8), &weights(12, 8, 3.0)).unwrap()
    };
    let (plain, other) = (surface(&[1.0; 12]), surface(&bias));
    let columns = plain.patch_counts()[1];
    for (k, (a, b)) in plain.patches().iter().zip(other.patches()).enumerate() {
        // The span of row r begins in joint r + 1; joint 6 changes those that begin in the joints 4 to 7.
        assert_eq!(a == b, !(3..=6).contains(&(k / columns)), "{k}");
    }
    assert_eq!(before.patches().len(), 4 * 5);
}

#[test]
fn surfaces_keep_their_points_when_refined_and_follow_affine_maps() {
    for surface in [bbb_surface(1.0), bbb_surface(20.0)] {
        let finer = surface.with_joint(Direction::U, 2.2).unwrap().with_joint(Direction::V, 3.3).unwrap();
        let higher = surface.elevated(Direction::V).unwrap();
        let passing = surface.with_passing_sides(Direction::U).unwrap();
        let skewed = DAffine3::from_cols_array(&[1.0, 0.2, 0.0, -0.3, 0.8, 0.1, 0.0, 0.5, 1.3, 4.0, 5.0, 6.0]);
        let moved = surface.transformed(&skewed);
        let turned = surface.transposed();
        for uv in samples(&surface, 23) {
            let point = surface.point(uv);
            for other in [&finer, &higher, &passing] {
                assert!((other.point(uv) - point).length() < 1e-13, "{uv}");
            }
            assert!((moved.point(uv) - skewed.transform_point3(point)).length() < 1e-13);
            assert!((turned.point(DVec2::new(uv.y, uv.x)) - point).length() < 1e-14);
            assert!((turned.normal(DVec2::new(uv.y, uv.x)) + surface.normal(uv)).length() < 1e-12);
        }
        let mirrored = surface.transformed(&DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
        let [low, high] = surface.domain();
        for uv in samples(&surface, 9) {
            let normal = mirrored.normal(DVec2::new(low.x + (high.x - uv.x), uv.y));
            assert!((normal - surface.normal(uv) * DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-9, "{uv}");
        }
        let parts = surface.subdivided(Direction::V, 3.0).unwrap();
        for part in &parts {
            assert!(samples(part, 9).into_iter().all(|uv| (part.point(uv) - surface.point(uv)).length() < 1e-12));
        }
        assert_eq!(parts.len(), 2);
    }
}

#[test]
fn patches_lie_in_the_hull_of_their_sixteen_control_points() {
    let surface = bbb_surface(1e6);
    let columns = surface.patch_counts()[1];
    for (k, patch) in surface.patches().iter().enumerate() {
        let near = |axis: usize, span: usize, x: f64| x >= span as f64 && x <= span as f64 + 3.0 || axis > 1;
        for uv in samples(patch, 7) {
            let point = patch.point(uv);
            assert!(near(0, k / columns, point.x) && near(1, k % columns, point.y), "{k}: {point}");
        }
    }
}

#[test]
fn extreme_parameters_and_coinciding_points_give_finite_surfaces() {
    let extremes = [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e6), (1e-3, 1e6), (1e3, 1e6)];
    for (bias, tension) in extremes {
        for spread in [1.0, 1e6] {
            let mut points = net(6, 6);
            points[2] = vec![points[2][0]; 6];
            points[3][3] = points[3][2];
            points[4] = points[5].clone();
            let u = Basis::beta(6, bias, tension).unwrap();
            let v = Basis::closed_bbb(&[bias; 6], &[tension; 6], &[1.0, 0.0, 2.0, 1e-3, 0.0, 5.0]).unwrap();
            let surface = SplineSurface::new(u, v, &points, &weights(6, 6, spread)).unwrap();
            for uv in samples(&surface, 29) {
                let (point, normal) = (surface.point(uv), surface.normal(uv));
                let derivatives = surface.derivatives(uv).into_iter().chain(surface.second_derivatives(uv));
                assert!(point.is_finite() && derivatives.into_iter().all(|d| d.is_finite()), "{uv}");
                assert!(normal == DVec3::ZERO || (normal.length() - 1.0).abs() < 1e-14, "{uv}: {normal}");
            }
        }
    }
    let point = vec![vec![DVec3::ONE; 4]; 4];
    let surface =
        SplineSurface::new(Basis::beta(4, 2.0, 3.0).unwrap(), Basis::bezier(3).unwrap(), &point, &[]).unwrap();
    assert_eq!((surface.point(DVec2::splat(0.3)), surface.normal(DVec2::splat(0.3))), (DVec3::ONE, DVec3::ZERO));
}

#[test]
fn meshes_that_do_not_fit_are_refused() {
    let (u, v) = (Basis::bezier(2).unwrap(), Basis::uniform(3, 6).unwrap());
    let fault = |rows, columns| SplineSurface::new(u.clone(), v.clone(), &net(rows, columns), &[]).unwrap_err();
    assert_eq!(fault(2, 6).to_string(), "2 rows of control points were given, 3 are needed");
    assert_eq!(fault(3, 5).to_string(), "5 control points in a row were given, 6 are needed");
    assert!(matches!(bbb_surface(1.0).with_joint(Direction::U, -1.0), Err(SplineError::Outside { .. })));
}

/// A surface beside [`bbb_surface`], a little off, that runs along the same joints.
fn neighbour(spread: f64) -> SplineSurface {
    let mut points = net(5, 8);
    points.iter_mut().flatten().for_each(|point| *point += DVec3::new(5.3, 0.1, 0.2));
    let weights = if spread == 1.0 { Vec::new() } else { weights(5, 8, spread) };
    SplineSurface::new(Basis::clamped(4, 5).unwrap(), bbb(8, 2), &points, &weights).unwrap()
}

#[test]
fn surfaces_are_joined_as_smoothly_as_asked() {
    use SurfaceSide::{HighU, HighV, LowU, LowV};
    for spread in [1.0, 1.3] {
        let (first, second) = (bbb_surface(spread), neighbour(spread));
        for smoothness in [Smoothness::G0, Smoothness::G1, Smoothness::G2] {
            let turned = second.transposed().reversed(Direction::V);
            for (other, side) in [(&second, LowU), (&turned, HighV)] {
                let [a, b] = joined(&first, other, [HighU, side], smoothness).unwrap();
                let joint = joint(&a, &b, [HighU, side], 33);
                assert_eq!(joint.gap, 0.0, "{smoothness:?} {joint:?}");
                assert_eq!(joint.angle < 1e-10, smoothness >= Smoothness::G1, "{smoothness:?} {joint:?}");
                let is_curved_alike = joint.curvature_difference < 1e-10 * joint.curvature;
                assert_eq!(is_curved_alike, smoothness >= Smoothness::G2, "{smoothness:?} {joint:?}");
            }
            // A side that runs the other way: the second surface comes back reversed.
            let against = second.reversed(Direction::U).reversed(Direction::V);
            let [a, b] = joined(&first, &against, [HighU, HighU], smoothness).unwrap();
            assert_eq!(joint(&a, &b, [HighU, LowU], 9).gap, 0.0);
        }
        let fault = joined(&first, &second, [HighU, LowV], Smoothness::G1).unwrap_err();
        assert_eq!(fault, JoinError::Sides { first: 8, second: 5 });
    }
    let flat = |u| SplineSurface::new(u, bbb(8, 2), &net(2, 8), &[]).unwrap();
    let fault = joined(&bbb_surface(1.0), &flat(Basis::bezier(1).unwrap()), [HighU, LowU], Smoothness::G2).unwrap_err();
    assert!(fault.to_string().starts_with("G2 needs degree 2"));
}

#[test]
fn joined_surfaces_have_no_crack() {
    use SurfaceSide::{HighU, LowU};
    let [a, b] = joined(&bbb_surface(1.0), &neighbour(1.0), [HighU, LowU], Smoothness::G1).unwrap();
    let patches = [a.patches(), b.patches()].concat();
    let report = tessellate(&patches, Tolerance::new(0.01, 180.0)).unwrap().edge_report();
    assert_eq!((report.non_manifold, report.misoriented, report.euler_characteristic()), (0, 0, 1));
}

/// Surfaces that are hard to tessellate.
fn hard() -> Vec<(String, SplineSurface)> {
    let beta = |bias, tension| {
        let u = Basis::beta(6, bias, tension).unwrap();
        SplineSurface::new(u.clone(), u, &net(6, 6), &[]).unwrap()
    };
    let cubic = || Basis::clamped(3, 6).unwrap();
    let mut points = net(6, 6);
    points[0] = vec![points[0][0]; 6];
    points[3][3] = points[3][2];
    points[4] = points[5].clone();
    let coinciding = SplineSurface::new(cubic(), cubic(), &points, &[]).unwrap();
    let mut surfaces = vec![
        ("BBB".to_owned(), bbb_surface(1.0)),
        ("rational".to_owned(), bbb_surface(10.0)),
        ("wild weights".to_owned(), bbb_surface(1e6)),
        ("coinciding".to_owned(), coinciding),
        ("sphere".to_owned(), rational_sphere(1.0).unwrap()),
        ("torus".to_owned(), rational_torus(2.0, 0.5).unwrap()),
    ];
    let extremes = [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e3), (1.0, 1e6), (1e3, 1e6)];
    surfaces.extend(extremes.map(|(bias, tension)| (format!("Beta {bias} {tension}"), beta(bias, tension))));
    surfaces
}

#[test]
fn spline_surfaces_are_tessellated_within_the_tolerance_without_cracks() {
    for (name, surface) in hard() {
        for chord in [0.1, 0.02] {
            let tolerance = Tolerance::new(chord, 180.0);
            let patches = surface.patches();
            let meshes = [tessellate(patches, tolerance).unwrap(), tessellate_adaptively(patches, tolerance).unwrap()];
            let surfaces: Vec<i64> = meshes.iter().map(|mesh| mesh.edge_report().euler_characteristic()).collect();
            assert_eq!(surfaces[0], surfaces[1], "{name}");
            for (mesh, least) in meshes.iter().zip([0.1, 0.3]) {
                let report = mesh.edge_report();
                assert_eq!((report.non_manifold, report.misoriented, report.collapsed), (0, 0, 0), "{name}");
                let error =
                    chord_error(mesh, patches, if mesh.triangles.len() < 3000 { 3 } else { 1 }).unwrap().maximum;
                assert!(error <= chord, "{name}: {} of {chord}", error / chord);
                assert!(error >= least * chord || mesh.triangles.len() > 3000, "{name}: {} of {chord}", error / chord);
            }
        }
    }
}

#[test]
fn adaptive_meshes_take_fewer_triangles_where_the_surface_is_uneven() {
    for (name, surface) in hard().into_iter().filter(|(name, _)| name.starts_with("Beta") || name == "wild weights") {
        let tolerance = Tolerance::new(0.01, 180.0);
        let grid = tessellate(surface.patches(), tolerance).unwrap().triangles.len();
        let adaptive = tessellate_adaptively(surface.patches(), tolerance).unwrap().triangles.len();
        assert!(3 * adaptive < grid, "{name}: {adaptive} and {grid}");
    }
}

#[test]
fn flat_patches_are_refined_only_where_their_outline_bends() {
    let flatten = |mut points: Vec<Vec<DVec3>>| {
        points.iter_mut().flatten().for_each(|point| point.z = 0.0);
        points
    };
    let cubic = Basis::clamped(3, 6).unwrap();
    // Straight sides, uneven weights inside: two triangles for each patch.
    let mut weights = weights(6, 6, 3.0);
    weights.iter_mut().for_each(|row| row.fill(1.0));
    let surface = SplineSurface::new(cubic.clone(), cubic, &flatten(net(6, 6)), &weights).unwrap();
    for chord in [0.1, 1e-6] {
        let mesh = tessellate_adaptively(surface.patches(), Tolerance::new(chord, 1.0)).unwrap();
        assert_eq!(mesh.triangles.len(), 2 * surface.patches().len());
        let mesh = tessellate(surface.patches(), Tolerance::new(chord, 1.0)).unwrap();
        assert_eq!(mesh.triangles.len(), 2 * surface.patches().len());
    }
}

#[test]
fn the_teapot_has_no_cracks_when_refined_where_it_bends() {
    for chord in [0.1, 0.02, 0.005] {
        let patches = teapot();
        let mesh = tessellate_adaptively(&patches, Tolerance::new(chord, 180.0)).unwrap();
        let report = mesh.edge_report();
        assert_eq!((report.non_manifold, report.misoriented, report.collapsed), (0, 0, 0));
        assert_eq!(report.euler_characteristic(), 2 - 1);
        assert!(mesh.with_holes_filled().is_closed());
        let error = chord_error(&mesh, &patches, 3).unwrap().maximum;
        assert!(error <= chord && error > 0.4 * chord, "{error} for {chord}");
    }
}

#[test]
fn normals_follow_the_angle_also_where_the_bend_is_sharp() {
    for (name, surface) in hard().into_iter().filter(|(name, _)| !name.contains("1000000")) {
        let mesh = tessellate_adaptively(surface.patches(), Tolerance::new(10.0, 25.0)).unwrap();
        let report = mesh.edge_report();
        assert_eq!((report.non_manifold, report.misoriented), (0, 0), "{name}");
        let sharp = (0..mesh.triangles.len()).filter(|&triangle| {
            let (n, p) = (mesh.corner_normals[triangle], mesh.corners(triangle));
            let pairs = [(0, 1), (1, 2), (2, 0)];
            let is_large = pairs.iter().any(|&(a, b)| p[a].distance(p[b]) > 0.1);
            is_large && pairs.iter().any(|&(a, b)| n[a].angle_between(n[b]).to_degrees() > 25.1)
        });
        assert_eq!(sharp.count(), 0, "{name}");
    }
}
