//! The first hit of a ray: a surface interaction, a surface that emits, or nothing.

use super::element::SurfaceElement;
use crate::color::Channels;
use crate::illumination::distribution::ShadingFrame;
use crate::illumination::light::LightHit;
use crate::illumination::optics::{Bsdf, TextureValues};
use glam::DVec3;

/// The first hit of a ray.
pub(in crate::render) enum RayHit<'a> {
    /// An element of an object.
    Surface(SurfaceInteraction<'a>),
    /// A surface that emits, and which of the lights it is.
    Light(usize, LightHit),
    /// No hit.
    Nothing,
}

/// A surface interaction: an element of an object, with the material and its texture values there.
pub(in crate::render) struct SurfaceInteraction<'a> {
    pub(in crate::render) element: SurfaceElement,
    pub(in crate::render) bsdf: &'a Bsdf,
    pub(in crate::render) triangle: u32,
    pub(in crate::render) object: u32,
    /// Number of the material among those of the object.
    pub(in crate::render) material: u32,
    /// From where the ray began to the triangle.
    pub(in crate::render) distance: f64,
    /// From where the ray began to the exact surface behind the triangle, if that is known.
    pub(in crate::render) depth: f64,
    /// From where the ray began to the exact surface, in lengths of the ray's direction.
    pub(in crate::render) t: f64,
    /// Texture values of the material; nothing for a material that has no textures.
    pub(super) texture_values: TextureValues,
    /// The direction in which its material is brushed.
    pub(in crate::render) brushed_along: Option<DVec3>,
}

impl SurfaceInteraction<'_> {
    /// The frame in which its BSDF has directions.
    pub(in crate::render) fn frame(&self) -> ShadingFrame {
        let normal = self.element.normal;
        self.brushed_along
            .map_or_else(|| ShadingFrame::from_normal(normal), |along| ShadingFrame::brushed(normal, along))
    }

    /// Whether wavelengths separate that are refracted into it.
    pub(in crate::render) fn disperses(&self) -> bool {
        self.bsdf.interior.as_ref().is_some_and(|interior| interior.disperses)
    }

    /// Texture values of the material.
    pub(in crate::render) fn texture_values(&self) -> &[Channels] {
        &self.texture_values
    }
}
