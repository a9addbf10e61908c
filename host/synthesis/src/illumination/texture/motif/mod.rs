//! The kinds of pattern: a file and a row each.

mod sampled;
mod checker;
mod clouds;
mod marble;
mod wood;
mod varied;
mod cover;
mod strata;
mod cracks;

use super::{Image, MOST_PAINTS, TextureError, TextureFootprint};
use cover::Lying;
use sampled::Sampled;
use serde::{Deserialize, Serialize};

/// Makes the enumeration of patterns. A row is the word for a kind, its numbers, what is checked of them, how much there is
/// of each paint over a footprint, and in all; and a pattern of the kind that tests of all of them try, of two paints.
macro_rules! motifs {
    ($($(#[doc = $doc:literal])* $kind:ident $word:literal $({
        $($(#[doc = $help:literal])* $field:ident: $type:ty,)*
    })? check $check:expr, parts |$sampled:ident| $parts:expr, mean $mean:expr $(, tried $tried:expr)?;)*) => {
        /// The kind of a pattern, of which one repetition has the size 1.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Motif {
            $($(#[doc = $doc])* #[serde(rename = $word)] $kind $({
                $($(#[doc = $help])* $field: $type,)*
            })?,)*
        }

        impl Motif {
            /// Patterns of two paints that tests try, one of each kind.
            #[cfg(test)]
            pub(super) const TRIED: &[Motif] = &[$($($tried,)?)*];

            /// The words for all kinds.
            #[cfg(test)]
            pub(super) const WORDS: &[&str] = &[$($word,)*];

            /// The word for the kind.
            pub fn word(&self) -> &'static str {
                match self {
                    $(Motif::$kind { .. } => $word,)*
                }
            }

            pub(super) fn check(&self) -> Result<(), TextureError> {
                match self {
                    // Not every number counts here.
                    $(Motif::$kind $({ $($field),* })? => {
                        $($(let _ = $field;)*)?
                        $check
                    })*
                }
            }

            fn sampled(&self, sampled: &Sampled<'_>) -> [f64; MOST_PAINTS] {
                match self {
                    $(Motif::$kind $({ $($field),* })? => {
                        let $sampled = sampled;
                        $parts
                    })*
                }
            }

            /// How much there is of each paint in all.
            pub(super) fn mean(&self) -> [f64; MOST_PAINTS] {
                match self {
                    // Not every number counts here.
                    $(Motif::$kind $({ $($field),* })? => {
                        $($(let _ = $field;)*)?
                        $mean
                    })*
                }
            }
        }
    };
}

motifs! {
    /// An image, once for each unit of u and v.
    Image "image" {
        /// The image.
        image: Image,
    }
    check Ok(()), parts |sampled| image.at(sampled.footprint).to_array(), mean image.mean().to_array();

    /// Squares or cubes of two paints in turn, two of which are as long as a unit.
    Checker "checker"
    check Ok(()), parts |sampled| two(checker::second(sampled)), mean two(checker::MEAN),
    tried Motif::Checker;

    /// Clouds of a second paint in the first.
    Noise "noise" {
        /// How many frequencies it has, each twice the one before, 1 to 16.
        octaves: u32,
    }
    check clouds::check(*octaves), parts |sampled| two(clouds::second(sampled, *octaves)), mean two(clouds::MEAN),
    tried Motif::Noise { octaves: 6 };

    /// Veins of a second paint in the first, across the x direction, a unit apart.
    Marble "marble" {
        /// How far the veins stray, in units, 0 and more.
        turbulence: f64,
        /// How narrow they are: 1 is a wave, more is narrower; up to 1000.
        sharpness: f64,
    }
    check marble::check(*turbulence, *sharpness),
    parts |sampled| two(marble::second(sampled, *turbulence, *sharpness)),
    mean two(marble::mean(*sharpness)),
    tried Motif::Marble { turbulence: 0.7, sharpness: 3.0 };

    /// Rings about the y axis, a unit wide: the first paint is early wood, the second late wood.
    Wood "wood" {
        /// How far the rings stray, in units, 0 and more.
        turbulence: f64,
        /// How much of the second paint is in fibres, 0..=1.
        grain: f64,
    }
    check wood::check(*turbulence, *grain),
    parts |sampled| two(wood::second(sampled, *turbulence, *grain)),
    mean two(wood::mean()),
    tried Motif::Wood { turbulence: 0.2, grain: 0.3 };

    /// One mixture of the two paints all over an instance, by its variation.
    Varied "varied" {
        /// Patterns of different channels vary by themselves.
        channel: u32,
    }
    check Ok(()), parts |sampled| two(varied::second(sampled, *channel)), mean two(varied::MEAN),
    tried Motif::Varied { channel: 0 };

    /// A second paint where the surface is neither too low, too high nor too steep, as snow and grass are.
    Cover "cover" {
        /// The least and the greatest y, in units.
        height: [f64; 2],
        /// The height over which it ends, 0 and more.
        edge: f64,
        /// How far the ends stray up and down, 0 and more.
        ragged: f64,
        /// The steepest surface on which it holds, degrees: 90 for any.
        steepest: f64,
    }
    check cover::check(&Lying { height: *height, edge: *edge, ragged: *ragged, steepest: *steepest }),
    parts |sampled| {
        two(cover::second(sampled, &Lying { height: *height, edge: *edge, ragged: *ragged, steepest: *steepest }))
    },
    mean two(cover::MEAN),
    tried Motif::Cover { height: [11.5, 1e9], edge: 0.5, ragged: 0.0, steepest: 90.0 };

    /// Layers of two paints across the y direction, of uneven thickness, about two in a unit.
    Strata "strata" {
        /// How far they stray, in units, 0 and more.
        turbulence: f64,
    }
    check strata::check(*turbulence), parts |sampled| two(strata::second(sampled, *turbulence)),
    mean two(strata::MEAN),
    tried Motif::Strata { turbulence: 0.4 };

    /// Scales of the second paint with cracks of the first between them.
    Cracks "cracks" {
        /// How many frequencies it has, each twice the one before, 1 to 16.
        octaves: u32,
    }
    check cracks::check(*octaves), parts |sampled| two(cracks::second(sampled, *octaves)), mean two(cracks::mean(*octaves)),
    tried Motif::Cracks { octaves: 4 };
}

impl Motif {
    /// The image, of a pattern that has its own colors.
    pub(super) fn image(&self) -> Option<&Image> {
        if let Motif::Image { image } = self { Some(image) } else { None }
    }

    /// How much there is of each paint in the mean over a footprint, in the coordinates of the pattern.
    pub(super) fn parts(&self, footprint: &TextureFootprint, is_solid: bool) -> [f64; MOST_PAINTS] {
        let sides = footprint.sides.map(|side| side.own);
        let width = sides[0].length().max(sides[1].length());
        let at = footprint.own;
        match at.is_finite() && width.is_finite() {
            true => self.sampled(&Sampled { footprint, at, sides, width, is_solid }),
            false => self.mean(),
        }
    }
}

/// The parts of two paints.
fn two(second: f64) -> [f64; MOST_PAINTS] {
    [1.0 - second, second, 0.0]
}
