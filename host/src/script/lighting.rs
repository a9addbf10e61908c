//! Functions of the scene language that light a scene, one row each.

use super::argument::Bound;
use super::builder::Builder;
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, Parameter, parameter};
use crate::color::srgb::LUMINANCE;
use crate::color::{Color, Spectrum, light_of_temperature};
use crate::illumination::Light;
use crate::illumination::light::{Goniometry, Panorama, Patch, SkyDisc, SkyMap};
use crate::memory;
use crate::scene::{MAX_LIGHTS, MAX_PORTALS, Studio};
use glam::DVec3;
use rhai::Dynamic;
use std::f64::consts::PI;
use std::sync::Arc;

/// The longest file of a luminaire, bytes.
const MAX_GONIOMETRY: u64 = 16 << 20;

/// The spectrum of a light.
pub(super) const SPECTRUM: Parameter = parameter(
    "spectrum",
    Kind::Text,
    Is("none: red, green and blue"),
    "\"D65\", \"A\", \"F11\" and others, \"blackbody 3000\" or \"daylight 5000\" (kelvin); the numbers tell how bright it is",
);

const AT: Parameter = parameter("at", Kind::Vector, Required, "where it is");
const CORNER: Parameter = parameter("corner", Kind::Vector, Required, "a corner");
const ACROSS: Parameter = parameter("across", Kind::Vector, Required, "from the corner along one side");
const UP: Parameter = parameter("up", Kind::Vector, Required, "from the corner along the other side");
const INTENSITY: Parameter = parameter("intensity", Kind::Powers, Is("that of the power"), "radiant intensity, W/sr");
const RADIANCE: Parameter = parameter("radiance", Kind::Powers, Is("that of the power"), "radiance, W/(m² sr)");
const POWER: Parameter = parameter("power", Kind::Powers, Is("that of the radiance"), "radiant power, W");

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "point_light",
        summary: "Adds a light that shines alike in all directions; give its intensity or its power.",
        parameters: &[
            AT,
            INTENSITY,
            parameter("power", Kind::Powers, Is("4 pi times the intensity"), "radiant power, W"),
            SPECTRUM,
        ],
        example: "point_light(#{ at: [5, 9, 6], intensity: 150 });",
        action: |builder, bound| {
            let at = bound.vector("at").unwrap_or_default();
            let intensity = either(builder, bound, "intensity", 4.0 * PI)?;
            add(builder, Light::Point { at, intensity })
        },
    },
    Function {
        name: "directional_light",
        summary: "Adds parallel light from infinitely far away.",
        parameters: &[
            parameter("direction", Kind::Vector, Required, "where the light goes"),
            parameter("irradiance", Kind::Powers, Is("pi"), "of a surface that faces it, W/m²"),
            parameter(
                "diameter",
                Kind::Number(0.0, 90.0),
                Is("0"),
                "of the disc in the sky from which it comes, degrees, 0.53 for the sun: edges of shadows are then as soft as its light makes them",
            ),
            SPECTRUM,
        ],
        example: "directional_light(#{ direction: [-1, -2, -1], irradiance: 2 });",
        action: directional_light,
    },
    Function {
        name: "spot_light",
        summary: "Adds a light that shines in a cone.",
        parameters: &[
            AT,
            parameter("to", Kind::Vector, Required, "a point on the axis of the cone"),
            parameter("intensity", Kind::Powers, Required, "radiant intensity on the axis, W/sr"),
            parameter(
                "inner",
                Kind::Number(0.0, 180.0),
                Is("15"),
                "angle from the axis where it begins to fall, degrees",
            ),
            parameter("outer", Kind::Number(0.0, 180.0), Is("30"), "angle from the axis where it ends, degrees"),
            SPECTRUM,
        ],
        example: "spot_light(#{ at: [0, 8, 0], to: [0, 0, 0], intensity: 80, inner: 10, outer: 25 });",
        action: |builder, bound| {
            let at = bound.vector("at").unwrap_or_default();
            let intensity = color_of_light(builder, bound, bound.vector("intensity").unwrap_or_default())?;
            let (inner, outer) = (bound.number("inner").unwrap_or(15.0), bound.number("outer").unwrap_or(30.0));
            let direction = bound.vector("to").unwrap_or_default() - at;
            add(builder, Light::Spot { at, direction, intensity, inner, outer })
        },
    },
    Function {
        name: "luminaire",
        summary: "Adds a luminaire whose intensities a laboratory measured, from a file of the IES.",
        parameters: &[
            AT,
            parameter("file", Kind::Text, Required, "its path; relative to the folder of the script"),
            parameter("down", Kind::Vector, Is("[0, -1, 0]"), "where its vertical angle is 0"),
            parameter("front", Kind::Vector, Is("[0, 0, 1]"), "about where its horizontal angle is 0"),
            parameter("factor", Kind::Powers, Is("1"), "what its intensities are multiplied with"),
            SPECTRUM,
        ],
        example: "luminaire(#{ at: [0, 3, 0], file: \"downlight.ies\", factor: 5 });",
        action: |builder, bound| {
            let path = builder.folders.file(bound.text("file").unwrap_or_default())?;
            let text =
                memory::read_text(&path, MAX_GONIOMETRY).map_err(|error| format!("{}: {error}", path.display()))?;
            let goniometry = Goniometry::parse(&text).map_err(|error| format!("{}: {error}", path.display()))?;
            let vector = |name, default| bound.vector(name).unwrap_or(default);
            let color = color_of_light(builder, bound, vector("factor", DVec3::ONE))?;
            let (down, front) = (vector("down", DVec3::NEG_Y), vector("front", DVec3::Z));
            add(builder, Light::Luminaire { at: vector("at", DVec3::ZERO), down, front, goniometry, color })
        },
    },
    Function {
        name: "studio",
        summary: "Shows the objects in a studio as large as they are: on a grey floor that bends up into a wall behind them, beside a window, under a soft box and a pale sky; with a camera if there is none. Pictures have it; tessellate, check and octree leave it out.",
        parameters: &[parameter(
            "light",
            Kind::Flag,
            Is("true"),
            "whether the window, the soft box and the sky are there",
        )],
        example: "studio();",
        action: |builder, bound| {
            let is_lit = bound.flag("light").unwrap_or(true);
            builder.scene.studio = Some(if is_lit { Studio::Lit } else { Studio::Bare });
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "rectangle_light",
        summary: "Adds a rectangle that shines on one side: where its two sides turn counter-clockwise.",
        parameters: &[CORNER, ACROSS, UP, RADIANCE, POWER, SPECTRUM],
        example: "rectangle_light(#{ corner: [-1, 5, -1], across: [2, 0, 0], up: [0, 0, 2], power: 60 });",
        action: |builder, bound| add_area(builder, bound, rectangle(bound)),
    },
    Function {
        name: "disc_light",
        summary: "Adds a disc that shines on the side of its normal.",
        parameters: &[
            parameter("center", Kind::Vector, Required, "its middle"),
            parameter("normal", Kind::Vector, Is("[0, -1, 0]"), "its normal"),
            parameter("radius", Kind::Length, Is("1"), "its radius"),
            RADIANCE,
            POWER,
            SPECTRUM,
        ],
        example: "disc_light(#{ center: [0, 6, 0], radius: 0.5, power: 40 });",
        action: |builder, bound| {
            let center = bound.vector("center").unwrap_or_default();
            let normal = bound.vector("normal").unwrap_or(DVec3::NEG_Y);
            add_area(builder, bound, Patch::Disc { center, normal, radius: bound.number("radius").unwrap_or(1.0) })
        },
    },
    Function {
        name: "sphere_light",
        summary: "Adds a sphere that shines in all directions.",
        parameters: &[
            parameter("center", Kind::Vector, Required, "its middle"),
            parameter("radius", Kind::Length, Is("1"), "its radius"),
            RADIANCE,
            POWER,
            SPECTRUM,
        ],
        example: "sphere_light(#{ center: [3, 5, 2], radius: 0.4, power: 100, spectrum: \"blackbody 2900\" });",
        action: |builder, bound| {
            let center = bound.vector("center").unwrap_or_default();
            add_area(builder, bound, Patch::Sphere { center, radius: bound.number("radius").unwrap_or(1.0) })
        },
    },
    Function {
        name: "sky",
        summary: "Surrounds the scene with light: the same from everywhere, or a picture over latitude and longitude.",
        parameters: &[
            parameter("radiance", Kind::Powers, Is("1"), "radiance, W/(m² sr); with a file a factor"),
            parameter(
                "file",
                Kind::Text,
                Is("none"),
                "a picture, .hdr, .exr or .png, over turn and angle from the zenith: its first row is up, its last down, its middle ahead (-z)",
            ),
            parameter("turned", Kind::Number(-1e6, 1e6), Is("0"), "degrees about the upright axis"),
            SPECTRUM,
        ],
        example: "sky(#{ radiance: [0.4, 0.5, 0.7] });",
        action: |builder, bound| {
            let map = match bound.text("file") {
                None => None,
                Some(file) => {
                    let path = builder.folders.file(file)?;
                    let panorama = Panorama::read(&path).map_err(|error| error.to_string())?;
                    Some(SkyMap { file: file.to_owned(), panorama: Some(Arc::new(panorama)), ..SkyMap::default() })
                }
            };
            let radiance = color_of_light(builder, bound, bound.vector("radiance").unwrap_or(DVec3::ONE))?;
            add(builder, Light::Sky { map, radiance, turned: bound.number("turned").unwrap_or(0.0) })
        },
    },
    Function {
        name: "portal",
        summary: "Tells of an opening through which the light of the sky comes into a room, a rectangle whose sides turn counter-clockwise seen from within: rays look for the sky there, and pictures of the room have less noise. It has no light of its own.",
        parameters: &[CORNER, ACROSS, UP],
        example: "portal(#{ corner: [3, 1, -1], across: [0, 0, 2], up: [0, 1.5, 0] });",
        action: |builder, bound| {
            if builder.scene.portals.len() >= MAX_PORTALS {
                return Err(format!("more than {MAX_PORTALS} portals"));
            }
            let portal = rectangle(bound);
            portal.check().map_err(|error| error.to_string())?;
            builder.scene.portals.push(portal);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "ambient",
        summary: "Sets the ambient light, which reaches every surface from everywhere.",
        parameters: &[parameter("radiance", Kind::Powers, Required, "its radiance, W/(m² sr)")],
        example: "ambient(0.05);",
        action: |builder, bound| {
            builder.scene.ambient = bound.vector("radiance").unwrap_or_default();
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "background",
        summary: "Sets what is seen where there is nothing.",
        parameters: &[parameter("radiance", Kind::Powers, Required, "its radiance, W/(m² sr); 1 shows as white")],
        example: "background([0.2, 0.3, 0.5]);",
        action: |builder, bound| {
            builder.scene.background = bound.vector("radiance").unwrap_or_default();
            Ok(Dynamic::UNIT)
        },
    },
];

/// The rectangle of a corner and two sides.
fn rectangle(bound: &Bound) -> Patch {
    let vector = |name: &str| bound.vector(name).unwrap_or_default();
    Patch::Rectangle { corner: vector("corner"), across: vector("across"), up: vector("up") }
}

fn directional_light(builder: &mut Builder, bound: &Bound) -> Done {
    let direction = bound.vector("direction").unwrap_or_default();
    let irradiance = bound.vector("irradiance").unwrap_or(DVec3::splat(PI));
    let radius = (0.5 * bound.number("diameter").unwrap_or(0.0)).to_radians();
    if radius <= 0.0 {
        let irradiance = color_of_light(builder, bound, irradiance)?;
        return add(builder, Light::Directional { direction, irradiance });
    }
    let towards = -direction.try_normalize().ok_or("its direction has no length")?;
    let disc = SkyDisc { towards, radius };
    // A surface that faces the disc is lit by its radiance times the projected solid angle.
    let radiance = color_of_light(builder, bound, irradiance / (PI * radius.sin().powi(2)))?;
    let map = SkyMap { file: "a disc in the sky".into(), panorama: None, disc: Some(disc) };
    add(builder, Light::Sky { map: Some(map), radiance, turned: 0.0 })
}

/// The strength of a light that is given, or its power over what one unit of strength emits.
fn either(builder: &Builder, bound: &Bound, strength: &str, flux: f64) -> Result<Color, String> {
    let bands = match (bound.vector(strength), bound.vector("power")) {
        (Some(strength), None) => strength,
        (None, Some(power)) => power / flux,
        _ => return Err(format!("give either its {strength} or its power")),
    };
    color_of_light(builder, bound, bands)
}

fn add_area(builder: &mut Builder, bound: &Bound, patch: Patch) -> Done {
    // A surface of radiance 1 emits pi on each unit of area.
    let radiance = either(builder, bound, "radiance", PI * patch.area().max(f64::MIN_POSITIVE))?;
    add(builder, Light::Area { patch, radiance })
}

/// Bands as a light, with a spectrum if one is given.
pub(super) fn color_of_light(builder: &Builder, bound: &Bound, bands: DVec3) -> Result<Color, String> {
    let Some(name) = bound.text("spectrum") else { return Ok(Color::Bands(bands)) };
    let spectrum = spectrum(builder, name)?;
    let color = Color::light_of(&spectrum, bands.dot(LUMINANCE));
    color.ok_or_else(|| format!("the spectrum {name} cannot be seen"))
}

/// A spectrum of light by its name.
pub(super) fn spectrum(builder: &Builder, name: &str) -> Result<Spectrum, String> {
    match light_of_temperature(name) {
        Some(spectrum) => spectrum.map_err(|error| error.to_string()),
        None => builder.library.light(name).map_err(|error| error.to_string()),
    }
}

/// Adds a light that was checked.
pub(super) fn add(builder: &mut Builder, light: Light) -> Done {
    if builder.scene.lights.len() >= MAX_LIGHTS {
        return Err(format!("more than {MAX_LIGHTS} lights"));
    }
    light.check().map_err(|error| error.to_string())?;
    builder.scene.lights.push(light);
    Ok(Dynamic::UNIT)
}
