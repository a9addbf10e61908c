//! Objects that are stored once and placed many times: how many, where, and their triangles.

use super::ShapeError;
use super::object::{Instances, Object, Placing, Shape};
use super::scatter::{FoundPlaces, PlacedGrid, ScatterCells, ScatterParts};
use super::shape_mesh::{ShapeMesh, flat_normals};
use super::stretch::largest_stretch;
use crate::memory;
use crate::octree::{
    Instance, InstanceError, InstanceOctree, MOST_INSTANCES, MOST_LEVELS, MOST_MADE_LEVELS, MOST_PROTOTYPES,
    PlacementForm, Prototype,
};
use crate::surface::Tolerance;
use glam::{DAffine3, DMat4, DVec3};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// So many instances of a surface or fewer are stored at once, more when rays come to them.
const MOST_AT_ONCE: usize = 1 << 16;
/// Of so many instances or fewer, triangles are counted one by one.
const COUNTED: usize = 1 << 22;
/// Bytes of a triangle of a mesh: corners, normals, numbers, and half a vertex.
const BYTES: u64 = 140;

/// The places of some instances, found by their numbers: none is stored but what the scene stores itself.
pub struct Places<'a>(KnownPlaces<'a>);

/// How places are known.
enum KnownPlaces<'a> {
    Listed(&'a [Instance]),
    Found(Box<FoundPlaces>),
    Parts(Box<ScatterParts>),
    Cells(Box<ScatterCells>),
}

/// Instances by chance that did not all find room.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShortScatter {
    /// The object that they are.
    pub object: String,
    /// How many found room.
    pub found: usize,
    /// How many were asked for.
    pub asked: usize,
}

impl fmt::Display for ShortScatter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ShortScatter { object, found, asked } = self;
        write!(f, "{object}: scatter found room for {found} of {asked} instances")
    }
}

impl Places<'_> {
    /// What is to be told of instances by chance that did not all find room.
    ///
    /// - `name`: of the object that they are.
    pub(super) fn short(&self, name: &str) -> Option<ShortScatter> {
        let KnownPlaces::Found(places) = &self.0 else { return None };
        let (found, asked) = (places.count(), places.asked);
        (found < asked).then(|| ShortScatter { object: name.to_owned(), found, asked })
    }

    /// How many there are, some of which may be missing.
    pub fn count(&self) -> usize {
        match &self.0 {
            KnownPlaces::Listed(all) => all.len(),
            KnownPlaces::Found(places) => places.count(),
            KnownPlaces::Parts(parts) => parts.count_of_all(),
            KnownPlaces::Cells(cells) => cells.count_of_all(),
        }
    }

    /// Whether the instance of a number is not missing.
    pub fn has(&self, number: usize) -> bool {
        match &self.0 {
            KnownPlaces::Cells(cells) => cells.has(number),
            _ => number < self.count(),
        }
    }

    /// An instance by its number, as it would be if it is missing.
    ///
    /// # Panics
    /// If the number is not below [`Places::count`].
    pub fn instance(&self, number: usize) -> Instance {
        match &self.0 {
            KnownPlaces::Listed(all) => all[number],
            KnownPlaces::Found(places) => places.instance(number),
            KnownPlaces::Parts(parts) => parts.instance_of_all(number),
            KnownPlaces::Cells(cells) => cells.instance_of_all(number),
        }
    }

    /// All instances, one after another.
    pub fn all(&self) -> impl Iterator<Item = Instance> + '_ {
        (0..self.count()).filter(|number| self.has(*number)).map(|number| self.instance(number))
    }

    /// The numbers of about so many instances about a point, all of those that are listed or were found one by one.
    pub fn near(&self, at: DVec3, most: usize) -> Vec<Range<usize>> {
        match &self.0 {
            KnownPlaces::Parts(parts) => parts.near(at, most),
            KnownPlaces::Cells(cells) => cells.near(at, most),
            KnownPlaces::Listed(_) | KnownPlaces::Found(_) => std::iter::once(0..self.count()).collect(),
        }
    }

    /// Where their cells are, if they are in cells.
    pub(super) fn grid(&self, prototypes: &[Prototype]) -> Option<PlacedGrid> {
        let KnownPlaces::Cells(cells) = &self.0 else { return None };
        Some(cells.placed(prototypes))
    }

    /// The octree over these instances.
    ///
    /// # Errors
    /// [`InstanceError`], for those that cannot be placed.
    ///
    /// - `aggregates`: the number of the octree among those that have aggregates, if it is one of them.
    pub(super) fn octree(
        self,
        prototypes: Vec<Prototype>,
        aggregates: Option<u32>,
    ) -> Result<InstanceOctree, InstanceError> {
        let count = self.count();
        match self.0 {
            KnownPlaces::Listed(all) => InstanceOctree::new(prototypes, PlacementForm::Affine, count, |n| all[n]),
            KnownPlaces::Found(places) => {
                InstanceOctree::new(prototypes, PlacementForm::Similar, count, |n| places.instance(n))
            }
            KnownPlaces::Parts(parts) if count <= MOST_AT_ONCE => {
                InstanceOctree::new(prototypes, PlacementForm::Similar, count, |n| parts.instance_of_all(n))
            }
            KnownPlaces::Parts(parts) => {
                let parts = parts.placing(&prototypes);
                InstanceOctree::on_demand(prototypes, PlacementForm::Similar, Arc::new(parts))
            }
            KnownPlaces::Cells(cells) => {
                let placement = cells.to_instances();
                let grid = cells.grid(&prototypes);
                let octree = InstanceOctree::in_cells(prototypes, grid, Arc::new(*cells))?;
                let octree = aggregates.into_iter().fold(octree, InstanceOctree::aggregated);
                if placement == DAffine3::IDENTITY {
                    return Ok(octree);
                }
                let ground = Instance { prototype: 0, variation: 0, placement };
                InstanceOctree::new(vec![Prototype::instances(Arc::new(octree))], PlacementForm::Exact, 1, |_| ground)
            }
        }
    }
}

