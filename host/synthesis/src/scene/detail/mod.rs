//! Detail on demand: what procedural models make, when a ray first comes to it and as finely as it is seen.
//!
//! How finely a model is made is a function of where it is placed and of the views alone, the same for rays from the eye, to
//! lights and between surfaces. What it makes then is a function of its seed and this level of detail. So pictures are the
//! same whatever is in the cache, and for any number of threads. A thing is made as a whole on one level, and has no cracks;
//! between two levels its surface moves by less than half a pixel.
//!
//! From the same views, aggregates stand in for what is scattered in cells and far away, and the ground has cells that are
//! as wide as it is seen.

mod cache;
mod outline;
mod made;
mod ground;

pub use cache::DetailCosts;
pub use ground::{GroundHit, SceneGround};
pub use made::MadeDetail;

use super::placed_models::{KeptDetails, PlacedAggregates, PlacedModel};
use super::prepared::Contents;
use super::scatter::PlacedGrid;
use super::stretch::largest_stretch;
use super::{DetailView, SceneError, Settings, View};
use crate::memory;
use crate::octree::{AggregateView, InstanceOctree, PlacedSurface, PrototypeMaker, RayInterval};
use cache::{DetailCache, MadeValue};
use glam::DMat4;
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

/// What is made of the models of a scene for some views, its ground as it is seen from there, and from where aggregates
/// are seen.
#[derive(Debug)]
pub struct Details {
    models: Vec<Arc<PlacedModel>>,
    views: Vec<DetailView>,
    /// For each of the instances for which aggregates stand in, these views in coordinates of its cells.
    aggregates: Vec<Vec<AggregateView>>,
    grounds: Vec<SceneGround>,
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
    /// What is made of its models for some views in the pictures that settings ask for, and from where its aggregates
    /// are seen; none without models and aggregates. Those that were asked for last are given again for the same views.
    pub fn details(&self, views: &[View], settings: &Settings) -> Option<Arc<Details>> {
        if self.models.is_empty() && self.aggregates.is_empty() && self.terrains.is_empty() {
            return None;
        }
        let views: Vec<DetailView> = views.iter().map(|view| DetailView::new(view, settings)).collect();
        let mut last = self.details.last();
        if let Some(details) = known(&last).filter(|details| details.views == views) {
            return Some(details);
        }
        // Models together may take as much as each terrain.
        let sharing = self.terrains.len() as u64 + u64::from(!self.models.is_empty());
        let most_bytes = self.details.most_bytes().unwrap_or_else(default_most) / sharing.max(1);
        let failed = OnceLock::new();
        let ground =
            |placed| SceneGround::new(placed, &views, most_bytes).map_err(|error| failed.set(error.to_string()));
        let grounds = self.terrains.iter().filter_map(|placed| ground(placed).ok()).collect();
        let cache = DetailCache::new(most_bytes);
        let aggregates = self.aggregates.iter().map(|placed| placed.seen_by(&views)).collect();
        let models = self.models.clone();
        let details = Arc::new(Details { models, views, aggregates, grounds, cache, failed });
        *last = Some(details.clone());
        Some(details)
    }

    /// Says how many bytes details may take that are asked for from now on; a word before this one counts.
    pub fn limit_details(&self, most_bytes: u64) {
        self.details.limit(most_bytes);
    }

    /// What the details cost by now that were asked for last; none if none were, or without models and terrain.
    pub fn detail_costs(&self) -> Option<DetailCosts> {
        let has_any = !(self.models.is_empty() && self.terrains.is_empty());
        known(&self.details.last()).filter(|_| has_any).map(|details| details.costs())
    }

    /// From where on aggregates stand in for the instances of an object, for some views in the pictures that settings
    /// ask for: for each its eye and a distance from it, in coordinates of the scene, or how much they are enlarged;
    /// nothing if they do nowhere.
    pub fn aggregate_views(&self, object: usize, views: &[View], settings: &Settings) -> Vec<AggregateView> {
        let views: Vec<DetailView> = views.iter().map(|view| DetailView::new(view, settings)).collect();
        let own = self.aggregates.iter().filter(|placed| placed.object as usize == object);
        let in_scene = |placed: &PlacedAggregates| {
            let placement = placed.grid.placement;
            let longest = largest_stretch(&DMat4::from(placement));
            let to_scene = move |view: AggregateView| match view {
                AggregateView::Eye { at, distance } => {
                    AggregateView::Eye { at: placement.transform_point3(at), distance: distance * longest }
                }
                parallel => parallel,
            };
            placed.seen_by(&views).into_iter().map(to_scene)
        };
        own.flat_map(in_scene).collect()
    }
}

fn known(last: &Option<KeptDetails>) -> Option<Arc<Details>> {
    last.clone()?.downcast::<Details>().ok()
}

impl PlacedAggregates {
    /// The views from which they are seen, in coordinates of the cells.
    fn seen_by(&self, views: &[DetailView]) -> Vec<AggregateView> {
        let PlacedGrid { placement, size, .. } = self.grid;
        let views = views.iter().filter(|_| size > 0.0);
        views.map(|view| view.aggregates(&placement, size, self.pixels)).collect()
    }
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

    /// The terrains of the scene as they are seen.
    pub fn grounds(&self) -> &[SceneGround] {
        &self.grounds
    }

    /// What all of it costs by now.
    fn costs(&self) -> DetailCosts {
        self.grounds.iter().map(SceneGround::costs).fold(self.cache.costs(), |all, ground| DetailCosts {
            made: all.made + ground.made,
            kept: all.kept + ground.kept as usize,
            bytes: all.bytes + ground.bytes,
            most_bytes: all.most_bytes,
        })
    }

    /// Whether there are models, whose detail is made on demand.
    pub fn has_models(&self) -> bool {
        !self.models.is_empty()
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

    fn aggregate_views(&self, number: u32) -> &[AggregateView] {
        self.aggregates.get(number as usize).map_or(&[], Vec::as_slice)
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
