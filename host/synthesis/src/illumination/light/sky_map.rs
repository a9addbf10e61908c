//! The map of a sky: a picture of all directions, or a disc that shines.

use super::Panorama;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// The map of a sky that is not the same all around.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SkyMap {
    /// The file of its picture, or what it was made of, for messages.
    pub file: String,
    /// The picture; empty where it is not kept.
    #[serde(skip)]
    pub panorama: Option<Arc<Panorama>>,
    /// The only part that shines, if it is but a disc.
    pub disc: Option<SkyDisc>,
}

/// A part of the sky that shines evenly: the sun.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SkyDisc {
    /// Towards its middle, unit length.
    pub towards: DVec3,
    /// Its radius, radians, above 0.
    pub radius: f64,
}

impl SkyDisc {
    /// Its solid angle, sr.
    pub fn solid_angle(&self) -> f64 {
        4.0 * PI * (0.5 * self.radius).sin().powi(2)
    }
}
