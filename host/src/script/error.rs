//! What can be wrong with a script, and where.

use super::fault::{MAX_OPERATIONS, ScriptFault};
use super::functions::functions;
use crate::memory;
use crate::scene::{SceneError, ScriptPosition};
use crate::spelling;
use rhai::{EvalAltResult, ParseErrorType, Position};
use std::path::PathBuf;

/// A fault that keeps a script from giving a scene.
#[derive(Debug, thiserror::Error)]
pub enum ScriptError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// There is neither a file nor a scene that ships of a name.
    #[error("there is no file {name}, and no scene of that name; {advice}")]
    Unknown {
        /// The name.
        name: String,
        /// What it may have meant, or the scenes that there are.
        advice: String,
    },
    /// The file is a picture.
    #[error("{} is a picture; a scene is a script (.rhai) or a mesh. peris convert and peris diff take pictures", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
    },
    /// The script is wrong at some position.
    #[error("{0}")]
    Fault(Box<ScriptFault>),
    /// A value was given for a parameter that the script does not ask for.
    #[error("-D {parameter}={value}: {file} has no parameter {parameter}; {known}")]
    Definition {
        /// The script.
        file: String,
        /// The parameter.
        parameter: String,
        /// The value that was given.
        value: String,
        /// What the script asks for, in words.
        known: String,
    },
    /// The script runs, but what it builds is no scene.
    #[error("{file}: {source}")]
    Scene {
        /// The script.
        file: String,
        /// What is wrong.
        source: Box<SceneError>,
    },
}

/// What is said of calls without end.
const RECURSION: &str = "too many calls within calls; does the recursion end?";

/// The error of a script that has taken nearly all memory.
#[derive(Clone)]
pub(super) struct OutOfMemory;

/// The error of a script whose calls have taken the stack that they may.
#[derive(Clone)]
pub(super) struct OutOfStack;

/// Turns an error of the interpreter into ours, with its position in the script.
pub(super) fn locate(error: &EvalAltResult, script: &str, file: &str) -> ScriptError {
    let (message, position) = describe(error);
    ScriptError::Fault(Box::new(ScriptFault::new(file, script, position_of(position), message)))
}

/// A position that the interpreter tells, if it does.
pub(super) fn position_of(position: Position) -> Option<ScriptPosition> {
    position.line().map(|line| ScriptPosition { line, column: position.position().unwrap_or(1) })
}

pub(super) fn describe(error: &EvalAltResult) -> (String, Position) {
    use EvalAltResult as E;
    let position = error.position();
    let message = match error {
        E::ErrorInFunctionCall(name, _, inner, outer) => {
            let (message, position) = describe(inner);
            let called = outer.line().map_or(String::new(), |line| format!(" called in line {line}"));
            let at = if position.is_none() { *outer } else { position };
            return (format!("{message} (in {name}{called})"), at);
        }
        E::ErrorParsing(kind, _) => parsing(kind),
        E::ErrorRuntime(value, _) => value.to_string(),
        E::ErrorFunctionNotFound(signature, _) => unknown_function(signature),
        E::ErrorVariableNotFound(name, _) => format!("unknown name {name}"),
        E::ErrorTerminated(reason, _) if reason.is::<OutOfMemory>() => format!(
            "the script takes more memory than there is: {} (--memory SIZE sets how much)",
            memory::readable(memory::limit().unwrap_or_default())
        ),
        E::ErrorTooManyOperations(_) => {
            format!("the script takes more than {} steps; does it end?", MAX_OPERATIONS)
        }
        E::ErrorStackOverflow(_) => RECURSION.into(),
        E::ErrorTerminated(reason, _) if reason.is::<OutOfStack>() => RECURSION.into(),
        E::ErrorDataTooLarge(what, _) => format!("too large: {what}"),
        other => {
            let mut plain = other.to_string();
            // The position is in front of the message already.
            if let Some(end) = plain.rfind(" (line ") {
                plain.truncate(end);
            }
            plain
        }
    };
    (message, position)
}

fn parsing(kind: &ParseErrorType) -> String {
    match kind {
        ParseErrorType::Reserved(word) => format!("{word} cannot be used in a scene script"),
        other => other.to_string(),
    }
}

/// A call that fits no row: either the name or the number of values is wrong.
fn unknown_function(signature: &str) -> String {
    let name = signature.split([' ', '(']).next().unwrap_or(signature);
    if let Some(function) = functions().find(|f| f.name == name) {
        return format!("{name}: these values do not fit; use {}", function.usage());
    }
    let known: Vec<&str> = functions().map(|function| function.name).collect();
    match spelling::question(name, &known) {
        None => format!("unknown function {signature}"),
        Some(question) => format!("unknown function {signature}; {question}"),
    }
}
