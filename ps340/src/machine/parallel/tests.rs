//! Facts about the parallel interface, from the words on.

use super::*;
use crate::line::LineId;
use crate::machine::{Input, Settings, addresses::FIRST_ADDRESS, mailbox::MAX_MESSAGES, time_of_frame};
use proptest::prelude::*;
use protocol::parallel::{Block, FrameReader, write_reset};

const HOST: LineId = LineId(1);
const TEXT: LineId = LineId(2);

/// A machine with a host on each interface; the one on the parallel interface is attached.
struct Scene {
    machine: Machine,
    reader: FrameReader,
}

impl Scene {
    fn new(text: &str) -> Scene {
        let mut scene = Scene { machine: Machine::new(Settings::default()), reader: FrameReader::default() };
        let said = scene.machine.step([Input::AttachParallel(HOST), Input::Attach(TEXT)], 0);
        assert_eq!(scene.frames(said), [Frame::Word(0x3000)], "it tells that it is there");
        assert_eq!(scene.say(&[Frame::Word(0xe000)]), [Frame::Word(0xe000)]);
        scene.machine.step([Input::Bytes(TEXT, text.into())], 0);
        scene
    }

    fn frames(&mut self, outputs: Vec<super::super::Output>) -> Vec<Frame> {
        outputs.iter().filter(|output| output.line == HOST).for_each(|output| self.reader.push(&output.bytes));
        self.reader.by_ref().collect()
    }

    /// Sends frames, one in each step; the answers.
    fn say(&mut self, frames: &[Frame]) -> Vec<Frame> {
        let mut answers = Vec::new();
        for frame in frames {
            let mut bytes = Vec::new();
            match frame {
                Frame::Word(word) => write_word(*word, &mut bytes),
                Frame::Block(block) => write_block(block, &mut bytes),
                Frame::Reset => write_reset(&mut bytes),
                Frame::Noise(byte) => bytes.push(*byte),
            }
            let said = self.machine.step([Input::Bytes(HOST, bytes)], 0);
            answers.extend(self.frames(said));
        }
        answers
    }

    fn pass(&mut self, frames: u64) -> Vec<Frame> {
        let until = time_of_frame(self.machine.frame() + frames);
        let said = self.machine.step([], until);
        self.frames(said)
    }

    /// A whole command with a block from the host; the answers behind its echo.
    fn transfer(&mut self, word: u16, block: &[u8]) -> Vec<Frame> {
        let count = Frame::Word(block.len() as u16);
        let mut said = self.say(&[Frame::Word(word), count, Frame::Word(0), Frame::Block(block.into())]);
        assert_eq!(said.remove(0), Frame::Word(word), "the machine echoes");
        said
    }

