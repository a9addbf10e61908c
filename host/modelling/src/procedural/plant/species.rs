//! Species: what a plant looks like, as plain data, and how one of its plants is drawn.

use super::error::PlantError;
use super::instant::PlantInstant;
use super::organ::{ColourTrack, Organ};
use super::parameters::TreeNumberError;
use super::tree_model::TreeModel;
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::procedural::drawing::{PlacedPredefined, PlantDrawing, Stroke, StrokeNode};

/// A species of plants: trees, herbs, grasses.
#[derive(Clone, Debug, PartialEq)]
pub struct Species {
    /// Its name.
    pub name: String,
    /// What the literature tells of it.
    pub published: Vec<PublishedRange>,
    /// The stems of which it is made, all from one place: one for most; blades and stalks of a grass are two.
    pub parts: Vec<SpeciesPart>,
}

/// Stems of a species, with what they look like.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeciesPart {
    /// How they grow, and their organs.
    pub tree: TreeModel,
    /// Their surface.
    pub stem: StemLook,
}

/// A measure of a species in the literature.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedRange {
    /// Of what: `height`, metres, `crown_ratio`, width of the crown to the height, or `branch_angle`, degrees to the trunk.
    pub what: String,
    /// The least and the most.
    pub range: [f64; 2],
}

/// The surface of stems.
#[derive(Clone, Debug, PartialEq)]
pub struct StemLook {
    /// Its colours over the year.
    pub colours: ColourTrack,
    /// The second colour of its pattern, in parts of the first.
    pub contrast: f64,
    /// Its pattern.
    pub pattern: BarkPattern,
    /// Size of the pattern, units of length.
    pub size: f64,
    /// Depth of its furrows, units of length, 0 and more.
    pub depth: f64,
    /// Light that goes through, in parts of what is reflected: of blades.
    pub transmission: f64,
}

/// The pattern of bark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BarkPattern {
    /// None.
    Plain,
    /// Furrows along the stem.
    Furrowed,
    /// Bands across it, as of birches.
    Banded,
    /// Plates, as of pines.
    Plated,
}

/// The patterns with their words.
pub const BARK_PATTERNS: [(&str, BarkPattern); 4] = [
    ("plain", BarkPattern::Plain),
    ("furrowed", BarkPattern::Furrowed),
    ("banded", BarkPattern::Banded),
    ("plated", BarkPattern::Plated),
];

/// What a colour of the drawing of a plant stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlantColour<'a> {
    /// The surface of stems.
    Stem(&'a StemLook),
    /// Organs.
    Organ(&'a Organ),
}

impl Species {
    /// Sets a number of all parts that have it as their own.
    ///
    /// # Errors
    /// [`TreeNumberError`].
    pub fn set(&mut self, name: &str, value: Varied) -> Result<(), TreeNumberError> {
        self.parts.iter_mut().try_for_each(|part| part.tree.numbers.set(name, &[value]))
    }

    /// What the colours of its drawings stand for, by their numbers: of each part its stems and its organs.
    pub fn colours(&self) -> Vec<PlantColour<'_>> {
        let of = |part: &'_ SpeciesPart| part.tree.organs.len();
        let mut colours = Vec::with_capacity(self.parts.iter().map(|part| 1 + of(part)).sum());
        for part in &self.parts {
            colours.push(PlantColour::Stem(&part.stem));
            colours.extend(part.tree.organs.iter().map(PlantColour::Organ));
        }
        colours
    }

    /// Draws one of its plants; what its colours stand for tells [`Species::colours`].
    ///
    /// - `seed`: which one.
    /// - `detail`: what is smaller may be left out or stand for several, units of length, above 0.
    ///
    /// # Errors
    /// More stems than there may be, and less memory than the drawing takes.
    pub fn grow(&self, seed: u32, instant: PlantInstant, detail: f64) -> Result<PlantDrawing, PlantError> {
        let mut whole = PlantDrawing::default();
        let mut surfaces = Vec::new();
        let mut colours = 0;
        for SpeciesPart { tree, .. } in &self.parts {
            let part = tree.grow(seed, instant, detail)?;
            let (node, surface) = (whole.nodes.len(), surfaces.len());
            whole.nodes.extend(part.nodes.iter().map(|one| StrokeNode { colour: one.colour + colours, ..*one }));
            whole.strokes.extend(part.strokes.iter().map(|one| Stroke { first: one.first + node, ..*one }));
            whole.placed.extend(part.placed.iter().map(|one| PlacedPredefined {
                surface: one.surface + surface,
                colour: one.colour + colours,
                ..*one
            }));
            surfaces.extend(part.surfaces.iter().cloned());
            colours += 1 + tree.organs.len() as u32;
        }
        whole.surfaces = surfaces.into();
        Ok(whole)
    }

    /// A box that holds plants of some seeds, however coarse they are drawn.
    ///
    /// - `first`: the first seed. `count`: how many follow each other.
    ///
    /// # Errors
    /// Those of [`Species::grow`].
    pub fn bounds(&self, first: u32, count: u32, instant: PlantInstant) -> Result<Bounds, PlantError> {
        let mut corners = Vec::new();
        for part in &self.parts {
            let bounds = part.tree.bounds(first, count, instant)?;
            corners.extend([bounds.min, bounds.max]);
        }
        Ok(Bounds::of(corners))
    }
}
