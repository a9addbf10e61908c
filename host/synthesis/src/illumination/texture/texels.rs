//! Fractions of light of many pixels, in as few bytes as their precision needs.

use glam::DVec3;
use protocol::raster::light_of_srgb;
use std::sync::LazyLock;

/// The number of sixteen bits for a fraction of 1.
const WHOLE: f64 = 65_535.0;
/// Bits of the bands of a packed pixel, and where each begins.
const PACKED: [(u32, u32); 3] = [(11, 0), (11, 11), (10, 22)];
/// Most pixels of three bands that are held in sixteen bits each: those of 1024 x 1024.
const MOST_WORDS: usize = 1 << 20;

/// Light of each byte of sRGB.
static LIGHT: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|byte| light_of_srgb(byte as f64 / 255.0)));
/// Numbers of each byte.
static NUMBERS: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|byte| byte as f64 / 255.0));

/// Fractions, 0..=1 in three bands, of many pixels.
#[derive(Clone, Debug)]
pub(super) enum Texels {
    /// Three bytes, whose fractions are in a table.
    Bytes {
        bytes: Vec<[u8; 3]>,
        /// The fraction of each byte.
        table: &'static [f64; 256],
    },
    /// One number of sixteen bits that stands for all bands.
    Grey(Vec<u16>),
    /// Three numbers of sixteen bits.
    Words(Vec<[u16; 3]>),
    /// Eleven bits of red, eleven of green and ten of blue, of the square roots of the fractions: closer together where
    /// it is dark.
    Packed(Vec<u32>),
}

/// How the pixels of an image are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TexelStorage {
    /// Bytes of sRGB, exactly.
    Light,
    /// Bytes of numbers, exactly.
    Numbers,
    /// One number for all bands, rounded to 1/65535.
    Grey,
    /// Three bands, rounded to 1/65535; those of large images to 1/1000 of what they are, or 1/4000000 where that is
    /// more.
    Bands,
}

impl Texels {
    /// Black pixels.
    pub(super) fn new(kind: TexelStorage, count: usize) -> Texels {
        match kind {
            TexelStorage::Light => Texels::Bytes { bytes: vec![[0; 3]; count], table: &LIGHT },
            TexelStorage::Numbers => Texels::Bytes { bytes: vec![[0; 3]; count], table: &NUMBERS },
            TexelStorage::Grey => Texels::Grey(vec![0; count]),
            TexelStorage::Bands if count <= MOST_WORDS => Texels::Words(vec![[0; 3]; count]),
            TexelStorage::Bands => Texels::Packed(vec![0; count]),
        }
    }

    /// Bytes that so many pixels take.
    pub(super) fn bytes_of(kind: TexelStorage, count: usize) -> usize {
        count
            * match kind {
                TexelStorage::Light | TexelStorage::Numbers => size_of::<[u8; 3]>(),
                TexelStorage::Grey => size_of::<u16>(),
                TexelStorage::Bands if count <= MOST_WORDS => size_of::<[u16; 3]>(),
                TexelStorage::Bands => size_of::<u32>(),
            }
    }

    /// Black pixels for means of these, of which there are fewer. Bytes are too coarse for means.
    pub(super) fn for_means(&self, count: usize) -> Texels {
        match self {
            Texels::Grey(_) => Texels::new(TexelStorage::Grey, count),
            Texels::Packed(_) => Texels::Packed(vec![0; count]),
            Texels::Bytes { .. } | Texels::Words(_) => Texels::new(TexelStorage::Bands, count),
        }
    }

    #[cfg(test)]
    pub(super) fn bytes(&self) -> usize {
        match self {
            Texels::Bytes { bytes, .. } => size_of_val(&bytes[..]),
            Texels::Grey(words) => size_of_val(&words[..]),
            Texels::Words(words) => size_of_val(&words[..]),
            Texels::Packed(words) => size_of_val(&words[..]),
        }
    }

    /// The fractions of a pixel.
    pub(super) fn at(&self, index: usize) -> DVec3 {
        match self {
            Texels::Bytes { bytes, table } => DVec3::from_array(bytes[index].map(|byte| table[usize::from(byte)])),
            Texels::Grey(words) => DVec3::splat(f64::from(words[index]) / WHOLE),
            Texels::Words(words) => DVec3::from_array(words[index].map(|word| f64::from(word) / WHOLE)),
            Texels::Packed(words) => DVec3::from_array(PACKED.map(|(bits, begin)| {
                let most = (1 << bits) - 1;
                let root = f64::from(words[index] >> begin & most) / f64::from(most);
                root * root
            })),
        }
    }

    /// Sets a pixel to fractions, of which what is below 0 or above 1 is cut off. Bytes take the nearest fraction of
    /// their table.
    pub(super) fn set(&mut self, index: usize, fractions: DVec3) {
        let fractions = fractions.clamp(DVec3::ZERO, DVec3::ONE);
        match self {
            Texels::Bytes { bytes, table } => {
                bytes[index] = fractions.to_array().map(|fraction| nearest(table, fraction))
            }
            Texels::Grey(words) => words[index] = word(fractions.x),
            Texels::Words(words) => words[index] = fractions.to_array().map(word),
            Texels::Packed(words) => {
                let parts = PACKED.iter().zip(fractions.to_array());
                words[index] = parts.fold(0, |packed, ((bits, begin), fraction)| {
                    let most = f64::from((1u32 << bits) - 1);
                    packed | ((fraction.sqrt() * most).round() as u32) << begin
                });
            }
        }
    }

