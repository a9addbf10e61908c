//! Tests of the devices in the whole machine: keyboard, terminal, cursor, labels, memory, screen saver.

use super::*;
use crate::line::LineId;
use crate::{
    port::Label,
    traversal::{
        Stroke,
        font::{self, Font},
    },
};
use proptest::prelude::*;
use protocol::wire::{Route, write_packet};

const LINE: LineId = LineId(1);

fn machine_with(settings: Settings, text: &str) -> Machine {
    let mut machine = Machine::new(settings);
    machine.step([Input::Attach(LINE)], 0);
    tell(&mut machine, text);
    machine
}

fn told(text: &str) -> Machine {
    machine_with(Settings::default(), text)
}

/// What comes out on the line for some text.
fn tell(machine: &mut Machine, text: &str) -> String {
    let outputs = machine.step([Input::Bytes(LINE, text.as_bytes().to_vec())], 0);
    outputs.iter().map(|o| String::from_utf8_lossy(&o.bytes).into_owned()).collect()
}

/// What comes out on the line for something that a person does.
fn done(machine: &mut Machine, event: Event) -> String {
    let outputs = machine.step([Input::Event(event)], 0);
    outputs.iter().map(|o| String::from_utf8_lossy(&o.bytes).into_owned()).collect()
}

fn typed(machine: &mut Machine, text: &str) -> String {
    done(machine, Event::Type(text.as_bytes().to_vec()))
}

fn press(machine: &mut Machine, name: &str) -> String {
    done(machine, Event::Press(Key::named(name).unwrap()))
}

fn moved(machine: &mut Machine, x: f64, y: f64) {
    machine.event(Event::Tablet(TabletEvent::Move([x, y])));
}

/// The strokes over the picture after a frame.
fn overlay(machine: &mut Machine) -> Vec<Stroke> {
    machine.next_frame();
    machine.overlay().to_vec()
}

fn ends(strokes: &[Stroke]) -> Vec<[f32; 4]> {
    let rounded = |x: f32| (x * 1e4).round() / 1e4;
    strokes.iter().map(|s| [s.start[0], s.start[1], s.end[0], s.end[1]].map(rounded)).collect()
}

#[test]
fn in_interactive_mode_characters_and_special_keys_go_to_their_instances() {
    let mut machine = told("CONNECT KEYBOARD<1>:<1>HOST_MESSAGE; CONNECT SPECKEYS<1>:<1>HOST_MESSAGE;");
    assert_eq!(typed(&mut machine, "ab"), "a\r\nb\r\n");
    assert_eq!(
        press(&mut machine, "up") + &press(&mut machine, "PF1") + &press(&mut machine, "keypad7"),
        "A\r\nP\r\nw\r\n"
    );
    assert_eq!(machine.terminal().text(), "", "nothing is echoed");
}

#[test]
fn the_keyboard_handler_gives_the_host_one_character_a_message() {
    let mut machine = told("CONNECT KBHANDLER<4>:<1>HOST_MESSAGE;");
    typed(&mut machine, "A\r\x7f");
    let said: Vec<_> = std::iter::from_fn(|| machine.take_message()).collect();
    assert_eq!(said, [b"A".to_vec(), b"\r".to_vec(), b"\x7f".to_vec()]);
}

#[test]
fn in_terminal_mode_keys_go_to_the_host_as_they_are() {
    let mut machine = told("");
    press(&mut machine, "host");
    assert_eq!(machine.keyboard_mode(), KeyboardMode::Terminal);
    assert_eq!(typed(&mut machine, "ls\r"), "ls\r");
    assert_eq!(
        press(&mut machine, "up") + &press(&mut machine, "delete") + &press(&mut machine, "enter"),
        "\x1b[A\x7f\r"
    );
    assert_eq!(machine.terminal().text(), "", "local echo is off");
    machine.show_text(None, b"\x1b[?1h\x1b[20h");
    assert_eq!(press(&mut machine, "up") + &press(&mut machine, "return"), "\x1bOA\r\n", "as the host's modes say");
    tell(&mut machine, "CONNECT KBHANDLER<4>:<1>HOST_MESSAGE;");
    assert_eq!(typed(&mut machine, "a"), "a\r\n", "a connected handler takes the characters");
}

