//! Points that fill the unit square evenly whatever their number, and are as random as random ones.

use super::sampling::mix;

/// One over 2 to the power of 32.
const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// Sobol's points in two dimensions, scrambled and shuffled as Owen proposed.
///
/// Of the first 2^k points every box of area 2^-k that is a product of two binary intervals holds one. Each purpose has
/// scrambles and an order of its own, so that points of different purposes go together without a pattern. A mean over
/// n points is unbiased, and for smooth functions its error falls nearly as n^-1.5.
///
/// # Source
/// Sobol 1967; Owen 1995; the hash in place of Owen's random tree: Laine and Karras 2011, constants of Burley 2020.
#[derive(Clone, Copy, Debug)]
pub struct SobolSequence {
    seed: u32,
}

impl SobolSequence {
    /// The sequence of a pixel, or of whatever is to have one of its own.
    pub fn new(seed: u64, index: u64) -> SobolSequence {
        SobolSequence { seed: fold(mix(mix(seed).wrapping_add(index))) }
    }

    /// Point `index` for a purpose, in 0..1 both.
    #[inline]
    pub fn point(self, index: u32, purpose: u64) -> [f64; 2] {
        let seed = fold(mix(mix(purpose).wrapping_add(u64::from(self.seed))));
        // Each bit by those above it: the first 2^k points stay together.
        let index = scrambled(index.reverse_bits(), seed).reverse_bits();
        // Both coordinates are made from their last bit to the first, as scrambling needs them.
        [scrambled(index, seed ^ 0x9e37_79b9), scrambled(sobol(index), seed ^ 0x7f4a_7c15)]
            .map(|x| f64::from(x.reverse_bits()) * UNIT)
    }

    /// Number `index` for a purpose, in 0..1.
    #[inline]
    pub fn number(self, index: u32, purpose: u64) -> f64 {
        self.point(index, purpose)[0]
    }
}

/// The second dimension of Sobol's sequence, bits in reverse: Pascal's triangle modulo 2.
///
/// Bit j is the sum of all bits i of the index for which i over j is odd, which by Lucas' theorem are those whose
/// number has all the bits of j: a sum over supersets, one bit of the numbers at a time.
#[inline]
fn sobol(index: u32) -> u32 {
    let steps = [(1, 0x5555_5555), (2, 0x3333_3333), (4, 0x0f0f_0f0f), (8, 0x00ff_00ff), (16, 0x0000_ffff_u32)];
    steps.into_iter().fold(index, |sum, (shift, without)| sum ^ (sum >> shift & without))
}

/// Scrambles bits, each by those below it only.
#[inline]
fn scrambled(bits: u32, seed: u32) -> u32 {
    let mut bits = bits.wrapping_add(seed);
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6_u32] {
        bits ^= bits.wrapping_mul(factor);
    }
    bits
}

fn fold(x: u64) -> u32 {
    (x >> 32) as u32 ^ x as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_dimension_has_the_direction_numbers_of_its_polynomial() {
        // The polynomial x + 1: each direction is the one before, added to itself a bit further on.
        let directions = std::iter::successors(Some(1_u32 << 31), |before| Some(before ^ (before >> 1)));
        for (bit, direction) in directions.take(32).enumerate() {
            assert_eq!(sobol(1 << bit).reverse_bits(), direction, "{bit}");
        }
    }

    #[test]
    fn every_elementary_box_holds_one_of_the_first_points() {
        for (seed, purpose) in [(0, 0), (1, 7), (99, 3)] {
            let sequence = SobolSequence::new(seed, 5);
            for k in 0..9 {
                for i in 0..=k {
                    let (columns, rows) = (1_usize << i, 1_usize << (k - i));
                    let mut boxes = vec![0; columns * rows];
                    for index in 0..1 << k {
                        let [x, y] = sequence.point(index, purpose);
                        assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                        boxes[(y * rows as f64) as usize * columns + (x * columns as f64) as usize] += 1;
                    }
                    assert!(boxes.iter().all(|count| *count == 1), "{k} {i}: {boxes:?}");
                }
            }
        }
    }

    #[test]
    fn the_mean_over_pixels_of_an_edge_is_its_area() {
        // The half-plane x + 2 y < 1 covers a quarter of the unit square.
        let inside = |&[x, y]: &[f64; 2]| x + 2.0 * y < 1.0;
        let hits: usize = (0..20_000)
            .map(|pixel| (0..4).map(|index| SobolSequence::new(3, pixel).point(index, 1)).filter(inside).count())
            .sum();
        let share = hits as f64 / 80_000.0;
        assert!((share - 0.25).abs() < 5.0 * (0.25f64 * 0.75 / 80_000.0).sqrt(), "{share}");
    }

    #[test]
    fn points_of_different_purposes_do_not_go_together() {
        let sequence = SobolSequence::new(1, 1);
        let count = 4096;
        let product: f64 =
            (0..count).map(|index| (sequence.number(index, 1) - 0.5) * (sequence.number(index, 2) - 0.5)).sum::<f64>();
        let correlation = product / f64::from(count) * 12.0;
        assert!(correlation.abs() < 5.0 / f64::from(count).sqrt(), "{correlation}");
    }
}
