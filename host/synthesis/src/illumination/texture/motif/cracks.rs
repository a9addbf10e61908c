//! Scales of a second paint with cracks of the first between them, as bark, dry mud and old paint have them.

use super::super::TextureError;
use super::clouds;
use super::sampled::{Sampled, sinc};
use crate::numeric::noise::octaves;

/// The noise at which scales are as high as they become: cracks are where the noise is near 0.
const SLOPE: f64 = 3.2;
/// The second paint in the mean, for each number of octaves; more change it no further.
const MEANS: [f64; 4] = [0.602, 0.634, 0.64, 0.641];

/// Refuses too many frequencies, and none.
pub(super) fn check(count: u32) -> Result<(), TextureError> {
    clouds::check(count)
}

/// The part of the second paint over a footprint.
pub(super) fn second(sampled: &Sampled<'_>, count: u32) -> f64 {
    let height = (SLOPE * octaves(sampled.at, count, sampled.width).abs()).min(1.0);
    // The mean of what is not a wave does not stay when waves become fainter.
    let mean = mean(count);
    mean + (height - mean) * sinc(2.0 * sampled.width)
}

/// The second paint in the mean.
pub(super) fn mean(count: u32) -> f64 {
    MEANS[(count.max(1) as usize).min(MEANS.len()) - 1]
}

#[cfg(test)]
mod tests {
    use super::super::super::TextureFootprint;
    use super::*;
    use crate::numeric::sampling::RandomStream;
    use glam::DVec3;

    #[test]
    fn the_mean_is_that_of_the_number_of_octaves() {
        let footprint = TextureFootprint::default();
        let mut random = RandomStream::new(1, 1);
        for count in [1, 2, 3, 4, 8] {
            let mut place = || random.uniform() * 400.0 - 200.0;
            let mut of = || {
                let at = DVec3::new(place(), place(), place());
                let sides = [DVec3::X * 1e-6, DVec3::Z * 1e-6];
                second(&Sampled { footprint: &footprint, at, sides, width: 1e-6, is_solid: true }, count)
            };
            let found = (0..60_000).map(|_| of()).sum::<f64>() / 60_000.0;
            assert!((found - mean(count)).abs() < 0.006, "{count}: {found}");
        }
    }
}
