//! Where in a pixel the samples lie.

/// 1 / golden ratio: its multiples modulo 1 are spread most evenly.
const INVERSE_GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Positions of the samples in a pixel, 0..1 in both directions.
///
/// One sample lies in the centre. More are the Fibonacci-like lattice ((i + 1/2)/n, i/phi), shifted by a random
/// vector of the pixel and wrapped around: each of n equal strips holds one sample in either direction (nearly so in
/// the second), and the mean is unbiased, since every shifted point is uniform over the pixel.
///
/// - `samples`: how many, n.
/// - `seed`: of the picture.
/// - `pixel`: number of the pixel.
pub(super) fn positions(samples: u32, seed: u64, pixel: u64) -> impl Iterator<Item = [f64; 2]> {
    let shift = if samples <= 1 {
        None
    } else {
        let bits = mix(mix(seed).wrapping_add(pixel));
        Some([unit(bits), unit(mix(bits))])
    };
    (0..samples.max(1)).map(move |i| match shift {
        None => [0.5, 0.5],
        Some([dx, dy]) => {
            let x = (f64::from(i) + 0.5) / f64::from(samples) + dx;
            let y = f64::from(i) * INVERSE_GOLDEN + dy;
            [x - x.floor(), y - y.floor()]
        }
    })
}

/// A number in 0..1 from the upper 53 bits.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// Scrambles 64 bits: each input bit flips about half of the output bits.
///
/// # Source
/// The finaliser of SplitMix64, Steele, Lea and Flood 2014.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_the_centre_and_all_lie_in_the_pixel() {
        assert_eq!(positions(1, 9, 77).collect::<Vec<_>>(), [[0.5, 0.5]]);
        for n in [2, 3, 7, 16, 1000] {
            let all: Vec<_> = positions(n, 5, 3).collect();
            assert_eq!(all.len(), n as usize);
            assert!(all.iter().flatten().all(|c| (0.0..1.0).contains(c)));
        }
    }

    #[test]
    fn each_strip_holds_one_sample() {
        for n in [5u32, 16, 64] {
            let mut strips = vec![0; n as usize];
            let all: Vec<_> = positions(n, 1, 12).collect();
            let least = all.iter().map(|p| p[0]).fold(1.0, f64::min);
            all.iter().for_each(|p| strips[((p[0] - least) * f64::from(n) + 0.5) as usize] += 1);
            assert_eq!(strips, vec![1; n as usize]);
        }
    }

    #[test]
    fn the_mean_over_pixels_of_an_edge_is_its_area() {
        // The half-plane x + 2 y < 1 covers a quarter of the unit square.
        let inside = |p: &[f64; 2]| p[0] + 2.0 * p[1] < 1.0;
        let hits: usize = (0..20_000).map(|pixel| positions(4, 3, pixel).filter(inside).count()).sum();
        let share = hits as f64 / 80_000.0;
        assert!((share - 0.25).abs() < 5.0 * (0.25f64 * 0.75 / 80_000.0).sqrt(), "{share}");
    }
}
