//! What a script builds: objects, lights, a camera and settings, as plain data.
//!
//! Modelling space is right-handed: x right, y up, z towards the viewer. Lengths are in scene units.

mod cage;
mod composite;
mod decomposition;
mod default_light;
mod error;
mod exact;
mod meeting;
mod motion;
mod places;
mod placing;
mod prepared;
mod sculpture;
mod shape;
mod shared;
mod soft_box;
mod studio;
mod triangles;
mod view;

pub use cage::{Cage, Sharp, Sharpening};
pub use composite::{Composite, MAX_NESTING, Operation};
pub use error::SceneError;
pub use exact::OnSurface;
pub use meeting::{Meeting, meetings};
pub use motion::{Motion, Moved};
pub use places::{Places, Position};
pub use placing::{Sides, footprint};
pub use prepared::{Prepared, PreparedObject};
pub use sculpture::{Sculpture, SculptureError, Sheet};
pub use shape::{Made, Rounded, Shape, ShapeError};
pub use studio::Studio;
pub use view::{Camera, Lens, Parallel, Projection, View};

use crate::illumination::light::Patch;
use crate::illumination::{Bands, Light, Material};
use crate::octree::MAX_POINT_DEPTH;
use crate::picture::Filter;
use crate::picture::display::DisplayTransform;
use glam::DMat4;
use serde::{Deserialize, Serialize};

/// Most objects in a scene.
pub const MAX_OBJECTS: usize = 100_000;
/// Most lights in a scene.
pub const MAX_LIGHTS: usize = 10_000;
/// Most portals in a scene: each is looked at for every direction to a sky.
pub const MAX_PORTALS: usize = 1_000;
/// Most samples in a pixel.
pub const MAX_SAMPLES: u32 = 65_536;
/// Most ways of light that are followed at a time: caught, they take up to 1.2 GB.
pub const MAX_PHOTONS: u32 = 16_000_000;
/// Deepest chain of reflections.
pub const MAX_REFLECTION_DEPTH: u32 = 1_000;

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
    pub portals: Vec<Patch>,
    /// Radiance that arrives from everywhere, W/(m² sr); only diffuse reflection answers it.
    pub ambient: Bands,
    /// Radiance where a ray meets nothing, W/(m² sr).
    pub background: Bands,
    /// From where it is seen; without one, what is no ground is framed from the front, a little from above.
    pub camera: Option<Camera>,
    /// How it is rendered.
    pub settings: Settings,
    /// How its pictures are shown.
    pub display: DisplayTransform,
    /// The studio in which it is looked at: [`Scene::lit`] puts it there.
    pub studio: Option<Studio>,
    /// Where its objects stand in its script.
    #[serde(skip)]
    pub places: Places,
}

/// One object: a shape, placed, of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// What messages and tables call it.
    pub name: String,
    /// Its form in its own coordinates.
    pub shape: Shape,
    /// Own coordinates to scene coordinates (column vectors: `p' = M p`); affine, not singular.
    pub transform: DMat4,
    /// How its surface reflects. Without one, an operand of a composite has that of the whole that it is part of, a
    /// composite that of its first operand, and others have the default.
    pub material: Option<Material>,
    /// Largest distance between surface and triangles in scene units; without one, that of the [`Settings`].
    pub tolerance: Option<f64>,
}

