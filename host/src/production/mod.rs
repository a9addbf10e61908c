//! The main job: a scene on the workstation, the view that is set there with the dials, and its image back.

mod closed_form;
mod error;
mod rendered_view;
mod progressive;

pub use closed_form::{difference, view_of_dials};
pub use error::ProductionError;
pub use progressive::{Progressive, RenderingEvent, VIEW_STAGE};
pub use rendered_view::RenderedView;

use crate::stages::Workers;
use crate::{
    picture::{Picture, display::DisplayTransform},
    plan::Plan,
    render::{RenderError, RenderOrder, Watch, World, radiosity::Radiosity, tiles::Tiling},
    scene::{Camera, Interreflection, Prepared, Projection, Scene, SceneError, View},
    workstation::{
        Drawing, DrawnInstances, DrawnMotion, FlipBook, InitialView, Session, StructureCommands, WorkstationError,
        motion::{self, MOTION_KEY},
        network, raster, structure, tiles,
    },
};
use glam::{DMat4, DVec3};
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::Instant;

/// Corners of the tiles that show a solution by radiosity, unless the scene has more triangles: the machine shades so many
/// within a second.
const MOST_CORNERS: usize = 200_000;
/// Corners that the machine renders at all.
const MOST_RENDERED: usize = 1_000_000;

/// A scene that is ready to be shown on a workstation.
#[derive(Debug)]
pub struct Model {
    prepared: Prepared,
    initial: InitialView,
    structure: StructureCommands,
    is_lit: bool,
    moving: Option<MovingScene>,
    begun: Instant,
}

impl Model {
    /// Models a scene.
    ///
    /// - `light`: of its surfaces, if it is to be shown; the workstation shades it whenever the dials have stood still for a
    ///   while. `initial`: from where it is seen, instead of by its own camera.
    ///
    /// # Errors
    /// [`ProductionError`].
    pub fn new(
        scene: &Scene,
        drawing: &Drawing,
        light: Option<&Tiling>,
        initial: Option<InitialView>,
    ) -> Result<Model, ProductionError> {
        let prepared = Prepared::new(scene)?;
        let begun = Instant::now();
        let own = InitialView::of(&prepared)?;
        let initial = initial.map_or(own, |initial| InitialView { elongation: own.elongation, ..initial });
        let shown = structure::with_light(scene, &initial, &prepared.subject(), drawing, light)?;
        let moving = shown.motion.map(|_| MovingScene::OfMotions(Arc::new(scene.clone())));
        Ok(Model { prepared, initial, structure: shown, is_lit: light.is_some(), moving, begun })
    }

    /// Models the pictures of a flip-book, which are seen by the camera of the first scene.
    ///
    /// # Errors
    /// [`ProductionError`].
    pub fn of_pictures(book: FlipBook, drawing: &Drawing) -> Result<Model, ProductionError> {
        let prepared = Prepared::new(book.first())?;
        let begun = Instant::now();
        let initial = InitialView::of(&prepared)?;
        let structure = structure::pictures(&book, &initial, &prepared.subject(), drawing)?;
        let moving = structure.motion.map(|_| MovingScene::OfPictures(Arc::new(book)));
        Ok(Model { prepared, initial, structure, is_lit: false, moving, begun })
    }

    /// From where it is seen before dials turn it.
    pub fn initial(&self) -> &InitialView {
        &self.initial
    }
}

/// A scene in which something moves on the workstation.
#[derive(Clone, Debug)]
enum MovingScene {
    /// By its motions.
    OfMotions(Arc<Scene>),
    /// From picture to picture.
    OfPictures(Arc<FlipBook>),
}

impl MovingScene {
    /// The scene as it stands after seconds, ready to be rendered.
    fn prepared(&self, seconds: f64) -> Result<Prepared, SceneError> {
        match self {
            MovingScene::OfMotions(scene) => Prepared::new(&scene.after(seconds)),
            MovingScene::OfPictures(book) => Prepared::new(book.scene(seconds)),
        }
    }
}

/// A scene that stands on a workstation.
#[derive(Debug)]
pub struct Production {
    prepared: Arc<Prepared>,
    initial: InitialView,
    session: Session,
    depth_clipping: bool,
    is_lit: bool,
    moving: Option<MovingScene>,
    sent: Sent,
    /// Width and height of the image on the raster screen, if one was sent.
    image: Option<[u32; 2]>,
}

