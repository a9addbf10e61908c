//! Facts about ray tracing: closed forms first, then invariants.

use super::*;
use crate::color::Color;
use crate::illumination::Paint;
use crate::illumination::material::Classic;
use crate::illumination::{Light, Material, RgbPower};
use crate::picture::{Operator, compose, difference};
use crate::render::film::{Film, FilmBlock};
use crate::render::ray_tracer;
use crate::scene::{Camera, Object, Projection, Scene, Settings, Shape};
use crate::solid::Primitive;
use crate::stages::{StageEvent, observed};
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

pub(super) fn object(shape: Shape, transform: DMat4, material: impl Into<Material>) -> Object {
    Object { name: shape.word().into(), shape, transform, material: Some(material.into()), tolerance: None }
}

pub(super) fn diffuse(k: f64) -> Classic {
    Classic { diffuse: Paint::grey(k), ..Classic::default() }
}

pub(super) fn mirror(k: f64) -> Classic {
    Classic { mirror: Paint::grey(k), ..diffuse(0.0) }
}

pub(super) fn scene(objects: Vec<Object>, lights: Vec<Light>, side: u32) -> Scene {
    let settings = Settings::of_size(side, side, 1);
    Scene { objects, lights, settings, ..Scene::default() }
}

/// Looks straight down on the square -half..half of the plane y = 0; x to the right, -z up.
pub(super) fn from_above(half: f64) -> View {
    let rows = [
        DVec4::new(1.0 / half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1.0 / half, 0.0),
        DVec4::new(0.0, -1e-3, 0.0, 0.5),
        DVec4::W,
    ];
    let to_clip = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    View::Projection(Projection { to_clip, depth_clipping: false })
}

pub(super) fn trace(scene: &Scene, view: Option<View>, everything: bool, threads: usize) -> Rendering {
    let prepared = Prepared::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let view = view.unwrap_or(prepared.view());
    let plan = if everything { Plan::everything(&prepared, &view) } else { Plan::new(&prepared, &view) };
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let order = RenderOrder { threads: NonZeroUsize::new(threads), ..RenderOrder::of(&scene.settings) };
    tracer.render(&view, &order, &Watch::NOBODY).expect("a picture")
}

pub(super) fn red(rendering: &Rendering, x: u32, y: u32) -> f64 {
    f64::from(rendering.picture.get(x, y).expect("inside").radiance[0])
}

/// A busy scene: curved and flat, shiny and dull, two kinds of light, something out of view.
fn still_life() -> Scene {
    let shiny = Classic { specular: Paint::grey(0.1), mirror: Paint::grey(0.4), ..diffuse(0.3) };
    let objects = vec![
        object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(0.6)),
        object(
            Shape::from(Primitive::Sphere { radius: 1.0 }),
            DMat4::from_translation(DVec3::new(-1.0, 1.0, 0.0)),
            shiny,
        ),
        object(
            Shape::from(Primitive::Box { size: DVec3::new(1.0, 2.0, 1.0) }),
            DMat4::from_translation(DVec3::new(1.4, 1.0, -0.5)) * DMat4::from_rotation_y(0.4),
            diffuse(0.5),
        ),
        object(
            Shape::from(Primitive::Sphere { radius: 0.5 }),
            DMat4::from_translation(DVec3::new(0.0, 0.5, 30.0)),
            diffuse(0.9),
        ),
    ];
    let lights = vec![
        Light::Point { at: DVec3::new(3.0, 5.0, 4.0), intensity: Color::Bands(RgbPower::new(30.0, 25.0, 20.0)) },
        Light::Directional { direction: DVec3::new(1.0, -1.0, -0.5), irradiance: Color::grey(1.0) },
        Light::Point { at: DVec3::new(0.0, 9.0, 0.0), intensity: Color::BLACK },
    ];
    let camera = Camera {
        from: DVec3::new(0.5, 2.5, 8.0),
        at: DVec3::new(0.0, 0.8, 0.0),
        up: DVec3::Y,
        field_of_view: 35.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    let mut scene = scene(objects, lights, 40);
    (scene.camera, scene.ambient, scene.background) =
        (Some(camera), RgbPower::splat(0.05), RgbPower::new(0.3, 0.4, 0.5));
    scene.settings.image.samples = 3;
    scene
}

