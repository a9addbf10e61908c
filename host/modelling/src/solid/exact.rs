//! Boolean operations whose results keep the exact surfaces of their operands.

use super::{Expression, Outcome, Solid, SolidError};
use crate::mesh::Mesh;
use crate::surface::{Surface, TransformedSurface};
use glam::{DAffine3, DVec2, DVec3};
use rayon::prelude::*;
use std::sync::Arc;

/// A solid of which triangles name surfaces, and the surfaces.
///
/// At every corner its mesh has a normal and the parameters (u, v) on the surface of the triangle. Where no surface is
/// known, the normal is that of the mesh it was made of, interpolated, or flat.
#[derive(Clone)]
pub struct ExactSolid {
    solid: Solid,
    /// By the numbers that the triangles give; none where only triangles are known.
    surfaces: Vec<Option<Arc<dyn Surface>>>,
}

impl ExactSolid {
    /// Takes a mesh and the surfaces that its triangles name. A mesh that crosses itself is taken for all points of
    /// positive winding number, with a warning.
    ///
    /// # Errors
    /// [`SolidError`] if the mesh bounds no solid.
    pub fn new(mesh: Mesh, surfaces: Vec<Option<Arc<dyn Surface>>>) -> Result<ExactSolid, SolidError> {
        ExactSolid::new_at(mesh, surfaces, &DAffine3::IDENTITY)
    }

    /// The solid of a mesh and its exact surfaces, both moved to another place first.
    ///
    /// # Errors
    /// [`SolidError`] if the mesh bounds no solid there.
    pub fn new_at(
        mut mesh: Mesh,
        mut surfaces: Vec<Option<Arc<dyn Surface>>>,
        placement: &DAffine3,
    ) -> Result<ExactSolid, SolidError> {
        let count = mesh.triangles.len();
        if mesh.corner_normals.is_empty() {
            let flat = |triangle| [mesh.face_normal(triangle).unwrap_or(DVec3::ZERO); 3];
            mesh.corner_normals = (0..count).map(flat).collect();
        }
        if mesh.corner_parameters.is_empty() {
            mesh.corner_parameters = vec![[DVec2::ZERO; 3]; count];
        }
        if mesh.surfaces.is_empty() {
            mesh.surfaces = vec![0; count];
        }
        let named = mesh.surfaces.iter().max().map_or(0, |last| *last as usize + 1);
        surfaces.resize(surfaces.len().max(named), None);
        if *placement != DAffine3::IDENTITY {
            (mesh, surfaces) = moved(&mesh, &surfaces, placement);
        }
        let (solid, crossing) = Solid::resolved(mesh)?;
        if let Some(crossing) = crossing {
            tracing::warn!("{crossing}; taken for all points of positive winding number");
        }
        Ok(ExactSolid { solid, surfaces })
    }

    /// The solid.
    pub fn solid(&self) -> &Solid {
        &self.solid
    }

    /// Its surfaces, by the numbers that the triangles give; none where only triangles are known.
    pub fn surfaces(&self) -> &[Option<Arc<dyn Surface>>] {
        &self.surfaces
    }

    /// Its mesh and the surfaces, for keeps.
    pub fn into_parts(self) -> (Mesh, Vec<Option<Arc<dyn Surface>>>) {
        (self.solid.into_mesh(), self.surfaces)
    }

    /// The solid in another place.
    ///
    /// # Errors
    /// [`SolidError`] if rounding spoils it there.
    pub fn transformed(self, placement: &DAffine3) -> Result<ExactSolid, SolidError> {
        if *placement == DAffine3::IDENTITY {
            return Ok(self);
        }
        let (mesh, surfaces) = self.into_parts();
        ExactSolid::new_at(mesh, surfaces, placement)
    }

