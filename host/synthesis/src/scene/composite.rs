//! Solids made of other objects.

use super::ShapeError;
use super::object::{Composite, Object, Operation, Shape};
use super::shape_mesh::ShapeMesh;
use super::stretch::largest_stretch;
use crate::illumination::Material;
use crate::mesh::normal_matrix;
use crate::numeric::bounds::Bounds;
use crate::solid::primitive::half_space;
use crate::solid::{ExactSolid, Expression, PrimitiveError, SolidError};
use crate::surface::Tolerance;
use glam::{DAffine3, DMat4, DVec3};
use rayon::prelude::*;

/// Operands that a message names.
const NAMED: usize = 4;

/// An operand that is no composite itself.
struct LeafOperand<'a> {
    object: &'a Object,
    to_composite: DMat4,
    material: Option<Material>,
    /// Distance between its surface and its triangles in the coordinates of the whole.
    chord: f64,
}

impl Composite {
    /// Triangles within `tolerance` of the exact surfaces, with normals and parameters of these. All operations of nested
    /// composites are done at once.
    ///
    /// # Errors
    /// [`ShapeError`] if an operand has no triangles, or bounds no solid, or if the result has no end or crosses itself.
    pub fn tessellate(&self, tolerance: Tolerance) -> Result<ShapeMesh, ShapeError> {
        let mut leaves = Vec::new();
        let expression = self.collect(&DMat4::IDENTITY, None, tolerance.chord, &mut leaves);
        let finite =
            |leaf: &LeafOperand| if leaf.is_half_space() { Ok(None) } else { leaf.solid(tolerance.angle).map(Some) };
        let finite: Vec<Option<ExactSolid>> = leaves.par_iter().map(finite).collect::<Result<_, _>>()?;
        let vertices = finite.iter().flatten().flat_map(|solid| &solid.solid().mesh().vertices);
        let bounds = Bounds::of(vertices.copied());
        let filled = finite.into_iter().zip(&leaves).map(|(solid, leaf)| match solid {
            Some(solid) => Ok(solid),
            None => leaf.half_space(&bounds),
        });
        let solids: Vec<ExactSolid> = filled.collect::<Result<_, _>>()?;
        let (result, outcome) = ExactSolid::evaluate(&solids.iter().collect::<Vec<_>>(), &expression)
            .map_err(|source| ShapeError::Solid { object: self.title(), source })?;
        let (mesh, surfaces) = result.into_parts();
        // A half-space reaches far beyond all others: what keeps its end has none itself.
        let reach = bounds.diagonal();
        let is_beyond = |p: &DVec3| (*p - p.clamp(bounds.min, bounds.max)).length() > reach;
        if leaves.iter().any(LeafOperand::is_half_space) && (bounds.is_empty() || mesh.vertices.iter().any(is_beyond)) {
            return Err(PrimitiveError::Endless.into());
        }
        let operand_of = outcome.sources.iter().map(|[operand, _]| *operand).collect();
        Ok(ShapeMesh { mesh, surfaces, operand_of, ..ShapeMesh::default() })
    }

    /// What it is called in messages.
    fn title(&self) -> String {
        let names: Vec<&str> = self.operands.iter().map(|operand| operand.name.as_str()).take(NAMED).collect();
        let more = if self.operands.len() > names.len() { " ..." } else { "" };
        format!("{}({}{more})", self.operation.word(), names.join(", "))
    }

    /// The materials of the operands that are no composites, in the order in which triangles name them.
    ///
    /// - `whole`: that of the object that the composite is the shape of, if it has one.
    pub(super) fn materials(&self, whole: Option<Material>) -> Vec<Material> {
        let mut leaves = Vec::new();
        self.collect(&DMat4::IDENTITY, whole, 1.0, &mut leaves);
        leaves.iter().map(|leaf| leaf.material.clone().unwrap_or_default()).collect()
    }

    /// That of its first operand that has one, as far as it goes.
    pub(super) fn first_material(&self) -> Option<Material> {
        self.operands.first()?.own_material()
    }

    /// The greatest of its operands.
    pub(super) fn extent(&self) -> Option<f64> {
        self.operands.iter().filter_map(Object::extent).reduce(f64::max)
    }

