//! Fresnel's equations: how much a smooth interface reflects, and where the rest goes.
//!
//! With η the index behind the interface over the index before it, c the cosine of incidence and q = √(η² − 1 + c²),
//! the amplitudes are (c − q) / (c + q) across the plane of incidence and (η² c − q) / (η² c + q) in it. Both
//! numerators cancel as η nears 1. Multiplied out they are
//!
//! ```text
//! perpendicular  −(η² − 1) / (c + q)²          parallel  (η² − 1) ((η² + 1) c² − 1) / (η² c + q)²
//! ```
//!
//! and η² − 1 is a product of a difference and a sum of the two indices: no digit is lost.

mod conductor;
mod dielectric;
#[cfg(test)]
mod tests;

pub use conductor::Conductor;
pub use dielectric::Dielectric;

/// The smallest index of refraction, or absolute value of a complex one.
const LEAST_INDEX: f64 = 1e-6;
/// The greatest index of refraction or extinction coefficient.
const MOST_INDEX: f64 = 1e6;

/// Parts of the power of light, 0..=1, by its polarisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polarised {
    /// The part of light whose electric field lies across the plane of incidence.
    pub perpendicular: f64,
    /// The part of light whose electric field lies in it.
    pub parallel: f64,
}

impl Polarised {
    /// The part of unpolarised light.
    pub fn mean(self) -> f64 {
        0.5 * (self.perpendicular + self.parallel)
    }
}

/// An index of refraction that no material has.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("an index of refraction of {n} + {k} i: it must not be negative, nor below 1e-6 or above 1e6")]
pub struct IndexError {
    /// The refractive index.
    pub n: f64,
    /// The extinction coefficient.
    pub k: f64,
}

/// The index if a material can have it.
fn checked(n: f64, k: f64) -> Result<(f64, f64), IndexError> {
    let possible = n >= 0.0 && k >= 0.0 && n.hypot(k) >= LEAST_INDEX && n.max(k) <= MOST_INDEX;
    if possible { Ok((n, k)) } else { Err(IndexError { n, k }) }
}

/// A cosine of incidence in 0..=1; 0 for one that is not a number.
fn cosine_of(cosine: f64) -> f64 {
    if cosine.is_nan() { 0.0 } else { cosine.clamp(0.0, 1.0) }
}
