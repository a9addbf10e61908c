//! What a picture file tells of how its picture was made. It holds only what is the same in every run.

use glam::DVec2;

/// Rows of text that say how a picture was made, and its white.
///
/// In EXR files the rows are lines `Key: value` of the attribute `comments`, beside `software`, `chromaticities` and
/// `adoptedNeutral`; in PNG files each is a text chunk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    rows: Vec<(&'static str, String)>,
    pub(super) white: Option<DVec2>,
}

/// The program and its version.
pub(super) const SOFTWARE: &str = concat!("PERIS ", env!("CARGO_PKG_VERSION"));

impl Provenance {
    /// - `white`: chromaticity x, y of the light that is shown as white; without one, that of D65.
    pub fn new(white: Option<DVec2>) -> Provenance {
        Provenance { rows: Vec::new(), white }
    }

    /// These rows, and one more.
    ///
    /// - `key`: 1 to 79 letters; the keywords of PNG where one fits.
    pub fn with(mut self, key: &'static str, value: impl ToString) -> Provenance {
        self.rows.push((key, value.to_string()));
        self
    }

    /// All rows, in order.
    pub fn rows(&self) -> &[(&'static str, String)] {
        &self.rows
    }

    /// All rows as lines of text.
    pub(super) fn text(&self) -> String {
        self.rows.iter().map(|(key, value)| format!("{key}: {value}")).collect::<Vec<_>>().join("\n")
    }
}
