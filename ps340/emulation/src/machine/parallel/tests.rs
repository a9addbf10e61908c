//! Facts about the parallel interface, from the words on.

use super::*;
use crate::line::LineId;
use crate::machine::{Input, Settings, addresses::FIRST_ADDRESS, mailbox::MAX_MESSAGES, time_of_frame};
use proptest::prelude::*;
use protocol::parallel::{Block, ParallelFrameReader, write_reset};

const HOST: LineId = LineId(1);
const TEXT: LineId = LineId(2);

/// A machine with a host on each interface; the one on the parallel interface is attached.
struct Scene {
    machine: Machine,
    reader: ParallelFrameReader,
}

impl Scene {
    fn new(text: &str) -> Scene {
        let mut scene = Scene { machine: Machine::new(Settings::default()), reader: ParallelFrameReader::default() };
        let said = scene.machine.step([Input::AttachParallel(HOST), Input::Attach(TEXT)], 0);
        assert_eq!(scene.frames(said), [ParallelFrame::Word(0x3000)], "it tells that it is there");
        assert_eq!(scene.say(&[ParallelFrame::Word(0xe000)]), [ParallelFrame::Word(0xe000)]);
        scene.machine.step([Input::Bytes(TEXT, text.into())], 0);
        scene
    }

    fn frames(&mut self, outputs: Vec<super::super::HostOutput>) -> Vec<ParallelFrame> {
        outputs.iter().filter(|output| output.line == HOST).for_each(|output| self.reader.push(&output.bytes));
        self.reader.by_ref().collect()
    }

    /// Sends frames, one in each step; the answers.
    fn say(&mut self, frames: &[ParallelFrame]) -> Vec<ParallelFrame> {
        let mut answers = Vec::new();
        for frame in frames {
            let mut bytes = Vec::new();
            match frame {
                ParallelFrame::Word(word) => write_word(*word, &mut bytes),
                ParallelFrame::Block(block) => write_block(block, &mut bytes),
                ParallelFrame::Reset => write_reset(&mut bytes),
                ParallelFrame::Noise(byte) => bytes.push(*byte),
            }
            let said = self.machine.step([Input::Bytes(HOST, bytes)], 0);
            answers.extend(self.frames(said));
        }
        answers
    }

    fn pass(&mut self, frames: u64) -> Vec<ParallelFrame> {
        let until = time_of_frame(self.machine.frame() + frames);
        let said = self.machine.step([], until);
        self.frames(said)
    }

    /// A whole command with a block from the host; the answers after its echo.
    fn transfer(&mut self, word: u16, block: &[u8]) -> Vec<ParallelFrame> {
        let count = ParallelFrame::Word(block.len() as u16);
        let mut said =
            self.say(&[ParallelFrame::Word(word), count, ParallelFrame::Word(0), ParallelFrame::Block(block.into())]);
        assert_eq!(said.remove(0), ParallelFrame::Word(word), "the machine echoes");
        said
    }

    fn address(&mut self, name: &str) -> u32 {
        match self.transfer(0x8000, name.as_bytes())[..] {
            [
                ParallelFrame::Word(0x8a00),
                ParallelFrame::Word(0x8100),
                ParallelFrame::Word(high),
                ParallelFrame::Word(low),
            ] => u32::from(high) << 16 | u32::from(low),
            ref other => panic!("{name}: {other:?}"),
        }
    }
}

fn list(address: u32, words: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    AddressList(vec![Block { address, words }]).write(&mut bytes);
    bytes
}

/// An error answer.
fn error(word: u16, error: ParallelError) -> [ParallelFrame; 2] {
    [ParallelFrame::Word(word | ERROR), ParallelFrame::Word(error as u16)]
}

const V: &str = "V := VECTOR_LIST ITEMIZED P 0.25,0,0 L 0.5,0,0; DISPLAY V;";

