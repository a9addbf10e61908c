//! Integers of any size, as far as determinants need them.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A whole number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Integer {
    is_negative: bool,
    /// Digits to the base 2^32, the lowest first, the last not 0; none for 0.
    digits: Vec<u32>,
}

impl Integer {
    /// A finite number times 2^`places`, which must be whole.
    ///
    /// # Panics
    /// If it is not finite or not whole.
    pub fn of(number: f64, places: i32) -> Integer {
        let (mantissa, exponent) = parts(number);
        if mantissa == 0 {
            return Integer::default();
        }
        let shift = u32::try_from(exponent + places).expect("the number is whole");
        let mut digits = vec![0; shift as usize / 32];
        let shifted = u128::from(mantissa) << (shift % 32);
        digits.extend((0..4).map(|k| (shifted >> (32 * k)) as u32));
        Integer { is_negative: number < 0.0, digits }.trimmed()
    }

    /// -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        match (self.digits.is_empty(), self.is_negative) {
            (true, _) => 0,
            (false, true) => -1,
            (false, false) => 1,
        }
    }

    fn trimmed(mut self) -> Integer {
        while self.digits.last() == Some(&0) {
            self.digits.pop();
        }
        self.is_negative &= !self.digits.is_empty();
        self
    }
}

/// A finite number as m 2^e, where m is odd or 0.
///
/// # Panics
/// If it is not finite.
pub fn parts(number: f64) -> (u64, i32) {
    assert!(number.is_finite(), "{number} is no number");
    let bits = number.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    let (mantissa, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    (mantissa >> zeros, exponent + zeros as i32)
}

/// How two rows of digits compare.
fn compared(one: &[u32], two: &[u32]) -> Ordering {
    one.len().cmp(&two.len()).then_with(|| one.iter().rev().cmp(two.iter().rev()))
}

fn sum(long: &[u32], short: &[u32]) -> Vec<u32> {
    let (long, short) = if long.len() < short.len() { (short, long) } else { (long, short) };
    let mut carry = 0;
    let mut digits: Vec<u32> = Vec::with_capacity(long.len() + 1);
    for (k, digit) in long.iter().enumerate() {
        let all = u64::from(*digit) + u64::from(short.get(k).copied().unwrap_or(0)) + carry;
        digits.push(all as u32);
        carry = all >> 32;
    }
    digits.push(carry as u32);
    digits
}

/// The larger row less the smaller.
fn rest(large: &[u32], small: &[u32]) -> Vec<u32> {
    let mut borrow = 0;
    let less = |(k, digit): (usize, &u32)| {
        let all = i64::from(*digit) - i64::from(small.get(k).copied().unwrap_or(0)) - borrow;
        borrow = i64::from(all < 0);
        all as u32
    };
    large.iter().enumerate().map(less).collect()
}

impl Add for &Integer {
    type Output = Integer;

    fn add(self, other: &Integer) -> Integer {
        let (is_negative, digits) = if self.is_negative == other.is_negative {
            (self.is_negative, sum(&self.digits, &other.digits))
        } else if compared(&self.digits, &other.digits) == Ordering::Less {
            (other.is_negative, rest(&other.digits, &self.digits))
        } else {
            (self.is_negative, rest(&self.digits, &other.digits))
        };
        Integer { is_negative, digits }.trimmed()
    }
}

impl Neg for Integer {
    type Output = Integer;

    fn neg(self) -> Integer {
        Integer { is_negative: !self.is_negative, ..self }
    }
}

impl Sub for &Integer {
    type Output = Integer;

    fn sub(self, other: &Integer) -> Integer {
        self + &-other.clone()
    }
}

impl Mul for &Integer {
    type Output = Integer;

    fn mul(self, other: &Integer) -> Integer {
        let mut digits = vec![0u32; self.digits.len() + other.digits.len()];
        for (j, one) in self.digits.iter().enumerate() {
            let mut carry = 0;
            for (k, two) in other.digits.iter().enumerate() {
                let all = u64::from(*one) * u64::from(*two) + u64::from(digits[j + k]) + carry;
                digits[j + k] = all as u32;
                carry = all >> 32;
            }
            digits[j + other.digits.len()] = carry as u32;
        }
        Integer { is_negative: self.is_negative != other.is_negative, digits }.trimmed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn small_ones_are_as_those_of_the_machine_and_large_ones_obey_the_laws() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        let of = |n: i64| Integer::of(n as f64, 0);
        for _ in 0..2000 {
            let bits = random.random_range(1..24);
            let [a, b] = [0; 2].map(|_| random.random_range(-(1i64 << bits)..1 << bits));
            assert_eq!(&of(a) + &of(b), of(a + b));
            assert_eq!(&of(a) - &of(b), of(a - b));
            assert_eq!(&of(a) * &of(b), of(a * b));
            assert_eq!(of(a).sign(), a.signum() as i32);
        }
        for _ in 0..500 {
            let [a, b, c] =
                [0; 3].map(|_| Integer::of(random.random_range(-1.0..1.0), 60 + random.random_range(0..300)));
            assert_eq!(&(&a + &b) * &c, &(&a * &c) + &(&b * &c));
            assert_eq!(&(&a - &b) + &b, a);
            assert_eq!((&(&a * &b) - &(&b * &a)).sign(), 0);
        }
        assert_eq!(Integer::of(f64::from_bits(1), 1074), of(1));
        assert_eq!(Integer::of(-1.5, 1), of(-3));
    }
}
