//! The graphics processor against the processor, conservation laws, and its own failure.
//!
//! Where there is no adapter these tests say so and do nothing; where `CI` is set they fail.

use super::Gpu;
use crate::calligraphic::tests::{difference, jumble};
use crate::{
    calligraphic::{Beam, Controls, Display, Drawer, PHOSPHORS, ScreenLight, draw},
    traversal::Stroke,
};
use std::sync::{Arc, OnceLock};

const WHITE: [f32; 3] = [1.0; 3];
/// Light over the strongest that 32 bits may lose: half a picture of 2000 pixels from the anchor, a direction of 24
/// bits is 1e-4 of a spot beside its line.
const ROUNDING: f64 = 5e-5;

/// The adapter of all tests.
fn gpu() -> Option<Arc<Gpu>> {
    static OPENED: OnceLock<Option<Arc<Gpu>>> = OnceLock::new();
    OPENED.get_or_init(open).clone()
}

fn open() -> Option<Arc<Gpu>> {
    match Gpu::open(true) {
        Ok(gpu) => Some(Arc::new(gpu)),
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "{error}");
            eprintln!("the graphics processor is not tested: {error}");
            None
        }
    }
}

fn stroke(start: [f32; 2], end: [f32; 2], intensity: [f32; 2]) -> Stroke {
    Stroke { start, end, intensity, color: WHITE }
}

/// The light that the graphics processor writes.
fn written(gpu: &Gpu, beam: &Beam, strokes: &[Stroke]) -> ScreenLight {
    let mut light = beam.dark(3);
    assert!(gpu.write(&mut light, strokes), "{}", gpu.name());
    light
}

/// Pictures by what they try.
fn scenes() -> Vec<(&'static str, Vec<Stroke>)> {
    let fan = |length: f32, intensity: [f32; 2]| -> Vec<Stroke> {
        let ray = |index: u8| {
            let (sin, cos) = (f32::from(index) * 0.7).sin_cos();
            let start = [0.6 * cos, 0.5 * sin];
            stroke(start, [start[0] + length * sin, start[1] - length * cos], intensity)
        };
        (0..9).map(ray).collect()
    };
    let crowd = stroke([0.1, 0.1], [0.1, 0.1], [0.3; 2]);
    vec![
        ("nothing", vec![]),
        ("dots", fan(0.0, [0.6; 2])),
        ("a length of 1e-6", fan(1e-6, [0.0, 500.0]).iter().map(|s| Stroke { color: [1e3; 3], ..*s }).collect()),
        ("short strokes", fan(0.004, [0.2, 1.0])),
        ("strokes as long as a spot", fan(0.01, [1.0, 0.4])),
        ("long strokes", fan(1.1, [0.8; 2])),
        ("ramps", fan(1.3, [0.0, 1.0])),
        ("a length of 1e9", fan(1e9, [0.5, 0.5]).into_iter().chain(fan(-1e9, [1.0, 0.0])).collect()),
        (
            "from far to far",
            vec![stroke([-1e9, -1e9], [1e9, 1e9], [0.2, 1.0]), stroke([0.3, 7e8], [0.3, -9e8], [1.0; 2])],
        ),
        ("no intensity", fan(0.5, [0.0; 2])),
        ("an intensity of 500", fan(0.3, [0.0, 500.0]).into_iter().chain(fan(0.0, [500.0; 2])).collect()),
        ("colours", jumble(400)),
        ("a million on a point", vec![crowd; 1_000_000]),
        ("not finite", vec![stroke([f32::NAN; 2], [0.0; 2], [1.0; 2]), stroke([0.0; 2], [f32::INFINITY; 2], [1.0; 2])]),
    ]
}

