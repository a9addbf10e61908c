//! Tests of the whole machine: bytes in, strokes and bytes out.

use super::*;
use crate::line::LineId;
use crate::port::Label;
use crate::traversal::Stroke;

const LINE: LineId = LineId(1);

/// A machine with one host, which has carried out all that it received.
fn told(text: &str) -> Machine {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    tell(&mut machine, text);
    machine
}

fn tell(machine: &mut Machine, text: &str) -> Vec<String> {
    let outputs = machine.step([Input::Bytes(LINE, text.as_bytes().to_vec())], 0);
    outputs.iter().flat_map(messages).collect()
}

/// The messages of an output, with their line ends.
fn messages(output: &HostOutput) -> Vec<String> {
    String::from_utf8_lossy(&output.bytes).split_inclusive('\n').map(str::to_owned).collect()
}

fn strokes(machine: &mut Machine) -> Vec<Stroke> {
    machine.next_frame();
    machine.latest_update().strokes.clone()
}

fn frames(machine: &mut Machine, count: usize) -> Vec<String> {
    let mut said = Vec::new();
    for _ in 0..count {
        let until = time_of_frame(machine.frame() + 1);
        said.extend(machine.step([], until).iter().flat_map(messages));
    }
    said
}

fn errors(machine: &Machine) -> Vec<&str> {
    machine.log().filter(|l| l.starts_with('E')).collect()
}

const DOT: &str = "D := VECTOR_LIST DOTS 0.5,0,0;";

#[test]
fn text_makes_a_picture() {
    let mut machine = told(&format!("{DOT} DISPLAY D;"));
    assert_eq!(strokes(&mut machine)[0].start, [0.5, 0.0]);
    assert!(errors(&machine).is_empty());
}

#[test]
fn names_may_be_used_before_they_are_defined() {
    let mut machine = told("DISPLAY FRAME; INCLUDE A IN FRAME; A := INSTANCE OF D;");
    assert!(strokes(&mut machine).is_empty());
    tell(&mut machine, DOT);
    assert_eq!(strokes(&mut machine).len(), 1);
    assert!(errors(&machine).is_empty());
}

#[test]
fn a_deleted_object_vanishes_where_it_is_referred_to_for_ever() {
    let mut machine = told(&format!("{DOT} A := INSTANCE OF D; DISPLAY A;"));
    tell(&mut machine, "DELETE D;");
    assert!(strokes(&mut machine).is_empty());
    tell(&mut machine, DOT);
    assert!(strokes(&mut machine).is_empty(), "the new D is another object");
    tell(&mut machine, "INCLUDE D IN A;");
    assert_eq!(strokes(&mut machine).len(), 1);
}

#[test]
fn a_forgotten_object_stays_where_it_is_referred_to() {
    let mut machine = told(&format!("{DOT} A := INSTANCE OF D; DISPLAY A; FORGET D;"));
    assert_eq!(strokes(&mut machine).len(), 1);
    tell(&mut machine, "D := VECTOR_LIST DOTS 0,0,0 0,0,0;");
    assert_eq!(strokes(&mut machine).len(), 1, "the new D is another object");
}

#[test]
fn a_dial_turns_a_node_at_the_next_frame() {
    let mut machine = told(
        "D := VECTOR_LIST DOTS 1,0,0; W := BEGIN_STRUCTURE RZ := ROTATE IN Z 0; INSTANCE OF D; END_STRUCTURE;
         F := F:DZROTATE; CONNECT DIALS<3>:<1>F; CONNECT F<1>:<1>W.RZ; SEND 0 TO <2>F; SEND 200 TO <3>F; DISPLAY W;",
    );
    machine.event(Event::Dial { dial: 3, turns: 0.3 });
    machine.event(Event::Dial { dial: 3, turns: 0.15 });
    assert!(!machine.is_idle());
    let at = strokes(&mut machine)[0].start;
    assert!((at[0]).abs() < 1e-6 && (at[1] - 1.0).abs() < 1e-6, "90 degrees: {at:?}");
    assert!(machine.is_idle());
}

