//! Views that are rendered one after the other, each written and reported on.

use super::arguments::RenderArguments;
use super::saved::Saved;
use crate::cli::interrupts::{self, InterruptGuard};
use crate::cli::output;
use crate::cli::rendering::{PictureWriter, check_error};
use crate::cli::{CommandFailure, Exit, progress};
use crate::memory;
use crate::octree::InstanceCosts;
use crate::picture::Picture;
use crate::render::radiosity::RadiosityReport;
use crate::render::ray_tracing::Checkpoints;
use crate::render::{Film, Rendering};
use crate::scene::{DetailCosts, View};
use crate::stages::StageTotal;
use files::Destination;
use serde_json::Value;
use std::path::Path;

/// Renders a view: on a film that was begun before, if there is one, and keeping it from time to time.
pub(super) type Render<'a> =
    dyn FnMut(&View, Option<Film>, Option<Checkpoints<'_>>) -> Result<Rendering, CommandFailure> + 'a;

/// Views of a scene, and their files.
pub(super) struct ViewBatch<'a> {
    pub(super) arguments: &'a RenderArguments,
    pub(super) views: &'a [View],
    /// The files of each view.
    pub(super) outputs: &'a [Vec<Destination>],
    /// How they are written; all have one exposure.
    pub(super) writer: PictureWriter<'a>,
    /// How long it took until the first view could be rendered, seconds.
    pub(super) build_seconds: f64,
    /// What radiosity took.
    pub(super) radiosity: Option<RadiosityReport>,
    /// Where films are kept, and what was there.
    pub(super) saved: Option<Saved<'a>>,
    /// Whether all of a picture is there before it has all its samples.
    pub(super) comes_bit_by_bit: bool,
}

