//! Materials: of what a surface is, as a scene says it, before it is prepared for rendering.

mod principled;
mod translucent;

pub use principled::Principled;
pub use translucent::Translucent;

use super::distribution::{
    DistributionError, FACET_MODELS, FAMILY, FacetForm, FacetModel, FacetTable, Tabulated, checked_roughness,
};
use super::fresnel::{Conductor, Dielectric, IndexError};
use super::texture::{NumberTexture, Paint, Relief, TextureError};
use crate::color::{Color, ColorError, Glass, Spectrum};
use crate::spelling;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How a surface reflects, lets through and emits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The kind of material, with its parameters.
    pub body: MaterialKind,
    /// Radiance that it emits on both sides, W/(m² sr); per nanometre, if a spectrum.
    pub emission: Color,
    /// The relief of the surface, if it has one.
    pub relief: Option<Relief>,
}

/// The kind of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialKind {
    /// The sum of Lambert's and Phong's terms, a mirror, and what goes straight through.
    Classic(Classic),
    /// A fraction K, distributed by a D of the family or of the user's.
    Shaped(Distributed),
    /// A metal, polished or rough.
    Metal(Metal),
    /// Glass, water, a gem: reflects and refracts.
    Transparent(Transparent),
    /// A diffuse ground under a transparent coat: plastic, varnish, glaze.
    Coated(Coated),
    /// A mixture of metal, opaque and transparent, with a coat and a sheen.
    Principled(Box<Principled>),
    /// A thin sheet that lets light through diffusely.
    Translucent(Box<Translucent>),
}

/// The sum of Lambert's and Phong's terms, a mirror, and what goes straight through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Classic {
    /// Diffusely reflected fraction, 0..=1.
    pub diffuse: Paint,
    /// Fraction in the highlight of Phong's model, 0..=1.
    pub specular: Paint,
    /// Phong's exponent n, 1 to [`Classic::MOST_EXPONENT`]; the lobe falls to one half at acos(2^(-1/n)).
    pub exponent: NumberTexture,
    /// Fraction reflected as by a mirror, 0..=1.
    pub mirror: Paint,
    /// Fraction that goes straight through, 0..=1.
    pub transparency: Paint,
}

/// A fraction K, distributed by a D.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Distributed {
    /// The reflected fraction K, 0..=1.
    pub reflectance: Paint,
    /// D.
    pub form: DistributionForm,
}

/// A distribution D.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistributionForm {
    /// A member of the family, by its name.
    Member {
        /// The name, as in [`FAMILY`].
        name: String,
        /// Its roughness m, 1e-8..=1000.
        roughness: NumberTexture,
    },
    /// One that the user defined, of the directions of light and viewer.
    Table(Tabulated),
    /// Facets that the user defined, by their angle.
    Facets(FacetTable),
}

/// A metal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metal {
    /// Refractive index over the wavelength.
    pub n: Spectrum,
    /// Extinction coefficient over the wavelength.
    pub k: Spectrum,
    /// How it was worked.
    pub finish: Finish,
}

/// How a surface was worked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// A mirror.
    Polished,
    /// Facets, distributed by a member of the family.
    Rough {
        /// The name, as in [`FAMILY`].
        name: String,
        /// Its roughness m, 1e-8..=1000.
        roughness: NumberTexture,
    },
    /// Facets that are not as rough along one direction as across it, and reflect once.
    Brushed {
        /// The name, "GGX" or "Beckmann".
        #[serde(default = "beckmann")]
        name: String,
        /// Roughness along and across, 1e-8..=1000.
        roughness: [NumberTexture; 2],
        /// The direction, in the coordinates of the scene; any length but 0.
        along: DVec3,
    },
    /// Facets that the user defined, by their angle.
    Facets(FacetTable),
}

/// The distribution of brushed metals that do not name one.
fn beckmann() -> String {
    "Beckmann".into()
}

/// Glass, water, a gem.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transparent {
    /// The refractive index.
    pub index: RefractiveIndex,
    /// Roughness m of both sides of its surface, 1e-8..=1000; 0 is polished, unless its facets are a table.
    pub roughness: NumberTexture,
    /// The facets of its surface, where it is not polished.
    #[serde(default)]
    pub facets: FacetForm,
    /// Absorption inside, in one unit of length of the scene: light falls by exp(−absorption).
    pub absorption: Color,
    /// Of bodies that are in one place, that of the greatest priority is there; of several with the same, the smallest.
    /// [`Transparent::LIQUID`] of liquids, and 0 of what is solid, if nothing else is said.
    pub priority: i32,
}

