//! Radiosity of a closed room with five balls under a lamp: elements against seconds.
//!
//! First proves the answer: flux is neither lost nor found, and in a closed ball that glows inside the radiosity is E /
//! (1 − ρ). Then the time for more and more elements, two threads.
//! `cargo bench -p tests --bench radiosity`

use glam::{DMat4, DVec3};
use host::color::{Channels, Color};
use host::illumination::material::Classic;
use host::illumination::{Light, Paint};
use host::plan::Plan;
use host::render::indirect::{IndirectLight, IrradiancePart};
use host::render::radiosity::{Exitance, Radiosity};
use host::render::{Watch, World};
use host::scene::{Interreflection, Object, Prepared, RadiositySettings, Scene, Shape};
use host::solid::Primitive;

fn main() {
    // `cargo bench` passes `--bench`; without it the proof is enough.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    let ball = prepared(vec![object(Shape::from(Primitive::Sphere { radius: 1.0 }), DVec3::ZERO, 0.99)], vec![]);
    let inside = |_: u32, outside: bool, _: DVec3| if outside { Channels::ZERO } else { Channels::ONE };
    let furnace = pool.install(|| solved(&ball, RadiositySettings::default(), Some(&inside)));
    let found = 1.0 + 0.99 * furnace.irradiance(0, false, [1.0 / 3.0; 3], IrradiancePart::All).0[0];
    assert!((found / 100.0 - 1.0).abs() < 1e-6, "{found} is not 100");
    let room = room();
    let coarse = pool.install(|| solved(&room, settings(0.04, 0.05), None)).report;
    assert!((coarse.left / coarse.arrived).abs() < 1e-6, "{coarse:?}");
    println!("proved: furnace {found:.6} of 100, flux left {:.1e} of {:.3}", coarse.left, coarse.arrived);
    if !is_bench {
        return;
    }
    println!("{:>9} {:>9} {:>7} {:>9} {:>14}", "elements", "links", "steps", "seconds", "µs an element");
    for (error, finest) in [(0.04, 0.1), (0.01, 0.015), (0.005, 0.004), (0.002, 0.0025)] {
        let report = pool.install(|| solved(&room, settings(error, finest), None)).report;
        let each = report.seconds / report.elements as f64 * 1e6;
        let host::render::radiosity::RadiosityReport { elements, links, steps, seconds, .. } = report;
        println!("{elements:>9} {links:>9} {steps:>7} {seconds:>9.3} {each:>14.1}");
    }
}

fn settings(error: f64, finest: f64) -> RadiositySettings {
    RadiositySettings { error, finest, ..RadiositySettings::default() }
}

fn solved(prepared: &Prepared, settings: RadiositySettings, exitance: Option<Exitance<'_>>) -> Radiosity {
    let plan = Plan::new(prepared, &prepared.view());
    let world = World::new(prepared, &plan).expect("a world");
    Radiosity::new(&world, &plan, &settings, exitance, &Watch::NOBODY).expect("a solution")
}

fn prepared(objects: Vec<Object>, lights: Vec<Light>) -> Prepared {
    let mut scene = Scene { objects, lights, ..Scene::default() };
    scene.settings.light.interreflection = Interreflection::Followed;
    Prepared::new(&scene).expect("a scene")
}

fn object(shape: Shape, at: DVec3, grey: f64) -> Object {
    Object {
        name: shape.word().into(),
        shape,
        transform: DMat4::from_translation(at),
        material: Some(Classic { diffuse: Paint::grey(grey), ..Classic::default() }.into()),
        tolerance: Some(0.01),
    }
}

fn room() -> Prepared {
    let ball = |k: i32| {
        let at = DVec3::new(0.7 * f64::from(k - 2), -0.6 + 0.1 * f64::from(k * k % 5), 0.3 * f64::from(k % 3) - 0.3);
        object(Shape::from(Primitive::Sphere { radius: 0.3 }), at, 0.7)
    };
    let walls = object(Shape::from(Primitive::Box { size: DVec3::new(4.0, 2.0, 3.0) }), DVec3::ZERO, 0.6);
    let lamp = Light::Point { at: DVec3::new(0.3, 0.9, 0.2), intensity: Color::grey(1.0) };
    prepared((0..5).map(ball).chain([walls]).collect(), vec![lamp])
}