#[test]
fn a_diffuse_sphere_under_parallel_light_follows_lambert() {
    let towards = DVec3::new(0.3, 0.5, 0.81).normalize();
    let light = Light::Directional { direction: -towards, irradiance: Color::grey(2.0) };
    let mut scene = scene(
        vec![object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, diffuse(0.8))],
        vec![light],
        40,
    );
    scene.settings.geometry.tolerance = Some(2e-4);
    let to_clip = DMat4::from_scale(DVec3::new(1.0, 1.0, -0.1));
    let rendering = trace(&scene, Some(View::Projection(Projection { to_clip, depth_clipping: false })), false, 2);
    let mut compared = 0;
    for (i, pixel) in rendering.picture.pixels().iter().enumerate() {
        let x = (f64::from(i as u32 % 40) + 0.5) / 20.0 - 1.0;
        let y = 1.0 - (f64::from(i as u32 / 40) + 0.5) / 20.0;
        let depth = 1.0 - x * x - y * y;
        assert_eq!(pixel.coverage, if depth > 0.0 { 1.0 } else { 0.0 }, "pixel {i}");
        if depth > 0.05 {
            let normal = DVec3::new(x, y, depth.sqrt());
            let expected = 0.8 * 2.0 * normal.dot(towards).max(0.0) / PI;
            assert!((f64::from(pixel.radiance[1]) - expected).abs() < 5e-4, "pixel {i}: {pixel:?}, not {expected}");
            compared += 1;
        }
    }
    assert!(compared > 1100);
}

#[test]
fn a_point_light_over_a_plane_falls_with_the_cube_of_the_slant_distance() {
    let light = Light::Point { at: DVec3::new(0.0, 2.0, 0.0), intensity: Color::grey(10.0) };
    let scene = scene(vec![object(Shape::Ground { size: 50.0 }, DMat4::IDENTITY, diffuse(0.5))], vec![light], 21);
    let rendering = trace(&scene, Some(from_above(5.25)), false, 2);
    for x in 0..21u32 {
        let r = (f64::from(x) - 10.0) * 0.5;
        let expected = 0.5 / PI * 10.0 * 2.0 / (4.0 + r * r).powf(1.5);
        assert!((red(&rendering, x, 10) - expected).abs() < 1e-6, "at {r}");
    }
}

#[test]
fn a_mirror_shows_the_luminance_of_what_it_reflects() {
    // A mirror on the floor, seen at 45 degrees, shows a wall of ambient luminance, and above it the background.
    let wall = object(
        Shape::from(Primitive::Box { size: DVec3::new(100.0, 4.0, 1.0) }),
        DMat4::from_translation(DVec3::new(0.0, 2.0, -10.5)),
        diffuse(0.5),
    );
    let floor = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, mirror(0.8));
    let mut scene = scene(vec![floor, wall], vec![], 1);
    (scene.ambient, scene.background) = (RgbPower::splat(0.3), RgbPower::splat(2.0));
    let look = |z: f64| Camera {
        from: DVec3::new(0.0, 5.0, z + 5.0),
        at: DVec3::new(0.0, 0.0, z),
        up: DVec3::Y,
        field_of_view: 1.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    let seen = |scene: &Scene, z: f64| red(&trace(scene, Some(View::Camera(look(z))), false, 1), 0, 0);
    assert!((seen(&scene, -7.0) - 0.8 * 0.5 * 0.3).abs() < 1e-6, "the wall, 3 above its foot");
    assert!((seen(&scene, -5.0) - 0.8 * 2.0).abs() < 1e-6, "past the wall, 5 above its foot");
    scene.settings.light.reflection_depth = 0;
    assert_eq!(seen(&scene, -7.0), 0.0, "without reflection a mirror is black");
}

