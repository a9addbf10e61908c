//! Facts about aggregates in pictures: what they change, that nothing else does, and where they are refused.

use super::instance_tests::{camera, diffuse, green, instances, object};
use super::{RENDERERS, RenderOrder, RendererRow, Rendering, Task, Technique, Watch};
use crate::color::Color;
use crate::illumination::{Light, Paint};
use crate::octree::Instance;
use crate::plan::Plan;
use crate::scene::{Camera, Instances, Object, Parallel, Placing, Prepared, Scatter, Scene, Settings, Shape};
use crate::solid::Primitive;
use glam::{DAffine3, DMat4, DVec2, DVec3};
use std::num::NonZero;

fn ray_tracing() -> &'static RendererRow {
    RENDERERS.iter().find(|row| row.technique == Technique::RayTracing).expect("a renderer")
}

/// Blades in cells of a ground.
fn blades(aggregate: Option<f64>, ground: DMat4) -> Object {
    let blade = object(
        Primitive::Box { size: DVec3::new(0.04, 0.5, 0.04) },
        DMat4::from_translation(DVec3::Y * 0.25),
        diffuse(Paint::grey(0.7)),
    );
    let on = object(Shape::Ground { size: 80.0 }, ground, diffuse(Paint::grey(0.1)));
    let scatter =
        Scatter { cell: Some(0.5), aggregate, scale: [0.6, 1.4], lean: 20.0, upright: 0.5, ..Scatter::over(on, 4) };
    let shape = Shape::Instances(Box::new(Instances {
        prototypes: vec![vec![blade]],
        placing: Placing::Scattered(Box::new(scatter)),
    }));
    Object { name: "blades".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None }
}

/// A meadow seen from above its blades, all of it enlarged.
fn meadow(aggregate: Option<f64>, ground: DMat4, scale: f64) -> Scene {
    let enlarged = DMat4::from_scale(DVec3::splat(scale));
    let soil = object(Shape::Ground { size: 80.0 }, ground, diffuse(Paint::grey(0.1)));
    let objects = [soil, blades(aggregate, ground)];
    let objects = objects.into_iter().map(|object| Object { transform: enlarged * object.transform, ..object });
    let sun = Light::Directional { direction: DVec3::new(-0.5, -0.8, -0.3), irradiance: Color::grey(3.0) };
    let mut settings = Settings::of_size(64, 32, 16);
    settings.light.reflection_depth = 1;
    let eye = Camera { at: DVec3::new(0.0, 0.2, -14.0) * scale, ..camera(DVec3::new(0.0, 2.2, 3.0) * scale, 35.0) };
    Scene { objects: objects.collect(), lights: vec![sun], settings, camera: Some(eye), ..Scene::default() }
}

fn render(scene: &Scene, threads: usize) -> Rendering {
    let prepared = Prepared::new(scene).unwrap_or_else(|error| panic!("{error}"));
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let made = ray_tracing().technique.prepare(&Task::new(&prepared, &plan)).expect("ready");
    let order = RenderOrder { threads: NonZero::new(threads), ..RenderOrder::of(&prepared.settings) };
    made.renderer.any().render(&view, &order, &Watch::NOBODY).expect("a picture")
}

/// The means of two pictures' rows beyond the first half, and the RMSE of their pixels as a part of the first mean.
fn compared(one: &Rendering, other: &Rendering) -> [f64; 2] {
    let [one, other] = [green(one), green(other)];
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    let squares: Vec<f64> = one.iter().zip(&other).map(|(a, b)| (a - b) * (a - b)).collect();
    [mean(&other) / mean(&one) - 1.0, mean(&squares).sqrt() / mean(&one)]
}

#[test]
fn a_picture_with_aggregates_is_as_the_exact_one_but_for_a_stated_error() {
    let mirrored = DMat4::from_rotation_y(0.4) * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let tilted = DMat4::from_rotation_x(0.1);
    for (ground, scale) in [(DMat4::IDENTITY, 1.0), (mirrored, 50.0), (tilted, 1e-3)] {
        let exact = render(&meadow(None, ground, scale), 2);
        // Another seed of the samples tells what of the difference is noise.
        let mut again = meadow(None, ground, scale);
        again.settings.image.seed = 99;
        let [_, noise] = compared(&exact, &render(&again, 2));
        let [bias, fine] = compared(&exact, &render(&meadow(Some(1.0), ground, scale), 2));
        assert!(bias.abs() < 0.01 && fine < 1.1 * noise, "{scale}: {bias} {fine} {noise}");
        let [_, coarse] = compared(&exact, &render(&meadow(Some(4.0), ground, scale), 2));
        assert!(coarse > fine, "{scale}: {coarse} {fine}");
        let near = render(&meadow(Some(1.0 / 256.0), ground, scale), 2);
        assert!(green(&near) == green(&exact), "nothing is so far away");
    }
}

/// A scene whose blades stand elsewhere.
fn sown(mut scene: Scene, seed: u64) -> Scene {
    let Shape::Instances(instances) = &mut scene.objects[1].shape else { panic!("no blades") };
    let Placing::Scattered(scatter) = &mut instances.placing else { panic!("not scattered") };
    scatter.seed = seed;
    scene
}