#[test]
fn the_terminal_speaks_with_the_host_that_spoke_to_it_last() {
    let settings = Settings { plain_text: PlainText::Terminal, keyboard: KeyboardMode::Terminal };
    let mut machine = machine_with(settings, "login: ");
    machine.step([Input::Attach(LineId(2))], 0);
    assert_eq!(machine.terminal().text(), "login:");
    let asked = machine.step([Input::Bytes(LineId(2), b"\x1b[6n".to_vec())], 0);
    assert_eq!(asked, [HostOutput { line: LineId(2), bytes: b"\x1b[1;8R".to_vec(), messages: 1, lost: 0 }]);
    let typed = machine.step([Input::Event(Event::Type(b"x".to_vec()))], 0);
    assert_eq!(typed, [HostOutput { line: LineId(2), bytes: b"x".to_vec(), messages: 1, lost: 0 }]);
    machine.step([Input::Detach(LineId(2))], 0);
    let typed = machine.step([Input::Event(Event::Type(b"y".to_vec()))], 0);
    assert_eq!(typed, [HostOutput { line: LINE, bytes: b"y".to_vec(), messages: 1, lost: 0 }]);
    machine.step([Input::Detach(LINE)], 0);
    assert_eq!(machine.step([Input::Event(Event::Type(b"z".to_vec()))], 0), [], "nobody is there");
}

#[test]
fn packets_on_the_route_of_the_terminal_and_es_te_show_text() {
    let mut machine = told("SEND 'FROM THE NETWORK' TO <1>ES_TE;");
    let mut packet = Vec::new();
    write_packet(Route::Terminal, b"\r\nFROM A \x1b[1mPACKET", &mut packet).unwrap();
    machine.step([Input::Bytes(LINE, packet)], 0);
    assert_eq!(machine.terminal().text(), "FROM THE NETWORK\nFROM A PACKET");
}

#[test]
fn in_command_mode_lines_are_commands_and_errors_appear_on_the_terminal() {
    let mut machine = told("");
    press(&mut machine, "command");
    typed(&mut machine, "D := VECTOR_LISS\x7fT DOTS 0,0,0; DISPLAY D;\r");
    typed(&mut machine, "SEND 1 TO <1>NOWHERE;\rNONS");
    let expected = "@@ D := VECTOR_LIST DOTS 0,0,0; DISPLAY D;\n\
                    @@ SEND 1 TO <1>NOWHERE;\n\
                    E 2 *** Name not found: NOWHERE\n\
                    @@ NONS";
    assert_eq!(machine.terminal().text(), expected);
    machine.next_frame();
    assert_eq!(machine.latest_update().strokes.len(), 1, "the dot");
    tell(&mut machine, "SEND 1 TO <1>ELSEWHERE;");
    let expected = format!("{expected}\nE 2 *** Name not found: ELSEWHERE\n@@ NONS");
    assert_eq!(machine.terminal().text(), expected, "the line goes on below what came in between");
    let mut unfinished = told("SEND CHAR(27) TO <1>ES_TE;");
    press(&mut unfinished, "command");
    assert_eq!(unfinished.terminal().text(), "@@", "a sequence that is not finished takes nothing of the prompt");
    press(&mut machine, "local");
    assert_eq!(machine.keyboard_mode(), KeyboardMode::Interactive);
    tell(&mut machine, "SEND 1 TO <1>ELSEWHERE;");
    assert_eq!(machine.terminal().text(), expected, "errors show in command mode only");
}

#[test]
fn a_command_goes_over_several_lines_and_the_arrows_bring_lines_back() {
    let mut machine = told("");
    machine.event(Event::Mode(KeyboardMode::Command));
    typed(&mut machine, "SEND 'X'\rTO <1>DLABEL1;\r");
    assert_eq!(machine.panel().label(Label::Dial(1)), b"X");
    typed(&mut machine, "wrong\x15");
    for key in ["up", "up", "up", "down", "up"] {
        press(&mut machine, key);
    }
    assert!(machine.terminal().text().ends_with("@@ SEND 'X'"), "{}", machine.terminal().text());
    typed(&mut machine, "TO <1>DLABEL2;\r");
    assert_eq!(machine.panel().label(Label::Dial(2)), b"X");
    assert_eq!(machine.counters().messages, 0);
}

