//! Decimal numbers: `[sign] digits [. digits] [E [sign] digits]`, read in one pass and rounded correctly.

/// A number as it was written, not yet rounded to a binary form.
///
/// Up to 19 digits are held exactly; a longer number is read again from its text when its value is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decimal {
    mantissa: u64,
    exponent: i32,
    negative: bool,
    whole: bool,
    exact: bool,
}

/// The powers of ten that double precision holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Digits that always fit into the mantissa.
const EXACT_DIGITS: usize = 19;
/// Mantissas up to here are exact in double precision.
const EXACT_MANTISSA: u64 = 1 << 53;
/// Larger exponents are cut to this; the number is out of range, or zero, anyway.
const EXPONENT_LIMIT: i32 = 1_000_000;

impl Decimal {
    /// Reads the number that begins at `text[at]`; also gives the offset after it. None if none begins there or it
    /// is malformed (a sign or a point without digits, a second point).
    #[inline]
    pub fn scan(text: &[u8], at: usize) -> Option<(Decimal, usize)> {
        let mut i = at;
        let negative = match text.get(i) {
            Some(b'-') => {
                i += 1;
                true
            }
            Some(b'+') => {
                i += 1;
                false
            }
            _ => false,
        };
        let mut mantissa = 0_u64;
        let first = i;
        i = digits(text, i, &mut mantissa);
        let mut count = i - first;
        let mut exponent = 0_i32;
        let mut whole = true;
        if text.get(i) == Some(&b'.') {
            whole = false;
            let fraction = i + 1;
            i = digits(text, fraction, &mut mantissa);
            count += i - fraction;
            exponent = -((i - fraction).min(EXPONENT_LIMIT as usize) as i32);
            if text.get(i) == Some(&b'.') {
                return None;
            }
        }
        if count == 0 {
            return None;
        }
        if let Some(b'E' | b'e') = text.get(i)
            && let Some((power, end)) = signed_power(text, i + 1)
        {
            whole = false;
            exponent = exponent.saturating_add(power).clamp(-2 * EXPONENT_LIMIT, 2 * EXPONENT_LIMIT);
            i = end;
        }
        Some((Decimal { mantissa, exponent, negative, whole, exact: count <= EXACT_DIGITS }, i))
    }

    /// Whether a number can begin with this byte.
    #[inline]
    pub const fn begins_with(byte: u8) -> bool {
        matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.')
    }

    /// The value, without rounding, as a double; none if that needs more than one exact operation.
    #[inline]
    fn quick(self) -> Option<f64> {
        if !self.exact || self.mantissa > EXACT_MANTISSA {
            return None;
        }
        let power = POWERS.get(self.exponent.unsigned_abs() as usize)?;
        let mantissa = self.mantissa as f64;
        let value = if self.exponent < 0 { mantissa / power } else { mantissa * power };
        Some(if self.negative { -value } else { value })
    }

    /// The nearest double; `text` is the text of the number. None if it is too large.
    #[inline]
    pub fn to_f64(self, text: &[u8]) -> Option<f64> {
        let value = match self.quick() {
            Some(value) => value,
            None => std::str::from_utf8(text).ok()?.parse().ok()?,
        };
        value.is_finite().then_some(value)
    }

    /// The nearest single-precision real; `text` is the text of the number. None if it is too large.
    #[inline]
    pub fn to_f32(self, text: &[u8]) -> Option<f32> {
        // The double is the correctly rounded value, so rounding it again is right unless it lies exactly half way
        // between two singles (or where singles are subnormal and have fewer digits).
        const HALF: u64 = 1 << 28;
        let value = match self.quick() {
            Some(value)
                if value.to_bits() & (2 * HALF - 1) != HALF
                    && (value == 0.0 || value.abs() >= f64::from(f32::MIN_POSITIVE)) =>
            {
                value as f32
            }
            _ => std::str::from_utf8(text).ok()?.parse().ok()?,
        };
        value.is_finite().then_some(value)
    }

    /// The value if it was written as a whole number (no point, no exponent) and fits.
    pub fn to_integer(self) -> Option<i64> {
        if !self.whole || !self.exact {
            return None;
        }
        let value = i64::try_from(self.mantissa).ok()?;
        Some(if self.negative { -value } else { value })
    }

    /// Whether it was written as a whole number.
    pub fn is_whole(self) -> bool {
        self.whole
    }
}

