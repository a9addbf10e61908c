//! Lanes: the numbers that one ray carries side by side.

use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub};

/// How many numbers a ray carries: wavelengths, or three bands and unused ones.
pub const LANES: usize = 8;

/// A quantity at the wavelengths, or in the bands, that a ray carries.
///
/// [`super::WavelengthSets`] tells the wavelengths. Lanes that are not used are 0 in every light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Channels(pub [f64; LANES]);

impl Channels {
    /// No light.
    pub const ZERO: Channels = Channels([0.0; LANES]);
    /// All of the light.
    pub const ONE: Channels = Channels([1.0; LANES]);

    /// One number in all lanes.
    pub fn splat(value: f64) -> Channels {
        Channels([value; LANES])
    }

    /// One lane, sampled in proportion to the numbers times weights, and that alone: it stands for all of them.
    ///
    /// - `uniform`: in 0..1, chooses.
    pub fn sample_lane(self, weights: [f64; LANES], uniform: f64) -> Option<(usize, Channels)> {
        let weighted: [f64; LANES] = std::array::from_fn(|lane| self.0[lane].abs() * weights[lane]);
        let all: f64 = weighted.iter().sum();
        let mut below = 0.0;
        let mut drawn = None;
        for (lane, weight) in weighted.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
            below += weight;
            drawn =
                Some((lane, Channels(std::array::from_fn(|i| if i == lane { self.0[i] * all / weight } else { 0.0 }))));
            if uniform * all < below {
                break;
            }
        }
        drawn.filter(|(_, channels)| channels.is_finite())
    }

    /// A function of each number.
    #[inline]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Channels {
        Channels(self.0.map(function))
    }

    /// The greatest number.
    #[inline]
    pub fn max(self) -> f64 {
        self.0.iter().fold(0.0, |most, value| f64::max(most, *value))
    }

    /// Whether all are numbers within bounds.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|value| value.is_finite())
    }
}

macro_rules! lane_by_lane {
    ($trait:ident $method:ident $operator:tt) => {
        impl $trait for Channels {
            type Output = Channels;

            #[inline]
            fn $method(mut self, other: Channels) -> Channels {
                for (lane, other) in self.0.iter_mut().zip(other.0) {
                    *lane $operator other;
                }
                self
            }
        }
    };
}

lane_by_lane!(Add add +=);
lane_by_lane!(Sub sub -=);
lane_by_lane!(Mul mul *=);

impl Mul<f64> for Channels {
    type Output = Channels;

    #[inline]
    fn mul(self, factor: f64) -> Channels {
        self.map(|value| value * factor)
    }
}

impl Neg for Channels {
    type Output = Channels;

    #[inline]
    fn neg(self) -> Channels {
        self.map(|value| -value)
    }
}

impl AddAssign for Channels {
    #[inline]
    fn add_assign(&mut self, other: Channels) {
        *self = *self + other;
    }
}

impl MulAssign for Channels {
    #[inline]
    fn mul_assign(&mut self, other: Channels) {
        *self = *self * other;
    }
}

impl MulAssign<f64> for Channels {
    #[inline]
    fn mul_assign(&mut self, factor: f64) {
        *self = *self * factor;
    }
}
