//! Facts about detail on demand: what models make looks as objects do, and pictures do not tell what was kept of it.

use super::instance_tests::{at, differing, diffuse, green, instances, lit, maps, object};
use super::{RENDERERS, RenderError, RenderOrder, RendererRow, Rendering, Task, Technique, Watch};
use crate::illumination::material::{MaterialKind, RefractiveIndex, Transparent};
use crate::illumination::texture::{Motif, Pattern, TextureMapping};
use crate::illumination::{Material, Paint};
use crate::numeric::bounds::Bounds;
use crate::octree::Instance;
use crate::plan::Plan;
use crate::scene::{Object, Prepared, Procedural, ProceduralModel, Scene, Settings};
use crate::solid::Primitive;
use glam::{DAffine3, DMat4, DQuat, DVec3};
use std::sync::Arc;

/// What makes a model.
type Maker = fn(u32, f64) -> Result<Vec<Object>, String>;

/// A model that a function makes.
struct Made {
    bounds: Bounds,
    kinds: u32,
    make: Maker,
}

impl std::fmt::Debug for Made {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} kinds", self.kinds)
    }
}

impl ProceduralModel for Made {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn kinds(&self) -> u32 {
        self.kinds
    }

    fn materials(&self) -> Vec<Material> {
        Vec::new()
    }

    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        (self.make)(seed, detail)
    }

    fn definition(&self) -> String {
        format!("{:?} {} {:p}", self.bounds, self.kinds, self.make as *const ())
    }
}

fn model(half: f64, kinds: u32, make: Maker) -> Object {
    let bounds = Bounds { min: DVec3::splat(-half), max: DVec3::splat(half) };
    let model = Procedural::new(Arc::new(Made { bounds, kinds, make })).unwrap_or_else(|problem| panic!("{problem}"));
    Object::procedural("model".into(), model)
}

fn cube(size: DVec3, place: DVec3) -> Object {
    let checker = |solid: bool| Pattern {
        motif: Motif::Checker,
        laying: TextureMapping { solid, size: DVec3::splat(0.21), ..TextureMapping::default() },
        paints: vec![Paint::grey(0.8), Paint::grey(0.2)],
    };
    let paint = Paint::Pattern(Box::new(checker(place.x > 0.0)));
    object(Primitive::Box { size }, DMat4::from_translation(place), diffuse(paint))
}

/// Two cubes, of which the second is the larger, the larger the seed.
fn cubes(seed: u32, _: f64) -> Result<Vec<Object>, String> {
    let larger = 0.5 + 0.1 * f64::from(seed);
    Ok(vec![cube(DVec3::splat(0.6), DVec3::X * -0.5), cube(DVec3::splat(larger), DVec3::X * 0.4)])
}

/// A cube with many on its top, of which only those are made that are seen; half of them instances.
fn crumbs(seed: u32, detail: f64) -> Result<Vec<Object>, String> {
    let mut all = vec![cube(DVec3::new(1.2, 0.4, 1.2), DVec3::new(0.1, 0.0, 0.0))];
    let turned = DMat4::from_quat(DQuat::from_rotation_y(f64::from(seed)));
    let (step, count) = (0.5_f64, (0.5 / detail).clamp(1.0, 12.0) as usize);
    let places = (0..count * count).map(|n| DVec3::new((n % count) as f64, 0.0, (n / count) as f64) / count as f64);
    let place = |place: DVec3| DVec3::Y * 0.25 + (place - DVec3::new(0.5, 0.0, 0.5)) * step;
    let crumb = cube(DVec3::splat(0.3 / count as f64), DVec3::X * 1e-9);
    let (one, other): (Vec<DVec3>, Vec<DVec3>) = places.map(place).partition(|at| at.x < at.z);
    all.extend(
        one.into_iter().map(|place| Object {
            transform: turned * DMat4::from_translation(place) * crumb.transform,
            ..crumb.clone()
        }),
    );
    let placements = other.into_iter().map(|place| at(DAffine3::from_translation(place), 0, 0)).collect();
    all.push(instances(vec![vec![crumb]], placements, turned));
    Ok(all)
}

