//! The program `peris`.

fn main() {}
