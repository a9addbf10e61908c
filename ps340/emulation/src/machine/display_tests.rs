//! The vector display of a structure: depth cues, blinking, screens, knobs.

use super::{Input, Machine, Settings};
use crate::calligraphic::{Controls, phosphor};
use crate::line::LineId;

fn machine(text: &str) -> Machine {
    let mut machine = Machine::new(Settings::default());
    let line = LineId(1);
    machine.step([Input::Attach(line), Input::Bytes(line, text.as_bytes().to_vec())], 0);
    machine.next_frame();
    machine
}

/// The brightest byte of the display, in its part from column `left` to `right`.
fn brightest(machine: &mut Machine, left: usize, right: usize) -> u8 {
    let pixels = machine.vector_frame([64, 64]);
    let inside = pixels.chunks_exact(4).enumerate().filter(|(at, _)| (left..right).contains(&(at % 64)));
    inside.flat_map(|(_, pixel)| &pixel[..3]).copied().max().unwrap_or(0)
}

#[test]
fn what_lies_farther_back_is_darker() {
    let mut machine = machine(
        "W := WINDOW X = -1:1 Y = -1:1 FRONT = 0 BACK = 1 THEN V; V := VECTOR_LIST SEPARATE_LINES N = 4
         -0.5,-0.8,0.1 -0.5,0.8,0.1 0.5,-0.8,0.8 0.5,0.8,0.8; DISPLAY W;",
    );
    let (front, back) = (brightest(&mut machine, 0, 32), brightest(&mut machine, 32, 64));
    assert!(front > 180 && back > 60 && back < front - 40, "{front} {back}");
}

#[test]
fn what_blinks_is_dark_in_every_other_phase() {
    let mut machine = machine(
        "B := SET BLINK RATE 5 THEN C; C := SET BLINKING ON THEN V;
         V := VECTOR_LIST N = 2 -0.5,0 0.5,0; DISPLAY B;",
    );
    let seen: Vec<bool> = (0..20)
        .map(|_| {
            machine.next_frame();
            brightest(&mut machine, 0, 64) > 0
        })
        .collect();
    let changes = seen.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!((3..=4).contains(&changes), "{seen:?}");
}

#[test]
fn each_screen_shows_what_is_set_for_it() {
    let mut machine = machine(
        "A := SET DISPLAY 1 OFF THEN L; L := VECTOR_LIST N = 2 -0.5,-0.8 -0.5,0.8;
         B := SET DISPLAY 0 OFF THEN R; R := VECTOR_LIST N = 2 0.5,-0.8 0.5,0.8; DISPLAY A; DISPLAY B;",
    );
    for (screen, left, right) in [(0, true, false), (1, false, true), (2, true, true), (0, true, false)] {
        machine.set_controls(Controls { screen, ..*machine.controls() });
        let seen = (brightest(&mut machine, 0, 32) > 0, brightest(&mut machine, 32, 64) > 0);
        assert_eq!(seen, (left, right), "screen {screen}");
    }
}

#[test]
fn the_picture_of_a_file_is_that_of_the_window() {
    let mut machine = machine("V := VECTOR_LIST N = 3 -0.5,0 0.5,0.3 0.1,-0.7; DISPLAY V;");
    machine.set_controls(Controls { phosphor: phosphor("P39").unwrap(), ..Controls::default() });
    let window = machine.vector_frame([200, 120]);
    for text in [&b"REMOVE V;"[..], b"", b"DISPLAY V;"] {
        machine.step([Input::Bytes(LineId(1), text.to_vec())], 0);
        machine.next_frame();
        let pixels = machine.vector_frame([200, 120]);
        let rgb: Vec<u8> = pixels.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
        for size in [None, Some([200, 120])] {
            assert_eq!(machine.vector_picture(size).to_srgb(), rgb);
        }
        assert!(rgb.iter().any(|byte| *byte > 0), "the afterglow is there");
    }
    assert_ne!(window, machine.vector_frame([200, 120]));
    // Another size disturbs nothing.
    let before = machine.vector_frame([200, 120]);
    assert_eq!(machine.vector_picture(Some([50, 70])).width(), 50);
    assert_eq!(machine.vector_frame([200, 120]), before);
}

