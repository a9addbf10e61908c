//! A scene as one mesh, of which every triangle knows its object and its surface.

use super::{MAX_OBJECTS, Made, Object, Scene, SceneError, Shape};
use crate::mesh::{Grouped, Mesh};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// Most triangles of the mesh.
const MAX_TRIANGLES: u64 = 1 << 30;

impl Scene {
    /// The triangles of all objects in scene coordinates, with normals, and with parameters if all objects have them. A
    /// surface is named OBJECT, or OBJECT/NUMBER where an object has several.
    ///
    /// # Errors
    /// [`SceneError`], for a value out of range or a mesh that cannot be made or read.
    pub fn tessellated(&self) -> Result<Grouped, SceneError> {
        self.check()?;
        let settings = &self.settings;
        let made = |object: &Object| object.made(settings.tolerance, settings.angle).map(|(made, _)| made);
        let all = self.objects.par_iter().map(made).collect::<Result<Vec<Made>, SceneError>>()?;
        let mut whole = Grouped::default();
        for (object, Made { mut mesh, .. }) in self.objects.iter().zip(all) {
            if (whole.mesh.triangles.len() + mesh.triangles.len()) as u64 > MAX_TRIANGLES {
                return Err(SceneError::Limit { what: "triangles", limit: MAX_TRIANGLES });
            }
            if mesh.corner_normals.is_empty() {
                mesh.corner_normals = flat_normals(&mesh);
            }
            mesh.surfaces.resize(mesh.triangles.len(), 0);
            let placed = mesh.transformed(&DAffine3::from_mat4(object.transform));
            if let Some(v) = placed.vertices.iter().find(|v| !v.is_finite()) {
                let problem = format!("a vertex is placed at {v}");
                return Err(SceneError::Object { object: object.name.clone(), problem });
            }
            let count = mesh.surfaces.iter().max().map_or(0, |last| *last as usize + 1);
            whole.mesh.append(&placed, whole.names.len() as u32);
            let name = |k: usize| if count == 1 { object.name.clone() } else { format!("{}/{k}", object.name) };
            whole.names.extend((0..count).map(name));
        }
        Ok(whole)
    }

    /// The same scene with a tolerance for all objects, whatever theirs were.
    ///
    /// - `chord`: largest distance between surface and triangles, scene units; without it the tolerances stay.
    /// - `angle`: largest turn of the normal along a triangle, degrees; without it that of the scene.
    pub fn within(mut self, chord: Option<f64>, angle: Option<f64>) -> Scene {
        fn release(object: &mut Object) {
            object.tolerance = None;
            if let Shape::Composite(composite) = &mut object.shape {
                composite.operands.iter_mut().for_each(release);
            }
        }
        if chord.is_some() {
            self.settings.tolerance = chord;
            self.objects.iter_mut().take(MAX_OBJECTS).for_each(release);
        }
        self.settings.angle = angle.unwrap_or(self.settings.angle);
        self
    }
}

fn flat_normals(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    (0..mesh.triangles.len()).map(|triangle| [mesh.face_normal(triangle).unwrap_or(DVec3::ZERO); 3]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Primitive;
    use glam::DMat4;

    fn object(name: &str, primitive: Primitive, x: f64) -> Object {
        let transform = DMat4::from_translation(DVec3::X * x);
        Object { name: name.into(), shape: Shape::Solid(primitive), transform, material: None, tolerance: Some(0.2) }
    }

    #[test]
    fn triangles_are_grouped_by_object_and_surface() {
        let can = object("can", Primitive::Cylinder { radius: 1.0, height: 2.0 }, 0.0);
        let ball = object("ball", Primitive::Sphere { radius: 1.0 }, 5.0);
        let scene = Scene { objects: vec![can, ball], ..Scene::default() };
        let Grouped { mesh, names } = scene.tessellated().unwrap();
        assert_eq!(names, ["can/0", "can/1", "can/2", "ball"]);
        for (k, surface) in mesh.surfaces.iter().enumerate() {
            assert_eq!(*surface == 3, mesh.corners(k)[0].x > 3.0);
        }
        assert_eq!(mesh.corner_normals.len(), mesh.triangles.len());
        let finer = scene.clone().within(Some(0.001), Some(5.0)).tessellated().unwrap().mesh;
        assert!(finer.triangles.len() > 10 * mesh.triangles.len());
        let turned = scene.within(None, Some(5.0)).tessellated().unwrap().mesh;
        assert!(turned.triangles.len() > 5 * mesh.triangles.len(), "the angle alone makes it finer");
    }
}
