//! The exact surfaces behind the triangles of a scene, and where rays meet them.

use super::Contents;
use super::placing::laid;
use super::prepared::FLAT_SINE;
use crate::mesh::Mesh;
use crate::numeric::ray::Ray;
use crate::surface::{Line, Pierced, Surface, pierced};
use glam::{DVec2, DVec3};
use std::fmt;
use std::sync::Arc;

/// Stands for no surface.
const NONE: u32 = u32::MAX;
/// Is added where the outside of a body is the inside of a surface.
const TURNED: u32 = 1 << 31;

/// Curved surfaces, each in the coordinates of its object, and which of them triangles belong to.
#[derive(Clone, Default)]
pub(super) struct Exact {
    surfaces: Vec<Arc<dyn Surface>>,
    /// By the triangles of the objects that have any, with [`TURNED`].
    surface_of: Vec<u32>,
}

/// Where a ray meets the exact surface behind a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnSurface {
    /// How far it is from where the ray meets the triangle, in lengths of the ray's direction; less than 0 before it.
    pub beyond: f64,
    /// The unit normal on the side of the viewer, scene coordinates.
    pub normal: DVec3,
    /// The parameters, 0..1 over the domain of the surface.
    pub uv: DVec2,
    /// Where it is in the coordinates of the object.
    pub own: DVec3,
}

impl Exact {
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
            (*number != NONE).then_some(if is_turned { number | TURNED } else { *number })
        };
        self.surface_of.extend(mesh.surfaces.iter().enumerate().map(|triangle| of(triangle).unwrap_or(NONE)));
        Some(from)
    }

    /// Bytes that the numbers take.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.surface_of[..])
    }
}

impl fmt::Debug for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} surfaces of {} triangles", self.surfaces.len(), self.surface_of.len())
    }
}

impl Contents {
    /// Where a ray that meets a triangle meets its exact surface.
    ///
    /// None where that is not known, is flat, is not asked for ([`super::Settings::exact_surfaces`]), or where Newton's
    /// method finds nothing closer to the triangle than its longest side is long: close to outlines the ray may pass by
    /// the surface.
    ///
    /// - `weights`: of the corners of the triangle. `position`: of the hit. `outside`: whether the ray comes from there.
    pub fn on_surface(
        &self,
        triangle: u32,
        ray: &Ray,
        weights: [f64; 3],
        (position, outside): (DVec3, bool),
    ) -> Option<OnSurface> {
        let object = self.object(triangle);
        let number = self.exact.surface_of[(object.surfaces_from? + triangle - object.first) as usize];
        if number == NONE {
            return None;
        }
        let surface = self.exact.surfaces.get((number & !TURNED) as usize)?;
        let [low, high] = surface.domain();
        let [a, b, c] = *self.parameters(triangle)?;
        let guess = low + (a * weights[0] + b * weights[1] + c * weights[2]) * (high - low);
        let [p, q, r] = self.corners(triangle);
        let own = |scene: DVec3| object.to_own.transform_vector3(scene);
        let reach = [q - p, r - q, p - r].map(|side| own(side).length_squared()).into_iter().fold(0.0, f64::max).sqrt();
        let (from, direction) = (object.to_own.transform_point3(position), own(ray.direction));
        let outward = outside == (number & TURNED != 0);
        let Pierced { uv, normal, t } = pierced(surface, &Line { from, direction, outward }, guess, reach)?;
        let outwards = (object.normals_to_scene * normal).try_normalize()?;
        let normal = if outward { -outwards } else { outwards };
        Some(OnSurface { beyond: t, normal, uv: (uv - low) / (high - low), own: from + direction * t })
    }
}
