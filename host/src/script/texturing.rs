//! Functions of the scene language that make patterns and reliefs, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::{CallResult, Handle};
use super::kinds::{Flag, Integer, Lengths, NumberKind, RangeKind, Reflectance, TextKind, Vector, Word};
use super::parameter::{Defaulted, Required, required, with_default};
use super::shared::OBJECT;
use crate::database::{self, Record};
use crate::illumination::Paint;
use crate::illumination::texture::{
    Band, Image, ImageContent, Motif, NumberTexture as PaintedNumber, Pattern, Relief, TextureMapping, Varying,
};
use rhai::Dynamic;

const ONE: Required<Reflectance> = required(Reflectance, "the first paint");
const TWO: Required<Reflectance> = required(Reflectance, "the second paint");
const SIZE: Defaulted<Lengths, f64> = with_default(Lengths, 1.0, "size of one repetition, own units of the object");
const SIZE_ON_SURFACE: Defaulted<Lengths, f64> =
    with_default(Lengths, 1.0, "size of one repetition in parameters (u, v) of the surface, each 0 to 1");
const AT: Defaulted<Vector, [f64; 3]> = with_default(Vector, [0.0; 3], "where it begins");
const UP: Defaulted<Vector, [f64; 3]> = with_default(Vector, [0.0, 1.0, 0.0], "its y direction");
const FILE: Required<TextKind> =
    required(TextKind, "a PNG or EXR file, relative to the folder of the script; or a texture of a database");
