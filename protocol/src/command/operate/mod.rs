//! Operate commands: what changes the state of the descendants. Each is one row of a table.

mod notation;
mod number;
mod setting;
mod keyword_tree;
mod text;
mod transformation;
mod viewing;
mod attribute;
mod condition;
mod rendering;
mod table;

#[cfg(any(test, feature = "proptest"))]
pub use table::operates;
pub(super) use table::{ATTRIBUTES, CONDITIONS, READING_BACK, RENDERING, TEXT, TRANSFORMATIONS, VIEWING, words_after};
pub use table::{Operate, OperateKind};

#[cfg(test)]
mod tests;
