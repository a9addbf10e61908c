//! Cases made from the table of functions: each example of each row, played over the wire.

use super::case::{Case, Expected, Step, Tag};
use protocol::{
    Name, Value,
    command::{Command, CommandReader, Destination, Input, print},
};
use ps340::functions::{Confidence, FAMILIES, FunctionExample, FunctionRow};

/// Allowed difference of printed numbers: F:PRINT has nine digits.
const TOLERANCE: f64 = 1e-8;
/// The name of the instance.
const INSTANCE: &str = "TESTED";
/// Numbers of the machine's messages that are warnings: no such input or output; queue full, clock late.
const WARNINGS: [u16; 2] = [9, 12];

/// Functions whose messages the rest of the machine carries out or answers: an example says what they do themselves,
/// and what comes of it the written cases say.
const ANSWERED: [&str; 7] = ["CI", "FETCH", "LBL_EXTRACT", "RASTERSTREAM", "READDISK", "READSTREAM", "SEND"];
/// The start characters of packets, which bare text cannot hold.
const STARTS: [u8; 2] = [0x1c, 0x16];

/// The section of the reference for a family of functions.
fn section(family: &str) -> &'static str {
    match family {
        "arithmetic" | "logic" | "vectors" => "C.4",
        "comparison" => "C.5",
        "transformation" | "viewing" => "C.6",
        "routing" | "accumulation" => "C.7",
        "clocks" => "C.8",
        "strings" => "C.9",
        "printing" => "C.10",
        "selection" => "C.11",
        _ => "C.12",
    }
}

/// A case for each example that the command language can express.
pub fn cases() -> Vec<Case> {
    let rows = FAMILIES.iter().flat_map(|(family, rows)| rows.iter().map(move |row| (section(family), row)));
    let examples = rows.flat_map(|(section, row)| (1..).zip(row.examples).map(move |(n, e)| (section, row, n, e)));
    examples.filter_map(|(section, row, n, example)| case(section, row, n, example)).collect()
}

/// The command that sends a value; none if the language has no form for it, or bare text cannot carry it.
fn sending(input: u16, value: Value) -> Option<String> {
    let destination = Destination { input: Input::Number(input.into()), name: Name::new(INSTANCE).ok()? };
    let command = Command::Send { value, destination };
    let mut text = Vec::new();
    print(&command, &mut text);
    let mut reader = CommandReader::default();
    reader.push(&text);
    let is_read_back = reader.next().is_some_and(|read| read.is_ok_and(|read| read.command == command));
    let is_bare = !text.iter().any(|byte| STARTS.contains(byte));
    (is_read_back && is_bare).then(|| String::from_utf8(text).ok())?
}

fn case(section: &str, row: &FunctionRow, number: usize, example: &FunctionExample) -> Option<Case> {
    if ANSWERED.contains(&row.name) {
        return None;
    }
    let tag = match row.source.confidence {
        Confidence::Confirmed => Tag::S,
        Confidence::Manual => Tag::M,
        Confidence::Uncertain => Tag::U,
    };
    let id = format!("table-{}-{number}", row.name);
    let title = format!("F:{}: {} (example {number} of the table)", row.name, row.summary);
    let mut case = Case { tolerance: TOLERANCE, ..Case::new(&id, &title, section, tag) };
    case.file = "table of functions".into();
    let size = if example.size > 0 { format!("({})", example.size) } else { String::new() };
    let mut steps = vec![Step::Send(format!("{INSTANCE} := F:{}{size};\n", row.name))];
    let outputs = row.shape((example.size > 0).then_some(example.size)).ok()?.outputs;
    for output in 1..=outputs {
        steps.push(Step::Watch { name: INSTANCE.into(), output, word: Some(output.to_string()) });
    }
    for (input, literal) in example.sends {
        steps.push(Step::Send(format!("{}\n", sending(*input, literal.value())?)));
    }
    let mut expected = Vec::new();
    for (output, literal) in example.results {
        expected.push(printed(*output, &literal.value())?);
    }
    for number in example.faults {
        let class = if WARNINGS.contains(number) { 'W' } else { 'E' };
        expected.push(Expected::Fault { class, number: Some(*number), text: None });
    }
    // Messages about faults may overtake results.
    if example.faults.is_empty() || expected.len() < 2 {
        steps.extend(expected.into_iter().map(Step::Expect));
    } else {
        steps.push(Step::Expect(Expected::AnyOrder(expected)));
    }
    steps.push(Step::Silence);
    case.steps = steps.into_iter().map(|step| (0, step)).collect();
    Some(case)
}

/// What F:PRINT makes of a value, written independently of the machine's own printing; none if there is no form, or the
/// text has ends of messages inside.
fn printed(output: u16, value: &Value) -> Option<Expected> {
    let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let numbers = |text: String| Some(Expected::Numbers(format!("{output} {text}")));
    match value {
        Value::String(text) if text.contains(&b'\n') => None,
        Value::String(text) => {
            let mut exact = format!("{output} ").into_bytes();
            exact.extend_from_slice(text);
            Some(Expected::Exact(exact))
        }
        Value::Boolean(b) => Some(Expected::Exact(format!("{output} {}", if *b { "TRUE" } else { "FALSE" }).into())),
        Value::Integer(i) => Some(Expected::Exact(format!("{output} {i}").into())),
        Value::Real(r) => numbers(list(&[*r])),
        Value::Vector2(v) => numbers(format!("V {}", list(&v.to_array()))),
        Value::Vector3(v) => numbers(format!("V {}", list(&v.to_array()))),
        Value::Vector4(v) => numbers(format!("V {}", list(&v.to_array()))),
        Value::Matrix2(m) => numbers(format!("M {}", list(&m.to_cols_array()))),
        Value::Matrix3(m) => numbers(format!("M {}", list(&m.to_cols_array()))),
        Value::Matrix4(m) => numbers(format!("M {}", list(&m.to_cols_array()))),
        Value::Matrix4x3(m) => {
            let rows = m.to_cols_array_2d();
            numbers(format!("M {}", rows.map(|row| list(&row[..3])).join(" ")))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_every_row_has_a_case() {
        let cases = cases();
        let without: Vec<&str> = FAMILIES
            .iter()
            .flat_map(|(_, rows)| rows.iter())
            .filter(|row| row.clock.is_none())
            .map(|row| row.name)
            .filter(|name| !cases.iter().any(|case| case.id.starts_with(&format!("table-{name}-"))))
            .collect();
        assert!(cases.len() > 150 && without.len() < 14, "{} cases, none for {without:?}", cases.len());
    }
}
