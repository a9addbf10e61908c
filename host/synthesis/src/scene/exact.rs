//! The exact surfaces behind the triangles of a scene.

use super::parameters::laid;
use crate::mesh::Mesh;
use crate::surface::Surface;
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// Normals of a file or surface that are this close to the plane's count as flat (sine of the angle).
pub(super) const FLAT_SINE: f64 = 1e-6;
/// Stands for no surface.
const NONE: u32 = u32::MAX;
/// Is added where the outside of a body is the inside of a surface.
const REVERSED: u32 = 1 << 31;

/// Curved surfaces, each in the coordinates of its object, and which of them triangles belong to.
#[derive(Clone, Default)]
pub(super) struct ExactSurfaces {
    surfaces: Vec<Arc<dyn Surface>>,
    /// By the triangles of the objects that have any, with [`REVERSED`].
    surface_of: Vec<u32>,
}

impl ExactSurfaces {
    /// Takes the curved surfaces of an object; where the numbers of its triangles begin, if it has any.
    pub(super) fn add(&mut self, mesh: &Mesh, surfaces: &[Option<Arc<dyn Surface>>]) -> Option<u32> {
        let count = mesh.triangles.len();
        if mesh.surfaces.len() != count || mesh.corner_normals.len() != count {
            return None;
        }
        let mut curved = vec![false; surfaces.len()];
        for (triangle, surface) in mesh.surfaces.iter().enumerate() {
            if let Some(curved) = curved.get_mut(*surface as usize).filter(|curved| !**curved) {
                let face = mesh.face_normal(triangle).unwrap_or(DVec3::ZERO);
                *curved = mesh.corner_normals[triangle].iter().any(|normal| normal.cross(face).length() > FLAT_SINE);
            }
        }
        let mut numbers = vec![NONE; surfaces.len()];
        let first = self.surfaces.len() as u32;
        for (index, surface) in surfaces.iter().enumerate() {
            if let (Some(surface), true) = (surface, curved[index]) {
                numbers[index] = self.surfaces.len() as u32;
                self.surfaces.push(Arc::clone(surface));
            }
        }
        if self.surfaces.len() as u32 == first {
            return None;
        }
        let from = self.surface_of.len() as u32;
        let of = |(triangle, surface): (usize, &u32)| {
            let (number, surface) = (numbers.get(*surface as usize)?, surfaces.get(*surface as usize)?.as_ref());
            laid(mesh, triangle, surface).map(|_| *number)?;
            let (normals, parameters) = (mesh.corner_normals[triangle], mesh.corner_parameters[triangle]);
            let along = |k: usize| surface.map_or(0.0, |surface| surface.normal(parameters[k]).dot(normals[k]));
            let is_turned = along(0) + along(1) + along(2) < 0.0;
            (*number != NONE).then_some(if is_turned { number | REVERSED } else { *number })
        };
        self.surface_of.extend(mesh.surfaces.iter().enumerate().map(|triangle| of(triangle).unwrap_or(NONE)));
        Some(from)
    }

    /// The surface of a triangle, counted among those that have any, and whether the outside of its body is its inside.
    pub(super) fn surface(&self, triangle: u32) -> Option<(&Arc<dyn Surface>, bool)> {
        let number = self.surface_of[triangle as usize];
        let surface = self.surfaces.get((number & !REVERSED) as usize).filter(|_| number != NONE)?;
        Some((surface, number & REVERSED != 0))
    }
}

impl fmt::Debug for ExactSurfaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} surfaces of {} triangles", self.surfaces.len(), self.surface_of.len())
    }
}
