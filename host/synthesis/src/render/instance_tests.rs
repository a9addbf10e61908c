//! Facts about instances, for every technique: they look as objects of their own do, in any size, and cost little.

use super::{RENDERERS, RenderOrder, RendererRow, Rendering, Task, Technique, Watch};
use crate::color::Color;
use crate::illumination::material::{Classic, Material, MaterialKind, RefractiveIndex, Transparent};
use crate::illumination::texture::{Motif, NumberTexture, Pattern, TextureMapping};
use crate::illumination::{Light, Paint};
use crate::octree::Instance;
use crate::plan::Plan;
use crate::scene::{
    Camera, DetailCosts, Instances, Motion, Object, PlacementList, Placing, Prepared, Scatter, Scene, SceneError,
    Settings, Shape,
};
use crate::solid::Primitive;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use std::num::NonZeroUsize;

pub(super) fn diffuse(paint: Paint) -> Material {
    Classic { diffuse: paint, ..Classic::default() }.into()
}

pub(super) fn object(shape: impl Into<Shape>, transform: DMat4, material: Material) -> Object {
    let shape = shape.into();
    Object { name: shape.word().into(), shape, transform, material: Some(material), tolerance: None }
}

pub(super) fn instances(prototypes: Vec<Vec<Object>>, placements: Vec<Instance>, transform: DMat4) -> Object {
    let placing = Placing::Listed(PlacementList(placements));
    let shape = Shape::Instances(Box::new(Instances { prototypes, placing }));
    Object { name: "instances".into(), shape, transform, material: None, tolerance: None }
}

pub(super) fn at(placement: DAffine3, prototype: u16, variation: u16) -> Instance {
    Instance { prototype, variation, placement }
}

pub(super) fn camera(from: DVec3, field_of_view: f64) -> Camera {
    Camera {
        from,
        at: DVec3::ZERO,
        up: DVec3::Y,
        field_of_view,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    }
}

pub(super) fn render(scene: &Scene, row: &RendererRow) -> Rendering {
    let mut scene = scene.clone();
    (row.require)(&mut scene.settings);
    let prepared = Prepared::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let made = row.technique.prepare(&Task::new(&prepared, &plan)).expect("ready");
    made.renderer.any().render(&view, &RenderOrder::of(&prepared.settings), &Watch::NOBODY).expect("a picture")
}

/// The green of a picture that keeps so many bytes of what is made on demand and has so many threads, and what was made.
pub(super) fn render_within(
    scene: &Scene,
    row: &RendererRow,
    most: Option<u64>,
    threads: usize,
) -> (Vec<f64>, DetailCosts) {
    let prepared = Prepared::new(scene).unwrap_or_else(|error| panic!("{error}"));
    if let Some(most) = most {
        prepared.limit_details(most);
    }
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let made = row.technique.prepare(&Task::new(&prepared, &plan)).expect("ready");
    let order = RenderOrder { threads: NonZeroUsize::new(threads), ..RenderOrder::of(&prepared.settings) };
    let rendering = made.renderer.any().render(&view, &order, &Watch::NOBODY).expect("a picture");
    (green(&rendering), prepared.detail_costs().expect("something made on demand"))
}

pub(super) fn green(rendering: &Rendering) -> Vec<f64> {
    rendering.picture.pixels().iter().map(|pixel| f64::from(pixel.radiance[1])).collect()
}

/// Maps that turn, stretch, skew and mirror, about a few places.
pub(super) fn maps() -> Vec<DAffine3> {
    let turned = |angle: f64| DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle));
    let skewed = DMat3::from_cols(DVec3::X, DVec3::new(0.4, 0.8, 0.0), DVec3::new(0.0, 0.3, 1.2));
    let matrices = [
        DMat3::IDENTITY,
        turned(1.0) * 0.7,
        turned(2.0) * DMat3::from_diagonal(DVec3::new(0.4, 1.3, -0.8)),
        skewed,
        skewed * turned(4.0) * DMat3::from_diagonal(DVec3::new(-1.0, 0.5, 0.5)),
    ];
    let place = |(number, matrix3): (usize, DMat3)| {
        let translation = DVec3::new(2.2 * (number as f64 - 2.0), 0.7 * (number % 2) as f64, -(number as f64 % 3.0));
        DAffine3 { matrix3, translation }
    };
    matrices.into_iter().enumerate().map(place).collect()
}

