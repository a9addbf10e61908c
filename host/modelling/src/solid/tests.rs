//! Boolean operations against closed forms and set identities.

use super::boolean::{self, Expression, Outcome, overlapping_up_to, resolve};
use super::{Solid, SolidError};
use crate::mesh::{Mesh, bunny};
use crate::numeric::exact::{ExactNumber, cross, dot};
use crate::octree::TriangleBvh;
use crate::surface::{Sphere, Surface, Tolerance, box_faces, tessellate};
use glam::{DAffine3, DVec3};
use rand::{RngExt, SeedableRng};

fn cube(low: DVec3, high: DVec3) -> Mesh {
    tessellate(&box_faces(low, high), Tolerance::new(1.0, 90.0)).unwrap()
}

fn ball(center: DVec3, radius: f64, chord: f64) -> Mesh {
    tessellate(&[Sphere::new(center, radius)], Tolerance::new(chord, 90.0)).unwrap()
}

fn moved(mesh: &Mesh, by: DAffine3) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.vertices.iter_mut().for_each(|v| *v = by.transform_point3(*v));
    mesh
}

/// Whether each edge is traversed as often one way as the other.
fn balanced(mesh: &Mesh) -> bool {
    let mut edges = std::collections::HashMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    edges.values().all(|n| *n == 0)
}

fn evaluate(meshes: Vec<&Mesh>, expression: &Expression) -> Outcome {
    let sorted: Vec<TriangleBvh> =
        meshes.iter().map(|mesh| TriangleBvh::new(&mesh.vertices, &mesh.triangles)).collect();
    let quad_partners: Vec<Vec<u32>> = meshes.iter().map(|mesh| boolean::quad_partners(mesh)).collect();
    let operand = |k: usize| boolean::Operand {
        mesh: meshes[k],
        sorted: &sorted[k],
        quad_partners: &quad_partners[k],
        overlaps: &[],
    };
    boolean::evaluate((0..meshes.len()).map(operand).collect(), expression).unwrap()
}

#[test]
fn corners_of_results_keep_the_parameters_of_their_faces() {
    // A notch across the line that divides the top, a hole through its middle, and a corner cut off.
    let ends = [
        [DVec3::ZERO, DVec3::ONE],
        [DVec3::new(0.2, 0.6, 0.25), DVec3::new(0.5, 2.0, 0.9)],
        [DVec3::new(0.55, -1.0, 0.3), DVec3::new(0.7, 2.0, 0.8)],
        [DVec3::splat(0.8), DVec3::splat(1.5)],
    ];
    let faces = ends.map(|[low, high]| box_faces(low, high));
    let [one, two @ ..] = ends.map(|[low, high]| cube(low, high));
    let rest = Expression::Union((1..4).map(Expression::Operand).collect());
    let outcome =
        evaluate([&one].into_iter().chain(&two).collect(), &Expression::difference(Expression::Operand(0), rest));
    assert!((outcome.mesh.signed_volume() - (1.0 - 0.3 * 0.4 * 0.65 - 0.15 * 0.5 - 0.008)).abs() < 1e-14);
    let mut seen = 0;
    for (triangle, source) in outcome.sources.iter().enumerate() {
        let face = &faces[source[0] as usize][one.surfaces[source[1] as usize] as usize];
        for (place, uv) in outcome.mesh.corners(triangle).into_iter().zip(outcome.mesh.corner_parameters[triangle]) {
            assert!(face.point(uv).distance(place) < 2e-15, "{place} {uv}");
            seen += 1;
        }
    }
    assert!(seen > 100);
}

fn all(one: &Mesh, two: &Mesh) -> [Outcome; 4] {
    let (a, b) = (Expression::Operand(0), Expression::Operand(1));
    let both = vec![a.clone(), b.clone()];
    let outcomes = [
        Expression::Union(both.clone()),
        Expression::Intersection(both.clone()),
        Expression::difference(a, b),
        Expression::SymmetricDifference(both),
    ]
    .map(|e| evaluate(vec![one, two], &e));
    for outcome in &outcomes {
        assert!(balanced(&outcome.mesh), "{:?}", outcome.counts);
        assert_eq!(outcome.mesh.validate(), Ok(()));
    }
    outcomes
}

