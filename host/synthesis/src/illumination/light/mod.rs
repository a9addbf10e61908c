//! Sources of light: what a scene says of them, and their samples in rendering.
//!
//! A new light is a file, what stands here of its kind, and a function of scripts.

mod error;
mod light_sample;
mod emitter;
mod goniometry;
mod panorama;
mod sky_map;
mod spherical_rectangle;
mod light_shape;
mod portal;
mod sky;
mod point;
mod directional;
mod spot;
mod goniometric;
mod area;
mod mesh;
mod environment;
mod source;
#[cfg(test)]
mod contract_tests;
#[cfg(test)]
mod emission_tests;
#[cfg(test)]
mod tests;

pub use error::LightError;
pub use goniometry::{Goniometry, GoniometryError};
pub use light_sample::{EmissionSample, LightHit, LightOrigin, LightPoint, LightSample};
pub use light_shape::LightShape;
pub use panorama::Panorama;
pub use sky::Sky;
pub use sky_map::{SkyDisc, SkyMap};
pub use source::LightSource;

use super::material::Material;
use crate::color::{Color, WavelengthSets};
use crate::numeric::bounds::Bounds;
use area::AreaLight;
use directional::DirectionalLight;
use emitter::Emitter;
use environment::EnvironmentLight;
use error::{directed, place};
use glam::DVec3;
use goniometric::GoniometricProfile;
use mesh::MeshLight;
use point::{Isotropic, PointLight};
use serde::{Deserialize, Serialize};
use spot::SpotProfile;
use std::sync::Arc;

/// A source of light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Light {
    /// A point that emits alike in all directions; its irradiance falls with the square of the distance.
    Point {
        /// Position of the point.
        at: DVec3,
        /// Radiant intensity, W/sr. A source of power P has P / (4 pi).
        intensity: Color,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// The direction in which the light goes; any length but 0.
        direction: DVec3,
        /// Irradiance of a surface that faces the light, W/m².
        irradiance: Color,
    },
    /// A point that emits a cone of light: all of its intensity up to the inner angle, none beyond the outer one, and
    /// t² (3 − 2 t) between, t going from 0 to 1 with the cosine.
    Spot {
        /// Position of the point.
        at: DVec3,
        /// The direction of the axis of the cone; any length but 0.
        direction: DVec3,
        /// Radiant intensity on the axis, W/sr.
        intensity: Color,
        /// Angle between the axis and where the light begins to fall, degrees.
        inner: f64,
        /// Angle between the axis and where there is none, degrees, up to 180.
        outer: f64,
    },
    /// A luminaire that was measured: a point whose intensity is a table over the directions.
    Luminaire {
        /// Position of the luminaire.
        at: DVec3,
        /// The direction of the vertical angle 0: down for most; any length but 0.
        down: DVec3,
        /// About where its horizontal angle is 0; not along `down`.
        front: DVec3,
        /// The table.
        goniometry: Goniometry,
        /// Factor of the table: a color with Y = 1 leaves its candelas as they are, at 683 for 1 W/sr.
        color: Color,
    },
    /// A surface that emits the same radiance in all directions, and is seen.
    Area {
        /// The surface.
        patch: LightShape,
        /// Its radiance, W/(m² sr).
        radiance: Color,
    },
    /// Light from infinitely far away all around: the background, too.
    Sky {
        /// Radiance over all directions, latitude and longitude: the first row is up (y), the middle of the rows ahead
        /// (−z), the right quarter right (x). Without it, 1 everywhere.
        map: Option<SkyMap>,
        /// Factor of the map.
        radiance: Color,
        /// Degrees by which the map is turned about the upright axis, as a right-handed screw turns.
        turned: f64,
    },
    /// A surface that emits the same radiance in all directions, and reflects as what it is made of: an
    /// [`Light::Area`] with a body.
    Lamp {
        /// The surface. The back of a flat one reflects as its front does, and emits nothing.
        patch: LightShape,
        /// Its radiance, W/(m² sr).
        radiance: Color,
        /// What it is made of. What this emits is left out: the lamp emits its own radiance.
        material: Box<Material>,
    },
}

