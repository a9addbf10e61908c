//! Error against run time: what a quality setting costs, and what it buys.
//!
//! A [`Knob`] is one quality setting that can be swept. [`KNOBS`] lists those that the program offers, but for the
//! [`RENDER_KNOBS`] of the renderers, which are studied together.

mod error;
mod options;
mod plot;
mod sweep;
mod illumination;
mod tessellation;
mod octree;
mod division;
mod composite;
mod residual;
mod intersection;
mod knobs;
mod rendering;

#[cfg(test)]
mod tests;

pub use error::StudyError;
pub use illumination::{IlluminationRow, IlluminationStudy, illumination};
pub use knobs::{KNOBS, KnobRow};
pub use options::Options;
pub use plot::{Axis, Plot, PlotError, PlotPoint, Series};
pub use rendering::{
    ErrorFloor, ErrorMeasures, KnobStudy, RENDER_KNOBS, RENDER_OPTIONS, RenderKnob, RenderRow, RenderStudy, renderers,
    studied, usual,
};
pub use sweep::{Knob, Study, StudyRow, Trial, sweep};
