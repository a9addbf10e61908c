//! Functions of the scene language that make patterns and reliefs, one row each.

use super::argument::Bound;
use super::builder::{Builder, value};
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, Parameter, parameter};
use crate::database::{self, Record};
use crate::illumination::Paint;
use crate::illumination::texture::{Band, Content, Image, Laying, Motif, Number, Pattern, Relief, Varying};
use glam::DVec3;
use rhai::Dynamic;

const ONE: Parameter = parameter("one", Kind::Reflectance, Required, "the first paint");
const TWO: Parameter = parameter("two", Kind::Reflectance, Required, "the second paint");
const SIZE: Parameter = parameter("size", Kind::Lengths, Is("1"), "size of one repetition, own units of the object");
const SIZE_ON_SURFACE: Parameter = parameter(
    "size",
    Kind::Lengths,
    Is("1"),
    "size of one repetition in parameters (u, v) of the surface, each 0 to 1",
);
const AT: Parameter = parameter("at", Kind::Vector, Is("[0, 0, 0]"), "where it begins");
const UP: Parameter = parameter("up", Kind::Vector, Is("[0, 1, 0]"), "its y direction");
const FILE: Parameter = parameter(
    "file",
    Kind::Text,
    Required,
    "a PNG or EXR file, relative to the folder of the script; or a texture of a database",
);

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "picture",
        summary: "Makes a pattern of an image that lies on the parameters (u, v) of surfaces, or the texture coordinates of a file. Give it where a reflectance is asked for.",
        parameters: &[
            FILE,
            SIZE_ON_SURFACE,
            AT,
            UP,
            parameter(
                "numbers",
                Kind::Flag,
                Is("false"),
                "whether a PNG file holds numbers, as maps of roughness do, and not colors of sRGB",
            ),
        ],
        example: "pot.material(picture(\"tiles.png\", 0.25));",
        action: |builder, bound| {
            let content = if bound.flag("numbers").unwrap_or(false) { Content::Numbers } else { Content::Color };
            let motif = Motif::Image { image: read(builder, bound, content)? };
            pattern(motif, laying(bound, false), Vec::new())
        },
    },
    Function {
        name: "checker",
        summary: "Makes a pattern of squares on the parameters (u, v) of surfaces, or of cubes in space, of two paints in turn. Give it where a reflectance is asked for.",
        parameters: &[
            ONE,
            TWO,
            parameter("size", Kind::Lengths, Is("1"), "size of two squares, in parameters or, if solid, in own units"),
            parameter("solid", Kind::Flag, Is("false"), "whether it goes through the body"),
            AT,
            UP,
        ],
        example: "ball.material(checker(0.8, [0.1, 0.05, 0.02], 0.125));",
        action: |_, bound| {
            let solid = bound.flag("solid").unwrap_or(false);
            pattern(Motif::Checker, laying(bound, solid), paints(bound))
        },
    },
    Function {
        name: "noise",
        summary: "Makes a pattern of clouds of a second paint in the first, through the body. Give it where a reflectance is asked for.",
        parameters: &[
            ONE,
            TWO,
            SIZE,
            parameter("octaves", Kind::Integer(1, 16), Is("5"), "how many frequencies, each twice the one before"),
            AT,
        ],
        example: "ball.material(noise(0.6, 0.75, 0.3));",
        action: |_, bound| {
            let octaves = bound.integer("octaves").and_then(|count| u32::try_from(count).ok()).unwrap_or(5);
            pattern(Motif::Noise { octaves }, laying(bound, true), paints(bound))
        },
    },
    Function {
        name: "marble",
        summary: "Makes a pattern of veins of a second paint in the first, through the body. Give it where a reflectance is asked for.",
        parameters: &[
            ONE,
            TWO,
            SIZE,
            parameter("turbulence", Kind::Number(0.0, 1000.0), Is("0.8"), "how far veins stray, in their distances"),
            parameter("sharpness", Kind::Number(0.01, 1000.0), Is("6"), "how narrow they are; 1 is a wave"),
            AT,
            UP,
        ],
        example: "ball.material(marble([0.85, 0.83, 0.8], [0.2, 0.22, 0.25], 0.5));",
        action: |_, bound| {
            let turbulence = bound.number("turbulence").unwrap_or(0.8);
            let motif = Motif::Marble { turbulence, sharpness: bound.number("sharpness").unwrap_or(6.0) };
            pattern(motif, laying(bound, true), paints(bound))
        },
    },
    Function {
        name: "wood",
        summary: "Makes a pattern of rings of early and late wood about an axis, through the body. Give it where a reflectance is asked for.",
        parameters: &[
            ONE,
            TWO,
            parameter("size", Kind::Lengths, Is("1"), "width of one ring, own units of the object"),
            parameter("turbulence", Kind::Number(0.0, 1000.0), Is("0.6"), "how far rings stray, in their widths"),
            parameter("grain", Kind::Number(0.0, 1.0), Is("0.25"), "how much of it is fibres"),
            AT,
            parameter("up", Kind::Vector, Is("[0, 1, 0]"), "the axis of the tree"),
        ],
        example: "ball.material(wood(#{ one: [0.55, 0.33, 0.16], two: [0.3, 0.15, 0.06], size: 0.08, up: [1, 0, 0] }));",
        action: |_, bound| {
            let turbulence = bound.number("turbulence").unwrap_or(0.6);
            let motif = Motif::Wood { turbulence, grain: bound.number("grain").unwrap_or(0.25) };
            pattern(motif, laying(bound, true), paints(bound))
        },
    },
    Function {
        name: "between",
        summary: "Makes a pattern of numbers of any range: low where a pattern is black, high where it is white. Give it where a pattern of numbers is asked for, as for a roughness.",
        parameters: &[
            parameter("low", Kind::Number(f64::MIN, f64::MAX), Required, "the number where the pattern is 0"),
            parameter("high", Kind::Number(f64::MIN, f64::MAX), Required, "the number where it is 1"),
            parameter("pattern", Kind::Reflectance, Required, "the pattern"),
            parameter(
                "band",
                Kind::Word(&["mean", "red", "green", "blue"]),
                Is("\"mean\""),
                "which band of it counts; maps of glTF have roughness in green, metalness in blue",
            ),
        ],
        example: "pot.metal(\"brass\", between(0.05, 0.4, noise(0, 1, 0.2)));",
        action: |_, bound| match bound.paint("pattern") {
            Some(Paint::Pattern(pattern)) => {
                let end = |name| bound.number(name).unwrap_or_default();
                let word = bound.text("band").unwrap_or("mean");
                let band = Band::ALL.into_iter().find(|row| row.0 == word).map_or(Band::Mean, |row| row.1);
                let varying = Varying { pattern: *pattern, band, from: end("low"), to: end("high") };
                let number = Number::Varying(Box::new(varying));
                number.check().map_err(|error| error.to_string())?;
                Ok(Dynamic::from(number))
            }
            _ => Err("between needs a pattern, not one color".into()),
        },
    },
    Function {
        name: "bumps",
        summary: "Makes an object look as if its surface were as high as a pattern has of its second paint, or an image is bright.",
        parameters: &[
            OBJECT,
            parameter("pattern", Kind::Reflectance, Required, "the pattern"),
            parameter(
                "height",
                Kind::Number(f64::MIN, f64::MAX),
                Required,
                "height of all of it, scene units; deep below 0",
            ),
        ],
        example: "pot.bumps(noise(0, 1, 0.05), 0.004);",
        action: |builder, bound| match bound.paint("pattern") {
            Some(Paint::Pattern(pattern)) => {
                let height = bound.number("height").unwrap_or_default();
                relieve(builder, bound, Relief::Bumps { pattern: *pattern, height })
            }
            _ => Err("bumps need a pattern, not one color".into()),
        },
    },
    Function {
        name: "normals",
        summary: "Gives an object the normals of an image: red along u, green along v, blue outwards.",
        parameters: &[OBJECT, FILE, SIZE_ON_SURFACE, AT, UP],
        example: "pot.normals(\"bricks_normal.png\", 0.5);",
        action: |builder, bound| {
            let image = read(builder, bound, Content::Numbers)?;
            relieve(builder, bound, Relief::Normals { image, laying: laying(bound, false) })
        },
    },
    Function {
        name: "texture_filter",
        summary: "Sets over how much of what a sample stands for the mean of patterns is taken.",
        parameters: &[parameter("part", Kind::Number(0.0, 1000.0), Required, "1 is all of it, 0 a point")],
        example: "texture_filter(0.5);",
        action: |builder, bound| {
            builder.scene.settings.light.texture_filter = bound.number("part").unwrap_or(1.0);
            Ok(Dynamic::UNIT)
        },
    },
];

