//! The samples of a film in two halves: what each pixel is in both, how noisy that is, and where one holds an outlier.

use super::super::features::PixelFeatures;
use super::super::film::Film;
use super::super::tally::Tally;
use super::plane::{PixelPlane, bell, square};
use super::regression::{MARGIN, NoisyPicture, RgbPlanes};
use crate::color::srgb::LUMINANCE;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::array::from_fn;

/// How far around a pixel variances are brought in line with what halves tell, pixels.
const VARIANCE_FAR: usize = 10;
/// The least and most of the variance of independent samples that evenly spread ones have.
const VARIANCE_PARTS: [f32; 2] = [0.02, 2.0];
/// For so many samples counts the mean variance of the pixels around one.
const VARIANCE_PRIOR: f32 = 1.0;
/// As an eye at the usual distance sees errors: standard deviation of what it sees as one, and of what the errors are
/// told by, pixels.
const SEEN: f32 = 0.7;
const TOLD: f32 = 4.0;
/// Errors count relative to the radiance, but that is at least this part of the mean, squared.
const DARK: f32 = 0.1;
/// A pixel has no noise to speak of below this relative standard error: less than a picture of eight bits shows.
const QUIET: f32 = 1.0 / 512.0;

/// A half of a pixel is an outlier if it is so many times as bright as the brightest of the other halves within
/// [`OUTLIER_FAR`] pixels; it then counts as that. Halves of fewer than [`OUTLIER_SAMPLES`] samples tell no outliers
/// from light that is rare.
const OUTLIER: f32 = 4.0;
const OUTLIER_FAR: isize = 2;
const OUTLIER_SAMPLES: f32 = 4.0;

/// Mean radiances of pictures whose squares are numbers of 32 bits.
const UNITS: std::ops::RangeInclusive<f32> = 1e-15..=1e15;

/// The means of both halves of a pixel, for each band.
type Means = [[f32; 2]; 3];

/// The samples of each pixel in two halves, in units of the mean radiance of the picture.
pub(super) struct Halves {
    pub(super) early: NoisyPicture,
    pub(super) late: NoisyPicture,
    /// The share of the samples that the early half has.
    share: PixelPlane,
    /// Pixels with an outlier, and their means without it.
    pub(super) outliers: FxHashMap<usize, [f32; 3]>,
    /// The unit.
    pub(super) unit: f32,
}

impl Halves {
    /// None of a film without light or features, and of one whose mean leaves [`UNITS`].
    pub(super) fn of(film: &Film) -> Option<Halves> {
        let size = [film.width() as usize, film.height() as usize];
        let (tallies, features) = (film.tallies(), film.features());
        let unit = tallies.iter().map(|tally| tally.mean().dot(LUMINANCE)).sum::<f64>() / tallies.len() as f64;
        let unit = unit as f32;
        if !UNITS.contains(&unit) || features.len() != tallies.len() {
            return None;
        }
        let pixels = tallies.len();
        let counts = |pixel: usize| halves(tallies[pixel].count);
        let mean = |pixel: usize| {
            let (Tally { sum, .. }, PixelFeatures { early, .. }) = (&tallies[pixel], &features[pixel]);
            let [first, rest] = counts(pixel);
            from_fn(|band| {
                let late = (sum[band] as f32 - early[band]) / rest.max(1.0);
                let early = if first > 0.0 { early[band] / first } else { late };
                [early / unit, late / unit]
            })
        };
        let mut means: Vec<Means> = (0..pixels).into_par_iter().map(mean).collect();
        let outliers = outliers(size, counts, &means);
        for (pixel, factors) in &outliers {
            means[*pixel].iter_mut().for_each(|band| *band = [factors[0] * band[0], factors[1] * band[1]]);
        }
        // As if samples were independent.
        let independent: [PixelPlane; 3] = from_fn(|band| {
            PixelPlane::new(size, 0, |pixel| {
                if outliers.contains_key(&pixel) {
                    // The squares of its samples are those of the outlier: it is as uncertain as it is bright.
                    return means[pixel][band].map(|half| half * half).iter().sum();
                }
                let (count, mean) = (tallies[pixel].count as f32, tallies[pixel].mean()[band] as f32);
                let squares = features[pixel].squares[band] / count.max(1.0) - mean * mean;
                squares.max(0.0) / (count - 1.0).max(1.0) / (unit * unit)
            })
        });
        // By what halves differ: right for evenly spread samples, but of a single pixel it tells little.
        let by_halves = PixelPlane::new(size, 0, |pixel| {
            let [first, rest] = counts(pixel);
            let differ = means[pixel].iter().map(|[early, late]| (early - late).powi(2)).sum::<f32>();
            differ * first * rest / (first + rest).max(1.0).powi(2)
        });
        let by_samples = PixelPlane::new(size, 0, |pixel| independent.iter().map(|band| band.of(pixel)).sum());
        let wide = square(VARIANCE_FAR);
        let [by_halves, by_samples] = [by_halves, by_samples].map(|plane| plane.convolved(&wide));
        let around = independent.each_ref().map(|band| band.convolved(&square(1)));
        let pooled = |band: usize, pixel: usize| {
            let part = by_halves.of(pixel) / by_samples.of(pixel).max(f32::MIN_POSITIVE);
            let own = tallies[pixel].count.saturating_sub(1) as f32;
            let pooled =
                (own * independent[band].of(pixel) + VARIANCE_PRIOR * around[band].of(pixel)) / (own + VARIANCE_PRIOR);
            pooled * part.clamp(VARIANCE_PARTS[0], VARIANCE_PARTS[1])
        };
        let variances: [PixelPlane; 3] = from_fn(|band| PixelPlane::new(size, 0, |pixel| pooled(band, pixel)));
        let share = PixelPlane::new(size, 0, |pixel| {
            let [first, rest] = counts(pixel);
            first / (first + rest).max(1.0)
        });
        let without = |pixel: usize| {
            let share = share.of(pixel);
            (pixel, means[pixel].map(|[early, late]| early * share + late * (1.0 - share)))
        };
        let outliers = outliers.into_keys().map(without).collect();
        let half = |half: usize| {
            let of_half = |pixel: usize| counts(pixel).iter().sum::<f32>() / counts(pixel)[half].max(1.0);
            let bands = from_fn(|band| PixelPlane::new(size, MARGIN, |pixel| means[pixel][band][half]));
            let variance = |band: usize, pixel: usize| variances[band].of(pixel) * of_half(pixel);
            NoisyPicture::new(bands, from_fn(|band| PixelPlane::new(size, MARGIN, |pixel| variance(band, pixel))))
        };
        let [early, late] = [half(0), half(1)];
        Some(Halves { early, late, share, outliers, unit })
    }

