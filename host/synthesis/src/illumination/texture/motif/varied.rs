//! Two paints, mixed by the variation of an instance.

use super::sampled::Sampled;
use crate::numeric::sampling::mix;

/// The second paint covers one half of many instances.
pub(super) const MEAN: f64 = 0.5;

/// The part of the second paint: in channel 0 the variation itself, in others a number that it draws.
pub(super) fn second(sampled: &Sampled<'_>, channel: u32) -> f64 {
    let variation = sampled.footprint.variation;
    let drawn = match channel {
        0 => variation,
        channel => mix(u64::from(channel) << 16 | u64::from(variation)) as u16,
    };
    f64::from(drawn) / f64::from(u16::MAX)
}

#[cfg(test)]
mod tests {
    use super::super::super::TextureFootprint;
    use super::*;
    use glam::DVec3;

    fn of(variation: u16, channel: u32) -> f64 {
        let footprint = TextureFootprint { variation, ..TextureFootprint::default() };
        let sides = [DVec3::ZERO; 2];
        second(&Sampled { footprint: &footprint, at: DVec3::ZERO, sides, width: 0.0, is_solid: true }, channel)
    }

    #[test]
    fn channels_vary_by_themselves_from_0_to_1() {
        assert_eq!([of(0, 0), of(u16::MAX, 0)], [0.0, 1.0]);
        let all = || (0..=u16::MAX).step_by(7);
        let count = all().count() as f64;
        let mean = |of: &dyn Fn(u16) -> f64| all().map(of).sum::<f64>() / count;
        for channel in [1, 2, 3] {
            assert!((mean(&|v| of(v, channel)) - 0.5).abs() < 0.01);
            let product = mean(&|v| (of(v, 0) - 0.5) * (of(v, channel) - 0.5));
            assert!(product.abs() < 0.005, "{product}");
        }
    }
}