#[test]
fn a_display_nobody_looked_at_before_goes_along_if_its_phosphor_glows() {
    let mut machine = machine("V := VECTOR_LIST N = 2 -0.5,0 0.5,0; DISPLAY V;");
    machine.set_controls(Controls { phosphor: phosphor("P39").unwrap(), ..Controls::default() });
    machine.next_frame();
    machine.step([Input::Bytes(LineId(1), b"REMOVE V;".to_vec())], 0);
    let glow: Vec<f32> = (0..3)
        .map(|_| {
            machine.next_frame();
            machine.vector_picture(None).pixels().as_flattened().iter().fold(0.0, |most, value| value.max(most))
        })
        .collect();
    assert!(glow[0] > glow[1] && glow[1] > glow[2] && glow[2] > 0.1, "{glow:?}");
}

#[test]
fn the_refresh_counts_the_strokes_of_all_screens_that_are_seen() {
    let mut machine = machine("A := SET DISPLAY 0 OFF THEN V; V := VECTOR_LIST N = 2 0,0 0.5,0; DISPLAY A;");
    // 0.15 to begin, 5 for 0.5.
    assert!((machine.refresh().micros - 5.15).abs() < 1e-3, "{:?}", machine.refresh());
    assert_eq!(machine.counters().refresh_micros, 5);
    machine.tube.graphics = false;
    assert_eq!(machine.refresh().micros, 0.0);
}

#[test]
fn a_picture_of_many_vectors_is_drawn_when_somebody_looks_and_is_the_same() {
    let vectors =
        |n: usize| (0..n).map(|i| format!("{},{} ", (i % 91) as f32 / 91.0, (i % 7) as f32 / 7.0)).collect::<String>();
    let text = format!("A := VECTOR_LIST {}; DISPLAY A; SEND 'HI' TO <1>MESSAGE_DISPLAY;", vectors(250_000));
    let machine = || {
        let mut machine = Machine::new(Settings::default());
        machine.step([Input::Attach(LineId(1)), Input::Bytes(LineId(1), text.clone().into())], 0);
        machine.next_frame();
        machine
    };
    let (mut in_parts, mut whole) = (machine(), machine());
    assert!(in_parts.latest_update().is_counted_only && in_parts.is_idle());
    assert_eq!((in_parts.counters().vectors, in_parts.counters().strokes), (250_000, 0));
    let size = Some([90, 60]);
    let picture = in_parts.vector_picture(size);
    assert!(in_parts.latest_update().is_counted_only, "its strokes were not kept");
    whole.renew_picture();
    assert_eq!((whole.counters().strokes, whole.latest_update().strokes.len()), (249_999, 249_999));
    assert_eq!(picture.to_srgb(), whole.vector_picture(size).to_srgb());
    // A glow needs every frame, and so every stroke.
    let controls = Controls { steady: false, ..*in_parts.controls() };
    in_parts.set_controls(controls);
    in_parts.next_frame();
    assert!(!in_parts.latest_update().is_counted_only);
}

#[test]
fn what_is_written_back_has_its_strokes() {
    let mut machine = Machine::new(Settings::default());
    let lists = "0,0 1,0 ".repeat(110_000);
    let text = format!(
        "A := VECTOR_LIST {lists}; W := WRITEBACK THEN B; B := VECTOR_LIST 0,0 0.5,0; DISPLAY A; DISPLAY W; SEND TRUE TO <1>W;"
    );
    machine.step([Input::Attach(LineId(1)), Input::Bytes(LineId(1), text.into())], 0);
    machine.next_frame();
    assert!(!machine.latest_update().is_counted_only);
    assert_eq!(machine.latest_update().write_back.iter().map(|range| range.len()).sum::<usize>(), 1);
}
