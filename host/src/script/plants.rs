//! Functions of the scene language for plants, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::kinds::{Integer, Length, NameOrFile, NumberKind, PlantNumbers, Reflectances, VariedKind, VariedMap};
use super::parameter::{checked, optional, required, with_default};
use super::procedural::add_model;
use crate::color::Color;
use crate::illumination::material::{Classic, Material, MaterialKind, Translucent};
use crate::illumination::texture::Paint;
use crate::memory;
use crate::procedural::Varied;
use crate::procedural::grammar::ABOP_FIGURES;
use crate::procedural::plant::{PlantInstant, SPECIES, Species};
use crate::scene::{GrammarModel, GrammarSettings, MOST_KINDS, PlantModel};
use crate::spelling;
use glam::DVec3;
use rhai::Dynamic;
use std::sync::Arc;

/// Most bytes of the text of a species.
const MOST_TEXT: u64 = 1 << 20;

/// The paints of the colours of a turtle.
const COLOURS: [[f64; 3]; 5] =
    [[0.3, 0.2, 0.1], [0.1, 0.25, 0.03], [0.05, 0.15, 0.02], [0.8, 0.6, 0.1], [0.8, 0.1, 0.1]];

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        plant(
            species: required(
                NameOrFile { names: || SPECIES.iter().map(|row| row.name).collect(), ending: ".toml" },
                "the species",
            ),
            kinds: with_default(Integer(1, MOST_KINDS), 1, "how many different ones there are, where instances place it"),
            seed: with_default(Integer(0u32, u32::MAX), 1, "which ones"),
            age: with_default(NumberKind(0.0, 1.0), 1.0, "the part of its growth that is over"),
            season: with_default(
                NumberKind(-1e6, 1e6),
                0.5,
                "time of the year in parts of it: 0 is midwinter, 0.25 spring, 0.5 midsummer, 0.75 autumn",
            ),
            vary: optional(
                PlantNumbers,
                "those of the species",
                "numbers of the species that are others here: each a number, or [mean, deviation] of what is drawn for each plant or stem",
            ),
        )
        "Adds a plant that grows from a species: stems, leaves, blossoms and fruit by its age and the season, as finely as it is seen. Species measure in metres."
        "let oak = plant(\"oak\", #{ seed: 3, season: 0.8 }); scatter(oak, ground(200), 9);"
        |builder| {
            if builder.makes_model() {
                return Err("a plant cannot be made within the function of another model".into());
            }
            let shipped = SPECIES.iter().find(|row| row.name == species);
            let (name, text) = match shipped {
                Some(row) => (row.name.to_owned(), row.text.to_owned()),
                None if species.ends_with(".toml") => {
                    let text = read(builder, &species)?;
                    (species, text)
                }
                None => {
                    let known: Vec<&str> = SPECIES.iter().map(|row| row.name).collect();
                    return Err(format!("no species is called \"{species}\"; {}", spelling::advice(&species, &known)));
                }
            };
            let mut species = Species::parse(&text).map_err(|error| format!("{name}: {error}"))?;
            for (number, value) in varied(builder, vary)? {
                species.set(&number, value).map_err(|error| error.to_string())?;
            }
            let instant = PlantInstant { age, season };
            let model = PlantModel::new(species, instant, seed, kinds).map_err(|error| format!("{name}: {error}"))?;
            add_model(builder, "plant", Arc::new(model))
        }
    },
    function! {
        lsystem(
            grammar: required(
                NameOrFile { names: || ABOP_FIGURES.iter().map(|figure| figure.name).collect(), ending: ".lsys" },
                "its text, in the notation that the guide tells, or a figure of \"The Algorithmic Beauty of Plants\"",
            ),
            steps: optional(Integer(0u32, 100_000), "those of the grammar", "of the derivation"),
            colours: with_default(
                Reflectances,
                &COLOURS,
                "the paint of each colour of the turtle, from 0 on; further ones have the last",
            ),
            translucency: with_default(
                NumberKind(0.0, 1.0),
                0.0,
                "light that comes through from behind, in parts of what is reflected and no more than is left: of what is thin",
            ),
            unit: with_default(Length, 1.0, "length of a unit of the grammar"),
            kinds: with_default(Integer(1, MOST_KINDS), 1, "how many different ones there are, where instances place it"),
            seed: with_default(Integer(0u32, u32::MAX), 1, "which ones"),
            vary: optional(
                VariedMap,
                "those of the grammar",
                "parameters of the grammar that are others here: each a number or [mean, deviation]",
            ),
        )
        "Adds a plant, or a curve, that a grammar grows: an L-system, drawn by a turtle. It grows along y. A grammar that declares a parameter detail is given what a pixel spans there, in its units: it may leave out what is smaller."
        "lsystem(\"lychnis\", #{ steps: 18, colours: [[0.2, 0.3, 0.1], [0.1, 0.25, 0.05], [0.1, 0.2, 0.05], [0.7, 0.1, 0.4]] });"
        |builder| {
            if builder.makes_model() {
                return Err("a plant cannot be made within the function of another model".into());
            }
            let shipped = ABOP_FIGURES.iter().find(|figure| figure.name == grammar);
            let text = match shipped {
                Some(figure) => figure.grammar.to_owned(),
                None if grammar.ends_with(".lsys") => read(builder, &grammar)?,
                None => {
                    let known: Vec<&str> = ABOP_FIGURES.iter().map(|figure| figure.name).collect();
                    let advice = spelling::advice(&grammar, &known);
                    return Err(format!("no grammar is called \"{grammar}\"; {advice}"));
                }
            };
            let given = varied(builder, vary)?;
            let materials = colours.into_iter().map(|paint| sheet(paint, translucency)).collect();
            let settings = GrammarSettings { steps, given, materials, unit, seed, kinds };
            let model = GrammarModel::new(text, settings).map_err(|error| format!("{grammar}: {error}"))?;
            add_model(builder, "lsystem", Arc::new(model))
        }
    },
];

/// The text of a file.
fn read(builder: &Builder, name: &str) -> Result<String, String> {
    let path = builder.folders.file(name)?;
    memory::read_text(&path, MOST_TEXT).map_err(|error| format!("{}: {error}", path.display()))
}

/// Numbers that are others than usual.
fn varied(builder: &Builder, vary: Option<Vec<(String, Dynamic)>>) -> Result<Vec<(String, Varied)>, String> {
    let one = |(name, value): (String, Dynamic)| {
        let varied = checked(&VariedKind, &format!("{name} of vary"), &value, &builder.databases.library)?;
        Ok((name, varied))
    };
    vary.unwrap_or_default().into_iter().map(one).collect()
}

/// A material that reflects a paint, and lets a part of that through.
fn sheet(paint: Paint, translucency: f64) -> Material {
    if translucency == 0.0 {
        return Classic { diffuse: paint, ..Classic::default() }.into();
    }
    let bands = paint.mean_bands();
    let transmittance = (bands * translucency).min(DVec3::ONE - bands).max(DVec3::ZERO);
    let transmittance = Paint::from(Color::from(transmittance));
    MaterialKind::Translucent(Box::new(Translucent { diffuse: paint, transmittance, coat: None })).into()
}
