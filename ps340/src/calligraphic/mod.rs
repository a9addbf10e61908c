//! The vector screen: strokes to light per pixel, by a Gaussian beam at constant writing speed.
//!
//! # Model
//! The spot is a circular Gaussian. The beam moves along a stroke at constant speed, while its current runs
//! linearly from the intensity of the start to that of the end. What a point at distance v from the stroke
//! and u along it receives has a closed form: the Gaussian of v, times error functions and Gaussians of u
//! and u - length (`spot`). Light adds: nothing depends on what is already there, so that a vector drawn
//! twice gives exactly twice the light and a stroke cut in pieces gives the same light.
//!
//! A stroke of no length is a dot, during which the beam dwells as long as it takes to write
//! [`Beam::dot_length`]. The formula of the stroke, divided by its length, has the dot as its limit.
//!
//! The processor adds the light up in tiles, or a graphics processor in a texture (`gpu`); [`Drawer`] says who.
//!
//! From there on: the phosphor gives the light colour and duration (`phosphor`), the length of the list decides how
//! often it is drawn (`refresh`), and the exposure makes pixels of it (`exposure`); [`Display`] holds all this over time,
//! and [`Screen`] is the one display that window and files show.
//!
//! # Energy
//! A stroke deposits length times mean intensity times colour, whatever its angle, place and the size of
//! the picture ([`Light::total`]), and whatever the focus. Pixels take the light at their centres. By Poisson's
//! summation formula the error of such a sum is at most 4 exp(-2 pi^2 s^2) for a spot of standard deviation s in
//! pixels, and so the spot never gets smaller than [`SPOT_FLOOR`] = 0.75 pixels: 6e-5. In a picture too small
//! for the spot, lines thus stay evenly wide and bright instead of breaking up. The Gaussian ends at 4.5 standard
//! deviations, and what lies beyond (7e-6) is spread over the rest.
//!
//! # Cost
//! Strokes are sorted into tiles of 64 by 32 pixels. A tile without light costs nothing, in memory either, and a picture
//! that stands still costs nothing at all. A graphics processor adds the cost of its way back: 16 bytes a pixel, lit or not.
//!
//! # Not modelled
//! The growth of the spot with the current and towards the corners, the pattern of the shadow mask, halation in the
//! glass, moiré, the way of the dark beam, the moment within a frame at which a stroke is drawn. A vector seen exactly
//! end on is a dot, as is any stroke of no length; one almost end on has almost no light. See also `phosphor` and
//! `refresh`.

mod bins;
mod controls;
mod display;
mod drawer;
mod exposure;
#[cfg(feature = "window")]
mod gpu;
mod light;
mod optics;
mod phosphor;
mod print;
mod refresh;
mod screen;
mod spot;
mod track;

pub use controls::{Controls, KNOBS, Knob, SCREENS};
pub use display::Display;
#[cfg(feature = "window")]
pub use drawer::Choice;
pub use drawer::Drawer;
pub use exposure::Exposure;
#[cfg(feature = "window")]
pub use gpu::{Gpu, GpuError};
pub use light::Light;
pub use phosphor::{Component, PHOSPHORS, Phosphor, phosphor};
pub use print::{svg, text};
pub use refresh::{POSITIONING_SPEED, Refresh, SETTLING_TIME, STARTING_TIME, WRITING_SPEED};
pub use screen::{DISPLAY_SIZE, Scene, Screen, Seen};

use crate::traversal::Stroke;
use bins::Bins;
use optics::Optics;

/// Smallest standard deviation of the spot, in pixels.
pub const SPOT_FLOOR: f64 = 0.75;
/// Largest standard deviation of the spot, in screen units.
pub const SPOT_CEILING: f64 = 0.02;
/// Largest width and height of a picture, in pixels.
pub const MAX_SIZE: u32 = 8192;
/// Farthest coordinate of a stroke that is drawn, in screen units.
pub const FAR: f32 = 1e10;
/// Strongest intensity and colour that is told from stronger.
pub const STRONGEST: f32 = 1e6;
/// Length of the stroke that takes as long to write as a dot, in screen units. Ours.
pub const DOT_LENGTH: f32 = 0.006;
/// Length of a frame: the beam draws the picture once in it, if it can.
const FRAME_SECONDS: f64 = 1.0 / 60.0;

/// The writing beam and the picture that it writes.
///
/// Lengths are in screen units: the screen is the square -1..=1, as large as fits in the middle of the picture. Light
/// beside the square is drawn as far as the picture goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Width of the picture in pixels, 1..=[`MAX_SIZE`].
    pub width: u32,
    /// Height of the picture in pixels, 1..=[`MAX_SIZE`].
    pub height: u32,
    /// Standard deviation of the spot in focus, in screen units; kept between [`SPOT_FLOOR`] pixels and
    /// [`SPOT_CEILING`].
    pub spot_radius: f32,
    /// How many times wider the spot is out of focus, at least 1; its light stays the same in all.
    pub blur: f32,
    /// How far intensities lie apart: the current for the intensity i is 1 + contrast (i - 1), and not below 0.
    pub contrast: f32,
    /// Length of the stroke that takes as long to write as a dot, in screen units; 0 or less: dots are dark.
    pub dot_length: f32,
}

impl Beam {
    /// A beam in focus for a picture of so many pixels.
    ///
    /// At 1024 pixels the spot has 0.77 pixels, about half a millimetre at half height on a screen of 30 cm. The centre
    /// of a dot is 1.6 times as bright as that of a line. Values are ours.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, spot_radius: 0.0015, blur: 1.0, contrast: 1.0, dot_length: DOT_LENGTH }
    }

    /// Its settings within their limits.
    fn optics(&self) -> Optics {
        Optics::new(self)
    }

    /// A picture without light.
    fn dark(&self, guns: usize) -> Light {
        Light::dark(self.optics(), guns)
    }
}

/// Draws `strokes` in their order with three guns and returns the light of every pixel.
///
/// A stroke with a number that is not finite, or farther than [`FAR`] from the screen, is left out.
/// Strokes that leave the picture are cut at its edge together with their glow. Negative intensities
/// and colours count as 0, those above [`STRONGEST`] as that.
///
/// The light is the same for any number of threads.
pub fn draw(beam: &Beam, strokes: &[Stroke]) -> Light {
    let mut light = beam.dark(3);
    light.write(&mut Bins::default(), strokes);
    light
}

#[cfg(test)]
mod display_tests;
#[cfg(test)]
mod tests;
