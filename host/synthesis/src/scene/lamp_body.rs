//! The bodies of lamps that reflect: objects of the lamps' shapes, which rays hit and renderers draw as any other.

use super::object::{Object, Shape};
use super::shape_mesh::ShapeMesh;
use super::{GeometrySettings, SceneError};
use crate::color::Color;
use crate::illumination::Material;
use crate::illumination::light::LightShape;
use crate::memory;
use crate::mesh::Mesh;
use crate::solid::Primitive;
use crate::surface::{Parallelogram, Surface, TessellationError, Tolerance, tessellate};
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Largest distance between a sphere and the triangles that stand for it, in parts of its radius: its outline is then
/// smaller by less than a thousandth.
const CHORD: f64 = 1.5e-3;
/// Sides of the polygon that stands for a disc.
const SIDES: usize = 128;
/// Bytes of a triangle of a prepared scene, with all that belongs to it.
const BYTES: u64 = 64;

/// The body of a lamp: an object of its material that emits nothing, and its triangles, whose outside is where the lamp
/// emits.
///
/// A sphere has its exact surface, and triangles within it; the polygon of a disc has the area of the disc. Parameters
/// go from 0 to 1 along the sides of a rectangle, and across the square around a disc.
///
/// - `number`: of the light, from 0.
///
/// # Errors
/// [`SceneError::Object`] if there is not enough memory for its triangles.
pub(super) fn lamp_body(
    patch: &LightShape,
    material: &Material,
    number: u32,
    settings: &GeometrySettings,
) -> Result<(Object, ShapeMesh), SceneError> {
    let name = format!("light {}", number + 1);
    // Of flat lamps only the triangles are asked for, not the shape.
    let flat = Shape::Ground { size: 1.0 };
    let at = |shape: Shape, center: DVec3, tolerance: Option<f64>| Object {
        name: name.clone(),
        shape,
        transform: DMat4::from_translation(center),
        material: Some(Material { emission: Color::BLACK, ..material.clone() }),
        tolerance,
    };
    let (body, made) = match *patch {
        LightShape::Rectangle { corner, across, up } => {
            let middle = 0.5 * (across + up);
            let failed =
                |error: TessellationError| SceneError::Object { object: name.clone(), problem: error.to_string() };
            (at(flat, corner + middle, None), rectangle(-middle, across, up).map_err(failed)?)
        }
        LightShape::Disc { center, normal, radius } => {
            (at(flat, center, None), disc(normal.normalize_or(DVec3::Y), radius))
        }
        LightShape::Sphere { center, radius } => {
            let asked_for = settings.tolerance.unwrap_or(f64::INFINITY).min(CHORD * radius);
            let body = at(Shape::from(Primitive::Sphere { radius }), center, Some(asked_for));
            let made = body.tessellate(None, settings.angle)?;
            (body, made)
        }
    };
    let triangles = made.mesh.triangles.len() as u64;
    memory::reserve(triangles * BYTES, || format!("{name} of {triangles} triangles"))
        .map_err(|excess| SceneError::Object { object: name.clone(), problem: excess.to_string() })?;
    Ok((body, made))
}

/// A rectangle whose outside is where its sides turn counter-clockwise.
fn rectangle(corner: DVec3, across: DVec3, up: DVec3) -> Result<ShapeMesh, TessellationError> {
    let surface: Vec<Arc<dyn Surface>> = vec![Arc::new(Parallelogram::new(corner, across, up))];
    let mesh = tessellate(&surface, Tolerance::new(f64::MAX, 180.0))?;
    Ok(ShapeMesh { mesh, surfaces: surface.into_iter().map(Some).collect(), ..ShapeMesh::default() })
}

/// A polygon about the origin of the area of a disc, its outside where the normal, of unit length, points.
fn disc(normal: DVec3, radius: f64) -> ShapeMesh {
    let across = normal.any_orthonormal_vector();
    let up = normal.cross(across);
    let step = TAU / SIDES as f64;
    let radius = radius * (step / step.sin()).sqrt();
    let turned = |k: usize| {
        let (sin, cos) = (step * (k % SIDES) as f64).sin_cos();
        DVec2::new(cos, sin)
    };
    let mut mesh = Mesh { vertices: vec![DVec3::ZERO], ..Mesh::default() };
    for k in 0..SIDES {
        let at = [DVec2::ZERO, turned(k), turned(k + 1)];
        mesh.vertices.push((across * at[1].x + up * at[1].y) * radius);
        mesh.triangles.push([0, k as u32 + 1, (k as u32 + 1) % SIDES as u32 + 1]);
        mesh.corner_normals.push([normal; 3]);
        mesh.corner_parameters.push(at.map(|at| 0.5 * (at + DVec2::ONE)));
        mesh.surfaces.push(0);
    }
    ShapeMesh { mesh, surfaces: vec![None], ..ShapeMesh::default() }
}

#[cfg(test)]
mod tests {
    use crate::color::Color;
    use crate::illumination::light::LightShape;
    use crate::illumination::{Light, Material};
    use crate::numeric::bounds::Bounds;
    use crate::scene::{Prepared, Scene};
    use glam::DVec3;

    #[test]
    fn a_body_has_the_area_of_its_lamp_and_faces_where_this_emits() {
        let center = DVec3::new(1.0, 2.0, -3.0);
        let (across, up) = (DVec3::new(0.3, 0.0, 0.4), DVec3::new(0.0, 2.0, 0.5));
        for patch in [
            LightShape::Rectangle { corner: center - 0.5 * (across + up), across, up },
            LightShape::Disc { center, normal: DVec3::new(1.0, -3.0, 0.5), radius: 0.7 },
            LightShape::Sphere { center, radius: 1.5 },
        ] {
            let material = Box::new(Material { emission: Color::grey(1.0), ..Material::default() });
            let lamp = Light::Lamp { patch, radiance: Color::grey(2.0), material };
            let point = Light::Point { at: DVec3::ZERO, intensity: Color::grey(1.0) };
            let scene = Scene { lights: vec![point, lamp.clone()], ..Scene::default() };
            let prepared = Prepared::new(&scene).expect("a lamp");
            let [body] = &prepared.objects[..] else { panic!("{:?}", prepared.objects) };
            assert_eq!((&*body.name, body.shape, body.light), ("light 2", "light", Some(1)));
            assert!(prepared.is_lit_lamp(body) && body.materials[0].emission.is_black());
            let (mut area, mut outwards) = (DVec3::ZERO, 0.0);
            let mut whole = 0.0;
            for triangle in 0..body.count {
                let [a, b, c] = prepared.corners(triangle);
                let normal = 0.5 * (b - a).cross(c - a);
                area += normal;
                whole += normal.length();
                outwards += normal.dot(a - center);
            }
            assert!((whole / patch.area() - 1.0).abs() < 4e-3, "{whole} {}", patch.area());
            let front = match patch {
                LightShape::Rectangle { .. } => area.normalize().dot(across.cross(up).normalize()),
                LightShape::Disc { normal, .. } => area.normalize().dot(normal.normalize()),
                LightShape::Sphere { radius, .. } => outwards / (radius * patch.area()),
            };
            assert!((front - 1.0).abs() < 4e-3, "{front}");
            let [low, high] = patch.bounds();
            assert!(prepared.bounds.touches(Bounds::of([low, high])) && prepared.subject() == prepared.bounds);
        }
    }
}
