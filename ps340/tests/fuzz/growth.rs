//! New statements about few names, so that what chance makes is connected.

use crate::{chance::Chance, mutation::NUMBERS, session};
use protocol::command::reference;
use ps340::functions::{self, devices::initial};
use std::sync::OnceLock;

/// The names of users in grown statements.
const NAMES: &[&str] = &["A", "B", "C", "V", "W", "N", "P", "A.B"];
/// Inputs of nodes that have names.
const INPUTS: &[&str] = &["append", "clear", "delete", "last", "position", "step", "substitute"];

/// Acts of a person.
const ORDERS: &[&str] = &[
    "dial 1 0.25",
    "dial 8 -3",
    "dial 3 1e300",
    "key 1",
    "key 12 shift",
    "button 32",
    "puck move 0.1 0.2",
    "puck move -1 1",
    "puck press 1",
    "puck press 15",
    "puck release",
    "puck away",
    "stylus move 0 0",
    "stylus down",
    "type ABC\\r",
    "type SEND 1 TO <1>A;\\r",
    "type \\e[5;5H\\x07\\d\\b",
    "mode terminal",
    "mode command",
    "mode interactive",
    "key setup",
    "key graph",
    "key term",
    "frames 5",
    "idle 10",
    "message 5",
];

/// A statement, or an act.
pub fn statement(chance: &mut Chance) -> String {
    let name = name(chance);
    match chance.below(22) {
        0..=2 => {
            let rows: Vec<_> = functions::all().collect();
            let size = if chance.one_in(3) { format!("({})", 1 + chance.below(5)) } else { String::new() };
            format!("{name} := F:{}{size};\n", chance.pick(&rows).name)
        }
        3..=6 => {
            let (output, input) = (1 + chance.below(4), 1 + chance.below(4));
            format!("CONNECT {}<{output}>:<{}>{name};\n", self::name(chance), input_of(chance, input))
        }
        7..=11 => {
            let input = 1 + chance.below(5);
            format!("SEND {} TO <{}>{name};\n", value(chance), input_of(chance, input))
        }
        12 | 13 => example(chance, name),
        14 => format!("{name} := INSTANCE OF {},{};\n", self::name(chance), self::name(chance)),
        15 => format!("INCLUDE {} IN {name};\n", self::name(chance)),
        16 => format!("DISPLAY {name};\n"),
        17 => {
            let ends = ["REMOVE", "FORGET", "DELETE", "REMOVE PREFIX OF", "REMOVE FOLLOWER OF"];
            format!("{} {name};\n", chance.pick(&ends))
        }
        18 => {
            let constant = if chance.one_in(2) { "TRUE" } else { "FALSE" };
            format!("SETUP CNESS {constant} <{}>{name};\n", 1 + chance.below(4))
        }
        19 => format!("{name} := BEGIN_STRUCTURE\n{}{}END_STRUCTURE;\n", example(chance, "B"), example(chance, "")),
        20 => {
            let ways = ["PREFIX", "FOLLOW"];
            let way = *chance.pick(&ways);
            let line = example(chance, "");
            let node = line.split_once(":=").map_or(&line[..], |(_, node)| node);
            format!("{way} {name} WITH {node}")
        }
        _ => act(chance),
    }
}

fn act(chance: &mut Chance) -> String {
    // The mark of an act is no character; it is put in where the statement becomes bytes.
    let frame = char::from(session::FRAME);
    let order = char::from(session::ORDER);
    match chance.below(3) {
        0 => format!("{ACT}{frame}"),
        1 => format!("{ACT}{order}{}\n", chance.pick(ORDERS)),
        _ => format!("{ACT}{}", char::from(*chance.pick(session::ACTS))),
    }
}

/// Stands for [`session::MARK`] in a statement.
const ACT: char = '\u{0}';

/// The bytes of statements.
pub fn bytes(statements: &str) -> Vec<u8> {
    statements.bytes().map(|byte| if byte == 0 { session::MARK } else { byte }).collect()
}

fn name(chance: &mut Chance) -> &'static str {
    static SYSTEM: OnceLock<Vec<String>> = OnceLock::new();
    let system = SYSTEM.get_or_init(|| initial().map(|initial| initial.name).collect());
    if chance.one_in(4) { chance.pick::<String>(system) } else { chance.pick::<&str>(NAMES) }
}

fn input_of(chance: &mut Chance, number: usize) -> String {
    if chance.one_in(5) { (*chance.pick(INPUTS)).into() } else { number.to_string() }
}

fn number(chance: &mut Chance) -> String {
    match chance.below(3) {
        0 => (*chance.pick(NUMBERS)).into(),
        1 => (chance.below(21) as i32 - 10).to_string(),
        _ => format!("{}", (chance.below(2001) as f64 - 1000.0) / 1000.0),
    }
}

fn value(chance: &mut Chance) -> String {
    let mut row = |count: usize| (0..count).map(|_| number(chance)).collect::<Vec<_>>().join(",");
    let rows = [row(1), row(2), row(3), row(4), row(1), row(1)];
    match chance.below(12) {
        0 | 1 => format!("FIX({})", rows[0]),
        2 => "TRUE".into(),
        3 => "FALSE".into(),
        4 => format!("V2D({})", rows[1]),
        5 => format!("V3D({})", rows[2]),
        6 => format!("V4D({})", rows[3]),
        7 => format!("M3D({0} {0} {0})", rows[2]),
        8 => format!("M4D({0} {0} {0} {0})", rows[3]),
        9 => format!("'{} {}'", NAMES[rows[0].len() % NAMES.len()], rows[4]),
        10 => format!("CHAR({})", rows[5]),
        _ => rows[0].clone(),
    }
}

/// The example of a command of the reference, with the names of users in it and other numbers.
fn example(chance: &mut Chance, name: &str) -> String {
    let rows: Vec<_> = reference::rows().collect();
    let example = chance.pick(&rows).example;
    let Some((before, after)) = example.split_once(":=") else { return format!("{example}\n") };
    let label = if name.is_empty() { before.trim() } else { name };
    let after = match after.rsplit_once(" TO ") {
        Some((node, _)) => format!("{node} TO {};", self::name(chance)),
        None => after.to_owned(),
    };
    let after: String = after.chars().map(|c| if c.is_ascii_digit() && chance.one_in(4) { '7' } else { c }).collect();
    format!("{label} :={after}\n")
}

#[test]
fn most_of_what_grows_can_be_read() {
    let mut chance = Chance::new(1);
    let statements: Vec<String> = (0..2_000).map(|_| statement(&mut chance)).collect();
    let grown: Vec<&String> = statements.iter().filter(|statement| !statement.contains(ACT)).collect();
    let read = |statement: &str| {
        let mut reader = protocol::command::CommandReader::default();
        reader.push(statement.as_bytes());
        reader.all(|item| item.is_ok())
    };
    let good = grown.iter().filter(|statement| read(statement)).count();
    assert!(good * 10 > grown.len() * 7, "{good} of {}", grown.len());
}
