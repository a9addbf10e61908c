//! From a colour to a smooth reflectance between 0 and 1 that has it under D65.
//!
//! The reflectance is a sigmoid of a quadratic in the wavelength. Its three coefficients are found by Gauss and
//! Newton's iteration, damped, along a path of colours from grey to the one that is asked for.

use super::observer::{VISIBLE, functions};
use super::{ColorError, Extrapolation, Spectrum, integral, shipped, srgb};
use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// Samples of a reflectance, nm apart.
const STEP: f64 = 5.0;
/// Rounds of the iteration for one colour on the path; a colour that is reached needs less than ten.
const ROUNDS: usize = 60;
/// Squared distance in linear sRGB at which a colour is reached.
const REACHED: f64 = 1e-28;
/// Colours on the path from grey, if one is not reached at once.
const PATH: usize = 16;
/// The largest coefficient: reflectances are then within 3e-13 of 0 or 1, and nothing overflows.
const MOST: f64 = 1e6;

/// A reflectance 1/2 + x / (2 √(1 + x²)) with x = a + b t + c t²; t runs from −1 at 360 nm to 1 at 830 nm.
///
/// # Source
/// Jakob and Hanika 2019, "A low-dimensional function space for efficient spectral upsampling".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothReflectance {
    coefficients: DVec3,
}

/// A smooth reflectance for a colour, and how well it has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The reflectance.
    pub reflectance: SmoothReflectance,
    /// Distance from the colour that was asked for, in linear sRGB. Below 1e-7 for all colours of sRGB, most of them
    /// below 1e-13; greater for colours that no surface has.
    pub error: f64,
}

/// Samples of t, and how much a reflectance of 1 there, linear to 0 at its neighbours, adds to linear sRGB under D65.
static WEIGHTS: LazyLock<Vec<(f64, DVec3)>> = LazyLock::new(|| {
    let count = ((VISIBLE.1 - VISIBLE.0) / STEP).round() as usize;
    let white = integral(&[&shipped::D65, &functions()[1]], VISIBLE.0, VISIBLE.1);
    let weight = |index: usize| {
        let at = VISIBLE.0 + STEP * index as f64;
        let hat =
            Spectrum::regular(at - STEP, STEP, vec![0.0, 1.0, 0.0], Extrapolation::Zero).expect("three samples rise");
        let sum = |f: &Spectrum| integral(&[&hat, &shipped::D65, f], VISIBLE.0, VISIBLE.1) / white;
        (place(at), srgb::from_xyz(DVec3::from_array(functions().each_ref().map(sum))))
    };
    (0..=count).map(weight).collect()
});

/// The place of a wavelength, nm, in −1..=1.
fn place(wavelength: f64) -> f64 {
    ((wavelength - VISIBLE.0) / (VISIBLE.1 - VISIBLE.0) * 2.0 - 1.0).clamp(-1.0, 1.0)
}

/// The sigmoid and its derivative.
fn sigmoid(x: f64) -> (f64, f64) {
    let square = 1.0 + x * x;
    let root = square.sqrt();
    // For negative x without cancellation.
    let value = if x >= 0.0 { 0.5 + 0.5 * x / root } else { 0.5 / (root * (root - x)) };
    (value, 0.5 / (square * root))
}

impl SmoothReflectance {
    /// The reflectance that looks like a colour in linear sRGB, 0..=1 in each band, under D65.
    ///
    /// A colour outside gets the nearest that the iteration finds; [`Fit::error`] says how near that is.
    ///
    /// # Errors
    /// [`ColorError::Color`] if it is not finite.
    pub fn from_linear_srgb(rgb: DVec3) -> Result<Fit, ColorError> {
        if !rgb.is_finite() {
            return Err(ColorError::Color(rgb));
        }
        let grey = (rgb.element_sum() / 3.0).clamp(1e-4, 1.0 - 1e-4);
        let start = DVec3::new((grey - 0.5) / (grey * (1.0 - grey)).sqrt(), 0.0, 0.0);
        let mut best = approach(start, rgb);
        if best.1 > REACHED {
            let mut coefficients = start;
            for step in 1..=PATH {
                let colour = DVec3::splat(grey).lerp(rgb, step as f64 / PATH as f64);
                let found = approach(coefficients, colour);
                coefficients = found.0;
                if step == PATH && found.1 < best.1 {
                    best = found;
                }
            }
        }
        Ok(Fit { reflectance: SmoothReflectance { coefficients: best.0 }, error: best.1.sqrt() })
    }

    /// The reflectance that has the given X, Y and Z under D65, Y of a perfect reflector being 1.
    ///
    /// # Errors
    /// [`ColorError::Color`] if they are not finite.
    pub fn from_xyz(xyz: DVec3) -> Result<Fit, ColorError> {
        SmoothReflectance::from_linear_srgb(srgb::from_xyz(xyz))
    }

    /// The reflectance at a wavelength, nm; 0..=1. Beyond 360 and 830 nm it is held.
    pub fn at(&self, wavelength: f64) -> f64 {
        let t = place(wavelength);
        sigmoid(self.coefficients.dot(DVec3::new(1.0, t, t * t))).0
    }

