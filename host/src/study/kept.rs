//! What of a study is done, in a file: who goes on with the study gets it from there.
//!
//! Layout: eight bytes of name and version; a fingerprint of the study (u32); a checksum of the rest (CRC-32, u32); and what
//! was done, in the order in which it was done. Numbers are little-endian.

use super::StudyError;
use bincode::config::{Configuration, standard};
use files::Destination;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// What such a file begins with; the last byte is the version.
const MAGIC: [u8; 8] = *b"PERISS\x00\x01";
/// Bytes before what was done.
const HEAD: usize = 16;
/// The longest file that is read, bytes.
const MAX_BYTES: u64 = 4 << 30;

const ENCODING: Configuration = standard();

/// Why what was done cannot be taken up.
#[derive(Debug, thiserror::Error)]
pub enum KeptError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is of another study, or damaged.
    #[error("{}: {problem}", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: &'static str,
    },
}

/// What of a study is done, each part once and always in the same order.
#[derive(Debug, Default)]
pub struct Kept<T> {
    /// Where it is kept, and the fingerprint of the study; nowhere without.
    file: Option<(Destination, u32)>,
    parts: Mutex<Parts<T>>,
}

#[derive(Debug)]
struct Parts<T> {
    done: Vec<T>,
    /// The number of the part that is asked for next, from 0.
    next: usize,
}

impl<T> Default for Parts<T> {
    fn default() -> Parts<T> {
        Parts { done: Vec::new(), next: 0 }
    }
}

impl<T: Clone + Serialize + DeserializeOwned> Kept<T> {
    /// A study that is kept nowhere.
    pub fn nowhere() -> Kept<T> {
        Kept { file: None, parts: Mutex::default() }
    }

    /// A study that begins, and is kept in a file.
    ///
    /// - `study`: whatever its parts depend on, in words.
    pub fn begin(destination: Destination, study: &str) -> Kept<T> {
        Kept { file: Some((destination, crc32fast::hash(study.as_bytes()))), parts: Mutex::default() }
    }

    /// A study that goes on with what is in the file, if there is one.
    ///
    /// # Errors
    /// [`KeptError`] for a file of another study, or one that is damaged.
    pub fn resume(destination: Destination, study: &str) -> Result<Kept<T>, KeptError> {
        let kept = Kept::begin(destination, study);
        let Some((destination, fingerprint)) = &kept.file else { return Ok(kept) };
        if destination.path().exists() {
            let done = read(destination.path(), *fingerprint)?;
            *kept.parts.lock().unwrap_or_else(PoisonError::into_inner) = Parts { done, next: 0 };
        }
        Ok(kept)
    }

    /// The next part: from the file, or made now and kept.
    ///
    /// That it cannot be kept is told of, and no reason to stop.
    ///
    /// # Errors
    /// Those of `make`.
    pub(super) fn next(&self, make: impl FnOnce() -> Result<T, StudyError>) -> Result<T, StudyError> {
        let mut parts = self.parts.lock().unwrap_or_else(PoisonError::into_inner);
        if parts.next == parts.done.len() {
            let part = make()?;
            parts.done.push(part);
            if let Err(error) = self.write(&parts.done) {
                tracing::warn!("{error}");
            }
        }
        parts.next += 1;
        Ok(parts.done[parts.next - 1].clone())
    }

    fn write(&self, done: &[T]) -> Result<(), files::WriteError> {
        let Some((destination, fingerprint)) = &self.file else { return Ok(()) };
        destination.write(|file| {
            let content = bincode::serde::encode_to_vec(done, ENCODING).map_err(std::io::Error::other)?;
            file.write_all(&MAGIC)?;
            file.write_all(&fingerprint.to_le_bytes())?;
            file.write_all(&crc32fast::hash(&content).to_le_bytes())?;
            file.write_all(&content)
        })
    }

    /// Ends the study: the file is of no use any more, and is removed.
    pub fn finish(self) {
        if let Some((destination, _)) = self.file {
            // That it cannot be removed harms nobody.
            let _ = std::fs::remove_file(destination.path());
        }
    }
}

fn read<T: DeserializeOwned>(path: &Path, fingerprint: u32) -> Result<Vec<T>, KeptError> {
    let failed = |source| KeptError::File { path: path.into(), source };
    let other = |problem| KeptError::Other { path: path.into(), problem };
    let bytes = files::read(path, MAX_BYTES).map_err(failed)?;
    let (head, content) = bytes.split_at_checked(HEAD).ok_or_else(|| other("this is no file of a study"))?;
    if !head.starts_with(&MAGIC) {
        return Err(other("this is no file of a study, or of one of another version"));
    }
    if head[8..12] != fingerprint.to_le_bytes() {
        return Err(other("this is of another study: its scene, options or settings differ"));
    }
    if head[12..] != crc32fast::hash(content).to_le_bytes() {
        return Err(other("its checksum is wrong"));
    }
    match bincode::serde::decode_from_slice(content, ENCODING) {
        Ok((done, used)) if used == content.len() => Ok(done),
        _ => Err(other("its content cannot be understood")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_goes_on_with_what_was_done_and_leaves_no_file_at_its_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.state");
        let destination = || Destination::of(&path).expect("a destination");
        let first = Kept::begin(destination(), "a study");
        assert_eq!((0..2).map(|part| first.next(|| Ok(part)).expect("made")).collect::<Vec<i32>>(), [0, 1]);
        assert!(matches!(first.next(|| Err(StudyError::Interrupted)), Err(StudyError::Interrupted)));
        let second = Kept::resume(destination(), "a study").expect("resumed");
        assert_eq!((0..3).map(|part| second.next(|| Ok(10 * part)).expect("made")).collect::<Vec<i32>>(), [0, 1, 20]);
        assert!(Kept::<i32>::resume(destination(), "another").is_err());
        let whole = std::fs::read(&path).expect("there");
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            std::fs::write(&path, bytes).expect("written");
            assert!(Kept::<i32>::resume(destination(), "a study").is_err(), "byte {at}");
        }
        second.finish();
        assert!(!path.exists());
    }
}
