//! Paints and numbers prepared for rendering: paints are tabulated at the wavelengths that rays carry.

use super::context::ShadingContext;
use crate::color::{Channels, SpectralTable, WavelengthSets};
use crate::illumination::texture::{NumberTexture, Paint, Pattern, TextureFootprint};

/// A fraction of light, prepared.
#[derive(Clone, Debug)]
pub(super) enum PreparedPaint {
    /// One curve, everywhere.
    Plain(SpectralTable),
    /// The texture value of a number, at the footprint.
    Textured(usize),
}

/// A number, prepared.
#[derive(Clone, Copy, Debug)]
pub(super) enum PreparedNumber {
    /// One, everywhere.
    Constant(f64),
    /// The texture value of a number, at the footprint.
    Varying(usize),
}

/// A texture, prepared: of a fraction of light, or of a number.
#[derive(Clone, Debug)]
pub(super) enum PreparedTexture {
    Paint(PreparedPattern),
    Number(NumberTexture),
}

/// A pattern, prepared.
#[derive(Clone, Debug)]
pub(super) struct PreparedPattern {
    pattern: Pattern,
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
enum Part {
    Plain(SpectralTable),
    Painted(PreparedPattern),
}

impl PreparedPattern {
    /// A pattern at some wavelengths.
    pub(super) fn new(pattern: &Pattern, wavelengths: &WavelengthSets) -> PreparedPattern {
        let part = |paint: &Paint| match paint {
            Paint::Plain(color) => Part::Plain(wavelengths.reflectance(color)),
            Paint::Pattern(pattern) => Part::Painted(PreparedPattern::new(pattern, wavelengths)),
        };
        let parts = if pattern.is_image() {
            wavelengths.primaries().map(Part::Plain).into()
        } else {
            pattern.paints.iter().map(part).collect()
        };
        // The paints are in the parts.
        PreparedPattern { pattern: Pattern { paints: Vec::new(), ..pattern.clone() }, parts }
    }

    /// The mean over a footprint.
    pub(super) fn at(&self, footprint: &TextureFootprint, wavelength_set: usize) -> Channels {
        let mut sum = Channels::ZERO;
        self.each(footprint, 1.0, &mut |curve, amount| sum += curve.of(wavelength_set) * amount);
        sum
    }

    /// Gives the curves of which it is mixed in the mean over a footprint, and how much of each.
    pub(super) fn each<'a>(
        &'a self,
        footprint: &TextureFootprint,
        amount: f64,
        give: &mut dyn FnMut(&'a SpectralTable, f64),
    ) {
        let amounts = self.pattern.parts(footprint).map(|part| part * amount);
        for (part, amount) in self.parts.iter().zip(amounts).filter(|(_, amount)| *amount != 0.0) {
            match part {
                Part::Plain(curve) => give(curve, amount),
                Part::Painted(pattern) => pattern.each(footprint, amount, give),
            }
        }
    }
}

impl PreparedTexture {
    /// The mean over a footprint; a number is in all lanes.
    pub(super) fn at(&self, footprint: &TextureFootprint, wavelength_set: usize) -> Channels {
        match self {
            PreparedTexture::Paint(pattern) => pattern.at(footprint, wavelength_set),
            PreparedTexture::Number(number) => Channels::splat(number.at(footprint)),
        }
    }
}

impl PreparedNumber {
    /// The number at the footprint of a shading context.
    #[inline]
    pub(super) fn of(self, context: &ShadingContext<'_>) -> f64 {
        match self {
            PreparedNumber::Constant(value) => value,
            PreparedNumber::Varying(number) => context.texture_values.get(number).map_or(0.0, |channels| channels.0[0]),
        }
    }
}

impl PreparedPaint {
    /// Whether it is 0 everywhere.
    pub(super) fn is_black(&self) -> bool {
        matches!(self, PreparedPaint::Plain(curve) if curve.max() <= 0.0)
    }

    /// The fraction at the footprint and the wavelengths of a shading context.
    #[inline]
    pub(super) fn of(&self, context: &ShadingContext<'_>) -> Channels {
        match self {
            PreparedPaint::Plain(curve) => curve.of(context.wavelength_set),
            PreparedPaint::Textured(number) => context.texture_values.get(*number).copied().unwrap_or_default(),
        }
    }
}
