//! Photon tracing at the extremes: each picture is held against a closed form or an invariant.

use super::caustic_tests::{down_on, fresnel};
use super::tests::{diffuse, from_above, mirror, object, red, scene};
use super::two_way_tests::{ball, block, from_below, glass, lamp, mirror_under_a_ceiling, two_way};
use super::*;
use crate::color::Color;
use crate::illumination::Light;
use crate::illumination::light::LightShape;
use crate::illumination::material::{MaterialKind, RefractiveIndex, Transparent};
use crate::picture::difference;
use crate::render::two_way::FluxBalance;
use crate::scene::{Composite, Object, Operation, Scene, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use std::f64::consts::PI;

/// Traces photons, and asks that their flux is finite and that no more arrives than was sent.
fn followed(mut scene: Scene, view: Option<View>, photons: u32) -> (Rendering, FluxBalance) {
    scene.settings.photons.count = photons;
    let rendering = two_way(&scene, view, 2);
    let finite = |pixel: &crate::picture::Pixel| pixel.radiance.iter().all(|band| band.is_finite() && *band >= 0.0);
    assert!(rendering.picture.pixels().iter().all(finite));
    let balance = rendering.flux_balance.expect("photons are traced");
    let parts = [balance.straight, balance.stored, balance.absorbed, balance.escaped, balance.stopped];
    assert!(parts.iter().all(|part| *part > -1e-9 * balance.sent), "{balance}");
    (rendering, balance)
}

fn floor(size: f64, below: f64) -> Object {
    block(DVec3::new(size, 0.1, size), DVec3::new(0.0, -below - 0.05, 0.0), diffuse(0.5))
}

/// The flux that a picture of the square -half..half of a floor shows, W.
fn shown(rendering: &Rendering, half: f64) -> f64 {
    let pixels = rendering.picture.pixels();
    let mean = pixels.iter().map(|p| f64::from(p.radiance[0])).sum::<f64>() / pixels.len() as f64;
    mean * PI / 0.5 * 4.0 * half * half
}

#[test]
fn a_burning_mirror_gathers_all_light_in_a_point() {
    // A paraboloid cut into a plate, hollow downwards; its focus 1 below its tip.
    let cut = object(
        Shape::from(Primitive::Paraboloid { radius: 1.0, height: 0.25 }),
        DMat4::from_translation(DVec3::Y * (1.0 - 0.125)),
        mirror(0.9),
    );
    let plate = object(
        Shape::from(Primitive::Box { size: DVec3::new(2.4, 0.5, 2.4) }),
        DMat4::from_translation(DVec3::Y),
        diffuse(0.0),
    );
    let hollow = Composite { operation: Operation::Difference, operands: vec![plate, cut], nesting: 1 };
    // A small plate at the focus, which sees nothing but the mirror, and keeps little light from it.
    let small = block(DVec3::new(0.2, 0.01, 0.2), DVec3::Y * -0.005, diffuse(0.5));
    let hollow = Object { material: None, ..object(Shape::Composite(Box::new(hollow)), DMat4::IDENTITY, mirror(0.9)) };
    let light = Light::Directional { direction: DVec3::Y, irradiance: Color::grey(1.0) };
    let mut scene = scene(vec![hollow, small], vec![light], 32);
    scene.settings.image.samples = 16;
    let (rendering, balance) = followed(scene, Some(down_on(DVec3::ZERO, 0.02, 0.2)), 50_000);
    let expected = 0.9 * (PI - 0.04);
    assert!((balance.stored / expected - 1.0).abs() < 0.01, "{} {expected}", balance.stored);
    // A disc is never wider than what holds a few hundred photons.
    assert!((shown(&rendering, 0.02) / expected - 1.0).abs() < 0.1, "{} {expected}", shown(&rendering, 0.02));
}

#[test]
fn a_ball_of_index_2_gathers_light_where_it_stands() {
    let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
    let mut scene = scene(vec![ball(1.0, DVec3::Y, glass(2.0)), floor(6.0, 0.0)], vec![light], 16);
    scene.settings.image.samples = 4;
    let (_, balance) = followed(scene, Some(from_above(2.0)), 30_000);
    assert!(balance.stored > 0.5 * PI && balance.stored < PI);
}

#[test]
fn a_beam_of_a_ten_thousandth_of_a_degree_finds_its_mirror() {
    let outer = 1e-4f64;
    let at = DVec3::new(0.0, 1.0, 0.0);
    for (inner, flat) in [(0.0, 0.5), (outer * (1.0 - 1e-9), 1.0)] {
        let light =
            Light::Spot { at, direction: DVec3::new(0.3, -1.0, 0.1), intensity: Color::grey(1e12), inner, outer };
        let objects = vec![
            block(DVec3::new(2.0, 0.1, 2.0), DVec3::new(0.0, -0.05, 0.0), mirror(0.8)),
            block(DVec3::new(4.0, 0.1, 4.0), DVec3::new(0.0, 3.05, 0.0), diffuse(0.5)),
        ];
        let (_, balance) = followed(scene(objects, vec![light], 8), Some(from_below()), 20_000);
        let power = 1e12 * 2.0 * PI * 2.0 * (0.5 * outer.to_radians()).sin().powi(2) * flat;
        assert!((balance.stored / (0.8 * power) - 1.0).abs() < 0.01, "{} {}", balance.stored, 0.8 * power);
    }
}

#[test]
fn a_lamp_of_a_millionth_is_a_point_that_follows_lambert() {
    let size = 1e-6;
    let patch = LightShape::Disc { center: DVec3::Y, normal: DVec3::NEG_Y, radius: size };
    let mut scene = mirror_under_a_ceiling(3.0, 15);
    scene.lights = vec![Light::Area { patch, radiance: Color::grey(10.0 / patch.area()) }];
    let (rendering, _) = followed(scene, Some(from_below()), 100_000);
    for x in [0, 2, 12, 14] {
        let square = ((f64::from(x) + 0.5) / 15.0 * 3.0 - 1.5f64).powi(2) + 16.0;
        let expected = 0.5 / PI * 0.8 * 10.0 * 16.0 / (square * square);
        let found = red(&rendering, x, 7);
        assert!((found / expected - 1.0).abs() < 0.12, "{x}: {found} {expected}");
    }
}

#[test]
fn a_rod_guides_light_through_a_hundred_reflections() {
    let (index, length) = (2.42, 330.0);
    let rod = block(DVec3::new(1.0, length, 1.0), DVec3::ZERO, glass(index));
    let top = DVec3::new(0.0, 0.5 * length, 0.1);
    let direction = DVec3::new(1.0, -1.0, 0.0);
    let light = Light::Spot { at: top - direction, direction, intensity: Color::grey(1.0), inner: 0.1, outer: 0.2 };
    let reflected = fresnel(index, 0.5f64.sqrt());
    let power = 2.0 * PI * (1.0 - 0.5 * (0.1f64.to_radians().cos() + 0.2f64.to_radians().cos()));
    let scene = scene(vec![rod, floor(20.0, 0.5 * length + 1.0)], vec![light], 4);
    let (_, balance) = followed(scene, Some(from_above(5.0)), 20_000);
    let found = [balance.stored, balance.escaped, balance.stopped].map(|part| part / power);
    // What comes back from the far end has too many scattering events before it.
    let expected = [(1.0 - reflected).powi(2), reflected, (1.0 - reflected) * reflected];
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01), "{found:?} {expected:?}");
}