#[test]
fn two_facing_mirrors_end_by_depth_or_by_energy() {
    let up = object(Shape::Ground { size: 50.0 }, DMat4::IDENTITY, mirror(0.5));
    let down = object(Shape::Ground { size: 50.0 }, DMat4::from_translation(DVec3::Y * 2.0), mirror(0.5));
    let mut scene = scene(vec![up, down], vec![], 1);
    scene.background = RgbPower::ONE;
    let straight_down = Camera {
        from: DVec3::Y,
        at: DVec3::ZERO,
        up: DVec3::Z,
        field_of_view: 1.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    scene.settings.light.reflection_depth = 5;
    assert_eq!(trace(&scene, Some(View::Camera(straight_down)), false, 1).rays.reflected, 5);
    scene.settings.light.reflection_depth = 1000;
    let chain = trace(&scene, Some(View::Camera(straight_down)), false, 1).rays.reflected;
    assert!((12..40).contains(&chain), "0.5^12 is the last that is surely traced, not {chain}");
}

#[test]
fn the_shadow_of_a_plate_is_its_central_projection() {
    // A plate of side 2 at height 1 under a light at height 3 throws a shadow of side 3.
    let plate = object(Shape::Ground { size: 2.0 }, DMat4::from_translation(DVec3::Y), mirror(0.0));
    let floor = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(1.0));
    let light = Light::Point { at: DVec3::new(0.0, 3.0, 0.0), intensity: Color::grey(9.0) };
    let scene = scene(vec![floor, plate], vec![light], 80);
    let rendering = trace(&scene, Some(from_above(4.0)), false, 2);
    for (i, pixel) in rendering.picture.pixels().iter().enumerate() {
        let (x, z) = ((f64::from(i as u32 % 80) - 39.5) / 10.0, (f64::from(i as u32 / 80) - 39.5) / 10.0);
        let dark = x.abs() < 1.5 && z.abs() < 1.5;
        assert_eq!(pixel.radiance[0] == 0.0, dark, "at {x}, {z}");
    }
}

#[test]
fn no_surface_shadows_itself_at_any_scale_or_place() {
    for (size, shift) in [(1e-6, 0.0), (1.0, 0.0), (1e6, 0.0), (1.0, 1e7), (1e3, 1e7)] {
        let center = DVec3::new(shift, -0.5 * shift, shift);
        let place = DMat4::from_translation(center) * DMat4::from_scale(DVec3::splat(size));
        let ball = object(Shape::from(Primitive::Sphere { radius: 1.0 }), place, diffuse(1.0));
        // The light stands behind the camera: whatever is seen is lit.
        let towards = DVec3::new(0.2, 0.3, 1.0).normalize();
        let lights = vec![Light::Directional { direction: -towards, irradiance: Color::grey(PI) }];
        let mut scene = scene(vec![ball], lights, 64);
        scene.settings.image.samples = 1;
        scene.camera = Some(Camera {
            from: center + towards * size * 1e3,
            at: center,
            up: DVec3::Y,
            field_of_view: 0.12,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        });
        let rendering = trace(&scene, None, false, 2);
        let covered: Vec<_> = rendering.picture.pixels().iter().filter(|p| p.coverage > 0.0).collect();
        assert!(covered.len() > 2000, "{size}, {shift}: {} pixels", covered.len());
        let dark = covered.iter().filter(|p| p.radiance[0] < 0.03).count();
        assert!(dark * 200 < covered.len(), "{size}, {shift}: {dark} of {} are dark", covered.len());
    }
}

#[test]
fn grazing_light_on_a_plane_is_not_shadowed_by_the_plane() {
    for turn in [0.0, 0.3, 1.1] {
        let tilt = DMat4::from_rotation_z(turn) * DMat4::from_rotation_x(0.7 * turn);
        let floor = object(Shape::Ground { size: 10.0 }, tilt, diffuse(1.0));
        let normal = tilt.transform_vector3(DVec3::Y);
        let along = tilt.transform_vector3(DVec3::new(0.6, 0.0, 0.8));
        for grazing in [1e-3, 1e-6, 1e-9] {
            let direction = -(along + normal * grazing);
            let light = Light::Directional { direction, irradiance: Color::grey(1.0 / grazing) };
            let mut scene = scene(vec![floor.clone()], vec![light], 32);
            let from = normal * 10.0;
            let up = tilt.transform_vector3(DVec3::Z);
            scene.camera = Some(Camera {
                from,
                at: DVec3::ZERO,
                up,
                field_of_view: 40.0,
                near: 0.0,
                far: None,
                lens: None,
                parallel: None,
                motion: None,
            });
            let rendering = trace(&scene, None, false, 2);
            for pixel in rendering.picture.pixels() {
                assert!((f64::from(pixel.radiance[0]) * PI - 1.0).abs() < 1e-4, "{turn}, {grazing}: {pixel:?}");
            }
        }
    }
}