/// A checkered ball on a patterned box, as a group; its second material varies by instance.
fn group() -> Vec<Object> {
    let checker = Pattern {
        motif: Motif::Checker,
        laying: TextureMapping { size: DVec3::splat(0.2), ..TextureMapping::default() },
        paints: vec![Paint::grey(0.8), Paint::grey(0.2)],
    };
    let ball = object(
        Primitive::Sphere { radius: 0.5 },
        DMat4::from_translation(DVec3::Y * 0.6),
        diffuse(Paint::Pattern(Box::new(checker))),
    );
    let cubes = Pattern {
        motif: Motif::Checker,
        laying: TextureMapping { solid: true, size: DVec3::splat(0.3), ..TextureMapping::default() },
        paints: vec![Paint::grey(0.3), Paint::grey(0.7)],
    };
    let size = DVec3::new(1.0, 0.4, 0.8);
    vec![ball, object(Primitive::Box { size }, DMat4::IDENTITY, diffuse(Paint::Pattern(Box::new(cubes))))]
}

pub(super) fn lit(objects: Vec<Object>) -> Scene {
    let lamp = Light::Point { at: DVec3::new(4.0, 9.0, 6.0), intensity: Color::grey(600.0) };
    let mut floor =
        object(Shape::Ground { size: 40.0 }, DMat4::from_translation(DVec3::Y * -1.2), diffuse(Paint::grey(0.5)));
    floor.name = "floor".into();
    let mut settings = Settings::of_size(96, 48, 1);
    settings.light.reflection_depth = 2;
    let objects = [vec![floor], objects].concat();
    Scene {
        objects,
        lights: vec![lamp],
        settings,
        camera: Some(camera(DVec3::new(0.0, 4.0, 12.0), 35.0)),
        ..Scene::default()
    }
}

/// Every object of a group at every place.
fn copies(group: &[Object], places: &[DAffine3]) -> Vec<Object> {
    let placed = |place: &DAffine3, object: &Object| Object {
        transform: DMat4::from(*place) * object.transform,
        ..object.clone()
    };
    places.iter().flat_map(|place| group.iter().map(move |object| placed(place, object))).collect()
}

/// How many pixels differ by more than rounding.
pub(super) fn differing(one: &Rendering, other: &Rendering) -> usize {
    let far = |(a, b): (f64, f64)| (a - b).abs() > 1e-3 * (a.abs() + b.abs()) + 1e-5;
    green(one).into_iter().zip(green(other)).filter(|pair| far(*pair)).count()
}

#[test]
fn instances_look_as_objects_of_their_own_do() {
    let turn = DMat4::from_rotation_y(0.3) * DMat4::from_scale(DVec3::splat(0.9));
    let placements = maps().into_iter().map(|map| at(map, 0, 0)).collect();
    let placed = lit(vec![instances(vec![group()], placements, turn)]);
    let places: Vec<DAffine3> = maps().into_iter().map(|map| DAffine3::from_mat4(turn) * map).collect();
    let copied = lit(copies(&group(), &places));
    for row in RENDERERS.iter().filter(|row| !row.solves_radiosity) {
        let differing = differing(&render(&placed, row), &render(&copied, row));
        // At edges, rounding decides.
        assert!(differing <= 12, "{}: {differing}", row.word);
    }
}

#[test]
fn what_is_nested_and_moves_looks_as_objects_that_move() {
    let inner: Vec<Instance> = maps().into_iter().take(3).map(|map| at(map, 0, 0)).collect();
    let places: Vec<DAffine3> = maps().into_iter().map(|map| DAffine3 { matrix3: map.matrix3 * 0.3, ..map }).collect();
    let outer = places.iter().map(|map| at(*map, 0, 0)).collect();
    let nested =
        instances(vec![vec![instances(vec![group()], inner, DMat4::from_rotation_x(0.2))]], outer, DMat4::IDENTITY);
    let all: Vec<DAffine3> = places
        .iter()
        .flat_map(|place| {
            maps().into_iter().take(3).map(|map| *place * DAffine3::from_mat4(DMat4::from_rotation_x(0.2)) * map)
        })
        .collect();
    let motion = Motion { by: DVec3::new(0.5, 0.2, 0.0), through: DVec3::X, axis: DVec3::Y, angle: 0.4 };
    for moves in [false, true] {
        let mut placed = lit(vec![nested.clone()]);
        let mut copied = lit(copies(&group(), &all));
        if moves {
            placed.motions = vec![(1, motion)];
            copied.motions = (1..copied.objects.len() as u32).map(|object| (object, motion)).collect();
        }
        for row in [Technique::RayTracing, Technique::ScanLine].map(Technique::row) {
            let differing = differing(&render(&placed, row), &render(&copied, row));
            assert!(differing <= 20, "{} {moves}: {differing}", row.word);
        }
    }
}

