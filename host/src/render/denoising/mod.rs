//! Denoising: a picture of few samples as it would about look with many.
//!
//! The samples of each pixel are two halves. Each half is filtered by weights that the other tells, so that weights know
//! nothing of the noise that they weigh; see [`regression`]. What both halves then say against each other tells how far the
//! filter is off, and where that is more than the noise, the noise is kept: of both, each pixel gets as much as makes the
//! error least that is seen from a distance.
//!
//! All of it follows the noise that the film knows: where there is none, nothing is computed. Time grows with the pixels
//! that have noise, memory with all of them, neither with the samples.
//!
//! # Source
//! Rousselle, Knaus and Zwicker 2012 for halves and weights; Bitterli and others 2016 for the regression. The mixture with
//! what is not filtered is ours, for the candidates of both.

mod plane;
mod regression;
#[cfg(test)]
mod tests;

use super::film::{Film, Tally};
use super::guide::Guide;
use crate::color::srgb::LUMINANCE;
use crate::picture::{Picture, PictureError};
use plane::{Plane, bell, square};
use rayon::prelude::*;
use regression::{GUIDES, Guides, MARGIN, Noisy, filtered};
use rustc_hash::FxHashMap;
use std::array::from_fn;

/// How far around a pixel variances are brought in line with what halves tell, pixels.
const VARIANCE_FAR: usize = 10;
/// The least and most of the variance of independent samples that evenly spread ones have.
const VARIANCE_PARTS: [f32; 2] = [0.02, 2.0];
/// For so many samples counts the mean variance of the pixels around one.
const VARIANCE_PRIOR: f32 = 1.0;
/// The least ridge of what guides: the variance of its mean is the ridge otherwise, so that what is noisy explains less.
const LEAST_RIDGE: f32 = 1e-5;
/// As an eye at the usual distance sees errors: standard deviation of what it sees as one, and of what the errors are told
/// by, pixels.
const SEEN: f32 = 0.7;
const TOLD: f32 = 4.0;
/// Errors count relative to the radiance, but that is at least this part of the mean, squared.
const DARK: f32 = 0.1;
/// A pixel has no noise to speak of below this relative standard error: less than a picture of eight bits shows.
const QUIET: f32 = 1.0 / 512.0;

/// A half of a pixel is an outlier if it is so many times as bright as the brightest of the other halves within
/// [`OUTLIER_FAR`] pixels; it then counts as that. Halves of fewer than [`OUTLIER_SAMPLES`] samples tell no outliers from
/// light that is rare.
const OUTLIER: f32 = 4.0;
const OUTLIER_FAR: isize = 2;
const OUTLIER_SAMPLES: f32 = 4.0;

/// Mean radiances of pictures whose squares are numbers of 32 bits.
const UNITS: std::ops::RangeInclusive<f32> = 1e-15..=1e15;

/// Memory that denoising takes for each pixel of a picture, bytes, the guides of its film included.
pub(super) const BYTES: u64 = 220;

/// The picture of a film without most of its noise; none if it was cancelled.
///
/// The film has to keep guides. A pixel of a single sample has it in both halves. A film without guides, and one that is so
/// dark or bright on average that squares leave the range of numbers ([`UNITS`]), stays as it is.
///
/// - `is_cancelled`: asked from time to time.
///
/// # Errors
/// [`PictureError`].
pub(super) fn denoised(film: &Film, is_cancelled: &(dyn Fn() -> bool + Sync)) -> Result<Option<Picture>, PictureError> {
    let mut picture = film.picture()?;
    let Some(halves) = Halves::of(film) else { return Ok(Some(picture)) };
    let guides = guides(film);
    let is_quiet = |pixel: usize| halves.is_quiet(pixel);
    let one = filtered(&halves.early, &halves.late, &guides, &is_quiet, is_cancelled);
    let two = filtered(&halves.late, &halves.early, &guides, &is_quiet, is_cancelled);
    drop(guides);
    if is_cancelled() {
        return Ok(None);
    }
    let part = halves.part_of_filtered(&one, &two);
    picture.pixels_mut().par_iter_mut().enumerate().for_each(|(pixel, place)| {
        let (early, part) = (halves.share.of(pixel), part.of(pixel));
        for band in 0..3 {
            let value = early * one[band].of(pixel) + (1.0 - early) * two[band].of(pixel);
            let noisy = halves.outliers.get(&pixel).map_or(place.radiance[band], |mean| mean[band] * halves.unit);
            place.radiance[band] = noisy + part * (value * halves.unit - noisy);
        }
    });
    Ok(Some(picture))
}

