//! The entry of a command: its row of the table, printed for people.

use super::row::{CommandRow, InputRow, OptionRow};
use crate::command::{parse, syntax::Command};
use std::fmt;

impl fmt::Display for CommandRow {
    /// The whole entry, over several lines.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.name, self.summary)?;
        writeln!(f, "({}; section {})\n", self.confidence.word(), self.section)?;
        for line in self.syntax {
            writeln!(f, "    {line}")?;
        }
        let width = |lengths: &mut dyn Iterator<Item = usize>| lengths.max().unwrap_or(0);
        if !self.options.is_empty() {
            writeln!(f)?;
            let column = width(&mut self.options.iter().map(|o| o.form.len()));
            for OptionRow { form, meaning, range, default } in self.options {
                write!(f, "  {form:column$}  {meaning}")?;
                if !range.is_empty() {
                    write!(f, "; {range}")?;
                }
                if !default.is_empty() {
                    write!(f, " (default {default})")?;
                }
                writeln!(f)?;
            }
        }
        if !self.inputs.is_empty() {
            writeln!(f, "\nInputs of the node:")?;
            let column = width(&mut self.inputs.iter().map(|i| i.input.len()));
            let kinds = width(&mut self.inputs.iter().map(|i| i.takes.len()));
            for InputRow { input, takes, effect } in self.inputs {
                writeln!(f, "  {input:column$}  {takes:kinds$}  {effect}")?;
            }
        }
        if !self.routines.is_empty() {
            writeln!(f, "\nLibrary routines: {}", self.routines.join(", "))?;
        }
        writeln!(f, "\nExample:")?;
        for line in self.example.lines() {
            writeln!(f, "    {line}")?;
        }
        if let Ok(Command::Define { name: None, .. }) = parse(self.example.as_bytes()) {
            writeln!(f, "inside a structure; outside of one, an object needs a name: NAME := ...")?;
        }
        Ok(())
    }
}
