//! Functions of the scene language for terrain, one row each.

use super::function::{Function, function};
use super::kinds::{Integer, Length, NumberKind, RectangleKind, Word};
use super::parameter::{Defaulted, optional, with_default};
use super::shared::{OBJECT, TOLERANCE};
use crate::procedural::terrain::{
    EROSION_PARAMETERS, ErosionEdge, ErosionSettings, FRACTAL_PARAMETERS, FRACTALS, FractalKind, FractalParameter,
    FractalParameters,
};
use crate::scene::{Erosion, FractalGround, GroundKind, Shape, Terrain};
use rhai::Dynamic;

/// The names of the kinds: those of noise, and midpoint displacement.
const KINDS: [(&str, GroundKind); FRACTALS.len() + 1] = {
    let mut kinds = [("midpoint", GroundKind::Midpoint); FRACTALS.len() + 1];
    let mut k = 0;
    while k < FRACTALS.len() {
        kinds[k] = (FRACTALS[k].name, GroundKind::Noise(FRACTALS[k].kind));
        k += 1;
    }
    kinds
};
/// What is beyond the edge.
const EDGES: [(&str, ErosionEdge); 2] = [("closed", ErosionEdge::Closed), ("open", ErosionEdge::Open)];
/// Scale of the first octave where none is given, as a part of the longer side.
const SCALE: f64 = 1.0 / 3.0;
/// Height of the first octave where none is given, as a part of its scale.
const HEIGHT: f64 = 1.0 / 4.0;

/// A number of erosion, as its table tells.
const fn erosion(name: &str) -> Defaulted<NumberKind, f64> {
    let mut k = 0;
    while !is_same(EROSION_PARAMETERS[k].name, name) {
        k += 1;
    }
    let row = &EROSION_PARAMETERS[k];
    with_default(NumberKind(row.range[0], row.range[1]), row.default, row.summary)
}

/// A number of the fractal, as its table tells.
const fn number(name: &str) -> Defaulted<NumberKind, f64> {
    with_default(within(name), row(name).default, row(name).summary)
}

/// Its range.
const fn within(name: &str) -> NumberKind {
    let [least, most] = row(name).range;
    NumberKind(least, most)
}

/// The row of a number of the fractal.
const fn row(name: &str) -> &'static FractalParameter {
    let mut k = 0;
    while !is_same(FRACTAL_PARAMETERS[k].name, name) {
        k += 1;
    }
    &FRACTAL_PARAMETERS[k]
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        terrain(
            kind: with_default(
                Word(&KINDS),
                GroundKind::Noise(FractalKind::Fbm),
                "of fractal: \"fbm\", as rough everywhere; \"heterogeneous\", plains in the valleys and rugged tops; \"hybrid\", smooth valleys at every height; \"ridged\", sharp ridges; \"midpoint\", squares that are divided and displaced, octaves times",
            ),
            size: with_default(RectangleKind, 100.0, "its sides along x and z, or one for both; its middle is at the origin"),
            scale: optional(Length, "a third of the longer side", row("scale").summary),
            height: optional(within("height"), "a quarter of the scale", row("height").summary),
            octaves: number("octaves"),
            lacunarity: number("lacunarity"),
            hurst: number("hurst"),
            offset: optional(within("offset"), "0.7, or 1 if ridged", row("offset").summary),
            feedback: number("feedback"),
            warp: with_default(
                NumberKind(0.0, 1e9),
                0.0,
                "how far another noise draws the ground aside, which bends ridges and valleys, units of length",
            ),
            base: optional(
                NumberKind(-1e12, 1e12),
                "an open surface",
                "its y: walls and a flat base there close the ground to a solid",
            ),
            seed: number("seed"),
            tolerance: TOLERANCE,
        )
        "Adds a mountain or other ground: a height for each x and z, a fractal of octaves of noise, each finer and lower than the one before."
        "let alps = terrain(\"ridged\", #{ size: 40, height: 4, seed: 3, warp: 1 });"
        |builder| {
            let scale = scale.unwrap_or(SCALE * size[0].max(size[1]));
            let height = height.unwrap_or(HEIGHT * scale);
            let usual = FRACTALS.iter().find(|row| kind == GroundKind::Noise(row.kind)).map_or(0.0, |row| row.offset);
            let offset = offset.unwrap_or(usual);
            let parameters =
                FractalParameters { octaves, lacunarity, hurst, offset, feedback, scale, height, seed };
            let fractal = FractalGround { kind, parameters, size, warp };
            let terrain = Terrain { fractal, erosion: None, base };
            terrain.field().map_err(|error| error.to_string())?;
            builder.add(Shape::Terrain(Box::new(terrain)), tolerance).map(Dynamic::from)
        }
    },
    function! {
        erode(
            object: OBJECT,
            cells: with_default(Integer(8u32, 8192), 512, "of the grid along the longer side"),
            river_steps: erosion("river_steps"),
            river_interval: erosion("river_interval"),
            erodibility: erosion("erodibility"),
            area_exponent: erosion("area_exponent"),
            slope_exponent: erosion("slope_exponent"),
            wander: erosion("wander"),
            uplift: erosion("uplift"),
            diffusivity: erosion("diffusivity"),
            tolerance: erosion("tolerance"),
            water_steps: erosion("water_steps"),
            rain: erosion("rain"),
            evaporation: erosion("evaporation"),
            drag: erosion("drag"),
            capacity: erosion("capacity"),
            detachment: erosion("detachment"),
            settling: erosion("settling"),
            edge: with_default(Word(&EDGES), ErosionEdge::Closed, "what is there for running water"),
            slide_steps: erosion("slide_steps"),
            repose_angle: erosion("repose_angle"),
            slide_rate: erosion("slide_rate"),
        )
        "Erodes terrain on a grid: rivers cut valleys, running water carries ground down into them, and slopes slide to their angle of repose. Its finer octaves are laid on top."
        "terrain(\"fbm\", #{ size: 40, height: 5, seed: 3 }).erode(#{ cells: 256 });"
        |builder| {
            let settings = ErosionSettings {
                water_steps,
                rain,
                evaporation,
                drag,
                capacity,
                detachment,
                settling,
                slide_steps,
                repose_angle,
                slide_rate,
                river_steps,
                river_interval,
                erodibility,
                area_exponent,
                slope_exponent,
                wander,
                uplift,
                diffusivity,
                tolerance,
                edge,
                rain_map: None,
                uplift_map: None,
            };
            let terrain = builder.object(object)?;
            let name = terrain.name.clone();
            let Shape::Terrain(ground) = &mut terrain.shape else { return Err(format!("{name} is no terrain")) };
            if ground.erosion.is_some() {
                return Err(format!("{name} is eroded"));
            }
            ground.erosion = Some(Box::new(Erosion { cells, settings }));
            ground.field().map_err(|error| error.to_string())?;
            Ok(Dynamic::from(object))
        }
    },
];
