//! A scene as meshes that are stored once, and the places of those that are instances.

use super::object::{Instances, Object, Procedural, Shape};
use super::placing::Whole;
use super::triangles::append;
use super::{GeometrySettings, Scene, SceneError, ShapeMesh};
use crate::memory;
use crate::mesh::{Grouped, MeshPlace, PlacedMeshes, RepeatedMesh};
use glam::{DAffine3, DMat4};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Bytes of a place while places are put together.
const PLACE_BYTES: u64 = 2 * size_of::<MeshPlace>() as u64;

/// Where a group of objects stands.
#[derive(Clone, Copy)]
struct GroupPlace {
    /// To coordinates of the scene.
    placement: DAffine3,
    /// By which it differs from others of its kind.
    variation: u16,
}

/// Meshes in the making.
struct Placer<'s> {
    all: PlacedMeshes,
    geometry: &'s GeometrySettings,
}

impl Scene {
    /// The triangles of all objects, as [`Scene::tessellated`] gives them, but what instances place only once, with its
    /// places: in coordinates of its own, of instances of instances too. So are meshes that glTF files place more than once.
    ///
    /// # Errors
    /// [`SceneError`], for a value out of range, a mesh that cannot be made or read, or for too little memory.
    pub fn tessellated_once(&self) -> Result<PlacedMeshes, SceneError> {
        self.check()?;
        let geometry = &self.settings.geometry;
        let (placing, standing): (Vec<&Object>, Vec<&Object>) = self
            .objects
            .iter()
            .partition(|object| matches!(object.shape, Shape::Instances(_)) || object.file_of_places().is_some());
        let made = |object: &&Object| object.tessellate(geometry.tolerance, geometry.angle);
        let made = standing.par_iter().map(made).collect::<Result<Vec<_>, SceneError>>()?;
        let mut placer = Placer { all: PlacedMeshes::default(), geometry };
        for (object, made) in standing.into_iter().zip(made) {
            append(&mut placer.all.alone, object, made)?;
        }
        for object in placing {
            let whole = Whole { object: 0, material: None, stretch: 1.0 };
            placer.add(&object.name, object, &whole, None)?;
        }
        Ok(placer.all)
    }
}

