//! Results of long computations in a file, so that who does the same once more gets them from there.
//!
//! Layout: eight bytes of name and version; a fingerprint of what is computed (u32); then records, each the length of
//! its content (u64), a checksum of it (CRC-32, u32) and the content: results in the order in which they were asked
//! for. Numbers are little-endian. A last record that is not whole, as after a crash, is written anew.

use super::StateError;
use crate::encoding::{Integers, decode, encode};
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::convert::Infallible;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The first bytes of such a file; the last one is the version.
const MAGIC: [u8; 8] = *b"PERISM\x00\x07";
/// Bytes before the first record.
const HEAD: u64 = 12;
/// Most bytes of a record; a length in it that says more is no length.
const MOST: usize = 1 << 30;
/// Parts into which items are divided for each thread.
const PARTS: usize = 32;
/// Results of a record: computed in about a tenth of a second, and enough for many threads.
const CHUNK: usize = 8192;

/// Results that are kept in a file.
#[derive(Debug)]
pub struct Memo {
    path: PathBuf,
    state: Mutex<MemoState>,
}

/// The state of the file.
#[derive(Debug)]
enum MemoState {
    /// The results of before are read, up to a byte.
    Reading(BufReader<File>, u64),
    /// New results are written.
    Writing(File),
    /// The file could not be written, and is left as it is.
    Broken,
}

impl Memo {
    /// Continues with the results in a file, or begins one.
    ///
    /// - `fingerprint`: of all that the results depend on.
    ///
    /// # Errors
    /// [`StateError`]: the file cannot be read or written, or is of another computation.
    pub fn open(path: &Path, fingerprint: u32) -> Result<Memo, StateError> {
        let failed = |source| StateError::File { path: path.into(), source };
        let other = |what| StateError::Other { path: path.into(), what };
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed)?;
        let head = [&MAGIC[..], &fingerprint.to_le_bytes()].concat();
        let mut found = Vec::new();
        Read::by_ref(&mut file).take(HEAD).read_to_end(&mut found).map_err(failed)?;
        // One that was begun and not more is begun again.
        if !head.starts_with(&found) {
            return Err(other(if found.starts_with(&MAGIC) { "what it computed differs" } else { "its kind differs" }));
        }
        let state = match found.len() == head.len() {
            true => MemoState::Reading(BufReader::new(file), HEAD),
            false => {
                file.seek(SeekFrom::Start(0)).and_then(|_| file.write_all(&head)).map_err(failed)?;
                MemoState::Writing(file)
            }
        };
        Ok(Memo { path: path.into(), state: Mutex::new(state) })
    }

    /// What a function makes of each item, told its number and the item, on all threads: from the file as far as it is
    /// there, and kept as far as it is not. Calls are to come in the same order each time.
    ///
    /// - `memo`: without one, nothing is kept.
    pub(super) fn map<T: Sync, R: Serialize + DeserializeOwned + Send>(
        memo: Option<&Memo>,
        items: &[T],
        f: impl Fn(usize, &T) -> R + Sync,
    ) -> Vec<R> {
        let make = |first: usize, chunk: &[T]| -> Vec<R> {
            // Some items take much longer than others: no thread is to have many of them left in the end.
            let most = chunk.len().div_ceil(PARTS * rayon::current_num_threads());
            let numbered = chunk.par_iter().enumerate().with_max_len(most.max(1));
            numbered.map(|(number, item)| f(first + number, item)).collect()
        };
        let Some(memo) = memo else { return make(0, items) };
        let mut results = Vec::with_capacity(items.len());
        for chunk in items.chunks(CHUNK) {
            let first = results.len();
            let has_all = |found: &Vec<R>| found.len() == chunk.len();
            let Ok(found) = memo.record::<_, Infallible>(has_all, || Ok(make(first, chunk)));
            results.extend(found);
        }
        results
    }

    /// The next result: from the file, or made now and kept. Calls are to come in the same order each time.
    ///
    /// - `memo`: without one, nothing is kept.
    ///
    /// # Errors
    /// Those of `make`; nothing is kept of them.
    pub fn next<R: Serialize + DeserializeOwned, E>(
        memo: Option<&Memo>,
        make: impl FnOnce() -> Result<R, E>,
    ) -> Result<R, E> {
        match memo {
            Some(memo) => memo.record(|_| true, make),
            None => make(),
        }
    }

    /// The next record: read, if it is whole and right, or made and written.
    fn record<R: Serialize + DeserializeOwned, E>(
        &self,
        is_right: impl Fn(&R) -> bool,
        make: impl FnOnce() -> Result<R, E>,
    ) -> Result<R, E> {
        let lock = || self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = lock().read(is_right) {
            return Ok(found);
        }
        let made = make()?;
        if let Err(error) = lock().write(&made) {
            tracing::warn!("{}: {error}; intermediate results are no longer kept", self.path.display());
        }
        Ok(made)
    }

    /// Ends the work: the file is of no use any more, and is removed. That it cannot be removed harms nobody.
    pub fn remove(self) {
        let _ = std::fs::remove_file(self.path);
    }
}

