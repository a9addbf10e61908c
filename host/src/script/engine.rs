//! One run of a script.

use super::bindings::{self, State};
use super::builder::Builder;
use super::calling;
use super::definition::ParameterAssignment;
use super::error::{self, ScriptError};
use super::evaluated::{Evaluated, Inputs};
use super::printed::Printed;
use super::source::ScriptSource;
use crate::memory;
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// Longest script, bytes.
const MAX_SCRIPT_BYTES: u64 = 4 << 20;

/// Reads a script.
pub(super) fn read(path: &Path) -> Result<String, ScriptError> {
    let failed = |source| ScriptError::Read { path: path.into(), source };
    memory::read_text(path, MAX_SCRIPT_BYTES).map_err(failed)
}

/// What one run of a script made.
pub(super) struct ScriptRun {
    /// The scene, what was printed, and the files that were read.
    pub(super) made: Evaluated,
    /// When the shutter opens and closes, seconds from the time of the picture.
    pub(super) shutter: [f64; 2],
    /// Whether the script asked for the time.
    pub(super) asked_time: bool,
}

/// Runs a script once.
///
/// - `text`: the script.
/// - `name`: what messages call it.
/// - `folder`: where the relative paths in it begin.
/// - `inputs`: what it is given.
/// - `now`: what it gets when it asks for the time, seconds.
///
/// # Errors
/// [`ScriptError`], with line and column where there are any.
pub(super) fn run(text: &str, name: &str, folder: &Path, inputs: &Inputs, now: f64) -> Result<ScriptRun, ScriptError> {
    let source = ScriptSource {
        text: text.to_owned(),
        name: name.to_owned(),
        folder: folder.into(),
        inputs: inputs.clone(),
        call: calling::call,
    };
    let state: State = Rc::new(RefCell::new(Builder::new(Arc::new(source), now)));
    let printed = Rc::new(RefCell::new(Printed::default()));
    let mut engine = bindings::engine(&state, &Rc::default());
    let lines = Rc::clone(&printed);
    engine.on_print(move |text| lines.borrow_mut().add(text));
    let outcome = engine.run(text);
    drop(engine);
    outcome.map_err(|e| error::locate(&e, text, name))?;
    if let Some(ParameterAssignment { name: parameter, value }) = state.borrow().definitions.unknown() {
        let (parameter, value, known) = (parameter.clone(), value.clone(), state.borrow().definitions.list());
        return Err(ScriptError::Definition { file: name.to_owned(), parameter, value, known });
    }
    let (mut scene, shutter) = state.borrow().finish();
    scene.origins.file = name.to_owned();
    scene.check().map_err(|source| ScriptError::Scene { file: name.to_owned(), source: Box::new(source) })?;
    let printed = printed.take().finish();
    let files = state.borrow().folders.named();
    let asked_time = state.borrow().asked_time;
    let is_timed = asked_time || !scene.motions.is_empty();
    let made = Evaluated { scene, name: name.to_owned(), printed, is_timed, files };
    Ok(ScriptRun { made, shutter, asked_time })
}
