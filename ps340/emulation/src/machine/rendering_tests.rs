//! Rendering nodes on the whole machine: commands in, strokes, pixels and messages out.

use super::*;
use crate::line::LineId;
use crate::traversal::Stroke;
use protocol::{
    Value,
    raster::{LookupEntry, RasterCommand},
};

const LINE: LineId = LineId(1);
const TETRA: &str = "RESERVE_WORKING_STORAGE 100000;
    T := POLYGON .5,.5,.5 .5,-.5,-.5 -.5,.5,-.5 POLYGON .5,.5,.5 -.5,.5,-.5 -.5,-.5,.5
         POLYGON .5,.5,.5 -.5,-.5,.5 .5,-.5,-.5 POLYGON .5,-.5,-.5 -.5,-.5,.5 -.5,.5,-.5;
    S := BEGIN_STRUCTURE Z := ROTATE IN Z 0; R := SOLID_RENDERING; I := INSTANCE OF T; END_STRUCTURE; DISPLAY S;
    VARIABLE V; CONNECT S.R<1>:<1>V;";

fn told(text: &str) -> Machine {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    tell(&mut machine, text);
    machine
}

/// Sends something and lets the machine finish it.
fn tell(machine: &mut Machine, text: &str) {
    machine.step([Input::Bytes(LINE, text.as_bytes().to_vec())], 0);
    finish(machine);
}

fn finish(machine: &mut Machine) {
    for _ in 0..1_000 {
        machine.next_frame();
        if machine.is_idle() {
            return;
        }
    }
    panic!("the machine does not rest");
}

fn strokes(machine: &Machine) -> Vec<Stroke> {
    machine.latest_update().strokes.clone()
}

/// The latest answer of the node.
fn answer(machine: &Machine) -> Option<Value> {
    machine.memory.variable(&protocol::Name::new("V").unwrap()).unwrap().cloned()
}

fn errors(machine: &Machine) -> Vec<&str> {
    machine.log().filter(|l| l.starts_with('E')).collect()
}

fn lit(machine: &Machine) -> usize {
    machine.frame_buffer.output().iter().filter(|pixel| **pixel != [0; 3]).count()
}

#[test]
fn a_rendering_stands_for_the_original_until_it_is_toggled() {
    let mut machine = told(TETRA);
    assert_eq!((strokes(&machine).len(), answer(&machine)), (12, None));
    for (command, count) in [
        ("SEND FIX(4) TO <1>S.R;", 5),
        ("SEND FIX(0) TO <1>S.R;", 12),
        ("SEND FIX(0) TO <1>S.R;", 5),
        ("SEND FALSE TO <1>S.R;", 12),
        ("SEND FALSE TO <1>S.R;", 12),
        ("SEND TRUE TO <1>S.R;", 5),
        ("SEND FALSE TO <2>S.R; SEND FIX(3) TO <1>S.R;", 6),
        ("SEND TRUE TO <2>S.R; SEND FIX(3) TO <1>S.R;", 5),
        ("SEND FIX(4) TO <1>S.R; SEND FIX(0) TO <1>S.R;", 12),
    ] {
        tell(&mut machine, command);
        assert_eq!((strokes(&machine).len(), answer(&machine)), (count, Some(Value::Boolean(true))), "{command}");
    }
    assert_eq!(errors(&machine), [""; 0]);
}

#[test]
fn a_rendering_turns_with_what_is_above_and_is_rigid() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND FIX(4) TO <1>S.R;");
    let before = strokes(&machine);
    tell(&mut machine, "Q := F:ZROTATE; CONNECT Q<1>:<1>S.Z; SEND 90 TO <1>Q;");
    let turned = strokes(&machine);
    assert_eq!(turned.len(), 5);
    for (before, turned) in before.iter().zip(&turned) {
        assert_eq!([-before.start[1], before.start[0]], turned.start);
        assert_eq!([-before.end[1], before.end[0]], turned.end);
    }
}

#[test]
fn a_rendering_is_of_the_moment_in_which_it_is_asked_for() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND FIX(4) TO <1>S.R; T := NIL;");
    assert_eq!((strokes(&machine).len(), answer(&machine)), (5, Some(Value::Boolean(true))));
}

#[test]
fn a_rendering_gets_a_name_of_its_own() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND FIX(4) TO <1>S.R; SEND 'KEPT' TO <1>S.R; REMOVE S; DISPLAY KEPT;");
    assert_eq!(strokes(&machine).len(), 5);
    tell(&mut machine, "SEND FALSE TO <1>S.R; DELETE S;");
    assert_eq!(strokes(&machine).len(), 5, "it is ordinary data");
    assert_eq!(errors(&machine), [""; 0]);
    assert_eq!(machine.memory.structures.audit(), Ok(()));
}

