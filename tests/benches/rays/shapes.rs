//! The meshes of the benchmark.

use glam::DVec3;
use host::{
    mesh::{Mesh, MeshError, bunny, read},
    surface::{Tolerance, teapot, tessellate},
};

/// Vertices and triangles under a name.
pub struct Shape {
    /// What it is called in the tables.
    pub name: String,
    /// Positions; each is exact in single precision, so that all rivals see the same mesh.
    pub vertices: Vec<DVec3>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A named mesh; positions are rounded to single precision.
    fn new(name: &str, mesh: Mesh) -> Self {
        let vertices = mesh.vertices.into_iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let triangles = mesh.triangles;
        Self { name: format!("{name} {}k", triangles.len().div_ceil(1000)), vertices, triangles }
    }

    /// Centre and radius of a sphere around the shape.
    pub fn bounds(&self) -> (DVec3, f64) {
        let low = self.vertices.iter().fold(DVec3::INFINITY, |a, &p| a.min(p));
        let high = self.vertices.iter().fold(DVec3::NEG_INFINITY, |a, &p| a.max(p));
        ((low + high) * 0.5, (high - low).length() * 0.5)
    }
}

/// The Utah teapot with a largest distance between patches and triangles; its height is 3.15.
pub fn pot(chord: f64) -> Shape {
    Shape::new("teapot", tessellate(&teapot(), Tolerance::new(chord, 180.0)).expect("the teapot can be tessellated"))
}

/// The Stanford bunny, with each triangle divided into four so many times.
pub fn rabbit(divisions: u32) -> Shape {
    Shape::new("bunny", (0..divisions).fold(bunny().expect("it ships"), |mesh, _| mesh.subdivided_smoothly()))
}

/// A mesh from a file.
pub fn file(path: &str) -> Result<Shape, MeshError> {
    Ok(Shape::new(path, read(path)?))
}
