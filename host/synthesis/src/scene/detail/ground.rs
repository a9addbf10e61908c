//! Terrain of a scene as rays meet it from some views: exactly, and as finely as it is seen.

use super::super::placed_models::PlacedTerrain;
use super::super::{DetailView, SceneError};
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::procedural::terrain::{TerrainCosts, TerrainSurface};
use glam::{DAffine3, DVec3};

/// A terrain of a scene with the surface that rays meet.
#[derive(Debug)]
pub struct SceneGround {
    /// The object of the scene that it is.
    pub object: u32,
    surface: TerrainSurface,
    to_scene: DAffine3,
    to_own: DAffine3,
    bounds: Bounds,
}

/// Where a ray meets the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundHit {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// The point, in coordinates of the terrain.
    pub own: DVec3,
    /// The unit normal there that points up, in coordinates of the terrain.
    pub normal: DVec3,
}

impl SceneGround {
    /// - `most_bytes`: that may be kept of it.
    ///
    /// # Errors
    /// [`SceneError`], for numbers that are out of range.
    pub(super) fn new(
        placed: &PlacedTerrain,
        views: &[DetailView],
        most_bytes: u64,
    ) -> Result<SceneGround, SceneError> {
        let failed =
            |error: &dyn ToString| SceneError::Object { object: placed.name.clone(), problem: error.to_string() };
        let to_scene = placed.to_scene;
        let views = views.iter().map(|view| view.ground(&to_scene)).collect();
        let field = placed.terrain.field().map_err(|error| failed(&error))?;
        let surface = TerrainSurface::new(field, views, most_bytes).map_err(|error| failed(&error))?;
        let own = surface.bounds();
        let corner = |k: usize| {
            let of = |axis: usize| if k >> axis & 1 == 0 { own.min[axis] } else { own.max[axis] };
            to_scene.transform_point3(DVec3::new(of(0), of(1), of(2)))
        };
        let bounds = Bounds::of((0..8).map(corner));
        Ok(SceneGround { object: placed.object, surface, to_scene, to_own: to_scene.inverse(), bounds })
    }

    /// A box around it, in coordinates of the scene.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// From its coordinates to those of the scene.
    pub fn to_scene(&self) -> &DAffine3 {
        &self.to_scene
    }

    /// From coordinates of the scene to its own.
    pub fn to_own(&self) -> &DAffine3 {
        &self.to_own
    }

    /// Where a ray first crosses the ground, from above or from below.
    ///
    /// - `between`: the lengths between which hits count.
    pub fn intersect(&self, ray: &Ray, between: [f64; 2]) -> Option<GroundHit> {
        let origin = self.to_own.transform_point3(ray.origin);
        let own = Ray { origin, direction: self.to_own.transform_vector3(ray.direction) };
        let hit = self.surface.intersect(&own, between)?;
        Some(GroundHit { t: hit.t, own: hit.point, normal: hit.normal })
    }

    /// What its surface costs by now.
    pub(super) fn costs(&self) -> TerrainCosts {
        self.surface.costs()
    }
}
