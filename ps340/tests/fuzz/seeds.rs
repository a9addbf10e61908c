//! Real inputs to begin with: the cases of the conformance suite, the programs, and random commands in every form.

use crate::{binary::BETWEEN, session};
use proptest::{
    strategy::{Strategy, ValueTree},
    test_runner::TestRunner,
};
use protocol::{
    capture::{Event, HEADER, Record},
    command::{Command, CommandReader, encode, print, strategy::commands},
    parallel,
    raster::{LookupEntry, RasterCommand, Run},
    wire::{DataForm, PacketForm, Route, Sending, write_commands_as, write_packet_as, write_raster_as},
};
use std::{fs, path::Path, sync::OnceLock};

/// Random commands.
const RANDOM: usize = 300;

/// What a case does, as far as it is input.
enum Step {
    Bytes(Vec<u8>),
    Order(String),
    Frames(usize),
}

/// The cases of the suite and the programs; none where the files are not there.
fn scripts() -> &'static [Vec<Step>] {
    static SCRIPTS: OnceLock<Vec<Vec<Step>>> = OnceLock::new();
    SCRIPTS.get_or_init(|| {
        let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let cases = files(&crate_folder.join("../tests/conformance"), "cases");
        let programs = files(&crate_folder.join("programs"), "ps300");
        let mut scripts: Vec<Vec<Step>> = cases.iter().flat_map(|text| script_of(text)).collect();
        scripts.extend(programs.into_iter().map(|text| vec![Step::Bytes(text.into_bytes()), Step::Frames(3)]));
        scripts
    })
}

fn files(folder: &Path, extension: &str) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == extension));
    paths.sort();
    paths.iter().filter_map(|path| fs::read_to_string(path).ok()).collect()
}

fn script_of(text: &str) -> Vec<Vec<Step>> {
    let mut scripts = vec![Vec::new()];
    for line in text.lines() {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let step = match word {
            "case" => {
                scripts.push(Vec::new());
                continue;
            }
            ">" => Step::Bytes(format!("{rest}\n").into_bytes()),
            "raw" => Step::Bytes(unescaped(rest.trim_matches('"'))),
            "@" => Step::Order(rest.into()),
            "frames" => Step::Frames(rest.trim().parse().unwrap_or(1)),
            _ => continue,
        };
        if let Some(script) = scripts.last_mut() {
            script.push(step);
        }
    }
    scripts.retain(|script| !script.is_empty());
    scripts
}

fn unescaped(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let mut bytes = text.bytes();
    while let Some(byte) = bytes.next() {
        out.push(match byte {
            b'\\' => match bytes.next() {
                Some(b'x') => {
                    bytes.by_ref().take(2).fold(0, |n, b| n << 4 | char::from(b).to_digit(16).unwrap_or(0) as u8)
                }
                Some(b'r') => b'\r',
                Some(b'n') => b'\n',
                Some(b't') => b'\t',
                other => other.unwrap_or(b'\\'),
            },
            byte => byte,
        });
    }
    out
}

/// Random commands of every kind.
fn random() -> Vec<Command> {
    let mut runner = TestRunner::deterministic();
    let strategy = commands();
    let trees = (0..RANDOM).filter_map(|_| strategy.new_tree(&mut runner).ok());
    trees.map(|tree| tree.current()).collect()
}

/// The bytes of each script, and the commands in them.
fn streams_of_scripts() -> impl Iterator<Item = Vec<u8>> {
    let bytes = |step: &Step| if let Step::Bytes(bytes) = step { Some(bytes.clone()) } else { None };
    scripts().iter().map(move |script| script.iter().filter_map(bytes).collect::<Vec<_>>().concat())
}

fn command_lists() -> impl Iterator<Item = Vec<Command>> {
    let read = |stream: Vec<u8>| {
        let mut reader = CommandReader::default();
        reader.push(&stream);
        reader.filter_map(|item| Some(item.ok()?.command)).collect::<Vec<_>>()
    };
    let lists = streams_of_scripts().map(read).filter(|list| !list.is_empty());
    lists.chain(random().chunks(2).map(<[_]>::to_vec).collect::<Vec<_>>())
}

