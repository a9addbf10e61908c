//! Plants of a grammar as a procedural model.

use super::drawn_objects::drawn_objects;
use super::object::{Object, ProceduralModel};
use crate::illumination::Material;
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::procedural::drawing::PlantDrawing;
use crate::procedural::grammar::{EmptyEnvironment, LSystem, Specimen};
use rayon::prelude::*;
use std::fmt;

/// The parameter of a grammar that is given what a pixel spans, where it declares one.
const DETAIL: &str = "detail";
/// The box of what is drawn is wider by this part of its diagonal than what was measured: what is drawn coarsely may come
/// out a little.
const MARGIN: f64 = 0.02;
/// The detail at which the box is measured, in parts of the diagonal.
const MEASURED: f64 = 1.0 / 512.0;

/// How the plants of a grammar are drawn.
#[derive(Clone, Debug)]
pub struct GrammarSettings {
    /// Derivation steps; those of the grammar for none.
    pub steps: Option<u32>,
    /// Parameters of the grammar in place of its defaults.
    pub given: Vec<(String, Varied)>,
    /// The material of each colour; further colours have the last.
    pub materials: Vec<Material>,
    /// Length of a unit of the grammar, units of length, above 0.
    pub unit: f64,
    /// Seed of the first kind.
    pub seed: u32,
    /// How many kinds there are.
    pub kinds: u32,
}

/// Plants of a grammar, each of its kinds another one.
pub struct GrammarModel {
    system: LSystem,
    text: String,
    settings: GrammarSettings,
    bounds: Bounds,
}

impl GrammarModel {
    /// Plants of a grammar.
    ///
    /// - `text`: of the grammar.
    ///
    /// # Errors
    /// The fault of the grammar or of one of its plants, in words.
    pub fn new(text: String, settings: GrammarSettings) -> Result<GrammarModel, String> {
        let system = LSystem::parse(&text).map_err(|error| error.to_string())?;
        let mut model = GrammarModel { system, text, settings, bounds: Bounds::EMPTY };
        let seeds = 0..model.settings.kinds;
        // What stands at one place has no size, but the surfaces that are placed there have.
        let size = |seed: u32| model.draw(seed, None).map(|drawing| drawing.bounds().diagonal());
        let sizes: Vec<f64> = seeds.clone().into_par_iter().map(size).collect::<Result<_, _>>()?;
        let size = sizes.into_iter().fold(0.0, f64::max).max(1.0);
        let of = |seed: u32| -> Result<Option<Bounds>, String> {
            let drawing = model.draw(seed, None)?;
            Ok(drawing.mesh(size * MEASURED).map_err(|error| error.to_string())?.bounds())
        };
        let all: Vec<Option<Bounds>> = seeds.into_par_iter().map(of).collect::<Result<_, _>>()?;
        let whole = Bounds::of(all.into_iter().flatten().flat_map(|one| [one.min, one.max]));
        if whole.is_empty() {
            return Err("it draws nothing that has a surface".into());
        }
        let margin = MARGIN * whole.diagonal();
        model.bounds =
            Bounds { min: (whole.min - margin) * model.settings.unit, max: (whole.max + margin) * model.settings.unit };
        Ok(model)
    }

    /// Draws one of its plants, in units of the grammar.
    ///
    /// - `detail`: what a pixel spans, in these; none where nobody asks.
    fn draw(&self, seed: u32, detail: Option<f64>) -> Result<PlantDrawing, String> {
        let GrammarSettings { steps, given, seed: first, .. } = &self.settings;
        let mut given: Vec<(&str, Varied)> = given.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let takes_detail = self.system.parameters().iter().any(|parameter| parameter.name == DETAIL);
        if let Some(mean) = detail.filter(|_| takes_detail) {
            given.push((DETAIL, Varied { mean, deviation: 0.0 }));
        }
        let drawn = Specimen::new(&self.system, first.wrapping_add(seed), &given)
            .and_then(|specimen| specimen.draw(&specimen.derive(*steps, &EmptyEnvironment)?));
        drawn.map_err(|error| error.to_string())
    }
}

impl ProceduralModel for GrammarModel {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn kinds(&self) -> u32 {
        self.settings.kinds
    }

    fn materials(&self) -> Vec<Material> {
        self.settings.materials.clone()
    }

    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        let GrammarSettings { materials, unit, .. } = &self.settings;
        let detail = detail / unit;
        let drawing = self.draw(seed, Some(detail))?;
        let material = |colour: u32| materials.get(colour as usize).or(materials.last()).cloned();
        let mut objects = drawn_objects(&drawing, |colour| format!("colour {colour}"), material, detail)
            .map_err(|error| error.to_string())?;
        let scale = glam::DMat4::from_scale(glam::DVec3::splat(*unit));
        objects.iter_mut().for_each(|object| object.transform = scale);
        Ok(objects)
    }

    fn definition(&self) -> String {
        format!("{:?}\n{}", self.settings, self.text)
    }
}

impl fmt::Debug for GrammarModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "grammar of {} bytes, {:?}", self.text.len(), self.settings)
    }
}