impl Transparent {
    /// The priority of liquids: the glass in which one is keeps its place.
    pub const LIQUID: i32 = -1;

    /// A polished, clear one of a refractive index, with the priority of solids.
    pub fn clear(index: RefractiveIndex) -> Transparent {
        let facets = FacetForm::default();
        Transparent { index, roughness: 0.0.into(), facets, absorption: Color::BLACK, priority: 0 }
    }
}

/// A refractive index.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RefractiveIndex {
    /// One number at all wavelengths, 1e-6..=1e6.
    Constant(f64),
    /// By Sellmeier's formula.
    Dispersive(Glass),
}

impl RefractiveIndex {
    /// The index at a wavelength, nm; where the formula of a glass does not hold, that of the nearest where it does.
    pub fn at(&self, wavelength: f64) -> f64 {
        match self {
            RefractiveIndex::Constant(index) => *index,
            RefractiveIndex::Dispersive(glass) => glass.index(wavelength.clamp(glass.from, glass.to)).unwrap_or(1.0),
        }
    }
}

/// A diffuse ground under a transparent coat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coated {
    /// Diffuse reflectance of the ground, 0..=1.
    pub diffuse: Paint,
    /// Refractive index of the coat, 1e-6..=1e6.
    pub index: f64,
    /// Roughness m of the coat, 1e-8..=1000; 0 is polished.
    pub roughness: NumberTexture,
}

impl Default for Classic {
    fn default() -> Classic {
        let [diffuse, specular, mirror, transparency] = [0.7, 0.0, 0.0, 0.0].map(Paint::grey);
        Classic { diffuse, specular, exponent: 50.0.into(), mirror, transparency }
    }
}

impl Classic {
    /// Largest exponent of the highlight; beyond it the lobe is narrower than any lamp.
    pub const MOST_EXPONENT: f64 = 1e6;
}

impl From<Classic> for Material {
    fn from(classic: Classic) -> Material {
        MaterialKind::Classic(classic).into()
    }
}

impl From<MaterialKind> for Material {
    fn from(body: MaterialKind) -> Material {
        Material { body, emission: Color::BLACK, relief: None }
    }
}

/// The least roughness that a pattern gives: where it has less, there would be a mirror at single points.
pub const LEAST_VARYING_ROUGHNESS: f64 = 1e-3;

impl Material {
    /// The greatest priority of a transparent body, and the least with the other sign.
    pub const MOST_PRIORITY: i32 = 1000;

    /// Whether it may cast caustics: some narrow lobe reflects or transmits light that comes to it.
    pub fn may_cast_caustics(&self) -> bool {
        match &self.body {
            MaterialKind::Classic(Classic { mirror, specular, .. }) => !mirror.is_black() || !specular.is_black(),
            _ => true,
        }
    }
}

impl Default for Material {
    fn default() -> Material {
        Classic::default().into()
    }
}

/// The looks of a material in three bands: fractions of light, linear sRGB, and the exponent of a highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialPreview {
    /// Diffusely reflected fraction.
    pub diffuse: DVec3,
    /// Fraction in the highlight.
    pub specular: DVec3,
    /// Phong's exponent.
    pub exponent: f64,
    /// Fraction reflected as by a mirror.
    pub mirror: DVec3,
}

