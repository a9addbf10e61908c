//! Where a scene comes from: a script file, or a name.

use super::Failure;
use crate::script::{self, Evaluated};
use std::path::Path;

/// Help for the argument SCRIPT.
pub const SCRIPT_HELP: &str =
    "A scene script (.rhai), or the name of a scene that ships with the program: teapot, primitives, flange, chess";

/// Runs the script that the command line names; what it prints goes to standard error.
///
/// # Errors
/// A [`Failure`] with [`super::Exit::Scene`].
pub fn load(name: &str) -> Result<Evaluated, Failure> {
    let evaluated = script::load(name)?;
    for line in &evaluated.printed {
        eprintln!("{line}");
    }
    Ok(evaluated)
}

/// The name of a script without folder and ending, for the files that are made of it.
pub(super) fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|s| s.to_str()).unwrap_or("scene")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_names_every_scene_that_ships() {
        assert!(script::EMBEDDED.iter().all(|e| SCRIPT_HELP.contains(e.name)));
        assert_eq!((stem("a/b/cup.rhai"), stem("teapot")), ("cup", "teapot"));
    }
}