/// What was sent to show a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sent {
    /// Lines drawn.
    pub lines: usize,
    /// Points sent: lines and moves.
    pub points: usize,
    /// What is drawn of the instances, in a scene that has any.
    pub instances: Option<DrawnInstances>,
    /// What moves, in a scene where something does.
    pub motion: Option<DrawnMotion>,
    /// From when they were chosen until the workstation had them, seconds.
    pub seconds: f64,
}

impl Sent {
    /// - `begun`: when it was chosen.
    fn of(shown: &StructureCommands, begun: Instant) -> Sent {
        let StructureCommands { lines, points, instances, motion, .. } = *shown;
        Sent { lines, points, instances, motion, seconds: begun.elapsed().as_secs_f64() }
    }
}

impl RenderedView {
    /// For each row, from the top, whether all of its pixels have samples; false in rows that a stop left out.
    pub fn rows(&self) -> Vec<bool> {
        progressive::rows_of(&self.rendering.film)
    }
}

impl Production {
    /// Models the scene and shows it on a workstation.
    ///
    /// # Errors
    /// [`ProductionError`].
    pub fn begin(scene: &Scene, session: Session, drawing: &Drawing) -> Result<Production, ProductionError> {
        Production::show(Model::new(scene, drawing, None, None)?, session)
    }

