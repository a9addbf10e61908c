//! Accumulation of samples on a film: passes over all pixels, each of which adds samples, that can be stopped and taken
//! up again anywhere.

use super::pixel::PixelSampler;
use super::tracer::PathScratch;
use super::{PathLog, RayTracer};
use crate::memory;
use crate::picture::PictureError;
use crate::render::film::{AdaptiveSampling, Film, FilmBlock};
use crate::render::state::after;
use crate::render::tally::SHARING;
use crate::render::two_way::{FluxBalance, PhotonEstimator};
use crate::render::{
    FinishedCounts, RayCounts, RenderError, RenderOrder, Rendering, SpanCounts, StateError, Watch, denoising,
};
use crate::scene::View;
use crate::stages::{StageSpan, Workers, part, stage};
use rayon::prelude::*;
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
        checkpoints: Option<Checkpoints<'_>>,
    ) -> Result<Accumulated, RenderError> {
        let stage = match (order.seconds, order.target) {
            (Some(seconds), _) => stage!("rendering", seconds, "seconds"),
            // How many samples it takes is not known.
            (None, Some(_)) => stage!("rendering", film.tallies().len() as f64, "pixels"),
            (None, None) => stage!("rendering", f64::from(order.samples), "samples"),
        };
        let eye = self.eye(view, order)?;
        let workers = Workers::new(order.threads)?;
        let adaptive = film.adaptive(order.target);
        let has_features = !film.features().is_empty();
        let due = checkpoints.as_ref().map(|checkpoints| Instant::now() + checkpoints.every);
        let mut work = Accumulation { film, order, watch, workers, stage, checkpoints, due, adaptive };
        let most = if self.photon_mapper.is_some() { SHARING } else { u32::MAX };
        let passes = self.passes(order);
        let (mut rays, mut flux_balance, mut is_finished) = (RayCounts::default(), None, true);
        let mut before = 0;
        for &samples in &passes {
            let interval = [std::mem::replace(&mut before, samples), samples];
            if work.adaptive.as_ref().is_some_and(|adaptive| samples <= adaptive.finished) {
                continue;
            }
            let _pass = part!(work.stage, "pass", samples);
            let is_needed = work.begin_pass(samples, most) > 0;
            let photons = match &self.photon_mapper {
                Some(mapper) if is_needed => {
                    let pass = (samples - 1) / SHARING;
                    let photons = work.workers.install(|| mapper.trace_pass(&self.world, pass, watch));
                    if photons.is_none() {
                        is_finished = false;
                        break;
                    }
                    photons
                }
                _ => None,
            };
            flux_balance = flux_balance.or(photons.as_ref().map(PhotonEstimator::balance));
            let sampler = self.pixel_sampler(photons.as_ref(), &eye, order, has_features);
            let (counts, is_whole) = work.add_pass(&sampler, interval);
            rays = rays + counts;
            if !is_whole {
                is_finished = false;
                break;
            }
            if let Some(adaptive) = &mut work.adaptive {
                adaptive.end_pass(samples);
            }
            if work.is_stopped() {
                is_finished = Some(&samples) == passes.last();
                break;
            }
        }
        self.world.check_details()?;
        let Accumulation { film, workers, stage, adaptive, .. } = work;
        film.set_adaptive(adaptive);
        Ok(Accumulated {
            rays,
            flux_balance,
            // Time that ran out as it was asked for is no interruption.
            complete: is_finished || (order.seconds.is_some() && !watch.is_cancelled()),
            seconds: stage.seconds(),
            threads: workers.count(),
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
        let Accumulated { rays, flux_balance, mut complete, mut seconds, threads } =
            self.accumulate(&mut film, view, order, watch, checkpoints)?;
        let picture = match order.denoise && complete {
            true => {
                let stage = stage!("denoising");
                let workers = Workers::new(order.threads)?;
                let denoised = workers.install(|| denoising::denoised(&film, &|| watch.is_cancelled()))?;
                complete = denoised.is_some();
                seconds += stage.seconds();
                denoised.map_or_else(|| film.picture(), Ok)?
            }
            false => film.picture()?,
        };
        let spans = SpanCounts::default();
        let finished = FinishedCounts::default();
        Ok(Rendering { picture, film, complete, rays, spans, finished, flux_balance, seconds, threads })
    }

    /// How many samples pixels have after each pass: one first, so that there is a whole picture soon, and then twice
    /// as many each time, so that errors and the clock can decide about more; and where photons are traced anew.
    ///
    /// Detail on demand may have to be made again in each pass. So it is left at one if neither decides.
    fn passes(&self, order: &RenderOrder) -> Vec<u32> {
        let mut passes = vec![order.samples];
        if !self.world.makes_detail() || order.seconds.is_some() || order.target.is_some() {
            let doubled = std::iter::successors(Some(FIRST_DOUBLED), |samples| samples.checked_mul(2));
            passes.extend(std::iter::once(1).chain(doubled).take_while(|samples| *samples < order.samples));
        }
        if self.photon_mapper.is_some() {
            passes.extend((SHARING..order.samples).step_by(SHARING as usize));
        }
        passes.sort_unstable();
        passes.dedup();
        passes
    }
}

/// Samples that are being added to a film.
struct Accumulation<'a, 'b> {
    film: &'a mut Film,
    order: &'a RenderOrder,
    watch: &'a Watch<'a>,
    workers: Workers,
    stage: StageSpan,
    checkpoints: Option<Checkpoints<'b>>,
    /// When the next checkpoint is due.
    due: Option<Instant>,
    adaptive: Option<AdaptiveSampling>,
}

impl Accumulation<'_, '_> {
    /// Whether the time is over that the order gives.
    fn is_late(&self) -> bool {
        self.order.seconds.is_some_and(|seconds| self.stage.seconds() >= seconds)
    }

    fn is_stopped(&self) -> bool {
        self.watch.is_cancelled() || self.is_late()
    }

    /// Begins a pass; how many pixels want samples.
    ///
    /// - `samples`: of a pixel after the pass. `most`: of them in this pass.
    fn begin_pass(&mut self, samples: u32, most: u32) -> usize {
        if let Some(adaptive) = &mut self.adaptive {
            adaptive.begin_pass(self.film, samples, most);
        }
        let goal = PassGoal::new(samples, self.order, self.adaptive.as_ref());
        let tallies = self.film.tallies();
        let wanting = tallies.iter().enumerate().filter(|(pixel, tally)| tally.count < goal.of(*pixel)).count();
        if self.adaptive.is_some() && self.order.seconds.is_none() {
            self.stage.progress((tallies.len() - wanting) as f64);
        }
        wanting
    }

    /// Adds the samples of a pass; how many rays that took, and whether it was not stopped before its end.
    ///
    /// - `samples`: of a pixel before and after it.
    fn add_pass(&mut self, sampler: &PixelSampler<'_>, samples: [u32; 2]) -> (RayCounts, bool) {
        let mut rays = RayCounts::default();
        loop {
            let (counts, is_whole) = self.add_until_pause(sampler, samples);
            rays = rays + counts;
            if is_whole || self.is_stopped() || sampler.world.lacks_detail() {
                return (rays, is_whole);
            }
            self.keep();
        }
    }

    /// Adds samples of a pass until it ends, is stopped, or a checkpoint is due; how many rays that took, and whether
    /// the pass has ended.
    fn add_until_pause(&mut self, sampler: &PixelSampler<'_>, [before, samples]: [u32; 2]) -> (RayCounts, bool) {
        let Accumulation { film, order, watch, workers, stage, due, adaptive, .. } = self;
        let goal = PassGoal::new(samples, order, adaptive.as_ref());
        let is_late = || order.seconds.is_some_and(|seconds| stage.seconds() >= seconds);
        let lacks_detail = || sampler.world.lacks_detail();
        let pauses =
            || watch.is_cancelled() || lacks_detail() || due.is_some_and(|due| Instant::now() >= due) || is_late();
        let (stage, blocks) = (&*stage, film.blocks_mut());
        let (count, done) = (blocks.len() as f64, AtomicU64::new(0));
        let block = |(number, block): (usize, FilmBlock<'_>)| {
            let _block = part!(stage, "block", number);
            let mut scratch = PathScratch::default();
            let FilmBlock { first, mut rows } = block;
            for (y, row) in (first[1]..).zip(&mut rows) {
                for (column, x) in (first[0]..).take(row.tallies.len()).enumerate() {
                    let goal = goal.of(y as usize * order.width as usize + x as usize);
                    while row.tallies[column].count < goal {
                        if pauses() {
                            return (scratch.counts, false);
                        }
                        let index = row.tallies[column].count;
                        let (sample, classes, _) = sampler.sample([x, y], index, &mut scratch, PathLog::SILENT);
                        row.add(column, &sample, &classes);
                    }
                }
            }
            let part = (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / count;
            match (order.seconds, order.target) {
                (Some(seconds), _) => stage.progress(stage.seconds().min(seconds)),
                (None, Some(_)) => {}
                (None, None) => stage.progress(f64::from(before) + part * f64::from(samples - before)),
            }
            (scratch.counts, true)
        };
        // Taken one by one in their order, so that threads work near each other, too.
        let sum = |(rays, are_whole), (more, is_whole)| (rays + more, are_whole && is_whole);
        let none = || (RayCounts::default(), true);
        workers.install(|| blocks.into_iter().enumerate().par_bridge().map(block).reduce(none, sum))
    }

    /// Keeps the film, if it is to be kept from time to time.
    fn keep(&mut self) {
        let Some(checkpoints) = &mut self.checkpoints else { return };
        self.film.set_adaptive(self.adaptive.clone());
        let begin = Instant::now();
        if let Err(error) = (checkpoints.keep)(self.film) {
            tracing::warn!("{error}");
        }
        self.due = Some(after(checkpoints.every, begin));
    }
}

/// How many samples pixels are to have after a pass.
#[derive(Clone, Copy)]
struct PassGoal<'a> {
    /// Where pixels do not differ.
    samples: u32,
    /// Of each pixel, where these differ; and the most of them.
    adaptive: Option<(&'a [u32], u32)>,
}

impl<'a> PassGoal<'a> {
    fn new(samples: u32, order: &RenderOrder, adaptive: Option<&'a AdaptiveSampling>) -> PassGoal<'a> {
        PassGoal { samples, adaptive: adaptive.map(|adaptive| (adaptive.goals.as_slice(), order.samples)) }
    }

    fn of(&self, pixel: usize) -> u32 {
        self.adaptive.map_or(self.samples, |(goals, most)| goals[pixel].min(most))
    }
}
