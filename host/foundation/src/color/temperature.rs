//! Light that a temperature tells.

use super::{ColorError, Spectrum, blackbody, daylight};

/// The spectrum of `blackbody 3000` or `daylight 5000`, kelvin; none for other words.
///
/// # Errors
/// [`ColorError::Temperature`].
pub fn light_of_temperature(words: &str) -> Option<Result<Spectrum, ColorError>> {
    let (kind, kelvin) = words.trim().split_once(' ')?;
    let kelvin: f64 = kelvin.trim().parse().ok()?;
    match kind {
        "blackbody" => Some(blackbody::spectrum(kelvin)),
        "daylight" => Some(daylight::spectrum(kelvin)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temperatures_are_read() {
        assert!(light_of_temperature("blackbody 3000").is_some_and(|spectrum| spectrum.is_ok()));
        assert!(light_of_temperature(" daylight  5000").is_some_and(|spectrum| spectrum.is_ok()));
        assert!(light_of_temperature("daylight 100").is_some_and(|spectrum| spectrum.is_err()));
        assert!(
            ["D65", "blackbody warm", "candle 1900", ""].into_iter().all(|name| light_of_temperature(name).is_none())
        );
    }
}
