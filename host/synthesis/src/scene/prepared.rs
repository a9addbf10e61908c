//! A scene flattened for rendering: one soup of triangles, with what each belongs to.

use super::acceleration::{AccelerationCache, PlacedInstances};
use super::exact::{ExactSurfaces, FLAT_SINE};
use super::instances::ShortScatter;
use super::lamp_body::lamp_body;
use super::object::{GROUND, Object, Shape};
use super::parameters::parameters;
use super::placed_models::{LastDetails, PlacedAggregates, PlacedModel, PlacedTerrain};
use super::shape_mesh::ShapeMesh;
use super::shared::SharedMeshes;
use super::stretch::cofactors;
use super::{Camera, GeometrySettings, Motion, Scene, SceneError, Settings, View};
use crate::illumination::light::LightShape;
use crate::illumination::{Light, Material, RgbPower};
use crate::mesh::Mesh;
use crate::numeric::bounds::Bounds;
use crate::numeric::triangle::MAX_MAGNITUDE;
use crate::octree::{InstanceCosts, InstanceOctree};
use crate::stages::stage;
use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, Vec3};
use rustc_hash::FxHashMap;
use std::ops::Deref;
use std::sync::Arc;

/// Most triangles in a scene.
pub const MAX_TRIANGLES: u64 = 1 << 30;
/// A scene ready for a renderer, and how it is to be rendered. Copies share all but the settings.
#[derive(Clone, Debug)]
pub struct Prepared {
    contents: Arc<Contents>,
    /// How to render it. Those of geometry were followed when it was prepared.
    pub settings: Settings,
}

/// What is in a prepared scene, whatever its settings become.
#[derive(Debug)]
pub struct Contents {
    /// Corners of all triangles, in scene coordinates.
    pub vertices: Arc<Vec<DVec3>>,
    /// Triangles, counter-clockwise from outside; those of an object stand together.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// The object that each triangle belongs to, an index into `objects`.
    pub object_of: Vec<u32>,
    /// Unit normals at the corners, for the triangles of curved objects only.
    normals: Vec<[Vec3; 3]>,
    /// Parameters of the corners, for the triangles of objects whose textures or exact surfaces need them.
    parameters: Vec<[DVec2; 3]>,
    /// The exact surfaces of the triangles of curved objects, as far as they are known.
    pub(super) exact: ExactSurfaces,
    /// For the triangles of objects of several materials, which of them.
    material_of: Vec<u32>,
    /// The objects, in the order of the scene, and then the bodies of its lamps that reflect, and what instances place.
    pub objects: Vec<PreparedObject>,
    /// The lights.
    pub lights: Vec<Light>,
    /// Rectangles through which the light of skies comes in.
    pub portals: Vec<LightShape>,
    /// Ambient radiance.
    pub ambient: RgbPower,
    /// Background radiance.
    pub background: RgbPower,
    /// The camera of the scene, or one that frames it.
    pub camera: Camera,
    /// A box around everything.
    pub bounds: Bounds,
    /// The objects of instances by chance for which there is less room than was asked for.
    pub short_scatters: Vec<ShortScatter>,
    /// The instances that stand in it, each group of an object.
    pub(super) placed: Vec<PlacedInstances>,
    /// Their octrees, those within prototypes too.
    pub(super) instanced: Vec<Arc<InstanceOctree>>,
    /// Triangles that they place, each as often as it is.
    pub(super) placed_triangles: u64,
    /// The procedural models that its instances place, by their numbers.
    pub(super) models: Vec<Arc<PlacedModel>>,
    /// Those of its instances for which aggregates stand in, by their numbers.
    pub(super) aggregates: Vec<PlacedAggregates>,
    /// Its terrains that stand still and are open surfaces.
    pub(super) terrains: Vec<PlacedTerrain>,
    /// Its octrees, as far as they were asked for.
    pub(super) octrees: AccelerationCache,
    /// What was made of its models, as far as it was asked for and is kept.
    pub(super) details: LastDetails,
}