/// Appends the digits from `text[i]` on to `mantissa` (it wraps beyond 19 digits) and gives the offset after them.
#[inline(always)]
fn digits(text: &[u8], mut i: usize, mantissa: &mut u64) -> usize {
    while let Some(&byte) = text.get(i) {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        i += 1;
    }
    i
}

/// The exponent after an `E`, and the offset after it; none if no digits follow.
fn signed_power(text: &[u8], at: usize) -> Option<(i32, usize)> {
    let (negative, first) = match text.get(at) {
        Some(b'-') => (true, at + 1),
        Some(b'+') => (false, at + 1),
        _ => (false, at),
    };
    let mut power = 0_i32;
    let mut i = first;
    while let Some(digit @ b'0'..=b'9') = text.get(i) {
        power = (power * 10 + i32::from(digit - b'0')).min(EXPONENT_LIMIT);
        i += 1;
    }
    (i > first).then_some((if negative { -power } else { power }, i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn double(text: &str) -> Option<f64> {
        let (decimal, end) = Decimal::scan(text.as_bytes(), 0)?;
        assert_eq!(end, text.len(), "{text}");
        decimal.to_f64(text.as_bytes())
    }

    #[test]
    fn the_forms_of_the_language_are_read() {
        for (text, value) in
            [("0", 0.0), ("-1", -1.0), ("+.5", 0.5), ("5.", 5.0), ("1E-15", 1e-15), ("1.5e+3", 1500.0), ("007", 7.0)]
        {
            assert_eq!(double(text), Some(value), "{text}");
        }
        for text in ["", "-", ".", "+.", "1.2.3", "E5"] {
            assert_eq!(Decimal::scan(text.as_bytes(), 0), None, "{text}");
        }
    }

    #[test]
    fn an_exponent_needs_digits() {
        let (decimal, end) = Decimal::scan(b"1END", 0).unwrap();
        assert_eq!((decimal.to_integer(), end), (Some(1), 1));
    }

    #[test]
    fn too_large_is_none_and_too_small_is_zero() {
        assert_eq!(double("1E309"), None);
        assert_eq!(double("1E999999999999"), None);
        assert_eq!(double("1E-400"), Some(0.0));
        let (decimal, _) = Decimal::scan(b"3.5E38", 0).unwrap();
        assert_eq!(decimal.to_f32(b"3.5E38"), None);
    }

    #[test]
    fn only_whole_numbers_are_integers() {
        let integer = |text: &str| Decimal::scan(text.as_bytes(), 0).unwrap().0.to_integer();
        assert_eq!(integer("-2147483648"), Some(-2_147_483_648));
        assert_eq!(integer("1.0"), None);
        assert_eq!(integer("1E2"), None);
        assert_eq!(integer("99999999999999999999"), None);
    }

    proptest! {
        #[test]
        fn doubles_round_as_the_standard_library_does(
            text in r"[-+]?[0-9]{1,25}(\.[0-9]{0,25})?(E[-+]?[0-9]{1,3})?"
        ) {
            let expected: f64 = text.parse().unwrap();
            prop_assert_eq!(double(&text), expected.is_finite().then_some(expected));
        }

        #[test]
        fn singles_round_as_the_standard_library_does(
            text in r"[-+]?[0-9]{1,12}(\.[0-9]{0,12})?(E[-+]?[0-9]{1,2})?"
        ) {
            let expected: f32 = text.parse().unwrap();
            let (decimal, _) = Decimal::scan(text.as_bytes(), 0).unwrap();
            prop_assert_eq!(decimal.to_f32(text.as_bytes()), expected.is_finite().then_some(expected));
        }

        #[test]
        fn a_half_way_decimal_is_rounded_once(bits in 0x0080_0000_u32..0x7f00_0000, nudge in 0_u32..3) {
            // Seventeen digits near the middle between two singles.
            let middle = (f64::from(f32::from_bits(bits)) + f64::from(f32::from_bits(bits + 1))) / 2.0;
            let near = f64::from_bits(middle.to_bits() + u64::from(nudge) - 1);
            let text = format!("{near:.17e}");
            let (decimal, _) = Decimal::scan(text.as_bytes(), 0).unwrap();
            prop_assert_eq!(decimal.to_f32(text.as_bytes()), Some(text.parse::<f32>().unwrap()));
        }
    }
}
