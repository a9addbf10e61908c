//! How a scene is rendered: a part for each stage and each renderer.

use super::SceneError;
use crate::illumination::optics::Interreflection;
use crate::octree::MAX_POINT_DEPTH;
use crate::picture::Filter;
use serde::{Deserialize, Serialize};

/// Most samples in a pixel.
pub const MAX_SAMPLES: u32 = 65_536;
/// Most photons that are traced at a time: stored, they take up to 1.2 GB.
pub const MAX_PHOTONS: u32 = 16_000_000;
/// Most pixels that the detail has which models leave out, and where aggregates begin.
pub const MOST_DETAIL: f64 = 256.0;
/// Deepest chain of reflections.
pub const MAX_REFLECTION_DEPTH: u32 = 1_000;

/// How a scene is rendered. Only `geometry` and [`Settings::copies_instances`] decide what a scene becomes when it is
/// prepared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Pictures and their samples.
    pub image: ImageSettings,
    /// Triangles, exact surfaces, motion.
    pub geometry: GeometrySettings,
    /// What of light counts, and how closely it is looked at.
    pub light: LightSettings,
    /// Solutions by radiosity.
    pub radiosity: RadiositySettings,
    /// Photons that are traced from lamps.
    pub photons: PhotonSettings,
}

/// Pictures and their samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ImageSettings {
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Samples in each pixel; one samples the centre.
    pub samples: u32,
    /// How samples around a pixel become one value.
    pub filter: Filter,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// What geometry a scene becomes, and how long the shutter sees it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GeometrySettings {
    /// Largest distance between exact surface and triangles, in scene units; without one, a two-thousandth of the
    /// diagonal of each object.
    pub tolerance: Option<f64>,
    /// Largest turn of the normal from vertex to vertex of an exact surface, degrees. Where it is large, interpolated
    /// normals are no longer those of the surface, however close the triangles are.
    pub angle: f64,
    /// Whether rays are led on to the exact surfaces behind the triangles that they meet, for position and normal.
    pub exact_surfaces: bool,
    /// How long the shutter is open, in the unit of time of motions.
    pub shutter: f64,
    /// How many pixels small the detail is that procedural models may leave out, 1/256 to 256: 1 is what a pixel spans.
    pub detail: f64,
    /// How many pixels the largest of what is scattered in cells spans where aggregates begin to stand in for all,
    /// 1/256 to 256 or 0 for nowhere, instead of what each scattering tells itself.
    pub aggregate: Option<f64>,
    /// Whether instances become objects of their own, for renderers that go through triangles one by one.
    pub copies_instances: bool,
}

/// What of light counts, and how closely it is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightSettings {
    /// How often a ray may be reflected or refracted.
    pub reflection_depth: u32,
    /// Points of each light that has a size, for each element.
    pub samples: u32,
    /// What becomes of light that goes from one diffuse surface to another.
    pub interreflection: Interreflection,
    /// What becomes of light that mirrors and glass throw from lamps.
    pub caustics: Caustics,
    /// Whether rays carry spectra; without a word, where a material or a light has one.
    pub spectral: Option<bool>,
    /// Over how much of what a sample stands for the mean of a texture is taken: 1 is all of it, 0 a point.
    pub texture_filter: f64,
    /// Whether ray tracing keeps what stands between voxels and lights; the picture is the same without.
    pub buffer: bool,
}

/// What becomes of light that a mirror or glass throws from a lamp on what is neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Caustics {
    /// It counts nothing. Highlights of lamps, too, are cut off on what is seen by spread light; light goes through
    /// polished bodies as if they did not bend it, and light of a sky that mirrors and glass throw counts.
    #[default]
    LeftOut,
    /// Rays from the eye find it by chance only: such pictures take very many samples.
    PathTraced,
    /// It is traced from lamps and stored as photons where it arrives: two-way ray tracing.
    PhotonMapped,
}

/// How good a solution by radiosity is to be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RadiositySettings {
    /// Error of the light that one link between patches brings, as a part of the mean irradiance, above 0.
    pub error: f64,
    /// Patches are not divided below this length, as a part of the diagonal of the scene, above 0.
    pub finest: f64,
    /// Patches are not divided below so many pixels of a picture that shows them, 0 and more; it counts where that is more
    /// than [`finest`](RadiositySettings::finest). By 0, pictures count nothing: not their pixels, nor what they show and
    /// how bright that is, and light is the same for all views and pictures of any size.
    pub pixels: f64,
    /// Directions in which each patch looks around at the least, 1 and more.
    pub directions: u32,
    /// Error of the solver, as a part of the greatest irradiance, above 0.
    pub tolerance: f64,
}

/// Photons that are traced from lamps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PhotonSettings {
    /// How many are traced each time.
    pub count: u32,
    /// The largest radius over which a photon is spread, scene units; without one, a twentieth of the scene's diagonal.
    pub radius: Option<f64>,
    /// Where photons are traced from lamps: 2 to this power voxels are along the scene, a point in each stands for the
    /// surface there, and rays meet these points; without a word, they meet the surfaces.
    pub point_depth: Option<u32>,
}

impl Default for ImageSettings {
    fn default() -> ImageSettings {
        ImageSettings { width: 640, height: 480, samples: 16, filter: Filter::Box, seed: 1 }
    }
}

impl Default for GeometrySettings {
    fn default() -> GeometrySettings {
        GeometrySettings::DEFAULT
    }
}

impl Default for LightSettings {
    fn default() -> LightSettings {
        LightSettings {
            reflection_depth: 6,
            samples: 1,
            interreflection: Interreflection::LeftOut,
            caustics: Caustics::LeftOut,
            spectral: None,
            texture_filter: 1.0,
            buffer: true,
        }
    }
}

