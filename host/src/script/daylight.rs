//! The function of the scene language that lights a scene by the sun and a clear sky.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::CallResult;
use super::kinds::{Flag, NumberKind, TextKind};
use super::lighting::add;
use super::parameter::{optional, with_default};
use crate::color::{Color, Extrapolation, Spectrum};
use crate::illumination::Light;
use crate::illumination::atmosphere::{
    Atmosphere, COLUMNS, ClearSky, Moment, NODES, ROWS, SUN_RADIUS, Spectral, node, solar_position,
};
use crate::illumination::light::{Panorama, SkyDisc, SkyMap};
use glam::DVec3;
use std::sync::Arc;

const DEGREES: NumberKind = NumberKind(-360.0, 360.0);

/// The function.
pub(super) const FUNCTIONS: &[Function] = &[function! {
    sun_and_sky(
        latitude: with_default(NumberKind(-90.0, 90.0), 30.26, "degrees, north above 0; without it, that of Hangzhou"),
        longitude: with_default(NumberKind(-180.0, 180.0), 120.12, "degrees, east above 0; without it, that of Hangzhou"),
        date: with_default(TextKind, "1988-06-21", "year, month and day"),
        hour: with_default(NumberKind(0.0, 24.0), 10.0, "of the day, 13.5 for half past one"),
        zone: optional(
            NumberKind(-14.0, 14.0),
            "that of the longitude",
            "hours by which clocks are ahead of Greenwich",
        ),
        elevation: optional(
            NumberKind(-20.0, 90.0),
            "by place, date and hour",
            "of the sun over the horizon, degrees",
        ),
        azimuth: optional(
            DEGREES,
            "by place, date and hour; 180 with an elevation",
            "of the sun, clockwise from north, degrees",
        ),
        turbidity: with_default(
            NumberKind(1.0, 10.0),
            3.0,
            "how much haze there is: 1 none, 2 clear, 3 ordinary, 10 thick",
        ),
        ground: with_default(
            NumberKind(0.0, 1.0),
            0.2,
            "the part of the light that the ground beyond the scene reflects",
        ),
        altitude: with_default(NumberKind(0.0, 50_000.0), 50.0, "of the scene over that ground, metres"),
        factor: with_default(NumberKind(0.0, 1e9), 1.0, "what all of it is multiplied with"),
        sun: with_default(Flag, true, "whether the sun shines; without it, it stands behind something"),
    )
    "Lights the scene by the sun and a clear sky, of a place, a date and an hour or of where the sun is; -z is north. Its light is that of the day: an exposure is best left to the meter."
    "sun_and_sky(#{ latitude: 48.2, longitude: 16.4, date: \"2026-09-23\", hour: 17.5 });"
    |builder| {
        let [azimuth, elevation] = match elevation {
            Some(elevation) => [azimuth.unwrap_or(180.0), elevation].map(f64::to_radians),
            None => {
                let zone = zone.unwrap_or((longitude / 15.0).round());
                let [year, month, day] = read_date(&date)?;
                let moment = Moment { year, month: month as u32, day: day as u32, hour: hour - zone };
                let [found, elevation] = solar_position(&moment, latitude, longitude);
                [azimuth.map_or(found, f64::to_radians), elevation]
            }
        };
        let atmosphere = Atmosphere { turbidity, albedo: ground, altitude, elevation };
        let sky = ClearSky::shared(&atmosphere);
        let done = add_sky(builder, &sky, azimuth, factor)?;
        let is_up = sky.sun.iter().any(|light| *light > 0.0);
        if !(is_up && sun) {
            return Ok(done);
        }
        let towards =
            DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), -azimuth.cos() * elevation.cos());
        add_sun(builder, &sky, towards, factor)
    }
}];

/// The light of the sky.
///
/// - `azimuth`: of the sun, radians.
fn add_sky(builder: &mut Builder, sky: &ClearSky, azimuth: f64, factor: f64) -> CallResult {
    let map = SkyMap { file: "a clear sky".into(), panorama: Some(Arc::new(panorama(sky)?)), disc: None };
    // The table begins at the sun; the panorama's middle is -z.
    let turned = -azimuth.to_degrees();
    add(builder, Light::Sky { map: Some(map), radiance: Color::grey(factor), turned })
}

