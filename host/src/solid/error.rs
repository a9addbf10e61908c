//! Why a mesh is no solid.

use crate::mesh::Fault;
use glam::DVec3;

/// Why a mesh is no solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// A number or an index is wrong.
    #[error(transparent)]
    Mesh(#[from] Fault),
    /// Edges are run through more often one way than the other: there is a hole, or triangles are turned against each
    /// other.
    #[error("{count} edges are not closed or not consistently oriented, the first {}", list(edges))]
    NotClosed {
        /// How many edges.
        count: usize,
        /// The ends of the first of them.
        edges: Vec<[DVec3; 2]>,
    },
    /// The triangles face inwards.
    #[error("the surface faces inwards: its volume is {volume}")]
    InsideOut {
        /// The volume, cubic units.
        volume: f64,
    },
    /// The surface crosses or covers itself, or parts of it lie in each other.
    #[error(
        "the surface crosses or covers itself ({overlaps} pairs of triangles): near {near} it winds {winding} times around a point"
    )]
    Crossing {
        /// How often it winds; once behind the surface of a solid.
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
         moving its points by {most} units in the last place does not mend it; moving an operand by a millionth of its \
         size may help"
    )]
    Unsettled {
        /// Pairs of triangles that have more in common than corners and edges.
        overlaps: usize,
        /// A corner of the first.
        near: DVec3,
        /// How far points were moved, in units in the last place of the largest coordinate there.
        most: f64,
    },
    /// The surface crosses itself so often that it is not put right, nor told how.
    #[error("the surface crosses itself too often to be taken for one: more than {most} {what}")]
    Tangled {
        /// Of what there are too many.
        what: &'static str,
        /// How many there may be.
        most: usize,
    },
}

fn list(edges: &[[DVec3; 2]]) -> String {
    edges.iter().map(|[a, b]| format!("{a} to {b}")).collect::<Vec<_>>().join(", ")
}
