//! Curves of intersection against closed forms.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};

use super::*;
use crate::mesh::Mesh;
use crate::solid::primitive::{block, cylinder, sphere, torus};
use crate::solid::{Body, ExactSolid, Expression};
use crate::surface::{Parallelogram, Surface, Tolerance, teapot, tessellate};

fn solid(body: Body, chord: f64, placement: DAffine3) -> ExactSolid {
    body.solid(Tolerance::new(chord, 45.0)).unwrap().transformed(&placement).unwrap()
}

fn moved(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// Some open surfaces with their triangles.
struct Open {
    mesh: Mesh,
    surfaces: Vec<Option<Arc<dyn Surface>>>,
}

impl Open {
    fn new<S: Surface + Clone + 'static>(surfaces: &[S], chord: f64) -> Open {
        let mesh = tessellate(surfaces, Tolerance::new(chord, 45.0)).unwrap();
        let shared = |surface: &S| Some(Arc::new(surface.clone()) as Arc<dyn Surface>);
        Open { mesh, surfaces: surfaces.iter().map(shared).collect() }
    }

    /// A square of side `2 * half` around `at`.
    fn square(at: DVec3, along_u: DVec3, along_v: DVec3, half: f64) -> Open {
        let (u, v) = (along_u.normalize() * half, along_v.normalize() * half);
        Open::new(&[Parallelogram::new(at - u - v, u * 2.0, v * 2.0)], 1.0)
    }

    fn sheet(&self) -> ExactSheet<'_> {
        ExactSheet::new(&self.mesh, &self.surfaces)
    }
}

fn level(y: f64, half: f64) -> Open {
    Open::square(DVec3::Y * y, DVec3::Z, DVec3::X, half)
}

fn curves<'a>(one: impl Into<ExactSheet<'a>>, two: impl Into<ExactSheet<'a>>) -> Intersection {
    intersect(one.into(), two.into(), &CurvePrecision::default())
}

/// Checks that every point is accurate and on some implicit surfaces, and gives the branches as lengths of cycles.
fn check(found: &Intersection, equations: &[&dyn Fn(DVec3) -> f64], residual: f64, off: f64) {
    for point in found.points() {
        assert_eq!(point.inaccuracy, None, "{point:?}");
        assert!(point.residual <= residual, "{point:?}");
        for equation in equations {
            let value = equation(point.position).abs();
            assert!(value <= off, "{value:e} at {point:?}");
        }
    }
    for branch in &found.branches {
        let count = branch.points.len();
        for k in 0..if branch.is_closed { count } else { count - 1 } {
            let [from, to] = [&branch.points[k], &branch.points[(k + 1) % count]];
            let way = to.position - from.position;
            assert!(from.mark == Mark::Corner || way.dot(from.tangent) > 0.0, "{k} of {count}: {from:?} {to:?}");
            assert!(way.length() > 0.0 || from.mark == Mark::Corner);
        }
    }
}

fn marks(branch: &Branch, mark: Mark) -> usize {
    branch.points.iter().filter(|point| point.mark == mark).count()
}

#[test]
fn a_sphere_and_a_plane_meet_in_a_circle_in_any_size_and_far_from_the_origin() {
    for (size, far, accuracy) in [(1.0, 0.0, 1e-15), (1e-6, 0.0, 1e-15), (1e6, 0.0, 1e-15), (1.0, 1e7, 2e-9)] {
        let at = DVec3::new(far, -far, 0.5 * far);
        let ball = solid(sphere(size).unwrap(), 0.01 * size, DAffine3::from_translation(at));
        let plane = Open::square(at + DVec3::Y * (0.3 * size), DVec3::Z, DVec3::X, 2.0 * size);
        let found = curves(&ball, plane.sheet());
        assert_eq!(found.branches.len(), 1);
        assert!(found.branches[0].is_closed && found.branches[0].points.len() > 20);
        let off = |p: DVec3| ((p - at).length() - size) / size;
        let level = |p: DVec3| ((p - at).y - 0.3 * size) / size;
        let bound = if far == 0.0 { 8.0 * accuracy } else { accuracy };
        check(&found, &[&off, &level], bound * size, bound);
        let angle = 0.3_f64.acos().to_degrees();
        let within = if far == 0.0 { 1e-12 } else { 1e-6 };
        assert!(found.points().all(|point| (point.angle - angle).abs() < within));
    }
}

