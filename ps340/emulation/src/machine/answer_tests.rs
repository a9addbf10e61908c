//! Tests of what functions ask of the machine: names, files, picks, transformed data, interpreters.

use super::*;
use crate::line::LineId;
use crate::{
    functions::find,
    network::Network,
    port::{Effect, ObjectId},
};
use protocol::{
    Value,
    command::{Input as Place, encode},
};

const LINE: LineId = LineId(1);

/// A machine with one host, which has carried out all that it received.
fn told(text: &str) -> Machine {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    tell(&mut machine, text);
    machine
}

fn tell(machine: &mut Machine, text: &str) {
    machine.step([Input::Bytes(LINE, text.as_bytes().to_vec())], 0);
}

/// What the host was sent since it was last asked.
fn said(machine: &mut Machine) -> Vec<String> {
    std::iter::from_fn(|| machine.take_message()).map(|m| String::from_utf8_lossy(&m).into_owned()).collect()
}

fn errors(machine: &Machine) -> Vec<&str> {
    machine.log().filter(|l| l.starts_with('E')).collect()
}

#[test]
fn a_message_goes_where_a_string_says() {
    let mut machine = told(
        "S := F:SEND; A := F:ADD; P := F:PRINT; CONNECT A<1>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE;
         SEND 1 TO <1>S; SEND 'A' TO <2>S; SEND FIX(1) TO <3>S;
         SEND 2 TO <1>S; SEND 'a ' TO <2>S; SEND FIX(2) TO <3>S;",
    );
    assert_eq!(said(&mut machine), ["3"]);
    tell(&mut machine, "SEND 1 TO <1>S; SEND 'NOWHERE' TO <2>S; SEND FIX(1) TO <3>S;");
    tell(&mut machine, "V := VECTOR_LIST DOTS 0,0,0; SEND 1 TO <1>S; SEND 'V' TO <2>S; SEND FIX(-1) TO <3>S;");
    let errors = errors(&machine);
    assert_eq!(errors.len(), 2, "{errors:?}");
    assert_eq!(errors[0], "E 2 *** Name not found: NOWHERE");
    assert!(errors[1].contains("<delete>V"), "{errors:?}");
}

#[test]
fn files_of_the_disk_are_written_grow_and_are_read() {
    let mut machine = told(
        "W := F:WRITEDISK; R := F:READDISK; CONNECT R<1>:<1>HOST_MESSAGE; SEND 'site.dat' TO <2>W;
         SEND 'ONE' TO <1>W; SEND TRUE TO <3>W; SEND ' TWO' TO <1>W; SEND 'SITE.DAT' TO <1>R;",
    );
    assert_eq!(said(&mut machine), ["ONE TWO"]);
    tell(&mut machine, "SEND 'OTHER' TO <1>R;");
    assert_eq!(errors(&machine), ["E 2 *** File not found: OTHER"]);
    assert_eq!(machine.disk().files().count(), 1);
}

#[test]
fn a_long_file_leaves_in_several_messages() {
    let mut machine = told("R := F:READDISK; L := F:LENGTH_STRING; P := F:PRINT;");
    let name = crate::port::FileName::new(b"LONG").unwrap();
    machine.disk_mut().write(name, &[b'X'; 2 * protocol::value::MAX_STRING + 1], false).unwrap();
    tell(&mut machine, "CONNECT R<1>:<1>L; CONNECT L<1>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE; SEND 'LONG' TO <1>R;");
    assert_eq!(said(&mut machine), ["65535", "65535", "1"]);
}

#[test]
fn a_pick_in_which_nothing_is_hit_says_false() {
    let mut machine =
        told("P := F:PRINT; CONNECT PICK<2>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE; SEND V2D(0,0) TO <1>PICK;");
    for _ in 0..3 {
        machine.next_frame();
    }
    assert_eq!(said(&mut machine), ["FALSE"]);
    assert!(errors(&machine).is_empty());
}