#[test]
fn the_matrix_of_a_view_comes_back_as_five_lines() {
    let mut machine = told(
        "W := BEGIN_STRUCTURE ROTATE IN Z 90; TRANSLATE BY 1,2,3; M := XFORM MATRIX; END_STRUCTURE; DISPLAY W;
         X := F:XFORMDATA; L := F:LIST; P := F:PRINT; CONNECT X<1>:<1>L; CONNECT L<1>:<1>P;
         CONNECT P<1>:<1>HOST_MESSAGE; SEND 'W.M' TO <2>X; SEND TRUE TO <1>X;",
    );
    let said = frames(&mut machine, 2);
    assert_eq!(said.len(), 5, "{said:?}");
    assert!(said[0].starts_with("MATRIX_4X4"));
    let row = |text: &str| -> Vec<f64> {
        text[1..].trim_end().trim_end_matches(';').split([' ', ',']).filter_map(|w| w.parse().ok()).collect()
    };
    assert_eq!(row(&said[1]), [0.0, 1.0, 0.0, 0.0]);
    assert_eq!(row(&said[2]), [-1.0, 0.0, 0.0, 0.0]);
    assert_eq!(row(&said[4]), [-2.0, 1.0, 3.0, 1.0]);
}

#[test]
fn an_xform_node_that_is_not_displayed_is_an_error() {
    let mut machine = told("X := F:XFORMDATA; SEND 'NOWHERE' TO <2>X; SEND TRUE TO <1>X;");
    frames(&mut machine, 2);
    assert_eq!(errors(&machine), ["E 2 *** Name not found: NOWHERE"]);
    assert!(machine.is_idle());
}

#[test]
fn messages_go_to_every_host() {
    let mut machine = told("");
    machine.step([Input::Attach(LineId(2))], 0);
    let outputs = machine.step([Input::Bytes(LINE, b"SEND 'HELLO' TO <1>HOST_MESSAGE;".to_vec())], 0);
    let lines: Vec<(LineId, &[u8])> = outputs.iter().map(|o| (o.line, o.bytes.as_slice())).collect();
    assert_eq!(lines, [(LINE, &b"HELLO\r\n"[..]), (LineId(2), &b"HELLO\r\n"[..])]);
    assert_eq!(machine.take_message().as_deref(), Some(&b"HELLO"[..]));
}

#[test]
fn a_reference_inside_a_structure_means_what_is_named_there_first() {
    let mut machine = told(
        "CUD := VECTOR_LIST DOTS 0,0,0 0,0,0;
         S := BEGIN_STRUCTURE INSTANCE OF CUD; CUD := VECTOR_LIST DOTS 0.5,0.5,0; END_STRUCTURE; DISPLAY S;",
    );
    let drawn = strokes(&mut machine);
    assert_eq!(drawn.len(), 2, "S.CUD by reference and in place");
    assert!(drawn.iter().all(|s| s.start == [0.5, 0.5]));
}

#[test]
fn send_inside_an_open_structure_acts_at_once_on_a_full_path() {
    let mut machine =
        told("A := BEGIN_STRUCTURE T := TRANSLATE BY 0,0,0; VECTOR_LIST DOTS 0,0,0; END_STRUCTURE; DISPLAY A;");
    tell(&mut machine, "B := BEGIN_STRUCTURE ROTATE IN X 10; SEND V3D(0.25,0,0) TO <1>A.T;");
    assert_eq!(strokes(&mut machine)[0].start, [0.25, 0.0]);
    tell(&mut machine, "END_STRUCTURE;");
    assert!(errors(&machine).is_empty(), "{:?}", errors(&machine));
}

#[test]
fn an_open_structure_shows_nothing_until_its_end() {
    let mut machine = told("DISPLAY A; A := BEGIN_STRUCTURE VECTOR_LIST DOTS 0,0,0;");
    assert!(strokes(&mut machine).is_empty());
    tell(&mut machine, "END_STRUCTURE;");
    assert_eq!(strokes(&mut machine).len(), 1);
}

#[test]
fn a_redefined_structure_loses_its_old_members() {
    let mut machine = told("A := BEGIN_STRUCTURE T := TRANSLATE BY 0,0,0; END_STRUCTURE;");
    tell(&mut machine, "A := BEGIN_STRUCTURE R := ROTATE IN X 0; END_STRUCTURE; SEND V3D(1,0,0) TO <1>A.T;");
    assert_eq!(errors(&machine), ["E 2 *** Name not found: A.T"]);
}

