//! A scene made ready, rendered, and written into files: what commands that render pictures share.

use super::output::warn;
use super::rendering_arguments::RenderingArguments;
use super::source::{warn_of_emptiness, warn_of_short_scatters};
use super::{CommandFailure, Exit};
use crate::picture::display::{DisplayTransform, Tone, clipped};
use crate::picture::{Picture, Provenance};
use crate::render::metering::Meter;
use crate::render::ray_tracing::Checkpoints;
use crate::render::{AnyRenderer, Film, PreparedRenderer, RenderError, RenderOrder, Rendering, Task, Watch};
use crate::scene::{Prepared, Scene, View};
use crate::stages::{Workers, stage};
use files::Destination;
use serde_json::Value;
use std::path::Path;

/// The part of the pixels that are clipped from which on it is told: less than it are lamps in sight.
const REPORTED_CLIPPING: f64 = 1e-3;

/// A scene with all that is known of its pictures before a renderer takes it up.
pub(super) struct ReadyScene {
    /// The scene, with the settings of the command line.
    pub(super) scene: Scene,
    /// The scene as renderers take it.
    pub(super) prepared: Prepared,
    /// How its pictures are to be made.
    pub(super) order: RenderOrder,
    /// How PNG files are shown.
    pub(super) display: DisplayTransform,
    /// What finds their exposure, if the display leaves it open.
    pub(super) meter: Meter,
}

impl ReadyScene {
    /// Prepares a scene as the command line wants it.
    ///
    /// - `seconds`: after which no sample is begun.
    ///
    /// # Errors
    /// A [`CommandFailure`] for a scene that cannot be made, and for options that do not go together.
    pub(super) fn new(
        mut scene: Scene,
        arguments: &RenderingArguments,
        seconds: Option<f64>,
    ) -> Result<ReadyScene, CommandFailure> {
        warn_of_emptiness(&scene);
        let display = arguments.display_of(&scene)?;
        let meter = Meter::new(&scene.settings, &display, arguments.threads);
        arguments.set(&mut scene.settings);
        let prepared = Prepared::new(&scene)?;
        if let Some(most) = arguments.detail_memory {
            prepared.limit_details(most);
        }
        warn_of_short_scatters(&prepared);
        let order = arguments.order(&prepared.settings, seconds)?;
        Ok(ReadyScene { scene, prepared, order, display, meter })
    }
}

/// Prepares the renderer that the command line names.
///
/// # Errors
/// [`RenderError`] as a [`CommandFailure`].
pub(super) fn prepare<'a>(
    arguments: &RenderingArguments,
    task: &Task<'a>,
) -> Result<PreparedRenderer<'a>, CommandFailure> {
    let workers = Workers::new(arguments.threads).map_err(RenderError::from)?;
    Ok(workers.install(|| arguments.renderer.prepare(task))?)
}

/// Says on standard error what pictures of a view do not show.
pub(super) fn warn_of_left_out(arguments: &RenderingArguments, renderer: &AnyRenderer<'_>, view: &View) {
    let word = arguments.renderer.row().word;
    renderer.any().left_out(view).iter().for_each(|what| warn(&format!("by {word}, {what}")));
}

/// Renders a view.
///
/// - `classes`: whether the kinds of light are kept apart on a new film.
/// - `film`: begun before, if it was. `checkpoints`: when it is kept; both where samples are added one by one only.
///
/// # Errors
/// [`RenderError`] as a [`CommandFailure`].
pub(super) fn render(
    renderer: &AnyRenderer<'_>,
    (view, order): (&View, &RenderOrder),
    watch: &Watch<'_>,
    classes: bool,
    film: Option<Film>,
    checkpoints: Option<Checkpoints<'_>>,
) -> Result<Rendering, CommandFailure> {
    Ok(match renderer {
        AnyRenderer::Whole(renderer) => renderer.render(view, order, watch)?,
        AnyRenderer::BySamples(tracer) => {
            let film = film.map_or_else(|| Film::new(order.width, order.height), Ok).map_err(RenderError::from)?;
            let film = if classes { film.with_classes() } else { film };
            tracer.resume(film, view, order, watch, checkpoints)?
        }
    })
}

/// How the pictures of a scene are written, and told of.
#[derive(Clone, Copy)]
pub(super) struct PictureWriter<'a> {
    pub(super) arguments: &'a RenderingArguments,
    /// The name of the scene.
    pub(super) source: &'a str,
    pub(super) prepared: &'a Prepared,
    /// How PNG files are shown.
    pub(super) display: &'a DisplayTransform,
    /// Their exposure, stops.
    pub(super) stops: f64,
}

