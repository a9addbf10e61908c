//! What a model makes for one seed and one level of detail, ready for rays.

use super::super::acceleration::AccelerationKey;
use super::super::placed_models::PlacedModel;
use super::super::prepared::Contents;
use super::super::procedural::{geometry_of, places_among};
use super::super::{PreparedObject, Scene, SceneError, Settings};
use super::outline::DetailOutline;
use crate::numeric::bounds::Bounds;
use crate::octree::{Instance, InstanceOctree, MOST_MADE_LEVELS, PlacementForm, Prototype};
use crate::stages::stage;
use glam::DAffine3;
use std::sync::Arc;

/// What is made may be out of the box of its model by this part of its diagonal, for rounding.
const ROUNDING: f64 = 1e-6;
/// Boxes about instances are larger than these: they may be out by this part of the diagonal.
const LOOSE: f64 = 1.0 / 16.0;

/// What a model makes for one seed and one level of detail.
#[derive(Debug)]
pub struct MadeDetail {
    contents: Contents,
    /// None without any triangles.
    octree: Option<InstanceOctree>,
    /// The object of the scene that has its materials.
    object: u32,
    /// For each of its objects, which of these materials are its own.
    material_of: Vec<Vec<u32>>,
}

impl MadeDetail {
    /// Nothing at all.
    pub(super) fn nothing() -> MadeDetail {
        let contents = Contents::empty(&Scene::default());
        MadeDetail { contents, octree: None, object: 0, material_of: Vec::new() }
    }

    /// Makes it.
    ///
    /// # Errors
    /// [`SceneError`], for what cannot be made, has another material, or is out of the box of the model.
    pub(super) fn new(of: &PlacedModel, seed: u32, level: i32) -> Result<MadeDetail, SceneError> {
        let _stage = stage!("making detail");
        let detail = of.model.detail_of(level);
        let name = || format!("model of seed {seed} at detail {detail:.3}");
        let failed = |problem: String| SceneError::Object { object: name(), problem };
        let objects = of.model.objects(seed, detail).map_err(failed)?;
        let objects = objects.iter().map(|object| object.within(&of.whole).into_owned()).collect();
        let settings = Settings { geometry: geometry_of(detail), ..Settings::default() };
        let contents = Contents::new(&Scene { objects, settings, ..Scene::default() })?;
        let places = |object: &PreparedObject| places_among(&of.materials, &object.materials);
        let material_of = contents.objects.iter().map(places).collect::<Result<_, String>>().map_err(failed)?;
        let kept = AccelerationKey { objects: vec![true; contents.objects.len()], motions: false };
        let still = contents.still(&kept).map_err(|error| failed(error.to_string()))?;
        let standing = contents.objects.iter().filter(|object| object.placed_by.is_none() && object.instances == 0);
        let own = standing.fold(Bounds::EMPTY, |all, object| all.union(object.bounds));
        check_within(&own, &of.model.bounds(), ROUNDING).map_err(failed)?;
        check_within(&contents.bounds, &of.model.bounds(), LOOSE).map_err(failed)?;
        let mut prototypes: Vec<Prototype> = Vec::new();
        let mut placements = Vec::new();
        if let Some(still) = still {
            prototypes.push(Prototype::surface(Arc::new(still.octree), 0));
            placements.push(DAffine3::IDENTITY);
        }
        for placed in &contents.placed {
            prototypes.push(placed.prototype.clone());
            placements.push(placed.transform);
        }
        let instance = |n: usize| Instance { prototype: n as u16, variation: 0, placement: placements[n] };
        let octree = InstanceOctree::new(prototypes, PlacementForm::Exact, placements.len(), instance)
            .map_err(|error| failed(error.to_string()))?;
        if octree.levels() > MOST_MADE_LEVELS {
            let most = MOST_MADE_LEVELS - 1;
            return Err(failed(format!("its instances are nested more than {most} times")));
        }
        let octree = (octree.count() > 0).then_some(octree);
        Ok(MadeDetail { contents, octree, object: of.object, material_of })
    }

    /// The octree over it, whose hits name its own triangles; none without any.
    pub fn octree(&self) -> Option<&InstanceOctree> {
        self.octree.as_ref()
    }

    /// Its triangles.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// The object of the scene, and which material of that, that one of its triangles has.
    pub fn object_and_material(&self, triangle: u32) -> [u32; 2] {
        let own = self.contents.object_of[triangle as usize];
        [self.object, self.material_of[own as usize][self.contents.material_number(triangle) as usize]]
    }

    /// Boxes around its triangles and instances.
    pub(super) fn outline(&self) -> DetailOutline {
        let standing = |object: &PreparedObject| object.placed_by.is_none();
        let triangles = self.contents.objects.iter().filter(|object| standing(object)).flat_map(|object| {
            (object.first..object.first + object.count).map(|triangle| Bounds::of(self.contents.corners(triangle)))
        });
        let instances = self.contents.placed.iter().map(|placed| {
            Bounds::of(placed.prototype.bounds().corners().map(|corner| placed.transform.transform_point3(corner)))
        });
        DetailOutline::around(&mut triangles.chain(instances).collect::<Vec<Bounds>>())
    }

    /// How much memory it takes.
    pub(super) fn bytes(&self) -> u64 {
        self.contents.bytes() + self.octree.as_ref().map_or(0, InstanceOctree::all_bytes) as u64
    }
}

/// Refuses what is out of the box of its model.
fn check_within(made: &Bounds, bounds: &Bounds, margin: f64) -> Result<(), String> {
    let margin = bounds.diagonal() * margin;
    let is_within =
        made.is_empty() || (made.min + margin).cmpge(bounds.min).all() && (made.max - margin).cmple(bounds.max).all();
    if is_within {
        return Ok(());
    }
    let Bounds { min, max } = bounds;
    Err(format!("it reaches from {} to {}, out of the box of its model from {min} to {max}", made.min, made.max))
}
