//! Functions of the scene language that light a scene, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::CallResult;
use super::kinds::{Flag, Length, MaterialOrigin, MaterialOriginKind, NumberKind, Powers, TextKind, Vector};
use super::made_of::material_from;
use super::parameter::{Defaulted, Optional, Required, optional, required, with_default};
use crate::color::srgb::LUMINANCE;
use crate::color::{Color, Spectrum, light_of_temperature};
use crate::illumination::Light;
use crate::illumination::light::{Goniometry, LightShape, Panorama, SkyDisc, SkyMap};
use crate::memory;
use crate::scene::{MAX_LIGHTS, MAX_PORTALS, Studio};
use glam::DVec3;
use rhai::Dynamic;
use std::f64::consts::PI;
use std::sync::Arc;

/// The longest file of a luminaire, bytes.
const MAX_GONIOMETRY: u64 = 16 << 20;

/// The spectrum of a light.
pub(super) const SPECTRUM: Optional<TextKind> = optional(
    TextKind,
    "none: red, green and blue",
    "\"D65\", \"A\", \"F11\" and others, \"blackbody 3000\" or \"daylight 5000\" (kelvin); the numbers tell how bright it is",
);

const AT: Required<Vector> = required(Vector, "where it is");
const CORNER: Required<Vector> = required(Vector, "a corner");
const ACROSS: Required<Vector> = required(Vector, "from the corner along one side");
const UP: Required<Vector> = required(Vector, "from the corner along the other side");
const CENTER: Required<Vector> = required(Vector, "its middle");
const RADIUS: Defaulted<Length, f64> = with_default(Length, 1.0, "its radius");
const INTENSITY: Optional<Powers> = optional(Powers, "that of the power", "radiant intensity, W/sr");
const RADIANCE: Optional<Powers> = optional(Powers, "that of the power", "radiance, W/(m² sr)");
const POWER: Optional<Powers> = optional(Powers, "that of the radiance", "radiant power, W");
const MADE_OF: Optional<MaterialOriginKind> = optional(
    MaterialOriginKind,
    "it reflects nothing",
    "what it is made of and so reflects, beside what it emits: a map of what material() takes, an object whose material it has, too, or a name, as stored() takes it",
);

