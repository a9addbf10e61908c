//! The position of the sun.

use std::f64::consts::TAU;

/// Radius of the sun as seen from the earth, radians: the mean over a year.
pub const SUN_RADIUS: f64 = 0.004_653;

/// A moment, in universal time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Year of the Gregorian calendar.
    pub year: i32,
    /// Month, 1..=12.
    pub month: u32,
    /// Day, 1..=31.
    pub day: u32,
    /// Hours since midnight at Greenwich; also below 0 and above 24.
    pub hour: f64,
}

impl Moment {
    /// Days since noon of 1 January 2000.
    fn days(&self) -> f64 {
        // Fliegel and Van Flandern 1968.
        let (year, month, day) = (i64::from(self.year), i64::from(self.month), i64::from(self.day));
        let shift = (month - 14) / 12;
        let julian = (1461 * (year + 4800 + shift)) / 4 + (367 * (month - 2 - 12 * shift)) / 12
            - (3 * ((year + 4900 + shift) / 100)) / 4
            + day
            - 32_075;
        (julian - 2_451_545) as f64 + (self.hour - 12.0) / 24.0
    }
}

/// Azimuth of the sun, clockwise from north, and its elevation, radians, without refraction.
///
/// - `latitude`, `longitude`: degrees, north and east above 0.
///
/// Within 0.01 degrees from 1950 to 2050.
///
/// # Source
/// The Astronomical Almanac, low-precision formulas for the sun.
pub fn solar_position(moment: &Moment, latitude: f64, longitude: f64) -> [f64; 2] {
    let days = moment.days();
    let mean = (280.460 + 0.985_647_4 * days).to_radians();
    let anomaly = (357.528 + 0.985_600_3 * days).to_radians();
    let ecliptic = mean + (1.915 * anomaly.sin() + 0.020 * (2.0 * anomaly).sin()).to_radians();
    let obliquity = (23.439 - 4e-7 * days).to_radians();
    let ascension = (obliquity.cos() * ecliptic.sin()).atan2(ecliptic.cos());
    let declination = (obliquity.sin() * ecliptic.sin()).asin();
    let sidereal = (18.697_374_558 + 24.065_709_824_419_08 * days) / 24.0 * TAU + longitude.to_radians();
    let hour = sidereal - ascension;
    let ((sine, cosine), (south, level)) = (latitude.to_radians().sin_cos(), declination.sin_cos());
    let elevation = (sine * south + cosine * level * hour.cos()).clamp(-1.0, 1.0).asin();
    let azimuth = (-level * hour.sin()).atan2(south * cosine - level * sine * hour.cos());
    [azimuth.rem_euclid(TAU), elevation]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_where_the_reference_algorithm_has_it() {
        // Reda and Andreas 2004, the example of the solar position algorithm: Golden, Colorado.
        let moment = Moment { year: 2003, month: 10, day: 17, hour: 12.5 + 30.0 / 3600.0 + 7.0 };
        let [azimuth, elevation] = solar_position(&moment, 39.742_476, -105.178_6).map(f64::to_degrees);
        // Its zenith angle, 50.11162, has refraction, 0.0164 degrees, in it.
        assert!((elevation - (90.0 - 50.111_62 - 0.016_4)).abs() < 0.012, "{elevation}");
        assert!((azimuth - 194.340_24).abs() < 0.012, "{azimuth}");
    }

    #[test]
    fn seasons_and_hours_are_those_of_the_calendar() {
        let noon = |month: u32, latitude: f64| {
            solar_position(&Moment { year: 2024, month, day: 21, hour: 12.0 }, latitude, 0.0).map(f64::to_degrees)
        };
        assert!(
            (noon(6, 51.5)[1] - (90.0 - 51.5 + 23.44)).abs() < 0.1 && (noon(12, 51.5)[1] - (38.5 - 23.44)).abs() < 0.1
        );
        assert!((noon(6, 51.5)[0] - 180.0).abs() < 2.0 && (noon(6, -33.9)[0] + 180.0).rem_euclid(360.0) - 180.0 < 2.0);
        let morning =
            solar_position(&Moment { year: 2024, month: 3, day: 20, hour: 6.0 }, 0.0, 0.0).map(f64::to_degrees);
        assert!((morning[0] - 90.0).abs() < 1.0 && morning[1].abs() < 3.0, "{morning:?}");
        let day = |year, month, day| Moment { year, month, day, hour: 12.0 }.days();
        assert_eq!([day(2000, 1, 1), day(2000, 3, 1), day(1988, 1, 1)], [0.0, 60.0, -4383.0]);
    }
}
