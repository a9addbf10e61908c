//! From the light that arrives at a surface element to the luminance that leaves it.
//!
//! Radiometric units, three bands. With N the normal, L towards the light and V towards the viewer, the luminance is
//!
//! ```text
//! I = D K E / (N·V),   E = I_light (N·L) / distance²     (point source)
//!                      E = E_beam (N·L)                  (parallel light)
//! ```
//!
//! K is the reflected fraction in each band, D the distribution of what is emitted over the outgoing hemisphere.
//! Ambient light is a term of its own: the same radiance from everywhere, reflected with the diffuse K.
//!
//! # Source
//! The 1988 paper, equations 4 and 5.

pub mod distribution;
pub mod fresnel;

use distribution::{Distribution, Frame, Lambert, Phong};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Power in the red, green and blue band; linear light, never gamma-encoded.
///
/// The unit is that of the quantity: a fraction 0..=1 for reflectances, W/sr for an intensity, W/m² for an
/// irradiance, W/(m² sr) for radiance.
pub type Bands = DVec3;

/// How a surface reflects: fractions K of the flux density that arrives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Material {
    /// Diffusely reflected fraction, 0..=1.
    pub diffuse: Bands,
    /// Fraction in the highlight of Phong's model, 0..=1.
    pub specular: Bands,
    /// Phong's exponent n, 1 to [`Material::MAX_EXPONENT`]; the lobe falls to one half at acos(2^(-1/n)).
    pub exponent: f64,
    /// Fraction reflected as by a mirror, 0..=1.
    pub mirror: Bands,
}

impl Default for Material {
    fn default() -> Material {
        Material { diffuse: Bands::splat(0.7), specular: Bands::ZERO, exponent: 50.0, mirror: Bands::ZERO }
    }
}

impl Material {
    /// Largest exponent of the highlight; beyond it the lobe is narrower than any lamp.
    pub const MAX_EXPONENT: f64 = 1e6;
}

/// A source of light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Light {
    /// A point that emits alike in all directions; its irradiance falls with the square of the distance.
    Point {
        /// Where it is.
        at: DVec3,
        /// Radiant intensity, W/sr. A source of power P has P / (4 pi).
        intensity: Bands,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Where the light goes; any length but 0.
        direction: DVec3,
        /// Irradiance of a surface that faces the light, W/m².
        irradiance: Bands,
    },
}

/// Light that arrives at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// From the point towards the light, unit length.
    pub towards: DVec3,
    /// From the point to the light; infinite for parallel light.
    pub distance: f64,
    /// Irradiance of a surface that faces the light, W/m².
    pub irradiance: Bands,
}

impl Light {
    /// The light that arrives at `point` if nothing stands between; none at the light itself.
    pub fn beam(&self, point: DVec3) -> Option<Beam> {
        match *self {
            Light::Point { at, intensity } => {
                let offset = at - point;
                let distance = offset.length();
                (distance > 0.0 && distance.is_finite()).then(|| Beam {
                    towards: offset / distance,
                    distance,
                    irradiance: intensity / distance / distance,
                })
            }
            Light::Directional { direction, irradiance } => {
                direction.try_normalize().map(|unit| Beam { towards: -unit, distance: f64::INFINITY, irradiance })
            }
        }
    }

    /// The strength, in the unit of its kind: W/sr or W/m².
    pub fn strength(&self) -> Bands {
        match *self {
            Light::Point { intensity, .. } => intensity,
            Light::Directional { irradiance, .. } => irradiance,
        }
    }
}

/// Which of the direct terms are computed. A term that is not needed contributes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// Lambert's term.
    pub diffuse: bool,
    /// Phong's term.
    pub specular: bool,
}

/// Luminance towards the viewer from one unobstructed beam.
///
/// - `normal`, `view`: unit vectors at the surface element, `view` towards the eye.
/// - Returns W/(m² sr); zero where the light is below the horizon.
pub fn reflected(material: &Material, beam: &Beam, normal: DVec3, view: DVec3, terms: Terms) -> Bands {
    let frame = Frame::about(normal);
    let (light, view) = (frame.local(beam.towards), frame.local(view));
    if light.z <= 0.0 || view.z <= 0.0 {
        return Bands::ZERO;
    }
    let flux_density = beam.irradiance * light.z;
    let mut fraction = Bands::ZERO;
    if terms.diffuse {
        fraction += material.diffuse * Lambert.density(light, view);
    }
    if terms.specular {
        let exponent = material.exponent.clamp(0.0, Material::MAX_EXPONENT);
        fraction += material.specular * Phong::new(exponent).map_or(0.0, |phong| phong.density(light, view));
    }
    fraction * flux_density / view.z
}

/// Luminance from the ambient term: uniform radiance `ambient` from the hemisphere, diffusely reflected.
///
/// The irradiance of a uniform hemisphere is pi times its radiance, and Lambert's 1/pi cancels it: I = K ambient.
pub fn ambient(material: &Material, ambient: Bands) -> Bands {
    material.diffuse * ambient
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const BOTH: Terms = Terms { diffuse: true, specular: true };

    #[test]
    fn irradiance_falls_with_the_square_of_the_distance() {
        let light = Light::Point { at: DVec3::new(0.0, 3.0, 0.0), intensity: Bands::splat(18.0) };
        let beam = light.beam(DVec3::ZERO).expect("not at the light");
        assert_eq!((beam.irradiance, beam.distance, beam.towards), (Bands::splat(2.0), 3.0, DVec3::Y));
        assert!(light.beam(DVec3::new(0.0, 3.0, 0.0)).is_none(), "no direction at the light itself");
    }

    #[test]
    fn a_diffuse_surface_has_the_luminance_of_lambert_from_everywhere() {
        let material = Material { diffuse: Bands::new(0.2, 0.4, 0.8), ..Material::default() };
        let light = Light::Directional { direction: DVec3::new(0.0, -1.0, -1.0), irradiance: Bands::splat(10.0) };
        let beam = light.beam(DVec3::ZERO).expect("direction");
        for view in [DVec3::Y, DVec3::new(0.6, 0.8, 0.0), DVec3::new(-0.8, 0.6, 0.0)] {
            let expected = material.diffuse * 10.0 * 0.5f64.sqrt() / PI;
            assert!((reflected(&material, &beam, DVec3::Y, view, BOTH) - expected).length() < 1e-12);
        }
    }

    #[test]
    fn light_and_eye_below_the_horizon_give_nothing() {
        let material = Material { specular: Bands::splat(0.5), ..Material::default() };
        let beam = Beam { towards: -DVec3::Y, distance: 1.0, irradiance: Bands::ONE };
        assert_eq!(reflected(&material, &beam, DVec3::Y, DVec3::Y, BOTH), Bands::ZERO);
        let beam = Beam { towards: DVec3::Y, ..beam };
        assert_eq!(reflected(&material, &beam, DVec3::Y, -DVec3::Y, BOTH), Bands::ZERO);
    }

    #[test]
    fn ambient_light_on_a_white_surface_gives_its_own_radiance() {
        let white = Material { diffuse: Bands::ONE, ..Material::default() };
        assert_eq!(ambient(&white, Bands::splat(0.3)), Bands::splat(0.3));
    }
}
