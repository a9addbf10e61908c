//! Facts about the error of two-way ray tracing: that it is as large as it is told, and that samples are added where it
//! is large.

use super::tests::{diffuse, scene};
use super::two_way_tests::{ball, block, glass, lamp};
use super::*;
use crate::color::srgb::LUMINANCE;
use crate::render::ray_tracer;
use crate::scene::{Camera, Caustics, Scene};
use glam::DVec3;

/// A glass ball over a plane: its caustic fills a third of the picture.
fn caustic() -> Scene {
    let objects = vec![
        block(DVec3::new(8.0, 0.2, 8.0), DVec3::new(0.0, -0.1, 0.0), diffuse(0.7)),
        ball(1.0, DVec3::new(0.0, 1.2, 0.0), glass(1.5)),
    ];
    let mut scene = scene(objects, vec![lamp(DVec3::new(2.0, 6.0, 0.0), 20.0)], 20);
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO, DVec3::ONE]));
    (camera.from, camera.at, camera.field_of_view) = (DVec3::new(-4.0, 3.0, 3.0), DVec3::new(-0.6, 0.3, 0.0), 30.0);
    scene.camera = Some(camera);
    (scene.settings.light.caustics, scene.settings.photons.count) = (Caustics::PhotonMapped, 4_000);
    scene
}

/// Renderings by seeds of their own.
fn renderings(scene: &Scene, target: Option<f64>) -> Vec<Rendering> {
    let rendering = |seed: u64| {
        let mut scene = scene.clone();
        scene.settings.image.seed = seed;
        let prepared = Prepared::new(&scene).expect("sound");
        let plan = Plan::new(&prepared, &prepared.view());
        let tracer = ray_tracer(&prepared, &plan).expect("an octree");
        let order = RenderOrder { target, ..RenderOrder::of(&scene.settings) };
        tracer.render(&prepared.view(), &order, &Watch::NOBODY).expect("a picture")
    };
    (1..=30).map(rendering).collect()
}

fn luminance(rendering: &Rendering, pixel: usize) -> f64 {
    rendering.film.tallies()[pixel].mean().dot(LUMINANCE)
}

/// Mean and variance of the luminance of each pixel, from one rendering to another.
fn spread(renderings: &[Rendering]) -> Vec<(f64, f64)> {
    let count = renderings.len() as f64;
    let of = |pixel: usize| {
        let mean = renderings.iter().map(|one| luminance(one, pixel)).sum::<f64>() / count;
        let squares = renderings.iter().map(|one| (luminance(one, pixel) - mean).powi(2)).sum::<f64>();
        (mean, squares / (count - 1.0))
    };
    (0..renderings[0].film.tallies().len()).map(of).collect()
}

#[test]
fn the_standard_error_that_is_told_is_how_far_renderings_are_apart() {
    let mut scene = caustic();
    // Within one pass of photons, chance in it counts as if they were independent: that is more than it is.
    for (samples, most) in [(8, 2.0), (16, 1.5), (20, 1.5), (32, 1.5)] {
        scene.settings.image.samples = samples;
        let all = renderings(&scene, None);
        let told = all.iter().map(|one| one.film.standard_error().powi(2)).sum::<f64>() / all.len() as f64;
        let pixels = spread(&all);
        let found = pixels.iter().map(|(_, variance)| variance).sum::<f64>() / pixels.len() as f64;
        let ratio = (told / found).sqrt();
        assert!((1.0 / 1.5..most).contains(&ratio), "{samples}: {} told, {} found", told.sqrt(), found.sqrt());
    }
}

#[test]
fn samples_are_added_until_the_error_is_as_asked_for() {
    let mut scene = caustic();
    scene.settings.image.samples = 96;
    for target in [0.2, 0.1] {
        let all = renderings(&scene, Some(target));
        let [least, most] = all[0].film.samples();
        assert!(least == 8 && most > 8, "{target}: {least} to {most}");
        let square = |(mean, variance): &(f64, f64)| variance / mean.max(0.05).powi(2);
        let over = spread(&all).iter().filter(|pixel| square(pixel) > target * target).count();
        // Of 400; the error of 30 is itself known within 13 %.
        assert!(over <= 4, "{target}: {over}");
        let told = all.iter().map(|one| one.film.standard_error().powi(2)).sum::<f64>() / all.len() as f64;
        let found = spread(&all).iter().map(|(_, variance)| variance).sum::<f64>() / 400.0;
        let ratio = (told / found).sqrt();
        // Most pixels have enough after one pass.
        assert!((1.0 / 1.5..2.0).contains(&ratio), "{target}: {} told, {} found", told.sqrt(), found.sqrt());
    }
}
