//! Functions of the scene language that make solids and combine them, one row each.

use super::argument::Bound;
use super::builder::Builder;
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, Parameter, TOLERANCE, parameter};
use crate::scene::{Operation, Shape, Solid};
use crate::solid::Primitive;
use glam::{DVec2, DVec3};
use rhai::Dynamic;

const OTHER: Parameter = parameter("other", Kind::Object, Required, "the other object; both must be closed");
const CONTOURS: Parameter = parameter(
    "contours",
    Kind::Contours,
    Required,
    "corners [x, y] of the polygon, or of several contours: what is in an odd number of them is inside",
);
const ANY: Kind = Kind::Number(f64::NEG_INFINITY, f64::INFINITY);

/// The functions that make solids and combine them.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "sphere",
        summary: "Adds a sphere around the origin.",
        parameters: &[parameter("radius", Kind::Length, Is("1"), "its radius"), TOLERANCE],
        example: "let ball = sphere(0.5);",
        action: |builder, bound| add(builder, bound, Primitive::Sphere { radius: length(bound, "radius", 1.0) }),
    },
    Function {
        name: "ellipsoid",
        summary: "Adds an ellipsoid around the origin, its axes along x, y and z.",
        parameters: &[parameter("radii", Kind::Lengths, Is("1"), "its half axes"), TOLERANCE],
        example: "let egg = ellipsoid(1, 1.4, 1);",
        action: |builder, bound| {
            add(builder, bound, Primitive::Ellipsoid { radii: bound.vector("radii").unwrap_or(DVec3::ONE) })
        },
    },
    Function {
        name: "box",
        summary: "Adds a box around the origin, its sides along the axes.",
        parameters: &[parameter("size", Kind::Lengths, Is("1"), "its sides along x, y and z")],
        example: "let brick = box(4, 1, 2);",
        action: add_box,
    },
    Function {
        name: "cube",
        summary: "Adds a cube around the origin; a box with equal sides.",
        parameters: &[parameter("size", Kind::Lengths, Is("1"), "its side")],
        example: "let die = cube(2);",
        action: add_box,
    },
    Function {
        name: "wedge",
        summary: "Adds a box around the origin whose top is shortened to an edge or a strip at the side of least x.",
        parameters: &[
            parameter("size", Kind::Lengths, Is("1"), "its sides along x, y and z"),
            parameter("top", Kind::Number(0.0, f64::INFINITY), Is("0"), "length of the top along x"),
        ],
        example: "let ramp = wedge(#{ size: [3, 1, 2], top: 0.5 });",
        action: |builder, bound| {
            add(
                builder,
                bound,
                Primitive::Wedge {
                    size: bound.vector("size").unwrap_or(DVec3::ONE),
                    top: bound.number("top").unwrap_or(0.0),
                },
            )
        },
    },
    Function {
        name: "pyramid",
        summary: "Adds a pyramid over a regular base, its tip up, the middle of its height at the origin.",
        parameters: &[
            parameter("radius", Kind::Length, Is("1"), "from the middle of the base to its corners"),
            parameter("height", Kind::Length, Is("1"), "its height"),
            parameter("sides", Kind::Integer(3, 100_000), Is("4"), "sides of the base"),
        ],
        example: "let roof = pyramid(2, 1, 6);",
        action: |builder, bound| {
            let (radius, height) = (length(bound, "radius", 1.0), length(bound, "height", 1.0));
            let sides = bound.integer("sides").and_then(|sides| usize::try_from(sides).ok()).unwrap_or(4);
            add(builder, bound, Primitive::Pyramid { sides, radius, height })
        },
    },
    Function {
        name: "cylinder",
        summary: "Adds a cylinder around the origin, its axis along y.",
        parameters: &[
            parameter("radius", Kind::Length, Is("1"), "its radius"),
            parameter("height", Kind::Length, Is("1"), "its height"),
            TOLERANCE,
        ],
        example: "let drill = cylinder(0.2, 5).rotate(\"x\", 90);",
        action: |builder, bound| {
            let (radius, height) = (length(bound, "radius", 1.0), length(bound, "height", 1.0));
            add(builder, bound, Primitive::Cylinder { radius, height })
        },
    },
    Function {
        name: "cone",
        summary: "Adds a cone or a frustum, its axis along y, the middle of its height at the origin.",
        parameters: &[
            parameter("radius", Kind::Length, Is("1"), "radius below"),
            parameter("height", Kind::Length, Is("1"), "its height"),
            parameter("top", Kind::Number(0.0, f64::INFINITY), Is("0"), "radius above"),
            TOLERANCE,
        ],
        example: "let cup = cone(#{ radius: 0.6, top: 1, height: 2 });",
        action: |builder, bound| {
            let (radius, height) = (length(bound, "radius", 1.0), length(bound, "height", 1.0));
            add(builder, bound, Primitive::Cone { radius, top: bound.number("top").unwrap_or(0.0), height })
        },
    },
    Function {
        name: "paraboloid",
        summary: "Adds a paraboloid, its tip up, closed by a disc, the middle of its height at the origin.",
        parameters: &[
            parameter("radius", Kind::Length, Is("1"), "radius of the disc"),
            parameter("height", Kind::Length, Is("1"), "its height"),
            TOLERANCE,
        ],
        example: "let nose = paraboloid(1, 3);",
        action: |builder, bound| {
            let (radius, height) = (length(bound, "radius", 1.0), length(bound, "height", 1.0));
            add(builder, bound, Primitive::Paraboloid { radius, height })
        },
    },
    Function {
        name: "hyperboloid",
        summary: "Adds a hyperboloid of one sheet between two discs, its axis along y, around the origin.",
        parameters: &[
            parameter("waist", Kind::Length, Is("0.5"), "least radius"),
            parameter("radius", Kind::Length, Is("1"), "radius of the discs"),
            parameter("height", Kind::Length, Is("2"), "its height"),
            TOLERANCE,
        ],
        example: "let tower = hyperboloid(0.6, 1, 3);",
        action: |builder, bound| {
            let (waist, radius) = (length(bound, "waist", 0.5), length(bound, "radius", 1.0));
            add(builder, bound, Primitive::Hyperboloid { waist, radius, height: length(bound, "height", 2.0) })
        },
    },
    Function {
        name: "bowls",
        summary: "Adds a hyperboloid of two sheets, closed by discs: two bowls with their tips towards each other.",
        parameters: &[
            parameter("gap", Kind::Length, Is("1"), "between the tips"),
            parameter("radius", Kind::Length, Is("1"), "radius of the discs"),
            parameter("height", Kind::Length, Is("3"), "of both together"),
            TOLERANCE,
        ],
        example: "let lenses = bowls(0.5, 1, 2);",
        action: |builder, bound| {
            let (gap, radius) = (length(bound, "gap", 1.0), length(bound, "radius", 1.0));
            add(builder, bound, Primitive::Bowls { gap, radius, height: length(bound, "height", 3.0) })
        },
    },
    Function {
        name: "torus",
        summary: "Adds a torus around the origin, its axis along y.",
        parameters: &[
            parameter("ring", Kind::Length, Is("1"), "radius of the circle in the middle of the tube"),
            parameter("tube", Kind::Length, Is("0.25"), "radius of the tube, less than that of the ring"),
            TOLERANCE,
        ],
        example: "let tyre = torus(1, 0.3);",
        action: |builder, bound| {
            let (ring, tube) = (length(bound, "ring", 1.0), length(bound, "tube", 0.25));
            add(builder, bound, Primitive::Torus { ring, tube })
        },
    },
    Function {
        name: "prism",
        summary: "Adds a polygon of the plane of x and y that was moved along z.",
        parameters: &[CONTOURS, parameter("height", Kind::Length, Is("1"), "how far, from z = 0 on")],
        example: "let plate = prism([[[0, 0], [4, 0], [4, 3], [0, 3]], [[1, 1], [1, 2], [2, 1]]], 0.2);",
        action: |builder, bound| {
            add(builder, bound, Primitive::Prism { contours: flat(bound), height: length(bound, "height", 1.0) })
        },
    },
    Function {
        name: "turning",
        summary: "Adds a polygon of the plane of x and y, with x not below 0, that turned about the y axis from the z axis on towards the x axis.",
        parameters: &[CONTOURS, parameter("angle", Kind::Number(0.0, 360.0), Is("360"), "how far, degrees"), TOLERANCE],
        example: "let slice = turning([[0, 0], [2, 0], [2, 1], [0, 1]], 60);",
        action: |builder, bound| {
            let turn = bound.number("angle").unwrap_or(360.0) / 360.0;
            add(builder, bound, Primitive::Turning { contours: flat(bound), turn })
        },
    },
    Function {
        name: "revolution",
        summary: "Adds the solid of a closed profile of lines and arcs that turned about the y axis.",
        parameters: &[
            parameter(
                "profile",
                Kind::Points,
                Required,
                "points [r, y, bulge]; the bulge is the tangent of a quarter of the angle of the arc to the next point, positive if it turns left, 0 for a line",
            ),
            TOLERANCE,
        ],
        example: "let pawn = revolution([[0, 0], [1, 0], [0.4, 1.2], [0.25, 1.5, 0.8], [0, 2]]);",
        action: |builder, bound| {
            let profile = bound.contours("profile").concat();
            add(builder, bound, Primitive::Revolution { profile })
        },
    },
    Function {
        name: "lathe",
        summary: "Adds the solid of a smooth profile that turned about the y axis: the cubic B-spline of some points, closed over the axis.",
        parameters: &[
            parameter(
                "profile",
                Kind::Points,
                Required,
                "control points [r, y]; the curve begins in the first and ends in the last",
            ),
            TOLERANCE,
        ],
        example: "let vase = lathe([[1, 0], [1.4, 1], [0.3, 2], [0.8, 3]]);",
        action: |builder, bound| {
            let profile = bound.contours("profile").concat().into_iter().map(|point| point.truncate()).collect();
            add(builder, bound, Primitive::Lathe { profile })
        },
    },
    Function {
        name: "sweep",
        summary: "Adds the solid of a polygon that went along a curve, square to it.",
        parameters: &[
            CONTOURS,
            parameter(
                "path",
                Kind::Curve,
                Required,
                "the curve, or control points of the cubic B-spline that begins in the first and ends in the last",
            ),
            parameter("closed", Kind::Flag, Is("false"), "whether the curve of control points is closed"),
            parameter("twist", ANY, Is("0"), "how far the polygon turns about the curve, degrees"),
            parameter("taper", Kind::Number(0.0, 1e6), Is("1"), "how much wider the polygon is at the end"),
            TOLERANCE,
        ],
        example: "let horn = sweep(#{ contours: [[-1, -1], [1, -1], [0, 1]], path: [[0, 0, 0], [0, 5, 0], [5, 5, 0]], taper: 0.2 });",
        action: |builder, bound| {
            let path = bound.curve("path", bound.flag("closed").unwrap_or(false))?.ok_or("path is missing")?;
            let sweep = Primitive::Sweep {
                contours: flat(bound),
                path: Box::new(path),
                twist: bound.number("twist").unwrap_or(0.0) / 360.0,
                taper: bound.number("taper").unwrap_or(1.0),
            };
            add(builder, bound, sweep)
        },
    },
    Function {
        name: "half_space",
        summary: "Adds all that is behind a plane; it must be combined with solids that have an end.",
        parameters: &[
            parameter("normal", Kind::Axis, Required, "towards the empty side"),
            parameter("at", Kind::Vector, Is("[0, 0, 0]"), "a point of the plane"),
        ],
        example: "let dome = sphere(1) - half_space(\"y\");",
        action: |builder, bound| {
            let (normal, at) = (bound.vector("normal").unwrap_or(DVec3::Y), bound.vector("at").unwrap_or_default());
            builder.add(Shape::HalfSpace { normal, at }, None).map(Dynamic::from)
        },
    },
    Function {
        name: "union",
        summary: "Makes one solid of two objects, that what is in either; also a + b.",
        parameters: &[OBJECT, OTHER],
        example: "let dumbbell = sphere(1).translate(-2, 0, 0) + sphere(1).translate(2, 0, 0) + box(4, 0.5, 0.5);",
        action: |builder, bound| builder.combine(Operation::Union, bound.object("object"), bound.object("other")),
    },
    Function {
        name: "intersection",
        summary: "Makes one solid of two objects, that what is in both; also a * b.",
        parameters: &[OBJECT, OTHER],
        example: "let lens = sphere(2).translate(0, 0, -1.5) * sphere(2).translate(0, 0, 1.5);",
        action: |builder, bound| {
            builder.combine(Operation::Intersection, bound.object("object"), bound.object("other"))
        },
    },
    Function {
        name: "difference",
        summary: "Makes one solid of two objects, what is in the first and not in the second; also a - b.",
        parameters: &[OBJECT, OTHER],
        example: "let bowl = sphere(1) - sphere(0.9) - box(3, 1, 3).translate(0, 0.5, 0);",
        action: |builder, bound| builder.combine(Operation::Difference, bound.object("object"), bound.object("other")),
    },
    Function {
        name: "symmetric_difference",
        summary: "Makes one solid of two objects, what is in one of them and not in both; also a ^ b.",
        parameters: &[OBJECT, OTHER],
        example: "let rings = cylinder(1, 1) ^ cylinder(0.5, 2);",
        action: |builder, bound| {
            builder.combine(Operation::SymmetricDifference, bound.object("object"), bound.object("other"))
        },
    },
    Function {
        name: "split",
        summary: "Divides a solid by a plane: the object keeps what is behind it; what is in front is the new object that is returned.",
        parameters: &[
            OBJECT,
            parameter("normal", Kind::Axis, Required, "what the plane is square to, towards the front"),
            parameter("at", Kind::Vector, Is("[0, 0, 0]"), "a point of the plane"),
        ],
        example: "let cap = ball.split(\"y\", [0, 0.5, 0]).translate(0, 1, 0);",
        action: |builder, bound| {
            let (normal, at) = (bound.vector("normal").unwrap_or(DVec3::Y), bound.vector("at").unwrap_or_default());
            builder.split(bound.object("object"), normal, at)
        },
    },
];

/// Adds a solid if there is one of these measures.
fn add(builder: &mut Builder, bound: &Bound, primitive: Primitive) -> Done {
    let solid = Solid::from(primitive);
    solid.body().map_err(|error| error.to_string())?;
    builder.add(Shape::Solid(solid), bound.number("tolerance")).map(Dynamic::from)
}

fn add_box(builder: &mut Builder, bound: &Bound) -> Done {
    add(builder, bound, Primitive::Box { size: bound.vector("size").unwrap_or(DVec3::ONE) })
}

fn length(bound: &Bound, name: &str, default: f64) -> f64 {
    bound.number(name).unwrap_or(default)
}

/// The contours of a polygon.
fn flat(bound: &Bound) -> Vec<Vec<DVec2>> {
    let contours = bound.contours("contours").into_iter();
    contours.map(|contour| contour.into_iter().map(|point| point.truncate()).collect()).collect()
}
