//! The light buffer: ten views of the living room from the door on, with it and without.
//!
//! First proves that the pictures are the same, bit by bit. The time for making triangles and octree is not counted,
//! that for finding what stands between voxels and lights is. `cargo bench -p tests --bench light_buffer`

use host::plan::Plan;
use host::render::ray_tracer;
use host::render::ray_tracing::RayTracer;
use host::render::{RenderOrder, Renderer, Rendering, Watch};
use host::scene::{Camera, Prepared, View};
use std::num::NonZeroUsize;

/// Views, and degrees from one to the next round the point that is looked at.
const VIEWS: u32 = 10;
const TURN: f64 = 3.0;

fn main() {
    // `cargo bench` passes `--bench`; without it the proof is enough.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let samples = if is_bench { 16 } else { 2 };
    let mut scene = host::script::load("room", &host::script::Inputs::default()).expect("a scene that ships").scene;
    if !is_bench {
        scene.settings.image.width = 48;
        scene.settings.image.height = 30;
    }
    let camera = scene.camera.expect("the room is seen");
    let prepared = Prepared::new(&scene).expect("a sound scene");
    let mut without = prepared.clone();
    without.settings.light.buffer = false;
    let runs = [&prepared, &without].map(|prepared| {
        let plan = Plan::new(prepared, &View::Camera(camera));
        let tracer = ray_tracer(prepared, &plan).expect("an octree");
        (0..VIEWS)
            .map(|index| render(&tracer, camera.turned((TURN * f64::from(index)).to_radians()), samples))
            .collect::<Vec<_>>()
    });
    let [with, plain] = &runs;
    assert!(with.iter().zip(plain).all(|(a, b)| a.picture == b.picture), "a picture depends on the light buffer");
    println!("proved: {VIEWS} pictures are the same");
    if !is_bench {
        return;
    }
    println!("{:<16} {:>9} {:>12} {:>12}", "ten views", "seconds", "shadow rays", "spared");
    for (name, run) in [("light buffer", with), ("all rays", plain)] {
        let seconds: f64 = run.iter().map(|rendering| rendering.seconds).sum();
        let [shadow, spared] = run.iter().fold([0, 0], |[a, b], r| [a + r.rays.shadow, b + r.rays.spared]);
        println!("{name:<16} {seconds:>9.2} {shadow:>12} {spared:>12}");
    }
}

fn render(tracer: &RayTracer<'_>, camera: Camera, samples: u32) -> Rendering {
    let settings = &tracer.prepared().settings;
    let order = RenderOrder { threads: NonZeroUsize::new(2), samples, ..RenderOrder::of(settings) };
    tracer.render(&View::Camera(camera), &order, &Watch::NOBODY).expect("a picture")
}
