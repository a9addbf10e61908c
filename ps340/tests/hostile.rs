//! Random and mutated streams never stop the machine. `PERIS_LONG=1` tries a million of them.

use proptest::prelude::*;
use protocol::command::{Command, print, strategy};
use protocol::parallel;
use protocol::wire::{DataForm, PacketForm, Route, Sending, write_commands_as, write_packet, write_packet_as};
use ps340::{
    line::LineId,
    machine::{Input, Machine, Settings},
};

const LINE: LineId = LineId(1);
/// A host on the parallel interface, which receives the same.
const PARALLEL: LineId = LineId(3);

/// Streams tried in an ordinary run.
const CASES: u32 = 1_500;
/// Streams tried in the long lane.
const LONG_CASES: u32 = 1_000_000;

fn config() -> ProptestConfig {
    let long = std::env::var("PERIS_LONG").is_ok_and(|value| value == "1");
    ProptestConfig {
        cases: if long { LONG_CASES } else { CASES },
        max_shrink_iters: 2_000,
        ..ProptestConfig::default()
    }
}

/// A stream of text, packets, fragments of the language, and plain noise.
fn streams() -> impl Strategy<Value = Vec<u8>> {
    let text = prop::collection::vec(strategy::commands(), 1..6).prop_map(|commands: Vec<Command>| {
        let mut out = Vec::new();
        commands.iter().for_each(|c| print(c, &mut out));
        out
    });
    let data = prop::sample::select(DataForm::ALL.to_vec());
    let sending = (prop::sample::select(PacketForm::ALL.to_vec()), data);
    let binary = (prop::collection::vec(strategy::commands(), 1..6), sending);
    let binary = binary.prop_map(|(commands, (packets, data)): (Vec<Command>, _)| {
        let mut out = Vec::new();
        let _ = write_commands_as(Sending { packets: packets.0, data: data.0 }, &commands, &mut out);
        out
    });
    let forms = prop::sample::select(PacketForm::ALL.to_vec());
    let packet = (prop_oneof![any::<u8>(), b'0'..=b'?'], prop::collection::vec(any::<u8>(), 0..200), forms);
    let packet = packet.prop_map(|(route, data, form)| {
        let mut out = Vec::new();
        let _ = write_packet_as(form.0, Route::from(route), &data, &mut out);
        out
    });
    let words = (prop::collection::vec((0..16_u16, any::<bool>()), 1..8), prop::collection::vec(any::<u8>(), 0..40));
    let parallel = words.prop_map(|(words, block)| {
        let mut out = Vec::new();
        for (word, is_code) in words {
            parallel::write_word(if is_code { word << 12 } else { word }, &mut out);
        }
        parallel::write_block(&block, &mut out);
        out
    });
    let raster = prop::collection::vec(any::<u8>(), 0..64).prop_map(|data| {
        let mut out = Vec::new();
        let _ = write_packet(Route::Raster, &data, &mut out);
        out
    });
    let words = prop::sample::select(vec![
        "A := F:ADD;",
        "B := F:ROUTE(3);",
        "CONNECT A<1>:<1>A;",
        "CONNECT A<1>:<2>A;",
        "SEND 1E38 TO <1>A;",
        "CONNECT ERROR<1>:<1>A;",
        "CONNECT WARNING<1>:<1>HOST_MESSAGE;",
        "A := BEGIN_STRUCTURE",
        "END_STRUCTURE;",
        "INCLUDE A IN A;",
        "DISPLAY A;",
        "DELETE *;",
        "INITIALIZE;",
        "SEND V3D(1,2,3) TO <append>V;",
        "V := VECTOR_LIST N=5 0,0 1,1;",
        "X := F:XFORMDATA; SEND 'A' TO <2>X; SEND TRUE TO <1>X;",
        "'",
        "{",
        ";",
        "C := F:CLFRAMES; SEND FIX(1) TO <1>C; SEND TRUE TO <3>C; SEND TRUE TO <4>C; CONNECT C<1>:<1>C;",
        "M := MATRIX_4X4 0,0,0,0 0,0,0,0 0,0,0,0 0,0,0,0 THEN V;",
        "FORGET A;",
        "C := F:CI; SEND 'DELETE C; C := F:CI; SEND ''X'' TO <1>C;' TO <1>C;",
        "K := F:CONSTANT; C := F:CI; CONNECT K<1>:<1>C; SEND 'SEND 1 TO <1>K;' TO <2>K; SEND 1 TO <1>K;",
        "D := F:DEPACKET; G := F:GATHER_STRING; CONNECT ERROR<1>:<1>D; CONNECT D<2>:<1>G; DELETE G; G := F:LINEEDITOR;",
        "S := F:SEND; SEND 'S' TO <2>S; SEND FIX(1) TO <3>S; SEND TRUE TO <1>S;",
        "W := F:WRITEDISK; SEND 'A' TO <2>W; SEND TRUE TO <3>W; CONNECT ERROR<1>:<1>W;",
        "DIALS := NIL;",
    ]);
    let words = prop::collection::vec(words, 1..12).prop_map(|w| w.join(" ").into_bytes());
    let noise = prop::collection::vec(any::<u8>(), 0..300);
    let piece = prop_oneof![text, binary, packet, raster, words, parallel, noise];
    prop::collection::vec(piece, 1..5).prop_map(|pieces| pieces.concat())
}

/// Bytes that are changed, put in or taken out.
fn mutations() -> impl Strategy<Value = Vec<(prop::sample::Index, u8, u8)>> {
    prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 0..8)
}

fn mutate(stream: &mut Vec<u8>, mutations: &[(prop::sample::Index, u8, u8)]) {
    for (at, byte, how) in mutations {
        if stream.is_empty() {
            return;
        }
        let at = at.index(stream.len());
        match how {
            0 => stream[at] = *byte,
            1 => stream.insert(at, *byte),
            _ => drop(stream.remove(at)),
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn no_stream_stops_the_machine(mut stream in streams(), changes in mutations(), piece in 1_usize..400) {
        mutate(&mut stream, &changes);
        let mut machine = Machine::new(Settings::default());
        machine.step([Input::Attach(LINE), Input::AttachParallel(PARALLEL)], 0);
        let mut attach = Vec::new();
        parallel::write_word(parallel::Code::Attach as u16, &mut attach);
        machine.step([Input::Bytes(PARALLEL, attach)], 0);
        for bytes in stream.chunks(piece) {
            machine.step([Input::Bytes(LINE, bytes.to_vec()), Input::Bytes(PARALLEL, bytes.to_vec())], 0);
            machine.next_frame();
        }
        // Another host is served, whatever the first one left.
        machine.step([Input::Attach(LineId(2)), Input::Detach(PARALLEL)], 0);
        let mark = b"\nMARK := F:NOP; CONNECT MARK<1>:<1>HOST_MESSAGE; SEND 'ALIVE' TO <1>MARK;".to_vec();
        let mut answers = machine.step([Input::Bytes(LineId(2), mark)], 0);
        for _ in 0..3 {
            machine.next_frame();
            answers.extend(machine.step([], 0));
        }
        let served = answers.iter().any(|o| o.line == LineId(2) && o.bytes.windows(5).any(|w| w == b"ALIVE"));
        prop_assert!(served || !machine.is_idle(), "{:?}", machine.log().collect::<Vec<_>>());
        let drawn = machine.latest_update().strokes.iter();
        for stroke in drawn {
            let numbers = stroke.start.iter().chain(&stroke.end).chain(&stroke.intensity).chain(&stroke.color);
            prop_assert!(numbers.clone().all(|x| x.is_finite()), "{stroke:?}");
        }
    }
}
