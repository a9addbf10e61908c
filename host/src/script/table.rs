//! Functions of the scene language, one row each: objects from data, placing, camera, settings.

use super::function::{Function, function};
use super::kinds::{
    ANY_NUMBER, AxisKind, Factors, Flag, Integer, Length, NamedAxis, NumberKind, PointsKind, ScalarKind, TextKind,
    Vector, Word,
};
use super::parameter::{Defaulted, optional, required, setting, with_default};
use super::shared::{OBJECT, TOLERANCE};
use crate::illumination::optics::Interreflection;
use crate::octree::MAX_POINT_DEPTH;
use crate::picture::{Filter, MAX_PIXELS};
use crate::scene::{
    Camera, Caustics, GeometrySettings, Lens, MAX_PHOTONS, MAX_REFLECTION_DEPTH, MAX_SAMPLES, MOST_DETAIL, Motion,
    Parallel, PhotonSettings, RadiositySettings, Shape,
};
use glam::{DMat3, DMat4, DVec2, DVec3};
use rhai::Dynamic;

const ORIGIN: [f64; 3] = [0.0; 3];
const ON: Defaulted<Flag, bool> = with_default(Flag, true, "whether it does");
const ON_WITHOUT_A_WORD: Defaulted<Flag, bool> = with_default(Flag, true, "whether it does; scenes do without a word");