    /// Whether a pixel has no noise to speak of.
    pub(super) fn is_quiet(&self, pixel: usize) -> bool {
        let share = self.share.of(pixel);
        (0..3).all(|band| {
            let [early, late] = [&self.early, &self.late].map(|half| half.bands[band].of(pixel));
            let mean = share * early + (1.0 - share) * late;
            // That of the late half, which no pixel lacks, for the share that it is of all.
            let variance = (1.0 - share) * self.late.variances[band].of(pixel);
            variance <= QUIET * QUIET * (mean * mean + DARK)
        })
    }

    /// The mean of both filtered halves of a pixel, by their shares, in each band.
    pub(super) fn mixed(&self, [one, two]: &[RgbPlanes; 2], pixel: usize) -> [f32; 3] {
        let share = self.share.of(pixel);
        from_fn(|band| share * one[band].of(pixel) + (1.0 - share) * two[band].of(pixel))
    }

    /// The squared errors of a pixel relative to its radiance: as it is, and filtered. The latter is told by the
    /// difference of each filtered half from the other half, less the noise of that; it may come out below 0.
    pub(super) fn errors(&self, filtered: &[RgbPlanes; 2], pixel: usize) -> [f32; 2] {
        let values = self.mixed(filtered, pixel);
        let [one, two] = filtered;
        let mut sum = [0.0; 2];
        for (band, value) in values.into_iter().enumerate() {
            let of = |half: &NoisyPicture| (half.bands[band].of(pixel), half.variances[band].of(pixel));
            let ((early, early_noise), (late, late_noise)) = (of(&self.early), of(&self.late));
            let off = [one[band].of(pixel) - late, two[band].of(pixel) - early];
            let errors = errors(self.share.of(pixel), value, off, [early_noise, late_noise]);
            sum = [sum[0] + errors[0], sum[1] + errors[1]];
        }
        sum
    }

