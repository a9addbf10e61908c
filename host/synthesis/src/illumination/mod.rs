//! From the light that arrives at a surface element to the luminance that leaves it.
//!
//! Radiometric units, over the wavelength or in three bands. With N the normal, L towards the light and V towards the
//! viewer, the luminance is
//!
//! ```text
//! I = ∫ D K E / (N·V),    E = I_light (N·L) dω
//! ```
//!
//! K is the reflected fraction at each wavelength, D the distribution of what is emitted over the outgoing hemisphere.
//! Ambient light is a term of its own: the same radiance from everywhere, reflected with the diffuse K.
//!
//! # Source
//! The 1988 paper, equations 4 and 5.

pub mod atmosphere;
pub mod distribution;
pub mod fresnel;
pub mod light;
pub mod material;
pub mod optics;
pub mod texture;

pub use light::Light;
pub use material::Material;
pub use texture::Paint;

use glam::DVec3;

/// Power in the red, green and blue band; linear light, never gamma-encoded.
///
/// The unit is that of the quantity: a fraction 0..=1 for reflectances, W/sr for an intensity, W/m² for an
/// irradiance, W/(m² sr) for radiance.
pub type RgbPower = DVec3;