#[test]
fn what_cannot_be_rendered_is_said_and_answered_with_false() {
    let mut machine = told(TETRA);
    for (command, error) in [
        ("SEND FIX(0) TO <1>S.R;", "E 10 *** Rendering failed: nothing was rendered at S.R"),
        ("SEND TRUE TO <1>S.R;", "E 10 *** Rendering failed: nothing was rendered at S.R"),
        ("SEND 'KEPT' TO <1>S.R;", "E 10 *** Rendering failed: nothing was rendered at S.R"),
        ("SEND FIX(1) TO <1>S.R;", "E 10 *** Rendering failed: no sectioning plane at S.R"),
        ("REMOVE S; SEND FIX(7) TO <1>S.R;", "E 10 *** Rendering failed: it is not displayed at S.R"),
        ("DISPLAY S; T := NIL; SEND FIX(7) TO <1>S.R;", "E 10 *** Rendering failed: no polygons at S.R"),
    ] {
        tell(&mut machine, "SEND 3 TO <1>V;");
        tell(&mut machine, command);
        assert_eq!(errors(&machine).last(), Some(&error), "{command}");
        assert_eq!(answer(&machine), Some(Value::Boolean(false)), "{command}");
    }
    assert!(machine.tube.graphics, "nothing was shaded");
}

#[test]
fn without_storage_nothing_is_rendered() {
    let mut machine = told(&TETRA.replace("100000", "1"));
    tell(&mut machine, "SEND FIX(4) TO <1>S.R;");
    assert_eq!((strokes(&machine).len(), errors(&machine).len()), (5, 0), "a little is there from the start");
    let many = "POLYGON .5,.5,.5 .5,-.5,-.5 -.5,.5,-.5\n".repeat(334);
    tell(&mut machine, &format!("T := {many};"));
    tell(&mut machine, "SEND FIX(4) TO <1>S.R;");
    assert_eq!(errors(&machine), ["E 8 *** Insufficient memory: S.R needs RESERVE_WORKING_STORAGE 50100"]);
    tell(&mut machine, "RESERVE_WORKING_STORAGE 50100; SEND FALSE TO <2>S.R; SEND FIX(3) TO <1>S.R;");
    assert_eq!(errors(&machine).len(), 1, "{:?}", errors(&machine));
}

#[test]
fn the_vector_screen_is_dark_after_shading_until_it_is_turned_on() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND FIX(0) TO <5>SHADINGENVIRONMENT; SEND FIX(6) TO <1>S.R;");
    assert_eq!((lit(&machine), answer(&machine)), (240 * 240, Some(Value::Boolean(true))));
    assert!(machine.visible_strokes().is_empty());
    tell(&mut machine, "SEND FIX(0) TO <1>TURNONDISPLAY;");
    assert_eq!(machine.visible_strokes().len(), 12);
    // The wiring of clients of the time turns it on by itself.
    tell(
        &mut machine,
        "CONS := F:CONSTANT; SEND FIX(0) TO <2>CONS; CONNECT S.R<1>:<1>CONS; CONNECT CONS<1>:<1>TURNONDISPLAY;",
    );
    tell(&mut machine, "SEND FIX(7) TO <1>S.R;");
    assert_eq!(machine.visible_strokes().len(), 12);
}

#[test]
fn washes_fill_the_viewport_or_the_screen() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND V3D(240,1,1) TO <2>SHADINGENVIRONMENT; SEND V3D(10,10,20) TO <3>SHADINGENVIRONMENT;");
    tell(&mut machine, "SEND FIX(0) TO <7>SHADINGENVIRONMENT;");
    assert_eq!(lit(&machine), 400);
    assert_eq!(machine.frame_buffer.pixel(29, 10), Some([0, 255, 0]));
    assert_eq!(machine.frame_buffer.pixel(30, 10), Some([0; 3]));
    tell(&mut machine, "SEND FIX(2) TO <7>SHADINGENVIRONMENT;");
    assert_eq!(lit(&machine), 640 * 480);
}

#[test]
fn a_long_rendering_is_made_in_slices_while_the_machine_goes_on() {
    let mut text = String::from("RESERVE_WORKING_STORAGE 10000000; B := ");
    for i in 0..60 {
        for k in 0..60 {
            let [x, y] = [i, k].map(|c| f64::from(c) / 30.0 - 1.0);
            let z = f64::from((i * 7 + k * 13) % 10) / 10.0;
            text += &format!("POLYGON {x},{y},{z} {x},{} ,{z} {},{},0.5 ", y + 0.5, x + 0.5, y + 0.5);
        }
    }
    text += "; S := BEGIN_STRUCTURE R := SURFACE_RENDERING; INSTANCE OF B; END_STRUCTURE; DISPLAY S;";
    let mut machine = told(&text);
    machine.step([Input::Bytes(LINE, b"SEND FIX(4) TO <1>S.R;".to_vec())], 0);
    machine.next_frame();
    machine.next_frame();
    assert!(!machine.is_idle(), "it takes longer than a frame");
    // The line is served, the picture is updated, and what changes does not matter for what has begun.
    machine.step([Input::Bytes(LINE, b"D := VECTOR_LIST DOTS 0,0,0; DISPLAY D; B := NIL;".to_vec())], 0);
    machine.next_frame();
    assert_eq!(strokes(&machine).len(), 1);
    finish(&mut machine);
    assert!(strokes(&machine).len() > 100);
    assert_eq!(errors(&machine), [""; 0]);
}

