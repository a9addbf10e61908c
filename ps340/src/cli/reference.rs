//! `ps340 functions` and `ps340 commands`: the reference, from the tables.

use super::error::{ToolError, print};
use crate::functions::page;
use protocol::command::reference;
use std::process::ExitCode;

/// Prints the reference of the functions: all in a table, or one in full.
pub(super) fn functions(name: Option<&str>) -> Result<ExitCode, ToolError> {
    let text = match name {
        None => page::table(),
        Some(name) => page::page(name).map_err(|error| ToolError::Usage(error.to_string()))?,
    };
    print(&text).map(|()| ExitCode::SUCCESS)
}

/// Prints the reference of the commands: all in a table, or one in full.
pub(super) fn commands(words: &[String]) -> Result<ExitCode, ToolError> {
    let text = if words.is_empty() {
        reference::list()
    } else {
        let rows = reference::find(&words.join(" ")).map_err(|error| ToolError::Usage(error.to_string()))?;
        rows.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    print(&text).map(|()| ExitCode::SUCCESS)
}
