//! Textures: fractions of light and heights that change from place to place.
//!
//! A [`Paint`] is a color, or a [`Pattern`] of other paints: at each place the pattern tells how much of each there is.
//! What is painted may thus be measured spectra, and patterns of patterns. Each pattern gives its mean over the part of
//! the surface that a ray stands for, so that what is far away does not shimmer.

mod image;
mod motif;
mod number;
mod footprint;
mod texels;
#[cfg(test)]
mod tests;

pub use footprint::{FootprintSide, TextureFootprint};
pub use image::{Image, ImageContent};
pub use motif::Motif;
pub use number::{Band, NumberTexture, Varying};

use crate::color::Color;
use glam::{DMat3, DVec2, DVec3};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use std::cell::Cell;

/// Most patterns within each other.
pub const MAX_NESTING: u32 = 16;
/// Paints of a pattern, at most.
pub const MOST_PAINTS: usize = 3;
/// Steps of a relief, at least, as a part of its size: differences of heights lose their digits below.
const LEAST_STEP: f64 = 1e-4;

/// A fraction of light, everywhere on a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Paint {
    /// One color everywhere.
    Plain(Color),
    /// Some of each of several paints.
    Pattern(Box<Pattern>),
}

/// How much there is of each of several paints, at each place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    /// The kind.
    pub motif: Motif,
    /// How it lies.
    pub laying: TextureMapping,
    /// The paints: two, or none for an image, which has its own.
    #[serde(deserialize_with = "nested")]
    pub paints: Vec<Paint>,
}

/// Reads the paints of a pattern, no deeper than patterns may be nested: a file must not exhaust the stack.
fn nested<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Paint>, D::Error> {
    thread_local! {
        static DEPTH: Cell<u32> = const { Cell::new(0) };
    }
    let depth = DEPTH.get();
    if depth > MAX_NESTING {
        return Err(D::Error::custom(TextureError::Nesting));
    }
    DEPTH.set(depth + 1);
    let paints = Vec::deserialize(deserializer);
    DEPTH.set(depth);
    paints
}

/// Texture mapping: how a pattern lies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TextureMapping {
    /// Whether it goes through the body, in the coordinates of the object. If not, it lies on the surface, in
    /// parameters (u, v), of which z is 0.
    pub solid: bool,
    /// Size of one repetition.
    pub size: DVec3,
    /// The point where it begins.
    pub at: DVec3,
    /// Its y direction; any length but 0.
    pub up: DVec3,
}

/// The relief of a surface: what of it is higher than it looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relief {
    /// Heights.
    Bumps {
        /// How high each place is: how much there is of the second paint, or how bright an image is.
        pattern: Pattern,
        /// Height of 1, scene units; below 0 it is deep.
        height: f64,
    },
    /// Normals from an image: red, green and blue from 0 to 1 are its components along u, along v and outwards, −1 to
    /// 1.
    Normals {
        /// The image.
        image: Image,
        /// How it lies.
        laying: TextureMapping,
    },
}

/// A reason for which a texture is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// A pattern has too few or too many paints.
    #[error("a pattern of kind {kind} has {count} paints; it needs {needed}")]
    Paints {
        /// Its kind.
        kind: &'static str,
        /// How many.
        count: usize,
        /// How many there must be.
        needed: usize,
    },
    /// A number of the pattern is out of range.
    #[error("{what} {value} of a pattern is not {range}")]
    Number {
        /// The name of the number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The range in which it must be.
        range: &'static str,
    },
    /// A number is told by a spectrum, which has no brightness of its own.
    #[error("a pattern of numbers is of greys or colors, not of spectra")]
    Spectrum,
    /// Patterns within patterns without end.
    #[error("patterns are nested more than {MAX_NESTING} deep")]
    Nesting,
}

impl From<Color> for Paint {
    fn from(color: Color) -> Paint {
        Paint::Plain(color)
    }
}

impl Default for TextureMapping {
    fn default() -> TextureMapping {
        TextureMapping { solid: false, size: DVec3::ONE, at: DVec3::ZERO, up: DVec3::Y }
    }
}

