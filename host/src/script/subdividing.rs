//! Functions of the scene language that make smooth shapes of polyhedra by corner cutting, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::handle::{CallResult, Handle};
use super::kinds::{Indices, Length, NumberKind, PointsKind};
use super::parameter::{Optional, optional, required, with_default};
use super::shared::{OBJECT, TOLERANCE};
use crate::scene::{Cage, Shape, Sharp, Sharpening};
use crate::surface::Tolerance;
use rhai::Dynamic;

const STEPS: Optional<NumberKind> = optional(
    NumberKind(0.0, 1000.0),
    "for ever",
    "for so many steps it stays sharp; a part of a step makes it partly sharp",
);
/// Chord of the polyhedron that stands for a curved object, as a part of the object's size.
const COARSE: f64 = 1.0 / 20.0;

/// The functions that make and sharpen subdivided polyhedra.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        subdivision(
            points: required(PointsKind, "the vertices [x, y, z]"),
            faces: required(Indices, "the vertices of each face, counter-clockwise from outside"),
            tolerance: TOLERANCE,
        )
        "Adds the smooth limit of a polyhedron, closed or open, whose corners and edges are cut again and again, adaptively to the tolerance; see sharpen_creases() and the like."
        "let pebble = subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]);"
        |builder| {
            let cage = Cage { points, faces, sharpenings: Vec::new() };
            cage.polyhedron().map_err(|error| error.to_string())?;
            builder.add(Shape::Subdivision(Box::new(cage)), tolerance).map(Dynamic::from)
        }
    },
    function! {
        subdivide(
            object: OBJECT,
            coarse: optional(
                Length,
                "a twentieth of its size",
                "largest distance between a curved object and the polyhedron, own units",
            ),
        )
        "Makes an object the smooth limit of its triangles, which then are the polyhedron: for meshes from files and solids of flat faces."
        "let cushion = box(3, 1, 3).subdivide();"
        |builder| subdivide(builder, object, coarse)
    },
    function! {
        sharpen_creases(object: OBJECT, angle: with_default(NumberKind(0.0, 180.0), 30.0, "degrees"), steps: STEPS)
        "Keeps all edges of a subdivided polyhedron sharp at which two faces meet at more than an angle."
        "let worn = box(2, 1, 1).subdivide().sharpen_creases(30, 1.5);"
        |builder| sharpen(builder, object, Sharpening { of: Sharp::Creases(angle), steps })
    },
    function! {
        sharpen_edges(
            object: OBJECT,
            edges: required(Indices, "the two vertices of each edge, counted from 0: [[0, 1], ...]"),
            steps: STEPS,
        )
        "Keeps some edges of a subdivided polyhedron sharp."
        "subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]).sharpen_edges([[0, 1], [2, 3]]);"
        |builder| {
            let pair = |edge: &Vec<u32>| <[u32; 2]>::try_from(edge.as_slice()).ok();
            let edges: Option<Vec<[u32; 2]>> = edges.iter().map(pair).collect();
            let edges = edges.ok_or("edges must be pairs of vertices [[0, 1], ...]")?;
            sharpen(builder, object, Sharpening { of: Sharp::Edges(edges), steps })
        }
    },
    function! {
        sharpen_vertices(object: OBJECT, vertices: required(Indices, "their numbers, counted from 0"), steps: STEPS)
        "Keeps some vertices of a subdivided polyhedron sharp: the surface comes to a point there."
        "let onion = subdivision([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]).sharpen_vertices([0]);"
        |builder| sharpen(builder, object, Sharpening { of: Sharp::Vertices(vertices.concat()), steps })
    },
];

fn subdivide(builder: &mut Builder, handle: Handle, coarse: Option<f64>) -> CallResult {
    let angle = builder.scene.settings.geometry.angle;
    let object = builder.object(handle)?;
    let chord = coarse.unwrap_or(COARSE * object.shape.extent().unwrap_or(1.0));
    let made = object.shape.tessellate(Tolerance::new(chord, angle)).map_err(|error| error.to_string())?;
    let mesh = made.mesh.welded();
    let faces = mesh.triangles.iter().map(|corners| corners.to_vec()).collect();
    let cage = Cage { points: mesh.vertices, faces, sharpenings: Vec::new() };
    cage.polyhedron().map_err(|error| error.to_string())?;
    object.shape = Shape::Subdivision(Box::new(cage));
    Ok(Dynamic::from(handle))
}

fn sharpen(builder: &mut Builder, handle: Handle, sharpening: Sharpening) -> CallResult {
    let object = builder.object(handle)?;
    let Shape::Subdivision(cage) = &mut object.shape else {
        return Err(format!("{} is no subdivided polyhedron", object.name));
    };
    cage.sharpenings.push(sharpening);
    cage.polyhedron().map_err(|error| error.to_string())?;
    Ok(Dynamic::from(handle))
}
