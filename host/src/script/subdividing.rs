//! Functions of the scene language that make smooth shapes of polyhedra by cutting and grinding, one row each.

use super::argument::Bound;
use super::builder::{Builder, value};
use super::function::Function;
use super::handle::Done;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, OBJECT, Parameter, TOLERANCE, parameter};
use crate::scene::{Cage, Shape, Sharp, Sharpening};
use crate::surface::Tolerance;
use rhai::Dynamic;

const STEPS: Parameter = parameter(
    "steps",
    Kind::Number(0.0, 1000.0),
    Is("for ever"),
    "for so many steps it stays sharp; a part of a step makes it partly sharp",
);
/// Chord of the polyhedron that stands for a curved object, as a part of the object's size.
const COARSE: f64 = 1.0 / 20.0;

/// The functions that make and sharpen subdivided polyhedra.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "subdivision",
        summary: "Adds the smooth limit of a polyhedron, closed or open, of which corners are cut and edges ground again and again, adaptively to the tolerance; see sharpen_creases() and the like.",
        parameters: &[
            parameter("points", Kind::Points, Required, "the vertices [x, y, z]"),
            parameter("faces", Kind::Indices, Required, "the vertices of each face, counter-clockwise from outside"),
            TOLERANCE,
        ],
        example: "let pebble = subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]);",
        action: |builder, bound| {
            let (points, faces) = (bound.contours("points").concat(), bound.indices("faces").unwrap_or_default());
            let cage = Cage { points, faces, sharpenings: Vec::new() };
            cage.polyhedron().map_err(|error| error.to_string())?;
            builder.add(Shape::Subdivision(Box::new(cage)), bound.number("tolerance")).map(Dynamic::from)
        },
    },
    Function {
        name: "subdivide",
        summary: "Makes an object the smooth limit of its triangles, which then are the polyhedron: for meshes from files and solids of flat faces.",
        parameters: &[
            OBJECT,
            parameter(
                "coarse",
                Kind::Length,
                Is("a twentieth of its size"),
                "largest distance between a curved object and the polyhedron, own units",
            ),
        ],
        example: "let cushion = box(3, 1, 3).subdivide();",
        action: subdivide,
    },
    Function {
        name: "sharpen_creases",
        summary: "Keeps all edges of a subdivided polyhedron sharp at which two faces meet at more than an angle.",
        parameters: &[OBJECT, parameter("angle", Kind::Number(0.0, 180.0), Is("30"), "degrees"), STEPS],
        example: "let worn = box(2, 1, 1).subdivide().sharpen_creases(30, 1.5);",
        action: |builder, bound| sharpen(builder, bound, Sharp::Creases(bound.number("angle").unwrap_or(30.0))),
    },
    Function {
        name: "sharpen_edges",
        summary: "Keeps some edges of a subdivided polyhedron sharp.",
        parameters: &[
            OBJECT,
            parameter("edges", Kind::Indices, Required, "the two vertices of each edge, counted from 0: [[0, 1], ...]"),
            STEPS,
        ],
        example: "subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]).sharpen_edges([[0, 1], [2, 3]]);",
        action: |builder, bound| {
            let pair = |edge: &Vec<u32>| <[u32; 2]>::try_from(edge.as_slice()).ok();
            let edges: Option<Vec<[u32; 2]>> = bound.indices("edges").unwrap_or_default().iter().map(pair).collect();
            sharpen(builder, bound, Sharp::Edges(edges.ok_or("edges must be pairs of vertices [[0, 1], ...]")?))
        },
    },
    Function {
        name: "sharpen_vertices",
        summary: "Keeps some vertices of a subdivided polyhedron sharp: the surface comes to a point there.",
        parameters: &[OBJECT, parameter("vertices", Kind::Indices, Required, "their numbers, counted from 0"), STEPS],
        example: "let onion = subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]).sharpen_vertices([0]);",
        action: |builder, bound| {
            sharpen(builder, bound, Sharp::Vertices(bound.indices("vertices").unwrap_or_default().concat()))
        },
    },
];

fn subdivide(builder: &mut Builder, bound: &Bound) -> Done {
    let (handle, angle) = (bound.object("object"), builder.scene.settings.geometry.angle);
    let object = builder.object(handle)?;
    let chord = bound.number("coarse").unwrap_or(COARSE * object.shape.extent().unwrap_or(1.0));
    let made = object.shape.made(Tolerance::new(chord, angle)).map_err(|error| error.to_string())?;
    let mesh = made.mesh.welded();
    let faces = mesh.triangles.iter().map(|corners| corners.to_vec()).collect();
    let cage = Cage { points: mesh.vertices, faces, sharpenings: Vec::new() };
    cage.polyhedron().map_err(|error| error.to_string())?;
    object.shape = Shape::Subdivision(Box::new(cage));
    Ok(value(handle))
}

fn sharpen(builder: &mut Builder, bound: &Bound, of: Sharp) -> Done {
    let handle = bound.object("object");
    let object = builder.object(handle)?;
    let Shape::Subdivision(cage) = &mut object.shape else {
        return Err(format!("{} is no subdivided polyhedron", object.name));
    };
    cage.sharpenings.push(Sharpening { of, steps: bound.number("steps") });
    cage.polyhedron().map_err(|error| error.to_string())?;
    Ok(value(handle))
}
