//! The table of renderers: what the command line, studies and reports know of each. A new renderer is a room and a row.

use super::indirect::IndirectLight;
use super::radiosity::{self, Exitance, Radiosity};
use super::ray_tracing::RayTracer;
use super::scan_line::ScanLine;
use super::two_way::PhotonStore;
use super::world::World;
use super::{RenderError, Renderer, Watch};
use crate::plan::{Plan, Stage};
use crate::scene::{Caustics, Interreflection, Prepared, Settings};
use serde::Serialize;
use std::sync::Arc;
use std::time::Duration;

/// A rendering technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// Ray tracing, with paths from the camera alone.
    RayTracing,
    /// Ray tracing, with photons that are traced from lamps first.
    TwoWay,
    /// Scan line.
    ScanLine,
    /// Radiosity, shown by scan line.
    Radiosity,
}

/// A row of the table of renderers.
pub struct RendererRow {
    /// The technique that the row describes.
    pub technique: Technique,
    /// The name on the command line.
    pub option: &'static str,
    /// The name in tables and sentences.
    pub word: &'static str,
    /// A summary for help texts.
    pub help: &'static str,
    /// Whether it adds samples to pixels one by one: errors, seconds, a state to continue with, single pixels and
    /// denoising can then be asked for.
    pub adds_samples: bool,
    /// Whether it traces photons from lamps, which can be stored.
    pub can_map_photons: bool,
    /// Whether it finds caustics by photons, in every scene.
    pub always_maps_photons: bool,
    /// Whether it finds the light that diffuse surfaces send each other in every scene, which takes long and can be
    /// continued.
    pub solves_radiosity: bool,
    /// Whether studies of knobs know it.
    pub is_studied: bool,
    /// Sets what it needs of the settings of a scene.
    pub require: fn(&mut Settings),
    /// Prepares it for a scene.
    prepare: for<'a> fn(&Task<'a>) -> Result<PreparedRenderer<'a>, RenderError>,
}

/// All renderers, in the order of [`Technique`].
pub const RENDERERS: [RendererRow; 4] = [
    RendererRow {
        technique: Technique::RayTracing,
        option: "ray-tracing",
        word: "ray tracing",
        help: "All light: mirrors, glass, rough surfaces, soft shadows",
        adds_samples: true,
        can_map_photons: true,
        always_maps_photons: false,
        solves_radiosity: false,
        is_studied: true,
        require: |_| (),
        prepare: ray_tracing,
    },
    RendererRow {
        technique: Technique::TwoWay,
        option: "two-way",
        word: "two-way",
        help: "All light, with photons traced from lamps through mirrors and glass first: caustics",
        adds_samples: true,
        can_map_photons: true,
        always_maps_photons: true,
        solves_radiosity: false,
        is_studied: true,
        require: |settings| settings.light.caustics = Caustics::PhotonMapped,
        prepare: ray_tracing,
    },
    RendererRow {
        technique: Technique::ScanLine,
        option: "scan-line",
        word: "scan line",
        help: "Light that comes straight from lights, with sharp shadows and straight transparency; many times faster. Pixels of mirrors, metals, coats and glass are finished by rays, and diffuse interreflection is interpolated between rays",
        adds_samples: false,
        can_map_photons: false,
        always_maps_photons: false,
        solves_radiosity: false,
        is_studied: true,
        require: |settings| settings.geometry.copies_instances = true,
        prepare: |task| {
            let scan_line = ScanLine::new(task.prepared, task.plan)?;
            Ok(PreparedRenderer { renderer: AnyRenderer::Whole(Box::new(scan_line)), radiosity: None })
        },
    },
    RendererRow {
        technique: Technique::Radiosity,
        option: "radiosity",
        word: "radiosity",
        help: "Light that goes from diffuse surface to diffuse surface, found once for all views; mirrors, glass and highlights are not seen",
        adds_samples: false,
        can_map_photons: false,
        always_maps_photons: false,
        solves_radiosity: true,
        is_studied: false,
        // Diffuse surfaces show what is solved for: no path goes on from them.
        require: |settings| {
            settings.light.interreflection = Interreflection::Solved;
            settings.geometry.copies_instances = true;
        },
        prepare: |task| {
            let world = World::new(task.prepared, task.plan)?;
            let solution = Radiosity::new(&world, task.plan, &task.prepared.settings.radiosity, None, &task.watch)?;
            let radiosity = Some(solution.report);
            let scan_line = ScanLine::showing(Arc::new(solution), world, task.plan);
            Ok(PreparedRenderer { renderer: AnyRenderer::Whole(Box::new(scan_line)), radiosity })
        },
    },
];

