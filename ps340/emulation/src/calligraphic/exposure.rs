//! The response of the picture to light: a soft shoulder that keeps the hue.

use super::spot::{bell, greater, lesser};

/// How light becomes a linear pixel value, 0..1.
///
/// With m the largest of the three channels, all three are multiplied by (1 - exp(-gain m)) / m: nearly
/// proportional for weak light, approaching 1 for strong light. The ratio of the channels stays, so that
/// crossings get brighter and never change their hue; red light upon green light is yellow.
///
/// With the default gain the centre of one vector of full intensity reaches 0.67 (byte 213 of sRGB), of two
/// 0.89 (242), of three 0.96 (251), of one at half the intensity 0.42 (174).
///
/// # Source
/// The exponential response is that of film and of many tone reproductions; holding the ratios is ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Slope of the response at no light; light 1 is the centre of a long stroke of intensity 1.
    pub gain: f32,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { gain: 1.1 }
    }
}

/// The strongest light that is distinguished from stronger.
const BLINDING: f32 = 1e30;

impl Exposure {
    /// The pixel value of `light` (red, green, blue; 1 = centre of a long stroke of intensity 1): 0..=1.
    ///
    /// A gain that is not positive, and light that is negative or NaN, give black.
    #[inline(always)]
    pub fn respond(&self, light: [f32; 3]) -> [f32; 3] {
        // Written so that NaN becomes 0.
        let bounded = |channel: f32| lesser(greater(channel, 0.0), BLINDING);
        let light = [bounded(light[0]), bounded(light[1]), bounded(light[2])];
        let strongest = greater(greater(light[0], light[1]), light[2]);
        let gain = greater(self.gain, 0.0);
        let scale = gain * saturation(gain * strongest);
        [lesser(light[0] * scale, 1.0), lesser(light[1] * scale, 1.0), lesser(light[2] * scale, 1.0)]
    }
}

/// (1 - exp(-x)) / x for x >= 0; 1 at 0. Relative error 1e-6.
#[inline(always)]
fn saturation(x: f32) -> f32 {
    // Both sides before the choice, for the compiler's sake. The series is worth 2e-7 at 0.25.
    let series = (-1.0_f32 / 720.0).mul_add(x, 1.0 / 120.0).mul_add(x, -1.0 / 24.0).mul_add(x, 1.0 / 6.0);
    let series = series.mul_add(x, -0.5).mul_add(x, 1.0);
    let direct = (1.0 - bell(lesser(2.0 * x, 160.0))) / x;
    if x < 0.25 { series } else { direct }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_two_and_three_vectors_get_brighter_and_stay_below_white() {
        let exposure = Exposure::default();
        let values = [0.5, 1.0, 2.0, 3.0, 10.0].map(|light| exposure.respond([light; 3])[0]);
        assert!(values.is_sorted_by(|weak, strong| strong - weak > 0.03), "{values:?}");
        assert!(values[1] > 0.6 && values[2] - values[1] > 0.2 && values[4] <= 1.0, "{values:?}");
    }

    #[test]
    fn the_hue_of_strong_light_is_that_of_weak_light() {
        let exposure = Exposure::default();
        for strength in [0.01, 1.0, 30.0, 1e9] {
            let [red, green, blue] = exposure.respond([strength, 0.5 * strength, 0.0]);
            assert!((green / red - 0.5).abs() < 1e-6 && blue == 0.0);
        }
    }

    #[test]
    fn the_response_is_that_of_film() {
        for step in 0..2000 {
            let light = 0.01 * step as f32;
            let exact = -(-f64::from(1.1f32 * light)).exp_m1();
            let value = f64::from(Exposure::default().respond([light, 0.0, 0.0])[0]);
            assert!((value - exact).abs() <= 1e-6 * exact, "{light}: {value} {exact}");
        }
    }

    #[test]
    fn weak_light_is_proportional_to_the_gain() {
        let value = Exposure { gain: 2.0 }.respond([1e-6, 0.0, 0.0])[0];
        assert!((value / 2e-6 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn odd_light_and_no_gain_are_black_and_nothing_is_nan() {
        let exposure = Exposure::default();
        assert_eq!(exposure.respond([0.0; 3]), [0.0; 3]);
        assert_eq!(exposure.respond([f32::NAN, -1.0, -0.0]), [0.0; 3]);
        assert_eq!(Exposure { gain: 0.0 }.respond([1.0; 3]), [0.0; 3]);
        assert_eq!(Exposure { gain: f32::NAN }.respond([1.0; 3]), [0.0; 3]);
        assert_eq!(exposure.respond([f32::INFINITY; 3]).map(|v| v > 0.999 && v <= 1.0), [true; 3]);
    }
}
