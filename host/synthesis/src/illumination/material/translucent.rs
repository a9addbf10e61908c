//! Thin sheets through which light comes diffusely: leaves, petals, paper, cloth.

use super::super::texture::{NumberTexture, Paint};
use serde::{Deserialize, Serialize};

/// A thin sheet that reflects some light diffusely and lets some through to the other side, diffusely, too; both sides are
/// alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Translucent {
    /// Diffuse reflectance, 0..=1.
    pub diffuse: Paint,
    /// Diffuse transmittance, 0..=1; with the reflectance no more than 1 at any place.
    pub transmittance: Paint,
    /// Roughness m of a transparent coat, 1e-8..=1000; none without one.
    pub coat: Option<NumberTexture>,
}

impl Translucent {
    /// Refractive index of the coat: of the wax on leaves.
    pub const COAT_INDEX: f64 = 1.4;
}