#[test]
fn transformed_data_becomes_an_object_with_the_name_that_was_asked_for() {
    let mut machine = told(
        "S := BEGIN_STRUCTURE SCALE BY 2,3,4; X := XFORM MATRIX; VECTOR_LIST DOTS 0,0,0; END_STRUCTURE; DISPLAY S;
         F := F:XFORMDATA; SEND 'S.X' TO <2>F; SEND 'COPY' TO <3>F; SEND TRUE TO <1>F;",
    );
    machine.next_frame();
    assert_eq!(machine.describe("COPY").as_deref(), Some("COPY := MATRIX_4X4 2,0,0,0  0,3,0,0  0,0,4,0  0,0,0,1"));
    assert!(errors(&machine).is_empty(), "{:?}", errors(&machine));
}

#[test]
fn a_part_of_transformed_vectors_is_given_and_becomes_a_vector_list() {
    let mut machine = told(
        "L := F:LIST; F := F:XFORMDATA; CONNECT F<1>:<1>L; CONNECT L<1>:<1>HOST_MESSAGE;
         S := BEGIN_STRUCTURE SCALE BY 0.5; X := XFORM VECTOR; VECTOR_LIST 1,0,0 2,0,0 4,0,0 8,0,0; END_STRUCTURE;
         DISPLAY S; SEND 'S.X' TO <2>F; SEND 'V' TO <3>F; SEND FIX(2) TO <4>F; SEND FIX(2) TO <5>F; SEND 1 TO <1>F;",
    );
    machine.next_frame();
    assert_eq!(said(&mut machine), ["VECTOR_LIST ITEMIZED N=2", "P 1,0,0", "L 2,0,0;"]);
    assert_eq!(machine.describe("V").as_deref(), Some("V := VECTOR_LIST Itemized, 2 vectors"));
}

#[test]
fn requests_beyond_the_patience_of_the_machine_are_lost_with_a_warning() {
    let mut machine = told("F := F:XFORMDATA; SEND 'X' TO <2>F;");
    for _ in 0..1_001 {
        tell(&mut machine, "SEND 1 TO <1>F;");
    }
    let warnings: Vec<_> = machine.log().filter(|line| line.starts_with('W')).collect();
    assert_eq!(warnings, ["W 12 *** Queue full at <1>F: 1 messages lost"]);
}

#[test]
fn an_interpreter_carries_out_commands_that_come_in_pieces() {
    let mut machine = told("C := F:CI(1); P := F:PRINT; CONNECT C<1>:<1>P; CONNECT P<1>:<1>HOST_MESSAGE;");
    tell(&mut machine, "SEND 'A := F:NOP; SEND ''X'' TO <1>MESSAGE_' TO <1>C; SEND 'DISPLAY; NONSENSE;' TO <1>C;");
    assert_eq!(said(&mut machine), ["1", "1"]);
    assert_eq!(machine.panel().message(), b"X");
    assert_eq!(machine.describe("A").as_deref(), Some("A := F:NOP"));
    assert_eq!(errors(&machine).len(), 1);
}

#[test]
fn an_interpreter_that_is_instanced_anew_has_forgotten_what_was_open() {
    let mut machine = told("C := F:CI; SEND 'A := BEGIN_STRUCTURE ' TO <1>C; SEND 'X := ' TO <1>C;");
    tell(&mut machine, "C := F:CI; SEND 'B := VECTOR_LIST DOTS 0,0,0;' TO <1>C;");
    assert!(machine.describe("B").is_some_and(|text| text.contains("VECTOR_LIST")));
    assert!(errors(&machine).is_empty(), "{:?}", errors(&machine));
    tell(&mut machine, "DELETE C; C := F:READSTREAM; SEND 'X' TO <1>C;");
    assert_eq!(errors(&machine).len(), 1);
}

