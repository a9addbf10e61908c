//! Scene scripts: Rhai programs that build a scene.
//!
//! Every function that a script may call is one row of a table, from which its binding, its help, and the reference
//! are derived.

mod argument;
mod builder;
mod camera_call;
mod daylight;
mod definition;
mod engine;
mod error;
mod folders;
mod function;
mod lighting;
mod lists;
mod materials;
mod printed;
mod sculpting;
mod shaping;
mod showing;
mod solids;
mod spline;
mod stored;
mod subdividing;
mod surfaces;
mod table;
mod texturing;

#[cfg(test)]
mod surface_tests;
#[cfg(test)]
mod tests;

pub use camera_call::camera_call;
pub use definition::Definition;
pub use engine::{MAX_OPERATIONS, MAX_SCRIPT_BYTES};
pub use error::ScriptError;
pub use function::{Function, Kind, Parameter};

use crate::scene::Scene;
use crate::spelling;
use std::path::{Path, PathBuf};

/// Every function that a script may call: those that make and combine objects, then the others.
pub fn functions() -> impl Iterator<Item = &'static Function> {
    [
        solids::FUNCTIONS,
        shaping::FUNCTIONS,
        surfaces::FUNCTIONS,
        subdividing::FUNCTIONS,
        materials::FUNCTIONS,
        texturing::FUNCTIONS,
        lighting::FUNCTIONS,
        daylight::FUNCTIONS,
        showing::FUNCTIONS,
        stored::FUNCTIONS,
        table::FUNCTIONS,
    ]
    .into_iter()
    .flatten()
}

/// Whether a function gives an object its shape, rather than a place, a material or a name.
fn makes_shapes(function: &Function) -> bool {
    let families = [solids::FUNCTIONS, shaping::FUNCTIONS, surfaces::FUNCTIONS, subdividing::FUNCTIONS];
    families.into_iter().flatten().any(|row| row.name == function.name)
}

/// A scene that ships with the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What it shows.
    pub summary: &'static str,
    /// Its script.
    pub text: &'static str,
}

/// The scenes that ship with the program; the first is the default.
pub const EMBEDDED: [Embedded; 21] = [
    Embedded {
        name: "teapot",
        summary: "the Utah teapot on a table top, beside a mirroring sphere and a box",
        text: include_str!("../../scenes/teapot.rhai"),
    },
    Embedded {
        name: "primitives",
        summary: "every primitive shape, in a row",
        text: include_str!("../../scenes/primitives.rhai"),
    },
    Embedded {
        name: "flange",
        summary: "a machine part of solids that are united, intersected and subtracted",
        text: include_str!("../../scenes/flange.rhai"),
    },
    Embedded {
        name: "chess",
        summary: "a game of chess: revolved profiles, swept polygons, and what is cut out of them",
        text: include_str!("../../scenes/chess.rhai"),
    },
    Embedded {
        name: "car",
        summary: "a car of sculptured surfaces that are joined smoothly, closed, cut and trimmed",
        text: include_str!("../../scenes/car.rhai"),
    },
    Embedded {
        name: "crystal",
        summary: "polyhedra between sharp and smooth, by subdivision with creases",
        text: include_str!("../../scenes/crystal.rhai"),
    },
    Embedded {
        name: "manifold",
        summary: "pipes with the accurate curves in which they meet, on saddles with rounded edges",
        text: include_str!("../../scenes/manifold.rhai"),
    },
    Embedded {
        name: "materials",
        summary: "metals, glass that disperses, varnish, plastic, glaze and plain colors under lights that have a size",
        text: include_str!("../../scenes/materials.rhai"),
    },
    Embedded {
        name: "textures",
        summary: "wood, marble, tiles and plaster: patterns through bodies and on surfaces, and reliefs",
        text: include_str!("../../scenes/textures.rhai"),
    },
    Embedded {
        name: "room",
        summary: "a living room with the sun in its window, a mirror and glass; three views",
        text: include_str!("../../scenes/room.rhai"),
    },
    Embedded {
        name: "cornell",
        summary: "the box of Cornell's Program of Computer Graphics, for light that goes from surface to surface",
        text: include_str!("../../scenes/cornell.rhai"),
    },
    Embedded {
        name: "caustic",
        summary: "a glass ball over a plane under a small lamp, which it gathers to a bright spot",
        text: include_str!("../../scenes/caustic.rhai"),
    },
    Embedded {
        name: "ring",
        summary: "a gold ring and a glass ball on paper, with the caustics of the textbooks",
        text: include_str!("../../scenes/ring.rhai"),
    },
    Embedded {
        name: "spectrum",
        summary: "a prism that paints a spectrum on a screen",
        text: include_str!("../../scenes/spectrum.rhai"),
    },
    Embedded {
        name: "mirror",
        summary: "a hand mirror that throws the sun on the wall of a room",
        text: include_str!("../../scenes/mirror.rhai"),
    },
    Embedded {
        name: "flowers",
        summary: "a vase of coloured glass in the evening sun",
        text: include_str!("../../scenes/flowers.rhai"),
    },
    Embedded {
        name: "pool",
        summary: "a swimming pool in the sun, with the net of light that its waves throw",
        text: include_str!("../../scenes/pool.rhai"),
    },
    Embedded {
        name: "afternoon",
        summary: "a room that the low sun lights through the window, and a glass of water on the table",
        text: include_str!("../../scenes/afternoon.rhai"),
    },
    Embedded {
        name: "vases",
        summary: "a copper vase in one light by three forms of Cook and Torrance's idea, side by side",
        text: include_str!("../../scenes/vases.rhai"),
    },
    Embedded {
        name: "corner",
        summary: "a corner of a room where every knob of the renderers has something to do, for studies",
        text: include_str!("../../scenes/corner.rhai"),
    },
    Embedded {
        name: "motion",
        summary: "a wheel that rolls, a ball that falls and a propeller, while the shutter is open",
        text: include_str!("../../scenes/motion.rhai"),
    },
];

/// What a script is given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Values for parameters that it asks for.
    pub definitions: Vec<Definition>,
    /// Folders below which it may read, beside its own.
    pub allowed: Vec<PathBuf>,
}

/// What a script made.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The scene.
    pub scene: Scene,
    /// Name of the script, for titles and messages.
    pub name: String,
    /// What the script printed, line by line.
    pub printed: Vec<String>,
    /// The files that it read, in the order in which it named them.
    pub files: Vec<PathBuf>,
}

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
/// As [`load`].
pub fn load_file(path: &Path, inputs: &Inputs) -> Result<Evaluated, ScriptError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if PICTURES.iter().any(|picture| extension.eq_ignore_ascii_case(picture)) {
        return Err(ScriptError::Picture { path: path.into() });
    }
    let text = engine::read(path)?;
    evaluate(&text, &path.display().to_string(), path.parent().unwrap_or(Path::new("")), inputs)
}

/// Runs a script.
///
/// - `text`: the script.
/// - `name`: what messages call it.
/// - `folder`: where the relative paths in it begin.
/// - `inputs`: what it is given.
///
/// # Errors
/// [`ScriptError`], with line and column where there are any.
pub fn evaluate(text: &str, name: &str, folder: &Path, inputs: &Inputs) -> Result<Evaluated, ScriptError> {
    engine::evaluate(text, name, folder, inputs)
}

/// The reference of all functions, as Markdown.
pub fn reference() -> String {
    let mut text = String::from("# Functions of a scene script\n");
    for function in functions() {
        text.push_str(&format!("\n## {}\n\n```\n{}\n```\n", function.name, function.help()));
    }
    text
}