#[test]
fn a_cut_diamond_gives_back_all_light_that_falls_on_its_table() {
    // A brilliant in a dark room: table, and eight facets of crown, girdle and pavilion each.
    let half = |normal: DVec3, at: DVec3| object(Shape::HalfSpace { normal, at }, DMat4::IDENTITY, glass(2.42));
    let around = |tilt: f64, turn: f64, at: f64| {
        let (sin, cos) = tilt.to_radians().sin_cos();
        let facet = move |k: u32| {
            let (z, x) = ((f64::from(k) + turn) * PI / 4.0).sin_cos();
            half(DVec3::new(x * sin, cos, z * sin), DVec3::new(x * at, 0.0, z * at))
        };
        (0..8).map(facet)
    };
    let facets = around(34.5, 0.0, 1.0).chain(around(90.0, 0.5, 0.95)).chain(around(180.0 - 40.75, 0.0, 0.98));
    let rough = block(DVec3::splat(3.0), DVec3::ZERO, glass(2.42));
    let operands = [rough, half(DVec3::Y, DVec3::Y * 0.3)].into_iter().chain(facets).collect();
    let stone = Composite { operation: Operation::Intersection, operands, nesting: 1 };
    let stone = Object { material: None, ..object(Shape::Composite(Box::new(stone)), DMat4::IDENTITY, glass(2.42)) };
    let mut objects = vec![stone];
    for axis in DVec3::AXES {
        let size = DVec3::splat(8.2) - axis * 8.1;
        objects.extend([-1.0, 1.0].map(|sign| block(size, axis * sign * 4.05, diffuse(0.5))));
    }
    let light = Light::Spot {
        at: DVec3::new(0.3, 3.0, 0.2),
        direction: DVec3::new(-0.3, -2.7, -0.2),
        intensity: Color::grey(1.0),
        inner: 3.0,
        outer: 4.0,
    };
    let mut scene = scene(objects, vec![light], 8);
    scene.settings.image.samples = 1;
    let (_, balance) = followed(scene, Some(from_above(3.9)), 20_000);
    assert!(balance.straight == 0.0 && balance.escaped == 0.0, "{balance}");
    assert!(balance.stored > 0.999 * balance.sent && balance.stopped < 1e-3 * balance.sent, "{balance}");
}

