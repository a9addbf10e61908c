//! Two-way ray tracing, phase one: photons are traced from lamps through mirrors and glass, and stored where they
//! arrive (photon mapping, Jensen 1996).
//!
//! It does not depend on the view. Phase two, the paths from the camera, adds the radiance estimate of the photons
//! around each surface interaction.
//!
//! **Which light paths are found by which phase.** Each scattering event at a surface is by a *narrow* lobe, a mirror,
//! an interface or a highlight (LPE classes S and G), or by a *broad* one, such as Lambert's (D). How light came to its
//! last broad scattering decides:
//!
//! - without any scattering since the lamp it is direct: light samples bring it;
//! - by narrow scattering it is a photon stored there, whatever was before: photons are scattered broadly, too;
//! - by other broad scattering it is found by the paths from the camera, which continue to where that was and estimate
//!   there again;
//! - light that comes to the camera by narrow scattering alone is found by the paths from the camera.
//!
//! A path from the camera that continues from broad scattering by a narrow lobe is a light path of the second kind, and
//! ends there. A sky without a picture is left to the paths from the camera: it is as bright everywhere, and they find
//! it. For it, and for ambient light, these paths do not end.

mod projection_map;
mod photon_tracing;
mod photon_map;
mod allocation;
mod photon_source;
mod photon_store;
mod smooth_surfaces;
mod occluders;

pub use photon_store::PhotonStore;
pub use photon_tracing::FluxBalance;

use crate::color::{Channels, LANES};
use crate::illumination::light::EmissionSample;
use crate::illumination::optics::ShadingContext;
use crate::memory;
use crate::numeric::ray::Ray;
use crate::numeric::sequence::SobolSequence;
use crate::octree::TriangleBvh;
use crate::render::Watch;
use crate::render::state::after;
use crate::render::world::{SurfaceInteraction, World, mean_diffuse_albedo};
use crate::scene::Prepared;
use crate::stages::stage;
use glam::DVec3;
use photon_map::{GatherContext, GatherDetail, GatherPoint, PhotonMap};
use photon_source::{PhotonSource, PhotonTarget};
use photon_tracing::{EmittedPhoton, LEAST_BOUNCES, Photon, PhotonDimension, PhotonSampler, PhotonTracer};
use projection_map::{BoundingSphere, DirectionPdf};
use rayon::prelude::*;
use smooth_surfaces::SmoothSurfaces;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Photon paths that one thread traces before it takes others.
const CHUNK: u32 = 1024;
/// The largest disc of a radiance estimate, as a part of the diagonal of the scene.
const REACH: f64 = 0.05;

/// How far above a surface lines along it lie, as a part of the size of the scene.
const LIFT: f64 = 1e-9;
/// Work on a pass that is kept when it is interrupted.
const WORTH_KEEPING: Duration = Duration::from_secs(5);
/// Memory that photon maps take while they are kept for further views, bytes at the most.
const MOST_BYTES: u64 = 1 << 30;

/// Traces passes of photons from lamps.
pub(in crate::render) struct PhotonMapper<'a> {
    surfaces: SmoothSurfaces,
    /// Triangles that occlude light.
    opaque: TriangleBvh,
    /// Bounding spheres around what mirrors or refracts, and then other targets of lamps.
    spheres: Vec<BoundingSphere>,
    bodies: usize,
    lamps: Vec<PhotonSource>,
    most_bounces: u32,
    reach: f64,
    seed: u64,
    /// The photon maps, pass by pass, as far as they are kept.
    passes: Mutex<Vec<Arc<PhotonPass>>>,
    store: Option<&'a PhotonStore>,
}

/// Photon paths that are traced together: so many from a lamp to one bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct PathBatch {
    lamp: usize,
    target: usize,
    number: u32,
}

/// Result of such paths, as if each of them were all of the lamp.
#[derive(Clone, Debug)]
struct BatchResult {
    photons: Vec<Photon>,
    balance: FluxBalance,
}