/// The disc of the sun.
fn add_sun(builder: &mut Builder, sky: &ClearSky, towards: DVec3, factor: f64) -> CallResult {
    let disc = SkyDisc { towards, radius: SUN_RADIUS };
    let samples: Vec<(f64, f64)> =
        sky.sun.iter().enumerate().map(|(index, light)| (node(index), light / disc.solid_angle() * factor)).collect();
    let spectrum = Spectrum::irregular(&samples, Extrapolation::Held).map_err(|error| error.to_string())?;
    let map = SkyMap { file: "the sun".into(), panorama: None, disc: Some(disc) };
    add(builder, Light::Sky { map: Some(map), radiance: Color::Spectrum(spectrum), turned: 0.0 })
}

/// Year, month and day of `1988-06-21`.
fn read_date(text: &str) -> Result<[i32; 3], String> {
    let wrong = || format!("'{text}' is no date: give year, month and day, such as 1988-06-21");
    let parts: Vec<i32> = text.split('-').map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
    let [year, month, day] = parts[..] else { return Err(wrong()) };
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + i32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    let is_date = (1600..=3000).contains(&year) && (1..=12).contains(&month) && (1..=days).contains(&day);
    is_date.then_some([year, month, day]).ok_or_else(wrong)
}

/// The sky as a panorama of spectra, its middle at the sun.
fn panorama(sky: &ClearSky) -> Result<Panorama, String> {
    // Hats over the nodes, which add up to what is linear between them.
    let hat = |index: usize| {
        let middle = node(index);
        let step = node(1) - node(0);
        Spectrum::irregular(&[(middle - step, 0.0), (middle, 1.0), (middle + step, 0.0)], Extrapolation::Zero)
    };
    let hats = (0..NODES).map(hat).collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
    let value = |row: usize, column: usize| {
        // Columns of a panorama are at the middles of their parts, and those of the table begin at the sun.
        let [a, b]: [&Spectral; 2] =
            [0, 1].map(|next| &sky.radiance[row * COLUMNS + (column + COLUMNS / 2 + next) % COLUMNS]);
        std::array::from_fn::<f32, NODES, _>(|index| (0.5 * (a[index] + b[index])) as f32)
    };
    let values = (0..ROWS).flat_map(|row| (0..COLUMNS).flat_map(move |column| value(row, column))).collect();
    Panorama::of_spectra(COLUMNS as u32, ROWS as u32, hats, values).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::super::tests::{problem, run};
    use super::*;

    #[test]
    fn the_sun_stands_where_place_date_and_hour_put_it() {
        let made = run("sun_and_sky(#{ latitude: 51.5, longitude: 0, date: \"2024-06-21\", hour: 12, turbidity: 2 });");
        let [Light::Sky { turned, .. }, Light::Sky { map: Some(sun), .. }] = &made.scene.lights[..] else {
            panic!("{:?}", made.scene.lights)
        };
        let disc = sun.disc.expect("a sun");
        assert!((disc.towards.y.asin().to_degrees() - (90.0 - 51.5 + 23.44)).abs() < 0.1, "{disc:?}");
        // It is in the south, +z, and the brightest part of the sky with it.
        assert!(disc.towards.z > 0.4 && disc.towards.x.abs() < 0.03 && (turned + 180.0).abs() < 3.0, "{turned}");
        assert_eq!(run("sun_and_sky(#{ elevation: 20, sun: false });").scene.lights.len(), 1);
        assert_eq!(run("sun_and_sky(#{ elevation: -8 });").scene.lights.len(), 1);
    }

    #[test]
    fn days_that_are_none_are_refused_with_their_place() {
        for wrong in ["2026-02-29", "2026-13-01", "tomorrow", "2026-09", "2026-09-31"] {
            let (line, _, message) = problem(&format!("sun_and_sky(#{{ date: \"{wrong}\" }});"));
            assert!(line == 1 && message.contains("is no date"), "{message}");
        }
    }
}