/// The samples of each pixel in two halves, in units of the mean radiance of the picture.
struct Halves {
    early: Noisy,
    late: Noisy,
    /// The share of the samples that the early half has.
    share: Plane,
    /// Pixels with an outlier, and their means without it.
    outliers: FxHashMap<usize, [f32; 3]>,
    /// The unit.
    unit: f32,
}

impl Halves {
    /// None of a film without light or guides.
    fn of(film: &Film) -> Option<Halves> {
        let size = [film.width() as usize, film.height() as usize];
        let (tallies, guides) = (film.tallies(), film.guides());
        let unit = tallies.iter().map(|tally| tally.mean().dot(LUMINANCE)).sum::<f64>() / tallies.len() as f64;
        let unit = unit as f32;
        if !UNITS.contains(&unit) || guides.len() != tallies.len() {
            return None;
        }
        let counts = |pixel: usize| halves(tallies[pixel].count);
        let mean = |pixel: usize, band: usize| {
            let (Tally { sum, .. }, Guide { early, .. }) = (&tallies[pixel], &guides[pixel]);
            let [first, rest] = counts(pixel);
            let late = (sum[band] as f32 - early[band]) / rest.max(1.0);
            let early = if first > 0.0 { early[band] / first } else { late };
            [early / unit, late / unit]
        };
        let lowered = outliers(size, counts, mean);
        let mean = |pixel: usize, band: usize| {
            let means = mean(pixel, band);
            lowered.get(&pixel).map_or(means, |parts| [parts[0] * means[0], parts[1] * means[1]])
        };
        let early = from_fn(|band| Plane::new(size, MARGIN, |pixel| mean(pixel, band)[0]));
        let late = from_fn(|band| Plane::new(size, MARGIN, |pixel| mean(pixel, band)[1]));
        // As if samples were independent.
        let independent: [Plane; 3] = from_fn(|band| {
            Plane::new(size, 0, |pixel| {
                if lowered.contains_key(&pixel) {
                    // The squares of its samples are those of the outlier: it is as uncertain as it is bright.
                    return mean(pixel, band).map(|half| half * half).iter().sum();
                }
                let (count, mean) = (tallies[pixel].count as f32, tallies[pixel].mean()[band] as f32);
                let squares = guides[pixel].squares[band] / count.max(1.0) - mean * mean;
                squares.max(0.0) / (count - 1.0).max(1.0) / (unit * unit)
            })
        });
        // By what halves differ: right for evenly spread samples, but of a single pixel it tells little.
        let by_halves = Plane::new(size, 0, |pixel| {
            let [first, rest] = counts(pixel);
            let differs = |band: usize| {
                let [early, late] = mean(pixel, band);
                (early - late).powi(2)
            };
            (0..3).map(differs).sum::<f32>() * first * rest / (first + rest).max(1.0).powi(2)
        });
        let by_samples = Plane::new(size, 0, |pixel| independent.iter().map(|band| band.of(pixel)).sum());
        let wide = square(VARIANCE_FAR);
        let [by_halves, by_samples] = [by_halves, by_samples].map(|plane| plane.convolved(&wide));
        let around = independent.each_ref().map(|band| band.convolved(&square(1)));
        let variance = |pixel: usize, band: usize| {
            let part = by_halves.of(pixel) / by_samples.of(pixel).max(f32::MIN_POSITIVE);
            let own = tallies[pixel].count.saturating_sub(1) as f32;
            let pooled =
                (own * independent[band].of(pixel) + VARIANCE_PRIOR * around[band].of(pixel)) / (own + VARIANCE_PRIOR);
            pooled * part.clamp(VARIANCE_PARTS[0], VARIANCE_PARTS[1])
        };
        let variances = |half: usize| {
            let of_half = |pixel: usize| counts(pixel).iter().sum::<f32>() / counts(pixel)[half].max(1.0);
            from_fn(|band| Plane::new(size, MARGIN, |pixel| variance(pixel, band) * of_half(pixel)))
        };
        let share = Plane::new(size, 0, |pixel| {
            let [first, rest] = counts(pixel);
            first / (first + rest).max(1.0)
        });
        let without = |pixel: usize| {
            let share = share.of(pixel);
            let mean = |band| mean(pixel, band)[0] * share + mean(pixel, band)[1] * (1.0 - share);
            (pixel, from_fn(mean))
        };
        let outliers = lowered.keys().map(|pixel| without(*pixel)).collect();
        let [early, late] = [Noisy::new(early, variances(0)), Noisy::new(late, variances(1))];
        Some(Halves { early, late, share, outliers, unit })
    }