impl MemoState {
    /// The next record, if it is whole and right; otherwise writing begins in its place.
    fn read<R: DeserializeOwned>(&mut self, is_right: impl Fn(&R) -> bool) -> Option<R> {
        let MemoState::Reading(file, end) = self else { return None };
        match record(file, *end) {
            Ok((content, next)) => {
                if let Ok((found, used)) = decode::<R, MOST>(&content, Integers::Fixed)
                    && used == content.len()
                    && is_right(&found)
                {
                    *end = next;
                    return Some(found);
                }
            }
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {}
            Err(error) => tracing::warn!("intermediate results are computed anew: {error}"),
        }
        let end = *end;
        *self = match std::mem::replace(self, MemoState::Broken) {
            MemoState::Reading(file, _) => {
                let mut file = file.into_inner();
                match file.set_len(end).and_then(|()| file.seek(SeekFrom::Start(end))) {
                    Ok(_) => MemoState::Writing(file),
                    Err(_) => MemoState::Broken,
                }
            }
            other => other,
        };
        None
    }

    fn write(&mut self, made: &impl Serialize) -> io::Result<()> {
        let MemoState::Writing(file) = self else { return Ok(()) };
        let content = encode(made, Integers::Fixed).map_err(io::Error::other)?;
        if content.len() > MOST {
            return Err(io::Error::other("a result is too long to be kept"));
        }
        let head = [&(content.len() as u64).to_le_bytes()[..], &crc32fast::hash(&content).to_le_bytes()].concat();
        let written = file.write_all(&head).and_then(|()| file.write_all(&content));
        if written.is_err() {
            *self = MemoState::Broken;
        }
        written
    }
}

/// The content of a record that begins at a byte, and where the next one begins.
fn record(file: &mut BufReader<File>, begin: u64) -> io::Result<(Vec<u8>, u64)> {
    let (mut length, mut sum) = ([0; 8], [0; 4]);
    file.read_exact(&mut length)?;
    file.read_exact(&mut sum)?;
    let length = u64::from_le_bytes(length);
    let next = begin.saturating_add(12).saturating_add(length);
    if next > file.get_ref().metadata()?.len() {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    let mut content = vec![0; length as usize];
    file.read_exact(&mut content)?;
    match crc32fast::hash(&content) == u32::from_le_bytes(sum) {
        true => Ok((content, next)),
        false => Err(io::Error::new(io::ErrorKind::InvalidData, "a checksum is wrong")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn results_come_one_by_one_and_errors_are_not_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("memo");
        let open = || Memo::open(&path, 7).expect("a memo");
        let next = |memo: &Memo, made: Result<i32, &'static str>| Memo::next(Some(memo), || made);
        let first = open();
        assert_eq!([next(&first, Ok(1)), next(&first, Ok(2)), next(&first, Err("no"))], [Ok(1), Ok(2), Err("no")]);
        let second = open();
        assert_eq!([next(&second, Err("a")), next(&second, Err("b")), next(&second, Ok(3))], [Ok(1), Ok(2), Ok(3)]);
        assert_eq!(Memo::next(None, || Ok::<_, ()>(4)), Ok(4));
        second.remove();
        assert!(!path.exists());
    }

    #[test]
    fn a_length_that_no_record_has_takes_no_memory() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("memo");
        // The content is the length of a text, eight bytes, and nothing behind it.
        let content = u64::MAX.to_le_bytes();
        let record = [&8_u64.to_le_bytes()[..], &crc32fast::hash(&content).to_le_bytes(), &content].concat();
        std::fs::write(&path, [&MAGIC[..], &7_u32.to_le_bytes(), &record].concat()).expect("written");
        let memo = Memo::open(&path, 7).expect("a memo");
        assert_eq!(Memo::next(Some(&memo), || Ok::<_, ()>("new".to_owned())), Ok("new".to_owned()));
    }

    /// Squares of numbers, and how many of them were computed.
    fn squares(path: &Path, counts: &[usize]) -> (Vec<Vec<u64>>, usize) {
        let memo = Memo::open(path, 7).expect("a memo");
        let computed = AtomicUsize::new(0);
        let square = |number: usize, item: &u64| {
            assert_eq!(number as u64, *item);
            computed.fetch_add(1, Ordering::Relaxed);
            item * item
        };
        let all = counts.iter().map(|count| {
            let items: Vec<u64> = (0..*count as u64).collect();
            Memo::map(Some(&memo), &items, square)
        });
        (all.collect(), computed.load(Ordering::Relaxed))
    }

    #[test]
    fn results_are_computed_once_wherever_the_file_was_cut_off() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("memo");
        let counts = [10, 2 * CHUNK + 5, 0, 3];
        let (whole, computed) = squares(&path, &counts);
        assert_eq!(computed, counts.iter().sum::<usize>());
        assert_eq!(squares(&path, &counts), (whole.clone(), 0));
        let bytes = std::fs::read(&path).expect("there");
        for cut in [0, 5, 12, 20, 100, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..cut]).expect("written");
            let (found, computed) = squares(&path, &counts);
            assert!(found == whole && computed > 0, "{cut} bytes");
            assert_eq!(std::fs::read(&path).expect("there"), bytes, "{cut} bytes");
        }
        let mut damaged = bytes.clone();
        damaged[bytes.len() / 2] ^= 1;
        std::fs::write(&path, damaged).expect("written");
        assert!(squares(&path, &counts).0 == whole && std::fs::read(&path).expect("there") == bytes);
        assert!(matches!(Memo::open(&path, 8), Err(StateError::Other { .. })));
        std::fs::write(&path, "a document").expect("written");
        assert!(matches!(Memo::open(&path, 7), Err(StateError::Other { .. })));
        assert_eq!(std::fs::read(&path).expect("there"), b"a document");
    }
}
