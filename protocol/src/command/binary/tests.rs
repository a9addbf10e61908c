//! Facts about the binary form.

use super::*;
use crate::{
    Name,
    command::{
        MAX_POINTS, parse,
        strategy::commands,
        syntax::{Command, Object, VectorClass, VectorList},
    },
    record::Witness,
};
use proptest::prelude::*;
use std::{fmt, ops::Range};

fn name(text: &str) -> Name {
    Name::new(text).unwrap()
}

fn list(class: VectorClass, count: usize) -> Command {
    let points: Vec<[f32; 4]> = (0..count).map(|i| [i as f32, -(i as f32), 0.5, 1.0]).collect();
    let lines = (0..count).filter(|_| class == VectorClass::Itemized).map(|i| i % 3 != 0).collect();
    let list = VectorList {
        block_normalized: false,
        fourth: crate::command::Fourth::Intensity,
        internal_units: false,
        class,
        dimension: 3,
        estimate: Some(7),
        points,
        lines,
    };
    Command::Define { name: Some(name("V")), object: Object::VectorList(list) }
}

fn decode(body: &[u8]) -> Vec<Result<Command, BinaryError>> {
    BinaryDecoder::default().push(body).collect()
}

fn encoded(command: &Command) -> Vec<u8> {
    let mut out = Vec::new();
    encode(command, &mut out).unwrap();
    out
}

#[test]
fn a_long_list_travels_in_parts_over_several_packets() {
    let command = list(VectorClass::Itemized, 2 * PART_POINTS + 5);
    let mut decoder = BinaryDecoder::default();
    let mut received = Vec::new();
    let mut packets = 0;
    records(&command, &mut Vec::new(), &mut |record| {
        packets += 1;
        received.extend(decoder.push(record).map(Result::unwrap));
    })
    .unwrap();
    assert_eq!(packets, 5);
    assert!(received == [command]);
    assert!(!decoder.is_unfinished());
}

#[test]
fn a_lost_part_is_noticed_at_the_end() {
    let mut kept = Vec::new();
    let mut index = 0;
    records(&list(VectorClass::Dots, PART_POINTS + 5), &mut Vec::new(), &mut |record| {
        if index != 1 {
            kept.extend_from_slice(record);
        }
        index += 1;
    })
    .unwrap();
    encode(&Command::EndStructure, &mut kept).unwrap();
    let items = decode(&kept);
    let problem = BinaryProblem::Count { announced: PART_POINTS + 5, received: 5 };
    assert_eq!(items[0].as_ref().unwrap_err().problem, problem);
    assert_eq!(items[1], Ok(Command::EndStructure));
}

#[test]
fn another_record_gives_up_an_open_list_and_is_obeyed() {
    let mut body = encoded(&list(VectorClass::Separate, 4));
    body.pop(); // the end
    encode(&Command::Display(name("A")), &mut body).unwrap();
    let items = decode(&body);
    assert_eq!(items[0].as_ref().unwrap_err().problem, BinaryProblem::StillOpen);
    assert_eq!(items[1], Ok(Command::Display(name("A"))));
    assert_eq!(items.len(), 2);
    assert_eq!(decode(&[Opcode::VectorsEnd.code()])[0].as_ref().unwrap_err().problem, BinaryProblem::NotOpen);
}

#[test]
fn vectors_that_are_not_finite_are_errors_with_their_place() {
    let Command::Define { name, object: Object::VectorList(mut list) } = list(VectorClass::Connected, 20) else {
        panic!("a list was expected");
    };
    list.points[3][2] = f32::NAN;
    let body = encoded(&Command::Define { name, object: Object::VectorList(list) });
    let error = decode(&body).remove(0).unwrap_err();
    let begin = 1 + 3 + 3 + 8;
    assert_eq!((error.problem, error.offset), (BinaryProblem::NotFinite, begin + 3 + 3 * 16));
}

#[test]
fn announced_lengths_do_not_make_room() {
    let mut begin = vec![Opcode::VectorsBegin.code(), 0, 0, 0, 0, 3, 0, 0, 0, 0];
    begin.extend_from_slice(&(MAX_POINTS as u32).to_le_bytes());
    let mut decoder = BinaryDecoder::default();
    assert_eq!(decoder.push(&begin).count(), 0);
    assert!(decoder.is_unfinished());
    let end = begin.len() - 4;
    begin[end..].copy_from_slice(&u32::MAX.to_le_bytes());
    decoder.reset();
    let error = decoder.push(&begin).next().unwrap().unwrap_err();
    let found = u32::MAX as usize;
    assert_eq!(error.problem, BinaryProblem::TooMany { found, limit: MAX_POINTS });
}

#[test]
fn what_exceeds_a_limit_is_not_encoded() {
    let long = Command::Define { name: None, object: Object::Instance(vec![name("A"); 70_000]) };
    let mut out = vec![1, 2, 3];
    assert_eq!(encode(&long, &mut out).unwrap_err().what, "the number of names");
    let large = Command::Define { name: None, object: Object::Instance(vec![name(&"A".repeat(256)); 60_000]) };
    assert_eq!(encode(&large, &mut out).unwrap_err().what, "the record");
    assert_eq!(out, [1, 2, 3]);
}

