//! Facts about photon tracing: closed forms, flux that adds up, and agreement with other algorithms.

use super::tests::{diffuse, from_above, mirror, object, red, scene};
use super::*;
use crate::color::Color;
use crate::illumination::light::LightShape;
use crate::illumination::material::{Material, MaterialKind, RefractiveIndex, Transparent};
use crate::illumination::{Light, RgbPower};
use crate::picture::difference;
use crate::render::ray_tracer;
use crate::scene::{Camera, Caustics, Interreflection, Object, Scene, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

pub(super) fn glass(index: f64) -> Material {
    MaterialKind::Transparent(Transparent::clear(RefractiveIndex::Constant(index))).into()
}

pub(super) fn block(size: DVec3, at: DVec3, material: impl Into<Material>) -> Object {
    object(Shape::from(Primitive::Box { size }), DMat4::from_translation(at), material)
}

pub(super) fn ball(radius: f64, at: DVec3, material: impl Into<Material>) -> Object {
    object(Shape::from(Primitive::Sphere { radius }), DMat4::from_translation(at), material)
}

pub(super) fn lamp(at: DVec3, intensity: f64) -> Light {
    Light::Point { at, intensity: Color::grey(intensity) }
}

/// Looks straight up from above the shade at the square -1.5..1.5 of the ceiling, x to the left, z up.
pub(super) fn from_below() -> View {
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (camera.from, camera.at, camera.up) = (DVec3::Y * 1.3, DVec3::Y * 3.0, DVec3::Z);
    camera.field_of_view = 2.0 * (1.5f64 / 1.7).atan().to_degrees();
    View::Camera(camera)
}

pub(super) fn two_way(scene: &Scene, view: Option<View>, threads: usize) -> Rendering {
    let mut scene = scene.clone();
    scene.settings.light.caustics = Caustics::PhotonMapped;
    let prepared = Prepared::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let view = view.unwrap_or(prepared.view());
    let plan = Plan::new(&prepared, &view);
    assert!(plan.needs(Stage::PhotonMap));
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let order = RenderOrder { threads: NonZeroUsize::new(threads), ..RenderOrder::of(&scene.settings) };
    let rendering = tracer.render(&view, &order, &Watch::NOBODY).expect("a picture");
    if let Some(balance) = &rendering.flux_balance {
        assert!(balance.residual() < 1e-6 && balance.sent > 0.0, "{balance}");
    }
    rendering
}

/// A lamp that a mirror on the floor throws on a ceiling of a size; a shade keeps its own light from there.
pub(super) fn mirror_under_a_ceiling(size: f64, side: u32) -> Scene {
    let objects = vec![
        block(DVec3::new(2.0, 0.1, 2.0), DVec3::new(0.0, -0.05, 0.0), mirror(0.8)),
        block(DVec3::new(size, 0.1, size), DVec3::new(0.0, 3.05, 0.0), diffuse(0.5)),
        block(DVec3::new(0.4, 0.02, 0.4), DVec3::new(0.0, 1.2, 0.0), diffuse(0.0)),
    ];
    let mut scene = scene(objects, vec![lamp(DVec3::new(0.0, 1.0, 0.0), 10.0)], side);
    (scene.settings.image.samples, scene.settings.photons.count) = (4, 200_000);
    scene
}

#[test]
fn a_mirror_lights_a_ceiling_as_a_lamp_behind_it_would() {
    // Up to the edge of the ceiling, and as far as the mirror reaches: from the lamp's image, 4 times as far as it is
    // wide.
    let rendering = two_way(&mirror_under_a_ceiling(3.0, 30), Some(from_below()), 1);
    // Where the disc is cut by an edge, there are fewer photons in it: the mean over the edge is asked for.
    let mut edge = [0.0; 2];
    let (mut squares, mut count) = (0.0, 0.0);
    for (x, y) in (0..30).flat_map(|x| (0..30).map(move |y| (x, y))) {
        let at = |i: u32| (f64::from(i) + 0.5) / 30.0 * 3.0 - 1.5;
        if at(x).abs().max(at(y).abs()) < 0.6 {
            continue;
        }
        let square = at(x).powi(2) + at(y).powi(2) + 16.0;
        let expected = 0.5 / PI * 0.8 * 10.0 * 4.0 / square.powf(1.5);
        let found = red(&rendering, x, y);
        let is_edge = [x, y].iter().any(|i| [0, 29].contains(i));
        if is_edge {
            edge = [edge[0] + found, edge[1] + expected];
        }
        let (error, most) = (found / expected - 1.0, if is_edge { 0.15 } else { 0.1 });
        assert!(error.abs() < most, "{x} {y}: {found} {expected}");
        (squares, count) = (squares + error * error, count + 1.0);
    }
    let mean = f64::sqrt(squares / count);
    assert!(mean < 0.03, "{mean}");
    assert!((edge[0] / edge[1] - 1.0).abs() < 0.01, "{edge:?}");
}

#[test]
fn more_light_makes_it_more_right() {
    let error = |photons: u32| {
        let mut scene = mirror_under_a_ceiling(3.0, 16);
        (scene.settings.photons.count, scene.settings.image.samples) = (photons, 1);
        let rendering = two_way(&scene, Some(from_below()), 2);
        let square = |(i, pixel): (usize, &crate::picture::Pixel)| {
            let at = |i: usize| (i as f64 + 0.5) / 16.0 * 3.0 - 1.5;
            let (x, y) = (at(i % 16), at(i / 16));
            let shaded = x.abs().max(y.abs()) < 0.9;
            let expected = 0.5 / PI * 0.8 * 10.0 * 4.0 / (x * x + y * y + 16.0).powf(1.5);
            if shaded { 0.0 } else { (f64::from(pixel.radiance[0]) / expected - 1.0).powi(2) }
        };
        rendering.picture.pixels().iter().enumerate().map(square).sum::<f64>()
    };
    let errors = [500, 5_000, 500_000].map(error);
    assert!(errors[0] > 2.0 * errors[1] && errors[1] > 2.0 * errors[2], "{errors:?}");
}

/// A glass ball and a mirror under a lamp that is large enough for camera paths to find it.
fn ball_and_mirror() -> Scene {
    let patch =
        LightShape::Rectangle { corner: DVec3::new(-1.5, 4.0, -1.5), across: DVec3::X * 3.0, up: DVec3::Z * 3.0 };
    let objects = vec![
        block(DVec3::new(8.0, 0.2, 8.0), DVec3::new(0.0, -0.1, 0.0), diffuse(0.7)),
        ball(0.8, DVec3::new(-1.0, 1.0, 0.0), glass(1.5)),
        block(DVec3::new(0.1, 2.0, 2.0), DVec3::new(1.5, 1.0, 0.0), mirror(0.9)),
    ];
    let mut scene = scene(objects, vec![Light::Area { patch, radiance: Color::grey(3.0) }], 16);
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::splat(-2.0), DVec3::splat(2.0)]));
    (camera.from, camera.at) = (DVec3::new(0.0, 5.0, 7.0), DVec3::new(0.0, 0.5, 0.0));
    scene.camera = Some(camera);
    (scene.settings.light.interreflection, scene.settings.light.reflection_depth) = (Interreflection::Followed, 12);
    scene
}

