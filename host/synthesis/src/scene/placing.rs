//! Instances of a prepared scene: what they place, each stored once, and where.

use super::acceleration::PlacedInstances;
use super::instances::{Places, ShortScatter};
use super::object::{Instances, Object, Procedural, Shape};
use super::placed_models::{PlacedAggregates, PlacedModel};
use super::prepared::{Contents, PreparedObject};
use super::procedural::geometry_of;
use super::shape_mesh::ShapeMesh;
use super::stretch::largest_stretch;
use super::{DetailView, GeometrySettings, Motion, SceneError, Settings};
use crate::illumination::Material;
use crate::memory;
use crate::mesh::{MeshPlace, PlacedMeshes, RepeatedMesh};
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::mix;
use crate::numeric::triangle::MAX_MAGNITUDE;
use crate::octree::{Instance, InstanceOctree, PlacementForm, Prototype};
use crate::stages::stage;
use glam::{DAffine3, DMat4};
use std::sync::Arc;

/// Bytes of a triangle of a copy: corners, normals, numbers, and half a vertex.
const TRIANGLE_BYTES: u64 = 64;
/// Bytes of a copy beside its triangles: names, materials, maps.
const COPY_BYTES: u64 = 1024;

/// What a group of objects becomes part of.
pub(super) struct Whole {
    /// Number of the object whose instances are prepared.
    pub(super) object: u32,
    /// That of objects that have none.
    pub(super) material: Option<Material>,
    /// How much longer what is placed may become at the most.
    pub(super) stretch: f64,
}

/// Objects of a group as they are copied.
enum Copied {
    Object(Box<Object>, ShapeMesh),
    Instances(DAffine3, CopiedInstances),
    /// A procedural model, made for each copy; the object has its place and the material of what has none.
    Model(Box<Object>, Procedural),
}

/// Instances as they are copied.
struct CopiedInstances {
    /// If they are by chance and did not all find room.
    short: Option<ShortScatter>,
    prototypes: Vec<Vec<Copied>>,
    placements: Vec<Instance>,
}

impl Contents {
    /// Places the instances of an object of the scene, or copies what they place.
    ///
    /// - `index`: of the object, which was added without triangles.
    ///
    /// # Errors
    /// [`SceneError`], for what cannot be tessellated or placed.
    pub(super) fn add_instances(
        &mut self,
        index: u32,
        object: &Object,
        instances: &Instances,
        settings: &Settings,
    ) -> Result<(), SceneError> {
        let _stage = stage!("placing instances");
        let geometry = &settings.geometry;
        let whole = Whole { object: index, material: None, stretch: 1.0 }.within(object);
        let transform = DAffine3::from_mat4(object.transform);
        if settings.copies_instances() {
            let copied = CopiedInstances::new(&object.name, instances, &whole, geometry)?;
            self.short_scatters.extend(copied.short_scatters());
            let motion = self.objects[index as usize].motion;
            let is_framed = self.camera.from.is_finite();
            let view = is_framed.then(|| DetailView::new(&self.view(), settings));
            self.objects[index as usize].copies =
                copied.add_to(self, &object.name, transform, motion, geometry, view.as_ref())?;
            return Ok(());
        }
        let pixels = instances.aggregate(geometry.aggregate);
        let octree = self.instance_octree(&object.name, instances, &whole, geometry, pixels)?;
        let mut exact = octree.bounds();
        if let Some(own) = self.aggregates.last_mut().filter(|aggregates| aggregates.object == index) {
            if octree.count() > 0 {
                exact = own.grid.exact;
            }
            own.grid.placement = transform * own.grid.placement;
        }
        self.stand(index, octree, &exact, transform, geometry)
    }

    /// Places what the file of an object of the scene places many times.
    ///
    /// - `index`: of the object, which was added with its other triangles.
    ///
    /// # Errors
    /// [`SceneError`], for what cannot be placed.
    pub(super) fn add_placed_meshes(
        &mut self,
        index: u32,
        object: &Object,
        meshes: &PlacedMeshes,
        geometry: &GeometrySettings,
    ) -> Result<(), SceneError> {
        let _stage = stage!("placing instances");
        let octree = self.mesh_octree(index, object, meshes, geometry)?;
        let exact = octree.bounds();
        self.stand(index, octree, &exact, DAffine3::from_mat4(object.transform), geometry)
    }

