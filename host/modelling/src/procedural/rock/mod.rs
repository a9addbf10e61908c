//! Rocks and crystals: bodies that planes bound, rounded and rough, or as exact polyhedra.

mod boulder;
mod boulder_mesh;
mod crystal;

pub use boulder::{Rock, RockError, RockNumbers};
pub use crystal::{CRYSTAL_HABITS, CrystalHabit, crystal_planes};

#[cfg(test)]
mod tests;
