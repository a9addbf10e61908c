//! Two-way ray tracing: error against time for the caustic of a glass ball, and ten views beside one.
//!
//! First proves that the flux that was sent out is found again, that a second view is the same as if it were the first,
//! and that the error falls with more samples. The error is the relative mean squared error off the ball, against a
//! picture of other random numbers with very many samples; its own error is printed. On one thread, so that seconds are
//! those of a processor. `cargo bench -p tests --bench two_way`

use host::color::srgb::LUMINANCE;
use host::picture::RELATIVE_FLOOR;
use host::plan::Plan;
use host::render::ray_tracer;
use host::render::ray_tracing::RayTracer;
use host::render::{RenderOrder, Renderer, Rendering, Watch};
use host::scene::{Interreflection, Prepared, Scene, View};
use std::num::NonZeroUsize;
use std::time::Instant;

/// Photons for eight samples, samples of each pixel, points of the lamp for each, and whether diffuse light is carried
/// on.
const SETTINGS: [(u32, u32, u32, bool); 9] = [
    (50_000, 1, 1, false),
    (200_000, 4, 1, false),
    (50_000, 1, 8, true),
    (80_000, 1, 8, true),
    (100_000, 4, 4, true),
    (100_000, 16, 1, true),
    (100_000, 64, 1, true),
    (100_000, 256, 1, true),
    (400_000, 256, 1, true),
];
/// Views, and degrees from one to the next round the ball.
const VIEWS: u32 = 10;
const TURN: f64 = 36.0;

fn main() {
    // `cargo bench` passes `--bench`; without it the proof is enough.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let mut scene = host::script::load("caustic", &host::script::Inputs::default()).expect("a scene that ships").scene;
    let (side, most) = if is_bench { (256, 2048) } else { (24, 64) };
    (scene.settings.image.width, scene.settings.image.height) = (side, side);
    let with = |(photons, samples, points, carried): (u32, u32, u32, bool), seed: u64| {
        let mut scene = scene.clone();
        let settings = &mut scene.settings;
        (settings.photons.count, settings.image.samples, settings.light.samples) = (photons, samples, points);
        (settings.light.interreflection, settings.image.seed) =
            (if carried { Interreflection::Followed } else { Interreflection::LeftOut }, seed);
        scene
    };
    let reference = [11, 12].map(|seed| timed(&with((200_000, most / 2, 1, true), seed), 2).0);
    let errors: Vec<(f64, f64)> = SETTINGS
        .iter()
        .filter(|(_, samples, ..)| is_bench || *samples <= 4)
        .map(|setting| {
            let (rendering, seconds) = timed(&with(*setting, 1), 1);
            (error(&rendering, &reference), seconds)
        })
        .collect();
    let own = 0.25 * error(&reference[0], &[reference[1].clone(), reference[1].clone()]);
    assert!(errors[3].0 < errors[0].0, "more samples do not help: {errors:?}");
    views(&with((if is_bench { 4_000_000 } else { 5_000 }, 2, 1, false), 1), is_bench);
    println!("proved: flux is found again, the error falls, and views do not depend on each other");
    if !is_bench {
        return;
    }
    let columns = ["photons", "samples", "points", "carried"].map(|name| format!("{name:>8}")).join(" ");
    println!("\n{columns} {:>10} {:>14}", "seconds", "relative MSE");
    for ((photons, samples, points, carried), (error, seconds)) in SETTINGS.iter().zip(&errors) {
        println!("{photons:>8} {samples:>8} {points:>8} {carried:>8} {seconds:>10.2} {error:>14.2e}");
    }
    println!("the reference itself: {own:.1e}");
}

/// Renders a scene anew, and the seconds that all of it took.
fn timed(scene: &Scene, threads: usize) -> (Rendering, f64) {
    let start = Instant::now();
    let prepared = Prepared::new(scene).expect("a sound scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let rendering = render(&tracer, &prepared.view(), threads);
    let balance = rendering.flux_balance.expect("light was followed");
    assert!(balance.residual() < 1e-6, "{balance}");
    (rendering, start.elapsed().as_secs_f64())
}

fn render(tracer: &RayTracer<'_>, view: &View, threads: usize) -> Rendering {
    let order = RenderOrder { threads: NonZeroUsize::new(threads), ..RenderOrder::of(&tracer.prepared().settings) };
    tracer.render(view, &order, &Watch::NOBODY).expect("a picture")
}

/// The relative mean squared error of the luminance where neither a pixel nor one beside it saw the ball.
fn error(rendering: &Rendering, reference: &[Rendering; 2]) -> f64 {
    let [one, two] = [0, 1].map(|i| reference[i].film.tallies());
    let width = rendering.film.width() as usize;
    let sees_plane = |i: usize| one.get(i).is_none_or(|tally| tally.elements == tally.count && tally.first_ids[0] == 0);
    let is_off = |i: usize| {
        let around = [-1, 0, 1].map(|row| row * width as isize).into_iter();
        around.flat_map(|row| [-1, 0, 1].map(|column| row + column)).all(|by| sees_plane(i.wrapping_add_signed(by)))
    };
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, tally) in rendering.film.tallies().iter().enumerate().filter(|(i, _)| is_off(*i)) {
        let expected = 0.5 * (one[i].mean() + two[i].mean()).dot(LUMINANCE);
        sum += (tally.mean().dot(LUMINANCE) - expected).powi(2) / (expected * expected + RELATIVE_FLOOR);
        count += 1.0;
    }
    sum / count
}

/// Renders views round the ball, and one of them alone.
fn views(scene: &Scene, is_bench: bool) {
    let camera = scene.camera.expect("a camera");
    let prepared = Prepared::new(scene).expect("a sound scene");
    let plan = Plan::new(&prepared, &prepared.view());
    let view = |index: u32| View::Camera(camera.turned((TURN * f64::from(index)).to_radians()));
    let start = Instant::now();
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let pictures: Vec<_> = (0..VIEWS).map(|index| render(&tracer, &view(index), 1).picture).collect();
    let all = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let alone = render(&tracer, &view(VIEWS - 1), 1).picture;
    let one = start.elapsed().as_secs_f64();
    assert!(alone == pictures[VIEWS as usize - 1], "a view depends on those before it");
    if is_bench {
        let photons = scene.settings.photons.count;
        println!("{photons} photons: one view {one:.2} s, {VIEWS} views {all:.2} s, {:.2} times as long", all / one);
    }
}
