//! The view that is set, told as a line of a script.

use crate::cli::{CommandFailure, output::warn};
use crate::{production::Production, script::camera_call};
use files::Destination;
use std::io::Write;

/// The view as somebody was told of it.
pub(super) struct ViewReporter {
    /// Where it is written, too.
    file: Option<Destination>,
    /// Whether nobody is told.
    is_quiet: bool,
    /// The line that was told last.
    last: String,
}

impl ViewReporter {
    /// Nobody has been told yet.
    ///
    /// - `file`: takes the line, too. `is_quiet`: whether only that does.
    pub(super) fn new(file: Option<Destination>, is_quiet: bool) -> ViewReporter {
        ViewReporter { file, is_quiet, last: String::new() }
    }

    /// Tells the view that is set now, unless that was told already.
    pub(super) fn report(&mut self, production: &mut Production) -> Result<(), CommandFailure> {
        let Some(camera) = production.camera()? else {
            warn("no camera sees what is set: it is scaled unequally, or not seen at all");
            return Ok(());
        };
        let line = camera_call(&camera);
        if line == self.last {
            return Ok(());
        }
        if let Some(file) = &self.file {
            file.write_or_save_elsewhere(|file| writeln!(file, "{line}"))?;
        }
        if !self.is_quiet {
            say!("{line}");
        }
        self.last = line;
        Ok(())
    }
}