#[test]
fn paths_from_the_camera_alone_find_the_same_light() {
    let mut scene = ball_and_mirror();
    scene.settings.image.samples = 64;
    let found = two_way(&scene, None, 2);
    (scene.settings.light.caustics, scene.settings.image.samples) = (Caustics::PathTraced, 1024);
    let expected = super::tests::trace(&scene, None, false, 2);
    let mean = |rendering: &Rendering, rows: std::ops::Range<usize>, columns: std::ops::Range<usize>| {
        let pixels = rows.flat_map(|y| columns.clone().map(move |x| (x as u32, y as u32)));
        pixels.map(|(x, y)| red(rendering, x, y)).sum::<f64>() / 16.0
    };
    for (row, column) in (0..16).map(|k| (k / 4, k % 4)) {
        let (rows, columns) = (4 * row..4 * row + 4, 4 * column..4 * column + 4);
        let [a, b] = [&found, &expected].map(|rendering| mean(rendering, rows.clone(), columns.clone()));
        assert!((a / b - 1.0).abs() < 0.03 || (a - b).abs() < 2e-3, "{row} {column}: {a} {b}");
    }
}

/// A sky with a small sun in it.
fn sky_with_a_sun() -> Light {
    let radiance = |x: u32, y: u32| DVec3::splat(if y.abs_diff(5) < 2 && x.abs_diff(20) < 2 { 40.0 } else { 0.2 });
    let panorama = crate::illumination::light::Panorama::of(64, 32, radiance).expect("small");
    let map = crate::illumination::light::SkyMap {
        file: "sky".into(),
        panorama: Some(std::sync::Arc::new(panorama)),
        ..Default::default()
    };
    Light::Sky { map: Some(map), radiance: Color::grey(1.0), turned: 0.0 }
}

