//! Points of lights, from which scan line casts shadows.

use crate::illumination::light::LightPoint;
use glam::DVec3;

/// The position of a point of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LightPosition {
    Point(DVec3),
    /// Towards the light, infinitely far away.
    Direction(DVec3),
}

impl LightPosition {
    /// From a point towards the light, any length.
    pub(super) fn from(&self, point: DVec3) -> DVec3 {
        match self {
            LightPosition::Point(at) => *at - point,
            LightPosition::Direction(towards) => *towards,
        }
    }
}

/// One point of a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct LampPoint {
    /// Index of the source that it is a point of.
    pub(super) source: usize,
    /// The number of the scene's light that it is a point of; none of an object that emits.
    pub(super) light: Option<u32>,
    pub(super) point: LightPoint,
    pub(super) position: LightPosition,
}