#[test]
fn a_box_of_perfect_mirrors_keeps_all_light_for_the_ball_in_it() {
    let mut objects = vec![ball(0.3, DVec3::new(0.2, -0.3, 0.1), diffuse(0.7))];
    for axis in DVec3::AXES {
        let size = DVec3::splat(2.2) - axis * 2.1;
        objects.extend([-1.0, 1.0].map(|sign| block(size, axis * sign * 1.05, mirror(1.0))));
    }
    let mut scene = scene(objects, vec![lamp(DVec3::new(0.3, 0.5, -0.2), 1.0)], 8);
    scene.settings.image.samples = 1;
    let (_, balance) = followed(scene, Some(from_above(0.9)), 5_000);
    assert!(balance.escaped.abs() < 1e-6 * balance.sent && balance.absorbed.abs() < 1e-9 * balance.sent, "{balance}");
    let all = balance.straight + balance.stored + balance.stopped;
    assert!((all / (4.0 * PI) - 1.0).abs() < 0.02 && balance.stopped < 0.05 * all, "{balance}");
}

#[test]
fn lamps_in_corners_and_on_surfaces_send_no_more_than_they_have() {
    let objects = || {
        vec![
            floor(4.0, 0.0),
            block(DVec3::new(0.1, 2.0, 4.0), DVec3::new(-2.05, 1.0, 0.0), mirror(1.0)),
            block(DVec3::new(4.0, 2.0, 0.1), DVec3::new(0.0, 1.0, -2.05), diffuse(0.5)),
            block(DVec3::splat(1.0), DVec3::new(0.5, 0.5, 0.5), glass(1.5)),
            ball(0.5, DVec3::new(-1.0, 0.5, 0.5), glass(1.5)),
        ]
    };
    // In the corner; on the mirror, the floor, a face, an edge and a corner of the block, and the ball.
    let places = [
        (-2.0, 0.0, -2.0),
        (-2.0, 1.0, 0.3),
        (0.3, 0.0, -1.0),
        (0.4, 1.0, 0.6),
        (0.0, 1.0, 0.3),
        (1.0, 1.0, 1.0),
        (-1.0, 1.0, 0.5),
    ];
    for (x, y, z) in places {
        let at = DVec3::new(x, y, z);
        let (_, balance) = followed(scene(objects(), vec![lamp(at, 1.0)], 8), Some(from_above(2.0)), 10_000);
        assert!(balance.sent < 4.2 * PI && balance.gained.abs() < 0.1 * balance.sent, "{at}: {balance}");
    }
    // A lamp in the plane of a face.
    let patch = LightShape::Rectangle { corner: DVec3::new(0.2, 1.0, 0.2), across: DVec3::X * 0.5, up: DVec3::Z * 0.5 };
    let light = Light::Area { patch, radiance: Color::grey(1.0) };
    let (_, balance) = followed(scene(objects(), vec![light], 8), Some(from_above(2.0)), 10_000);
    assert!(balance.sent < 0.26 * PI, "{balance}");
}