#[test]
fn light_of_a_sky_with_a_sun_is_found_once_whoever_looks_for_it() {
    let mut scene = ball_and_mirror();
    scene.lights = vec![sky_with_a_sun()];
    scene.settings.image.samples = 64;
    let found = two_way(&scene, None, 2);
    (scene.settings.light.caustics, scene.settings.image.samples) = (Caustics::PathTraced, 1024);
    let expected = super::tests::trace(&scene, None, false, 2);
    let mean = |rendering: &Rendering| {
        (0..256).map(|i| red(rendering, i % 16, i / 16)).filter(|radiance| *radiance < 2.0).sum::<f64>()
    };
    let (found, expected) = (mean(&found), mean(&expected));
    assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
}

#[test]
fn classes_of_light_add_up_and_are_the_same_for_both_algorithms() {
    let mut scene = ball_and_mirror();
    let classes = |scene: &Scene| {
        let prepared = Prepared::new(scene).expect("sound");
        let plan = Plan::new(&prepared, &prepared.view());
        let tracer = ray_tracer(&prepared, &plan).expect("an octree");
        let order = RenderOrder::of(&scene.settings);
        let film = Film::new(16, 16).expect("small").with_classes();
        let film = tracer.resume(film, &prepared.view(), &order, &Watch::NOBODY, None).expect("a picture").film;
        for (tally, classes) in film.tallies().iter().zip(film.classes()) {
            assert!((tally.sum - classes.iter().copied().sum::<DVec3>()).length() <= 1e-9 * tally.sum.length());
        }
        let count = f64::from(scene.settings.image.samples) * 256.0;
        [0, 1, 2, 3].map(|class| film.classes().iter().map(|classes| classes[class].x).sum::<f64>() / count)
    };
    (scene.settings.image.samples, scene.settings.light.caustics) = (64, Caustics::PhotonMapped);
    let found = classes(&scene);
    (scene.settings.image.samples, scene.settings.light.caustics) = (512, Caustics::PathTraced);
    let expected = classes(&scene);
    // Of so little indirect light, chance takes more.
    for ((a, b), most) in found.iter().zip(expected).zip([0.03, 0.01, 0.03, 0.15]) {
        assert!(*a > 0.0 && (a / b - 1.0).abs() < most, "{found:?} {expected:?}");
    }
    // Left out, caustics are not there, neither directly seen nor scattered on; light goes straight through glass
    // instead.
    scene.settings.light.caustics = Caustics::LeftOut;
    let without = classes(&scene);
    assert!(without[2] == 0.0 && without[3] < expected[3], "{without:?} {expected:?}");
    assert!(without[1] > expected[1] && without[1] < expected[1] + expected[2], "{without:?} {expected:?}");
}

#[test]
fn a_closed_dark_room_stays_dark_whatever_shines_outside() {
    // Thin walls, which share the floor with the outside: mirrors and glass there throw light to their feet.
    let wall = |size: DVec3, at: DVec3| block(size, at, diffuse(0.7));
    let mut objects = vec![wall(DVec3::new(12.0, 0.1, 12.0), DVec3::new(0.0, -0.05, 0.0))];
    for side in [-1.0, 1.0] {
        objects.push(wall(DVec3::new(1e-4, 2.0, 4.0), DVec3::new(2.0 * side, 1.0, 0.0)));
        objects.push(wall(DVec3::new(4.0, 2.0, 1e-4), DVec3::new(0.0, 1.0, 2.0 * side)));
        objects.push(ball(0.7, DVec3::new(3.5 * side, 1.5, 0.0), glass(1.5)));
        objects.push(ball(0.7, DVec3::new(0.5, 1.5, 3.5 * side), mirror(1.0)));
    }
    objects.push(wall(DVec3::new(4.0, 0.1, 4.0), DVec3::new(0.0, 2.05, 0.0)));
    let lights = [-4.0, 4.0].map(|x| lamp(DVec3::new(x, 5.0, x), 100.0));
    let mut scene = scene(objects, lights.to_vec(), 24);
    (scene.settings.image.samples, scene.settings.photons.count) = (4, 50_000);
    scene.settings.light.interreflection = Interreflection::Followed;
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (camera.from, camera.at, camera.up) = (DVec3::new(0.0, 1.5, 0.0), DVec3::ZERO, DVec3::Z);
    camera.field_of_view = 120.0;
    // Also where points stand for walls.
    for (from, at, point_depth) in [(1.9, 0.0, None), (0.3, 1.99, None), (1.9, 0.0, Some(7))] {
        (camera.from.y, camera.at.y, scene.settings.photons.point_depth) = (from, at, point_depth);
        let rendering = two_way(&scene, Some(View::Camera(camera)), 2);
        assert!(rendering.picture.pixels().iter().all(|pixel| pixel.radiance == [0.0; 3]), "from {from}");
    }
    // From outside it is light enough.
    scene.settings.photons.point_depth = None;
    let outside = two_way(&scene, Some(from_above(5.0)), 2);
    assert!(outside.picture.pixels().iter().any(|pixel| pixel.radiance[0] > 1.0));
}

