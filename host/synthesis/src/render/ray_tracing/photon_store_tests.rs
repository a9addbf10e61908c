//! Facts about photon maps that are stored in a database: they are what would be traced, and are taken as far as they
//! are the same.

use super::two_way_tests::{from_below, lamp, mirror_under_a_ceiling};
use super::*;
use crate::color::Color;
use crate::database::{RecordKind, Store};
use crate::illumination::Light;
use crate::picture::Picture;
use crate::render::two_way::FluxBalance;
use crate::render::{Task, ray_tracer_watched};
use crate::scene::{Caustics, Scene};
use glam::DVec3;
use std::path::Path;
use std::time::Duration;

/// Two lamps over a mirror.
fn two_lamps() -> Scene {
    let mut scene = mirror_under_a_ceiling(3.0, 12);
    scene.lights.push(lamp(DVec3::new(0.1, 0.8, 0.0), 5.0));
    (scene.settings.photons.count, scene.settings.light.caustics) = (40_000, Caustics::PhotonMapped);
    scene
}

/// A picture with its flux balance, by a database or without one.
fn picture(scene: &Scene, path: Option<&Path>) -> (Picture, FluxBalance) {
    let prepared = Prepared::new(scene).expect("sound");
    let plan = Plan::new(&prepared, &from_below());
    let photon_store =
        path.map(|path| PhotonStore::new(path, scene, &prepared, Duration::from_secs(60), true).expect("a database"));
    let tracer = ray_tracer_watched(&Task { photon_store: photon_store.as_ref(), ..Task::new(&prepared, &plan) })
        .expect("a tracer")
        .0;
    let rendering = tracer.render(&from_below(), &RenderOrder::of(&scene.settings), &Watch::NOBODY).expect("a picture");
    (rendering.picture, rendering.flux_balance.expect("photons were traced"))
}

#[test]
fn photons_from_a_database_give_the_same_picture_to_the_bit_and_are_not_traced_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("light.redb");
    let mut scene = two_lamps();
    let (plain, balance) = picture(&scene, None);
    assert_eq!(balance.stored_paths, 0);
    let (first, balance) = picture(&scene, Some(&path));
    assert_eq!((&first, balance.stored_paths), (&plain, 0));
    let (again, balance) = picture(&scene, Some(&path));
    assert_eq!(again, plain);
    // The last paths to each photon target are no whole block.
    assert!(balance.stored_paths > balance.paths * 4 / 5 && balance.stored_paths < balance.paths, "{balance}");
    let before = balance.stored_paths;
    // Neither the size of the picture nor the samples matter, nor where photons are gathered.
    (scene.settings.image.width, scene.settings.image.samples, scene.settings.photons.radius) = (9, 2, Some(0.1));
    assert_eq!(picture(&scene, Some(&path)).1.stored_paths, before);
    // Each pass has its own photons.
    scene.settings.image.samples = 2 * SHARING;
    let (plain, _) = picture(&scene, None);
    assert_eq!(picture(&scene, Some(&path)).0, plain);
    let store = Store::open(&path).expect("a database");
    assert_eq!(store.entries(Some(RecordKind::Photons)).expect("a list").len(), 4, "two lamps, two passes");
}

#[test]
fn where_one_lamp_changes_the_light_of_the_other_is_taken_from_the_database() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("light.redb");
    let mut scene = two_lamps();
    let whole = picture(&scene, Some(&path)).1.paths;
    scene.lights[1] = Light::Point { at: DVec3::new(0.1, 0.8, 0.0), intensity: Color::grey(2.0) };
    let (plain, _) = picture(&scene, None);
    let (changed, balance) = picture(&scene, Some(&path));
    assert_eq!(changed, plain);
    assert!(balance.stored_paths > whole / 4 && balance.stored_paths < whole * 9 / 10, "{balance}");
    // More paths of a lamp are added to those that are there.
    scene.settings.photons.count = 50_000;
    let (plain, _) = picture(&scene, None);
    let (more, balance) = picture(&scene, Some(&path));
    assert_eq!(more, plain);
    assert!(balance.stored_paths == 0 || balance.stored_paths < balance.paths, "{balance}");
}

#[test]
fn nothing_is_taken_where_surfaces_or_how_photons_are_traced_have_changed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("light.redb");
    let scene = two_lamps();
    picture(&scene, Some(&path));
    let mut moved = scene.clone();
    moved.objects[0].transform *= glam::DMat4::from_translation(DVec3::Y * 1e-3);
    let mut painted = scene.clone();
    painted.objects[1].material = Some(super::tests::diffuse(0.25).into());
    let (mut seeded, mut shallow) = (scene.clone(), scene.clone());
    (seeded.settings.image.seed, shallow.settings.light.reflection_depth) = (5, 1);
    for other in [moved, painted, seeded, shallow] {
        let (taken, balance) = picture(&other, Some(&path));
        assert_eq!(balance.stored_paths, 0);
        assert_eq!(taken, picture(&other, None).0);
    }
}

#[test]
fn what_is_no_database_is_an_error_before_anything_is_rendered() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("light.redb");
    std::fs::write(&path, "no database").expect("written");
    let scene = two_lamps();
    let prepared = Prepared::new(&scene).expect("sound");
    assert!(PhotonStore::new(&path, &scene, &prepared, Duration::from_secs(60), true).is_err());
}