#[test]
fn a_request_dies_with_its_node_and_with_initialize() {
    for end in ["DELETE S;", "INITIALIZE;", "S := NIL;"] {
        let mut machine = told(TETRA);
        machine.step([Input::Bytes(LINE, format!("SEND FIX(4) TO <1>S.R; {end}").into_bytes())], 0);
        finish(&mut machine);
        assert_eq!(errors(&machine), [""; 0], "{end}");
        assert_eq!(machine.memory.structures.audit(), Ok(()));
    }
}

#[test]
fn a_node_that_sends_to_itself_does_not_stop_the_machine() {
    let mut machine = told(TETRA);
    tell(&mut machine, "SEND FIX(4) TO <1>S.R;");
    // Each answer shows the rendering again.
    machine.step([Input::Bytes(LINE, b"CONNECT S.R<1>:<1>S.R; SEND TRUE TO <1>S.R;".to_vec())], 0);
    for _ in 0..10 {
        machine.next_frame();
    }
    assert_eq!(strokes(&machine).len(), 5);
    for _ in 0..2_000 {
        machine.request_rendering(machine.memory.objects.find("S.R").unwrap(), crate::port::RenderingRequest::Toggle);
    }
    machine.next_frame();
    assert!(errors(&machine).iter().any(|error| error.starts_with("E 8")), "the queue has an end");
}

#[test]
fn between_begin_and_end_nothing_is_rendered() {
    let mut machine = told(TETRA);
    machine.step([Input::Bytes(LINE, b"BEGIN; SEND FIX(4) TO <1>S.R;".to_vec())], 0);
    for _ in 0..3 {
        machine.next_frame();
    }
    assert_eq!(strokes(&machine).len(), 12);
    tell(&mut machine, "END;");
    assert_eq!(strokes(&machine).len(), 5);
}

fn raster(machine: &mut Machine, commands: &[RasterCommand]) {
    let mut bytes = Vec::new();
    protocol::wire::write_raster(commands, &mut bytes).unwrap();
    machine.step([Input::Bytes(LINE, bytes)], 0);
}

#[test]
fn a_thousand_changes_of_the_tables_a_second_are_all_made() {
    let mut machine = told("");
    raster(&mut machine, &[RasterCommand::Erase { color: [200, 100, 50] }]);
    for frame in 0..60_u8 {
        for change in 0..17_u8 {
            let value = frame.wrapping_mul(17).wrapping_add(change);
            let entries = vec![LookupEntry { count: 255, color: [value, 255 - value, value / 2] }];
            raster(&mut machine, &[RasterCommand::LookupTable { index: 0, entries }]);
            let shown = [value, 255 - value, value / 2];
            assert_eq!(machine.frame_buffer.output()[0], shown, "frame {frame}, change {change}");
        }
        machine.next_frame();
    }
    assert!(machine.is_idle() && machine.frame_buffer.pixel(0, 0) == Some([200, 100, 50]));
    assert_eq!(errors(&machine), [""; 0]);
}

#[test]
fn what_changes_while_a_picture_is_shaded_holds_for_the_next_one() {
    let begin = |machine: &mut Machine| {
        tell(machine, "SEND FIX(3) TO <5>SHADINGENVIRONMENT;");
        machine.step([Input::Bytes(LINE, b"SEND FIX(8) TO <1>S.R;".to_vec())], 0);
        machine.next_frame();
        machine.next_frame();
        assert!(!machine.is_idle(), "it takes longer than a frame");
    };
    let mut undisturbed = told(TETRA);
    begin(&mut undisturbed);
    finish(&mut undisturbed);
    let mut machine = told(TETRA);
    begin(&mut machine);
    for part in 1..4_i32 {
        let text = format!(
            "SEND V3D({0},{0},{0}) TO <3>SHADINGENVIRONMENT; SEND FIX(0) TO <5>SHADINGENVIRONMENT;
             SEND V3D(120,1,1) TO <2>SHADINGENVIRONMENT; SEND 3 TO <4>SHADINGENVIRONMENT;",
            100 / part
        );
        machine.step([Input::Bytes(LINE, text.into_bytes())], 0);
        machine.next_frame();
    }
    finish(&mut machine);
    assert_eq!(machine.frame_buffer, undisturbed.frame_buffer);
    tell(&mut machine, "SEND FIX(2) TO <7>SHADINGENVIRONMENT; SEND FIX(8) TO <1>S.R;");
    assert_eq!(machine.frame_buffer.pixel(32, 32), Some([255, 0, 0]), "the background, beside the new viewport");
    assert_ne!(machine.frame_buffer.pixel(50, 50), Some([255, 0, 0]));
    assert_eq!(errors(&machine), [""; 0]);
}
