//! `peris render`: a scene to a picture file.

mod arguments;
mod pixel;
mod saved;
mod views;

use super::output::warn;
use super::source::{load_lit, warn_of_emptiness, warn_of_short_scatters};
use super::{CommandFailure, Exit, SubcommandRow, progress};
use crate::picture::display::DisplayTransform;
use crate::plan::Plan;
use crate::render::metering::Meter;
use crate::render::two_way::PhotonStore;
use crate::render::{AnyRenderer, Film, Fingerprint, PreparedRenderer, RenderError, RenderOrder, Task, Watch};
use crate::scene::Prepared;
use crate::stages::{Workers, stage};
use arguments::RenderArguments;
use clap::{Args, FromArgMatches};
use files::Destination;
use saved::{Intermediate, Saved};
use std::path::Path;
use std::time::Duration;
use views::ViewBatch;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "render",
    summary: "Renders a scene by ray tracing, scan line or radiosity into a PNG or EXR file.",
    arguments: RenderArguments::augment_args,
    run: |matches| run(&RenderArguments::from_arg_matches(matches)?),
};

fn run(arguments: &RenderArguments) -> Result<(), CommandFailure> {
    arguments.check()?;
    let outputs = arguments.destinations()?;
    let state = arguments.resume.as_ref().map(Destination::of).transpose()?;
    arguments.light.as_ref().map(Destination::of).transpose()?;
    let mut scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    warn_of_emptiness(&scene);
    // Layers of a composition are put together as light, and exposed as a whole.
    let display = arguments.display.over(if arguments.matte { DisplayTransform::LINEAR } else { scene.display })?;
    // Several views are exposed as the first, which is that of the scene.
    let meter = Meter::new(&scene.settings, &display, arguments.threads);
    arguments.set(&mut scene.settings);
    let preparing = stage!("preparing");
    let prepared = Prepared::new(&scene)?;
    warn_of_short_scatters(&prepared);
    let views = arguments.views_of(&prepared)?;
    let plan = Plan::of_views(&prepared, &views, arguments.everything);
    let order = arguments.render_options(&prepared.settings);
    check_denoising(&order)?;
    let every = Duration::from_secs_f64(arguments.checkpoint.min(1e9));
    let intermediate = Intermediate::of(arguments, &plan);
    let keeps = |(path, lasts): (&Path, bool)| PhotonStore::new(path, &scene, &prepared, every, lasts);
    let photon_store = intermediate.light(arguments).map(keeps).transpose()?;
    // Only what is kept has to be known again.
    let fingerprint = state.as_ref().map(|_| Fingerprint::of(&scene, &prepared, &order));
    let memo = intermediate.memo(arguments, fingerprint.as_ref())?;
    let watch = Watch { memo: memo.as_ref(), ..progress::watch() };
    if order.seconds.is_none() && order.target.is_none() {
        progress::follow(&format!("{} samples", order.samples));
    }
    let mut all = ViewBatch {
        arguments,
        views: &views,
        outputs: &outputs,
        prepared: &prepared,
        display: &display,
        stops: 0.0,
        build_seconds: 0.0,
        radiosity: None,
        saved: None,
        comes_bit_by_bit: false,
    };
    let row = arguments.renderer.row();
    if let (true, Some(state), Some(fingerprint)) = (row.adds_samples, &state, fingerprint) {
        all.saved = Some(Saved::read(arguments, every, state, fingerprint, &order)?);
    }
    let task = Task { prepared: &prepared, plan: &plan, photon_store: photon_store.as_ref(), watch };
    let workers = Workers::new(arguments.threads).map_err(RenderError::from)?;
    let PreparedRenderer { renderer, radiosity } = workers.install(|| arguments.renderer.prepare(&task))?;
    all.radiosity = radiosity;
    if let (Some(pixel), AnyRenderer::BySamples(tracer)) = (arguments.pixel, &renderer) {
        let _stage = stage!("sampling the pixel");
        return pixel::explain(arguments, tracer, &views[0], &order, pixel);
    }
    renderer.any().left_out(&views[0]).iter().for_each(|what| warn(&format!("by {}, {what}", row.word)));
    all.stops = meter.stops(renderer.any(), &prepared, &views[..1], &watch)?;
    all.build_seconds = preparing.seconds();
    drop(preparing);
    let ended = match &renderer {
        AnyRenderer::Whole(renderer) => all.render(&mut |view, _, _| Ok(renderer.render(view, &order, &watch)?)),
        AnyRenderer::BySamples(tracer) => {
            all.comes_bit_by_bit = true;
            all.render(&mut |view, film, checkpoints| {
                let film = film.map_or_else(|| Film::new(order.width, order.height), Ok)?;
                let film = if arguments.layers && state.is_none() { film.with_classes() } else { film };
                Ok(tracer.resume(film, view, &order, &watch, checkpoints)?)
            })
        }
    };
    if ended.as_ref().map_or_else(|failure| failure.exit == Exit::Missed, |()| true) {
        intermediate.remove();
    }
    ended
}

/// Checks that a picture that is to be denoised has the samples for it.
fn check_denoising(order: &RenderOrder) -> Result<(), CommandFailure> {
    if order.denoise && order.samples < 2 {
        let message = "--denoise needs 2 samples in each pixel: what differs between them is noise";
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    Ok(())
}
