//! The clear sky over a place as a table of directions.

use super::air::{Air, NODES, Spectral};
use super::columns::Columns;
use super::scattering::Scattering;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, Mutex, PoisonError};

/// Columns of a table of the sky: all around.
pub const COLUMNS: usize = 128;
/// Rows of a table of the sky: from straight up to straight down, one of them level.
pub const ROWS: usize = 513;

/// The air over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atmosphere {
    /// How much haze there is: 1 none, 2 a clear day, 3 ordinary, 10 a hazy one; 1..=10.
    pub turbidity: f64,
    /// The part of the light that the ground reflects, 0..=1.
    pub albedo: f64,
    /// Altitude of the eye over the ground, metres, 0..=50,000.
    pub altitude: f64,
    /// Elevation of the sun over the horizon, radians, -π/2..=π/2.
    pub elevation: f64,
}

/// A clear sky.
#[derive(Clone, Debug)]
pub struct ClearSky {
    /// Radiance, W/(m² sr nm): rows from straight up to straight down, in each from the direction of the sun all
    /// around.
    pub radiance: Vec<Spectral>,
    /// Irradiance of a surface that faces the sun by the sun alone, W/(m² nm).
    pub sun: Spectral,
}

/// The sky that was asked for last.
static LAST: Mutex<Option<(Atmosphere, Arc<ClearSky>)>> = Mutex::new(None);

impl ClearSky {
    /// The sky of [`ClearSky::new`], found anew only if another one was asked for since: frames of an animation and runs
    /// of its script mostly have the same one.
    pub fn shared(atmosphere: &Atmosphere) -> Arc<ClearSky> {
        let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
        let known = last().as_ref().filter(|(of, _)| of == atmosphere).map(|(_, sky)| Arc::clone(sky));
        // It is not locked meanwhile: a thread that finds the sky may be given other work that asks for one.
        known.unwrap_or_else(|| {
            let sky = Arc::new(ClearSky::new(atmosphere));
            *last() = Some((*atmosphere, Arc::clone(&sky)));
            sky
        })
    }

    /// Finds the sky.
    ///
    /// Time: about a million steps along lines of sight, whatever the numbers.
    pub fn new(atmosphere: &Atmosphere) -> ClearSky {
        let air = Air::new(atmosphere.turbidity);
        let columns = Columns::new();
        let sun = [atmosphere.elevation.sin(), atmosphere.elevation.cos()];
        let scattering = Scattering::new(&air, &columns, atmosphere.albedo);
        let eye = atmosphere.altitude / 1000.0;
        let half = COLUMNS / 2;
        let row = |row: usize| -> Vec<Spectral> {
            let zenith = row as f64 / (ROWS - 1) as f64 * PI;
            let along = |column: usize| {
                let turn = column as f64 / COLUMNS as f64 * TAU;
                let view = DVec3::new(zenith.sin() * turn.cos(), zenith.cos(), zenith.sin() * turn.sin());
                scattering.radiance(eye, view, DVec3::new(sun[1], sun[0], 0.0))
            };
            let first: Vec<Spectral> = (0..=half).map(along).collect();
            // The other half is a mirror image.
            let second = (1..half).rev().map(|column| first[column]);
            first.iter().copied().chain(second).collect()
        };
        let radiance = (0..ROWS).into_par_iter().flat_map_iter(row).collect();
        ClearSky { radiance, sun: scattering.of_sun(eye, sun[0]) }
    }

    /// Irradiance of level ground by the sky, W/(m² nm).
    pub fn irradiance(&self) -> Spectral {
        let step = PI / (ROWS - 1) as f64;
        let mut sums = [0.0; NODES];
        for (row, lights) in self.radiance.chunks_exact(COLUMNS).enumerate().take(ROWS / 2 + 1) {
            let zenith = row as f64 * step;
            let end = if zenith > FRAC_PI_2 - 0.5 * step { 0.5 } else { 1.0 };
            let part = zenith.sin() * zenith.cos().max(0.0) * step * TAU / COLUMNS as f64 * end;
            for light in lights {
                sums.iter_mut().zip(light).for_each(|(sum, light)| *sum += part * light);
            }
        }
        sums
    }
}
