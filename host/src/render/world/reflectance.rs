//! How much of light materials reflect diffusely.

use crate::color::Channels;
use crate::illumination::optics::{Optics, Side, Sighting};
use crate::illumination::texture::Place;
use glam::DVec3;

/// The part of light that a material reflects diffusely at a place, in the mean over all combs of wavelengths.
pub(in crate::render) fn mean_diffuse(optics: &Optics, place: Option<&Place>, combs: usize) -> Channels {
    let mixture = place.map(|place| optics.mix(place));
    let sum = (0..combs).fold(Channels::ZERO, |sum, comb| {
        let painting = mixture.as_ref().map(|mixture| mixture.at(comb));
        sum + diffuse(optics, comb, painting.as_ref().map_or(&[], |painting| painting.as_slice()))
    });
    sum * (combs as f64).recip()
}

/// The part of light that a material reflects diffusely.
pub(in crate::render) fn diffuse(optics: &Optics, comb: usize, painted: &[Channels]) -> Channels {
    optics.diffuse(&Sighting { view: DVec3::Z, comb, side: Side::AIR, lane: 0, painted })
}