#[test]
fn points_are_added_until_the_lines_are_near_to_the_curve() {
    let (one, two) = (
        solid(sphere(1.0).unwrap(), 0.02, DAffine3::IDENTITY),
        solid(sphere(0.8).unwrap(), 0.02, moved(0.9, 0.4, 0.2)),
    );
    for chord in [1e-2, 1e-4, 1e-6] {
        let precision = CurvePrecision { chord: Some(chord), ..CurvePrecision::default() };
        let found = intersect((&one).into(), (&two).into(), &precision);
        assert!(found.branches.len() == 1 && found.counts.unfilled == 0);
        let center = DVec3::new(0.9, 0.4, 0.2);
        check(&found, &[&|p| p.length() - 1.0, &|p| (p - center).length() - 0.8], 1e-14, 2e-15);
        let d = center.length();
        let x = (d * d + 1.0 - 0.64) / (2.0 * d);
        let radius = (1.0 - x * x).sqrt();
        let lines = found.branches[0].positions();
        let sagitta = |pair: &[DVec3]| radius - (pair[0].midpoint(pair[1]) - center * (x / d)).length();
        let largest = lines.windows(2).map(sagitta).fold(0.0, f64::max);
        assert!(largest < chord && (chord > 1e-3 || largest > 0.05 * chord), "{chord} {largest}");
    }
}

#[test]
fn a_cylinder_and_a_slanted_plane_meet_in_an_ellipse() {
    let tube = solid(cylinder(1.0, 8.0).unwrap(), 0.01, DAffine3::IDENTITY);
    let normal = DVec3::new(0.5, 1.0, 0.25);
    let plane = Open::square(DVec3::ZERO, DVec3::new(1.0, -0.5, 0.0), DVec3::new(1.0, -0.5, 0.0).cross(normal), 4.0);
    let found = curves(&tube, plane.sheet());
    assert_eq!(found.branches.len(), 1);
    assert!(found.branches[0].is_closed);
    check(&found, &[&|p| p.x.hypot(p.z) - 1.0, &|p| p.dot(normal)], 1e-14, 1e-14);
    // The crossing of the seam does not lead back.
    let turns: f64 = found.branches[0]
        .positions()
        .windows(2)
        .map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|p| DVec2::new(p.z, p.x));
            a.angle_to(b)
        })
        .sum();
    assert!((turns.abs() - 2.0 * PI).abs() < 1e-9, "{turns}");
}

#[test]
fn equal_cylinders_at_right_angles_meet_in_two_ellipses_that_cross_twice() {
    for turn in [0.0, 0.1] {
        let tube = solid(cylinder(1.0, 6.0).unwrap(), 0.005, DAffine3::from_rotation_y(turn));
        let lying = solid(cylinder(1.0, 6.0).unwrap(), 0.007, DAffine3::from_rotation_z(0.5 * PI));
        let found = curves(&tube, &lying);
        check(
            &found,
            &[&|p| p.x.hypot(p.z) - 1.0, &|p| p.y.hypot(p.z) - 1.0, &|p| p.x.abs() - p.y.abs()],
            1e-13,
            1e-12,
        );
        assert_eq!(found.branches.len(), 2, "{turn}");
        for branch in &found.branches {
            assert!(branch.is_closed);
            assert_eq!(marks(branch, Mark::Branching), 2);
            let side = branch
                .points
                .iter()
                .map(|p| p.position.x * p.position.y)
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            assert!(branch.points.iter().all(|p| p.position.x * p.position.y * side.signum() > -1e-12));
            for point in branch.points.iter().filter(|point| point.mark == Mark::Branching) {
                assert!((point.position.abs() - DVec3::Z).length() < 1e-12, "{point:?}");
                assert!((point.tangent.abs() - DVec3::new(1.0, 1.0, 0.0).normalize()).length() < 1e-6);
            }
        }
    }
}

