//! Facts about motion while the shutter is open: how long a point is covered, lit or mirrored, in closed form.

use super::tests::{diffuse, from_above, mirror, object, red, scene, trace};
use super::*;
use crate::color::Color;
use crate::illumination::Light;
use crate::scene::{Camera, Motion, Object, Scene, Shape, View};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const STILL: Motion = Motion { by: DVec3::ZERO, through: DVec3::ZERO, axis: DVec3::Y, angle: 0.0 };

fn plate(size: f64, at: DVec3, reflectance: f64) -> Object {
    object(Shape::Ground { size }, DMat4::from_translation(at), diffuse(reflectance))
}

/// Objects, of which one moves, under ambient light alone: radiance is reflectance.
fn ambient(objects: Vec<Object>, index: u32, motion: Motion, side: u32) -> Scene {
    let mut scene = Scene { ambient: DVec3::ONE, motions: vec![(index, motion)], ..scene(objects, Vec::new(), side) };
    scene.settings.image.samples = 256;
    scene
}

/// Mean of what is above 0 of a ramp with slope 1 over a pixel, at most 1.
fn ramp(from: f64, to: f64) -> f64 {
    let integral = |x: f64| {
        if x < 0.0 {
            0.0
        } else if x < 1.0 {
            0.5 * x * x
        } else {
            x - 0.5
        }
    };
    (integral(to) - integral(from)) / (to - from)
}

/// Compares a row of 64 pixels from -1 to 1 with means over them. Times are spread evenly, and independent of places in
/// the pixel: errors are chance where both decide.
fn compare(rendering: &Rendering, mean: impl Fn(f64, f64) -> f64) {
    let mut sum = 0.0;
    for x in 0..64 {
        let [from, to] = [x, x + 1].map(|k| f64::from(k) / 32.0 - 1.0);
        let (found, mean) = (red(rendering, x, 31), mean(from, to));
        assert!((found - mean).abs() < 0.02, "{x}: {found} {mean}");
        sum += (found - mean).abs();
    }
    assert!(sum / 64.0 < 3e-3, "{}", sum / 64.0);
}

#[test]
fn a_moving_edge_is_a_linear_ramp() {
    // The right edge goes from x = -1/2 to x = 1/2, in a picture from -1 to 1.
    let object = plate(20.0, DVec3::new(-10.0, 0.0, 0.0), 0.8);
    let scene = ambient(vec![object], 0, Motion { by: DVec3::X, ..STILL }, 64);
    // A point is covered from when the edge has passed it.
    let share = |from: f64, to: f64| ramp(0.5 - to, 0.5 - from);
    let rendering = trace(&scene, Some(from_above(1.0)), false, 2);
    compare(&rendering, |from, to| 0.8 * share(from, to));
    let covered = f64::from(rendering.picture.get(40, 31).expect("inside").coverage);
    assert!((covered - share(8.0 / 32.0, 9.0 / 32.0)).abs() < 0.02, "{covered}");
}

#[test]
fn the_time_in_which_the_shutter_is_open_scales_the_ramp() {
    for shutter in [0.0, 0.25] {
        let mut scene =
            ambient(vec![plate(20.0, DVec3::new(-10.0, 0.0, 0.0), 1.0)], 0, Motion { by: DVec3::X, ..STILL }, 64);
        scene.settings.geometry.shutter = shutter;
        let rendering = trace(&scene, Some(from_above(1.0)), false, 2);
        let blurred = (0..64).filter(|x| (0.01..0.99).contains(&red(&rendering, *x, 31))).count();
        assert!(blurred.abs_diff((shutter * 32.0) as usize) <= 1, "{shutter}: {blurred}");
    }
}

