//! Solids: closed surfaces with an inside, and what can be done with them.

pub mod boolean;

#[cfg(test)]
mod tests;