#[test]
fn few_large_blades_are_as_bright_in_the_mean_as_all() {
    for parallel in [None, Some(Parallel { height: 12.0, oblique: DVec2::ZERO })] {
        let seen = |aggregate: Option<f64>, seed: u64| {
            let mut scene = sown(meadow(aggregate, DMat4::IDENTITY, 1.0), seed);
            scene.settings.image.samples = 4;
            // From above, so that nothing stands out above the horizon.
            let from = DVec3::new(0.0, 14.0, 16.0);
            scene.camera = scene.camera.map(|camera| Camera { from, at: DVec3::ZERO, parallel, ..camera });
            render(&scene, 2)
        };
        // Some hundred blades of four pixels are in sight: how bright they are differs from one meadow to the next.
        let count = 16;
        let biases: Vec<f64> = (1..=count).map(|seed| compared(&seen(None, seed), &seen(Some(4.0), seed))[0]).collect();
        let mean = biases.iter().sum::<f64>() / count as f64;
        let variance = biases.iter().map(|bias| (bias - mean) * (bias - mean)).sum::<f64>() / (count - 1) as f64;
        let error = (variance / count as f64).sqrt();
        // Large and small ones side by side hide a little less of each other from the sun.
        assert!(mean.abs() < 0.04 && error < 0.02, "{mean} +- {error}");
    }
}

#[test]
fn pictures_with_aggregates_are_equal_for_any_number_of_threads() {
    let scene = meadow(Some(4.0), DMat4::IDENTITY, 1.0);
    let [one, two] = [1, 2].map(|threads| green(&render(&scene, threads)));
    assert!(one == two && one != green(&render(&meadow(None, DMat4::IDENTITY, 1.0), 2)));
}

#[test]
fn the_plan_tells_from_where_on_aggregates_stand_in() {
    let reason = |scene: &Scene| {
        let prepared = Prepared::new(scene).expect("a scene");
        let plan = Plan::new(&prepared, &prepared.view());
        plan.table()
    };
    // The largest blade has a diagonal of 1.4 times that of the box; 32 pixels span twice the tangent of half the
    // angle.
    let size = 1.4 * DVec3::new(0.04, 0.5, 0.04).length();
    let pixel = 2.0 * 17.5_f64.to_radians().tan() / 32.0;
    for (pixels, scale) in [(4.0, 1.0), (0.5, 100.0)] {
        let table = reason(&meadow(Some(pixels), DMat4::IDENTITY, scale));
        let told = format!("aggregates stand in beyond {:.4} from the eye", scale * size / pixels / pixel);
        assert!(table.contains(&told[..told.len() - 14]), "{told}: {table}");
    }
    assert!(!reason(&meadow(None, DMat4::IDENTITY, 1.0)).contains("aggregates"));
    let mut parallel = meadow(Some(4.0), DMat4::IDENTITY, 1.0);
    let lines = Some(Parallel { height: 32.0, oblique: DVec2::ZERO });
    parallel.camera = parallel.camera.map(|camera| Camera { parallel: lines, ..camera });
    let table = reason(&parallel);
    assert!(table.contains(&format!("for all, up to {:.2} times as large", 4.0 / size)), "{table}");
}

#[test]
fn a_camera_frames_what_is_there_without_aggregates_and_boxes_hold_them() {
    let boxes = |aggregate: Option<f64>| {
        let scene = Scene { camera: None, ..meadow(aggregate, DMat4::IDENTITY, 2.0) };
        let prepared = Prepared::new(&scene).expect("a scene");
        (prepared.subject(), prepared.camera, prepared.objects[1].bounds, prepared.bounds)
    };
    let ((subject, eye, exact, _), (same, framed, large, all)) = (boxes(None), boxes(Some(1.0)));
    assert!((subject.min - same.min).abs().max_element() < 1e-9 && (subject.max - same.max).abs().max_element() < 1e-9);
    assert!(eye.from.distance(framed.from) < 1e-6);
    assert!((large.max.y / exact.max.y - 16.0).abs() < 1e-6 && all.max.y >= large.max.y);
}

#[test]
fn what_is_placed_again_has_no_aggregates() {
    let here = Instance { prototype: 0, variation: 0, placement: DAffine3::IDENTITY };
    let again = |aggregate| instances(vec![vec![blades(aggregate, DMat4::IDENTITY)]], vec![here], DMat4::IDENTITY);
    let scene = |aggregate| Scene { objects: vec![again(aggregate)], ..meadow(None, DMat4::IDENTITY, 1.0) };
    let error = Prepared::new(&scene(Some(1.0))).expect_err("a problem").to_string();
    assert!(error.contains("blades has aggregates, which stand in for what the scene itself has"), "{error}");
    // What counts for all scatterings leaves these out.
    let mut exact = scene(None);
    exact.settings.geometry.aggregate = Some(4.0);
    assert!(green(&render(&exact, 2)) == green(&render(&scene(None), 2)));
    let mut asked = meadow(Some(0.5), DMat4::IDENTITY, 1.0);
    asked.settings.geometry.aggregate = Some(4.0);
    assert!(green(&render(&asked, 2)) == green(&render(&meadow(Some(4.0), DMat4::IDENTITY, 1.0), 2)));
    asked.settings.geometry.aggregate = Some(0.0);
    assert!(green(&render(&asked, 2)) == green(&render(&meadow(None, DMat4::IDENTITY, 1.0), 2)));
    asked.settings.geometry.aggregate = Some(1e9);
    let error = Prepared::new(&asked).expect_err("a problem").to_string();
    assert!(error.contains("aggregates from 1000000000 pixels on are not within"), "{error}");
}
