//! Tests of lines with messages of their own.

use super::*;
use crate::line::LineId;
use protocol::wire::{MessageForm, MessageReader, Route, write_packet};
use std::collections::BTreeMap;

/// A machine and the readers of the hosts on lines 1, 2 and 3, of which 1 and 2 have messages of their own.
struct Room {
    machine: Machine,
    readers: BTreeMap<LineId, MessageReader>,
}

const ONE: LineId = LineId(1);
const TWO: LineId = LineId(2);
const SHARED: LineId = LineId(3);

impl Room {
    fn new() -> Room {
        let mut machine = Machine::new(Settings::default());
        machine.step([ONE, TWO, SHARED].map(Input::Attach), 0);
        let readers = [ONE, TWO, SHARED].map(|line| (line, MessageReader::default())).into();
        let mut room = Room { machine, readers };
        room.ask(ONE, MessageForm::Own);
        room.ask(TWO, MessageForm::Own);
        room
    }

    fn ask(&mut self, line: LineId, form: MessageForm) {
        let mut packet = Vec::new();
        form.write_request(&mut packet);
        self.readers.entry(line).or_default().expect(form);
        self.send(line, packet);
    }

    fn send(&mut self, line: LineId, bytes: impl Into<Vec<u8>>) {
        let outputs = self.machine.step([Input::Bytes(line, bytes.into())], 0);
        outputs.iter().for_each(|output| self.hear(output));
    }

    fn hear(&mut self, output: &HostOutput) {
        self.readers.get_mut(&output.line).expect("it is attached").push(&output.bytes);
    }

    fn frame(&mut self) {
        let until = time_of_frame(self.machine.frame() + 1);
        self.machine.step([], until).iter().for_each(|output| self.hear(output));
    }

    /// The messages and the reports that a line received since it was last asked.
    fn heard(&mut self, line: LineId) -> (Vec<String>, Vec<String>) {
        let reader = self.readers.get_mut(&line).expect("it is attached");
        let messages = reader.by_ref().map(|message| String::from_utf8_lossy(&message.expect("whole")).into_owned());
        let messages = messages.collect();
        (messages, std::iter::from_fn(|| reader.next_report()).collect())
    }

    #[track_caller]
    fn assert_heard(&mut self, line: LineId, messages: &[&str], reports: &[&str]) {
        let heard = self.heard(line);
        assert_eq!(heard.0, messages);
        let begins = heard.1.len() == reports.len() && heard.1.iter().zip(reports).all(|(is, b)| is.starts_with(b));
        assert!(begins, "{:?} should begin as {reports:?}", heard.1);
    }
}

#[test]
fn messages_go_to_the_line_whose_commands_led_them_there() {
    let mut room = Room::new();
    for (line, name) in [(ONE, "A"), (TWO, "B"), (SHARED, "C")] {
        room.send(line, format!("{name} := F:PRINT; CONNECT {name}<1>:<1>HOST_MESSAGE; SEND 'hello' TO <1>{name};"));
    }
    // Names are common: what one sends into the network of another comes out there.
    room.send(ONE, "SEND FIX(7) TO <1>B; SEND 'mine' TO <1>HOST_MESSAGEB; SEND 'by HOSTOUT' TO <1>HOSTOUT;");
    let (messages, reports) = room.heard(ONE);
    assert_eq!((messages.len(), &messages[..2], reports.len()), (2, &["hello".into(), "mine".into()][..], 0));
    room.assert_heard(TWO, &["hello", "7"], &[]);
    room.assert_heard(SHARED, &["hello"], &[]);
    room.send(TWO, "DISCONNECT B<1>:<1>HOST_MESSAGE; SEND FIX(8) TO <1>B;");
    room.assert_heard(TWO, &[], &[]);
}

#[test]
fn reports_about_commands_come_to_their_line_alone() {
    let mut room = Room::new();
    room.send(SHARED, "CONNECT ERROR<1>:<1>HOST_MESSAGE; CONNECT WARNING<1>:<1>HOST_MESSAGE;");
    room.send(ONE, "CONNECT ERROR<1>:<1>HOST_MESSAGE; ADD := F:ADD; SEND 'x' TO <1>NOBODY; ADD := F:ADD; DISPLAY;");
    room.assert_heard(ONE, &[], &["E 2", "W 3", "E 1"]);
    // A fault of a function while it works off a command, an answer, bytes that are no packet, a raster operation.
    room.send(ONE, "SEND 'x' TO <1>ADD; SEND 1 TO <2>ADD; COMMAND STATUS; SHOW INTERFACE;");
    let (messages, reports) = room.heard(ONE);
    assert!(messages.is_empty(), "{messages:?}");
    assert!(reports[0].starts_with("E 5") && reports.iter().skip(1).any(|report| report.starts_with("I 11")));
    room.send(ONE, b"\x1c\x01\x01".to_vec());
    room.assert_heard(ONE, &[], &["W 12"]);
    for line in [TWO, SHARED] {
        room.assert_heard(line, &[], &[]);
    }
    // The error of a line without messages of its own leaves ERROR, to whoever connected it.
    room.send(SHARED, "SEND 'x' TO <1>NOBODY;");
    assert_eq!(room.heard(SHARED).0.len(), 1);
    assert_eq!(room.heard(ONE).0.len(), 1);
    room.assert_heard(TWO, &[], &[]);
}

