//! Octrees over the objects of a prepared scene, built when they are first asked for.

use super::Motion;
use super::acceleration::{Acceleration, AccelerationKey, PlacedInstances, SceneOctree};
use super::error::AccelerationError;
use super::prepared::{Contents, PreparedObject};
use crate::octree::{Instance, InstanceError, InstanceOctree, Octree, OctreeError, OctreeSettings, PlacementForm};
use crate::stages::stage;
use std::collections::HashMap;
use std::sync::Arc;

impl Contents {
    /// The octrees over the objects that are included. Those that were built last are given again for the same objects:
    /// a change of any setting but those of geometry builds none.
    ///
    /// # Errors
    /// [`AccelerationError`], for more than an octree takes.
    pub fn acceleration(&self, kept: AccelerationKey) -> Result<Arc<Acceleration>, AccelerationError> {
        if let Some(acceleration) = self.octrees.get(&kept) {
            return Ok(acceleration);
        }
        let stage = stage!("building the octree");
        let still = self.still(&kept)?;
        let moving = if kept.motions { self.moving(&kept)? } else { Vec::new() };
        let placed = self.placed_still(&kept)?;
        let placed_moving = if kept.motions { self.placed_moving(&kept)? } else { Vec::new() };
        let acceleration = Arc::new(Acceleration { still, moving, placed, placed_moving, build: stage.elapsed() });
        self.octrees.store(kept, &acceleration);
        Ok(acceleration)
    }

    /// How often octrees were built.
    pub fn accelerations(&self) -> u32 {
        self.octrees.times()
    }

    /// The octree over the static objects that are included; none if they have no triangles.
    pub(super) fn still(&self, kept: &AccelerationKey) -> Result<Option<SceneOctree>, OctreeError> {
        let stands = |object: usize| {
            let PreparedObject { motion, placed_by, .. } = &self.objects[object];
            kept.objects[object] && placed_by.is_none() && !(kept.motions && motion.is_some())
        };
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
        let octree = Octree::sharing(self.vertices.clone(), triangles, &OctreeSettings::default())?;
        Ok(Some(SceneOctree { octree, triangle_of }))
    }

    /// Octrees over the moving objects that are included, one for each motion.
    fn moving(&self, kept: &AccelerationKey) -> Result<Vec<(Motion, SceneOctree)>, OctreeError> {
        let moving = self.objects.iter().zip(&kept.objects).filter(|(object, is_kept)| **is_kept && object.count > 0);
        let groups = by_motion(moving.filter_map(|(object, _)| Some((object.motion?, object))));
        let made = |(motion, objects): (Motion, Vec<&PreparedObject>)| {
            let triangles = objects.iter().flat_map(|object| object.first..object.first + object.count);
            let triangle_of: Vec<u32> = triangles.collect();
            let octree = self.octree_over(triangle_of.iter().copied())?;
            Ok((motion, SceneOctree { octree, triangle_of }))
        };
        groups.into_iter().map(made).collect()
    }

    /// An octree over some triangles, numbered in their order. It has the vertices of these only: there may be many.
    ///
    /// # Errors
    /// [`OctreeError`], for more triangles than an octree takes.
    pub(super) fn octree_over(&self, triangles: impl Iterator<Item = u32>) -> Result<Octree, OctreeError> {
        let mut vertices = Vec::new();
        let mut numbers = HashMap::new();
        let mut number = |vertex: u32| {
            *numbers.entry(vertex).or_insert_with(|| {
                vertices.push(self.vertices[vertex as usize]);
                vertices.len() as u32 - 1
            })
        };
        let triangles: Vec<[u32; 3]> = triangles.map(|t| self.triangles[t as usize].map(&mut number)).collect();
        Octree::sharing(Arc::new(vertices), Arc::new(triangles), &OctreeSettings::default())
    }

    /// The octree over the instances of objects that are included and stand still; none if there are none.
    fn placed_still(&self, kept: &AccelerationKey) -> Result<Option<InstanceOctree>, InstanceError> {
        let stands = |placed: &&PlacedInstances| {
            let object = placed.object as usize;
            kept.objects[object] && !(kept.motions && self.objects[object].motion.is_some())
        };
        let all: Vec<&PlacedInstances> = self.placed.iter().filter(stands).collect();
        if all.is_empty() { Ok(None) } else { placed_together(&all).map(Some) }
    }

    /// Octrees over the instances of objects that are included and move, one for each motion.
    fn placed_moving(&self, kept: &AccelerationKey) -> Result<Vec<(Motion, InstanceOctree)>, InstanceError> {
        let kept = self.placed.iter().filter(|placed| kept.objects[placed.object as usize]);
        let groups = by_motion(kept.filter_map(|placed| Some((self.objects[placed.object as usize].motion?, placed))));
        groups.into_iter().map(|(motion, all)| Ok((motion, placed_together(&all)?))).collect()
    }
}

/// What has the same motion, together, in the order of the first of each.
fn by_motion<T>(all: impl Iterator<Item = (Motion, T)>) -> Vec<(Motion, Vec<T>)> {
    let mut groups: Vec<(Motion, Vec<T>)> = Vec::new();
    for (motion, one) in all {
        match groups.iter_mut().find(|(other, _)| *other == motion) {
            Some((_, of)) => of.push(one),
            None => groups.push((motion, vec![one])),
        }
    }
    groups
}

/// One octree over the instances of several objects.
fn placed_together(all: &[&PlacedInstances]) -> Result<InstanceOctree, InstanceError> {
    let prototypes = all.iter().map(|placed| placed.prototype.clone()).collect();
    let instance = |number: usize| {
        let placement = all[number].transform;
        Instance { prototype: number as u16, variation: 0, placement }
    };
    InstanceOctree::new(prototypes, PlacementForm::Exact, all.len(), instance)
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
        let kept = |objects: [bool; 2]| AccelerationKey { objects: objects.into(), motions: true };
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
