//! Facts about plants: every technique draws them, pictures do not tell what was kept, and light comes through leaves.

use super::instance_tests::{at, camera, green, instances, lit, object, render, render_within};
use super::{RENDERERS, Rendering, Technique};
use crate::color::Color;
use crate::illumination::material::{MaterialKind, Translucent};
use crate::illumination::texture::Paint;
use crate::illumination::{Light, Material};
use crate::procedural::plant::{PlantInstant, SPECIES, Species};
use crate::scene::{Object, PlantModel, Procedural, Scene, Settings, Shape};
use glam::{DAffine3, DMat4, DVec3};
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// Plants of a species, small enough for the scene of these tests, each another one.
fn plants(name: &str, size: f64) -> Object {
    let row = SPECIES.iter().find(|row| row.name == name).expect("a species");
    let species = Species::parse(row.text).expect("a species");
    let model = PlantModel::new(species, PlantInstant::default(), 1, 3).expect("a plant");
    let model = Object::procedural("plant".into(), Procedural::new(Arc::new(model)).expect("a model"));
    let place = |number: u16| {
        let translation = DVec3::new(f64::from(number) * 2.4 - 2.4, -1.2, 0.0);
        at(DAffine3::from_translation(translation) * DAffine3::from_scale(DVec3::splat(size)), 0, number)
    };
    instances(vec![vec![model]], (0..3).map(place).collect(), DMat4::IDENTITY)
}

#[test]
fn every_technique_draws_plants() {
    let scene = lit(vec![plants("tulip", 6.0)]);
    let mean = |rendering: &Rendering| green(rendering).iter().sum::<f64>() / green(rendering).len() as f64;
    let bare = mean(&render(&lit(Vec::new()), Technique::RayTracing.row()));
    let expected = mean(&render(&scene, Technique::RayTracing.row()));
    assert!((expected / bare - 1.0).abs() > 0.02, "{expected} {bare}");
    for row in &RENDERERS {
        let found = mean(&render(&scene, row));
        assert!((found / expected - 1.0).abs() < 0.1, "{}: {found} {expected}", row.word);
    }
}

#[test]
fn pictures_of_plants_do_not_tell_what_was_kept_nor_how_many_threads_there_are() {
    let row = Technique::RayTracing.row();
    let mut scene = lit(vec![plants("daisy", 5.0)]);
    (row.require)(&mut scene.settings);
    let picture = |most: Option<u64>, threads: usize| render_within(&scene, row, most, threads);
    let (whole, all) = picture(None, 1);
    assert_eq!(all.made, 3, "{all:?}");
    for (most, threads) in [(None, 2), (Some(all.bytes / 2), 2)] {
        let (found, costs) = picture(most, threads);
        assert!(found == whole, "{most:?} bytes, {threads} threads: {costs:?}");
    }
}

#[test]
fn light_comes_through_a_leaf_as_its_transmittance_tells() {
    const TRANSMITTANCE: f64 = 0.3;
    let leaf = Translucent { diffuse: Paint::grey(0.4), transmittance: Paint::grey(TRANSMITTANCE), coat: None };
    let material: Material = MaterialKind::Translucent(Box::new(leaf)).into();
    let standing = DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let settings = Settings::of_size(8, 8, 4);
    // Light comes from behind the sheet at 60 degrees to its normal.
    let direction = DVec3::new(0.0, -(3.0_f64.sqrt()) / 2.0, 0.5);
    let scene = |side: f64| Scene {
        objects: vec![object(Shape::Ground { size: 4.0 }, standing, material.clone())],
        lights: vec![Light::Directional { direction, irradiance: Color::grey(2.0) }],
        settings,
        camera: Some(camera(DVec3::Z * (6.0 * side), 10.0)),
        ..Scene::default()
    };
    for (side, fraction) in [(1.0, TRANSMITTANCE), (-1.0, 0.4)] {
        for technique in [Technique::RayTracing, Technique::ScanLine] {
            let found = green(&render(&scene(side), technique.row()));
            let expected = fraction * 2.0 * 0.5 * FRAC_1_PI;
            let is_near = |value: &f64| (value / expected - 1.0).abs() < 1e-5;
            assert!(found.iter().all(is_near), "{side}: {found:?} {expected}");
        }
    }
}
