//! Changes of an input: bits, runs, splices, words, numbers, checks.

use crate::{
    chance::Chance,
    growth::{bytes, statement},
    vocabulary::vocabulary,
};
use protocol::wire::{LONG_HEADER, LONG_START, LONG_TRAILER, Route, write_packet};

/// Longest input, in bytes.
pub const LONGEST: usize = 3_072;

/// Numbers as text that are hard to take.
pub const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "0.5",
    "1E38",
    "-1E38",
    "3.4028235E38",
    "1E-45",
    "1E308",
    "1.7976931348623157E308",
    "1E-308",
    "1E400",
    "127",
    "128",
    "240",
    "255",
    "256",
    "1000",
    "32767",
    "-32768",
    "65535",
    "65536",
    "2147483647",
    "-2147483648",
    "2147483648",
    "4294967295",
    "16777216",
    "99999999999999999999",
    "1e999999999",
    "0.0000000000000000000000001",
    "360",
    "180",
    "90",
    "0.1",
    "3",
    "10",
    "15",
];

/// Numbers as bytes that are hard to take.
const WORDS: &[u32] = &[
    0,
    1,
    0x7F,
    0x80,
    0xFF,
    0x100,
    0x7FFF,
    0x8000,
    0xFFFF,
    0x10000,
    0x7FFF_FFFF,
    0x8000_0000,
    0xFFFF_FFFF,
    0x7F80_0000,
    0x7FC0_0000,
    0x3F80_0000,
    0x0080_0000,
    0x1000_0000,
];

/// A changed copy of `parent`, some of it from `other`.
pub fn mutate(chance: &mut Chance, parent: &[u8], other: &[u8]) -> Vec<u8> {
    let mut input = parent.to_vec();
    let most = 1 << chance.below(4);
    let edits = 1 + chance.below(most);
    for _ in 0..edits {
        edit(chance, &mut input, other);
        input.truncate(LONGEST);
    }
    if chance.one_in(2) && input.contains(&LONG_START) {
        input = with_good_checks(&input);
        input.truncate(LONGEST);
    }
    input
}

fn edit(chance: &mut Chance, input: &mut Vec<u8>, other: &[u8]) {
    let at = chance.below(input.len() + 1);
    match chance.below(20) {
        0 => {
            if let Some(byte) = input.get_mut(at) {
                *byte ^= 1 << chance.below(8);
            }
        }
        1 => {
            if let Some(byte) = input.get_mut(at) {
                *byte = chance.next() as u8;
            }
        }
        2 => {
            let byte = chance.next() as u8;
            let run = vec![byte; 1 << chance.below(9)];
            insert(input, at, &run);
        }
        3 => {
            let gone = chance.range(input.len());
            input.drain(gone);
        }
        4 => {
            let copied = input[chance.range(input.len())].to_vec();
            (0..1 + chance.below(4)).for_each(|_| insert(input, at, &copied));
        }
        5 => {
            let from = chance.below(other.len() + 1);
            input.truncate(at);
            input.extend_from_slice(&other[from..]);
        }
        6 => insert(input, at, &other[chance.range(other.len())]),
        7 => insert(input, at, chance.pick::<Vec<u8>>(vocabulary())),
        8 => replace_word(chance, input, at),
        9 => replace_number(chance, input, at),
        10 => input.truncate(at),
        11 => {
            let word = chance.pick(WORDS).to_le_bytes();
            let width = *chance.pick(&[1, 2, 4]);
            for (place, byte) in input.iter_mut().skip(at).zip(&word[..width]) {
                *place = *byte;
            }
        }
        12 => swap_statements(chance, input),
        13 => {
            let (a, b) = (word_at(input, at), word_at(input, chance.below(input.len() + 1)));
            let text = input[b].to_vec();
            input.splice(a, text);
        }
        14 => {
            let statement = statement_of(chance, other);
            insert(input, at, &statement);
        }
        15 => input.extend_from_slice(other),
        16 => insert(input, 0, other),
        _ => {
            let at = input.iter().skip(at).position(|byte| *byte == b';').map_or(at, |behind| at + behind + 1);
            let count = 1 + chance.below(8);
            let statements: Vec<String> = (0..count).map(|_| statement(chance)).collect();
            insert(input, at, &bytes(&statements.concat()));
        }
    }
}

