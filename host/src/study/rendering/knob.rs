//! The knobs of the renderers: one row each, from which the sweep, the help and the tables are derived.

use super::setup::{Setup, StudiedScene};
use crate::illumination::Light;
use crate::illumination::optics::Interreflection;
use crate::octree::MAX_POINT_DEPTH;
use crate::plan::Stage;
use crate::render::two_way::greatest_gather_radius;
use crate::render::{RendererRow, Technique};
use crate::scene::{Caustics, MAX_PHOTONS};

/// The coarsest tolerance, as a part of the diagonal of the largest curved object, and how much finer the next one is.
const COARSEST: f64 = 1.0 / 60.0;
const TOLERANCE_STEP: f64 = 4.0;
/// The greatest relative error that is asked for, and the widest filter of textures.
const LARGEST_ERROR: f64 = 0.5;
const WIDEST_FILTER: f64 = 2.0;
/// The largest turn of normals, degrees.
const LARGEST_ANGLE: f64 = 90.0;
/// The coarsest detail that is tried, pixels.
const COARSEST_DETAIL: f64 = 16.0;
/// The most pixels at which aggregates begin that are tried.
const COARSEST_AGGREGATE: f64 = 2.0;
/// Depths that are tried; the reference has twice the last one.
const DEPTHS: [f64; 10] = [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 32.0];
/// Points of lights that the reference of scan line has for each of the finest setting.
const MORE_POINTS: f64 = 2.0;

/// The coarsest patches that are tried, and those of the reference, as parts of what the scene asks for.
const COARSEST_PATCHES: f64 = 4.0;
const BEST_PATCHES: f64 = 0.5;

/// How many more photons are traced from one setting to the next, and how much smaller their largest disc is.
const PHOTON_STEP: f64 = 4.0;
const RADIUS_STEP: f64 = 2.0;
/// The least resolution of voxels with points that is tried.
const COARSEST_VOXELS: i32 = 6;

const ALL: fn(&RendererRow) -> bool = |renderer| renderer.is_studied;
const RAYS: fn(&RendererRow) -> bool = |renderer| renderer.is_studied && renderer.adds_samples;
/// Rays from the eye alone.
const EYE: fn(&RendererRow) -> bool = |renderer| RAYS(renderer) && !renderer.always_maps_photons;
const LAMPS: fn(&RendererRow) -> bool = |renderer| renderer.is_studied && renderer.always_maps_photons;

/// A quality setting of a renderer.
pub struct RenderKnob {
    /// Its name, as the command line, scripts or both call it.
    pub name: &'static str,
    /// What it sets, with its unit.
    pub sets: &'static str,
    /// Whether a renderer has it.
    pub renderers: fn(&RendererRow) -> bool,
    /// Whether it says which light counts, and not how well that is found: a reference is then only as good as the
    /// scene asks for, unless this knob is what is studied.
    pub is_model: bool,
    /// Whether the triangles depend on it: the run time includes their making.
    pub remodels: bool,
    /// The reason for which it changes nothing in a scene, where that is so.
    pub(super) idle: fn(&StudiedScene) -> Option<&'static str>,
    /// Settings to try, from the coarsest to the finest.
    pub(super) values: fn(&StudiedScene) -> Vec<f64>,
    /// The setting of a reference.
    pub(super) best: fn(&StudiedScene, Technique) -> f64,
    /// How it is set.
    pub(super) get: fn(&Setup) -> f64,
    /// Sets it.
    pub(super) set: fn(&mut Setup, f64),
}