#[test]
fn a_square_that_turns_by_a_right_angle_covers_as_much_as_the_circle_says() {
    let scene = ambient(vec![plate(1.0, DVec3::ZERO, 1.0)], 0, Motion { angle: FRAC_PI_2, ..STILL }, 64);
    let rendering = trace(&scene, Some(from_above(1.0)), false, 2);
    for x in 32..64 {
        let at = (f64::from(x) + 0.5 - 32.0) / 32.0;
        // Of all directions those in which the square reaches so far: 4 corners, each pi/4 - acos(a/r) to both sides.
        let share = |r: f64| {
            if r <= 0.5 {
                1.0
            } else if r < 0.5_f64.sqrt() {
                8.0 * (FRAC_PI_4 - (0.5 / r).acos()) / (2.0 * PI)
            } else {
                0.0
            }
        };
        let steps = 64;
        let point = |i: i32, j: i32| {
            let off = |k: i32| (f64::from(k) + 0.5) / f64::from(steps) - 0.5;
            share((at + off(i) / 32.0).hypot((0.5 + off(j)) / 32.0))
        };
        let mean = (0..steps * steps).map(|k| point(k % steps, k / steps)).sum::<f64>() / f64::from(steps * steps);
        let found = red(&rendering, x, 31);
        assert!((found - mean).abs() < 0.02, "{x}: {found} {mean}");
    }
}

#[test]
fn a_moving_plate_throws_a_shadow_that_is_a_ramp() {
    // Light from the right above, at 45 degrees: the shadow of the left edge goes from x = -1/2 to x = 1/2.
    let light =
        Light::Directional { direction: DVec3::new(-1.0, -1.0, 0.0), irradiance: Color::grey(PI * 2f64.sqrt()) };
    let objects = vec![plate(200.0, DVec3::ZERO, 1.0), plate(20.0, DVec3::new(10.0 + 6.0, 6.0, 0.0), 1.0)];
    let mut scene = scene(objects, vec![light], 64);
    scene.motions = vec![(1, Motion { by: DVec3::X, ..STILL })];
    scene.settings.image.samples = 256;
    // A point right of the edge is dark; the edge passes to the right, so that it becomes bright.
    compare(&trace(&scene, Some(from_above(1.0)), false, 2), |from, to| ramp(0.5 - to, 0.5 - from));
}

#[test]
fn a_rising_mirror_shows_an_edge_as_a_ramp() {
    // A mirror at 45 degrees in the plane y = x + c, c from -1/2 to 1/2, seen from above, shows at x what is to the
    // left at the height x + c: a wall above the height 0.
    let tilted = DMat4::from_rotation_z(FRAC_PI_4);
    let mirror = object(Shape::Ground { size: 20.0 }, tilted, mirror(1.0));
    let wall = Shape::from(Primitive::Box { size: DVec3::new(0.5, 50.0, 50.0) });
    let wall = object(wall, DMat4::from_translation(DVec3::new(-30.0, 25.0, 0.0)), diffuse(1.0));
    let scene = ambient(vec![wall, mirror], 1, Motion { by: DVec3::Y, ..STILL }, 64);
    compare(&trace(&scene, Some(from_above(1.0)), false, 2), |from, to| ramp(from + 0.5, to + 0.5));
}

#[test]
fn what_stands_still_in_an_octree_of_its_own_gives_the_same_picture() {
    let ball = Object {
        tolerance: Some(0.05),
        ..object(Shape::from(Primitive::Sphere { radius: 0.5 }), DMat4::IDENTITY, mirror(0.6))
    };
    let light = Light::Point { at: DVec3::new(1.0, 3.0, 1.0), intensity: Color::grey(20.0) };
    let mut scene = scene(vec![plate(4.0, DVec3::Y * -0.5, 0.7), ball], vec![light], 32);
    scene.settings.image.samples = 4;
    let [lean, forced] = [false, true].map(|everything| trace(&scene, Some(from_above(1.0)), everything, 2).picture);
    assert_eq!(lean.pixels(), forced.pixels(), "no time is sampled where nothing moves");
    scene.motions = vec![(1, STILL)];
    let moving = trace(&scene, Some(from_above(1.0)), false, 2).picture;
    for (a, b) in lean.pixels().iter().zip(moving.pixels()) {
        assert!((0..3).all(|k| (a.radiance[k] - b.radiance[k]).abs() < 1e-5));
    }
    let forced = trace(&scene, Some(from_above(1.0)), true, 1).picture;
    assert_eq!(moving.pixels(), forced.pixels());
}

