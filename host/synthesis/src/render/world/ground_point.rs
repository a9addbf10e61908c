//! A point of the ground that a ray meets exactly: the surface element there, and where it is for textures.

use super::element::{SurfaceElement, rounding_at};
use crate::illumination::texture::{FootprintSide, TextureFootprint};
use crate::numeric::ray::Ray;
use crate::scene::{Footprint, GroundHit, SceneGround};
use glam::{DAffine3, DVec2, DVec3};

/// A point of the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundPoint {
    position: DVec3,
    /// The unit normal that points up, scene coordinates.
    normal: DVec3,
    /// Where it is in the coordinates of the terrain.
    own: DVec3,
    /// How steep the ground is there along x and z, in these.
    slope: DVec2,
    to_scene: DAffine3,
    to_own: DAffine3,
}

impl GroundPoint {
    pub(super) fn new(hit: &GroundHit, ground: &SceneGround) -> GroundPoint {
        let (to_scene, to_own) = (*ground.to_scene(), *ground.to_own());
        let outwards = to_own.matrix3.transpose() * hit.normal;
        GroundPoint {
            position: to_scene.transform_point3(hit.own),
            normal: outwards.try_normalize().unwrap_or(hit.normal),
            own: hit.own,
            slope: DVec2::new(-hit.normal.x, -hit.normal.z) / hit.normal.y,
            to_scene,
            to_own,
        }
    }

    /// The surface element for a ray.
    pub(super) fn element(&self, ray: &Ray) -> SurfaceElement {
        let largest = self.position.abs().max_element().max(ray.origin.abs().max_element());
        SurfaceElement::smooth(self.position, self.normal, ray.direction, rounding_at(largest))
    }

    /// Where it is, and what of the ground is looked at: parameters are x and z.
    ///
    /// - `sides`: tangents, scene units. `variation`: of the object.
    pub(super) fn texture_place(&self, sides: Footprint, variation: u16) -> TextureFootprint {
        let side = |scene: DVec3| {
            let own = self.to_own.transform_vector3(scene);
            FootprintSide { scene, uv: DVec2::new(own.x, own.z), own }
        };
        let along = [DVec3::new(1.0, self.slope.x, 0.0), DVec3::new(0.0, self.slope.y, 1.0)];
        TextureFootprint {
            uv: DVec2::new(self.own.x, self.own.z),
            own: self.own,
            sides: sides.map(side),
            along: along.map(|tangent| self.to_scene.transform_vector3(tangent)),
            variation,
        }
    }
}