impl ViewBatch<'_> {
    /// Renders the views, writes them and reports on them.
    ///
    /// # Errors
    /// [`CommandFailure`], also for a picture that was interrupted, or has pixels that miss the error that was asked for.
    pub(super) fn render(mut self, render: &mut Render<'_>) -> Result<(), CommandFailure> {
        let mut reports = Vec::new();
        let ended = self.render_all(render, &mut reports);
        match self.arguments.views {
            _ if !self.arguments.json || reports.is_empty() => {}
            Some(_) => output::report(Value::Array(reports)),
            None => output::report(reports.pop().unwrap_or_default()),
        }
        ended
    }

    fn render_all(&mut self, render: &mut Render<'_>, reports: &mut Vec<Value>) -> Result<(), CommandFailure> {
        let mut missing: f64 = 0.0;
        for (number, (view, outputs)) in self.views.iter().zip(self.outputs).enumerate() {
            if self.saved.as_ref().is_some_and(|saved| saved.has_finished(number, outputs)) {
                continue;
            }
            let keeping = self.comes_bit_by_bit.then(InterruptGuard::begin);
            let film = self.saved.as_mut().and_then(|saved| saved.take(number));
            let saved = self.saved.as_ref();
            let mut keep = |film: &Film| saved.map_or(Ok(()), |saved| saved.write(number, film));
            let checkpoints = saved.map(|saved| Checkpoints { every: saved.every, keep: &mut keep });
            let rendering = render(view, film, checkpoints)?;
            let [least, most] = rendering.film.samples();
            let is_whole = least > 0;
            let written = match is_whole {
                true => self.writer.write(outputs, view, &rendering, &self.writer.provenance(&rendering)),
                false => Ok(0.0),
            };
            // The state comes after the picture, and does not depend on it.
            let is_followed = rendering.complete && number + 1 < self.views.len();
            let kept = saved.map_or(Ok(()), |saved| match is_followed {
                true => saved.write_next(number + 1, &rendering.film),
                false => saved.write(number, &rendering.film),
            });
            drop(keeping);
            self.writer.warn_of_clipping(written?);
            if is_whole {
                let outputs: Vec<&Path> = outputs.iter().map(Destination::path).collect();
                match self.arguments.json {
                    true => reports.push(self.json(&outputs, &rendering)),
                    false => self.report(&outputs, &rendering),
                }
            }
            kept?;
            let failed = |exit, message: String| Err(CommandFailure::new(exit, anyhow::anyhow!(message)));
            match (is_whole, rendering.complete) {
                (true, true) => {}
                (true, false) => {
                    let message = format!("interrupted; pixels have {least} to {most} samples, which are kept");
                    return failed(Exit::Interrupted, message);
                }
                (false, false) => {
                    let message = "interrupted before every pixel had a sample; no picture is written";
                    return failed(Exit::Interrupted, message.into());
                }
                (false, true) => {
                    let message = "time ran out before every pixel had a sample; no picture is written";
                    return failed(Exit::Missed, message.into());
                }
            }
            interrupts::note_saved("pictures of finished views are written");
            missing = missing.max(self.writer.missing(&rendering));
        }
        check_error(&self.arguments.rendering, missing, "the picture is")
    }

    fn json(&self, outputs: &[&Path], rendering: &Rendering) -> serde_json::Value {
        let mut known = self.writer.json(outputs, rendering);
        known["build_seconds"] = self.build_seconds.into();
        known["radiosity"] = serde_json::json!(self.radiosity);
        known["stages"] = serde_json::json!(progress::totals());
        known
    }

    fn report(&self, outputs: &[&Path], rendering: &Rendering) {
        let picture = &rendering.picture;
        let [least, most] = rendering.film.samples();
        let names: Vec<String> = outputs.iter().map(|p| p.display().to_string()).collect();
        let samples = if least == most { format!("{least}") } else { format!("{least} to {most}") };
        let error = rendering.film.standard_error();
        let error = match (error.is_finite(), self.arguments.rendering.denoise) {
            (true, false) => format!("standard error of luminance {error:.2e}"),
            (true, true) => format!("standard error of luminance {error:.2e} before it was denoised"),
            // One sample of each pixel tells nothing of its error.
            (false, _) => "of unknown error".into(),
        };
        say!(
            "{}: {} x {} pixels, {samples} samples each; {error}",
            names.join(", "),
            picture.width(),
            picture.height()
        );
        let (build_seconds, memory) = (self.build_seconds, memory::readable(memory::peak()));
        let (seconds, threads) = (rendering.seconds, rendering.threads);
        say!("rendered in {seconds:.3} s after {build_seconds:.3} s of preparation, on {threads} threads in {memory}");
        if outputs.iter().any(|output| !Picture::is_exr(output)) {
            say!("exposed by {:+.2} stops, tone {}", self.writer.stops, self.writer.display.tone.word());
        }
        if self.arguments.stats {
            self.report_statistics(rendering);
        }
    }

    /// Says how much work it was.
    fn report_statistics(&self, rendering: &Rendering) {
        for StageTotal { name, depth, seconds, times } in progress::totals() {
            let times = if times > 1 { format!(", {times} times") } else { String::new() };
            say!("{seconds:>9.3} s  {:indent$}{name}{times}", "", indent = 2 * depth);
        }
        say!("{} triangles", self.writer.prepared.triangles.len());
        if let Some(InstanceCosts { instances, stored, bytes, triangles }) = self.writer.prepared.instance_costs() {
            let (each, memory) = (bytes as f64 / stored.max(1) as f64, memory::readable(bytes as u64));
            let stored = if stored < instances { format!(", {stored} of them stored") } else { String::new() };
            say!("{instances} instances{stored} in {memory}, {each:.1} bytes each; they place {triangles} triangles");
        }
        if let Some(DetailCosts { made, kept, bytes, most_bytes }) = self.writer.prepared.detail_costs() {
            let [bytes, most] = [bytes, most_bytes].map(memory::readable);
            say!("detail made on demand {made} times; {kept} of these are kept, in {bytes} of at most {most}");
        }
        if let Some(balance) = &rendering.flux_balance {
            say!("{balance}");
        }
        self.radiosity.iter().flat_map(RadiosityReport::lines).for_each(|line| say!("{line}"));
        let Rendering { rays, spans, finished, .. } = rendering;
        if !self.arguments.rendering.renderer.row().adds_samples {
            say!("{} spans of surfaces, {} of shadow polygons", spans.surfaces, spans.shadows);
            if finished.pixels > 0 {
                say!(
                    "{} pixels finished by rays, {:.1} % of all: {} samples, {:.3} s of all threads together",
                    finished.pixels,
                    100.0 * finished.pixels as f64 / rendering.film.tallies().len() as f64,
                    finished.samples,
                    finished.seconds
                );
            }
            if rays.total() == 0 {
                return;
            }
        }
        let spared = if rays.spared > 0 { format!(", {} more spared", rays.spared) } else { String::new() };
        say!(
            "{} rays: {} primary, {} to lights{spared}, {} reflected or refracted; {:.2} million a second",
            rays.total(),
            rays.primary,
            rays.shadow,
            rays.reflected,
            rendering.mega_rays_per_second()
        );
    }
}