/// Checks |A| + |B| = |A u B| + |A n B| and its kin; returns the volume of the intersection.
fn check(one: &Mesh, two: &Mesh) -> f64 {
    let [union, common, less, either] = all(one, two).map(|o| o.mesh.signed_volume());
    let [a, b] = [one, two].map(Mesh::signed_volume);
    let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-12 * (a + b), "{x} {y}");
    close(a + b, union + common);
    close(less, a - common);
    close(either, union - common);
    common
}

#[test]
fn cubes_in_every_position() {
    let unit = cube(DVec3::ZERO, DVec3::ONE);
    let steps = [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0];
    for x in steps {
        for y in steps {
            for z in steps {
                for size in [DVec3::ONE, DVec3::new(0.5, 1.0, 2.0)] {
                    let at = DVec3::new(x, y, z);
                    let common = check(&unit, &cube(at, at + size));
                    let sides = (at + size).min(DVec3::ONE) - at.max(DVec3::ZERO);
                    let expected = sides.max(DVec3::ZERO).element_product();
                    assert!((common - expected).abs() < 1e-15, "{at} {size}: {common} {expected}");
                }
            }
        }
    }
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn a_solid_less_itself_is_empty() {
    for mesh in [cube(DVec3::ZERO, DVec3::ONE), ball(DVec3::ONE, 2.0, 0.01), bunny().expect("it ships")] {
        let [union, common, less, either] = all(&mesh, &mesh);
        assert!(less.mesh.triangles.is_empty() && either.mesh.triangles.is_empty());
        for result in [union, common] {
            assert!((result.mesh.signed_volume() / mesh.signed_volume() - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn spheres_and_bunnies_that_overlap() {
    let (one, two) = (ball(DVec3::ZERO, 1.0, 1e-3), ball(DVec3::new(0.7, 0.2, 0.1), 1.0, 1e-3));
    let common = check(&one, &two);
    let d = DVec3::new(0.7, 0.2, 0.1).length();
    let lens = std::f64::consts::PI * (2.0 - d).powi(2) * (d * d + 4.0 * d) / (12.0 * d);
    assert!((common / lens - 1.0).abs() < 3e-3, "{common} {lens}");
    let bunny = bunny().expect("it ships");
    check(&bunny, &moved(&bunny, DAffine3::from_translation(DVec3::new(0.1, 0.05, 0.02))));
}

/// The volume inside a mesh, without rounding but for the last.
fn exact_volume(mesh: &Mesh) -> f64 {
    let mut sum = ExactNumber::default();
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle).map(|p| p.to_array().map(ExactNumber::from));
        sum = sum + dot(&a, &cross(&b, &c));
    }
    sum.over(&ExactNumber::from(6.0))
}

#[test]
fn tiny_turns_keep_their_slivers() {
    let unit = cube(DVec3::splat(-0.5), DVec3::splat(0.5));
    for power in 3..=15 {
        let turn = DAffine3::from_rotation_z(10f64.powi(-power));
        let turned = moved(&unit, turn);
        // Four right-angled triangles, each cut off from a corner by a side of the other square. All differences of
        // neighbouring numbers are exact, so that this is right to the last digits.
        let corner = |k: usize| [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)][k % 4];
        let expected: f64 = (0..4)
            .map(|k| {
                let at = |k: usize| DVec3::new(corner(k).0, corner(k).1, 0.5);
                let (p, q) = (turn.transform_point3(at(k + 3)), turn.transform_point3(at(k)));
                let (dx, dy) = (q.x - p.x, q.y - p.y);
                let c = at(k);
                let s = dx * (c.y - q.y) - dy * (c.x - q.x);
                s * s / (2.0 * (dx * dy).abs())
            })
            .sum();
        let [.., less, _] = all(&unit, &turned);
        let volume = exact_volume(&less.mesh);
        assert!((volume - expected).abs() < 1e-16, "1e-{power}: {volume} {expected}");
    }
}

/// A random expression in which each operand occurs once.
fn random_expression(random: &mut rand_pcg::Pcg64Mcg, operands: std::ops::Range<usize>) -> Expression {
    let count = operands.len();
    if count == 1 {
        return Expression::Operand(operands.start);
    }
    let middle = operands.start + random.random_range(1..count);
    let one = random_expression(random, operands.start..middle);
    let two = random_expression(random, middle..operands.end);
    match random.random_range(0..4) {
        0 => Expression::Intersection(vec![one, two]),
        1 => Expression::difference(one, two),
        2 => Expression::SymmetricDifference(vec![one, two]),
        _ => Expression::Union(vec![one, two]),
    }
}

#[test]
fn boxes_on_a_grid_have_the_volume_that_their_voxels_have() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(11);
    for round in 0..300 {
        let count = random.random_range(2..7);
        let side = if round % 3 == 0 { 3 } else { 6 };
        let boxes: Vec<[[i32; 3]; 2]> = (0..count)
            .map(|_| {
                let low = [0; 3].map(|_| random.random_range(0..side - 1));
                [low, low.map(|x| random.random_range(x + 1..side))]
            })
            .collect();
        // Sevenths have no exact numbers; equal ones are equal nevertheless.
        let at = |corner: [i32; 3]| DVec3::from(corner.map(f64::from)) / 7.0;
        let meshes: Vec<Mesh> = boxes.iter().map(|[low, high]| cube(at(*low), at(*high))).collect();
        let expression = random_expression(&mut random, 0..count);
        let outcome = evaluate(meshes.iter().collect(), &expression);
        let mut voxels = 0;
        for voxel in 0..side.pow(3) {
            let voxel = [voxel % side, voxel / side % side, voxel / side / side];
            let within = |[low, high]: &[[i32; 3]; 2]| (0..3).all(|k| (low[k]..high[k]).contains(&voxel[k]));
            voxels += u32::from(expression.contains(&boxes.iter().map(within).collect::<Vec<_>>()));
        }
        assert!(balanced(&outcome.mesh), "{round} {boxes:?} {expression:?}");
        let volume = outcome.mesh.signed_volume() * 343.0;
        assert!((volume - f64::from(voxels)).abs() < 1e-12, "{round} {boxes:?} {expression:?}: {volume} {voxels}");
    }
}

#[test]
fn many_turned_cubes_keep_the_identities() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(12);
    for _ in 0..20 {
        let mut turned = || {
            let mut number = || random.random_range(-1.0..1.0);
            let axis = DVec3::new(number(), number(), number()).normalize();
            let turn = DAffine3::from_axis_angle(axis, number() * 3.0);
            let shift = DAffine3::from_translation(DVec3::new(number(), number(), number()) * 0.4);
            moved(&cube(DVec3::splat(-0.5), DVec3::splat(0.5)), shift * turn)
        };
        let meshes = [turned(), turned(), turned(), turned()];
        let volume = |expression: &Expression| {
            let outcome = evaluate(meshes.iter().collect(), expression);
            assert!(balanced(&outcome.mesh));
            outcome.mesh.signed_volume()
        };
        // |A u B u C u D| by inclusion and exclusion.
        let mut sum = 0.0;
        for set in 1_usize..16 {
            let members: Vec<Expression> = (0..4).filter(|k| set >> k & 1 == 1).map(Expression::Operand).collect();
            let sign = if members.len() % 2 == 1 { 1.0 } else { -1.0 };
            sum += sign * volume(&Expression::Intersection(members));
        }
        let union = volume(&Expression::Union((0..4).map(Expression::Operand).collect()));
        assert!((union - sum).abs() < 1e-13, "{union} {sum}");
    }
}

/// A random ball, with a hollow in every third.
fn random_shell(random: &mut rand_pcg::Pcg64Mcg) -> Mesh {
    let center = DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)));
    let shell = ball(center, random.random_range(0.7..1.3), 0.02);
    if random.random_range(0..3) > 0 {
        return shell;
    }
    let hollow = ball(center, 0.45, 0.02);
    let less = Expression::difference(Expression::Operand(0), Expression::Operand(1));
    evaluate(vec![&shell, &hollow], &less).mesh
}

