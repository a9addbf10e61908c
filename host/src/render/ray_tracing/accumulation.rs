//! Accumulation of samples on a film: passes over all pixels, each of which adds samples, that can be stopped and taken
//! up again anywhere.

use super::tracer::PathScratch;
use super::{PathLog, RayTracer};
use crate::memory;
use crate::picture::PictureError;
use crate::render::film::{Film, FilmRow};
use crate::render::state::after;
use crate::render::tally::SHARING;
use crate::render::two_way::{FluxBalance, PhotonEstimator};
use crate::render::{
    Progress, RayCounts, RenderError, RenderOrder, Rendering, SpanCounts, StateError, Watch, denoising,
};
use crate::scene::View;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Samples after the second pass, which are enough to tell the error of a pixel.
const FIRST_DOUBLED: u32 = 8;
/// Keeps a film from time to time while samples are added.
pub struct Checkpoints<'a> {
    /// Time from one to the next.
    pub every: Duration,
    /// Keeps the film as it is. What goes wrong is told of, and the work goes on.
    pub keep: &'a mut dyn FnMut(&Film) -> Result<(), StateError>,
}

/// The threads that an order asks for.
fn pool(order: &RenderOrder) -> Result<ThreadPool, RenderError> {
    Ok(ThreadPoolBuilder::new().num_threads(order.threads.map_or(0, |n| n.get())).build()?)
}

/// The work of accumulating samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulated {
    /// How many rays were traced.
    pub rays: RayCounts,
    /// The balance of the flux of the photons that were traced first, if any were.
    pub flux_balance: Option<FluxBalance>,
    /// Whether it was not stopped from outside.
    pub complete: bool,
    /// Wall-clock time, seconds.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