impl PictureWriter<'_> {
    /// What the files of a picture tell of how it was made.
    pub(super) fn provenance(&self, rendering: &Rendering) -> Provenance {
        let renderer = self.arguments.renderer.row().option;
        let seed = self.prepared.settings.image.seed;
        let provenance = rendering.provenance(self.source, renderer, seed, self.display, self.stops);
        match self.arguments.denoise {
            true => provenance.with("Denoiser", "first-order regression"),
            false => provenance,
        }
    }

    /// Writes the files of a picture; the part of the pixels that are clipped in a PNG file, 0..=1.
    ///
    /// # Errors
    /// [`crate::picture::PictureError`] as a [`CommandFailure`]; other files may be written then.
    pub(super) fn write(
        &self,
        outputs: &[Destination],
        view: &View,
        rendering: &Rendering,
        provenance: &Provenance,
    ) -> Result<f64, CommandFailure> {
        let _stage = stage!("writing");
        let Rendering { picture, film, .. } = rendering;
        let is_seen = outputs.iter().any(|file| !Picture::is_exr(file.path()));
        let shown = match is_seen {
            true => self.display.shown(picture, self.stops, view.pixel_angle(picture.width(), picture.height()))?,
            false => Picture::new(1, 1)?,
        };
        let write = |file: &Destination| match (Picture::is_exr(file.path()), self.arguments.layers) {
            (true, true) => film.write_layers(picture, file, self.prepared, provenance),
            (true, false) => picture.write_with(file, provenance),
            (false, _) => shown.write_with(file, provenance),
        };
        // One that fails is no reason not to write the others.
        let written: Vec<_> = outputs.iter().map(write).collect();
        written.into_iter().collect::<Result<(), _>>()?;
        Ok(clipped(&shown))
    }

    /// Says on standard error that much of a picture is clipped.
    ///
    /// - `clipped`: the part of its pixels, 0..=1.
    pub(super) fn warn_of_clipping(&self, clipped: f64) {
        if clipped > REPORTED_CLIPPING && self.display.tone == Tone::Linear {
            let part = 100.0 * clipped;
            warn(&format!("{part:.1}% of the pixels are brighter than white, and clipped; --tone filmic shows them"));
        }
    }

    /// The part of the pixels that miss the error that was asked for, 0..=1; 0 where none was.
    pub(super) fn missing(&self, rendering: &Rendering) -> f64 {
        self.arguments.error.map_or(0.0, |target| rendering.film.missing(target))
    }

    /// What `--json` tells of a picture.
    pub(super) fn json(&self, outputs: &[&Path], rendering: &Rendering) -> Value {
        let picture = &rendering.picture;
        serde_json::json!({
            "files": outputs,
            "width": picture.width(),
            "height": picture.height(),
            "samples": rendering.film.samples(),
            "standard_error": Some(rendering.film.standard_error()).filter(|error| error.is_finite()),
            "seed": self.prepared.settings.image.seed,
            "exposure": self.stops,
            "tone": self.display.tone.word(),
            "triangles": self.prepared.triangles.len(),
            "instances": self.prepared.instance_costs(),
            "details": self.prepared.detail_costs(),
            "render_seconds": rendering.seconds,
            "threads": rendering.threads,
            "rays": rendering.rays,
            "caught_light": rendering.flux_balance,
            "spans": rendering.spans,
            "finished_by_rays": rendering.finished,
            "denoised": self.arguments.denoise,
            "complete": rendering.complete,
            "pixels_over_error": self.arguments.error.map(|target| rendering.film.missing(target)),
        })
    }
}

/// The end of a command some of whose pixels miss the error that was asked for.
///
/// - `missing`: the largest part of them in a picture, 0..=1. `what`: is written all the same, such as `the picture is`.
///
/// # Errors
/// [`Exit::Missed`] as a [`CommandFailure`], if there are any.
pub(super) fn check_error(arguments: &RenderingArguments, missing: f64, what: &str) -> Result<(), CommandFailure> {
    match arguments.error {
        Some(target) if missing > 0.0 => {
            let part = 100.0 * missing;
            let message =
                format!("{part:.2}% of the pixels have a relative error above {target}; {what} written all the same");
            Err(CommandFailure::new(Exit::Missed, anyhow::anyhow!(message)))
        }
        _ => Ok(()),
    }
}
