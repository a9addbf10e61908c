//! Files that are read as a whole, within a limit.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// The content of an ordinary file. Devices, pipes and sockets, which may have no end or never answer, are refused, and
/// its length is looked at before there is memory for it.
///
/// - `most`: bytes that it may have.
///
/// # Errors
/// What the system says, or in words what kind of file it is, or how long.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    let length = file.metadata()?.len();
    if length > most {
        return Err(io::Error::other(format!("it has {length} bytes; {most} are read at most")));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // It may grow meanwhile.
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!("it grows beyond the {most} bytes that are read at most")));
    }
    Ok(bytes)
}

/// The content of an ordinary file that is text, as [`read`] reads it.
///
/// # Errors
/// Those of [`read`], and one that names the first byte that is not UTF-8.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        io::Error::new(io::ErrorKind::InvalidData, format!("this is no text: byte {place} is not UTF-8"))
    })
}

/// Opens an ordinary file for reading; others are refused as by [`read`].
///
/// # Errors
/// What the system says, or in words what kind of file it is.
pub fn open(path: &Path) -> io::Result<File> {
    let refused = || Err(io::Error::other("this is a device, pipe or socket and no ordinary file"));
    let check = |found: fs::Metadata| match found {
        found if found.is_dir() => Err(io::Error::other("this is a folder")),
        found if !found.is_file() => refused(),
        _ => Ok(()),
    };
    // To open a pipe waits for somebody who writes.
    check(fs::metadata(path)?)?;
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
    }
    let file = options.open(path)?;
    check(file.metadata()?)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_ordinary_files_within_the_limit_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        fs::write(&path, "twelve bytes").expect("written");
        assert_eq!(read(&path, 12).expect("read"), b"twelve bytes");
        assert_eq!(read_text(&path, 12).expect("read"), "twelve bytes");
        let said = |path: &Path, most| read(path, most).expect_err("refused").to_string();
        assert_eq!(said(&path, 11), "it has 12 bytes; 11 are read at most");
        assert_eq!(said(folder.path(), 12), "this is a folder");
        let pipe = folder.path().join("pipe");
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, 0o600.into(), 0).expect("a pipe");
        for special in [&*pipe, Path::new("/dev/zero"), Path::new("/dev/null")] {
            assert_eq!(said(special, 1 << 40), "this is a device, pipe or socket and no ordinary file");
        }
        assert_eq!(read(Path::new("/no/such/file"), 1).expect_err("none").kind(), io::ErrorKind::NotFound);
        fs::write(&path, b"ab\xff").expect("written");
        assert_eq!(read_text(&path, 9).expect_err("no text").to_string(), "this is no text: byte 2 is not UTF-8");
    }
}
