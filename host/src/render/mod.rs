//! Renderers: from a prepared scene and a view to a picture.

mod denoising;
mod element;
#[cfg(test)]
mod extreme_tests;
mod eye;
mod film;
mod guide;
mod layers;
mod memo;
pub mod metering;
mod ready;
pub mod radiosity;
pub mod ray_tracing;
pub mod scan_line;
pub mod tiles;
mod state;

pub use film::{ByClass, Class, Film, Sample, Tally};
pub use memo::Memo;
pub use state::{Fingerprint, State, StateError};

use crate::illumination::material::MaterialError;
use crate::octree::OctreeError;
use crate::picture::display::DisplayTransform;
use crate::picture::{Filter, Picture, PictureError, Provenance};
use crate::scene::View;
use serde::Serialize;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

/// A renderer that has taken up a scene and can make pictures of it.
pub trait Renderer: Sync {
    /// Its name in tables.
    fn name(&self) -> &'static str;

    /// Renders one view.
    ///
    /// The picture does not depend on the number of threads.
    ///
    /// # Errors
    /// [`RenderError`] for a view that sees nothing, or when no memory or thread can be had. Being cancelled is no
    /// error: the rendering then holds the rows that were finished.
    fn render(&self, view: &View, order: &Order, watch: &Watch<'_>) -> Result<Rendering, RenderError>;
}

/// How a picture is to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples in each pixel, 1 and more; one samples the centre. With a target or a budget, the most of them.
    pub samples: u32,
    /// So many samples of a pixel share the footprint in which textures are filtered, 1 and more: as many as there are, or
    /// are thought to become.
    pub footprints: u32,
    /// How samples around a pixel become one value.
    pub filter: Filter,
    /// Relative error of the luminance at which a pixel has samples enough; none for all samples everywhere.
    pub target: Option<f64>,
    /// Seconds after which no sample is begun.
    pub seconds: Option<f64>,
    /// Whether samples that meet nothing are black: a picture whose radiance is premultiplied by its coverage. The
    /// background behind glass and in mirrors stays.
    pub matte: bool,
    /// Whether the picture is denoised, by ray tracing; scan line has no noise.
    pub denoise: bool,
    /// Seed of the sample positions.
    pub seed: u64,
    /// Threads; every core without a number.
    pub threads: Option<NonZeroUsize>,
}

impl Order {
    /// What the scene's settings ask for, on every core.
    pub fn of(settings: &crate::scene::Settings) -> Order {
        let crate::scene::Settings { width, height, samples, filter, seed, .. } = *settings;
        Order {
            width,
            height,
            samples,
            footprints: samples,
            filter,
            target: None,
            seconds: None,
            matte: false,
            denoise: false,
            seed,
            threads: None,
        }
    }
}

/// How much of a stage of the work is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    /// What is done, `0..=all`.
    pub done: f64,
    /// All that is to be done.
    pub all: f64,
    /// What is counted, such as `samples`.
    pub unit: &'static str,
}

impl Amount {
    /// So many of so many.
    pub fn of(done: u64, all: u64, unit: &'static str) -> Amount {
        Amount { done: done as f64, all: all as f64, unit }
    }
}

/// Who watches a rendering and may stop it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Set from outside to stop after the rows that are being rendered.
    pub cancelled: &'a AtomicBool,
    /// Called when more of the stage is done; from any thread.
    pub progress: &'a (dyn Fn(Amount) + Sync),
    /// Called when another stage of the work begins, with words such as `while rendering`.
    pub stage: &'a (dyn Fn(&'static str) + Sync),
    /// Where results of long computations are kept, if anywhere.
    pub memo: Option<&'a Memo>,
}

/// Is never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// Nobody watches.
    pub const NOBODY: Watch<'static> = Watch { cancelled: &NEVER, progress: &|_| {}, stage: &|_| {}, memo: None };

    /// One who may stop what another watches, and sees nothing of it.
    pub fn quiet(&self) -> Watch<'_> {
        Watch { cancelled: self.cancelled, ..Watch::NOBODY }
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// A picture with what it took.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The picture; pixels that were not begun are black and uncovered.
    pub picture: Picture,
    /// All that is known of its pixels.
    pub film: Film,
    /// Whether nothing was left out because the rendering was stopped.
    pub complete: bool,
    /// How many rays were traced; none by scan line.
    pub rays: RayCounts,
    /// How many spans were drawn; none by ray tracing.
    pub spans: SpanCounts,
    /// What became of the light of lamps that was followed first, if any was.
    pub balance: Option<ray_tracing::Balance>,
    /// Wall-clock time, seconds.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

impl Rendering {
    /// What a file tells of how the picture was made: source, renderer, samples, seed, exposure, tone, and error, if it is
    /// known.
    ///
    /// - `source`: the name of the scene. `renderer`: its word.
    /// - `display`: how the picture is shown, exposed by `stops`.
    pub fn provenance(
        &self,
        (source, renderer): (&str, &str),
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
    /// From the eye.
    pub primary: u64,
    /// Towards lights.
    pub shadow: u64,
    /// From surfaces that reflect or let through.
    pub reflected: u64,
    /// Rays towards lights that were not needed: the light buffer knew that nothing comes from there.
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

/// Spans of samples by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SpanCounts {
    /// Of triangles that may be seen.
    pub surfaces: u64,
    /// Of shadow polygons.
    pub shadows: u64,
}

impl std::ops::Add for SpanCounts {
    type Output = SpanCounts;

    fn add(self, other: SpanCounts) -> SpanCounts {
        SpanCounts { surfaces: self.surfaces + other.surfaces, shadows: self.shadows + other.shadows }
    }
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The octree cannot be built.
    #[error("octree: {0}")]
    Octree(#[from] OctreeError),
    /// The picture cannot be made.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A material is impossible.
    #[error("{object}: {source}")]
    Material {
        /// The object.
        object: String,
        /// Why.
        source: MaterialError,
    },
    /// The view flattens space to a line or a point, or is not finite.
    #[error("the view has no directions for the pixels: its matrix is singular or not finite")]
    View,
    /// Radiosity has no solution.
    #[error("radiosity: {0}")]
    Radiosity(#[from] radiosity::Unsolvable),
    /// The threads cannot be started.
    #[error("threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
