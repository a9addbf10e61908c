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
    let [byte] = srgb_from_linear_each(&[light]);
    byte as u8
}

/// [`srgb_from_linear`] for several at once, 0..=255, with the widest instructions that the caller is compiled for.
#[inline(always)]
pub fn srgb_from_linear_each<const N: usize>(light: &[f32; N]) -> [u32; N] {
    let encoding = &*ENCODING;
    let mut bytes = [0; N];
    for (byte, light) in bytes.iter_mut().zip(light) {
        // Written so that NaN becomes 0.
        let light = if *light > 0.0 { *light } else { 0.0 };
        let light = if light < 1.0 { light } else { 1.0 };
        let step = (light * STEPS as f32 + ROUND).to_bits();
        let start = encoding.starts[step as usize % ROOM];
        *byte = start + if encoding.thresholds[start as usize % BYTES] <= light { 1 } else { 0 };
    }
    bytes
}

/// Equal steps of light, each of which passes one threshold at most: they are 1/3295 apart where they are closest.
/// Multiplying by this number is exact.
const STEPS: usize = 4096;
/// Values of a byte.
const BYTES: usize = 256;
/// More than the steps: a remainder by it spares a check.
const ROOM: usize = 2 * STEPS;
/// 1.5 * 2^23: adding it rounds to a whole number and leaves that in the low bits, in one instruction.
const ROUND: f32 = 12_582_912.0;

/// What finds the byte of a light.
struct Encoding {
    /// Light of every half step between two bytes, rising; the last is never passed.
    thresholds: [f32; BYTES],
    /// How many thresholds the beginning of each step passes, which is half a step before its number.
    starts: [u32; ROOM],
}

/// Light of every byte.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|byte| light_of_srgb(byte as f64 / 255.0) as f32));

static ENCODING: LazyLock<Encoding> = LazyLock::new(|| {
    let half_step =
        |byte: usize| if byte < 255 { light_of_srgb((byte as f64 + 0.5) / 255.0) as f32 } else { f32::INFINITY };
    let thresholds: [f32; BYTES] = std::array::from_fn(half_step);
    let passed = |light: f32| thresholds.partition_point(|threshold| *threshold <= light);
    // At most 255 thresholds are passed, so that the count fits a byte.
    Encoding { thresholds, starts: std::array::from_fn(|step| passed((step as f32 - 0.5) / STEPS as f32) as u32) }
});

/// Linear light, 0..=1, of a number that is encoded as sRGB, 0..=1.
///
/// # Source
/// IEC 61966-2-1.
pub fn light_of_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
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
    fn several_at_once_have_the_bytes_that_each_has_alone() {
        let light = std::array::from_fn::<f32, 1000, _>(|step| (step as f32 - 100.0) / 700.0);
        assert_eq!(srgb_from_linear_each(&light), light.map(|light| u32::from(srgb_from_linear(light))));
    }

    #[test]
    fn light_out_of_range_is_clamped() {
        let bytes = [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1.0, 9.0, f32::INFINITY].map(srgb_from_linear);
        assert_eq!(bytes, [0, 0, 0, 0, 255, 255, 255]);
    }

    #[test]
    fn every_byte_begins_exactly_at_its_half_step() {
        for byte in 1..=255_u8 {
            let threshold = light_of_srgb((f64::from(byte) - 0.5) / 255.0) as f32;
            assert_eq!(srgb_from_linear(threshold), byte);
            assert_eq!(srgb_from_linear(threshold.next_down()), byte - 1);
        }
    }
}
