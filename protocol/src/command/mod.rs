//! The command language: text and binary forms of the same plain data.

pub mod syntax;

pub use syntax::*;