#[test]
fn a_line_that_closes_inside_a_structure_leaves_nothing_half_done() {
    let mut machine = told("A := BEGIN_STRUCTURE VECTOR_LIST DOTS 0,0,0;");
    machine.step([Input::Detach(LINE)], 0);
    assert_eq!(machine.describe("A"), None);
    assert_eq!(errors(&machine).len(), 1);
}

#[test]
fn wildcards_and_initialize_spare_the_system() {
    let mut machine = told("T1 := F:ADDC; T2 := F:NOP; CONNECT DIALS<1>:<1>T1; DELETE T*; SEND 'X' TO <1>DLABEL1;");
    assert_eq!(machine.describe("TABLETIN").as_deref(), Some("TABLETIN := F:TABLETIN"));
    assert_eq!(machine.describe("T1"), None);
    assert_eq!(machine.panel().label(Label::Dial(1)), b"X");
    tell(&mut machine, "INITIALIZE;");
    assert_eq!(machine.describe("T1"), None);
    assert!(machine.describe("TURNONDISPLAY").is_some());
    tell(&mut machine, "DIALS := F:ADDC; DELETE FKEYS;");
    assert_eq!(errors(&machine).len(), 2, "{:?}", errors(&machine));
}

#[test]
fn the_harmless_things_that_clients_do_are_harmless() {
    let mut machine = told("A := F:ACCUMULATE; B := F:NOP; FRAME := INSTANCE OF A;");
    for text in [
        "DISCONNECT A<1>:<2>B;",
        "DISCONNECT A:ALL;",
        "CONNECT A<1>:<1>B; CONNECT A<1>:<1>B;",
        "REMOVE T001 FROM FRAME;",
        "REMOVE NOWHERE;",
        "B := F:NOP; B := F:NOP;",
        "SEND TRUE TO <1>CLEAR_LABELS; SEND FIX(0) TO <1>OFFBUTTONLIGHTS; SEND FIX(0) TO <1>TURNONDISPLAY;",
        "IF := WINDOW X = -1:1 Y = -1:1; IN := ROTATE IN X 1; IS := SCALE BY 2;",
    ] {
        tell(&mut machine, text);
        assert!(errors(&machine).is_empty(), "{text}: {:?}", errors(&machine));
    }
}

#[test]
fn errors_reach_the_host_that_asks_for_them() {
    let mut machine = told("CONNECT ERROR<1>:<1>HOST_MESSAGE;");
    let said = tell(&mut machine, "NONSENSE 1 2; SEND 1 TO <1>NOWHERE;");
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].starts_with("E 1 ***") && said[0].contains("NONSENSE"), "{said:?}");
    assert!(said[1].starts_with("E 2 *** Name not found: NOWHERE"));
}

#[test]
fn a_network_that_never_rests_stops_neither_frames_nor_lines() {
    let mut machine = told("A := F:NOP; B := F:NOP; CONNECT A<1>:<1>B; CONNECT B<1>:<1>A; SEND 1 TO <1>A;");
    frames(&mut machine, 3);
    assert!(!machine.is_idle());
    let firings = machine.counters().firings;
    assert!((WORK_PER_STEP..=10 * WORK_PER_STEP).contains(&firings), "{firings}");
    tell(&mut machine, "DELETE A, B; SEND 'STILL HERE' TO <1>HOST_MESSAGE;");
    frames(&mut machine, 2);
    assert_eq!(machine.take_message().as_deref(), Some(&b"STILL HERE"[..]));
}

#[test]
fn an_error_that_causes_itself_does_not_hang_the_machine() {
    let mut machine = told("S := F:DIV; CONNECT ERROR<1>:<1>S; CONNECT ERROR<1>:<2>S;");
    tell(&mut machine, "NONSENSE;");
    frames(&mut machine, 3);
    assert!(machine.log().count() <= 1000);
}

#[test]
fn dials_beyond_the_patience_of_a_network_are_counted() {
    let mut machine = told("A := F:ADD; CONNECT DIALS<1>:<1>A;");
    for _ in 0..20_000 {
        machine.event(Event::Dial { dial: 1, turns: 0.1 });
        machine.next_frame();
    }
    let warnings = machine.log().filter(|l| l.starts_with('W')).count();
    assert!(warnings >= 1, "{:?}", machine.log().last());
}

