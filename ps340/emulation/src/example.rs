//! The programs that ship with the machine.

use protocol::command::spelling::nearest;

/// A program for the machine, as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExampleProgram {
    /// Its name.
    pub name: &'static str,
    /// Its commands.
    pub text: &'static str,
}

/// Every program.
pub const EXAMPLES: &[ExampleProgram] = &[
    ExampleProgram { name: "dials", text: include_str!("../../programs/dials.ps300") },
    ExampleProgram { name: "pick", text: include_str!("../../programs/pick.ps300") },
    ExampleProgram { name: "clock", text: include_str!("../../programs/clock.ps300") },
    ExampleProgram { name: "helix", text: include_str!("../../programs/helix.ps300") },
];

impl ExampleProgram {
    /// What it shows: its first comment.
    pub fn summary(&self) -> &'static str {
        let comment = self.text.split_once('{').and_then(|(_, rest)| rest.split_once('}'));
        comment.map_or("", |(summary, _)| summary.trim())
    }
}

/// The program of a name.
///
/// # Errors
/// A sentence with the name that was meant, or all names.
pub fn example(name: &str) -> Result<&'static ExampleProgram, String> {
    if let Some(found) = EXAMPLES.iter().find(|e| e.name.eq_ignore_ascii_case(name)) {
        return Ok(found);
    }
    let names = || EXAMPLES.iter().map(|e| e.name);
    Err(match nearest(name, names()) {
        Some(meant) => format!("there is no example '{name}'; did you mean '{meant}'?"),
        None => format!("there is no example '{name}'; there are {}", names().collect::<Vec<_>>().join(", ")),
    })
}