    /// Evaluates an expression over some solids at once, as [`Solid::evaluate`] does. The surfaces of the result are
    /// those of all operands, one operand after the other; each corner has the normal and the parameters of the point
    /// of its surface that is nearest. Where the result lies on the other side of a surface, normals are reversed.
    ///
    /// # Errors
    /// [`SolidError::SelfIntersecting`] if the result crosses itself when it is rounded, and that could not be mended.
    pub fn evaluate(operands: &[&ExactSolid], expression: &Expression) -> Result<(ExactSolid, Outcome), SolidError> {
        let solids: Vec<&Solid> = operands.iter().map(|operand| &operand.solid).collect();
        let (result, outcome) = Solid::evaluate(&solids, expression)?;
        let mut firsts = Vec::new();
        let mut surfaces = Vec::new();
        for operand in operands {
            firsts.push(surfaces.len() as u32);
            surfaces.extend(operand.surfaces.iter().cloned());
        }
        let mut mesh = result.into_mesh();
        let corners = |triangle: usize| {
            let [operand, source] = outcome.sources[triangle];
            operands[operand as usize].corners_of(&mesh, triangle, source as usize)
        };
        let laid: Vec<[(DVec3, DVec2); 3]> = (0..mesh.triangles.len()).into_par_iter().map(corners).collect();
        mesh.corner_normals = laid.iter().map(|corners| corners.map(|(normal, _)| normal)).collect();
        mesh.corner_parameters = laid.iter().map(|corners| corners.map(|(_, uv)| uv)).collect();
        let number = |&[operand, source]: &[u32; 2]| {
            firsts[operand as usize] + operands[operand as usize].solid.mesh().surfaces[source as usize]
        };
        mesh.surfaces = outcome.sources.iter().map(number).collect();
        Ok((ExactSolid { solid: Solid::of(mesh), surfaces }, outcome))
    }

    /// Normals and parameters at the corners of a triangle of a result that is a part of triangle `source` of this
    /// solid.
    pub(super) fn corners_of(&self, result: &Mesh, triangle: usize, source: usize) -> [(DVec3, DVec2); 3] {
        let mesh = self.solid.mesh();
        let (corners, normals, uvs) =
            (mesh.corners(source), mesh.corner_normals[source], mesh.corner_parameters[source]);
        let is_turned = mesh.area_vector(source).dot(result.area_vector(triangle)) < 0.0;
        let side = if is_turned { -1.0 } else { 1.0 };
        let surface = self.surfaces[mesh.surfaces[source] as usize].as_ref();
        let places = result.corners(triangle);
        [0, 1, 2].map(|k| {
            if let Some(same) = corners.iter().position(|corner| *corner == places[k]) {
                return (normals[same] * side, uvs[same]);
            }
            let (mean, guess) = (result.corner_normals[triangle][k], result.corner_parameters[triangle][k]);
            let Some(surface) = surface else { return (mean, guess) };
            let uv = surface.nearest(places[k], guess);
            let normal = surface.normal(uv);
            // The solid itself may lie on the other side of its surface.
            (if normal.dot(mean) < 0.0 { -normal } else { normal }, uv)
        })
    }
}

/// A mesh, and the surfaces that its triangles name, in another place.
pub fn moved(
    mesh: &Mesh,
    surfaces: &[Option<Arc<dyn Surface>>],
    placement: &DAffine3,
) -> (Mesh, Vec<Option<Arc<dyn Surface>>>) {
    let mut mesh = mesh.transformed(placement);
    if placement.matrix3.determinant() < 0.0 {
        // A mirrored surface is traversed with u reversed.
        for (corners, surface) in mesh.corner_parameters.iter_mut().zip(&mesh.surfaces) {
            let Some(surface) = surfaces.get(*surface as usize).and_then(Option::as_ref) else { continue };
            let [low, high] = surface.domain();
            corners.iter_mut().for_each(|uv| uv.x = low.x + (high.x - uv.x));
        }
    }
    let moved = |surface: &Option<Arc<dyn Surface>>| {
        surface.clone().map(|surface| Arc::new(TransformedSurface::new(surface, *placement)) as Arc<dyn Surface>)
    };
    (mesh, surfaces.iter().map(moved).collect())
}

#[cfg(test)]
mod tests {
    use super::super::Body;
    use super::super::primitive::{block, cylinder, sphere};
    use super::*;
    use crate::surface::Tolerance;

    fn exact(body: Body, placement: DAffine3) -> ExactSolid {
        body.solid(Tolerance::new(2e-3, 30.0)).unwrap().transformed(&placement).unwrap()
    }

