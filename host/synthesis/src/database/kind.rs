//! The kinds of records.

use serde::Serialize;
use std::fmt;

/// The longest name, bytes.
pub const LONGEST_NAME: usize = 200;
/// The largest record, bytes.
pub const MAX_RECORD: usize = 1 << 30;

/// What a record is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum RecordKind {
    /// A mesh with its groups.
    Geometry,
    /// A picture.
    Texture,
    /// How a surface reflects, lets through and emits.
    Material,
    /// A source of light.
    Light,
    /// A quantity over the wavelength, or several.
    Spectrum,
    /// Stored photons of a lamp on the surfaces of a scene.
    #[serde(rename = "caught-light")]
    #[value(name = "caught-light")]
    Photons,
}

impl RecordKind {
    /// Every kind.
    pub const ALL: [RecordKind; 6] = [
        RecordKind::Geometry,
        RecordKind::Texture,
        RecordKind::Material,
        RecordKind::Light,
        RecordKind::Spectrum,
        RecordKind::Photons,
    ];

    /// The kind in a word; the name of its table, too.
    pub fn word(self) -> &'static str {
        match self {
            RecordKind::Geometry => "geometry",
            RecordKind::Texture => "texture",
            RecordKind::Material => "material",
            RecordKind::Light => "light",
            RecordKind::Spectrum => "spectrum",
            RecordKind::Photons => "caught-light",
        }
    }

    /// The version of the form in which records of the kind are stored. It rises when what is stored changes; a test
    /// fails when that is forgotten.
    pub(super) fn version(self) -> u32 {
        match self {
            // 2: numbers that change from place to place, priorities of transparent bodies. 3: the facets of glass and
            // of brushed metals.
            RecordKind::Material => 3,
            // 2: lamps that reflect. What was stored before is read as it is.
            RecordKind::Light => 2,
            _ => 1,
        }
    }
}

impl fmt::Display for RecordKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.word())
    }
}
