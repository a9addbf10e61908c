//! Facts about two-way ray tracing and radiosity together: each light path counts once.

use super::tests::{diffuse, mirror, scene, trace};
use super::two_way_tests::{ball, block, glass, lamp, two_way};
use super::*;
use crate::render::ray_tracer;
use crate::scene::{Camera, Caustics, Interreflection, Object, Scene};
use glam::DVec3;

/// A box of a length, open nowhere, of walls with a reflectance; the one on the right may be another.
fn room(length: f64, reflectance: f64, right: Option<Object>) -> Vec<Object> {
    let wall =
        |size: [f64; 3], at: [f64; 3]| block(DVec3::from_array(size), DVec3::from_array(at), diffuse(reflectance));
    let middle = 0.5 * length - 1.0;
    vec![
        wall([length + 0.4, 0.2, 2.4], [middle, -1.1, 0.0]),
        wall([length + 0.4, 0.2, 2.4], [middle, 1.1, 0.0]),
        wall([length + 0.4, 2.0, 0.2], [middle, 0.0, -1.1]),
        wall([length + 0.4, 2.0, 0.2], [middle, 0.0, 1.1]),
        wall([0.2, 2.0, 2.0], [-1.1, 0.0, 0.0]),
        right.unwrap_or_else(|| wall([0.2, 2.0, 2.0], [length - 0.9, 0.0, 0.0])),
    ]
}

/// Looks from the middle to the left.
fn to_the_left() -> View {
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (camera.from, camera.at, camera.field_of_view) = (DVec3::new(0.8, 0.0, 0.0), DVec3::NEG_X, 90.0);
    View::Camera(camera)
}

fn mean(rendering: &Rendering) -> f64 {
    let pixels = rendering.picture.pixels();
    pixels.iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / pixels.len() as f64
}

#[test]
fn a_room_with_a_mirror_for_a_wall_is_as_bright_as_one_twice_as_long() {
    let at = DVec3::new(-0.3, 0.4, 0.2);
    let image = DVec3::new(2.0 - at.x, at.y, at.z);
    let mut long = scene(room(4.0, 0.7, None), vec![lamp(at, 1.0), lamp(image, 1.0)], 12);
    long.settings.light.interreflection = Interreflection::Followed;
    (long.settings.image.samples, long.settings.light.reflection_depth) = (512, 40);
    let expected = mean(&trace(&long, Some(to_the_left()), false, 2));
    let wall = block(DVec3::new(0.2, 2.0, 2.0), DVec3::new(1.1, 0.0, 0.0), mirror(1.0));
    let mut short = scene(room(2.0, 0.7, Some(wall)), vec![lamp(at, 1.0)], 12);
    short.settings.photons.count = 50_000;
    (short.settings.light.interreflection, short.settings.image.samples, short.settings.light.reflection_depth) =
        (Interreflection::Followed, 64, 40);
    let found = mean(&two_way(&short, Some(to_the_left()), 2));
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    (short.settings.light.interreflection, short.settings.image.samples) = (Interreflection::Solved, 16);
    (short.settings.radiosity.error, short.settings.radiosity.finest) = (0.02, 0.03);
    let found = mean(&two_way(&short, Some(to_the_left()), 2));
    assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
}

/// Means of emitted, direct, caustic and indirect light, and of the picture.
fn classes(scene: &Scene) -> [f64; 5] {
    let prepared = Prepared::new(scene).expect("sound");
    let plan = Plan::new(&prepared, &to_the_left());
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let order = RenderOrder::of(&scene.settings);
    let film = Film::new(order.width, order.height).expect("small").with_classes();
    let rendering = tracer.resume(film, &to_the_left(), &order, &Watch::NOBODY, None).expect("a picture");
    let film = &rendering.film;
    let count = f64::from(order.samples) * film.tallies().len() as f64;
    let of = |class: usize| film.classes().iter().map(|classes| classes[class].x).sum::<f64>() / count;
    [of(0), of(1), of(2), of(3), mean(&rendering)]
}

#[test]
fn direct_light_caustics_and_what_surfaces_send_each_other_are_all_the_light_of_a_room() {
    use crate::color::Color;
    use crate::illumination::Light;
    use crate::illumination::light::LightShape;
    let patch =
        LightShape::Rectangle { corner: DVec3::new(-0.4, 0.95, -0.4), across: DVec3::X * 0.8, up: DVec3::Z * 0.8 };
    let mut objects = room(2.0, 0.6, None);
    objects.push(ball(0.35, DVec3::new(-0.3, -0.6, 0.2), glass(1.5)));
    objects.push(block(DVec3::new(0.05, 1.2, 1.2), DVec3::new(-0.9, 0.2, -0.2), mirror(0.9)));
    let mut scene = scene(objects, vec![Light::Area { patch, radiance: Color::grey(3.0) }], 12);
    (scene.settings.light.interreflection, scene.settings.light.reflection_depth) = (Interreflection::Followed, 24);
    (scene.settings.light.caustics, scene.settings.image.samples) = (Caustics::PathTraced, 2048);
    let expected = classes(&scene);
    (scene.settings.light.caustics, scene.settings.image.samples, scene.settings.photons.count) =
        (Caustics::PhotonMapped, 64, 100_000);
    let by_eye = classes(&scene);
    (scene.settings.light.interreflection, scene.settings.image.samples) = (Interreflection::Solved, 16);
    (scene.settings.radiosity.error, scene.settings.radiosity.finest) = (0.02, 0.03);
    let solved = classes(&scene);
    for found in [by_eye, solved] {
        assert!((found[..4].iter().sum::<f64>() / found[4] - 1.0).abs() < 1e-5, "{found:?}");
        // The path tracer finds caustics by chance: its own standard error is 2 % there.
        for (class, most) in [(1, 0.01), (2, 0.05), (3, 0.03), (4, 0.015)] {
            let error = found[class] / expected[class] - 1.0;
            assert!(error.abs() < most, "class {class}: {found:?} {expected:?}");
        }
    }
}