#[test]
fn unequal_cylinders_meet_in_two_closed_curves() {
    let tube = solid(cylinder(1.0, 6.0).unwrap(), 0.01, DAffine3::IDENTITY);
    let thin = solid(cylinder(0.6, 6.0).unwrap(), 0.01, DAffine3::from_rotation_x(0.5 * PI));
    let found = curves(&tube, &thin);
    check(&found, &[&|p| p.x.hypot(p.z) - 1.0, &|p| p.x.hypot(p.y) - 0.6], 1e-13, 1e-14);
    assert_eq!(found.branches.len(), 2);
    // (0.6 cos t, 0.6 sin t, sqrt(1 - 0.36 cos^2 t))
    for point in found.points() {
        let p = point.position;
        let t = p.y.atan2(p.x);
        assert!((p.z.abs() - (1.0 - 0.36 * t.cos().powi(2)).sqrt()).abs() < 1e-14);
    }
}

#[test]
fn vivianis_curve_crosses_itself_once() {
    for turn in [0.0, 0.3] {
        let ball = solid(sphere(2.0).unwrap(), 0.01, DAffine3::from_rotation_y(turn));
        let tube = solid(cylinder(1.0, 6.0).unwrap(), 0.01, moved(0.0, 0.0, 1.0));
        let found = curves(&ball, &tube);
        check(&found, &[&|p| p.length() - 2.0, &|p| p.x.hypot(p.z - 1.0) - 1.0], 1e-13, 1e-12);
        assert_eq!(found.branches.len(), 1);
        let branch = &found.branches[0];
        assert!(branch.is_closed);
        let crossings: Vec<_> = branch.points.iter().filter(|point| point.mark == Mark::Branching).collect();
        assert_eq!(crossings.len(), 2, "once on each of the two ways through");
        assert!(crossings.iter().all(|point| (point.position - DVec3::Z * 2.0).length() < 1e-12));
        assert!(crossings[0].tangent.dot(crossings[1].tangent).abs() < 1e-6, "at right angles");
        // (sin t, 2 sin(t / 2), 1 + cos t)
        for point in &branch.points {
            let p = point.position;
            let t = 2.0 * (0.5 * p.y).clamp(-1.0, 1.0).asin();
            let cosine = 0.5 * p.y * p.y;
            assert!((p.z - (2.0 - cosine)).abs() < 1e-11 && (p.x.abs() - t.sin().abs()).abs() < 1e-6, "{p}");
        }
    }
}

#[test]
fn the_tangent_plane_through_the_middle_of_a_torus_cuts_villarceaus_circles() {
    let ring = solid(torus(2.0, 1.0).unwrap(), 0.01, DAffine3::from_rotation_y(0.2));
    // It touches the tube above and below, at the distance of sqrt(3) from the middle.
    let normal = DVec3::new(-0.5, 0.75_f64.sqrt(), 0.0);
    let plane = Open::square(DVec3::ZERO, DVec3::Z, DVec3::Z.cross(normal), 4.0);
    let found = curves(&ring, plane.sheet());
    let on_torus = |p: DVec3| (p.x.hypot(p.z) - 2.0).hypot(p.y) - 1.0;
    check(&found, &[&on_torus, &|p| p.dot(normal)], 1e-13, 1e-12);
    assert_eq!(found.branches.len(), 2);
    for branch in &found.branches {
        assert!(branch.is_closed && marks(branch, Mark::Branching) == 2);
        // Circles of radius 2 around the points at distance 1 from the middle.
        let side = branch.points.iter().map(|p| p.position.z).sum::<f64>().signum();
        let center = DVec3::new(0.0, 0.0, side);
        for point in &branch.points {
            assert!((point.position.distance(center) - 2.0).abs() < 1e-11, "{point:?}");
        }
    }
}

#[test]
fn a_sphere_that_rests_on_a_plane_touches_it_in_one_point() {
    let at = DVec3::new(0.3, 1.0, -0.2);
    let ball = solid(sphere(1.0).unwrap(), 0.01, DAffine3::from_translation(at) * DAffine3::from_rotation_z(0.7));
    for (one, two) in [(ExactSheet::from(&ball), level(0.0, 50.0)), (ExactSheet::from(&ball), level(0.0, 1.5))] {
        for found in [curves(one, two.sheet()), curves(two.sheet(), one)] {
            assert!(found.branches.is_empty(), "{:?}", found.branches.len());
            assert_eq!(found.touching.len(), 1);
            check(&found, &[&|p| p.distance(DVec3::new(0.3, 0.0, -0.2))], 1e-15, 1e-12);
            assert_eq!(found.touching[0].mark, Mark::Tangent);
            assert!(found.touching[0].angle < 1e-6);
        }
    }
    assert!(curves(&ball, level(-1e-9, 2.0).sheet()).points().next().is_none());
}

