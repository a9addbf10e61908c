//! FLIP: how much of the difference of two pictures is seen by a person who flips between them.

use super::{Picture, PictureError};
use crate::color::srgb::{from_xyz, to_xyz};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Pixels to a degree of the visual field for a display 0.7 m away, 0.7 m and 3840 pixels wide.
pub const PIXELS_PER_DEGREE: f64 = 67.0;

/// Fewest and most pixels to a degree.
pub const PIXELS_PER_DEGREE_RANGE: (f64, f64) = (1.0, 1000.0);

/// Sensitivity to contrast, for each of Y, Cx and Cz a sum of two Gaussians: weight a and width b, square degrees.
const SENSITIVITY: [[[f64; 2]; 2]; 3] =
    [[[1.0, 0.0047], [0.0, 1e-5]], [[1.0, 0.0053], [0.0, 1e-5]], [[34.1, 0.04], [13.5, 0.025]]];

/// The widest of them.
const WIDEST: f64 = 0.04;

/// Exponent of colour differences.
const COLOR_EXPONENT: f64 = 0.7;

/// Colour differences up to this part of the largest are spread over errors up to [`BEND_ERROR`].
const BEND: f64 = 0.4;

/// The error at the bend.
const BEND_ERROR: f64 = 0.95;

/// Width of an edge or point that is seen, degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// Exponent of feature differences.
const FEATURE_EXPONENT: f64 = 0.5;

/// What is seen of the differences between two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// The error of each pixel, 0..=1, row by row from the top.
    pub map: Vec<f32>,
    /// Their mean, 0..=1.
    pub mean: f64,
}

/// The LDR-FLIP error of a picture against a reference; the order of the two does not matter.
///
/// Radiance is clipped to 0..=1 and taken for linear sRGB of a display; what is not a number counts as black. Coverage
/// does not matter. Beyond the border the pixels there go on.
///
/// - `pixels_per_degree`: of the visual field, brought into [`PIXELS_PER_DEGREE_RANGE`].
///
/// # Errors
/// [`PictureError::Mismatch`] if the sizes differ.
///
/// # Source
/// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild: FLIP: A Difference Evaluator for Alternating
/// Images, 2020. X, Y and Z are by [`crate::color::srgb`], which differs from the matrix there by less than 5e-4.
pub fn flip(picture: &Picture, reference: &Picture, pixels_per_degree: f64) -> Result<Flip, PictureError> {
    if (picture.width(), picture.height()) != (reference.width(), reference.height()) {
        return Err(PictureError::Mismatch(picture.width(), picture.height(), reference.width(), reference.height()));
    }
    let density = pixels_per_degree.clamp(PIXELS_PER_DEGREE_RANGE.0, PIXELS_PER_DEGREE_RANGE.1);
    let [a, b] = [picture, reference].map(|picture| Appearance::new(picture, density));
    let largest = color_difference(perceived(DVec3::Y), perceived(DVec3::Z)).powf(COLOR_EXPONENT);
    let map: Vec<f32> = (0..a.colors.len())
        .into_par_iter()
        .map(|pixel| {
            let by_color = color_error(color_difference(a.colors[pixel], b.colors[pixel]), largest);
            let [edges, points] = [0, 1].map(|i| f64::from(a.features[pixel][i] - b.features[pixel][i]).abs());
            let by_feature = (FRAC_1_SQRT_2 * edges.max(points)).powf(FEATURE_EXPONENT).min(1.0);
            by_color.powf(1.0 - by_feature) as f32
        })
        .collect();
    let mean = map.iter().map(|error| f64::from(*error)).sum::<f64>() / map.len() as f64;
    Ok(Flip { map, mean })
}

/// What a person sees of a picture.
struct Appearance {
    /// Filtered L*, a*, b* with the Hunt effect.
    colors: Vec<DVec3>,
    /// Strength of edges and of points.
    features: Vec<[f32; 2]>,
}

impl Appearance {
    fn new(picture: &Picture, density: f64) -> Appearance {
        let light = |value: f32| f64::from(clipped(value));
        let opponents: Vec<DVec3> =
            picture.pixels().par_iter().map(|pixel| opponent(DVec3::from_array(pixel.radiance.map(light)))).collect();
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let plane = |band: usize| Plane { width, height, values: opponents.iter().map(|o| o[band] as f32).collect() };
        let filtered = [0, 1, 2].map(|band| plane(band).filtered(&SENSITIVITY[band], density));
        let color = |i: usize| {
            let seen = DVec3::from_array([0, 1, 2].map(|band| f64::from(filtered[band].values[i])));
            perceived(from_opponent(seen).clamp(DVec3::ZERO, DVec3::ONE))
        };
        let mut luminance = plane(0);
        luminance.values.iter_mut().for_each(|value| *value = (*value + 16.0) / 116.0);
        let colors = (0..opponents.len()).into_par_iter().map(color).collect();
        Appearance { colors, features: luminance.features(density) }
    }
}

