//! Facts about plans.

use super::*;
use crate::color::Color;
use crate::illumination::Paint;
use crate::illumination::material::{Classic, MaterialKind};
use crate::illumination::{Light, Material, RgbPower};
use crate::scene::{Camera, Object, Scene, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};

fn object(name: &str, shape: Shape, at: DVec3) -> Object {
    let material = Classic { diffuse: Paint::grey(0.5), ..Classic::default() }.into();
    Object {
        name: name.into(),
        shape,
        transform: DMat4::from_translation(at),
        material: Some(material),
        tolerance: None,
    }
}

/// A cube in view, a cube far to the right, and light from the right.
fn scene() -> Scene {
    let cube = Shape::from(Primitive::Box { size: DVec3::ONE });
    let objects = vec![object("middle", cube.clone(), DVec3::ZERO), object("right", cube, DVec3::new(50.0, 0.0, 0.0))];
    let lights = vec![Light::Directional { direction: DVec3::new(-1.0, 0.0, 0.0), irradiance: Color::grey(1.0) }];
    let camera = Camera {
        from: DVec3::new(0.0, 0.0, 8.0),
        at: DVec3::ZERO,
        up: DVec3::Y,
        field_of_view: 30.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    let mut scene = Scene { objects, lights, camera: Some(camera), ..Scene::default() };
    scene.settings.image.samples = 1;
    scene
}

fn material(scene: &mut Scene) -> &mut Classic {
    match &mut scene.objects[0].material {
        Some(Material { body: MaterialKind::Classic(classic), .. }) => classic,
        other => panic!("it was given a classic one, not {other:?}"),
    }
}

fn plan(scene: &Scene) -> Plan {
    let prepared = Prepared::new(scene).expect("a scene");
    Plan::new(&prepared, &prepared.view())
}

#[test]
fn a_plain_scene_needs_only_its_stages() {
    let plan = plan(&scene());
    let needed: Vec<Stage> = Stage::ALL.into_iter().filter(|s| plan.needs(*s)).collect();
    assert_eq!(needed, [Stage::Octree, Stage::Diffuse, Stage::Shadows]);
    assert_eq!(plan.entries.len(), Stage::ALL.len() + 2 + 1);
}

#[test]
fn each_property_brings_its_stage() {
    let with = |change: fn(&mut Scene)| {
        let mut scene = scene();
        change(&mut scene);
        plan(&scene)
    };
    assert!(with(|s| material(s).mirror = Paint::grey(0.1)).needs(Stage::Reflection));
    assert!(with(|s| material(s).specular = Paint::grey(0.1)).needs(Stage::Specular));
    assert!(with(|s| s.ambient = RgbPower::splat(0.1)).needs(Stage::Ambient));
    assert!(with(|s| s.settings.image.samples = 2).needs(Stage::AntiAliasing));
    assert!(with(|s| s.objects[0].shape = Shape::from(Primitive::Sphere { radius: 1.0 })).needs(Stage::Normals));
    let dark = with(|s| s.lights.clear());
    assert!(!dark.needs(Stage::Shadows) && !dark.needs(Stage::Diffuse));
    let shallow = with(|s| {
        material(s).mirror = Paint::grey(0.1);
        s.settings.light.reflection_depth = 0;
    });
    assert!(!shallow.needs(Stage::Reflection));
}

#[test]
fn an_object_out_of_view_is_kept_for_its_shadow_or_its_mirror_image_only() {
    assert!(plan(&scene()).includes_object(1), "it stands between the light and the cube in view");
    let mut lit_from_the_left = scene();
    lit_from_the_left.lights =
        vec![Light::Directional { direction: DVec3::new(1.0, 0.0, 0.0), irradiance: Color::grey(1.0) }];
    assert!(!plan(&lit_from_the_left).includes_object(1));
    let mut lamp = scene();
    lamp.lights = vec![Light::Point { at: DVec3::new(9.0, 9.0, 9.0), intensity: Color::grey(1.0) }];
    assert!(!plan(&lamp).includes_object(1), "beyond the lamp");
    material(&mut lamp).mirror = Paint::grey(0.5);
    assert!(plan(&lamp).includes_object(1), "a mirror may show it");
}

#[test]
fn a_light_without_power_is_left_out() {
    let mut scene = scene();
    scene.lights.push(Light::Point { at: DVec3::Y, intensity: Color::BLACK });
    let plan = plan(&scene);
    assert!(plan.includes_light(0) && !plan.includes_light(1));
}

#[test]
fn seconds_of_all_work_of_a_stage_are_added_up() {
    let prepared = Prepared::new(&scene()).expect("a scene");
    let mut plan = Plan::new(&prepared, &prepared.view());
    let total = |name, seconds| StageTotal { name, depth: 0, seconds, times: 1 };
    let totals = [
        total("tracing photons", 0.25),
        total("rendering", 7.0),
        total("tracing photons", 0.5),
        total("allocating photon paths", 1.0),
    ];
    plan.set_seconds(&totals);
    let seconds: Vec<_> = plan.entries.iter().filter_map(|e| Some((e.name.as_str(), e.seconds?))).collect();
    assert_eq!(seconds, [("photon map", 1.75)]);
    assert!(plan.table().lines().next().is_some_and(|head| head.contains(" seconds ")));
}

#[test]
fn a_forced_plan_leaves_nothing_out_and_says_so() {
    let mut scene = scene();
    scene.lights.clear();
    let prepared = Prepared::new(&scene).expect("a scene");
    let plan = Plan::everything(&prepared, &prepared.view());
    // Spectra, caustics and radiosity are another picture: they are not forced.
    let others = [Stage::Spectra, Stage::PhotonMap, Stage::SurfacePoints, Stage::Radiosity];
    let all = plan.entries.iter().filter(|e| others.iter().all(|stage| e.name != stage.word()));
    assert!(all.clone().count() + others.len() == plan.entries.len() && all.clone().all(|e| e.needed));
    assert!(Stage::ALL.into_iter().all(|s| plan.needs(s) != others.contains(&s)));
    assert!(plan.entries.iter().any(|e| e.reason.starts_with("forced; no light")));
    assert!(plan.table().lines().count() == plan.entries.len() + 1);
    assert!(!plan.table().contains("seconds"));
    let json = serde_json::to_value(&plan).expect("plain data");
    assert_eq!(json["forced"], true);
    assert_eq!(json["entries"][0]["name"], "octree");
}
