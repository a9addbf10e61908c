//! The shading context: how an interaction is seen; and the BSDF samples that continue a path from it.

use crate::color::Channels;
use glam::DVec3;

/// The refractive indices on both sides of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterfaceIndices {
    /// On the side of the viewer, for each lane.
    pub before: Channels,
    /// Behind.
    pub behind: Channels,
    /// Whether the viewer is inside the body of the element.
    pub inside: bool,
}

impl InterfaceIndices {
    /// Air on both sides.
    pub const AIR: InterfaceIndices = InterfaceIndices { before: Channels::ONE, behind: Channels::ONE, inside: false };
}

/// The shading context: direction to the viewer, wavelength set, indices and texture values of an interaction.
#[derive(Clone, Copy, Debug)]
pub struct ShadingContext<'a> {
    /// Towards the viewer.
    pub view: DVec3,
    /// The number of the wavelength set.
    pub wavelength_set: usize,
    /// The refractive index on the side of the viewer and behind.
    pub indices: InterfaceIndices,
    /// The lane for which refracted directions are sampled.
    pub lane: usize,
    /// Texture values at the footprint, as [`Bsdf::texture_values`](super::Bsdf::texture_values) tells; nothing for a
    /// material that has none.
    pub texture_values: &'a [Channels],
}

impl ShadingContext<'_> {
    /// The direction that a mirror would reflect to the viewer.
    pub(super) fn mirror_direction(&self) -> DVec3 {
        DVec3::new(-self.view.x, -self.view.y, self.view.z)
    }

    /// Whether light or viewer is behind the element, where what only reflects shows nothing.
    #[inline]
    pub(super) fn is_behind(&self, light: DVec3) -> bool {
        light.z <= 0.0 || self.view.z <= 0.0
    }
}

/// A BSDF sample: a direction to light, its weight and its pdf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Towards the light.
    pub light: DVec3,
    /// Radiance to the viewer for a radiance of 1 from there, over the pdf.
    pub weight: Channels,
    /// The pdf of the direction, 1/sr; none for a delta lobe: a mirror or a smooth interface.
    pub pdf: Option<f64>,
    /// Whether it goes straight through, as if nothing was there.
    pub is_straight: bool,
    /// Whether a broad lobe scatters there, and not a narrow one.
    pub is_broad: bool,
}

impl BsdfSample {
    /// The sample of a delta lobe: a mirror or a smooth interface.
    pub(super) fn specular(light: DVec3, weight: Channels) -> BsdfSample {
        BsdfSample { light, weight, pdf: None, is_straight: false, is_broad: false }
    }

    /// A sample of a lobe with a pdf: its weight is found when the values and pdfs of all lobes are known.
    pub(super) fn unweighted(light: DVec3) -> BsdfSample {
        BsdfSample { light, weight: Channels::ZERO, pdf: Some(0.0), is_straight: false, is_broad: true }
    }
}