fn insert(input: &mut Vec<u8>, at: usize, bytes: &[u8]) {
    let at = at.min(input.len());
    input.splice(at..at, bytes.iter().copied());
}

/// The word or number that stands at an offset, or the nothing there.
fn word_at(input: &[u8], at: usize) -> std::ops::Range<usize> {
    let part = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'$');
    let start = input[..at].iter().rposition(|byte| !part(byte)).map_or(0, |before| before + 1);
    let end = at + input[at..].iter().take_while(|byte| part(byte)).count();
    start..end
}

fn replace_word(chance: &mut Chance, input: &mut Vec<u8>, at: usize) {
    let word = word_at(input, at);
    input.splice(word, chance.pick(vocabulary()).iter().copied());
}

/// Makes the first number from `at` on another one.
fn replace_number(chance: &mut Chance, input: &mut Vec<u8>, at: usize) {
    let Some(digit) = input[at..].iter().position(u8::is_ascii_digit) else { return };
    let start = at + digit;
    let length = input[start..].iter().take_while(|byte| byte.is_ascii_digit() || matches!(byte, b'.')).count();
    input.splice(start..start + length, chance.pick(NUMBERS).bytes());
}

/// A piece between two `;`.
fn statement_of(chance: &mut Chance, input: &[u8]) -> Vec<u8> {
    let pieces: Vec<&[u8]> = input.split_inclusive(|byte| *byte == b';').collect();
    if pieces.is_empty() { Vec::new() } else { chance.pick(&pieces).to_vec() }
}

fn swap_statements(chance: &mut Chance, input: &mut Vec<u8>) {
    let mut pieces: Vec<&[u8]> = input.split_inclusive(|byte| *byte == b';').collect();
    let (a, b) = (chance.below(pieces.len()), chance.below(pieces.len()));
    if !pieces.is_empty() {
        pieces.swap(a, b);
    }
    *input = pieces.concat();
}

/// Input with the checks of its long packets made right, so that a change reaches their records.
fn with_good_checks(input: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(input.len());
    let mut rest = input;
    while let Some((byte, behind)) = rest.split_first() {
        let body = rest.get(LONG_HEADER..).filter(|_| *byte == LONG_START);
        let Some(body) = body else {
            out.push(*byte);
            rest = behind;
            continue;
        };
        let announced = u32::from_le_bytes([rest[2], rest[3], rest[4], rest[5]]) as usize;
        let (payload, after) = body.split_at(announced.min(body.len().saturating_sub(LONG_TRAILER)));
        if write_packet(Route::from(rest[1]), payload, &mut out).is_err() {
            out.push(*byte);
        }
        rest = after.get(LONG_TRAILER..).unwrap_or(&[]);
    }
    out
}

#[test]
fn checks_of_damaged_packets_are_made_right() {
    let mut good = b"text ".to_vec();
    write_packet(Route::Binary, b"abc", &mut good).expect("it is short");
    good.extend(b" more");
    let mut bad = good.clone();
    bad[5 + LONG_HEADER + 1] ^= 1;
    let mended = with_good_checks(&bad);
    assert_eq!(with_good_checks(&good), good);
    assert!(mended != bad && mended != good && mended.len() == good.len());
}

#[test]
fn a_seed_gives_the_same_changes() {
    let run = |seed| {
        let mut chance = Chance::new(seed);
        (0..500).map(|_| mutate(&mut chance, b"SEND 1 TO <1>A; DISPLAY B;", b"A := F:ADD;")).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}