/// The greatest difference of two displays in a byte.
fn apart(one: &Display, other: &Display) -> u8 {
    assert_eq!(one.size(), other.size());
    one.frame().iter().zip(other.frame()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Shows the same on two displays of a size, one by either processor, and compares their bytes at each step.
fn compare(gpu: &Arc<Gpu>, controls: Controls, size: [u32; 2], name: &str, shows: &[(&[Stroke], u64)]) {
    let mut exact = Display::new(controls, size);
    let mut drawn = Display::drawn_by(Drawer::Gpu(gpu.clone()), controls, size);
    for (version, (strokes, frame)) in shows.iter().enumerate() {
        exact.show(strokes, version as u64, *frame);
        drawn.show(strokes, version as u64, *frame);
        let worst = apart(&exact, &drawn);
        assert!(worst <= 1, "{name}, {size:?}, {}, frame {frame}: {worst}", controls.phosphor.name);
        assert!(drawn.picture().pixels().as_flattened().iter().all(|value| (0.0..=1.0).contains(value)), "{name}");
    }
    assert!(gpu.works());
}

#[test]
fn every_scene_looks_as_by_the_processor_in_every_size() {
    let Some(gpu) = gpu() else { return };
    for (name, strokes) in scenes() {
        for size in [[1, 1], [64, 48], [1000, 700]] {
            compare(&gpu, Controls::default(), size, name, &[(&strokes, 0)]);
        }
        if !["nothing", "no intensity", "not finite"].contains(&name) {
            let light = written(&gpu, &Beam::new(300, 200), &strokes);
            assert!(light.lit_pixels() > 10, "{name}");
        }
    }
}

#[test]
fn every_phosphor_glows_as_by_the_processor_steady_or_not() {
    let Some(gpu) = gpu() else { return };
    let (one, other) = (jumble(60), jumble(90).split_off(60));
    for phosphor in PHOSPHORS {
        for steady in [true, false] {
            let controls = Controls { phosphor, steady, ..Controls::default() };
            compare(&gpu, controls, [131, 77], "a jumble", &[(&one, 0), (&other, 1), (&[], 3), (&one, 9)]);
        }
    }
}

#[test]
fn knobs_act_as_by_the_processor() {
    let Some(gpu) = gpu() else { return };
    let strokes = jumble(100);
    for (brightness, contrast, focus) in [(1.0, 0.5, 1.0), (0.2, 1.0, 0.4), (0.6, 0.0, 0.0)] {
        let controls = Controls { brightness, contrast, focus, ..Controls::default() };
        compare(&gpu, controls, [400, 300], "a jumble", &[(&strokes, 0)]);
    }
}

#[test]
fn a_picture_that_is_read_back_in_parts_is_whole() {
    let Some(gpu) = gpu() else { return };
    let beam = Beam::new(2100, 2000);
    let strokes = jumble(300);
    let worst = difference(&draw(&beam, &strokes), &written(&gpu, &beam, &strokes));
    assert!(worst < ROUNDING, "{worst}");
}

#[test]
fn the_light_of_a_pixel_is_that_of_the_processor_to_what_32_bits_hold() {
    let Some(gpu) = gpu() else { return };
    for (name, strokes) in scenes() {
        let beam = Beam::new(500, 500);
        let (exact, drawn) = (draw(&beam, &strokes), written(&gpu, &beam, &strokes));
        if exact.total() == [0.0; 3] {
            assert_eq!(drawn.total(), [0.0; 3], "{name}");
            continue;
        }
        let worst = difference(&exact, &drawn);
        assert!(worst < ROUNDING, "{name}: {worst}");
    }
}

#[test]
fn total_light_is_length_times_mean_intensity() {
    let Some(gpu) = gpu() else { return };
    for (case, length) in [0.9_f32, 0.11, 0.02, 0.004, 0.0004].into_iter().cycle().take(40).enumerate() {
        let (sin, cos) = (case as f32 * 0.37).sin_cos();
        let end = [0.1 + 0.5 * length * cos, 0.5 * length * sin - 0.2];
        let sum = written(&gpu, &Beam::new(333, 333), &[stroke([0.1, -0.2], end, [0.2, 0.9])]).total()[1];
        let (dx, dy) = (f64::from(end[0]) - f64::from(0.1_f32), f64::from(end[1]) + f64::from(0.2_f32));
        let expected = dx.hypot(dy) * 0.55;
        assert!((sum / expected - 1.0).abs() < 1e-4, "length {length}: {sum} {expected}");
    }
}

#[test]
fn a_stroke_cut_in_pieces_gives_the_same_light() {
    let Some(gpu) = gpu() else { return };
    let (start, end) = ([-0.5, -0.25], [0.5, 0.75]);
    let beam = Beam::new(512, 512);
    let whole = written(&gpu, &beam, &[stroke(start, end, [0.25, 0.75])]);
    for pieces in [2_u16, 64, 1024, 4096] {
        let at = |piece: u16| {
            let t = f32::from(piece) / f32::from(pieces);
            ([0, 1].map(|axis| start[axis] + t * (end[axis] - start[axis])), 0.25 + 0.5 * t)
        };
        let piece = |piece| {
            let ((from, dim), (to, bright)) = (at(piece), at(piece + 1));
            stroke(from, to, [dim, bright])
        };
        let cut: Vec<Stroke> = (0..pieces).map(piece).collect();
        let parts = written(&gpu, &beam, &cut);
        let total = parts.total()[0] / whole.total()[0] - 1.0;
        assert!(total.abs() < 1e-5, "{pieces} pieces: total {total}");
        let worst = difference(&whole, &parts);
        assert!(worst < 2e-5, "{pieces} pieces: pixel {worst}");
    }
}

#[test]
fn a_lost_device_leaves_the_picture_to_the_processor() {
    let Some(gpu) = open() else { return };
    let controls = Controls::default();
    let mut exact = Display::new(controls, [120, 90]);
    let mut drawn = Display::drawn_by(Drawer::Gpu(gpu.clone()), controls, [120, 90]);
    drawn.show(&jumble(20), 0, 0);
    assert_eq!(drawn.drawer().to_string(), gpu.name());
    gpu.lose();
    for display in [&mut exact, &mut drawn] {
        display.show(&jumble(50), 1, 1);
    }
    assert!(!gpu.works() && drawn.drawer().to_string().starts_with("the processor, as "));
    assert_eq!(exact.frame(), drawn.frame());
}