/// A value brought into 0..=1; what is not a number is 0.
fn clipped(value: f32) -> f32 {
    if value > 0.0 { value.min(1.0) } else { 0.0 }
}

/// Y, Cx and Cz: a linear form of L*, a* and b*.
fn opponent(rgb: DVec3) -> DVec3 {
    let xyz = to_xyz(rgb) / to_xyz(DVec3::ONE);
    DVec3::new(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z))
}

fn from_opponent(seen: DVec3) -> DVec3 {
    let y = (seen.x + 16.0) / 116.0;
    from_xyz(DVec3::new(y + seen.y / 500.0, y, y - seen.z / 200.0) * to_xyz(DVec3::ONE))
}

/// L*, a* and b* (CIE 15), a* and b* growing with L* as Hunt found.
fn perceived(rgb: DVec3) -> DVec3 {
    const BORDER: f64 = 6.0 / 29.0;
    let root = |t: f64| match t > BORDER.powi(3) {
        true => t.cbrt(),
        false => t / (3.0 * BORDER * BORDER) + 4.0 / 29.0,
    };
    let [x, y, z] = (to_xyz(rgb) / to_xyz(DVec3::ONE)).to_array().map(root);
    let lightness = 116.0 * y - 16.0;
    DVec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
}

/// HyAB: city blocks between lightness and chroma.
fn color_difference(a: DVec3, b: DVec3) -> f64 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// A colour difference as an error, 0..=1: small ones are spread over most of it, large ones pressed together.
fn color_error(difference: f64, largest: f64) -> f64 {
    let (difference, bend) = (difference.powf(COLOR_EXPONENT), BEND * largest);
    if difference < bend {
        BEND_ERROR / bend * difference
    } else {
        (BEND_ERROR + (difference - bend) / (largest - bend) * (1.0 - BEND_ERROR)).min(1.0)
    }
}

/// One number for each pixel.
struct Plane {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Without the detail that is too fine to be seen.
    fn filtered(&self, gaussians: &[[f64; 2]; 2], density: f64) -> Plane {
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * density).ceil() as i64;
        let parts = gaussians.map(|[weight, width]| {
            let kernel = kernel(radius, |x| (-PI * PI * (x / density).powi(2) / width).exp());
            let sum: f64 = kernel.iter().sum();
            (weight * (PI / width).sqrt() * sum * sum, kernel.iter().map(|k| k / sum).collect::<Vec<_>>())
        });
        let all: f64 = parts.iter().map(|(weight, _)| weight).sum();
        let mut seen = Plane { values: vec![0.0; self.values.len()], ..*self };
        for (weight, kernel) in parts.iter().filter(|(weight, _)| *weight > 0.0) {
            let part = (weight / all) as f32;
            let smooth = self.convolved(kernel, kernel);
            seen.values.iter_mut().zip(smooth.values).for_each(|(value, smooth)| *value += part * smooth);
        }
        seen
    }

    /// Strengths of edges and of points, from first and second derivatives of a Gaussian.
    fn features(&self, density: f64) -> Vec<[f32; 2]> {
        let deviation = 0.5 * FEATURE_WIDTH * density;
        let radius = (3.0 * deviation).ceil() as i64;
        let gaussian = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let smooth = kernel(radius, gaussian);
        let sum: f64 = smooth.iter().sum();
        let smooth: Vec<f64> = smooth.iter().map(|k| k / sum).collect();
        let edge = balanced(kernel(radius, |x| -x * gaussian(x)));
        let point = balanced(kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x)));
        let strength = |detector: &[f64]| {
            let (x, y) = (self.convolved(detector, &smooth), self.convolved(&smooth, detector));
            x.values.into_iter().zip(y.values).map(|(x, y)| x.hypot(y)).collect::<Vec<f32>>()
        };
        strength(&edge).into_iter().zip(strength(&point)).map(|(edge, point)| [edge, point]).collect()
    }

    /// The convolution with the product of two kernels of odd length.
    fn convolved(&self, along_x: &[f64], along_y: &[f64]) -> Plane {
        let Plane { width, height, .. } = *self;
        let mut across = vec![0.0f32; self.values.len()];
        let rows = across.par_chunks_exact_mut(width).zip(self.values.par_chunks_exact(width));
        rows.for_each(|(out, row)| {
            let radius = along_x.len() / 2;
            let mut padded = vec![row[0]; radius];
            padded.extend_from_slice(row);
            padded.resize(width + 2 * radius, row[width - 1]);
            for (value, window) in out.iter_mut().zip(padded.windows(along_x.len())) {
                *value = window.iter().zip(along_x).map(|(v, k)| f64::from(*v) * k).sum::<f64>() as f32;
            }
        });
        let mut values = vec![0.0f32; self.values.len()];
        values.par_chunks_exact_mut(width).enumerate().for_each(|(y, out)| {
            let mut sums = vec![0.0f64; width];
            for (i, k) in along_y.iter().enumerate() {
                let from = (y + i).saturating_sub(along_y.len() / 2).min(height - 1);
                let row = &across[from * width..(from + 1) * width];
                sums.iter_mut().zip(row).for_each(|(sum, v)| *sum += k * f64::from(*v));
            }
            out.iter_mut().zip(sums).for_each(|(value, sum)| *value = sum as f32);
        });
        Plane { width, height, values }
    }
}

