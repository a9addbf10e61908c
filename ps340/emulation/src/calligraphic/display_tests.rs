//! The display over time: persistence against the closed form, refresh and flicker, knobs, pixels.

use super::*;
use crate::traversal::Stroke;

const GREEN: &str = "P39";

fn line(intensity: f32) -> Vec<Stroke> {
    let ends = [[-0.9, 0.013], [0.9, 0.013]];
    vec![Stroke { start: ends[0], end: ends[1], intensity: [intensity; 2], color: [1.0; 3] }]
}

fn with(phosphor_name: &str, steady: bool) -> Controls {
    Controls { phosphor: phosphor(phosphor_name).unwrap(), steady, ..Controls::default() }
}

/// The light of all components at the brightest pixel, as the exposure takes it: the strongest channel.
fn light(display: &Display) -> f64 {
    let gain = f64::from(display.controls().exposure().gain);
    let value = display.picture().pixels().as_flattened().iter().fold(0.0f32, |most, value| most.max(*value));
    -(1.0 - f64::from(value)).ln() / gain
}

/// Strokes that take the beam this many frames; together they are as bright as one of full intensity.
fn lasting(frames: usize) -> Vec<Stroke> {
    // There and back: 2 (0.15 + 18) microseconds.
    let count = 2 * ((frames as f64 - 0.5) * 1e6 / 60.0 / 36.3) as usize;
    let intensity = [1.0 / count as f32; 2];
    let stroke = |x: [f32; 2]| Stroke { start: [x[0], 0.013], end: [x[1], 0.013], intensity, color: [1.0; 3] };
    [stroke([-0.9, 0.9]), stroke([0.9, -0.9])].into_iter().cycle().take(count).collect()
}

#[test]
fn a_picture_that_stands_still_looks_alike_for_every_phosphor_and_frame() {
    for row in PHOSPHORS.iter().filter(|row| row.guns() == 1 && row.components.len() < 3) {
        let mut display = Display::new(with(row.name, true), [96, 96]);
        display.show(&line(0.7), 1, 5);
        let first = light(&display);
        let drawn = f64::from(display.light().at(48, 47).unwrap()[0]);
        assert!((first / drawn - 1.0).abs() < 1e-3, "{}: {first} {drawn}", row.name);
        display.show(&line(0.7), 1, 900);
        assert_eq!(light(&display), first, "{}", row.name);
    }
}

#[test]
fn light_that_is_gone_decays_by_the_closed_form() {
    let controls = with(GREEN, true);
    let decay = controls.phosphor.components[0].decay;
    for steps in [&[1u64, 2, 3, 4, 5, 6][..], &[6], &[2, 5, 6]] {
        let mut display = Display::new(controls, [64, 64]);
        display.show(&line(1.0), 1, 0);
        let before = light(&display);
        for frame in steps {
            display.show(&[], 2, *frame);
        }
        // Until the first of these frames the picture was there.
        let frames = (6 - steps[0] + 1) as f64;
        let expected = before * (-frames / 60.0 / decay).exp();
        let found = light(&display);
        assert!((found / expected - 1.0).abs() < 1e-4, "{steps:?}: {found} {expected}");
    }
}

#[test]
fn a_new_picture_builds_up_by_the_closed_form() {
    let controls = with(GREEN, true);
    let decay = controls.phosphor.components[0].decay;
    let mut display = Display::new(controls, [64, 64]);
    display.show(&[], 1, 0);
    for frame in 1..=5 {
        display.show(&line(1.0), 2, frame);
    }
    let full = f64::from(display.light().at(32, 31).unwrap()[0]);
    let expected = full * (1.0 - (-5.0 / 60.0 / decay).exp());
    assert!((light(&display) / expected - 1.0).abs() < 1e-4, "{} {expected}", light(&display));
}

#[test]
fn each_component_decays_by_itself() {
    // P1: 0.5618 with 2.88 ms, 0.4382 with 15.1 ms; in the frame after the last refresh.
    let mut display = Display::new(with("P1", true), [64, 64]);
    display.show(&line(1.0), 1, 0);
    let before = light(&display);
    display.show(&[], 2, 1);
    let frame = 1.0 / 60.0;
    let expected = 0.5618 * (-frame / 2.88e-3f64).exp() + 0.4382 * (-frame / 15.1e-3f64).exp();
    assert!((light(&display) / before / expected - 1.0).abs() < 1e-3, "{} {expected}", light(&display) / before);
}

