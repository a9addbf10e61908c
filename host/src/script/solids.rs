//! Functions of the scene language that make solids and combine them, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::CallResult;
use super::kinds::{
    ANY_NUMBER, AxisKind, Contours, CurveKind, Flag, Integer, Length, Lengths, NumberKind, ObjectKind, PointsKind,
    Vector,
};
use super::parameter::{Defaulted, Required, required, with_default};
use super::shared::{OBJECT, TOLERANCE};
use crate::scene::{Operation, PrimitiveSolid, Shape};
use crate::solid::Primitive;
use glam::{DVec2, DVec3};
use rhai::Dynamic;

const OTHER: Required<ObjectKind> = required(ObjectKind, "the other object; both must be closed");
const CONTOURS: Required<Contours> = required(
    Contours,
    "corners [x, y] of the polygon, or of several contours: what is in an odd number of them is inside",
);
const HEIGHT: Defaulted<Length, f64> = with_default(Length, 1.0, "its height");
const DISCS: Defaulted<Length, f64> = with_default(Length, 1.0, "radius of the discs");
const POINT_OF_PLANE: Defaulted<Vector, [f64; 3]> = with_default(Vector, [0.0; 3], "a point of the plane");

/// The functions that make solids and combine them.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        sphere(radius: with_default(Length, 1.0, "its radius"), tolerance: TOLERANCE)
        "Adds a sphere around the origin."
        "let ball = sphere(0.5);"
        |builder| add(builder, Primitive::Sphere { radius }, tolerance)
    },
    function! {
        ellipsoid(radii: with_default(Lengths, 1.0, "its half axes"), tolerance: TOLERANCE)
        "Adds an ellipsoid around the origin, its axes along x, y and z."
        "let egg = ellipsoid(1, 1.4, 1);"
        |builder| add(builder, Primitive::Ellipsoid { radii }, tolerance)
    },
    function! {
        box(size: with_default(Lengths, 1.0, "its sides along x, y and z"))
        "Adds a box around the origin, its sides along the axes."
        "let brick = box(4, 1, 2);"
        |builder| add(builder, Primitive::Box { size }, None)
    },
    function! {
        cube(size: with_default(Lengths, 1.0, "its side"))
        "Adds a cube around the origin; a box with equal sides."
        "let die = cube(2);"
        |builder| add(builder, Primitive::Box { size }, None)
    },
    function! {
        wedge(
            size: with_default(Lengths, 1.0, "its sides along x, y and z"),
            top: with_default(NumberKind(0.0, f64::INFINITY), 0.0, "length of the top along x"),
        )
        "Adds a box around the origin whose top is shortened to an edge or a strip at the side of least x."
        "let ramp = wedge(#{ size: [3, 1, 2], top: 0.5 });"
        |builder| add(builder, Primitive::Wedge { size, top }, None)
    },
    function! {
        pyramid(
            radius: with_default(Length, 1.0, "from the middle of the base to its corners"),
            height: HEIGHT,
            sides: with_default(Integer(3usize, 100_000), 4, "sides of the base"),
        )
        "Adds a pyramid over a regular base, its tip up, the middle of its height at the origin."
        "let roof = pyramid(2, 1, 6);"
        |builder| add(builder, Primitive::Pyramid { sides, radius, height }, None)
    },
    function! {
        cylinder(radius: with_default(Length, 1.0, "its radius"), height: HEIGHT, tolerance: TOLERANCE)
        "Adds a cylinder around the origin, its axis along y."
        "let drill = cylinder(0.2, 5).rotate(\"x\", 90);"
        |builder| add(builder, Primitive::Cylinder { radius, height }, tolerance)
    },
    function! {
        cone(
            radius: with_default(Length, 1.0, "radius below"),
            height: HEIGHT,
            top: with_default(NumberKind(0.0, f64::INFINITY), 0.0, "radius above"),
            tolerance: TOLERANCE,
        )
        "Adds a cone or a frustum, its axis along y, the middle of its height at the origin."
        "let cup = cone(#{ radius: 0.6, top: 1, height: 2 });"
        |builder| add(builder, Primitive::Cone { radius, top, height }, tolerance)
    },
    function! {
        paraboloid(
            radius: with_default(Length, 1.0, "radius of the disc"),
            height: HEIGHT,
            tolerance: TOLERANCE,
        )
        "Adds a paraboloid, its tip up, closed by a disc, the middle of its height at the origin."
        "let nose = paraboloid(1, 3);"
        |builder| add(builder, Primitive::Paraboloid { radius, height }, tolerance)
    },
    function! {
        hyperboloid(
            waist: with_default(Length, 0.5, "least radius"),
            radius: DISCS,
            height: with_default(Length, 2.0, "its height"),
            tolerance: TOLERANCE,
        )
        "Adds a hyperboloid of one sheet between two discs, its axis along y, around the origin."
        "let tower = hyperboloid(0.6, 1, 3);"
        |builder| add(builder, Primitive::HyperboloidOfOneSheet { waist, radius, height }, tolerance)
    },
    function! {
        bowls(
            gap: with_default(Length, 1.0, "between the tips"),
            radius: DISCS,
            height: with_default(Length, 3.0, "of both together"),
            tolerance: TOLERANCE,
        )
        "Adds a hyperboloid of two sheets, their tips towards each other, closed by discs."
        "let lenses = bowls(0.5, 1, 2);"
        |builder| add(builder, Primitive::HyperboloidOfTwoSheets { gap, radius, height }, tolerance)
    },
    function! {
        torus(
            ring: with_default(Length, 1.0, "radius of the circle in the middle of the tube"),
            tube: with_default(Length, 0.25, "radius of the tube, less than that of the ring"),
            tolerance: TOLERANCE,
        )
        "Adds a torus around the origin, its axis along y."
        "let tyre = torus(1, 0.3);"
        |builder| add(builder, Primitive::Torus { ring, tube }, tolerance)
    },
    function! {
        prism(contours: CONTOURS, height: with_default(Length, 1.0, "how far, from z = 0 on"))
        "Adds a polygon of the plane of x and y that was moved along z."
        "let plate = prism([[[0, 0], [4, 0], [4, 3], [0, 3]], [[1, 1], [1, 2], [2, 1]]], 0.2);"
        |builder| add(builder, Primitive::Prism { contours: flat(contours), height }, None)
    },
    function! {
        turning(
            contours: CONTOURS,
            angle: with_default(NumberKind(0.0, 360.0), 360.0, "how far, degrees"),
            tolerance: TOLERANCE,
        )
        "Adds a polygon of the plane of x and y, with x not below 0, revolved about the y axis from the z axis on towards the x axis."
        "let slice = turning([[0, 0], [2, 0], [2, 1], [0, 1]], 60);"
        |builder| add(builder, Primitive::RevolvedPolygon { contours: flat(contours), turn: angle / 360.0 }, tolerance)
    },
    function! {
        revolution(
            profile: required(
                PointsKind,
                "points [r, y, bulge]; the bulge is the tangent of a quarter of the angle of the arc to the next point, positive if it turns left, 0 for a line",
            ),
            tolerance: TOLERANCE,
        )
        "Adds the solid of a closed profile of lines and arcs revolved about the y axis."
        "let pawn = revolution([[0, 0], [1, 0], [0.4, 1.2], [0.25, 1.5, 0.8], [0, 2]]);"
        |builder| add(builder, Primitive::Revolution { profile }, tolerance)
    },
    function! {
        lathe(
            profile: required(PointsKind, "control points [r, y]; the curve begins in the first and ends in the last"),
            tolerance: TOLERANCE,
        )
        "Adds the solid of a smooth profile revolved about the y axis: the cubic B-spline of some points, closed over the axis."
        "let vase = lathe([[1, 0], [1.4, 1], [0.3, 2], [0.8, 3]]);"
        |builder| add(builder, Primitive::SmoothRevolution { profile: flat([profile]).concat() }, tolerance)
    },
    function! {
        sweep(
            contours: CONTOURS,
            path: required(
                CurveKind,
                "the curve, or control points of the cubic B-spline that begins in the first and ends in the last",
            ),
            closed: with_default(Flag, false, "whether the curve of control points is closed"),
            twist: with_default(ANY_NUMBER, 0.0, "how far the polygon is twisted about the curve, degrees"),
            taper: with_default(NumberKind(0.0, 1e6), 1.0, "how much wider the polygon is at the end"),
            tolerance: TOLERANCE,
        )
        "Adds the solid of a polygon swept along a curve, square to it."
        "let horn = sweep(#{ contours: [[-1, -1], [1, -1], [0, 1]], path: [[0, 0, 0], [0, 5, 0], [5, 5, 0]], taper: 0.2 });"
        |builder| {
            let path = Box::new(path.curve(closed)?);
            add(builder, Primitive::Sweep { contours: flat(contours), path, twist: twist / 360.0, taper }, tolerance)
        }
    },
    function! {
        half_space(normal: required(AxisKind, "towards the empty side"), at: POINT_OF_PLANE)
        "Adds all that is behind a plane; it must be combined with solids that have an end."
        "let dome = sphere(1) - half_space(\"y\");"
        |builder| builder.add(Shape::HalfSpace { normal, at }, None).map(Dynamic::from)
    },
    function! {
        union(object: OBJECT, other: OTHER)
        "Makes one solid of two objects, that what is in either; also a + b."
        "let dumbbell = sphere(1).translate(-2, 0, 0) + sphere(1).translate(2, 0, 0) + box(4, 0.5, 0.5);"
        |builder| builder.combine(Operation::Union, object, other)
    },
    function! {
        intersection(object: OBJECT, other: OTHER)
        "Makes one solid of two objects, that what is in both; also a * b."
        "let lens = sphere(2).translate(0, 0, -1.5) * sphere(2).translate(0, 0, 1.5);"
        |builder| builder.combine(Operation::Intersection, object, other)
    },
    function! {
        difference(object: OBJECT, other: OTHER)
        "Makes one solid of two objects, what is in the first and not in the second; also a - b."
        "let bowl = sphere(1) - sphere(0.9) - box(3, 1, 3).translate(0, 0.5, 0);"
        |builder| builder.combine(Operation::Difference, object, other)
    },
    function! {
        symmetric_difference(object: OBJECT, other: OTHER)
        "Makes one solid of two objects, what is in one of them and not in both; also a ^ b."
        "let rings = cylinder(1, 1) ^ cylinder(0.5, 2);"
        |builder| builder.combine(Operation::SymmetricDifference, object, other)
    },
    function! {
        split(
            object: OBJECT,
            normal: required(AxisKind, "what the plane is square to, towards the front"),
            at: POINT_OF_PLANE,
        )
        "Divides a solid by a plane: the object keeps what is behind it; what is in front is the new object that is returned."
        "let cap = ball.split(\"y\", [0, 0.5, 0]).translate(0, 1, 0);"
        |builder| builder.split(object, normal, at)
    },
];

/// Adds a solid if there is one of these measures.
fn add(builder: &mut Builder, primitive: Primitive, tolerance: Option<f64>) -> CallResult {
    let solid = PrimitiveSolid::from(primitive);
    solid.body().map_err(|error| error.to_string())?;
    builder.add(Shape::Solid(solid), tolerance).map(Dynamic::from)
}

/// Contours of the plane of x and y.
fn flat(contours: impl IntoIterator<Item = Vec<DVec3>>) -> Vec<Vec<DVec2>> {
    contours.into_iter().map(|contour| contour.into_iter().map(DVec3::truncate).collect()).collect()
}
