//! Images of a view: at once, or in a thread of their own that tells of itself while samples are added.

use super::error::ProductionError;
use super::rendered_view::RenderedView;
use crate::{
    picture::{Picture, display::DisplayTransform},
    plan::Plan,
    render::{
        Film, RenderError, RenderOrder, Task, Watch, metering::Meter, ray_tracer_watched, ray_tracing::Checkpoints,
    },
    scene::{Prepared, View},
    stages::stage,
};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// How often a part of an image is told of; less often where making it takes long.
const EVERY: Duration = Duration::from_millis(150);

/// The name of the stage within which a view is rendered in a thread of its own.
pub const VIEW_STAGE: &str = "rendering the view";

/// What is told of a rendering, beside its stages, which are within one of the name [`VIEW_STAGE`].
#[derive(Debug)]
pub enum RenderingEvent {
    /// There is more of the image.
    Part {
        /// The image as a display shows it; pixels without samples are black.
        shown: Picture,
        /// For each row whether all of its pixels have samples.
        rows: Vec<bool>,
        /// Samples that pixels have, the mean.
        samples: f64,
        /// Seconds that the samples which are missing will take, about.
        seconds_left: f64,
    },
    /// It has ended.
    End(Result<Box<RenderedView>, ProductionError>),
}

/// A rendering in a thread of its own. It is stopped when this is dropped.
#[derive(Debug)]
pub struct Progressive {
    events: mpsc::Receiver<RenderingEvent>,
    is_cancelled: Arc<AtomicBool>,
}

impl Progressive {
    /// Begins to render.
    ///
    /// - `prepared`: makes the scene ready, in the thread of the rendering.
    pub(super) fn begin(
        prepared: impl FnOnce() -> Result<Arc<Prepared>, ProductionError> + Send + 'static,
        view: View,
        options: RenderOrder,
        display: DisplayTransform,
    ) -> Result<Progressive, ProductionError> {
        let (sender, news) = mpsc::channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let cancelled = is_cancelled.clone();
        let work = move || {
            // Nobody may be listening any more.
            let tell = |news| drop(sender.send(news));
            let _stage = stage!("rendering the view");
            let watch = Watch { cancelled: &cancelled, memo: None };
            let mut part = |part: RenderingEvent| tell(part);
            let rendered = prepared()
                .and_then(|prepared| render_view(&prepared, &view, &options, &display, &watch, Some(&mut part)));
            tell(RenderingEvent::End(rendered.map(Box::new)));
        };
        let thread = std::thread::Builder::new().name("rendering".into());
        thread.spawn(work).map_err(|error| ProductionError::Thread(error.to_string()))?;
        Ok(Progressive { events: news, is_cancelled })
    }

    /// What is new, oldest first; of parts that follow each other, the last one only.
    pub fn events(&self) -> Vec<RenderingEvent> {
        let mut all: Vec<RenderingEvent> = Vec::new();
        loop {
            match self.events.try_recv() {
                Ok(news) => {
                    let parts = (all.last(), &news);
                    if matches!(parts, (Some(RenderingEvent::Part { .. }), RenderingEvent::Part { .. })) {
                        all.pop();
                    }
                    all.push(news);
                }
                Err(mpsc::TryRecvError::Empty) => return all,
                Err(mpsc::TryRecvError::Disconnected) => {
                    if !matches!(all.last(), Some(RenderingEvent::End(_))) {
                        all.push(RenderingEvent::End(Err(ProductionError::Thread("its thread failed".into()))));
                    }
                    return all;
                }
            }
        }
    }

    /// Asks it to stop; it then ends with what there is.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }
}

impl Drop for Progressive {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// Ray-traces a view.
///
/// - `parts`: told of parts of the image while it grows, if anybody is.
pub(super) fn render_view(
    prepared: &Prepared,
    view: &View,
    options: &RenderOrder,
    display: &DisplayTransform,
    watch: &Watch<'_>,
    parts: Option<&mut dyn FnMut(RenderingEvent)>,
) -> Result<RenderedView, ProductionError> {
    let start = Instant::now();
    let plan = Plan::new(prepared, view);
    let (tracer, _) = ray_tracer_watched(&Task { watch: *watch, ..Task::new(prepared, &plan) })?;
    let build_seconds = start.elapsed().as_secs_f64();
    let triangles = prepared.triangles.len().max(1) as f64;
    let octree_bytes = tracer.world().octree().map(|octree| octree.bytes() as f64 / triangles);
    let meter = Meter::new(&prepared.settings, display, options.threads);
    let stops = meter.stops(&tracer, prepared, std::slice::from_ref(view), watch)?;
    let pixel_angle = view.pixel_angle(options.width, options.height);
    let shown = |picture: &Picture| display.shown(picture, stops, pixel_angle);
    let begin = Instant::now();
    let film = Film::new(options.width, options.height).map_err(RenderError::from)?;
    let rendering = match parts {
        Some(tell) => {
            let mut keep = |film: &Film| {
                match film.picture().and_then(|picture| shown(&picture)) {
                    Ok(shown) => tell(part(film, shown, options, begin)),
                    // The whole image may not fit into memory either, and then says so.
                    Err(error) => tracing::warn!("a part of the image is not shown: {error}"),
                }
                Ok(())
            };
            let checkpoints = Checkpoints { every: EVERY, keep: &mut keep };
            tracer.resume(film, view, options, watch, Some(checkpoints))?
        }
        None => tracer.resume(film, view, options, watch, None)?,
    };
    let shown = shown(&rendering.picture).map_err(RenderError::from)?;
    Ok(RenderedView { rendering, octree_bytes, build_seconds, shown, stops })
}

/// What there is of an image.
fn part(film: &Film, shown: Picture, options: &RenderOrder, begin: Instant) -> RenderingEvent {
    let rows = rows_of(film);
    let taken: u64 = film.tallies().iter().map(|tally| u64::from(tally.count)).sum();
    let all = film.tallies().len() as u64 * u64::from(options.samples);
    let seconds_left = begin.elapsed().as_secs_f64() * (all as f64 / taken.max(1) as f64 - 1.0).max(0.0);
    let samples = taken as f64 / film.tallies().len() as f64;
    RenderingEvent::Part { shown, rows, samples, seconds_left }
}

/// For each row whether all of its pixels have samples.
pub(super) fn rows_of(film: &Film) -> Vec<bool> {
    let rows = film.tallies().chunks(film.width() as usize);
    rows.map(|row| row.iter().all(|tally| tally.count > 0)).collect()
}