#[test]
fn a_vector_list_is_read_and_written_by_its_address() {
    let mut scene = Scene::new(V);
    let address = scene.address("v");
    // Vector 1: x is 0.5, the mark at its end is a line.
    let read = scene.transfer(0x9000, &list(address + 18, 2));
    let block = ParallelFrame::Block(vec![0x3f, 0, 0, 0]);
    assert_eq!(read, [ParallelFrame::Word(0x9100), ParallelFrame::Word(4), block, ParallelFrame::Word(0x9a00)]);
    let mut write = list(address + 18, 2);
    write.extend([0xbf, 0, 0, 0]);
    assert_eq!(scene.transfer(0xb000, &write), [ParallelFrame::Word(0xba00)]);
    scene.machine.next_frame();
    assert_eq!(scene.machine.latest_update().strokes[0].end, [-0.5, 0.0]);
    assert_eq!(scene.address("V"), address, "the address stays");
}

#[test]
fn a_synchronised_write_waits_for_the_refresh() {
    let mut scene = Scene::new(V);
    let mut write = list(scene.address("V") + 18, 1);
    write.extend([0xbf, 0]);
    assert_eq!(scene.transfer(0xa000, &write), []);
    let shown = scene.machine.describe("V");
    assert_eq!(scene.pass(1), [ParallelFrame::Word(0xaa00)]);
    assert_eq!(scene.machine.latest_update().strokes[0].end, [-0.5, 0.0]);
    // ABORT before the refresh: nothing is written.
    write[8] = 0x3f;
    assert_eq!(scene.transfer(0xa000, &write), []);
    assert_eq!(scene.say(&[ParallelFrame::Word(0x1000)]), [ParallelFrame::Word(0x1000)]);
    assert_eq!(scene.pass(2), []);
    assert_eq!(scene.machine.latest_update().strokes[0].end, [-0.5, 0.0]);
    assert!(shown.is_some());
}

#[test]
fn logical_writes_are_the_host_line_and_logical_reads_its_messages() {
    let mut scene = Scene::new("");
    let text = b"E := F:NOP; CONNECT E<1>:<1>HOST_MESSAGE; SEND 'odd' TO <1>E;\x160SEND 'second";
    assert_eq!(scene.transfer(0xc002, text), [ParallelFrame::Word(0xca02)]);
    let read = [ParallelFrame::Word(0x5000), ParallelFrame::Word(100), ParallelFrame::Word(0)];
    let message = |text: &[u8], count| {
        [0x5000, 0x5100, count]
            .map(ParallelFrame::Word)
            .into_iter()
            .chain([ParallelFrame::Block(text.into()), ParallelFrame::Word(0x5a00)])
    };
    assert_eq!(scene.say(&read), message(b"odd\0", 3).collect::<Vec<_>>());
    // The next one is not there yet: the machine answers when it is.
    assert_eq!(scene.say(&read[..1]), []);
    let said = scene.machine.step([Input::Bytes(TEXT, b"SEND 'from another line' TO <1>E;".into())], 0);
    let answers = [scene.frames(said), scene.say(&[ParallelFrame::Word(5), ParallelFrame::Word(1)])].concat();
    // A buffer of five bytes, with exchanged bytes.
    assert_eq!(answers, message(b"rfmo\0 ", 5).collect::<Vec<_>>());
    // While a read waits, it can be aborted; then a packet that was cut is completed.
    assert_eq!(scene.say(&[ParallelFrame::Word(0x5000), ParallelFrame::Word(0x1000)]), [ParallelFrame::Word(0x1000)]);
    assert_eq!(scene.transfer(0xc000, b"' TO <1>E;\x16\x16"), [ParallelFrame::Word(0xca00)]);
    assert_eq!(scene.say(&read), message(b"second", 6).collect::<Vec<_>>());
}