    fn address(&mut self, name: &str) -> u32 {
        match self.transfer(0x8000, name.as_bytes())[..] {
            [Frame::Word(0x8a00), Frame::Word(0x8100), Frame::Word(high), Frame::Word(low)] => {
                u32::from(high) << 16 | u32::from(low)
            }
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
fn error(word: u16, trouble: Trouble) -> [Frame; 2] {
    [Frame::Word(word | ERROR), Frame::Word(trouble as u16)]
}

const V: &str = "V := VECTOR_LIST ITEMIZED P 0.25,0,0 L 0.5,0,0; DISPLAY V;";

#[test]
fn a_vector_list_is_read_and_written_by_its_address() {
    let mut scene = Scene::new(V);
    let address = scene.address("v");
    // Vector 1: x is 0.5, the mark at its end is a line.
    let read = scene.transfer(0x9000, &list(address + 18, 2));
    let block = Frame::Block(vec![0x3f, 0, 0, 0]);
    assert_eq!(read, [Frame::Word(0x9100), Frame::Word(4), block, Frame::Word(0x9a00)]);
    let mut write = list(address + 18, 2);
    write.extend([0xbf, 0, 0, 0]);
    assert_eq!(scene.transfer(0xb000, &write), [Frame::Word(0xba00)]);
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
    assert_eq!(scene.pass(1), [Frame::Word(0xaa00)]);
    assert_eq!(scene.machine.latest_update().strokes[0].end, [-0.5, 0.0]);
    // ABORT before the refresh: nothing is written.
    write[8] = 0x3f;
    assert_eq!(scene.transfer(0xa000, &write), []);
    assert_eq!(scene.say(&[Frame::Word(0x1000)]), [Frame::Word(0x1000)]);
    assert_eq!(scene.pass(2), []);
    assert_eq!(scene.machine.latest_update().strokes[0].end, [-0.5, 0.0]);
    assert!(shown.is_some());
}

#[test]
fn logical_writes_are_the_host_line_and_logical_reads_its_messages() {
    let mut scene = Scene::new("");
    let text = b"E := F:NOP; CONNECT E<1>:<1>HOST_MESSAGE; SEND 'odd' TO <1>E;\x160SEND 'second";
    assert_eq!(scene.transfer(0xc002, text), [Frame::Word(0xca02)]);
    let read = [Frame::Word(0x5000), Frame::Word(100), Frame::Word(0)];
    let message = |text: &[u8], count| {
        [0x5000, 0x5100, count].map(Frame::Word).into_iter().chain([Frame::Block(text.into()), Frame::Word(0x5a00)])
    };
    assert_eq!(scene.say(&read), message(b"odd\0", 3).collect::<Vec<_>>());
    // The next one is not there yet: the machine answers when it is.
    assert_eq!(scene.say(&read[..1]), []);
    let said = scene.machine.step([Input::Bytes(TEXT, b"SEND 'from another line' TO <1>E;".into())], 0);
    let answers = [scene.frames(said), scene.say(&[Frame::Word(5), Frame::Word(1)])].concat();
    // A buffer of five bytes, with exchanged bytes.
    assert_eq!(answers, message(b"rfmo\0 ", 5).collect::<Vec<_>>());
    // While a read waits, it can be aborted; then a packet that was cut is completed.
    assert_eq!(scene.say(&[Frame::Word(0x5000), Frame::Word(0x1000)]), [Frame::Word(0x1000)]);
    assert_eq!(scene.transfer(0xc000, b"' TO <1>E;\x16\x16"), [Frame::Word(0xca00)]);
    assert_eq!(scene.say(&read), message(b"second", 6).collect::<Vec<_>>());
}

#[test]
fn what_is_not_allowed_is_an_error_and_the_next_command_works() {
    let mut scene = Scene::new(V);
    let address = scene.address("V");
    for (name, trouble) in [(&b"NOBODY"[..], Trouble::Name), (b"1", Trouble::Name), (b"\xff", Trouble::Name)] {
        assert_eq!(scene.transfer(0x8000, name), error(0x8000, trouble));
    }
    for (at, words, trouble) in [
        (address, 19, Trouble::Address),
        (address + 1, 1, Trouble::Address),
        (address + 0x100, 0, Trouble::Address),
        (0, 1, Trouble::Address),
        (u32::MAX, 1, Trouble::Address),
    ] {
        assert_eq!(scene.transfer(0x9000, &list(at, words)), error(0x9000, trouble), "{at:x} {words}");
    }
    assert_eq!(scene.transfer(0x9000, &list(address, 18)[..6]), error(0x9000, Trouble::ByteCount));
    assert_eq!(scene.transfer(0xb000, &list(address, 18)), error(0xb000, Trouble::ByteCount));
    let mut infinite = list(address, 1);
    infinite.extend([0x7f, 0x80]);
    assert_eq!(scene.transfer(0xb000, &infinite), error(0xb000, Trouble::Data));
    for word in [0x0000, 0x4000, 0x8a00] {
        assert_eq!(scene.say(&[Frame::Word(word)]), error(word & 0xf00f, Trouble::Command));
    }
    for count in [0, 257] {
        let answer = scene.say(&[Frame::Word(0x8000), Frame::Word(count)]);
        assert_eq!(answer[1..], error(0x8000, Trouble::ByteCount));
    }
    let answer = scene.say(&[Frame::Word(0x8000), Frame::Block(vec![1])]);
    assert_eq!(answer[1..], error(0x8000, Trouble::Command));
    let answer = scene.say(&[Frame::Word(0x8000), Frame::Word(3), Frame::Word(0), Frame::Block(vec![1])]);
    assert_eq!(answer[1..], error(0x8000, Trouble::ByteCount));
    assert_eq!(scene.say(&[Frame::Noise(b'!'), Frame::Noise(b'?')]), error(0, Trouble::Command));
    assert_eq!(scene.address("V"), address);
}

#[test]
fn a_command_that_stays_unfinished_is_given_up() {
    let mut scene = Scene::new(V);
    assert_eq!(scene.say(&[Frame::Word(0x8000), Frame::Word(2)]), [Frame::Word(0x8000)]);
    assert_eq!(scene.pass(TRANSFER_FRAMES - 1), []);
    assert_eq!(scene.pass(1), error(0x8000, Trouble::Timeout));
    scene.address("V");
}

#[test]
fn reset_ends_everything_and_attach_comes_first() {
    let mut scene = Scene::new(V);
    scene.address("V");
    assert_eq!(scene.transfer(0xc000, b"S := BEGIN_STRUCTURE NIL;"), [Frame::Word(0xca00)]);
    // In the middle of a transfer only the reset line is heard.
    assert_eq!(scene.say(&[Frame::Word(0xc000), Frame::Reset]), [Frame::Word(0xc000), Frame::Word(0x3000)]);
    assert!(scene.machine.log().any(|line| line.contains("while S was open")));
    for word in [0x5000, 0x8000, 0x9000, 0xa000, 0xb000, 0xc000] {
        assert_eq!(scene.say(&[Frame::Word(word)]), error(word, Trouble::Command));
    }
    // The diagnostic attach is for memory alone.
    assert_eq!(scene.say(&[Frame::Word(0xf001)]), [Frame::Word(0xf001)]);
    scene.address("V");
    assert_eq!(scene.say(&[Frame::Word(0xc001)]), error(0xc001, Trouble::Command));
    assert_eq!(scene.say(&[Frame::Word(0xd000), Frame::Word(0x3005)]), [Frame::Word(0xd000), Frame::Word(0x3005)]);
}

#[test]
fn an_address_follows_its_name_and_not_its_object() {
    let mut scene = Scene::new(V);
    let address = scene.address("V");
    scene.machine.step([Input::Bytes(TEXT, b"DELETE V;".into())], 0);
    assert_eq!(scene.transfer(0x9000, &list(address, 1)), error(0x9000, Trouble::Address));
    scene.machine.step([Input::Bytes(TEXT, b"INITIALIZE; W := VECTOR_LIST 1,1;".into())], 0);
    assert_eq!(scene.transfer(0x9000, &list(address, 1)), error(0x9000, Trouble::Address));
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
    scene.say(&[Frame::Word(0x5000)]);
    assert_eq!(scene.machine.lines.mailbox(HOST).messages.len(), MAX_MESSAGES);
    assert!(scene.machine.log().any(|line| line.starts_with("W 12 *** 7 messages")));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn no_words_stop_the_machine(
        frames in prop::collection::vec(prop_oneof![
            (0..16_u16).prop_map(|code| Frame::Word(code << 12)),
            (0..40_u16).prop_map(Frame::Word),
            any::<u16>().prop_map(Frame::Word),
            prop::collection::vec(any::<u8>(), 0..40).prop_map(Frame::Block),
            (0..3_u16, any::<u8>()).prop_map(|(words, data)| {
                let mut bytes = list(FIRST_ADDRESS, words);
                bytes.extend(vec![data; 2 * usize::from(words)]);
                Frame::Block(bytes)
            }),
            Just(Frame::Block(b"V".into())),
            Just(Frame::Reset),
            any::<u8>().prop_map(Frame::Noise),
        ], 0..40)
    ) {
        let mut scene = Scene::new(V);
        scene.address("V");
        scene.say(&frames);
        scene.pass(2);
        // A frame that was cut off takes what follows for its own.
        scene.say(&vec![Frame::Noise(0); if scene.machine.lines.parallels[&HOST].frames.is_unfinished() { 70_000 } else { 0 }]);
        scene.say(&[Frame::Reset]);
        prop_assert_eq!(scene.say(&[Frame::Word(0xe000)]), [Frame::Word(0xe000)]);
        scene.address("V");
    }
}
