//! A point that emits alike in all directions.

use super::beam::{Beam, LightPoint, Origin, Start, from_point};
use super::emitter::Emitter;
use crate::color::{Channels, Curve};
use glam::DVec3;
use std::f64::consts::TAU;

/// A point light.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) at: DVec3,
    /// Radiant intensity, W/sr.
    pub(super) strength: Curve,
}

impl Emitter for Point {
    fn beam(&self, point: DVec3, _: Option<DVec3>, _: [f64; 2], comb: usize) -> Option<Beam> {
        from_point(self.at - point, self.strength.of(comb))
    }

    fn points(&self, _: u32) -> Vec<LightPoint> {
        vec![LightPoint::at(self.at)]
    }

    fn origin(&self) -> Origin {
        Origin::point(self.at)
    }

    fn start(&self, _: [f64; 2], _: usize) -> Option<Start> {
        Some(Start::Place { at: self.at, normal: None, area: 0.0 })
    }

    fn intensity(&self, _: Option<DVec3>, _: DVec3, comb: usize) -> Channels {
        self.strength.of(comb)
    }

    fn power(&self, _: f64, comb: usize) -> Channels {
        self.strength.of(comb) * (2.0 * TAU)
    }
}
