//! Gradient noise of the plane at several frequencies, four at a time.

use super::error::TerrainError;
use super::four::Four;
use crate::numeric::sampling::mix;
use glam::DVec2;

/// Most octaves of a fractal.
pub const MOST_OCTAVES: usize = 32;
/// Octaves that are computed at once.
pub(super) const LANES: usize = 4;
/// The largest lattice coordinate: doubles tell places within a cell to a 512th there.
pub(super) const MOST_COORDINATE: f64 = (1_u64 << 44) as f64;

/// The noise lies between -1 and 1: the sum over the corners of a cell of weight times distance, whose greatest value
/// is in its middle, is 1 / sqrt 2, and noise is sqrt 2 times that.
pub(super) const MOST_NOISE: f64 = 1.000_000_1;
/// No slope of the noise is longer, lattice spacings taken as 1.
pub(super) const MOST_SLOPE: f64 = 2.93;
/// No second derivative of the noise along a line is larger.
pub(super) const MOST_BEND: f64 = 13.08;
/// Mean of the absolute value of the noise.
pub(super) const MEAN_ABSOLUTE: f64 = 0.25;

/// What rounding makes of noise between -1 and 1, near the origin.
pub(super) const NOISE_ROUNDING: f64 = 256.0 * f64::EPSILON;
/// What it makes of it for each lattice spacing of distance from the origin.
pub(super) const PLACE_ROUNDING: f64 = 12.0 * f64::EPSILON;
/// Noise over discs of more lattice spacings is bounded no better by computing it.
pub(super) const WIDEST: f64 = 0.33;

/// The directions of the gradients, sqrt 2 long: sixteen, evenly around, none along an axis or a diagonal.
const GRADIENTS: [[f64; 2]; 16] = {
    const COSINES: [f64; 4] =
        [1.387_039_845_322_147_6, 1.175_875_602_419_358_8, 0.785_694_958_387_102_2, 0.275_899_379_282_943_1];
    let mut gradients = [[0.0; 2]; 16];
    let mut k = 0;
    while k < 16 {
        let (x, z) = (COSINES[k % 4], COSINES[3 - k % 4]);
        gradients[k] = [if k & 4 == 0 { x } else { -x }, if k & 8 == 0 { z } else { -z }];
        k += 1;
    }
    gradients
};
/// Turns of the lattices of one octave after the other: 3-4-5 triangles, whose sides are exact.
const TURN: DVec2 = DVec2::new(0.8, 0.6);
/// What a step along x and z adds to the number of a lattice point before it is mixed.
const STEPS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03];

/// The lattices of the octaves of a fractal: octave i has the frequency `lacunarity^i / scale`, a turn and a shift of
/// its own, so that neither their axes nor their zeros add up.
#[derive(Clone, Debug)]
pub(super) struct Octaves {
    count: usize,
    /// Whether the processor has AVX2.
    is_wide: bool,
    /// Lattice points in a unit of length.
    pub(super) frequencies: [f64; MOST_OCTAVES],
    cosines: [f64; MOST_OCTAVES],
    sines: [f64; MOST_OCTAVES],
    shifts: [[f64; MOST_OCTAVES]; 2],
    seeds: [u64; MOST_OCTAVES],
}

/// Noise of four octaves at a place, and its slopes along x and z.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NoiseLanes {
    pub(super) value: Four,
    pub(super) slopes: [Four; 2],
}

/// The lattice cell of an octave, as the reference asks for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct NoiseLattice {
    /// Lattice coordinates are (c x - s z, s x + c z) + shift.
    pub(super) cosine: f64,
    pub(super) sine: f64,
    pub(super) shift: DVec2,
    seed: u64,
}