#[test]
fn points_that_stand_for_surfaces_come_near_them_as_voxels_get_small() {
    let mut scene = ball_and_mirror();
    (scene.settings.image.samples, scene.settings.photons.count) = (16, 50_000);
    let exact = two_way(&scene, None, 2);
    let stored = |rendering: &Rendering| rendering.flux_balance.map_or(0.0, |balance| balance.stored / balance.sent);
    let off = [(6, 0.1), (8, 0.03)].map(|(depth, most)| {
        scene.settings.photons.point_depth = Some(depth);
        let rendering = two_way(&scene, None, 2);
        let off = stored(&rendering) / stored(&exact) - 1.0;
        assert!(off.abs() < most, "{off} at {depth}");
        difference(&rendering.picture, &exact.picture).expect("of one size").rmse
    });
    assert!(off[1] < 0.7 * off[0], "{off:?}");
    let again = two_way(&scene, None, 1);
    assert!(again.picture == two_way(&scene, None, 2).picture);
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads_and_with_nothing_left_out() {
    let mut scene = ball_and_mirror();
    (scene.settings.image.samples, scene.settings.photons.count) = (9, 5_000);
    let one = two_way(&scene, None, 1);
    let two = two_way(&scene, None, 2);
    assert!(one.picture == two.picture && one.flux_balance == two.flux_balance);
    scene.settings.light.caustics = Caustics::PhotonMapped;
    let all = super::tests::trace(&scene, None, true, 2);
    assert!(one.picture == all.picture, "{:?}", difference(&one.picture, &all.picture));
}

#[test]
fn a_second_view_takes_the_photons_that_were_stored_for_the_first() {
    let mut scene = ball_and_mirror();
    (scene.settings.image.samples, scene.settings.photons.count, scene.settings.light.caustics) =
        (2, 5_000, Caustics::PhotonMapped);
    let prepared = Prepared::new(&scene).expect("sound");
    let plan = Plan::new(&prepared, &prepared.view());
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let order = RenderOrder::of(&scene.settings);
    let render = |view: &View| tracer.render(view, &order, &Watch::NOBODY).expect("a picture").picture;
    let (first, above) = (render(&prepared.view()), render(&from_above(3.0)));
    let anew = ray_tracer(&prepared, &plan).expect("an octree");
    let other = anew.render(&from_above(3.0), &order, &Watch::NOBODY).expect("a picture").picture;
    assert_eq!(difference(&above, &other).expect("alike").rmse, 0.0);
    assert!(first == render(&prepared.view()));
}

#[test]
fn scenes_without_mirrors_or_lamps_do_without_it() {
    let floor = || block(DVec3::new(4.0, 0.2, 4.0), DVec3::ZERO, diffuse(0.7));
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let shiny = || ball(0.5, DVec3::Y, mirror(1.0));
    let light = || lamp(DVec3::new(0.0, 5.0, 0.0), 5.0);
    let cases = [
        (vec![floor()], vec![light()]),
        (vec![floor(), shiny()], vec![sky]),
        (vec![shiny()], vec![light()]),
        (vec![], vec![light()]),
    ];
    for (objects, lights) in cases {
        let mut scene = Scene { background: RgbPower::ONE, ..scene(objects, lights, 8) };
        scene.settings.light.caustics = Caustics::PhotonMapped;
        let prepared = Prepared::new(&scene).expect("sound");
        let plan = Plan::new(&prepared, &prepared.view());
        assert!(!plan.needs(Stage::PhotonMap));
        let with = super::tests::trace(&scene, None, false, 1);
        scene.settings.light.caustics = Caustics::LeftOut;
        assert!(with.picture == super::tests::trace(&scene, None, false, 1).picture);
    }
}