/// A mirror that lights a ceiling, all of it as often as large and elsewhere.
fn elsewhere(size: f64, by: DVec3) -> Rendering {
    let mut scene = mirror_under_a_ceiling(3.0, 16);
    let to = DMat4::from_translation(by) * DMat4::from_scale(DVec3::splat(size));
    scene.objects.iter_mut().for_each(|object| object.transform = to * object.transform);
    scene.lights = vec![lamp(to.transform_point3(DVec3::Y), 10.0 * size * size)];
    let View::Camera(mut camera) = from_below() else { panic!("a camera") };
    (camera.from, camera.at) = (to.transform_point3(camera.from), to.transform_point3(camera.at));
    followed(scene, Some(View::Camera(camera)), 20_000).0
}

#[test]
fn size_and_place_of_a_scene_do_not_show() {
    // Rounding decides here and there which disc is taken.
    let plain = elsewhere(1.0, DVec3::ZERO);
    let far = DVec3::new(1e7, -1e7, 1e7);
    for (size, by, most) in
        [(1e-6, DVec3::ZERO, 0.02), (1e6, DVec3::ZERO, 0.02), (1.0, far, 0.05), (1e6, far * 1e6, 0.05)]
    {
        let rmse = difference(&plain.picture, &elsewhere(size, by).picture).expect("alike").rmse;
        let mean = plain.picture.pixels().iter().map(|p| f64::from(p.radiance[0])).sum::<f64>() / 256.0;
        assert!(rmse < most * mean, "{size} {by}: {rmse} of {mean}");
    }
}

#[test]
fn glass_of_no_index_is_not_there() {
    for index in [1.0 - 1e-9, 1.0, 1.0 + 1e-9] {
        let pane = block(DVec3::new(6.0, 0.2, 6.0), DVec3::Y * 0.5, glass(index));
        let scene = scene(vec![floor(4.0, 0.0), pane], vec![lamp(DVec3::Y * 2.0, 10.0)], 16);
        let (rendering, _) = followed(scene, Some(from_above(1.5)), 100_000);
        let mut squares = 0.0;
        for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
            let at = |i: u32| (f64::from(i) + 0.5) / 16.0 * 3.0 - 1.5;
            let expected = 0.5 / PI * 20.0 / (at(x).powi(2) + at(y).powi(2) + 4.0).powf(1.5);
            let error = red(&rendering, x, y) / expected - 1.0;
            assert!(error.abs() < 0.25, "{index} {x} {y}: {error}");
            squares += error * error;
        }
        assert!(f64::sqrt(squares / 256.0) < 0.06, "{index}: {squares}");
    }
}

#[test]
fn a_lamp_within_a_ball_of_glass_shines_as_if_alone_but_for_what_the_glass_absorbs() {
    for (index, absorption) in [(1.5, 0.0), (2.42, 0.0), (1.5, 0.8)] {
        let inside =
            Transparent { absorption: Color::grey(absorption), ..Transparent::clear(RefractiveIndex::Constant(index)) };
        let objects = vec![ball(0.5, DVec3::ZERO, MaterialKind::Transparent(inside)), floor(4.0, 3.0)];
        let scene = scene(objects, vec![lamp(DVec3::ZERO, 10.0)], 8);
        let (rendering, _) = followed(scene, Some(down_on(DVec3::NEG_Y * 3.0, 0.5, 1.0)), 100_000);
        // All that is reflected comes to the middle and on to the other side.
        let (passed, reflected) = ((-0.5 * absorption).exp(), fresnel(index, 1.0));
        let factor = passed * (1.0 - reflected) / (1.0 - reflected * passed * passed);
        let (mut all, mut sum) = (0.0, 0.0);
        for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
            let at = |i: u32| (f64::from(i) + 0.5) / 8.0 - 0.5;
            sum += 0.5 / PI * 30.0 * factor / (at(x).powi(2) + at(y).powi(2) + 9.0).powf(1.5);
            all += red(&rendering, x, y);
        }
        assert!((all / sum - 1.0).abs() < 0.02, "{index} {absorption}: {all} {sum}");
    }
}