fn placed(model: Object, placements: Vec<Instance>) -> Object {
    instances(vec![vec![model]], placements, DMat4::IDENTITY)
}

/// Many instances from near to far, of different kinds.
fn field(model: Object) -> Scene {
    let place = |n: usize| {
        let (x, z) = ((n % 12) as f64 - 5.5, (n / 12) as f64);
        let turn = DQuat::from_rotation_y(n as f64);
        let placement = DAffine3::from_rotation_translation(turn, DVec3::new(1.8 * x, -1.0, 8.0 - 3.0 * z));
        at(placement, 0, n as u16)
    };
    lit(vec![placed(model, (0..120).map(place).collect())])
}

fn prepared(scene: &Scene, row: &RendererRow) -> Prepared {
    let mut scene = scene.clone();
    (row.require)(&mut scene.settings);
    Prepared::new(&scene).unwrap_or_else(|error| panic!("{error}"))
}

fn render(prepared: &Prepared, row: &RendererRow, threads: usize) -> Result<Rendering, RenderError> {
    let view = prepared.view();
    let plan = Plan::new(prepared, &view);
    let made = row.technique.prepare(&Task::new(prepared, &plan)).expect("ready");
    let order = RenderOrder { threads: std::num::NonZeroUsize::new(threads), ..RenderOrder::of(&prepared.settings) };
    made.renderer.any().render(&view, &order, &Watch::NOBODY)
}

#[test]
fn what_a_model_makes_looks_as_objects_do_in_every_technique() {
    let places: Vec<DAffine3> = maps();
    let variations = || (0..places.len()).map(|n| n as u16 * 3);
    let placements = places.iter().zip(variations()).map(|(map, variation)| at(*map, 0, variation)).collect();
    let modelled = lit(vec![placed(model(1.2, 5, cubes), placements)]);
    let copies = places.iter().zip(variations()).flat_map(|(map, variation)| {
        let made = cubes(u32::from(variation) % 5, 1.0).expect("cubes");
        made.into_iter().map(|object| Object { transform: DMat4::from(*map) * object.transform, ..object })
    });
    let copied = lit(copies.collect());
    for row in &RENDERERS {
        let one = render(&prepared(&modelled, row), row, 2).expect("a picture");
        let other = render(&prepared(&copied, row), row, 2).expect("a picture");
        let most = if row.solves_radiosity { 60 } else { 12 };
        let differing = differing(&one, &other);
        assert!(differing <= most, "{}: {differing} pixels", row.word);
    }
}

#[test]
fn pictures_do_not_tell_how_much_is_kept_nor_how_many_threads_there_are() {
    let row = Technique::RayTracing.row();
    let mut scene = field(model(1.2, 40, crumbs));
    scene.settings.image.samples = 2;
    let picture = |most: Option<u64>, threads: usize| {
        let prepared = prepared(&scene, row);
        if let Some(most) = most {
            prepared.limit_details(most);
        }
        let made = green(&render(&prepared, row, threads).expect("a picture"));
        (made, prepared.detail_costs().expect("models"))
    };
    let (whole, all) = picture(None, 1);
    assert_eq!(all.made, all.kept as u64, "each is made once: {all:?}");
    assert!(all.kept > 60 && all.bytes > 1 << 20, "{all:?}");
    for (most, threads) in [(None, 2), (Some(all.bytes / 8), 1), (Some(all.bytes / 8), 2), (Some(0), 2)] {
        let (made, costs) = picture(most, threads);
        assert!(made == whole, "{most:?} bytes, {threads} threads");
        if let Some(most) = most {
            assert!(costs.made > all.made, "{costs:?}");
            assert!(costs.bytes <= most.max(all.bytes / 10), "{costs:?}");
        }
    }
}

