//! What the bytes of a raster picture mean: the transfer function of sRGB, on which host and workstation agree.

use std::sync::LazyLock;

/// Linear light, 0..=1, of a byte of sRGB.
///
/// [`srgb_from_linear`] gives every byte back exactly.
///
/// # Source
/// IEC 61966-2-1.
pub fn linear_from_srgb(byte: u8) -> f32 {
    LINEAR[usize::from(byte)]
}

/// Byte of sRGB of a linear light; clamped to 0..=1, and NaN is black.
///
/// Exact: rounds the encoded value to the nearest byte, by comparing with the light of every half step.
///
/// # Source
/// IEC 61966-2-1.
#[inline]
pub fn srgb_from_linear(light: f32) -> u8 {
    let encoding = &*ENCODING;
    // The cast takes NaN to 0, and no threshold is passed by NaN.
    let mut byte = encoding.starts[(light.clamp(0.0, 1.0) * STEPS as f32) as usize];
    while encoding.thresholds.get(usize::from(byte)).is_some_and(|threshold| *threshold <= light) {
        byte += 1;
    }
    byte
}

/// Equal steps of light for which it is known where the search for a byte begins. Multiplying by this number is exact.
const STEPS: usize = 4096;

/// What finds the byte of a light.
struct Encoding {
    /// Light of every half step between two bytes, rising.
    thresholds: [f32; 255],
    /// How many thresholds the beginning of each step passes: at most one or two are left to pass.
    starts: [u8; STEPS + 1],
}

/// Light of every byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|byte| decode(byte as f64 / 255.0)));

static ENCODING: LazyLock<Encoding> = LazyLock::new(|| {
    let thresholds = std::array::from_fn(|byte| decode((byte as f64 + 0.5) / 255.0));
    let passed = |light: f32| thresholds.partition_point(|threshold: &f32| *threshold <= light);
    // At most 255 thresholds are passed, so that the count fits a byte.
    Encoding { thresholds, starts: std::array::from_fn(|step| passed(step as f32 / STEPS as f32) as u8) }
});

/// The transfer function of sRGB, encoded 0..=1 to linear 0..=1.
fn decode(encoded: f64) -> f32 {
    let linear = if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
    linear as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_way_through_linear_light() {
        for byte in 0..=255 {
            assert_eq!(srgb_from_linear(linear_from_srgb(byte)), byte);
        }
    }

    #[test]
    fn encoding_equals_the_rounded_inverse_of_the_standard() {
        for step in 0..=100_000 {
            let light = f64::from(step as f32 / 100_000.0);
            let encoded = if light <= 0.0031308 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
            let exact = encoded * 255.0;
            let byte = f64::from(srgb_from_linear(light as f32));
            assert!((byte - exact).abs() < 0.5 + 1e-2, "{light}: {byte} for {exact}");
        }
    }

    #[test]
    fn light_out_of_range_is_clamped() {
        let bytes = [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1.0, 9.0, f32::INFINITY].map(srgb_from_linear);
        assert_eq!(bytes, [0, 0, 0, 0, 255, 255, 255]);
    }
}