/// An expression evaluated operation by operation, two operands at a time.
fn by_steps(meshes: &[Mesh], expression: &Expression) -> Mesh {
    let [one, two] = [0, 1].map(Expression::Operand);
    let (parts, step): (&[Expression], _) = match expression {
        Expression::Operand(k) => return meshes[*k].clone(),
        Expression::Union(parts) => (parts, Expression::Union(vec![one, two])),
        Expression::Intersection(parts) => (parts, Expression::Intersection(vec![one, two])),
        Expression::Difference(parts) => (&parts[..], Expression::difference(one, two)),
        Expression::SymmetricDifference(parts) => (parts, Expression::SymmetricDifference(vec![one, two])),
    };
    let parts: Vec<Mesh> = parts.iter().map(|part| by_steps(meshes, part)).collect();
    parts.into_iter().reduce(|one, two| evaluate(vec![&one, &two], &step).mesh).unwrap()
}

#[test]
fn what_is_buried_is_not_missed() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(13);
    for round in 0..12 {
        let count = random.random_range(3..9);
        let meshes: Vec<Mesh> = (0..count).map(|_| random_shell(&mut random)).collect();
        let expression = match round {
            0..4 => Expression::Union((0..count).map(Expression::Operand).collect()),
            _ => random_expression(&mut random, 0..count),
        };
        let outcome = evaluate(meshes.iter().collect(), &expression);
        let steps = by_steps(&meshes, &expression);
        assert!(balanced(&outcome.mesh), "{round} {expression:?}");
        for (one, other) in [(outcome.mesh.signed_volume(), steps.signed_volume()), (outcome.mesh.area(), steps.area())]
        {
            assert!((one - other).abs() < 1e-10 * (1.0 + other), "{round} {expression:?}: {one} {other}");
        }
    }
}

