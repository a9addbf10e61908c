//! Lambert's law: equal luminance in all directions.

use super::{Directions, Distribution};
use std::f64::consts::FRAC_1_PI;

/// Lambert's distribution, D = (N·V)/pi; normalised for every incidence.
///
/// # Source
/// The 1988 paper, table of D; Lambert 1760.
#[derive(Clone, Copy, Debug)]
pub struct Lambert;

impl Distribution for Lambert {
    fn name(&self) -> &'static str {
        "Lambert"
    }

    fn density(&self, directions: &Directions) -> f64 {
        directions.n_v * FRAC_1_PI
    }
}

#[cfg(test)]
mod tests {
    use super::super::hemisphere_integral;
    use super::*;

    #[test]
    fn lambert_is_normalised_at_every_incidence() {
        for incidence in [0.0, 0.5, 1.0, 1.5] {
            assert!((hemisphere_integral(&Lambert, incidence, 100) - 1.0).abs() < 1e-4);
        }
    }
}