#[test]
fn afterglow_ends_in_darkness_and_then_nothing_is_awaited() {
    let mut display = Display::new(with(GREEN, true), [64, 64]);
    display.show(&line(1.0), 1, 0);
    display.show(&[], 2, 1);
    assert!(display.awaits(2, 2) && light(&display) > 0.1);
    for frame in 2..=120 {
        display.show(&[], 2, frame);
    }
    assert!(!display.awaits(2, 121) && light(&display) == 0.0);
    assert!(display.frame().chunks_exact(4).all(|pixel| pixel == [0, 0, 0, 255]));
    assert!(display.light().tiles.iter().all(|tile| !tile.visible && !tile.glowing && !tile.lit));
}

#[test]
fn a_list_that_takes_two_frames_flickers_unless_it_is_steady() {
    let list = lasting(2);
    assert_eq!(Refresh::of(&list).frames, 2);
    let mut display = Display::new(with("P22", false), [64, 64]);
    let seen: Vec<bool> = (10..18)
        .map(|frame| {
            display.show(&list, 1, frame);
            light(&display) > 0.1
        })
        .collect();
    assert_eq!(seen, [true, false].repeat(4));

    display.set_controls(Controls { steady: true, ..*display.controls() });
    for frame in 18..24 {
        display.show(&list, 1, frame);
        assert!(light(&display) > 0.1, "{frame}");
    }
    assert!(!display.awaits(1, 24));
}

#[test]
fn the_same_frame_looks_the_same_however_often_one_looked() {
    let list = lasting(3);
    for (name, steady) in [("P22", false), ("P39", false), ("P7", false), ("P31", true), ("P1", false)] {
        let run = |frames: &[u64]| {
            let mut display = Display::new(with(name, steady), [64, 64]);
            display.show(&list, 1, 0);
            frames.iter().for_each(|frame| display.show(&list, 1, *frame));
            display.picture()
        };
        let every: Vec<u64> = (1..=31).collect();
        let (one, other) = (run(&every), run(&[4, 5, 17, 31]));
        let pairs = one.pixels().as_flattened().iter().zip(other.pixels().as_flattened());
        let worst = pairs.fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst < 2e-5, "{name}: {worst}");
    }
}

#[test]
fn a_long_phosphor_smooths_the_flicker_by_the_closed_form() {
    let list = lasting(4);
    let controls = with(GREEN, false);
    let keep = (-1.0 / 60.0 / controls.phosphor.components[0].decay).exp();
    let mut display = Display::new(controls, [64, 64]);
    display.show(&list, 1, 0);
    let full = f64::from(display.light().at(32, 31).unwrap()[0]);
    for frame in 0..12 {
        display.show(&list, 1, frame);
        let expected = full * (1.0 - keep) * keep.powi(frame as i32 % 4) / (1.0 - keep.powi(4));
        let found = light(&display);
        assert!((found / expected - 1.0).abs() < 2e-3, "frame {frame}: {found} {expected}");
    }
}

#[test]
fn what_changes_between_refreshes_is_seen_at_the_next() {
    let list = lasting(3);
    let mut display = Display::new(with("P22", false), [64, 64]);
    display.show(&list, 1, 0);
    let mut red = list.clone();
    red.iter_mut().for_each(|stroke| stroke.color = [1.0, 0.0, 0.0]);
    let is_red = |display: &Display| display.light().at(32, 31).unwrap()[1] == 0.0;
    for frame in 1..3 {
        display.show(&red, 2, frame);
        assert!(!is_red(&display), "{frame}");
    }
    display.show(&red, 2, 3);
    assert!(is_red(&display) && light(&display) > 0.1);
}

#[test]
fn a_change_within_a_frame_is_seen_at_once_with_a_short_phosphor() {
    let mut display = Display::new(Controls::default(), [64, 64]);
    display.show(&[], 1, 7);
    assert_eq!(light(&display), 0.0);
    display.show(&line(1.0), 2, 7);
    assert!(light(&display) > 0.5 && !display.awaits(2, 7) && !display.awaits(2, 700));
}

#[test]
fn the_bytes_are_those_of_the_picture() {
    for (size, name) in [([64, 64], "P22"), ([131, 77], "P39"), ([1, 1], "P4"), ([65, 33], "P7"), ([7, 300], "P31")] {
        let mut display = Display::new(with(name, true), size);
        let color = [1.0, 0.5, 0.2];
        let strokes = [Stroke { start: [-0.8, -0.7], end: [0.9, 0.6], intensity: [0.1, 1.5], color }];
        display.show(&strokes, 1, 0);
        display.show(&line(0.3), 2, 1);
        let picture = display.picture();
        assert_eq!(display.frame().len(), 4 * (size[0] * size[1]) as usize);
        let rgb: Vec<u8> = display.frame().chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
        assert_eq!(rgb, picture.to_srgb(), "{size:?}");
        assert!(size == [1, 1] || rgb.iter().any(|byte| *byte > 50), "{size:?}");
    }
}