impl Octaves {
    /// Makes the lattices.
    ///
    /// - `reach`: the largest coordinate at which they are asked.
    ///
    /// # Errors
    /// [`TerrainError::TooFine`] where doubles cannot tell places within a cell.
    pub(super) fn new(count: u32, scale: f64, lacunarity: f64, seed: u64, reach: f64) -> Result<Octaves, TerrainError> {
        const SHIFTS: f64 = 16.0;
        let mut octaves = Octaves {
            count: count as usize,
            is_wide: has_wide_instructions(),
            frequencies: [0.0; MOST_OCTAVES],
            cosines: [0.0; MOST_OCTAVES],
            sines: [0.0; MOST_OCTAVES],
            shifts: [[0.0; MOST_OCTAVES]; 2],
            seeds: [0; MOST_OCTAVES],
        };
        let (mut frequency, mut turn) = (1.0 / scale, DVec2::X);
        for octave in 0..octaves.count {
            // Written so that what is not a number ends here.
            let is_fine = frequency * reach < MOST_COORDINATE && frequency > 0.0;
            if !is_fine {
                return Err(TerrainError::TooFine { octave });
            }
            let seed = mix(seed ^ mix(octave as u64));
            octaves.frequencies[octave] = frequency;
            octaves.cosines[octave] = frequency * turn.x;
            octaves.sines[octave] = frequency * turn.y;
            for (axis, shifts) in octaves.shifts.iter_mut().enumerate() {
                shifts[octave] = (mix(seed ^ (axis as u64 + 1)) >> 11) as f64 / (1_u64 << 53) as f64 * SHIFTS;
            }
            octaves.seeds[octave] = seed;
            frequency *= lacunarity;
            turn = TURN.rotate(turn);
        }
        Ok(octaves)
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn lattice(&self, octave: usize) -> NoiseLattice {
        NoiseLattice {
            cosine: self.cosines[octave],
            sine: self.sines[octave],
            shift: DVec2::new(self.shifts[0][octave], self.shifts[1][octave]),
            seed: self.seeds[octave],
        }
    }

    /// Whether there are wide instructions for it.
    #[inline(always)]
    pub(super) fn is_wide(&self) -> bool {
        self.is_wide
    }

    /// Noise of the octaves `first..first + 4`, with the widest instructions; those beyond the last have no meaning.
    pub(super) fn noise_at(&self, first: usize, at: DVec2) -> NoiseLanes {
        #[cfg(target_arch = "x86_64")]
        {
            // Products are not rounded together with sums: the result is the same on every processor.
            #[target_feature(enable = "avx2")]
            fn wide(octaves: &Octaves, first: usize, at: DVec2) -> NoiseLanes {
                octaves.noise(first, at)
            }
            if self.is_wide {
                // SAFETY: the processor was asked for what the function is compiled for.
                return unsafe { wide(self, first, at) };
            }
        }
        self.noise(first, at)
    }

    /// Noise of the octaves `first..first + 4` without its slopes, with the widest instructions; those beyond the last
    /// have no meaning.
    pub(super) fn values_at(&self, first: usize, at: DVec2) -> Four {
        #[cfg(target_arch = "x86_64")]
        {
            // Products are not rounded together with sums: the result is the same on every processor.
            #[target_feature(enable = "avx2")]
            fn wide(octaves: &Octaves, first: usize, at: DVec2) -> Four {
                octaves.values(first, at)
            }
            if self.is_wide {
                // SAFETY: the processor was asked for what the function is compiled for.
                return unsafe { wide(self, first, at) };
            }
        }
        self.values(first, at)
    }

    /// Noise of the octaves `first..first + 4` without its slopes; those beyond the last have no meaning.
    #[inline(always)]
    pub(super) fn values(&self, first: usize, at: DVec2) -> Four {
        let (_, gradients, place) = self.cells(first, at);
        interpolated(gradients, place)[0]
    }

    /// Noise of the octaves `first..first + 4`; those beyond the last have no meaning.
    #[inline(always)]
    pub(super) fn noise(&self, first: usize, at: DVec2) -> NoiseLanes {
        let ([cosines, sines], gradients, place) = self.cells(first, at);
        let [value, along, across] = interpolated(gradients, place);
        NoiseLanes { value, slopes: [cosines * along + sines * across, cosines * across - sines * along] }
    }

    /// The cells of the octaves `first..first + 4` in which a place is: cosines and sines of their lattices, gradients
    /// at the corners, the place in each.
    #[inline(always)]
    fn cells(&self, first: usize, at: DVec2) -> ([Four; 2], [[Four; 2]; 4], [Four; 2]) {
        let (cosines, sines) = (Four::of(&self.cosines, first), Four::of(&self.sines, first));
        let x = cosines * at.x - sines * at.y + Four::of(&self.shifts[0], first);
        let z = sines * at.x + cosines * at.y + Four::of(&self.shifts[1], first);
        let ((columns, x), (rows, z)) = (cells_of(x), cells_of(z));
        let number = |lane: usize| number_of([columns[lane], rows[lane]], self.seeds[first + lane]);
        let numbers = [number(0), number(1), number(2), number(3)];
        let gradients = [
            gradients_at(&numbers, 0),
            gradients_at(&numbers, 1),
            gradients_at(&numbers, 2),
            gradients_at(&numbers, 3),
        ];
        ([cosines, sines], gradients, [x, z])
    }
}

impl NoiseLattice {
    /// Gradients at the corners of a cell: (0, 0), (1, 0), (0, 1), (1, 1).
    pub(super) fn gradients(&self, cell: [i64; 2]) -> [[f64; 2]; 4] {
        let number = number_of(cell.map(|axis| axis as u64), self.seed);
        std::array::from_fn(|corner| gradient_of(at_corner(number, corner)))
    }
}

fn has_wide_instructions() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    false
}

