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
pub(in crate::render) use element::SurfaceElement;
pub(in crate::render) use eye::{AHEAD, RayCone, CameraRays, BoundedRay, plane_intersection};
pub(in crate::render) use found::{SurfaceInteraction, RayHit};
pub use geometry::World;
pub(in crate::render) use light_buffer::Occluders;
pub(in crate::render) use media::{MediumInterface, Media};
pub(in crate::render) use reflectance::{diffuse_albedo, mean_diffuse_albedo};
