//! Lambert's law: equal luminance in all directions.

use super::Distribution;
use crate::numeric::sampling::cosine_hemisphere;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Lambert's distribution, D = (N·V)/pi; normalised for every incidence.
///
/// # Source
/// The 1988 paper, table of D; Lambert 1760.
#[derive(Clone, Copy, Debug)]
pub struct Lambert;

impl Distribution for Lambert {
    fn name(&self) -> &str {
        "Lambert"
    }

    fn density(&self, _: DVec3, view: DVec3) -> f64 {
        view.z * FRAC_1_PI
    }

    fn sample(&self, _: DVec3, point: [f64; 2]) -> Option<DVec3> {
        Some(cosine_hemisphere(point, DVec3::Z)).filter(|view| view.z > 0.0)
    }

    fn pdf(&self, _: DVec3, view: DVec3) -> f64 {
        view.z * FRAC_1_PI
    }
}
