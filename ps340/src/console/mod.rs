//! The console: a window with both screens and every device of the machine.
//!
//! It is the only user of egui and eframe, and owns no state of the machine: it sees by a mirror
//! ([`crate::shell::Mirror`]) and acts by operator commands, as an operator on a line does.

mod operator_commands;
mod widget_positions;
mod mapping;
mod fault;
mod libraries;
mod link;
mod painter;
mod puck;
mod keyboard;
mod dials;
mod steering;
mod screens;
mod split;
mod pad;
mod keys;
mod devices;
mod readable;
mod views;
mod welcome;
mod choices;
mod bar;
mod app;
mod window;

pub use fault::ConsoleError;
pub use link::Appearance;
pub use mapping::{DEFAULT_MAPPING, Mapping, MappingError};
pub use window::open;