#[test]
fn a_press_of_the_puck_sends_place_and_code_once() {
    let mut machine = told(
        "P := F:PRINT; CONNECT TABLETIN<3>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE;
         Q := F:PRINT; CONNECT TABLETIN<6>:<1>Q; CONNECT Q<1>:<1>HOST_MESSAGE;",
    );
    machine.event(Event::Tablet(TabletEvent::Move([0.25, -0.125])));
    machine.event(Event::Tablet(TabletEvent::Press(1)));
    machine.event(Event::Tablet(TabletEvent::Release));
    let mut said = Vec::new();
    while let Some(message) = machine.take_message() {
        said.push(String::from_utf8_lossy(&message).into_owned());
    }
    assert_eq!(said.iter().filter(|m| m.starts_with('V')).count(), 1, "{said:?}");
    said.retain(|m| !m.starts_with('V'));
    assert_eq!(said, ["0", "0", "1", "0"]);
}

#[test]
fn two_machines_do_the_same() {
    let script = format!("{DOT} A := BEGIN_STRUCTURE ROTATE IN Z 17; INSTANCE OF D; END_STRUCTURE; DISPLAY A;");
    let (mut one, mut two) = (told(&script), told(""));
    for byte in script.bytes() {
        two.step([Input::Bytes(LINE, vec![byte])], 0);
    }
    assert_eq!(strokes(&mut one), strokes(&mut two));
    let size = Some([64, 64]);
    assert_eq!(one.vector_picture(size).pixels(), two.vector_picture(size).pixels());
}

#[test]
fn every_packet_mode_and_form_reaches_the_interpreter() {
    use protocol::command::parse;
    use protocol::wire::{DataForm, PacketForm, Sending, write_commands_as};
    let commands = [DOT, "A := INSTANCE OF D;", "DISPLAY A;"].map(|text| parse(text.as_bytes()).unwrap());
    for (packets, _) in PacketForm::ALL {
        for (data, _) in DataForm::ALL {
            let mut stream = Vec::new();
            write_commands_as(Sending { packets, data }, &commands, &mut stream).unwrap();
            let mut machine = told("");
            for byte in stream {
                machine.step([Input::Bytes(LINE, vec![byte])], 0);
            }
            assert_eq!(strokes(&mut machine).len(), 1, "{packets:?} {data:?}");
            assert!(errors(&machine).is_empty());
        }
    }
}

#[test]
fn a_channel_of_the_site_reaches_the_network() {
    let mut machine = told("CONNECT CHANNEL5<1>:<1>HOST_MESSAGE;");
    assert_eq!(tell(&mut machine, "\x165left\x10\x16\x16\x16\x166lost\x16\x16"), ["left\x16\r\n"]);
    assert!(tell(&mut machine, "DELETE CHANNEL5;").is_empty());
    assert_eq!(errors(&machine).len(), 1, "it belongs to the system");
}

#[test]
fn a_diagnostic_packet_is_an_information() {
    let mut machine = told("CONNECT INFORMATION<1>:<1>HOST_MESSAGE;");
    assert_eq!(tell(&mut machine, "\x16?half\nway\x16\x16"), ["I 13 *** Host says: half\\nway\r\n"]);
}

#[test]
fn a_damaged_six_bit_packet_is_dropped_with_a_message() {
    let mut machine = told("\x162~~\x16\x16\x168 1\x16\x16");
    let warnings: Vec<&str> = machine.log().filter(|l| l.starts_with("W 12")).collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(tell(&mut machine, "SEND 'x' TO <1>HOST_MESSAGE;") == ["x\r\n"]);
}

#[test]
fn what_is_between_begin_and_end_is_seen_at_once() {
    let mut machine = told(&format!("{DOT} DISPLAY D;"));
    assert_eq!(strokes(&mut machine)[0].start, [0.5, 0.0]);
    tell(&mut machine, "BEGIN; D := VECTOR_LIST DOTS 0.25,0,0; BEGIN; A := INSTANCE OF D; END; DISPLAY A;");
    assert_eq!(strokes(&mut machine).len(), 1, "the picture stands still");
    assert_eq!(strokes(&mut machine)[0].start, [0.5, 0.0]);
    tell(&mut machine, "X := F:XFORMDATA; SEND 'NOWHERE' TO <2>X; SEND TRUE TO <1>X;");
    frames(&mut machine, 2);
    assert!(errors(&machine).is_empty(), "what asks for an update waits for it");
    tell(&mut machine, "END;");
    let drawn = strokes(&mut machine);
    assert_eq!(drawn.iter().map(|s| s.start).collect::<Vec<_>>(), [[0.25, 0.0]; 2]);
    assert_eq!(errors(&machine), ["E 2 *** Name not found: NOWHERE"]);
}