#[test]
fn a_sphere_dips_through_a_plane_by_a_little() {
    let ball = solid(sphere(1.0).unwrap(), 0.01, DAffine3::from_rotation_z(0.7));
    for depth in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        let found = curves(&ball, level(-1.0 + depth, 2.0).sheet());
        assert_eq!((found.branches.len(), found.touching.len()), (1, 0), "{depth}");
        assert!(
            found.branches[0].is_closed && found.branches[0].points.len() >= 12,
            "{}",
            found.branches[0].points.len()
        );
        let height = -1.0 + depth;
        let radius = (1.0 - height * height).sqrt();
        // What is lost across the curve is the residual over the sine of the angle.
        check(&found, &[&|p| p.y - height], 2e-15, 2e-15);
        check(&found, &[&|p| p.x.hypot(p.z) - radius], 2e-15, 2e-15 / radius);
    }
}

#[test]
fn cylinders_that_nearly_branch_keep_their_branches_apart() {
    for (radius, crossing) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false), (1.0 - 1e-10, true), (1.0 + 1e-4, false)] {
        let tube = solid(cylinder(1.0, 6.0).unwrap(), 0.005, DAffine3::from_rotation_y(0.1));
        let lying = solid(cylinder(radius, 6.0).unwrap(), 0.007, DAffine3::from_rotation_z(0.5 * PI));
        let found = curves(&tube, &lying);
        let angle = (1.0 - radius).abs().sqrt();
        check(&found, &[&|p| p.x.hypot(p.z) - 1.0, &|p| p.y.hypot(p.z) - radius], 1e-13, 2e-16 / angle + 1e-13);
        assert_eq!(found.branches.len(), 2, "{radius}");
        for branch in &found.branches {
            assert!(branch.is_closed && marks(branch, Mark::Branching) == 0);
            // The thinner one is cut twice, on either side.
            let sign = |p: DVec3| if crossing { p.x } else { p.y };
            let first = sign(branch.points[0].position);
            assert!(branch.points.iter().all(|p| sign(p.position) * first > 0.0), "{radius}");
        }
    }
}

#[test]
fn a_torus_that_lies_on_a_plane_touches_it_along_a_circle() {
    let ring = solid(torus(2.0, 1.0).unwrap(), 0.01, DAffine3::IDENTITY);
    let found = curves(&ring, level(-1.0, 4.0).sheet());
    assert_eq!((found.branches.len(), found.touching.len()), (1, 0));
    check(&found, &[&|p| p.y + 1.0, &|p| p.x.hypot(p.z) - 2.0], 1e-14, 1e-12);
    let branch = &found.branches[0];
    assert!(branch.is_closed && marks(branch, Mark::Tangent) == branch.points.len());
    let found = curves(&ring, level(-1.0 + 1e-6, 4.0).sheet());
    assert_eq!(found.branches.len(), 2);
    let half = (1.0 - (1.0 - 1e-6_f64).powi(2)).sqrt();
    check(&found, &[&|p| (p.x.hypot(p.z) - 2.0).abs() - half], 1e-14, 1e-12);
    assert!(found.branches.iter().all(|branch| branch.is_closed));
}

#[test]
fn edges_of_a_block_become_corners_of_the_curve() {
    let ball = solid(sphere(1.2).unwrap(), 0.01, DAffine3::from_rotation_z(0.3));
    let cube = solid(block(DVec3::splat(2.0)).unwrap(), 1.0, DAffine3::IDENTITY);
    let found = curves(&ball, &cube);
    // The sphere comes through the faces and not as far as the edges.
    assert_eq!(found.branches.len(), 6);
    check(&found, &[&|p| p.length() - 1.2, &|p| p.abs().max_element() - 1.0], 1e-14, 1e-14);
    let ball = solid(sphere(1.5).unwrap(), 0.01, DAffine3::from_rotation_z(0.3));
    let found = curves(&ball, &cube);
    assert_eq!(found.branches.len(), 8, "a triangle of arcs around each corner");
    check(&found, &[&|p| p.length() - 1.5, &|p| p.abs().max_element() - 1.0], 1e-14, 1e-14);
    for branch in &found.branches {
        assert_eq!(marks(branch, Mark::Corner), 6);
        for point in branch.points.iter().filter(|point| point.mark == Mark::Corner) {
            let ones = point.position.abs().to_array().iter().filter(|c| (**c - 1.0).abs() < 1e-14).count();
            assert_eq!(ones, 2);
        }
    }
}

