//! Detail on demand: what procedural models make, when a ray first comes to it and as finely as it is seen.
//!
//! How finely a model is made is a function of where it is placed and of the views alone, the same for rays from the eye, to
//! lights and between surfaces. What it makes then is a function of its seed and this level of detail. So pictures are the
//! same whatever is in the cache, and for any number of threads. A thing is made as a whole on one level, and has no cracks;
//! between two levels its surface moves by less than half a pixel.

mod cache;
mod outline;
mod made;

pub use cache::DetailCosts;
pub use made::MadeDetail;

use super::placed_models::{KeptDetails, PlacedModel};
use super::prepared::Contents;
use super::{DetailView, SceneError, Settings, View};
use crate::memory;
use crate::octree::{InstanceOctree, PlacedSurface, PrototypeMaker, RayInterval};
use cache::{DetailCache, MadeValue};
use outline::DetailOutline;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::sync::{Arc, OnceLock, mpsc};
use std::time::Instant;

/// Part of the memory that what is made takes at the most, if nothing else is asked for: one of so many.
const SHARE: u64 = 2;
/// Where the memory is not known, what is made takes so many bytes at the most.
const MOST_UNKNOWN: u64 = 1 << 30;
/// Stack of threads that make detail, bytes: scripts may nest calls and expressions.
const STACK: usize = 16 << 20;

/// What is made of the models of a scene for some views.
#[derive(Debug)]
pub struct Details {
    models: Vec<Arc<PlacedModel>>,
    views: Vec<DetailView>,
    cache: DetailCache<DetailKey, MadeDetail, DetailOutline>,
    failed: OnceLock<String>,
}

/// By what details of a scene differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct DetailKey {
    model: u32,
    seed: u32,
    level: i32,
}

impl Contents {
    /// What is made of its models for some views in the pictures that settings ask for; none without models. Those that
    /// were asked for last are given again for the same views.
    pub fn details(&self, views: &[View], settings: &Settings) -> Option<Arc<Details>> {
        if self.models.is_empty() {
            return None;
        }
        let views: Vec<DetailView> = views.iter().map(|view| DetailView::new(view, settings)).collect();
        let mut last = self.details.last();
        if let Some(details) = known(&last).filter(|details| details.views == views) {
            return Some(details);
        }
        let cache = DetailCache::new(self.details.most_bytes().unwrap_or_else(default_most));
        let details = Arc::new(Details { models: self.models.clone(), views, cache, failed: OnceLock::new() });
        *last = Some(details.clone());
        Some(details)
    }

    /// Says how many bytes details may take that are asked for from now on; a word before this one counts.
    pub fn limit_details(&self, most_bytes: u64) {
        self.details.limit(most_bytes);
    }

    /// What the details cost by now that were asked for last; none if none were.
    pub fn detail_costs(&self) -> Option<DetailCosts> {
        known(&self.details.last()).map(|details| details.cache.costs())
    }
}

fn known(last: &Option<KeptDetails>) -> Option<Arc<Details>> {
    last.clone()?.downcast::<Details>().ok()
}

impl Details {
    /// What a model makes for an instance; nothing if it cannot, which [`Details::check`] tells. None if there is no such
    /// model, or if a ray is known to pass by what it makes.
    ///
    /// - `along`: the ray for which it is asked, in coordinates of the model; none if it is wanted in any case.
    pub fn made(&self, model: u32, placed: &PlacedSurface, along: Option<RayInterval<'_>>) -> Option<Arc<MadeDetail>> {
        let of = self.models.get(model as usize)?;
        let bounds = of.model.bounds();
        let footprints = self.views.iter().map(|view| view.footprint(&placed.placement, &bounds));
        let level = of.model.level(footprints.fold(f64::INFINITY, f64::min));
        let key = DetailKey { model, seed: of.model.seed(placed.variation), level };
        let is_wanted = |outline: &DetailOutline| along.is_none_or(|along| outline.is_met(&along));
        self.cache.get(key, is_wanted, || {
            let begin = Instant::now();
            let made = make(of, key).unwrap_or_else(|error| {
                _ = self.failed.set(error.to_string());
                MadeDetail::nothing()
            });
            let (bytes, outline) = (made.bytes(), made.outline());
            MadeValue { value: made, outline, bytes, seconds: begin.elapsed().as_secs_f64() }
        })
    }

    /// Whether something could not be made.
    pub fn has_failed(&self) -> bool {
        self.failed.get().is_some()
    }

    /// Says what could not be made.
    ///
    /// # Errors
    /// The first problem that was met, in words.
    pub fn check(&self) -> Result<(), String> {
        self.failed.get().map_or(Ok(()), |problem| Err(problem.clone()))
    }
}

impl PrototypeMaker for Details {
    fn give(
        &self,
        model: u32,
        placed: &PlacedSurface,
        along: Option<RayInterval<'_>>,
        to: &mut dyn FnMut(&InstanceOctree),
    ) {
        if let Some(made) = self.made(model, placed, along) {
            made.octree().into_iter().for_each(to);
        }
    }
}

/// Makes detail on a thread for this.
///
/// Whoever waits here renders, on a thread of a pool: if it waited for work of that pool, it would begin other work
/// meanwhile, which might come to the same detail and wait for itself.
fn make(of: &Arc<PlacedModel>, key: DetailKey) -> Result<MadeDetail, SceneError> {
    static MAKERS: OnceLock<Result<ThreadPool, ThreadPoolBuildError>> = OnceLock::new();
    let name = |number| format!("detail {number}");
    let makers = MAKERS.get_or_init(|| ThreadPoolBuilder::new().stack_size(STACK).thread_name(name).build());
    let failed = |problem: String| SceneError::Object { object: "procedural model".into(), problem };
    let makers = makers.as_ref().map_err(|error| failed(error.to_string()))?;
    let (give, take) = mpsc::sync_channel(1);
    let of = of.clone();
    makers.spawn(move || _ = give.send(MadeDetail::new(&of, key.seed, key.level)));
    take.recv().map_err(|_| failed("its detail is not made any more".into()))?
}

/// What details may take if nothing else is asked for, bytes.
fn default_most() -> u64 {
    memory::limit().or_else(memory::machine).map_or(MOST_UNKNOWN, |all| all / SHARE)
}
