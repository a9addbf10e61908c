//! Numbers for predicates: one that knows its error, and one that has none.
//!
//! A formula is written once over [`Arithmetic`]. It is first evaluated with [`RoundedNumber`], whose error bound says
//! whether the sign is certain, and only if it is not with [`ExactNumber`].

use dashu_int::{IBig, Sign, UBig, ops::BitTest};
use std::ops::{Add, Mul, Sub};

/// Arithmetic of sums, differences and products, with which a formula is evaluated.
pub trait Arithmetic:
    Clone + From<f64> + Add<Output = Self> + Sub<Output = Self> + for<'a> Mul<&'a Self, Output = Self>
{
}

impl<N> Arithmetic for N where N: Clone + From<f64> + Add<Output = N> + Sub<Output = N> + for<'a> Mul<&'a N, Output = N> {}

/// Half the distance from 1 to the next number: the relative error of one operation.
const UNIT: f64 = f64::EPSILON / 2.0;
/// Factor by which error bounds are enlarged, since they are rounded themselves; far more than any formula here
/// gathers.
const SLACK: f64 = 1.0 + 1e-12;

/// A rounded number and a bound on its distance from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedNumber {
    /// The number as it came out.
    pub value: f64,
    /// The true number is at most so far away; infinite or NaN if nothing is known.
    pub error: f64,
}

impl RoundedNumber {
    /// The sign, -1.0, 0.0 or 1.0, if the error leaves no doubt.
    pub fn sign(self) -> Option<f64> {
        if self.value.abs() > self.error * SLACK {
            Some(self.value.signum())
        } else {
            (self.value == 0.0 && self.error == 0.0).then_some(0.0)
        }
    }

    /// The quotient; its error is infinite if the divisor may be 0.
    pub fn over(self, divisor: RoundedNumber) -> RoundedNumber {
        let least = divisor.value.abs() - divisor.error * SLACK;
        if least <= 0.0 || least.is_nan() {
            return RoundedNumber { value: self.value / divisor.value, error: f64::INFINITY };
        }
        let value = self.value / divisor.value;
        let error = (self.error + value.abs() * divisor.error) / least + UNIT * value.abs() + f64::MIN_POSITIVE;
        RoundedNumber { value, error }
    }
}

impl From<f64> for RoundedNumber {
    fn from(value: f64) -> RoundedNumber {
        RoundedNumber { value, error: 0.0 }
    }
}

impl Add for RoundedNumber {
    type Output = RoundedNumber;
    #[inline]
    fn add(self, other: RoundedNumber) -> RoundedNumber {
        let value = self.value + other.value;
        RoundedNumber { value, error: self.error + other.error + UNIT * value.abs() }
    }
}

impl Sub for RoundedNumber {
    type Output = RoundedNumber;
    #[inline]
    fn sub(self, other: RoundedNumber) -> RoundedNumber {
        let value = self.value - other.value;
        RoundedNumber { value, error: self.error + other.error + UNIT * value.abs() }
    }
}

impl Mul<&RoundedNumber> for RoundedNumber {
    type Output = RoundedNumber;
    #[inline]
    fn mul(self, other: &RoundedNumber) -> RoundedNumber {
        let value = self.value * other.value;
        // A product of nonzero numbers may fall below the smallest one; a product with a true 0 is 0.
        let lost = if value.abs() > f64::MIN_POSITIVE || self.value == 0.0 || other.value == 0.0 {
            0.0
        } else {
            f64::MIN_POSITIVE
        };
        let error = self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        RoundedNumber { value, error: error + UNIT * value.abs() + lost }
    }
}