    /// Whether a pixel has no noise to speak of.
    fn is_quiet(&self, pixel: usize) -> bool {
        let share = self.share.of(pixel);
        (0..3).all(|band| {
            let [early, late] = [&self.early, &self.late].map(|half| half.bands[band].of(pixel));
            let mean = share * early + (1.0 - share) * late;
            // That of the late half, which no pixel lacks, for the share that it is of all.
            let variance = (1.0 - share) * self.late.variances[band].of(pixel);
            variance <= QUIET * QUIET * (mean * mean + DARK)
        })
    }

    /// How much of what was filtered is best in each pixel; the rest is what was not.
    ///
    /// Errors of both are independent: the mean squared error of the mixture is least where each counts as much as the
    /// other is wrong. That of what was filtered is told by its difference from the other half, less the noise of that.
    fn part_of_filtered(&self, one: &[Plane; 3], two: &[Plane; 3]) -> Plane {
        let size = [self.share.width, self.share.height];
        let bell_seen = bell(SEEN);
        let squared: Vec<f32> = bell_seen.iter().map(|part| part * part).collect();
        let seen_noise = |half: &Noisy, band: usize| half.variances[band].convolved(&squared);
        let seen_difference = |filtered: &[Plane; 3], half: &Noisy, band: usize| {
            let (filtered, half) = (&filtered[band], &half.bands[band]);
            Plane::new(size, 0, |pixel| filtered.of(pixel) - half.of(pixel)).convolved(&bell_seen)
        };
        // The squared errors of what was not filtered and of what was.
        let mut errors = vec![[0.0f32; 2]; size[0] * size[1]];
        for band in 0..3 {
            let noise = [&self.early, &self.late].map(|half| seen_noise(half, band));
            let off = [seen_difference(one, &self.late, band), seen_difference(two, &self.early, band)];
            errors.par_iter_mut().enumerate().for_each(|(pixel, [unfiltered, filtered])| {
                let [early, late] = noise.each_ref().map(|noise| noise.of(pixel));
                let share = self.share.of(pixel);
                let value = share * one[band].of(pixel) + (1.0 - share) * two[band].of(pixel);
                let scale = 1.0 / (value * value + DARK);
                *unfiltered += scale * (share * share * early + (1.0 - share).powi(2) * late);
                *filtered += scale * 0.5 * (off[0].of(pixel).powi(2) - late + off[1].of(pixel).powi(2) - early);
            });
        }
        let wide = bell(TOLD);
        let smooth = |which: usize| Plane::new(size, 0, |pixel| errors[pixel][which]).convolved(&wide);
        let [unfiltered, filtered] = [smooth(0), smooth(1)];
        Plane::new(size, 0, |pixel| {
            let (unfiltered, filtered) = (unfiltered.of(pixel).max(0.0), filtered.of(pixel).max(0.0));
            if unfiltered > 0.0 { unfiltered / (unfiltered + filtered) } else { 0.0 }
        })
    }
}