/// How a scene is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Samples in each pixel; one samples the centre.
    pub samples: u32,
    /// How samples around a pixel become one value.
    pub filter: Filter,
    /// Seed of the sample positions.
    pub seed: u64,
    /// How often a ray may be reflected or refracted.
    pub reflection_depth: u32,
    /// Points of each light that has a size, for each element.
    pub light_samples: u32,
    /// Whether diffuse light is carried on from surface to surface, up to the same depth.
    pub interreflection: bool,
    /// Whether ray tracing reads light that diffuse surfaces send each other from a solution by radiosity.
    pub radiosity: bool,
    /// Error of the light that one pair of patches brings in radiosity, as a part of the mean irradiance, above 0.
    pub patch_error: f64,
    /// Patches are not divided below this length in radiosity, as a part of the diagonal of the scene, above 0.
    pub finest_patch: f64,
    /// Directions in which each patch of radiosity looks around, 1 and more.
    pub patch_directions: u32,
    /// Error of the solver of radiosity, as a part of the greatest irradiance, above 0.
    pub patch_tolerance: f64,
    /// Whether light counts that a mirror or glass throws from a lamp on what is neither. Rays from the eye find it by
    /// chance only: such pictures take very many samples. Without it, too, highlights of lamps are cut off on what is seen
    /// by spread light; light goes through polished bodies as if they did not bend it, and light of a sky that mirrors and
    /// glass throw counts.
    pub caustics: bool,
    /// Whether light is followed from lamps through mirrors and glass and caught where it arrives, so that caustics come
    /// out well: two-way ray tracing.
    pub two_way: bool,
    /// How many ways of light are followed each time.
    pub photons: u32,
    /// The largest radius over which caught light is spread, scene units; without one, a twentieth of the scene's diagonal.
    pub photon_radius: Option<f64>,
    /// Where light is followed from lamps: 2 to this power voxels are along the scene, a point in each stands for the
    /// surface there, and rays meet these points; without a word, they meet the surfaces.
    pub point_depth: Option<u32>,
    /// Whether ray tracing keeps what stands between voxels and lights; the picture is the same without.
    pub light_buffer: bool,
    /// Whether rays carry spectra; without a word, where a material or a light has one.
    pub spectral: Option<bool>,
    /// Whether rays are led on to the exact surfaces behind the triangles that they meet, for position and normal.
    pub exact_surfaces: bool,
    /// How long the shutter is open, in the unit of time of motions.
    pub shutter: f64,
    /// Over how much of what a sample stands for the mean of a texture is taken: 1 is all of it, 0 a point.
    pub texture_filter: f64,
    /// Largest distance between exact surface and triangles, in scene units; without one, a two-thousandth of the
    /// diagonal of each object.
    pub tolerance: Option<f64>,
    /// Largest turn of the normal from vertex to vertex of an exact surface, degrees. Where it is large, interpolated
    /// normals are no longer those of the surface, however close the triangles are.
    pub angle: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            width: 640,
            height: 480,
            samples: 16,
            filter: Filter::Box,
            seed: 1,
            reflection_depth: 6,
            light_samples: 1,
            interreflection: false,
            radiosity: false,
            patch_error: 0.005,
            finest_patch: 1.0 / 200.0,
            patch_directions: 32,
            patch_tolerance: 1e-6,
            caustics: false,
            two_way: false,
            photons: 200_000,
            photon_radius: None,
            point_depth: None,
            light_buffer: true,
            spectral: None,
            exact_surfaces: true,
            shutter: 1.0,
            texture_filter: 1.0,
            tolerance: None,
            angle: 45.0,
        }
    }
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
    /// How an object moves, if it does while the shutter is open.
    pub fn motion(&self, object: usize) -> Option<Motion> {
        let motion = self.motions.iter().find(|(moving, _)| *moving as usize == object).map(|(_, motion)| *motion);
        motion.filter(|_| self.settings.shutter > 0.0)
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
            largest = largest.max(object.chord_error(self.settings.tolerance, self.settings.angle)?);
        }
        Ok(largest)
    }
}

impl Object {
    /// The materials of its surface, each once, and which of them its triangles have; nothing if that is the same for all.
    ///
    /// - `operand_of`: for each triangle of a composite its innermost operand, as [`Made`] tells.
    pub fn materials(&self, operand_of: &[u32]) -> (Vec<Material>, Vec<u32>) {
        let Some((composite, whole)) = self.composite() else {
            return (vec![self.own_material().unwrap_or_default()], Vec::new());
        };
        let mut materials: Vec<Material> = Vec::new();
        let mut number = |material: Material| {
            materials.iter().position(|known| *known == material).unwrap_or_else(|| {
                materials.push(material);
                materials.len() - 1
            }) as u32
        };
        let of_operand: Vec<u32> = composite.materials(whole).into_iter().map(&mut number).collect();
        if materials.len() < 2 {
            return (vec![materials.pop().unwrap_or_default()], Vec::new());
        }
        (materials, operand_of.iter().map(|operand| of_operand[*operand as usize]).collect())
    }

    /// The composite whose operands its triangles come from, and the material of the whole.
    fn composite(&self) -> Option<(&Composite, Option<Material>)> {
        match &self.shape {
            Shape::Composite(composite) => Some((composite, self.material.clone())),
            Shape::Rounded(rounded) => {
                let (composite, inner) = rounded.object.composite()?;
                Some((composite, self.material.clone().or(inner)))
            }
            _ => None,
        }
    }