/// The task of a renderer: what it is prepared for.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The scene, with settings as [`RendererRow::require`] left them.
    pub prepared: &'a Prepared,
    /// The plan of what is needed of the scene.
    pub plan: &'a Plan,
    /// Where photons are stored beyond the renderer; nowhere without one.
    pub photon_store: Option<&'a PhotonStore>,
    /// Who watches what is found before the first picture, and may stop it: the light that surfaces send each other is
    /// then known coarsely.
    pub watch: Watch<'a>,
}

impl<'a> Task<'a> {
    /// A scene, unwatched.
    pub fn new(prepared: &'a Prepared, plan: &'a Plan) -> Task<'a> {
        Task { prepared, plan, photon_store: None, watch: Watch::NOBODY }
    }
}

/// A renderer that has taken up a scene.
pub struct PreparedRenderer<'a> {
    /// The renderer, with its world.
    pub renderer: AnyRenderer<'a>,
    /// The report of the light that diffuse surfaces send each other, if that was found before.
    pub radiosity: Option<radiosity::RadiosityReport>,
}

/// A renderer, by how it makes its pictures.
pub enum AnyRenderer<'a> {
    /// Sample by sample: [`RendererRow::adds_samples`].
    BySamples(Box<RayTracer<'a>>),
    /// At once.
    Whole(Box<dyn Renderer + 'a>),
}

impl<'a> AnyRenderer<'a> {
    /// The renderer, as any.
    pub fn any(&self) -> &(dyn Renderer + 'a) {
        match self {
            AnyRenderer::BySamples(tracer) => &**tracer,
            AnyRenderer::Whole(renderer) => &**renderer,
        }
    }

    /// How long it took to build the octrees that its rays go through, whether for it or for an earlier renderer.
    pub fn octree_time(&self) -> Duration {
        match self {
            AnyRenderer::BySamples(tracer) => tracer.world().octree_time(),
            AnyRenderer::Whole(_) => Duration::ZERO,
        }
    }
}

impl Technique {
    /// Its row of the table.
    pub fn row(self) -> &'static RendererRow {
        &RENDERERS[self as usize]
    }

    /// The one of a name on the command line.
    pub fn of_option(option: &str) -> Option<Technique> {
        RENDERERS.iter().find(|row| row.option == option).map(|row| row.technique)
    }

    /// Prepares it for a scene, on the threads of the pool in which it is called.
    ///
    /// # Errors
    /// [`RenderError`], for a scene that has no octree, an impossible material, or light that grows without end.
    pub fn prepare<'a>(self, task: &Task<'a>) -> Result<PreparedRenderer<'a>, RenderError> {
        (self.row().prepare)(task)
    }
}

/// A ray tracer with all that its plan needs.
///
/// # Errors
/// [`RenderError::Octree`], [`RenderError::Material`], [`RenderError::Radiosity`].
pub fn ray_tracer<'a>(prepared: &'a Prepared, plan: &'a Plan) -> Result<RayTracer<'a>, RenderError> {
    Ok(ray_tracer_watched(&Task::new(prepared, plan))?.0)
}

/// A ray tracer with all that its plan needs; and what radiosity took, if it was solved for.
///
/// # Errors
/// [`RenderError::Octree`], [`RenderError::Material`], [`RenderError::Radiosity`].
pub fn ray_tracer_watched<'a>(
    task: &Task<'a>,
) -> Result<(RayTracer<'a>, Option<radiosity::RadiosityReport>), RenderError> {
    let Task { prepared, plan, photon_store, watch } = *task;
    let world = World::new(prepared, plan)?;
    let tracer = RayTracer::new(world, plan, photon_store);
    if !plan.needs(Stage::Radiosity) {
        return Ok((tracer, None));
    }
    let solution = {
        let photons = tracer.photon_estimator(&watch);
        let sent = photons.as_ref().map(|photons| |triangle, outside, at| photons.exitance(triangle, outside, at));
        let exitance: Option<Exitance<'_>> = sent.as_ref().map(|sent| sent as Exitance<'_>);
        Radiosity::new(tracer.world(), plan, &prepared.settings.radiosity, exitance, &watch)?
    };
    let report = solution.report;
    let light: Box<dyn IndirectLight> = Box::new(solution);
    Ok((tracer.with_indirect(light), Some(report)))
}

fn ray_tracing<'a>(task: &Task<'a>) -> Result<PreparedRenderer<'a>, RenderError> {
    let (tracer, radiosity) = ray_tracer_watched(task)?;
    Ok(PreparedRenderer { renderer: AnyRenderer::BySamples(Box::new(tracer)), radiosity })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_techniques_and_their_names_lead_to_them() {
        for row in &RENDERERS {
            assert_eq!(row.technique.row().option, row.option);
            assert_eq!(Technique::of_option(row.option), Some(row.technique));
        }
    }
}
