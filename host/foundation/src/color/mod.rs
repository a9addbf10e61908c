//! Spectra, and what an eye and a screen make of them.
//!
//! Wavelengths are in nanometres. A spectrum is piecewise linear between its samples, and integrals of products of
//! spectra are exact for that form. Colours are those of the CIE 1931 observer and of linear sRGB, whose white is D65.

pub mod bins;
pub mod blackbody;
mod channels;
#[expect(clippy::module_inception, reason = "the noun of the field")]
mod color;
pub mod columns;
pub mod daylight;
mod error;
pub mod glass;
pub mod observer;
pub mod reflectance;
pub mod shipped;
pub mod spectrum;
pub mod srgb;
mod temperature;
mod wavelengths;

pub use bins::Bins;
pub use channels::{Channels, LANES};
pub use color::{Color, WHITE};
pub use columns::Origin;
pub use error::ColorError;
pub use glass::Glass;
pub use reflectance::SmoothReflectance;
pub use spectrum::{Extrapolation, Spectrum, integral};
pub use temperature::light_of_temperature;
pub use wavelengths::{SpectralTable, WavelengthSets};