#[test]
fn results_serve_as_operands() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(32);
    for round in 0..14 {
        // Cubes that nearly coincide, rotated by little or by much.
        let power = [-12.0, -15.0, -9.0, -14.0, -6.0, -1.0, -15.5][round % 7];
        let mut turned = || {
            let mut number = || random.random_range(-1.0..1.0);
            let axis = DVec3::new(number(), number(), number()).normalize();
            let shift = DVec3::new(number(), number(), number()).round() * 0.5;
            let turn = DAffine3::from_axis_angle(axis, number() * 10f64.powf(power));
            moved(&cube(DVec3::splat(-0.5), DVec3::splat(0.5)), DAffine3::from_translation(shift) * turn)
        };
        let meshes: Vec<Mesh> = (0..5).map(|_| turned()).collect();
        let (mut solid, mut expression) = (Solid::new(meshes[0].clone()).unwrap(), Expression::Operand(0));
        for (index, mesh) in meshes.iter().enumerate().skip(1) {
            let next = Solid::new(mesh.clone()).unwrap();
            let operand = Expression::Operand(index);
            (solid, expression) = match (round + index) % 3 {
                0 => (solid.difference(&next).unwrap(), Expression::difference(expression, operand)),
                1 => (solid.union(&next).unwrap(), Expression::Union(vec![expression, operand])),
                _ if index == 4 => {
                    (solid.intersection(&next).unwrap(), Expression::Intersection(vec![expression, operand]))
                }
                _ => (solid.union(&next).unwrap(), Expression::Union(vec![expression, operand])),
            };
            let at_once = evaluate(meshes.iter().collect(), &expression).mesh;
            let (step, whole) = (exact_volume(solid.mesh()), exact_volume(&at_once));
            assert!((step - whole).abs() < 1e-14, "{round} {index} 1e{power}: {step} {whole}");
            assert_eq!(Solid::new(solid.mesh().clone()).err(), None, "{round} {index} 1e{power}");
            assert!(balanced(&at_once), "{round} {index} 1e{power}");
        }
    }
}

