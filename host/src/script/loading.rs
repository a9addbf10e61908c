//! Scripts from files and from the program.

use super::engine;
use super::error::ScriptError;
use super::evaluated::{Evaluated, Inputs};
use super::shipped::EMBEDDED;
use super::timed::evaluate;
use crate::spelling;
use std::path::Path;

/// Endings of the names of pictures.
const PICTURES: [&str; 6] = ["png", "exr", "hdr", "jpg", "jpeg", "tif"];

/// Runs the embedded scene of this name, or else the script in the file of this name.
///
/// - `inputs`: what it is given.
///
/// # Errors
/// [`ScriptError`] if the file cannot be read, the script is wrong, or it does not ask for what is given.
pub fn load(name: &str, inputs: &Inputs) -> Result<Evaluated, ScriptError> {
    match EMBEDDED.iter().find(|e| e.name == name) {
        Some(embedded) => evaluate(embedded.text, embedded.name, Path::new(""), inputs),
        None => load_file(Path::new(name), inputs).map_err(|error| match error {
            ScriptError::Read { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                ScriptError::Unknown { name: name.into(), advice: spelling::advice(name, &EMBEDDED.map(|e| e.name)) }
            }
            other => other,
        }),
    }
}

/// Runs the script in a file; the paths in it are relative to its folder.
///
/// # Errors
/// [`ScriptError`] if the file cannot be read, the script is wrong, or it does not ask for what is given.
pub fn load_file(path: &Path, inputs: &Inputs) -> Result<Evaluated, ScriptError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if PICTURES.iter().any(|picture| extension.eq_ignore_ascii_case(picture)) {
        return Err(ScriptError::Picture { path: path.into() });
    }
    let text = engine::read(path)?;
    evaluate(&text, &path.display().to_string(), path.parent().unwrap_or(Path::new("")), inputs)
}
