//! The species that ship with the program: a file and a row each.

/// A species that ships with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedSpecies {
    /// Its name in scripts.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// Makes the table of species.
macro_rules! species {
    ($($name:literal,)*) => {
        /// The species that ship with the program, by their names.
        pub const SPECIES: &[ShippedSpecies] = &[
            $(ShippedSpecies { name: $name, text: include_str!(concat!("../../../species/", $name, ".toml")) },)*
        ];
    };
}

species! {
    "apple",
    "ash",
    "bamboo",
    "beech",
    "birch",
    "cherry",
    "cornflower",
    "cypress",
    "daisy",
    "dandelion",
    "elm",
    "fern",
    "grass",
    "hazel",
    "horse_chestnut",
    "larch",
    "lavender",
    "linden",
    "maple",
    "oak",
    "palm",
    "pine",
    "poplar",
    "poppy",
    "reed",
    "rowan",
    "spruce",
    "sunflower",
    "tulip",
    "wheat",
    "willow",
}
