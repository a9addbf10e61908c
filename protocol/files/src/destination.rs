//! Where files will be written.

use crate::draft::Draft;
use crate::error::{Problem, WriteError};
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Takes the bytes of a file that is written.
pub type Writer<'a> = BufWriter<&'a File>;

/// Where a file will be written: its folder is there and takes files, and what may have the name already is
/// an ordinary file that may be replaced.
///
/// It is tested when it is made, so that long work does not begin for a file that cannot be written.
#[derive(Clone, Debug)]
pub struct Destination {
    /// The file, as it was called.
    path: PathBuf,
    /// The file itself, behind symbolic links.
    target: PathBuf,
    /// The folder, where it must stay open so that `target` leads there; then links in it are not followed.
    open: Option<Arc<File>>,
}

impl Destination {
    /// Tests a destination. A symbolic link is followed, so that what it leads to will be replaced and not the link.
    ///
    /// Nothing is written, and nothing is left in the folder.
    ///
    /// # Errors
    /// [`WriteError`] with what stands in the way.
    pub fn of(path: impl AsRef<Path>) -> Result<Destination, WriteError> {
        let path = path.as_ref();
        let failed = |problem| WriteError { path: path.into(), problem };
        let target = target_of(path).map_err(failed)?;
        // A name that ends with a slash is that of a folder.
        let is_named = target.file_name().is_some() && !path.as_os_str().as_encoded_bytes().ends_with(b"/");
        if !is_named {
            return Err(failed(if path.is_dir() { Problem::IsAFolder } else { Problem::NoName }));
        }
        let destination = Destination { path: path.into(), target, open: None };
        check_folder(destination.folder()).and_then(|()| destination.check_older()).map_err(failed)?;
        Ok(destination)
    }

    /// Tests a destination in a folder that is open.
    ///
    /// - `path`: the file, as it was called; `target`: its path, which leads through `folder`.
    pub(crate) fn inside(path: &Path, target: PathBuf, folder: Arc<File>) -> Result<Destination, WriteError> {
        let destination = Destination { path: path.into(), target, open: Some(folder) };
        let tested = check_folder(destination.folder()).and_then(|()| destination.check_older());
        tested.map_err(|problem| destination.failed(problem))?;
        Ok(destination)
    }

    /// The file, as it was called.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file itself, behind symbolic links.
    pub(crate) fn target(&self) -> &Path {
        &self.target
    }

    fn folder(&self) -> &Path {
        folder_of(&self.target)
    }

    /// Whether what has the name may be replaced.
    fn check_older(&self) -> Result<(), Problem> {
        if self.open.is_some() && self.target.is_symlink() {
            return Err(Problem::Link);
        }
        match fs::metadata(&self.target) {
            Ok(found) if found.is_dir() => Err(Problem::IsAFolder),
            Ok(found) if !found.is_file() => Err(Problem::NotOrdinary),
            // Who may not write into a file is not to replace it either.
            Ok(_) => OpenOptions::new().write(true).open(&self.target).map(drop).map_err(Problem::System),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            Err(error) => Err(Problem::System(error)),
        }
    }