/// The pixels of which a half is an outlier, and what is to be made of their halves, as factors.
///
/// - `counts`: samples of the halves of a pixel. `mean`: their means in a band.
fn outliers(
    [width, height]: [usize; 2],
    counts: impl Fn(usize) -> [f32; 2] + Sync,
    mean: impl Fn(usize, usize) -> [f32; 2] + Sync,
) -> FxHashMap<usize, [f32; 2]> {
    let luminance = |pixel: usize| {
        let bands: [[f32; 2]; 3] = from_fn(|band| mean(pixel, band));
        [0, 1].map(|half| (0..3).map(|band| bands[band][half] * LUMINANCE[band] as f32).sum::<f32>())
    };
    let luminances: Vec<[f32; 2]> = (0..width * height).into_par_iter().map(luminance).collect();
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
fn halves(count: u32) -> [f32; 2] {
    let first = count.checked_sub(1).and_then(u32::checked_ilog2).map_or(0, |power| 1u32 << power);
    [first, count - first].map(|half| half as f32)
}

/// What guides the regression.
fn guides(film: &Film) -> Guides {
    let size = [film.width() as usize, film.height() as usize];
    let (tallies, guides) = (film.tallies(), film.guides());
    let count = |pixel: usize| tallies[pixel].count.max(1) as f32;
    let distance = |pixel: usize| {
        let Tally { elements, distances, .. } = &tallies[pixel];
        (*elements > 0).then(|| (distances / f64::from(*elements)).max(f64::MIN_POSITIVE))
    };
    let (sum, seen) = (0..tallies.len())
        .filter_map(distance)
        .fold((0.0, 0.0f64), |(sum, seen), distance| (sum + distance.ln(), seen + 1.0));
    let typical = sum / seen.max(1.0);
    let values: [Plane; GUIDES] = from_fn(|guide| {
        Plane::new(size, MARGIN, |pixel| match guide {
            0..3 => guides[pixel].albedo[guide] / count(pixel),
            3..6 => guides[pixel].normal[guide - 3] / count(pixel),
            _ => distance(pixel).map_or(0.0, |distance| (distance.ln() - typical) as f32),
        })
    });
    // Of a mean, by the squares of what it is of.
    let variance = |mean_squared: f32, squares: f32, count: f32| {
        (squares / count - mean_squared).max(0.0) / (count - 1.0).max(1.0)
    };
    let ridge = |variance: f32| variance.max(LEAST_RIDGE);
    let of_vector = |pixel: usize, sum: [f32; 3], squares: f32| {
        let mean_squared = sum.map(|sum| (sum / count(pixel)).powi(2)).iter().sum();
        variance(mean_squared, squares, count(pixel)) / 3.0
    };
    let ridges = [
        Plane::new(size, MARGIN, |pixel| {
            let Guide { albedo, albedo_squares, .. } = guides[pixel];
            ridge(of_vector(pixel, albedo, albedo_squares))
        }),
        Plane::new(size, MARGIN, |pixel| {
            let Guide { normal, normal_squares, .. } = guides[pixel];
            ridge(of_vector(pixel, normal, normal_squares))
        }),
        Plane::new(size, MARGIN, |pixel| {
            let mean = distance(pixel).unwrap_or(1.0) as f32;
            let squares = guides[pixel].distance_squares;
            ridge(variance(mean * mean, squares, tallies[pixel].elements.max(1) as f32) / (mean * mean))
        }),
    ];
    Guides { values, ridges }
}