#[test]
fn an_instance_in_any_size_is_lit_by_all_of_a_sky() {
    // A convex body under a sky: no ray that leaves it comes back.
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let turned = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 2.5));
    for size in [1e-6, 1.0, 1e6] {
        for shape in [Primitive::Box { size: DVec3::ONE }, Primitive::Sphere { radius: 0.6 }] {
            for mirror in [1.0, -1.0] {
                let body = object(shape.clone(), DMat4::IDENTITY, diffuse(Paint::grey(0.5)));
                // Small within large, and large within small; far from the middle, and back.
                let far = DVec3::new(300.0, -40.0, 7.0);
                let inner = DAffine3 { matrix3: turned * (mirror * size), translation: far * size };
                let outer = DAffine3 { matrix3: turned.transpose() / size, translation: turned.transpose() * -far };
                let nested = instances(
                    vec![vec![instances(vec![vec![body]], vec![at(inner, 0, 0)], DMat4::IDENTITY)]],
                    vec![at(outer, 0, 0)],
                    DMat4::IDENTITY,
                );
                let mut settings = Settings::of_size(16, 16, 16);
                settings.light.samples = 4;
                let camera = Some(camera(DVec3::new(1.0, 2.0, 6.0), 4.0));
                let scene =
                    Scene { objects: vec![nested], lights: vec![sky.clone()], settings, camera, ..Scene::default() };
                let found = green(&render(&scene, Technique::RayTracing.row()));
                let mean = found.iter().sum::<f64>() / found.len() as f64;
                assert!((mean - 0.5).abs() < 0.005, "{shape:?} {size} {mirror}: {mean}");
            }
        }
    }
}

#[test]
fn glass_instances_lose_no_light() {
    let glass = MaterialKind::Transparent(Transparent::clear(RefractiveIndex::Constant(1.5))).into();
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let ball = object(Primitive::Sphere { radius: 0.8 }, DMat4::IDENTITY, glass);
    let placements =
        maps().into_iter().map(|map| at(DAffine3 { translation: map.translation * 0.6, ..map }, 0, 0)).collect();
    let mut settings = Settings::of_size(32, 16, 16);
    settings.light.reflection_depth = 200;
    let camera = Some(camera(DVec3::new(0.0, 1.0, 9.0), 25.0));
    let objects = vec![instances(vec![vec![ball]], placements, DMat4::IDENTITY)];
    let scene = Scene { objects, lights: vec![sky], settings, camera, ..Scene::default() };
    let found = green(&render(&scene, Technique::RayTracing.row()));
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    assert!((mean - 1.0).abs() < 0.01, "{mean}");
}

/// What is scattered in the cells of a ground that is placed in some way.
fn in_cells(ground: DMat4, cell: f64, change: impl Fn(&mut Scatter)) -> Object {
    let on = object(Shape::Ground { size: 9.0 }, ground, diffuse(Paint::grey(0.5)));
    let mut scatter = Scatter {
        cell: Some(cell),
        density: NumberTexture::Constant(0.8),
        scale: [0.3, 0.8],
        sink: 0.1,
        seed: 5,
        ..Scatter::over(on, 2)
    };
    change(&mut scatter);
    let shape = Shape::Instances(Box::new(Instances {
        prototypes: vec![group()],
        placing: Placing::Scattered(Box::new(scatter)),
    }));
    Object { name: "cells".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None }
}

#[test]
fn instances_in_cells_look_as_copies_do() {
    let tilted = DMat4::from_rotation_z(0.3) * DMat4::from_scale(DVec3::new(-1.0, 1.0, 0.5));
    let cases = [
        in_cells(DMat4::IDENTITY, 1.5, |_| {}),
        in_cells(DMat4::IDENTITY, 0.7, |scatter| (scatter.lean, scatter.sink) = (60.0, 0.8)),
        in_cells(tilted, 1.5, |scatter| (scatter.lean, scatter.upright) = (20.0, 1.0)),
        in_cells(DMat4::from_rotation_x(2.5), 4.0, |scatter| (scatter.count, scatter.turn) = (9, 0.0)),
    ];
    for (number, cells) in cases.into_iter().enumerate() {
        let mut scene = lit(vec![cells]);
        let of = |scene: &Scene| render(scene, Technique::RayTracing.row());
        let placed = of(&scene);
        scene.settings.geometry.copies_instances = true;
        let differing = differing(&placed, &of(&scene));
        assert!(differing <= 12, "case {number}: {differing}");
        scene.objects.pop();
        let without = of(&scene);
        let seen = self::differing(&placed, &without);
        assert!(seen > 300, "case {number}: {seen} pixels are theirs");
    }
}