/// An image from a file or, if there is none of that name, from the databases.
fn read(builder: &Builder, bound: &Bound, content: Content) -> Result<Image, String> {
    let name = bound.text("file").unwrap_or_default();
    let path = builder.folders.file(name)?;
    match builder.library.record(database::Kind::Texture, name) {
        Ok((Record { content: database::Content::Texture(picture), .. }, _)) if !path.exists() => {
            Ok(Image::of_picture(name.to_owned(), &picture, content))
        }
        _ => Image::read(&path, content).map_err(|error| error.to_string()),
    }
}

fn laying(bound: &Bound, solid: bool) -> Laying {
    let vector = |name, default| bound.vector(name).unwrap_or(default);
    Laying { solid, size: vector("size", DVec3::ONE), at: vector("at", DVec3::ZERO), up: vector("up", DVec3::Y) }
}

fn paints(bound: &Bound) -> Vec<Paint> {
    ["one", "two"].into_iter().filter_map(|name| bound.paint(name)).collect()
}

fn pattern(motif: Motif, laying: Laying, paints: Vec<Paint>) -> Done {
    let paint = Paint::Pattern(Box::new(Pattern { motif, laying, paints }));
    paint.check().map_err(|error| error.to_string())?;
    Ok(Dynamic::from(paint))
}

fn relieve(builder: &mut Builder, bound: &Bound, relief: Relief) -> Done {
    relief.check().map_err(|error| error.to_string())?;
    let object = builder.object(bound.object("object"))?;
    object.material.get_or_insert_default().relief = Some(relief);
    Ok(value(bound.object("object")))
}