    /// Its samples in steps of 5 nm.
    pub fn spectrum(&self) -> Spectrum {
        let values = (0..WEIGHTS.len()).map(|i| self.at(VISIBLE.0 + STEP * i as f64)).collect();
        Spectrum::regular(VISIBLE.0, STEP, values, Extrapolation::Held).expect("a sigmoid is finite")
    }
}

/// The colour of coefficients, and its derivatives by them as columns.
fn color(coefficients: DVec3) -> (DVec3, DMat3) {
    let mut sum = (DVec3::ZERO, DMat3::ZERO);
    for &(t, weight) in WEIGHTS.iter() {
        let powers = DVec3::new(1.0, t, t * t);
        let (value, slope) = sigmoid(coefficients.dot(powers));
        sum.0 += weight * value;
        sum.1 += DMat3::from_cols(weight * slope * powers.x, weight * slope * powers.y, weight * slope * powers.z);
    }
    sum
}

/// Coefficients near those given, whose colour is as near to `target` as a descent finds, and the squared distance.
fn approach(start: DVec3, target: DVec3) -> (DVec3, f64) {
    let (mut at, mut damping) = (start, 1e-4);
    let (mut found, mut derivatives) = color(at);
    for _ in 0..ROUNDS {
        let missing = target - found;
        if missing.length_squared() <= REACHED {
            break;
        }
        let transposed = derivatives.transpose();
        let square = transposed * derivatives;
        let diagonal = DVec3::new(square.x_axis.x, square.y_axis.y, square.z_axis.z);
        let step = (square + DMat3::from_diagonal(diagonal * damping)).inverse() * (transposed * missing);
        let next = (at + step).clamp(DVec3::splat(-MOST), DVec3::splat(MOST));
        let (color, slopes) = if next.is_finite() { color(next) } else { (found, derivatives) };
        if (target - color).length_squared() < missing.length_squared() {
            (at, found, derivatives) = (next, color, slopes);
            damping = (damping * 0.1).max(1e-12);
        } else if damping > 1e12 {
            break;
        } else {
            damping *= 10.0;
        }
    }
    (at, (target - found).length_squared())
}

#[cfg(test)]
mod tests {
    use super::super::observer::surface_tristimulus;
    use super::*;

    #[test]
    fn every_colour_of_srgb_comes_back_from_its_reflectance() {
        // A grid over the whole gamut with all corners, then dark and pale colours beside its faces.
        let steps = 8;
        let grid = |i: i32| f64::from(i) / f64::from(steps);
        let mut colors: Vec<DVec3> = (0..(steps + 1) * (steps + 1) * (steps + 1))
            .map(|i| DVec3::new(grid(i % 9), grid(i / 9 % 9), grid(i / 81)))
            .collect();
        colors.extend([1e-3, 1e-6].into_iter().flat_map(|d| DVec3::AXES.map(|axis| axis * d)));
        colors.extend([1e-3, 1e-6].into_iter().flat_map(|d| DVec3::AXES.map(|axis| DVec3::ONE - axis * d)));
        for rgb in colors {
            let fit = SmoothReflectance::from_linear_srgb(rgb).expect("a fit");
            assert!(fit.error < 1e-7, "{rgb}: {}", fit.error);
        }
    }

    #[test]
    fn the_error_is_that_of_the_exact_integrals() {
        for rgb in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.7, 0.2, 0.1), DVec3::new(0.0, 0.5, 1.0)] {
            let spectrum = SmoothReflectance::from_linear_srgb(rgb).expect("a fit").reflectance.spectrum();
            assert!(spectrum.samples().all(|(_, value)| (0.0..=1.0).contains(&value)));
            let back = srgb::from_xyz(surface_tristimulus(&spectrum, &shipped::D65).expect("light"));
            assert!((back - rgb).length() < 1e-9, "{rgb} {back}");
        }
    }

    #[test]
    fn a_colour_of_no_surface_gets_a_near_one_and_its_error() {
        for rgb in [DVec3::splat(2.0), DVec3::new(-0.5, 1.2, -0.5), DVec3::new(0.0, 0.0, 1e9)] {
            let fit = SmoothReflectance::from_linear_srgb(rgb).expect("a fit");
            assert!(fit.error > 1e-3 && fit.error.is_finite());
            assert!((0..100).all(|i| (0.0..=1.0).contains(&fit.reflectance.at(f64::from(i) * 10.0))));
        }
        assert!(SmoothReflectance::from_linear_srgb(DVec3::new(f64::NAN, 0.0, 0.0)).is_err());
    }

    #[test]
    fn colours_of_the_checker_get_reflectances_like_theirs() {
        for name in ["dark_skin", "foliage", "blue_sky", "neutral_5"] {
            let patch = shipped::reflectance(name).expect("a patch");
            let fit =
                SmoothReflectance::from_xyz(surface_tristimulus(&patch, &shipped::D65).expect("light")).expect("a fit");
            let squares = (420..=680).map(|w| (fit.reflectance.at(f64::from(w)) - patch.at(f64::from(w))).powi(2));
            assert!((squares.sum::<f64>() / 261.0).sqrt() < 0.06, "{name}");
        }
    }
}