#[test]
fn what_is_not_allowed_is_an_error_and_the_next_command_works() {
    let mut scene = Scene::new(V);
    let address = scene.address("V");
    for (name, fault) in
        [(&b"NOBODY"[..], ParallelError::Name), (b"1", ParallelError::Name), (b"\xff", ParallelError::Name)]
    {
        assert_eq!(scene.transfer(0x8000, name), error(0x8000, fault));
    }
    for (at, words, fault) in [
        (address, 19, ParallelError::Address),
        (address + 1, 1, ParallelError::Address),
        (address + 0x100, 0, ParallelError::Address),
        (0, 1, ParallelError::Address),
        (u32::MAX, 1, ParallelError::Address),
    ] {
        assert_eq!(scene.transfer(0x9000, &list(at, words)), error(0x9000, fault), "{at:x} {words}");
    }
    assert_eq!(scene.transfer(0x9000, &list(address, 18)[..6]), error(0x9000, ParallelError::ByteCount));
    assert_eq!(scene.transfer(0xb000, &list(address, 18)), error(0xb000, ParallelError::ByteCount));
    let mut infinite = list(address, 1);
    infinite.extend([0x7f, 0x80]);
    assert_eq!(scene.transfer(0xb000, &infinite), error(0xb000, ParallelError::Data));
    for word in [0x0000, 0x4000, 0x8a00] {
        assert_eq!(scene.say(&[ParallelFrame::Word(word)]), error(word & 0xf00f, ParallelError::Command));
    }
    for count in [0, 257] {
        let answer = scene.say(&[ParallelFrame::Word(0x8000), ParallelFrame::Word(count)]);
        assert_eq!(answer[1..], error(0x8000, ParallelError::ByteCount));
    }
    let answer = scene.say(&[ParallelFrame::Word(0x8000), ParallelFrame::Block(vec![1])]);
    assert_eq!(answer[1..], error(0x8000, ParallelError::Command));
    let answer = scene.say(&[
        ParallelFrame::Word(0x8000),
        ParallelFrame::Word(3),
        ParallelFrame::Word(0),
        ParallelFrame::Block(vec![1]),
    ]);
    assert_eq!(answer[1..], error(0x8000, ParallelError::ByteCount));
    assert_eq!(scene.say(&[ParallelFrame::Noise(b'!'), ParallelFrame::Noise(b'?')]), error(0, ParallelError::Command));
    assert_eq!(scene.address("V"), address);
}

#[test]
fn a_command_that_stays_unfinished_is_given_up() {
    let mut scene = Scene::new(V);
    assert_eq!(scene.say(&[ParallelFrame::Word(0x8000), ParallelFrame::Word(2)]), [ParallelFrame::Word(0x8000)]);
    assert_eq!(scene.pass(TRANSFER_FRAMES - 1), []);
    assert_eq!(scene.pass(1), error(0x8000, ParallelError::Timeout));
    scene.address("V");
}

#[test]
fn reset_ends_everything_and_attach_comes_first() {
    let mut scene = Scene::new(V);
    scene.address("V");
    assert_eq!(scene.transfer(0xc000, b"S := BEGIN_STRUCTURE NIL;"), [ParallelFrame::Word(0xca00)]);
    // In the middle of a transfer only the reset line is obeyed.
    assert_eq!(
        scene.say(&[ParallelFrame::Word(0xc000), ParallelFrame::Reset]),
        [ParallelFrame::Word(0xc000), ParallelFrame::Word(0x3000)]
    );
    assert!(scene.machine.log().any(|line| line.contains("while S was open")));
    for word in [0x5000, 0x8000, 0x9000, 0xa000, 0xb000, 0xc000] {
        assert_eq!(scene.say(&[ParallelFrame::Word(word)]), error(word, ParallelError::Command));
    }
    // The diagnostic attach is for memory alone.
    assert_eq!(scene.say(&[ParallelFrame::Word(0xf001)]), [ParallelFrame::Word(0xf001)]);
    scene.address("V");
    assert_eq!(scene.say(&[ParallelFrame::Word(0xc001)]), error(0xc001, ParallelError::Command));
    assert_eq!(
        scene.say(&[ParallelFrame::Word(0xd000), ParallelFrame::Word(0x3005)]),
        [ParallelFrame::Word(0xd000), ParallelFrame::Word(0x3005)]
    );
}

