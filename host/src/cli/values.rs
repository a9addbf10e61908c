//! Numbers that commands read from the command line.

use crate::memory;
use std::num::NonZeroUsize;
use std::ops::Range;

/// Most threads that a command takes.
const MAX_THREADS: usize = 1024;
/// Most vectors of a picture that instances are thinned out to.
const MAX_VECTORS: usize = 1_000_000;
/// The latest time of a scene, seconds: frames beyond it would be no longer apart than numbers are.
pub(super) const MOST_SECONDS: f64 = 1e9;
/// The largest number of a frame.
const MOST_FRAMES: u32 = 10_000_000;
/// Least memory that a command may be given, bytes: less than its own code and stacks is no use.
const LEAST_MEMORY: u64 = 64 << 20;
/// Longest period of what moves on a workstation, seconds.
const MAX_PERIOD: f64 = 3600.0;

/// Reads a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let count = text.parse().ok().filter(|n: &NonZeroUsize| n.get() <= MAX_THREADS);
    count.ok_or_else(|| format!("give 1 to {MAX_THREADS}"))
}

/// Reads a number of vectors of a picture.
pub(super) fn vectors(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_VECTORS).contains(count));
    count.ok_or_else(|| format!("give 1 to {MAX_VECTORS}"))
}

/// Reads a number of bytes that a command may take.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    let bytes = any_bytes(text)?;
    match bytes < LEAST_MEMORY {
        true => Err(format!("give at least {}, such as 512M", memory::readable(LEAST_MEMORY))),
        false => Ok(bytes),
    }
}

/// Reads a number of bytes.
pub(super) fn any_bytes(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "" | "B" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        "T" | "TB" | "TIB" => 40,
        _ => return Err("give a number of bytes with K, M, G or T behind it, such as 512M".into()),
    };
    let bytes = digits.parse().ok().map(|number: f64| number * 2f64.powi(unit));
    let bytes = bytes.filter(|bytes| (0.0..=u64::MAX as f64).contains(bytes));
    bytes.map(|bytes| bytes as u64).ok_or_else(|| "give a number of bytes, such as 512M".into())
}

/// Reads a time of a scene, seconds.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| seconds.abs() <= MOST_SECONDS);
    seconds.ok_or_else(|| format!("give a number of seconds, from -{MOST_SECONDS:e} to {MOST_SECONDS:e}"))
}

/// Reads the numbers of frames.
pub(super) fn frames(text: &str) -> Result<Range<u32>, String> {
    let wrong = || format!("give A..B, from A to before B, or one number, up to {MOST_FRAMES}");
    let number = |text: &str| -> Result<u32, String> {
        let is_number = !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit());
        is_number.then(|| text.parse().ok()).flatten().filter(|number| *number <= MOST_FRAMES).ok_or_else(wrong)
    };
    let frames = match text.split_once("..") {
        Some((first, end)) => number(first)?..number(end)?,
        None => number(text).map(|only| only..only + 1)?,
    };
    if frames.is_empty() { Err(format!("there is no frame from {text}: {}", wrong())) } else { Ok(frames) }
}

/// Reads a length above 0.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length| *length > 0.0 && *length < f64::INFINITY);
    length.ok_or_else(|| "give a length above 0".to_string())
}

/// Reads the period of what moves on a workstation, seconds.
pub(super) fn period(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| *seconds > 0.0 && *seconds <= MAX_PERIOD);
    seconds.ok_or_else(|| format!("give a number of seconds, above 0 and at most {MAX_PERIOD}"))
}

/// Reads a distance as a part of a diagonal.
pub(super) fn part(text: &str) -> Result<f64, String> {
    let part = text.parse().ok().filter(|part| *part > 0.0 && *part <= 1.0);
    part.ok_or_else(|| "give a part of the diagonal, above 0 and at most 1".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_given_in_bytes_and_their_multiples() {
        for (text, expected) in
            [("512M", 512 << 20), ("0.5GiB", 512 << 20), ("100000000", 100_000_000), ("2t", 2 << 40)]
        {
            assert_eq!(bytes(text), Ok(expected), "{text}");
        }
        for text in ["", "M", "63M", "-1G", "1X", "NaNG", "1e300G", "infT"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }

    #[test]
    fn frames_are_a_half_open_range_or_one_number() {
        assert_eq!(frames("0..240"), Ok(0..240));
        assert_eq!(frames("200"), Ok(200..201));
        assert_eq!(frames("007..9"), Ok(7..9));
        for text in ["", "..", "5..", "..5", "5..5", "6..5", "-1..3", "1..=3", "0..1e3", "0..99999999", "a", "1...3"] {
            assert!(frames(text).is_err(), "{text}");
        }
    }
}
