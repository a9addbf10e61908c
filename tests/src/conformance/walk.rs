//! Cases made from the table of functions: each example of each row, played over the wire.

use super::case::{Case, Expected, Step, Tag};
use protocol::{
    Name, Value,
    command::{Command, Destination, Input, print},
};
use ps340::functions::{Confidence, Example, FAMILIES, FunctionRow};

/// Allowed difference of printed numbers: F:PRINT has nine digits.
const TOLERANCE: f64 = 1e-8;
/// The name of the instance.
const INSTANCE: &str = "TESTED";
/// Numbers of the machine's messages that are warnings: no such input or output; queue full, clock late.
const WARNINGS: [u16; 2] = [9, 12];

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

fn case(section: &str, row: &FunctionRow, number: usize, example: &Example) -> Option<Case> {
    let tag = match row.source.confidence {
        Confidence::Confirmed => Tag::S,
        Confidence::Manual => Tag::M,
        Confidence::Uncertain => Tag::U,
        Confidence::Ours => Tag::C,
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
        let destination = Destination { input: Input::Number((*input).into()), name: Name::new(INSTANCE).ok()? };
        let mut text = Vec::new();
        print(&Command::Send { value: literal.value(), destination }, &mut text);
        steps.push(Step::Send(format!("{}\n", String::from_utf8(text).ok()?)));
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
    steps.push(Step::Quiet);
    case.steps = steps.into_iter().map(|step| (0, step)).collect();
    Some(case)
}

/// What F:PRINT makes of a value, written independently of the machine's own printing; none if there is no form.
fn printed(output: u16, value: &Value) -> Option<Expected> {
    let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let numbers = |text: String| Some(Expected::Numbers(format!("{output} {text}")));
    match value {
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
        assert!(cases.len() > 150 && without.len() < 8, "{} cases, none for {without:?}", cases.len());
    }
}
