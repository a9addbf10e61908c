//! Guiding of samples: which lights, and which parts of them, bring light through an opening, and from which directions
//! other light comes through it.
//!
//! Of the sky that is above a point of a small window, hardly any is seen through it by the room behind. So a few samples
//! tell first where the light comes from, and most of the others are taken there.
//!
//! # Source
//! Primary sample space guiding by a histogram: Guo, Bauszat, Bikker and Eisemann 2018.

use serde::{Deserialize, Serialize};

/// Cells of all lights together, at the most, unless there are more lights.
const CELLS: usize = 1 << 12;
/// The part of samples that are spread over all lights alike.
const SPREAD: f64 = 0.25;
/// The part of a mean square that each cell beside it has, too.
const BESIDE: f64 = 0.25;

/// A distribution of light samples over lights and the unit square of each, constant in each cell.
#[derive(Clone, Debug)]
pub(super) struct SampleGuide {
    side: usize,
    /// The probability of each cell, and of it with all before it.
    part: Vec<f64>,
    cumulative: Vec<f64>,
}

/// A sample of a light.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct GuidedSample {
    /// The number of the light.
    pub(super) light: usize,
    /// A point of the unit square.
    pub(super) uniform: [f64; 2],
    /// One over the density: of a light and in the unit square.
    pub(super) weight: f64,
    /// In which it is.
    pub(super) cell: usize,
}

impl SampleGuide {
    /// All lights, and all that is of them, alike.
    ///
    /// - `lights`: how many, at least 1. `side`: cells of each along a side at the most, at least 1.
    pub(super) fn even(lights: usize, side: usize) -> SampleGuide {
        let side = ((CELLS / lights) as f64).sqrt().clamp(1.0, side as f64) as usize;
        SampleGuide::of(side, vec![1.0; lights * side * side])
    }

    /// A guide to where these samples found light; an even one where they found none.
    ///
    /// - `found`: samples of this guide with what they brought, of any unit; those that brought nothing may lack.
    pub(super) fn guided(&self, found: impl IntoIterator<Item = (GuidedSample, f64)>) -> SampleGuide {
        // The variance is least where the density is the root of the mean square of what samples bring.
        let mut squares = vec![0.0; self.part.len()];
        for (sample, brought) in found {
            squares[sample.cell] += (brought * sample.weight).powi(2) * self.part[sample.cell];
        }
        let roots: Vec<f64> = (0..squares.len()).map(|cell| self.with_neighbours(&squares, cell).sqrt()).collect();
        let all: f64 = roots.iter().sum();
        if !(all > 0.0 && all.is_finite()) {
            return self.clone();
        }
        let even = SPREAD / roots.len() as f64;
        SampleGuide::of(self.side, roots.into_iter().map(|root| even + (1.0 - SPREAD) * root / all).collect())
    }

    /// A value of a cell with a part of those beside it: where light comes through a small part of a cell, few samples of
    /// the cell itself may miss it.
    fn with_neighbours(&self, values: &[f64], cell: usize) -> f64 {
        let (x, y) = (cell % self.side, cell / self.side % self.side);
        let beside = [
            (x > 0).then(|| cell - 1),
            (x + 1 < self.side).then_some(cell + 1),
            (y > 0).then(|| cell - self.side),
            (y + 1 < self.side).then_some(cell + self.side),
        ];
        values[cell] + BESIDE * beside.into_iter().flatten().map(|cell| values[cell]).sum::<f64>()
    }

    fn of(side: usize, mut part: Vec<f64>) -> SampleGuide {
        let all: f64 = part.iter().sum();
        part.iter_mut().for_each(|part| *part /= all);
        let mut sum = 0.0;
        let cumulative = part.iter().map(|part| {
            sum += part;
            sum
        });
        SampleGuide { side, cumulative: cumulative.collect(), part }
    }

    /// - `uniform`: three numbers, each uniform in 0..1: which cell, and where in it.
    pub(super) fn sample(&self, [which, u, v]: [f64; 3]) -> GuidedSample {
        let cell = self.cumulative.partition_point(|sum| *sum <= which).min(self.part.len() - 1);
        let of_light = self.side * self.side;
        let (light, place) = (cell / of_light, cell % of_light);
        let side = self.side as f64;
        let uniform = [((place % self.side) as f64 + u) / side, ((place / self.side) as f64 + v) / side];
        GuidedSample { light, uniform, weight: (of_light as f64 * self.part[cell]).recip(), cell }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sequence::SobolSequence;

    #[test]
    fn guided_samples_have_the_same_mean_and_less_variance() {
        // Of three lights one shines, through a small part of its square.
        let brings = |sample: &GuidedSample| {
            let [u, v] = sample.uniform;
            if sample.light == 1 && u < 0.1 && v > 0.85 { 1.0 + u } else { 0.0 }
        };
        let expected = 0.15 * (0.1 + 0.5 * 0.1 * 0.1);
        let sequence = SobolSequence::new(3, 1);
        let all = |guide: &SampleGuide, count: u32| -> (Vec<(GuidedSample, f64)>, f64, f64) {
            let sample = |index: u32| {
                let [which, _] = sequence.point(index, 0);
                let [u, v] = sequence.point(index, 1);
                let sample = guide.sample([which, u, v]);
                (sample, brings(&sample))
            };
            let found: Vec<(GuidedSample, f64)> = (0..count).map(sample).collect();
            let values = found.iter().map(|(sample, brought)| sample.weight * brought);
            let mean = values.clone().sum::<f64>() / f64::from(count);
            let square = values.map(|value| value * value).sum::<f64>() / f64::from(count);
            (found, mean, square - mean * mean)
        };
        let even = SampleGuide::even(3, 32);
        let (found, mean, variance) = all(&even, 1 << 14);
        assert!((mean / expected - 1.0).abs() < 0.05, "{mean} {expected}");
        let guide = even.guided(found);
        let (found, guided_mean, guided_variance) = all(&guide, 1 << 14);
        assert!((guided_mean / expected - 1.0).abs() < 0.01, "{guided_mean} {expected}");
        assert!(guided_variance < variance / 30.0, "{guided_variance} {variance}");
        let (_, again, _) = all(&guide.guided(found), 1 << 14);
        assert!((again / expected - 1.0).abs() < 0.01, "{again} {expected}");
    }

    #[test]
    fn where_nothing_is_found_the_guide_stays_even_and_many_lights_have_one_cell_each() {
        let even = SampleGuide::even(5, 8);
        let sample = even.sample([0.5, 0.1, 0.2]);
        assert_eq!(even.guided([(sample, 0.0)]).part, even.part);
        let many = SampleGuide::even(1 << 14, 8);
        assert_eq!((many.side, many.part.len()), (1, 1 << 14));
        let last = many.sample([1.0 - f64::EPSILON / 2.0, 0.5, 0.5]);
        assert_eq!((last.light, last.uniform), ((1 << 14) - 1, [0.5, 0.5]));
        assert!((last.weight / f64::from(1 << 14) - 1.0).abs() < 1e-9);
    }
}