fn texts_of(commands: &[Command]) -> Vec<u8> {
    let mut text = Vec::new();
    commands.iter().for_each(|command| print(command, &mut text));
    text
}

/// For the parser.
pub fn texts() -> Vec<Vec<u8>> {
    let random = random();
    streams_of_scripts().chain(random.chunks(2).map(texts_of)).map(short).collect()
}

fn short(mut input: Vec<u8>) -> Vec<u8> {
    input.truncate(crate::mutation::LONGEST);
    input
}

/// For the decoders of packets: text, packets in every form, words, captures.
pub fn streams() -> Vec<Vec<u8>> {
    let mut streams: Vec<Vec<u8>> = streams_of_scripts().take(100).collect();
    for (index, list) in command_lists().step_by(3).enumerate() {
        let packets = PacketForm::ALL[index % 3].0;
        let data = DataForm::ALL[index / 3 % 3].0;
        let mut stream = Vec::new();
        if write_commands_as(Sending { packets, data }, &list, &mut stream).is_ok() {
            streams.push(stream);
        }
    }
    for (route, _) in Route::KNOWN {
        for (form, _) in PacketForm::ALL {
            let mut stream = Vec::new();
            if write_packet_as(form, route, b"P 1\x10\x16 text\r\n", &mut stream).is_ok() {
                streams.push(stream);
            }
        }
    }
    streams.push(words());
    streams.extend(rasters());
    let events = [
        Event::Open("tcp:127.0.0.1:40000".into()),
        Event::FromHost(b"DISPLAY A;\r\n\x1c 0'\\".to_vec()),
        Event::ToHost(b"1V 0.25,-0.125 \r\n".to_vec()),
        Event::Close,
    ];
    let mut capture = format!("{HEADER}\n");
    for (micros, event) in (0..).step_by(1_000_300).zip(events) {
        Record { micros, line: 1, event }.write(&mut capture);
    }
    streams.push(capture.into_bytes());
    streams.into_iter().map(short).collect()
}

fn words() -> Vec<u8> {
    let mut out = Vec::new();
    for code in 0..16 {
        parallel::write_word(code << 12 | 1, &mut out);
        parallel::write_block(b"DISPLAY A;", &mut out);
    }
    parallel::write_reset(&mut out);
    out
}

fn rasters() -> Vec<Vec<u8>> {
    let entries = vec![LookupEntry { count: 3, color: [1, 2, 3] }];
    let runs = vec![Run { count: 700, color: [255, 0, 9] }, Run { count: 1, color: [0; 3] }];
    let commands = [RasterCommand::LookupTable { index: 250, entries }, RasterCommand::Runs(runs)];
    let sendings = PacketForm::ALL.into_iter().flat_map(|p| [DataForm::EightBit, DataForm::SixBit].map(|d| (p.0, d)));
    let stream = |(packets, data)| {
        let mut out = Vec::new();
        write_raster_as(Sending { packets, data }, &commands, &mut out).ok().map(|()| out)
    };
    sendings.filter_map(stream).collect()
}

/// For the decoders of records.
pub fn records() -> Vec<Vec<u8>> {
    let mut out = Vec::new();
    for list in command_lists() {
        let mut body = Vec::new();
        for command in &list {
            if encode(command, &mut body).is_ok() && body.len() % 3 == 0 {
                body.extend_from_slice(BETWEEN);
            }
        }
        out.push(short(body));
    }
    out
}

/// For the machine: the scripts as sessions, and the same in packets.
pub fn sessions() -> Vec<Vec<u8>> {
    let mut out = Vec::new();
    for script in scripts() {
        let mut input = Vec::new();
        for step in script {
            match step {
                Step::Bytes(bytes) => input.extend_from_slice(bytes),
                Step::Order(order) => {
                    input.extend([session::MARK, session::ORDER]);
                    input.extend_from_slice(order.as_bytes());
                    input.push(b'\n');
                }
                Step::Frames(count) => (0..(*count).min(4)).for_each(|_| input.extend([session::MARK, session::FRAME])),
            }
        }
        input.extend([session::MARK, session::FRAME]);
        out.push(short(input));
    }
    out.extend(streams());
    out.push([&[session::MARK, session::PARALLEL], &words()[..]].concat());
    out
}