impl RayTracer<'_> {
    /// Adds samples to a film until each pixel has what the order asks for.
    ///
    /// The film may hold samples of the same order already, as after an interruption, also one in the middle of a pass:
    /// the same samples are then added as if there had been none.
    ///
    /// - `checkpoints`: keeps the film while samples are added.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn accumulate(
        &self,
        film: &mut Film,
        view: &View,
        order: &RenderOrder,
        watch: &Watch<'_>,
        mut checkpoints: Option<Checkpoints<'_>>,
    ) -> Result<Accumulated, RenderError> {
        let start = Instant::now();
        let eye = self.eye(view, order)?;
        let pool = pool(order)?;
        let is_late = || order.seconds.is_some_and(|seconds| start.elapsed().as_secs_f64() >= seconds);
        let mut due = checkpoints.as_ref().map(|checkpoints| start + checkpoints.every);
        let mut adaptive = film.adaptive(order.target);
        let passes = self.passes(order);
        let mut rays = RayCounts::default();
        let mut balance = None;
        let mut is_finished = true;
        'passes: for (number, samples) in passes.iter().enumerate() {
            if adaptive.as_ref().is_some_and(|adaptive| *samples <= adaptive.finished) {
                continue;
            }
            if let Some(adaptive) = &mut adaptive {
                adaptive.begin_pass(film, *samples, if self.photon_mapper.is_some() { SHARING } else { u32::MAX });
            }
            let before = number.checked_sub(1).map_or(0, |last| passes[last]);
            let goal = |pixel: usize| match &adaptive {
                Some(adaptive) => adaptive.goals[pixel].min(order.samples),
                None => *samples,
            };
            let wanting = film.tallies().iter().enumerate().filter(|(pixel, tally)| tally.count < goal(*pixel)).count();
            let is_needed = wanting > 0;
            if adaptive.is_some() {
                let all = film.tallies().len() as u64;
                (watch.progress)(Progress::of(all - wanting as u64, all, "pixels"));
            }
            let photons = match &self.photon_mapper {
                Some(two_way) if is_needed => {
                    (watch.stage)("while tracing photons");
                    let pass = (samples - 1) / SHARING;
                    let photons = pool.install(|| two_way.trace_pass(&self.world, pass, watch));
                    if photons.is_none() {
                        is_finished = false;
                        break;
                    }
                    (watch.stage)("while rendering");
                    photons
                }
                _ => None,
            };
            balance = balance.or(photons.as_ref().map(PhotonEstimator::balance));
            let tracer = self.tracer(photons.as_ref(), &eye, !film.features().is_empty());
            loop {
                let rows = f64::from(order.height);
                let rows_done = AtomicU64::new(0);
                let is_due = || due.is_some_and(|due| Instant::now() >= due);
                let pauses = || watch.is_cancelled() || is_due() || is_late();
                let row = |(y, mut row): (usize, FilmRow<'_>)| {
                    let mut scratch = PathScratch::default();
                    for x in 0..row.tallies.len() {
                        let goal = goal(y * order.width as usize + x);
                        while row.tallies[x].count < goal {
                            if pauses() {
                                return (scratch.counts, false);
                            }
                            let (pixel, index) = ([x as u32, y as u32], row.tallies[x].count);
                            let (sample, classes, _) =
                                self.sample((&tracer, &eye, order), pixel, index, &mut scratch, PathLog::SILENT);
                            row.add(x, &sample, &classes);
                        }
                    }
                    let part = (rows_done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / rows;
                    let done = f64::from(before) + part * f64::from(samples - before);
                    match (order.seconds, order.target) {
                        (Some(seconds), _) => {
                            let done = start.elapsed().as_secs_f64().min(seconds);
                            (watch.progress)(Progress { done, all: seconds, unit: "seconds" });
                        }
                        // How many it takes is not known.
                        (None, Some(_)) => {}
                        (None, None) => {
                            (watch.progress)(Progress { done, all: f64::from(order.samples), unit: "samples" });
                        }
                    }
                    (scratch.counts, true)
                };
                let rows: Vec<(RayCounts, bool)> =
                    pool.install(|| film.rows_mut().into_par_iter().enumerate().map(row).collect());
                rays = rows.iter().fold(rays, |sum, (counts, _)| sum + *counts);
                if rows.iter().all(|(_, is_whole)| *is_whole) {
                    break;
                }
                if watch.is_cancelled() || is_late() {
                    is_finished = false;
                    break 'passes;
                }
                due = checkpoints.as_mut().map(|checkpoints| {
                    film.set_adaptive(adaptive.clone());
                    let begin = Instant::now();
                    if let Err(error) = (checkpoints.keep)(film) {
                        tracing::warn!("{error}");
                    }
                    after(checkpoints.every, begin)
                });
            }
            if let Some(adaptive) = &mut adaptive {
                adaptive.end_pass(*samples);
            }
            if watch.is_cancelled() || is_late() {
                is_finished = number + 1 == passes.len();
                break;
            }
        }
        film.set_adaptive(adaptive);
        Ok(Accumulated {
            rays,
            flux_balance: balance,
            // Time that ran out as it was asked for is no interruption.
            complete: is_finished || (order.seconds.is_some() && !watch.is_cancelled()),
            seconds: start.elapsed().as_secs_f64(),
            threads: pool.current_num_threads(),
        })
    }

    /// Makes a picture of a film to which samples are added, as [`RayTracer::accumulate`] does it.
    ///
    /// If it is to be denoised, a film that holds samples has to hold features, too; without these it stays as it is.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn resume(
        &self,
        mut film: Film,
        view: &View,
        order: &RenderOrder,
        watch: &Watch<'_>,
        checkpoints: Option<Checkpoints<'_>>,
    ) -> Result<Rendering, RenderError> {
        if order.denoise {
            let pixels = u64::from(order.width) * u64::from(order.height);
            memory::reserve(denoising::BYTES * pixels, || "denoising".into()).map_err(PictureError::from)?;
            if film.features().is_empty() && film.samples() == [0, 0] {
                film = film.with_features();
            }
        }
        (watch.stage)("while rendering");
        let Accumulated { rays, flux_balance: balance, mut complete, mut seconds, threads } =
            self.accumulate(&mut film, view, order, watch, checkpoints)?;
        let spans = SpanCounts::default();
        let picture = match order.denoise && complete {
            true => {
                let start = Instant::now();
                (watch.stage)("while denoising");
                let pool = pool(order)?;
                let denoised = pool.install(|| denoising::denoised(&film, &|| watch.is_cancelled()))?;
                complete = denoised.is_some();
                seconds += start.elapsed().as_secs_f64();
                denoised.map_or_else(|| film.picture(), Ok)?
            }
            false => film.picture()?,
        };
        Ok(Rendering { picture, film, complete, rays, spans, flux_balance: balance, seconds, threads })
    }

    /// How many samples pixels have after each pass: one first, so that there is a whole picture soon, and then twice
    /// as many each time, so that errors and the clock can decide about more; and where photons are traced anew.
    fn passes(&self, order: &RenderOrder) -> Vec<u32> {
        let doubled = std::iter::successors(Some(FIRST_DOUBLED), |samples| samples.checked_mul(2));
        let mut passes = vec![1, order.samples];
        passes.extend(doubled.take_while(|samples| *samples < order.samples));
        if self.photon_mapper.is_some() {
            passes.extend((SHARING..order.samples).step_by(SHARING as usize));
        }
        passes.sort_unstable();
        passes.dedup();
        passes
    }
}