#[test]
fn a_material_varies_by_instance_placed_and_copied() {
    let varied = Pattern {
        motif: Motif::Varied { channel: 0 },
        laying: TextureMapping { solid: true, ..TextureMapping::default() },
        paints: vec![Paint::grey(0.0), Paint::grey(1.0)],
    };
    let body = object(Primitive::Box { size: DVec3::ONE }, DMat4::IDENTITY, diffuse(Paint::Pattern(Box::new(varied))));
    let place = |x: f64, variation: u16| at(DAffine3::from_translation(DVec3::X * x), 0, variation);
    let placements = vec![place(-1.0, 0), place(0.0, u16::MAX / 2), place(1.0, u16::MAX)];
    let row = instances(vec![vec![body]], placements, DMat4::IDENTITY);
    let mut settings = Settings::of_size(3, 1, 1);
    settings.image.height = 1;
    let lights = vec![Light::Directional { direction: DVec3::NEG_Z, irradiance: Color::grey(std::f64::consts::PI) }];
    let mut scene =
        Scene { objects: vec![row], lights, settings, camera: Some(camera(DVec3::Z * 20.5, 2.86)), ..Scene::default() };
    // Hardly anything: copies that move are carried from where they are kept.
    let motion = Motion { by: DVec3::X * 1e-9, through: DVec3::ZERO, axis: DVec3::Y, angle: 0.0 };
    for (copies, moves) in [(false, false), (true, false), (false, true), (true, true)] {
        scene.settings.geometry.copies_instances = copies;
        scene.motions = if moves { vec![(0, motion)] } else { Vec::new() };
        let found = green(&render(&scene, Technique::RayTracing.row()));
        for (found, expected) in found.iter().zip([0.0, 0.5, 1.0]) {
            assert!((found - expected).abs() < 1e-3, "{copies} {moves}: {found} {expected}");
        }
    }
}

#[test]
fn what_cannot_be_placed_is_refused_by_name() {
    let refused = |object: Object| match Prepared::new(&Scene { objects: vec![object], ..Scene::default() }) {
        Err(SceneError::Object { object, problem }) => format!("{object}: {problem}"),
        other => panic!("{other:?}"),
    };
    let cube = || object(Primitive::Box { size: DVec3::ONE }, DMat4::IDENTITY, diffuse(Paint::grey(0.5)));
    let mut lamp = cube();
    lamp.name = "lamp".into();
    lamp.material = Some(Material { emission: Color::grey(1.0), ..Material::default() });
    let here = at(DAffine3::IDENTITY, 0, 0);
    let of = |object: Object, instance: Instance| {
        refused(instances(vec![vec![object]], vec![here, instance], DMat4::IDENTITY))
    };
    assert_eq!(of(lamp, here), "lamp: it emits light, and what emits light cannot be an instance; copy it instead");
    let flat = at(DAffine3::from_scale(DVec3::new(1.0, 1e-300, 1.0)), 0, 0);
    assert_eq!(of(cube(), flat), "instances: the placement of instance 1 flattens it");
    let far = at(DAffine3::from_translation(DVec3::X * 1e200), 0, 0);
    assert!(of(cube(), far).starts_with("instances: an instance is placed farther than"));
    let unknown = Instance { prototype: 3, ..here };
    assert_eq!(of(cube(), unknown), "instances: instance 1 places prototype 3, but there are only 1");
}

#[test]
fn the_plan_tells_instances_and_leaves_out_those_out_of_sight() {
    let cube = object(Primitive::Box { size: DVec3::ONE }, DMat4::IDENTITY, diffuse(Paint::grey(0.5)));
    let place = |x: f64| at(DAffine3::from_translation(DVec3::X * x), 0, 0);
    let seen = instances(vec![vec![cube.clone()]], vec![place(0.0), place(1.0)], DMat4::IDENTITY);
    let unseen = instances(vec![vec![cube]], vec![place(-500.0)], DMat4::IDENTITY);
    let scene = Scene { camera: Some(camera(DVec3::Z * 9.0, 30.0)), objects: vec![seen, unseen], ..Scene::default() };
    let prepared = Prepared::new(&scene).expect("a scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let needed: Vec<bool> = (0..prepared.objects.len()).map(|object| plan.includes_object(object)).collect();
    assert_eq!(needed, [true, false, true, false], "instances of both objects, then what they place");
    let reasons: Vec<&str> = plan.entries.iter().map(|entry| &*entry.reason).collect();
    assert!(
        reasons.contains(&"in view, 2 instances") && reasons.contains(&"placed by instances, 12 triangles"),
        "{reasons:?}"
    );
}
