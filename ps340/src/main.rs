//! The process `ps340`.

fn main() {}
