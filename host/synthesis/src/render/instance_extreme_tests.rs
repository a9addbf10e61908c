//! Instances at the extremes, and meshes that files place many times: each picture is held against a closed form, or
//! against that of objects that are no instances.

use super::instance_tests::{at, camera, differing, diffuse, green, instances, lit, maps, object, render};
use super::{RENDERERS, Technique};
use crate::color::Color;
use crate::illumination::material::Material;
use crate::illumination::{Light, Paint};
use crate::mesh::{self, Mesh, MeshPlace, MeshPlaces, PlacedMeshes, RepeatedMesh};
use crate::octree::MOST_LEVELS;
use crate::plan::Plan;
use crate::scene::{Instances, Object, Placing, Prepared, Scatter, Scene, Settings, Shape};
use crate::solid::Primitive;
use crate::surface::Tolerance;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use std::path::{Path, PathBuf};

/// What of a sky a convex body of reflectance 0.5 sends back, as the mean of what is seen of it: 0.5, whatever it is.
fn lit_by_sky(body: Object) -> f64 {
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let mut settings = Settings::of_size(12, 12, 16);
    settings.light.samples = 4;
    let camera = Some(camera(DVec3::new(1.0, 2.0, 6.0), 4.0));
    let scene = Scene { objects: vec![body], lights: vec![sky], settings, camera, ..Scene::default() };
    let found = green(&render(&scene, Technique::RayTracing.row()));
    found.iter().sum::<f64>() / found.len() as f64
}

fn cube() -> Object {
    object(Primitive::Box { size: DVec3::ONE }, DMat4::IDENTITY, diffuse(Paint::grey(0.5)))
}

#[test]
fn instances_nested_as_deep_as_can_be_each_a_million_times_as_large_or_as_small_are_lit_by_all_of_a_sky() {
    let turned = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 1.1));
    let mut body = cube();
    let levels = MOST_LEVELS - 1;
    for level in 0..levels {
        // Down and up by turns, each level mirrored; the last one gives the size back.
        let size = match level {
            _ if level == levels - 1 => 1.0,
            even if even % 2 == 0 => -1e-6,
            _ => -1e6,
        };
        let map = DAffine3 { matrix3: turned * size, translation: DVec3::ZERO };
        body = instances(vec![vec![body]], vec![at(map, 0, 0)], DMat4::IDENTITY);
    }
    let mean = lit_by_sky(body);
    assert!((mean - 0.5).abs() < 0.005, "{mean}");
}

#[test]
fn ten_thousand_instances_at_one_place_look_as_one() {
    let turned = DAffine3::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0));
    let all = |count: usize| instances(vec![vec![cube()]], vec![at(turned, 0, 0); count], DMat4::IDENTITY);
    let mean = lit_by_sky(all(10_000));
    assert!((mean - 0.5).abs() < 0.005, "{mean}");
    let (one, many) = (lit(vec![all(1)]), lit(vec![all(10_000)]));
    let row = Technique::RayTracing.row();
    assert_eq!(differing(&render(&one, row), &render(&many, row)), 0);
}

#[test]
fn needles_and_plates_of_one_prototype_are_lit_by_all_of_a_sky() {
    for scale in [DVec3::new(1.0, 1e4, 1.0), DVec3::new(1.0, 1.0, 1e-4), DVec3::new(-1e3, 1e3, 1e-3)] {
        // As large as one seen from in front: the whole picture lies on its face.
        let map = DAffine3 { matrix3: DMat3::from_diagonal(scale), translation: DVec3::ZERO };
        let mean = lit_by_sky(instances(vec![vec![cube()]], vec![at(map, 0, 0)], DMat4::IDENTITY));
        assert!((mean - 0.5).abs() < 0.005, "{scale}: {mean}");
    }
}

/// A file of a ball that is placed by maps that turn, stretch, skew and mirror, and of a box that stands alone.
fn file(folder: &Path) -> PathBuf {
    // So fine that it is no matter whether normals are placed before they are interpolated, or behind.
    let mesh = |primitive: Primitive| {
        Shape::from(primitive).tessellate(Tolerance::new(0.01, 3.0)).expect("a solid").mesh.welded()
    };
    let mut places = MeshPlaces::default();
    maps().into_iter().for_each(|placement| places.push(MeshPlace { mesh: 0, placement }));
    let ball = Mesh { surfaces: Vec::new(), ..mesh(Primitive::Sphere { radius: 0.7 }) };
    let beam = mesh(Primitive::Box { size: DVec3::new(9.0, 0.2, 0.3) });
    let alone = Mesh { surfaces: Vec::new(), ..beam }.into();
    let placed =
        PlacedMeshes { alone, repeated: vec![RepeatedMesh { name: "ball".into(), grouped: ball.into() }], places };
    let path = folder.join("balls.glb");
    std::fs::write(&path, mesh::print_placed(&placed, mesh::Format::Glb).expect("sound")).expect("written");
    path
}

fn of_file(path: &Path, transform: DMat4, material: Material) -> Object {
    Object { name: "balls".into(), ..object(Shape::Mesh { path: path.to_owned() }, transform, material) }
}

