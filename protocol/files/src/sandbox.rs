//! Folders below which files are written, whatever their names say and whoever changes links meanwhile.

use crate::destination::Destination;
use crate::error::{Problem, WriteError};
use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder that is open. Files are created below it, and nowhere else: the system itself resolves their names
/// inside the folder, so that neither `..` nor a link, even one that changes meanwhile, leads out of it.
///
/// Where the system cannot do so, names are resolved step by step, and no link is followed. Where it cannot even name a
/// folder by its open file (other systems than Linux), whoever may change folders inside it at the same time can win.
#[derive(Debug)]
pub struct Sandbox {
    /// Without links.
    path: PathBuf,
    /// As it was called, seen from the root of the file system.
    called: PathBuf,
    folder: File,
}

impl Sandbox {
    /// Opens a folder, which must be there.
    ///
    /// # Errors
    /// Those of the system, or that it is no folder.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Sandbox> {
        let called = std::path::absolute(path)?;
        let path = std::fs::canonicalize(&called)?;
        if !path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "this is no folder"));
        }
        Ok(Sandbox { folder: File::open(&path)?, path, called })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Tests the destination of a file below the folder. A link that has its name is refused.
    ///
    /// - `name`: seen from the folder, or from the root of the file system.
    ///
    /// # Errors
    /// [`WriteError`], with [`Problem::Outside`] for a name that leads out of the folder.
    pub fn destination(&self, name: impl AsRef<Path>) -> Result<Destination, WriteError> {
        let called = name.as_ref();
        let failed = |problem| WriteError { path: called.into(), problem };
        let inside = called.strip_prefix(&self.path).or_else(|_| called.strip_prefix(&self.called));
        let name = inside.unwrap_or(called);
        let file = name.file_name().filter(|_| !called.as_os_str().as_encoded_bytes().ends_with(b"/"));
        let file = file.ok_or_else(|| failed(Problem::NoName))?;
        let parent = name.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = self.resolve(parent).map_err(|error| {
            failed(match error.kind() {
                io::ErrorKind::NotFound => Problem::NoFolder(parent.into()),
                io::ErrorKind::NotADirectory => Problem::NotAFolder(parent.into()),
                io::ErrorKind::CrossesDevices => Problem::Outside(self.path.clone()),
                _ => Problem::System(error),
            })
        })?;
        Destination::inside(called, self.entrance(&folder, parent, file), Arc::new(folder))
    }

    /// The path of a file in a folder that is open.
    #[cfg(target_os = "linux")]
    fn entrance(&self, folder: &File, _: &Path, file: &OsStr) -> PathBuf {
        use std::os::fd::AsRawFd;
        // It leads to this very folder, wherever that is by now.
        Path::new("/proc/self/fd").join(folder.as_raw_fd().to_string()).join(file)
    }

    #[cfg(not(target_os = "linux"))]
    fn entrance(&self, _: &File, parent: &Path, file: &OsStr) -> PathBuf {
        self.path.join(parent).join(file)
    }

    /// Opens a folder inside this one.
    #[cfg(target_os = "linux")]
    fn resolve(&self, inside: &Path) -> io::Result<File> {
        use rustix::fs::{Mode, OFlags, ResolveFlags, openat2};
        use rustix::io::Errno;
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC;
        let within = ResolveFlags::BENEATH | ResolveFlags::NO_MAGICLINKS;
        for _ in 0..TRIES {
            match openat2(&self.folder, inside, flags, Mode::empty(), within) {
                // Something was renamed meanwhile, so that the system cannot tell.
                Err(Errno::AGAIN) => {}
                // The system is too old, or lets this program not ask.
                Err(Errno::NOSYS | Errno::PERM) => return self.step_by_step(inside),
                opened => return Ok(opened?.into()),
            }
        }
        Err(Errno::AGAIN.into())
    }

    #[cfg(not(target_os = "linux"))]
    fn resolve(&self, inside: &Path) -> io::Result<File> {
        self.step_by_step(inside)
    }

    /// Opens a folder inside this one without following links.
    fn step_by_step(&self, inside: &Path) -> io::Result<File> {
        use rustix::fs::{Mode, OFlags, openat};
        use std::path::Component;
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let mut folder = self.folder.try_clone()?;
        for component in inside.components() {
            match component {
                Component::CurDir => {}
                Component::Normal(name) => folder = openat(&folder, name, flags, Mode::empty())?.into(),
                _ => return Err(io::ErrorKind::CrossesDevices.into()),
            }
        }
        Ok(folder)
    }
}

