//! The main job: a scene on the workstation, the view that is set there with the dials, and its image back.

mod closed_form;

pub use closed_form::{difference, view_of_dials};

use crate::{
    picture::{Picture, display::DisplayTransform},
    plan::Plan,
    render::{
        Order, RenderError, Renderer, Rendering, Watch, metering::Meter, radiosity::Radiosity, ray_tracing::RayTracer,
        tiles::Tiling,
    },
    scene::{Camera, Prepared, Projection, Scene, SceneError, View},
    workstation::{Drawing, Session, WorkstationError, network, raster, structure, tiles},
};
use glam::{DMat4, DVec3};
use std::num::NonZeroUsize;
use std::time::Instant;

/// Corners of the tiles that show a solution by radiosity, unless the scene has more triangles: the machine shades so many
/// within a second.
const MOST_CORNERS: usize = 200_000;
/// Corners that the machine renders at all.
const MOST_RENDERED: usize = 1_000_000;

/// Why the main job failed.
#[derive(Debug, thiserror::Error)]
pub enum ProductionError {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The workstation, or the way there, failed.
    #[error(transparent)]
    Workstation(#[from] WorkstationError),
    /// The image cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// A scene that stands on a workstation.
#[derive(Debug)]
pub struct Production {
    prepared: Prepared,
    session: Session,
    depth_clipping: bool,
    is_lit: bool,
    sent: Sent,
}

/// What was sent to show a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sent {
    /// Lines drawn.
    pub lines: usize,
    /// Points sent: lines and moves.
    pub points: usize,
    /// Until the workstation had them, seconds.
    pub seconds: f64,
}

/// An image of the view that is set on the workstation.
#[derive(Debug)]
pub struct Shot {
    /// The image, with what it took.
    pub rendering: Rendering,
    /// Memory of the octree that the rays went through, bytes a triangle; none if the view needs no triangles.
    pub octree_bytes: Option<f64>,
    /// Until octree and tables stood, seconds.
    pub build_seconds: f64,
    /// The image as a display shows it.
    pub shown: Picture,
    /// Its exposure, stops.
    pub stops: f64,
}

impl Production {
    /// Models the scene and shows it on a workstation.
    ///
    /// # Errors
    /// [`ProductionError`].
    pub fn begin(scene: &Scene, session: Session, drawing: &Drawing) -> Result<Production, ProductionError> {
        Production::lit(scene, session, drawing, None)
    }

    /// Models the scene and shows it on a workstation with the light of a solution, which the workstation shades whenever the
    /// dials have stood still for a while.
    ///
    /// # Errors
    /// [`ProductionError`].
    pub fn lit(
        scene: &Scene,
        mut session: Session,
        drawing: &Drawing,
        light: Option<&Tiling>,
    ) -> Result<Production, ProductionError> {
        let prepared = Prepared::new(scene)?;
        let start = Instant::now();
        let shown = structure::with_light(scene, &prepared.camera, &prepared.bounds, drawing, light)?;
        session.show(&shown, prepared.bounds.diagonal().max(f64::MIN_POSITIVE))?;
        if light.is_some() {
            session.commands(&tiles::settings(prepared.background))?;
            session.commands(&network::shading())?;
            session.synchronize()?;
        }
        let sent = Sent { lines: shown.lines, points: shown.points, seconds: start.elapsed().as_secs_f64() };
        let (depth_clipping, is_lit) = (shown.depth_clipping, light.is_some());
        Ok(Production { prepared, session, depth_clipping, is_lit, sent })
    }

    /// The scene as it is rendered.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// What was sent.
    pub fn sent(&self) -> Sent {
        self.sent
    }

    /// The session with the workstation.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Reads the matrix of the view back: scene coordinates (z negated) to clip space.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn view(&mut self) -> Result<DMat4, ProductionError> {
        Ok(self.session.view()?)
    }

