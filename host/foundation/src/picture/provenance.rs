//! What a picture file tells of how its picture was made. It holds only what is the same in every run.

use super::source::format_of;
use exr::meta::MetaData;
use glam::DVec2;
use image::ImageFormat;
use png::{Decoder, Limits};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Most bytes that a reader of PNG files may take for what is no pixel.
const MOST_BESIDE: usize = 16 << 20;

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

    /// What a picture file that is there tells in one of its rows; none where it has no such row, or is no PNG or EXR
    /// file that can be read.
    ///
    /// - `key`: of the row, whose value is of ASCII letters.
    pub fn value_in(path: &Path, key: &str) -> Option<String> {
        let format = format_of(path).ok()?;
        let file = BufReader::new(files::open(path).ok()?);
        match format {
            ImageFormat::Png => of_png(file, key),
            ImageFormat::OpenExr => of_exr(file, key),
            _ => None,
        }
    }

    /// All rows as lines of text.
    pub(super) fn text(&self) -> String {
        self.rows.iter().map(|(key, value)| format!("{key}: {value}")).collect::<Vec<_>>().join("\n")
    }
}

fn of_png(file: BufReader<File>, key: &str) -> Option<String> {
    let reader = Decoder::new_with_limits(file, Limits { bytes: MOST_BESIDE }).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    texts.iter().find(|chunk| chunk.keyword == key).map(|chunk| chunk.text.clone())
}

fn of_exr(file: BufReader<File>, key: &str) -> Option<String> {
    let about = MetaData::read_from_buffered(file, false).ok()?;
    let comments = about.headers.first()?.own_attributes.comments.as_ref()?.to_string();
    let rows = comments.lines().filter_map(|line| line.split_once(": "));
    rows.into_iter().find(|(found, _)| *found == key).map(|(_, value)| value.to_owned())
}

#[cfg(test)]
mod tests {
    use super::super::Picture;
    use super::*;

    #[test]
    fn rows_of_written_files_are_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let provenance = Provenance::new(None).with("Source", "a: b").with("Samples", "1 to 2");
        for name in ["a.png", "a.exr"] {
            let path = folder.path().join(name);
            let picture = Picture::new(3, 2).expect("small");
            picture.write_with(&Picture::destination(&path).expect("a destination"), &provenance).expect("written");
            assert_eq!(Provenance::value_in(&path, "Source").as_deref(), Some("a: b"), "{name}");
            assert_eq!(Provenance::value_in(&path, "Samples").as_deref(), Some("1 to 2"), "{name}");
            assert_eq!(Provenance::value_in(&path, "Ample"), None);
            std::fs::write(&path, "a text").expect("written");
            assert_eq!(Provenance::value_in(&path, "Source"), None);
        }
        assert_eq!(Provenance::value_in(&folder.path().join("none.png"), "Source"), None);
    }
}