#[test]
fn a_coarse_sphere_has_no_jagged_terminator() {
    let light = Light::Directional { direction: DVec3::NEG_X, irradiance: Color::grey(PI) };
    let mut scene = scene(
        vec![object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, diffuse(1.0))],
        vec![light],
        48,
    );
    scene.settings.geometry.tolerance = Some(0.01);
    let to_clip = DMat4::from_scale(DVec3::new(1.0, 1.0, -0.1));
    let rendering = trace(&scene, Some(View::Projection(Projection { to_clip, depth_clipping: false })), false, 2);
    // Right of the terminator (x > 0) every pixel is lit: none is black where the exact luminance is above 0.1.
    let picture = &rendering.picture;
    for y in 8..40 {
        for x in 27..46 {
            let pixel = picture.get(x, y).expect("inside");
            if pixel.coverage > 0.0 {
                assert!(pixel.radiance[0] > 0.05, "{x}, {y}: {pixel:?}");
            }
        }
    }
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads() {
    let scene = still_life();
    let one = trace(&scene, None, false, 1);
    for threads in [2, 3, 7] {
        let many = trace(&scene, None, false, threads);
        assert_eq!(one.picture, many.picture);
        assert_eq!(one.rays, many.rays);
    }
    assert!(one.picture.is_finite() && one.complete);
}

#[test]
fn another_seed_gives_another_picture_of_the_same_scene() {
    let scene = still_life();
    let mut other = scene.clone();
    other.settings.image.seed = 2;
    let (a, b) = (trace(&scene, None, false, 2).picture, trace(&other, None, false, 2).picture);
    let d = difference(&a, &b).expect("same size");
    assert!(d.rmse > 0.0 && d.rmse < 0.1, "{d:?}");
}

#[test]
fn forcing_everything_gives_the_same_picture() {
    let full = still_life();
    let mut dull = full.clone();
    dull.objects.iter_mut().for_each(|o| o.material = Some(diffuse(0.5).into()));
    let mut dark = full.clone();
    dark.lights.clear();
    let mut flat = full.clone();
    flat.objects.retain(|o| matches!(o.shape.word(), "box" | "ground"));
    let mut black = full.clone();
    black.ambient = RgbPower::ZERO;
    black.objects.iter_mut().for_each(|o| o.material = Some(mirror(0.0).into()));
    let mut plain = full.clone();
    (plain.settings.image.samples, plain.settings.light.reflection_depth) = (1, 0);
    let mut empty = full.clone();
    empty.objects.clear();
    let mut away = full.clone();
    away.camera = away.camera.map(|c| Camera { at: DVec3::new(0.0, 50.0, 8.0), up: DVec3::Z, ..c });
    for (name, scene) in [
        ("full", full),
        ("dull", dull),
        ("dark", dark),
        ("flat", flat),
        ("black", black),
        ("plain", plain),
        ("empty", empty),
        ("away", away),
    ] {
        let (lean, forced) = (trace(&scene, None, false, 2), trace(&scene, None, true, 2));
        assert_eq!(lean.picture, forced.picture, "{name}");
        assert!(lean.rays.total() <= forced.rays.total(), "{name}");
    }
}

#[test]
fn a_camera_and_the_matrix_of_the_workstation_show_the_same_silhouette() {
    let mut scene = still_life();
    scene.objects.remove(0);
    scene.settings.image.samples = 1;
    let camera = scene.camera.expect("set");
    // What LOOK and FIELD_OF_VIEW make of the scene with its z negated: rows times matrix, left-handed.
    let negated = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let reported = camera.projection().expect("sees").to_clip * negated;
    let view = View::Projection(Projection::from_workstation(&reported, false));
    let (a, b) = (trace(&scene, None, false, 2), trace(&scene, Some(view), false, 2));
    let d = difference(&a.picture, &b.picture).expect("same size");
    assert!(d.silhouette < 0.005 && d.rmse < 0.02, "{d:?}");
}

