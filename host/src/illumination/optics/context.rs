//! How an element is seen, and where rays go on from it.

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

/// How an element is seen, and what is on its two sides.
#[derive(Clone, Copy, Debug)]
pub struct ShadingContext<'a> {
    /// Towards the viewer.
    pub view: DVec3,
    /// The number of the set of wavelengths that are carried.
    pub wavelength_set: usize,
    /// The refractive index on the side of the viewer and behind.
    pub indices: InterfaceIndices,
    /// For which lane refracted directions are drawn.
    pub lane: usize,
    /// What the patterns give at the place, as [`Bsdf::texture_values`](super::Bsdf::texture_values) tells; nothing for a material that has none.
    pub texture_values: &'a [Channels],
}

impl ShadingContext<'_> {
    /// The direction in which a mirror would see.
    pub(super) fn mirror_direction(&self) -> DVec3 {
        DVec3::new(-self.view.x, -self.view.y, self.view.z)
    }

    /// Whether light or viewer is behind the element, where what only reflects shows nothing.
    #[inline]
    pub(super) fn is_behind(&self, light: DVec3) -> bool {
        light.z <= 0.0 || self.view.z <= 0.0
    }
}

/// Where a ray goes on, backwards to where its light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Towards the light.
    pub light: DVec3,
    /// What of the radiance from there comes to the viewer, over the density with which the direction was drawn.
    pub weight: Channels,
    /// That density, 1/sr; none for the one direction of a mirror or a smooth interface.
    pub pdf: Option<f64>,
    /// Whether it goes straight on, as if nothing was there.
    pub is_straight: bool,
    /// Whether a broad lobe carries it on, and not a narrow one.
    pub is_broad: bool,
}

impl BsdfSample {
    /// The one direction of a mirror or a smooth interface.
    pub(super) fn specular(light: DVec3, weight: Channels) -> BsdfSample {
        BsdfSample { light, weight, pdf: None, is_straight: false, is_broad: false }
    }

    /// A direction of many: its weight is found when all lobes that could have drawn it were asked.
    pub(super) fn unweighted(light: DVec3) -> BsdfSample {
        BsdfSample { light, weight: Channels::ZERO, pdf: Some(0.0), is_straight: false, is_broad: true }
    }
}
