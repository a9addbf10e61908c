//! A surface moved to another place.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::{Surface, nearest_from};
use crate::mesh::normal_matrix;

/// A surface as an affine map places it: turned, moved, scaled, sheared or mirrored.
#[derive(Clone, Debug)]
pub struct Placed<S> {
    surface: S,
    placement: DAffine3,
    normals: DMat3,
    is_mirrored: bool,
}

impl<S: Surface> Placed<S> {
    /// `surface` moved by `placement`. A mirrored surface is run through with u reversed, so that outside stays outside.
    pub fn new(surface: S, placement: DAffine3) -> Placed<S> {
        let is_mirrored = placement.matrix3.determinant() < 0.0;
        Placed { surface, placement, normals: normal_matrix(placement.matrix3), is_mirrored }
    }

    /// The parameters of the inner surface for `uv`, or the other way round.
    fn inner(&self, uv: DVec2) -> DVec2 {
        let [low, high] = self.surface.domain();
        if self.is_mirrored { DVec2::new(low.x + (high.x - uv.x), uv.y) } else { uv }
    }
}

impl<S: Surface> Surface for Placed<S> {
    fn domain(&self) -> [DVec2; 2] {
        self.surface.domain()
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        self.placement.transform_point3(self.surface.point(self.inner(uv)))
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        let [du, dv] = self.surface.derivatives(self.inner(uv)).map(|d| self.placement.transform_vector3(d));
        [if self.is_mirrored { -du } else { du }, dv]
    }

    fn normal(&self, uv: DVec2) -> DVec3 {
        (self.normals * self.surface.normal(self.inner(uv))).normalize_or_zero()
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}