#[test]
fn a_line_that_closes_after_begin_lets_the_picture_go_on() {
    let mut machine = told(&format!("DISPLAY D; BEGIN; {DOT}"));
    assert!(strokes(&mut machine).is_empty());
    machine.step([Input::Detach(LINE)], 0);
    assert_eq!(strokes(&mut machine).len(), 1);
    assert_eq!(errors(&machine), ["E 4 *** the line closed while BEGIN was open"]);
}

#[test]
fn the_dashes_of_a_pattern_follow_its_list_at_the_next_frame() {
    let mut machine = told(
        "V := VECTOR_LIST 0,0 0.8,0; DISPLAY V; P := PATTERN 1 1 LENGTH 0.2; PATTERN V WITH P;
         CONNECT FKEYS<1>:<delete>V;",
    );
    assert_eq!(strokes(&mut machine).len(), 4);
    tell(&mut machine, "SEND V2D(0.4,0) TO <2>V;");
    assert_eq!(strokes(&mut machine).len(), 2);
    machine.event(Event::Key(1));
    assert!(strokes(&mut machine).is_empty());
    tell(&mut machine, "SEND V2D(1E9,0) TO <append>V; SEND V2D(2E9,0) TO <append>V;");
    frames(&mut machine, 1);
    assert_eq!(errors(&machine).len(), 1, "{:?}", errors(&machine));
    assert!(errors(&machine)[0].starts_with("E 6 *** Value out of range in V: the pattern is given up"));
}

#[test]
fn a_restart_leaves_time_lines_and_password_only() {
    let mut machine = told(&format!(
        "{DOT} DISPLAY D; CONFIGURE X; SETUP PASSWORD SESAME; SEND 'X' TO <1>DLABEL1; DELETE FKEYS;
         A := BEGIN_STRUCTURE BEGIN; CONNECT ERROR<1>:<1>HOST_MESSAGE;"
    ));
    machine.step([Input::Attach(LineId(2)), Input::Bytes(LineId(2), b"BEGIN; B := BEGIN_STRUCTURE ".to_vec())], 0);
    frames(&mut machine, 3);
    tell(&mut machine, "REBOOT WRONG; REBOOT SESAME;");
    assert_eq!(errors(&machine), ["E 4 *** the password is wrong"]);
    assert!(strokes(&mut machine).is_empty());
    assert_eq!(machine.describe("D"), None);
    assert!(machine.describe("FKEYS").is_some() && machine.frame() == 4);
    assert_ne!(machine.panel().label(Label::Dial(1)), b"X");
    let said = tell(&mut machine, "NONSENSE; C := F:CLFRAMES; COMMAND STATUS; CONFIGURE WRONG;");
    assert!(said.is_empty(), "the connections are gone: {said:?}");
    let log: Vec<&str> = machine.log().collect();
    assert!(log.contains(&"I 11 *** the machine was started again") && log.contains(&"I 11 *** 0 BEGIN open"));
    assert_eq!(errors(&machine).last(), Some(&"E 4 *** the password is wrong"));
    tell(&mut machine, &format!("{DOT} DISPLAY D;"));
    assert_eq!(strokes(&mut machine).len(), 1);
    machine.step([Input::Bytes(LineId(2), b"END;".to_vec())], 0);
    assert_eq!(errors(&machine).last(), Some(&"E 4 *** END without BEGIN"), "the other line begins anew, too");
}

#[test]
fn information_reaches_the_host_that_asks_for_it() {
    let mut machine = told("CONNECT INFORMATION<1>:<1>HOST_MESSAGE; SETUP INTERFACE PORT1/SPEED=9600;");
    assert_eq!(tell(&mut machine, "SHOW INTERFACE PORT1;"), ["I 11 *** interface PORT1: SPEED=9600\r\n"]);
}

