//! Objects and their shapes, as data: a shape may be made of other objects.

use super::cage::Cage;
use super::made_mesh::MadeMesh;
use super::sculpture::Sculpture;
use super::solid::PrimitiveSolid;
use super::terrain::Terrain;
use crate::illumination::Material;
use crate::illumination::texture::NumberTexture;
use crate::numeric::bounds::Bounds;
use crate::octree::Instance;
use crate::procedural::Wind;
use crate::solid::Primitive;
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

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
    /// Ground whose heights are a fractal.
    Terrain(Box<Terrain>),
    /// Triangles that a model made.
    Made(MadeMesh),
    /// A solid made of other objects.
    Composite(Box<Composite>),
    /// The intersection curves of two objects; lines without triangles.
    Curve(Box<[Object; 2]>),
    /// A solid with rounded edges.
    Rounded(Box<RoundedSolid>),
    /// Objects that are placed many times.
    Instances(Box<Instances>),
    /// What is made when it is looked at, where instances place it; where it stands itself, the first of its kinds.
    Procedural(Procedural),
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

/// Objects that are placed many times, as one object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instances {
    /// What is placed: groups of objects, each in coordinates of its own. Objects of a group may be instances again.
    pub prototypes: Vec<Vec<Object>>,
    /// Where.
    pub placing: Placing,
}

/// Where instances are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Placing {
    /// At places that are told one by one, by any affine maps.
    Listed(PlacementList),
    /// By chance, on a surface.
    Scattered(Box<Scatter>),
}

/// Instances by chance on the surface of an object: as many in each part of its area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scatter {
    /// The object, in coordinates of the instances.
    pub on: Object,
    /// How many instances, or how many in each cell; there are fewer where these do not find room.
    pub count: usize,
    /// Side of square cells, units of the instances: those in a cell are a function of the cell and the seed, and stored
    /// nowhere. The object must be a ground then.
    pub cell: Option<f64>,
    /// In cells: beyond the distance from the eye at which the largest of them spans so many pixels, fewer and larger
    /// ones stand in for all; 1/256 to 256. None where all are seen as they are.
    pub aggregate: Option<f64>,
    /// Of each two instances the least distance, 0 and more.
    pub distance: f64,
    /// The part of the instances that stay, 0 to 1, by place.
    pub density: NumberTexture,
    /// The least and the greatest angle between the surface and a level one, degrees.
    pub slope: [f64; 2],
    /// The least and the greatest y.
    pub height: [f64; 2],
    /// The least and the greatest scale, above 0.
    pub scale: [f64; 2],
    /// Within which angle they are turned about their axis, degrees; 360 is every way.
    pub turn: f64,
    /// How far their axis leans at the most, degrees, below 90.
    pub lean: f64,
    /// Where their axis, that is y of a prototype, points: 0 along the normal of the surface, 1 up.
    pub upright: f64,
    /// How deep their origin is below the surface, along their axis, units of the instances.
    pub sink: f64,
    /// How often there is each of the prototypes, in the same unit.
    pub shares: Vec<f64>,
    /// How the wind bends them; none where it does not.
    pub sway: Option<Sway>,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// How the wind at a time bends what stands in it.
///
/// An instance leans about its origin the way the wind blows there: the tangent of the angle grows as the square of the
/// speed, since that is how drag grows against a stem that gives way as a spring does. What a gust has
/// beyond two standard deviations above the mean speed does not count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sway {
    /// The wind, in coordinates of the instances.
    pub wind: Wind,
    /// The time, seconds.
    pub time: f64,
    /// How far an instance leans at a speed of 10, degrees, 0 to 89.
    pub lean: f64,
}

impl Instances {
    /// How many pixels the largest of them spans where aggregates begin to stand in; none where none do.
    ///
    /// - `asked`: what counts instead of what they tell themselves.
    pub(super) fn aggregate(&self, asked: Option<f64>) -> Option<f64> {
        let Placing::Scattered(scatter) = &self.placing else { return None };
        asked.filter(|_| scatter.cell.is_some()).or(scatter.aggregate).filter(|pixels| *pixels > 0.0)
    }
}

impl Scatter {
    /// Instances of one prototype all over an object, square to its surface, each turned by chance.
    pub fn over(on: Object, count: usize) -> Scatter {
        Scatter {
            on,
            count,
            cell: None,
            aggregate: None,
            distance: 0.0,
            density: NumberTexture::Constant(1.0),
            slope: [0.0, 180.0],
            height: [f64::NEG_INFINITY, f64::INFINITY],
            scale: [1.0, 1.0],
            turn: 360.0,
            lean: 0.0,
            upright: 0.0,
            sink: 0.0,
            shares: vec![1.0],
            sway: None,
            seed: 1,
        }
    }
}

