//! The disk: files that functions write and read, kept as long as the machine runs.

use std::collections::BTreeMap;

/// Bytes of all files together. A diskette of the time held about a megabyte; ours.
pub const MAX_BYTES: usize = 64 << 20;
/// Most files. Ours.
pub const MAX_FILES: usize = 1000;

/// Why the disk did not take something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the disk is full")]
pub struct DiskFull;

/// The disk.
#[derive(Debug, Default)]
pub struct Disk {
    files: BTreeMap<Box<[u8]>, Vec<u8>>,
    bytes: usize,
}

impl Disk {
    /// The contents of a file.
    pub fn read(&self, file: &[u8]) -> Option<&[u8]> {
        self.files.get(file).map(Vec::as_slice)
    }

    /// Adds to a file, which is made if need be; without a text, makes it empty.
    ///
    /// # Errors
    /// [`DiskFull`]; the file is as before.
    pub fn write(&mut self, file: &[u8], text: Option<&[u8]>) -> Result<(), DiskFull> {
        let new = !self.files.contains_key(file);
        let more = text.map_or(0, <[u8]>::len) + if new { file.len() } else { 0 };
        if self.bytes + more > MAX_BYTES || new && self.files.len() >= MAX_FILES {
            return Err(DiskFull);
        }
        let contents = self.files.entry(file.into()).or_default();
        self.bytes += more;
        match text {
            Some(text) => contents.extend_from_slice(text),
            None => {
                self.bytes -= contents.len();
                contents.clear();
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_grows_and_begins_anew() {
        let mut disk = Disk::default();
        assert_eq!(disk.read(b"A"), None);
        disk.write(b"A", Some(b"one")).unwrap();
        disk.write(b"A", Some(b" two")).unwrap();
        assert_eq!(disk.read(b"A"), Some(b"one two".as_slice()));
        disk.write(b"A", None).unwrap();
        assert_eq!((disk.read(b"A"), disk.bytes), (Some(b"".as_slice()), 1));
    }

    #[test]
    fn a_full_disk_refuses() {
        let mut disk = Disk::default();
        disk.write(b"A", Some(&vec![0; MAX_BYTES - 1])).unwrap();
        assert_eq!(disk.write(b"A", Some(b"x")), Err(DiskFull));
        assert_eq!(disk.write(b"B", None), Err(DiskFull));
        disk.write(b"A", None).unwrap();
        assert_eq!(disk.write(b"B", Some(b"x")), Ok(()));
    }
}