    /// What a matrix that was read back shows of the scene.
    fn projection(&self, matrix: &DMat4) -> Projection {
        // The screen's sides are those of the longer side of the picture, a view's those of the shorter one.
        let zoom = structure::elongation(&self.prepared.settings);
        let matrix = DMat4::from_scale(DVec3::new(zoom, zoom, 1.0)) * *matrix;
        Projection::from_workstation(&matrix, self.depth_clipping)
    }

    /// Reads back from where the scene is seen; none if no camera sees it so, as when somebody else has set the matrix.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn camera(&mut self) -> Result<Option<Camera>, ProductionError> {
        let matrix = self.view()?;
        let bounds = &self.prepared.bounds;
        Ok(self.projection(&matrix).camera(bounds.center(), bounds.diagonal().max(f64::MIN_POSITIVE)))
    }

    /// Ray-traces the view of a matrix that was read back.
    ///
    /// - `display`: how the image is shown; an automatic exposure is metered from this view.
    ///
    /// # Errors
    /// [`ProductionError::Render`]; a matrix that shows nothing is one.
    pub fn render(
        &self,
        matrix: &DMat4,
        order: &Order,
        display: &DisplayTransform,
        watch: &Watch<'_>,
    ) -> Result<Shot, ProductionError> {
        let view = View::Projection(self.projection(matrix));
        let start = Instant::now();
        let plan = Plan::new(&self.prepared, &view);
        let tracer = RayTracer::new(&self.prepared, &plan)?;
        let build_seconds = start.elapsed().as_secs_f64();
        let triangles = self.prepared.triangles.len().max(1) as f64;
        let octree_bytes = tracer.octree().map(|octree| octree.bytes() as f64 / triangles);
        let meter = Meter::new(&self.prepared.settings, display, order.threads);
        let stops = meter.stops(&tracer, &self.prepared, &[view], watch)?;
        let rendering = tracer.render(&view, order, watch)?;
        let pixel_angle = view.pixel_angle(order.width, order.height);
        let shown = display.shown(&rendering.picture, stops, pixel_angle).map_err(RenderError::from)?;
        Ok(Shot { rendering, octree_bytes, build_seconds, shown, stops })
    }

    /// Shows an image on the raster screen, whose radiance is the light of the display. It is there when this returns.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn show_image(&mut self, picture: &Picture) -> Result<(), ProductionError> {
        let bytes = picture.to_srgb8();
        let (pixels, _) = bytes.as_chunks::<3>();
        self.session.raster(&raster::commands(picture.width(), picture.height(), pixels))?;
        Ok(self.session.synchronize()?)
    }

    /// Puts the dials back to where they began.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn reset(&mut self) -> Result<(), ProductionError> {
        self.session.commands(&network::reset())?;
        if self.is_lit {
            self.session.commands(&network::shade())?;
        }
        Ok(self.session.synchronize()?)
    }
}

/// Solves for the light of a scene by radiosity, as tiles for [`Production::lit`].
///
/// - `threads`: as in [`Order`].
///
/// # Errors
/// [`ProductionError`]; more polygons than the machine renders are one.
pub fn tiling(scene: &Scene, threads: Option<NonZeroUsize>, watch: &Watch<'_>) -> Result<Tiling, ProductionError> {
    let mut prepared = Prepared::new(scene)?;
    // Surfaces out of view send light, too, and come into view.
    prepared.settings.interreflection = true;
    let plan = Plan::new(&prepared, &prepared.view());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, |n| n.get())).build();
    let tiling = pool.map_err(RenderError::from)?.install(|| {
        let solution = Radiosity::new(&prepared, &plan, &prepared.settings.into(), None, watch)?;
        Tiling::new(&solution, &prepared, &plan, MOST_CORNERS)
    })?;
    match tiling.corners() {
        corners if corners > MOST_RENDERED => {
            let problem = format!("its polygons have {corners} corners; the machine renders {MOST_RENDERED} at most");
            Err(WorkstationError::Scene(problem).into())
        }
        _ => Ok(tiling),
    }
}
