//! How many frames of a moving picture are shown in a second, as an exact fraction.

use std::fmt;

/// Most digits behind the point of a rate.
const MOST_DECIMALS: usize = 6;

/// Frames a second, as a fraction in lowest terms whose parts have 16 bits: what APNG files can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    numerator: u16,
    denominator: u16,
}

impl FrameRate {
    /// Reads `24`, `23.976` or `24000/1001`.
    ///
    /// # Errors
    /// In words, for what is no number above 0, or is no fraction of parts up to 65,535.
    pub fn parse(text: &str) -> Result<FrameRate, String> {
        let wrong = || format!("'{text}' is no rate: give frames a second, such as 24, 23.976 or 24000/1001");
        let whole = |digits: &str| {
            let is_number = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
            is_number.then(|| digits.parse::<u64>().ok()).flatten().ok_or_else(wrong)
        };
        let (numerator, denominator) = match (text.split_once('/'), text.split_once('.')) {
            (Some((numerator, denominator)), _) => (whole(numerator)?, whole(denominator)?),
            (None, Some((units, decimals))) if decimals.len() <= MOST_DECIMALS => {
                let scale = 10_u64.pow(decimals.len() as u32);
                let units = whole(units)?.checked_mul(scale).ok_or_else(wrong)?;
                (units.checked_add(whole(decimals)?).ok_or_else(wrong)?, scale)
            }
            (None, Some(_)) => return Err(format!("{}; it has at most {MOST_DECIMALS} decimals", wrong())),
            (None, None) => (whole(text)?, 1),
        };
        if numerator == 0 || denominator == 0 {
            return Err(wrong());
        }
        let divisor = greatest_common_divisor(numerator, denominator);
        let part = |number: u64| u16::try_from(number / divisor);
        match (part(numerator), part(denominator)) {
            (Ok(numerator), Ok(denominator)) => Ok(FrameRate { numerator, denominator }),
            _ => Err(format!("{text} is no fraction of numbers up to {}: give one, such as 24000/1001", u16::MAX)),
        }
    }

    /// The numerator, frames.
    pub fn numerator(self) -> u16 {
        self.numerator
    }

    /// The denominator, seconds.
    pub fn denominator(self) -> u16 {
        self.denominator
    }

    /// The time of a frame, seconds: the number that is nearest to the exact one.
    ///
    /// - `number`: of the frame; that of frame 0 is 0.
    pub fn time(self, number: u32) -> f64 {
        // The product is exact, and the division is rounded once.
        f64::from(number) * f64::from(self.denominator) / f64::from(self.numerator)
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.denominator {
            1 => write!(f, "{}", self.numerator),
            denominator => write!(f, "{}/{denominator}", self.numerator),
        }
    }
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_fractions_in_lowest_terms() {
        for (text, parts) in [
            ("24", [24, 1]),
            ("48/2", [24, 1]),
            ("23.976", [2997, 125]),
            ("24000/1001", [24000, 1001]),
            ("12.5", [25, 2]),
            ("0.25", [1, 4]),
            ("65535", [65535, 1]),
        ] {
            let rate = FrameRate::parse(text).expect("a rate");
            assert_eq!([rate.numerator(), rate.denominator()], parts, "{text}");
        }
        for text in [
            "",
            "0",
            "0.0",
            "24/0",
            "0/1",
            "-24",
            "+24",
            "1e3",
            "24fps",
            "1/2/3",
            "1.",
            ".5",
            "65536",
            "23.9760239",
            "∞",
        ] {
            assert!(FrameRate::parse(text).is_err(), "{text}");
        }
        assert_eq!(FrameRate::parse("30000/1001").map(|rate| rate.to_string()), Ok("30000/1001".into()));
    }

    #[test]
    fn the_time_of_a_frame_is_its_number_over_the_rate() {
        let time = |rate: &str, number| FrameRate::parse(rate).map(|rate| rate.time(number));
        assert_eq!(time("24", 200), Ok(200.0 / 24.0));
        assert_eq!(time("24000/1001", 24_000_000), Ok(1_001_000.0));
        assert_eq!(time("24", 0), Ok(0.0));
    }
}
