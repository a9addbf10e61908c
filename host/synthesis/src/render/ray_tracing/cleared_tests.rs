//! Facts about light that goes through polished bodies as if they did not bend it, where caustics are left out.

use super::View;
use super::tests::{diffuse, object, red, scene, trace};
use crate::color::Color;
use crate::illumination::Light;
use crate::illumination::fresnel::Dielectric;
use crate::illumination::light::LightShape;
use crate::illumination::material::{Finish, Material, MaterialKind, Metal, RefractiveIndex, Transparent};
use crate::numeric::bounds::Bounds;
use crate::scene::{Camera, Caustics, Interreflection, Object, Parallel, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

fn glass(index: f64, absorption: f64) -> Material {
    let clear = Transparent::clear(RefractiveIndex::Constant(index));
    MaterialKind::Transparent(Transparent { absorption: Color::grey(absorption), ..clear }).into()
}

/// Sees a small square of the floor from just above it.
fn near() -> View {
    let mut view = Camera::framing(&Bounds::of([DVec3::ZERO]));
    (view.from, view.at, view.up) = (DVec3::Y, DVec3::ZERO, DVec3::Z);
    (view.parallel, view.near) = (Some(Parallel { height: 0.02, oblique: DVec2::ZERO }), 0.5);
    View::Camera(view)
}

fn slab([low, high]: [f64; 2], material: Material) -> Object {
    let shape = Shape::from(Primitive::Box { size: DVec3::new(60.0, high - low, 60.0) });
    object(shape, DMat4::from_translation(DVec3::new(0.0, 0.5 * (low + high), 0.0)), material)
}

#[test]
fn a_floor_behind_glass_gets_what_fresnel_and_bouguer_leave() {
    for degrees in [0.0_f64, 60.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let light = Light::Directional { direction: DVec3::new(sin, -cos, 0.0), irradiance: Color::grey(1.0) };
        let floor = object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, diffuse(0.8));
        let mut scene = scene(vec![floor, slab([4.0, 5.0], glass(1.5, 0.3))], vec![light], 1);
        scene.settings.image.samples = 4;
        let found = red(&trace(&scene, Some(near()), false, 1), 0, 0);
        let once = 1.0 - Dielectric::new(1.0, 1.5).expect("an index").reflectance(cos).mean();
        let expected = 0.8 / PI * cos * once * once * (-0.3 / cos).exp();
        assert!((found / expected - 1.0).abs() < 1e-6, "{degrees}: {found} {expected}");
    }
}

#[test]
fn glass_that_hardly_is_there_changes_no_light() {
    // A floor with a diffuse and a metallic lobe, under a lamp and a sky, with a slab between that bends next to
    // nothing.
    let copper = crate::color::shipped::metal("copper").expect("a metal");
    let finish = Finish::Rough { name: "GGX, all".into(), roughness: 0.5.into() };
    let metal = Material::from(MaterialKind::Metal(Metal { n: copper.n, k: copper.k, finish }));
    let lamp =
        LightShape::Rectangle { corner: DVec3::new(-2.0, 9.0, -2.0), across: DVec3::X * 4.0, up: DVec3::Z * 4.0 };
    for material in [metal, diffuse(0.7).into()] {
        let with = |slabs: Vec<Object>| {
            let floor = object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, material.clone());
            let lights = vec![
                Light::Sky { map: None, radiance: Color::grey(0.7), turned: 0.0 },
                Light::Area { patch: lamp, radiance: Color::grey(3.0) },
            ];
            let mut scene = scene([vec![floor], slabs].concat(), lights, 2);
            (scene.settings.image.samples, scene.settings.light.reflection_depth) = (4096, 12);
            scene.settings.light.spectral = Some(false);
            let picture = trace(&scene, Some(near()), false, 2).picture;
            picture.pixels().iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / 4.0
        };
        let (without, within) = (with(Vec::new()), with(vec![slab([4.0, 5.0], glass(1.0 + 1e-7, 0.0))]));
        assert!((within / without - 1.0).abs() < 0.01, "{}: {within} {without}", material.word());
    }
}