/// How much is left of noise whose mean is taken over a part of its lattice spacing: all below a fifth of it, nothing
/// above three quarters.
///
/// # Source
/// Apodaca and Gritz 2000, Advanced RenderMan, filtered noise.
pub(super) fn remaining(width: f64) -> f64 {
    let t = ((width - 0.2) / (0.75 - 0.2)).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// The cells of lattice coordinates, and where they are within, 0..=1 but for rounding: a coordinate between two cells
/// may be in either.
#[inline(always)]
fn cells_of(coordinates: Four) -> ([u64; LANES], Four) {
    // Numbers of this size have no places behind the point: adding it rounds to a whole number, which is in the low
    // bits.
    const WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;
    let moved = coordinates + -0.5 + WHOLE;
    let cell = |lane: usize| moved.0[lane].to_bits().wrapping_sub(WHOLE.to_bits());
    ([cell(0), cell(1), cell(2), cell(3)], coordinates - (moved + -WHOLE))
}

#[inline(always)]
fn number_of(cell: [u64; 2], seed: u64) -> u64 {
    cell[0].wrapping_mul(STEPS[0]).wrapping_add(cell[1].wrapping_mul(STEPS[1])).wrapping_add(seed)
}

#[inline(always)]
fn at_corner(number: u64, corner: usize) -> u64 {
    const OFFSETS: [u64; 4] = [0, STEPS[0], STEPS[1], STEPS[0].wrapping_add(STEPS[1])];
    number.wrapping_add(OFFSETS[corner])
}

/// The gradients at one corner of four cells.
#[inline(always)]
fn gradients_at(numbers: &[u64; LANES], corner: usize) -> [Four; 2] {
    let of = |lane: usize| gradient_of(at_corner(numbers[lane], corner));
    let (a, b, c, d) = (of(0), of(1), of(2), of(3));
    [Four([a[0], b[0], c[0], d[0]]), Four([a[1], b[1], c[1], d[1]])]
}

/// The gradient of a lattice point: the number is mixed as far as its first four bits need it.
#[inline(always)]
fn gradient_of(number: u64) -> [f64; 2] {
    let x = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    GRADIENTS[(x >> 60) as usize]
}

/// Noise within a cell, and its slopes along the lattice.
///
/// # Source
/// Perlin 2002, improving noise: the polynomial of fifth degree.
#[inline(always)]
fn interpolated([g00, g10, g01, g11]: [[Four; 2]; 4], [x, z]: [Four; 2]) -> [Four; 3] {
    let fade = |t: Four| t * t * t * (t * (t * 6.0 + -15.0) + 10.0);
    let fade_slope = |t: Four| t * t * (t * (t + -2.0) + 1.0) * 30.0;
    let (u, v, du, dv) = (fade(x), fade(z), fade_slope(x), fade_slope(z));
    let (x1, z1) = (x + -1.0, z + -1.0);
    let (n00, n10) = (g00[0] * x + g00[1] * z, g10[0] * x1 + g10[1] * z);
    let (n01, n11) = (g01[0] * x + g01[1] * z1, g11[0] * x1 + g11[1] * z1);
    let (a, b) = (n10 - n00, n01 - n00);
    let c = (n11 - n01) - a;
    let uv = u * v;
    let mixed = |k: usize| {
        let (a, b) = (g10[k] - g00[k], g01[k] - g00[k]);
        g00[k] + u * a + v * b + uv * ((g11[k] - g01[k]) - a)
    };
    [n00 + u * a + v * b + uv * c, mixed(0) + du * (a + v * c), mixed(1) + dv * (b + u * c)]
}