#[test]
fn every_kind_of_object_is_described() {
    let mut machine = told(
        "S := BEGIN_STRUCTURE T := SET RATE 2 3; BEGIN_STRUCTURE NIL; END_STRUCTURE; END_STRUCTURE; A := S;
         F := BEGIN_FONT C[65]: P 0,0 L 1,1; END_FONT; G := CHARACTER FONT F APPLIED TO S; VARIABLE V;
         L := LABELS 0,0 'ONE' 1,1 'TWO'; P := POLYGON 0,0,0 1,0,0 0,1,0; Q := PATTERN 1 2 NOMATCH LENGTH 3;
         B := POLYNOMIAL ORDER = 1 COEFFICIENTS = 1,0 0,0 CHORDS = 2; PATTERN B WITH Q; R := RAWBLOCK 7;",
    );
    tell(&mut machine, "STORE FIX(3) IN V; PREFIX G WITH SET PICKING ON;");
    let cases = [
        ("A", "A := S"),
        ("S", "S := BEGIN_STRUCTURE, 2 members: S.T (structure)"),
        ("S.T", "S.T := SET RATE 2 3 ON 0"),
        ("F", "F := BEGIN_FONT, 1 characters"),
        ("G", "G := SET PICKING ON APPLIED TO (CHARACTER FONT)"),
        ("V", "V := VARIABLE, FIX(3)"),
        ("L", "L := LABELS, 2: 'ONE' 'TWO'"),
        ("P", "P := POLYGON, 1 polygons, 3 vertices"),
        ("Q", "Q := PATTERN 1 2 NOMATCH LENGTH 3"),
        ("B", "B := VECTOR_LIST Connected, 3 vectors, a curve over 0:1, in 4 vectors of a pattern"),
        ("R", "R := RAWBLOCK 7"),
    ];
    for (name, expected) in cases {
        assert_eq!(machine.describe(name).as_deref(), Some(expected));
    }
}

#[test]
fn an_initial_structure_that_is_restored_has_no_prefix() {
    let mut machine = told("PREFIX PICK_LOCATION WITH SCALE BY 2; DELETE PICK_LOCATION;");
    assert!(errors(&machine).is_empty(), "{:?}", errors(&machine));
    tell(&mut machine, "SEND V2D(0.1,0.1) TO <2>PICK_LOCATION;");
    assert!(errors(&machine).is_empty(), "it takes the size of the pick box again: {:?}", errors(&machine));
    tell(&mut machine, "REMOVE PREFIX OF PICK_LOCATION;");
    assert_eq!(errors(&machine), ["E 4 *** PICK_LOCATION is a name without a prefix"]);
}

#[test]
fn a_host_that_leaves_ends_the_begin_that_holds_the_picture_for_all() {
    let mut machine = Machine::new(Settings::default());
    let (first, second) = (LineId(1), LineId(2));
    machine.step([Input::Attach(first), Input::Attach(second)], 0);
    let say = |machine: &mut Machine, line, text: &str| {
        machine.step([Input::Bytes(line, text.as_bytes().to_vec())], 0);
        machine.next_frame();
    };
    say(&mut machine, first, "BEGIN");
    say(&mut machine, first, " V := VECTOR_LIST DOTS 0,0; DISPLAY V; BEGIN V := NIL;");
    say(&mut machine, second, "W := VECTOR_LIST DOTS 0,0 0.5,0; DISPLAY W; COMMAND STATUS;");
    assert!(machine.latest_update().strokes.is_empty());
    let status = "I 11 *** 0 BEGIN open; the picture stands still until END on 1 other lines";
    assert!(machine.log().any(|line| line == status), "{:?}", machine.log().collect::<Vec<_>>());
    machine.step([Input::Detach(first)], 0);
    machine.next_frame();
    assert_eq!(machine.latest_update().strokes.len(), 2);
    assert!(machine.log().any(|line| line.contains("the line closed while BEGIN was open")));
}

#[test]
fn a_name_that_is_not_known_is_told_with_the_one_that_was_meant() {
    let machine = told("CUBE := NIL; SEND 1 TO <1>CUEB; X := F:ADDD; DELETE DAILS;");
    let expected = [
        "E 2 *** Name not found: CUEB; did you mean CUBE?",
        "E 2 *** Name not found: F:ADDD; did you mean F:ADD?",
        "E 2 *** Name not found: DAILS; did you mean DIALS?",
    ];
    assert_eq!(errors(&machine), expected);
}