    /// Writes the file: whole, synchronised, and then in place of an older one, whose permissions it takes over.
    ///
    /// - `content`: writes the bytes, from the beginning.
    ///
    /// # Errors
    /// [`WriteError`]; the older file, or that there was none, is then as before.
    pub fn write(&self, content: impl Fn(&mut Writer<'_>) -> io::Result<()>) -> Result<(), WriteError> {
        self.try_write(content).map_err(|problem| self.failed(problem))
    }

    /// Writes the file as [`Destination::write`] does; where that fails, into the folder for temporary files or the
    /// current one, under a name that no file has.
    ///
    /// # Errors
    /// [`WriteError`], also with [`Problem::Elsewhere`] if the content is saved there.
    pub fn write_or_save_elsewhere(
        &self,
        content: impl Fn(&mut Writer<'_>) -> io::Result<()>,
    ) -> Result<(), WriteError> {
        let name = self.target.file_name().unwrap_or_default();
        self.try_write(&content).map_err(|problem| self.failed(saved_elsewhere(name, problem, &content)))
    }

    /// Makes a file that begins as more than an empty one, such as a database, unless there is one with more than
    /// nothing in it: the content is made under no name, and only then gets its own. Of several processes that do so at
    /// once, one makes the file, and the others find it.
    ///
    /// - `content`: makes the content of a file that is open for reading and writing.
    ///
    /// # Errors
    /// Those of `content`, or [`WriteError`].
    pub fn make_once<E: From<WriteError>>(&self, content: impl FnOnce(&File) -> Result<(), E>) -> Result<(), E> {
        let failed = |error| self.failed(Problem::System(error));
        let empty = match OpenOptions::new().read(true).write(true).open(&self.target) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error).into()),
            Ok(file) => {
                // Who replaces an empty file holds its lock, and so does so once.
                file.lock().map_err(failed)?;
                let is_there = is_same(&file, &self.target) && file.metadata().map_err(failed)?.len() == 0;
                if !is_there {
                    return Ok(());
                }
                Some(file)
            }
        };
        let draft = Draft::new(self.folder()).map_err(failed)?;
        content(draft.file())?;
        let published = match &empty {
            Some(_) => draft.publish(&self.target),
            None => draft.publish_new(&self.target),
        };
        match published {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
            published => Ok(published.map_err(failed)?),
        }
    }

    pub(crate) fn failed(&self, problem: Problem) -> WriteError {
        WriteError { path: self.path.clone(), problem }
    }

    fn try_write(&self, content: impl Fn(&mut Writer<'_>) -> io::Result<()>) -> Result<(), Problem> {
        self.check_older()?;
        let write = || {
            let draft = Draft::new(self.folder())?;
            fill(&draft, content)?;
            if let Ok(older) = fs::metadata(&self.target) {
                take_over(draft.file(), &older);
            }
            draft.publish(&self.target)
        };
        write().map_err(Problem::System)
    }
}

/// A folder for files that will be written: it is there and takes files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder, with those above it, if there is none, and tests it.
    ///
    /// # Errors
    /// [`WriteError`] with what stands in the way.
    pub fn make(path: impl AsRef<Path>) -> Result<Folder, WriteError> {
        let path = path.as_ref();
        let failed = |problem| WriteError { path: path.into(), problem };
        let nearest = path.ancestors().find(|above| above.exists());
        if let Some(file) = nearest.filter(|above| !above.is_dir()) {
            return Err(failed(Problem::NotAFolder(file.into())));
        }
        fs::create_dir_all(path).map_err(|error| failed(Problem::System(error)))?;
        check_folder(path).map_err(failed)?;
        Ok(Folder { path: path.into() })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file in it, as [`Destination::write_or_save_elsewhere`] does, also where the name turns out to be taken
    /// by a folder or device; where it is.
    ///
    /// # Errors
    /// [`WriteError`], also with [`Problem::Elsewhere`] if the content is saved elsewhere.
    pub fn write_or_save_elsewhere(
        &self,
        name: &str,
        content: impl Fn(&mut Writer<'_>) -> io::Result<()>,
    ) -> Result<PathBuf, WriteError> {
        let path = self.path.join(name);
        match Destination::of(&path) {
            Ok(destination) => destination.write_or_save_elsewhere(content)?,
            Err(WriteError { problem, .. }) => {
                let problem = saved_elsewhere(name.as_ref(), problem, &content);
                return Err(WriteError { path, problem });
            }
        }
        Ok(path)
    }
}

/// Whether there is a folder that takes files.
fn check_folder(folder: &Path) -> Result<(), Problem> {
    match fs::metadata(folder) {
        Ok(found) if found.is_dir() => Draft::new(folder).map(drop).map_err(Problem::Closed),
        Ok(_) => Err(Problem::NotAFolder(folder.into())),
        Err(error) => Err(match error.kind() {
            io::ErrorKind::NotFound => Problem::NoFolder(folder.into()),
            io::ErrorKind::NotADirectory => Problem::NotAFolder(folder.into()),
            _ => Problem::System(error),
        }),
    }
}

/// Writes a file that could not be written to its destination into another folder, and adds to the problem where it is.
fn saved_elsewhere(name: &OsStr, problem: Problem, content: &dyn Fn(&mut Writer<'_>) -> io::Result<()>) -> Problem {
    let keep = |folder: &Path| {
        let draft = Draft::new(folder).ok()?;
        fill(&draft, content).ok()?;
        let name = name.to_string_lossy();
        let names = std::iter::once(name.to_string()).chain((1..1000).map(|number| format!("{number}-{name}")));
        let free = names.map(|name| folder.join(name)).find(|path| path.symlink_metadata().is_err())?;
        draft.publish_new(&free).ok()?;
        Some(fs::canonicalize(&free).unwrap_or(free))
    };
    match [std::env::temp_dir(), PathBuf::from(".")].iter().find_map(|folder| keep(folder)) {
        Some(kept) => Problem::Elsewhere { saved_as: kept, why: Box::new(problem) },
        None => problem,
    }
}

fn fill(draft: &Draft, content: impl Fn(&mut Writer<'_>) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(draft.file());
    content(&mut writer)?;
    writer.flush()
}

/// Whether a path leads to a file that is open.
#[cfg(unix)]
fn is_same(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(open), Ok(named)) => identity(open) == identity(named),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_same(_: &File, path: &Path) -> bool {
    path.exists()
}

/// The folder of a file.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What a path leads to: itself, or the file behind symbolic links.
fn target_of(path: &Path) -> Result<PathBuf, Problem> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => fs::canonicalize(path).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => Problem::DeadLink,
            _ => Problem::System(error),
        }),
        Err(error) if !matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Err(Problem::System(error))
        }
        _ => Ok(path.into()),
    }
}

