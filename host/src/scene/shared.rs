//! Shapes that several objects have: their triangles are made once.

use super::{Made, Object, Scene, SceneError};
use crate::memory;
use crate::numeric::print_of;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Bytes of a triangle of a scene that is made ready: corners, normals, numbers, and half a vertex.
const BYTES: u64 = 64;

/// The triangles of shapes, as long as an object needs them.
pub(super) struct Shared {
    /// For each object the first one with the same shape and tolerance.
    first: Vec<u32>,
    /// For each first one how many objects still need its triangles.
    needed: Vec<u32>,
    made: FxHashMap<u32, Rc<Made>>,
}

impl Shared {
    /// Finds out which objects of a scene have the same triangles, in their own coordinates.
    pub(super) fn of(scene: &Scene) -> Shared {
        let mut shared = Shared { first: Vec::new(), needed: vec![0; scene.objects.len()], made: FxHashMap::default() };
        let mut known: FxHashMap<u64, Vec<u32>> = FxHashMap::default();
        let tolerance = |object: &Object| object.own_tolerance(scene.settings.tolerance, scene.settings.angle);
        for (object, index) in scene.objects.iter().zip(0u32..) {
            let is_same = |other: &u32| {
                let other = &scene.objects[*other as usize];
                other.shape == object.shape && tolerance(other) == tolerance(object)
            };
            let alike = known.entry(print_of(&object.shape)).or_default();
            let first = alike.iter().copied().find(is_same).unwrap_or_else(|| {
                alike.push(index);
                index
            });
            shared.first.push(first);
            shared.needed[first as usize] += 1;
        }
        shared
    }

    /// The triangles of an object, which must be asked for once for each object.
    ///
    /// # Errors
    /// [`SceneError`] if they cannot be made, or if all objects that need them would take more memory than there is.
    pub(super) fn made(&mut self, scene: &Scene, index: usize) -> Result<Rc<Made>, SceneError> {
        let (first, object) = (self.first[index], &scene.objects[index]);
        let needed = &mut self.needed[first as usize];
        let made = match self.made.get(&first) {
            Some(made) => Rc::clone(made),
            None => {
                let made = object.made(scene.settings.tolerance, scene.settings.angle)?;
                let (count, triangles) = (u64::from(*needed), made.mesh.triangles.len() as u64);
                let objects = if count == 1 { String::new() } else { format!(" and {} more", count - 1) };
                memory::ask(count * triangles * BYTES, || format!("{}{objects} of {triangles} triangles", object.name))
                    .map_err(|excess| SceneError::Object {
                        object: object.name.clone(),
                        problem: excess.to_string(),
                    })?;
                Rc::new(made)
            }
        };
        *needed -= 1;
        match *needed {
            0 => self.made.remove(&first),
            _ => self.made.insert(first, Rc::clone(&made)),
        };
        Ok(made)
    }
}