    /// The surfaces that the result has, and how far its normals are from closed forms.
    fn check(solid: &ExactSolid, closed_forms: &[(u32, &dyn Fn(DVec3) -> DVec3)]) {
        let mesh = solid.solid().mesh();
        let mut seen = vec![0; closed_forms.len()];
        for triangle in 0..mesh.triangles.len() {
            let number = mesh.surfaces[triangle];
            let form =
                closed_forms.iter().position(|(surface, _)| *surface == number).expect("a surface that is there");
            seen[form] += 1;
            let face = mesh.face_normal(triangle).unwrap();
            for (corner, point) in mesh.corners(triangle).into_iter().enumerate() {
                let normal = mesh.corner_normals[triangle][corner];
                let gap = (normal - closed_forms[form].1(point)).length();
                assert!(gap < 1e-12, "surface {number} at {point}: {gap:e}");
                assert!(normal.dot(face) > 0.8, "{number}");
                let surface = solid.surfaces[number as usize].as_ref().unwrap();
                let uv = mesh.corner_parameters[triangle][corner];
                assert!(surface.point(uv).distance(point) < 4e-3 && surface.normal(uv).cross(normal).length() < 1e-12);
            }
        }
        assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
    }

    #[test]
    fn every_corner_of_a_drilled_sphere_has_the_normal_of_sphere_or_drill() {
        let center = DVec3::new(3.0, -1.0, 0.5);
        let turn = DAffine3::from_rotation_z(0.4) * DAffine3::from_rotation_x(1.1);
        let axis = turn.transform_vector3(DVec3::Y);
        let across = move |point: DVec3| (point - center) - axis * (point - center).dot(axis);
        let ball = exact(sphere(2.0).unwrap(), DAffine3::from_translation(center));
        for (mirror, expression) in [
            (1.0, Expression::difference(Expression::Operand(0), Expression::Operand(1))),
            (-1.0, Expression::difference(Expression::Operand(0), Expression::Operand(1))),
        ] {
            let place = DAffine3::from_translation(center) * turn * DAffine3::from_scale(DVec3::new(mirror, 1.0, 1.0));
            let drill = exact(cylinder(0.7, 6.0).unwrap(), place);
            let (result, _) = ExactSolid::evaluate(&[&ball, &drill], &expression).unwrap();
            // The sphere is surface 0; of the drill the lower disc is 1, the cylinder 2, the upper disc 3.
            check(&result, &[(0, &|p| (p - center).normalize()), (2, &|p| -across(p).normalize())]);
        }
    }

    #[test]
    fn results_are_operands_that_still_know_their_surfaces() {
        let ball = exact(sphere(1.0).unwrap(), DAffine3::IDENTITY);
        let drill = exact(cylinder(0.5, 3.0).unwrap(), DAffine3::IDENTITY);
        let cut = exact(block(DVec3::splat(4.0)).unwrap(), DAffine3::from_translation(DVec3::X * 2.1));
        let less = Expression::difference(Expression::Operand(0), Expression::Operand(1));
        let (ring, _) = ExactSolid::evaluate(&[&ball, &drill], &less).unwrap();
        let (half, outcome) = ExactSolid::evaluate(&[&ring, &cut], &less).unwrap();
        let across = |p: DVec3| DVec3::new(-p.x, 0.0, -p.z).normalize();
        // The block counts its faces from 4 on; that of least x is the first.
        check(&half, &[(0, &|p| p.normalize()), (2, &across), (4, &|_| DVec3::X)]);
        assert_eq!(outcome.sources.len(), half.solid().mesh().triangles.len());
    }

    #[test]
    fn meshes_without_surfaces_keep_what_they_have() {
        let known = exact(block(DVec3::ONE).unwrap(), DAffine3::IDENTITY);
        let (mesh, _) = exact(block(DVec3::ONE).unwrap(), DAffine3::from_translation(DVec3::splat(0.3))).into_parts();
        let bare = Mesh { vertices: mesh.vertices, triangles: mesh.triangles, ..Mesh::default() };
        let bare = ExactSolid::new(bare, Vec::new()).unwrap();
        let both = Expression::Union(vec![Expression::Operand(0), Expression::Operand(1)]);
        let (mesh, surfaces) = ExactSolid::evaluate(&[&known, &bare], &both).unwrap().0.into_parts();
        assert!(surfaces.len() == 7 && surfaces[6].is_none());
        for triangle in 0..mesh.triangles.len() {
            let face = mesh.face_normal(triangle).unwrap();
            assert!(mesh.corner_normals[triangle].iter().all(|normal| (*normal - face).length() < 1e-14));
        }
    }
}