    fn own_material(&self) -> Option<Material> {
        match &self.shape {
            Shape::Composite(composite) => self.material.clone().or_else(|| composite.first_material()),
            Shape::Rounded(rounded) => self.material.clone().or_else(|| rounded.object.own_material()),
            _ => self.material.clone(),
        }
    }

    /// Checks every number of it.
    ///
    /// - `is_shape_known`: whether its shape was checked before.
    fn check(&self, is_shape_known: bool) -> Result<(), SceneError> {
        let failed = |problem: String| SceneError::Object { object: self.name.clone(), problem };
        if !is_shape_known {
            self.shape.check().map_err(failed)?;
        }
        if !self.transform.is_finite() {
            return Err(failed("its transformation is not finite".into()));
        }
        if self.transform.row(3) != glam::DVec4::W {
            return Err(failed("its transformation is not affine".into()));
        }
        let determinant = self.transform.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return Err(failed("its transformation is singular: it flattens the object".into()));
        }
        if let Some(tolerance) = self.tolerance {
            check_tolerance(tolerance).map_err(failed)?;
        }
        self.material
            .as_ref()
            .map_or(Ok(()), |material| material.check().map_err(|problem| failed(problem.to_string())))
    }
}

impl Settings {
    fn check(&self) -> Result<(), SceneError> {
        let pixels = u64::from(self.width) * u64::from(self.height);
        if pixels == 0 || pixels > crate::picture::MAX_PIXELS {
            let problem = format!("a picture of {} x {} pixels is empty or too large", self.width, self.height);
            return Err(SceneError::Setting(problem));
        }
        if !(1..=MAX_SAMPLES).contains(&self.samples) {
            return Err(SceneError::Setting(format!("{} samples are not within 1 to {MAX_SAMPLES}", self.samples)));
        }
        if !(1..=MAX_SAMPLES).contains(&self.light_samples) {
            let problem = format!("{} points of a light are not within 1 to {MAX_SAMPLES}", self.light_samples);
            return Err(SceneError::Setting(problem));
        }
        if !(1..=MAX_PHOTONS).contains(&self.photons) {
            return Err(SceneError::Setting(format!(
                "{} ways of light are not within 1 to {MAX_PHOTONS}",
                self.photons
            )));
        }
        if self.photon_radius.is_some_and(|radius| !(radius > 0.0 && radius.is_finite())) {
            return Err(SceneError::Setting("the radius of caught light is not a length above 0".into()));
        }
        if self.point_depth.is_some_and(|depth| !(1..=MAX_POINT_DEPTH).contains(&depth)) {
            return Err(SceneError::Setting(format!("a resolution of voxels is not within 1 to {MAX_POINT_DEPTH}")));
        }
        if self.reflection_depth > MAX_REFLECTION_DEPTH {
            return Err(SceneError::Limit { what: "reflections in a chain", limit: u64::from(MAX_REFLECTION_DEPTH) });
        }
        if !(0.0..=1000.0).contains(&self.texture_filter) {
            let problem = format!("texture filter {} is not within 0 to 1000", self.texture_filter);
            return Err(SceneError::Setting(problem));
        }
        if !(self.angle > 0.0 && self.angle <= 180.0) {
            return Err(SceneError::Setting(format!("angle {} is not within 0 to 180 degrees", self.angle)));
        }
        if !(self.shutter >= 0.0 && self.shutter.is_finite()) {
            let problem = format!("a shutter that is open for {} is no shutter", self.shutter);
            return Err(SceneError::Setting(problem));
        }
        self.tolerance.map_or(Ok(()), check_tolerance).map_err(SceneError::Setting)
    }
}

fn check_tolerance(tolerance: f64) -> Result<(), String> {
    if tolerance.is_finite() && tolerance > 0.0 {
        Ok(())
    } else {
        Err(format!("tolerance {tolerance} is not a length above 0"))
    }
}

fn check_power(what: &str, power: Bands) -> Result<(), String> {
    if power.is_finite() && power.min_element() >= 0.0 {
        Ok(())
    } else {
        Err(format!("{what} {power} is negative or not finite"))
    }
}

#[cfg(test)]
mod tests;
