//! Diffuse albedo of materials.

use crate::color::Channels;
use crate::illumination::optics::{Bsdf, InterfaceIndices, ShadingContext};
use crate::illumination::texture::TextureFootprint;
use glam::DVec3;

/// The part of light that a material reflects diffusely at a footprint, in the mean over all wavelength sets.
pub(in crate::render) fn mean_diffuse_albedo(
    bsdf: &Bsdf,
    footprint: Option<&TextureFootprint>,
    sets: usize,
) -> Channels {
    let mixture = footprint.map(|place| bsdf.texture_mixture(place));
    let sum = (0..sets).fold(Channels::ZERO, |sum, wavelength_set| {
        let texture_values = mixture.as_ref().map(|mixture| mixture.at(wavelength_set));
        sum + diffuse_albedo(bsdf, wavelength_set, texture_values.as_ref().map_or(&[], |painting| painting.as_slice()))
    });
    sum * (sets as f64).recip()
}

/// The part of light that a material reflects diffusely.
pub(in crate::render) fn diffuse_albedo(bsdf: &Bsdf, wavelength_set: usize, texture_values: &[Channels]) -> Channels {
    bsdf.diffuse_albedo(&ShadingContext {
        view: DVec3::Z,
        wavelength_set,
        indices: InterfaceIndices::AIR,
        lane: 0,
        texture_values,
    })
}
