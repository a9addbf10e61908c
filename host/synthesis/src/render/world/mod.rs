//! The world: a scene prepared for renderers, with its index for rays, lights, materials and camera. It knows no
//! renderer.

mod appearance;
mod carrier;
mod element;
mod ground_point;
mod found;
mod camera_rays;
mod interaction;
mod light_buffer;
mod geometry;
mod transmittance;
mod media;
mod reflectance;

pub(in crate::render) use appearance::Appearance;
pub(in crate::render) use camera_rays::{AHEAD, BoundedRay, CameraRays, RayCone, plane_intersection};
pub(in crate::render) use element::SurfaceElement;
pub use geometry::World;
pub(in crate::render) use geometry::check_copied;
pub(in crate::render) use interaction::{RayHit, SurfaceInteraction};
pub(in crate::render) use light_buffer::Occluders;
pub(in crate::render) use media::{Media, MediumInterface};
pub(in crate::render) use reflectance::{diffuse_albedo, mean_diffuse_albedo};