impl BatchResult {
    fn scaled(mut self, factor: f64) -> BatchResult {
        self.photons.iter_mut().for_each(|photon| photon.flux *= factor);
        BatchResult { balance: self.balance.scaled(factor), ..self }
    }
}

/// The photon map of a pass.
struct PhotonPass {
    pass: u32,
    map: PhotonMap,
    balance: FluxBalance,
}

/// A photon map, with what radiance estimates need.
pub(in crate::render) struct PhotonEstimator<'a> {
    world: &'a World<'a>,
    mapper: &'a PhotonMapper<'a>,
    pass: Arc<PhotonPass>,
    shrink: f64,
}

impl<'s> PhotonMapper<'s> {
    /// Looks where light of lamps goes; none if nothing of it goes through mirrors or glass to where photons are
    /// stored.
    ///
    /// - `photon_store`: where photon maps are kept beyond this, if anywhere.
    pub(in crate::render) fn new(
        world: &World<'_>,
        keeps: impl Fn(usize) -> bool,
        photon_store: Option<&'s PhotonStore>,
    ) -> Option<PhotonMapper<'s>> {
        let appearance = &world.appearance;
        let prepared = appearance.prepared;
        let settings = &prepared.settings;
        let of = |triangle: u32| {
            let object = prepared.object_of[triangle as usize];
            (keeps(object as usize), appearance.bsdf(object, prepared.material_number(triangle)))
        };
        let casts_caustics = |triangle: u32| matches!(of(triangle), (true, optics) if optics.casts_caustics());
        let spheres = projection_map::bounding_spheres(prepared, casts_caustics);
        let lamps: Vec<usize> =
            (0..appearance.sources.len()).filter(|i| appearance.sources[*i].1.emits_photons()).collect();
        if spheres.is_empty() || lamps.is_empty() {
            return None;
        }
        let stores_photons = |object: usize| {
            let materials = 0..prepared.objects[object].materials.len() as u32;
            keeps(object) && materials.into_iter().any(|m| appearance.bsdf(object as u32, m).stores_photons())
        };
        let opaque = |triangle: u32| of(triangle).0 && world.is_opaque(triangle);
        let mut two_way = PhotonMapper {
            surfaces: SmoothSurfaces::new(prepared, stores_photons),
            opaque: TriangleBvh::new(&prepared.vertices, &prepared.triangles).only(opaque),
            lamps: Vec::new(),
            most_bounces: settings.light.reflection_depth.max(LEAST_BOUNCES),
            reach: settings.photons.radius.unwrap_or_else(|| greatest_gather_radius(prepared)),
            seed: settings.image.seed,
            passes: Mutex::new(Vec::new()),
            store: photon_store,
            bodies: spheres.len(),
            spheres,
        };
        let scatters_broad = |triangle: u32| matches!(of(triangle), (true, optics) if optics.is_broad());
        two_way.allocate_paths(world, &lamps, projection_map::bounding_sphere(prepared, scatters_broad));
        if let Some(photon_store) = photon_store {
            let (photons, lamps) = (settings.photons.count, lamps.len());
            for lamp in &mut two_way.lamps {
                let pilot = PhotonMapper::pilot_paths(photons, lamps, lamp.targets.len());
                lamp.name = Some(photon_store.name(world, lamp, &keeps, pilot));
            }
        }
        (!two_way.lamps.is_empty()).then_some(two_way)
    }

    /// Traces all paths of a pass; none if it was cancelled. What was traced until then is in the photon store, if
    /// there is one.
    ///
    /// - `pass`: counts from 0. The higher it is, the smaller are the discs of radiance estimates (progressive photon
    ///   mapping, Knaus and Zwicker 2011).
    pub(in crate::render) fn trace_pass<'a>(
        &'a self,
        world: &'a World<'a>,
        pass: u32,
        watch: &Watch<'_>,
    ) -> Option<PhotonEstimator<'a>> {
        let shown = |photon_pass: Arc<PhotonPass>| {
            let shrink = f64::from(pass + 1).powf(-1.0 / 3.0);
            PhotonEstimator { world, mapper: self, pass: photon_pass, shrink }
        };
        let kept = || self.passes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(photon_pass) = kept().iter().find(|photon_pass| photon_pass.pass == pass) {
            return Some(shown(photon_pass.clone()));
        }
        let photon_pass = Arc::new(self.photon_pass(world, pass, watch)?);
        let mut kept = kept();
        let bytes: usize = kept.iter().map(|photon_pass| photon_pass.map.bytes()).sum();
        // Half of what is left is for the work that continues.
        let most = MOST_BYTES.min(bytes as u64 + memory::left() / 2);
        if (bytes + photon_pass.map.bytes()) as u64 <= most {
            kept.push(photon_pass.clone());
        }
        Some(shown(photon_pass))
    }

    fn photon_pass(&self, world: &World<'_>, pass: u32, watch: &Watch<'_>) -> Option<PhotonPass> {
        let lanes = world.appearance.wavelengths.lanes();
        let before = self.stored_blocks(pass, lanes);
        let mut wanted: Vec<PathBatch> = Vec::new();
        for (lamp, PhotonSource { targets, .. }) in self.lamps.iter().enumerate() {
            for (target, PhotonTarget { count, .. }) in targets.iter().enumerate() {
                wanted.extend((0..count.div_ceil(CHUNK)).map(|number| PathBatch { lamp, target, number }));
            }
        }
        let paths = |chunk: &PathBatch| {
            let count = self.lamps[chunk.lamp].targets[chunk.target].count;
            chunk.number * CHUNK..((chunk.number + 1) * CHUNK).min(count)
        };
        let is_whole = |chunk: &PathBatch| paths(chunk).len() == CHUNK as usize;
        let known = |chunk: &PathBatch| before.get(chunk).filter(|_| is_whole(chunk)).cloned();
        let mut blocks: Vec<Option<BatchResult>> = wanted.iter().map(known).collect();
        let stage = stage!("tracing photons", wanted.len() as f64, "parts");
        let mut kept = Instant::now();
        let mut due = self.store.map(|photon_store| kept + photon_store.every);
        loop {
            let pauses = || watch.is_cancelled() || due.is_some_and(|due| Instant::now() >= due);
            let done = AtomicU64::new(blocks.iter().flatten().count() as u64);
            blocks.par_iter_mut().zip(&wanted).filter(|(block, _)| block.is_none()).for_each(|(block, chunk)| {
                if !pauses() {
                    *block = Some(self.trace_batch(world, u64::from(pass), chunk, paths(chunk)));
                    stage.progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64);
                }
            });
            let is_finished = blocks.iter().all(Option::is_some);
            let lasts = is_finished && self.store.is_some_and(|photon_store| photon_store.keeps_finished);
            // Who is interrupted does not wait for little to be kept.
            let worth = self.store.map_or(WORTH_KEEPING, |photon_store| photon_store.every.min(WORTH_KEEPING));
            if lasts || (!is_finished && kept.elapsed() >= worth) {
                let begin = Instant::now();
                let whole = wanted.iter().zip(&blocks).filter(|(chunk, _)| is_whole(chunk));
                let whole = whole.filter_map(|(chunk, block)| Some((*chunk, block.as_ref()?)));
                self.store_blocks(world, pass, whole.collect(), &before);
                kept = Instant::now();
                due = self.store.map(|photon_store| after(photon_store.every, begin));
            }
            if is_finished {
                break;
            }
            if watch.is_cancelled() {
                return None;
            }
        }
        let blocks = blocks.into_iter().flatten();
        let scaled = |(chunk, block): (&PathBatch, BatchResult)| {
            let PhotonTarget { count, part, .. } = self.lamps[chunk.lamp].targets[chunk.target];
            block.scaled(part / f64::from(count))
        };
        let blocks: Vec<BatchResult> = wanted.iter().zip(blocks).map(scaled).collect();
        let balance = blocks.iter().fold(FluxBalance::default(), |sum, block| sum + block.balance);
        let photons: Vec<Photon> = blocks.into_iter().flat_map(|block| block.photons).collect();
        Some(PhotonPass { pass, map: PhotonMap::new(&photons, lanes), balance })
    }

    /// The batches of a pass that other runs traced.
    fn stored_blocks(&self, pass: u32, lanes: usize) -> HashMap<PathBatch, BatchResult> {
        let Some(photon_store) = self.store else { return HashMap::new() };
        let named =
            self.lamps.iter().enumerate().filter_map(|(lamp, PhotonSource { name, .. })| Some((lamp, name.as_ref()?)));
        named.flat_map(|(lamp, name)| photon_store.load(&format!("{name}-{pass}"), lamp, lanes)).collect()
    }

    /// Stores batches of a pass for other runs, with what was stored before, for each lamp of which something is new.
    fn store_blocks(
        &self,
        world: &World<'_>,
        pass: u32,
        now: HashMap<PathBatch, &BatchResult>,
        before: &HashMap<PathBatch, BatchResult>,
    ) {
        let Some(photon_store) = self.store else { return };
        for (number, lamp) in self.lamps.iter().enumerate() {
            let Some(name) = &lamp.name else { continue };
            if now.keys().any(|chunk| chunk.lamp == number && !before.contains_key(chunk)) {
                let mut all: HashMap<PathBatch, &BatchResult> =
                    before.iter().map(|(chunk, block)| (*chunk, block)).collect();
                all.extend(&now);
                all.retain(|chunk, _| chunk.lamp == number);
                let what = format!("light {}, pass {pass}", world.appearance.sources[lamp.source].0 + 1);
                photon_store.save(&format!("{name}-{pass}"), what, world.appearance.wavelengths.lanes(), &all);
            }
        }
    }

    /// Traces some paths from a lamp.
    fn trace_batch(&self, world: &World<'_>, pass: u64, chunk: &PathBatch, paths: Range<u32>) -> BatchResult {
        let lamp = &self.lamps[chunk.lamp];
        let mut flight = PhotonTracer {
            world,
            surfaces: &self.surfaces,
            spheres: &self.spheres[..self.bodies],
            most_bounces: self.most_bounces,
            typical_flux: lamp.stored_flux,
            waiting: Vec::new(),
            photons: Vec::new(),
            balance: FluxBalance::default(),
        };
        let sequence = self.sequence(world, pass, chunk);
        for index in paths {
            let sampler = PhotonSampler::new(sequence, index);
            match self.emit(world, lamp, &lamp.targets[chunk.target], &sampler) {
                Some(start) if start.flux.max() > 0.0 && start.flux.is_finite() => flight.trace(&start, &sampler),
                _ => flight.balance.paths += 1,
            }
        }
        // As exactly as it is stored.
        let rounded = |flux: Channels| Channels(flux.0.map(|flux| f64::from(flux as f32)));
        let photons = flight.photons.into_iter().map(|photon| Photon { flux: rounded(photon.flux), ..photon });
        BatchResult { photons: photons.collect(), balance: flight.balance }
    }

    /// The random numbers of a pass for paths from a lamp.
    fn sequence(&self, world: &World<'_>, pass: u64, chunk: &PathBatch) -> SobolSequence {
        let light = world.appearance.sources[self.lamps[chunk.lamp].source].0;
        let number = (light as u64) << 32 | chunk.target as u64;
        SobolSequence::new(self.seed ^ pass.wrapping_mul(0x9e37_79b9_7f4a_7c15), number)
    }

    /// Samples a photon that leaves a lamp, as if it were all of the light.
    fn emit(
        &self,
        world: &World<'_>,
        lamp: &PhotonSource,
        target: &PhotonTarget,
        sampler: &PhotonSampler,
    ) -> Option<EmittedPhoton> {
        let appearance = &world.appearance;
        let source = &appearance.sources[lamp.source].1;
        let [wavelength_set, time] = sampler.point(PhotonDimension::Wavelengths, 0);
        let wavelength_set = appearance.wavelengths.set_at(wavelength_set);
        let time = if world.moves() { (time - 0.5) * appearance.prepared.settings.geometry.shutter } else { 0.0 };
        let place = target.map.sample(sampler.point(PhotonDimension::Aim, 0));
        let sphere = &self.spheres[target.sphere];
        // By whichever target a path might have been sampled.
        let all = |pdf: &dyn Fn(&BoundingSphere) -> Option<DirectionPdf>| -> f64 {
            let of = |other: &PhotonTarget| {
                let (pdf, place) = pdf(&self.spheres[other.sphere])?;
                Some(other.part * pdf * other.map.pdf(place))
            };
            lamp.targets.iter().filter_map(of).sum()
        };
        match source.sample_emission(sampler.point(PhotonDimension::Start, 0), wavelength_set)? {
            EmissionSample::Point { at, normal, area } => {
                let direction = sphere.direction(at, place);
                let pdf = all(&|ball| ball.pdf(at, direction));
                let flux = source.intensity(normal, direction, wavelength_set) * pdf.recip();
                // Clear of the lamp itself.
                let largest = at.abs().max_element() + area.sqrt();
                let clear = normal.map_or(DVec3::ZERO, |n| n * (1e-12 * largest * n.dot(direction).signum()));
                Some(EmittedPhoton { ray: Ray { origin: at + clear, direction }, flux, wavelength_set, time })
            }
            EmissionSample::Parallel { direction, irradiance } => {
                let on = sphere.line(direction, place);
                let pdf = all(&|ball| ball.line_pdf(direction, on));
                let bounds = &appearance.prepared.bounds;
                let far = 2.0 * bounds.diagonal() + on.distance(bounds.center());
                let ray = Ray { origin: on - direction * far, direction };
                Some(EmittedPhoton { ray, flux: irradiance * pdf.recip(), wavelength_set, time })
            }
        }
    }
}