/// One object of a prepared scene.
#[derive(Clone, Debug)]
pub struct PreparedObject {
    /// Its name.
    pub name: String,
    /// The word for its shape.
    pub shape: &'static str,
    /// How it reflects: one material, or several for the faces of a composite.
    pub materials: Vec<Material>,
    /// Its first triangle.
    pub first: u32,
    /// How many triangles it has.
    pub count: u32,
    /// A box around it, wherever it moves, and around the aggregates that may stand in for its instances.
    pub bounds: Bounds,
    /// A box around it, wherever it moves, without aggregates: what a camera frames.
    pub framed: Bounds,
    /// The light whose body it is, an index into the lights of the scene; none of an object of the scene.
    pub light: Option<u32>,
    /// The object whose instances place it, an index into the objects; it and its box are in coordinates of its own then.
    pub placed_by: Option<u32>,
    /// How many instances it has, beside its triangles, each of which may place more; 0 for other objects.
    pub instances: usize,
    /// How many objects are copies of what its instances place; 0 where they are placed.
    pub copies: u64,
    /// The variation of a copy that stands for an instance; 0 for others.
    pub variation: u16,
    /// How it moves while the shutter is open; its triangles are where it is in the middle of that time.
    pub motion: Option<Motion>,
    /// Where its corner normals begin; none for an object with flat faces.
    normals_from: Option<u32>,
    /// Where the parameters of its corners begin; none for an object that needs none.
    parameters_from: Option<u32>,
    /// From scene coordinates to its own.
    pub to_own: DMat4,
    /// From its own normals to those of the scene, of some length.
    pub(super) normals_to_scene: DMat3,
    /// Where the numbers of its exact surfaces begin; none for an object without any that is curved.
    pub(super) surfaces_from: Option<u32>,
    /// Where its numbers of materials begin; none for an object of one material.
    materials_from: Option<u32>,
}

impl PreparedObject {
    /// Whether it has neither triangles nor instances.
    pub fn is_empty(&self) -> bool {
        self.count == 0 && self.instances == 0
    }

    /// Whether it has normals other than those of its faces.
    pub fn is_curved(&self) -> bool {
        self.normals_from.is_some()
    }

    /// Whether it has curved surfaces that are known exactly, and that the scene asks for.
    pub fn is_exact(&self) -> bool {
        self.surfaces_from.is_some()
    }
}

impl Prepared {
    /// Tessellates, reads and places everything in `scene`.
    ///
    /// # Errors
    /// [`SceneError`], for a value out of range or a mesh that cannot be made or read.
    pub fn new(scene: &Scene) -> Result<Prepared, SceneError> {
        let _stage = stage!("building the geometry");
        let contents = Contents::new(scene).map_err(|error| scene.origins.located(error))?;
        Ok(Prepared { contents: Arc::new(contents), settings: scene.settings })
    }
}

impl Deref for Prepared {
    type Target = Contents;

    fn deref(&self) -> &Contents {
        &self.contents
    }
}

impl Contents {
    /// Nothing of a scene but its lights.
    pub(super) fn empty(scene: &Scene) -> Contents {
        Contents {
            vertices: Arc::default(),
            triangles: Arc::default(),
            object_of: Vec::new(),
            normals: Vec::new(),
            parameters: Vec::new(),
            exact: ExactSurfaces::default(),
            material_of: Vec::new(),
            objects: Vec::new(),
            lights: scene.lights.clone(),
            portals: scene.portals.clone(),
            ambient: scene.ambient,
            background: scene.background,
            camera: Camera::framing(&Bounds::EMPTY),
            bounds: Bounds::EMPTY,
            short_scatters: Vec::new(),
            placed: Vec::new(),
            instanced: Vec::new(),
            placed_triangles: 0,
            models: Vec::new(),
            aggregates: Vec::new(),
            terrains: Vec::new(),
            octrees: AccelerationCache::default(),
            details: LastDetails::default(),
        }
    }

    pub(super) fn new(scene: &Scene) -> Result<Contents, SceneError> {
        scene.check()?;
        let mut contents = Contents::empty(scene);
        let mut shared = SharedMeshes::of(scene);
        let motions: FxHashMap<u32, Motion> = match scene.settings.geometry.shutter > 0.0 {
            true => scene.motions.iter().copied().collect(),
            false => FxHashMap::default(),
        };
        for (object, index) in scene.objects.iter().zip(0u32..) {
            let made = shared.mesh_of(scene, index)?;
            let motion = motions.get(&index).copied();
            contents.add_standing(object, &made, motion, &scene.settings.geometry)?;
            if let Shape::Terrain(terrain) = &object.shape
                && terrain.base.is_none()
                && motion.is_none()
            {
                let (name, to_scene) = (object.name.clone(), DAffine3::from_mat4(object.transform));
                contents.terrains.push(PlacedTerrain { object: index, name, terrain: (**terrain).clone(), to_scene });
            }
        }
        for (light, number) in scene.lights.iter().zip(0u32..) {
            let Some((patch, material)) = light.body() else { continue };
            let (body, made) = lamp_body(patch, material, number, &scene.settings.geometry)?;
            contents.add_standing(&body, &made, None, &scene.settings.geometry)?;
            if let Some(body) = contents.objects.last_mut() {
                (body.shape, body.light) = ("light", Some(number));
            }
        }
        // Copies of models are made for it.
        contents.camera = scene.camera.unwrap_or_else(|| Camera::framing(&contents.subject()));
        for (object, index) in scene.objects.iter().zip(0u32..) {
            if let Shape::Instances(instances) = &object.shape {
                contents.add_instances(index, object, instances, &scene.settings)?;
            } else if let Some(meshes) = shared.placed_by(index) {
                contents.add_placed_meshes(index, object, &meshes, &scene.settings.geometry)?;
            }
        }
        contents.camera = scene.camera.unwrap_or_else(|| Camera::framing(&contents.subject()));
        Ok(contents)
    }

