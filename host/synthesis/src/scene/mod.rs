//! What a script builds: objects, lights, a camera and settings, as plain data.
//!
//! Modelling space is right-handed: x right, y up, z towards the viewer. Lengths are in scene units.

mod settings;
mod motion;
mod decomposition;
mod view;
mod detail_view;
mod cage;
mod sculpture;
mod solid;
mod shape_mesh;
mod kept_grids;
mod fractal_ground;
mod erosion;
mod terrain;
mod made_mesh;
mod error;
mod object;
mod origins;
mod stretch;
mod tolerance;
mod composite;
mod object_intersection;
mod shape;
mod parameters;
mod scatter;
mod instances;
mod procedural;
mod drawn_objects;
mod plant;
mod grammar_plant;
mod rock;
mod exact;
mod acceleration;
mod file_meshes;
mod shared;
mod placed_models;
mod lamp_body;
mod prepared;
mod texture_footprint;
mod piercing;
mod octrees;
mod detail;
mod placing;
mod triangles;
mod placed_triangles;
mod soft_box;
mod default_light;
mod studio;

pub use acceleration::{Acceleration, AccelerationKey, SceneOctree};
pub use cage::{Cage, Sharp, Sharpening};
pub use detail::{DetailCosts, Details, GroundHit, MadeDetail, SceneGround};
pub use detail_view::DetailView;
pub use erosion::Erosion;
pub use error::{AccelerationError, SceneError, ShapeError};
pub use fractal_ground::{FractalGround, GroundKind};
pub use grammar_plant::{GrammarModel, GrammarSettings};
pub use instances::{Places, ShortScatter};
pub use made_mesh::MadeMesh;
pub use motion::{Displacement, Motion};
pub use object::{
    Composite, Instances, MAX_NESTING, Object, Operation, PlacementList, Placing, Procedural, ProceduralModel,
    RoundedSolid, Scatter, Shape, Sway,
};
pub use object_intersection::{ObjectIntersection, object_intersections};
pub use origins::{ScriptPosition, ShapeOrigins};
pub use piercing::SurfacePoint;
pub use plant::PlantModel;
pub use prepared::{Contents, Prepared, PreparedObject};
pub use procedural::MOST_KINDS;
pub use rock::RockModel;
pub use sculpture::{Sculpture, SculptureError, SurfaceSheet};
pub use settings::{
    Caustics, GeometrySettings, ImageSettings, LightSettings, MAX_PHOTONS, MAX_REFLECTION_DEPTH, MAX_SAMPLES,
    MOST_DETAIL, PhotonSettings, RadiositySettings, Settings,
};
pub use shape_mesh::ShapeMesh;
pub use solid::PrimitiveSolid;
pub use stretch::largest_stretch;
pub use studio::Studio;
pub use terrain::Terrain;
pub use texture_footprint::{Footprint, footprint};
pub use view::{Camera, Lens, Parallel, Projection, View};

pub use crate::illumination::optics::Interreflection;

use crate::illumination::light::LightShape;
use crate::illumination::{Light, RgbPower};
use crate::picture::display::DisplayTransform;
use serde::{Deserialize, Serialize};

/// Most objects in a scene.
pub const MAX_OBJECTS: usize = 100_000;
/// Most lights in a scene.
pub const MAX_LIGHTS: usize = 10_000;
/// Most portals in a scene: each is looked at for every direction to a sky.
pub const MAX_PORTALS: usize = 1_000;

/// A scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Scene {
    /// What stands in it.
    pub objects: Vec<Object>,
    /// Objects that move, by their place in `objects`, which says where they are in the middle of the time in which the
    /// shutter is open: that is the time 0 of their motions.
    pub motions: Vec<(u32, Motion)>,
    /// What lights it.
    pub lights: Vec<Light>,
    /// Rectangles through which the light of skies comes in, their normals pointing inwards. They change the noise of
    /// pictures, not what these show.
    pub portals: Vec<LightShape>,
    /// Radiance that arrives from everywhere, W/(m² sr); only diffuse reflection answers it.
    pub ambient: RgbPower,
    /// Radiance where a ray meets nothing, W/(m² sr).
    pub background: RgbPower,
    /// From where it is seen; without one, what is no ground is framed from the front, a little from above.
    pub camera: Option<Camera>,
    /// How it is rendered.
    pub settings: Settings,
    /// How its pictures are shown.
    pub display: DisplayTransform,
    /// The studio in which it is looked at: [`Scene::lit`] puts it there.
    pub studio: Option<Studio>,
    /// Where in its script its objects got their shapes.
    #[serde(skip)]
    pub origins: ShapeOrigins,
}