#[test]
fn caustics_that_are_asked_for_are_not_counted_twice() {
    // The same floor under a slab of glass: with caustics, camera paths find the lamp behind it, which is large.
    let lamp =
        LightShape::Rectangle { corner: DVec3::new(-20.0, 9.0, -20.0), across: DVec3::X * 40.0, up: DVec3::Z * 40.0 };
    let found = [false, true].map(|caustics| {
        let floor = object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, diffuse(0.7));
        let lights = vec![Light::Area { patch: lamp, radiance: Color::grey(3.0) }];
        let mut scene = scene(vec![floor, slab([4.0, 5.0], glass(1.5, 0.1))], lights, 2);
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (4096, 12);
        (scene.settings.light.caustics, scene.settings.light.interreflection) =
            (if caustics { Caustics::PathTraced } else { Caustics::LeftOut }, Interreflection::Followed);
        let picture = trace(&scene, Some(near()), false, 2).picture;
        picture.pixels().iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / 4.0
    });
    // Straight light lacks what is reflected to and fro within the slab, and what it throws back on the floor.
    assert!(found[0] < found[1] && found[0] > 0.75 * found[1], "{found:?}");
}

#[test]
fn what_glass_stands_on_is_seen_through_it() {
    // A floor at the height of the bottom of a slab, in both orders; next to it, the slab hovers.
    let floor = || object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, diffuse(0.8));
    let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
    let mut view = Camera::framing(&Bounds::of([DVec3::ZERO]));
    (view.from, view.at, view.up) = (DVec3::Y * 9.0, DVec3::new(0.3, 0.0, 0.1), DVec3::Z);
    (view.parallel, view.near) = (Some(Parallel { height: 0.02, oblique: DVec2::ZERO }), 0.5);
    let seen = |objects: Vec<Object>| {
        let mut scene = scene(objects, vec![light.clone()], 4);
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (64, 6);
        let picture = trace(&scene, Some(View::Camera(view)), false, 1).picture;
        picture.pixels().iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / 16.0
    };
    let slab = || slab([0.0, 1.0], glass(1.5, 0.0));
    let found = [seen(vec![floor(), slab()]), seen(vec![slab(), floor()])];
    let once = 1.0 - Dielectric::new(1.0, 1.5).expect("an index").reflectance(1.0).mean();
    // Light comes in once, and what the floor sends up goes out once; its radiance in the glass is that of the square.
    let expected = 0.8 / PI * once * once / 2.25;
    for found in found {
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}

#[test]
fn bodies_that_touch_absorb_on_their_own_segments_alone() {
    let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
    let index = 1.0 + 1e-9;
    for [low, high] in [[0.3, 0.0], [0.0, 0.3]] {
        let floor = object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, diffuse(0.8));
        let slabs = [slab([4.0, 5.0], glass(index, low)), slab([5.0, 6.0], glass(index, high))];
        let mut scene = scene([vec![floor], slabs.into()].concat(), vec![light.clone()], 1);
        scene.settings.image.samples = 4;
        let found = red(&trace(&scene, Some(near()), false, 1), 0, 0);
        let expected = 0.8 / PI * f64::exp(-0.3);
        assert!((found / expected - 1.0).abs() < 1e-6, "{low} {high}: {found} {expected}");
    }
}

#[test]
fn a_lamp_within_a_body_is_dimmed_on_the_way_through_it() {
    let floor = object(Shape::Ground { size: 60.0 }, DMat4::IDENTITY, diffuse(0.8));
    let lamp = Light::Point { at: DVec3::Y * 5.0, intensity: Color::grey(25.0) };
    let mut scene = scene(vec![floor, slab([3.0, 9.0], glass(1.0 + 1e-9, 0.2))], vec![lamp], 1);
    scene.settings.image.samples = 4;
    let found = red(&trace(&scene, Some(near()), false, 1), 0, 0);
    let expected = 0.8 / PI * f64::exp(-0.4);
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
}