impl TextureMapping {
    /// The footprint in the coordinates of the pattern.
    fn mapped(&self, footprint: &TextureFootprint) -> TextureFootprint {
        let turn = self.turned();
        let lay = |uv: DVec2, own: DVec3| {
            let solid = if self.solid { turn * own } else { turn * uv.extend(0.0) };
            solid / self.size
        };
        let begin = if self.solid { footprint.own - self.at } else { footprint.own };
        let uv = if self.solid { footprint.uv } else { footprint.uv - self.at.truncate() };
        let own = lay(uv, begin);
        let side = |side: FootprintSide| {
            let own = lay(side.uv, side.own);
            FootprintSide { scene: side.scene, uv: own.truncate(), own }
        };
        TextureFootprint { uv: own.truncate(), own, sides: footprint.sides.map(side), ..*footprint }
    }

    /// From the coordinates of the object to those of the pattern; on a surface it turns about the normal.
    fn turned(&self) -> DMat3 {
        if self.up == DVec3::Y {
            return DMat3::IDENTITY;
        }
        if !self.solid {
            let up = self.up.truncate().normalize_or(DVec2::Y);
            return DMat3::from_cols(DVec3::new(up.y, up.x, 0.0), DVec3::new(-up.x, up.y, 0.0), DVec3::Z);
        }
        let up = self.up.normalize_or(DVec3::Y);
        let (a, b) = up.any_orthonormal_pair();
        DMat3::from_cols(a, up, b).transpose()
    }

    fn check(&self) -> Result<(), TextureError> {
        for value in self.size.to_array() {
            positive("size", value)?;
        }
        if let Some(value) = self.at.to_array().into_iter().find(|value| !value.is_finite()) {
            return Err(TextureError::Number { what: "place", value, range: "a finite number" });
        }
        let up = if self.solid { self.up } else { self.up.truncate().extend(0.0) };
        match up.try_normalize() {
            Some(_) => Ok(()),
            None => Err(TextureError::Number { what: "direction", value: up.length(), range: "of a length above 0" }),
        }
    }
}

impl Paint {
    /// One fraction of light of all wavelengths, everywhere.
    pub fn grey(value: f64) -> Paint {
        Paint::Plain(Color::grey(value))
    }

    /// All colors in it.
    pub fn colors(&self) -> Vec<&Color> {
        match self {
            Paint::Plain(color) => vec![color],
            Paint::Pattern(pattern) => pattern.paints.iter().flat_map(Paint::colors).collect(),
        }
    }

    /// Whether it is 0 at all wavelengths, everywhere. An image is taken to have something.
    pub fn is_black(&self) -> bool {
        match self {
            Paint::Plain(color) => color.is_black(),
            Paint::Pattern(pattern) => !pattern.is_image() && pattern.paints.iter().all(Paint::is_black),
        }
    }

    /// Whether it changes from place to place.
    pub fn is_pattern(&self) -> bool {
        matches!(self, Paint::Pattern(_))
    }

    /// Whether some color of it is given over the wavelength.
    pub fn is_spectral(&self) -> bool {
        self.colors().into_iter().any(Color::is_spectral)
    }

    /// Whether parameters of the surface are needed to tell it.
    pub fn needs_parameters(&self) -> bool {
        match self {
            Paint::Plain(_) => false,
            Paint::Pattern(pattern) => !pattern.laying.solid || pattern.paints.iter().any(Paint::needs_parameters),
        }
    }

    /// Linear sRGB of its mean, as a reflectance under D65.
    pub fn mean_bands(&self) -> DVec3 {
        self.mean_bands_of(None)
    }

    /// Linear sRGB of its mean over one instance, or over all, as a reflectance under D65.
    ///
    /// - `variation`: by which instances of one kind differ.
    pub fn mean_bands_of(&self, variation: Option<u16>) -> DVec3 {
        match self {
            Paint::Plain(color) => color.bands_of_reflectance(),
            Paint::Pattern(pattern) => match pattern.motif.image() {
                Some(image) => image.mean(),
                None => {
                    let parts = match (&pattern.motif, variation) {
                        (Motif::Varied { .. }, Some(variation)) => {
                            pattern.parts(&TextureFootprint { variation, ..TextureFootprint::default() })
                        }
                        _ => pattern.motif.mean(),
                    };
                    pattern.paints.iter().zip(parts).map(|(paint, part)| paint.mean_bands_of(variation) * part).sum()
                }
            },
        }
    }

