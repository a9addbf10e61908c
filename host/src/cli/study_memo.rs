//! What a study has done, kept so that it can go on after an interruption.

use super::{CommandFailure, Exit, interrupts};
use crate::render::Memo;
use files::Folder;

/// What was done of a study before, if that is asked for; and where what is done is kept.
///
/// - `name`: of the study and its files. `study`: whatever it depends on, in words.
pub(super) fn memo(folder: &Folder, name: &str, study: &str, resume: bool) -> Result<Memo, CommandFailure> {
    let path = folder.path().join(format!("{name}.state"));
    let file = path.display();
    if !resume && path.exists() {
        let why = format!("{file} holds what an interrupted study has done; --resume goes on, remove it to begin anew");
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(why)));
    }
    interrupts::note_saved(format!("what is finished is kept in {file}; --resume goes on"));
    Ok(Memo::open(&path, crc32fast::hash(study.as_bytes()))?)
}
