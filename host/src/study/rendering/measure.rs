//! How far pictures are from a reference, and what of that is noise and what is bias.
//!
//! Two runs A and B with other seeds and two halves R and S of a reference have errors that know nothing of one
//! another: the mean of (A − R)(B − S) over all pixels is therefore the squared bias alone, the mean of (A − B)² / 2
//! the noise of a run, and the mean of (R − S)² / 4 that of the mean of both halves. Of more than two runs all pairs
//! are taken.
//!
//! # Source
//! Ours; the product of independent halves is an old means against noise.

use super::setup::TimedRendering;
use crate::picture::{Difference, PIXELS_PER_DEGREE, Picture, PictureError, Pixel, difference, flip};
use crate::study::StudyError;
use serde::Serialize;

/// How many standard errors a bias must have to count as one.
pub(super) const CLEAR: f64 = 3.0;

/// A reference.
pub(super) struct ReferencePicture {
    halves: [Picture; 2],
    /// The mean of both.
    mean: Picture,
    /// What noise does to the mean: root of the mean squared error of radiance.
    pub(super) error: f64,
    /// What it took, seconds.
    pub(super) seconds: f64,
}

/// How far a setting is from the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorMeasures {
    /// Root of the mean squared error of radiance.
    pub rmse: f64,
    /// The part of it that is noise: two runs differ by √2 times as much. 0 for renderers without noise.
    pub noise: f64,
    /// The square of the part that is no noise, W²/(m⁴ sr²); it is found by chance, and may be less than 0.
    pub bias_squared: f64,
    /// The standard error of that square.
    pub bias_squared_error: f64,
    /// Relative mean squared error.
    pub relative_mse: f64,
    /// FLIP, as it is seen with [`PIXELS_PER_DEGREE`].
    pub flip: f64,
}

impl ErrorMeasures {
    /// The part of the root mean squared error that is no noise; 0 where it is not clear of noise.
    pub fn bias(&self) -> f64 {
        if self.is_clear() { self.bias_squared.sqrt() } else { 0.0 }
    }

    /// The bias is hardly more than this.
    pub fn most_bias(&self) -> f64 {
        (self.bias_squared.max(0.0) + CLEAR * self.bias_squared_error).sqrt()
    }

    /// Whether there is a bias beyond doubt.
    pub fn is_clear(&self) -> bool {
        self.bias_squared > CLEAR * self.bias_squared_error
    }
}

impl ReferencePicture {
    /// # Errors
    /// [`PictureError::Mismatch`].
    pub(super) fn new([one, other]: [TimedRendering; 2]) -> Result<ReferencePicture, StudyError> {
        // Both are of one build.
        let seconds = one.build + one.render + other.render;
        let halves = [one.picture, other.picture];
        let error = difference(&halves[0], &halves[1])?.rmse / 2.0;
        let mut mean = halves[0].clone();
        for (one, other) in mean.pixels_mut().iter_mut().zip(halves[1].pixels()) {
            *one = Pixel {
                radiance: [0, 1, 2].map(|band| one.radiance[band].midpoint(other.radiance[band])),
                coverage: one.coverage.midpoint(other.coverage),
            };
        }
        Ok(ReferencePicture { halves, mean, error, seconds })
    }

    /// The root mean squared distance from another reference.
    pub(super) fn apart(&self, other: &ReferencePicture) -> Result<f64, PictureError> {
        Ok(difference(&self.mean, &other.mean)?.rmse)
    }

    /// Measures some runs of one setting, two or more.
    ///
    /// # Errors
    /// [`StudyError::Picture`].
    pub(super) fn measure(&self, runs: &[TimedRendering]) -> Result<ErrorMeasures, StudyError> {
        let count = runs.len() as f64;
        let found: Result<Vec<_>, _> = runs.iter().map(|run| difference(&run.picture, &self.mean)).collect();
        let found = found?;
        let (mut chance, mut sum, mut squares) = (0.0, 0.0, 0.0);
        let pixels = self.mean.pixels().len();
        for pixel in 0..pixels {
            let (mut spread, mut product) = (0.0, 0.0);
            for band in 0..3 {
                let radiance = |picture: &Picture| f64::from(picture.pixels()[pixel].radiance[band]);
                let [half, other] = self.halves.each_ref().map(radiance);
                // Sums over all runs, and over the same runs twice.
                let [mut a, mut b, mut same, mut all, mut square] = [0.0; 5];
                for run in runs {
                    let found = radiance(&run.picture);
                    (a, b, same) = (a + found - half, b + found - other, same + (found - half) * (found - other));
                    (all, square) = (all + found, square + found * found);
                }
                product += (a * b - same) / (count * (count - 1.0)) / 3.0;
                spread += (square - all * all / count).max(0.0) / (count - 1.0) / 3.0;
            }
            (sum, squares, chance) = (sum + product, squares + product * product, chance + spread);
        }
        let pixels = pixels as f64;
        let mean = sum / pixels;
        // Without noise there is no doubt.
        let is_sure = runs.iter().all(|run| run.picture == runs[0].picture);
        let error = if is_sure { 0.0 } else { ((squares / pixels - mean * mean).max(0.0) / pixels).sqrt() };
        let mean_of = |of: fn(&Difference) -> f64| found.iter().map(of).sum::<f64>() / count;
        Ok(ErrorMeasures {
            rmse: mean_of(|found| found.rmse * found.rmse).sqrt(),
            noise: if is_sure { 0.0 } else { (chance / pixels).sqrt() },
            bias_squared: mean,
            bias_squared_error: error,
            relative_mse: mean_of(|found| found.relative_mse),
            flip: flip(&runs[0].picture, &self.mean, PIXELS_PER_DEGREE)?.mean,
        })
    }
}
