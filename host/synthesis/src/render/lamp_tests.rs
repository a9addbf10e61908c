//! Facts about lamps that reflect, for every technique: closed forms under a sky and within a sphere, and their light.

use super::{RENDERERS, RenderOrder, RendererRow, Rendering, Task, Technique, Watch};
use crate::color::Color;
use crate::illumination::light::LightShape;
use crate::illumination::material::{Classic, Coated, Material, MaterialKind};
use crate::illumination::{Light, Paint};
use crate::plan::Plan;
use crate::scene::{Camera, Interreflection, Object, Parallel, Prepared, RadiositySettings, Scene, Settings, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};

fn diffuse(k: f64) -> Material {
    Classic { diffuse: Paint::grey(k), ..Classic::default() }.into()
}

fn lamp(patch: LightShape, radiance: f64, reflectance: f64) -> Light {
    Light::Lamp { patch, radiance: Color::grey(radiance), material: Box::new(diffuse(reflectance)) }
}

fn sky(radiance: f64) -> Light {
    Light::Sky { map: None, radiance: Color::grey(radiance), turned: 0.0 }
}

fn object(shape: Shape, transform: DMat4, material: Material) -> Object {
    Object { name: shape.word().into(), shape, transform, material: Some(material), tolerance: None }
}

/// Sees a square about a point from somewhere.
fn camera(from: DVec3, at: DVec3, height: f64) -> Camera {
    Camera {
        from,
        at,
        up: if (at - from).cross(DVec3::Y).length() < 1e-3 { DVec3::X } else { DVec3::Y },
        field_of_view: 40.0,
        near: 1e-3,
        far: None,
        lens: None,
        parallel: Some(Parallel { height, oblique: DVec2::ZERO }),
        motion: None,
    }
}

fn scene(objects: Vec<Object>, lights: Vec<Light>, camera: Camera, samples: u32) -> Scene {
    let mut settings = Settings::of_size(8, 8, samples);
    (settings.light.interreflection, settings.light.reflection_depth) = (Interreflection::Followed, 30);
    // Coarse elements are enough where light is the same everywhere.
    settings.radiosity = RadiositySettings { error: 0.1, finest: 1.0 / 16.0, ..RadiositySettings::default() };
    Scene { objects, lights, settings, camera: Some(camera), ..Scene::default() }
}

fn render(scene: &Scene, row: &RendererRow) -> Rendering {
    let mut prepared = Prepared::new(scene).unwrap_or_else(|error| panic!("{error}"));
    (row.require)(&mut prepared.settings);
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let made = row.technique.prepare(&Task::new(&prepared, &plan)).expect("ready");
    made.renderer.any().render(&view, &RenderOrder::of(&prepared.settings), &Watch::NOBODY).expect("a picture")
}

fn mean(rendering: &Rendering) -> f64 {
    let pixels = rendering.picture.pixels();
    pixels.iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / pixels.len() as f64
}

/// Lamps of all shapes around the origin, which shine to +z.
fn shapes() -> [LightShape; 3] {
    let center = DVec3::ZERO;
    [
        LightShape::Rectangle { corner: DVec3::new(-1.0, -1.0, 0.0), across: DVec3::X * 2.0, up: DVec3::Y * 2.0 },
        LightShape::Disc { center, normal: DVec3::Z, radius: 1.0 },
        LightShape::Sphere { center, radius: 1.0 },
    ]
}

#[test]
fn a_lamp_shows_what_it_emits_and_what_it_reflects_of_a_sky() {
    let (emitted, reflectance, around) = (2.0, 0.6, 1.5);
    for row in &RENDERERS {
        // Radiosity, and light that scan line gathers, know of spectra a few means over the wavelength.
        let tolerance = if row.adds_samples { 5e-3 } else { 2e-2 };
        for (patch, spectral) in shapes().into_iter().flat_map(|patch| [(patch, false), (patch, true)]) {
            let is_sphere = matches!(patch, LightShape::Sphere { .. });
            // Of the many triangles of a sphere, radiosity takes long in spectra.
            if spectral && is_sphere && row.solves_radiosity {
                continue;
            }
            for (side, expected) in [(1.0, emitted + reflectance * around), (-1.0, reflectance * around)] {
                if is_sphere && side < 0.0 {
                    continue;
                }
                let camera = camera(DVec3::new(0.3, 0.2, 4.0) * side, DVec3::ZERO, 0.2);
                let lights = vec![sky(around), lamp(patch, emitted, reflectance)];
                let mut scene = scene(Vec::new(), lights, camera, 16);
                scene.settings.light.spectral = Some(spectral);
                scene.settings.light.samples = 16;
                let found = mean(&render(&scene, row));
                assert!(
                    (found / expected - 1.0).abs() < tolerance,
                    "{} {patch:?} {side}: {found} {expected}",
                    row.word
                );
            }
        }
    }
}

