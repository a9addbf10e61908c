//! The files of frames that are there already: which are ours, and which of them need not be made again.

use super::arguments::AnimateArguments;
use super::fingerprint::FrameFingerprint;
use crate::cli::{CommandFailure, Exit};
use crate::picture::Provenance;
use std::path::{Path, PathBuf};

/// The row of a file that tells the fingerprint of its frame.
pub(super) const FINGERPRINT: &str = "Fingerprint";

/// Refuses to write over files that have the names of frames and are none.
///
/// # Errors
/// [`Exit::Usage`] as a [`CommandFailure`].
pub(super) fn check_own(arguments: &AnimateArguments) -> Result<(), CommandFailure> {
    let mut all = arguments.frames.clone().flat_map(|number| arguments.files(number));
    let is_foreign =
        |path: &PathBuf| path.symlink_metadata().is_ok() && Provenance::value_in(path, FINGERPRINT).is_none();
    let Some(first) = all.find(is_foreign) else { return Ok(()) };
    let more = match all.filter(is_foreign).count() {
        0 => String::new(),
        more => format!(", nor are {more} more"),
    };
    let message = format!(
        "{} is no frame of peris animate{more}; give another folder, or --overwrite to write over it; nothing is written",
        first.display()
    );
    Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)))
}

/// Whether all files of a frame are there, and show it.
pub(super) fn are_there(files: &[PathBuf], fingerprint: FrameFingerprint) -> bool {
    let wanted = fingerprint.to_string();
    let shows = |path: &Path| Provenance::value_in(path, FINGERPRINT).is_some_and(|found| found == wanted);
    files.iter().all(|path| shows(path))
}
