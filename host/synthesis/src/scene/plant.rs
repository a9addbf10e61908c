//! Plants of a species as a procedural model.

use super::drawn_objects::drawn_objects;
use super::object::{Object, ProceduralModel};
use crate::color::Color;
use crate::illumination::material::{Classic, Material, MaterialKind, Translucent};
use crate::illumination::texture::{Motif, Paint, Pattern, Relief, TextureMapping};
use crate::numeric::bounds::Bounds;
use crate::procedural::plant::{BarkPattern, Organ, PlantColour, PlantError, PlantInstant, Species, StemLook};
use glam::DVec3;

/// How much longer than wide the pattern of bark is along the y axis, for each pattern.
const FURROWS: f64 = 7.0;
const BANDS: f64 = 0.16;
const PLATES: f64 = 2.2;
/// By how much the colour of light that comes through a leaf is deeper than that of what it reflects.
const DEEPER: f64 = 0.6;
/// The youngest plant that is made, in parts of its growth.
const YOUNGEST: f64 = 1e-3;
/// Frequencies of the noise of bark.
const OCTAVES: u32 = 4;

/// Plants of a species, each of its kinds another one, at an instant.
#[derive(Debug)]
pub struct PlantModel {
    species: Species,
    instant: PlantInstant,
    seed: u32,
    kinds: u32,
    bounds: Bounds,
    materials: Vec<Material>,
}

impl PlantModel {
    /// Plants of a species.
    ///
    /// - `seed`: of the first kind; the others have those that follow.
    /// - `kinds`: how many there are.
    ///
    /// # Errors
    /// [`PlantError`], if one of them does not grow.
    pub fn new(species: Species, instant: PlantInstant, seed: u32, kinds: u32) -> Result<PlantModel, PlantError> {
        // What has just begun to grow has a size, but none that is seen.
        let instant = PlantInstant { age: instant.age.max(YOUNGEST), ..instant };
        let bounds = species.bounds(seed, kinds, instant)?;
        let material = |colour: &PlantColour<'_>| match colour {
            PlantColour::Stem(look) => stem_material(look, instant.season),
            PlantColour::Organ(organ) => organ_material(organ, instant.season),
        };
        let materials = species.colours().iter().map(material).collect();
        Ok(PlantModel { species, instant, seed, kinds, bounds, materials })
    }
}

impl ProceduralModel for PlantModel {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn kinds(&self) -> u32 {
        self.kinds
    }

    fn materials(&self) -> Vec<Material> {
        self.materials.clone()
    }

    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        let drawing =
            self.species.grow(self.seed.wrapping_add(seed), self.instant, detail).map_err(|error| error.to_string())?;
        let colours = self.species.colours();
        let name = |colour: u32| match colours[colour as usize] {
            PlantColour::Stem(_) => "stems".to_owned(),
            PlantColour::Organ(organ) => organ.name.clone(),
        };
        let material = |colour: u32| Some(self.materials[colour as usize].clone());
        drawn_objects(&drawing, name, material, detail).map_err(|error| error.to_string())
    }

    fn definition(&self) -> String {
        format!("{:?} at {:?}, {} kinds from {}", self.species, self.instant, self.kinds, self.seed)
    }
}

/// A paint between two colours, another one for each instance.
fn between([from, to]: [DVec3; 2]) -> Paint {
    let plain = |colour: DVec3| Paint::from(Color::from(colour));
    if from == to {
        return plain(from);
    }
    let motif = Motif::Varied { channel: 0 };
    Paint::Pattern(Box::new(Pattern { motif, laying: TextureMapping::default(), paints: vec![plain(from), plain(to)] }))
}

fn organ_material(organ: &Organ, season: f64) -> Material {
    let colours = organ.colours.range(season);
    let part = organ.transmission;
    // What comes through has gone through more of the leaf: its colour is deeper.
    let rest = DVec3::ONE - colours[0].max(colours[1]);
    let through = colours.map(|colour| {
        let deeper = DVec3::ONE + DEEPER * colour / colour.max_element().max(1e-9);
        (colour * deeper * part / (1.0 + DEEPER)).min(rest)
    });
    sheet(between(colours), between(through), part, organ.gloss)
}

/// A thin sheet, or an opaque surface where nothing comes through.
fn sheet(diffuse: Paint, transmittance: Paint, part: f64, gloss: Option<f64>) -> Material {
    if part == 0.0 && gloss.is_none() {
        return MaterialKind::Classic(Classic { diffuse, ..Classic::default() }).into();
    }
    let transmittance = if part == 0.0 { Paint::grey(0.0) } else { transmittance };
    MaterialKind::Translucent(Box::new(Translucent { diffuse, transmittance, coat: gloss.map(Into::into) })).into()
}

fn stem_material(look: &StemLook, season: f64) -> Material {
    let StemLook { colours, contrast, pattern, size, depth, transmission } = look;
    let light = colours.range(season);
    if *pattern == BarkPattern::Plain {
        let rest = DVec3::ONE - light[0].max(light[1]);
        let through = light.map(|colour| (colour * *transmission).min(rest));
        return sheet(between(light), between(through), *transmission, None);
    }
    let dark = light.map(|colour| (colour * *contrast).min(DVec3::splat(0.98)));
    let along = match pattern {
        BarkPattern::Banded => BANDS,
        BarkPattern::Plated => PLATES,
        _ => FURROWS,
    };
    let laying =
        TextureMapping { solid: true, size: DVec3::new(*size, size * along, *size), ..TextureMapping::default() };
    let motif = Motif::Cracks { octaves: OCTAVES };
    let pattern = |paints: Vec<Paint>| Pattern { motif: motif.clone(), laying, paints };
    let diffuse = Paint::Pattern(Box::new(pattern(vec![between(dark), between(light)])));
    let relief = (*depth > 0.0)
        .then(|| Relief::Bumps { pattern: pattern(vec![Paint::grey(0.0), Paint::grey(1.0)]), height: *depth });
    let body = MaterialKind::Classic(Classic { diffuse, ..Classic::default() });
    Material { relief, ..body.into() }
}
