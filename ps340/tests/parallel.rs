//! The dialogues in `protocol/PARALLEL.md` are what the machine does.
//!
//! To write them anew: `PROTOCOL_DOCUMENT=write cargo test -p ps340 --test parallel`.

use protocol::parallel::{AddressList, Block, Code, ParallelListing, Side, write_block, write_reset, write_word};
use ps340::{
    line::LineId,
    machine::{Input, Machine, Settings},
};
use std::{fs, path::PathBuf};

const MARK: &str = "<!-- dialogue: ";
const HOST: LineId = LineId(1);
const OTHER: LineId = LineId(2);
/// The address that the first look-up gives.
const ADDRESS: u32 = 0x0001_0000;

/// A host and a machine, and the dialogue between them.
struct Dialogue {
    machine: Machine,
    listing: ParallelListing,
    text: String,
}

impl Dialogue {
    /// A machine to which another host has sent `commands`, with a host attached unless `fresh`.
    fn new(commands: &str, fresh: bool) -> Dialogue {
        let machine = Machine::new(Settings::default());
        let mut dialogue = Dialogue { machine, listing: ParallelListing::default(), text: String::new() };
        dialogue.machine.step([Input::Attach(OTHER), Input::Bytes(OTHER, commands.into())], 0);
        dialogue.inputs(Input::AttachParallel(HOST));
        if !fresh {
            dialogue.word(Code::Attach as u16);
            dialogue.text.clear();
        }
        dialogue
    }

    fn inputs(&mut self, input: Input) {
        for output in self.machine.step([input], 0) {
            if output.line == HOST {
                self.listing.push(Side::Machine, &output.bytes, &mut self.text);
            }
        }
    }

    fn host(&mut self, bytes: Vec<u8>) {
        self.listing.push(Side::Host, &bytes, &mut self.text);
        self.inputs(Input::Bytes(HOST, bytes));
    }

    fn word(&mut self, word: u16) {
        let mut bytes = Vec::new();
        write_word(word, &mut bytes);
        self.host(bytes);
    }

    /// A command with its byte count, swap flag and block.
    fn transfer(&mut self, code: Code, block: &[u8]) {
        self.words(&[code as u16, block.len() as u16, 0]);
        let mut bytes = Vec::new();
        write_block(block, &mut bytes);
        self.host(bytes);
    }

    fn words(&mut self, words: &[u16]) {
        words.iter().for_each(|word| self.word(*word));
    }
}

fn list(words: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    AddressList(vec![Block { address: ADDRESS + 18, words }]).write(&mut bytes);
    bytes
}

/// The dialogue with a name.
fn dialogue(name: &str) -> String {
    let vectors = "V := VECTOR_LIST ITEMIZED P 0,0,0 L 1,0.5,0;";
    let mut dialogue = Dialogue::new(vectors, name == "attach");
    match name {
        "attach" => dialogue.word(Code::Attach as u16),
        "write and read" => {
            dialogue.transfer(Code::WriteNet, b"SEND 'HI' TO <1>HOST_MESSAGE;");
            dialogue.words(&[Code::ReadNet as u16, 80, 0]);
        }
        "look up" => dialogue.transfer(Code::Lookup, b"V"),
        "physical" => {
            dialogue.transfer(Code::Lookup, b"V");
            dialogue.text.clear();
            dialogue.transfer(Code::ReadPhysical, &list(9));
            let mut block = list(2);
            block.extend((-1.0_f32).to_be_bytes());
            dialogue.transfer(Code::WritePhysical, &block);
        }
        "errors" => {
            dialogue.transfer(Code::Lookup, b"NOBODY");
            dialogue.words(&[0x4000, Code::ReadPhysical as u16, 3, Code::WriteNet as u16]);
            let mut bytes = Vec::new();
            write_reset(&mut bytes);
            dialogue.host(bytes);
            dialogue.word(Code::WriteNet as u16);
        }
        other => panic!("no dialogue is called {other}"),
    }
    dialogue.text
}

#[test]
fn the_dialogues_in_the_document_are_what_the_machine_does() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../protocol/PARALLEL.md");
    let document = fs::read_to_string(&path).expect("the document lies beside the protocol");
    let mut pieces = document.split(MARK);
    let mut expected = pieces.next().unwrap_or_default().to_owned();
    let mut count = 0;
    for piece in pieces {
        let (name, rest) = piece.split_once(" -->\n").expect("the name of a dialogue ends with its comment");
        let fenced = rest.strip_prefix("```text\n").and_then(|rest| rest.split_once("```\n"));
        let (_, after) = fenced.expect("a dialogue in a fence");
        expected += &format!("{MARK}{name} -->\n```text\n{}```\n{after}", dialogue(name));
        count += 1;
    }
    assert_eq!(count, 5);
    for (code, name) in Code::ALL {
        let row = format!("| `{:04x}` | {name} |", code as u16);
        assert!(document.contains(&row), "the table lacks {row}");
    }
    if std::env::var_os("PROTOCOL_DOCUMENT").is_some_and(|wish| wish == "write") {
        fs::write(&path, &expected).expect("the document can be written");
    } else {
        for (line, (is, should)) in document.lines().zip(expected.lines()).enumerate() {
            assert_eq!(is, should, "PARALLEL.md, line {}", line + 1);
        }
        assert_eq!(document, expected);
    }
}