/// The knobs of the renderers.
///
/// Two are missing that one might look for: rays always carry eight wavelengths of 512, or three bands, and the octree
/// of the renderer has one leaf size and depth, which change no hit (`peris study octree`, `peris study depth`).
///
/// Nor have the passes of two-way ray tracing a knob of their own: samples are passes. For each eight of them photons
/// are traced anew and spread over smaller discs, so that both noise and bias fall to nothing with samples alone; more
/// photons make discs smaller at once, and a smaller largest disc counts where little light is.
pub const RENDER_KNOBS: &[RenderKnob] = &[
    RenderKnob {
        name: "samples",
        sets: "samples in each pixel",
        renderers: ALL,
        is_model: false,
        remodels: false,
        idle: |_| None,
        values: |base| doubled(base).filter(|n| *n <= f64::from(base.options.samples / 4).max(1.0)).collect(),
        best: |base, _| f64::from(base.options.samples / 2).max(2.0),
        get: |setup| f64::from(setup.settings.image.samples),
        set: |setup, value| setup.settings.image.samples = value as u32,
    },
    RenderKnob {
        name: "error",
        sets: "relative error of the luminance at which a pixel has samples enough, of half as many as the reference has at the most",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: |_| None,
        values: |base| halved(base, LARGEST_ERROR).collect(),
        best: |_, _| 0.0,
        get: |setup| setup.target.unwrap_or(0.0),
        set: |setup, value| setup.target = (value > 0.0).then_some(value),
    },
    RenderKnob {
        name: "denoise",
        sets: "whether pictures are denoised (1) or not (0); the reference never is",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: |base| {
            (base.settings().image.samples < 2)
                .then_some("the scene has one sample in each pixel, and a denoiser needs two")
        },
        values: |_| vec![0.0, 1.0],
        best: |_, _| 0.0,
        get: |setup| f64::from(u8::from(setup.denoise)),
        set: |setup, value| setup.denoise = value > 0.0,
    },
    RenderKnob {
        name: "depth",
        sets: "how often a ray may be reflected or refracted",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: |base| base.lacks(Stage::Reflection, "nothing in the scene reflects, refracts or carries light on"),
        values: |base| DEPTHS.into_iter().take(base.options.settings as usize + 1).collect(),
        best: |base, _| {
            let last = DEPTHS[(base.options.settings as usize).min(DEPTHS.len() - 1)];
            f64::max(2.0 * last, f64::from(base.settings().light.reflection_depth))
        },
        get: |setup| f64::from(setup.settings.light.reflection_depth),
        set: |setup, value| setup.settings.light.reflection_depth = value as u32,
    },
    RenderKnob {
        name: "light_samples",
        sets: "points of each light that has a size, for each element",
        renderers: ALL,
        is_model: false,
        remodels: false,
        idle: |base| (!has_spread_light(base)).then_some("no light of the scene has a size"),
        values: |base| doubled(base).take(6).collect(),
        best: |base, technique| {
            let own = f64::from(base.settings().light.samples);
            match technique.row().adds_samples {
                // Every sample of a pixel draws points of its own: their number makes no difference in the end.
                true => own,
                false => doubled(base).take(6).fold(own, f64::max) * MORE_POINTS,
            }
        },
        get: |setup| f64::from(setup.settings.light.samples),
        set: |setup, value| setup.settings.light.samples = value as u32,
    },
    RenderKnob {
        name: "texture_filter",
        sets: "over how much of what a sample stands for the mean of a texture is taken; 0 is a point",
        renderers: ALL,
        is_model: false,
        remodels: false,
        idle: |base| base.lacks(Stage::Textures, "no material changes from place to place"),
        values: |base| halved(base, WIDEST_FILTER).take(base.options.settings as usize - 1).chain([0.0]).collect(),
        // Scan line finds light once for a pixel: there, a point instead of the mean is no better.
        best: |_, technique| if technique.row().adds_samples { 0.0 } else { 1.0 },
        get: |setup| setup.settings.light.texture_filter,
        set: |setup, value| setup.settings.light.texture_filter = value,
    },
    RenderKnob {
        name: "tolerance",
        sets: "distance between exact surface and triangles, scene units; 0 stands for a part of each object's size",
        renderers: ALL,
        is_model: false,
        remodels: true,
        idle: curved,
        values: |base| tolerances(base).collect(),
        best: |base, _| tolerances(base).last().unwrap_or(0.0) / TOLERANCE_STEP,
        get: |setup| if setup.own_tolerances { 0.0 } else { setup.settings.geometry.tolerance.unwrap_or(0.0) },
        set: |setup, value| (setup.settings.geometry.tolerance, setup.own_tolerances) = (Some(value), false),
    },
    RenderKnob {
        name: "angle",
        sets: "largest turn of the normal from vertex to vertex of an exact surface, degrees",
        renderers: ALL,
        is_model: false,
        remodels: true,
        idle: curved,
        values: |base| halved(base, LARGEST_ANGLE).take(6).collect(),
        best: |base, _| halved(base, LARGEST_ANGLE).take(6).last().unwrap_or(LARGEST_ANGLE),
        get: |setup| setup.settings.geometry.angle,
        set: |setup, value| setup.settings.geometry.angle = value,
    },
    RenderKnob {
        name: "exact_surfaces",
        sets: "whether rays are led on from triangles to the exact surfaces behind them (1) or not (0)",
        renderers: RAYS,
        is_model: false,
        remodels: true,
        idle: curved,
        values: |_| vec![0.0, 1.0],
        best: |_, _| 1.0,
        get: |setup| f64::from(u8::from(setup.settings.geometry.exact_surfaces)),
        set: |setup, value| setup.settings.geometry.exact_surfaces = value > 0.0,
    },
    RenderKnob {
        name: "detail",
        sets: "how small the detail is that procedural models may leave out, pixels",
        renderers: ALL,
        is_model: false,
        remodels: true,
        idle: |base| base.has_no_models().then_some("the scene has no procedural models"),
        values: |base| halved(base, COARSEST_DETAIL).collect(),
        best: |base, _| halved(base, COARSEST_DETAIL).last().unwrap_or(1.0).min(1.0) / 2.0,
        get: |setup| setup.settings.geometry.detail,
        set: |setup, value| setup.settings.geometry.detail = value,
    },
    RenderKnob {
        name: "aggregate",
        sets: "pixels that the largest of what is scattered in cells spans where fewer and larger ones begin to stand in for all; 0 for nowhere",
        renderers: EYE,
        is_model: false,
        remodels: true,
        idle: |base| base.has_no_cells().then_some("nothing is scattered in cells"),
        values: |base| halved(base, COARSEST_AGGREGATE).take(base.options.settings as usize - 1).chain([0.0]).collect(),
        best: |_, _| 0.0,
        get: |setup| setup.settings.geometry.aggregate.unwrap_or(0.0),
        set: |setup, value| setup.settings.geometry.aggregate = Some(value),
    },
    RenderKnob {
        name: "spectral",
        sets: "whether rays carry eight wavelengths (1) or three bands (0)",
        renderers: ALL,
        is_model: true,
        remodels: false,
        idle: |base| base.lacks(Stage::Spectra, "no material and no light has a spectrum"),
        values: |_| vec![0.0, 1.0],
        best: |_, _| 1.0,
        get: |setup| f64::from(u8::from(setup.settings.light.spectral != Some(false))),
        set: |setup, value| setup.settings.light.spectral = Some(value > 0.0),
    },
    RenderKnob {
        name: "interreflection",
        sets: "whether diffuse light is carried on from surface to surface (1) or not (0)",
        renderers: RAYS,
        is_model: true,
        remodels: false,
        idle: |base| (base.settings().light.reflection_depth == 0).then_some("the depth of the scene is 0"),
        values: |_| vec![0.0, 1.0],
        best: |_, _| 1.0,
        get: |setup| f64::from(u8::from(setup.settings.light.interreflection != Interreflection::LeftOut)),
        set: |setup, value| match value > 0.0 {
            true => setup.settings.light.interreflection.count(),
            false => setup.settings.light.interreflection = Interreflection::LeftOut,
        },
    },
    RenderKnob {
        name: "caustics",
        sets: "whether light counts that a mirror or glass throws from a lamp (1) or not (0)",
        renderers: EYE,
        is_model: true,
        remodels: false,
        idle: |base| base.lacks(Stage::Reflection, "nothing in the scene reflects, refracts or carries light on"),
        values: |_| vec![0.0, 1.0],
        best: |_, _| 1.0,
        get: |setup| f64::from(u8::from(setup.settings.light.caustics == Caustics::PathTraced)),
        set: |setup, value| {
            setup.settings.light.caustics = if value > 0.0 { Caustics::PathTraced } else { Caustics::LeftOut };
        },
    },
    RenderKnob {
        name: "photons",
        sets: "photons that are traced from lamps for eight samples of each pixel",
        renderers: LAMPS,
        is_model: false,
        remodels: false,
        idle: |_| None,
        values: |base| around(base, f64::from(base.settings().photons.count), PHOTON_STEP).map(f64::round).collect(),
        best: |base, _| (f64::from(base.settings().photons.count) * PHOTON_STEP).min(f64::from(MAX_PHOTONS)),
        get: |setup| f64::from(setup.settings.photons.count),
        set: |setup, value| setup.settings.photons.count = (value as u32).clamp(1, MAX_PHOTONS),
    },
    RenderKnob {
        name: "radius",
        sets: "radius of the largest disc over which photons are spread, scene units; where there are many, discs are smaller",
        renderers: LAMPS,
        is_model: false,
        remodels: false,
        idle: |_| None,
        values: |base| around(base, own_radius(base), 1.0 / RADIUS_STEP).collect(),
        best: |base, _| own_radius(base) / RADIUS_STEP,
        get: |setup| setup.settings.photons.radius.unwrap_or(0.0),
        set: |setup, value| setup.settings.photons.radius = Some(value),
    },
    RenderKnob {
        name: "voxels",
        sets: "2 to this power voxels are along the scene, a point in each stands for its surface, and rays meet these; 0 for none: rays meet surfaces",
        renderers: LAMPS,
        is_model: false,
        remodels: false,
        idle: |_| None,
        values: |base| {
            (0..base.options.settings as i32)
                .map(|i| f64::from(i + COARSEST_VOXELS))
                .take_while(|depth| *depth <= f64::from(MAX_POINT_DEPTH))
                .chain([0.0])
                .collect()
        },
        best: |_, _| 0.0,
        get: |setup| setup.settings.photons.point_depth.map_or(0.0, f64::from),
        set: |setup, value| setup.settings.photons.point_depth = Some(value as u32).filter(|depth| *depth > 0),
    },
    RenderKnob {
        name: "radiosity_error",
        sets: "error of the light that one pair of patches brings in radiosity, as a part of the mean irradiance",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: no_radiosity,
        values: |base| halved(base, COARSEST_PATCHES * base.settings().radiosity.error).collect(),
        best: |base, _| base.settings().radiosity.error * BEST_PATCHES,
        get: |setup| setup.settings.radiosity.error,
        set: |setup, value| setup.settings.radiosity.error = value,
    },
    RenderKnob {
        name: "radiosity_finest",
        sets: "length below which patches are not divided in radiosity, as a part of the diagonal of the scene",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: no_radiosity,
        values: |base| halved(base, COARSEST_PATCHES * base.settings().radiosity.finest).collect(),
        best: |base, _| base.settings().radiosity.finest * BEST_PATCHES,
        get: |setup| setup.settings.radiosity.finest,
        set: |setup, value| setup.settings.radiosity.finest = value,
    },
    RenderKnob {
        name: "radiosity_pixels",
        sets: "pixels below which patches are not divided in radiosity, where that is longer",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: no_radiosity,
        values: |base| halved(base, COARSEST_PATCHES).chain([0.0]).collect(),
        best: |_, _| 0.0,
        get: |setup| setup.settings.radiosity.pixels,
        set: |setup, value| setup.settings.radiosity.pixels = value,
    },
    RenderKnob {
        name: "radiosity_directions",
        sets: "directions in which each patch of radiosity looks around at the least, by which form factors are balanced",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: no_radiosity,
        values: |base| doubled(base).map(|n| 4.0 * n).collect(),
        best: |base, _| 4.0 * f64::from(base.settings().radiosity.directions),
        get: |setup| f64::from(setup.settings.radiosity.directions),
        set: |setup, value| setup.settings.radiosity.directions = value as u32,
    },
    RenderKnob {
        name: "radiosity_tolerance",
        sets: "error of the solver of radiosity, as a part of the greatest irradiance",
        renderers: RAYS,
        is_model: false,
        remodels: false,
        idle: no_radiosity,
        values: |base| (1..=base.options.settings as i32).map(|i| 10f64.powi(-i)).collect(),
        best: |base, _| base.settings().radiosity.tolerance * 0.1,
        get: |setup| setup.settings.radiosity.tolerance,
        set: |setup, value| setup.settings.radiosity.tolerance = value,
    },
];