/// The functions that place, colour, light and show objects, and make those that are no solids of a few measures.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        teapot(tolerance: TOLERANCE)
        "Adds the Utah teapot, resting on y = 0, its spout towards +x; 6.525 long and 3.15 high."
        "let pot = teapot(#{ tolerance: 0.002 });"
        |builder| builder.add(Shape::Teapot, tolerance).map(Dynamic::from)
    },
    function! {
        bunny()
        "Adds the Stanford bunny, about 2 high, facing the viewer; 69,666 triangles. No commercial use without permission of Stanford."
        "bunny().translate(0, 1, 0);"
        |builder| builder.add(Shape::Bunny, None).map(Dynamic::from)
    },
    function! {
        ground(
            size: with_default(Length, 100.0, "its side; it is finite"),
            height: with_default(ANY_NUMBER, 0.0, "its y"),
        )
        "Adds a level square, its middle above or below the origin."
        "ground(#{ size: 40, height: -1 });"
        |builder| {
            let handle = builder.add(Shape::Ground { size }, None)?;
            builder.transform(handle, DMat4::from_translation(DVec3::new(0.0, height, 0.0)))
        }
    },
    function! {
        mesh(file: required(TextKind, "its path; relative to the folder of the script"))
        "Adds a mesh from an OBJ, STL, PLY or glTF file. What a glTF file places more than once is stored once and placed, as instances are; Booleans take its copies."
        "let bunny = mesh(\"bunny.ply\");"
        |builder| {
            let path = builder.folders.file(&file)?;
            if !path.is_file() {
                return Err(format!("there is no file {}", path.display()));
            }
            builder.add(Shape::Mesh { path }, None).map(Dynamic::from)
        }
    },
    function! {
        copy(object: OBJECT)
        "Adds a copy of an object, as combined objects are used up."
        "let second = pot.copy().translate(8, 0, 0);"
        |builder| builder.copy(object).map(Dynamic::from)
    },
    function! {
        translate(object: OBJECT, by: required(Vector, "how far along x, y and z"))
        "Moves an object, after all that was done to it before."
        "pot.translate(0, 1, 0);"
        |builder| builder.transform(object, DMat4::from_translation(by))
    },
    function! {
        rotate(
            object: OBJECT,
            axis: required(AxisKind, "what it turns about"),
            angle: required(ANY_NUMBER, "degrees; positive as a right-handed screw turns"),
        )
        "Turns an object about an axis through the origin, after all that was done to it before."
        "pot.rotate(\"y\", 30);"
        |builder| builder.transform(object, DMat4::from_axis_angle(axis, angle.to_radians()))
    },
    function! {
        moving(
            object: OBJECT,
            by: with_default(Vector, ORIGIN, "how far it moves until the time 1"),
            axis: with_default(AxisKind, NamedAxis::Y, "what it turns about"),
            angle: with_default(ANY_NUMBER, 0.0, "how far it turns until the time 1, degrees"),
            through: with_default(Vector, ORIGIN, "a point of the axis at the time 0"),
        )
        "Lets an object move while the shutter is open: from where it is placed at the time 0 it moves on evenly, and turns about an axis that moves with it."
        "pot.moving(#{ by: [0.5, 0, 0], axis: \"y\", angle: 20, through: [0, 0, 0] });"
        |builder| builder.let_move(object, Motion { by, through, axis, angle: angle.to_radians() })
    },
    function! {
        time()
        "Gives the time of the picture, seconds: what --time says, or the frame of an animation; otherwise 0. A scene is a function of it: the same at the same time, whatever was rendered before."
        "sphere(1).translate(0, 2 * abs(sin(PI() * time())), 0);"
        |builder| Ok(Dynamic::from(builder.ask_time()))
    },
    function! {
        shutter(
            open: required(ANY_NUMBER, "when it opens, seconds from the time of the picture"),
            close: required(ANY_NUMBER, "when it closes; not before"),
        )
        "Sets when the shutter opens and closes: samples of ray tracing see at times between what is moving(), and what the script places by the time(). Other pictures show the middle. Without it, the shutter is open for half the time from frame to frame of an animation; in single pictures from 0 to 1, or for an instant where the script asks for the time()."
        "shutter(0, 0.5);"
        |builder| {
            if close < open {
                return Err(format!("it closes at {close}, before it opens at {open}"));
            }
            builder.shutter = Some([open, close]);
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        reflect(
            object: OBJECT,
            normal: required(AxisKind, "what the plane is square to"),
            at: with_default(Vector, ORIGIN, "a point of the plane"),
        )
        "Mirrors an object in a plane, after all that was done to it before."
        "pot.copy().reflect(\"x\", [4, 0, 0]);"
        |builder| {
            let columns = DVec3::AXES.map(|axis| axis - normal * (2.0 * normal.dot(axis)));
            let mirror = DMat4::from_mat3(DMat3::from_cols(columns[0], columns[1], columns[2]));
            let there = DMat4::from_translation(normal * (2.0 * normal.dot(at)));
            builder.transform(object, there * mirror)
        }
    },
    function! {
        scale(object: OBJECT, by: required(Factors, "factor, or one for each axis"))
        "Scales an object about the origin, after all that was done to it before."
        "pot.scale(0.5);"
        |builder| builder.transform(object, DMat4::from_scale(by))
    },
    function! {
        name(object: OBJECT, text: required(TextKind, "the name"))
        "Names an object, for messages and tables."
        "pot.name(\"pot\");"
        |builder| builder.name(object, &text)
    },
    function! {
        camera(
            from: required(Vector, "the eye"),
            at: with_default(Vector, ORIGIN, "what is in the middle of the picture"),
            up: with_default(Vector, [0.0, 1.0, 0.0], "what is up in the picture"),
            field_of_view: with_default(
                NumberKind(1e-6, 179.999_999),
                30.0,
                "full angle across the shorter side of the picture, degrees",
            ),
            near: with_default(NumberKind(0.0, f64::INFINITY), 0.0, "depth before which nothing is seen"),
            far: optional(Length, "no end", "depth behind which nothing is seen"),
            lens: optional(Length, "a pinhole", "radius of a lens, which is sharp at one depth only"),
            focus: optional(Length, "the distance to at", "depth at which it is sharp"),
            height: optional(
                Length,
                "perspective",
                "a parallel view that shows so much across the shorter side",
            ),
            oblique: optional(
                PointsKind,
                "orthographic",
                "[[right, up]] by which a parallel view moves nearer points",
            ),
        )
        "Sets from where the scene is seen; without it, all that is no ground is framed."
        "camera(#{ from: [0, 4, 12], at: [0, 1, 0], field_of_view: 30 });"
        |builder| {
            let focus = focus.unwrap_or(from.distance(at));
            let lens = lens.map(|radius| Lens { radius, focus });
            let oblique = oblique.unwrap_or_default().first().map_or(DVec2::ZERO, |shift| shift.truncate());
            let parallel = height.map(|height| Parallel { height, oblique });
            let camera = Camera { from, at, up, field_of_view, near, far, lens, parallel, motion: None };
            // The message names the function already.
            camera.check().map_err(|e| e.to_string().trim_start_matches("camera: ").to_string())?;
            builder.scene.camera = Some(camera);
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        parameter(
            name: required(TextKind, "letters, digits and underscores"),
            default: required(ScalarKind, "the value when none is given"),
            meaning: optional(TextKind, "none", "what it means, for those who look for it"),
        )
        "Gives the value that the command line sets with -D NAME=VALUE, of the kind of the default; without one, the default."
        "let count = parameter(\"count\", 6, \"how many there are\");"
        |builder| builder.definitions.value(&name, default, &meaning.unwrap_or_default())
    },
    function! {
        image(
            width: required(Integer(1, MAX_PIXELS as u32), "columns of pixels"),
            height: required(Integer(1, MAX_PIXELS as u32), "rows of pixels"),
        )
        "Sets the size of the picture."
        "image(640, 480);"
        |builder| {
            if u64::from(width) * u64::from(height) > MAX_PIXELS {
                return Err(format!("a picture has at most {MAX_PIXELS} pixels"));
            }
            builder.scene.settings.image.width = width;
            builder.scene.settings.image.height = height;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        samples(count: required(Integer(1, MAX_SAMPLES), "how many"))
        "Sets the number of samples in each pixel; one samples its centre."
        "samples(16);"
        |builder| {
            builder.scene.settings.image.samples = count;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        filter(
            name: required(
                Word(&Filter::NAMED),
                "\"box\" is the mean over the pixel, as without a word; \"gaussian\" and \"blackman-harris\" smooth, \"mitchell\" sharpens",
            ),
        )
        "Sets how samples around a pixel become one value."
        "filter(\"blackman-harris\");"
        |builder| {
            builder.scene.settings.image.filter = name;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        seed(number: required(Integer(0, i64::MAX as u64), "the seed"))
        "Sets the seed of the sample positions; the same seed gives the same picture."
        "seed(7);"
        |builder| {
            builder.scene.settings.image.seed = number;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        reflection_depth(depth: required(Integer(0, MAX_REFLECTION_DEPTH), "how often"))
        "Sets how often light may go from mirror to mirror; 0 leaves mirrors black."
        "reflection_depth(4);"
        |builder| {
            builder.scene.settings.light.reflection_depth = depth;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        light_samples(count: required(Integer(1, MAX_SAMPLES), "how many"))
        "Sets how many points of each light that has a size are asked for light, for each element of a surface."
        "light_samples(4);"
        |builder| {
            builder.scene.settings.light.samples = count;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        interreflection(on: ON)
        "Lets diffuse light go on from surface to surface, as often as reflection_depth says; leave ambient light out then."
        "interreflection();"
        |builder| {
            let interreflection = &mut builder.scene.settings.light.interreflection;
            match on {
                true => interreflection.count(),
                false => *interreflection = Interreflection::LeftOut,
            }
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        radiosity(
            on: with_default(Flag, true, "whether ray tracing does"),
            error: setting(
                NumberKind(1e-6, 10.0),
                RadiositySettings::DEFAULT.error,
                "of the light that one pair of patches brings, as a part of the mean irradiance",
            ),
            finest: setting(
                NumberKind(1e-5, 1.0),
                RadiositySettings::DEFAULT.finest,
                "shortest edge of a patch that is divided, as a part of the diagonal of the scene",
            ),
            pixels: setting(
                NumberKind(0.0, 1000.0),
                RadiositySettings::DEFAULT.pixels,
                "shortest edge of a patch that is divided, in pixels of the picture, where that is more; 0 for light that is the same in pictures of all sizes",
            ),
            directions: setting(
                Integer(1, 4096),
                RadiositySettings::DEFAULT.directions,
                "in which each patch looks around, at the least; more where chance would be seen",
            ),
            tolerance: setting(
                NumberKind(1e-12, 1.0),
                RadiositySettings::DEFAULT.tolerance,
                "error of the solver, as a part of the greatest irradiance",
            ),
        )
        "Lets ray tracing read the light that diffuse surfaces send each other from a solution by radiosity, found before for all views; leave ambient light out then. Sets how good solutions are."
        "radiosity(#{ error: 0.002 });"
        |builder| {
            let settings = &mut builder.scene.settings;
            match (on, &mut settings.light.interreflection) {
                (true, interreflection) => *interreflection = Interreflection::Solved,
                (false, solved @ Interreflection::Solved) => *solved = Interreflection::LeftOut,
                (false, _) => {}
            }
            let now = settings.radiosity;
            settings.radiosity = RadiositySettings {
                error: error.unwrap_or(now.error),
                finest: finest.unwrap_or(now.finest),
                pixels: pixels.unwrap_or(now.pixels),
                directions: directions.unwrap_or(now.directions),
                tolerance: tolerance.unwrap_or(now.tolerance),
            };
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        caustics(on: ON)
        "Lets light count that mirrors and glass throw from lamps; rays from the eye find it by chance only, and need very many samples. Without it, light goes through polished glass as if that did not bend it, less what it reflects and absorbs."
        "caustics();"
        |builder| {
            let caustics = &mut builder.scene.settings.light.caustics;
            match (on, *caustics) {
                (true, Caustics::LeftOut) => *caustics = Caustics::PathTraced,
                (false, Caustics::PathTraced) => *caustics = Caustics::LeftOut,
                _ => {}
            }
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        two_way(
            photons: setting(
                Integer(1, MAX_PHOTONS),
                PhotonSettings::DEFAULT.count,
                "how many photons are traced for eight samples of each pixel",
            ),
            radius: optional(
                NumberKind(0.0, f64::INFINITY),
                "a twentieth of the scene's diagonal",
                "the largest over which photons are spread, scene units",
            ),
            voxels: with_default(
                Integer(0, MAX_POINT_DEPTH),
                0,
                "as the paper has it, 2 to this power voxels are along the scene, and rays meet a point in each that stands for its surface: an approximation to about a voxel",
            )
            .note("none"),
            on: with_default(Flag, true, "whether it does; without it, --renderer two-way still may"),
        )
        "Traces photons from lamps through mirrors and glass and stores them where they arrive, before rays from the eye ask for them: caustics, as `--renderer two-way` shows them."
        "two_way(#{ photons: 500000 });"
        |builder| {
            let settings = &mut builder.scene.settings;
            match (on, &mut settings.light.caustics) {
                (true, caustics) => *caustics = Caustics::PhotonMapped,
                (false, mapped @ Caustics::PhotonMapped) => *mapped = Caustics::LeftOut,
                (false, _) => {}
            }
            settings.photons = PhotonSettings {
                count: photons.unwrap_or(settings.photons.count),
                radius: radius.filter(|radius| *radius > 0.0),
                point_depth: Some(voxels).filter(|depth| *depth > 0),
            };
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        exact_surfaces(on: ON_WITHOUT_A_WORD)
        "Leads rays on from triangles to the exact surfaces that they stand for; without them normals are interpolated between corners."
        "exact_surfaces(false);"
        |builder| {
            builder.scene.settings.geometry.exact_surfaces = on;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        detail(
            pixels: required(
                NumberKind(1.0 / MOST_DETAIL, MOST_DETAIL),
                "how small the detail is that they may leave out, pixels; 1 if nothing is said",
            ),
        )
        "Sets how finely procedural models are made: to what a pixel spans where they are seen, or to more or less of it."
        "detail(0.5);"
        |builder| {
            builder.scene.settings.geometry.detail = pixels;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        light_buffer(on: ON_WITHOUT_A_WORD)
        "Lets ray tracing keep what stands between the parts of the scene and its lights, for all views; pictures are the same without."
        "light_buffer(false);"
        |builder| {
            builder.scene.settings.light.buffer = on;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        spectral(on: with_default(Flag, true, "whether they do"))
        "Lets rays carry spectra, or three bands only, whatever the scene needs."
        "spectral();"
        |builder| {
            builder.scene.settings.light.spectral = Some(on);
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        tolerance(
            length: required(Length, "largest distance, scene units"),
            angle: setting(
                NumberKind(0.01, 180.0),
                GeometrySettings::DEFAULT.angle,
                "largest turn of the normal along a triangle, degrees",
            ),
        )
        "Sets how closely triangles follow the surfaces of all objects that have no tolerance of their own."
        "tolerance(0.001, 20);"
        |builder| {
            let geometry = &mut builder.scene.settings.geometry;
            geometry.tolerance = Some(length);
            geometry.angle = angle.unwrap_or(geometry.angle);
            Ok(Dynamic::UNIT)
        }
    },
];
