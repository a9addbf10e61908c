//! Objects that are stored once and placed many times: how many, where, and their triangles.

use super::ShapeError;
use super::object::{Instances, Object, Placing, Shape};
use super::scatter::ScatteredPlaces;
use super::shape_mesh::{ShapeMesh, flat_normals};
use super::stretch::largest_stretch;
use crate::memory;
use crate::octree::{Instance, MOST_INSTANCES, MOST_LEVELS, MOST_PROTOTYPES, PlacementForm};
use crate::surface::Tolerance;
use glam::DMat4;

/// Bytes of a triangle of a mesh: corners, normals, numbers, and half a vertex.
const BYTES: u64 = 140;

/// The places of some instances, found by their numbers: none is stored but what the scene stores itself.
pub enum Places<'a> {
    /// Told one by one.
    Listed(&'a [Instance]),
    /// Drawn by chance; each is drawn anew when it is asked for.
    Scattered(ScatteredPlaces<'a>),
}

impl Places<'_> {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Places::Listed(all) => all.len(),
            Places::Scattered(places) => places.count(),
        }
    }

    /// An instance by its number.
    ///
    /// # Panics
    /// If there is none of this number.
    pub fn instance(&self, number: usize) -> Instance {
        match self {
            Places::Listed(all) => all[number],
            Places::Scattered(places) => places.instance(number),
        }
    }

    /// How renderers keep the placements.
    pub(super) fn form(&self) -> PlacementForm {
        match self {
            Places::Listed(_) => PlacementForm::Affine,
            Places::Scattered(_) => PlacementForm::Similar,
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
        Ok(match &self.placing {
            Placing::Listed(list) => Places::Listed(&list.0),
            Placing::Scattered(scatter) => Places::Scattered(ScatteredPlaces::new(scatter, scene_tolerance, angle)?),
        })
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
            _ => 0,
        };
        1 + self.prototypes.iter().flatten().map(of).max().unwrap_or(0)
    }

    /// The triangles of all instances, as one mesh; without exact surfaces.
    ///
    /// # Errors
    /// [`ShapeError`], also if they would take more memory than there is.
    pub(super) fn tessellate(&self, tolerance: Tolerance) -> Result<ShapeMesh, ShapeError> {
        let chord = (tolerance.chord < f64::MAX).then(|| tolerance.chord / self.largest_stretch());
        let (mut operands, mut surfaces) = (0, 0);
        let mut parts: Vec<ShapeMesh> = Vec::with_capacity(self.prototypes.len());
        for group in &self.prototypes {
            let mut part = ShapeMesh::default();
            for object in group {
                let ShapeMesh { mut mesh, mut operand_of, .. } =
                    object.in_place(object.shape.tessellate(object.own_tolerance(chord, tolerance.angle))?);
                let count = mesh.triangles.len();
                if mesh.corner_normals.is_empty() {
                    mesh.corner_normals = flat_normals(&mesh);
                }
                mesh.surfaces.resize(count, 0);
                operand_of.resize(count, 0);
                part.operand_of.extend(operand_of.iter().map(|operand| operand + operands));
                operands += object.operand_materials().len() as u32;
                part.mesh.append(&mesh, surfaces);
                surfaces += mesh.surfaces.iter().max().map_or(0, |last| last + 1);
            }
            parts.push(part);
        }
        let places = self.places(chord, tolerance.angle)?;
        let part = |number: usize| {
            let Instance { prototype, placement, .. } = places.instance(number);
            parts.get(usize::from(prototype)).map(|part| (part, placement))
        };
        let count = |number| part(number).map_or(0, |(part, _)| part.mesh.triangles.len() as u64);
        let triangles = (0..places.count()).map(count).sum::<u64>();
        memory::reserve(triangles * BYTES, || format!("{} instances of {triangles} triangles", places.count()))?;
        let mut whole = ShapeMesh::default();
        for (part, placement) in (0..places.count()).filter_map(part) {
            whole.mesh.append(&part.mesh.transformed(&placement), 0);
            whole.operand_of.extend(&part.operand_of);
        }
        Ok(whole)
    }

    /// Checks all numbers but the maps of placements, which are checked where they are used; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.prototypes.len() > MOST_PROTOTYPES {
            return Err(format!("more than {MOST_PROTOTYPES} prototypes"));
        }
        let count = match &self.placing {
            Placing::Listed(list) => {
                let count = self.prototypes.len();
                let unknown = list.0.iter().position(|instance| usize::from(instance.prototype) >= count);
                if let Some(number) = unknown {
                    let prototype = list.0[number].prototype;
                    return Err(format!("instance {number} places prototype {prototype}, but there are only {count}"));
                }
                list.0.len()
            }
            Placing::Scattered(scatter) => {
                scatter.check(self.prototypes.len())?;
                scatter.count
            }
        };
        if count > MOST_INSTANCES {
            return Err(format!("more than {MOST_INSTANCES} instances; place groups of them"));
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
                _ => {}
            }
        }
        Ok(())
    }
}