#[test]
fn the_detail_that_is_made_is_that_of_a_quarter_pixel_near_and_far() {
    let row = Technique::RayTracing.row();
    fn balls(_: u32, detail: f64) -> Result<Vec<Object>, String> {
        let ball = object(Primitive::Sphere { radius: 1.0 }, DMat4::IDENTITY, diffuse(Paint::grey(0.5)));
        assert!(detail > 0.0);
        Ok(vec![ball])
    }
    let prepared = prepared(&field(model(1.0, 1, balls)), row);
    let details = prepared.details(&[prepared.view()], &Settings::of_size(1920, 960, 1)).expect("a model");
    let triangles = |z: f64| {
        let placement = DAffine3::from_translation(DVec3::new(0.0, 0.0, z));
        let placed = crate::octree::PlacedSurface { placement, variation: 0, largest: 0.0 };
        let made = details.made(0, &placed, None).expect("a model");
        made.contents().triangles.len() as f64
    };
    let counts = [-5.0, -39.0, -158.0, -638.0].map(triangles);
    // The chord error of a sphere is as the area of its triangles, and what a pixel spans as the distance.
    for pair in counts.windows(2) {
        assert!((2.0..8.5).contains(&(pair[0] / pair[1])), "{counts:?}");
    }
    let [near, .., far] = counts;
    assert!((20.0..100.0).contains(&(near / far)), "{counts:?}");
}

#[test]
fn glass_that_is_made_on_demand_lets_light_through_as_other_glass_does() {
    fn panes(_: u32, _: f64) -> Result<Vec<Object>, String> {
        let body = MaterialKind::Transparent(Transparent::clear(RefractiveIndex::Constant(1.5)));
        let size = DVec3::new(1.0, 0.3, 1.0);
        let above = DMat4::from_translation(DVec3::Y * 0.5);
        Ok(vec![
            object(Primitive::Box { size }, DMat4::IDENTITY, body.clone().into()),
            object(Primitive::Box { size }, above, body.into()),
        ])
    }
    let row = Technique::RayTracing.row();
    let mut modelled = lit(vec![placed(model(0.9, 3, panes), maps().into_iter().map(|map| at(map, 0, 1)).collect())]);
    modelled.settings.light.reflection_depth = 12;
    let copies = instances(
        vec![panes(0, 1.0).expect("panes")],
        maps().into_iter().map(|m| at(m, 0, 1)).collect(),
        DMat4::IDENTITY,
    );
    let copied = Scene { objects: vec![modelled.objects[0].clone(), copies], ..modelled.clone() };
    let [one, other] = [modelled, copied].map(|scene| render(&prepared(&scene, row), row, 2).expect("a picture"));
    assert!(differing(&one, &other) <= 12, "{} pixels", differing(&one, &other));
}

#[test]
fn what_cannot_be_made_is_told_before_or_with_the_picture() {
    let row = Technique::RayTracing.row();
    let cases: [(Maker, &str); 3] = [
        (|seed, _| if seed < 30 { cubes(0, 1.0) } else { Err("too old".into()) }, "too old"),
        (|seed, _| cubes(if seed == 7 { 40 } else { 1 }, 1.0), "out of the box of its model"),
        (
            |seed, _| {
                let mut all = cubes(1, 1.0)?;
                all[1].material = Some(diffuse(Paint::grey(0.01 * f64::from(seed))));
                Ok(all)
            },
            "a material that the model of seed 0 has not",
        ),
    ];
    for (make, words) in cases {
        let scene = field(model(1.2, 40, make));
        let Err(error) = render(&prepared(&scene, row), row, 2) else { panic!("a picture without {words}") };
        assert!(matches!(&error, RenderError::Model(problem) if problem.contains(words)), "{error}");
    }
    let unsound = |half: f64, kinds: u32, make| {
        let bounds = Bounds { min: DVec3::splat(-half), max: DVec3::splat(half) };
        Procedural::new(Arc::new(Made { bounds, kinds, make })).expect_err("refused")
    };
    assert!(unsound(-1.0, 1, cubes).contains("has no size"));
    assert!(unsound(f64::NAN, 1, cubes).contains("has no size"));
    assert!(unsound(1.0, 0, cubes).contains("0 kinds"));
    assert!(unsound(1.0, 1, |_, _| Ok(Vec::new())).contains("makes nothing"));
    assert!(unsound(1.0, 1, |_, _| Ok(vec![model(1.2, 1, cubes)])).contains("cannot be made of models"));
}
