//! Plants: stems that branch, and organs that stand on them; species as text.
//!
//! [`Species::parse`] reads a species, [`Species::grow`] draws one of its plants at an age and a season. [`SPECIES`] are
//! those that ship with the program.

mod outline;
mod parameters;
mod error;
mod crown;
mod taper;
mod instant;
mod frame;
mod axis;
mod organ;
mod organ_mesh;
mod colonisation;
mod tree_model;
mod grower;
mod stem;
mod colonised;
mod tree;
mod species;
mod reading;
mod catalogue;

pub use catalogue::{SPECIES, ShippedSpecies};
pub use colonisation::Colonisation;
pub use crown::{CROWN_SHAPES, CrownShape};
pub use error::{PlantError, SpeciesError, SpeciesProblem};
pub use instant::PlantInstant;
pub use organ::{BladeArrangement, ColourTrack, Organ, OrganPlace, OrganSeason};
pub use outline::{BladeOutline, OUTLINES, OutlineError};
pub use parameters::{MOST_STEM_LEVELS, STEM_PARAMETERS, TREE_PARAMETERS, TreeNumberError, TreeNumbers, TreeParameter};
pub use species::{BARK_PATTERNS, BarkPattern, PlantColour, PublishedRange, Species, SpeciesPart, StemLook};
pub use tree_model::TreeModel;

#[cfg(test)]
mod tests;
