//! Facts about transparent bodies that overlap, touch and nearly touch: closed forms of stacks of slabs and nested
//! spheres.

use super::tests::{diffuse, object, red, scene, trace};
use super::*;
use crate::color::Color;
use crate::illumination::Material;
use crate::illumination::fresnel::Dielectric;
use crate::illumination::material::{MaterialKind, RefractiveIndex, Transparent};
use crate::numeric::bounds::Bounds;
use crate::scene::{Camera, Object, Parallel, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};

/// Surfaces are told apart that are further from each other than 1e-14 of their greatest coordinate.
const GAPS: [f64; 3] = [1e-3, 1e-8, 1e-12];

fn body(index: f64, absorption: f64, priority: i32) -> Material {
    let clear = Transparent::clear(RefractiveIndex::Constant(index));
    MaterialKind::Transparent(Transparent { absorption: Color::grey(absorption), priority, ..clear }).into()
}

/// A slab between two heights, wide enough for everything that goes to and fro in it.
fn slab([low, high]: [f64; 2], material: Material) -> Object {
    let size = DVec3::new(40.0, high - low, 40.0);
    let mut slab = object(
        Shape::from(Primitive::Box { size }),
        DMat4::from_translation(DVec3::new(0.0, 0.5 * (low + high), 0.0)),
        material,
    );
    slab.name = format!("from {low} to {high}");
    slab
}

/// The part of the light of a wide lamp far below that comes up at an angle.
fn passed(mut objects: Vec<Object>, degrees: f64) -> f64 {
    let mut lamp = Material::from(diffuse(0.0));
    lamp.emission = Color::grey(1.0);
    objects.push(object(Shape::Ground { size: 4000.0 }, DMat4::from_translation(DVec3::NEG_Y * 20.0), lamp));
    let mut scene = scene(objects, vec![], 1);
    (scene.settings.image.samples, scene.settings.light.reflection_depth) = (2048, 200);
    scene.settings.geometry.tolerance = Some(1e-3);
    let mut view = Camera::framing(&Bounds::of([DVec3::ZERO]));
    let (sin, cos) = degrees.to_radians().sin_cos();
    (view.from, view.at, view.up) = (DVec3::new(sin, cos, 0.0) * 10.0, DVec3::ZERO, DVec3::Z);
    (view.parallel, view.near) = (Some(Parallel { height: 1e-3, oblique: DVec2::ZERO }), 1e-3);
    red(&trace(&scene, Some(View::Camera(view)), false, 1), 0, 0)
}

/// Transmittance of layers one upon the other, the uppermost first: each its index, thickness and absorption.
///
/// Light goes to and fro between interfaces as the geometric series says, and no phases are known.
fn through(layers: &[[f64; 3]], degrees: f64) -> f64 {
    let sine = degrees.to_radians().sin();
    let cosine = |index: f64| (1.0 - (sine / index).powi(2)).sqrt();
    let (mut passes, mut reflects) = (1.0, 0.0);
    let above = |layer: usize| if layer == 0 { 1.0 } else { layers[layer - 1][0] };
    for layer in (0..=layers.len()).rev() {
        if let Some([index, thickness, absorption]) = layers.get(layer) {
            let part = (-absorption * thickness / cosine(*index)).exp();
            (passes, reflects) = (passes * part, reflects * part * part);
        }
        let (before, behind) = (above(layer), layers.get(layer).map_or(1.0, |layer| layer[0]));
        let r = Dielectric::new(before, behind).expect("indices").reflectance(cosine(before)).mean();
        let series = (1.0 - r) / (1.0 - r * reflects);
        (passes, reflects) = (passes * series, r + (1.0 - r) * reflects * series);
    }
    passes
}

