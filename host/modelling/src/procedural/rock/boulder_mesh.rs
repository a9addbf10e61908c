//! Rocks as triangles: a cube's faces, divided and drawn onto the surface.

use super::boulder::Rock;
use crate::memory::{self, MemoryExceeded};
use crate::mesh::Mesh;
use glam::{DVec2, DVec3};

/// Fewest and most squares along the edge of a face of the cube.
const DIVISIONS: [usize; 2] = [3, 512];
/// Step of the directions by which normals are found, in parts of the side of a square.
const STEP: f64 = 0.5;
/// Bytes of a triangle with what is known at its corners, and half a vertex.
const TRIANGLE_BYTES: u64 = 12 + 72 + 48 + 4 + 12;

impl Rock {
    /// The rock as a closed mesh.
    ///
    /// - `detail`: what is smaller is left out, units of length, above 0: triangles are about as large.
    ///
    /// # Errors
    /// Less memory than the triangles take.
    pub fn mesh(&self, detail: f64) -> Result<Mesh, MemoryExceeded> {
        let [least, most] = DIVISIONS;
        // An edge of the cube spans a quarter of the way around.
        let wanted = 0.8 * self.diameter() / detail.max(f64::MIN_POSITIVE);
        let divisions = if wanted < most as f64 { (wanted.ceil() as usize).clamp(least, most) } else { most };
        memory::reserve(12 * (divisions * divisions) as u64 * TRIANGLE_BYTES, || {
            format!("{} triangles of a rock", 12 * divisions * divisions)
        })?;
        let footprint = 0.8 * self.diameter() / divisions as f64;
        let mut mesh = Mesh::default();
        let mut numbers = rustc_hash::FxHashMap::default();
        let mut normals = Vec::new();
        for face in 0..6 {
            let mut vertex = |mesh: &mut Mesh, i: usize, j: usize| {
                let cell = on_cube(face, [i, j], divisions);
                *numbers.entry(cell).or_insert_with(|| {
                    let direction = direction(cell, divisions);
                    mesh.vertices.push(self.at(direction, footprint));
                    normals.push(self.normal(direction, STEP / divisions as f64, footprint));
                    mesh.vertices.len() as u32 - 1
                })
            };
            for i in 0..divisions {
                for j in 0..divisions {
                    let [a, b] = [vertex(&mut mesh, i, j), vertex(&mut mesh, i + 1, j)];
                    let [c, d] = [vertex(&mut mesh, i + 1, j + 1), vertex(&mut mesh, i, j + 1)];
                    mesh.triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        for corners in &mesh.triangles {
            mesh.corner_normals.push(corners.map(|corner| normals[corner as usize]));
            mesh.corner_parameters.push([DVec2::ZERO; 3]);
            mesh.surfaces.push(0);
        }
        Ok(mesh)
    }

    /// The normal in a direction, by differences.
    fn normal(&self, direction: DVec3, step: f64, footprint: f64) -> DVec3 {
        let (across, along) = direction.any_orthonormal_pair();
        let slope = |aside: DVec3| {
            let [before, after] =
                [-1.0, 1.0].map(|side| self.at((direction + aside * (side * step)).normalize(), footprint));
            after - before
        };
        slope(across).cross(slope(along)).normalize_or(direction)
    }
}

/// The lattice point of a place on a face of a cube, so that faces that meet share theirs.
fn on_cube(face: usize, [i, j]: [usize; 2], divisions: usize) -> [i32; 3] {
    let whole = divisions as i32;
    let [i, j] = [i as i32, j as i32].map(|k| 2 * k - whole);
    match face {
        0 => [whole, i, j],
        1 => [-whole, j, i],
        2 => [j, whole, i],
        3 => [i, -whole, j],
        4 => [i, j, whole],
        _ => [j, i, -whole],
    }
}

/// The direction of a lattice point of the cube: angles are even along its edges.
fn direction(cell: [i32; 3], divisions: usize) -> DVec3 {
    let even = |k: i32| (std::f64::consts::FRAC_PI_4 * f64::from(k) / divisions as f64).tan();
    DVec3::new(even(cell[0]), even(cell[1]), even(cell[2])).normalize()
}
