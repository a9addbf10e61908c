//! The dumps in `PROTOCOL.md` are what the code produces.
//!
//! A dump stands after a comment that names it. To write them anew: `PROTOCOL_DOCUMENT=write cargo test -p protocol`.

use protocol::{
    command::{Command, binary::Opcode, parse},
    listing::{Listing, Sender},
    raster::{LookupEntry, RasterCommand, RasterOpcode, Run},
    wire::{
        DataForm, MessageForm, MessageWriter, PacketForm, Route, Sending, write_commands, write_commands_as,
        write_count_packet, write_escape_packet, write_packet, write_raster,
    },
};
use std::{fs, path::PathBuf};

const MARK: &str = "<!-- dump: ";

/// The stream of a dump that is made of commands as binary packets: its name and the commands.
const COMMANDS: &[(&str, &[&str])] = &[
    (
        "structure",
        &[
            "A := NIL",
            "B := BEGIN_STRUCTURE",
            "END_STRUCTURE",
            "I := INSTANCE OF A, B",
            "C := CHARACTERS 0,1 STEP 1,0 'Hi'",
            "R := F:ROUTE(2)",
        ],
    ),
    ("vectors", &["V := VECTOR_LIST ITEMIZED N=3 P 0,0,0 L 1,0,0 L 1,1,0 I=0.5"]),
    ("transformations", &["R := ROTATE IN X 30 APPLIED TO A", "SCALE BY 2", "TRANSLATE BY 1,2,3"]),
    (
        "matrices",
        &[
            "MATRIX_2X2 1,0 0,1",
            "MATRIX_3X3 1,0,0 0,1,0 0,0,1",
            "MATRIX_4X3 1,0,0 0,1,0 0,0,1 5,6,7",
            "MATRIX_4X4 1,0,0,0 0,1,0,0 0,0,1,0 0,0,0,1",
        ],
    ),
    (
        "viewing",
        &[
            "LOOK AT 0,0,0 FROM 0,0,-10",
            "WINDOW X=-1:1 Y=-1:1",
            "FIELD_OF_VIEW 30 FRONT=6 BACK=14",
            "VIEWPORT HORIZONTAL=-1:1 VERTICAL=-1:1 INTENSITY=0.5:1",
        ],
    ),
    ("attributes", &["SET COLOR 180,1", "SET INTENSITY ON 0:1", "SET DEPTH_CLIPPING OFF", "XFORM MATRIX"]),
    (
        "display",
        &[
            "DISPLAY A",
            "REMOVE A",
            "INCLUDE A IN I",
            "REMOVE A FROM I",
            "DELETE A, T*",
            "FORGET A",
            "INITIALIZE DISPLAYS",
        ],
    ),
    ("network", &["CONNECT DIALS<1>:<1>R", "DISCONNECT R<1>:<append>V", "DISCONNECT R:ALL"]),
    (
        "values",
        &[
            "SEND TRUE TO <1>A",
            "SEND FIX(-1) TO <2>A",
            "SEND 0.5 TO <last>A",
            "SEND 'ROT X' TO <1>DLABEL1",
            "SEND V2D(1,2) TO <1>A",
            "SEND V3D(1,2,3) TO <1>A",
            "SEND V4D(1,2,3,4) TO <1>A",
            "SEND M2D(1,2 3,4) TO <1>A",
        ],
    ),
    ("commands as text", &["I := IF PHASE IS ON THEN A", "SET PICKING ON", "SEND 3*L TO <2>V"]),
];

