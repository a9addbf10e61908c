//! Triangle meshes, and what can be said of them without knowing their surfaces.
//!
//! Files come in through [`read`], go out through [`write()`], with names of surfaces as groups through [`read_grouped`]
//! and [`write_grouped`]; [`Mesh::validate`] and [`Mesh::edge_report`] tell whether
//! a mesh can be trusted; [`edges`] and [`Polylines`] turn it into vectors.

mod boundary;
mod check;
mod compact;
mod contour;
pub mod edges;
mod error;
mod file;
mod gltf;
mod groups;
#[cfg(test)]
mod holes;
mod json_path;
mod measure;
mod obj;
mod placement;
mod ply;
mod polylines;
mod stl;
mod simplify;
mod subdivide;

pub use boundary::BoundaryLoop;
pub use check::EdgeReport;
pub use edges::{Eye, Interior, Selection, wire};
pub use error::{Fault, MeshError, Place, Problem};
pub use file::{
    Format, destination, parse, parse_grouped, print, print_grouped, read, read_grouped, write, write_grouped,
};
pub use groups::{Grouped, Look};
pub use json_path::JsonPath;
pub(crate) use measure::bits;
pub(crate) use placement::normal_matrix;
pub use polylines::{Polylines, polylines, polylines_of_groups};

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Triangles over shared vertices.
///
/// Counter-clockwise corners seen from outside, in the right-handed modelling space (x right, y up, z
/// towards the viewer). The per-corner tables are either empty or as long as `triangles`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Positions.
    pub vertices: Vec<DVec3>,
    /// Corners of each triangle, indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals of the exact surface (or of the file) at the corners.
    pub corner_normals: Vec<[DVec3; 3]>,
    /// Surface parameters (or texture coordinates) of the corners.
    pub corner_parameters: Vec<[DVec2; 3]>,
    /// The surface that each triangle approximates, an index into the surfaces of the object.
    pub surfaces: Vec<u32>,
}

impl Mesh {
    /// The positions of the corners of triangle `triangle`.
    ///
    /// # Panics
    /// If the triangle or one of its vertices does not exist; [`Mesh::validate`] excludes the latter.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }
}

/// The Stanford bunny was left out when the program was built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the Stanford bunny is not in this program: it was built without the feature `bunny` of crate `host`")]
pub struct NoBunny;

/// The Stanford bunny, closed: 34,835 vertices and 69,666 triangles, about 2 units high, y up, facing the viewer.
///
/// Coordinates are rounded to 1/65535 of the longest side of its box. Please acknowledge the Stanford Computer
/// Graphics Laboratory in what you publish with it; no commercial use without its permission (`data/README.md`).
///
/// # Errors
/// [`NoBunny`] in a program that was built without the feature `bunny`.
///
/// # Source
/// Stanford 3D Scanning Repository, scan of Greg Turk and Marc Levoy, 1994; the holes of its base are filled.
pub fn bunny() -> Result<Mesh, NoBunny> {
    #[cfg(feature = "bunny")]
    let file = Some(include_bytes!("../../data/bunny.cmesh"));
    #[cfg(not(feature = "bunny"))]
    let file = None::<&[u8]>;
    let file = file.ok_or(NoBunny)?;
    Ok(compact::parse(file).expect("the embedded bunny is well formed; a test reads it"))
}

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;