    /// Lets instances of an object stand in the scene.
    ///
    /// - `exact`: around all of them as they are, in coordinates of the object.
    fn stand(
        &mut self,
        index: u32,
        octree: Arc<InstanceOctree>,
        exact: &Bounds,
        transform: DAffine3,
        geometry: &GeometrySettings,
    ) -> Result<(), SceneError> {
        let group = &mut self.objects[index as usize];
        let placed = |bounds: &Bounds| match bounds.is_empty() {
            true => Bounds::EMPTY,
            false => Bounds::of(bounds.corners().map(|corner| transform.transform_point3(corner))),
        };
        let still = placed(&octree.bounds());
        let is_near = still.is_empty() || still.min.abs().max(still.max.abs()).max_element() <= MAX_MAGNITUDE;
        if !is_near {
            let problem = format!("an instance is placed farther than {MAX_MAGNITUDE:e} from the origin");
            return Err(failed(&group.name, problem));
        }
        let half = 0.5 * geometry.shutter;
        let swept = |still: Bounds| group.motion.map_or(still, |motion| motion.swept(&still, [-half, half]));
        let [bounds, framed] = [still, placed(exact)].map(swept);
        let has_triangles = group.count > 0;
        let with = |own: Bounds, more: Bounds| if has_triangles { own.union(more) } else { more };
        (group.bounds, group.framed) = (with(group.bounds, bounds), with(group.framed, framed));
        group.instances = octree.count();
        self.bounds = self.bounds.union(group.bounds);
        self.placed_triangles = self.placed_triangles.saturating_add(octree.costs().triangles);
        let prototype = Prototype::instances(octree);
        self.placed.push(PlacedInstances { object: index, prototype, transform });
        Ok(())
    }

    /// The octree over the meshes that a file places many times, in coordinates of the file; each becomes an object.
    ///
    /// - `placing`: the object of the scene that places them.
    fn mesh_octree(
        &mut self,
        placing: u32,
        object: &Object,
        meshes: &PlacedMeshes,
        geometry: &GeometrySettings,
    ) -> Result<Arc<InstanceOctree>, SceneError> {
        let PlacedMeshes { repeated, places, .. } = meshes;
        let mut prototypes = Vec::with_capacity(repeated.len());
        for (RepeatedMesh { name, grouped }, number) in repeated.iter().zip(0..) {
            let name = if name.is_empty() { format!("mesh {number}") } else { name.clone() };
            let part = Object { name: format!("{}/{name}", object.name), transform: DMat4::IDENTITY, ..object.clone() };
            let made = ShapeMesh { mesh: grouped.mesh.clone(), ..ShapeMesh::default() };
            let added = self.add(&part, &made, None, geometry)?;
            added.placed_by = Some(placing);
            let (first, count) = (added.first, added.count);
            let octree = self.octree_over(first..first + count).map_err(|error| failed(&object.name, error))?;
            prototypes.push(Prototype::surface(Arc::new(octree), first));
        }
        let instance = |number: usize| {
            let MeshPlace { mesh, placement } = places.place(number);
            Instance { prototype: mesh as u16, variation: mix(number as u64) as u16, placement }
        };
        let octree = InstanceOctree::new(prototypes, PlacementForm::Affine, places.count(), instance);
        Ok(self.counted(octree.map_err(|error| failed(&object.name, error))?))
    }

    /// An octree over instances, kept for what it costs.
    fn counted(&mut self, octree: InstanceOctree) -> Arc<InstanceOctree> {
        let octree = Arc::new(octree);
        self.instanced.push(octree.clone());
        octree
    }