/// The bytes that a dump shows.
fn stream(name: &str) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    match name {
        "text" => out.extend_from_slice(b"DISPLAY WORLD;\r\n"),
        "count packet" => write_count_packet(Route::Text, b"REMOVE A;", &mut out).expect("it is short"),
        "long packet" => write_packet(Route::Text, b"REMOVE A;", &mut out).expect("it is short"),
        "escape packet" => {
            write_escape_packet(Route::Text, b"REMOVE A;\x16", &mut out).expect("it is short");
            write_commands_as(
                Sending { packets: PacketForm::Escape, data: DataForm::EightBit },
                [&parse(b"SEND FIX(22) TO <1>A;").expect("it is a command")],
                &mut out,
            )
            .expect("it is short");
        }
        "6-bit" => {
            let sending = Sending { packets: PacketForm::Count, data: DataForm::SixBit };
            let commands = ["DISPLAY A;", "SEND 0.5 TO <1>B;"].map(|text| parse(text.as_bytes()).expect(text));
            write_commands_as(sending, &commands, &mut out).expect("they are short");
        }
        "messages as text" => {
            MessageWriter::default().write(b"1V 0.25,-0.125", &mut out).expect("it is short");
        }
        "request for packets" => MessageForm::Packets.write_request(&mut out),
        "messages as packets" => {
            let mut writer = MessageWriter::default();
            writer.set_form(MessageForm::Packets);
            writer.write(b"1V 0.25,-0.125", &mut out).expect("it is short");
        }
        "request for messages of its own" => MessageForm::Own.write_request(&mut out),
        "report" => {
            let mut writer = MessageWriter::default();
            writer.set_form(MessageForm::Own);
            writer.write_report("E 2 *** Name not found: CUBE", &mut out).expect("it is short");
        }
        "raster" => {
            let commands = [
                RasterCommand::Erase { color: [0, 0, 64] },
                RasterCommand::Window { x_min: 0, y_min: 0, x_max: 639, y_max: 479 },
                RasterCommand::Position { x: 100, y: 200 },
                RasterCommand::Runs(vec![
                    Run { count: 10, color: [255, 0, 0] },
                    Run { count: 300, color: [0, 255, 0] },
                ]),
                RasterCommand::LookupTable { index: 16, entries: vec![LookupEntry { count: 4, color: [1, 2, 3] }] },
                RasterCommand::LookupRamp { min: 0, max: 255 },
            ];
            write_raster(&commands, &mut out).expect("they are short");
        }
        _ => {
            let texts = COMMANDS.iter().find(|row| row.0 == name)?.1;
            let commands: Vec<Command> = texts.iter().map(|text| parse(text.as_bytes()).expect(text)).collect();
            write_commands(&commands, &mut out).expect("they are short");
        }
    }
    Some(out)
}

fn dump(name: &str) -> String {
    let stream = stream(name).unwrap_or_else(|| panic!("no dump is called {name}"));
    let mut text = String::new();
    // A request for packets is what a host sends.
    let sender = if name.starts_with("messages as") || name == "report" { Sender::Machine } else { Sender::Host };
    let mut listing = Listing::of(sender);
    listing.push(&stream, &mut text).expect("a string takes all text");
    listing.finish(&mut text).expect("a string takes all text");
    text
}

/// The document with every dump as the code produces it, and the names of the dumps.
fn rewritten(document: &str) -> (String, Vec<String>) {
    let mut pieces = document.split(MARK);
    let mut text = pieces.next().unwrap_or_default().to_owned();
    let mut names = Vec::new();
    for piece in pieces {
        let (name, rest) = piece.split_once(" -->\n").expect("the name of a dump ends with its comment");
        let (_, after) =
            rest.strip_prefix("```text\n").and_then(|rest| rest.split_once("```\n")).expect("a dump in a fence");
        text += &format!("{MARK}{name} -->\n```text\n{}```\n{after}", dump(name));
        names.push(name.to_owned());
    }
    (text, names)
}

#[test]
fn the_dumps_in_the_document_are_what_the_code_produces() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("PROTOCOL.md");
    let document = fs::read_to_string(&path).expect("the document lies beside the manifest");
    let (expected, names) = rewritten(&document);
    if std::env::var_os("PROTOCOL_DOCUMENT").is_some_and(|wish| wish == "write") {
        fs::write(&path, &expected).expect("the document can be written");
    } else {
        for (line, (is, should)) in document.lines().zip(expected.lines()).enumerate() {
            assert_eq!(is, should, "PROTOCOL.md, line {}", line + 1);
        }
        assert_eq!(document, expected);
    }
    for (name, _) in COMMANDS {
        assert!(names.iter().any(|shown| shown == name), "the dump {name} is not in the document");
    }
    for (route, word) in Route::KNOWN {
        let row = if matches!(route, Route::Channel(_)) {
            "| `3` to `7` |".into()
        } else {
            format!("| `{}` |", char::from(route.code()))
        };
        assert!(expected.contains(&row), "the table of routes lacks {word}");
    }
    for opcode in Opcode::ALL {
        let row = format!("opcode: {}\n", opcode.word());
        assert!(expected.contains(&row), "no dump shows {}", opcode.word());
        let code = format!("| `{:02x}` | {}", opcode.code(), opcode.word());
        assert!(expected.contains(&code), "the table lacks {code}");
    }
    for (opcode, word) in RasterOpcode::ALL {
        assert!(expected.contains(&format!("opcode: {word}\n")), "no dump shows {word}");
        assert!(expected.contains(&format!("| `{:02x}` | {word}", opcode as u8)), "the table lacks {word}");
    }
}