#[test]
fn stratified_samples_converge_faster_than_random_ones() {
    // An edge across the picture: its coverage is known exactly.
    let mut scene = scene(
        vec![object(Shape::from(Primitive::Box { size: DVec3::ONE }), DMat4::from_rotation_z(0.3), diffuse(0.5))],
        vec![],
        12,
    );
    scene.ambient = RgbPower::ONE;
    let to_clip = DMat4::from_scale(DVec3::new(1.2, 1.2, -0.1));
    let view = View::Projection(Projection { to_clip, depth_clipping: false });
    let error = |samples: u32| {
        let reference = 1.2f64 * 1.2 / 4.0;
        let runs = (0..24).map(|seed| {
            scene.settings.image.samples = samples;
            scene.settings.image.seed = seed;
            let picture = trace(&scene, Some(view), false, 1).picture;
            let mean = picture.pixels().iter().map(|p| f64::from(p.coverage)).sum::<f64>() / 144.0;
            (mean - reference).powi(2)
        });
        (runs.collect::<Vec<f64>>().iter().sum::<f64>() / 24.0).sqrt()
    };
    let mut error = error;
    let (coarse, fine) = (error(4), error(256));
    let rate = (coarse / fine).ln() / 64f64.ln();
    assert!(rate > 0.6, "error ~ n^-{rate}: {coarse} to {fine}");
}

#[test]
fn a_cancelled_rendering_keeps_the_blocks_that_are_done() {
    let mut scene = still_life();
    scene.settings.image.samples = 1;
    let prepared = Prepared::new(&scene).expect("a scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let (cancelled, blocks) = (Arc::new(AtomicBool::new(false)), AtomicU32::new(0));
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    let stop = {
        let cancelled = cancelled.clone();
        move |event| {
            if let StageEvent::Progress { .. } = event {
                cancelled.store(blocks.fetch_add(1, Ordering::Relaxed) + 1 >= 2, Ordering::Relaxed);
            }
        }
    };
    let order = RenderOrder { threads: NonZeroUsize::new(1), ..RenderOrder::of(&scene.settings) };
    let part = observed(stop, || tracer.render(&prepared.view(), &order, &watch)).expect("a part");
    let begun = part.film.tallies().iter().filter(|tally| tally.count > 0).count();
    let mut empty = Film::new(part.film.width(), part.film.height()).expect("small");
    let pixels = |block: &FilmBlock<'_>| block.rows.iter().map(|row| row.tallies.len()).sum::<usize>();
    let first: usize = empty.blocks_mut()[..2].iter().map(pixels).sum();
    assert_eq!((begun, part.complete), (first, false));
    let whole = trace(&scene, None, false, 1);
    for (index, _) in part.film.tallies().iter().enumerate().filter(|(_, tally)| tally.count > 0) {
        assert_eq!(part.picture.pixels()[index], whole.picture.pixels()[index]);
    }
    // What is missing can be added later, and nothing tells that it was.
    let mut film = part.film;
    let added = tracer.accumulate(&mut film, &prepared.view(), &order, &Watch::NOBODY, None).expect("the rest");
    assert!(added.complete && film == whole.film);
}

#[test]
fn degenerate_views_are_errors() {
    let scene = still_life();
    let prepared = Prepared::new(&scene).expect("a scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let view = View::Projection(Projection { to_clip: DMat4::ZERO, depth_clipping: true });
    let result = tracer.render(&view, &RenderOrder::of(&scene.settings), &Watch::NOBODY);
    assert!(matches!(result, Err(RenderError::View)));
}

#[test]
fn a_matte_over_the_background_is_the_picture() {
    let mut scene = still_life();
    scene.settings.image.samples = 5;
    let prepared = Prepared::new(&scene).expect("a scene");
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let [picture, matte] = [false, true].map(|matte| {
        let order = RenderOrder { matte, ..RenderOrder::of(&scene.settings) };
        tracer.render(&view, &order, &Watch::NOBODY).expect("a picture").picture
    });
    let parts = matte.pixels().iter().filter(|p| p.coverage > 0.0 && p.coverage < 1.0).count();
    assert!(matte.is_matte() && !picture.is_matte() && parts > 10, "{parts}");
    let mut background = matte.clone();
    let behind = scene.background.as_vec3().to_array();
    background.pixels_mut().iter_mut().for_each(|pixel| pixel.radiance = behind);
    let both = compose(&matte, Operator::Over, &background).expect("same size");
    let d = difference(&both, &picture).expect("same size");
    assert!(d.largest < 1e-5, "{}", d.largest);
}
