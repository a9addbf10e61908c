//! Octrees over a prepared scene: one over what stands still, one for each motion.

use super::{Contents, Motion};
use crate::octree::{Octree, OctreeError, Settings};
use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The octrees that rays go through. They know triangles of the scene, no renderer and no settings.
#[derive(Debug)]
pub struct Acceleration {
    /// Over what stands still; none if nothing does.
    pub still: Option<SceneOctree>,
    /// Over what moves while the shutter is open, where it is in the middle of that time; one for each motion.
    pub moving: Vec<(Motion, SceneOctree)>,
    /// How long it took to build them.
    pub build: Duration,
}

/// An octree over some triangles of a scene.
#[derive(Debug)]
pub struct SceneOctree {
    /// It numbers its triangles from 0.
    pub octree: Octree,
    /// The triangle of the scene behind each of its triangles; empty if it holds the whole scene.
    triangle_of: Vec<u32>,
}

/// Which objects of a scene octrees are built over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Whether each object of the scene counts.
    pub objects: Vec<bool>,
    /// Whether motions count; without them everything stands where it is in the middle of the time in which the shutter is
    /// open.
    pub motions: bool,
}

/// The octrees that were built last, for whoever asks for the same again.
#[derive(Debug, Default)]
pub(super) struct Built {
    last: Mutex<Option<(Kept, Arc<Acceleration>)>>,
    times: AtomicU32,
}

impl Contents {
    /// The octrees over the objects that are kept. Those that were built last are given again for the same objects: a
    /// change of any setting but those of geometry builds none.
    ///
    /// # Errors
    /// [`OctreeError`], for more triangles than an octree takes.
    pub fn acceleration(&self, kept: Kept) -> Result<Arc<Acceleration>, OctreeError> {
        let last = || self.built.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, acceleration)) = last().as_ref().filter(|(of, _)| *of == kept) {
            return Ok(acceleration.clone());
        }
        // Not within the lock: threads that build may ask for others.
        let start = Instant::now();
        let still = self.still(&kept)?;
        let moving = if kept.motions { self.moving(&kept)? } else { Vec::new() };
        let acceleration = Arc::new(Acceleration { still, moving, build: start.elapsed() });
        self.built.times.fetch_add(1, Ordering::Relaxed);
        *last() = Some((kept, acceleration.clone()));
        Ok(acceleration)
    }

    /// How often octrees were built.
    pub fn accelerations(&self) -> u32 {
        self.built.times.load(Ordering::Relaxed)
    }

    /// The octree over the objects that are kept and stand still; none if they have no triangles.
    fn still(&self, kept: &Kept) -> Result<Option<SceneOctree>, OctreeError> {
        let stands = |object: usize| kept.objects[object] && !(kept.motions && self.objects[object].motion.is_some());
        let (triangles, triangle_of) = match (0..self.objects.len()).all(stands) {
            true => (self.triangles.clone(), Vec::new()),
            false => {
                let stands = |triangle: &u32| stands(self.object_of[*triangle as usize] as usize);
                let kept: Vec<u32> = (0..self.triangles.len() as u32).filter(stands).collect();
                (Arc::new(kept.iter().map(|triangle| self.triangles[*triangle as usize]).collect()), kept)
            }
        };
        if triangles.is_empty() {
            return Ok(None);
        }
        let octree = Octree::sharing(self.vertices.clone(), triangles, &Settings::default())?;
        Ok(Some(SceneOctree { octree, triangle_of }))
    }

    /// Octrees over the objects that are kept and move, one for each motion.
    fn moving(&self, kept: &Kept) -> Result<Vec<(Motion, SceneOctree)>, OctreeError> {
        let mut groups: Vec<(Motion, Vec<u32>)> = Vec::new();
        for (object, is_kept) in self.objects.iter().zip(&kept.objects) {
            let Some(motion) = object.motion.filter(|_| *is_kept && object.count > 0) else { continue };
            let triangles = object.first..object.first + object.count;
            match groups.iter_mut().find(|(other, _)| *other == motion) {
                Some((_, of)) => of.extend(triangles),
                None => groups.push((motion, triangles.collect())),
            }
        }
        let made = |(motion, triangle_of): (Motion, Vec<u32>)| {
            // Only the vertices that it has: there may be many motions.
            let mut vertices = Vec::new();
            let mut numbers = HashMap::new();
            let mut number = |vertex: u32| {
                *numbers.entry(vertex).or_insert_with(|| {
                    vertices.push(self.vertices[vertex as usize]);
                    vertices.len() as u32 - 1
                })
            };
            let triangles: Vec<[u32; 3]> =
                triangle_of.iter().map(|&t| self.triangles[t as usize].map(&mut number)).collect();
            let octree = Octree::sharing(Arc::new(vertices), Arc::new(triangles), &Settings::default())?;
            Ok((motion, SceneOctree { octree, triangle_of }))
        };
        groups.into_iter().map(made).collect()
    }
}

impl SceneOctree {
    /// The triangle of the scene behind one of its triangles.
    #[inline]
    pub fn triangle(&self, own: u32) -> u32 {
        self.triangle_of.get(own as usize).copied().unwrap_or(own)
    }

    /// The triangles of the scene that it holds, in the order of its own.
    pub fn triangles(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.octree.triangle_count() as u32).map(|own| self.triangle(own))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Object, Prepared, Scene, Shape};
    use crate::solid::Primitive;
    use glam::{DMat4, DVec3};

    #[test]
    fn octrees_are_built_once_for_the_same_objects_whatever_the_settings_become() {
        let cube = |x: f64| Object {
            name: "cube".into(),
            shape: Shape::from(Primitive::Box { size: DVec3::ONE }),
            transform: DMat4::from_translation(DVec3::X * x),
            material: None,
            tolerance: None,
        };
        let one = Prepared::new(&Scene { objects: vec![cube(0.0), cube(3.0)], ..Scene::default() }).expect("a scene");
        let mut other = one.clone();
        other.settings.image.samples = 64;
        let kept = |objects: [bool; 2]| Kept { objects: objects.into(), motions: true };
        let both = one.acceleration(kept([true, true])).expect("few triangles");
        assert!(Arc::ptr_eq(&both, &other.acceleration(kept([true, true])).expect("few triangles")));
        let triangles = |acceleration: &Acceleration| -> Vec<u32> {
            acceleration.still.iter().flat_map(SceneOctree::triangles).collect()
        };
        assert_eq!((other.accelerations(), triangles(&both)), (1, (0..24).collect()));
        let second = one.acceleration(kept([false, true])).expect("few triangles");
        assert_eq!((other.accelerations(), triangles(&second)), (2, (12..24).collect()));
        let none = one.acceleration(kept([false, false])).expect("no triangles");
        assert!(none.still.is_none());
    }
}
