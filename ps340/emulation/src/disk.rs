//! The disk: named files that functions read and write, held in memory. The shell may keep them in a folder.

use crate::port::FileName;
use std::collections::BTreeMap;

/// Bytes of all files. The machine's disks held about a megabyte; ours.
pub const MAX_DISK: usize = 8 << 20;
/// Files on the disk. Ours.
pub const MAX_FILES: usize = 1_000;

/// The reason why the disk did not do something.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DiskFault {
    /// A file that is not there.
    #[error("File not found: {}", .0.as_str())]
    NotFound(FileName),
    /// No space for what should be written; the file is as it was.
    #[error("Disk full: {} is not written", .0.as_str())]
    Full(FileName),
}

impl DiskFault {
    /// The number of the message. Ours.
    pub const fn number(&self) -> u16 {
        match self {
            DiskFault::NotFound(_) => 2,
            DiskFault::Full(_) => 8,
        }
    }
}

/// Named files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Disk {
    files: BTreeMap<FileName, Vec<u8>>,
    bytes: usize,
}

impl Disk {
    /// The contents of a file.
    ///
    /// # Errors
    /// [`DiskFault::NotFound`].
    pub fn read(&self, name: &FileName) -> Result<&[u8], DiskFault> {
        self.files.get(name).map(Vec::as_slice).ok_or_else(|| DiskFault::NotFound(name.clone()))
    }

    /// Writes a file: to its end, or instead of what is there.
    ///
    /// # Errors
    /// [`DiskFault::Full`] beyond [`MAX_DISK`] bytes or [`MAX_FILES`] files.
    pub fn write(&mut self, name: FileName, bytes: &[u8], append: bool) -> Result<(), DiskFault> {
        let before = self.files.get(&name);
        let replaced = if append { 0 } else { before.map_or(0, Vec::len) };
        let total = self.bytes - replaced + bytes.len();
        if total > MAX_DISK || (before.is_none() && self.files.len() >= MAX_FILES) {
            return Err(DiskFault::Full(name));
        }
        self.bytes = total;
        let file = self.files.entry(name).or_default();
        if !append {
            file.clear();
        }
        file.extend_from_slice(bytes);
        Ok(())
    }

    /// The files, by name.
    pub fn files(&self) -> impl Iterator<Item = (&FileName, &[u8])> {
        self.files.iter().map(|(name, bytes)| (name, bytes.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str) -> FileName {
        FileName::new(text.as_bytes()).unwrap()
    }

    #[test]
    fn files_are_replaced_or_grow_and_keep_their_bytes() {
        let mut disk = Disk::default();
        assert_eq!(disk.read(&name("A")), Err(DiskFault::NotFound(name("a"))));
        disk.write(name("A"), b"one", false).unwrap();
        disk.write(name("A"), b" two", true).unwrap();
        assert_eq!(disk.read(&name("a")).unwrap(), b"one two");
        disk.write(name("A"), b"3", false).unwrap();
        assert_eq!(disk.files().collect::<Vec<_>>(), [(&name("A"), &b"3"[..])]);
    }

    #[test]
    fn a_full_disk_changes_nothing_and_room_comes_back() {
        let mut disk = Disk::default();
        let all = vec![0; MAX_DISK];
        disk.write(name("A"), &all, false).unwrap();
        assert_eq!(disk.write(name("B"), b"x", false), Err(DiskFault::Full(name("B"))));
        assert_eq!(disk.write(name("A"), b"x", true), Err(DiskFault::Full(name("A"))));
        disk.write(name("A"), b"x", false).unwrap();
        disk.write(name("B"), &all[1..], false).unwrap();
        assert_eq!(disk.files().count(), 2);
    }

    #[test]
    fn there_are_only_so_many_files() {
        let mut disk = Disk::default();
        for i in 0..MAX_FILES {
            disk.write(name(&format!("F{i}")), b"", false).unwrap();
        }
        assert!(disk.write(name("ONE_MORE"), b"", false).is_err());
        assert!(disk.write(name("F0"), b"x", false).is_ok());
    }
}
