//! What becomes of a scene while its script is edited: whenever a file that it is made of is saved, it is made anew.

use super::{arguments::ShowArguments, ready::modelled};
use crate::{
    cli::{CommandFailure, load, source},
    production::Model,
    scene::{Camera, Scene},
    workstation::InitialView,
};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::mpsc,
    thread,
    time::{Duration, SystemTime},
};

/// How often files are polled. One that has changed is read when it stays the same from one poll to the next.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// A scene that was made anew.
pub(super) struct Edit {
    /// The scene.
    pub(super) scene: Scene,
    /// It, ready to be shown.
    pub(super) model: Model,
    /// Whether it is seen as the scene before was, because its script asks for the same camera.
    pub(super) same_view: bool,
}

/// When a file was written, and its bytes; none for a file that is not there.
type Stamp = Option<(SystemTime, u64)>;

/// Files, and what they were when they were looked at last.
#[derive(Default)]
pub(super) struct WatchedFiles(Vec<(PathBuf, Stamp)>);

impl WatchedFiles {
    /// The script, or mesh, as it is before it is read.
    pub(super) fn of(script: &str) -> WatchedFiles {
        let mut watched = WatchedFiles::default();
        watched.follow(source::file(script).map(Path::to_path_buf));
        watched
    }

    /// Watches these files from now on. One that was watched already has changed if it is not as it was then: it may
    /// have been saved while it was read.
    fn follow(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        let before = std::mem::take(&mut self.0);
        let known = |file: &Path| before.iter().find(|(other, _)| other == file).map(|(_, stamp)| *stamp);
        let stamped = |file: PathBuf| (known(&file).unwrap_or_else(|| stamp(&file)), file);
        self.0 = files.into_iter().map(stamped).map(|(stamp, file)| (file, stamp)).collect();
    }

    /// Whether one of them has changed since they were looked at last.
    fn have_changed(&mut self) -> bool {
        self.0.iter_mut().fold(false, |changed, (file, before)| {
            let now = stamp(file);
            let is_new = now != *before;
            *before = now;
            changed || is_new
        })
    }
}

fn stamp(file: &Path) -> Stamp {
    let about = fs::metadata(file).ok()?;
    Some((about.modified().ok()?, about.len()))
}

/// The script, or mesh, and all that it reads.
fn files(script: &str, read: &[PathBuf]) -> Vec<PathBuf> {
    let own = source::file(script).map(Path::to_path_buf);
    own.into_iter().chain(read.iter().cloned()).collect()
}

/// Tells of the scene whenever it was made anew, or why it could not be, in a thread of its own that ends when nobody
/// listens.
///
/// - `watched`: the script. `files_read`: by the scene as it is shown now. `camera`: that its script asks for.
///   `initial`: from where it is seen.
pub(super) fn watch(
    arguments: &ShowArguments,
    mut watched: WatchedFiles,
    files_read: &[PathBuf],
    camera: Option<Camera>,
    initial: InitialView,
) -> mpsc::Receiver<Result<Edit, CommandFailure>> {
    let (sender, edits) = mpsc::channel();
    let arguments = arguments.clone();
    watched.follow(files(&arguments.script, files_read));
    let (mut camera, mut initial) = (camera, initial);
    thread::spawn(move || {
        loop {
            thread::sleep(POLL_INTERVAL);
            if !watched.have_changed() {
                continue;
            }
            while watched.have_changed() {
                thread::sleep(POLL_INTERVAL);
            }
            let edit = load(&arguments.script, &arguments.definitions).and_then(|evaluated| {
                watched.follow(files(&arguments.script, &evaluated.files));
                let asked = evaluated.scene.camera;
                let keeps_view = asked == camera;
                let scene = source::lit(evaluated)?.scene;
                let (model, _) = modelled(&scene, &arguments, keeps_view.then_some(initial))?;
                (camera, initial) = (asked, *model.initial());
                Ok(Edit { scene, model, same_view: keeps_view })
            });
            if sender.send(edit).is_err() {
                return;
            }
        }
    });
    edits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_saved_vanishes_or_comes_has_changed_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
        fs::write(&one, "1").expect("written");
        let mut watched = WatchedFiles::default();
        watched.follow([one.clone(), two.clone()]);
        let changes = |watched: &mut WatchedFiles| [watched.have_changed(), watched.have_changed()];
        assert_eq!(changes(&mut watched), [false, false]);
        fs::write(&one, "12").expect("written");
        assert_eq!(changes(&mut watched), [true, false]);
        fs::write(&two, "").expect("written");
        assert_eq!(changes(&mut watched), [true, false]);
        fs::remove_file(&one).expect("removed");
        assert_eq!(changes(&mut watched), [true, false]);
        // What is saved before the files are followed anew has changed, too.
        fs::write(&one, "1").expect("written");
        watched.follow([one]);
        assert_eq!(changes(&mut watched), [true, false]);
    }
}