    /// Shows a scene on a workstation.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn show(model: Model, mut session: Session) -> Result<Production, ProductionError> {
        let Model { prepared, initial, structure: shown, is_lit, moving, begun } = model;
        session.show(&shown, initial.movement())?;
        if is_lit {
            session.commands(&tiles::settings(prepared.background))?;
            session.commands(&network::shading())?;
            session.synchronize()?;
        }
        let sent = Sent::of(&shown, begun);
        let depth_clipping = shown.depth_clipping;
        let prepared = Arc::new(prepared);
        Ok(Production { prepared, initial, session, depth_clipping, is_lit, moving, sent, image: None })
    }

    /// Shows another scene in place of this one, which was shown with light if that is.
    ///
    /// - `keeps_dials`: whether it stands as dials have turned this one, rather than as its own camera sees it.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn replace(&mut self, model: Model, keeps_dials: bool) -> Result<(), ProductionError> {
        let Model { prepared, initial, structure: shown, moving, begun, .. } = model;
        self.session.replace(&shown, initial.movement())?;
        if self.is_lit {
            // The node that shades was made anew.
            self.session.commands(&network::shading())?;
        }
        if self.moving.is_some() && moving.is_none() {
            self.label(MOTION_KEY.0, "")?;
        }
        (self.sent, self.moving) = (Sent::of(&shown, begun), moving);
        (self.prepared, self.initial, self.depth_clipping) = (Arc::new(prepared), initial, shown.depth_clipping);
        if keeps_dials { Ok(self.session.synchronize()?) } else { self.reset() }
    }

    /// The scene as it is rendered.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// From where it is seen before dials turn it.
    pub fn initial(&self) -> &InitialView {
        &self.initial
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

    /// Reads back how long everything has moved since it began, or began anew, seconds: at 0 the scene stands as it was
    /// shown. 0 where nothing moves.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn motion_seconds(&mut self) -> Result<f64, ProductionError> {
        Ok(if self.moving.is_some() { self.session.motion_seconds()? } else { 0.0 })
    }

    /// What a matrix that was read back shows of the scene.
    fn projection(&self, matrix: &DMat4) -> Projection {
        // The screen's sides are those of the longer side of the picture, a view's those of the shorter one.
        let zoom = self.initial.elongation;
        let matrix = DMat4::from_scale(DVec3::new(zoom, zoom, 1.0)) * *matrix;
        Projection::from_workstation(&matrix, self.depth_clipping)
    }

    /// Reads back from where the scene is seen; none if no camera sees it so, as when somebody else has set the matrix.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn camera(&mut self) -> Result<Option<Camera>, ProductionError> {
        let matrix = self.view()?;
        let diagonal = self.prepared.bounds.diagonal().max(f64::MIN_POSITIVE);
        Ok(self.projection(&matrix).camera(self.initial.center, diagonal))
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
        options: &RenderOrder,
        display: &DisplayTransform,
        watch: &Watch<'_>,
    ) -> Result<RenderedView, ProductionError> {
        let view = View::Projection(self.projection(matrix));
        progressive::render_view(&self.prepared, &view, options, display, watch, None)
    }

    /// Begins to ray-trace the view of a matrix that was read back, beside whatever else is done.
    ///
    /// - `seconds`: how long everything has moved, as [`motion_seconds`](Self::motion_seconds) reads it back.
    /// - `display`: how the image is shown; an automatic exposure is metered from this view.
    ///
    /// # Errors
    /// [`ProductionError::Thread`].
    pub fn begin_rendering(
        &self,
        matrix: &DMat4,
        seconds: f64,
        options: &RenderOrder,
        display: &DisplayTransform,
    ) -> Result<Progressive, ProductionError> {
        let view = View::Projection(self.projection(matrix));
        let (shown, moving) = (self.prepared.clone(), self.moving.clone().filter(|_| seconds != 0.0));
        let prepared = move || match moving {
            Some(scene) => Ok(Arc::new(scene.prepared(seconds)?)),
            None => Ok(shown),
        };
        Progressive::begin(prepared, view, *options, *display)
    }

    /// Shows an image on the raster screen, whose radiance is the light of the display. It is there when this returns.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn show_image(&mut self, picture: &Picture) -> Result<(), ProductionError> {
        self.show_rows(picture, |_| true)
    }

    /// Shows rows of an image on the raster screen, whose radiance is the light of the display. They are there when this
    /// returns. Elsewhere an image of the same size stays.
    ///
    /// - `is_shown`: which rows, counted from the top.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn show_rows(&mut self, picture: &Picture, is_shown: impl Fn(u32) -> bool) -> Result<(), ProductionError> {
        let size = [picture.width(), picture.height()];
        if self.image.replace(size) != Some(size) {
            self.session.raster(&raster::begin())?;
        }
        let bytes = picture.to_srgb8();
        let (pixels, _) = bytes.as_chunks::<3>();
        self.session.raster(&raster::rows(size, pixels, is_shown))?;
        Ok(self.session.synchronize()?)
    }

    /// Says something in the message line of the workstation, which a blank empties.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn show_message(&mut self, text: &str) -> Result<(), ProductionError> {
        Ok(self.session.commands(&[network::message(text)])?)
    }

    /// Writes the label over a function key (1..=12), of 8 characters at most.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn label(&mut self, key: i32, text: &str) -> Result<(), ProductionError> {
        Ok(self.session.commands(&[network::label(key, text)])?)
    }

    /// Puts the dials back to where they began, and lets what moves begin anew.
    ///
    /// # Errors
    /// [`ProductionError::Workstation`].
    pub fn reset(&mut self) -> Result<(), ProductionError> {
        self.session.commands(&network::reset())?;
        if self.sent.instances.is_some() {
            self.session.commands(&network::reset_detail())?;
        }
        if self.moving.is_some() {
            self.session.commands(&motion::restart())?;
        }
        if self.is_lit {
            self.session.commands(&network::shade())?;
        }
        Ok(self.session.synchronize()?)
    }
}

/// Solves for the light of a scene by radiosity, as tiles for a [`Model`].
///
/// - `threads`: as in [`RenderOrder`].
///
/// # Errors
/// [`ProductionError`]; more polygons than the machine renders are one.
pub fn tiling(scene: &Scene, threads: Option<NonZeroUsize>, watch: &Watch<'_>) -> Result<Tiling, ProductionError> {
    let mut scene = scene.clone();
    // Surfaces out of view send light, too, and come into view; near ones, too.
    scene.settings.light.interreflection = Interreflection::Solved;
    scene.settings.radiosity.pixels = 0.0;
    let prepared = Prepared::new(&scene)?;
    let plan = Plan::new(&prepared, &prepared.view());
    let workers = Workers::new(threads).map_err(RenderError::from)?;
    let tiling = workers.install(|| {
        let solution =
            Radiosity::new(&World::new(&prepared, &plan)?, &plan, &prepared.settings.radiosity, None, watch)?;
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