#[test]
fn water_that_reaches_into_glass_ends_where_the_glass_begins() {
    for degrees in [0.0, 50.0] {
        for overlap in GAPS {
            let glass = || slab([0.0, 1.0], body(1.5, 0.3, 0));
            let water = || slab([-1.0, overlap], body(1.33, 0.1, Transparent::LIQUID));
            let expected = through(&[[1.5, 1.0, 0.3], [1.33, 1.0, 0.1]], degrees);
            for objects in [vec![glass(), water()], vec![water(), glass()]] {
                let found = passed(objects, degrees);
                assert!((found / expected - 1.0).abs() < 8e-3, "{overlap} at {degrees}: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_gap_of_air_is_there_however_thin() {
    for degrees in [0.0, 50.0] {
        for gap in GAPS {
            let objects =
                vec![slab([0.0, 1.0], body(1.5, 0.3, 0)), slab([-1.0, -gap], body(1.33, 0.1, Transparent::LIQUID))];
            let expected = through(&[[1.5, 1.0, 0.3], [1.0, gap, 0.0], [1.33, 1.0 - gap, 0.1]], degrees);
            let found = passed(objects, degrees);
            assert!((found / expected - 1.0).abs() < 8e-3, "{gap} at {degrees}: {found} {expected}");
        }
    }
}

#[test]
fn bodies_that_touch_have_one_interface() {
    for degrees in [0.0, 50.0] {
        let expected = through(&[[1.5, 1.0, 0.0], [1.33, 1.0, 0.0], [1.7, 1.0, 0.0]], degrees);
        let bodies = || {
            [
                slab([0.0, 1.0], body(1.5, 0.0, 0)),
                slab([-1.0, 0.0], body(1.33, 0.0, Transparent::LIQUID)),
                slab([-2.0, -1.0], body(1.7, 0.0, 0)),
            ]
        };
        let [a, b, c] = bodies();
        let [d, e, f] = bodies();
        for objects in [vec![a, b, c], vec![f, d, e]] {
            let found = passed(objects, degrees);
            assert!((found / expected - 1.0).abs() < 8e-3, "at {degrees}: {found} {expected}");
        }
    }
}

#[test]
fn of_bodies_in_one_place_the_greatest_priority_and_then_the_smallest_is_there() {
    // A bubble within water, water within ice that has a greater priority, and a part in which two of the same overlap.
    for (objects, layers) in [
        (
            vec![slab([-2.0, 2.0], body(1.33, 0.2, -1)), slab([-0.5, 0.5], body(1.0, 0.0, 0))],
            vec![[1.33, 1.5, 0.2], [1.0, 1.0, 0.0], [1.33, 1.5, 0.2]],
        ),
        (vec![slab([-0.5, 0.5], body(1.33, 0.2, -1)), slab([-2.0, 2.0], body(1.31, 0.1, 0))], vec![[1.31, 4.0, 0.1]]),
        (
            vec![slab([-2.0, 0.5], body(1.6, 0.2, 0)), slab([-0.5, 1.0], body(1.4, 0.1, 0))],
            vec![[1.4, 1.5, 0.1], [1.6, 1.5, 0.2]],
        ),
        (
            vec![slab([-2.0, 0.5], body(1.6, 0.2, 3)), slab([-0.5, 1.0], body(1.4, 0.1, 2))],
            vec![[1.4, 0.5, 0.1], [1.6, 2.5, 0.2]],
        ),
    ] {
        let (found, expected) = (passed(objects, 30.0), through(&layers, 30.0));
        assert!((found / expected - 1.0).abs() < 8e-3, "{layers:?}: {found} {expected}");
    }
}

#[test]
fn nested_spheres_pass_along_their_axis_what_slabs_do() {
    let ball = |radius: f64, material: Material| {
        let mut ball = object(Shape::from(Primitive::Sphere { radius }), DMat4::IDENTITY, material);
        ball.tolerance = Some(1e-4);
        ball
    };
    for gap in GAPS {
        // A ball of glass with a hollow, full of water that reaches into the glass.
        let objects =
            vec![ball(1.0, body(1.5, 0.1, 0)), ball(0.5, body(1.0, 0.0, -2)), ball(0.5 + gap, body(1.33, 0.2, -1))];
        // The hollow is of less priority than the glass about it: it would not be there, and neither is the water.
        let solid = through(&[[1.5, 2.0, 0.1]], 0.0);
        let found = passed(objects, 0.0);
        assert!((found / solid - 1.0).abs() < 8e-3, "{gap}: {found} {solid}");
        // The hollow of the same priority, and water of a greater one: all of the three are there.
        let objects =
            vec![ball(1.0, body(1.5, 0.1, 0)), ball(0.5, body(1.0, 0.0, 0)), ball(0.5 - gap, body(1.33, 0.2, 1))];
        let (wall, air, water) = ([1.5, 0.5, 0.1], [1.0, gap, 0.0], [1.33, 1.0 - 2.0 * gap, 0.2]);
        let expected = through(&[wall, air, water, air, wall], 0.0);
        let found = passed(objects, 0.0);
        assert!((found / expected - 1.0).abs() < 8e-3, "{gap}: {found} {expected}");
    }
}
