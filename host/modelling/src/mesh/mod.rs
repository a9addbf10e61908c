//! Triangle meshes, and what can be said of them without knowing their surfaces.
//!
//! Files come in through [`read`], go out through [`write()`], with names of surfaces as groups through [`read_grouped`]
//! and [`write_grouped`], as meshes that are stored once and placed many times through [`read_placed`] and
//! [`write_placed`]; [`Mesh::validate`] and [`Mesh::edge_report`] tell whether
//! a mesh can be trusted; [`edges`] and [`Polylines`] turn it into vectors.

mod triangles;
mod measure;
mod json_path;
mod error;
mod groups;
mod placed;
mod fan;
pub mod edges;
mod smooth_outline;
mod wire;
mod polylines;
mod boundary;
mod check;
mod placement;
mod subdivide;
mod simplify;
mod obj;
mod stl;
mod ply;
mod gltf;
mod compact;
mod file;
mod bunny;
#[cfg(test)]
mod holes;

pub use boundary::BoundaryLoop;
pub use bunny::{NoBunny, bunny};
pub use check::EdgeReport;
pub use edges::{EdgeSelection, SmoothEdges, Viewer};
pub use error::{Fault, FaultLocation, MeshError, MeshProblem};
pub use file::{
    Format, destination, parse, parse_grouped, parse_placed, print, print_grouped, print_placed, read, read_grouped,
    read_placed, write, write_grouped, write_placed,
};
pub use groups::{Grouped, MetallicRoughness};
pub use json_path::JsonPath;
pub(crate) use measure::bits;
pub use placed::{MOST_REPEATED, MeshPlace, MeshPlaces, PlaceRow, PlacedMeshes, RepeatedMesh};
pub use placement::normal_matrix;
pub use polylines::{Polylines, polylines, polylines_of_groups};
pub use triangles::Mesh;
pub use wire::wire;

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;
