//! The text that runs, what it was given, and how one of its functions is called later on another thread.

use super::definition::AskedParameter;
use super::evaluated::Inputs;
use super::fault::ScriptFault;
use crate::database::Library;
use crate::scene::Object;
use rhai::Dynamic;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A script and what it was given.
#[derive(Clone)]
pub(super) struct ScriptSource {
    /// The script.
    pub(super) text: String,
    /// What messages call it.
    pub(super) name: String,
    /// Where the relative paths in it begin.
    pub(super) folder: PathBuf,
    /// What it was given.
    pub(super) inputs: Inputs,
    /// Calls one of its functions on any thread.
    pub(super) call: fn(&FunctionCall<'_>) -> Result<CallOutcome, ScriptFault>,
}

/// The databases that a script opened.
#[derive(Clone, Default)]
pub(super) struct OpenDatabases {
    /// Where names are looked up.
    pub(super) library: Arc<Library>,
    /// The files, in the order in which they were opened.
    pub(super) files: Vec<PathBuf>,
}

impl OpenDatabases {
    /// Opens another one, which is asked before the others.
    pub(super) fn open(&mut self, file: &Path) -> Result<(), String> {
        match Arc::get_mut(&mut self.library) {
            Some(library) => library.open(file).map_err(|error| error.to_string())?,
            // A model goes on with those that it has.
            None => {
                let mut library = Library::default();
                let all = self.files.iter().map(PathBuf::as_path).chain([file]);
                all.into_iter().try_for_each(|file| library.open(file)).map_err(|error| error.to_string())?;
                self.library = Arc::new(library);
            }
        }
        self.files.push(file.into());
        Ok(())
    }
}

/// A call of a function of a script, which makes objects of its own.
pub(super) struct FunctionCall<'a> {
    pub(super) source: &'a Arc<ScriptSource>,
    /// What it gets when it asks for the time, seconds.
    pub(super) now: f64,
    pub(super) databases: &'a OpenDatabases,
    /// The name of the function.
    pub(super) function: &'a str,
    pub(super) arguments: Vec<Dynamic>,
    /// Steps that it may take.
    pub(super) most_operations: u64,
    pub(super) may_ask_time: bool,
}

/// What a call made, and what it asked for.
pub(super) struct CallOutcome {
    pub(super) objects: Vec<Object>,
    /// Steps that it took.
    pub(super) operations: u64,
    /// Whether it asked for the time.
    pub(super) asked_time: bool,
    /// Parameters of the script that it asked for.
    pub(super) parameters: Vec<AskedParameter>,
    /// The files that it named.
    pub(super) files: Vec<PathBuf>,
}

impl fmt::Debug for ScriptSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} bytes", self.name, self.text.len())
    }
}
