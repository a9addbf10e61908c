//! What every surface must keep, checked for one of each kind.

use glam::{DAffine3, DVec2, DVec3};

use super::*;
use crate::curve::{Basis, SplineCurve};

fn members() -> Vec<(&'static str, Box<dyn Surface>)> {
    let sphere = Sphere::new(DVec3::new(1.0, -2.0, 0.5), 3.0);
    let skewed = DAffine3::from_cols_array(&[1.0, 0.2, 0.0, -0.3, 0.8, 0.1, 0.0, 0.5, 1.3, 4.0, 5.0, 6.0]);
    let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 2.0));
    let mut members: Vec<(&'static str, Box<dyn Surface>)> = vec![
        ("sphere", Box::new(sphere.clone())),
        ("skewed sphere", Box::new(TransformedSurface::new(sphere.clone(), skewed))),
        ("mirrored sphere", Box::new(TransformedSurface::new(sphere, mirrored))),
        (
            "parallelogram",
            Box::new(Parallelogram::new(DVec3::ONE, DVec3::new(2.0, 0.1, 0.0), DVec3::new(0.3, 1.0, 0.4))),
        ),
    ];
    members.extend(turned());
    members.extend(swept());
    for patch in teapot() {
        members.push(("patch of the teapot", Box::new(patch)));
    }
    members.extend(splines());
    members
}