impl Light {
    /// Its strength, in the unit of its kind, and the word for that.
    pub fn strength(&self) -> (&'static str, &Color) {
        match self {
            Light::Point { intensity, .. } | Light::Spot { intensity, .. } => ("its intensity", intensity),
            Light::Directional { irradiance, .. } => ("its irradiance", irradiance),
            Light::Luminaire { color, .. } => ("its color", color),
            Light::Area { radiance, .. } | Light::Lamp { radiance, .. } | Light::Sky { radiance, .. } => {
                ("its radiance", radiance)
            }
        }
    }

    /// The picture of a sky, if it has one.
    pub fn panorama(&self) -> Option<&Panorama> {
        match self {
            Light::Sky { map: Some(map), .. } => map.panorama.as_deref(),
            _ => None,
        }
    }

    /// Words for its kind.
    pub fn words(&self) -> &'static str {
        match self {
            Light::Point { .. } => "a point light",
            Light::Directional { .. } => "parallel light",
            Light::Spot { .. } => "a spot light",
            Light::Luminaire { .. } => "a luminaire",
            Light::Area { patch, .. } | Light::Lamp { patch, .. } => patch.words(),
            Light::Sky { .. } => "a sky",
        }
    }

    /// The origin of its light.
    pub fn origin(&self) -> LightOrigin {
        match self {
            Light::Point { at, .. } | Light::Spot { at, .. } | Light::Luminaire { at, .. } => LightOrigin::point(*at),
            Light::Directional { direction, .. } => LightOrigin::Towards(-direction.normalize_or(DVec3::NEG_Y)),
            Light::Area { patch, .. } | Light::Lamp { patch, .. } => LightOrigin::Within(Bounds::of(patch.bounds())),
            Light::Sky { .. } => LightOrigin::Everywhere,
        }
    }

    /// The surface that emits and its radiance, if it has one that reflects nothing.
    pub fn surface(&self) -> Option<(&LightShape, &Color)> {
        match self {
            Light::Area { patch, radiance } => Some((patch, radiance)),
            _ => None,
        }
    }

    /// The surface and the material of a lamp that reflects, if it is one.
    pub fn body(&self) -> Option<(&LightShape, &Material)> {
        match self {
            Light::Lamp { patch, material, .. } => Some((patch, material)),
            _ => None,
        }
    }

    /// Whether its shadows have soft edges: it is a surface, or a sky.
    pub fn has_size(&self) -> bool {
        matches!(self, Light::Area { .. } | Light::Lamp { .. } | Light::Sky { .. })
    }

    /// The map of a sky that is not the same all around.
    pub fn sky_map(&self) -> Option<&SkyMap> {
        match self {
            Light::Sky { map, .. } => map.as_ref(),
            _ => None,
        }
    }

    /// Whether it is a sky of one radiance.
    pub fn is_even_sky(&self) -> bool {
        matches!(self, Light::Sky { map: None, .. })
    }

    /// Whether its color cannot be told in three bands.
    pub fn is_spectral(&self) -> bool {
        self.strength().1.is_spectral()
    }

    /// The light, prepared for rendering. It should have been checked before.
    fn emitter(&self, wavelengths: &WavelengthSets) -> AnyEmitter {
        let strength = wavelengths.light(self.strength().1);
        match self {
            Light::Point { at, .. } => AnyEmitter::Point(PointLight { at: *at, strength, profile: Isotropic }),
            Light::Directional { direction, .. } => {
                AnyEmitter::Directional(DirectionalLight { towards: -direction.normalize_or(DVec3::NEG_Y), strength })
            }
            Light::Spot { at, direction, inner, outer, .. } => {
                let axis = direction.normalize_or(DVec3::NEG_Y);
                let [inner, outer] = [inner, outer].map(|angle| angle.to_radians().cos());
                AnyEmitter::Spot(PointLight { at: *at, strength, profile: SpotProfile { axis, inner, outer } })
            }
            Light::Luminaire { at, down, front, goniometry, .. } => {
                let profile = GoniometricProfile::new(*down, *front, Arc::new(goniometry.clone()));
                AnyEmitter::Luminaire(PointLight { at: *at, strength, profile })
            }
            Light::Area { patch, .. } => AnyEmitter::Area(AreaLight { patch: *patch, strength, has_body: false }),
            Light::Lamp { patch, .. } => AnyEmitter::Area(AreaLight { patch: *patch, strength, has_body: true }),
            Light::Sky { map, radiance, turned } => {
                let sky = Sky::new(map.as_ref(), radiance, *turned, wavelengths);
                AnyEmitter::Sky(EnvironmentLight { sky: Box::new(sky), strength })
            }
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first [`LightError`].
    pub fn check(&self) -> Result<(), LightError> {
        let (what, color) = self.strength();
        let [least, most] = color.range();
        if !(least >= 0.0 && most.is_finite()) {
            return Err(LightError::Strength { what, least, most });
        }
        match self {
            Light::Point { at, .. } => place(*at),
            Light::Directional { direction, .. } => directed("its direction", *direction),
            Light::Spot { at, direction, inner, outer, .. } => {
                place(*at)?;
                directed("its direction", *direction)?;
                let possible = *inner >= 0.0 && inner < outer && *outer <= 180.0;
                if possible { Ok(()) } else { Err(LightError::Cone { inner: *inner, outer: *outer }) }
            }
            Light::Luminaire { at, down, front, .. } => {
                place(*at)?;
                directed("down", *down)?;
                directed("front", *front)?;
                directed("front across down", down.cross(*front))
            }
            Light::Area { patch, .. } => patch.check(),
            Light::Lamp { patch, material, .. } => {
                patch.check()?;
                material.check().map_err(LightError::Material)
            }
            Light::Sky { turned, .. } if turned.is_finite() => Ok(()),
            Light::Sky { turned, .. } => Err(LightError::NotFinite { what: "its turn", value: DVec3::splat(*turned) }),
        }
    }
}

/// Makes an enumeration of lights, each of which calls its own functions.
///
/// What stands behind `tried` makes lights of the kind for the contract of all lights, all above the plane y = 1.
macro_rules! lights {
    ($($kind:ident($light:ty) $(tried $tried:path)?,)*) => {
        /// A light of any kind, prepared for rendering.
        #[derive(Clone, Debug)]
        enum AnyEmitter {
            $($kind($light),)*
        }

        #[cfg(test)]
        impl AnyEmitter {
            /// The words for all kinds.
            const KINDS: &[&str] = &[$(stringify!($kind),)*];

            /// The lights that rows bring for the contract.
            fn tried() -> Vec<Light> {
                let all: &[Vec<Light>] = &[$($($tried(),)?)*];
                all.concat()
            }

            /// The word for its kind.
            fn kind(&self) -> &'static str {
                match self {
                    $(AnyEmitter::$kind(_) => stringify!($kind),)*
                }
            }
        }

        impl AnyEmitter {
            #[inline]
            fn emitter(&self) -> &dyn Emitter {
                match self {
                    $(AnyEmitter::$kind(light) => light,)*
                }
            }
        }
    };
}

lights! {
    Point(PointLight<Isotropic>),
    Directional(DirectionalLight),
    Spot(PointLight<SpotProfile>) tried spot::tests::tried,
    Luminaire(PointLight<GoniometricProfile>) tried goniometric::tests::tried,
    Area(AreaLight),
    Mesh(MeshLight),
    Sky(EnvironmentLight),
}