impl Instances {
    /// Where they are.
    ///
    /// - `scene_tolerance`, `angle`: those of [`GeometrySettings`](super::GeometrySettings), for a surface that has
    ///   them; the first divided by how much longer the instances may become where they are placed.
    ///
    /// # Errors
    /// [`ShapeError`], if a surface that has them cannot be tessellated, or for too little memory.
    pub fn places(&self, scene_tolerance: Option<f64>, angle: f64) -> Result<Places<'_>, ShapeError> {
        Ok(Places(match &self.placing {
            Placing::Listed(list) => KnownPlaces::Listed(&list.0),
            Placing::Scattered(scatter) => match scatter.cell {
                Some(side) => KnownPlaces::Cells(Box::new(ScatterCells::new(scatter, side, angle)?)),
                None if scatter.takes_all() => {
                    KnownPlaces::Parts(Box::new(ScatterParts::new(scatter, scene_tolerance, angle)?))
                }
                None => KnownPlaces::Found(Box::new(FoundPlaces::new(scatter, scene_tolerance, angle)?)),
            },
        }))
    }

    /// An upper bound of how much any placement lengthens; 1 without any.
    pub fn largest_stretch(&self) -> f64 {
        match &self.placing {
            Placing::Listed(list) => {
                let of = |instance: &Instance| largest_stretch(&DMat4::from(instance.placement));
                list.0.iter().map(of).reduce(f64::max).unwrap_or(1.0)
            }
            Placing::Scattered(scatter) => scatter.scale[1],
        }
    }

    /// How many times over instances are placed by instances.
    pub fn levels(&self) -> usize {
        let of = |object: &Object| match &object.shape {
            Shape::Instances(inner) => inner.levels(),
            Shape::Procedural(_) => MOST_MADE_LEVELS,
            _ => 0,
        };
        1 + self.prototypes.iter().flatten().map(of).max().unwrap_or(0)
    }

    /// The triangles of all instances, as one mesh; without exact surfaces.
    ///
    /// - `variation`: of the instance of which these are part; 0 without one.
    ///
    /// # Errors
    /// [`ShapeError`], also if they would take more memory than there is.
    pub(super) fn tessellate(&self, tolerance: Tolerance, variation: u16) -> Result<ShapeMesh, ShapeError> {
        let chord = (tolerance.chord < f64::MAX).then(|| tolerance.chord / self.largest_stretch());
        let (mut operands, mut surfaces) = (0, 0);
        let mut parts: Vec<GroupMesh> = Vec::with_capacity(self.prototypes.len());
        for group in &self.prototypes {
            let made = together(group, chord, tolerance.angle, 0)?;
            let varies = group.iter().any(Object::has_models);
            let part = GroupMesh { made, operands, surfaces, varies };
            operands += group.iter().map(|object| object.operand_materials().len() as u32).sum::<u32>();
            surfaces += part.made.mesh.surfaces.iter().max().map_or(0, |last| last + 1);
            parts.push(part);
        }
        let places = self.places(chord, tolerance.angle)?;
        let count = places.count();
        let triangles = |part: &GroupMesh| part.made.mesh.triangles.len() as u64;
        // Not counted one by one where there are too many for that.
        let total = match count <= COUNTED {
            true => places.all().map(|instance| triangles(&parts[usize::from(instance.prototype)])).sum(),
            false => (count as u64).saturating_mul(parts.iter().map(triangles).max().unwrap_or(0)),
        };
        let bytes = u64::saturating_mul(total, BYTES);
        memory::reserve(bytes, || format!("{count} instances of {total} triangles"))?;
        let mut whole = ShapeMesh::default();
        for Instance { prototype, variation: own, placement } in places.all() {
            let GroupMesh { made, operands, surfaces, varies } = &parts[usize::from(prototype)];
            let another;
            let made = if *varies {
                let group = &self.prototypes[usize::from(prototype)];
                another = together(group, chord, tolerance.angle, variation.wrapping_add(own))?;
                &another
            } else {
                made
            };
            whole.mesh.append(&made.mesh.transformed(&placement), *surfaces);
            whole.operand_of.extend(made.operand_of.iter().map(|operand| operand + operands));
        }
        Ok(whole)
    }

    /// Checks all numbers but the maps of placements, which are checked where they are used; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.prototypes.len() > MOST_PROTOTYPES {
            return Err(format!("more than {MOST_PROTOTYPES} prototypes"));
        }
        match &self.placing {
            Placing::Listed(list) => {
                let count = self.prototypes.len();
                let unknown = list.0.iter().position(|instance| usize::from(instance.prototype) >= count);
                if let Some(number) = unknown {
                    let prototype = list.0[number].prototype;
                    return Err(format!("instance {number} places prototype {prototype}, but there are only {count}"));
                }
                if list.0.len() > MOST_INSTANCES {
                    return Err(format!("more than {MOST_INSTANCES} instances; place groups of them"));
                }
            }
            Placing::Scattered(scatter) => scatter.check(self.prototypes.len())?,
        }
        // One level is that of the scene.
        let most = MOST_LEVELS - 1;
        if self.levels() > most {
            return Err(format!("instances are nested more than {most} times"));
        }
        for object in self.prototypes.iter().flatten() {
            object.check(false).map_err(|error| error.to_string())?;
            match &object.shape {
                Shape::Curve(_) => return Err(format!("{} is a curve; only surfaces can be instances", object.name)),
                Shape::HalfSpace { .. } => return Err(format!("{} has no end", object.name)),
                Shape::Instances(inner) if inner.aggregate(None).is_some() => {
                    let what =
                        "has aggregates, which stand in for what the scene itself has, not for what is placed again";
                    return Err(format!("{} {what}", object.name));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// The triangles of a group of objects that is placed.
struct GroupMesh {
    /// Those of an instance whose variation is 0.
    made: ShapeMesh,
    /// How many operands the groups before have.
    operands: u32,
    /// How many surfaces they have.
    surfaces: u32,
    /// Whether those of other instances differ.
    varies: bool,
}

/// Triangles of objects that stand together, as one mesh without exact surfaces; their operands are counted through.
///
/// - `variation`: of the instance that they are.
pub(super) fn together(
    objects: &[Object],
    chord: Option<f64>,
    angle: f64,
    variation: u16,
) -> Result<ShapeMesh, ShapeError> {
    let (mut operands, mut surfaces) = (0, 0);
    let mut all = ShapeMesh::default();
    for object in objects {
        let tolerance = object.own_tolerance(chord, angle);
        let made = match &object.shape {
            Shape::Instances(instances) => instances.tessellate(tolerance, variation)?,
            Shape::Procedural(model) => {
                let chord = (tolerance.chord < f64::MAX).then_some(tolerance.chord);
                model.tessellate(model.seed(variation), model.detail_within(chord))?
            }
            shape => shape.tessellate(tolerance)?,
        };
        let ShapeMesh { mut mesh, mut operand_of, .. } = object.in_place(made);
        let count = mesh.triangles.len();
        if mesh.corner_normals.is_empty() {
            mesh.corner_normals = flat_normals(&mesh);
        }
        mesh.surfaces.resize(count, 0);
        operand_of.resize(count, 0);
        all.operand_of.extend(operand_of.iter().map(|operand| operand + operands));
        operands += object.operand_materials().len() as u32;
        all.mesh.append(&mesh, surfaces);
        surfaces += mesh.surfaces.iter().max().map_or(0, |last| last + 1);
    }
    Ok(all)
}
