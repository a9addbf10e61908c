//! Frames one after the other: each is left as it is, copied from the one before, or rendered.

use super::arguments::AnimateArguments;
use super::fingerprint::{Fingerprints, FrameFingerprint, is_metered};
use super::frames::{FINGERPRINT, are_there};
use crate::cli::rendering::{self, PictureWriter, ReadyScene};
use crate::cli::rendering_arguments::RenderingArguments;
use crate::cli::source::{load_lit_at, stem};
use crate::cli::{CommandFailure, output, progress};
use crate::picture::Picture;
use crate::picture::display::{DisplayTransform, Exposure};
use crate::plan::Plan;
use crate::render::metering::Meter;
use crate::render::{AnyRenderer, PreparedRenderer, Task};
use crate::scene::View;
use crate::script::Evaluated;
use files::Destination;
use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// How a frame came to be there.
pub(super) enum FrameOrigin {
    /// It was there already.
    Kept,
    /// It is the picture of the frame before.
    Copied,
    /// It was rendered.
    Rendered {
        /// Wall-clock time of the whole frame, its scene included, seconds.
        seconds: f64,
        /// What `--json` tells of it.
        known: Value,
        /// The part of its pixels that miss the error that was asked for, 0..=1.
        missing: f64,
    },
}

/// The frames of a scene, as far as they were looked at.
pub(super) struct Sequence<'a> {
    arguments: &'a AnimateArguments,
    fingerprints: Fingerprints,
    /// The scene at the time 0, if it was needed.
    beginning: Option<Arc<Evaluated>>,
    /// The exposure that the meter finds there, stops, if it was needed.
    metered_stops: Option<f64>,
    /// The scene of all times, if it does not depend on the time.
    still: Option<Arc<Evaluated>>,
    /// The last frame, and its files.
    last: Option<(FrameFingerprint, Vec<PathBuf>)>,
}

impl<'a> Sequence<'a> {
    /// No frame was looked at.
    pub(super) fn new(arguments: &'a AnimateArguments) -> Sequence<'a> {
        Sequence {
            arguments,
            fingerprints: Fingerprints::default(),
            beginning: None,
            metered_stops: None,
            still: None,
            last: None,
        }
    }

    /// Sees to it that the files of a frame are there.
    ///
    /// # Errors
    /// A [`CommandFailure`] for a scene or a picture that cannot be made, and for files that cannot be written.
    pub(super) fn make(&mut self, number: u32) -> Result<FrameOrigin, CommandFailure> {
        let begin = Instant::now();
        let arguments = self.arguments;
        let options = &arguments.rendering;
        let evaluated = self.scene_of(number)?;
        let exposure = options.display_of(&evaluated.scene)?.exposure;
        let metered = if is_metered(exposure) { Some(self.scene_of(0)?) } else { None };
        let fingerprint = self.fingerprints.of(&arguments.script, options, &evaluated, metered.as_deref())?;
        let files = arguments.files(number);
        let before = self.last.replace((fingerprint, files.clone()));
        if are_there(&files, fingerprint) {
            return Ok(FrameOrigin::Kept);
        }
        let outputs = files.iter().map(|path| Picture::destination(path)).collect::<Result<Vec<_>, _>>()?;
        if let Some((_, files)) = before.filter(|(other, _)| *other == fingerprint) {
            for (file, output) in files.iter().zip(&outputs) {
                let bytes = std::fs::read(file)?;
                output.write(|to| to.write_all(&bytes))?;
            }
            return Ok(FrameOrigin::Copied);
        }
        let stops = match (exposure, metered) {
            (Exposure::Auto { compensation }, Some(beginning)) => compensation + self.stops_of(&beginning)?,
            (Exposure::Auto { compensation: stops } | Exposure::Stops(stops), _) => stops,
        };
        let (known, missing) = render(arguments, &evaluated, fingerprint, stops, &outputs)?;
        Ok(FrameOrigin::Rendered { seconds: begin.elapsed().as_secs_f64(), known, missing })
    }

    /// The scene of a frame.
    fn scene_of(&mut self, number: u32) -> Result<Arc<Evaluated>, CommandFailure> {
        let known = self.still.as_ref().or(self.beginning.as_ref().filter(|_| number == 0));
        if let Some(known) = known {
            return Ok(Arc::clone(known));
        }
        let evaluated = Arc::new(load_lit_at(&self.arguments.script, &self.arguments.inputs(number))?);
        if !evaluated.is_timed {
            output::warn(
                "the scene does not depend on the time: its frames are all one picture, which is rendered once",
            );
            self.still = Some(Arc::clone(&evaluated));
        } else if number == 0 {
            self.beginning = Some(Arc::clone(&evaluated));
        }
        Ok(evaluated)
    }

    /// What the meter finds in the scene at the time 0, stops.
    fn stops_of(&mut self, beginning: &Evaluated) -> Result<f64, CommandFailure> {
        if let Some(stops) = self.metered_stops {
            return Ok(stops);
        }
        let options = &self.arguments.rendering;
        let display = options.display_of(&beginning.scene)?;
        let display = DisplayTransform { exposure: Exposure::Auto { compensation: 0.0 }, ..display };
        let meter = Meter::new(&beginning.scene.settings, &display, options.threads);
        let stops = with_renderer(options, beginning, |ready, renderer, view| {
            Ok(meter.stops(renderer.any(), &ready.prepared, &[*view], &progress::watch())?)
        })?;
        self.metered_stops = Some(stops);
        Ok(stops)
    }
}

/// Does work with the renderer of a scene, as its own camera sees it.
fn with_renderer<T>(
    options: &RenderingArguments,
    evaluated: &Evaluated,
    work: impl FnOnce(&ReadyScene, &AnyRenderer<'_>, &View) -> Result<T, CommandFailure>,
) -> Result<T, CommandFailure> {
    let ready = ReadyScene::new(evaluated.scene.clone(), options, None)?;
    let view = ready.prepared.view();
    let plan = Plan::of_views(&ready.prepared, &[view], options.everything);
    let task = Task { prepared: &ready.prepared, plan: &plan, photon_store: None, watch: progress::watch() };
    let PreparedRenderer { renderer, .. } = rendering::prepare(options, &task)?;
    work(&ready, &renderer, &view)
}

/// Renders a frame into its files; what `--json` tells of it, and the part of its pixels that miss the error.
fn render(
    arguments: &AnimateArguments,
    evaluated: &Evaluated,
    fingerprint: FrameFingerprint,
    stops: f64,
    outputs: &[Destination],
) -> Result<(Value, f64), CommandFailure> {
    let options = &arguments.rendering;
    with_renderer(options, evaluated, |ready, renderer, view| {
        let ReadyScene { prepared, order, display, .. } = ready;
        rendering::warn_of_left_out(options, renderer, view);
        let rendering = rendering::render(renderer, (view, order), &progress::watch(), options.layers, None, None)?;
        let source = stem(&arguments.script);
        let writer = PictureWriter { arguments: options, source, prepared, display, stops };
        let provenance = writer.provenance(&rendering).with(FINGERPRINT, fingerprint);
        let clipped = writer.write(outputs, view, &rendering, &provenance)?;
        writer.warn_of_clipping(clipped);
        let paths: Vec<&Path> = outputs.iter().map(Destination::path).collect();
        Ok((writer.json(&paths, &rendering), writer.missing(&rendering)))
    })
}