#[test]
fn the_set_up_page_takes_the_characters() {
    let mut machine = told("CONNECT KEYBOARD<1>:<1>HOST_MESSAGE;");
    press(&mut machine, "setup");
    assert_eq!(typed(&mut machine, "3"), "");
    assert!(machine.terminal().modes().local_echo && machine.terminal().in_setup());
    press(&mut machine, "setup");
    press(&mut machine, "host");
    assert_eq!(typed(&mut machine, "AB"), "AB");
    assert_eq!(machine.terminal().text(), "AB", "local echo");
}

#[test]
fn the_keys_graph_and_term_switch_what_is_seen() {
    let mut machine =
        told("D := VECTOR_LIST DOTS 0,0,0; DISPLAY D; SEND '-' TO <1>ES_TE; SEND '.' TO <1>MESSAGE_DISPLAY;");
    machine.next_frame();
    let strokes = |character| font::strokes(Font::Standard.glyph(character)).count();
    let (text, message) = (strokes(b'-'), strokes(b'.'));
    assert_eq!(machine.visible_strokes().len(), 1 + text + message);
    press(&mut machine, "term");
    machine.next_frame();
    assert_eq!(machine.visible_strokes().len(), 1 + message, "the message line stays");
    press(&mut machine, "graph");
    assert_eq!(machine.visible_strokes().len(), message);
    tell(&mut machine, "SEND FIX(0) TO <1>TURNONDISPLAY; SEND ' ' TO <1>MESSAGE_DISPLAY;");
    machine.next_frame();
    assert_eq!(machine.visible_strokes().len(), 1);
    assert!(machine.switches().ends_with("graphics on, text off"), "{}", machine.switches());
}

#[test]
fn the_default_cursor_follows_the_tablet_while_that_is_in_range() {
    let mut machine = told("");
    assert!(overlay(&mut machine).is_empty());
    moved(&mut machine, 0.5, -0.25);
    assert!(!machine.is_idle());
    let cross = ends(&overlay(&mut machine));
    assert_eq!(cross, [[0.46, -0.25, 0.54, -0.25], [0.5, -0.29, 0.5, -0.21]]);
    assert!(machine.is_idle());
    let updates = machine.counters().updates;
    moved(&mut machine, -0.5, 0.0);
    assert_eq!(ends(&overlay(&mut machine))[0], [-0.54, 0.0, -0.46, 0.0]);
    assert_eq!(machine.counters().updates, updates, "the structure is not walked for it");
    machine.event(Event::Tablet(TabletEvent::Away));
    assert!(overlay(&mut machine).is_empty());
}

#[test]
fn a_cursor_of_the_user_is_shown_without_display_and_connections() {
    let mut machine = told(
        "CURSOR := BEGIN_STRUCTURE BIG := SCALE BY 2; INSTANCE OF BCU; END_STRUCTURE;
         BCU := VECTOR_LIST ITEMIZED P -2,0 L 2,0;",
    );
    moved(&mut machine, 0.25, 0.5);
    assert_eq!(ends(&overlay(&mut machine)), [[-1.0, 0.5, 1.0, 0.5]], "clipped at the edges of the screen");
    tell(&mut machine, "SEND M3D(0.1,0,0 0,1,0 0,0,1) TO <1>CURSOR.BIG;");
    assert_eq!(ends(&overlay(&mut machine)), [[0.05, 0.5, 0.45, 0.5]]);
    for restore in ["DELETE CURSOR;", "INITIALIZE;", "INITIALIZE NAMES;"] {
        tell(&mut machine, "CURSOR := VECTOR_LIST DOTS 0,0;");
        assert_eq!(overlay(&mut machine).len(), 1);
        tell(&mut machine, restore);
        assert_eq!(overlay(&mut machine).len(), 2, "{restore} brings the cross back");
    }
    assert_eq!(machine.describe("CURSOR.BIG"), None);
    tell(&mut machine, "CURSOR := F:NOP; FORGET CURSOR;");
    assert_eq!(machine.log().filter(|l| l.starts_with("E 9")).count(), 2);
}

