//! Wind: a field of velocities, a function of place and time.

use crate::numeric::noise::noise_slope;
use crate::numeric::sampling::mix;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Most sizes of eddies.
const MOST_OCTAVES: u32 = 8;
/// Root of the mean square of the slopes of gradient noise along an axis.
const SLOPE: f64 = 0.704;
/// Height of the plane of the noise that gives gusts: slopes along it are there as large as elsewhere.
const GUST_PLANE: f64 = 0.28;

/// A steady wind with gusts and turbulence.
///
/// v(x, t) = U + curl P(x - U t), where U is the mean velocity: eddies are carried along as they are, the hypothesis of
/// frozen turbulence. The curl of a potential P has no divergence: air is neither made nor lost. P has two parts: one
/// upright potential that does not depend on height, for gusts along the ground and across, and one of several sizes for
/// turbulence in all directions. The velocity of eddies grows as the cube root of their size.
///
/// Not modelled: the ground, which slows the air near it, and obstacles.
///
/// # Source
/// Frozen turbulence: Taylor 1938. Curls of noise: Bridson, Hourihan and Nordenstam 2007. Velocities of eddies: Kolmogorov
/// 1941.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wind {
    /// The mean velocity, units of length a second.
    pub mean: DVec3,
    /// How strong gusts are: the root of the mean square of a level component of their velocity, in parts of the mean
    /// speed; 0 and more.
    pub gusts: f64,
    /// Size of gusts, units of length, above 0.
    pub gust_size: f64,
    /// How strong turbulence is: the root of the mean square of each component of its velocity, in parts of the mean speed;
    /// 0 and more.
    pub turbulence: f64,
    /// Size of the largest eddies of turbulence, units of length, above 0.
    pub eddy_size: f64,
    /// How many sizes of eddies there are, each half of the one before; 1 to 8.
    pub octaves: u32,
    /// After so many seconds it begins anew, without a jump; none if it does not.
    pub period: Option<f64>,
    /// Seed of gusts and eddies.
    pub seed: u64,
}

