//! `peris render`: a scene to a picture file.

mod arguments;
mod pixel;
mod saved;
mod views;

use super::rendering::{self, PictureWriter, ReadyScene};
use super::source::{load_lit, stem};
use super::{CommandFailure, Exit, SubcommandRow, progress};
use crate::plan::Plan;
use crate::render::two_way::PhotonStore;
use crate::render::{AnyRenderer, Fingerprint, PreparedRenderer, Task, Watch};
use crate::stages::stage;
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
    let scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    let options = &arguments.rendering;
    let preparing = stage!("preparing");
    let ReadyScene { scene, prepared, order, display, meter } = ReadyScene::new(scene, options, arguments.seconds)?;
    let views = arguments.views_of(&prepared)?;
    let plan = Plan::of_views(&prepared, &views, options.everything);
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
    let row = options.renderer.row();
    let saved = match (row.adds_samples, &state, fingerprint) {
        (true, Some(state), Some(print)) => Some(Saved::read(arguments, every, state, print, &order)?),
        _ => None,
    };
    let task = Task { prepared: &prepared, plan: &plan, photon_store: photon_store.as_ref(), watch };
    let PreparedRenderer { renderer, radiosity } = rendering::prepare(options, &task)?;
    if let (Some(pixel), AnyRenderer::BySamples(tracer)) = (arguments.pixel, &renderer) {
        let _stage = stage!("sampling the pixel");
        return pixel::explain(arguments, tracer, &views[0], &order, pixel);
    }
    rendering::warn_of_left_out(options, &renderer, &views[0]);
    // Several views are exposed as the first, which is that of the scene.
    let stops = meter.stops(renderer.any(), &prepared, &views[..1], &watch)?;
    let source = stem(&arguments.script);
    let all = ViewBatch {
        arguments,
        views: &views,
        outputs: &outputs,
        writer: PictureWriter { arguments: options, source, prepared: &prepared, display: &display, stops },
        build_seconds: preparing.seconds(),
        radiosity,
        saved,
        comes_bit_by_bit: matches!(renderer, AnyRenderer::BySamples(_)),
    };
    drop(preparing);
    let classes = options.layers && state.is_none();
    let ended = all.render(&mut |view, film, checkpoints| {
        rendering::render(&renderer, (view, &order), &watch, classes, film, checkpoints)
    });
    if ended.as_ref().map_or_else(|failure| failure.exit == Exit::Missed, |()| true) {
        intermediate.remove();
    }
    ended
}
