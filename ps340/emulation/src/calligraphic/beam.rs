//! The settings of the writing beam and of the picture that it writes.

use super::DOT_LENGTH;

/// The writing beam and the picture that it writes.
///
/// Lengths are in screen units: the screen is the square -1..=1, as large as fits in the middle of the picture. Light
/// beside the square is drawn as far as the picture goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Width of the picture in pixels, 1..=[`MAX_SIZE`](super::MAX_SIZE).
    pub width: u32,
    /// Height of the picture in pixels, 1..=[`MAX_SIZE`](super::MAX_SIZE).
    pub height: u32,
    /// Standard deviation of the spot in focus, in screen units; kept between [`SPOT_FLOOR`](super::SPOT_FLOOR) pixels
    /// and [`SPOT_CEILING`](super::SPOT_CEILING).
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
}
