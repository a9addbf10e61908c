//! The mass memory: names, display structure and function network together, and the operations that touch more than
//! one.

mod refusal;
mod system;
mod initial;
mod insertions;
mod line_instances;
mod mass;
mod physical;
mod prefix;
mod own_instances;
mod deletion;
mod rendering;
mod messages;
mod restore;
mod title;

pub use mass::{MASS_MEMORY, MassMemory};
pub use refusal::Refusal;
pub use system::{INITIAL_WORKING_STORAGE, MAX_INTERFACE_ENTRIES, System};