impl Default for RadiositySettings {
    fn default() -> RadiositySettings {
        RadiositySettings::DEFAULT
    }
}

impl Default for PhotonSettings {
    fn default() -> PhotonSettings {
        PhotonSettings::DEFAULT
    }
}

impl Settings {
    /// Settings for pictures of some columns and rows, all else as it is without a word.
    pub fn of_size(width: u32, height: u32, samples: u32) -> Settings {
        let image = ImageSettings { width, height, samples, ..ImageSettings::default() };
        Settings { image, ..Settings::default() }
    }

    /// Whether a scene is prepared with its instances as objects of their own: also where light is solved for or stored
    /// by triangles.
    pub fn copies_instances(&self) -> bool {
        let by_triangles = self.light.interreflection == Interreflection::Solved;
        self.geometry.copies_instances || by_triangles || self.light.caustics == Caustics::PhotonMapped
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`SceneError`], for the first that is out of range.
    pub(super) fn check(&self) -> Result<(), SceneError> {
        let Settings { image, geometry, light, radiosity, photons } = self;
        image.check().map_err(SceneError::Setting)?;
        if light.reflection_depth > MAX_REFLECTION_DEPTH {
            return Err(SceneError::Limit { what: "reflections in a chain", limit: u64::from(MAX_REFLECTION_DEPTH) });
        }
        light.check().map_err(SceneError::Setting)?;
        radiosity.check().map_err(SceneError::Setting)?;
        photons.check().map_err(SceneError::Setting)?;
        geometry.check().map_err(SceneError::Setting)
    }
}

impl ImageSettings {
    fn check(&self) -> Result<(), String> {
        let pixels = u64::from(self.width) * u64::from(self.height);
        if pixels == 0 || pixels > crate::picture::MAX_PIXELS {
            return Err(format!("a picture of {} x {} pixels is empty or too large", self.width, self.height));
        }
        within("samples", self.samples, MAX_SAMPLES)
    }
}

impl GeometrySettings {
    /// What holds without a word.
    pub const DEFAULT: GeometrySettings = GeometrySettings {
        tolerance: None,
        angle: 45.0,
        exact_surfaces: true,
        shutter: 1.0,
        detail: 1.0,
        aggregate: None,
        copies_instances: false,
    };

    fn check(&self) -> Result<(), String> {
        if !(self.angle > 0.0 && self.angle <= 180.0) {
            return Err(format!("angle {} is not within 0 to 180 degrees", self.angle));
        }
        if !(self.shutter >= 0.0 && self.shutter.is_finite()) {
            return Err(format!("a shutter that is open for {} is no shutter", self.shutter));
        }
        if !(1.0 / MOST_DETAIL..=MOST_DETAIL).contains(&self.detail) {
            return Err(format!("detail of {} pixels is not within 1/{MOST_DETAIL} to {MOST_DETAIL}", self.detail));
        }
        self.aggregate.filter(|pixels| *pixels != 0.0).map_or(Ok(()), check_aggregate)?;
        self.tolerance.map_or(Ok(()), check_tolerance)
    }
}

/// Checks how many pixels the largest of what is scattered spans where aggregates begin; the problem in words.
pub(super) fn check_aggregate(pixels: f64) -> Result<(), String> {
    match (1.0 / MOST_DETAIL..=MOST_DETAIL).contains(&pixels) {
        true => Ok(()),
        false => Err(format!("aggregates from {pixels} pixels on are not within 1/{MOST_DETAIL} to {MOST_DETAIL}")),
    }
}

impl LightSettings {
    fn check(&self) -> Result<(), String> {
        if !(0.0..=1000.0).contains(&self.texture_filter) {
            return Err(format!("texture filter {} is not within 0 to 1000", self.texture_filter));
        }
        within("points of a light", self.samples, MAX_SAMPLES)
    }
}

impl RadiositySettings {
    /// What holds without a word.
    pub const DEFAULT: RadiositySettings =
        RadiositySettings { error: 0.005, finest: 1.0 / 200.0, pixels: 0.5, directions: 32, tolerance: 1e-6 };

    fn check(&self) -> Result<(), String> {
        let is_part = |part: f64| part > 0.0 && part.is_finite();
        if !(self.pixels >= 0.0 && self.pixels.is_finite()) {
            return Err(format!("elements of {} pixels in radiosity", self.pixels));
        }
        match is_part(self.error) && is_part(self.finest) && is_part(self.tolerance) && self.directions > 0 {
            true => Ok(()),
            false => Err("a setting of radiosity is not above 0, or not finite".into()),
        }
    }
}

impl PhotonSettings {
    /// What holds without a word.
    pub const DEFAULT: PhotonSettings = PhotonSettings { count: 200_000, radius: None, point_depth: None };

    fn check(&self) -> Result<(), String> {
        if self.radius.is_some_and(|radius| !(radius > 0.0 && radius.is_finite())) {
            return Err("the radius over which photons are spread is not a length above 0".into());
        }
        if self.point_depth.is_some_and(|depth| !(1..=MAX_POINT_DEPTH).contains(&depth)) {
            return Err(format!("a resolution of voxels is not within 1 to {MAX_POINT_DEPTH}"));
        }
        within("photons", self.count, MAX_PHOTONS)
    }
}

fn within(what: &str, number: u32, limit: u32) -> Result<(), String> {
    match (1..=limit).contains(&number) {
        true => Ok(()),
        false => Err(format!("{number} {what} are not within 1 to {limit}")),
    }
}

/// An error unless it is a length above 0.
pub(super) fn check_tolerance(tolerance: f64) -> Result<(), String> {
    if tolerance.is_finite() && tolerance > 0.0 {
        Ok(())
    } else {
        Err(format!("tolerance {tolerance} is not a length above 0"))
    }
}
