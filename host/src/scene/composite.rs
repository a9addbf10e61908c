//! Solids made of other objects.

use super::{Object, ShapeError};
use crate::mesh::{Mesh, normal_matrix};
use crate::solid::{Expression, Solid};
use glam::{DMat3, DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// Deepest nesting of composites.
pub const MAX_NESTING: u32 = 100;

/// A set operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// What is in any of them.
    Union,
    /// What is in all of them.
    Intersection,
    /// What is in the first and in none of the others.
    Difference,
}

impl Operation {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
        }
    }
}

/// Objects and what becomes of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Composite {
    /// How they are combined.
    pub operation: Operation,
    /// The objects; each must bound a solid. Their materials do not count.
    pub operands: Vec<Object>,
    /// How deep composites are nested in it: 1 if no operand is one.
    pub nesting: u32,
}

impl Composite {
    /// Triangles within `chord` of the exact surfaces. All operations of nested composites are done at once.
    ///
    /// # Errors
    /// [`ShapeError`] if an operand has no triangles, or bounds no solid.
    pub fn mesh(&self, chord: f64) -> Result<Mesh, ShapeError> {
        let mut solids = Vec::new();
        let expression = self.collect(&DMat4::IDENTITY, chord, &mut solids)?;
        let operands: Vec<&Solid> = solids.iter().collect();
        Ok(Solid::evaluate(&operands, &expression).0.into_mesh())
    }

    fn collect(&self, to_whole: &DMat4, chord: f64, solids: &mut Vec<Solid>) -> Result<Expression, ShapeError> {
        let mut parts = Vec::new();
        for operand in &self.operands {
            let to_whole = *to_whole * operand.transform;
            parts.push(match &operand.shape {
                super::Shape::Composite(inner) => inner.collect(&to_whole, chord, solids)?,
                _ => {
                    let mesh = operand.own_mesh(operand.tolerance.unwrap_or(chord), &to_whole)?;
                    let failed = |source| ShapeError::Solid { object: operand.name.clone(), source };
                    solids.push(Solid::new(placed(mesh, &to_whole)).map_err(failed)?);
                    Expression::Operand(solids.len() - 1)
                }
            });
        }
        Ok(match self.operation {
            Operation::Union => Expression::Union(parts),
            Operation::Intersection => Expression::Intersection(parts),
            Operation::Difference => {
                let others = parts.split_off(1.min(parts.len()));
                let first = parts.pop().unwrap_or(Expression::Union(Vec::new()));
                Expression::difference(first, Expression::Union(others))
            }
        })
    }
}

/// A mesh in another place, with normals at all corners.
fn placed(mut mesh: Mesh, to_whole: &DMat4) -> Mesh {
    if mesh.corner_normals.is_empty() {
        let flat = |triangle| [mesh.face_normal(triangle).unwrap_or(DVec3::ZERO); 3];
        mesh.corner_normals = (0..mesh.triangles.len()).map(flat).collect();
    }
    let normals = normal_matrix(DMat3::from_mat4(*to_whole));
    mesh.vertices.iter_mut().for_each(|vertex| *vertex = to_whole.transform_point3(*vertex));
    for corner in mesh.corner_normals.as_flattened_mut() {
        *corner = (normals * *corner).normalize_or_zero();
    }
    if to_whole.determinant() < 0.0 {
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        mesh.corner_normals.iter_mut().for_each(|normals| normals.swap(1, 2));
        mesh.corner_parameters.iter_mut().for_each(|parameters| parameters.swap(1, 2));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;
    use crate::illumination::Material;

    fn object(shape: Shape, transform: DMat4) -> Object {
        Object { name: shape.word().into(), shape, transform, material: Material::default(), tolerance: None }
    }

    #[test]
    fn nested_and_mirrored_composites_have_the_volume_of_the_set() {
        let cube = |x: f64| object(Shape::Box { size: DVec3::ONE }, DMat4::from_translation(DVec3::X * x));
        let inner = Composite { operation: Operation::Union, operands: vec![cube(0.0), cube(0.5)], nesting: 1 };
        let mirrored = DMat4::from_scale(DVec3::new(-2.0, 1.0, 1.0));
        let inner = object(Shape::Composite(Box::new(inner)), mirrored);
        let ball = object(Shape::Sphere { radius: 0.25 }, DMat4::IDENTITY);
        let operands = vec![inner, cube(-2.0), ball];
        let mesh = Composite { operation: Operation::Difference, operands, nesting: 2 }.mesh(1e-3).unwrap();
        // The bar reaches from -2 to 1, the cube takes all below -1.5, the ball its inscribed triangles.
        let rest = 2.5 - mesh.signed_volume();
        let ball = 4.0 / 3.0 * std::f64::consts::PI / 64.0;
        assert!(rest < ball && rest > ball - std::f64::consts::PI / 4.0 * 1e-3, "{rest} {ball}");
        assert_eq!(mesh.corner_normals.len(), mesh.triangles.len());
        for triangle in 0..mesh.triangles.len() {
            let face = mesh.face_normal(triangle).unwrap();
            assert!(mesh.corner_normals[triangle].iter().all(|normal| normal.dot(face) > 0.8));
        }
    }

    #[test]
    fn an_open_shape_is_named() {
        let operands = vec![object(Shape::Teapot, DMat4::IDENTITY), object(Shape::Bunny, DMat4::IDENTITY)];
        let error = Composite { operation: Operation::Union, operands, nesting: 1 }.mesh(0.01).unwrap_err();
        assert!(error.to_string().starts_with("teapot bounds no solid"), "{error}");
    }
}
