//! Light that surfaces send each other, known before a picture is begun, as renderers ask for it.

use crate::color::Channels;

/// A part of the light that comes to surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IrradiancePart {
    /// All of the light.
    All,
    /// Only what other surfaces reflect.
    Indirect,
}

/// Light of all surfaces, for all views.
pub trait IndirectLight: Send + Sync {
    /// Irradiance at a place of a side of a triangle, W/m²: in bands, or in spectra the means over eight parts of the
    /// wavelengths.
    ///
    /// - `outside`: whether it is the outer side. `weights`: of the corners, each 0..=1, their sum 1.
    fn irradiance(&self, triangle: u32, outside: bool, weights: [f64; 3], part: IrradiancePart) -> Channels;
}
