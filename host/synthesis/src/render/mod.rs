//! Renderers: from a prepared scene and a view to a picture.

mod error;
mod tally;
mod features;
mod film;
mod order;
mod content_hash;
mod state;
mod memo;
mod watch;
pub mod indirect;
mod layers;
mod denoising;
mod world;
pub mod radiosity;
pub mod two_way;
mod rendering;
mod renderer;
pub mod metering;
pub mod ray_tracing;
pub mod scan_line;
pub mod tiles;
mod renderers;

#[cfg(test)]
mod extreme_tests;
#[cfg(test)]
mod instance_tests;
#[cfg(test)]
mod instance_extreme_tests;
#[cfg(test)]
mod aggregate_tests;
#[cfg(test)]
mod detail_tests;
#[cfg(test)]
mod terrain_tests;
#[cfg(test)]
mod plant_tests;
#[cfg(test)]
mod lamp_tests;

pub use content_hash::ContentHash;
pub use error::{RadiosityError, RenderError};
pub use film::Film;
pub use memo::Memo;
pub use order::RenderOrder;
pub use renderer::Renderer;
pub use renderers::{
    AnyRenderer, PreparedRenderer, RENDERERS, RendererRow, Task, Technique, ray_tracer, ray_tracer_watched,
};
pub use rendering::{FinishedCounts, RayCounts, Rendering, SpanCounts};
pub use state::{Fingerprint, RenderState, StateError};
pub use tally::{PathClass, PixelSample, RadianceByClass, Tally};
pub use watch::Watch;
pub use world::World;
