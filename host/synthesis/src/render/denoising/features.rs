//! Features for the regression, of the samples of a film.

use super::super::features::PixelFeatures;
use super::super::film::Film;
use super::super::tally::Tally;
use super::plane::PixelPlane;
use super::regression::{FEATURES, FeaturePlanes, MARGIN};
use std::array::from_fn;

/// The least ridge of the features: the variance of their means is the ridge otherwise, so that what is noisy explains
/// less.
const LEAST_RIDGE: f32 = 1e-5;

/// Planes of the features of a film.
pub(super) fn feature_planes(film: &Film) -> FeaturePlanes {
    let size = [film.width() as usize, film.height() as usize];
    let (tallies, features) = (film.tallies(), film.features());
    let count = |pixel: usize| tallies[pixel].count.max(1) as f32;
    let distance = |pixel: usize| {
        let Tally { elements, distances, .. } = &tallies[pixel];
        (*elements > 0).then(|| (distances / f64::from(*elements)).max(f64::MIN_POSITIVE))
    };
    let (sum, seen) = (0..tallies.len())
        .filter_map(distance)
        .fold((0.0, 0.0f64), |(sum, seen), distance| (sum + distance.ln(), seen + 1.0));
    let typical = sum / seen.max(1.0);
    let values: [PixelPlane; FEATURES] = from_fn(|feature| {
        PixelPlane::new(size, MARGIN, |pixel| match feature {
            0..3 => features[pixel].albedo[feature] / count(pixel),
            3..6 => features[pixel].normal[feature - 3] / count(pixel),
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
        PixelPlane::new(size, MARGIN, |pixel| {
            let PixelFeatures { albedo, albedo_squares, .. } = features[pixel];
            ridge(of_vector(pixel, albedo, albedo_squares))
        }),
        PixelPlane::new(size, MARGIN, |pixel| {
            let PixelFeatures { normal, normal_squares, .. } = features[pixel];
            ridge(of_vector(pixel, normal, normal_squares))
        }),
        PixelPlane::new(size, MARGIN, |pixel| {
            let mean = distance(pixel).unwrap_or(1.0) as f32;
            let squares = features[pixel].distance_squares;
            ridge(variance(mean * mean, squares, tallies[pixel].elements.max(1) as f32) / (mean * mean))
        }),
    ];
    FeaturePlanes { values, ridges }
}
