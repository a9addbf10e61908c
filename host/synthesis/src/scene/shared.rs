//! Shapes that several objects have: their triangles are made once.

use super::shape_mesh::ShapeMesh;
use super::{Scene, SceneError, Shape};
use crate::memory;
use crate::mesh::PlacedMeshes;
use crate::numeric::debug_hash;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Bytes of a triangle of a prepared scene: corners, normals, numbers, and half a vertex.
const BYTES: u64 = 64;

/// The triangles of shapes, as long as an object needs them.
pub(super) struct SharedMeshes {
    /// For each object the first one with the same shape and tolerance.
    first: Vec<u32>,
    /// For each first one how many objects still need its triangles.
    needed: Vec<u32>,
    meshes: FxHashMap<u32, Rc<ShapeMesh>>,
    /// Whether what files place many times is copied.
    copies: bool,
    /// For each first one what its file places many times.
    placed: FxHashMap<u32, Rc<PlacedMeshes>>,
}

/// The first object with its shape and tolerance.
struct First {
    index: u32,
    /// Of the shape; none for flat ones.
    extent: Option<f64>,
    /// Whether its file may place meshes.
    has_places: bool,
}

impl SharedMeshes {
    /// Finds out which objects of a scene have the same triangles, in their own coordinates.
    pub(super) fn of(scene: &Scene) -> SharedMeshes {
        let count = scene.objects.len();
        let (mut first, mut chords, mut needed) =
            (Vec::with_capacity(count), Vec::with_capacity(count), vec![0; count]);
        let mut known: FxHashMap<u64, Vec<First>> = FxHashMap::default();
        for (object, index) in scene.objects.iter().zip(0u32..) {
            let alike = known.entry(debug_hash(&object.shape)).or_default();
            let is_alike = |other: &&First| scene.objects[other.index as usize].shape == object.shape;
            let extent = alike.iter().find(is_alike).map_or_else(|| object.shape.extent(), |other| other.extent);
            // The tolerance in own coordinates, 0 for flat shapes.
            let chord = extent.map_or(0.0, |extent| object.chord_of(extent, scene.settings.geometry.tolerance));
            let has_places = object.file_of_places().is_some();
            let is_same = |other: &&First| {
                chords.get(other.index as usize) == Some(&chord) && other.has_places == has_places && is_alike(other)
            };
            let same = alike.iter().find(is_same);
            let found = same.map(|other| other.index);
            if found.is_none() {
                alike.push(First { index, extent, has_places });
            }
            let found = found.unwrap_or(index);
            needed[found as usize] += 1;
            first.push(found);
            chords.push(chord);
        }
        let copies = scene.settings.copies_instances();
        SharedMeshes { first, needed, meshes: FxHashMap::default(), copies, placed: FxHashMap::default() }
    }

    /// The meshes that the file of an object places many times; none before its triangles were asked for.
    pub(super) fn placed_by(&self, index: u32) -> Option<Rc<PlacedMeshes>> {
        self.placed.get(&self.first[index as usize]).cloned()
    }

    /// The triangles of an object, which must be asked for once for each object; without those that its file places many
    /// times.
    ///
    /// # Errors
    /// [`SceneError`] if they cannot be made, or if all objects that need them would take more memory than there is.
    pub(super) fn mesh_of(&mut self, scene: &Scene, index: u32) -> Result<Rc<ShapeMesh>, SceneError> {
        let (first, object) = (self.first[index as usize], &scene.objects[index as usize]);
        let needed = &mut self.needed[first as usize];
        let made = match self.meshes.get(&first) {
            Some(made) => Rc::clone(made),
            // They are placed when all other objects are there.
            None if matches!(object.shape, Shape::Instances(_)) => Rc::default(),
            None => {
                let file = if self.copies { None } else { object.placed_meshes()? };
                let made = match file {
                    Some(mut file) => {
                        let mesh = std::mem::take(&mut file.alone).mesh;
                        if file.places.count() > 0 {
                            self.placed.insert(first, Rc::new(file));
                        }
                        ShapeMesh { mesh, ..ShapeMesh::default() }
                    }
                    None => object.tessellate(scene.settings.geometry.tolerance, scene.settings.geometry.angle)?,
                };
                let (count, triangles) = (u64::from(*needed), made.mesh.triangles.len() as u64);
                let objects = if count == 1 { String::new() } else { format!(" and {} more", count - 1) };
                memory::reserve(count * triangles * BYTES, || {
                    format!("{}{objects} of {triangles} triangles", object.name)
                })
                .map_err(|excess| SceneError::Object { object: object.name.clone(), problem: excess.to_string() })?;
                Rc::new(made)
            }
        };
        *needed -= 1;
        match *needed {
            0 => self.meshes.remove(&first),
            _ => self.meshes.insert(first, Rc::clone(&made)),
        };
        Ok(made)
    }
}