/// The radius of the largest disc of a radiance estimate, unless the scene has one, scene units.
pub fn greatest_gather_radius(prepared: &Prepared) -> f64 {
    REACH * prepared.bounds.diagonal()
}

impl PhotonEstimator<'_> {
    /// The flux balance of the pass.
    pub(in crate::render) fn balance(&self) -> FluxBalance {
        self.pass.balance
    }

    /// Exitance of a side of a triangle by what it reflects diffusely of the photons around a point, W/m², in lanes
    /// that are means over all wavelength sets.
    pub(in crate::render) fn exitance(&self, triangle: u32, outside: bool, at: DVec3) -> Channels {
        let appearance = &self.world.appearance;
        let prepared = appearance.prepared;
        let bsdf = appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle));
        let corners = prepared.corners(triangle);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize();
        let Some(normal) = normal.filter(|_| bsdf.stores_photons()) else { return Channels::ZERO };
        let surface = self.mapper.surfaces.of(triangle);
        let lift = LIFT * (at.abs().max_element() + prepared.bounds.diagonal());
        let place = GatherPoint {
            position: at,
            outside: normal,
            leave: at + normal * if outside { lift } else { -lift },
            surface,
            side: photon_tracing::side_of(surface, outside),
        };
        let ([narrow, broad], _) = self.pass.map.irradiance(&place, &self.gather_context(GatherDetail::Smooth));
        let irradiance = narrow + broad;
        if irradiance == Channels::ZERO {
            return irradiance;
        }
        let weights = crate::numeric::triangle::weights(corners, at);
        let size = normal.any_orthonormal_pair();
        let place =
            bsdf.is_textured().then(|| prepared.texture_place(triangle, weights, [size.0 * lift, size.1 * lift]));
        mean_diffuse_albedo(bsdf, place.as_ref(), appearance.wavelengths.count()) * irradiance
    }

    fn gather_context(&self, detail: GatherDetail) -> GatherContext<'_> {
        GatherContext {
            world: self.world,
            surfaces: &self.mapper.surfaces,
            opaque: &self.mapper.opaque,
            reach: self.mapper.reach,
            detail,
            shrink: self.shrink,
        }
    }

    /// Radiance estimate towards the viewer of an element, by the photons around it.
    ///
    /// - `throughput`: of the path. `is_parted`: whether a single wavelength is left of it.
    /// - `coarse`: whether the element is one of many that light what is seen.
    /// - Returns radiance at the camera: in the lanes of the path, and at other wavelengths as linear sRGB; of photons
    ///   that were scattered narrowly only, and of photons that were scattered broadly, too. And the standard error of
    ///   all of it, over it.
    pub(in crate::render) fn radiance_estimate(
        &self,
        interaction: &SurfaceInteraction<'_>,
        context: &ShadingContext<'_>,
        throughput: Channels,
        is_parted: bool,
        coarse: bool,
    ) -> ([(Channels, DVec3); 2], f64) {
        let two_way = self.mapper;
        let element = &interaction.element;
        let surface = two_way.surfaces.of(interaction.triangle);
        let sign = if element.outside { 1.0 } else { -1.0 };
        let place = GatherPoint {
            position: element.position,
            outside: element.face * sign,
            leave: element.leave,
            surface,
            side: photon_tracing::side_of(surface, element.outside),
        };
        let appearance = &self.world.appearance;
        let gather_context = self.gather_context(if coarse { GatherDetail::Coarse } else { GatherDetail::Fine });
        let frame = interaction.frame();
        let wavelengths = &appearance.wavelengths;
        let is_one_color = !wavelengths.is_spectral() || is_parted;
        if let Some(value) = interaction.bsdf.constant_value(context).filter(|_| is_one_color) {
            let (irradiance, error) = self.pass.map.irradiance(&place, &gather_context);
            return (irradiance.map(|irradiance| (throughput * value * irradiance, DVec3::ZERO)), error);
        }
        let mut sums = [(Channels::ZERO, DVec3::ZERO); 2];
        let error = self.pass.map.each(&place, &gather_context, |contribution| {
            let light = frame.local(contribution.towards);
            let (sum, elsewhere) = &mut sums[usize::from(contribution.had_broad)];
            if is_one_color {
                *sum += interaction.bsdf.non_narrow_value(context, light) * contribution.irradiance;
            } else {
                // The photon has other wavelengths than the path.
                let at = ShadingContext { wavelength_set: contribution.wavelength_set, ..*context };
                let throughput =
                    between(throughput, context.wavelength_set, contribution.wavelength_set, wavelengths.count());
                let radiance = interaction.bsdf.non_narrow_value(&at, light) * contribution.irradiance * throughput;
                *elsewhere += wavelengths.to_srgb(contribution.wavelength_set, radiance);
            }
        });
        (sums.map(|(sum, elsewhere)| (throughput * sum, elsewhere)), error)
    }
}

/// Interpolates a quantity linearly from the wavelengths of one wavelength set to those of another.
fn between(quantity: Channels, known: usize, wanted: usize, sets: usize) -> Channels {
    let apart = (wanted as f64 - known as f64) / sets as f64;
    let (other, part) = (if apart < 0.0 { -1 } else { 1 }, apart.abs());
    Channels(std::array::from_fn(|lane| {
        let beside = (lane as isize + other).clamp(0, LANES as isize - 1) as usize;
        quantity.0[lane] * (1.0 - part) + quantity.0[beside] * part
    }))
}
