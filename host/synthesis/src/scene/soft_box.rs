//! A soft box: a square lamp that faces what it lights.

use crate::illumination::RgbPower;
use crate::illumination::light::{Light, LightShape};
use glam::DVec3;

/// A square lamp around a place, which faces another.
///
/// - `irradiance`: about what a surface there that faces it gets, W/m².
pub(super) fn soft_box(place: DVec3, on: DVec3, side: f64, irradiance: RgbPower) -> Light {
    let (inward, distance) = ((on - place).normalize(), on.distance(place));
    let across = DVec3::Y.cross(inward).normalize_or(DVec3::X) * side;
    let up = inward.cross(across);
    let patch = LightShape::Rectangle { corner: place - (across + up) / 2.0, across, up };
    let radiance = irradiance * (distance / side).powi(2);
    Light::Area { patch, radiance: radiance.into() }
}
