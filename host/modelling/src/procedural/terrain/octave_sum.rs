//! Sums of octaves of noise, with their bounds.

use super::enclosure::Enclosure;
use super::four::Four;
use super::octaves::{LANES, MOST_BEND, MOST_NOISE, MOST_OCTAVES, MOST_SLOPE, NOISE_ROUNDING, NoiseLanes, Octaves};
use super::octaves::{PLACE_ROUNDING, WIDEST, remaining};
use glam::DVec2;

/// Octaves of noise, each times an amplitude.
#[derive(Clone, Debug)]
pub(super) struct OctaveSum {
    pub(super) octaves: Octaves,
    pub(super) amplitudes: [f64; MOST_OCTAVES],
    /// Sums over the octaves below each number: amplitude, amplitude times frequency, times its square.
    below: [[f64; 3]; MOST_OCTAVES + 1],
}

impl OctaveSum {
    pub(super) fn new(octaves: Octaves, amplitudes: [f64; MOST_OCTAVES]) -> OctaveSum {
        let mut below = [[0.0; 3]; MOST_OCTAVES + 1];
        for octave in 0..octaves.count() {
            let frequency = octaves.frequencies[octave];
            let sizes = [1.0, frequency, frequency * frequency].map(|power| power * amplitudes[octave].abs());
            below[octave + 1] = std::array::from_fn(|power| below[octave][power] + sizes[power]);
        }
        OctaveSum { octaves, amplitudes, below }
    }

    /// The sum over a disc. Octaves that are too fine to be known over it are bounded by what noise can be at the most.
    #[inline]
    pub(super) fn enclosure(&self, at: DVec2, radius: f64, footprint: f64) -> Enclosure {
        let frequencies = &self.octaves.frequencies;
        let count = self.octaves.count();
        let mut known = 0;
        while known < count && frequencies[known] * radius <= WIDEST {
            known += 1;
        }
        let weights = Weights::new(self, footprint);
        known = known.min(weights.count);
        let [value, x, z] = self.planes(at, known, &weights);
        let [[size, rate, bend], [all_sizes, all_rates, _]] = weights.sums(self, known);
        let far = at.x.abs() + at.y.abs();
        let rounding = NOISE_ROUNDING * size + PLACE_ROUNDING * rate * far;
        Enclosure {
            value,
            slope: DVec2::new(x, z),
            error: 0.5 * MOST_BEND * bend * radius * radius
                + MOST_NOISE * (all_sizes - size)
                + rounding
                + 4.0 * f64::EPSILON * all_sizes,
            slope_error: MOST_BEND * bend * radius
                + MOST_SLOPE * (all_rates - rate)
                + 8.0 * (NOISE_ROUNDING * all_rates + PLACE_ROUNDING * bend * far),
            radius,
        }
    }

    fn planes(&self, at: DVec2, known: usize, weights: &Weights) -> [f64; 3] {
        #[cfg(target_arch = "x86_64")]
        {
            // Products are not rounded together with sums: the result is the same on every processor.
            #[target_feature(enable = "avx2")]
            fn wide(sum: &OctaveSum, at: DVec2, known: usize, weights: &Weights) -> [f64; 3] {
                sum.planes_by_lanes(at, known, weights)
            }
            if self.octaves.is_wide() {
                // SAFETY: the processor was asked for what the function is compiled for.
                return unsafe { wide(self, at, known, weights) };
            }
        }
        self.planes_by_lanes(at, known, weights)
    }

    /// The sum at a place.
    pub(super) fn value(&self, at: DVec2, footprint: f64) -> f64 {
        let weights = Weights::new(self, footprint);
        #[cfg(target_arch = "x86_64")]
        {
            // Products are not rounded together with sums: the result is the same on every processor.
            #[target_feature(enable = "avx2")]
            fn wide(sum: &OctaveSum, at: DVec2, weights: &Weights) -> f64 {
                sum.value_by_lanes(at, weights)
            }
            if self.octaves.is_wide() {
                // SAFETY: the processor was asked for what the function is compiled for.
                return unsafe { wide(self, at, &weights) };
            }
        }
        self.value_by_lanes(at, &weights)
    }

    #[inline(always)]
    fn value_by_lanes(&self, at: DVec2, weights: &Weights) -> f64 {
        let mut sum = Four::default();
        for first in (0..weights.count).step_by(LANES) {
            sum = sum + self.weighted(first, weights.count, weights) * self.octaves.values(first, at);
        }
        sum.sum()
    }

    /// Amplitudes of the octaves `first..first + 4` times what is left of them; 0 from `end` on.
    #[inline(always)]
    fn weighted(&self, first: usize, end: usize, weights: &Weights) -> Four {
        let mut amplitudes = Four::of(&self.amplitudes, first);
        if first + LANES > end.min(weights.full) {
            for (octave, amplitude) in (first..).zip(&mut amplitudes.0) {
                *amplitude = if octave < end { *amplitude * weights.of(octave) } else { 0.0 };
            }
        }
        amplitudes
    }

    #[inline(always)]
    fn planes_by_lanes(&self, at: DVec2, known: usize, weights: &Weights) -> [f64; 3] {
        let mut sums = NoiseLanes::default();
        for first in (0..known).step_by(LANES) {
            let noise = self.octaves.noise(first, at);
            let amplitudes = self.weighted(first, known, weights);
            sums.value = sums.value + amplitudes * noise.value;
            let [x, z] = noise.slopes;
            sums.slopes = [sums.slopes[0] + amplitudes * x, sums.slopes[1] + amplitudes * z];
        }
        [sums.value.sum(), sums.slopes[0].sum(), sums.slopes[1].sum()]
    }
}

/// How much is left of each octave at a footprint.
struct Weights {
    /// Octaves below this number are there as a whole.
    full: usize,
    /// Nothing is left of this octave and those above.
    count: usize,
    partial: [f64; Weights::MOST],
}

impl Weights {
    /// Most octaves of which a part is left: frequencies rise by a quarter at the least.
    const MOST: usize = 8;

    fn new(sum: &OctaveSum, footprint: f64) -> Weights {
        let mut weights = Weights { full: sum.octaves.count(), count: sum.octaves.count(), partial: [0.0; Self::MOST] };
        if footprint > 0.0 {
            let left = |octave: &usize| remaining(footprint * sum.octaves.frequencies[*octave]);
            weights.full = (0..weights.count).find(|octave| left(octave) < 1.0).unwrap_or(weights.count);
            weights.count = (weights.full..weights.count).find(|octave| left(octave) == 0.0).unwrap_or(weights.count);
            for octave in weights.full..weights.count {
                weights.partial[(octave - weights.full).min(Self::MOST - 1)] = left(&octave);
            }
        }
        weights
    }

    #[inline(always)]
    fn of(&self, octave: usize) -> f64 {
        if octave < self.full { 1.0 } else { self.partial[(octave - self.full).min(Self::MOST - 1)] }
    }

    /// Sums over the octaves below a number, and over all.
    fn sums(&self, sum: &OctaveSum, known: usize) -> [[f64; 3]; 2] {
        let up_to = |number: usize| {
            let mut sums = sum.below[number.min(self.full)];
            for octave in self.full..number {
                let part = |power: usize| sum.below[octave + 1][power] - sum.below[octave][power];
                for (power, sum) in sums.iter_mut().enumerate() {
                    *sum += self.of(octave) * part(power);
                }
            }
            sums
        };
        [up_to(known), up_to(self.count)]
    }
}
