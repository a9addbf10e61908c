//! Intersection curves of objects.

use super::object::Object;
use super::shape_mesh::ShapeMesh;
use super::stretch::largest_stretch;
use super::{Scene, SceneError, ShapeError};
use crate::intersection::{CurvePrecision, ExactSheet, Intersection, intersect};
use crate::numeric::bounds::Bounds;
use crate::solid::moved;
use crate::surface::Tolerance;
use glam::DAffine3;

/// The intersection curves of two objects of a scene.
#[derive(Clone, Debug)]
pub struct ObjectIntersection {
    /// The numbers of the objects in the scene, the lower first.
    pub objects: [usize; 2],
    /// The curves, in scene coordinates.
    pub intersection: Intersection,
}

/// The intersection curves of each two objects of a scene; pairs whose boxes do not touch are left out.
///
/// # Errors
/// [`SceneError`] if an object has no triangles.
pub fn object_intersections(scene: &Scene, precision: &CurvePrecision) -> Result<Vec<ObjectIntersection>, SceneError> {
    scene.check()?;
    let placed = |object: &Object| {
        let made = object.tessellate(scene.settings.geometry.tolerance, scene.settings.geometry.angle)?;
        Ok(object.in_place(made))
    };
    let placed: Vec<ShapeMesh> = scene.objects.iter().map(placed).collect::<Result<_, SceneError>>()?;
    let bounds: Vec<Bounds> = placed.iter().map(|made| made.mesh.bounds().unwrap_or(Bounds::EMPTY)).collect();
    let mut meetings = Vec::new();
    for (two, behind) in placed.iter().enumerate() {
        for (one, before) in placed[..two].iter().enumerate().filter(|(one, _)| bounds[*one].touches(bounds[two])) {
            meetings.push(ObjectIntersection { objects: [one, two], intersection: between(before, behind, precision) });
        }
    }
    meetings.sort_by_key(|meeting| meeting.objects);
    Ok(meetings)
}

/// The intersection curves of two objects, in the coordinates that the objects are placed in.
///
/// - `tolerance`: of the triangles, in these coordinates.
pub(super) fn intersect_shapes(
    objects: [&Object; 2],
    tolerance: Tolerance,
    precision: &CurvePrecision,
) -> Result<Intersection, ShapeError> {
    let made = |object: &Object| {
        let chord = object.tolerance.unwrap_or(tolerance.chord) / largest_stretch(&object.transform);
        Ok::<_, ShapeError>(object.in_place(object.shape.tessellate(Tolerance { chord, ..tolerance })?))
    };
    let [one, two] = objects;
    Ok(between(&made(one)?, &made(two)?, precision))
}

fn between(one: &ShapeMesh, two: &ShapeMesh, precision: &CurvePrecision) -> Intersection {
    let [one, two] = [one, two].map(|made| ExactSheet::new(&made.mesh, &made.surfaces));
    intersect(one, two, precision)
}

impl Object {
    /// The mesh of its shape, moved to where the object is.
    pub(super) fn in_place(&self, shape_mesh: ShapeMesh) -> ShapeMesh {
        let (mesh, surfaces) = moved(&shape_mesh.mesh, &shape_mesh.surfaces, &DAffine3::from_mat4(self.transform));
        ShapeMesh { mesh, surfaces, ..shape_mesh }
    }
}