    fn collect<'a>(
        &'a self,
        to_whole: &DMat4,
        whole: Option<Material>,
        chord: f64,
        leaves: &mut Vec<LeafOperand<'a>>,
    ) -> Expression {
        let whole = whole.or_else(|| self.first_material());
        let part = |operand: &'a Object| {
            let (to_whole, material) =
                (*to_whole * operand.transform, operand.material.clone().or_else(|| whole.clone()));
            match &operand.shape {
                Shape::Composite(inner) => inner.collect(&to_whole, material, chord, leaves),
                _ => {
                    let chord = operand.tolerance.unwrap_or(chord);
                    leaves.push(LeafOperand { object: operand, to_composite: to_whole, material, chord });
                    Expression::Operand(leaves.len() - 1)
                }
            }
        };
        let mut parts: Vec<Expression> = self.operands.iter().map(part).collect();
        match self.operation {
            Operation::Union => Expression::Union(parts),
            Operation::Intersection => Expression::Intersection(parts),
            Operation::SymmetricDifference => Expression::SymmetricDifference(parts),
            Operation::Difference => {
                let others = parts.split_off(1.min(parts.len()));
                let first = parts.pop().unwrap_or(Expression::Union(Vec::new()));
                Expression::difference(first, Expression::Union(others))
            }
        }
    }
}

