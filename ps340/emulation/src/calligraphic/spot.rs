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
//! The functions compute both sides of a choice before they choose, so that the compiler can work on many
//! pixels with one instruction. They consist of additions, multiplications, fused multiply-adds, choices and
//! one shift of bits in 32-bit floating point, so that a shader can repeat them.
//!
//! As written(-x) = 1 - written(x) holds to the last bit here, approximation errors cancel in the total light.

/// Where the spot ends, in standard deviations.
pub(super) const REACH: f32 = 4.5;
/// Density of a whole Gaussian at [`REACH`].
const EDGE: f32 = 1.598_374e-5;
/// One over the integral of a whole Gaussian between -[`REACH`] and [`REACH`].
const WHOLE: f32 = 1.000_006_8;
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

/// The position in the spot that counts for `x`: beyond the reach nothing changes any more.
#[inline(always)]
pub(super) fn within(x: f32) -> f32 {
    greater(lesser(x, REACH), -REACH)
}

/// The function written of the module's text less one half, for `x` [`within`] the reach. Error: 5e-7.
///
/// x times a polynomial of x^2, in the variable 2 x^2 / 4.5^2 - 1 in which no terms cancel (cut
/// Chebyshev series of degree 11, 2.6e-7; fit is ours).
#[inline(always)]
pub(super) fn half_written(x: f32) -> f32 {
    const TERMS: [f32; 12] = [
        1.569_06e-1,
        -7.719_028e-2,
        5.470_156e-2,
        -4.019_157e-2,
        2.828_412_3e-2,
        -1.856_137_2e-2,
        1.143_930_4e-2,
        -6.302_321e-3,
        2.716_296e-3,
        -1.289_294_6e-3,
        9.806_993e-4,
        -3.820_862_7e-4,
    ];
    let t = (x * x).mul_add(2.0 / (REACH * REACH), -1.0);
    // Pairs of terms (Estrin's scheme), as waiting for the steps of Horner's rule takes longer.
    let pair = |first: usize| TERMS[first + 1].mul_add(t, TERMS[first]);
    let square = t * t;
    let low = pair(2).mul_add(square, pair(0));
    let middle = pair(6).mul_add(square, pair(4));
    let high = pair(10).mul_add(square, pair(8));
    let fourth = square * square;
    x * high.mul_add(fourth, middle).mul_add(fourth, low)
}

/// The function rise of the module's text, for `x` [`within`] the reach. Error: 1e-7.
#[inline(always)]
pub(super) fn rise(x: f32) -> f32 {
    bell(x * x).mul_add(DENSITY * WHOLE, -EDGE * WHOLE)
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

/// exp(-square / 2) for square = 0..=160, anything beyond. Relative error 4e-7 up to 9, then 2e-6.
///
/// 2^t with t = whole + fraction: the fraction by a minimax polynomial of degree 5 (7.5e-8, fit is ours),
/// the whole part added to the exponent's bits.
#[inline(always)]
pub(super) fn bell(square: f32) -> f32 {
    /// 1.5 * 2^23: adding it rounds to a whole number and leaves that in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let power = square * (-0.5 * std::f32::consts::LOG2_E);
    let rounded = power + ROUND;
    let fraction = power - (rounded - ROUND);
    let low = 6.931_469_6e-1_f32.mul_add(fraction, 1.0);
    let middle = 5.550_714e-2_f32.mul_add(fraction, 2.402_212e-1);
    let high = 1.327_632_3e-3_f32.mul_add(fraction, 9.675_548e-3);
    let square = fraction * fraction;
    let mantissa = high.mul_add(square, middle).mul_add(square, low);
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

    fn written(x: f32) -> f32 {
        0.5 + half_written(within(x))
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
    }

    #[test]
    fn written_and_rise_are_integrals_of_the_cut_gaussian() {
        let whole = integral(normal, -4.5, 4.5);
        for step in -100..=100 {
            let x = step as f32 * 0.05;
            let end = f64::from(x).clamp(-4.5, 4.5);
            let (written, rise) = (written(x), rise(within(x)));
            let exact = integral(normal, -4.5, end) / whole;
            let moment = -integral(|t| t * normal(t), -4.5, end) / whole;
            assert!((f64::from(written) - exact).abs() < 5e-7, "written({x})");
            assert!((f64::from(rise) - moment).abs() < 1e-7, "rise({x})");
        }
    }

    #[test]
    fn written_is_symmetric_and_saturates() {
        for step in 1..=1000 {
            let x = step as f32 * 0.01;
            assert!((written(x) + written(-x) - 1.0).abs() <= f32::EPSILON);
        }
        assert!((written(4.5) - 1.0).abs() < 5e-7 && written(-1e9).abs() < 5e-7);
        assert_eq!(written(4.5), written(f32::MAX));
        assert_eq!(half_written(within(9.0)) + half_written(within(-9.0)), 0.0);
        assert!(rise(REACH).abs() < 1e-9 && rise(REACH) == rise(within(-1e9)));
    }

    #[test]
    fn the_constants_are_those_of_the_normal_distribution() {
        assert!((f64::from(EDGE) / normal(4.5) - 1.0).abs() < 1e-6);
        assert!((f64::from(WHOLE) * integral(normal, -4.5, 4.5) - 1.0).abs() < 1e-7);
    }
}
