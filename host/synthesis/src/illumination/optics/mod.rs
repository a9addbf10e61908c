//! Materials prepared for rendering: what they scatter, tabulated at the wavelengths that rays carry.
//!
//! Directions are unit vectors in the frame of the surface element: z is its normal on the side of the viewer. Light
//! may come from above, or from below where a surface lets it through.
//!
//! A [`Bsdf`] is a sum of lobes. Some end a path: they reflect light of lights and ambient light only, as Lambert's and
//! Phong's terms do where diffuse interreflection is left out. The others continue it.

mod context;
mod prepared_textures;
mod lobe;
mod diffuse;
mod distributed;
mod mirror;
mod straight;
mod translucent;
mod smooth_conductor;
mod rough_conductor;
mod coat;
mod dielectric;
mod interface_losses;
mod rough_dielectric;
mod principled;
mod varied;
mod lobes;
mod bsdf;
mod builder;

#[cfg(test)]
mod contract_tests;
#[cfg(test)]
mod glass_tests;
#[cfg(test)]
mod tests;

pub use bsdf::{Bsdf, InteriorMedium, Interreflection, LobeClass, LobeSelection, TextureMixture, TextureValues};
pub use builder::BsdfBuilder;
pub use context::{BsdfSample, InterfaceIndices, ShadingContext};