#[test]
fn the_pick_box_follows_the_tablet_also_after_initialize() {
    let mut machine = told("INITIALIZE; SEND V2D(0.02,0.03) TO <2>PICK_LOCATION;");
    let version = machine.memory.structures.version();
    moved(&mut machine, 0.5, 0.25);
    let id = machine.memory.objects.find("PICK_LOCATION").unwrap();
    let operation = crate::structure::Operation::PickLocation {
        center: glam::DVec2::new(0.5, 0.25),
        size: glam::DVec2::new(0.02, 0.03),
    };
    let expected = crate::structure::Node::operate(operation, None);
    assert_eq!(machine.memory.structures.node(id), Some(&expected));
    assert_eq!(machine.memory.structures.version(), version, "the picture does not depend on it");
    tell(&mut machine, "DISCONNECT TABLETIN<1>:<1>PICK_LOCATION; PICK_LOCATION := F:NOP;");
    moved(&mut machine, 0.0, 0.0);
    assert_eq!(machine.memory.structures.node(id), Some(&expected));
    assert_eq!(machine.log().count(), 1);
}

#[test]
fn a_static_screen_costs_nothing() {
    let mut machine = told("SEND 'A LINE' TO <1>MESSAGE_DISPLAY; SEND 'TEXT' TO <1>ES_TE;");
    moved(&mut machine, 0.0, 0.0);
    let drawn = overlay(&mut machine);
    for _ in 0..100 {
        machine.next_frame();
        assert!(machine.is_idle(), "nothing is to be drawn anew");
    }
    assert_eq!(machine.overlay(), drawn);
    assert_eq!(machine.counters().updates, 1);
    assert_eq!(machine.counters().strokes, 0, "counted are the strokes of the structure");
}

#[test]
fn blinking_text_comes_and_goes_twice_a_second_at_most() {
    let mut machine = told("");
    machine.show_text(None, b"\x1b[5m-");
    let seen: Vec<bool> = (0..120).map(|_| !overlay(&mut machine).is_empty()).collect();
    assert_eq!(seen.windows(2).filter(|pair| pair[0] != pair[1]).count(), 4);
    assert_eq!(seen.iter().filter(|seen| **seen).count(), 60);
}

#[test]
fn dials_obey_their_settings() {
    let mut machine = told(
        "P := F:PRINT; CONNECT DIALS<2>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE;
         SEND TRUE TO <1>DSET2; SEND FIX(20) TO <3>DSET2; SEND 1 TO <4>DSET2;",
    );
    for _ in 0..6 {
        machine.event(Event::Dial { dial: 2, turns: 0.25 });
        machine.next_frame();
    }
    let said: Vec<_> = std::iter::from_fn(|| machine.take_message()).collect();
    assert_eq!(said.iter().map(|m| String::from_utf8_lossy(m)).collect::<Vec<_>>(), ["1.75", "2.5"]);
}

#[test]
fn the_tablet_obeys_commands() {
    let mut machine =
        told("P := F:PRINT; CONNECT TABLETIN<1>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE; SEND 'D' TO <1>TABLETOUT;");
    moved(&mut machine, 0.5, 0.5);
    assert_eq!(machine.take_message(), None);
    tell(&mut machine, "SEND 'PP' TO <1>TABLETOUT;");
    assert_eq!(std::iter::from_fn(|| machine.take_message()).count(), 2);
}

