//! Bloom: light that an eye scatters about bright points, by the point spread of its lens and cornea.
//!
//! The spread is a sum of Gaussians, each twice as wide as the one before, that a pyramid of pictures makes: time and memory
//! grow with the number of pixels, however far light is scattered.
//!
//! # Source
//! Spencer, Shirley, Zimmerman and Greenberg 1995, the spread of an eye by day, without its rings and rays. The pyramid is
//! that of Burt and Adelson 1983.

use crate::memory;
use crate::picture::{Picture, PictureError};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Parts of the light in the two hyperbolas of the spread; the rest stays within minutes of arc.
const PARTS: [f64; 2] = [0.478, 0.138];
/// Their strengths, 1/sr where degrees to the third and second power are divided.
const STRENGTHS: [f64; 2] = [20.91, 72.37];
/// Angle from the middle at which the hyperbolas begin to fall, degrees.
const CORE: f64 = 0.02;
/// Radius within which a Gaussian has half of its light, in standard deviations.
const HALF_WITHIN: f64 = 1.177_410_022_515_474_7;
/// Weights with which five pixels of a level make one of the next.
const DOWN: [f32; 5] = [0.0625, 0.25, 0.375, 0.25, 0.0625];

/// The part of the light that the hyperbolas scatter by less than an angle, degrees.
fn scattered_within(angle: f64) -> f64 {
    let square_degrees = 2.0 * PI * (PI / 180.0).powi(2);
    let (a, t) = (CORE, angle + CORE);
    let cubed = 0.5 / a - 1.0 / t + a / (2.0 * t * t);
    let squared = (t / a).ln() + a / t - 1.0;
    square_degrees * (PARTS[0] * STRENGTHS[0] * cubed + PARTS[1] * STRENGTHS[1] * squared)
}

/// Standard deviation of what a level of the pyramid spreads light by, pixels.
fn deviation(level: usize) -> f64 {
    (2.0 * (4f64.powi(level as i32) - 1.0) / 3.0).sqrt()
}

/// Scatters the light of a picture.
///
/// - `amount`: times what an eye scatters. `pixel_angle`: what a pixel spans, degrees, above 0.
///
/// # Errors
/// [`PictureError`] if there is no memory for the pyramid.
pub(super) fn scatter(picture: &mut Picture, amount: f64, pixel_angle: f64) -> Result<(), PictureError> {
    let bytes = picture.pixels.len() as u64 * 32;
    memory::reserve(bytes, || format!("bloom of {} x {} pixels", picture.width, picture.height))?;
    let (width, height) = (picture.width as usize, picture.height as usize);
    let base = Level { width, height, pixels: picture.pixels.iter().map(|pixel| pixel.radiance).collect() };
    let mut levels = vec![base];
    while let Some(last) = levels.last()
        && last.width.max(last.height) > 2
    {
        levels.push(last.smaller());
    }
    let weight = |level: usize| {
        let radius = deviation(level) * HALF_WITHIN * pixel_angle;
        amount * (scattered_within(radius * 2f64.sqrt()) - scattered_within(radius / 2f64.sqrt()))
    };
    let mut weights: Vec<f64> = (0..levels.len()).map(|level| if level == 0 { 0.0 } else { weight(level) }).collect();
    let sum: f64 = weights.iter().sum();
    // No more light is scattered than there is.
    weights.iter_mut().for_each(|weight| *weight /= sum.max(1.0));
    let kept = 1.0 - weights.iter().sum::<f64>();
    let mut weighted = levels.into_iter().zip(&weights).skip(1).rev();
    let Some((mut spread, weight)) = weighted.next() else { return Ok(()) };
    spread.scale(*weight as f32);
    for (mut level, weight) in weighted {
        level.scale(*weight as f32);
        level.add_larger(&spread);
        spread = level;
    }
    let mut shown = Level { width, height, pixels: picture.pixels.iter().map(|pixel| pixel.radiance).collect() };
    shown.scale(kept as f32);
    shown.add_larger(&spread);
    picture.pixels.iter_mut().zip(shown.pixels).for_each(|(pixel, radiance)| pixel.radiance = radiance);
    Ok(())
}

