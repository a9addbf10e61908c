//! Facts about the principled material in scenes: furnaces, panes that let light through, numbers that patterns tell.

use super::tests::{diffuse, from_above, object, red, scene, trace};
use crate::color::Color;
use crate::illumination::material::{MaterialKind, Principled};
use crate::illumination::texture::{Band, Motif, NumberTexture, Pattern, TextureMapping, Varying};
use crate::illumination::{Light, Material, Paint, RgbPower};
use crate::scene::{Interreflection, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use std::f64::consts::PI;

fn white() -> Principled {
    Principled { base_color: Paint::grey(1.0), ..Principled::default() }
}

/// A white one under a coat whose roughness varies.
fn coated() -> Principled {
    Principled { coat: 1.0.into(), coat_roughness: cells(0.1, 0.6), ..white() }
}

fn of(principled: Principled) -> Material {
    MaterialKind::Principled(Box::new(principled)).into()
}

/// A number that varies in cells of a checker, from one to another.
fn cells(from: f64, to: f64) -> NumberTexture {
    let paints = vec![Paint::grey(0.0), Paint::grey(1.0)];
    let laying = TextureMapping { solid: true, size: DVec3::splat(0.6), ..TextureMapping::default() };
    NumberTexture::Varying(Box::new(Varying {
        pattern: Pattern { motif: Motif::Checker, laying, paints },
        band: Band::Mean,
        from,
        to,
    }))
}

#[test]
fn a_white_furnace_hides_it_with_whatever_numbers() {
    let materials = [
        white(),
        Principled { metallic: 1.0.into(), roughness: cells(0.1, 0.7), ..white() },
        Principled { metallic: cells(0.0, 1.0), coat: 1.0.into(), coat_roughness: 0.3.into(), ..white() },
        Principled { transmission: 1.0.into(), roughness: 0.6.into(), ..white() },
        Principled { transmission: 1.0.into(), roughness: 0.0.into(), coat: 0.5.into(), ..white() },
        Principled { transmission: cells(0.0, 1.0), roughness: 0.4.into(), thin: true, ..white() },
        Principled { transmission: 1.0.into(), roughness: 0.0.into(), thin: true, ..coated() },
        Principled { metallic: 1.0.into(), roughness: 0.0.into(), ..coated() },
        Principled { sheen: Paint::grey(0.7), coat: cells(0.0, 1.0), roughness: 0.9.into(), ..white() },
    ];
    for principled in materials {
        // Light goes to and fro many times in a rough body, each time by chance.
        let tolerance = if principled.transmits() { 1.2e-2 } else { 4e-3 };
        let words = format!("{principled:?}");
        let ball = object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, of(principled));
        let mut scene = scene(vec![ball], vec![], 8);
        scene.lights = vec![Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 }];
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (256, 100);
        scene.settings.light.interreflection = Interreflection::Followed;
        let rendering = trace(&scene, Some(from_above(0.8)), false, 2);
        let mean = rendering.picture.pixels().iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / 64.0;
        assert!((mean - 1.0).abs() < tolerance, "{words}: {mean}");
    }
}

#[test]
fn a_polished_pane_lets_lamps_through_as_fresnel_tells() {
    let pane = Principled { transmission: 1.0.into(), roughness: 0.0.into(), thin: true, ..white() };
    for (degrees, specular) in [(0.0_f64, true), (60.0, true), (60.0, false)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let light = Light::Directional { direction: DVec3::new(sin, -cos, 0.0), irradiance: Color::grey(1.0) };
        let floor = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(0.8));
        // Beside what is looked at, between it and the light alone; or above it.
        let beside = if specular { DVec3::new(-2.0 * sin / cos, 2.0, 0.0) } else { DVec3::Y * 2.0 };
        let size = if degrees == 0.0 || !specular { 20.0 } else { 4.0 };
        let plate = object(Shape::Ground { size }, DMat4::from_translation(beside), of(pane.clone()));
        let mut scene = scene(vec![floor, plate], vec![light], 1);
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (512, 8);
        let found = red(&trace(&scene, Some(from_above(0.01)), false, 1), 0, 0);
        let through = |cosine: f64| {
            let once =
                crate::illumination::fresnel::Dielectric::new(1.0, 1.5).expect("an index").reflectance(cosine).mean();
            (1.0 - once) / (1.0 + once)
        };
        let seen = if degrees == 0.0 || !specular { through(1.0) } else { 1.0 };
        let expected = 0.8 / PI * cos * through(cos) * seen;
        assert!((found / expected - 1.0).abs() < 5e-3, "{degrees}: {found} {expected}");
    }
}

#[test]
fn ambient_light_and_a_background_show_what_it_reflects() {
    let ball = |principled| object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, of(principled));
    for (principled, expected) in [
        (Principled { specular: 0.0.into(), base_color: Paint::grey(0.5), ..white() }, 0.5),
        (Principled { metallic: 1.0.into(), roughness: 0.0.into(), base_color: Paint::grey(0.5), ..white() }, 0.5),
    ] {
        let mut scene = scene(vec![ball(principled)], vec![], 1);
        (scene.ambient, scene.background) = (RgbPower::ONE, RgbPower::ONE);
        scene.settings.image.samples = 16;
        let found = red(&trace(&scene, Some(from_above(0.01)), false, 1), 0, 0);
        assert!((found - expected).abs() < 2e-3, "{found} {expected}");
    }
}
