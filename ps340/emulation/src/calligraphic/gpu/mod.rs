//! The beam on a graphics processor: the light of a refresh, by the closed forms that the processor uses.
//!
//! # Model
//! Each stroke is an instance of a rectangle: as much of it as the picture can see, and 4.5 standard deviations more on
//! all sides. The fragment shader (`beam.wgsl`) evaluates the formulas of `spot` and `track`; blending adds. What needs
//! double precision is done before by the same code as for the processor's tiles: a stroke's distances are computed at
//! an anchor in the picture (`instance`), so that 32 bits suffice, however long the stroke is.
//!
//! # Why the light is read back
//! Only the light is made here. It is read back into [`super::ScreenLight`], and phosphor, glow and exposure go on from
//! there on their one path. That costs 16 MB over the bus for each changed picture of 1024 by 1024 (4 MB with a single
//! gun): a copy of some milliseconds, while making all of it here would double the code that decides what a picture
//! looks like.
//!
//! # Which adapters
//! Light adds up in 32 bits. An adapter that cannot blend such pixels is refused: in 16 bits, weak strokes upon strong
//! ones would be lost, and light beyond 65504 too.
//!
//! # Failure
//! Nothing here panics or waits for ever. When a device is lost, has no memory left or does not answer in time
//! (`device`), that is logged once, and the processor draws from then on, beginning with the same picture.

mod instance;
mod pipeline;
mod device;
mod canvas;
mod beam;

pub use beam::Gpu;
pub use device::GpuError;

#[cfg(test)]
mod tests;
