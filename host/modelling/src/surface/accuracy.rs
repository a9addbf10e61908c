//! How far a mesh is from the surfaces that it approximates.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::Surface;
use super::tessellation::TessellationError;
use crate::mesh::Mesh;

/// Chord errors: distances between points of a mesh and the exact surface, model units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChordError {
    /// The largest.
    pub maximum: f64,
    /// The root of their mean square, each triangle weighted by its area.
    pub rms: f64,
    /// Points that were measured.
    pub samples: usize,
}

/// Measures how far `mesh` is from `surfaces`, at the points of a triangular lattice of `density` steps a side (>= 1)
/// on each triangle.
///
/// Each distance is to the nearest point of the piece of surface that the triangle belongs to; the result does not
/// depend on the number of threads.
///
/// # Errors
/// If the mesh lacks corner parameters or surface indices, or names a surface that is not there.
pub fn chord_error<S: Surface>(mesh: &Mesh, surfaces: &[S], density: usize) -> Result<ChordError, TessellationError> {
    let count = mesh.triangles.len();
    if mesh.corner_parameters.len() != count || mesh.surfaces.len() != count {
        return Err(TessellationError::NoParameters);
    }
    if let Some(&index) = mesh.surfaces.iter().find(|&&index| index as usize >= surfaces.len()) {
        return Err(TessellationError::NoSurface { index, count: surfaces.len() });
    }
    let measure = |triangle: usize| {
        let surface = &surfaces[mesh.surfaces[triangle] as usize];
        let samples = lattice(density.max(1));
        let (maximum, sum) = distances(surface, mesh.corners(triangle), mesh.corner_parameters[triangle], &samples);
        (maximum, sum / samples.len() as f64, mesh.area_vector(triangle).length())
    };
    let measured: Vec<(f64, f64, f64)> = (0..count).into_par_iter().map(measure).collect();
    let area: f64 = measured.iter().map(|(.., area)| area).sum();
    let weighted: f64 = measured.iter().map(|(_, mean, area)| mean * area).sum();
    Ok(ChordError {
        maximum: measured.iter().map(|(maximum, ..)| *maximum).fold(0.0, f64::max),
        rms: if area > 0.0 { (weighted / area).sqrt() } else { 0.0 },
        samples: count * lattice(density.max(1)).len(),
    })
}

/// The largest distance and the sum of the squares at `samples`, the weights of the three corners.
pub(super) fn distances<S: Surface>(
    surface: &S,
    corners: [DVec3; 3],
    parameters: [DVec2; 3],
    samples: &[[f64; 3]],
) -> (f64, f64) {
    let mut maximum = 0.0f64;
    let mut sum = 0.0;
    for &[a, b, c] in samples {
        let point = corners[0] * a + corners[1] * b + corners[2] * c;
        let guess = parameters[0] * a + parameters[1] * b + parameters[2] * c;
        let squared = surface.point(surface.nearest(point, guess)).distance_squared(point);
        maximum = maximum.max(squared.sqrt());
        sum += squared;
    }
    (maximum, sum)
}

/// The points of a triangular lattice of `steps` steps a side, as weights of the corners.
pub(super) fn lattice(steps: usize) -> Vec<[f64; 3]> {
    let at = |k: usize| k as f64 / steps as f64;
    (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| [at(steps - i - j), at(i), at(j)])).collect()
}