#[test]
fn the_memory_monitor_speaks_at_once_and_then_in_its_interval() {
    let mut machine = told("CONNECT MEMORY_MONITOR<1>:<1>FLABEL0; CONNECT MEMORY_MONITOR<1>:<1>HOST_MESSAGE;");
    let spoken = |machine: &mut Machine| {
        (0..150).for_each(|_| machine.next_frame());
        std::iter::from_fn(|| machine.take_message()).count()
    };
    tell(&mut machine, "SEND FIX(1) TO <3>MEMORY_MONITOR;");
    let label = String::from_utf8_lossy(machine.panel().label(Label::Strip)).into_owned();
    assert!(
        label.starts_with("MEMORY") && label.contains(&format!("{} bytes in use", machine.counters().bytes)),
        "{label}"
    );
    assert_eq!(spoken(&mut machine), 3);
    tell(&mut machine, "SEND 0 TO <3>MEMORY_MONITOR;");
    assert_eq!(spoken(&mut machine), 1);
    assert_eq!(spoken(&mut machine), 0);
}

#[test]
fn the_memory_alert_speaks_once_when_its_limit_is_passed() {
    let mut machine = told("CONNECT MEMORY_ALERT<1>:<1>HOST_MESSAGE; CONNECT MEMALERT<1>:<1>HOST_MESSAGE;");
    let spoken = |machine: &mut Machine| {
        (0..3).for_each(|_| machine.next_frame());
        std::iter::from_fn(|| machine.take_message()).count()
    };
    assert_eq!(spoken(&mut machine), 0);
    tell(&mut machine, "SEND 0 TO <1>MEMORY_ALERT;");
    assert_eq!(spoken(&mut machine), 1);
    assert_eq!(spoken(&mut machine), 0);
    tell(&mut machine, "SEND 99 TO <1>MEMORY_ALERT;");
    assert_eq!(spoken(&mut machine), 0);
    tell(&mut machine, "SEND 0 TO <1>MEMORY_ALERT; SEND 0 TO <1>MEMALERT;");
    assert_eq!(spoken(&mut machine), 2);
}

#[test]
fn the_screen_is_blanked_when_nobody_is_there_and_wakes_when_somebody_is() {
    let mut machine = told("D := VECTOR_LIST DOTS 0,0,0; DISPLAY D; SEND 0.05 TO <2>SCREENSAVE;");
    let frames = |machine: &mut Machine, count| (0..count).for_each(|_| machine.next_frame());
    frames(&mut machine, 179);
    assert_eq!(machine.visible_strokes().len(), 1);
    frames(&mut machine, 1);
    assert!(machine.visible_strokes().is_empty() && machine.switches().contains("blanked"));
    machine.event(Event::Dial { dial: 1, turns: 0.1 });
    assert_eq!(machine.visible_strokes().len(), 1);
    frames(&mut machine, 180);
    assert!(machine.visible_strokes().is_empty());
    tell(&mut machine, "SEND TRUE TO <1>SCREENSAVE; SEND 0 TO <2>SCREENSAVE;");
    frames(&mut machine, 1000);
    assert_eq!(machine.visible_strokes().len(), 1, "0 minutes are never");
}

#[test]
fn characters_for_the_host_go_out_as_they_are_also_between_packets() {
    let mut machine = told("");
    assert_eq!(tell(&mut machine, "SEND 'RAW' TO <1>HOSTOUT;"), "RAW");
    let mut packet = Vec::new();
    protocol::wire::MessageForm::Packets.write_request(&mut packet);
    machine.step([Input::Bytes(LINE, packet)], 0);
    assert_eq!(tell(&mut machine, "SEND 'RAW' TO <1>HOSTOUT;"), "RAW");
    assert_eq!(machine.take_message(), None);
}

#[test]
fn the_colour_of_the_text_is_that_of_tecolor_while_the_colour_tube_is_on() {
    let mut machine = told("SEND '-' TO <1>ES_TE; SEND 240 TO <1>TECOLOR;");
    assert_eq!(overlay(&mut machine)[0].color, [0.0, 1.0, 0.0]);
    tell(&mut machine, "SEND FALSE TO <1>TSCSM;");
    assert_eq!(overlay(&mut machine)[0].color, [1.0; 3]);
    tell(&mut machine, "SEND TRUE TO <1>TSCSM; SEND 0 TO <2>TECOLOR; SEND 120 TO <1>TECOLOR;");
    assert_eq!(overlay(&mut machine)[0].color, [1.0; 3], "saturation 0");
}