    /// The octree over instances, in coordinates of the object that has them; what they place is added.
    ///
    /// - `pixels`: how many the largest of them spans where aggregates begin to stand in, if they do.
    fn instance_octree(
        &mut self,
        name: &str,
        instances: &Instances,
        whole: &Whole,
        geometry: &GeometrySettings,
        pixels: Option<f64>,
    ) -> Result<Arc<InstanceOctree>, SceneError> {
        let places = whole.places(name, instances, geometry)?;
        self.short_scatters.extend(places.short(name));
        let placed = whole.placed_by(instances);
        let prototypes = instances.prototypes.iter().map(|group| self.prototype(name, group, &placed, geometry));
        let prototypes = prototypes.collect::<Result<Vec<Prototype>, SceneError>>()?;
        let grid = pixels.and_then(|pixels| Some((pixels, places.grid(&prototypes)?)));
        let number = grid.is_some().then_some(self.aggregates.len() as u32);
        let octree = places.octree(prototypes, number).map_err(|error| failed(name, error))?;
        let placed = |(pixels, grid)| PlacedAggregates { object: whole.object, grid, pixels };
        self.aggregates.extend(grid.map(placed));
        Ok(self.counted(octree))
    }

    /// A group of objects as one prototype.
    fn prototype(
        &mut self,
        name: &str,
        group: &[Object],
        whole: &Whole,
        geometry: &GeometrySettings,
    ) -> Result<Prototype, SceneError> {
        let first = self.triangles.len() as u32;
        let mut files = Vec::new();
        let stands = |object: &&Object| !matches!(object.shape, Shape::Instances(_) | Shape::Procedural(_));
        for object in group.iter().filter(stands) {
            let (object, made) = match object.within(&whole.material).placed_meshes()? {
                Some(mut file) => {
                    let object = object.within(&whole.material).into_owned();
                    let mesh = std::mem::take(&mut file.alone).mesh;
                    files.push((object.clone(), file));
                    (object, ShapeMesh { mesh, ..ShapeMesh::default() })
                }
                None => whole.made(object, geometry)?,
            };
            let added = self.add(&object, &made, None, geometry)?;
            check_emission(added)?;
            added.placed_by = Some(whole.object);
        }
        let triangles = first..self.triangles.len() as u32;
        let mut parts = Vec::new();
        if !triangles.is_empty() {
            let octree = self.octree_over(triangles).map_err(|error| failed(name, error))?;
            parts.push((Prototype::surface(Arc::new(octree), first), DAffine3::IDENTITY));
        }
        for (object, file) in files.iter().filter(|(_, file)| file.places.count() > 0) {
            let octree = self.mesh_octree(whole.object, object, file, geometry)?;
            parts.push((Prototype::instances(octree), DAffine3::from_mat4(object.transform)));
        }
        for object in group {
            let part = match &object.shape {
                Shape::Instances(inner) => {
                    let octree = self.instance_octree(&object.name, inner, &whole.within(object), geometry, None)?;
                    Prototype::instances(octree)
                }
                Shape::Procedural(model) => self.model(object, model, whole, geometry)?,
                _ => continue,
            };
            parts.push((part, DAffine3::from_mat4(object.transform)));
        }
        if let [(alone, placement)] = &parts[..]
            && *placement == DAffine3::IDENTITY
        {
            return Ok(alone.clone());
        }
        let placements: Vec<DAffine3> = parts.iter().map(|(_, placement)| *placement).collect();
        let prototypes: Vec<Prototype> = parts.into_iter().map(|(prototype, _)| prototype).collect();
        let instance =
            |number: usize| Instance { prototype: number as u16, variation: 0, placement: placements[number] };
        let together = InstanceOctree::new(prototypes, PlacementForm::Exact, placements.len(), instance);
        Ok(Prototype::instances(Arc::new(together.map_err(|error| failed(name, error))?)))
    }
}

impl Contents {
    /// A procedural model as a prototype; an object stands for all that it makes.
    fn model(
        &mut self,
        object: &Object,
        model: &Procedural,
        whole: &Whole,
        geometry: &GeometrySettings,
    ) -> Result<Prototype, SceneError> {
        let object = object.within(&whole.material);
        let made = model.pattern_mesh().map_err(|source| object.failed(source))?;
        let added = self.add(&object, &made, None, geometry)?;
        check_emission(added)?;
        added.placed_by = Some(whole.object);
        let materials = added.materials.clone();
        let number = self.models.len() as u32;
        let last = self.objects.len() as u32 - 1;
        let whole = object.material.clone();
        self.models.push(Arc::new(PlacedModel { model: model.clone(), whole, object: last, materials }));
        Ok(Prototype::made(number, model.bounds()))
    }
}

