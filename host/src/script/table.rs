//! Functions of the scene language, one row each: objects from data, placing, camera, settings.

use super::argument::Bound;
use super::builder::Builder;
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, TOLERANCE, parameter};
use crate::illumination::optics::Interreflection;
use crate::octree::MAX_POINT_DEPTH;
use crate::picture::{Filter, MAX_PIXELS};
use crate::scene::{Camera, Caustics, Lens, MAX_PHOTONS, MAX_REFLECTION_DEPTH, MAX_SAMPLES, Motion, Parallel, Shape};
use glam::{DMat3, DMat4, DVec2, DVec3};
use rhai::Dynamic;

const ANY: Kind = Kind::Number(f64::NEG_INFINITY, f64::INFINITY);

/// The functions that place, colour, light and show objects, and make those that are no solids of a few measures.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "teapot",
        summary: "Adds the Utah teapot, standing on y = 0, its spout towards +x; 6.525 long and 3.15 high.",
        parameters: &[TOLERANCE],
        example: "let pot = teapot(#{ tolerance: 0.002 });",
        action: |builder, bound| builder.add(Shape::Teapot, bound.number("tolerance")).map(Dynamic::from),
    },
    Function {
        name: "bunny",
        summary: "Adds the Stanford bunny, about 2 high, facing the viewer; 69,666 triangles. No commercial use without permission of Stanford.",
        parameters: &[],
        example: "bunny().translate(0, 1, 0);",
        action: |builder, _| builder.add(Shape::Bunny, None).map(Dynamic::from),
    },
    Function {
        name: "ground",
        summary: "Adds a level square, its middle above or below the origin.",
        parameters: &[
            parameter("size", Kind::Length, Is("100"), "its side; it is finite"),
            parameter("height", ANY, Is("0"), "its y"),
        ],
        example: "ground(#{ size: 40, height: -1 });",
        action: |builder, bound| {
            let handle = builder.add(Shape::Ground { size: bound.number("size").unwrap_or(100.0) }, None)?;
            let height = bound.number("height").unwrap_or(0.0);
            builder.transform(Some(handle), DMat4::from_translation(DVec3::new(0.0, height, 0.0)))
        },
    },
    Function {
        name: "mesh",
        summary: "Adds a mesh from an OBJ, STL, PLY or glTF file.",
        parameters: &[parameter("file", Kind::Text, Required, "its path; relative to the folder of the script")],
        example: "let bunny = mesh(\"bunny.ply\");",
        action: add_mesh,
    },
    Function {
        name: "copy",
        summary: "Adds a copy of an object, as combined objects are used up.",
        parameters: &[OBJECT],
        example: "let second = pot.copy().translate(8, 0, 0);",
        action: |builder, bound| builder.copy(bound.object("object")).map(Dynamic::from),
    },
    Function {
        name: "translate",
        summary: "Moves an object, after all that was done to it before.",
        parameters: &[OBJECT, parameter("by", Kind::Vector, Required, "how far along x, y and z")],
        example: "pot.translate(0, 1, 0);",
        action: |builder, bound| {
            let by = bound.vector("by").unwrap_or_default();
            builder.transform(bound.object("object"), DMat4::from_translation(by))
        },
    },
    Function {
        name: "rotate",
        summary: "Turns an object about an axis through the origin, after all that was done to it before.",
        parameters: &[
            OBJECT,
            parameter("axis", Kind::Axis, Required, "what it turns about"),
            parameter("angle", ANY, Required, "degrees; positive as a right-handed screw turns"),
        ],
        example: "pot.rotate(\"y\", 30);",
        action: |builder, bound| {
            let axis = bound.vector("axis").unwrap_or(DVec3::Y);
            let angle = bound.number("angle").unwrap_or_default().to_radians();
            builder.transform(bound.object("object"), DMat4::from_axis_angle(axis, angle))
        },
    },
    Function {
        name: "moving",
        summary: "Lets an object move while the shutter is open: from where it is placed at the time 0 it moves on evenly, and turns about an axis that moves with it.",
        parameters: &[
            OBJECT,
            parameter("by", Kind::Vector, Is("[0, 0, 0]"), "how far it moves until the time 1"),
            parameter("axis", Kind::Axis, Is("\"y\""), "what it turns about"),
            parameter("angle", ANY, Is("0"), "how far it turns until the time 1, degrees"),
            parameter("through", Kind::Vector, Is("[0, 0, 0]"), "a point of the axis at the time 0"),
        ],
        example: "pot.moving(#{ by: [0.5, 0, 0], axis: \"y\", angle: 20, through: [0, 0, 0] });",
        action: |builder, bound| {
            let motion = Motion {
                by: bound.vector("by").unwrap_or_default(),
                through: bound.vector("through").unwrap_or_default(),
                axis: bound.vector("axis").unwrap_or(DVec3::Y),
                angle: bound.number("angle").unwrap_or_default().to_radians(),
            };
            builder.let_move(bound.object("object"), motion)
        },
    },
    Function {
        name: "shutter",
        summary: "Sets when the shutter opens and closes: samples of ray tracing see what moves at times between. Other pictures show the middle.",
        parameters: &[
            parameter("open", ANY, Required, "when it opens"),
            parameter("close", ANY, Required, "when it closes; not before"),
        ],
        example: "shutter(0, 0.5);",
        action: |builder, bound| {
            let (open, close) = (bound.number("open").unwrap_or(0.0), bound.number("close").unwrap_or(1.0));
            if close < open {
                return Err(format!("it closes at {close}, before it opens at {open}"));
            }
            builder.shutter = [open, close];
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "reflect",
        summary: "Mirrors an object in a plane, after all that was done to it before.",
        parameters: &[
            OBJECT,
            parameter("normal", Kind::Axis, Required, "what the plane is square to"),
            parameter("at", Kind::Vector, Is("[0, 0, 0]"), "a point of the plane"),
        ],
        example: "pot.copy().reflect(\"x\", [4, 0, 0]);",
        action: |builder, bound| {
            let (normal, at) = (bound.vector("normal").unwrap_or(DVec3::X), bound.vector("at").unwrap_or_default());
            let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis - normal * (2.0 * normal.dot(axis)));
            let mirror = DMat4::from_mat3(DMat3::from_cols(columns[0], columns[1], columns[2]));
            let there = DMat4::from_translation(normal * (2.0 * normal.dot(at)));
            builder.transform(bound.object("object"), there * mirror)
        },
    },
    Function {
        name: "scale",
        summary: "Scales an object about the origin, after all that was done to it before.",
        parameters: &[OBJECT, parameter("by", Kind::Factors, Required, "factor, or one for each axis")],
        example: "pot.scale(0.5);",
        action: |builder, bound| {
            let by = bound.vector("by").unwrap_or(DVec3::ONE);
            builder.transform(bound.object("object"), DMat4::from_scale(by))
        },
    },
    Function {
        name: "name",
        summary: "Names an object, for messages and tables.",
        parameters: &[OBJECT, parameter("text", Kind::Text, Required, "the name")],
        example: "pot.name(\"pot\");",
        action: |builder, bound| builder.name(bound.object("object"), bound.text("text").unwrap_or_default()),
    },
    Function {
        name: "camera",
        summary: "Sets from where the scene is seen; without it, all that is no ground is framed.",
        parameters: &[
            parameter("from", Kind::Vector, Required, "the eye"),
            parameter("at", Kind::Vector, Is("[0, 0, 0]"), "what is in the middle of the picture"),
            parameter("up", Kind::Vector, Is("[0, 1, 0]"), "what is up in the picture"),
            parameter(
                "field_of_view",
                Kind::Number(1e-6, 179.999_999),
                Is("30"),
                "full angle across the shorter side of the picture, degrees",
            ),
            parameter("near", Kind::Number(0.0, f64::INFINITY), Is("0"), "depth before which nothing is seen"),
            parameter("far", Kind::Length, Is("no end"), "depth behind which nothing is seen"),
            parameter("lens", Kind::Length, Is("a pinhole"), "radius of a lens, which is sharp at one depth only"),
            parameter("focus", Kind::Length, Is("the distance to at"), "depth at which it is sharp"),
            parameter(
                "height",
                Kind::Length,
                Is("perspective"),
                "a parallel view that shows so much across the shorter side",
            ),
            parameter(
                "oblique",
                Kind::Points,
                Is("orthographic"),
                "[[right, up]] by which a parallel view moves nearer points",
            ),
        ],
        example: "camera(#{ from: [0, 4, 12], at: [0, 1, 0], field_of_view: 30 });",
        action: set_camera,
    },
    Function {
        name: "parameter",
        summary: "Gives the value that the command line sets with -D NAME=VALUE, of the kind of the default; without one, the default.",
        parameters: &[
            parameter("name", Kind::Text, Required, "letters, digits and underscores"),
            parameter("default", Kind::Scalar, Required, "the value when none is given"),
            parameter("meaning", Kind::Text, Is("none"), "what it means, for those who look for it"),
        ],
        example: "let count = parameter(\"count\", 6, \"how many there are\");",
        action: |builder, bound| {
            let (name, meaning) = (bound.text("name").unwrap_or_default(), bound.text("meaning").unwrap_or_default());
            builder.definitions.value(name, bound.scalar("default").unwrap_or_default(), meaning)
        },
    },
    Function {
        name: "image",
        summary: "Sets the size of the picture.",
        parameters: &[
            parameter("width", Kind::Integer(1, MAX_PIXELS as i64), Required, "columns of pixels"),
            parameter("height", Kind::Integer(1, MAX_PIXELS as i64), Required, "rows of pixels"),
        ],
        example: "image(640, 480);",
        action: |builder, bound| {
            let side = |name| bound.integer(name).and_then(|i| u32::try_from(i).ok()).unwrap_or(1);
            let (width, height) = (side("width"), side("height"));
            if u64::from(width) * u64::from(height) > MAX_PIXELS {
                return Err(format!("a picture has at most {MAX_PIXELS} pixels"));
            }
            builder.scene.settings.image.width = width;
            builder.scene.settings.image.height = height;
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "samples",
        summary: "Sets the number of samples in each pixel; one samples its centre.",
        parameters: &[parameter("count", Kind::Integer(1, MAX_SAMPLES as i64), Required, "how many")],
        example: "samples(16);",
        action: |builder, bound| {
            builder.scene.settings.image.samples =
                bound.integer("count").and_then(|i| u32::try_from(i).ok()).unwrap_or(1);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "filter",
        summary: "Sets how samples around a pixel become one value.",
        parameters: &[parameter(
            "name",
            Kind::Word(&Filter::WORDS),
            Required,
            "\"box\" is the mean over the pixel, as without a word; \"gaussian\" and \"blackman-harris\" smooth, \"mitchell\" sharpens",
        )],
        example: "filter(\"blackman-harris\");",
        action: |builder, bound| {
            builder.scene.settings.image.filter = bound.text("name").and_then(Filter::of_word).unwrap_or_default();
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "seed",
        summary: "Sets the seed of the sample positions; the same seed gives the same picture.",
        parameters: &[parameter("number", Kind::Integer(0, i64::MAX), Required, "the seed")],
        example: "seed(7);",
        action: |builder, bound| {
            builder.scene.settings.image.seed = bound.integer("number").unwrap_or_default().unsigned_abs();
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "reflection_depth",
        summary: "Sets how often light may go from mirror to mirror; 0 leaves mirrors black.",
        parameters: &[parameter("depth", Kind::Integer(0, MAX_REFLECTION_DEPTH as i64), Required, "how often")],
        example: "reflection_depth(4);",
        action: |builder, bound| {
            let depth = bound.integer("depth").and_then(|i| u32::try_from(i).ok());
            builder.scene.settings.light.reflection_depth = depth.unwrap_or_default();
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "light_samples",
        summary: "Sets how many points of each light that has a size are asked for light, for each element of a surface.",
        parameters: &[parameter("count", Kind::Integer(1, MAX_SAMPLES as i64), Required, "how many")],
        example: "light_samples(4);",
        action: |builder, bound| {
            let count = bound.integer("count").and_then(|i| u32::try_from(i).ok());
            builder.scene.settings.light.samples = count.unwrap_or(1);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "interreflection",
        summary: "Lets diffuse light go on from surface to surface, as often as reflection_depth says; leave ambient light out then.",
        parameters: &[parameter("on", Kind::Flag, Is("true"), "whether it does")],
        example: "interreflection();",
        action: |builder, bound| {
            let interreflection = &mut builder.scene.settings.light.interreflection;
            match bound.flag("on").unwrap_or(true) {
                true => interreflection.count(),
                false => *interreflection = Interreflection::LeftOut,
            }
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "radiosity",
        summary: "Lets ray tracing read the light that diffuse surfaces send each other from a solution by radiosity, found before for all views; leave ambient light out then. Sets how good solutions are.",
        parameters: &[
            parameter("on", Kind::Flag, Is("true"), "whether ray tracing does"),
            parameter(
                "error",
                Kind::Number(1e-6, 10.0),
                Is("0.005"),
                "of the light that one pair of patches brings, as a part of the mean irradiance",
            ),
            parameter(
                "finest",
                Kind::Number(1e-5, 1.0),
                Is("0.005"),
                "shortest edge of a patch that is divided, as a part of the diagonal of the scene",
            ),
            parameter("directions", Kind::Integer(1, 4096), Is("32"), "in which each patch looks around"),
            parameter(
                "tolerance",
                Kind::Number(1e-12, 1.0),
                Is("1e-6"),
                "error of the solver, as a part of the greatest irradiance",
            ),
        ],
        example: "radiosity(#{ error: 0.002 });",
        action: |builder, bound| {
            let settings = &mut builder.scene.settings;
            match (bound.flag("on").unwrap_or(true), &mut settings.light.interreflection) {
                (true, interreflection) => *interreflection = Interreflection::Solved,
                (false, solved @ Interreflection::Solved) => *solved = Interreflection::LeftOut,
                (false, _) => {}
            }
            settings.radiosity.error = bound.number("error").unwrap_or(settings.radiosity.error);
            settings.radiosity.finest = bound.number("finest").unwrap_or(settings.radiosity.finest);
            settings.radiosity.directions =
                bound.integer("directions").map_or(settings.radiosity.directions, |n| n as u32);
            settings.radiosity.tolerance = bound.number("tolerance").unwrap_or(settings.radiosity.tolerance);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "caustics",
        summary: "Lets light count that mirrors and glass throw from lamps; rays from the eye find it by chance only, and need very many samples. Without it, light goes through polished glass as if that did not bend it, less what it reflects and absorbs.",
        parameters: &[parameter("on", Kind::Flag, Is("true"), "whether it does")],
        example: "caustics();",
        action: |builder, bound| {
            let caustics = &mut builder.scene.settings.light.caustics;
            match (bound.flag("on").unwrap_or(true), *caustics) {
                (true, Caustics::LeftOut) => *caustics = Caustics::PathTraced,
                (false, Caustics::PathTraced) => *caustics = Caustics::LeftOut,
                _ => {}
            }
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "two_way",
        summary: "Follows light from lamps through mirrors and glass and catches it where it arrives, before rays from the eye ask for it: caustics, as `--renderer two-way` shows them.",
        parameters: &[
            parameter(
                "photons",
                Kind::Integer(1, MAX_PHOTONS as i64),
                Is("200000"),
                "how many ways of light are followed for eight samples of each pixel",
            ),
            parameter(
                "radius",
                Kind::Number(0.0, f64::INFINITY),
                Is("a twentieth of the scene's diagonal"),
                "the largest over which caught light is spread, scene units",
            ),
            parameter(
                "voxels",
                Kind::Integer(0, MAX_POINT_DEPTH as i64),
                Is("0: none"),
                "as the paper has it, 2 to this power voxels are along the scene, and rays meet a point in each that stands for its surface: an approximation to about a voxel",
            ),
            parameter("on", Kind::Flag, Is("true"), "whether it does; without it, --renderer two-way still may"),
        ],
        example: "two_way(#{ photons: 500000 });",
        action: |builder, bound| {
            let settings = &mut builder.scene.settings;
            match (bound.flag("on").unwrap_or(true), &mut settings.light.caustics) {
                (true, caustics) => *caustics = Caustics::PhotonMapped,
                (false, mapped @ Caustics::PhotonMapped) => *mapped = Caustics::LeftOut,
                (false, _) => {}
            }
            settings.photons.count =
                bound.integer("photons").and_then(|i| u32::try_from(i).ok()).unwrap_or(settings.photons.count);
            settings.photons.radius = bound.number("radius").filter(|radius| *radius > 0.0);
            settings.photons.point_depth =
                bound.integer("voxels").and_then(|i| u32::try_from(i).ok()).filter(|depth| *depth > 0);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "exact_surfaces",
        summary: "Leads rays on from triangles to the exact surfaces that they stand for; without them normals are interpolated between corners.",
        parameters: &[parameter("on", Kind::Flag, Is("true"), "whether it does; scenes do without a word")],
        example: "exact_surfaces(false);",
        action: |builder, bound| {
            builder.scene.settings.geometry.exact_surfaces = bound.flag("on").unwrap_or(true);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "light_buffer",
        summary: "Lets ray tracing keep what stands between the parts of the scene and its lights, for all views; pictures are the same without.",
        parameters: &[parameter("on", Kind::Flag, Is("true"), "whether it does; scenes do without a word")],
        example: "light_buffer(false);",
        action: |builder, bound| {
            builder.scene.settings.light.buffer = bound.flag("on").unwrap_or(true);
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "spectral",
        summary: "Lets rays carry spectra, or three bands only, whatever the scene needs.",
        parameters: &[parameter("on", Kind::Flag, Is("true"), "whether they do")],
        example: "spectral();",
        action: |builder, bound| {
            builder.scene.settings.light.spectral = Some(bound.flag("on").unwrap_or(true));
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "tolerance",
        summary: "Sets how closely triangles follow the surfaces of all objects that have no tolerance of their own.",
        parameters: &[
            parameter("length", Kind::Length, Required, "largest distance, scene units"),
            parameter(
                "angle",
                Kind::Number(0.01, 180.0),
                Is("45"),
                "largest turn of the normal along a triangle, degrees",
            ),
        ],
        example: "tolerance(0.001, 20);",
        action: |builder, bound| {
            builder.scene.settings.geometry.tolerance = bound.number("length");
            builder.scene.settings.geometry.angle =
                bound.number("angle").unwrap_or(builder.scene.settings.geometry.angle);
            Ok(Dynamic::UNIT)
        },
    },
];

fn add_mesh(builder: &mut Builder, bound: &Bound) -> Done {
    let path = builder.folders.file(bound.text("file").unwrap_or_default())?;
    if !path.is_file() {
        return Err(format!("there is no file {}", path.display()));
    }
    builder.add(Shape::Mesh { path }, None).map(Dynamic::from)
}

fn set_camera(builder: &mut Builder, bound: &Bound) -> Done {
    let (from, at) = (bound.vector("from").unwrap_or_default(), bound.vector("at").unwrap_or_default());
    let focus = bound.number("focus").unwrap_or(from.distance(at));
    let lens = bound.number("lens").map(|radius| Lens { radius, focus });
    let oblique = bound.contours("oblique").concat().first().map_or(DVec2::ZERO, |shift| shift.truncate());
    let parallel = bound.number("height").map(|height| Parallel { height, oblique });
    let camera = Camera {
        from,
        at,
        up: bound.vector("up").unwrap_or(DVec3::Y),
        field_of_view: bound.number("field_of_view").unwrap_or(30.0),
        near: bound.number("near").unwrap_or(0.0),
        far: bound.number("far"),
        lens,
        parallel,
    };
    // The message names the function already.
    camera.check().map_err(|e| e.to_string().trim_start_matches("camera: ").to_string())?;
    builder.scene.camera = Some(camera);
    Ok(Dynamic::UNIT)
}
