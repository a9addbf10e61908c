//! Views of the machine's inside: one a part, beside the screens.

mod view;
mod counters;
mod display;
mod help;
mod line;
mod messages;
mod network;
mod structure;
mod tablet;
mod all;

pub use all::all;
pub use view::View;
