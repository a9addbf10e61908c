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
//! The processor adds the light up in tiles, or a graphics processor in a texture (`gpu`); [`Drawer`] chooses which.
//!
//! From there on: the phosphor gives the light colour and duration (`phosphor`), the length of the list decides how
//! often it is drawn (`refresh`), and the exposure makes pixels of it (`exposure`); [`Display`] holds all this over
//! time, and [`SharedDisplay`] is the one display that window and files show.
//!
//! # Energy
//! A stroke deposits length times mean intensity times colour, whatever its angle, position and the size of
//! the picture ([`ScreenLight::total`]), and whatever the focus. Pixels take the light at their centres. By Poisson's
//! summation formula the error of such a sum is at most 4 exp(-2 pi^2 s^2) for a spot of standard deviation s in
//! pixels, and so the spot never gets smaller than [`SPOT_FLOOR`] = 0.75 pixels: 6e-5. In a picture too small
//! for the spot, lines thus stay evenly wide and bright instead of breaking up. The Gaussian ends at 4.5 standard
//! deviations, and what lies beyond (7e-6) is spread over the rest.
//!
//! # Cost
//! Strokes are sorted into tiles of 64 by 32 pixels. A tile without light costs nothing, in memory either, and a
//! picture that stands still costs nothing at all. A graphics processor adds the cost of its way back: 16 bytes a
//! pixel, lit or not.
//!
//! # Not modelled
//! The growth of the spot with the current and towards the corners, the pattern of the shadow mask, halation in the
//! glass, moiré, the way of the dark beam, the moment within a frame at which a stroke is drawn. A vector seen exactly
//! end on is a dot, as is any stroke of no length; one almost end on has almost no light. See also `phosphor` and
//! `refresh`.

mod limits;
mod beam;
mod spot;
mod optics;
mod tile;
mod track;
mod bins;
mod light;
#[cfg(feature = "window")]
mod gpu;
mod draw;
mod drawer;
mod phosphor;
mod exposure;
mod controls;
mod refresh;
mod display;
mod screen;
mod print;

pub use beam::Beam;
pub use controls::{Controls, KNOBS, Knob, SCREENS};
pub use display::Display;
pub use draw::draw;
#[cfg(feature = "window")]
pub use drawer::Choice;
pub use drawer::Drawer;
pub use exposure::Exposure;
#[cfg(feature = "window")]
pub use gpu::{Gpu, GpuError};
pub use light::ScreenLight;
pub use limits::{DOT_LENGTH, FAR, MAX_SIZE, SPOT_CEILING, SPOT_FLOOR, STRONGEST};
pub use phosphor::{Component, PHOSPHORS, Phosphor, phosphor};
pub use print::{svg, text};
pub use refresh::Refresh;
pub use screen::{DISPLAY_SIZE, DisplayLook, Scene, SharedDisplay};

#[cfg(test)]
mod display_tests;
#[cfg(test)]
mod tests;