#[test]
fn binary_commands_and_packets_reach_their_interpreters() {
    let mut machine = told(
        "D := F:DEPACKET; R := F:CIROUTE(3); C := F:CI; B := F:READSTREAM;
         CONNECT D<1>:<1>R; CONNECT D<2>:<2>R; CONNECT R<1>:<1>ES_TE; CONNECT R<2>:<1>C; CONNECT R<3>:<1>B;",
    );
    let mut records = Vec::new();
    let mut reader = protocol::command::CommandReader::default();
    reader.push(b"SEND 'Y' TO <1>DLABEL2;");
    encode(&reader.next().unwrap().unwrap().command, &mut records).unwrap();
    let mut stream = b"TYPED".to_vec();
    for (route, data) in
        [(protocol::wire::Route::Text, &b"SEND 'X' TO <1>DLABEL1;"[..]), (protocol::wire::Route::Binary, &records)]
    {
        protocol::wire::write_count_packet(route, data, &mut stream).unwrap();
    }
    let to = machine.memory.objects.find("D").unwrap();
    for byte in stream {
        let value = Value::string([byte]);
        machine.memory.network.send(to, Place::Number(1), value, &mut machine.memory.effects);
    }
    machine.next_frame();
    assert_eq!(machine.panel().label(crate::port::Label::Dial(1)), b"X");
    assert_eq!(machine.panel().label(crate::port::Label::Dial(2)), b"Y");
    assert_eq!(machine.terminal().text().trim_end(), "TYPED");
    assert!(errors(&machine).is_empty(), "{:?}", errors(&machine));
}

#[test]
fn commands_that_cause_themselves_stop_neither_frames_nor_lines() {
    let mut machine =
        told("K := F:CONSTANT; C := F:CI; CONNECT K<1>:<1>C; SEND 'SEND TRUE TO <1>K;' TO <2>K; SEND TRUE TO <1>K;");
    for _ in 0..2 {
        machine.next_frame();
    }
    assert!(!machine.is_idle());
    tell(&mut machine, "DELETE K; SEND 'STILL HERE' TO <1>HOST_MESSAGE;");
    machine.next_frame();
    assert_eq!(said(&mut machine), ["STILL HERE"]);
    machine.next_frame();
    assert!(machine.network_rests());
}

#[test]
fn what_no_interpreter_can_keep_up_with_is_lost_and_counted() {
    // Each message becomes two, so the interpreter lags at once.
    let mut machine = told(
        "K := F:CONSTANT; C := F:CI; CONNECT K<1>:<1>C; SEND 'SEND 1 TO <1>K; SEND 1 TO <1>K; {                  }' TO <2>K;
         SEND TRUE TO <1>K;",
    );
    let mut frames = 0;
    while !machine.log().any(|line| line.starts_with("W 12")) {
        machine.next_frame();
        frames += 1;
        assert!(frames < 40, "{:?}", machine.log().last());
    }
}

#[test]
fn a_variable_or_label_that_is_not_there_is_an_error() {
    let mut machine = told("F := F:FETCH; SEND 'ANGLE' TO <2>F; SEND TRUE TO <1>F;");
    tell(&mut machine, "L := F:LBL_EXTRACT; SEND 'ATOMS' TO <2>L; SEND FIX(1) TO <1>L;");
    assert_eq!(errors(&machine), ["E 2 *** Name not found: ANGLE", "E 2 *** Name not found: ATOMS"]);
}

#[test]
fn code_of_the_user_is_refused_in_words() {
    let machine = told("G := F:GATHER_GENFCN; SEND 'S9030000FC' TO <1>G;");
    assert_eq!(errors(&machine), ["E 10 *** G: functions of the user are code for another processor"]);
}

#[test]
fn a_time_out_speaks_once_when_nothing_came_for_a_while() {
    let mut machine = told(
        "T := F:TIMEOUT; CONNECT T<1>:<1>HOST_MESSAGE; SEND FIX(50) TO <2>T; SEND 'LATE' TO <3>T; SEND TRUE TO <1>T;",
    );
    let wait = |machine: &mut Machine, frames: usize| (0..frames).for_each(|_| machine.next_frame());
    wait(&mut machine, 29);
    tell(&mut machine, "SEND TRUE TO <1>T;");
    wait(&mut machine, 29);
    assert!(said(&mut machine).is_empty(), "each message starts the time anew");
    wait(&mut machine, 3);
    assert_eq!(said(&mut machine), ["LATE"]);
    wait(&mut machine, 200);
    assert!(said(&mut machine).is_empty());
}