/// A picture of the pyramid.
struct Level {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

impl Level {
    fn scale(&mut self, factor: f32) {
        self.pixels.par_iter_mut().with_min_len(1 << 14).flatten_iter().for_each(|band| *band *= factor);
    }

    /// The pixel that is nearest to a place.
    fn at(&self, x: isize, y: isize) -> [f32; 3] {
        let held = |at: isize, count: usize| at.clamp(0, count as isize - 1) as usize;
        self.pixels[held(y, self.height) * self.width + held(x, self.width)]
    }

    /// The next level: every other pixel of every other row, after the weights have spread each.
    fn smaller(&self) -> Level {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut pixels = vec![[0.0; 3]; width * height];
        pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                for (down, part) in (-2..=2).zip(DOWN) {
                    for (across, share) in (-2..=2).zip(DOWN) {
                        let from = self.at(2 * x as isize + across, 2 * y as isize + down);
                        pixel.iter_mut().zip(from).for_each(|(sum, light)| *sum += part * share * light);
                    }
                }
            }
        });
        Level { width, height, pixels }
    }

    /// Adds the next level, spread by the same weights to the size of this one.
    fn add_larger(&mut self, next: &Level) {
        // A pixel is on one of the next level or between two.
        let taps = |at: usize| {
            let middle = (at / 2) as isize;
            match at % 2 {
                0 => [(middle - 1, 0.125), (middle, 0.75), (middle + 1, 0.125)],
                _ => [(middle, 0.5), (middle + 1, 0.5), (middle, 0.0)],
            }
        };
        self.pixels.par_chunks_mut(self.width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                for (down, part) in taps(y) {
                    for (across, share) in taps(x) {
                        let from = next.at(across, down);
                        pixel.iter_mut().zip(from).for_each(|(sum, light)| *sum += part * share * light);
                    }
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Pixel;

    /// A picture with one bright point in its middle.
    fn point(side: u32, light: f32) -> Picture {
        let mut picture = Picture::new(side, side).expect("small");
        let middle = (side / 2 * side + side / 2) as usize;
        picture.pixels_mut()[middle] = Pixel { radiance: [light; 3], coverage: 1.0 };
        picture
    }

    #[test]
    fn a_point_is_spread_as_the_eye_spreads_it() {
        let (side, angle) = (513, 0.05);
        let mut picture = point(side, 1.0);
        scatter(&mut picture, 1.0, angle).expect("small");
        for radius in [4, 8, 16, 32, 64, 100] {
            // The mean over a ring, over the spread that the source gives there.
            let ring = (0..360).map(|degree| {
                let (sine, cosine) = f64::from(degree).to_radians().sin_cos();
                let at = |part: f64| (f64::from(side / 2) + f64::from(radius) * part).round() as u32;
                f64::from(picture.get(at(cosine), at(sine)).expect("inside").radiance[1])
            });
            let mean = ring.sum::<f64>() / 360.0;
            let theta = f64::from(radius) * angle + CORE;
            let density = PARTS[0] * STRENGTHS[0] / theta.powi(3) + PARTS[1] * STRENGTHS[1] / theta.powi(2);
            let expected = density * (angle.to_radians()).powi(2);
            assert!((mean / expected - 1.0).abs() < 0.2, "{radius}: {}", mean / expected);
        }
    }

    #[test]
    fn even_light_stays_even_and_no_light_is_made() {
        let mut even = Picture::new(37, 20).expect("small");
        even.pixels_mut().fill(Pixel { radiance: [2.0; 3], coverage: 1.0 });
        scatter(&mut even, 1.0, 0.1).expect("small");
        assert!(even.pixels().iter().all(|p| p.radiance.iter().all(|light| (light - 2.0).abs() < 1e-5)));
        for amount in [0.5, 1.0, 100.0] {
            let mut picture = point(257, 1.0);
            scatter(&mut picture, amount, 0.1).expect("small");
            let sum: f64 = picture.pixels().iter().map(|p| f64::from(p.radiance[0])).sum();
            // What leaves the picture is lost.
            assert!((0.8..1.001).contains(&sum) && picture.pixels().iter().all(|p| p.radiance[0] >= 0.0), "{sum}");
        }
        for side in [1, 2, 3] {
            scatter(&mut point(side, 1.0), 1.0, 0.1).expect("small");
        }
    }
}