#[test]
fn an_address_follows_its_name_and_not_its_object() {
    let mut scene = Scene::new(V);
    let address = scene.address("V");
    scene.machine.step([Input::Bytes(TEXT, b"DELETE V;".into())], 0);
    assert_eq!(scene.transfer(0x9000, &list(address, 1)), error(0x9000, ParallelError::Address));
    scene.machine.step([Input::Bytes(TEXT, b"INITIALIZE; W := VECTOR_LIST 1,1;".into())], 0);
    assert_eq!(scene.transfer(0x9000, &list(address, 1)), error(0x9000, ParallelError::Address));
    scene.machine.step([Input::Bytes(TEXT, V.into())], 0);
    assert_eq!(scene.transfer(0x9000, &list(address, 1)).len(), 4);
}

#[test]
fn a_list_that_grew_has_a_new_address_beside_the_old_one() {
    let mut scene = Scene::new(V);
    let before = scene.address("V");
    scene.machine.step([Input::Bytes(TEXT, b"SEND V3D(7,8,9) TO <append>V;".into())], 0);
    let after = scene.address("V");
    assert_ne!(after, before);
    assert_eq!((scene.address("V"), scene.address("V")), (after, after));
    // The first two vectors are the same memory; the third one is only known by the new address.
    let first = scene.transfer(0x9000, &list(before, 18));
    assert_eq!(first, scene.transfer(0x9000, &list(after, 18)));
    assert_eq!(scene.transfer(0x9000, &list(after + 36, 9)).len(), 4);
}

#[test]
fn messages_that_nobody_reads_are_limited() {
    let mut scene = Scene::new("");
    let many = "SEND 'm' TO <1>HOST_MESSAGE;".repeat(MAX_MESSAGES + 7);
    scene.machine.step([Input::Bytes(TEXT, many.into())], 0);
    scene.say(&[ParallelFrame::Word(0x5000)]);
    assert_eq!(scene.machine.lines.mailbox(HOST).messages.len(), MAX_MESSAGES);
    assert!(scene.machine.log().any(|line| line.starts_with("W 12 *** 7 messages")));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn no_words_stop_the_machine(
        frames in prop::collection::vec(prop_oneof![
            (0..16_u16).prop_map(|code| ParallelFrame::Word(code << 12)),
            (0..40_u16).prop_map(ParallelFrame::Word),
            any::<u16>().prop_map(ParallelFrame::Word),
            prop::collection::vec(any::<u8>(), 0..40).prop_map(ParallelFrame::Block),
            (0..3_u16, any::<u8>()).prop_map(|(words, data)| {
                let mut bytes = list(FIRST_ADDRESS, words);
                bytes.extend(vec![data; 2 * usize::from(words)]);
                ParallelFrame::Block(bytes)
            }),
            Just(ParallelFrame::Block(b"V".into())),
            Just(ParallelFrame::Reset),
            any::<u8>().prop_map(ParallelFrame::Noise),
        ], 0..40)
    ) {
        let mut scene = Scene::new(V);
        scene.address("V");
        scene.say(&frames);
        scene.pass(2);
        // A frame that was cut off takes what follows for its own.
        scene.say(&vec![ParallelFrame::Noise(0); if scene.machine.lines.parallels[&HOST].frames.is_unfinished() { 70_000 } else { 0 }]);
        scene.say(&[ParallelFrame::Reset]);
        prop_assert_eq!(scene.say(&[ParallelFrame::Word(0xe000)]), [ParallelFrame::Word(0xe000)]);
        scene.address("V");
    }
}