#[test]
fn what_functions_do_later_is_nobodys_command() {
    let mut room = Room::new();
    room.send(SHARED, "CONNECT ERROR<1>:<1>HOST_MESSAGE;");
    room.send(
        ONE,
        "P := F:PRINT; R := F:ROUTE(2); CONNECT DIALS<1>:<1>R; SEND 1 TO <2>R; CONNECT P<1>:<1>HOST_MESSAGE;",
    );
    room.machine.event(Event::Dial { dial: 1, turns: 0.5 });
    room.frame();
    let heard = room.heard(SHARED).0;
    assert!(heard.len() == 1 && heard[0].starts_with("E "), "{heard:?}");
    room.assert_heard(ONE, &[], &[]);
    // What a function that interprets commands causes is reported to no line alone.
    room.send(ONE, "CI := F:CI; SEND 'SEND ''to all'' TO <1>HOST_MESSAGE; NONSENSE;' TO <1>CI;");
    let heard = room.heard(SHARED).0;
    assert!(heard.len() == 2 && heard[0] == "to all" && heard[1].starts_with("E 1"), "{heard:?}");
    room.assert_heard(ONE, &[], &[]);
}

#[test]
fn packets_for_channels_leave_the_channel_of_the_line() {
    let mut room = Room::new();
    room.send(SHARED, "CONNECT CHANNEL3<1>:<1>HOST_MESSAGE;");
    room.send(ONE, "CONNECT CHANNEL3<1>:<1>HOST_MESSAGE;");
    room.send(TWO, "CONNECT CHANNEL3<1>:<1>HOST_MESSAGE;");
    for (line, text) in [(ONE, "one"), (TWO, "two"), (SHARED, "three")] {
        let mut packet = Vec::new();
        write_packet(Route::Channel(3), text.as_bytes(), &mut packet).expect("it is short");
        room.send(line, packet);
    }
    room.assert_heard(ONE, &["one"], &[]);
    room.assert_heard(TWO, &["two"], &[]);
    room.assert_heard(SHARED, &["three"], &[]);
}

#[test]
fn instances_of_a_line_outlive_initialize_and_reboot_and_go_with_the_wish() {
    let mut room = Room::new();
    let objects = room.machine.counters().objects;
    for command in ["INITIALIZE;", "REBOOT ANY;"] {
        room.send(ONE, "P := F:PRINT; CONNECT P<1>:<1>HOST_MESSAGE;");
        room.send(TWO, command);
        room.heard(ONE);
        room.heard(TWO);
        assert_eq!(room.machine.counters().objects, objects, "{command}");
        room.send(ONE, "P := F:PRINT; SEND 'lost' TO <1>P; SEND 'kept' TO <1>HOST_MESSAGE;");
        room.assert_heard(ONE, &["kept"], &[]);
        room.machine.audit().expect("the books agree");
    }
    room.send(ONE, "CONNECT P<1>:<1>HOST_MESSAGE;");
    room.ask(ONE, MessageForm::Packets);
    let own = objects - room.machine.counters().objects;
    assert_eq!(own, 7, "and P is one more");
    room.send(ONE, "SEND 'gone' TO <1>P; SEND 'to all' TO <1>HOST_MESSAGE; NONSENSE;");
    room.assert_heard(ONE, &["to all"], &[]);
    room.assert_heard(SHARED, &["to all"], &[]);
    room.assert_heard(TWO, &[], &[]);
    room.machine.step([Input::Bytes(TWO, b"S := BEGIN_STRUCTURE".to_vec()), Input::Detach(TWO)], 0);
    assert_eq!(room.machine.counters().objects, objects + 1 - 2 * 8);
    room.machine.audit().expect("the books agree");
}

#[test]
fn an_instance_of_a_line_is_called_by_its_name_and_its_line() {
    let mut room = Room::new();
    room.send(ONE, "SEND 1 TO <2>HOST_MESSAGE; A := F:PRINT; CONNECT A<1>:<1>HOST_MESSAGE;");
    let reports = room.heard(ONE).1;
    assert!(reports.len() == 1 && reports[0].contains("HOST_MESSAGE of line 1"), "{reports:?}");
    room.send(SHARED, "SETUP CNESS TRUE <1>HOST_MESSAGE;");
    room.send(ONE, "SEND 'still here' TO <1>A;");
    room.assert_heard(ONE, &["still here"], &[]);
}

#[test]
fn many_errors_of_a_line_with_its_own_do_not_silence_those_of_others() {
    let mut room = Room::new();
    room.send(SHARED, "CONNECT ERROR<1>:<1>HOST_MESSAGE;");
    let wrong = "SEND 0 TO <1>NOBODY;".repeat(2 * REPORTS_PER_FRAME as usize);
    room.send(ONE, wrong);
    assert_eq!(room.heard(ONE).1.len(), 2 * REPORTS_PER_FRAME as usize);
    room.send(SHARED, "SEND 0 TO <1>NOBODY;");
    let (messages, reports) = room.heard(SHARED);
    assert!(
        messages.len() == 1 && messages[0].contains("Name not found: NOBODY") && reports.is_empty(),
        "{messages:?}"
    );
    // Those that reach ERROR are limited all the same.
    room.send(SHARED, "SEND 0 TO <1>NOBODY;".repeat(2 * REPORTS_PER_FRAME as usize));
    assert_eq!(room.heard(SHARED).0.len(), REPORTS_PER_FRAME as usize - 1);
    room.frame();
    room.send(SHARED, "SEND 0 TO <1>NOBODY;");
    assert_eq!(room.heard(SHARED).0.len(), 1);
}
