//! Inputs that chance makes out of real ones, against parser, packets, binary form and the whole machine.
//!
//! - In an ordinary run a fixed number of inputs, the same ones each time.
//! - `PERIS_FUZZ_SECONDS=3600 cargo test -p ps340 --test fuzz -- --nocapture` goes on for an hour on all cores, from
//!   `PERIS_FUZZ_SEED` (1), and writes what fails to files. The profile for development is the one to use: it is
//!   optimised, and arithmetic that overflows panics.
//! - `PERIS_FUZZ_INPUT=FILE` tries the input of such a file again.
//!
//! An input that shows something new (a message, a pair of words, a frame, an order of magnitude) is kept and changed
//! further.

mod binary;
mod campaign;
mod chance;
mod growth;
mod long;
mod mutation;
mod packets;
mod pool;
mod seeds;
mod session;
mod text;
mod vocabulary;
mod watch;

use campaign::{Campaign, Target};
use chance::Chance;
use pool::Features;
use std::{env, fs};

/// All targets, with how many inputs an ordinary run tries of each.
static TARGETS: [(&Target, usize); 4] =
    [(&text::TEXT, 4_000), (&packets::PACKETS, 2_000), (&binary::BINARY, 4_000), (&session::SESSION, 600)];

fn a_few(target: &'static Target) {
    let count = TARGETS.iter().find(|row| row.0.name == target.name).map_or(0, |row| row.1);
    let campaign = Campaign::new(target, None);
    let (planted, seen) = campaign.sizes();
    let mut chance = Chance::new(1);
    (0..count).for_each(|_| campaign.advance(&mut chance, None));
    let (kept, seen_now) = campaign.sizes();
    assert!(campaign.failures().is_empty(), "{:#?}", campaign.failures());
    assert!(kept > planted && seen_now > seen, "changes show something new");
}

#[test]
fn texts_are_read_however_they_are_damaged() {
    a_few(&text::TEXT);
}

#[test]
fn packets_are_told_apart_however_they_are_damaged() {
    a_few(&packets::PACKETS);
}

#[test]
fn records_are_decoded_however_they_are_damaged() {
    a_few(&binary::BINARY);
}

#[test]
fn sessions_never_stop_the_machine() {
    a_few(&session::SESSION);
}

#[test]
fn for_as_long_as_asked() {
    let number = |name| env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    if let Some(seconds) = number("PERIS_FUZZ_SECONDS") {
        long::run(seconds, number("PERIS_FUZZ_SEED").unwrap_or(1));
    }
}

#[test]
fn an_input_of_a_file_again() {
    let Ok(file) = env::var("PERIS_FUZZ_INPUT") else { return };
    let bytes = fs::read(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let end = bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len());
    let target = TARGETS.iter().map(|row| row.0).find(|target| target.name.as_bytes() == &bytes[..end]);
    let target = target.unwrap_or_else(|| panic!("{file}: the first line names no target"));
    let input = bytes.get(end + 1..).unwrap_or_default();
    println!("{}: {}", target.name, input.escape_ascii());
    (target.run)(input, &mut Features::default());
}

#[test]
fn what_fails_is_found_and_made_short() {
    static FRAGILE: Target = Target {
        name: "fragile",
        seeds: || vec![b"SEND 1 TO <1>A; DISPLAY B; SEND 2 TO <1>B;".to_vec()],
        run: |input, features| {
            features.saw(input.iter().filter(|byte| **byte == b';').count());
            assert!(!input.windows(2).any(|two| two == b";;"), "two of them");
        },
    };
    let campaign = Campaign::new(&FRAGILE, None);
    let mut chance = Chance::new(1);
    while campaign.failures().is_empty() && campaign.executions() < 100_000 {
        campaign.advance(&mut chance, None);
    }
    let failures: Vec<_> = campaign.failures().into_values().collect();
    assert!(matches!(&failures[..], [one] if one.input == b";;" && one.message == "two of them"), "{failures:?}");
}
