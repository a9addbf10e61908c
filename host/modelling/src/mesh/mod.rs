//! Triangle meshes, and what can be said of them without knowing their surfaces.
//!
//! Files come in through [`read`], go out through [`write()`], with names of surfaces as groups through [`read_grouped`]
//! and [`write_grouped`]; [`Mesh::validate`] and [`Mesh::edge_report`] tell whether
//! a mesh can be trusted; [`edges`] and [`Polylines`] turn it into vectors.

mod triangles;
mod measure;
mod json_path;
mod error;
mod groups;
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
    Format, destination, parse, parse_grouped, print, print_grouped, read, read_grouped, write, write_grouped,
};
pub use groups::{Grouped, MetallicRoughness};
pub use json_path::JsonPath;
pub(crate) use measure::bits;
pub use placement::normal_matrix;
pub use polylines::{Polylines, polylines, polylines_of_groups};
pub use triangles::Mesh;
pub use wire::wire;

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;