impl LeafOperand<'_> {
    fn is_half_space(&self) -> bool {
        matches!(self.object.shape, Shape::HalfSpace { .. })
    }

    fn placement(&self) -> DAffine3 {
        DAffine3::from_mat4(self.to_composite)
    }

    fn failed(&self, source: SolidError) -> ShapeError {
        ShapeError::Solid { object: self.object.name.clone(), source }
    }

    fn solid(&self, angle: f64) -> Result<ExactSolid, ShapeError> {
        let tolerance = Tolerance::new(self.chord / largest_stretch(&self.to_composite), angle);
        let ShapeMesh { mesh, surfaces, .. } = self.object.shape.tessellate(tolerance)?;
        ExactSolid::new_at(mesh, surfaces, &self.placement()).map_err(|source| self.failed(source))
    }

    /// As much of a half-space as covers `bounds`, which are in the coordinates of the whole.
    fn half_space(&self, bounds: &Bounds) -> Result<ExactSolid, ShapeError> {
        let Shape::HalfSpace { normal, at } = self.object.shape else { return Err(PrimitiveError::Endless.into()) };
        let normal = normal_matrix(self.placement().matrix3) * normal;
        let body = half_space(normal, self.to_composite.transform_point3(at), bounds)?;
        Ok(body.solid(Tolerance::new(1.0, 90.0))?)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Prepared;
    use super::*;
    use crate::color::Color;
    use crate::illumination::material::Classic;
    use crate::scene::Scene;
    use crate::solid::Primitive;
    use glam::DVec3;
    use std::f64::consts::PI;

    fn object(shape: Shape, transform: DMat4) -> Object {
        Object { name: shape.word().into(), shape, transform, material: None, tolerance: None }
    }

    fn solid(primitive: Primitive) -> Object {
        object(Shape::from(primitive), DMat4::IDENTITY)
    }

    fn cube(x: f64) -> Object {
        object(Shape::from(Primitive::Box { size: DVec3::ONE }), DMat4::from_translation(DVec3::X * x))
    }

    fn within(chord: f64) -> Tolerance {
        Tolerance::new(chord, 45.0)
    }

    fn composite(operation: Operation, operands: Vec<Object>) -> Composite {
        Composite { operation, operands, nesting: 1 }
    }

    #[test]
    fn nested_and_mirrored_composites_have_the_volume_of_the_set() {
        let inner = composite(Operation::Union, vec![cube(0.0), cube(0.5)]);
        let mirrored = DMat4::from_scale(DVec3::new(-2.0, 1.0, 1.0));
        let inner = object(Shape::Composite(Box::new(inner)), mirrored);
        let operands = vec![inner, cube(-2.0), solid(Primitive::Sphere { radius: 0.25 })];
        let mesh =
            Composite { operation: Operation::Difference, operands, nesting: 2 }.tessellate(within(1e-3)).unwrap().mesh;
        // The bar reaches from -2 to 1, the cube takes all below -1.5, the ball its inscribed triangles.
        let rest = 2.5 - mesh.signed_volume();
        let ball = 4.0 / 3.0 * PI / 64.0;
        assert!(rest < ball && rest > ball - PI / 4.0 * 1e-3, "{rest} {ball}");
        assert_eq!(mesh.corner_normals.len(), mesh.triangles.len());
        for triangle in 0..mesh.triangles.len() {
            let face = mesh.face_normal(triangle).unwrap();
            assert!(mesh.corner_normals[triangle].iter().all(|normal| normal.dot(face) > 0.8));
        }
    }

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn an_open_shape_is_named() {
        let operands = vec![object(Shape::Teapot, DMat4::IDENTITY), object(Shape::Bunny, DMat4::IDENTITY)];
        let error = composite(Operation::Union, operands).tessellate(within(0.01)).err().unwrap();
        assert!(error.to_string().starts_with("teapot bounds no solid"), "{error}");
    }

    #[test]
    fn triangles_know_the_placed_surfaces_of_their_operands() {
        let drill = Object {
            transform: DMat4::from_rotation_z(0.3) * DMat4::from_scale(DVec3::new(1.0, 1.0, 2.0)),
            ..solid(Primitive::Cylinder { radius: 0.4, height: 4.0 })
        };
        let made = composite(Operation::Difference, vec![solid(Primitive::Sphere { radius: 1.0 }), drill]);
        let ShapeMesh { mesh, surfaces, operand_of, .. } = made.tessellate(within(1e-3)).unwrap();
        assert_eq!((surfaces.len(), operand_of.len()), (4, mesh.triangles.len()));
        for triangle in 0..mesh.triangles.len() {
            let surface = surfaces[mesh.surfaces[triangle] as usize].as_ref().unwrap();
            assert_eq!(operand_of[triangle], u32::from(mesh.surfaces[triangle] > 0));
            for (corner, point) in mesh.corners(triangle).into_iter().enumerate() {
                let (uv, normal) = (mesh.corner_parameters[triangle][corner], mesh.corner_normals[triangle][corner]);
                assert!(surface.point(uv).distance(point) < 2e-3);
                let side = if operand_of[triangle] == 0 { 1.0 } else { -1.0 };
                assert!((surface.normal(uv) * side - normal).length() < 1e-12);
                // The way to the surface is along its normal.
                let off = point - surface.point(uv);
                assert!(off.cross(normal).length() < 1e-12, "{triangle}: {off}");
            }
        }
    }

    #[test]
    fn half_spaces_cut_and_do_not_make_endless_solids() {
        let half = || object(Shape::HalfSpace { normal: DVec3::Y, at: DVec3::Y * 0.25 }, DMat4::IDENTITY);
        let ball = || solid(Primitive::Sphere { radius: 1.0 });
        let cap =
            |operation| Ok::<_, ShapeError>(composite(operation, vec![ball(), half()]).tessellate(within(1e-4))?.mesh);
        let (below, above) = (cap(Operation::Intersection).unwrap(), cap(Operation::Difference).unwrap());
        assert!((above.signed_volume() - PI * 0.75_f64.powi(2) * 2.25 / 3.0).abs() < 1e-3);
        assert!((below.signed_volume() + above.signed_volume() - 4.0 / 3.0 * PI).abs() < 1e-3);
        assert!(below.bounds().unwrap().max.y == 0.25 && above.bounds().unwrap().min.y == 0.25);
        assert!(cap(Operation::Union).unwrap_err().to_string().starts_with("a half-space has no end"));
        assert!(half().shape.tessellate(within(1.0)).is_err());
        assert!(composite(Operation::Union, vec![half(), half()]).tessellate(within(1.0)).is_err());
    }

    #[test]
    fn faces_keep_the_material_that_their_operand_was_given() {
        let paint = |r, g, b| {
            Material::from(Classic { diffuse: Color::Bands(DVec3::new(r, g, b)).into(), ..Classic::default() })
        };
        let red = paint(0.9, 0.1, 0.1);
        let blue = paint(0.1, 0.1, 0.9);
        let all = |one: Option<&Material>, two: Option<&Material>, whole: Option<&Material>| {
            let [one, two, whole] = [one, two, whole].map(|material| material.cloned());
            let operands =
                vec![Object { material: one, ..cube(0.0) }, Object { material: two, ..cube(0.5) }, cube(0.75)];
            let shape = Shape::Composite(Box::new(composite(Operation::Union, operands)));
            let scene = Scene {
                objects: vec![Object { material: whole, ..object(shape, DMat4::IDENTITY) }],
                ..Scene::default()
            };
            let prepared = Prepared::new(&scene).unwrap();
            let at = |x: f64| {
                let is_there = |t: &u32| prepared.corners(*t).iter().all(|corner| corner.x == x);
                prepared.material((0..prepared.triangles.len() as u32).find(is_there).unwrap()).clone()
            };
            // The end of the first cube, and that of the third.
            [at(-0.5), at(1.25)]
        };
        assert_eq!(all(Some(&red), Some(&blue), None), [red.clone(), red.clone()]);
        assert_eq!(all(None, Some(&red), Some(&blue)), [blue.clone(), blue.clone()]);
        assert_eq!(all(Some(&red), None, Some(&blue)), [red, blue]);
        assert_eq!(all(None, None, None), [Material::default(), Material::default()]);
    }
}
