//! How far a picture is from a reference.

use super::{Picture, PictureError};
use serde::Serialize;

/// Added to the squared reference in the relative mean squared error, so that black pixels do not divide by zero.
pub const RELATIVE_FLOOR: f64 = 1e-2;

/// Differences between a picture and a reference; all are 0 for equal pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Root of the mean squared difference of radiance, over all pixels and bands.
    pub rmse: f64,
    /// Mean of (a - b)² / (b² + 0.01) over all pixels and bands, b being the reference.
    pub relative_mse: f64,
    /// Largest difference of radiance in any band.
    pub largest: f64,
    /// The difference of radiance that 99 of 100 values, counted over all pixels and bands, do not exceed.
    pub percentile_99: f64,
    /// Mean of |coverage a - coverage b| over all pixels, 0..=1.
    pub coverage: f64,
    /// Share of the union of both silhouettes (coverage of a half and more) that only one of them has, 0..=1.
    pub silhouette: f64,
}

/// Compares `picture` with `reference`.
///
/// # Errors
/// [`PictureError::Mismatch`] if the sizes differ.
pub fn difference(picture: &Picture, reference: &Picture) -> Result<Difference, PictureError> {
    if (picture.width(), picture.height()) != (reference.width(), reference.height()) {
        return Err(PictureError::Mismatch(picture.width(), picture.height(), reference.width(), reference.height()));
    }
    let (mut squared, mut relative, mut largest, mut coverage) = (0.0, 0.0, 0.0f64, 0.0);
    let (mut both, mut either) = (0u64, 0u64);
    let mut apart = Vec::with_capacity(3 * picture.pixels().len());
    for (a, b) in picture.pixels().iter().zip(reference.pixels()) {
        for (x, y) in a.radiance.iter().zip(b.radiance) {
            let (x, y) = (f64::from(*x), f64::from(y));
            squared += (x - y) * (x - y);
            relative += (x - y) * (x - y) / (y * y + RELATIVE_FLOOR);
            largest = largest.max((x - y).abs());
            apart.push((x - y).abs() as f32);
        }
        coverage += f64::from((a.coverage - b.coverage).abs());
        both += u64::from(a.coverage >= 0.5 && b.coverage >= 0.5);
        either += u64::from(a.coverage >= 0.5 || b.coverage >= 0.5);
    }
    // The nearest rank; no picture is empty.
    let rank = (99 * apart.len()).div_ceil(100) - 1;
    let percentile_99 = f64::from(*apart.select_nth_unstable_by(rank, f32::total_cmp).1);
    let pixels = picture.pixels().len() as f64;
    Ok(Difference {
        rmse: (squared / (3.0 * pixels)).sqrt(),
        relative_mse: relative / (3.0 * pixels),
        largest,
        percentile_99,
        coverage: coverage / pixels,
        silhouette: if either == 0 { 0.0 } else { (either - both) as f64 / either as f64 },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_do_not_differ() {
        let picture = Picture::new(4, 4).expect("small");
        let d = difference(&picture, &picture).expect("same size");
        assert_eq!((d.rmse, d.relative_mse, d.largest, d.coverage, d.silhouette), (0.0, 0.0, 0.0, 0.0, 0.0));
    }

    #[test]
    fn a_uniform_offset_is_the_root_mean_square() {
        let mut a = Picture::new(3, 2).expect("small");
        let mut b = a.clone();
        a.pixels_mut().iter_mut().for_each(|p| p.radiance = [0.75; 3]);
        b.pixels_mut().iter_mut().for_each(|p| p.radiance = [0.5; 3]);
        let d = difference(&a, &b).expect("same size");
        assert!((d.rmse - 0.25).abs() < 1e-12 && (d.largest - 0.25).abs() < 1e-12);
        assert!((d.relative_mse - 0.0625 / 0.26).abs() < 1e-12);
    }

    #[test]
    fn one_value_of_a_hundred_may_exceed_the_percentile() {
        let reference = Picture::new(10, 10).expect("small");
        for (outliers, expected) in [(1, 0.25), (2, 8.0)] {
            let mut picture = reference.clone();
            picture.pixels_mut().iter_mut().for_each(|p| p.radiance = [0.25; 3]);
            picture.pixels_mut().iter_mut().take(outliers).for_each(|p| p.radiance = [8.0; 3]);
            let d = difference(&picture, &reference).expect("same size");
            assert_eq!((d.percentile_99, d.largest), (expected, 8.0));
        }
    }

    #[test]
    fn silhouettes_count_against_their_union() {
        let mut a = Picture::new(4, 1).expect("small");
        let mut b = a.clone();
        (0..3).for_each(|x| a.pixels_mut()[x].coverage = 1.0);
        (1..4).for_each(|x| b.pixels_mut()[x].coverage = 1.0);
        let d = difference(&a, &b).expect("same size");
        assert_eq!((d.silhouette, d.coverage), (0.5, 0.5));
        assert!(difference(&a, &Picture::new(1, 4).expect("small")).is_err());
    }
}
