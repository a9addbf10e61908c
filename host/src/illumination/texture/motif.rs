//! The kinds of pattern.

use super::noise::octaves;
use super::{Image, MOST_PAINTS, TextureError, TextureFootprint, positive};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Most octaves of noise.
const MOST_OCTAVES: u32 = 16;
/// The place in a ring of wood where the late wood ends and the next year begins.
const YEAR: f64 = 0.85;

/// The kind of a pattern, of which one repetition has the size 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motif {
    /// An image, once for each unit of u and v.
    Image {
        /// The image.
        image: Image,
    },
    /// Squares or cubes of two paints in turn, two of which are as long as a unit.
    Checker,
    /// Clouds of a second paint in the first.
    Noise {
        /// How many frequencies it has, each twice the one before, 1 to 16.
        octaves: u32,
    },
    /// Veins of a second paint in the first, across the x direction, a unit apart.
    Marble {
        /// How far the veins stray, in units, 0 and more.
        turbulence: f64,
        /// How narrow they are: 1 is a wave, more is narrower; up to 1000.
        sharpness: f64,
    },
    /// Rings about the y axis, a unit wide: the first paint is early wood, the second late wood.
    Wood {
        /// How far the rings stray, in units, 0 and more.
        turbulence: f64,
        /// How much of the second paint is in fibres, 0..=1.
        grain: f64,
    },
}

impl Motif {
    /// The word for the kind.
    pub fn word(&self) -> &'static str {
        match self {
            Motif::Image { .. } => "image",
            Motif::Checker => "checker",
            Motif::Noise { .. } => "noise",
            Motif::Marble { .. } => "marble",
            Motif::Wood { .. } => "wood",
        }
    }

    pub(super) fn check(&self) -> Result<(), TextureError> {
        let stray = |value: f64| {
            let possible = value.is_finite() && value >= 0.0;
            if possible { Ok(()) } else { Err(TextureError::Number { what: "turbulence", value, range: "0 or more" }) }
        };
        match *self {
            Motif::Image { .. } | Motif::Checker => Ok(()),
            Motif::Noise { octaves } if (1..=MOST_OCTAVES).contains(&octaves) => Ok(()),
            Motif::Noise { octaves } => {
                Err(TextureError::Number { what: "number of octaves", value: f64::from(octaves), range: "1 to 16" })
            }
            Motif::Marble { turbulence, sharpness } => {
                positive("sharpness", sharpness)?;
                if sharpness > 1000.0 {
                    return Err(TextureError::Number { what: "sharpness", value: sharpness, range: "at most 1000" });
                }
                stray(turbulence)
            }
            Motif::Wood { turbulence, grain } => {
                if !(0.0..=1.0).contains(&grain) {
                    return Err(TextureError::Number { what: "grain", value: grain, range: "0 to 1" });
                }
                stray(turbulence)
            }
        }
    }

    /// How much there is of each paint in the mean over a footprint, in the coordinates of the pattern.
    pub(super) fn parts(&self, footprint: &TextureFootprint, solid: bool) -> [f64; MOST_PAINTS] {
        let [a, b] = footprint.sides.map(|side| side.own);
        let width = a.length().max(b.length());
        let at = footprint.own;
        if !at.is_finite() || !width.is_finite() {
            return self.mean();
        }
        let second = match *self {
            Motif::Image { ref image } => return image.at(footprint).to_array(),
            Motif::Checker => {
                let extent = a.abs() + b.abs();
                let axes = if solid { 3 } else { 2 };
                0.5 - 0.5 * (0..axes).map(|axis| square_wave(at[axis], extent[axis])).product::<f64>()
            }
            Motif::Noise { octaves: count } => (0.5 + 0.5 * octaves(at, count, width)).clamp(0.0, 1.0),
            Motif::Marble { turbulence, sharpness } => {
                let x = at.x + turbulence * octaves(at, 6, width);
                let wave = (0.5 + 0.5 * (TAU * x).sin()).powf(sharpness);
                let mean = mean_of_power(sharpness);
                // Narrow veins have higher frequencies.
                mean + (wave - mean) * sinc(width * sharpness.sqrt())
            }
            Motif::Wood { turbulence, grain } => {
                let stray = DVec3::new(1.0, 0.15, 1.0);
                let radius =
                    DVec3::new(at.x, 0.0, at.z).length() + turbulence * octaves(at * 0.4 * stray, 3, 0.4 * width);
                let part = radius - radius.floor();
                let ring = if part < YEAR { (part / YEAR).powi(3) } else { (1.0 - part) / (1.0 - YEAR) };
                let mean = mean_of_ring();
                let ring = mean + (ring - mean) * sinc(width * 2.0);
                let fibre = octaves(at * DVec3::new(24.0, 0.8, 24.0), 2, width * 24.0);
                (ring * (1.0 - grain) + grain * (mean + fibre)).clamp(0.0, 1.0)
            }
        };
        [1.0 - second, second, 0.0]
    }

    /// How much there is of each paint in all.
    pub(super) fn mean(&self) -> [f64; MOST_PAINTS] {
        let second = match self {
            Motif::Image { image } => return image.mean().to_array(),
            Motif::Checker | Motif::Noise { .. } => 0.5,
            Motif::Marble { sharpness, .. } => mean_of_power(*sharpness),
            Motif::Wood { .. } => mean_of_ring(),
        };
        [1.0 - second, second, 0.0]
    }
}

/// The mean over a width of a wave that is 1 from 0 to 1/2 and −1 from 1/2 to 1.
fn square_wave(at: f64, width: f64) -> f64 {
    let part = |x: f64| x - x.floor();
    if width < 1e-12 {
        return if part(at) < 0.5 { 1.0 } else { -1.0 };
    }
    // Its integral is a triangle wave; whole periods have none.
    let integral = |x: f64| {
        let part = part(x);
        if part < 0.5 { part } else { 1.0 - part }
    };
    let mean = (integral(at + 0.5 * width) - integral(at - 0.5 * width)) / width;
    if mean.is_finite() { mean.clamp(-1.0, 1.0) } else { 0.0 }
}

/// The mean of ((1 + sin x)/2)^s: Γ(s + 1/2) / (√π Γ(s + 1)).
fn mean_of_power(s: f64) -> f64 {
    (libm::lgamma(s + 0.5) - libm::lgamma(s + 1.0)).exp() / std::f64::consts::PI.sqrt()
}

/// The mean of a ring of wood.
fn mean_of_ring() -> f64 {
    YEAR / 4.0 + (1.0 - YEAR) / 2.0
}

/// Amplitude of a wave of period 1 in the mean over a width; 0 beyond one period.
fn sinc(width: f64) -> f64 {
    let x = std::f64::consts::PI * width;
    if width >= 1.0 {
        0.0
    } else if x < 1e-6 {
        1.0
    } else {
        x.sin() / x
    }
}
