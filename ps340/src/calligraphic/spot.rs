//! The Gaussian spot, cut at 4.5 standard deviations.
//!
//! Lengths are in standard deviations of the spot. With g the density exp(-x^2/2)/sqrt(2 pi) on
//! -4.5..=4.5, divided by its integral there so that no light is lost:
//!
//! - written(x) = integral of g from -4.5 to x,
//! - rise(x) = g(x) - g(4.5) = - integral of t g(t) from -4.5 to x.
//!
//! A beam that starts at 0 with current i and gains k per unit of length until it stops at L leaves at u
//!
//!   integral of (i + k s) g(u - s) for s = 0..L
//!   = (i + k u) (written(u) - written(u - L)) + k (rise(u) - rise(u - L)).
//!
//! The functions compute both sides of a choice before they choose, so that the compiler can work on eight
//! pixels with one instruction.
//!
//! As written(-x) = 1 - written(x) holds to the last bit here, approximation errors cancel in the total light.

/// Where the spot ends, in standard deviations.
pub(super) const REACH: f32 = 4.5;
/// Part of a whole Gaussian that lies beyond [`REACH`] on one side.
const TAIL: f32 = 3.397_673e-6;
/// Density of a whole Gaussian at [`REACH`].
const EDGE: f32 = 1.598_374e-5;
/// One over the integral of a whole Gaussian between -[`REACH`] and [`REACH`].
const WHOLE: f32 = 1.0 + 2.0 * TAIL;
/// 1 / sqrt(2 pi).
const DENSITY: f32 = 0.398_942_3;

/// Light across a long stroke of intensity 1 at distance `v` from it: 1 at the centre, 0 beyond the reach.
#[inline(always)]
pub(super) fn across(v: f32) -> f32 {
    let square = v * v;
    let light = bell(square) * WHOLE;
    if square <= REACH * REACH { light } else { 0.0 }
}

/// Density of a dot at distances `u` and `v` along two perpendicular directions, for [`across`] = 1 in `v`.
#[inline(always)]
pub(super) fn dot(u: f32, v: f32) -> f32 {
    let (along, across) = (u * u, v * v);
    let light = bell(along + across) * (DENSITY * WHOLE * WHOLE);
    if greater(along, across) <= REACH * REACH { light } else { 0.0 }
}

/// The functions written and rise of the module's text, at `x`.
///
/// Error: 4e-7 in written, 1e-7 in rise.
#[inline(always)]
pub(super) fn along(x: f32) -> (f32, f32) {
    let distance = lesser(x.abs(), REACH);
    let density = bell(distance * distance) * DENSITY;
    let beyond = greater(density * mills_ratio(distance) - TAIL, 0.0) * WHOLE;
    let within = 1.0 - beyond;
    let written = if x < 0.0 { beyond } else { within };
    (written, greater(density - EDGE, 0.0) * WHOLE)
}

/// The lesser of two numbers; the second if one is NaN. One instruction, unlike `f32::min`.
#[inline(always)]
pub(super) fn lesser(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}

/// The greater of two numbers; the second if one is NaN. One instruction, unlike `f32::max`.
#[inline(always)]
pub(super) fn greater(one: f32, other: f32) -> f32 {
    if one > other { one } else { other }
}

/// (1 - Phi(x)) / phi(x) for x = 0..=4.5: the tail of the normal distribution over its density.
///
/// Weighted minimax polynomial of degree 9: error times phi(x) at most 2.5e-7. Fit is ours. The terms are
/// summed in pairs (Estrin's scheme), as waiting for the steps of Horner's rule takes longer.
#[inline(always)]
fn mills_ratio(x: f32) -> f32 {
    let square = x * x;
    let fourth = square * square;
    let low = (1.253_313_5 - 9.999_513_5e-1 * x) + (6.260_435_4e-1 - 3.303_378_8e-1 * x) * square;
    let middle = (1.492_052_2e-1 - 5.580_434_3e-2 * x) + (1.605_166_9e-2 - 3.205_655e-3 * x) * square;
    let high = 3.845_851_8e-4 - 2.050_118_4e-5 * x;
    low + (middle + high * fourth) * fourth
}

/// exp(-square / 2) for square = 0..=160, 2e-35 beyond. Relative error 4e-7 up to 9, then 2e-6.
///
/// 2^t with t = whole + fraction: the fraction by a minimax polynomial of degree 5 (7.5e-8, fit is ours),
/// the whole part added to the exponent's bits.
#[inline(always)]
fn bell(square: f32) -> f32 {
    /// 1.5 * 2^23: adding it rounds to a whole number and leaves that in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let power = lesser(square, 160.0) * (-0.5 * std::f32::consts::LOG2_E);
    let rounded = power + ROUND;
    let fraction = power - (rounded - ROUND);
    let low = 1.0 + 6.931_469_6e-1 * fraction;
    let middle = 2.402_212e-1 + 5.550_714e-2 * fraction;
    let high = 9.675_548e-3 + 1.327_632_3e-3 * fraction;
    let fraction_square = fraction * fraction;
    let mantissa = low + (middle + high * fraction_square) * fraction_square;
    f32::from_bits(mantissa.to_bits().wrapping_add(rounded.to_bits() << 23))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral of f from a to b by Gauss-Legendre with three points on each of 2000 parts.
    fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
        let part = (b - a) / 2000.0;
        let node = 0.6f64.sqrt() / 2.0;
        (0..2000)
            .map(|index| {
                let middle = a + (f64::from(index) + 0.5) * part;
                (5.0 * (f(middle - node * part) + f(middle + node * part)) + 8.0 * f(middle)) / 18.0 * part
            })
            .sum()
    }

    fn normal(x: f64) -> f64 {
        (-x * x / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt()
    }

    #[test]
    fn bell_is_the_gaussian_to_3e_7() {
        for step in 0..=16_000 {
            let square = step as f32 * 0.01;
            let value = f64::from(bell(square));
            assert!((value / (-0.5 * f64::from(square)).exp() - 1.0).abs() < 2e-6 * f64::from(square / 20.0).max(0.15));
        }
        assert!(bell(1e30) < 1e-30);
    }

    #[test]
    fn written_and_rise_are_integrals_of_the_cut_gaussian() {
        let whole = integral(normal, -4.5, 4.5);
        for step in -100..=100 {
            let x = step as f32 * 0.05;
            let end = f64::from(x).clamp(-4.5, 4.5);
            let (written, rise) = along(x);
            let exact = integral(normal, -4.5, end) / whole;
            let moment = -integral(|t| t * normal(t), -4.5, end) / whole;
            assert!((f64::from(written) - exact).abs() < 4e-7, "written({x})");
            assert!((f64::from(rise) - moment).abs() < 1e-7, "rise({x})");
        }
    }

    #[test]
    fn written_is_exactly_symmetric_and_saturates() {
        for step in 1..=1000 {
            let x = step as f32 * 0.01;
            let (right, left) = (along(x).0, along(-x).0);
            assert!((right + left - 1.0).abs() <= f32::EPSILON);
        }
        assert_eq!(along(4.5), (1.0, 0.0));
        assert_eq!(along(-1e9), (0.0, 0.0));
    }

    #[test]
    fn the_constants_are_those_of_the_normal_distribution() {
        assert!((f64::from(EDGE) / normal(4.5) - 1.0).abs() < 1e-6);
        assert!((f64::from(TAIL) / integral(normal, 4.5, 14.0) - 1.0).abs() < 1e-6);
        assert!((f64::from(WHOLE) * integral(normal, -4.5, 4.5) - 1.0).abs() < 1e-7);
    }
}
