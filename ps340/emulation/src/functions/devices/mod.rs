//! The initial instances: devices, labels, lights, the screen's text and the host, as functions that exist at start.
//!
//! Sources have outputs only; the machine sends from them what a person does. Sinks ask the machine for an effect.

mod common;
pub mod control;
pub mod display;
pub mod line;
pub mod shading;
pub mod status;

use super::{Family, FunctionRow};

/// The initial instances by what they belong to.
pub static FAMILIES: [(&str, &[FunctionRow]); 5] = [
    ("control devices", control::ROWS),
    ("labels, lights and screen", display::ROWS),
    ("host line", line::ROWS),
    ("status", status::ROWS),
    ("shading", shading::ROWS),
];

/// A function that exists at start under a name of its own.
#[derive(Clone, Debug)]
pub struct InitialInstance {
    /// The name of the instance, such as `DLABEL3`.
    pub name: String,
    /// What it is.
    pub function: &'static FunctionRow,
    /// The number among several equal devices: 1..=8 for a dial label; none for a single one.
    pub device: Option<u16>,
}

/// The rows of all initial instances.
pub fn rows() -> impl Iterator<Item = &'static FunctionRow> {
    FAMILIES.iter().flat_map(|(_, rows)| rows.iter())
}

/// The initial instances: each row once, or once a device.
pub fn initial() -> impl Iterator<Item = InitialInstance> {
    // PICK is an instance of a function that a user can make too.
    let pick = super::picking::ROWS.iter().filter(|row| row.name == "PICK");
    rows().chain(pick).flat_map(|function| {
        let devices = match (function.family, function.name) {
            (Family::Device, "FLABEL") => 0..=12,
            (Family::Device, "CHANNEL") => 3..=7,
            (Family::Device, _) => 1..=8,
            _ => return vec![InitialInstance { name: function.name.into(), function, device: None }],
        };
        let several =
            devices.map(|n| InitialInstance { name: format!("{}{n}", function.name), function, device: Some(n) });
        several.collect()
    })
}

/// The initial instances of the host line, of which a line may have its own.
pub fn of_line() -> impl Iterator<Item = InitialInstance> {
    initial().filter(|initial| line::ROWS.iter().any(|row| row.name == initial.function.name))
}
