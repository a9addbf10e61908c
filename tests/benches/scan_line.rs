//! Scan line with shadow volumes beside ray tracing: the bunny on a floor under one lamp, 1024 x 1024 pixels.
//!
//! First proves the picture: a small one by scan line is that of ray tracing. Then the best of several runs counts,
//! with two threads and four samples in each pixel, finding the neighbours of triangles included.
//! `cargo bench -p tests --bench scan_line`

use glam::{DMat4, DVec3};
use host::color::Color;
use host::illumination::material::Classic;
use host::illumination::{Light, Paint};
use host::picture::difference;
use host::plan::Plan;
use host::render::ray_tracer;
use host::render::scan_line::ScanLine;
use host::render::{RenderOrder, Renderer, Rendering, Watch};
use host::scene::{Camera, Object, Prepared, Scene, Settings, Shape};
use std::num::NonZeroUsize;
use std::time::Instant;

/// Runs of each case; the best counts.
const RUNS: usize = 9;
/// Largest RMSE between the two renderers: that of edges by 16 samples.
const TOLERANCE: f64 = 0.01;

fn main() {
    // `cargo bench` passes `--bench`; without it the proof is enough.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let prepared = Prepared::new(&scene()).expect("a scene");
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let scan_line = ScanLine::new(&prepared, &plan).expect("sound materials");
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let small = |samples: u32| order(96, samples);
    let [drawn, traced] = [(&scan_line as &dyn Renderer, 16), (&tracer, 64)]
        .map(|(renderer, samples)| renderer.render(&view, &small(samples), &Watch::NOBODY).expect("a picture"));
    let apart = difference(&drawn.picture, &traced.picture).expect("of one size").rmse;
    assert!(apart < TOLERANCE, "scan line and ray tracing are {apart} apart");
    println!("proved: RMSE {apart:.5} to ray tracing");
    if !is_bench {
        return;
    }
    println!("{:<34} {:>9} {:>9}", "seconds, two threads", "building", "picture");
    for samples in [4, 16] {
        let build = || ScanLine::new(&prepared, &plan).expect("sound materials");
        row(&format!("scan line, {samples} samples"), build, |scan| {
            scan.render(&view, &order(1024, samples), &Watch::NOBODY).expect("a picture")
        });
    }
    let build = || ray_tracer(&prepared, &plan).expect("an octree");
    row("ray tracing, 4 samples", build, |tracer| {
        tracer.render(&view, &order(1024, 4), &Watch::NOBODY).expect("a picture")
    });
}

fn row<R>(name: &str, build: impl Fn() -> R, render: impl Fn(&R) -> Rendering) {
    let run = || {
        let start = Instant::now();
        let renderer = build();
        let building = start.elapsed().as_secs_f64();
        [building, render(&renderer).seconds]
    };
    let best = (0..RUNS).map(|_| run()).fold([f64::INFINITY; 2], |a, b| [a[0].min(b[0]), a[1].min(b[1])]);
    println!("{name:<34} {:>9.4} {:>9.4}", best[0], best[1]);
}

fn order(side: u32, samples: u32) -> RenderOrder {
    let settings = Settings::of_size(side, side, samples);
    RenderOrder { threads: NonZeroUsize::new(2), ..RenderOrder::of(&settings) }
}

fn scene() -> Scene {
    let object = |shape: Shape, transform: DMat4, grey: f64| Object {
        name: shape.word().into(),
        shape,
        transform,
        material: Some(Classic { diffuse: Paint::grey(grey), ..Classic::default() }.into()),
        tolerance: None,
    };
    let floor = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, 0.6);
    let bunny = object(Shape::Bunny, DMat4::from_translation(DVec3::Y), 0.7);
    let camera = Camera {
        from: DVec3::new(1.0, 3.0, 8.0),
        at: DVec3::new(0.0, 0.8, 0.0),
        up: DVec3::Y,
        field_of_view: 25.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    let lamp = Light::Point { at: DVec3::new(3.0, 5.0, 4.0), intensity: Color::grey(30.0) };
    Scene { objects: vec![floor, bunny], lights: vec![lamp], camera: Some(camera), ..Scene::default() }
}