#[test]
fn what_is_packed_is_unpacked_wherever_the_stream_is_cut() {
    let data: Vec<u8> = (0..10_000_u32).map(|i| ((i * 7919) >> 3) as u8).collect();
    for piece in [1, 2, 7, 4096, 20_000] {
        let mut network = Network::new();
        let mut effects = Vec::new();
        let [packer, cutter, unpacker, sink] = [0, 1, 2, 3].map(ObjectId);
        network.define(packer, find("PACKET").unwrap(), None).unwrap();
        network.define(unpacker, find("DEPACKET").unwrap(), None).unwrap();
        network.connect(packer, 1, cutter, Place::Number(1)).unwrap();
        network.connect(unpacker, 1, sink, Place::Number(1)).unwrap();
        network.connect(unpacker, 2, sink, Place::Number(2)).unwrap();
        network.send(packer, Place::Number(2), Value::string("5"), &mut effects);
        network.send(packer, Place::Number(1), Value::string(&data), &mut effects);
        network.run(1_000_000, &mut effects);
        let mut line = b"before".to_vec();
        for effect in effects.drain(..) {
            let Effect::Deliver { value: Value::String(packet), .. } = effect else { panic!("{effect:?}") };
            line.extend_from_slice(&packet);
        }
        for bytes in line.chunks(piece) {
            network.send(unpacker, Place::Number(1), Value::string(bytes), &mut effects);
            network.run(1_000_000, &mut effects);
        }
        let (mut back, mut text) = (Vec::new(), Vec::new());
        for effect in effects {
            match effect {
                Effect::Deliver { input: Place::Number(1), value: Value::String(packet), .. } => {
                    assert_eq!(packet[0], b'5');
                    back.extend_from_slice(&packet[1..]);
                }
                Effect::Deliver { value: Value::String(outside), .. } => text.extend_from_slice(&outside),
                other => panic!("{other:?}"),
            }
        }
        assert!(back == data && text == b"before", "in pieces of {piece}");
    }
}

#[test]
fn a_command_that_never_ends_is_told_when_the_line_closes() {
    let mut machine = told("A := NIL; SEND 'it''s TO <1>MESSAGE_DISPLAY;\n");
    machine.step([Input::Detach(LINE)], 0);
    let expected = "E 4 *** the line closed while the command 'SEND \\'it\\'\\'s TO <1>MESSAGE_DISPLAY;' was open";
    assert_eq!(errors(&machine), [expected]);
    machine.step([Input::Attach(LineId(2)), Input::Bytes(LineId(2), b"DISPLAY A; \n { done }".to_vec())], 0);
    machine.step([Input::Detach(LineId(2))], 0);
    assert_eq!(errors(&machine).len(), 1, "blanks and comments begin nothing");
}

#[test]
fn initialize_forgets_what_waits_for_an_update() {
    let mut machine = told("SEND FIX(1000000) TO <3>PICK; SEND V2D(0.9,0.9) TO <1>PICK;");
    machine.next_frame();
    assert!(!machine.is_idle());
    tell(&mut machine, "INITIALIZE;");
    machine.next_frame();
    assert!(machine.is_idle());
}

#[test]
fn what_contains_itself_is_told_again_after_initialize() {
    let text = "A := INSTANCE OF A; DISPLAY A;";
    let mut machine = told(text);
    machine.next_frame();
    assert_eq!(errors(&machine).len(), 1);
    machine.next_frame();
    assert_eq!(errors(&machine).len(), 1, "once is enough");
    tell(&mut machine, &format!("INITIALIZE; {text}"));
    machine.next_frame();
    assert_eq!(errors(&machine).len(), 2);
}

#[test]
fn a_host_does_not_silence_the_system() {
    let mut machine = told("SETUP CNESS TRUE <1>HOST_MESSAGE; SEND 'HERE' TO <1>HOST_MESSAGE;");
    assert_eq!(said(&mut machine), ["HERE"]);
    assert_eq!(errors(&machine), ["E 9 *** HOST_MESSAGE belongs to the system"]);
    tell(&mut machine, "P := F:ADD; SETUP CNESS TRUE <2>P; CONNECT P<1>:<1>DLABEL1; SEND 2 TO <2>P; SEND 1 TO <1>P;");
    assert_eq!(machine.panel().label(crate::port::Label::Dial(1)), b"3");
}
