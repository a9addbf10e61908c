//! The reference of the functions as text, made from the rows.

use super::{Confidence, FAMILIES, Family, FunctionExample, FunctionRow, Rule, devices};
use crate::port::{PortSpec, QueueRole};
use protocol::command::spelling::nearest;
use std::fmt::Write;

/// Width of the first column.
const COLUMN: usize = 17;

/// No function has a name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no function {name}{}", .meant.map_or(String::new(), |meant| format!("; did you mean {meant}?")))]
pub struct UnknownFunction {
    /// The name that was asked for.
    pub name: String,
    /// The one that was probably meant.
    pub meant: Option<&'static str>,
}

/// All functions by families, then the initial instances: a line each.
pub fn table() -> String {
    let mut text = String::new();
    let system = devices::FAMILIES.iter().map(|(family, rows)| (format!("initial instances: {family}"), *rows));
    let user = FAMILIES.iter().map(|(family, rows)| ((*family).to_owned(), *rows));
    for (family, rows) in user.chain(system) {
        let _ = writeln!(text, "{family}");
        for row in rows {
            let _ = writeln!(text, "  {:COLUMN$} {}", title(row), row.summary);
        }
        text.push('\n');
    }
    text.push_str("One of them in full: ps340 functions NAME\n");
    text
}

/// Everything about one function.
///
/// - `name`: with or without `F:` and a size, in any case.
///
/// # Errors
/// [`UnknownFunction`].
pub fn page(name: &str) -> Result<String, UnknownFunction> {
    let upper = name.trim().to_ascii_uppercase();
    let bare = upper.strip_prefix("F:").unwrap_or(&upper);
    let bare = bare.split_once('(').map_or(bare, |(bare, _)| bare);
    let rows = || {
        let initial = devices::rows().map(|row| ("initial instances", row));
        FAMILIES.iter().flat_map(|(family, rows)| rows.iter().map(|row| (*family, row))).chain(initial)
    };
    match rows().find(|(_, row)| row.name == bare) {
        Some((family, row)) => Ok(describe(family, row)),
        None => {
            let meant = nearest(bare, rows().map(|(_, row)| row.name));
            Err(UnknownFunction { name: bare.to_string(), meant })
        }
    }
}

/// How the function is written where it is instanced.
fn title(row: &FunctionRow) -> String {
    let initial = devices::rows().any(|device| device.name == row.name);
    match row.family {
        Family::Device if initial => format!("{}n", row.name),
        _ if initial => row.name.into(),
        Family::Single => format!("F:{}", row.name),
        Family::Device => format!("F:{}[(n)]", row.name),
        Family::Inputs | Family::Outputs | Family::Channels => format!("F:{}(n)", row.name),
    }
}

fn describe(family: &str, row: &FunctionRow) -> String {
    let mut text = format!("{}: {}\n\n", title(row), row.summary);
    let mut line = |label: &str, content: &str| {
        let _ = writeln!(text, "{label:10}{content}");
    };
    line("family", family);
    let several = matches!(row.family, Family::Inputs | Family::Channels);
    let repeated = if row.inputs.len() > 1 { "n-1" } else { "n" };
    for (i, port) in row.inputs.iter().enumerate() {
        let number = match i {
            0 if several => format!("<1>..<{repeated}>"),
            i if several => format!("<n-{}>", row.inputs.len() - 1 - i).replace("<n-0>", "<n>"),
            i => format!("<{}>", i + 1),
        };
        line(if i == 0 { "inputs" } else { "" }, &format!("{number} {}", input(port)));
    }
    for (i, output) in row.outputs.iter().enumerate() {
        let many = matches!(row.family, Family::Outputs | Family::Channels);
        let number = if many { "<1>..<n>".into() } else { format!("<{}>", i + 1) };
        line(if i == 0 { "outputs" } else { "" }, &format!("{number} {output}"));
    }
    line("fires", fires(row));
    let known = match row.source.confidence {
        Confidence::Confirmed => "confirmed by programs of the time",
        Confidence::Manual => "remembered from the manuals",
        Confidence::Uncertain => "uncertain",
    };
    line("source", known);
    if !row.source.note.is_empty() {
        line("notes", row.source.note);
    }
    for (i, sample) in row.examples.iter().enumerate() {
        line(if i == 0 { "examples" } else { "" }, &example(sample));
    }
    text
}

fn fires(row: &FunctionRow) -> &'static str {
    match row.rule {
        _ if row.inputs.is_empty() => "when the device does something",
        _ if row.clock.is_some() => "as time passes",
        Rule::All => "when all active inputs have a message and all constants that it needs a value",
        Rule::Any => "when any active input has a message",
    }
}

fn input(port: &PortSpec) -> String {
    let role = match port.role {
        QueueRole::Active => "active".into(),
        QueueRole::Constant => "constant".into(),
        QueueRole::Optional => "constant, not needed".into(),
        QueueRole::Default(value) => format!("constant, {value} at first"),
    };
    format!("{} ({role}): {}", port.kinds, port.summary)
}

fn example(example: &FunctionExample) -> String {
    let list = |messages: &[(u16, crate::port::Literal)]| {
        messages.iter().map(|(place, value)| format!("<{place}> {value}")).collect::<Vec<_>>().join(", ")
    };
    let size = if example.size > 0 { format!("n = {}: ", example.size) } else { String::new() };
    let mut results = list(example.results);
    if results.is_empty() {
        results.push_str("nothing");
    }
    for fault in example.faults {
        let _ = write!(results, ", E {fault}");
    }
    format!("{size}{} gives {results}", list(example.sends))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_says_what_the_row_says() {
        let page = page("f:route(4)").unwrap();
        for part in [
            "F:ROUTE(n)",
            "<1> integer (active): output, 1 to n",
            "<1>..<n> <2>",
            "confirmed by programs",
            "n = 9: <1> FIX(9), <2> FIX(9)",
            "gives <3> 'C', E 6, E 6",
        ] {
            assert!(page.contains(part), "{part} in\n{page}");
        }
        assert!(super::page("INPUTS_CHOOSE").unwrap().contains("<1>..<n-1> any (constant)"));
        assert!(super::page("dlabel").unwrap().starts_with("DLABELn: "));
    }

    #[test]
    fn every_function_is_in_the_table_and_has_a_page() {
        let table = table();
        for row in super::super::all().chain(devices::rows()) {
            assert!(table.contains(&format!("  {}", title(row))), "{}", row.name);
            let page = page(row.name).unwrap();
            assert!(page.lines().count() >= 4 && page.contains(row.summary), "{page}");
        }
    }

    #[test]
    fn a_slip_finds_the_function_that_was_meant() {
        let error = page("F:DXROTAT").unwrap_err();
        assert_eq!(error.to_string(), "there is no function DXROTAT; did you mean DXROTATE?");
        assert_eq!(page("ZZZZZZZZ").unwrap_err().meant, None);
    }
}