    /// How much of what was filtered is best in each pixel; the rest is what was not.
    ///
    /// Errors of both are independent: the mean squared error of the mixture is least where each counts as much as the
    /// other is wrong. That of what was filtered is told by its difference from the other half, less the noise of that.
    pub(super) fn part_of_filtered(&self, both: &[RgbPlanes; 2]) -> PixelPlane {
        let [one, two] = both;
        let size = [self.share.width, self.share.height];
        let bell_seen = bell(SEEN);
        let squared: Vec<f32> = bell_seen.iter().map(|part| part * part).collect();
        let seen_noise = |half: &NoisyPicture, band: usize| half.variances[band].convolved(&squared);
        let seen_difference = |filtered: &RgbPlanes, half: &NoisyPicture, band: usize| {
            let (filtered, half) = (&filtered[band], &half.bands[band]);
            PixelPlane::new(size, 0, |pixel| filtered.of(pixel) - half.of(pixel)).convolved(&bell_seen)
        };
        // The squared errors of what was not filtered and of what was.
        let mut sums = vec![[0.0f32; 2]; size[0] * size[1]];
        for band in 0..3 {
            let noise = [&self.early, &self.late].map(|half| seen_noise(half, band));
            let off = [seen_difference(one, &self.late, band), seen_difference(two, &self.early, band)];
            sums.par_iter_mut().enumerate().for_each(|(pixel, sum)| {
                let of = |planes: &[PixelPlane; 2]| planes.each_ref().map(|plane| plane.of(pixel));
                let value = self.mixed(both, pixel)[band];
                let errors = errors(self.share.of(pixel), value, of(&off), of(&noise));
                *sum = [sum[0] + errors[0], sum[1] + errors[1]];
            });
        }
        let wide = bell(TOLD);
        let smooth = |which: usize| PixelPlane::new(size, 0, |pixel| sums[pixel][which]).convolved(&wide);
        let [unfiltered, filtered] = [smooth(0), smooth(1)];
        PixelPlane::new(size, 0, |pixel| {
            let (unfiltered, filtered) = (unfiltered.of(pixel).max(0.0), filtered.of(pixel).max(0.0));
            if unfiltered > 0.0 { unfiltered / (unfiltered + filtered) } else { 0.0 }
        })
    }
}

/// The squared errors of a pixel in a band, relative to its radiance: as it is, and filtered.
///
/// - `share`: of the samples that the early half has. `value`: of the pixel, filtered.
/// - `off`: how far each half, filtered, is from the other as it is: the early one first.
/// - `noise`: the variance of the early half and of the late one.
fn errors(share: f32, value: f32, off: [f32; 2], [early, late]: [f32; 2]) -> [f32; 2] {
    let scale = 1.0 / (value * value + DARK);
    let as_it_is = share * share * early + (1.0 - share).powi(2) * late;
    [scale * as_it_is, scale * 0.5 * (off[0].powi(2) - late + off[1].powi(2) - early)]
}

/// The pixels of which a half is an outlier, and what is to be made of their halves, as factors.
///
/// - `counts`: samples of the halves of a pixel.
fn outliers(
    [width, height]: [usize; 2],
    counts: impl Fn(usize) -> [f32; 2] + Sync,
    means: &[Means],
) -> FxHashMap<usize, [f32; 2]> {
    let luminance =
        |bands: &Means| [0, 1].map(|half| (0..3).map(|band| bands[band][half] * LUMINANCE[band] as f32).sum::<f32>());
    let luminances: Vec<[f32; 2]> = means.par_iter().map(luminance).collect();
    let around = |at: usize, most: usize| {
        let from = at.saturating_add_signed(-OUTLIER_FAR);
        from..(at.saturating_add_signed(OUTLIER_FAR) + 1).min(most)
    };
    let lowered = |pixel: usize| {
        if counts(pixel).iter().any(|count| *count < OUTLIER_SAMPLES) {
            return None;
        }
        let (x, y) = (pixel % width, pixel / width);
        let own = luminances[pixel];
        let is_far = |half: usize| own[half] > OUTLIER * own[1 - half];
        if !is_far(0) && !is_far(1) {
            return None;
        }
        let brightest = |half: usize| {
            let rows = around(y, height).flat_map(|y| around(x, width).map(move |x| y * width + x));
            rows.map(|other| luminances[other][half]).fold(0.0, f32::max)
        };
        let factor = |half: usize| {
            let most = OUTLIER * brightest(1 - half);
            if own[half] > most { brightest(1 - half) / own[half] } else { 1.0 }
        };
        let factors = [0, 1].map(factor);
        (factors != [1.0; 2]).then_some((pixel, factors))
    };
    (0..width * height).into_par_iter().filter_map(lowered).collect::<Vec<_>>().into_iter().collect()
}

/// How many samples are in each half: those up to the last power of two before their number, and the rest.
pub(super) fn halves(count: u32) -> [f32; 2] {
    let first = count.checked_sub(1).and_then(u32::checked_ilog2).map_or(0, |power| 1u32 << power);
    [first, count - first].map(|half| half as f32)
}