impl Whole {
    /// An object that instances place, for those that it has itself.
    pub(super) fn within(&self, object: &Object) -> Whole {
        let material = object.material.clone().or_else(|| self.material.clone());
        Whole { material, stretch: self.stretch * largest_stretch(&object.transform), ..*self }
    }

    /// This, for what its instances place.
    pub(super) fn placed_by(&self, instances: &Instances) -> Whole {
        let stretch = self.stretch * instances.largest_stretch();
        Whole { material: self.material.clone(), stretch, ..*self }
    }

    /// The tolerance of the scene, in coordinates of what is placed.
    pub(super) fn tolerance(&self, geometry: &GeometrySettings) -> Option<f64> {
        geometry.tolerance.map(|tolerance| tolerance / self.stretch)
    }

    /// Where the instances of an object of a group are.
    pub(super) fn places<'a>(
        &self,
        name: &str,
        instances: &'a Instances,
        geometry: &GeometrySettings,
    ) -> Result<Places<'a>, SceneError> {
        instances.places(self.tolerance(geometry), geometry.angle).map_err(|error| failed(name, error))
    }

    /// An object of a group, and its triangles in its own coordinates.
    pub(super) fn made(&self, object: &Object, geometry: &GeometrySettings) -> Result<(Object, ShapeMesh), SceneError> {
        let mut object = object.within(&self.material).into_owned();
        object.tolerance = object.tolerance.map(|tolerance| tolerance / self.stretch);
        let made = object.tessellate(self.tolerance(geometry), geometry.angle)?;
        Ok((object, made))
    }
}

impl CopiedInstances {
    fn new(
        name: &str,
        instances: &Instances,
        whole: &Whole,
        geometry: &GeometrySettings,
    ) -> Result<CopiedInstances, SceneError> {
        let placed = whole.placed_by(instances);
        let copied = |object: &Object| match &object.shape {
            Shape::Instances(inner) => {
                let inner = CopiedInstances::new(&object.name, inner, &placed.within(object), geometry)?;
                Ok(Copied::Instances(DAffine3::from_mat4(object.transform), inner))
            }
            Shape::Procedural(model) => {
                Ok(Copied::Model(Box::new(object.within(&placed.material).into_owned()), model.clone()))
            }
            _ => {
                let (object, made) = placed.made(object, geometry)?;
                Ok(Copied::Object(Box::new(object), made))
            }
        };
        let prototypes = instances.prototypes.iter().map(|group| group.iter().map(copied).collect());
        let prototypes = prototypes.collect::<Result<Vec<Vec<Copied>>, SceneError>>()?;
        let places = whole.places(name, instances, geometry)?;
        let count = places.count();
        memory::reserve((count as u64).saturating_mul(size_of::<Instance>() as u64), || {
            format!("copying {count} instances")
        })
        .map_err(|error| failed(name, error))?;
        Ok(CopiedInstances { short: places.short(name), prototypes, placements: places.all().collect() })
    }

    /// Those that did not all find room, here and in what is copied.
    fn short_scatters(&self) -> Vec<ShortScatter> {
        let of = |copied: &Copied| match copied {
            Copied::Object(..) | Copied::Model(..) => Vec::new(),
            Copied::Instances(_, inner) => inner.short_scatters(),
        };
        self.short.iter().cloned().chain(self.prototypes.iter().flatten().flat_map(of)).collect()
    }

    /// Objects and triangles of all copies.
    fn counts(&self) -> [u64; 2] {
        let of = |copied: &Copied| match copied {
            Copied::Object(_, made) => [1, made.mesh.triangles.len() as u64],
            Copied::Instances(_, inner) => inner.counts(),
            // It is counted when it is made.
            Copied::Model(..) => [0, 0],
        };
        let sum = |[a, b]: [u64; 2], [c, d]: [u64; 2]| [a.saturating_add(c), b.saturating_add(d)];
        let groups: Vec<[u64; 2]> =
            self.prototypes.iter().map(|group| group.iter().map(of).fold([0; 2], sum)).collect();
        let group = |instance: &Instance| groups[usize::from(instance.prototype)];
        self.placements.iter().map(group).fold([0; 2], sum)
    }

