//! A picture with what it took.

use super::film::Film;
use super::two_way::FluxBalance;
use crate::picture::display::DisplayTransform;
use crate::picture::{Picture, Provenance};
use serde::Serialize;

/// A picture with what it took.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The picture; pixels that were not begun are black and uncovered.
    pub picture: Picture,
    /// All that is known of its pixels.
    pub film: Film,
    /// Whether nothing was left out because the rendering was stopped.
    pub complete: bool,
    /// How many rays were traced; by scan line, those that finished samples.
    pub rays: RayCounts,
    /// How many spans were drawn; none by ray tracing.
    pub spans: SpanCounts,
    /// The samples that rays finished; none by ray tracing, of which all samples are.
    pub finished: FinishedCounts,
    /// The balance of the flux of the photons that were traced first, if any were.
    pub flux_balance: Option<FluxBalance>,
    /// Wall-clock time, seconds.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

impl Rendering {
    /// What a file tells of how the picture was made: source, renderer, samples, seed, exposure, tone, and error, if it
    /// is known.
    ///
    /// - `source`: the name of the scene. `renderer`: its word.
    /// - `display`: how the picture is shown, exposed by `stops`.
    pub fn provenance(
        &self,
        source: &str,
        renderer: &str,
        seed: u64,
        display: &DisplayTransform,
        stops: f64,
    ) -> Provenance {
        let [least, most] = self.film.samples();
        let provenance = Provenance::new(display.white)
            .with("Source", source)
            .with("Renderer", renderer)
            .with("Samples", format!("{least} to {most}"))
            .with("Seed", seed)
            .with("Exposure", format!("{stops:.4} stops, in PNG files only"))
            .with("Tone", display.tone.word());
        let error = self.film.standard_error();
        if error.is_finite() {
            provenance.with("Error", format!("{error:.3e}, standard error of luminance"))
        } else {
            provenance
        }
    }

    /// Rays of all kinds per second, in millions.
    pub fn mega_rays_per_second(&self) -> f64 {
        self.rays.total() as f64 / self.seconds.max(f64::MIN_POSITIVE) / 1e6
    }
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// Towards lights.
    pub shadow: u64,
    /// From surfaces that reflect or transmit.
    pub reflected: u64,
    /// Shadow rays that were not needed: the light buffer knew that no light comes from there.
    pub spared: u64,
}

impl RayCounts {
    /// All that were traced.
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.reflected
    }
}

impl std::ops::Add for RayCounts {
    type Output = RayCounts;

    fn add(self, other: RayCounts) -> RayCounts {
        RayCounts {
            primary: self.primary + other.primary,
            shadow: self.shadow + other.shadow,
            reflected: self.reflected + other.reflected,
            spared: self.spared + other.spared,
        }
    }
}

/// Samples that scan line leaves to rays: those of mirrors, metals, coats and glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FinishedCounts {
    /// Pixels with such samples.
    pub pixels: u64,
    /// The samples.
    pub samples: u64,
    /// The time that they took, all threads together, seconds.
    pub seconds: f64,
}

impl std::ops::Add for FinishedCounts {
    type Output = FinishedCounts;

    fn add(self, other: FinishedCounts) -> FinishedCounts {
        FinishedCounts {
            pixels: self.pixels + other.pixels,
            samples: self.samples + other.samples,
            seconds: self.seconds + other.seconds,
        }
    }
}

/// Spans of samples by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SpanCounts {
    /// Spans of triangles that may be seen.
    pub surfaces: u64,
    /// Spans of shadow polygons.
    pub shadows: u64,
}

impl std::ops::Add for SpanCounts {
    type Output = SpanCounts;

    fn add(self, other: SpanCounts) -> SpanCounts {
        SpanCounts { surfaces: self.surfaces + other.surfaces, shadows: self.shadows + other.shadows }
    }
}