#[test]
fn every_opcode_is_found_by_its_code() {
    for &opcode in Opcode::ALL {
        assert_eq!(Opcode::from_code(opcode.code()), Some(opcode));
    }
    assert_eq!(Opcode::from_code(0), None);
}

fn text_record(more: bool, text: &str) -> Vec<u8> {
    let mut record = vec![Opcode::Text.code(), more.into()];
    record.extend((text.len() as u16).to_le_bytes());
    record.extend(text.as_bytes());
    record
}

#[test]
fn a_long_command_travels_as_text_in_parts_over_several_packets() {
    let vertex = "0.125,0.25,0.5 ".repeat(4);
    let command = parse(format!("P := {};", format!("POLYGON {vertex}").repeat(2_000)).as_bytes()).unwrap();
    let mut decoder = BinaryDecoder::default();
    let (mut received, mut packets) = (Vec::new(), 0);
    records(&command, &mut Vec::new(), &mut |record| {
        packets += 1;
        assert!(record.len() <= PART_TEXT + 4);
        received.extend(decoder.push(record).map(Result::unwrap));
    })
    .unwrap();
    assert!(packets > 3 && received == [command]);
}

#[test]
fn an_error_in_a_text_has_its_place_and_ends_no_packet() {
    let mut body = text_record(false, "SET COLOUR 1,1;");
    encode(&Command::EndStructure, &mut body).unwrap();
    let items = decode(&body);
    let error = items[0].as_ref().unwrap_err();
    // After opcode, flag and length, and `SET `.
    assert_eq!((error.offset, error.field), (4 + 4, "text"));
    assert!(error.to_string().contains("1:5: expected a setting") && error.to_string().contains("COLOR?"));
    assert_eq!(items[1], Ok(Command::EndStructure));
    let parts = [text_record(true, "SET PICKING "), text_record(false, "ON 7")].concat();
    let error = decode(&parts).remove(0).unwrap_err();
    assert_eq!(error.offset, parts.len() - 1);
}

#[test]
fn another_record_gives_up_an_open_text_and_is_obeyed() {
    let mut body = text_record(true, "SET PICKING ");
    encode(&Command::Display(name("A")), &mut body).unwrap();
    body.extend(text_record(false, "SET CSM ON"));
    let items = decode(&body);
    assert_eq!(items[0].as_ref().unwrap_err().problem, BinaryProblem::StillOpen);
    assert_eq!(items[1], Ok(Command::Display(name("A"))));
    assert_eq!(items[2], Ok(parse(b"SET CSM ON").unwrap()));
    let mut vectors = text_record(true, "SET ");
    vectors.push(Opcode::VectorsEnd.code());
    assert_eq!(decode(&vectors)[0].as_ref().unwrap_err().problem, BinaryProblem::NotOpen);
}

#[test]
fn what_no_text_can_say_is_not_encoded() {
    let label = crate::command::LabelText { position: Default::default(), text: vec![b'a'; 241].into() };
    let labels = crate::command::Labels { labels: vec![label] };
    let command = Command::Define { name: None, object: Object::Labels(labels) };
    assert_eq!(encode(&command, &mut Vec::new()).unwrap_err().what, "the text of a label");
}

/// Checks that the fields follow each other without gap.
struct Cover(usize);

impl Witness for Cover {
    fn field(&mut self, place: Range<usize>, _: &'static str, _: fmt::Arguments<'_>) {
        assert_eq!(place.start, self.0);
        self.0 = place.end;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]
    #[test]
    fn decoding_what_was_encoded_gives_the_commands(commands in prop::collection::vec(commands(), 1..6)) {
        let mut body = Vec::new();
        for command in &commands {
            encode(command, &mut body).unwrap();
        }
        let decoded: Result<Vec<Command>, BinaryError> = BinaryDecoder::default().push(&body).collect();
        prop_assert_eq!(decoded, Ok(commands));
    }

    #[test]
    fn the_witness_hears_of_every_byte(command in commands()) {
        let body = encoded(&command);
        let (mut decoder, mut at, mut cover) = (BinaryDecoder::default(), 0, Cover(0));
        while at < body.len() {
            decoder.record(&body, &mut at, &mut cover).unwrap();
            prop_assert_eq!(cover.0, at);
        }
    }

    #[test]
    fn a_cut_body_is_an_error_and_never_a_panic(command in commands(), cut in any::<prop::sample::Index>()) {
        let body = encoded(&command);
        let cut = cut.index(body.len());
        let mut decoder = BinaryDecoder::default();
        let items: Vec<_> = decoder.push(&body[..cut]).collect();
        prop_assert!(items.iter().all(Result::is_err));
        prop_assert!(cut == 0 || decoder.is_unfinished() || items.len() == 1);
    }

    #[test]
    fn mutated_bodies_never_panic(
        commands in prop::collection::vec(commands(), 1..4),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)
    ) {
        let mut body = Vec::new();
        commands.iter().for_each(|command| encode(command, &mut body).unwrap());
        for (place, byte) in changes {
            let at = place.index(body.len());
            body[at] = byte;
        }
        let items = decode(&body);
        prop_assert!(items.iter().flatten().count() <= body.len());
        for error in items.iter().filter_map(|item| item.as_ref().err()) {
            prop_assert!(error.offset <= body.len());
        }
    }
}