#[test]
fn what_a_file_places_many_times_is_stored_once_and_looks_as_its_copies_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let triangles = mesh::read(&path).expect("a mesh").triangles.len() as u32;
    let turn = DMat4::from_rotation_y(0.3) * DMat4::from_scale(DVec3::new(0.9, -0.8, 0.9));
    let placed = lit(vec![of_file(&path, turn, diffuse(Paint::grey(0.5)))]);
    let mut copied = placed.clone();
    copied.settings.geometry.copies_instances = true;
    for row in RENDERERS.iter().filter(|row| !row.solves_radiosity) {
        let differing = differing(&render(&placed, row), &render(&copied, row));
        assert!(differing <= 12, "{}: {differing}", row.word);
    }
    let [few, all] = [&placed, &copied].map(|scene| Prepared::new(scene).expect("a scene"));
    let told: Vec<(&str, u32, usize)> = few.objects[1..].iter().map(|o| (&*o.name, o.count, o.instances)).collect();
    let ball = (triangles - 12) / 5;
    assert_eq!(told, [("balls", 12, 5), ("balls/ball", ball, 0)]);
    assert_eq!(all.objects[1..].iter().map(|object| object.count).collect::<Vec<_>>(), [triangles]);
    // Maps that turn make the box around boxes larger.
    let (inner, outer) = (all.objects[1].bounds, few.objects[1].bounds);
    assert!(inner.min.cmpge(outer.min - 1e-5).all() && inner.max.cmple(outer.max + 1e-5).all());
    let plan = Plan::new(&few, &few.view());
    let reasons: Vec<&str> = plan.entries.iter().map(|entry| &*entry.reason).collect();
    assert!(reasons.contains(&"in view, 12 triangles and 5 instances"), "{reasons:?}");
    // What emits light has its triangles, each of them.
    let glow = Material { emission: Color::grey(1.0), ..Material::default() };
    let scene = Scene { objects: vec![of_file(&path, turn, glow)], ..Scene::default() };
    assert_eq!(Prepared::new(&scene).expect("a scene").objects[0].count, triangles);
}

#[test]
fn a_file_of_instances_is_placed_again_and_moves_and_is_written_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = file(folder.path());
    let small = DMat4::from_scale(DVec3::splat(0.4)) * DMat4::from_rotation_x(0.2);
    let group = vec![of_file(&path, small, diffuse(Paint::grey(0.4)))];
    let places = [-2.0, 0.0, 2.5].map(|x| at(DAffine3::from_translation(DVec3::new(x, 0.3 * x, 0.0)), 0, 0));
    let placed = lit(vec![instances(vec![group], places.to_vec(), DMat4::from_rotation_y(0.1))]);
    let mut copied = placed.clone();
    copied.settings.geometry.copies_instances = true;
    let row = Technique::RayTracing.row();
    let far = differing(&render(&placed, row), &render(&copied, row));
    assert!(far <= 12, "{far}");
    let prepared = Prepared::new(&copied).expect("a scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let reasons: Vec<&str> = plan.entries.iter().map(|entry| &*entry.reason).collect();
    assert!(reasons.contains(&"the copies of what it places stand for it, 3 objects"), "{reasons:?}");
    // As one mesh, and as meshes with their places.
    let whole = placed.tessellated().expect("triangles").mesh;
    let once = placed.tessellated_once().expect("triangles");
    assert_eq!(once.places.count(), 3 + 15);
    let names: Vec<&str> = once.repeated.iter().map(|repeated| &*repeated.name).collect();
    assert_eq!(names, ["instances/balls", "instances/balls/ball"]);
    let mut copies = once.alone.mesh.clone();
    for MeshPlace { mesh, placement } in once.places.iter() {
        copies.append(&once.repeated[mesh as usize].grouped.mesh.transformed(&placement), 0);
    }
    let (one, other) = (whole.bounds().expect("some"), copies.bounds().expect("some"));
    assert!((one.min - other.min).abs().max_element() < 1e-9 && (one.max - other.max).abs().max_element() < 1e-9);
    assert!((whole.signed_volume() / copies.signed_volume() - 1.0).abs() < 1e-9);
    assert_eq!(copies.triangles.len(), whole.triangles.len());
}

#[test]
fn instances_that_find_no_room_are_told_with_both_numbers_placed_and_copied() {
    let scatter = |on: f64, count: usize| {
        let on = object(Shape::Ground { size: on }, DMat4::IDENTITY, diffuse(Paint::grey(0.5)));
        Scatter { distance: 1.0, seed: 7, ..Scatter::over(on, count) }
    };
    let scattered = |name: &str, group: Object, scatter: Scatter| {
        let placing = Placing::Scattered(Box::new(scatter));
        let shape = Shape::Instances(Box::new(Instances { prototypes: vec![vec![group]], placing }));
        Object { name: name.into(), ..object(shape, DMat4::IDENTITY, diffuse(Paint::grey(0.5))) }
    };
    let tuft = scattered("tuft", cube(), scatter(3.0, 500));
    let mut scene = Scene {
        objects: vec![scattered("meadow", tuft, scatter(40.0, 5)), scattered("row", cube(), scatter(40.0, 5))],
        ..Scene::default()
    };
    for copies in [false, true] {
        scene.settings.geometry.copies_instances = copies;
        let prepared = Prepared::new(&scene).expect("a scene");
        let [short] = &prepared.short_scatters[..] else { panic!("{:?}", prepared.short_scatters) };
        assert_eq!((short.object.as_str(), short.asked), ("tuft", 500));
        assert!((5..20).contains(&short.found), "{short}");
        assert_eq!(short.to_string(), format!("tuft: scatter found room for {} of 500 instances", short.found));
    }
}
