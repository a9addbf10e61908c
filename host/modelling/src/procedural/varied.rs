//! Numbers that differ from one kind of a model to the next.

use crate::numeric::sampling::{RandomStream, mix};
use serde::{Deserialize, Serialize};

/// A number that is another one in each kind of a model: drawn evenly from `mean - deviation` to `mean + deviation`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Varied {
    /// The middle of what is drawn.
    pub mean: f64,
    /// How far from the middle it is at the most, 0 and more.
    pub deviation: f64,
}

/// A fault of a number that varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VariedError {
    /// It cannot lie within less than nothing of its mean.
    #[error("the deviation is below 0")]
    NegativeDeviation,
    /// Something of what is drawn would be no number.
    #[error("the mean or what is drawn about it is not finite")]
    NotFinite,
}

impl Varied {
    /// Checks both numbers.
    ///
    /// # Errors
    /// [`VariedError`], if nothing can be drawn.
    pub fn check(&self) -> Result<(), VariedError> {
        let Varied { mean, deviation } = *self;
        if deviation < 0.0 {
            return Err(VariedError::NegativeDeviation);
        }
        let is_finite =
            (2.0 * deviation).is_finite() && (mean - deviation).is_finite() && (mean + deviation).is_finite();
        if is_finite { Ok(()) } else { Err(VariedError::NotFinite) }
    }

    /// The number at a part of what may be drawn.
    ///
    /// - `part`: 0 is the least, 1 the most.
    pub fn at(&self, part: f64) -> f64 {
        self.mean + (2.0 * part - 1.0) * self.deviation
    }

    /// What one kind has, a function of both numbers and the arguments alone.
    ///
    /// - `seed`: of the kind.
    /// - `channel`: for which purpose; what is drawn from different channels is unrelated. See [`channel`].
    pub fn draw(&self, seed: u32, channel: u64) -> f64 {
        self.at(RandomStream::new(u64::from(seed), channel).uniform())
    }
}

/// The channel of a name, the same in every run and on every machine.
pub fn channel(name: &str) -> u64 {
    name.bytes().fold(mix(name.len() as u64), |channel, byte| mix(channel ^ u64::from(byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_fills_its_range_evenly_and_names_are_unrelated() {
        const SEEDS: u32 = 20_000;
        let varied = Varied { mean: 3.0, deviation: 2.0 };
        let of = |name: &str| -> Vec<f64> { (0..SEEDS).map(|seed| varied.draw(seed, channel(name))).collect() };
        let (sizes, leans) = (of("size"), of("lean"));
        assert!(sizes.iter().chain(&leans).all(|drawn| (1.0..=5.0).contains(drawn)));
        for tenth in 0..10 {
            let low = 1.0 + 0.4 * f64::from(tenth);
            let count = sizes.iter().filter(|drawn| (low..low + 0.4).contains(*drawn)).count();
            assert!((1800..2200).contains(&count), "{count} from {low}");
        }
        // The variance of an even distribution is a third of the square of its deviation.
        let together: f64 = sizes.iter().zip(&leans).map(|(size, lean)| (size - 3.0) * (lean - 3.0)).sum();
        let correlation = together / f64::from(SEEDS) / (4.0 / 3.0);
        assert!(correlation.abs() < 0.03, "{correlation}");
        assert_ne!(channel("ab"), channel("ba"));
        assert_eq!(varied.draw(7, channel("size")), sizes[7]);
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let check = |mean: f64, deviation: f64| Varied { mean, deviation }.check();
        assert_eq!(check(-1.0, 0.0), Ok(()));
        assert_eq!(check(1.0, -0.1), Err(VariedError::NegativeDeviation));
        for (mean, deviation) in [(f64::NAN, 0.0), (0.0, f64::NAN), (f64::INFINITY, 1.0), (1e308, 1e308)] {
            assert_eq!(check(mean, deviation), Err(VariedError::NotFinite), "{mean} {deviation}");
        }
    }
}