#[test]
fn results_and_bare_meshes_are_sides_too() {
    let ball = solid(sphere(1.0).unwrap(), 0.01, DAffine3::IDENTITY);
    let drill = solid(cylinder(0.5, 3.0).unwrap(), 0.01, DAffine3::IDENTITY);
    let less = Expression::difference(Expression::Operand(0), Expression::Operand(1));
    let (ring, _) = ExactSolid::evaluate(&[&ball, &drill], &less).unwrap();
    let found = curves(&ring, Open::square(DVec3::ZERO, DVec3::X, DVec3::Y, 2.0).sheet());
    // A section of the ring: two closed curves of two arcs and two lines.
    assert_eq!(found.branches.len(), 2);
    check(&found, &[&|p| p.z, &|p| (p.length() - 1.0) * (p.x.hypot(p.z) - 0.5)], 1e-14, 1e-14);
    // What the rounded triangles of a result have for its edge is near to the exact one: the corners are exact.
    for branch in &found.branches {
        let corners: Vec<_> = branch.points.iter().filter(|point| point.mark == Mark::Corner).collect();
        assert_eq!(corners.len(), 4);
        assert!(corners.iter().all(|c| (c.position.abs() - DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)).length() < 1e-14));
    }
    let (mesh, _) = ring.into_parts();
    let bare = Mesh { vertices: mesh.vertices, triangles: mesh.triangles, ..Mesh::default() };
    let cut = level(0.1, 2.0);
    let found = curves(ExactSheet::new(&bare, &[]), cut.sheet());
    assert_eq!(found.branches.len(), 2);
    check(&found, &[&|p| p.y - 0.1], 1e-14, 1e-14);
}

#[test]
fn the_teapot_is_cut_through_all_its_patches() {
    let pot = Open::new(&teapot(), 0.02);
    for normal in [DVec3::new(0.1, 1.0, 0.2), DVec3::new(0.3, 0.2, 1.0)] {
        let unit = normal.normalize();
        let across = unit.any_orthonormal_vector();
        let at = DVec3::new(0.0, 1.37, 0.0);
        let plane = Open::square(at, across, unit.cross(across), 6.0);
        let found = curves(pot.sheet(), plane.sheet());
        check(&found, &[&|p| (p - at).dot(unit)], 1e-12, 1e-12);
        for point in found.points() {
            let place = point.coordinates[0];
            let surface = pot.surfaces[place.surface.unwrap() as usize].as_ref().unwrap();
            assert!(surface.point(place.uv).distance(point.position) < 1e-12);
        }
        let ends: Vec<[Mark; 2]> = found
            .branches
            .iter()
            .filter(|branch| !branch.is_closed)
            .map(|branch| [branch.points[0].mark, branch.points[branch.points.len() - 1].mark])
            .collect();
        assert!(found.branches.len() >= 2 && ends.iter().flatten().all(|mark| *mark == Mark::End));
    }
}

#[test]
fn the_work_grows_with_the_points() {
    let count = |chord: f64| {
        let ball = solid(sphere(1.0).unwrap(), chord, DAffine3::IDENTITY);
        let found = curves(&ball, level(0.3, 2.0).sheet());
        (found.counts.raw, found.counts.pairs)
    };
    let ((few, some), (many, more)) = (count(1e-2), count(1e-4));
    assert!(many > 8 * few && (more as f64 / some as f64) < 2.0 * many as f64 / few as f64);
}

#[test]
fn sheets_that_coincide_say_so() {
    let one = solid(block(DVec3::ONE).unwrap(), 1.0, DAffine3::IDENTITY);
    let two = solid(block(DVec3::ONE).unwrap(), 1.0, moved(0.5, 1.0, 0.0));
    let found = curves(&one, &two);
    assert!(found.counts.coincident > 0);
    check(&found, &[&|p| p.y - 0.5], 1e-15, 1e-15);
    let ball = |chord: f64| solid(sphere(1.0).unwrap(), chord, DAffine3::IDENTITY);
    let found = curves(&ball(0.01), &ball(0.013));
    assert!(found.points().all(|point| point.angle < 1e-5));
}
