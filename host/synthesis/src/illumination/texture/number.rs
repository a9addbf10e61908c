//! Numbers of a surface that may change from place to place: roughness, metalness, weights.

use super::{Paint, Pattern, TextureError, TextureFootprint};
use crate::color::Color;
use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number of a surface: the same everywhere, or as a pattern has it.
#[derive(Clone, Debug, PartialEq)]
pub enum NumberTexture {
    /// One everywhere.
    Constant(f64),
    /// A number that a pattern tells at each place.
    Varying(Box<Varying>),
}

/// A number that a pattern tells: `from` where the pattern is black, `to` where it is white, and linear in between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Varying {
    /// The pattern.
    pub pattern: Pattern,
    /// The band of it that counts.
    pub band: Band,
    /// The number where the pattern is black.
    pub from: f64,
    /// The number where the pattern is white.
    pub to: f64,
}

/// The band of a pattern that tells a number.
///
/// Maps of glTF hold roughness in their green band and metalness in the blue one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// The mean of all three.
    #[default]
    Mean,
    /// The red one.
    Red,
    /// The green one.
    Green,
    /// The blue one.
    Blue,
}

impl Band {
    /// Every band, with its word.
    pub const ALL: [(&'static str, Band); 4] =
        [("mean", Band::Mean), ("red", Band::Red), ("green", Band::Green), ("blue", Band::Blue)];

    fn of(self, bands: DVec3) -> f64 {
        match self {
            Band::Mean => bands.element_sum() / 3.0,
            Band::Red => bands.x,
            Band::Green => bands.y,
            Band::Blue => bands.z,
        }
    }
}

impl From<f64> for NumberTexture {
    fn from(value: f64) -> NumberTexture {
        NumberTexture::Constant(value)
    }
}

impl NumberTexture {
    /// The mean of the number over a footprint.
    pub fn at(&self, footprint: &TextureFootprint) -> f64 {
        match self {
            NumberTexture::Constant(value) => *value,
            NumberTexture::Varying(varying) => varying.between(varying.band.of(bands(&varying.pattern, footprint))),
        }
    }

    /// The mean over all footprints.
    pub fn mean(&self) -> f64 {
        match self {
            NumberTexture::Constant(value) => *value,
            NumberTexture::Varying(varying) => {
                let bands = Paint::Pattern(Box::new(varying.pattern.clone())).mean_bands();
                varying.between(varying.band.of(bands))
            }
        }
    }

    /// The least and the greatest value that it may have somewhere.
    pub fn range(&self) -> [f64; 2] {
        match self {
            NumberTexture::Constant(value) => [*value; 2],
            NumberTexture::Varying(varying) => {
                let [a, b] = range(&varying.pattern, varying.band).map(|part| varying.between(part));
                [a.min(b), a.max(b)]
            }
        }
    }

    /// Whether it changes from place to place.
    pub fn is_varying(&self) -> bool {
        matches!(self, NumberTexture::Varying(_))
    }

    /// Whether parameters of the surface are needed to tell it.
    pub fn needs_parameters(&self) -> bool {
        match self {
            NumberTexture::Constant(_) => false,
            NumberTexture::Varying(varying) => Paint::Pattern(Box::new(varying.pattern.clone())).needs_parameters(),
        }
    }

    /// Checks the pattern, if there is one; not the range.
    ///
    /// # Errors
    /// [`TextureError`].
    pub fn check(&self) -> Result<(), TextureError> {
        let NumberTexture::Varying(varying) = self else { return Ok(()) };
        for value in [varying.from, varying.to] {
            if !value.is_finite() {
                return Err(TextureError::Number { what: "end", value, range: "a finite number" });
            }
        }
        let paint = Paint::Pattern(Box::new(varying.pattern.clone()));
        match paint.colors().into_iter().all(|color| matches!(color, Color::Bands(_))) {
            true => paint.check(),
            false => Err(TextureError::Spectrum),
        }
    }
}

impl Varying {
    fn between(&self, part: f64) -> f64 {
        self.from + (self.to - self.from) * part
    }
}

/// The mean bands of a pattern over a footprint.
fn bands(pattern: &Pattern, footprint: &TextureFootprint) -> DVec3 {
    let parts = pattern.parts(footprint);
    if pattern.is_image() {
        return DVec3::from_array(parts);
    }
    let of = |paint: &Paint| match paint {
        Paint::Plain(color) => color_bands(color),
        Paint::Pattern(pattern) => bands(pattern, footprint),
    };
    pattern.paints.iter().zip(parts).map(|(paint, part)| of(paint) * part).sum()
}

/// The least and the greatest value that a band of a pattern may have.
fn range(pattern: &Pattern, band: Band) -> [f64; 2] {
    let of = |paint: &Paint| match paint {
        Paint::Plain(color) => [band.of(color_bands(color)); 2],
        Paint::Pattern(pattern) => range(pattern, band),
    };
    match pattern.motif.image() {
        Some(image) => image.range().map(|bands| band.of(bands)),
        None => pattern.paints.iter().map(of).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or([0.0, 1.0]),
    }
}

fn color_bands(color: &Color) -> DVec3 {
    match color {
        Color::Bands(bands) => *bands,
        Color::Spectrum(_) => DVec3::ZERO,
    }
}

/// The form of a number where what is read does not tell its own kind.
#[derive(Serialize, Deserialize)]
enum Tagged {
    Constant(f64),
    Varying(Box<Varying>),
}

/// The form of a number in text: a number, or an object.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Plain {
    Constant(f64),
    Varying(Box<Varying>),
}

impl Serialize for NumberTexture {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let number = self.clone();
        match (serializer.is_human_readable(), number) {
            (true, NumberTexture::Constant(value)) => Plain::Constant(value).serialize(serializer),
            (true, NumberTexture::Varying(varying)) => Plain::Varying(varying).serialize(serializer),
            (false, NumberTexture::Constant(value)) => Tagged::Constant(value).serialize(serializer),
            (false, NumberTexture::Varying(varying)) => Tagged::Varying(varying).serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for NumberTexture {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<NumberTexture, D::Error> {
        if deserializer.is_human_readable() {
            Plain::deserialize(deserializer).map(|plain| match plain {
                Plain::Constant(value) => NumberTexture::Constant(value),
                Plain::Varying(varying) => NumberTexture::Varying(varying),
            })
        } else {
            Tagged::deserialize(deserializer).map(|tagged| match tagged {
                Tagged::Constant(value) => NumberTexture::Constant(value),
                Tagged::Varying(varying) => NumberTexture::Varying(varying),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Motif, TextureMapping};
    use super::*;
    use crate::encoding::{Integers, decode, encode};
    use glam::{DVec2, DVec3};

    fn checks(from: f64, to: f64) -> NumberTexture {
        let paints = vec![Paint::grey(0.25), Paint::grey(0.75)];
        let pattern = Pattern { motif: Motif::Checker, laying: TextureMapping::default(), paints };
        NumberTexture::Varying(Box::new(Varying { pattern, band: Band::Mean, from, to }))
    }

    #[test]
    fn a_number_is_between_its_ends_as_bright_as_its_pattern() {
        let number = checks(0.0, 2.0);
        let at = |x: f64| number.at(&TextureFootprint::point(DVec2::new(x, 0.2), DVec3::ZERO));
        let mut both = [at(0.2), at(0.7)];
        both.sort_by(f64::total_cmp);
        assert_eq!(both, [0.5, 1.5]);
        assert_eq!((number.range(), number.mean()), ([0.5, 1.5], 1.0));
        assert_eq!(checks(4.0, 0.0).range(), [1.0, 3.0]);
        assert!(number.is_varying() && number.needs_parameters() && number.check().is_ok());
        assert!(checks(f64::NAN, 1.0).check().is_err());
    }

    #[test]
    fn a_number_that_is_written_is_read_again_as_text_and_as_bytes() {
        for number in [NumberTexture::Constant(0.3), checks(0.1, 0.4)] {
            let text = serde_json::to_string(&number).expect("plain data");
            assert_eq!(serde_json::from_str::<NumberTexture>(&text).expect("the same"), number);
            let bytes = encode(&number, Integers::Compact).expect("plain data");
            let read = decode::<NumberTexture, 1_000_000>(&bytes, Integers::Compact).expect("the number").0;
            assert_eq!(read, number);
        }
        assert_eq!(serde_json::to_string(&NumberTexture::Constant(0.5)).expect("plain data"), "0.5");
    }
}