impl Placer<'_> {
    /// Adds an object at places, or where it stands in the scene.
    ///
    /// - `name`: what it is called.
    /// - `outer`: the places of the group of objects that it is part of.
    fn add(
        &mut self,
        name: &str,
        object: &Object,
        whole: &Whole,
        outer: Option<&[GroupPlace]>,
    ) -> Result<(), SceneError> {
        let own = DAffine3::from_mat4(object.transform);
        let standing = [GroupPlace { placement: DAffine3::IDENTITY, variation: 0 }];
        let groups = outer.unwrap_or(&standing);
        if let Shape::Instances(instances) = &object.shape {
            return self.instances(name, instances, &whole.within(object), &own, groups);
        }
        if let Shape::Procedural(model) = &object.shape {
            return self.models(name, model, &whole.within(object), &own, groups);
        }
        let placements = || groups.iter().map(|group| group.placement);
        let object = Object { name: name.to_owned(), ..object.within(&whole.material).into_owned() };
        let Some(mut file) = object.placed_meshes()? else {
            let (object, made) = whole.made(&object, self.geometry)?;
            let mut grouped = Grouped::default();
            append(&mut grouped, &object, made)?;
            return self.repeat(&object, RepeatedMesh { name: name.to_owned(), grouped }, placements());
        };
        let plain = |mesh| ShapeMesh { mesh, ..ShapeMesh::default() };
        let alone = plain(std::mem::take(&mut file.alone.mesh));
        match outer {
            None => append(&mut self.all.alone, &object, alone)?,
            Some(_) => {
                let mut grouped = Grouped::default();
                append(&mut grouped, &object, alone)?;
                self.repeat(&object, RepeatedMesh { name: name.to_owned(), grouped }, placements())?;
            }
        }
        let mut places: Vec<Vec<DAffine3>> = vec![Vec::new(); file.repeated.len()];
        self.reserve(name, file.places.count(), groups.len())?;
        for MeshPlace { mesh, placement } in file.places.iter() {
            places[mesh as usize].push(own * placement);
        }
        for (RepeatedMesh { name: part, grouped }, places) in file.repeated.into_iter().zip(places) {
            let name = if part.is_empty() { name.to_owned() } else { format!("{name}/{part}") };
            let object = Object { name: name.clone(), transform: DMat4::IDENTITY, ..object.clone() };
            let mut own = Grouped::default();
            append(&mut own, &object, plain(grouped.mesh))?;
            let all = placements().flat_map(|outer| places.iter().map(move |place| outer * *place));
            self.repeat(&object, RepeatedMesh { name, grouped: own }, all)?;
        }
        Ok(())
    }

    /// Adds what instances place.
    fn instances(
        &mut self,
        name: &str,
        instances: &Instances,
        whole: &Whole,
        own: &DAffine3,
        groups: &[GroupPlace],
    ) -> Result<(), SceneError> {
        let places = whole.places(name, instances, self.geometry)?;
        let count = places.count();
        self.reserve(name, count, groups.len())?;
        let mut all: Vec<Vec<GroupPlace>> = vec![Vec::new(); instances.prototypes.len()];
        for outer in groups {
            let to_scene = outer.placement * *own;
            for instance in places.all() {
                let placement = to_scene * instance.placement;
                let variation = outer.variation.wrapping_add(instance.variation);
                all[usize::from(instance.prototype)].push(GroupPlace { placement, variation });
            }
        }
        drop(places);
        let placed = whole.placed_by(instances);
        for (group, places) in instances.prototypes.iter().zip(&all) {
            for object in group {
                self.add(&format!("{name}/{}", object.name), object, &placed, Some(places))?;
            }
        }
        Ok(())
    }

    /// Adds what a model makes: each of its kinds once, at the places that have it.
    fn models(
        &mut self,
        name: &str,
        model: &Procedural,
        whole: &Whole,
        own: &DAffine3,
        groups: &[GroupPlace],
    ) -> Result<(), SceneError> {
        let mut by_seed: BTreeMap<u32, Vec<GroupPlace>> = BTreeMap::new();
        for group in groups {
            let placement = group.placement * *own;
            by_seed.entry(model.seed(group.variation)).or_default().push(GroupPlace { placement, ..*group });
        }
        let detail = model.detail_within(whole.tolerance(self.geometry));
        for (seed, places) in by_seed {
            let failed = |problem: String| SceneError::Object { object: name.to_owned(), problem };
            for object in model.objects(seed, detail).map_err(failed)? {
                self.add(&format!("{name}/{seed}/{}", object.name), &object, whole, Some(&places))?;
            }
        }
        Ok(())
    }

    /// Adds a mesh at places.
    fn repeat(
        &mut self,
        object: &Object,
        mesh: RepeatedMesh,
        places: impl Iterator<Item = DAffine3>,
    ) -> Result<(), SceneError> {
        if mesh.grouped.mesh.triangles.is_empty() {
            return Ok(());
        }
        let number = self.all.repeated.len() as u32;
        self.all.repeated.push(mesh);
        for placement in places {
            if !placement.is_finite() {
                let problem = "one of its places is not finite".to_owned();
                return Err(SceneError::Object { object: object.name.clone(), problem });
            }
            self.all.places.push(MeshPlace { mesh: number, placement });
        }
        Ok(())
    }

    /// Asks for the memory of places.
    fn reserve(&self, object: &str, count: usize, times: usize) -> Result<(), SceneError> {
        let bytes = (count as u64).saturating_mul(times as u64 + 1).saturating_mul(PLACE_BYTES);
        memory::reserve(bytes, || format!("placing {count} meshes {times} times"))
            .map_err(|excess| SceneError::Object { object: object.to_owned(), problem: excess.to_string() })
    }
}