/// 1, 2, 4, ..., as many as are to be tried.
fn doubled(base: &StudiedScene) -> impl Iterator<Item = f64> + use<> {
    (0..base.options.settings as i32).map(|i| 2f64.powi(i))
}

/// A value, its half, ..., as many as are to be tried.
fn halved(base: &StudiedScene, from: f64) -> impl Iterator<Item = f64> + use<> {
    (0..base.options.settings as i32).map(move |i| from / 2f64.powi(i))
}

/// What the scene has, coarser ones before it and one finer one, as many as are to be tried.
fn around(base: &StudiedScene, own: f64, step: f64) -> impl Iterator<Item = f64> + use<> {
    let count = base.options.settings as i32;
    (0..count).map(move |i| own * step.powi(i + 2 - count))
}

/// The radius of the largest disc that the scene has.
fn own_radius(base: &StudiedScene) -> f64 {
    base.settings().photons.radius.unwrap_or_else(|| greatest_gather_radius(&base.prepared))
}

/// Tolerances for the largest curved object.
fn tolerances(base: &StudiedScene) -> impl Iterator<Item = f64> + use<> {
    let coarsest = base.largest_curved * COARSEST;
    // Triangles grow as the reciprocal: four settings and the reference span a factor of a thousand.
    (0..base.options.settings.min(5) as i32).map(move |i| coarsest / TOLERANCE_STEP.powi(i))
}

fn no_radiosity(base: &StudiedScene) -> Option<&'static str> {
    base.lacks(Stage::Radiosity, "the scene has no light by radiosity")
}

fn curved(base: &StudiedScene) -> Option<&'static str> {
    (base.largest_curved == 0.0).then_some("no object is tessellated from a curved surface")
}

/// Whether some light is no point and not parallel.
fn has_spread_light(base: &StudiedScene) -> bool {
    let emits = base.prepared.objects.iter().flat_map(|object| &object.materials);
    base.prepared.lights.iter().any(Light::has_size) || emits.into_iter().any(|material| !material.emission.is_black())
}