    /// A box around what is looked at: all objects that are no grounds and no lamps, or everything if there are only these.
    pub fn subject(&self) -> Bounds {
        let is_meant =
            |object: &&PreparedObject| object.shape != GROUND && object.light.is_none() && object.placed_by.is_none();
        let all = self.objects.iter().filter(is_meant).filter(|object| !object.framed.is_empty());
        all.map(|object| object.framed).reduce(Bounds::union).unwrap_or(self.bounds)
    }

    /// Adds an object that stands in the scene as the last one.
    pub(super) fn add_standing(
        &mut self,
        object: &Object,
        shape_mesh: &ShapeMesh,
        motion: Option<Motion>,
        settings: &GeometrySettings,
    ) -> Result<&mut PreparedObject, SceneError> {
        let bounds = self.add(object, shape_mesh, motion, settings)?.bounds;
        self.bounds = self.bounds.union(bounds);
        let last = self.objects.len() - 1;
        Ok(&mut self.objects[last])
    }

    /// Adds an object as the last one; the box around everything stays.
    pub(super) fn add(
        &mut self,
        object: &Object,
        shape_mesh: &ShapeMesh,
        motion: Option<Motion>,
        settings: &GeometrySettings,
    ) -> Result<&mut PreparedObject, SceneError> {
        let failed = |problem: String| SceneError::Object { object: object.name.clone(), problem };
        let ShapeMesh { mesh, surfaces, operand_of, lines } = shape_mesh;
        if self.triangles.len() as u64 + mesh.triangles.len() as u64 > MAX_TRIANGLES {
            return Err(SceneError::Limit { what: "triangles", limit: MAX_TRIANGLES });
        }
        let mirrored = object.transform.determinant() < 0.0;
        let base = u32::try_from(self.vertices.len())
            .ok()
            .filter(|b| b.checked_add(mesh.vertices.len() as u32).is_some())
            .ok_or(SceneError::Limit { what: "vertices", limit: u64::from(u32::MAX) })?;
        let vertices = Arc::make_mut(&mut self.vertices);
        vertices.extend(mesh.vertices.iter().map(|v| object.transform.transform_point3(*v)));
        let placed = &vertices[base as usize..];
        let is_near = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAX_MAGNITUDE;
        if let Some(v) = placed.iter().find(|v| !is_near(v)) {
            return Err(failed(format!("a vertex is placed at {v}, farther than {MAX_MAGNITUDE:e} from the origin")));
        }
        let lines = lines.points.iter().map(|point| object.transform.transform_point3(*point));
        let still = Bounds::of(placed.iter().copied().chain(lines));
        let half = 0.5 * settings.shutter;
        let bounds = motion.map_or(still, |motion| motion.swept(&still, [-half, half]));
        let first = self.triangles.len() as u32;
        Arc::make_mut(&mut self.triangles).extend(mesh.triangles.iter().map(|&[a, b, c]| {
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            [a + base, b + base, c + base]
        }));
        self.object_of.resize(self.triangles.len(), self.objects.len() as u32);
        let normals_from = self.add_normals(mesh, &object.transform, mirrored);
        let is_wanted = settings.exact_surfaces && normals_from.is_some();
        let surfaces_from = if is_wanted { self.exact.add(mesh, surfaces) } else { None };
        let needs_parameters = surfaces_from.is_some() || object.needs_parameters(operand_of);
        let parameters_from = needs_parameters.then_some(self.parameters.len() as u32);
        if parameters_from.is_some() {
            self.parameters.extend(parameters(mesh, surfaces, mirrored));
        }
        let (materials, materials_from) = self.add_materials(object, operand_of);
        if motion.is_some() && materials.iter().any(|material| !material.emission.is_black()) {
            return Err(failed("it emits light, and what emits light cannot move".into()));
        }
        self.objects.push(PreparedObject {
            name: object.name.clone(),
            shape: object.shape.word(),
            materials,
            first,
            count: mesh.triangles.len() as u32,
            bounds,
            framed: bounds,
            light: None,
            placed_by: None,
            instances: 0,
            copies: 0,
            variation: 0,
            motion,
            normals_from,
            parameters_from,
            to_own: object.transform.inverse(),
            normals_to_scene: cofactors(&DMat3::from_mat4(object.transform)),
            surfaces_from,
            materials_from,
        });
        let last = self.objects.len() - 1;
        Ok(&mut self.objects[last])
    }

