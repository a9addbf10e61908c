//! How much of light materials reflect diffusely.

use crate::color::Channels;
use crate::illumination::optics::{Bsdf, InterfaceIndices, ShadingContext};
use crate::illumination::texture::TextureFootprint;
use glam::DVec3;

/// The part of light that a material reflects diffusely at a place, in the mean over all combs of wavelengths.
pub(in crate::render) fn mean_diffuse_albedo(optics: &Bsdf, place: Option<&TextureFootprint>, combs: usize) -> Channels {
    let mixture = place.map(|place| optics.texture_mixture(place));
    let sum = (0..combs).fold(Channels::ZERO, |sum, comb| {
        let painting = mixture.as_ref().map(|mixture| mixture.at(comb));
        sum + diffuse_albedo(optics, comb, painting.as_ref().map_or(&[], |painting| painting.as_slice()))
    });
    sum * (combs as f64).recip()
}

/// The part of light that a material reflects diffusely.
pub(in crate::render) fn diffuse_albedo(optics: &Bsdf, comb: usize, painted: &[Channels]) -> Channels {
    optics.diffuse_albedo(&ShadingContext { view: DVec3::Z, comb, side: InterfaceIndices::AIR, lane: 0, painted })
}