/// How often the system is asked where it cannot tell.
#[cfg(target_os = "linux")]
const TRIES: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;
    use std::os::unix::fs::symlink;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// A folder with the folder `inside`, beside a document that is to stay as it is.
    fn place() -> (tempfile::TempDir, Sandbox, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().canonicalize().expect("it is there");
        fs::create_dir_all(path.join("files/inside")).expect("made");
        fs::create_dir(path.join("outside")).expect("made");
        fs::write(path.join("outside/document"), "precious").expect("written");
        let beneath = Sandbox::open(path.join("files")).expect("opened");
        (folder, beneath, path)
    }

    fn write(beneath: &Sandbox, name: impl AsRef<Path>) -> Result<(), WriteError> {
        beneath.destination(name)?.write(|file| file.write_all(b"new"))
    }

    fn assert_untouched(path: &Path) {
        assert_eq!(fs::read(path.join("outside/document")).expect("there"), b"precious");
        assert_eq!(fs::read_dir(path.join("outside")).expect("there").count(), 1);
    }

    #[test]
    fn names_inside_are_written_relative_and_absolute() {
        let (_folder, beneath, path) = place();
        symlink("inside", path.join("files/link")).expect("linked");
        for name in ["a", "inside/b", "inside/../c", "./d", "link/e"] {
            write(&beneath, name).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        write(&beneath, path.join("files/inside/f")).expect("written");
        symlink(path.join("files"), path.join("called")).expect("linked");
        let called = Sandbox::open(path.join("called")).expect("opened");
        write(&called, path.join("called/g")).expect("written");
        for name in ["a", "inside/b", "c", "d", "inside/e", "inside/f", "g"] {
            assert_eq!(fs::read(path.join("files").join(name)).expect("there"), b"new", "{name}");
        }
    }

    #[test]
    fn names_that_lead_out_are_refused() {
        let (_folder, beneath, path) = place();
        symlink("../outside", path.join("files/relative")).expect("linked");
        symlink(path.join("outside"), path.join("files/absolute")).expect("linked");
        symlink("../outside/document", path.join("files/document")).expect("linked");
        let outside = path.join("outside/document");
        let names = ["../outside/document", "inside/../../outside/document", "relative/document", "absolute/document"];
        for name in names.iter().map(Path::new).chain([outside.as_path(), Path::new("/etc/new")]) {
            let error = write(&beneath, name).expect_err("refused");
            assert!(matches!(error.problem, Problem::Outside(_)), "{}: {error}", name.display());
        }
        assert!(matches!(write(&beneath, "document").expect_err("refused").problem, Problem::Link));
        assert!(matches!(write(&beneath, "missing/a").expect_err("refused").problem, Problem::NoFolder(_)));
        assert!(matches!(write(&beneath, "inside").expect_err("refused").problem, Problem::IsAFolder));
        for name in ["", "..", "inside/"] {
            assert!(write(&beneath, name).is_err(), "{name}");
        }
        assert_untouched(&path);
    }

    #[test]
    fn a_link_that_takes_the_place_of_folder_or_file_after_the_test_leads_nowhere() {
        let (_folder, beneath, path) = place();
        let destination = beneath.destination("inside/document").expect("tested");
        fs::rename(path.join("files/inside"), path.join("files/moved")).expect("renamed");
        symlink("../outside", path.join("files/inside")).expect("linked");
        symlink("../../outside/document", path.join("files/moved/document")).expect("linked");
        let written = destination.write(|file| file.write_all(b"new"));
        assert_untouched(&path);
        // It is the folder that was tested, under another name; the link in it is replaced, or refused.
        assert!(written.is_err() || fs::read(path.join("files/moved/document")).expect("there") == b"new");
    }

    #[test]
    fn links_that_change_all_the_time_lead_nowhere() {
        let (_folder, beneath, path) = place();
        let (files, stop) = (path.join("files"), AtomicBool::new(false));
        symlink("../outside", files.join("trap")).expect("linked");
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !stop.load(Ordering::Relaxed) {
                    // The folder and the link change places.
                    for (from, to) in [("inside", "aside"), ("trap", "inside"), ("inside", "trap"), ("aside", "inside")]
                    {
                        fs::rename(files.join(from), files.join(to)).expect("renamed");
                    }
                }
            });
            let written = (0..2000).filter(|_| write(&beneath, "inside/document").is_ok()).count();
            stop.store(true, Ordering::Relaxed);
            assert!(written > 0, "now and then the folder is there");
        });
        assert_untouched(&path);
    }

    #[test]
    fn without_the_help_of_the_system_no_link_is_followed() {
        let (_folder, beneath, path) = place();
        symlink("inside", path.join("files/link")).expect("linked");
        for (inside, is_opened) in [("inside", true), (".", true), ("link", false), ("..", false), ("/", false)] {
            assert_eq!(beneath.step_by_step(Path::new(inside)).is_ok(), is_opened, "{inside}");
        }
    }
}
