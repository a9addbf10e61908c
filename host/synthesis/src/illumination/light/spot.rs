//! The profile of a spot light: a cone of light, which fades towards its edge.

use super::point::AngularProfile;
use glam::DVec3;
use std::f64::consts::TAU;

/// A cone of light.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpotProfile {
    /// Where the cone goes, unit length.
    pub(super) axis: DVec3,
    /// Cosine of the angle where the light begins to fall.
    pub(super) inner: f64,
    /// Cosine of the angle where there is none.
    pub(super) outer: f64,
}

impl AngularProfile for SpotProfile {
    fn part(&self, direction: DVec3) -> f64 {
        let part = ((direction.dot(self.axis) - self.outer) / (self.inner - self.outer)).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    }

    fn integral(&self) -> f64 {
        TAU * (1.0 - 0.5 * (self.inner + self.outer))
    }

    fn cone(&self) -> Option<(DVec3, f64)> {
        Some((self.axis, self.outer))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::color::Color;
    use crate::illumination::Light;

    /// A spot light for the contract of all lights.
    pub fn tried() -> Vec<Light> {
        let (at, intensity) = (DVec3::new(0.5, 3.0, 0.4), Color::grey(1.0));
        vec![Light::Spot { at, direction: DVec3::NEG_Y, intensity, inner: 20.0, outer: 60.0 }]
    }
}