    /// Stores the placed corner normals if any of them departs from its face's.
    fn add_normals(&mut self, mesh: &Mesh, transform: &DMat4, mirrored: bool) -> Option<u32> {
        let curved = mesh.corner_normals.iter().zip(&mesh.triangles).any(|(normals, t)| {
            let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
            let face = (b - a).cross(c - a).normalize_or_zero();
            normals.iter().any(|n| n.normalize_or_zero().cross(face).length() > FLAT_SINE)
        });
        if !curved {
            return None;
        }
        let from = self.normals.len() as u32;
        let matrix = cofactors(&DMat3::from_mat4(*transform));
        self.normals.extend(mesh.corner_normals.iter().map(|normals| {
            let [a, b, c] = normals.map(|n| (matrix * n).normalize_or_zero().as_vec3());
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
        Some(from)
    }

    /// The materials of an object, each once; which of them its triangles have is stored if there are several.
    fn add_materials(&mut self, object: &Object, operand_of: &[u32]) -> (Vec<Material>, Option<u32>) {
        let (materials, of_triangles) = object.materials(operand_of);
        let from = (!of_triangles.is_empty()).then_some(self.material_of.len() as u32);
        self.material_of.extend(of_triangles);
        (materials, from)
    }

    /// Whether an object is the body of a lamp that has power.
    pub fn is_lit_lamp(&self, object: &PreparedObject) -> bool {
        let light = object.light.and_then(|light| self.lights.get(light as usize));
        light.is_some_and(|light| !light.strength().1.is_black())
    }

    /// How a triangle reflects.
    pub fn material(&self, triangle: u32) -> &Material {
        &self.object(triangle).materials[self.material_number(triangle) as usize]
    }

    /// The number of a triangle's material among those of its object.
    pub fn material_number(&self, triangle: u32) -> u32 {
        let object = self.object(triangle);
        object.materials_from.map_or(0, |from| self.material_of[(from + triangle - object.first) as usize])
    }

    /// The corners of a triangle, in scene coordinates.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// The object that a triangle belongs to.
    pub fn object(&self, triangle: u32) -> &PreparedObject {
        &self.objects[self.object_of[triangle as usize] as usize]
    }

    /// The unit normals at the corners of a triangle; none where its object is flat.
    ///
    /// A normal of length 0 stands for one that the surface does not have (a pole, a broken file).
    pub fn corner_normals(&self, triangle: u32) -> Option<&[Vec3; 3]> {
        let object = self.object(triangle);
        object.normals_from.map(|from| &self.normals[(from + triangle - object.first) as usize])
    }

    /// The parameters of the corners of a triangle, where a texture or its exact surface needs them: 0..1 over the
    /// domain of its exact surface.
    pub fn parameters(&self, triangle: u32) -> Option<&[DVec2; 3]> {
        let object = self.object(triangle);
        object.parameters_from.map(|from| &self.parameters[(from + triangle - object.first) as usize])
    }

    /// What all placed instances cost by now, those within prototypes too; nothing without any.
    pub fn instance_costs(&self) -> Option<InstanceCosts> {
        let none = InstanceCosts { triangles: self.placed_triangles, ..InstanceCosts::default() };
        let all = self.instanced.iter().fold(none, |all, octree| {
            let InstanceCosts { instances, stored, bytes, .. } = octree.costs();
            InstanceCosts {
                instances: all.instances.saturating_add(instances),
                stored: all.stored + stored,
                bytes: all.bytes + bytes,
                ..all
            }
        });
        (all.instances > 0).then_some(all)
    }

    /// Adds the placements of all instances to a checksum, and what defines models.
    pub fn add_placements_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        self.models.iter().for_each(|placed| sum.update(placed.model.definition().as_bytes()));
        self.placed.iter().for_each(|placed| placed.prototype.add_to_checksum(sum));
        self.aggregates.iter().for_each(|placed| sum.update(&placed.pixels.to_le_bytes()));
    }

    /// An object whose instances are placed, if there is one: renderers that go through triangles one by one do not see
    /// them.
    pub fn placed(&self) -> Option<&PreparedObject> {
        self.objects.iter().find(|object| object.instances > 0)
    }

    /// Memory of its triangles and what belongs to them, bytes; without octrees.
    pub(super) fn bytes(&self) -> u64 {
        let triangles = size_of_val(&self.vertices[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.object_of[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.parameters[..])
            + size_of_val(&self.material_of[..]);
        (triangles + size_of_val(&self.objects[..]) + size_of::<Contents>()) as u64
    }

    /// The view of the scene's own camera.
    pub fn view(&self) -> View {
        View::Camera(self.camera)
    }
}
