//! What the beam can do: bounds of the spot, of positions, intensities and pictures, and lengths of time.

/// Smallest standard deviation of the spot, in pixels.
pub const SPOT_FLOOR: f64 = 0.75;
/// Largest standard deviation of the spot, in screen units.
pub const SPOT_CEILING: f64 = 0.02;
/// Largest width and height of a picture, in pixels.
pub const MAX_SIZE: u32 = 8192;
/// Farthest coordinate of a stroke that is drawn, in screen units.
pub const FAR: f32 = 1e10;
/// Strongest intensity and colour that is distinguished from stronger.
pub const STRONGEST: f32 = 1e6;
/// Length of the stroke that takes as long to write as a dot, in screen units. Ours.
pub const DOT_LENGTH: f32 = 0.006;
/// Length of a frame: the beam draws the picture once in it, if it can.
pub(super) const FRAME_SECONDS: f64 = 1.0 / 60.0;