#[test]
fn a_ball_that_rolls_keeps_its_texture_and_its_outline() {
    // A rotation about its middle changes nothing of a ball of one colour, wherever the exact surface is hit.
    let ball = Object {
        tolerance: Some(0.1),
        ..object(Shape::from(Primitive::Sphere { radius: 0.8 }), DMat4::IDENTITY, diffuse(1.0))
    };
    let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(PI) };
    let mut scene = scene(vec![ball], vec![light], 32);
    scene.settings.image.samples = 64;
    scene.motions = vec![(0, Motion { angle: 3.0, axis: DVec3::new(0.6, 0.0, 0.8), ..STILL })];
    let rendering = trace(&scene, Some(from_above(1.0)), false, 2);
    for (x, y) in [(16, 16), (22, 16), (16, 7), (25, 20)] {
        let [u, v] = [x, y].map(|k| (f64::from(k) + 0.5) / 16.0 - 1.0);
        let expected = (1.0 - (u * u + v * v) / 0.64).sqrt();
        assert!((red(&rendering, x, y) - expected).abs() < 5e-3, "{x} {y}: {expected}");
    }
}

#[test]
fn what_emits_cannot_move_and_nothing_moves_twice() {
    let mut lamp = plate(1.0, DVec3::ZERO, 0.5);
    lamp.material.as_mut().expect("given").emission = Color::grey(1.0);
    let failed = |scene: &Scene| Prepared::new(scene).expect_err("it is refused").to_string();
    let problem = failed(&ambient(vec![lamp], 0, STILL, 8));
    assert!(problem.contains("cannot move"), "{problem}");
    let mut twice = ambient(vec![plate(1.0, DVec3::ZERO, 0.5)], 0, STILL, 8);
    twice.motions.push((0, STILL));
    assert!(failed(&twice).contains("two motions"));
    twice.motions = vec![(3, STILL)];
    assert!(failed(&twice).contains("no object 3"));
    twice.motions = vec![(0, Motion { axis: DVec3::ZERO, ..STILL })];
    assert!(failed(&twice).contains("axis"));
}

#[test]
fn a_camera_that_moves_sees_what_a_still_one_sees_of_objects_that_move_the_other_way() {
    let plates = || {
        let small = |x: f64, y: f64, reflectance: f64| plate(0.5, DVec3::new(x, y, 0.1 * x), reflectance);
        // The last comes into view as the shutter closes.
        vec![small(-0.4, 0.0, 0.3), small(0.3, 0.2, 0.6), small(1.35, 0.0, 0.9)]
    };
    for (camera_motion, opposite) in [
        (Motion { by: DVec3::X * 0.9, ..STILL }, Motion { by: DVec3::X * -0.9, ..STILL }),
        (Motion { angle: 0.8, ..STILL }, Motion { angle: -0.8, ..STILL }),
    ] {
        let mut still = ambient(plates(), 0, opposite, 32);
        still.motions = (0..3).map(|object| (object, opposite)).collect();
        let moving = Scene { motions: Vec::new(), ..still.clone() };
        let eye = Camera {
            from: DVec3::Y * 5.0,
            at: DVec3::ZERO,
            up: DVec3::NEG_Z,
            field_of_view: 2.0 * 0.2_f64.atan().to_degrees(),
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        };
        let [by_camera, by_objects] = [
            trace(&moving, Some(View::Camera(Camera { motion: Some(camera_motion), ..eye })), false, 1),
            trace(&still, Some(View::Camera(eye)), false, 1),
        ];
        let mut seen = [0.0; 2];
        for (x, y) in (0..32).flat_map(|x| (0..32).map(move |y| (x, y))) {
            let [one, other] = [&by_camera, &by_objects].map(|rendering| red(rendering, x, y));
            assert!((one - other).abs() < 1e-9, "{x} {y}: {one} {other}");
            seen = [seen[0] + one, seen[1].max(red(&by_camera, 31, y))];
        }
        assert!(seen[0] > 10.0 && seen[1] > 0.02, "{seen:?}");
    }
}
