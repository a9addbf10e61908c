//! What is rendered in a study: a scene, how each of its knobs is set, and the renderings of it that are timed.

use crate::picture::Picture;
use crate::plan::{Plan, Stage};
use crate::render::two_way::greatest_gather_radius;
use crate::render::{Memo, PreparedRenderer, RENDERERS, RenderOrder, Task, Technique, Watch};
use crate::scene::{Caustics, GeometrySettings, Object, Prepared, Scene, Settings};
use crate::study::options::resized;
use crate::study::{Options, StudyError};
use serde::{Deserialize, Serialize};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Added to the seed of a reference, so that its samples are independent of those under test.
const REFERENCE_SEED: u64 = 0x5EED;

/// The renderers whose knobs are studied.
pub fn studied() -> impl Iterator<Item = Technique> {
    RENDERERS.iter().filter(|row| row.is_studied).map(|row| row.technique)
}

/// Those by which a scene is studied unless others are asked for: scan line, and ray tracing as the scene has it.
pub fn usual(settings: &Settings) -> [Technique; 2] {
    let rays = match settings.light.caustics {
        Caustics::PhotonMapped => Technique::TwoWay,
        _ => Technique::RayTracing,
    };
    [rays, Technique::ScanLine]
}

/// How every knob is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setup {
    pub(super) technique: Technique,
    pub(super) settings: Settings,
    /// Relative error at which a pixel has samples enough.
    pub(super) target: Option<f64>,
    /// Whether pictures are denoised.
    pub(super) denoise: bool,
    /// Whether tolerances of single objects count.
    pub(super) own_tolerances: bool,
}

/// The scene that is studied, as it was asked for.
pub(super) struct StudiedScene {
    scene: Scene,
    pub(super) prepared: Prepared,
    pub(super) options: Options,
    /// What the scene would need if no knob held it back.
    plan: Plan,
    /// Diagonal of the largest object with a surface that is curved and known exactly, scene units; 0 without.
    pub(super) largest_curved: f64,
}

/// One rendering.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct TimedRendering {
    pub(super) picture: Picture,
    /// From the scene to a renderer that has taken it up, seconds.
    pub(super) build: f64,
    /// For the picture, seconds.
    pub(super) render: f64,
}

impl StudiedScene {
    /// # Errors
    /// [`StudyError::Scene`].
    pub(super) fn new(scene: &Scene, options: &Options) -> Result<StudiedScene, StudyError> {
        let options = Options { settings: options.settings.clamp(2, 16), ..*options };
        let mut scene = resized(scene, &options);
        let prepared = Prepared::new(&scene)?;
        // In words, if all that is scattered in cells tells the same.
        let own = scene.objects.iter().filter(|object| object.is_in_cells()).map(Object::aggregate);
        let own: Vec<f64> = own.map(|pixels| pixels.unwrap_or(0.0)).collect();
        if own.windows(2).all(|pair| pair[0] == pair[1]) {
            scene.settings.geometry.aggregate = scene.settings.geometry.aggregate.or(own.first().copied());
        }
        // The camera stays where it is, even if it was framed automatically.
        scene.camera = Some(prepared.camera);
        let curved = scene.objects.iter().zip(&prepared.objects).filter(|(o, _)| o.shape.is_exact_and_curved());
        let largest_curved = curved.map(|(_, p)| p.bounds.diagonal()).fold(0.0, f64::max);
        let mut free = prepared.clone();
        free.settings.light.reflection_depth = free.settings.light.reflection_depth.max(1);
        free.settings.light.spectral = free.settings.light.spectral.filter(|spectral| *spectral);
        free.settings.light.caustics = Caustics::PhotonMapped;
        let plan = Plan::new(&free, &free.view());
        Ok(StudiedScene { scene, prepared, options, plan, largest_curved })
    }

    pub(super) fn settings(&self) -> &Settings {
        &self.scene.settings
    }

    /// The words, if the scene has no need of a stage.
    pub(super) fn lacks(&self, stage: Stage, why: &'static str) -> Option<&'static str> {
        (!self.plan.needs(stage)).then_some(why)
    }

    /// Whether no procedural model is in the scene.
    pub(super) fn has_no_models(&self) -> bool {
        !self.scene.objects.iter().any(Object::has_models)
    }

    /// Whether nothing is scattered in cells.
    pub(super) fn has_no_cells(&self) -> bool {
        !self.scene.objects.iter().any(Object::is_in_cells)
    }

    /// All knobs as the scene has them.
    pub(super) fn own(&self, technique: Technique) -> Setup {
        let mut settings = self.scene.settings;
        // In words, so that setups that are the same are equal.
        settings.light.spectral = Some(settings.light.spectral.unwrap_or(self.plan.needs(Stage::Spectra)));
        if settings.light.caustics == Caustics::PhotonMapped {
            settings.light.caustics = Caustics::LeftOut;
        }
        (technique.row().require)(&mut settings);
        settings.photons.radius =
            Some(settings.photons.radius.unwrap_or_else(|| greatest_gather_radius(&self.prepared)));
        Setup { technique, settings, target: None, denoise: false, own_tolerances: true }
    }

    /// What a renderer leaves out of the scene: nothing by samples of all light.
    pub(super) fn left_out(&self, technique: Technique) -> Result<Vec<&'static str>, StudyError> {
        if technique.row().adds_samples {
            return Ok(Vec::new());
        }
        let prepared = self.prepared_for(&self.own(technique))?;
        let view = prepared.view();
        let plan = Plan::new(&prepared, &view);
        Ok(technique.prepare(&Task::new(&prepared, &plan))?.renderer.any().left_out(&view))
    }