/// Gives a file the permissions and, where that is allowed, the owner of another.
fn take_over(file: &File, older: &fs::Metadata) {
    // A file with other permissions is better than none.
    let _ = file.set_permissions(older.permissions());
    #[cfg(unix)]
    {
        use rustix::fs::{Gid, Uid, fchown};
        use std::os::unix::fs::MetadataExt;
        let [owner, group] = [older.uid(), older.gid()];
        let _ = fchown(file, Some(Uid::from_raw(owner)), Some(Gid::from_raw(group)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};

    fn files_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn write(destination: &Destination, bytes: &[u8]) -> Result<(), WriteError> {
        destination.write(|file| file.write_all(bytes))
    }

    /// The problem of a destination, as it is printed.
    fn problem(path: impl AsRef<Path>) -> String {
        Destination::of(path).expect_err("no destination").problem.to_string()
    }

    #[test]
    fn a_destination_is_tested_and_nothing_is_left_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        Destination::of(at("new.png")).expect("a destination");
        assert!(files_in(folder.path()).is_empty());
        fs::write(at("file"), "older").expect("written");
        symlink("nowhere", at("dead")).expect("a link");
        assert!(problem(at("none/a.png")).starts_with("there is no folder"));
        assert!(problem(at("file/a.png")).ends_with("is no folder"));
        assert_eq!(problem(folder.path()), "this is a folder");
        assert_eq!(problem(at("a/..")), "this names no file");
        assert_eq!(problem(at("a/")), "this names no file");
        assert_eq!(problem(at("dead")), "this is a link that leads nowhere");
        assert_eq!(problem("/dev/null"), "this is a device, pipe or socket and no ordinary file");
        assert!(problem(at(&"a".repeat(300))).contains("too long"));
        assert!(fs::metadata("/dev/null").expect("there").file_type().is_char_device());
        assert_eq!(files_in(folder.path()), ["dead", "file"]);
        let error = Destination::of(at("none/a.png")).expect_err("no destination").to_string();
        assert!(error.starts_with("writing ") && error.contains("none/a.png: there is no folder"), "{error}");
    }

    #[test]
    fn a_file_is_written_and_takes_the_place_and_the_permissions_of_an_older_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        let destination = Destination::of(&path).expect("a destination");
        write(&destination, b"one").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"one");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("allowed");
        write(&destination, b"two").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"two");
        assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o640);
        assert_eq!(files_in(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_link_stays_and_what_it_leads_to_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("real")).expect("a folder");
        fs::write(at("real/a.txt"), "older").expect("written");
        symlink("real/a.txt", at("link")).expect("a link");
        write(&Destination::of(at("link")).expect("a destination"), b"new").expect("written");
        assert!(at("link").is_symlink());
        assert_eq!(fs::read(at("real/a.txt")).expect("there"), b"new");
        assert_eq!(files_in(&at("real")), ["a.txt"]);
    }

    #[test]
    fn content_that_fails_leaves_the_older_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        fs::write(&path, "older").expect("written");
        let destination = Destination::of(&path).expect("a destination");
        let failing = |file: &mut Writer<'_>| {
            file.write_all(&[0; 100_000])?;
            Err(io::Error::other("no more"))
        };
        let error = destination.write(failing).expect_err("failed");
        assert!(error.to_string().ends_with("a.txt: no more"), "{error}");
        assert_eq!(fs::read(&path).expect("there"), b"older");
        assert_eq!(files_in(folder.path()), ["a.txt"]);
    }

    #[test]
    fn what_cannot_be_written_in_its_place_is_kept_elsewhere_under_a_new_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("inner");
        fs::create_dir(&inner).expect("a folder");
        let name = format!("kept-{}.txt", std::process::id());
        let destination = Destination::of(inner.join(&name)).expect("a destination");
        fs::remove_dir(&inner).expect("removed");
        let [first, second] = [b"one", b"two"].map(|bytes| {
            let error = destination.write_or_save_elsewhere(|file| file.write_all(bytes)).expect_err("no folder");
            let Problem::Elsewhere { saved_as: kept, .. } = error.problem else { panic!("{error}") };
            kept
        });
        assert_ne!(first, second);
        for (kept, bytes) in [(first, b"one"), (second, b"two")] {
            assert_eq!(fs::read(&kept).expect("there"), bytes);
            fs::remove_file(kept).expect("removed");
        }
    }

    #[test]
    fn of_many_that_make_a_file_one_makes_it_also_in_place_of_an_empty_one() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, is_empty) in [("new", false), ("empty", true)] {
            let path = folder.path().join(name);
            if is_empty {
                fs::write(&path, "").expect("written");
            }
            let make = |number: usize| {
                let destination = Destination::of(&path).expect("a destination");
                destination.make_once(|mut file| {
                    std::thread::sleep(std::time::Duration::from_millis(5));
                    writeln!(file, "{number}").map_err(|error| destination.failed(Problem::System(error)))
                })
            };
            std::thread::scope(|scope| {
                let all: Vec<_> = (0..8).map(|number| scope.spawn(move || make(number).is_ok())).collect();
                assert!(all.into_iter().all(|one| one.join().expect("no panic")));
            });
            let made = fs::read(&path).expect("made");
            assert_eq!(made.len(), 2);
            make(9).expect("there is one");
            assert_eq!(fs::read(&path).expect("there"), made);
        }
        assert_eq!(files_in(folder.path()), ["empty", "new"]);
    }

    #[test]
    fn folders_are_made_and_tested() {
        let there = tempfile::tempdir().expect("a folder");
        Folder::make(there.path().join("a/b")).expect("made");
        let folder = Folder::make(there.path().join("a/b")).expect("there");
        let path = folder.write_or_save_elsewhere("c.txt", |file| file.write_all(b"one")).expect("written");
        assert_eq!((path.as_path(), fs::read(&path).expect("there")), (&*folder.path().join("c.txt"), b"one".to_vec()));
        for below in ["a/b/c.txt", "a/b/c.txt/d/e"] {
            let error = Folder::make(there.path().join(below)).expect_err("a file").to_string();
            assert!(error.ends_with("c.txt is no folder"), "{error}");
        }
        let name = format!("kept-in-folder-{}", std::process::id());
        fs::create_dir(folder.path().join(&name)).expect("a folder");
        let error =
            folder.write_or_save_elsewhere(&name, |file| file.write_all(b"two")).expect_err("a folder has the name");
        let Problem::Elsewhere { saved_as: kept, why } = error.problem else { panic!("{error}") };
        assert!(matches!(*why, Problem::IsAFolder));
        assert_eq!(fs::read(&kept).expect("there"), b"two");
        fs::remove_file(kept).expect("removed");
    }
}
