//! Paints and numbers made ready for rendering: paints are tabulated at the wavelengths that rays carry.

use super::sighting::Sighting;
use crate::color::{Channels, Curve, Wavelengths};
use crate::illumination::texture::{Number, Paint, Pattern, Place};

/// A fraction of light, ready.
#[derive(Clone, Debug)]
pub(super) enum Shade {
    /// One curve, everywhere.
    Plain(Curve),
    /// What the pattern of a number gives at the place that is looked at.
    Painted(usize),
}

/// A number, ready.
#[derive(Clone, Copy, Debug)]
pub(super) enum Quantity {
    /// One, everywhere.
    Constant(f64),
    /// What the pattern of a number gives at the place that is looked at.
    Varying(usize),
}

/// What changes from place to place: a fraction of light, or a number.
#[derive(Clone, Debug)]
pub(super) enum Changing {
    Paint(Painted),
    Number(Number),
}

/// A pattern, ready.
#[derive(Clone, Debug)]
pub(super) struct Painted {
    pattern: Pattern,
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
enum Part {
    Plain(Curve),
    Painted(Painted),
}

impl Painted {
    /// A pattern at some wavelengths.
    pub(super) fn new(pattern: &Pattern, wavelengths: &Wavelengths) -> Painted {
        let part = |paint: &Paint| match paint {
            Paint::Plain(color) => Part::Plain(wavelengths.reflectance(color)),
            Paint::Pattern(pattern) => Part::Painted(Painted::new(pattern, wavelengths)),
        };
        let parts = if pattern.is_image() {
            wavelengths.primaries().map(Part::Plain).into()
        } else {
            pattern.paints.iter().map(part).collect()
        };
        // The paints are in the parts.
        Painted { pattern: Pattern { paints: Vec::new(), ..pattern.clone() }, parts }
    }

    /// The mean over a place.
    pub(super) fn at(&self, place: &Place, comb: usize) -> Channels {
        let mut sum = Channels::ZERO;
        self.each(place, 1.0, &mut |curve, amount| sum += curve.of(comb) * amount);
        sum
    }

    /// Gives what it is mixed of in the mean over a place, and how much of each.
    pub(super) fn each<'a>(&'a self, place: &Place, amount: f64, give: &mut dyn FnMut(&'a Curve, f64)) {
        let amounts = self.pattern.parts(place).map(|part| part * amount);
        for (part, amount) in self.parts.iter().zip(amounts).filter(|(_, amount)| *amount != 0.0) {
            match part {
                Part::Plain(curve) => give(curve, amount),
                Part::Painted(painted) => painted.each(place, amount, give),
            }
        }
    }
}

impl Changing {
    /// The mean over a place; a number is in all lanes.
    pub(super) fn at(&self, place: &Place, comb: usize) -> Channels {
        match self {
            Changing::Paint(painted) => painted.at(place, comb),
            Changing::Number(number) => Channels::splat(number.at(place)),
        }
    }
}

impl Quantity {
    /// The number at the place that is looked at.
    #[inline]
    pub(super) fn of(self, sighting: &Sighting<'_>) -> f64 {
        match self {
            Quantity::Constant(value) => value,
            Quantity::Varying(number) => sighting.painted.get(number).map_or(0.0, |channels| channels.0[0]),
        }
    }
}

impl Shade {
    /// Whether it is nothing, wherever.
    pub(super) fn is_black(&self) -> bool {
        matches!(self, Shade::Plain(curve) if curve.max() <= 0.0)
    }

    /// The fraction at the place and the wavelengths that are looked at.
    #[inline]
    pub(super) fn of(&self, sighting: &Sighting<'_>) -> Channels {
        match self {
            Shade::Plain(curve) => curve.of(sighting.comb),
            Shade::Painted(number) => sighting.painted.get(*number).copied().unwrap_or_default(),
        }
    }
}
