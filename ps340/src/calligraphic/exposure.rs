//! The response of the picture to light: a soft shoulder that keeps the hue.

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

impl Exposure {
    /// The pixel value of `light` (red, green, blue; 1 = centre of a long stroke of intensity 1): 0..=1.
    ///
    /// A gain or a light that is not positive gives black.
    pub fn respond(&self, light: [f32; 3]) -> [f32; 3] {
        let strongest = light[0].max(light[1]).max(light[2]);
        let exponent = self.gain * strongest;
        if !(exponent > 0.0 && strongest.is_finite()) {
            return [0.0; 3];
        }
        let scale = -(-exponent).exp_m1() / strongest;
        light.map(|channel| channel * scale)
    }
}

#[cfg(test)]
mod tests {
    use super::Exposure;

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
        for strength in [0.01, 1.0, 30.0] {
            let [red, green, blue] = exposure.respond([strength, 0.5 * strength, 0.0]);
            assert!((green / red - 0.5).abs() < 1e-6 && blue == 0.0);
        }
    }

    #[test]
    fn weak_light_is_proportional_to_the_gain() {
        let value = Exposure { gain: 2.0 }.respond([1e-6, 0.0, 0.0])[0];
        assert!((value / 2e-6 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn no_light_and_no_gain_are_black() {
        assert_eq!(Exposure::default().respond([0.0; 3]), [0.0; 3]);
        assert_eq!(Exposure { gain: 0.0 }.respond([1.0; 3]), [0.0; 3]);
        assert_eq!(Exposure { gain: f32::NAN }.respond([1.0; 3]), [0.0; 3]);
    }
}