/// How strong a light is: one of the two is given.
struct Strength {
    /// Intensity or radiance, by its name.
    named: &'static str,
    strength: Option<DVec3>,
    power: Option<DVec3>,
    /// The power of one unit of strength.
    flux: f64,
    spectrum: Option<String>,
}

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        point_light(
            at: AT,
            intensity: INTENSITY,
            power: optional(Powers, "4 pi times the intensity", "radiant power, W"),
            spectrum: SPECTRUM,
        )
        "Adds a light that shines alike in all directions; give its intensity or its power."
        "point_light(#{ at: [5, 9, 6], intensity: 150 });"
        |builder| {
            let given = Strength { named: "intensity", strength: intensity, power, flux: 4.0 * PI, spectrum };
            let intensity = given.color(builder)?;
            add(builder, Light::Point { at, intensity })
        }
    },
    function! {
        directional_light(
            direction: required(Vector, "where the light goes"),
            irradiance: with_default(Powers, PI, "of a surface that faces it, W/m²"),
            diameter: with_default(
                NumberKind(0.0, 90.0),
                0.0,
                "of the disc in the sky from which it comes, degrees, 0.53 for the sun: edges of shadows are then as soft as its light makes them",
            ),
            spectrum: SPECTRUM,
        )
        "Adds parallel light from infinitely far away."
        "directional_light(#{ direction: [-1, -2, -1], irradiance: 2 });"
        |builder| {
            if diameter <= 0.0 {
                let irradiance = color_of_light(builder, spectrum.as_deref(), irradiance)?;
                return add(builder, Light::Directional { direction, irradiance });
            }
            let towards = -direction.try_normalize().ok_or("its direction has no length")?;
            let disc = SkyDisc { towards, radius: (0.5 * diameter).to_radians() };
            // A surface that faces the disc is lit by its radiance times the projected solid angle.
            let radiance = irradiance / (PI * disc.radius.sin().powi(2));
            let radiance = color_of_light(builder, spectrum.as_deref(), radiance)?;
            let map = SkyMap { file: "a disc in the sky".into(), panorama: None, disc: Some(disc) };
            add(builder, Light::Sky { map: Some(map), radiance, turned: 0.0 })
        }
    },
    function! {
        spot_light(
            at: AT,
            to: required(Vector, "a point on the axis of the cone"),
            intensity: required(Powers, "radiant intensity on the axis, W/sr"),
            inner: with_default(NumberKind(0.0, 180.0), 15.0, "angle from the axis where it begins to fall, degrees"),
            outer: with_default(NumberKind(0.0, 180.0), 30.0, "angle from the axis where it ends, degrees"),
            spectrum: SPECTRUM,
        )
        "Adds a light that shines in a cone."
        "spot_light(#{ at: [0, 8, 0], to: [0, 0, 0], intensity: 80, inner: 10, outer: 25 });"
        |builder| {
            let intensity = color_of_light(builder, spectrum.as_deref(), intensity)?;
            add(builder, Light::Spot { at, direction: to - at, intensity, inner, outer })
        }
    },
    function! {
        luminaire(
            at: AT,
            file: required(TextKind, "its path; relative to the folder of the script"),
            down: with_default(Vector, [0.0, -1.0, 0.0], "where its vertical angle is 0"),
            front: with_default(Vector, [0.0, 0.0, 1.0], "about where its horizontal angle is 0"),
            factor: with_default(Powers, 1.0, "what its intensities are multiplied with"),
            spectrum: SPECTRUM,
        )
        "Adds a luminaire whose intensities a laboratory measured, from a file of the IES."
        "luminaire(#{ at: [0, 3, 0], file: \"downlight.ies\", factor: 5 });"
        |builder| {
            let path = builder.folders.file(&file)?;
            let text =
                memory::read_text(&path, MAX_GONIOMETRY).map_err(|error| format!("{}: {error}", path.display()))?;
            let goniometry = Goniometry::parse(&text).map_err(|error| format!("{}: {error}", path.display()))?;
            let color = color_of_light(builder, spectrum.as_deref(), factor)?;
            add(builder, Light::Luminaire { at, down, front, goniometry, color })
        }
    },
    function! {
        studio(light: with_default(Flag, true, "whether the window, the soft box and the sky are there"))
        "Shows the objects in a studio as large as they are: on a grey floor that bends up into a wall behind them, beside a window, under a soft box and a pale sky; with a camera if there is none. Pictures have it; tessellate, check and octree leave it out."
        "studio();"
        |builder| {
            builder.scene.studio = Some(if light { Studio::Lit } else { Studio::Bare });
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        rectangle_light(
            corner: CORNER,
            across: ACROSS,
            up: UP,
            radiance: RADIANCE,
            power: POWER,
            spectrum: SPECTRUM,
            material: MADE_OF,
        )
        "Adds a rectangle that shines on one side: where its two sides turn counter-clockwise. With a material it reflects on both sides."
        "rectangle_light(#{ corner: [-1, 5, -1], across: [2, 0, 0], up: [0, 0, 2], power: 60 });"
        |builder| add_area(builder, LightShape::Rectangle { corner, across, up }, [radiance, power], spectrum, material)
    },
    function! {
        disc_light(
            center: CENTER,
            normal: with_default(Vector, [0.0, -1.0, 0.0], "its normal"),
            radius: RADIUS,
            radiance: RADIANCE,
            power: POWER,
            spectrum: SPECTRUM,
            material: MADE_OF,
        )
        "Adds a disc that shines on the side of its normal. With a material it reflects on both sides."
        "disc_light(#{ center: [0, 6, 0], radius: 0.5, power: 40 });"
        |builder| add_area(builder, LightShape::Disc { center, normal, radius }, [radiance, power], spectrum, material)
    },
    function! {
        sphere_light(
            center: CENTER,
            radius: RADIUS,
            radiance: RADIANCE,
            power: POWER,
            spectrum: SPECTRUM,
            material: MADE_OF,
        )
        "Adds a sphere that shines in all directions."
        "sphere_light(#{ center: [3, 5, 2], radius: 0.4, power: 100, spectrum: \"blackbody 2900\", material: #{ diffuse: 0.8 } });"
        |builder| add_area(builder, LightShape::Sphere { center, radius }, [radiance, power], spectrum, material)
    },
    function! {
        sky(
            radiance: with_default(Powers, 1.0, "radiance, W/(m² sr); with a file a factor"),
            file: optional(
                TextKind,
                "none",
                "a picture, .hdr, .exr or .png, over turn and angle from the zenith: its first row is up, its last down, its middle ahead (-z)",
            ),
            turned: with_default(NumberKind(-1e6, 1e6), 0.0, "degrees about the upright axis"),
            spectrum: SPECTRUM,
        )
        "Surrounds the scene with light: the same from everywhere, or a picture over latitude and longitude."
        "sky(#{ radiance: [0.4, 0.5, 0.7] });"
        |builder| {
            let map = match file {
                None => None,
                Some(file) => {
                    let path = builder.folders.file(&file)?;
                    let panorama = Panorama::read(&path).map_err(|error| error.to_string())?;
                    Some(SkyMap { file, panorama: Some(Arc::new(panorama)), ..SkyMap::default() })
                }
            };
            let radiance = color_of_light(builder, spectrum.as_deref(), radiance)?;
            add(builder, Light::Sky { map, radiance, turned })
        }
    },
    function! {
        portal(corner: CORNER, across: ACROSS, up: UP)
        "Tells of an opening through which light comes into a room, a rectangle whose sides turn counter-clockwise seen from within: rays look for the sky there, radiosity for all light, and pictures of the room have less noise and error. It has no light of its own."
        "portal(#{ corner: [3, 1, -1], across: [0, 0, 2], up: [0, 1.5, 0] });"
        |builder| {
            if builder.scene.portals.len() >= MAX_PORTALS {
                return Err(format!("more than {MAX_PORTALS} portals"));
            }
            let portal = LightShape::Rectangle { corner, across, up };
            portal.check().map_err(|error| error.to_string())?;
            builder.scene.portals.push(portal);
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        ambient(radiance: required(Powers, "its radiance, W/(m² sr)"))
        "Sets the ambient light, which reaches every surface from everywhere."
        "ambient(0.05);"
        |builder| {
            builder.scene.ambient = radiance;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        background(radiance: required(Powers, "its radiance, W/(m² sr); 1 shows as white"))
        "Sets what is seen where there is nothing."
        "background([0.2, 0.3, 0.5]);"
        |builder| {
            builder.scene.background = radiance;
            Ok(Dynamic::UNIT)
        }
    },
];

impl Strength {
    /// The light of one unit, as bright as was given.
    fn color(&self, builder: &Builder) -> Result<Color, String> {
        let bands = match (self.strength, self.power) {
            (Some(strength), None) => strength,
            (None, Some(power)) => power / self.flux,
            _ => return Err(format!("give either its {} or its power", self.named)),
        };
        color_of_light(builder, self.spectrum.as_deref(), bands)
    }
}

/// Adds a surface that shines.
fn add_area(
    builder: &mut Builder,
    patch: LightShape,
    given: [Option<DVec3>; 2],
    spectrum: Option<String>,
    material: Option<MaterialOrigin>,
) -> CallResult {
    let [strength, power] = given;
    // A surface of radiance 1 emits pi on each unit of area.
    let flux = PI * patch.area().max(f64::MIN_POSITIVE);
    let radiance = Strength { named: "radiance", strength, power, flux, spectrum }.color(builder)?;
    let light = match material {
        Some(material) => Light::Lamp { patch, radiance, material: Box::new(material_from(builder, material)?) },
        None => Light::Area { patch, radiance },
    };
    add(builder, light)
}

/// Bands as a light, with a spectrum if one is given.
pub(super) fn color_of_light(builder: &Builder, spectrum: Option<&str>, bands: DVec3) -> Result<Color, String> {
    let Some(name) = spectrum else { return Ok(Color::Bands(bands)) };
    let color = Color::light_of(&spectrum_named(builder, name)?, bands.dot(LUMINANCE));
    color.ok_or_else(|| format!("the spectrum {name} cannot be seen"))
}

/// A spectrum of light by its name.
pub(super) fn spectrum_named(builder: &Builder, name: &str) -> Result<Spectrum, String> {
    match light_of_temperature(name) {
        Some(spectrum) => spectrum.map_err(|error| error.to_string()),
        None => builder.databases.library.light(name).map_err(|error| error.to_string()),
    }
}

/// Adds a light that was checked.
pub(super) fn add(builder: &mut Builder, light: Light) -> CallResult {
    if builder.scene.lights.len() >= MAX_LIGHTS {
        return Err(format!("more than {MAX_LIGHTS} lights"));
    }
    light.check().map_err(|error| error.to_string())?;
    builder.scene.lights.push(light);
    Ok(Dynamic::UNIT)
}
