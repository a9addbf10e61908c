//! The functions of the machine: one row each, by families.
//!
//! A row says everything that is known about a function: its inputs and outputs, where the knowledge comes from,
//! what it does, and examples that a test runs. The network, messages and pages of help are made from the rows.

mod row;

pub mod accumulation;
pub mod algebra;
pub mod arithmetic;
pub mod characters;
pub mod clocks;
pub mod comparison;
pub mod devices;
pub mod host_line;
pub mod labels;
pub mod logic;
pub mod naming;
pub mod page;
pub mod picking;
pub mod printing;
pub mod routing;
pub mod selection;
pub mod strings;
pub mod transformation;
pub mod vectors;
pub mod viewing;

pub use row::{
    Behaviour, ClockBehaviour, Confidence, Family, FunctionExample, FunctionRow, InPlace, MAX_SIZE, QueuePosition,
    Rule, Shape, SizeError, Source,
};

use std::{collections::HashMap, sync::LazyLock};

/// The families of functions that a command can instance, in the order of the manuals.
pub static FAMILIES: [(&str, &[FunctionRow]); 17] = [
    ("arithmetic", arithmetic::ROWS),
    ("logic", logic::ROWS),
    ("comparison", comparison::ROWS),
    ("vectors", vectors::ROWS),
    ("transformation", transformation::ROWS),
    ("viewing", viewing::ROWS),
    ("routing", routing::ROWS),
    ("accumulation", accumulation::ROWS),
    ("clocks", clocks::ROWS),
    ("strings", strings::ROWS),
    ("characters", characters::ROWS),
    ("printing", printing::ROWS),
    ("labels", labels::ROWS),
    ("picking", picking::ROWS),
    ("transformed data", selection::ROWS),
    ("names and files", naming::ROWS),
    ("host line", host_line::ROWS),
];

/// The rows of all functions that a command can instance.
pub fn all() -> impl Iterator<Item = &'static FunctionRow> {
    FAMILIES.iter().flat_map(|(_, rows)| rows.iter())
}

/// The row of a function.
///
/// - `name`: the type without `F:`, upper case.
pub fn find(name: &str) -> Option<&'static FunctionRow> {
    static BY_NAME: LazyLock<HashMap<&'static str, &'static FunctionRow>> =
        LazyLock::new(|| all().map(|row| (row.name, row)).collect());
    BY_NAME.get(name).copied()
}

#[cfg(test)]
mod tests;