#[test]
fn colours_of_the_hue_circle_are_those_of_the_tube() {
    // Hue 240 is green: the green primary of the tube, within half a percent of what sRGB can show.
    let mut green = line(1.0);
    green[0].color = crate::hue::rgb(240.0, 1.0);
    let mut display = Display::new(Controls::default(), [64, 64]);
    display.show(&green, 1, 0);
    let [r, g, b] = display.picture().pixel(32, 31).unwrap();
    assert!(r > 0.0 && r < 0.1 * g && b < 0.01 * g && g > 0.4, "{r} {g} {b}");
    display.show(&line(1.0), 2, 1);
    let [r, g, b] = display.picture().pixel(32, 31).unwrap();
    assert!((r / g - 1.0).abs() < 1e-5 && (b / g - 1.0).abs() < 1e-5, "white is white: {r} {g} {b}");
}

#[test]
fn one_gun_draws_every_colour_alike() {
    let mut red = line(1.0);
    red[0].color = [1.0, 0.0, 0.0];
    let shown = |strokes: &[Stroke]| {
        let mut display = Display::new(with("P4", true), [64, 64]);
        display.show(strokes, 1, 0);
        display.picture()
    };
    assert_eq!(shown(&red), shown(&line(1.0)));
}

#[test]
fn knobs_act_at_once_and_keep_the_afterglow() {
    let mut display = Display::new(with(GREEN, true), [64, 64]);
    display.show(&line(1.0), 1, 0);
    display.show(&[], 2, 1);
    let glow = light(&display);
    let mut controls = *display.controls();
    KNOBS[0].set(&mut controls, 0.25);
    assert_eq!((KNOBS[0].name, KNOBS[0].get(&controls)), ("brightness", 0.25));
    display.set_controls(controls);
    assert!(display.awaits(2, 1));
    display.show(&[], 2, 1);
    assert!((light(&display) / glow - 1.0).abs() < 1e-4, "the light is the same, the gain a quarter");
    KNOBS[0].set(&mut controls, 0.0);
    display.set_controls(controls);
    display.show(&[], 2, 1);
    assert!(display.picture().pixels().iter().all(|pixel| *pixel == [0.0; 3]));

    let mut display = Display::new(Controls::default(), [512, 512]);
    display.show(&line(1.0), 1, 0);
    let sharp = display.light().lit_pixels();
    display.set_controls(Controls { focus: 0.0, ..Controls::default() });
    display.show(&line(1.0), 1, 0);
    assert!(display.light().lit_pixels() > 3 * sharp);
}

#[test]
fn a_knob_beyond_its_ends_stays_at_them() {
    for knob in KNOBS {
        let mut controls = Controls::default();
        for (to, stands) in [(-3.0, 0.0), (9.0, 1.0), (f32::NAN, 1.0), (0.25, 0.25)] {
            knob.set(&mut controls, to);
            assert_eq!(knob.get(&controls), stands, "{}", knob.name);
        }
    }
}

#[test]
fn any_size_and_resizing_at_any_time_is_fine() {
    let mut display = Display::new(with("P7", false), [0, 0]);
    for (frame, size) in [[1, 1], [1, 2000], [640, 480], [3, 3], [9000, 2], [64, 32], [65, 33]].into_iter().enumerate()
    {
        display.resize(size);
        let size = size.map(|pixels| pixels.clamp(1, MAX_SIZE));
        assert_eq!((display.size(), display.frame().len()), (size, 4 * (size[0] * size[1]) as usize));
        display.show(&lasting(2), frame as u64, 3 * frame as u64);
        display.show(&line(1.0), 100 + frame as u64, 3 * frame as u64 + 1);
        assert!(display.picture().pixels().as_flattened().iter().all(|value| (0.0..=1.0).contains(value)));
    }
}

#[test]
fn a_frame_in_the_past_and_frames_far_ahead_are_fine() {
    for steady in [true, false] {
        let mut display = Display::new(with("P31", steady), [32, 32]);
        display.show(&lasting(2), 1, 1000);
        display.show(&line(1.0), 2, 3);
        display.show(&line(1.0), 3, u64::MAX / 4);
        display.show(&line(1.0), 4, u64::MAX / 4 + 1);
        assert!(light(&display).is_finite());
    }
}