impl Scene {
    /// Checks every number in the scene.
    ///
    /// # Errors
    /// The first [`SceneError`], which names the object or the light.
    pub fn check(&self) -> Result<(), SceneError> {
        if self.objects.len() > MAX_OBJECTS {
            return Err(SceneError::Limit { what: "objects", limit: MAX_OBJECTS as u64 });
        }
        if self.lights.len() > MAX_LIGHTS {
            return Err(SceneError::Limit { what: "lights", limit: MAX_LIGHTS as u64 });
        }
        let mut before = None;
        for object in &self.objects {
            // Of many objects in a row that have the same shape, one is looked at.
            let is_known = before == Some(&object.shape);
            object.check(is_known)?;
            before = Some(&object.shape);
        }
        self.check_motions()?;
        for (index, light) in self.lights.iter().enumerate() {
            light.check().map_err(|problem| SceneError::Light { number: index + 1, problem: problem.to_string() })?;
        }
        if self.portals.len() > MAX_PORTALS {
            return Err(SceneError::Limit { what: "portals", limit: MAX_PORTALS as u64 });
        }
        for (index, portal) in self.portals.iter().enumerate() {
            portal.check().map_err(|problem| SceneError::Setting(format!("portal {}: {problem}", index + 1)))?;
        }
        check_power("ambient light", self.ambient).map_err(SceneError::Setting)?;
        check_power("background", self.background).map_err(SceneError::Setting)?;
        if let Some(camera) = &self.camera {
            camera.check()?;
        }
        self.display.check().map_err(SceneError::Setting)?;
        self.settings.check()
    }
}

impl Scene {
    /// The scene as it is after some time of its motions, which go on from there.
    ///
    /// - `time`: in the unit of time of the motions; may be below 0.
    pub fn after(&self, time: f64) -> Scene {
        let mut scene = self.clone();
        for (object, motion) in &mut scene.motions {
            if let Some(object) = scene.objects.get_mut(*object as usize) {
                object.transform = motion.at(time).matrix() * object.transform;
            }
            *motion = motion.since(time);
        }
        scene
    }

    fn check_motions(&self) -> Result<(), SceneError> {
        let mut known = vec![false; self.objects.len()];
        for (index, motion) in &self.motions {
            let Some(object) = self.objects.get(*index as usize) else {
                return Err(SceneError::Setting(format!("there is no object {index} that could move")));
            };
            let failed = |problem: String| SceneError::Object { object: object.name.clone(), problem };
            if std::mem::replace(&mut known[*index as usize], true) {
                return Err(failed("it has two motions".into()));
            }
            motion.check().map_err(failed)?;
        }
        Ok(())
    }

    /// Largest distance between the exact surfaces and the triangles that stand for them, scene units.
    ///
    /// It is measured, not the tolerance that was asked for; 0 without curved surfaces.
    ///
    /// # Errors
    /// [`SceneError`] if a mesh cannot be made.
    pub fn chord_error(&self) -> Result<f64, SceneError> {
        let mut largest = 0.0f64;
        for object in self.objects.iter().filter(|o| o.shape.is_approximated()) {
            largest = largest.max(object.chord_error(self.settings.geometry.tolerance, self.settings.geometry.angle)?);
        }
        Ok(largest)
    }
}

fn check_power(what: &str, power: RgbPower) -> Result<(), String> {
    if power.is_finite() && power.min_element() >= 0.0 {
        Ok(())
    } else {
        Err(format!("{what} {power} is negative or not finite"))
    }
}

#[cfg(test)]
mod tests;