    /// Renders the two halves of a reference, which know nothing of one another: by other seeds, and scan line, which
    /// has none, by another grid of samples.
    ///
    /// # Errors
    /// [`StudyError`]; [`StudyError::Interrupted`] for a picture that is not complete.
    pub(super) fn halves(&self, setup: &Setup, watch: &Watch<'_>) -> Result<[TimedRendering; 2], StudyError> {
        let half = |half: u64, order: &mut RenderOrder| {
            order.seed = order.seed.wrapping_add(REFERENCE_SEED + half);
            if half == 1 && !setup.technique.row().adds_samples {
                order.samples -= order.samples / 8;
            }
        };
        let shots = self.render(setup, &half, &|shots| shots.len() == 2, watch)?;
        <[TimedRendering; 2]>::try_from(shots).map_err(|_| StudyError::Interrupted)
    }

    /// Renders a setup again and again, each time with another seed.
    ///
    /// - `is_enough`: whether no more are needed.
    ///
    /// # Errors
    /// [`StudyError`]; [`StudyError::Interrupted`] for a picture that is not complete.
    pub(super) fn trials(
        &self,
        setup: &Setup,
        is_enough: &dyn Fn(&[TimedRendering]) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Vec<TimedRendering>, StudyError> {
        self.render(setup, &|trial, order| order.seed = order.seed.wrapping_add(trial), is_enough, watch)
    }

    fn render(
        &self,
        setup: &Setup,
        vary: &dyn Fn(u64, &mut RenderOrder),
        is_enough: &dyn Fn(&[TimedRendering]) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Vec<TimedRendering>, StudyError> {
        Memo::next(watch.memo, || self.render_now(setup, vary, is_enough, watch))
    }

    fn render_now(
        &self,
        setup: &Setup,
        vary: &dyn Fn(u64, &mut RenderOrder),
        is_enough: &dyn Fn(&[TimedRendering]) -> bool,
        watch: &Watch<'_>,
    ) -> Result<Vec<TimedRendering>, StudyError> {
        let start = Instant::now();
        let mut prepared = self.prepared_for(setup)?;
        let modelling = start.elapsed().as_secs_f64();
        // With a target, as many samples as a half of the reference has, at the most.
        let samples = match setup.target {
            Some(_) => setup.settings.image.samples.max(self.options.samples / 2),
            None => setup.settings.image.samples,
        };
        let order = RenderOrder {
            samples,
            target: setup.target,
            denoise: setup.denoise,
            threads: self.options.threads,
            ..RenderOrder::of(&setup.settings)
        };
        let varied = |shots: &[TimedRendering]| {
            let mut order = order;
            vary(shots.len() as u64, &mut order);
            order
        };
        let unkept = watch.without_memo();
        let is_followed = setup.technique.row().always_maps_photons;
        let mut shots = Vec::new();
        while !is_enough(&shots) {
            if is_followed {
                // Photons are traced from lamps by the seed of the scene, and kept for all further pictures.
                prepared.settings.image.seed = varied(&shots).seed;
            }
            let (start, built) = (Instant::now(), prepared.accelerations());
            let view = prepared.view();
            let plan = Plan::new(&prepared, &view);
            let PreparedRenderer { renderer, .. } = setup.technique.prepare(&Task::new(&prepared, &plan))?;
            // An octree of an earlier setting is part of what this one costs, too.
            let shared = if prepared.accelerations() == built { renderer.octree_time() } else { Duration::ZERO };
            let build = modelling + (start.elapsed() + shared).as_secs_f64();
            while !is_enough(&shots) {
                let rendering = renderer.any().render(&view, &varied(&shots), &unkept)?;
                if !rendering.complete || watch.cancelled.load(Ordering::Relaxed) {
                    return Err(StudyError::Interrupted);
                }
                shots.push(TimedRendering { picture: rendering.picture, build, render: rendering.seconds });
                if is_followed {
                    break;
                }
            }
        }
        Ok(shots)
    }

    fn prepared_for(&self, setup: &Setup) -> Result<Prepared, StudyError> {
        let Setup { settings, own_tolerances, .. } = *setup;
        let own = self.settings();
        let modelled = |s: &Settings| GeometrySettings { copies_instances: s.copies_instances(), ..s.geometry };
        if own_tolerances && modelled(&settings) == modelled(own) {
            let mut prepared = self.prepared.clone();
            prepared.settings = settings;
            return Ok(prepared);
        }
        let mut scene = Scene { settings, ..self.scene.clone() };
        if !own_tolerances {
            scene.objects.iter_mut().for_each(|object| object.tolerance = None);
        }
        Ok(Prepared::new(&scene)?)
    }
}
