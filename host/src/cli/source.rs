//! Where a scene comes from: a script file, or a name.

use super::{Failure, progress};
use crate::script::{self, Definition, Evaluated};
use clap::Args;
use std::path::Path;

/// Help for the argument SCRIPT.
pub const SCRIPT_HELP: &str = "A scene script (.rhai), or the name of a scene that ships: teapot, primitives, flange, chess, car, crystal, manifold, materials, textures, room, cornell, caustic, ring, spectrum, mirror, flowers, pool, afternoon, vases, corner, motion";

/// Values for parameters of the script.
#[derive(Args, Clone, Debug, Default)]
pub struct Definitions {
    /// Sets a parameter of the script; may be given more than once. A name that the script does not ask for is an error
    /// that lists those that it asks for
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE")]
    given: Vec<Definition>,
}

impl Definitions {
    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }
}

/// Runs the script that the command line names; what it prints goes to standard error.
///
/// # Errors
/// A [`Failure`] with [`super::Exit::Scene`].
pub fn load(name: &str, definitions: &Definitions) -> Result<Evaluated, Failure> {
    progress::stage("while evaluating the script");
    let evaluated = script::load(name, &definitions.given)?;
    progress::clear();
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