    /// Adds the copies as objects of the scene, and tells how many they are.
    fn add_to(
        mut self,
        contents: &mut Contents,
        name: &str,
        transform: DAffine3,
        motion: Option<Motion>,
        geometry: &GeometrySettings,
        view: Option<&DetailView>,
    ) -> Result<u64, SceneError> {
        let [objects, triangles] = self.counts();
        let bytes = objects.saturating_mul(COPY_BYTES).saturating_add(triangles.saturating_mul(TRIANGLE_BYTES));
        memory::reserve(bytes, || format!("copying instances as {objects} objects of {triangles} triangles"))
            .map_err(|error| failed(name, error))?;
        let mut copies = 0;
        let mut add = |object: &Object, made: &ShapeMesh, variation: u16| {
            copies += 1;
            let added = contents.add_standing(object, made, motion, geometry)?;
            added.variation = variation;
            check_emission(added)
        };
        self.each(transform, 0, view, &mut add)?;
        Ok(copies)
    }

    /// Gives all copies, placed.
    ///
    /// - `view`: for which models are made, if there is one.
    fn each(
        &mut self,
        to_scene: DAffine3,
        variation: u16,
        view: Option<&DetailView>,
        give: &mut impl FnMut(&Object, &ShapeMesh, u16) -> Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        let CopiedInstances { prototypes, placements, .. } = self;
        for instance in placements.iter() {
            let (placement, variation) = (to_scene * instance.placement, variation.wrapping_add(instance.variation));
            for copied in &mut prototypes[usize::from(instance.prototype)] {
                match copied {
                    Copied::Object(object, made) => {
                        let own = object.transform;
                        object.transform = DMat4::from(placement) * own;
                        let given = give(object, made, variation);
                        object.transform = own;
                        given?;
                    }
                    Copied::Instances(transform, inner) => {
                        inner.each(placement * *transform, variation, view, give)?;
                    }
                    Copied::Model(object, model) => each_of_model(object, model, placement, variation, view, give)?,
                }
            }
        }
        Ok(())
    }
}

/// Gives what a model makes for an instance, placed.
fn each_of_model(
    object: &Object,
    model: &Procedural,
    placement: DAffine3,
    variation: u16,
    view: Option<&DetailView>,
    give: &mut impl FnMut(&Object, &ShapeMesh, u16) -> Result<(), SceneError>,
) -> Result<(), SceneError> {
    let placement = placement * DAffine3::from_mat4(object.transform);
    let footprint = view.map_or(model.detail_within(None), |view| view.footprint(&placement, &model.bounds()));
    let detail = model.detail_of(model.level(footprint));
    let geometry = geometry_of(detail);
    let seed = model.seed(variation);
    let whole = Whole { object: 0, material: object.material.clone(), stretch: 1.0 };
    for part in model.objects(seed, detail).map_err(|problem| failed(&object.name, problem))? {
        let to_scene = placement * DAffine3::from_mat4(part.transform);
        if let Shape::Instances(inner) = &part.shape {
            let mut copied = CopiedInstances::new(&part.name, inner, &whole.within(&part), &geometry)?;
            copied.each(to_scene, variation, view, give)?;
            continue;
        }
        let (part, made) = whole.made(&part, &geometry)?;
        let bytes = COPY_BYTES + made.mesh.triangles.len() as u64 * TRIANGLE_BYTES;
        memory::reserve(bytes, || format!("a copy of {}", object.name)).map_err(|error| failed(&object.name, error))?;
        give(&Object { transform: DMat4::from(to_scene), ..part }, &made, variation)?;
    }
    Ok(())
}

/// Refuses light sources: a scene has each of them once.
fn check_emission(object: &PreparedObject) -> Result<(), SceneError> {
    let emits = object.materials.iter().any(|material| !material.emission.is_black());
    let problem = "it emits light, and what emits light cannot be an instance; copy it instead";
    if emits { Err(failed(&object.name, problem)) } else { Ok(()) }
}

fn failed(object: &str, problem: impl ToString) -> SceneError {
    SceneError::Object { object: object.to_owned(), problem: problem.to_string() }
}
