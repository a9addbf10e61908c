//! Seeded random numbers, point sets in the unit square, and maps from it to what is sampled.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A stream of random numbers that depends on a seed and on what it is for, and on nothing else.
///
/// Give each pixel its own: then the picture is the same for any number of threads and any order of the pixels.
#[derive(Clone, Debug)]
pub struct RandomStream(Pcg64Mcg);

impl RandomStream {
    /// The stream for one purpose.
    ///
    /// - `seed`: of the whole picture or study.
    /// - `index`: of the pixel, ray or object; streams of different indices are unrelated.
    pub fn new(seed: u64, index: u64) -> Self {
        let state = u128::from(mix(seed ^ mix(index))) << 64 | u128::from(mix(index.wrapping_add(mix(!seed))));
        Self(Pcg64Mcg::from_seed(state.to_le_bytes()))
    }

    /// A number, uniform in 0..1, 1 excluded.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// A point, uniform in the unit square.
    #[inline]
    pub fn point(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }

    /// A whole number, uniform in `0..bound`; 0 if `bound` is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        if bound == 0 { 0 } else { self.0.random_range(0..bound) }
    }
}

/// Mixes the bits of a number, one to one: each bit of it flips about half of them.
///
/// # Source
/// Steele, Lea and Flood 2014 (SplitMix), constants of variant 13 by Stafford.
#[inline]
pub fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Point `index` of a sequence that fills the unit square evenly at any length, moved by a random shift.
///
/// Point n is (n / g, n / g^2) + shift, modulo 1, with g^3 = g + 1.
///
/// - `shift`: any point of the unit square; another one for each pixel makes their errors unrelated.
///
/// # Source
/// Roberts 2018, "The unreasonable effectiveness of quasirandom sequences" (R2).
#[inline]
pub fn r2_point(index: u32, shift: [f64; 2]) -> [f64; 2] {
    const G: f64 = 1.324_717_957_244_746;
    let place = |step: f64, shift: f64| (f64::from(index) * step + shift).fract();
    [place(1.0 / G, shift[0]), place(1.0 / (G * G), shift[1])]
}

/// A direction uniform over the unit sphere, from a point of the unit square.
#[inline]
pub fn sphere(point: [f64; 2]) -> DVec3 {
    around_z(1.0 - 2.0 * point[0], point[1])
}

/// A unit vector whose cosine with z is given, turned about z by a part of a whole turn.
#[inline]
pub fn around_z(cosine: f64, turn: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(sine * cos, sine * sin, cosine)
}

/// A point uniform in the unit disk, from a point of the unit square; squares around the middle become rings.
///
/// # Source
/// Shirley and Chiu 1997.
#[inline]
pub fn disk(point: [f64; 2]) -> [f64; 2] {
    let [x, y] = point.map(|a| 2.0 * a - 1.0);
    if x == 0.0 && y == 0.0 {
        return [0.0; 2];
    }
    let (radius, angle) = if x.abs() > y.abs() { (x, PI / 4.0 * (y / x)) } else { (y, PI / 2.0 - PI / 4.0 * (x / y)) };
    let (sin, cos) = angle.sin_cos();
    [radius * cos, radius * sin]
}

/// A point uniform in the unit disk across a direction, about the origin, from a point of the unit square.
///
/// - `normal`: unit length.
#[inline]
pub fn disk_across(normal: DVec3, point: [f64; 2]) -> DVec3 {
    let (x, y) = normal.any_orthonormal_pair();
    let [a, b] = disk(point);
    x * a + y * b
}

/// 1 − cos of the half angle under which a sphere is seen; none from inside.
///
/// - `offset`: from where it is seen to its middle.
#[inline]
pub fn cap(offset: DVec3, radius: f64) -> Option<f64> {
    let sine = radius / offset.length();
    (sine < 1.0).then(|| sine * sine / (1.0 + (1.0 - sine * sine).sqrt()))
}

/// The part in which a number falls, and where in it, 0..1: the middle of a part that is empty.
///
/// - `below`: the sum of the parts up to each, rising to 1.
pub fn part_of(below: &[f64], uniform: f64) -> (usize, f64) {
    let index = below.partition_point(|part| *part <= uniform).min(below.len() - 1);
    let from = if index == 0 { 0.0 } else { below[index - 1] };
    let size = below[index] - from;
    (index, if size > 0.0 { ((uniform - from) / size).clamp(0.0, 1.0_f64.next_down()) } else { 0.5 })
}

/// A direction over a surface with the pdf cos / pi, 1/sr, from a point of the unit square.
///
/// - `normal`: unit length.
#[inline]
pub fn cosine_hemisphere(point: [f64; 2], normal: DVec3) -> DVec3 {
    let [x, y] = disk(point);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    tangent * x + bitangent * y + normal * z
}

/// Barycentric weights of the second and third corner of a point uniform in a triangle, from a point of the square.
#[inline]
pub fn triangle(point: [f64; 2]) -> [f64; 2] {
    let root = point[0].sqrt();
    [root * (1.0 - point[1]), root * point[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of a function over an even set of points.
    fn mean(f: impl Fn([f64; 2]) -> f64) -> f64 {
        const COUNT: u32 = 20_000;
        (0..COUNT).map(|i| f(r2_point(i, [0.5, 0.5]))).sum::<f64>() / f64::from(COUNT)
    }

    #[test]
    fn streams_repeat_and_differ_by_seed_and_index() {
        let take = |seed, index| {
            let mut stream = RandomStream::new(seed, index);
            [0; 4].map(|_: i32| stream.uniform().to_bits())
        };
        assert_eq!(take(1, 2), take(1, 2));
        let all = [take(1, 2), take(2, 1), take(1, 3), take(2, 2), take(0, 0)];
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a.iter().zip(b).all(|(x, y)| x != y)));
        }
    }

    #[test]
    fn neighbouring_streams_are_uncorrelated() {
        let n = 20_000;
        let first = |i| RandomStream::new(9, i).uniform() - 0.5;
        let covariance = (0..n).map(|i| first(i) * first(i + 1)).sum::<f64>() / n as f64;
        let variance = (0..n).map(|i| first(i).powi(2)).sum::<f64>() / n as f64;
        assert!((variance - 1.0 / 12.0).abs() < 0.003, "{variance}");
        // The standard error of the correlation is 1 / sqrt(n) = 0.007.
        assert!((covariance / variance).abs() < 0.03, "{covariance}");
    }

    #[test]
    fn directions_have_the_moments_of_the_sphere() {
        assert!((mean(|p| sphere(p).length()) - 1.0).abs() < 1e-12);
        assert!(mean(|p| sphere(p).x).abs() < 1e-3);
        assert!((mean(|p| sphere(p).y.powi(2)) - 1.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn the_mean_cosine_of_a_cosine_hemisphere_is_two_thirds() {
        for normal in [DVec3::Z, -DVec3::Z, DVec3::new(1.0, 2.0, -3.0).normalize()] {
            assert!((mean(|p| cosine_hemisphere(p, normal).dot(normal)) - 2.0 / 3.0).abs() < 1e-3);
            assert!((mean(|p| cosine_hemisphere(p, normal).length()) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn triangle_and_disk_are_filled_evenly() {
        assert!((mean(|p| triangle(p)[0]) - 1.0 / 3.0).abs() < 1e-3);
        assert!((mean(|p| triangle(p)[1]) - 1.0 / 3.0).abs() < 1e-3);
        // The mean square of the radius of a unit disk is one half.
        assert!((mean(|p| disk(p).map(|x| x * x).iter().sum()) - 0.5).abs() < 1e-3);
    }
}