/// A length, or none.
const LENGTH: NumberKind = NumberKind(0.0, 1e12);
const ANY: NumberKind = NumberKind(f64::MIN, f64::MAX);

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        picture(
            file: FILE,
            size: SIZE_ON_SURFACE,
            at: AT,
            up: UP,
            numbers: with_default(
                Flag,
                false,
                "whether a PNG file holds numbers, as maps of roughness do, and not colors of sRGB",
            ),
        )
        "Makes a pattern of an image that lies on the parameters (u, v) of surfaces, or the texture coordinates of a file. Give it where a reflectance is asked for."
        "pot.material(picture(\"tiles.png\", 0.25));"
        |builder| {
            let content = if numbers { ImageContent::Numbers } else { ImageContent::Color };
            let motif = Motif::Image { image: read(builder, &file, content)? };
            pattern(motif, TextureMapping { solid: false, size, at, up }, Vec::new())
        }
    },
    function! {
        checker(
            one: ONE,
            two: TWO,
            size: with_default(Lengths, 1.0, "size of two squares, in parameters or, if solid, in own units"),
            solid: with_default(Flag, false, "whether it goes through the body"),
            at: AT,
            up: UP,
        )
        "Makes a pattern of squares on the parameters (u, v) of surfaces, or of cubes in space, of two paints in turn. Give it where a reflectance is asked for."
        "ball.material(checker(0.8, [0.1, 0.05, 0.02], 0.125));"
        |_| pattern(Motif::Checker, TextureMapping { solid, size, at, up }, vec![one, two])
    },
    function! {
        noise(
            one: ONE,
            two: TWO,
            size: SIZE,
            octaves: with_default(Integer(1u32, 16), 5, "how many frequencies, each twice the one before"),
            at: AT,
        )
        "Makes a pattern of clouds of a second paint in the first, through the body. Give it where a reflectance is asked for."
        "ball.material(noise(0.6, 0.75, 0.3));"
        |_| pattern(Motif::Noise { octaves }, TextureMapping { solid: true, size, at, ..TextureMapping::default() }, vec![one, two])
    },
    function! {
        marble(
            one: ONE,
            two: TWO,
            size: SIZE,
            turbulence: with_default(NumberKind(0.0, 1000.0), 0.8, "how far veins stray, in their distances"),
            sharpness: with_default(NumberKind(0.01, 1000.0), 6.0, "how narrow they are; 1 is a wave"),
            at: AT,
            up: UP,
        )
        "Makes a pattern of veins of a second paint in the first, through the body. Give it where a reflectance is asked for."
        "ball.material(marble([0.85, 0.83, 0.8], [0.2, 0.22, 0.25], 0.5));"
        |_| pattern(Motif::Marble { turbulence, sharpness }, TextureMapping { solid: true, size, at, up }, vec![one, two])
    },
    function! {
        wood(
            one: ONE,
            two: TWO,
            size: with_default(Lengths, 1.0, "width of one ring, own units of the object"),
            turbulence: with_default(NumberKind(0.0, 1000.0), 0.6, "how far rings stray, in their widths"),
            grain: with_default(NumberKind(0.0, 1.0), 0.25, "how much of it is fibres"),
            at: AT,
            up: with_default(Vector, [0.0, 1.0, 0.0], "the axis of the tree"),
        )
        "Makes a pattern of rings of early and late wood about an axis, through the body. Give it where a reflectance is asked for."
        "ball.material(wood(#{ one: [0.55, 0.33, 0.16], two: [0.3, 0.15, 0.06], size: 0.08, up: [1, 0, 0] }));"
        |_| pattern(Motif::Wood { turbulence, grain }, TextureMapping { solid: true, size, at, up }, vec![one, two])
    },
    function! {
        cover(
            one: ONE,
            two: TWO,
            height: with_default(RangeKind(-1e12, 1e12), [-1e12, 1e12], "least and greatest y, own units of the object").note("any"),
            edge: with_default(LENGTH, 0.0, "the height over which it ends"),
            ragged: with_default(LENGTH, 0.0, "how far its ends stray up and down"),
            steepest: with_default(NumberKind(0.0, 90.0), 90.0, "the steepest surface on which it holds, degrees"),
            up: UP,
        )
        "Makes a pattern of a second paint where a surface is neither too low, too high nor too steep, as snow and grass are. Give it where a reflectance is asked for."
        "terrain(\"ridged\").material(cover([0.3, 0.27, 0.24], 0.85, #{ height: [3, 100], ragged: 0.4, steepest: 42 }));"
        |_| {
            let laying = TextureMapping { solid: true, up, ..TextureMapping::default() };
            pattern(Motif::Cover { height, edge, ragged, steepest }, laying, vec![one, two])
        }
    },
    function! {
        strata(
            one: ONE,
            two: TWO,
            size: with_default(Lengths, 1.0, "thickness of two layers, own units of the object"),
            turbulence: with_default(NumberKind(0.0, 1000.0), 0.4, "how far layers stray, in these"),
            at: AT,
            up: with_default(Vector, [0.0, 1.0, 0.0], "across the layers"),
        )
        "Makes a pattern of layers of two paints, of uneven thickness, through the body. Give it where a reflectance is asked for."
        "terrain(\"ridged\").material(strata([0.35, 0.25, 0.18], [0.5, 0.42, 0.33], #{ size: 0.5, up: [0.1, 1, 0.05] }));"
        |_| pattern(Motif::Strata { turbulence }, TextureMapping { solid: true, size, at, up }, vec![one, two])
    },
    function! {
        cracks(
            crack: required(Reflectance, "the paint of the cracks"),
            scale: required(Reflectance, "the paint between them"),
            size: with_default(Lengths, 1.0, "of the scales, own units of the object"),
            octaves: with_default(Integer(1u32, 16), 4, "how many sizes of cracks there are"),
            at: AT,
            up: with_default(Vector, [0.0, 1.0, 0.0], "the y direction of the size"),
        )
        "Makes a pattern of scales with cracks between them through the body, as bark and dry mud have them. Give it where a reflectance is asked for."
        "cylinder(1, 6).material(cracks([0.05, 0.04, 0.03], [0.25, 0.2, 0.15], #{ size: [0.2, 1.2, 0.2] }));"
        |_| pattern(Motif::Cracks { octaves }, TextureMapping { solid: true, size, at, up }, vec![crack, scale])
    },
    function! {
        varied(
            one: ONE,
            two: TWO,
            channel: with_default(Integer(0u32, u32::MAX), 0, "patterns of different channels vary by themselves"),
        )
        "Makes a pattern that is the same everywhere on an instance, and lies between two paints by its variation. Give it where a reflectance is asked for."
        "pot.material(varied([0.1, 0.3, 0.05], [0.4, 0.3, 0.05]));"
        |_| pattern(Motif::Varied { channel }, TextureMapping { solid: true, ..TextureMapping::default() }, vec![one, two])
    },
    function! {
        between(
            low: required(ANY, "the number where the pattern is 0"),
            high: required(ANY, "the number where it is 1"),
            pattern: required(Reflectance, "the pattern"),
            band: with_default(
                Word(&Band::ALL),
                Band::Mean,
                "which band of it counts; maps of glTF have roughness in green, metalness in blue",
            ),
        )
        "Makes a pattern of numbers of any range: low where a pattern is black, high where it is white. Give it where a pattern of numbers is asked for, as for a roughness."
        "pot.metal(\"brass\", between(0.05, 0.4, noise(0, 1, 0.2)));"
        |_| match pattern {
            Paint::Pattern(pattern) => {
                let varying = Varying { pattern: *pattern, band, from: low, to: high };
                let number = PaintedNumber::Varying(Box::new(varying));
                number.check().map_err(|error| error.to_string())?;
                Ok(Dynamic::from(number))
            }
            Paint::Plain(_) => Err("between needs a pattern, not one color".into()),
        }
    },
    function! {
        bumps(
            object: OBJECT,
            pattern: required(Reflectance, "the pattern"),
            height: required(ANY, "height of all of it, scene units; deep below 0"),
        )
        "Makes an object look as if its surface were as high as a pattern has of its second paint, or an image is bright."
        "pot.bumps(noise(0, 1, 0.05), 0.004);"
        |builder| match pattern {
            Paint::Pattern(pattern) => relieve(builder, object, Relief::Bumps { pattern: *pattern, height }),
            Paint::Plain(_) => Err("bumps need a pattern, not one color".into()),
        }
    },
    function! {
        normals(object: OBJECT, file: FILE, size: SIZE_ON_SURFACE, at: AT, up: UP)
        "Gives an object the normals of an image: red along u, green along v, blue outwards."
        "pot.normals(\"bricks_normal.png\", 0.5);"
        |builder| {
            let image = read(builder, &file, ImageContent::Numbers)?;
            relieve(builder, object, Relief::Normals { image, laying: TextureMapping { solid: false, size, at, up } })
        }
    },
    function! {
        texture_filter(part: required(NumberKind(0.0, 1000.0), "1 is all of it, 0 a point"))
        "Sets over how much of what a sample stands for the mean of patterns is taken."
        "texture_filter(0.5);"
        |builder| {
            builder.scene.settings.light.texture_filter = part;
            Ok(Dynamic::UNIT)
        }
    },
];

/// An image from a file or, if there is none of that name, from the databases.
fn read(builder: &Builder, name: &str, content: ImageContent) -> Result<Image, String> {
    let path = builder.folders.file(name)?;
    match builder.databases.library.record(database::RecordKind::Texture, name) {
        Ok((Record { content: database::RecordContent::Texture(picture), .. }, _)) if !path.exists() => {
            Ok(Image::of_picture(name.to_owned(), &picture, content))
        }
        _ => Image::read(&path, content).map_err(|error| error.to_string()),
    }
}

fn pattern(motif: Motif, laying: TextureMapping, paints: Vec<Paint>) -> CallResult {
    let paint = Paint::Pattern(Box::new(Pattern { motif, laying, paints }));
    paint.check().map_err(|error| error.to_string())?;
    Ok(Dynamic::from(paint))
}

fn relieve(builder: &mut Builder, handle: Handle, relief: Relief) -> CallResult {
    relief.check().map_err(|error| error.to_string())?;
    let object = builder.object(handle)?;
    object.material.get_or_insert_default().relief = Some(relief);
    Ok(Dynamic::from(handle))
}
