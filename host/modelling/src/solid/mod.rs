//! Solids: closed surfaces with an inside, and what can be done with them.

mod error;
mod union_find;
mod cleaning;
pub mod boolean;
mod closed;
mod self_intersection;
mod shells;
mod import;
mod operations;
mod mass;
mod repair;
mod exact;
mod glue;
mod body;
pub mod primitive;
mod rounded;

pub use body::{Body, Face, Measures};
pub use boolean::{Counts, Expression, Outcome};
pub use cleaning::retain;
pub use closed::Solid;
pub use error::{OpenLoop, SolidError};
pub use exact::{ExactSolid, moved};
pub use glue::GlueError;
pub use mass::Mass;
pub use primitive::{Primitive, PrimitiveError};
pub use repair::{Repair, boundary};
pub use rounded::{EdgeChoice, RoundingError};

#[cfg(test)]
mod tests;
