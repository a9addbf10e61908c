//! Scene scripts: Rhai programs that build a scene.
//!
//! Every function that a script may call is one row of a table, from which its binding, its help, and the reference
//! are derived.

mod handle;
mod spline;
mod parameter;
mod kinds;
mod shared;
mod given;
mod plain;
mod definition;
mod evaluated;
mod fault;
mod source;
mod folders;
mod printed;
mod builder;
mod function;
mod camera_call;
mod solids;
mod shaping;
mod sculpting;
mod surfaces;
mod subdividing;
mod terrain;
mod wind;
mod instancing;
mod model;
mod procedural;
mod plants;
mod rocks;
mod made_of;
mod materials;
mod texturing;
mod lighting;
mod daylight;
mod showing;
mod stored;
mod table;
mod functions;
mod error;
mod bindings;
mod calling;
mod engine;
mod timed;
mod shipped;
mod loading;

#[cfg(test)]
mod instancing_tests;
#[cfg(test)]
mod procedural_tests;
#[cfg(test)]
mod plants_tests;
#[cfg(test)]
mod surface_tests;
#[cfg(test)]
mod terrain_tests;
#[cfg(test)]
mod tests;

pub use camera_call::camera_call;
pub use definition::ParameterAssignment;
pub use error::ScriptError;
pub use evaluated::{Evaluated, Inputs};
pub use fault::MAX_OPERATIONS;
pub use function::Function;
pub use functions::{functions, reference};
pub use loading::{load, load_file};
pub use parameter::Parameter;
pub use shipped::{EMBEDDED, Embedded};
pub use timed::evaluate;
