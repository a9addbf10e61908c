//! A file that has no name yet.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A file in a folder that nobody else sees as a whole one yet; it is gone when dropped.
///
/// On Linux it has no name at all, where the file system knows such files: a process that is killed leaves nothing
/// behind. Elsewhere it has a name of its own that begins with a dot.
pub(crate) struct Draft {
    file: File,
    folder: PathBuf,
    /// None while the file has no name.
    name: Option<PathBuf>,
}

impl Draft {
    /// An empty file in a folder.
    pub(crate) fn new(folder: &Path) -> io::Result<Draft> {
        if let Some(file) = nameless(folder)? {
            return Ok(Draft { file, folder: folder.into(), name: None });
        }
        let name = unused(folder);
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(&name)?;
        Ok(Draft { file, folder: folder.into(), name: Some(name) })
    }

    /// The file, to be written.
    pub(crate) fn file(&self) -> &File {
        &self.file
    }

    /// Synchronises the file and gives it its name, in place of a file that had it.
    pub(crate) fn publish(self, path: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        self.replace(path)
    }

    /// Synchronises the file and gives it its name, if no file has it.
    pub(crate) fn publish_new(self, path: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        match &self.name {
            None => name_it(&self.file, path)?,
            Some(name) => fs::hard_link(name, path)?,
        }
        synchronise(&self.folder)
    }

    fn replace(mut self, path: &Path) -> io::Result<()> {
        let _naming = naming();
        let beside = match &self.name {
            Some(name) => name.clone(),
            // Most files are new, and need no second name.
            None => match name_it(&self.file, path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    let beside = unused(&self.folder);
                    name_it(&self.file, &beside)?;
                    self.name = Some(beside.clone());
                    beside
                }
                named => return named.and_then(|()| synchronise(&self.folder)),
            },
        };
        fs::rename(beside, path)?;
        self.name = None;
        synchronise(&self.folder)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some(name) = &self.name {
            // It is of no use to anybody; nothing more can be done where it cannot be removed.
            let _ = fs::remove_file(name);
        }
    }
}

/// Held while a file that is whole has a name of its own and not yet that of the older one, which is a moment.
static NAMING: Mutex<()> = Mutex::new(());

/// Waits until no file is on its way from one name to another: who ends the process while holding this leaves no other
/// name behind. A process that is killed may, once in thousands of times, where an older file is replaced.
pub fn naming() -> MutexGuard<'static, ()> {
    NAMING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A name in a folder that no file has.
fn unused(folder: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = folder.join(format!(".peris-{}-{count}", std::process::id()));
        if name.symlink_metadata().is_err() {
            return name;
        }
    }
}

/// A file without a name; none where the file system does not know such files.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path) -> io::Result<Option<File>> {
    use rustix::fs::{CWD, Mode, OFlags, openat};
    use rustix::io::Errno;
    // To be named, it must be found below /proc.
    if !Path::new("/proc/self/fd").is_dir() {
        return Ok(None);
    }
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    match openat(CWD, folder, flags, Mode::from_raw_mode(0o666)) {
        Ok(file) => Ok(Some(file.into())),
        Err(Errno::OPNOTSUPP | Errno::ISDIR | Errno::INVAL) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

#[cfg(not(target_os = "linux"))]
fn nameless(_: &Path) -> io::Result<Option<File>> {
    Ok(None)
}

/// Gives a file without a name one.
#[cfg(target_os = "linux")]
fn name_it(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let at = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, at, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn name_it(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Makes the names in a folder last.
fn synchronise(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some file systems know no such thing; the name is there all the same.
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::PermissionDenied) => Ok(()),
        result => result,
    }
}
