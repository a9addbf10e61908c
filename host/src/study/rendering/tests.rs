//! Facts about studies of renderers: closed forms first, then every row of the table.

use super::*;
use crate::color::{Color, Extrapolation, Spectrum};
use crate::illumination::light::LightShape;
use crate::illumination::material::{Classic, Material};
use crate::illumination::texture::{Motif, Pattern, TextureMapping};
use crate::illumination::{Light, Paint};
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::octree::Instance;
use crate::render::RENDERERS;
use crate::scene::{
    Camera, Instances, Interreflection, Lens, Object, PlacementList, Placing, Procedural, ProceduralModel, Scatter,
    Settings, Shape,
};
use crate::solid::Primitive;
use crate::stages::{StageEvent, observed};
use glam::{DAffine3, DMat4, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

const SMALL: Options = Options { width: 20, samples: 256, settings: 5, threads: None };
const RAYS: &[Technique] = &[Technique::RayTracing];

fn object(shape: Shape, transform: DMat4, material: impl Into<Material>) -> Object {
    Object { name: shape.word().into(), shape, transform, material: Some(material.into()), tolerance: None }
}

fn diffuse(k: f64) -> Classic {
    Classic { diffuse: Paint::grey(k), ..Classic::default() }
}

fn mirror(k: f64) -> Classic {
    Classic { mirror: Paint::grey(k), ..diffuse(0.0) }
}

fn camera(from: DVec3, at: DVec3, up: DVec3, field_of_view: f64) -> Camera {
    Camera { from, at, up, field_of_view, near: 0.0, far: None, lens: None, parallel: None, motion: None }
}

fn scene(objects: Vec<Object>, lights: Vec<Light>, camera: Camera) -> Scene {
    let settings = Settings::of_size(20, 20, 16);
    Scene { objects, lights, camera: Some(camera), settings, ..Scene::default() }
}

/// A white ball under parallel light.
fn ball() -> Scene {
    let light = Light::Directional { direction: DVec3::new(-1.0, -1.0, -1.5), irradiance: Color::grey(3.0) };
    let ball = object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, diffuse(1.0));
    scene(vec![ball], vec![light], camera(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, 30.0))
}

#[test]
fn eight_settings_of_samples_need_one_octree() {
    let base = setup::StudiedScene::new(&all_knobs(), &Options { width: 8, settings: 8, ..SMALL }).expect("a scene");
    for samples in (0..8).map(|power| 1 << power) {
        let mut setup = base.own(Technique::RayTracing);
        setup.settings.image.samples = samples;
        let shots = base.trials(&setup, &|shots| !shots.is_empty(), &Watch::NOBODY).expect("a picture");
        assert!(shots[0].build > 0.0);
    }
    assert_eq!(base.prepared.accelerations(), 1);
}

/// A diffuse ball that is made on demand, and a narrow box where it is hardly seen.
#[derive(Debug)]
struct ModelledBall;

impl ProceduralModel for ModelledBall {
    fn bounds(&self) -> Bounds {
        Bounds { min: DVec3::splat(-0.4), max: DVec3::splat(0.4) }
    }

    fn kinds(&self) -> u32 {
        1
    }

    fn materials(&self) -> Vec<Material> {
        Vec::new()
    }

    fn make(&self, _: u32, detail: f64) -> Result<Vec<Object>, String> {
        let ball = Shape::from(Primitive::Sphere { radius: 0.4 });
        let coarse = Shape::from(Primitive::Box { size: DVec3::new(0.2, 0.7, 0.2) });
        Ok(vec![object(if detail < 1.0 { ball } else { coarse }, DMat4::IDENTITY, diffuse(0.7))])
    }

    fn definition(&self) -> String {
        "a ball".into()
    }
}

/// An instance of it.
fn modelled(at: DVec3) -> Object {
    let ball = Object::procedural("ball".into(), Procedural::new(Arc::new(ModelledBall)).expect("a ball"));
    let here = Instance { prototype: 0, variation: 0, placement: DAffine3::from_translation(at) };
    let placing = Placing::Listed(PlacementList(vec![here]));
    let shape = Shape::Instances(Box::new(Instances { prototypes: vec![vec![ball]], placing }));
    Object { name: "balls".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None }
}