/// Surfaces of revolution over each kind of profile, whole and in part, placed and not.
fn turned() -> Vec<(&'static str, Box<dyn Surface>)> {
    let curve = [[0.0, 0.0], [2.0, 0.5], [0.5, 1.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let curve = SplineCurve::new(Basis::clamped(3, 4).unwrap(), &curve, &[]).unwrap();
    let torus = Profile::Arc { center: DVec2::X * 2.0, radius: 0.7, turns: [0.0, 1.0] };
    let turn = DAffine3::from_rotation_x(0.7) * DAffine3::from_scale(DVec3::new(-3.0, 3.0, 3.0));
    let profiles = [
        ("cylinder", Profile::line(DVec2::new(1.5, -1.0), DVec2::new(1.5, 2.0))),
        ("cone", Profile::line(DVec2::new(1.5, -1.0), DVec2::Y * 2.0)),
        ("disc", Profile::line(DVec2::Y, DVec2::new(1.5, 1.0))),
        ("dome", Profile::Arc { center: DVec2::Y, radius: 2.0, turns: [0.1, 0.25] }),
        ("torus of revolution", torus.clone()),
        ("paraboloid", Profile::Parabola { apex: 1.0, rise: 0.4, reach: [0.0, 1.5] }),
        ("hyperboloid of one sheet", Profile::HyperbolaOneSheet { across: 0.8, along: 1.2, reach: [-1.0, 1.0] }),
        ("hyperboloid of two sheets", Profile::HyperbolaTwoSheets { across: 0.8, along: 1.2, reach: [0.0, 1.0] }),
        ("vase", Profile::Spline(curve)),
    ];
    let mut members: Vec<(&'static str, Box<dyn Surface>)> = Vec::new();
    for (name, profile) in profiles {
        members.push((name, Box::new(SurfaceOfRevolution::whole(profile.clone()))));
        members.push((name, Box::new(SurfaceOfRevolution::part(profile.reversed(), [-0.3, 0.35]))));
    }
    members
        .push(("mirrored torus", Box::new(TransformedSurface::new(SurfaceOfRevolution::whole(torus.clone()), turn))));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.5, 2.0));
    members.push(("stretched torus", Box::new(TransformedSurface::new(SurfaceOfRevolution::whole(torus), flat))));
    members
}

/// Surfaces of an edge along a curve in space: as it is, and twisted and narrowed to a point.
fn swept() -> Vec<(&'static str, Box<dyn Surface>)> {
    let path = [[0.0, 0.0, 0.0], [0.0, 3.0, 1.0], [4.0, 4.0, 2.0], [6.0, 0.0, 5.0], [3.0, -2.0, 6.0]];
    let path = SplineCurve::new(Basis::clamped(3, 5).unwrap(), &path.map(DVec3::from_array), &[]).unwrap();
    let spine = Arc::new(Spine::new(path).unwrap());
    let edge = [DVec2::new(-0.4, 0.1), DVec2::new(0.3, -0.2)];
    let part =
        |twist_and_taper: TwistAndTaper| Box::new(Swept::new(Arc::clone(&spine), twist_and_taper, edge, [0.0, 1.0]));
    vec![
        ("swept edge", part(TwistAndTaper { twist_turns: 0.0, scale: 1.0 }) as Box<dyn Surface>),
        ("twisted and tapered edge", part(TwistAndTaper { twist_turns: 0.4, scale: 0.0 })),
    ]
}

/// Tensor patches and spline surfaces of several kinds, with poles and weights among them.
fn splines() -> Vec<(&'static str, Box<dyn Surface>)> {
    let net = |rows: usize, columns: usize| -> Vec<Vec<DVec3>> {
        let at = |i: usize, j: usize| DVec3::new(i as f64, j as f64, ((i * 3 + j * 5) % 7) as f64 * 0.2);
        (0..rows).map(|i| (0..columns).map(|j| at(i, j)).collect()).collect()
    };
    let weights: Vec<Vec<f64>> = (0..4).map(|i| (0..5).map(|j| 1.0 + ((i + j) % 3) as f64).collect()).collect();
    let bbb =
        Basis::bbb(&[1.0, 2.0, 0.5, 1.0, 1.0], &[0.0, 3.0, 1.0, 9.0, 0.0], &[1.0, 0.5, 1.0, 2.0, 0.0, 1.0]).unwrap();
    let sphere = rational_sphere(2.0).unwrap();
    vec![
        ("rational patch", Box::new(TensorPatch::new(&net(4, 5), &weights).unwrap())),
        ("patch of a sphere", Box::new(sphere.patches()[3].clone())),
        ("patch at a pole", Box::new(sphere.patches()[4].clone())),
        ("torus", Box::new(rational_torus(2.0, 0.7).unwrap().patches()[6].clone())),
        ("B-spline", {
            let (u, v) = (Basis::clamped(3, 4).unwrap(), Basis::bezier(4).unwrap());
            Box::new(SplineSurface::new(u, v, &net(4, 5), &weights).unwrap())
        }),
        ("patch of a BBB-spline", {
            let surface = SplineSurface::new(bbb.clone(), Basis::closed_beta(4, 1.5, 2.0).unwrap(), &net(5, 4), &[]);
            Box::new(surface.unwrap().patches()[5].clone())
        }),
    ]
}

fn samples(surface: &dyn Surface, count: usize) -> Vec<DVec2> {
    let [low, high] = surface.domain();
    let at = |k: usize| k as f64 / (count - 1) as f64;
    let grid = (0..count * count).map(|k| DVec2::new(at(k % count), at(k / count)));
    grid.map(|f| DVec2::new(between(low.x, high.x, f.x), between(low.y, high.y, f.y))).collect()
}

#[test]
fn parameter_lines_give_points_and_normals_to_the_bit() {
    for (name, surface) in members() {
        let [low, high] = surface.domain();
        for j in 0..=12 {
            let v = between(low.y, high.y, f64::from(j) / 12.0);
            let line = surface.line(v);
            for i in 0..=12 {
                let u = between(low.x, high.x, f64::from(i) / 12.0);
                let uv = DVec2::new(u, v);
                assert_eq!(line(u), [surface.point(uv), surface.normal(uv)], "{name} at {uv}");
            }
        }
    }
}

#[test]
fn derivatives_agree_with_differences_of_points() {
    for (name, surface) in members() {
        for uv in samples(&surface, 7) {
            let [low, high] = surface.domain();
            for (axis, derivative) in [DVec2::X, DVec2::Y].into_iter().zip(surface.derivatives(uv)) {
                let h = (high - low) * axis * 1e-5;
                let (from, to) = ((uv - h).max(low), (uv + h).min(high));
                let middle = surface.derivatives((from + to) * 0.5);
                let expected = (surface.point(to) - surface.point(from)) / (to - from).dot(axis);
                let derivative = if from == uv || to == uv { middle[axis.y as usize] } else { derivative };
                assert!((derivative - expected).length() < 1e-6, "{name} at {uv}: {derivative} {expected}");
            }
        }
    }
}

#[test]
fn points_and_derivatives_at_once_are_those_of_each() {
    for (name, surface) in members() {
        for uv in samples(&surface, 7) {
            let [point, du, dv] = surface.point_and_derivatives(uv);
            let [u, v] = surface.derivatives(uv);
            let off = (point - surface.point(uv)).length() + (du - u).length() + (dv - v).length();
            assert!(off <= 1e-13 * (10.0 + u.length() + v.length()), "{name} at {uv}: {off}");
        }
    }
}

#[test]
fn normals_are_unit_perpendicular_and_on_the_side_of_du_x_dv() {
    for (name, surface) in members() {
        for uv in samples(&surface, 9) {
            let normal = surface.normal(uv);
            let [du, dv] = surface.derivatives(uv);
            assert!((normal.length() - 1.0).abs() < 1e-14, "{name} at {uv}: {normal}");
            assert!(
                normal.dot(du).abs() <= 1e-12 * du.length() && normal.dot(dv).abs() <= 1e-12 * dv.length(),
                "{name} at {uv}"
            );
            assert!(du.cross(dv).dot(normal) >= 0.0, "{name} at {uv}");
        }
    }
}

#[test]
fn normals_at_the_rim_of_the_domain_are_limits_of_inner_ones() {
    for (name, surface) in members() {
        let [low, high] = surface.domain();
        for uv in samples(&surface, 9) {
            let inward = uv + ((low + high) * 0.5 - uv) * 1e-7;
            let gap = (surface.normal(uv) - surface.normal(inward)).length();
            assert!(gap < 1e-4, "{name} at {uv}: {} {}", surface.normal(uv), surface.normal(inward));
        }
    }
}

#[test]
fn the_nearest_point_of_a_point_just_off_the_surface_is_where_it_came_from() {
    for (name, surface) in members() {
        let [low, high] = surface.domain();
        for uv in samples(&surface, 6) {
            for height in [-1e-3, 0.0, 1e-3] {
                let point = surface.point(uv) + surface.normal(uv) * height;
                let guess = (uv + (high - low) * 0.01).min(high);
                let found = surface.nearest(point, guess);
                assert!(found.cmpge(low).all() && found.cmple(high).all(), "{name}: {found}");
                let distance = surface.point(found).distance(point);
                assert!(distance <= height.abs() + 1e-9, "{name} at {uv}: {distance} for {height}");
            }
        }
    }
}

#[test]
fn second_derivatives_agree_with_differences_of_first_ones() {
    let arc = Profile::Arc { center: DVec2::new(2.0, 0.5), radius: 0.7, turns: [0.1, 0.4] };
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 2.0));
    let members: Vec<Box<dyn Curved>> = vec![
        Box::new(Sphere::new(DVec3::ONE, 2.0)),
        Box::new(TransformedSurface::new(Sphere::new(DVec3::ONE, 2.0), mirror)),
        Box::new(SurfaceOfRevolution::whole(arc)),
        Box::new(SurfaceOfRevolution::whole(Profile::HyperbolaOneSheet {
            across: 0.8,
            along: 1.2,
            reach: [-1.0, 1.0],
        })),
        Box::new(SurfaceOfRevolution::whole(Profile::HyperbolaTwoSheets {
            across: 0.8,
            along: 1.2,
            reach: [-1.0, 1.0],
        })),
        Box::new(SurfaceOfRevolution::whole(Profile::Parabola { apex: 1.0, rise: 0.4, reach: [0.0, 1.5] })),
        Box::new(Parallelogram::new(DVec3::ONE, DVec3::X, DVec3::Y)),
        Box::new(teapot()[7].clone()),
    ];
    for (member, surface) in members.iter().enumerate() {
        let [low, high] = surface.domain();
        for k in 0..25 {
            let uv = low + (high - low) * DVec2::new(f64::from(k % 5 + 1), f64::from(k / 5 + 1)) / 6.0;
            let h = 1e-5;
            let slope = |axis: DVec2, k: usize| {
                (surface.derivatives(uv + axis * h)[k] - surface.derivatives(uv - axis * h)[k]) / (2.0 * h)
            };
            let expected = [slope(DVec2::X, 0), slope(DVec2::Y, 0), slope(DVec2::Y, 1)];
            for (found, expected) in surface.second_derivatives(uv).into_iter().zip(expected) {
                assert!((found - expected).length() < 1e-6 * (1.0 + expected.length()), "{member} {found} {expected}");
            }
        }
    }
}
