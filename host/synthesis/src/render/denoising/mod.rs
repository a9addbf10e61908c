//! Denoising: a picture of few samples as it would about look with many.
//!
//! The samples of each pixel are two halves. Each half is filtered by weights that the other tells, so that weights
//! know nothing of the noise that they weigh; see [`regression`]. What both halves then say against each other tells
//! how far the filter is off, and where that is more than the noise, the noise is kept: of both, each pixel gets as
//! much as makes the error least that is seen from a distance.
//!
//! All of it follows the noise that the film knows: where there is none, nothing is computed, and where a trial in some
//! windows gains nothing, nothing is filtered; see [`pilot`]. Time grows with the pixels that have noise, memory with
//! all of them, neither with the samples.
//!
//! # Source
//! Rousselle, Knaus and Zwicker 2012 for halves and weights; Bitterli and others 2016 for the regression. The mixture
//! with what is not filtered is ours, for the candidates of both.

mod features;
mod halves;
mod pilot;
mod plane;
mod regression;
#[cfg(test)]
mod tests;

use super::film::Film;
use crate::picture::{Picture, PictureError};
use features::feature_planes;
use halves::Halves;
use pilot::Pilot;
use rayon::prelude::*;
use regression::filtered;

/// Memory that denoising takes for each pixel of a picture, bytes, the features of its film included.
pub(super) const BYTES: u64 = 220;

/// The picture of a film without most of its noise; none if it was cancelled.
///
/// The film has to hold features. A pixel of a single sample has it in both halves. A film without features, and one
/// that is so dark or bright on average that squares leave the range of numbers, stays as it is.
///
/// - `is_cancelled`: asked from time to time.
///
/// # Errors
/// [`PictureError`].
pub(super) fn denoised(film: &Film, is_cancelled: &(dyn Fn() -> bool + Sync)) -> Result<Option<Picture>, PictureError> {
    let mut picture = film.picture()?;
    let Some(halves) = Halves::of(film) else { return Ok(Some(picture)) };
    let features = feature_planes(film);
    let both = |quiet: &[bool]| {
        let [early, late] = [&halves.early, &halves.late];
        [filtered(early, late, &features, quiet, is_cancelled), filtered(late, early, &features, quiet, is_cancelled)]
    };
    let quiet: Vec<bool> = (0..film.tallies().len()).into_par_iter().map(|pixel| halves.is_quiet(pixel)).collect();
    let pilot = Pilot::new(&quiet, film);
    let is_worth = pilot.is_worth(&halves, &both(&pilot.quiet));
    let filtered = is_worth.then(|| both(&quiet));
    drop(features);
    let part = filtered.as_ref().map(|both| halves.part_of_filtered(both));
    if is_cancelled() {
        return Ok(None);
    }
    picture.pixels_mut().par_iter_mut().enumerate().for_each(|(pixel, place)| {
        let noisy = halves.outliers.get(&pixel).map(|mean| mean.map(|value| value * halves.unit));
        place.radiance = noisy.unwrap_or(place.radiance);
        if let (Some(both), Some(part)) = (&filtered, &part) {
            let value = halves.mixed(both, pixel).map(|value| value * halves.unit);
            let filtered = place.radiance.iter_mut().zip(value);
            filtered.for_each(|(noisy, value)| *noisy += part.of(pixel) * (value - *noisy));
        }
    });
    Ok(Some(picture))
}
