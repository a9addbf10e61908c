//! Gradient noise: a smooth function of space without period, between -1 and 1, of one frequency.

use super::sampling::mix;
use glam::{DVec3, I64Vec3};

/// Gradient noise of lattice spacing 1: 0 at all points of whole numbers, mean 0.
///
/// # Source
/// Perlin 2002, improving noise: the polynomial of fifth degree and the twelve gradients.
pub fn noise(at: DVec3) -> f64 {
    if is_beyond(at) {
        return 0.0;
    }
    let floor = at.floor();
    let cell = floor.as_i64vec3();
    let p = at - floor;
    let fade = p * p * p * (p * (p * 6.0 - 15.0) + 10.0);
    let corner = |x: i64, y: i64, z: i64| {
        gradient(hash(cell + I64Vec3::new(x, y, z)), p - DVec3::new(x as f64, y as f64, z as f64))
    };
    let between = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let edge = |y: i64, z: i64| between(corner(0, y, z), corner(1, y, z), fade.x);
    between(between(edge(0, 0), edge(1, 0), fade.y), between(edge(0, 1), edge(1, 1), fade.y), fade.z)
}

/// How gradient noise changes from place to place: its derivatives along x, y and z.
///
/// They are continuous, and 0.704 in the root of the mean square.
pub fn noise_slope(at: DVec3) -> DVec3 {
    if is_beyond(at) {
        return DVec3::ZERO;
    }
    let floor = at.floor();
    let (cell, p) = (floor.as_i64vec3(), at - floor);
    let fade = p * p * p * (p * (p * 6.0 - 15.0) + 10.0);
    let fade_slope = p * p * (p * (p * 30.0 - 60.0) + 30.0);
    let sides =
        |axis: usize| [(1.0 - fade[axis], -fade_slope[axis], p[axis]), (fade[axis], fade_slope[axis], p[axis] - 1.0)];
    let (along_x, along_y, along_z) = (sides(0), sides(1), sides(2));
    let mut slope = DVec3::ZERO;
    for (x, (wx, sx, px)) in (0..).zip(along_x) {
        // Corners share the first steps of their hashes.
        let of_x = mix(cell.x.wrapping_add(x) as u64);
        for (y, (wy, sy, py)) in (0..).zip(along_y) {
            let of_y = mix(of_x.wrapping_add(cell.y.wrapping_add(y) as u64));
            for (z, (wz, sz, pz)) in (0..).zip(along_z) {
                let direction = direction(mix(of_y.wrapping_add(cell.z.wrapping_add(z) as u64)));
                let height = direction.dot(DVec3::new(px, py, pz));
                slope += direction * (wx * wy * wz) + DVec3::new(sx * wy * wz, wx * sy * wz, wx * wy * sz) * height;
            }
        }
    }
    slope
}

/// Whether a place is beyond the whole numbers that doubles can count: there is no lattice.
fn is_beyond(at: DVec3) -> bool {
    !at.is_finite() || at.abs().max_element() >= 1e15
}

/// Octaves of noise, each of twice the frequency and half the height of the one before; what is finer than `width` is
/// left out, so that it is the mean over about that much.
pub fn octaves(at: DVec3, count: u32, width: f64) -> f64 {
    let (mut sum, mut frequency, mut height) = (0.0, 1.0, 1.0);
    for octave in 0..count {
        let part = remaining(width * frequency);
        if part == 0.0 {
            break;
        }
        // Lattices that do not lie on each other: their zeros would add up to a grid that can be seen.
        let shift = f64::from(octave) * 17.31;
        sum += part * height * noise(at * frequency + DVec3::splat(shift));
        frequency *= 2.0;
        height *= 0.5;
    }
    sum
}

/// How much is left of noise whose mean is taken over a part of its lattice spacing.
///
/// # Source
/// Apodaca and Gritz 2000, Advanced RenderMan, filtered noise.
fn remaining(width: f64) -> f64 {
    let t = ((width - 0.2) / (0.75 - 0.2)).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// A number without pattern for a point of the lattice.
fn hash(cell: I64Vec3) -> u64 {
    cell.to_array().into_iter().fold(0, |state: u64, x| mix(state.wrapping_add(x as u64)))
}

/// One of the twelve directions to the middles of the edges of a cube.
fn direction(hash: u64) -> DVec3 {
    let sign = |bit: u64| f64::from_bits(1.0_f64.to_bits() | (hash >> bit & 1) << 63);
    match hash % 3 {
        0 => DVec3::new(sign(40), sign(41), 0.0),
        1 => DVec3::new(0.0, sign(40), sign(41)),
        _ => DVec3::new(sign(41), 0.0, sign(40)),
    }
}

/// The product with one of the twelve directions to the middles of the edges of a cube.
fn gradient(hash: u64, p: DVec3) -> f64 {
    let [a, b] = match hash % 3 {
        0 => [p.x, p.y],
        1 => [p.y, p.z],
        _ => [p.z, p.x],
    };
    let sign = |bit: u64, x: f64| if hash >> bit & 1 == 0 { x } else { -x };
    sign(40, a) + sign(41, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: u32) -> impl Iterator<Item = DVec3> {
        (0..count).map(|i| f64::from(i) * DVec3::new(0.377_132, 0.618_034, 0.290_61) - DVec3::splat(100.0))
    }

    #[test]
    fn noise_stays_within_one_and_has_the_mean_zero() {
        let values: Vec<f64> = points(100_000).map(noise).collect();
        assert!(values.iter().all(|value| value.abs() <= 1.0));
        let mean = values.iter().sum::<f64>() / 1e5;
        let square = values.iter().map(|value| value * value).sum::<f64>() / 1e5;
        assert!(mean.abs() < 3e-3 && (0.04..0.2).contains(&square), "{mean} {square}");
    }

    #[test]
    fn noise_vanishes_on_the_lattice_and_is_smooth_across_it() {
        for at in [DVec3::ZERO, DVec3::new(3.0, -7.0, 1e6)] {
            assert_eq!(noise(at), 0.0);
            let step = DVec3::new(1e-6, 0.0, 0.0);
            let slopes = [noise(at + step) / 1e-6, -noise(at - step) / 1e-6];
            assert!((slopes[0] - slopes[1]).abs() < 1e-3, "{slopes:?}");
        }
        assert_eq!(noise(DVec3::splat(1e300)), 0.0);
        assert_eq!(noise(DVec3::splat(f64::NAN)), 0.0);
    }

    #[test]
    fn slopes_are_those_of_the_noise() {
        const STEP: f64 = 1e-5;
        let mut square = 0.0;
        for at in points(20_000) {
            let slope = noise_slope(at);
            let found = DVec3::AXES.map(|axis| (noise(at + axis * STEP) - noise(at - axis * STEP)) / (2.0 * STEP));
            assert!((slope - DVec3::from(found)).length() < 1e-7, "{at}: {slope} {found:?}");
            square += slope.length_squared() / 3.0 / 20_000.0;
        }
        assert!((square.sqrt() - 0.704).abs() < 0.01, "{}", square.sqrt());
        assert_eq!(noise_slope(DVec3::splat(f64::INFINITY)), DVec3::ZERO);
    }

    #[test]
    fn octaves_that_are_finer_than_the_width_are_left_out() {
        for at in points(100) {
            assert_eq!(octaves(at, 8, 0.8), 0.0);
            assert!((octaves(at, 8, 0.1) - octaves(at, 3, 0.1)).abs() <= 0.1 + 1e-12);
            assert_eq!(octaves(at, 1, 0.0), noise(at));
        }
    }
}
