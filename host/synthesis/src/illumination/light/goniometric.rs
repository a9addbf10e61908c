//! The profile of a luminaire that was measured: a table over the directions.

use super::Goniometry;
use super::point::AngularProfile;
use crate::color::observer::LUMENS_PER_WATT;
use crate::numeric::cubature::GAUSS;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Parts of the angles over which the power of a luminaire is summed.
const PARTS: usize = 24;

/// The intensities of a luminaire, as a laboratory measured them.
#[derive(Clone, Debug)]
pub(super) struct GoniometricProfile {
    /// From the axes of the table to those of the scene.
    axes: DMat3,
    /// Candelas.
    table: Arc<Goniometry>,
}

impl GoniometricProfile {
    /// - `down`: where the vertical angle is 0. `front`: about where the horizontal angle is 0.
    pub(super) fn new(down: DVec3, front: DVec3, table: Arc<Goniometry>) -> GoniometricProfile {
        let up = -down.normalize_or(DVec3::NEG_Y);
        let y = up.cross(front).normalize_or(up.any_orthonormal_vector());
        GoniometricProfile { axes: DMat3::from_cols(y.cross(up), y, up), table }
    }
}

impl AngularProfile for GoniometricProfile {
    fn part(&self, direction: DVec3) -> f64 {
        self.table.candelas(self.axes.transpose() * direction) / LUMENS_PER_WATT
    }

    fn integral(&self) -> f64 {
        over_the_sphere(|direction| self.table.candelas(direction)) / LUMENS_PER_WATT
    }
}

/// The integral of a function of directions.
fn over_the_sphere(function: impl Fn(DVec3) -> f64) -> f64 {
    let part = (PARTS as f64).recip();
    let points =
        || (0..PARTS).flat_map(|k| GAUSS.iter().map(move |(at, weight)| ((k as f64 + at) * part, weight * part)));
    let ring = |(x, weight): (f64, f64)| {
        let (down, sine) = ((PI * x).cos(), (PI * x).sin());
        let along = |(y, weight): (f64, f64)| {
            let (sin, cos) = (TAU * y).sin_cos();
            function(DVec3::new(sine * cos, sine * sin, down)) * weight
        };
        points().map(along).sum::<f64>() * TAU * PI * sine * weight
    };
    points().map(ring).sum()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::color::Color;
    use crate::illumination::Light;

    /// A luminaire for the contract of all lights.
    pub fn tried() -> Vec<Light> {
        let vertical: Vec<f64> = (0..=180).map(f64::from).collect();
        let candelas = vertical.iter().map(|v| LUMENS_PER_WATT * (1.0 + v.to_radians().cos())).collect();
        let goniometry = Goniometry::new(vertical, vec![0.0], candelas).expect("a table");
        let (at, color) = (DVec3::new(0.5, 3.0, 0.4), Color::grey(1.0));
        vec![Light::Luminaire { at, down: DVec3::NEG_Y, front: DVec3::X, goniometry, color }]
    }
}