/// A reason for which a material is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A fraction that is not between 0 and 1.
    #[error("{what} {least} to {most} is not within 0 to 1")]
    Fraction {
        /// The name of the fraction.
        what: &'static str,
        /// Its least value.
        least: f64,
        /// Its greatest value.
        most: f64,
    },
    /// A quantity that is negative or not finite.
    #[error("{what} {least} to {most} is negative or not finite")]
    Negative {
        /// The name of the quantity.
        what: &'static str,
        /// Its least value.
        least: f64,
        /// Its greatest value.
        most: f64,
    },
    /// An exponent of Phong's model that is none.
    #[error("exponent {0} is not within 1 to {most}", most = Classic::MOST_EXPONENT)]
    Exponent(f64),
    /// A priority that is none.
    #[error("priority {0} is not within -{most} to {most}", most = Material::MOST_PRIORITY)]
    Priority(i32),
    /// No such distribution.
    #[error("no distribution is called \"{name}\"; {advice}")]
    Unknown {
        /// The name that was looked for.
        name: String,
        /// The name that it may have meant, or the names that there are.
        advice: String,
    },
    /// A distribution cannot be made.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// An impossible formula of an index.
    #[error(transparent)]
    Formula(#[from] ColorError),
    /// An impossible index of refraction.
    #[error(transparent)]
    Index(#[from] IndexError),
    /// An impossible pattern or relief.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

impl Material {
    /// Whether its color cannot be told in three bands: metals, glass that disperses, spectra from tables.
    pub fn is_spectral(&self) -> bool {
        self.emission.is_spectral()
            || self.paints().into_iter().any(Paint::is_spectral)
            || match &self.body {
                MaterialKind::Metal(_) => true,
                MaterialKind::Transparent(Transparent { index, absorption, .. }) => {
                    matches!(index, RefractiveIndex::Dispersive(_)) || absorption.is_spectral()
                }
                MaterialKind::Principled(principled) => principled.transmits() && principled.absorption.is_spectral(),
                MaterialKind::Classic(_)
                | MaterialKind::Shaped(_)
                | MaterialKind::Coated(_)
                | MaterialKind::Translucent(_) => false,
            }
    }

    /// The fractions of light in it.
    pub fn paints(&self) -> Vec<&Paint> {
        match &self.body {
            MaterialKind::Classic(Classic { diffuse, specular, mirror, transparency, .. }) => {
                vec![diffuse, specular, mirror, transparency]
            }
            MaterialKind::Shaped(shaped) => vec![&shaped.reflectance],
            MaterialKind::Coated(coated) => vec![&coated.diffuse],
            MaterialKind::Translucent(sheet) => vec![&sheet.diffuse, &sheet.transmittance],
            MaterialKind::Principled(principled) => vec![&principled.base_color, &principled.sheen],
            MaterialKind::Metal(_) | MaterialKind::Transparent(_) => Vec::new(),
        }
    }

    /// The numbers in it that may change from place to place.
    pub fn numbers(&self) -> Vec<&NumberTexture> {
        match &self.body {
            MaterialKind::Classic(classic) => vec![&classic.exponent],
            MaterialKind::Shaped(Distributed { form: DistributionForm::Member { roughness, .. }, .. })
            | MaterialKind::Metal(Metal { finish: Finish::Rough { roughness, .. }, .. })
            | MaterialKind::Transparent(Transparent { roughness, .. })
            | MaterialKind::Coated(Coated { roughness, .. }) => vec![roughness],
            MaterialKind::Metal(Metal { finish: Finish::Brushed { roughness, .. }, .. }) => roughness.iter().collect(),
            MaterialKind::Principled(principled) => {
                let Principled { metallic, roughness, specular, transmission, coat, .. } = &**principled;
                let Principled { coat_roughness, sheen_roughness, .. } = &**principled;
                vec![metallic, roughness, specular, transmission, coat, coat_roughness, sheen_roughness]
            }
            MaterialKind::Translucent(sheet) => sheet.coat.iter().collect(),
            MaterialKind::Metal(_) | MaterialKind::Shaped(_) => Vec::new(),
        }
    }

    /// Whether it changes from place to place.
    pub fn is_textured(&self) -> bool {
        self.relief.is_some()
            || self.paints().into_iter().any(Paint::is_pattern)
            || self.numbers().into_iter().any(NumberTexture::is_varying)
    }

    /// Whether parameters of the surface are needed to tell what it is like at a footprint.
    pub fn needs_parameters(&self) -> bool {
        self.relief.as_ref().is_some_and(Relief::needs_parameters)
            || self.paints().into_iter().any(Paint::needs_parameters)
            || self.numbers().into_iter().any(NumberTexture::needs_parameters)
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first [`MaterialError`].
    pub fn check(&self) -> Result<(), MaterialError> {
        power("emission", &self.emission)?;
        self.relief.as_ref().map_or(Ok(()), Relief::check)?;
        match &self.body {
            MaterialKind::Classic(classic) => {
                fraction("diffuse reflectance", &classic.diffuse)?;
                fraction("specular reflectance", &classic.specular)?;
                fraction("mirror reflectance", &classic.mirror)?;
                fraction("transparency", &classic.transparency)?;
                classic.exponent.check()?;
                let impossible = |exponent: &f64| !(1.0..=Classic::MOST_EXPONENT).contains(exponent);
                classic
                    .exponent
                    .range()
                    .into_iter()
                    .find(impossible)
                    .map_or(Ok(()), |n| Err(MaterialError::Exponent(n)))
            }
            MaterialKind::Shaped(shaped) => {
                fraction("reflectance", &shaped.reflectance)?;
                match &shaped.form {
                    DistributionForm::Member { name, roughness } => member(name, roughness),
                    DistributionForm::Table(_) | DistributionForm::Facets(_) => Ok(()),
                }
            }
            MaterialKind::Metal(metal) => {
                for (wavelength, n) in metal.n.samples() {
                    Conductor::new(1.0, n, metal.k.at(wavelength))?;
                }
                match &metal.finish {
                    Finish::Polished | Finish::Facets(_) => Ok(()),
                    Finish::Rough { name, roughness } => member(name, roughness),
                    Finish::Brushed { name, roughness, .. } => {
                        facet_model(name, |model| model.is_correlated && !model.is_multiple)?;
                        roughness.iter().try_for_each(rough)
                    }
                }
            }
            MaterialKind::Transparent(Transparent { index, roughness, facets, absorption, priority }) => {
                self::priority(*priority)?;
                if let FacetForm::Model(name) = facets {
                    facet_model(name, |_| true)?;
                }
                power("absorption", absorption)?;
                if let RefractiveIndex::Dispersive(glass) = index {
                    glass.check()?;
                }
                Dielectric::new(1.0, index.at(550.0))?;
                polished_or_rough(roughness)
            }
            MaterialKind::Coated(Coated { diffuse, index, roughness }) => {
                fraction("diffuse reflectance", diffuse)?;
                Dielectric::new(1.0, *index)?;
                polished_or_rough(roughness)
            }
            MaterialKind::Principled(principled) => principled.check(),
            MaterialKind::Translucent(sheet) => {
                let Translucent { diffuse, transmittance, coat } = &**sheet;
                fraction("diffuse reflectance", diffuse)?;
                fraction("transmittance", transmittance)?;
                // Of each band by itself, whichever colors of patterns meet.
                let most = |paint: &Paint| {
                    let bands = paint.colors().into_iter().map(|color| match color {
                        Color::Bands(bands) => *bands,
                        Color::Spectrum(_) => DVec3::splat(color.range()[1]),
                    });
                    bands.fold(DVec3::ZERO, DVec3::max)
                };
                let sum = (most(diffuse) + most(transmittance)).max_element();
                if sum > 1.001 {
                    return Err(MaterialError::Fraction {
                        what: "the sum of reflectance and transmittance",
                        least: 0.0,
                        most: sum,
                    });
                }
                coat.as_ref().map_or(Ok(()), polished_or_rough)
            }
        }
    }

    /// Its looks in three bands, for displays that know no more of a material.
    pub fn preview(&self) -> MaterialPreview {
        self.preview_of(None)
    }

    /// Its looks in three bands at an instance, or in the mean over all.
    ///
    /// - `variation`: by which instances of one kind differ.
    pub fn preview_of(&self, variation: Option<u16>) -> MaterialPreview {
        let shine = |roughness: f64| (2.0 / roughness.max(1e-3).powi(2) - 2.0).clamp(1.0, Classic::MOST_EXPONENT);
        let black = MaterialPreview { diffuse: DVec3::ZERO, specular: DVec3::ZERO, exponent: 1.0, mirror: DVec3::ZERO };
        let bands = |paint: &Paint| paint.mean_bands_of(variation).clamp(DVec3::ZERO, DVec3::ONE);
        match &self.body {
            MaterialKind::Classic(Classic { diffuse, specular, exponent, mirror, .. }) => {
                let [diffuse, specular, mirror] = [diffuse, specular, mirror].map(bands);
                MaterialPreview { diffuse, specular, exponent: exponent.mean(), mirror }
            }
            MaterialKind::Shaped(shaped) => MaterialPreview { diffuse: bands(&shaped.reflectance), ..black },
            MaterialKind::Metal(metal) => {
                let normal = |w: f64| {
                    Conductor::new(1.0, metal.n.at(w), metal.k.at(w)).map_or(0.0, |c| c.reflectance(1.0).mean())
                };
                let color = DVec3::from_array([611.0, 549.0, 464.0].map(normal));
                match &metal.finish {
                    Finish::Polished => MaterialPreview { mirror: color, ..black },
                    Finish::Rough { roughness, .. } => {
                        MaterialPreview { specular: color, exponent: shine(roughness.mean()), ..black }
                    }
                    Finish::Facets(table) => {
                        MaterialPreview { specular: color, exponent: shine(table.roughness()), ..black }
                    }
                    Finish::Brushed { roughness: [along, across], .. } => MaterialPreview {
                        specular: color,
                        exponent: shine((along.mean() * across.mean()).sqrt()),
                        ..black
                    },
                }
            }
            MaterialKind::Principled(principled) => principled.preview(variation),
            MaterialKind::Translucent(sheet) => MaterialPreview { diffuse: bands(&sheet.diffuse), ..black },
            MaterialKind::Transparent(Transparent { index, .. }) => {
                MaterialPreview { mirror: DVec3::splat(normal_reflectance(index.at(550.0))), ..black }
            }
            MaterialKind::Coated(Coated { diffuse, index, roughness }) => {
                let reflected = DVec3::splat(normal_reflectance(*index));
                let [specular, mirror] =
                    if roughness.mean() > 0.0 { [reflected, DVec3::ZERO] } else { [DVec3::ZERO, reflected] };
                MaterialPreview { diffuse: bands(diffuse), specular, exponent: shine(roughness.mean()), mirror }
            }
        }
    }

    /// The word for its kind.
    pub fn word(&self) -> &'static str {
        match self.body {
            MaterialKind::Classic(_) => "classic",
            MaterialKind::Shaped(_) => "shaped",
            MaterialKind::Metal(_) => "metal",
            MaterialKind::Transparent(_) => "transparent",
            MaterialKind::Coated(_) => "coated",
            MaterialKind::Principled(_) => "principled",
            MaterialKind::Translucent(_) => "translucent",
        }
    }
}

fn normal_reflectance(index: f64) -> f64 {
    Dielectric::new(1.0, index).map_or(0.0, |surface| surface.reflectance(1.0).mean())
}

fn fraction(what: &'static str, paint: &Paint) -> Result<(), MaterialError> {
    paint.check()?;
    for color in paint.colors() {
        let [least, most] = color.range();
        // A spectrum that was measured may err a little.
        let possible = least >= 0.0 && most <= if color.is_spectral() { 1.001 } else { 1.0 };
        if !possible {
            return Err(MaterialError::Fraction { what, least, most });
        }
    }
    Ok(())
}

fn power(what: &'static str, color: &Color) -> Result<(), MaterialError> {
    let [least, most] = color.range();
    if least >= 0.0 && most.is_finite() { Ok(()) } else { Err(MaterialError::Negative { what, least, most }) }
}

fn priority(priority: i32) -> Result<(), MaterialError> {
    let most = Material::MOST_PRIORITY;
    if (-most..=most).contains(&priority) { Ok(()) } else { Err(MaterialError::Priority(priority)) }
}

/// Checks a roughness that may be 0.
fn polished_or_rough(roughness: &NumberTexture) -> Result<(), MaterialError> {
    if *roughness == NumberTexture::Constant(0.0) { Ok(()) } else { rough(roughness) }
}

/// Checks a roughness. One that varies may be 0 here and there: surfaces are no smoother there than they can be.
fn rough(roughness: &NumberTexture) -> Result<(), MaterialError> {
    roughness.check()?;
    let [least, most] = roughness.range();
    let least = if roughness.is_varying() && least >= 0.0 { least.max(LEAST_VARYING_ROUGHNESS) } else { least };
    for m in [least, most.max(least)] {
        checked_roughness(m)?;
    }
    Ok(())
}

/// Checks the name of a model of facets.
///
/// - `is_possible`: whether a model may be used.
fn facet_model(name: &str, is_possible: impl Fn(&FacetModel) -> bool) -> Result<(), MaterialError> {
    let models = || FACET_MODELS.iter().filter(|model| is_possible(model));
    if models().any(|model| model.name == name) {
        return Ok(());
    }
    let names: Vec<&str> = models().map(|model| model.name).collect();
    Err(MaterialError::Unknown { name: name.into(), advice: spelling::advice(name, &names) })
}

/// Checks a member of the family: its name, and its roughness.
fn member(name: &str, roughness: &NumberTexture) -> Result<(), MaterialError> {
    if !FAMILY.iter().any(|row| row.name == name) {
        let names: Vec<&str> = FAMILY.iter().map(|row| row.name).collect();
        return Err(MaterialError::Unknown { name: name.into(), advice: spelling::advice(name, &names) });
    }
    rough(roughness)
}
