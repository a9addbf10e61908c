//! Where a scene comes from: a script file, or a name.

use super::values::seconds;
use super::{CommandFailure, Exit, output};
use crate::mesh;
use crate::octree::Octree;
use crate::scene::{Prepared, Scene, Studio};
use crate::script::{self, Evaluated, Inputs, ParameterAssignment};
use crate::stages::stage;
use clap::Args;
use std::path::{Path, PathBuf};

/// Help for the argument SCRIPT.
pub const SCRIPT_HELP: &str = "A scene script (.rhai), a mesh (.obj, .stl, .ply, .gltf, .glb, .cmesh), an octree that was kept (.octree), or the name of a scene that ships: teapot, primitives, flange, chess, car, crystal, manifold, materials, textures, room, cornell, caustic, ring, spectrum, mirror, flowers, pool, afternoon, vases, corner, motion";

/// What the script is given at every time.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct DefinitionArguments {
    /// Sets a parameter of the script; may be given more than once. A name that the script does not ask for is an error
    /// that lists those that it asks for
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE")]
    given: Vec<ParameterAssignment>,
    /// Lets the script read below another folder than its own, too; may be given more than once
    #[arg(long, value_name = "FOLDER")]
    allow: Vec<PathBuf>,
}

impl DefinitionArguments {
    /// What the script is given at a time.
    ///
    /// - `time`: of the picture, seconds. `shutter`: as in [`Inputs`].
    pub(super) fn inputs(&self, time: f64, shutter: Option<[f64; 2]>) -> Inputs {
        Inputs { definitions: self.given.clone(), allowed: self.allow.clone(), time, shutter }
    }
}

/// What the script is given.
#[derive(Args, Clone, Debug, Default)]
pub struct ScriptArguments {
    #[command(flatten)]
    definitions: DefinitionArguments,
    /// The time of the picture, for a scene that is a function of it: what the script gets from time(), and when the
    /// shutter begins to count [default: 0]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    time: Option<f64>,
}

impl ScriptArguments {
    /// These arguments with a time instead of their own, seconds.
    pub(super) fn at(&self, time: f64) -> ScriptArguments {
        ScriptArguments { time: Some(time), ..self.clone() }
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.definitions.given.is_empty() && self.time.is_none()
    }
}

/// The file that a name on the command line means; none for the name of a scene that ships.
pub(super) fn file(name: &str) -> Option<&Path> {
    script::EMBEDDED.iter().all(|embedded| embedded.name != name).then_some(Path::new(name))
}

/// Whether a name is that of a file with triangles, and not of a script.
pub(super) fn is_mesh(name: &Path) -> bool {
    mesh::Format::of(name).is_some() || Octree::is_file(name)
}

/// The scene that the command line names, to be looked at: a mesh and a script that asks for it in a studio, and one that
/// has no light is lit, of which a line tells.
///
/// # Errors
/// A [`CommandFailure`] with [`super::Exit::Scene`], if the script is wrong or the mesh cannot be read.
pub(super) fn load_lit(name: &str, definitions: &ScriptArguments) -> Result<Evaluated, CommandFailure> {
    lit(load(name, definitions)?)
}

/// What [`load`] gave, to be looked at, as [`load_lit`] says it.
///
/// # Errors
/// A [`CommandFailure`] with [`super::Exit::Scene`].
pub(super) fn lit(evaluated: Evaluated) -> Result<Evaluated, CommandFailure> {
    let count = evaluated.scene.lights.len();
    let is_lit_by_studio = evaluated.scene.studio == Some(Studio::Lit);
    let scene = evaluated.scene.lit()?;
    if scene.lights.len() > count && !is_lit_by_studio {
        output::write_error("the scene has no light of its own: it is lit as in a studio");
    }
    Ok(Evaluated { scene, ..evaluated })
}

/// Says on standard error that a picture will be empty.
pub(super) fn warn_of_emptiness(scene: &Scene) {
    if scene.objects.is_empty() {
        output::warn("the scene has no objects; only its background will be seen");
    }
}

/// Says on standard error which instances did not all find room.
pub(super) fn warn_of_short_scatters(prepared: &Prepared) {
    prepared.short_scatters.iter().for_each(|short| output::warn(&short.to_string()));
}

/// The scene of a time, to be looked at, as [`load_lit`] says it.
///
/// - `inputs`: what the script is given, and when.
///
/// # Errors
/// A [`CommandFailure`] with [`super::Exit::Scene`].
pub(super) fn load_lit_at(name: &str, inputs: &Inputs) -> Result<Evaluated, CommandFailure> {
    lit(evaluate(name, inputs)?)
}

/// Runs the script that the command line names, or takes the mesh that it names as the only object of a scene; what the
/// script prints goes to standard error.
///
/// # Errors
/// A [`CommandFailure`] with [`super::Exit::Scene`].
pub fn load(name: &str, arguments: &ScriptArguments) -> Result<Evaluated, CommandFailure> {
    if !arguments.is_empty() && is_mesh(Path::new(name)) {
        return Err(no_script(name));
    }
    evaluate(name, &arguments.definitions.inputs(arguments.time.unwrap_or_default(), None))
}

/// The scene of a script or a mesh.
fn evaluate(name: &str, inputs: &Inputs) -> Result<Evaluated, CommandFailure> {
    let path = Path::new(name);
    if is_mesh(path) {
        if !inputs.definitions.is_empty() {
            return Err(no_script(name));
        }
        return Ok(Evaluated {
            scene: Scene::of_mesh(path),
            name: stem(name).into(),
            printed: Vec::new(),
            is_timed: false,
            files: Vec::new(),
        });
    }
    let stage = stage!("evaluating the script");
    let evaluated = script::load(name, inputs)?;
    drop(stage);
    evaluated.printed.iter().for_each(|line| output::write_error(line));
    Ok(evaluated)
}

/// What is said where a mesh is given what only a script takes.
fn no_script(name: &str) -> CommandFailure {
    CommandFailure::new(Exit::Usage, anyhow::anyhow!("-D and --time are for a script, and {name} is none"))
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
