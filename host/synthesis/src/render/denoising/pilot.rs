//! The pilot of the denoiser: some windows of a picture, in which is tried whether to filter is worth its time.
//!
//! Where all noise comes from edges that samples hit by chance, filtering gains nothing.

use super::super::film::Film;
use super::halves::Halves;
use super::regression::RgbPlanes;
use rayon::prelude::*;

/// The columns and rows of a window.
const WIDTH: usize = 32;
const HEIGHT: usize = 16;
/// One of so many windows is tried; of a picture with n times [`PIXELS`] pixels one of n times as many.
const SPARSE: usize = 8;
const PIXELS: usize = 1 << 17;
/// Errors are compared in cells of so many pixels to each side.
const CELL: usize = 16;
/// To filter is worth its time up to this error, times the square root of the samples of a pixel, as a part of the
/// error of what was not filtered: the more samples there are, the less of the time goes into filtering.
///
/// Measured on eleven scenes of 4, 8 and 16 samples: where the eye (FLIP) finds a gain it is at most 0.14 times the
/// root, and at least 0.18 where it finds none.
const WORTH: f64 = 0.15;

/// The windows whose pixels are tried.
pub(super) struct Pilot {
    /// Whether each pixel, row by row, is quiet or outside of the windows.
    pub(super) quiet: Vec<bool>,
    width: usize,
    /// The error that is small enough, as a part of the error of what was not filtered.
    most: f64,
}

impl Pilot {
    /// - `quiet`: which pixels of the film have no noise to speak of.
    pub(super) fn new(quiet: &[bool], film: &Film) -> Pilot {
        let width = film.width() as usize;
        let sparse = SPARSE * quiet.len().div_ceil(PIXELS);
        let is_inside = |x: usize, y: usize| (x / WIDTH + 2 * (y / HEIGHT)).is_multiple_of(sparse);
        let is_left_out = |(pixel, quiet): (usize, &bool)| *quiet || !is_inside(pixel % width, pixel / width);
        let samples: f64 = film.tallies().iter().map(|tally| f64::from(tally.count)).sum();
        let most = WORTH * (samples / quiet.len() as f64).sqrt();
        Pilot { quiet: quiet.par_iter().enumerate().map(is_left_out).collect(), width, most }
    }

    /// Whether the best mixture of what was filtered and what was not has an error that is small enough; so if no pixel
    /// was tried.
    ///
    /// - `filtered`: both halves, where [`Pilot::quiet`] is false.
    pub(super) fn is_worth(&self, halves: &Halves, filtered: &[RgbPlanes; 2]) -> bool {
        let rows = self.quiet.len() / self.width;
        let (mut unfiltered, mut mixture) = (0.0, 0.0);
        for y in (0..rows).step_by(CELL) {
            for x in (0..self.width).step_by(CELL) {
                let in_row = |y: usize| (x..self.width.min(x + CELL)).map(move |x| y * self.width + x);
                let pixels = (y..rows.min(y + CELL)).flat_map(in_row).filter(|pixel| !self.quiet[*pixel]);
                let add = |[count, of_noisy, of_filtered]: [f64; 3], pixel: usize| {
                    let errors = halves.errors(filtered, pixel).map(f64::from);
                    [count + 1.0, of_noisy + errors[0], of_filtered + errors[1]]
                };
                let [count, of_noisy, of_filtered] = pixels.fold([0.0; 3], add);
                if of_noisy > 0.0 && of_filtered > 0.0 {
                    mixture += (count * of_noisy * of_filtered / (of_noisy + of_filtered)).sqrt();
                }
                unfiltered += (count * of_noisy).sqrt();
            }
        }
        mixture <= self.most * unfiltered
    }
}
