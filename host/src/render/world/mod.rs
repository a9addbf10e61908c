//! The world: a prepared scene made ready for renderers, with its index for rays, lights, materials and eye. It knows no
//! renderer.

mod appearance;
mod element;
mod eye;
mod found;
mod light_buffer;
mod geometry;
mod media;
mod reflectance;

pub(in crate::render) use appearance::Appearance;
pub(in crate::render) use element::Element;
pub(in crate::render) use eye::{AHEAD, Cone, Eye, Sight, meet};
pub(in crate::render) use found::{Found, Met};
pub use geometry::World;
pub(in crate::render) use light_buffer::Way;
pub(in crate::render) use media::{Crossing, Media};
pub(in crate::render) use reflectance::{diffuse, mean_diffuse};
