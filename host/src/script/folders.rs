//! Below which folders a script reads.

use std::cell::RefCell;
use std::path::{Component, Path, PathBuf};

/// The folder where the paths of a script begin, and all below which it may read.
pub(super) struct Folders {
    own: PathBuf,
    /// Without links; those that there are.
    readable: Vec<PathBuf>,
    /// The files that it has named.
    named: RefCell<Vec<PathBuf>>,
}

impl Folders {
    /// - `own`: where relative paths begin; empty for the current folder.
    /// - `allowed`: others, below which the script may read, too.
    pub(super) fn new(own: &Path, allowed: &[PathBuf]) -> Folders {
        let all = std::iter::once(own).chain(allowed.iter().map(PathBuf::as_path));
        Folders { own: own.into(), readable: all.filter_map(without_links).collect(), named: RefCell::default() }
    }

    /// Notes files that the script has named elsewhere.
    pub(super) fn note(&self, files: &[PathBuf]) {
        self.named.borrow_mut().extend_from_slice(files);
    }

    /// The files that the script has named, in the order in which it did.
    pub(super) fn named(&self) -> Vec<PathBuf> {
        self.named.borrow().clone()
    }

    /// Where a file is that a script names; a file that is not there may be anywhere below the folders.
    ///
    /// # Errors
    /// In words, where it is outside the folders, links followed.
    pub(super) fn file(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.own.join(name);
        self.named.borrow_mut().push(path.clone());
        let is_below = without_links(&path).is_some_and(|path| self.readable.iter().any(|top| path.starts_with(top)));
        is_below.then_some(path).ok_or_else(|| {
            format!(
                "{name} is outside the folder of the script; --allow FOLDER lets scripts read below another one, too"
            )
        })
    }
}

/// A path from the root on, its links followed as far as it exists; none if what does not exist leads back up.
fn without_links(path: &Path) -> Option<PathBuf> {
    let here = |path: &Path| if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.into() };
    let (real, rest) = path.ancestors().find_map(|existing| {
        let real = here(existing).canonicalize().ok()?;
        Some((real, path.strip_prefix(existing).ok()?))
    })?;
    rest.components().all(|part| matches!(part, Component::Normal(_))).then(|| real.join(rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_below_the_folders_are_found_and_others_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let [own, other, secret] = ["scenes", "meshes", "secret"].map(|name| folder.path().join(name));
        for made in [&own, &other, &secret] {
            std::fs::create_dir(made).expect("made");
            std::fs::write(made.join("a.obj"), "").expect("written");
        }
        #[cfg(unix)]
        std::os::unix::fs::symlink(&secret, own.join("link")).expect("a link");
        let alone = Folders::new(&own, &[]);
        let both = Folders::new(&own, std::slice::from_ref(&other));
        for name in ["a.obj", "./a.obj", "none.obj", "none/none.obj", "../scenes/a.obj"] {
            assert_eq!(alone.file(name), Ok(own.join(name)), "{name}");
        }
        let absolute = other.join("a.obj").display().to_string();
        for name in ["../meshes/a.obj", &absolute, "../meshes/none.obj"] {
            assert!(alone.file(name).is_err_and(|error| error.contains("--allow")), "{name}");
            assert!(both.file(name).is_ok(), "{name}");
        }
        for name in ["../secret/a.obj", "link/a.obj", "/etc/passwd", "none/../../secret/a.obj", "../a.obj"] {
            assert!(both.file(name).is_err(), "{name}");
        }
        assert!(Folders::new(Path::new(""), &[]).file("none.obj").is_ok());
    }
}