#[test]
fn the_labels_of_the_keys_are_parts_of_one_strip() {
    let mut machine = told("SEND 'ONE' TO <1>FLABEL1; SEND 'TWO TOO LONG' TO <1>FLABEL2; SEND 'TURN' TO <1>DLABEL8;");
    let panel = machine.panel();
    assert_eq!((panel.label(Label::Key(1)), panel.label(Label::Key(2))), (&b"ONE"[..], &b"TWO TOO"[..]));
    assert_eq!(panel.label(Label::Strip), b"ONE     TWO TOO");
    assert!(panel.to_string().starts_with("dial 8: TURN\nkey 1: ONE\nkey 2: TWO TOO\nlights:"), "{panel}");
    tell(&mut machine, "SEND 'A WHOLE STRIP' TO <1>FLABEL0;");
    assert_eq!(machine.panel().label(Label::Key(2)), b"STRIP");
    assert!(machine.panel().to_string().contains("\nkeys: A WHOLE STRIP\n"));
    tell(
        &mut machine,
        "SEND TRUE TO <1>CLEAR_LABELS; SEND FIX(0) TO <1>ONBUTTONLIGHTS; SEND FIX(2) TO <1>OFFBUTTONLIGHTS;",
    );
    let panel = machine.panel();
    assert!(panel.label(Label::Strip).is_empty() && panel.label(Label::Dial(8)).is_empty());
    assert!(panel.light(1) && !panel.light(2) && panel.light(32) && !panel.light(33));
}

/// Anything that a person may do, sensible or not.
fn events() -> impl Strategy<Value = Event> {
    let number = prop_oneof![4 => -2.0..2.0, 1 => prop::num::f64::ANY];
    let keys: Vec<Key> = Key::names().filter_map(Key::named).collect();
    prop_oneof![
        (any::<u8>(), number.clone()).prop_map(|(dial, turns)| Event::Dial { dial, turns }),
        any::<u8>().prop_map(Event::Key),
        any::<u8>().prop_map(Event::Button),
        [number.clone(), number].prop_map(|at| Event::Tablet(TabletEvent::Move(at))),
        any::<u8>().prop_map(|code| Event::Tablet(TabletEvent::Press(code))),
        Just(Event::Tablet(TabletEvent::Release)),
        Just(Event::Tablet(TabletEvent::Away)),
        prop::collection::vec(any::<u8>(), 0..20).prop_map(Event::Type),
        Just(Event::Type(b"SEND 'x' TO <1>ES_TE; DELETE *;\r".to_vec())),
        prop::sample::select(keys).prop_map(Event::Press),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn whatever_a_person_does_the_machine_goes_on(events in prop::collection::vec(events(), 0..60)) {
        let mut machine = told("CONNECT TABLETIN<1>:<1>TABLETOUT; CONNECT KBHANDLER<4>:<1>ES_TE; SEND 'text' TO <1>DLABEL1;");
        for event in events {
            machine.event(event);
            machine.next_frame();
        }
        let on_screen = |s: &Stroke| s.start.iter().chain(&s.end).all(|c| c.abs() <= 1.0);
        prop_assert!(machine.visible_strokes().iter().all(on_screen));
        machine.event(Event::Mode(KeyboardMode::Interactive));
        tell(&mut machine, "SEND 'STILL HERE' TO <1>HOST_MESSAGE;");
        let mut said = std::iter::from_fn(|| machine.take_message());
        prop_assert!(said.any(|message| message == b"STILL HERE"));
    }
}

#[test]
fn initialize_does_without_arcs_whose_ends_were_made_something_else() {
    let mut machine = told("CONFIGURE ANY; TABLETIN := F:SEND; FINISH CONFIGURATION; INITIALIZE;");
    assert!(machine.describe("TABLETIN").is_some_and(|text| text.contains("F:SEND")));
    tell(&mut machine, "SEND 'HERE' TO <1>HOST_MESSAGE;");
    assert_eq!(machine.take_message().as_deref(), Some(b"HERE".as_slice()));
}
