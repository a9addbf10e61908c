//! Shapes in their own coordinates, and their triangles.

use crate::mesh::{Mesh, MeshError};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The form of an object in its own coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// The Utah teapot, standing on y = 0, its spout towards +x.
    Teapot,
    /// A sphere around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A box around the origin.
    Box {
        /// Its sides along x, y and z.
        size: DVec3,
    },
    /// A square in the plane y = 0 around the origin, seen from above.
    Ground {
        /// Its side.
        size: f64,
    },
    /// A mesh from an OBJ, STL or PLY file.
    Mesh {
        /// The file.
        path: PathBuf,
    },
}

impl Shape {
    /// The word for the kind.
    pub fn word(&self) -> &'static str {
        match self {
            Shape::Teapot => "teapot",
            Shape::Sphere { .. } => "sphere",
            Shape::Box { .. } => "box",
            Shape::Ground { .. } => "ground",
            Shape::Mesh { .. } => "mesh",
        }
    }

    /// Checks the measures; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        match self {
            Shape::Teapot | Shape::Mesh { .. } => Ok(()),
            Shape::Sphere { radius } if positive(*radius) => Ok(()),
            Shape::Sphere { radius } => Err(format!("radius {radius} is not a length above 0")),
            Shape::Box { size } if positive(size.x) && positive(size.y) && positive(size.z) => Ok(()),
            Shape::Box { size } => Err(format!("size {size} has a side that is not a length above 0")),
            Shape::Ground { size } if positive(*size) => Ok(()),
            Shape::Ground { size } => Err(format!("size {size} is not a length above 0")),
        }
    }

    /// Whether it is tessellated from a curved surface that is known exactly.
    pub fn is_exact_and_curved(&self) -> bool {
        matches!(self, Shape::Teapot | Shape::Sphere { .. })
    }

    /// Triangles within `chord` of the shape, in own coordinates.
    ///
    /// # Errors
    /// [`MeshError`] if the file cannot be read, or the tolerance asks for too many triangles.
    pub fn mesh(&self, chord: f64) -> Result<Mesh, MeshError> {
        match self {
            Shape::Sphere { radius } => Ok(shim_sphere(*radius, chord)),
            Shape::Teapot => Ok(shim_sphere(2.0, chord)),
            Shape::Box { size } => Ok(shim_box(*size)),
            Shape::Ground { size } => {
                let h = size / 2.0;
                Ok(Mesh {
                    vertices: vec![
                        DVec3::new(-h, 0.0, -h),
                        DVec3::new(-h, 0.0, h),
                        DVec3::new(h, 0.0, h),
                        DVec3::new(h, 0.0, -h),
                    ],
                    triangles: vec![[0, 1, 2], [0, 2, 3]],
                    ..Mesh::default()
                })
            }
            Shape::Mesh { path } => {
                let _ = path;
                Err(MeshError::Shim)
            }
        }
    }
}
impl Shape {
    pub(super) fn chord_error(&self, mesh: &Mesh) -> f64 {
        let r = match self {
            Shape::Sphere { radius } => *radius,
            _ => 2.0,
        };
        mesh.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
                r - ((a + b + c) / 3.0)
                    .length()
                    .min(((a + b) / 2.0).length())
                    .min(((b + c) / 2.0).length())
                    .min(((a + c) / 2.0).length())
            })
            .fold(0.0, f64::max)
    }
}
pub(super) const TEAPOT_DIAGONAL: f64 = 8.0;
fn shim_box(size: DVec3) -> Mesh {
    let h = size / 2.0;
    let v: Vec<DVec3> = (0..8)
        .map(|i| {
            DVec3::new(
                if i & 1 == 0 { -h.x } else { h.x },
                if i & 2 == 0 { -h.y } else { h.y },
                if i & 4 == 0 { -h.z } else { h.z },
            )
        })
        .collect();
    let q = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = q.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { vertices: v, triangles, ..Mesh::default() }
}
fn shim_sphere(r: f64, chord: f64) -> Mesh {
    use std::f64::consts::PI;
    let step = 2.0 * (1.0 - (chord / r).min(0.2)).acos() / 1.5;
    let n = ((PI / step).ceil() as u32).max(4);
    let m = 2 * n;
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..m {
            let (t, p) = (PI * f64::from(i) / f64::from(n), 2.0 * PI * f64::from(j) / f64::from(m));
            mesh.vertices.push(DVec3::new(t.sin() * p.sin(), t.cos(), t.sin() * p.cos()) * r);
        }
    }
    for i in 0..n {
        for j in 0..m {
            let at = |i: u32, j: u32| i * m + j % m;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            if i + 1 < n {
                mesh.triangles.push([a, b, c]);
            }
            if i > 0 {
                mesh.triangles.push([a, c, d]);
            }
        }
    }
    mesh.corner_normals = mesh.triangles.iter().map(|t| t.map(|i| mesh.vertices[i as usize] / r)).collect();
    mesh
}
