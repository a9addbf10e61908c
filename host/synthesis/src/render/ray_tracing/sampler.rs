//! The random numbers of a sample, by dimension: what one purpose needs does not shift those of another.

use crate::numeric::sequence::SobolSequence;
use crate::picture::Filter;

/// A dimension of the sampler: what a random number is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub(super) enum SampleDimension {
    /// Place in the pixel.
    Pixel,
    /// Place on the lens.
    Lens,
    /// The wavelength set, and the lane that is left where wavelengths separate.
    Wavelengths,
    /// The lobe that continues the path.
    Choice,
    /// Russian roulette of a faint path segment.
    Survival,
    /// The direction of a BSDF sample.
    Direction,
    /// Points of lights: one dimension for each from here on.
    Lights,
    /// The time of the sample; beyond all lights.
    Time = 1 << 31,
}

/// The random numbers of one sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathSampler {
    sequence: SobolSequence,
    index: u32,
    of: u32,
    /// The time of the sample, from the middle of the time in which the shutter is open.
    pub(super) time: f64,
}

impl PathSampler {
    /// - `seed`: of the picture. `pixel`: its number. `index`: of the sample, of `of` at the most.
    pub(super) fn new(seed: u64, pixel: u64, index: u32, of: u32) -> PathSampler {
        PathSampler { sequence: SobolSequence::new(seed, pixel), index, of, time: 0.0 }
    }

    /// The sampler at a time from those in which a shutter is open for so long; a single sample in their middle.
    pub(super) fn at_random_time(self, shutter: f64) -> PathSampler {
        let part = if self.of <= 1 { 0.5 } else { self.point(SampleDimension::Time)[0] };
        PathSampler { time: (part - 0.5) * shutter, ..self }
    }

    /// Where the sample lies from the left upper corner of its pixel, and its weight by a filter; a single one in the
    /// middle.
    pub(super) fn position(&self, filter: Filter) -> ([f64; 2], f64) {
        if self.of <= 1 {
            return ([0.5; 2], 1.0);
        }
        filter.sample(self.sequence.point(self.index, SampleDimension::Pixel as u64))
    }

    /// A point of the unit square for the sample as a whole.
    pub(super) fn point(&self, purpose: SampleDimension) -> [f64; 2] {
        self.sequence.point(self.index, purpose as u64)
    }

    /// A point of the unit square for a path segment of the sample.
    ///
    /// - `segment`: its number, above 0, unlike that of all other path segments. `more`: which of several for the same
    ///   purpose.
    pub(super) fn for_segment(&self, segment: u32, purpose: SampleDimension, more: u32) -> [f64; 2] {
        self.for_one_of_several(segment, purpose, more, [0, 1])
    }

    /// One of several points for the same: they are as far from each other, and from those of other samples, as those
    /// of as many samples are.
    pub(super) fn for_one_of_several(
        &self,
        segment: u32,
        purpose: SampleDimension,
        more: u32,
        [which, of]: [u32; 2],
    ) -> [f64; 2] {
        let index = self.index.wrapping_mul(of).wrapping_add(which);
        self.sequence.point(index, u64::from(segment) << 32 | (purpose as u64 + u64::from(more)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_points_of_a_sample_are_one_in_each_cell() {
        for (index, of) in [(0, 16), (3, 16), (0, 1)] {
            // Of one sample, and of sixteen that have one each.
            let points = (0..16).map(|k| match of {
                16 => PathSampler::new(5, 7, index, 4).for_one_of_several(2, SampleDimension::Lights, 1, [k, of]),
                _ => PathSampler::new(5, 7, k, 16).for_segment(2, SampleDimension::Lights, 1),
            });
            let mut cells: Vec<u32> = points.map(|[x, y]| (x * 4.0) as u32 * 4 + (y * 4.0) as u32).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..16).collect::<Vec<u32>>(), "{index} {of}");
        }
    }
}
