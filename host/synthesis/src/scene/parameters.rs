//! The parameters of the corners of triangles, for textures and exact surfaces.

use super::object::Object;
use crate::mesh::Mesh;
use crate::surface::Surface;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Where the parameters of a triangle are worth nothing: their area in the square of the domain.
const NO_AREA: f64 = 1e-30;

/// The parameters of the corners of all triangles of an object, 0..1 over the domain of each exact surface; the two own
/// coordinates along a face where a mesh has none.
pub(super) fn parameters(mesh: &Mesh, surfaces: &[Option<Arc<dyn Surface>>], mirrored: bool) -> Vec<[DVec2; 3]> {
    let of = |triangle: usize| {
        let surface =
            mesh.surfaces.get(triangle).and_then(|surface| surfaces.get(*surface as usize)).and_then(Option::as_ref);
        let [a, b, c] = laid(mesh, triangle, surface).unwrap_or_else(|| along_axes(mesh.corners(triangle)));
        if mirrored { [a, c, b] } else { [a, b, c] }
    };
    (0..mesh.triangles.len()).map(of).collect()
}

/// The parameters of the corners of a triangle that its mesh has, if they are worth anything.
pub(super) fn laid(mesh: &Mesh, triangle: usize, surface: Option<&Arc<dyn Surface>>) -> Option<[DVec2; 3]> {
    let parameters = mesh.corner_parameters.get(triangle)?;
    let laid = surface.map_or(*parameters, |surface| {
        let [low, high] = surface.domain();
        parameters.map(|uv| (uv - low) / (high - low))
    });
    let [a, b, c] = laid;
    (laid.iter().all(|uv| uv.is_finite()) && (b - a).perp_dot(c - a).abs() > NO_AREA).then_some(laid)
}

/// The two coordinates of points across the axis to which their triangle is most upright.
fn along_axes(corners: [DVec3; 3]) -> [DVec2; 3] {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).abs();
    corners.map(|p| match normal.max_position() {
        0 => DVec2::new(p.z, p.y),
        1 => DVec2::new(p.x, p.z),
        _ => DVec2::new(p.x, p.y),
    })
}

impl Object {
    /// Whether parameters are needed to tell what it looks like.
    pub(super) fn needs_parameters(&self, operand_of: &[u32]) -> bool {
        self.materials(operand_of).0.iter().any(crate::illumination::Material::needs_parameters)
    }
}