/// Some meshes as one.
fn joined(meshes: &[Mesh]) -> Mesh {
    meshes.iter().fold(Mesh::default(), |mut all, mesh| {
        all.append(mesh, 0);
        all
    })
}

#[test]
fn surfaces_that_cross_themselves_are_refused_or_made_simple() {
    let unit = cube(DVec3::ZERO, DVec3::ONE);
    let half = DVec3::splat(0.5);
    let inner = cube(half * 0.5, half * 1.5);
    let turned = moved(&unit, DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.5));
    let cases = [
        ("cubes that cross", joined(&[unit.clone(), cube(half, half + 1.0)]), 1.875, 2),
        ("a cube twice", joined(&[unit.clone(), unit.clone()]), 1.0, 2),
        ("a cube in a cube", joined(&[unit.clone(), inner.clone()]), 1.0, 2),
        (
            "cubes that overlap in part of a face",
            joined(&[unit.clone(), cube(DVec3::new(0.5, 0.0, 0.25), DVec3::new(1.5, 1.0, 0.75))]),
            1.25,
            2,
        ),
        (
            "a cube and an inverted one that crosses it",
            joined(&[unit.clone(), cube(half, half + 1.0).reversed()]),
            0.875,
            -1,
        ),
        ("a turned cube", joined(&[unit.clone(), turned.clone()]), 2.0 - check(&unit, &turned), 2),
    ];
    for (name, mesh, volume, winding) in cases {
        match Solid::new(mesh.clone()) {
            Err(SolidError::Crossing { winding: found, .. }) => assert_eq!(found, winding, "{name}"),
            other => panic!("{name}: {other:?}"),
        }
        let overlaps = overlapping_up_to(&mesh, &TriangleBvh::new(&mesh.vertices, &mesh.triangles), usize::MAX);
        let simple = resolve(&mesh, &overlaps).unwrap().outcome.mesh;
        assert!((simple.signed_volume() - volume).abs() < 1e-15, "{name}: {} {volume}", simple.signed_volume());
        assert_eq!(Solid::new(simple.clone()).map(Solid::into_mesh), Ok(simple), "{name}");
    }
    // These touch themselves only.
    let hollow = joined(&[unit.clone(), inner.reversed()]);
    let by_edge = joined(&[unit.clone(), cube(DVec3::new(1.0, 1.0, 0.25), DVec3::new(2.0, 2.0, 1.0))]);
    let by_corner = joined(&[unit.clone(), cube(DVec3::ONE, DVec3::splat(2.0))]);
    let on_face = joined(&[unit.clone(), ball(DVec3::new(0.5, 0.5, 2.0), 1.0, 0.1)]);
    for (mesh, volume) in [(hollow, 0.875), (by_edge, 1.75), (by_corner, 2.0)] {
        let solid = Solid::new(mesh.clone()).unwrap();
        assert!((solid.mesh().signed_volume() - volume).abs() < 1e-15);
    }
    assert!(Solid::new(on_face).is_ok());
    // A wall inside is no border of anything.
    let halves = joined(&[unit.clone(), moved(&unit, DAffine3::from_translation(DVec3::X))]);
    let solid = Solid::new(halves).unwrap();
    assert_eq!((solid.mesh().triangles.len(), solid.mesh().signed_volume()), (20, 2.0));
}