/// A procedural model: a sparse description from which objects are made.
///
/// What it makes is a function of a seed and of a length alone, the same whenever it is asked and on whichever thread.
pub trait ProceduralModel: fmt::Debug + Send + Sync {
    /// The box that holds all that it makes, in coordinates of its own.
    fn bounds(&self) -> Bounds;

    /// How many different ones there are, 1 to [`MOST_KINDS`](super::MOST_KINDS).
    fn kinds(&self) -> u32;

    /// Materials that some of them have and the first may lack; those that the first has may be among them.
    fn materials(&self) -> Vec<Material>;

    /// Makes one of them: surfaces and instances of surfaces, in coordinates of its own.
    ///
    /// - `seed`: which one, below [`ProceduralModel::kinds`].
    /// - `detail`: what a pixel spans where it is seen, units of its own, above 0. What is smaller may be left out, as may
    ///   all that changes what is seen by less.
    ///
    /// # Errors
    /// What is wrong, in words, with the place in the script if it comes from one.
    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String>;

    /// All that decides what it makes, as text.
    fn definition(&self) -> String;
}

/// A procedural model as the shape of an object.
#[derive(Clone)]
pub struct Procedural {
    pub(super) model: Arc<dyn ProceduralModel>,
    /// The first of its kinds, as it is made without a view.
    pub(super) pattern: Arc<Vec<Object>>,
}

/// Placements one by one. As text, only their number is shown and a checksum: there may be millions.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PlacementList(pub Vec<Instance>);

impl fmt::Debug for PlacementList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sum = crc32fast::Hasher::new();
        for Instance { prototype, variation, placement } in &self.0 {
            sum.update(bytemuck::bytes_of(&[*prototype, *variation]));
            sum.update(bytemuck::cast_slice(&placement.to_cols_array()));
        }
        write!(f, "{} placements, {:08x}", self.0.len(), sum.finalize())
    }
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
            Shape::Terrain(_) => "terrain",
            Shape::Made(_) => "triangles",
            Shape::Composite(composite) => composite.operation.word(),
            Shape::Curve(_) => "curve",
            Shape::Rounded(rounded) => rounded.object.shape.word(),
            Shape::Instances(_) => "instances",
            Shape::Procedural(_) => "procedural",
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
        let mut materials: Vec<Material> = Vec::new();
        let mut number = |material: Material| {
            materials.iter().position(|known| *known == material).unwrap_or_else(|| {
                materials.push(material);
                materials.len() - 1
            }) as u32
        };
        let of_operand: Vec<u32> = self.operand_materials().into_iter().map(&mut number).collect();
        if materials.len() < 2 {
            return (vec![materials.pop().unwrap_or_default()], Vec::new());
        }
        (materials, operand_of.iter().map(|operand| of_operand[*operand as usize]).collect())
    }

    /// The materials of its operands, and of what instances place, in the order in which triangles name them; that of
    /// the object, if it has no such parts.
    pub(super) fn operand_materials(&self) -> Vec<Material> {
        if let Shape::Instances(instances) = &self.shape {
            let objects = instances.prototypes.iter().flatten();
            return objects.flat_map(|object| object.within(&self.material).operand_materials()).collect();
        }
        if let Shape::Procedural(model) = &self.shape {
            let objects = model.pattern.iter();
            return objects.flat_map(|object| object.within(&self.material).operand_materials()).collect();
        }
        match self.composite() {
            Some((composite, whole)) => composite.materials(whole),
            None => vec![self.own_material().unwrap_or_default()],
        }
    }

    /// Whether it is, or places, a procedural model.
    pub fn has_models(&self) -> bool {
        match &self.shape {
            Shape::Procedural(_) => true,
            Shape::Instances(instances) => instances.prototypes.iter().flatten().any(Object::has_models),
            _ => false,
        }
    }

    /// Whether it is scattered in cells, so that aggregates may stand in for what is far away.
    pub fn is_in_cells(&self) -> bool {
        let Shape::Instances(instances) = &self.shape else { return false };
        matches!(&instances.placing, Placing::Scattered(scatter) if scatter.cell.is_some())
    }

    /// How many pixels the largest of its instances spans where aggregates begin to stand in; none where none do.
    pub fn aggregate(&self) -> Option<f64> {
        let Shape::Instances(instances) = &self.shape else { return None };
        instances.aggregate(None)
    }

    /// Whether any of its surface emits light.
    pub fn emits(&self) -> bool {
        self.operand_materials().iter().any(|material| !material.emission.is_black())
    }

    /// It, with the material of the whole that it is part of if it has none.
    pub fn within(&self, whole: &Option<Material>) -> Cow<'_, Object> {
        match (self.own_material(), whole) {
            (None, Some(_)) => Cow::Owned(Object { material: whole.clone(), ..self.clone() }),
            _ => Cow::Borrowed(self),
        }
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