/// Posts in cells of a small ground.
fn posts() -> Object {
    let size = DVec3::new(0.05, 0.3, 0.05);
    let post = object(Shape::from(Primitive::Box { size }), DMat4::from_translation(DVec3::Y * 0.15), diffuse(0.9));
    let place = DMat4::from_translation(DVec3::new(1.2, 0.0, -2.5));
    let on = object(Shape::Ground { size: 2.0 }, place, diffuse(0.1));
    let scatter = Scatter { cell: Some(0.25), ..Scatter::over(on, 1) };
    let placing = Placing::Scattered(Box::new(scatter));
    let shape = Shape::Instances(Box::new(Instances { prototypes: vec![vec![post]], placing }));
    Object { name: "posts".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None }
}

/// Every knob has something to do: a ball that mirrors and one that is made on demand, on tiles beside a colored wall,
/// before posts in cells, under a lamp with a spectrum.
fn all_knobs() -> Scene {
    let (paints, laying) = (
        vec![Paint::grey(0.2), Paint::grey(0.8)],
        TextureMapping { size: DVec3::splat(0.07), ..TextureMapping::default() },
    );
    let tiles = Paint::Pattern(Box::new(Pattern { motif: Motif::Checker, laying, paints }));
    let red = Paint::Plain(Color::Bands(DVec3::new(0.7, 0.15, 0.1)));
    let wall = DMat4::from_translation(DVec3::new(-1.2, 1.0, 0.0));
    let objects = vec![
        object(Shape::Ground { size: 8.0 }, DMat4::IDENTITY, Classic { diffuse: tiles, ..Classic::default() }),
        object(
            Shape::from(Primitive::Box { size: DVec3::new(0.1, 2.0, 4.0) }),
            wall,
            Classic { diffuse: red, ..Classic::default() },
        ),
        object(Shape::from(Primitive::Sphere { radius: 0.6 }), DMat4::from_translation(DVec3::Y * 0.6), mirror(0.8)),
        modelled(DVec3::new(1.0, 0.4, 0.3)),
        posts(),
    ];
    let patch = LightShape::Rectangle { corner: DVec3::new(-0.5, 2.5, 0.0), across: DVec3::X, up: DVec3::Z };
    let steep = Spectrum::regular(400.0, 100.0, vec![0.0, 0.2, 1.0, 0.1], Extrapolation::Held).expect("a spectrum");
    let radiance = Color::light_of(&steep, 12.0).expect("a light");
    let eye = camera(DVec3::new(0.8, 1.4, 4.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y, 34.0);
    let mut scene = scene(objects, vec![Light::Area { patch, radiance }], eye);
    (scene.settings.light.interreflection, scene.settings.photons.count) = (Interreflection::Followed, 1000);
    scene
}

/// The ball as its closed form has it: the means of many points in each pixel.
fn exact_ball(width: u32) -> Picture {
    const STEPS: u32 = 64;
    let scene = ball();
    let eye = scene.camera.expect("set");
    let [right, up, forward] = eye.axes().expect("a view");
    let towards = DVec3::new(1.0, 1.0, 1.5).normalize();
    let mut picture = Picture::new(width, width).expect("small");
    for (index, pixel) in picture.pixels_mut().iter_mut().enumerate() {
        let at = |pixel: u32, step: u32| {
            let part = (f64::from(pixel) + (f64::from(step) + 0.5) / f64::from(STEPS)) / f64::from(width);
            (2.0 * part - 1.0) * eye.half_tangent()
        };
        let mut sum = 0.0;
        for step in 0..STEPS * STEPS {
            let (x, y) = (at(index as u32 % width, step % STEPS), at(index as u32 / width, step / STEPS));
            let ray = Ray { origin: eye.from, direction: (forward + right * x - up * y).normalize() };
            let b = ray.origin.dot(ray.direction);
            let root = b * b - ray.origin.length_squared() + 1.0;
            if root > 0.0 {
                sum += 3.0 / PI * ray.at(-b - root.sqrt()).dot(towards).max(0.0);
            }
        }
        pixel.radiance = [(sum / f64::from(STEPS * STEPS)) as f32; 3];
    }
    picture
}

fn study(scene: &Scene, names: &[&str], options: Options) -> Vec<KnobStudy> {
    let study = renderers(scene, RAYS, names, &options, &Watch::NOBODY).expect("a study");
    assert!(study.complete);
    study.knobs
}

#[test]
fn a_reference_is_as_near_to_the_closed_form_as_it_says() {
    let base = StudiedScene::new(&ball(), &SMALL).expect("a scene");
    let samples = RENDER_KNOBS.iter().find(|knob| knob.name == "samples").expect("a knob");
    let best = base.best(Technique::RayTracing, samples);
    let reference = ReferencePicture::new(base.halves(&best, &Watch::NOBODY).expect("pictures")).expect("a reference");
    let exact = base.trials(&best, &|shots| shots.len() == 1, &Watch::NOBODY).expect("a picture").remove(0);
    let exact = TimedRendering { picture: exact_ball(20), ..exact };
    let found = reference.measure(&[exact.clone(), exact]).expect("measured").rmse;
    // The sum of 64 x 64 points at the edge is off by a little, too.
    assert!(found < 2.0 * reference.error + 5e-4, "{found}, stated {}", reference.error);
    assert!(reference.error < 5e-3, "{}", reference.error);
}

#[test]
fn errors_of_samples_and_tolerance_fall_towards_the_closed_form() {
    let studies = study(&ball(), &["samples", "error", "tolerance"], SMALL);
    let rmse = |name: &str| {
        let study = studies.iter().find(|study| study.name == name).expect("a knob");
        study.rows.iter().map(|row| row.measures.rmse).collect::<Vec<f64>>()
    };
    let samples = rmse("samples");
    // Stratified: faster than n^-1/2, at which 16 times the samples have a fourth of the error.
    assert!(samples[0] / samples[4] > 5.0, "{samples:?}");
    let (error, tolerance) = (rmse("error"), rmse("tolerance"));
    assert!(error[0] > error[4], "{error:?}");
    assert!(tolerance[0] > 3.0 * tolerance[2], "{tolerance:?}");
}

#[test]
fn the_error_of_a_depth_is_what_is_left_of_the_geometric_series() {
    let plate = |height: f64, material: Material| {
        object(Shape::Ground { size: 50.0 }, DMat4::from_translation(DVec3::Y * height), material)
    };
    let glowing = Material { emission: Color::grey(1.0), ..Material::from(mirror(0.9)) };
    let eye = camera(DVec3::Y, DVec3::ZERO, DVec3::Z, 1e-3);
    let scene = scene(vec![plate(0.0, glowing), plate(2.0, mirror(0.8).into())], vec![], eye);
    let [found] = study(&scene, &["depth"], SMALL).try_into().expect("one knob");
    assert_eq!(found.best, 12.0);
    for row in &found.rows {
        let rest: f64 = (row.setting as i32 / 2 + 1..=6).map(|power| 0.72f64.powi(power)).sum();
        assert!((row.measures.rmse - rest).abs() < 1e-5, "{row:?}, not {rest}");
        assert!((row.measures.bias() - row.measures.rmse).abs() < 1e-6, "there is no chance: {row:?}");
    }
}

#[test]
fn a_coarse_tessellation_bends_the_curve_of_the_samples_and_is_named() {
    let mut scene = ball();
    scene.settings.geometry.tolerance = Some(0.08);
    let [found] = study(&scene, &["samples"], Options { settings: 7, ..SMALL }).try_into().expect("one knob");
    let Some(ErrorFloor::Bias { from, causes }) = &found.error_floor else { panic!("{}", found.table()) };
    assert!(*from < 4 && causes[0].0 == "tolerance" && causes[0].1 > 0.9, "{}", found.table());
    assert!(found.verdict.contains("the error is bias") && found.table().contains("tolerance ("), "{}", found.verdict);
}

#[test]
fn knobs_of_radiosity_are_idle_without_it_and_change_the_picture_with_it() {
    let light = Light::Point { at: DVec3::new(0.5, 1.5, 0.5), intensity: Color::grey(1.0) };
    let eye = camera(DVec3::new(0.0, 2.0, 3.0), DVec3::ZERO, DVec3::Y, 30.0);
    let cube = Shape::from(Primitive::Box { size: DVec3::splat(0.6) });
    let turned = DMat4::from_rotation_y(0.4) * DMat4::from_translation(DVec3::new(0.0, 0.3, 0.0));
    let things =
        [(Shape::Ground { size: 3.0 }, DMat4::IDENTITY), (cube, turned)].map(|(s, m)| object(s, m, diffuse(0.7)));
    let mut box_on_ground = scene(things.into(), vec![light], eye);
    let names = ["radiosity_error", "radiosity_finest"];
    let options = Options { width: 12, samples: 16, settings: 2, ..SMALL };
    for is_on in [false, true] {
        box_on_ground.settings.light.interreflection =
            if is_on { Interreflection::Solved } else { Interreflection::LeftOut };
        (box_on_ground.settings.radiosity.error, box_on_ground.settings.radiosity.finest) = (0.02, 0.02);
        for study in study(&box_on_ground, &names, options) {
            assert_eq!(is_on, !study.verdict.contains("changes nothing"), "{}", study.table());
        }
    }
}

#[test]
fn every_knob_changes_the_picture_or_says_why_not() {
    let options = Options { width: 12, samples: 64, settings: 3, ..SMALL };
    let names: Vec<&str> = RENDER_KNOBS.iter().map(|knob| knob.name).collect();
    let mut knobs = all_knobs();
    // Scan line leaves the lens out, and is held against itself: its points of a lamp would hide what other knobs do.
    knobs.camera = knobs.camera.map(|camera| Camera { lens: Some(Lens { radius: 1e-6, focus: 4.0 }), ..camera });
    let mut found =
        renderers(&knobs, &studied().collect::<Vec<_>>(), &names, &options, &Watch::NOBODY).expect("a study");
    let expected =
        RENDER_KNOBS.iter().map(|knob| RENDERERS.iter().filter(|row| (knob.renderers)(row)).count()).sum::<usize>();
    assert_eq!(found.knobs.len(), expected);
    found.knobs.retain(|study| !study.name.starts_with("radiosity"));
    for study in &found.knobs {
        let is_model = RENDER_KNOBS.iter().any(|knob| knob.name == study.name && knob.is_model);
        let measured: Vec<ErrorMeasures> = study.rows.iter().map(|row| row.measures).collect();
        // The tolerance alone turns normals far enough.
        let idle = study.name == "angle";
        assert!(idle || !study.verdict.contains("changes nothing"), "{}", study.table());
        // What says which light counts may bring more noise, but no more bias; what says how well it is found, no more
        // error.
        let (first, last) = (measured[0], measured[measured.len() - 1]);
        let doubt = 4.0 * last.bias_squared_error.hypot(first.bias_squared_error);
        let least = measured.iter().fold(f64::INFINITY, |least, m| least.min(m.rmse));
        // Where photons are traced from lamps, their noise may be more than all that a knob does.
        let is_drowned = study.technique == Technique::TwoWay && !["samples", "photons"].contains(&study.name);
        // In a dozen pixels, a denoiser finds hardly any that are alike.
        let is_small = study.name == "denoise";
        match is_model || is_drowned || is_small {
            true => assert!(last.bias_squared <= first.bias_squared + doubt, "{}", study.table()),
            false => assert!(idle || least < first.rmse, "{}", study.table()),
        }
        assert!(study.rows.iter().all(|row| row.seconds > 0.0 && row.measures.rmse.is_finite()));
    }
    // Nothing but a flat, black and sharply lit plane: most knobs say why they change nothing.
    let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
    let eye = camera(DVec3::new(0.0, 2.0, 3.0), DVec3::ZERO, DVec3::Y, 30.0);
    let plain = scene(vec![object(Shape::Ground { size: 1.0 }, DMat4::IDENTITY, diffuse(0.5))], vec![light], eye);
    for study in study(&plain, &names, options) {
        let works = ["samples", "error", "denoise"].contains(&study.name);
        assert_eq!(works, !study.verdict.contains("changes nothing: "), "{}", study.table());
    }
}

#[test]
fn denoising_lowers_the_error_of_a_picture_with_noise() {
    // A ball in the soft shadow of a large lamp, and light between it and the floor.
    let patch =
        LightShape::Rectangle { corner: DVec3::new(-2.0, 3.0, -2.0), across: DVec3::X * 4.0, up: DVec3::Z * 4.0 };
    let ball = DMat4::from_translation(DVec3::Y * 0.7);
    let objects = vec![
        object(Shape::Ground { size: 8.0 }, DMat4::IDENTITY, diffuse(0.6)),
        object(Shape::from(Primitive::Sphere { radius: 0.6 }), ball, diffuse(0.7)),
    ];
    let eye = camera(DVec3::new(0.8, 2.0, 4.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y, 40.0);
    let mut noisy = scene(objects, vec![Light::Area { patch, radiance: Color::grey(4.0) }], eye);
    (noisy.settings.light.interreflection, noisy.settings.light.samples, noisy.settings.image.samples) =
        (Interreflection::Followed, 1, 4);
    let options = Options { width: 80, samples: 128, settings: 2, ..SMALL };
    let [found] = study(&noisy, &["denoise"], options).try_into().expect("one knob");
    let [without, with] = [0, 1].map(|row| found.rows[row].measures);
    assert!(with.rmse < 0.8 * without.rmse && with.noise < 0.7 * without.noise, "{}", found.table());
    assert_eq!(found.best, 0.0, "the reference is not denoised");
}

#[test]
fn scan_line_is_held_against_ray_tracing_where_it_leaves_nothing_out() {
    let study = |scene: &Scene, options: &Options| {
        let study = renderers(scene, &[Technique::ScanLine], &["samples"], options, &Watch::NOBODY);
        study.expect("a study").knobs.remove(0)
    };
    let whole = study(&ball(), &SMALL);
    assert!(whole.reference.contains("ray tracing") && whole.rows.iter().all(|row| row.measures.noise == 0.0));
    assert!(whole.rows[0].measures.rmse > 3.0 * whole.rows[4].measures.rmse, "{}", whole.table());
    let mut through_a_lens = all_knobs();
    through_a_lens.camera =
        through_a_lens.camera.map(|camera| Camera { lens: Some(Lens { radius: 0.1, focus: 4.0 }), ..camera });
    let part = study(&through_a_lens, &Options { width: 12, samples: 64, settings: 3, ..SMALL });
    assert!(part.reference.contains("scan line") && part.verdict.contains("from ray tracing, as"), "{}", part.table());
}

#[test]
fn what_was_finished_before_an_interruption_is_kept() {
    let cancelled = Arc::new(AtomicBool::new(false));
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    let studies = AtomicU64::new(0);
    let stop = {
        let cancelled = cancelled.clone();
        move |event| match event {
            StageEvent::Begin { id, name: "studying", .. } => studies.store(id, Ordering::Relaxed),
            StageEvent::Progress { id, done } if id == studies.load(Ordering::Relaxed) => {
                cancelled.store(done >= 2.0, Ordering::Relaxed);
            }
            _ => {}
        }
    };
    let found = observed(stop, || renderers(&ball(), RAYS, &["samples", "error"], &SMALL, &watch)).expect("a part");
    assert!(!found.complete && found.knobs.len() == 1 && found.knobs[0].rows.len() == 2, "{found:?}");
    assert_eq!(found.csv().lines().count(), 3);
}

#[test]
fn plots_show_curves_of_all_knobs_and_each_alone() {
    let studies = study(&ball(), &["samples", "tolerance"], SMALL);
    let found = RenderStudy { knobs: studies, complete: true };
    let plots = found.plots("ball");
    assert_eq!(plots.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["", "-samples", "-tolerance"]);
    for (_, plot) in &plots {
        assert!(plot.svg().expect("drawn").contains("ray tracing"));
    }
    assert!(found.csv().starts_with("renderer,knob,setting,time (s),build (s),RMSE,chance,bias,"));
}