    /// Sets a pixel to bytes, where bytes are held.
    pub(super) fn set_bytes(&mut self, index: usize, to: [u8; 3]) {
        match self {
            Texels::Bytes { bytes, .. } => bytes[index] = to,
            other => other.set(index, DVec3::from_array(to.map(|byte| LIGHT[usize::from(byte)]))),
        }
    }

    /// The pixels in sixteen bits a band.
    pub(super) fn words(&self) -> impl Iterator<Item = [u16; 3]> + '_ {
        let count = match self {
            Texels::Bytes { bytes, .. } => bytes.len(),
            Texels::Grey(words) => words.len(),
            Texels::Words(words) => words.len(),
            Texels::Packed(words) => words.len(),
        };
        (0..count).map(|index| self.at(index).to_array().map(word))
    }

    /// Pixels of sixteen bits a band, in as few bytes as hold them exactly, or as large images are held.
    pub(super) fn of_words(words: Vec<[u16; 3]>) -> Texels {
        for table in [&*LIGHT, &*NUMBERS] {
            let mut codes = words.iter().map(|pixel| {
                let code = pixel.map(|word| nearest(table, f64::from(word) / WHOLE));
                let is_exact = code.map(|byte| word(table[usize::from(byte)])) == *pixel;
                is_exact.then_some(code)
            });
            // Most images of another kind show it at their first pixels.
            if codes.clone().all(|code| code.is_some()) {
                return Texels::Bytes { bytes: codes.by_ref().flatten().collect(), table };
            }
        }
        if words.iter().all(|[r, g, b]| r == g && g == b) {
            return Texels::Grey(words.into_iter().map(|[r, ..]| r).collect());
        }
        if words.len() <= MOST_WORDS {
            return Texels::Words(words);
        }
        let mut packed = Texels::new(TexelStorage::Bands, words.len());
        for (index, pixel) in words.iter().enumerate() {
            packed.set(index, DVec3::from_array(pixel.map(|word| f64::from(word) / WHOLE)));
        }
        packed
    }
}

/// A fraction in sixteen bits.
fn word(fraction: f64) -> u16 {
    (fraction * WHOLE).round() as u16
}

/// The byte whose fraction is nearest.
fn nearest(table: &[f64; 256], fraction: f64) -> u8 {
    let above = table.partition_point(|found| *found < fraction).min(255);
    let below = above.saturating_sub(1);
    if table[above] - fraction < fraction - table[below] { above as u8 } else { below as u8 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_held_exactly_and_found_again_in_words() {
        for kind in [TexelStorage::Light, TexelStorage::Numbers] {
            let mut texels = Texels::new(kind, 256);
            (0..=255).for_each(|byte: u8| texels.set_bytes(usize::from(byte), [byte, 255 - byte, 7]));
            let again = Texels::of_words(texels.words().collect());
            assert_eq!(again.bytes(), 256 * 3);
            for index in 0..256 {
                assert_eq!(again.at(index), texels.at(index));
                let mut set = Texels::new(kind, 1);
                set.set(0, texels.at(index));
                assert_eq!(set.at(0), texels.at(index), "{kind:?} {index}");
            }
        }
    }

    #[test]
    fn each_kind_rounds_as_finely_as_it_says() {
        let fractions = (0..4096).map(|i| DVec3::new(f64::from(i) / 4095.0, f64::from(i * i) / 4095f64.powi(2), 0.3));
        let mut large = Texels::Packed(vec![0; 1]);
        for (kind, most) in
            [(TexelStorage::Light, 0.005), (TexelStorage::Numbers, 0.002), (TexelStorage::Bands, 0.5001 / WHOLE)]
        {
            let mut texels = Texels::new(kind, 1);
            for fraction in fractions.clone() {
                texels.set(0, fraction);
                assert!((texels.at(0) - fraction).abs().max_element() <= most, "{kind:?} {fraction}");
            }
        }
        for fraction in fractions {
            large.set(0, fraction);
            let off = (large.at(0) - fraction).abs();
            let most = fraction.map(|fraction| (fraction / 900.0).max(fraction.sqrt() / 900.0));
            assert!(off.cmple(most.max(DVec3::splat(2.5e-7))).all(), "{fraction} {off}");
        }
        let mut grey = Texels::new(TexelStorage::Grey, 1);
        grey.set(0, DVec3::splat(0.25));
        assert!((grey.at(0) - 0.25).abs().max_element() < 1.0 / WHOLE);
        grey.set(0, DVec3::splat(f64::INFINITY));
        assert_eq!(grey.at(0), DVec3::ONE);
    }

    #[test]
    fn words_are_kept_as_they_are_and_grey_ones_once() {
        let words = vec![[1, 2, 3], [65_535, 0, 12_345]];
        assert_eq!(Texels::of_words(words.clone()).words().collect::<Vec<_>>(), words);
        let grey = Texels::of_words(vec![[1; 3], [12_345; 3]]);
        assert_eq!((grey.bytes(), grey.words().nth(1)), (4, Some([12_345; 3])));
    }
}