/// A double-double number, of twice the digits: a rounded one, and what it lacks (Dekker 1971).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// A sum and what its rounding lost, |a| >= |b| (Dekker 1971).
fn fast_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// A sum and what its rounding lost (Knuth 1969).
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// A product and what its rounding lost (Veltkamp and Dekker 1971).
fn product(a: f64, b: f64) -> DoubleDouble {
    let halves = |x: f64| {
        let scaled = x * 134_217_729.0;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    let high = a * b;
    DoubleDouble { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
}

impl DoubleDouble {
    /// The number nearest to it.
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    /// The quotient.
    pub fn over(self, divisor: DoubleDouble) -> DoubleDouble {
        let quotient = self.high / divisor.high;
        let rest = self - DoubleDouble::from(quotient) * &divisor;
        fast_sum(quotient, (rest.high + rest.low) / divisor.high)
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> DoubleDouble {
        DoubleDouble { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let middle = fast_sum(high.high, high.low + low.high);
        fast_sum(middle.high, middle.low + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        Add::add(self, DoubleDouble { high: -other.high, low: -other.low })
    }
}

impl Mul<&DoubleDouble> for DoubleDouble {
    type Output = DoubleDouble;
    fn mul(self, other: &DoubleDouble) -> DoubleDouble {
        let high = product(self.high, other.high);
        fast_sum(high.high, high.low + (self.high * other.low + self.low * other.high))
    }
}

/// A number without error: an integer of any length times a power of two.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExactNumber {
    integer: IBig,
    /// Power of two.
    exponent: i32,
}

impl ExactNumber {
    /// The sign: -1.0, 0.0 or 1.0.
    pub fn sign(&self) -> f64 {
        if self.integer.is_zero() {
            0.0
        } else if self.integer.sign() == Sign::Negative {
            -1.0
        } else {
            1.0
        }
    }

    /// This number with the other sign.
    pub fn negated(self) -> ExactNumber {
        ExactNumber { integer: -self.integer, exponent: self.exponent }
    }

    /// The quotient, rounded to the nearest `f64` but for a doubt in the last bit at a tie.
    ///
    /// # Panics
    /// If the divisor is 0.
    pub fn over(&self, divisor: &ExactNumber) -> f64 {
        let (sign, dividend) = self.integer.clone().into_parts();
        let (divisor_sign, denominator) = divisor.integer.clone().into_parts();
        // A quotient of at least 64 bits, the rest noted in its last bit.
        let shift = (66 + denominator.bit_len() as i64 - dividend.bit_len() as i64).max(0) as usize;
        let shifted: UBig = dividend << shift;
        let mut quotient = &shifted / &denominator;
        if &quotient * &denominator != shifted {
            quotient |= UBig::ONE;
        }
        let magnitude = scaled(&quotient, i64::from(self.exponent) - i64::from(divisor.exponent) - shift as i64);
        if sign == divisor_sign { magnitude } else { -magnitude }
    }

    /// The integer at the lower of two exponents, and that exponent.
    fn aligned(self, other: ExactNumber) -> (IBig, IBig, i32) {
        let exponent = self.exponent.min(other.exponent);
        let shift = |number: ExactNumber| match (number.exponent - exponent) as usize {
            0 => number.integer,
            bits => number.integer << bits,
        };
        (shift(self), shift(other), exponent)
    }
}

/// An integer times a power of two, rounded to the nearest number.
fn scaled(integer: &UBig, exponent: i64) -> f64 {
    let length = integer.bit_len() as i64;
    if length == 0 {
        return 0.0;
    }
    // 64 bits are kept, with the rest noted in the last one, so that the one rounding to 53 bits is right.
    let drop = (length - 64).max(0) as usize;
    let mut top = u64::try_from(integer >> drop).unwrap_or(u64::MAX);
    if drop > 0 && !(integer & ((UBig::ONE << drop) - UBig::ONE)).is_zero() {
        top |= 1;
    }
    let power = exponent + drop as i64;
    // In two steps, as a power of two may lie outside the range where the product does not.
    let half = power / 2;
    let pow = |e: i64| 2f64.powi(e.clamp(-1074, 1023) as i32);
    if length + exponent > 1100 {
        return f64::INFINITY;
    }
    if length + exponent < -1100 {
        return 0.0;
    }
    top as f64 * pow(half) * pow(power - half)
}

impl From<f64> for ExactNumber {
    /// # Panics
    /// If the number is not finite, which every door to the geometry refuses.
    fn from(value: f64) -> ExactNumber {
        assert!(value.is_finite(), "{value} has no exact value");
        if value == 0.0 {
            return ExactNumber::default();
        }
        let bits = value.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        let zeros = mantissa.trailing_zeros();
        let integer = IBig::from((mantissa >> zeros) as i64 * if value < 0.0 { -1 } else { 1 });
        ExactNumber { integer, exponent: exponent + zeros as i32 }
    }
}

impl Add for ExactNumber {
    type Output = ExactNumber;
    fn add(self, other: ExactNumber) -> ExactNumber {
        if self.integer.is_zero() {
            return other;
        }
        if other.integer.is_zero() {
            return self;
        }
        let (one, two, exponent) = self.aligned(other);
        ExactNumber { integer: one + two, exponent }
    }
}

impl Sub for ExactNumber {
    type Output = ExactNumber;
    fn sub(self, other: ExactNumber) -> ExactNumber {
        Add::add(self, other.negated())
    }
}

impl Mul<&ExactNumber> for ExactNumber {
    type Output = ExactNumber;
    fn mul(self, other: &ExactNumber) -> ExactNumber {
        if self.integer.is_zero() || other.integer.is_zero() {
            return ExactNumber::default();
        }
        ExactNumber { integer: self.integer * &other.integer, exponent: self.exponent + other.exponent }
    }
}

/// Cross product of two vectors.
pub fn cross<N: Arithmetic>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    let term = |i: usize, j: usize| a[i].clone() * &b[j] - a[j].clone() * &b[i];
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// Scalar product of two vectors.
pub fn dot<N: Arithmetic>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].clone() * &b[0] + a[1].clone() * &b[1] + a[2].clone() * &b[2]
}

/// Difference of two vectors.
pub fn minus<N: Arithmetic>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [0, 1, 2].map(|axis| a[axis].clone() - b[axis].clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn exact_numbers_keep_what_floats_lose() {
        let big = ExactNumber::from(1e300);
        let sum = big.clone() + ExactNumber::from(1e-300) - big;
        assert_eq!(sum, ExactNumber::from(1e-300));
        assert_eq!(sum.over(&ExactNumber::from(1.0)), 1e-300);
        assert_eq!(ExactNumber::from(5e-324).over(&ExactNumber::from(1.0)), 5e-324);
        assert_eq!(ExactNumber::from(1.0).over(&ExactNumber::from(3.0)), 1.0 / 3.0);
        assert_eq!(ExactNumber::from(-1.0).over(&ExactNumber::from(3.0)), -1.0 / 3.0);
        assert_eq!(ExactNumber::from(f64::MAX).over(&ExactNumber::from(1.0)), f64::MAX);
        assert_eq!(
            (ExactNumber::from(1e300) * &ExactNumber::from(1e300)).over(&ExactNumber::from(1e-300)),
            f64::INFINITY
        );
        assert_eq!((ExactNumber::from(3.0) - ExactNumber::from(3.0)).sign(), 0.0);
    }

    proptest! {
        #[test]
        fn errors_hold_and_signs_are_certain(a in -1e3..1e3, b in -1e3..1e3, c in -1e-3..1e-3, d in 1e-9..1.0) {
            fn formula<N: Arithmetic>([a, b, c, d]: [f64; 4]) -> N {
                let [a, b, c, d] = [a, b, c, d].map(N::from);
                (a.clone() - b.clone()) * &(a + c.clone()) - (b * &c) * &d
            }
            let rounded: RoundedNumber = formula([a, b, c, d]);
            let exact: ExactNumber = formula([a, b, c, d]);
            let gap = (exact.clone() - ExactNumber::from(rounded.value)).over(&ExactNumber::from(1.0)).abs();
            prop_assert!(gap <= rounded.error * SLACK);
            if let Some(sign) = rounded.sign() {
                prop_assert_eq!(sign, exact.sign());
            }
            let twofold: DoubleDouble = formula([a, b, c, d]);
            let close = |value: f64| (exact.clone() - ExactNumber::from(value)).over(&ExactNumber::from(1.0)).abs();
            prop_assert!(close(twofold.value()) <= UNIT * twofold.value().abs() * 1.000_001 + rounded.error * 1e-14);
            let quotient = rounded.over(RoundedNumber::from(d));
            let gap = (exact - ExactNumber::from(quotient.value) * &ExactNumber::from(d)).over(&ExactNumber::from(d)).abs();
            prop_assert!(gap <= quotient.error * SLACK);
        }

        #[test]
        fn quotients_are_rounded_right(a in any::<f64>(), b in any::<f64>()) {
            prop_assume!(a.is_finite() && b.is_finite() && b != 0.0 && (a / b).is_normal());
            prop_assert_eq!(ExactNumber::from(a).over(&ExactNumber::from(b)), a / b);
        }
    }
}