/// A function at -radius..=radius.
fn kernel(radius: i64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (-radius..=radius).map(|x| value(x as f64)).collect()
}

/// A kernel whose positive numbers add up to 1, and its negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| kernel.iter().map(|k| (sign * k).max(0.0)).sum::<f64>();
    let (above, below) = (sum(1.0), sum(-1.0));
    kernel.iter().map(|k| if *k > 0.0 { k / above } else { k / below }).collect()
}

/// A picture of an error map: black, violet, red, orange and light yellow for 0 to 1, ever lighter.
///
/// - `map`: an error for each of `width` x `height` pixels; values are brought into 0..=1, missing ones are 0.
///
/// # Errors
/// [`PictureError::Size`].
///
/// # Source
/// Ours: straight lines between five colours.
pub fn error_map(width: u32, height: u32, map: &[f32]) -> Result<Picture, PictureError> {
    /// Linear sRGB.
    const RAMP: [[f32; 3]; 5] =
        [[0.0, 0.0, 0.0], [0.06, 0.006, 0.18], [0.5, 0.03, 0.14], [1.0, 0.33, 0.07], [1.0, 1.0, 0.75]];
    let mut picture = Picture::new(width, height)?;
    for (pixel, error) in picture.pixels_mut().iter_mut().zip(map) {
        let at = clipped(*error) * (RAMP.len() - 1) as f32;
        let below = (at as usize).min(RAMP.len() - 2);
        let part = at - below as f32;
        pixel.radiance = [0, 1, 2].map(|band| RAMP[below][band] * (1.0 - part) + RAMP[below + 1][band] * part);
        pixel.coverage = 1.0;
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (48, 32);

    fn picture(value: impl Fn(u32, u32) -> [f32; 3]) -> Picture {
        let mut picture = Picture::new(SIZE.0, SIZE.1).expect("small");
        let pixels = picture.pixels_mut().iter_mut().enumerate();
        pixels.for_each(|(i, pixel)| pixel.radiance = value(i as u32 % SIZE.0, i as u32 / SIZE.0));
        picture
    }

    /// Numbers of 0..1, row by row, from a linear congruential generator.
    fn noise(seed: u64) -> Picture {
        let state = std::cell::Cell::new(seed);
        let next = || {
            state.set(state.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
            (state.get() >> 40) as f32 / (1 << 24) as f32
        };
        picture(|_, _| std::array::from_fn(|_| next()))
    }

    /// Waves and ramps, and the same with a fifth of noise.
    fn smooth_and_noisy() -> [Picture; 2] {
        let smooth = picture(|x, y| {
            let (x, y) = (f64::from(x), f64::from(y));
            [0.5 + 0.5 * (0.3 * x).sin() * (0.2 * y).cos(), x / 48.0, y / 32.0].map(|value| value as f32)
        });
        let mut noisy = smooth.clone();
        for (pixel, n) in noisy.pixels_mut().iter_mut().zip(noise(1).pixels()) {
            let value = |band: usize| (pixel.radiance[band] + 0.2 * (n.radiance[band] - 0.5)).clamp(0.0, 1.0);
            pixel.radiance = [0, 1, 2].map(value);
        }
        [smooth, noisy]
    }

    fn mean(a: &Picture, b: &Picture) -> f64 {
        flip(a, b, PIXELS_PER_DEGREE).expect("same size").mean
    }

    #[test]
    fn errors_are_those_of_the_evaluator_of_its_authors() {
        // flip-evaluator 1.7 from PyPI: mean, and the errors of the pixels (0, 0), (24, 16) and (47, 31).
        let [smooth, noisy] = smooth_and_noisy();
        let cases = [
            (noise(1), noise(2), 67.0, 0.407525, [0.559397, 0.416215, 0.737552]),
            (smooth.clone(), noisy.clone(), 67.0, 0.109727, [0.188425, 0.098167, 0.157693]),
            (smooth, noisy, 20.0, 0.269909, [0.154621, 0.195887, 0.250712]),
        ];
        for (a, b, density, mean, errors) in cases {
            let ours = flip(&a, &b, density).expect("same size");
            assert!((ours.mean - mean).abs() < 1e-3, "{} {mean}", ours.mean);
            for (at, error) in [0, 16 * 48 + 24, 31 * 48 + 47].into_iter().zip(errors) {
                assert!((ours.map[at] - error).abs() < 1e-3, "{} {error}", ours.map[at]);
            }
        }
    }

    #[test]
    fn equal_pictures_have_no_error_and_the_order_does_not_matter() {
        let (a, b) = (noise(3), noise(4));
        assert_eq!(mean(&a, &a), 0.0);
        assert_eq!(flip(&a, &b, 67.0).expect("same size"), flip(&b, &a, 67.0).expect("same size"));
        assert!(flip(&a, &Picture::new(32, 48).expect("small"), 67.0).is_err());
    }

    #[test]
    fn black_and_white_differ_by_their_lightness_alone() {
        // |L*| = 100 without edges; blue and green, which differ most, have the error 1.
        let [black, white] = [0.0, 1.0].map(|value| picture(|_, _| [value; 3]));
        let largest = color_difference(perceived(DVec3::Y), perceived(DVec3::Z)).powf(COLOR_EXPONENT);
        let expected = BEND_ERROR + (1.0 - BEND_ERROR) * (100f64.powf(0.7) / largest - BEND) / (1.0 - BEND);
        assert!((mean(&black, &white) - expected).abs() < 1e-4 && (expected - 0.9674).abs() < 1e-3, "{expected}");
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|color| picture(|_, _| color));
        assert!((mean(&green, &blue) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn errors_grow_with_the_offset_and_stay_within_0_and_1() {
        let grey = picture(|_, _| [0.2; 3]);
        let mut last = 0.0;
        for offset in [0.01f32, 0.05, 0.2, 0.8, 5.0] {
            let error = mean(&grey, &picture(|_, _| [0.2 + offset; 3]));
            assert!(error > last || offset > 1.0 && error == last, "{offset}: {error}");
            last = error;
        }
        for density in [0.0, 1.0, 9.0, 200.0, f64::INFINITY] {
            let map = flip(&noise(5), &noise(6), density).expect("same size").map;
            assert!(map.iter().all(|error| (0.0..=1.0).contains(error)), "{density}");
        }
        let hostile = picture(|x, _| [f32::NAN, f32::INFINITY, -(x as f32)]);
        assert!(mean(&hostile, &grey).is_finite());
    }

    #[test]
    fn an_edge_is_seen_better_than_the_same_difference_of_an_area() {
        let area = picture(|_, _| [0.3; 3]);
        let line = picture(|x, _| [if x == 24 { 0.3 } else { 0.2 }; 3]);
        let ground = picture(|_, _| [0.2; 3]);
        let seen = flip(&line, &ground, 67.0).expect("same size").map;
        let away = flip(&area, &ground, 67.0).expect("same size").map;
        let detectors = (seen[16 * 48 + 23], seen[16 * 48]);
        assert!(detectors.0 > 0.05 && detectors.1 < 1e-3 && away[0] > 0.05, "{detectors:?} {}", away[0]);
    }

    #[test]
    fn an_error_map_grows_lighter_with_the_error() {
        let map: Vec<f32> = (0..=100u8).map(|i| f32::from(i) / 100.0).collect();
        let picture = error_map(101, 1, &map).expect("small");
        let luminance = |p: &super::super::Pixel| to_xyz(DVec3::from_array(p.radiance.map(f64::from))).y;
        let lights: Vec<f64> = picture.pixels().iter().map(luminance).collect();
        assert!(lights.windows(2).all(|pair| pair[0] < pair[1]) && lights[0] == 0.0 && lights[100] > 0.9);
    }
}
