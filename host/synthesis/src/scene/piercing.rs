//! Where rays meet the exact surfaces behind triangles.

use super::prepared::Contents;
use crate::numeric::ray::Ray;
use crate::surface::{PiercingLine, PiercingPoint, pierced};
use glam::{DVec2, DVec3};

/// Where a ray meets the exact surface behind a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// How far it is from where the ray meets the triangle, in lengths of the ray's direction; less than 0 before it.
    pub beyond: f64,
    /// The unit normal on the side of the viewer, scene coordinates.
    pub normal: DVec3,
    /// The parameters, 0..1 over the domain of the surface.
    pub uv: DVec2,
    /// Where it is in the coordinates of the object.
    pub own: DVec3,
}

impl Contents {
    /// Where a ray that meets a triangle meets its exact surface.
    ///
    /// None where that is not known, is flat, is not asked for ([`GeometrySettings::exact_surfaces`](super::GeometrySettings::exact_surfaces)), or where Newton's
    /// method finds nothing closer to the triangle than its longest side is long: close to outlines the ray may pass by
    /// the surface.
    ///
    /// - `weights`: of the corners of the triangle. `position`: of the hit. `outside`: whether the ray comes from there.
    pub fn on_surface(
        &self,
        triangle: u32,
        ray: &Ray,
        weights: [f64; 3],
        position: DVec3,
        outside: bool,
    ) -> Option<SurfacePoint> {
        let object = self.object(triangle);
        let (surface, is_turned) = self.exact.surface(object.surfaces_from? + triangle - object.first)?;
        let [low, high] = surface.domain();
        let [a, b, c] = *self.parameters(triangle)?;
        let guess = low + (a * weights[0] + b * weights[1] + c * weights[2]) * (high - low);
        let [p, q, r] = self.corners(triangle);
        let own = |scene: DVec3| object.to_own.transform_vector3(scene);
        let reach = [q - p, r - q, p - r].map(|side| own(side).length_squared()).into_iter().fold(0.0, f64::max).sqrt();
        let (from, direction) = (object.to_own.transform_point3(position), own(ray.direction));
        let outward = outside == is_turned;
        let PiercingPoint { uv, normal, t } =
            pierced(surface, &PiercingLine { from, direction, outward }, guess, reach)?;
        let outwards = (object.normals_to_scene * normal).try_normalize()?;
        let normal = if outward { -outwards } else { outwards };
        Some(SurfacePoint { beyond: t, normal, uv: (uv - low) / (high - low), own: from + direction * t })
    }
}
