//! A scene as one mesh, of which every triangle knows its object and its surface.

use super::shape_mesh::flat_normals;
use super::{MAX_OBJECTS, Object, Scene, SceneError, Shape, ShapeMesh};
use crate::illumination::Material;
use crate::illumination::material::{MaterialKind, MaterialPreview};
use crate::mesh::{Grouped, MetallicRoughness};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// Most triangles of the mesh.
const MAX_TRIANGLES: u64 = 1 << 30;

impl Scene {
    /// The triangles of all objects in scene coordinates, with normals, and with parameters if all objects have them. A
    /// surface is named OBJECT, or OBJECT/NUMBER where an object has several, and has its material.
    ///
    /// # Errors
    /// [`SceneError`], for a value out of range or a mesh that cannot be made or read.
    pub fn tessellated(&self) -> Result<Grouped, SceneError> {
        self.check()?;
        let settings = &self.settings;
        let made = |object: &Object| object.tessellate(settings.geometry.tolerance, settings.geometry.angle);
        let all = self.objects.par_iter().map(made).collect::<Result<Vec<ShapeMesh>, SceneError>>()?;
        let mut whole = Grouped::default();
        for (object, made) in self.objects.iter().zip(all) {
            append(&mut whole, object, made)?;
        }
        Ok(whole)
    }

    /// The scene with a tolerance for all objects, whatever theirs were.
    ///
    /// - `chord`: largest distance between surface and triangles, scene units; without it the tolerances stay.
    /// - `angle`: largest turn of the normal along a triangle, degrees; without it that of the scene.
    pub fn within(mut self, chord: Option<f64>, angle: Option<f64>) -> Scene {
        fn release(object: &mut Object) {
            object.tolerance = None;
            match &mut object.shape {
                Shape::Composite(composite) => composite.operands.iter_mut().for_each(release),
                Shape::Instances(instances) => instances.prototypes.iter_mut().flatten().for_each(release),
                _ => {}
            }
        }
        if chord.is_some() {
            self.settings.geometry.tolerance = chord;
            self.objects.iter_mut().take(MAX_OBJECTS).for_each(release);
        }
        self.settings.geometry.angle = angle.unwrap_or(self.settings.geometry.angle);
        self
    }
}

/// Adds the triangles of an object where it stands, with its name and its materials.
///
/// # Errors
/// [`SceneError`], for too many triangles, or for a vertex that is not finite.
pub(super) fn append(whole: &mut Grouped, object: &Object, made: ShapeMesh) -> Result<(), SceneError> {
    let ShapeMesh { mut mesh, operand_of, .. } = made;
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
    let (materials, of_triangles) = object.materials(&operand_of);
    let mut looks = vec![metallic_roughness(&materials[0]); count];
    for (surface, material) in placed.surfaces.iter().zip(of_triangles) {
        looks[*surface as usize] = metallic_roughness(&materials[material as usize]);
    }
    whole.materials.extend(looks.into_iter().map(Some));
    Ok(())
}

/// A metallic-roughness material of glTF, which has one colour: what is mirrored counts to it, as a metal. Those terms
/// are a part of the principled material's.
///
/// # Source
/// The exponent n of a highlight belongs to facets of the roughness a with n = 2 / a^2 - 2 (Walter et al. 2007), and a
/// is the square of the number that glTF wants.
fn metallic_roughness(material: &Material) -> MetallicRoughness {
    if let MaterialKind::Principled(principled) = &material.body {
        let base = principled.base_color.mean_bands().clamp(DVec3::ZERO, DVec3::ONE);
        return MetallicRoughness {
            base,
            metallic: principled.metallic.mean(),
            roughness: principled.roughness.mean(),
        };
    }
    let sum = |bands: DVec3| bands.element_sum();
    let MaterialPreview { diffuse, specular, exponent, mirror } = material.preview();
    // The highlight of a body without another color is its color.
    let shine = if diffuse == DVec3::ZERO { specular } else { DVec3::ZERO };
    let base = (diffuse + mirror + shine).min(DVec3::ONE);
    let metallic = sum(mirror + shine) / (sum(diffuse) + sum(mirror + shine)).max(f64::MIN_POSITIVE);
    let roughness = if sum(specular) > 0.0 {
        (2.0 / (exponent + 2.0)).powf(0.25)
    } else if sum(mirror) > 0.0 {
        0.0
    } else {
        1.0
    };
    MetallicRoughness { base, metallic, roughness }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illumination::Paint;
    use crate::illumination::material::Classic;
    use crate::scene::{Composite, Operation};
    use crate::solid::Primitive;
    use glam::DMat4;

    #[test]
    fn materials_of_operands_become_looks_of_surfaces() {
        let grey = || Paint::grey(0.35);
        let shine = Classic { mirror: grey(), diffuse: grey(), ..Classic::default() }.into();
        let mut can = object("can", Primitive::Cylinder { radius: 1.0, height: 2.0 }, 0.0);
        let mut drill = object("drill", Primitive::Cylinder { radius: 0.5, height: 4.0 }, 0.0);
        (can.material, drill.material) = (Some(Material::default()), Some(shine));
        let composite = Composite { operation: Operation::Difference, operands: vec![can.clone(), drill], nesting: 1 };
        let part = Object { shape: Shape::Composite(Box::new(composite)), material: None, ..can };
        let Grouped { mesh, materials: looks, .. } =
            Scene { objects: vec![part], ..Scene::default() }.tessellated().unwrap();
        for (triangle, surface) in mesh.surfaces.iter().enumerate() {
            let is_hole = mesh.corners(triangle).iter().all(|p| p.x.hypot(p.z) < 0.6);
            let look = looks[*surface as usize].unwrap();
            assert_eq!((look.base, look.metallic), (DVec3::splat(0.7), if is_hole { 0.5 } else { 0.0 }));
        }
    }

    fn object(name: &str, primitive: Primitive, x: f64) -> Object {
        let transform = DMat4::from_translation(DVec3::X * x);
        Object { name: name.into(), shape: Shape::from(primitive), transform, material: None, tolerance: Some(0.2) }
    }

    #[test]
    fn triangles_are_grouped_by_object_and_surface() {
        let can = object("can", Primitive::Cylinder { radius: 1.0, height: 2.0 }, 0.0);
        let ball = object("ball", Primitive::Sphere { radius: 1.0 }, 5.0);
        let scene = Scene { objects: vec![can, ball], ..Scene::default() };
        let Grouped { mesh, names, materials: looks } = scene.tessellated().unwrap();
        assert_eq!(looks, [Some(MetallicRoughness { base: DVec3::splat(0.7), metallic: 0.0, roughness: 1.0 }); 4]);
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
