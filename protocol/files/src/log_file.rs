//! Files that grow while something goes on, as logs do.

use crate::destination::Destination;
use crate::error::{Problem, WriteError};
use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that grows: its name has `.part` after it until it is finished.
///
/// When the process is killed, what was written until then is left under that name, and an older file under the whole
/// name is as it was.
#[derive(Debug)]
pub struct LogFile {
    file: File,
    part: PathBuf,
    destination: Destination,
}

impl LogFile {
    /// Begins an empty file. Parts that others left are not touched: the name then has a number, too.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn create(destination: Destination) -> Result<LogFile, WriteError> {
        let named = |ending: &str| {
            let mut name = OsString::from(destination.target());
            name.push(ending);
            PathBuf::from(name)
        };
        let names = std::iter::once(named(".part")).chain((2..1000).map(|number| named(&format!(".{number}.part"))));
        let mut refused = io::Error::from(io::ErrorKind::AlreadyExists);
        for part in names {
            match OpenOptions::new().write(true).create_new(true).open(&part) {
                Ok(file) => return Ok(LogFile { file, part, destination }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => refused = error,
                Err(error) => return Err(destination.failed(Problem::System(error))),
            }
        }
        Err(destination.failed(Problem::System(refused)))
    }

    /// Where it is until it is finished.
    pub fn part(&self) -> &Path {
        &self.part
    }

    /// Ends the file: it is synchronised and gets its name, in place of an older file.
    ///
    /// # Errors
    /// [`WriteError`]; what was written is left under the name with `.part`.
    pub fn finish(self) -> Result<(), WriteError> {
        let LogFile { file, part, destination } = self;
        let end = || file.sync_all().and_then(|()| std::fs::rename(&part, destination.target()));
        end().map_err(|error| destination.failed(Problem::System(error)))
    }
}

impl Write for LogFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_grows_beside_an_older_one_and_takes_its_place_at_the_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log");
        fs::write(&path, "older").expect("written");
        let begin = || LogFile::create(Destination::of(&path).expect("a destination")).expect("begun");
        let (mut first, mut second) = (begin(), begin());
        assert!(first.part().ends_with("log.part") && second.part().ends_with("log.2.part"));
        first.write_all(b"one").expect("written");
        second.write_all(b"two").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"older");
        assert_eq!(fs::read(first.part()).expect("there"), b"one");
        second.finish().expect("finished");
        assert_eq!(fs::read(&path).expect("there"), b"two");
        drop(first);
        assert!(folder.path().join("log.part").exists(), "what was not finished is left");
    }
}