/// A number that no wind has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {0} of the wind is out of range")]
pub struct WindError(&'static str);

impl Wind {
    /// Checks every number.
    ///
    /// # Errors
    /// [`WindError`] names the first that is out of range.
    pub fn check(&self) -> Result<(), WindError> {
        let is_amount = |amount: f64| amount >= 0.0 && amount.is_finite();
        let is_size = |size: f64| size > 0.0 && size.is_finite();
        let rows = [
            ("mean velocity", self.mean.is_finite() && self.mean.length().is_finite()),
            ("strength of gusts", is_amount(self.gusts)),
            ("size of gusts", is_size(self.gust_size)),
            ("strength of turbulence", is_amount(self.turbulence)),
            ("size of eddies", is_size(self.eddy_size)),
            ("number of octaves", (1..=MOST_OCTAVES).contains(&self.octaves)),
            ("period", self.period.is_none_or(is_size)),
        ];
        rows.into_iter().find(|(_, is_sound)| !is_sound).map_or(Ok(()), |(what, _)| Err(WindError(what)))
    }

    /// The velocity of the air, units of length a second.
    ///
    /// - `time`: seconds, any.
    pub fn at(&self, at: DVec3, time: f64) -> DVec3 {
        let speed = self.mean.length();
        if speed == 0.0 {
            return DVec3::ZERO;
        }
        let fluctuation = match self.period {
            None => self.fluctuation(at - self.mean * time),
            // Two runs of the same wind, one a period later, of which the one ends as the other begins: the sum of the
            // squares of their weights is 1, and so the strength stays.
            Some(period) => {
                let within = time.rem_euclid(period);
                let part = within / period;
                let angle = FRAC_PI_2 * part * part * (3.0 - 2.0 * part);
                let [first, second] = [within, within - period].map(|time| self.fluctuation(at - self.mean * time));
                first * angle.cos() + second * angle.sin()
            }
        };
        self.mean + fluctuation * speed
    }

    /// Gusts and turbulence in parts of the mean speed, at a place that is carried along.
    fn fluctuation(&self, at: DVec3) -> DVec3 {
        let mut sum = DVec3::ZERO;
        if self.gusts > 0.0 {
            let place = at / self.gust_size + self.shift(0);
            let slope = noise_slope(DVec3::new(place.x, GUST_PLANE, place.z));
            sum += DVec3::new(slope.z, 0.0, -slope.x) * (self.gusts / SLOPE);
        }
        if self.turbulence > 0.0 {
            // Eddies of half the size have this part of the squares of velocities.
            let part = 0.5_f64.powf(2.0 / 3.0);
            let all = (1.0 - part.powi(self.octaves as i32)) / (1.0 - part);
            // Two slopes make each component of a curl.
            let mut strength = self.turbulence / (SLOPE * (2.0 * all).sqrt());
            let mut size = self.eddy_size;
            for octave in 0..self.octaves {
                // Columns are the slopes of the components of the potential.
                let slopes = DMat3::from_cols_array_2d(
                    &[1, 2, 3].map(|one| noise_slope(at / size + self.shift(8 * octave + one)).to_array()),
                );
                sum += curl(&slopes) * strength;
                size *= 0.5;
                strength *= part.sqrt();
            }
        }
        sum
    }

    /// Where a noise begins, so that others do not begin there.
    fn shift(&self, number: u32) -> DVec3 {
        const MOST: f64 = 4096.0;
        let of_axis = |axis: u32| mix(self.seed ^ mix(u64::from(4 * number + axis))) as f64 / u64::MAX as f64 * MOST;
        DVec3::new(of_axis(0), of_axis(1), of_axis(2))
    }
}

/// The curl of a field whose components have the columns as slopes.
fn curl(slopes: &DMat3) -> DVec3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = slopes;
    DVec3::new(z.y - y.z, x.z - z.x, y.x - x.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn breeze() -> Wind {
        Wind {
            mean: DVec3::new(4.0, 0.5, -3.0),
            gusts: 0.4,
            gust_size: 20.0,
            turbulence: 0.2,
            eddy_size: 3.0,
            octaves: 3,
            period: None,
            seed: 7,
        }
    }

    fn places(count: u32) -> impl Iterator<Item = DVec3> {
        (0..count).map(|i| f64::from(i) * DVec3::new(3.377_132, 0.618_034, 2.290_61) - DVec3::splat(500.0))
    }

    /// What a component is in the mean, and the root of the mean square about that.
    fn spread(values: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
        let (mut count, mut sum, mut squares) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for value in values {
            (count, sum, squares) = (count + 1.0, sum + value, squares + value * value);
        }
        let mean = sum / count;
        let variance = squares / count - mean * mean;
        [mean, DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt())]
    }

    #[test]
    fn air_is_neither_made_nor_lost() {
        const STEP: f64 = 1e-4;
        for wind in [breeze(), Wind { period: Some(12.0), ..breeze() }] {
            for at in places(500) {
                let slope =
                    |axis: DVec3| (wind.at(at + axis * STEP, 3.7) - wind.at(at - axis * STEP, 3.7)) / (2.0 * STEP);
                let [x, y, z] = DVec3::AXES.map(slope);
                let strain = x.abs().max_element().max(y.abs().max_element()).max(z.abs().max_element());
                assert!((x.x + y.y + z.z).abs() < 1e-6 * strain.max(0.1), "{at}: {}", x.x + y.y + z.z);
            }
        }
    }

    #[test]
    fn mean_and_strength_are_those_that_were_asked_for() {
        let speed = breeze().mean.length();
        for (gusts, turbulence, octaves, period) in
            [(0.4, 0.0, 1, None), (0.0, 0.3, 1, None), (0.0, 0.3, 5, None), (0.2, 0.3, 3, Some(5.0))]
        {
            let wind = Wind { gusts, turbulence, octaves, period, ..breeze() };
            for time in [0.0, 2.2] {
                let [mean, rms] = spread(places(60_000).map(|at| wind.at(at, time)));
                assert!((mean - wind.mean).length() < 0.03 * speed, "{mean}");
                let level = f64::hypot(gusts, turbulence) * speed;
                for (found, asked) in [(rms.x, level), (rms.y, turbulence * speed), (rms.z, level)] {
                    assert!((found - asked).abs() <= 0.05 * asked, "{gusts} {turbulence} {octaves}: {found} {asked}");
                }
            }
        }
    }

    #[test]
    fn eddies_go_with_the_wind_and_a_period_ends_as_it_begins() {
        let wind = breeze();
        let looped = Wind { period: Some(9.0), ..breeze() };
        for at in places(50) {
            let later = wind.at(at + wind.mean * 2.5, 2.5);
            assert!((later - wind.at(at, 0.0)).length() < 1e-10);
            assert_eq!(looped.at(at, 0.0), looped.at(at, 9.0));
            assert_eq!(looped.at(at, 0.0), wind.at(at, 0.0));
            // Neither velocity nor acceleration jumps.
            let [before, after] = [9.0 - 1e-5, 9.0 + 1e-5].map(|time| looped.at(at, time));
            let acceleration = |time: f64| (looped.at(at, time + 4e-7) - looped.at(at, time - 4e-7)) / 8e-7;
            assert!((before - after).length() < 1e-3);
            assert!((acceleration(9.0 - 1e-6) - acceleration(9.0 + 1e-6)).length() < 0.02);
        }
    }

    #[test]
    fn calm_and_storm_are_finite_and_bad_numbers_refused() {
        assert_eq!(Wind { mean: DVec3::ZERO, ..breeze() }.at(DVec3::ONE, 5.0), DVec3::ZERO);
        let storm = Wind { mean: DVec3::X * 1e6, ..breeze() };
        assert_eq!(storm.check(), Ok(()));
        let speeds: Vec<f64> = places(100).map(|at| storm.at(at, 1e6).length()).collect();
        assert!(speeds.iter().all(|speed| *speed > 1e4 && *speed < 1e7), "{speeds:?}");
        assert!(speeds.iter().any(|speed| (speed - speeds[0]).abs() > 1e4));
        let refused = |wind: Wind| wind.check().unwrap_err().to_string();
        assert!(refused(Wind { mean: DVec3::splat(f64::NAN), ..breeze() }).contains("mean velocity"));
        assert!(refused(Wind { gusts: -0.1, ..breeze() }).contains("gusts"));
        assert!(refused(Wind { octaves: 0, ..breeze() }).contains("octaves"));
        assert!(refused(Wind { period: Some(0.0), ..breeze() }).contains("period"));
    }
}
