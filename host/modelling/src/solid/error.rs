//! Errors of meshes that are no solids.

use crate::mesh::Fault;
use glam::DVec3;

/// Loops that an error names.
const NAMED_LOOPS: usize = 4;

/// A fault that keeps a mesh from being a solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// A number or an index is wrong.
    #[error(transparent)]
    Mesh(#[from] Fault),
    /// Edges are traversed more often one way than the other: there is a hole, or triangles are oriented against each
    /// other.
    #[error("{count} edges are not closed or not consistently oriented, the first {}", list(edges))]
    NotClosed {
        /// How many edges.
        count: usize,
        /// The ends of the first of them.
        edges: Vec<[DVec3; 2]>,
    },
    /// Loops of edges bound the surface, and no patch was found that closes them without meeting the surface.
    #[error("the surface is open: {}", list_loops(loops))]
    Open {
        /// The loops that stay open, the longest first.
        loops: Vec<OpenLoop>,
    },
    /// Triangles face inwards: all, or those of shells that lie in no other.
    #[error("{}", turned(*bodies, *of, *volume, *near))]
    InsideOut {
        /// Shells that face inwards.
        bodies: usize,
        /// Shells in all.
        of: usize,
        /// The volume of the largest of these, cubic units.
        volume: f64,
        /// A corner of it.
        near: DVec3,
    },
    /// The winding number of the surface is 0 everywhere: its triangles lie back to back or have no area.
    #[error("the surface bounds nothing: its triangles lie back to back or have no area")]
    BoundsNothing,
    /// The surface crosses or covers itself, or parts of it lie in each other.
    #[error(
        "the surface crosses or covers itself ({overlaps} pairs of triangles): near {near} a point has the winding number {winding}"
    )]
    Crossing {
        /// The winding number there; 1 behind the surface of a solid.
        winding: i32,
        /// Where.
        near: DVec3,
        /// Pairs of triangles that have more in common than corners and edges; 0 if parts only lie in each other.
        overlaps: usize,
    },
    /// The result of an operation crosses itself when its points are rounded, and moving them by some roundings did not
    /// mend it.
    #[error(
        "rounded to numbers, the result crosses itself ({overlaps} pairs of triangles, the first near {near}), and \
         moving its points by up to {most} units in the last place does not mend it; moving an operand by a millionth of its \
         size may help"
    )]
    SelfIntersecting {
        /// Pairs of triangles that have more in common than corners and edges.
        overlaps: usize,
        /// A corner of the first.
        near: DVec3,
        /// How far points might be moved, in units in the last place of the largest coordinate.
        most: f64,
    },
    /// The surface crosses itself so often that it is neither repaired nor are all crossings counted.
    #[error("the surface crosses itself too often to be repaired: more than {most} {what}")]
    TooManyIntersections {
        /// Of what there are too many.
        what: &'static str,
        /// How many there may be.
        most: usize,
    },
}

fn list(edges: &[[DVec3; 2]]) -> String {
    edges.iter().map(|[a, b]| format!("{a} to {b}")).collect::<Vec<_>>().join(", ")
}

/// A loop of edges that bounds a surface, and why it stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLoop {
    /// Number of its edges.
    pub edges: usize,
    /// Length, units.
    pub length: f64,
    /// Its first corner.
    pub near: DVec3,
}

fn list_loops(loops: &[OpenLoop]) -> String {
    let named = loops
        .iter()
        .take(NAMED_LOOPS)
        .map(|OpenLoop { edges, length, near }| format!("{edges} edges of length {length:.4} near {near:.4}"));
    let named: Vec<String> = named.collect();
    let more = loops.len().saturating_sub(named.len());
    let more = if more == 0 { String::new() } else { format!(", and {more} more") };
    let one = if loops.len() == 1 { "a loop" } else { "loops" };
    format!("every patch for {one} of {}{more} meets the surface", named.join(", "))
}

fn turned(bodies: usize, of: usize, volume: f64, near: DVec3) -> String {
    match of {
        1 => format!("the surface faces inwards: its volume is {volume}"),
        _ => format!("{bodies} of {of} shells face inwards, the largest near {near}: its volume is {volume}"),
    }
}