#[test]
fn a_lamp_in_a_closed_sphere_is_lit_by_its_own_light() {
    let (emitted, lamp_reflectance, wall, size) = (3.0, 0.8, 0.5, 0.5);
    // The part of what a point of the wall sees that is the lamp is the square of its size.
    let part: f64 = size * size;
    let of_wall = wall * part * emitted / (1.0 - wall * (1.0 - part) - wall * part * lamp_reflectance);
    let of_lamp = emitted + lamp_reflectance * of_wall;
    for row in RENDERERS.iter().filter(|row| row.technique != Technique::ScanLine) {
        for solved in [false, true] {
            if solved && row.solves_radiosity {
                continue;
            }
            for (towards, expected) in [(DVec3::ZERO, of_lamp), (DVec3::new(0.0, 0.3, 2.0), of_wall)] {
                let room = object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, diffuse(wall));
                let patch = LightShape::Sphere { center: DVec3::ZERO, radius: size };
                let camera = camera(DVec3::new(0.0, 0.0, 0.8), towards, 0.1);
                let mut scene = scene(vec![room], vec![lamp(patch, emitted, lamp_reflectance)], camera, 24);
                scene.settings.light.samples = 4;
                if solved {
                    scene.settings.light.interreflection = Interreflection::Solved;
                }
                let found = mean(&render(&scene, row));
                assert!((found / expected - 1.0).abs() < 0.01, "{} {solved}: {found} {expected}", row.word);
            }
        }
    }
}

#[test]
fn a_lamp_that_reflects_nothing_shines_as_one_without_a_body() {
    let coat = || -> Material {
        MaterialKind::Coated(Coated { diffuse: Paint::grey(0.5), index: 1.5, roughness: 0.3.into() }).into()
    };
    for row in &RENDERERS {
        for patch in shapes() {
            for material in [diffuse(0.7), coat()] {
                // The floor stands before the lamp, and a part of it behind.
                let upright = DMat4::from_translation(DVec3::new(0.0, -1.2, 0.0));
                let floor = object(Shape::Ground { size: 6.0 }, upright, material);
                let seen = |light: Light| {
                    let camera = camera(DVec3::new(0.0, 3.0, 3.0), DVec3::new(0.0, -1.2, 0.7), 2.0);
                    let mut scene = scene(vec![floor.clone()], vec![light], camera, 64);
                    (scene.settings.light.samples, scene.settings.radiosity) = (16, RadiositySettings::default());
                    mean(&render(&scene, row))
                };
                let bare = seen(Light::Area { patch, radiance: Color::grey(4.0) });
                let bodied = seen(lamp(patch, 4.0, 0.0));
                assert!((bodied / bare - 1.0).abs() < 0.01, "{} {patch:?}: {bodied} {bare}", row.word);
            }
        }
    }
}

#[test]
fn one_lamp_lights_another() {
    // A large lamp over a small one: what this shows is its own light and what it reflects straight.
    let large = LightShape::Disc { center: DVec3::new(0.0, 0.0, 2.0), normal: DVec3::NEG_Z, radius: 0.5 };
    let part = 0.25 / (0.25 + 4.0);
    for row in &RENDERERS {
        let small =
            LightShape::Rectangle { corner: DVec3::new(-0.05, -0.05, 0.0), across: DVec3::X * 0.1, up: DVec3::Y * 0.1 };
        let camera = camera(DVec3::new(1.0, 0.0, 1.0), DVec3::ZERO, 0.02);
        let mut scene = scene(Vec::new(), vec![lamp(large, 10.0, 0.0), lamp(small, 0.25, 0.5)], camera, 64);
        scene.settings.light.samples = 16;
        let expected = 0.25 + 0.5 * 10.0 * part;
        let found = mean(&render(&scene, row));
        assert!((found / expected - 1.0).abs() < 0.01, "{}: {found} {expected}", row.word);
    }
}
