//! Objects and their shapes, as data: a shape may be made of other objects.

use super::cage::Cage;
use super::sculpture::Sculpture;
use super::solid::PrimitiveSolid;
use crate::illumination::Material;
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// One object: a shape, placed, of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// What messages and tables call it.
    pub name: String,
    /// Its form in its own coordinates.
    pub shape: Shape,
    /// Own coordinates to scene coordinates (column vectors: `p' = M p`); affine, not singular.
    pub transform: DMat4,
    /// How its surface reflects. Without one, an operand of a composite has that of the whole that it is part of, a
    /// composite that of its first operand, and others have the default.
    pub material: Option<Material>,
    /// Largest distance between surface and triangles in scene units; without one, that of the scene.
    pub tolerance: Option<f64>,
}

/// The word for [`Shape::Ground`].
pub(super) const GROUND: &str = "ground";

/// The form of an object in its own coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// The Utah teapot, resting on y = 0, its spout towards +x.
    Teapot,
    /// The Stanford bunny, about 2 high.
    Bunny,
    /// A solid of a few measures.
    Solid(PrimitiveSolid),
    /// All that is behind a plane; it must be combined with other solids.
    HalfSpace {
        /// Towards the empty side, any length above 0.
        normal: DVec3,
        /// A point of the plane.
        at: DVec3,
    },
    /// A square in the plane y = 0 around the origin, seen from above.
    Ground {
        /// Its side.
        size: f64,
    },
    /// A mesh from an OBJ, STL, PLY or glTF file.
    Mesh {
        /// The file.
        path: PathBuf,
    },
    /// Geometry of a database.
    Stored {
        /// The file of the database; none if it ships with the program.
        database: Option<PathBuf>,
        /// Its name.
        name: String,
    },
    /// Sculptured surfaces, open or closed.
    Sculpture(Box<Sculpture>),
    /// The smooth limit of a polyhedron.
    Subdivision(Box<Cage>),
    /// A solid made of other objects.
    Composite(Box<Composite>),
    /// The intersection curves of two objects; lines without triangles.
    Curve(Box<[Object; 2]>),
    /// A solid with rounded edges.
    Rounded(Box<RoundedSolid>),
}

/// A solid of flat faces, edges of which are rounded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoundedSolid {
    /// The solid.
    pub object: Object,
    /// Points; for each the edge that is nearest to it is rounded. Without any, all edges are.
    pub edges: Vec<DVec3>,
    /// Radius of a ball that touches the faces where the rounding begins.
    pub radius: f64,
}

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
    /// What is in an odd number of them.
    SymmetricDifference,
}

impl Operation {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
            Operation::SymmetricDifference => "symmetric_difference",
        }
    }
}

/// Objects and what becomes of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Composite {
    /// How they are combined.
    pub operation: Operation,
    /// The objects; each must bound a solid. A face keeps the material of its operand; see [`Object::material`].
    pub operands: Vec<Object>,
    /// How deep composites are nested in it: 1 if no operand is one.
    pub nesting: u32,
}

impl From<Primitive> for Shape {
    fn from(primitive: Primitive) -> Shape {
        Shape::Solid(primitive.into())
    }
}

impl Shape {
    /// The word for the kind.
    pub fn word(&self) -> &'static str {
        match self {
            Shape::Teapot => "teapot",
            Shape::Bunny => "bunny",
            Shape::Solid(solid) => solid.primitive().word(),
            Shape::HalfSpace { .. } => "half_space",
            Shape::Ground { .. } => GROUND,
            Shape::Mesh { .. } => "mesh",
            Shape::Stored { .. } => "stored",
            Shape::Sculpture(_) => "surface",
            Shape::Subdivision(_) => "subdivision",
            Shape::Composite(composite) => composite.operation.word(),
            Shape::Curve(_) => "curve",
            Shape::Rounded(rounded) => rounded.object.shape.word(),
        }
    }
}

impl Object {
    /// The materials of its surface, each once, and which of them its triangles have; nothing if that is the same for
    /// all.
    ///
    /// - `operand_of`: for each triangle of a composite its innermost operand, as [`ShapeMesh`](super::ShapeMesh)
    ///   tells.
    pub fn materials(&self, operand_of: &[u32]) -> (Vec<Material>, Vec<u32>) {
        let Some((composite, whole)) = self.composite() else {
            return (vec![self.own_material().unwrap_or_default()], Vec::new());
        };
        let mut materials: Vec<Material> = Vec::new();
        let mut number = |material: Material| {
            materials.iter().position(|known| *known == material).unwrap_or_else(|| {
                materials.push(material);
                materials.len() - 1
            }) as u32
        };
        let of_operand: Vec<u32> = composite.materials(whole).into_iter().map(&mut number).collect();
        if materials.len() < 2 {
            return (vec![materials.pop().unwrap_or_default()], Vec::new());
        }
        (materials, operand_of.iter().map(|operand| of_operand[*operand as usize]).collect())
    }

    /// The composite whose operands its triangles come from, and the material of the whole.
    fn composite(&self) -> Option<(&Composite, Option<Material>)> {
        match &self.shape {
            Shape::Composite(composite) => Some((composite, self.material.clone())),
            Shape::Rounded(rounded) => {
                let (composite, inner) = rounded.object.composite()?;
                Some((composite, self.material.clone().or(inner)))
            }
            _ => None,
        }
    }

    /// The material that it was given; of a composite without one that of its first operand.
    pub fn own_material(&self) -> Option<Material> {
        match &self.shape {
            Shape::Composite(composite) => self.material.clone().or_else(|| composite.first_material()),
            Shape::Rounded(rounded) => self.material.clone().or_else(|| rounded.object.own_material()),
            _ => self.material.clone(),
        }
    }
}