    /// Checks everything in it but the colors.
    ///
    /// # Errors
    /// [`TextureError`].
    pub fn check(&self) -> Result<(), TextureError> {
        self.check_within(0)
    }

    fn check_within(&self, depth: u32) -> Result<(), TextureError> {
        match self {
            Paint::Plain(_) => Ok(()),
            Paint::Pattern(_) if depth >= MAX_NESTING => Err(TextureError::Nesting),
            Paint::Pattern(pattern) => {
                pattern.check()?;
                pattern.paints.iter().try_for_each(|paint| paint.check_within(depth + 1))
            }
        }
    }
}

impl Pattern {
    /// How much there is of each paint, in the mean over a footprint: fractions; of the bands of an image, three.
    pub fn parts(&self, footprint: &TextureFootprint) -> [f64; MOST_PAINTS] {
        self.motif.parts(&self.laying.mapped(footprint), self.laying.solid)
    }

    /// Whether it has its own colors.
    pub fn is_image(&self) -> bool {
        self.motif.image().is_some()
    }

    /// The height at a footprint, 0..=1.
    fn height(&self, footprint: &TextureFootprint) -> f64 {
        let [a, b, c] = self.parts(footprint);
        if self.is_image() { (a + b + c) / 3.0 } else { b }
    }

    fn check(&self) -> Result<(), TextureError> {
        let needed = if self.is_image() { 0 } else { 2 };
        if self.paints.len() != needed {
            return Err(TextureError::Paints { kind: self.motif.word(), count: self.paints.len(), needed });
        }
        self.laying.check()?;
        self.motif.check()
    }
}

impl Relief {
    /// Whether parameters of the surface are needed to tell it.
    pub fn needs_parameters(&self) -> bool {
        match self {
            Relief::Bumps { pattern, .. } => !pattern.laying.solid,
            Relief::Normals { .. } => true,
        }
    }

    /// Checks everything in it.
    ///
    /// # Errors
    /// [`TextureError`].
    pub fn check(&self) -> Result<(), TextureError> {
        match self {
            Relief::Bumps { pattern, height } => {
                if !height.is_finite() {
                    return Err(TextureError::Number { what: "height", value: *height, range: "a finite number" });
                }
                pattern.check()
            }
            Relief::Normals { laying, .. } => laying.check(),
        }
    }

    /// The normal that the relief gives a surface at a footprint.
    ///
    /// - `normal`: of the surface, unit length, outwards.
    ///
    /// # Source
    /// Blinn 1978, simulation of wrinkled surfaces: N − h_s s − h_t t for heights along two tangents at right angles.
    pub fn normal(&self, footprint: &TextureFootprint, normal: DVec3) -> DVec3 {
        let tilted = match self {
            Relief::Bumps { pattern, height } => {
                let slope = |side: &FootprintSide| {
                    let length = side.scene.length();
                    let laid = pattern.laying.mapped(&TextureFootprint { sides: [*side; 2], ..*footprint }).sides[0];
                    let extent = if pattern.laying.solid { laid.own.length() } else { laid.uv.length() };
                    if length == 0.0 || extent == 0.0 {
                        return DVec3::ZERO;
                    }
                    let step = (LEAST_STEP / extent).max(1.0);
                    let [before, behind] =
                        [-0.5, 0.5].map(|part| pattern.height(&footprint.moved(&side.scaled(part * step))));
                    side.scene * ((behind - before) * height / (step * length * length))
                };
                normal - slope(&footprint.sides[0]) - slope(&footprint.sides[1])
            }
            Relief::Normals { image, laying } => {
                let [x, y, z] = (image.at(&laying.mapped(footprint)) * 2.0 - 1.0).to_array();
                let upright = |along: DVec3| (along - normal * along.dot(normal)).normalize_or_zero();
                upright(footprint.along[0]) * x + upright(footprint.along[1]) * y + normal * z.max(0.0)
            }
        };
        tilted.try_normalize().unwrap_or(normal)
    }
}

/// A number of a pattern that must be above 0.
fn positive(what: &'static str, value: f64) -> Result<(), TextureError> {
    let possible = value.is_finite() && value > 0.0;
    if possible { Ok(()) } else { Err(TextureError::Number { what, value, range: "above 0 and finite" }) }
}
