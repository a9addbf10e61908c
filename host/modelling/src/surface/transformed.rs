//! A surface moved to another place.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::curvature::Curved;
use super::{ParameterLine, Surface, nearest_from};
use crate::mesh::normal_matrix;

/// A surface as an affine map places it: rotated, moved, scaled, sheared or mirrored.
#[derive(Clone, Debug)]
pub struct TransformedSurface<S> {
    surface: S,
    placement: DAffine3,
    normals: DMat3,
    is_mirrored: bool,
    /// The way back, if the map keeps angles: then what is nearest stays nearest.
    back: Option<DAffine3>,
}

/// Columns of equal length and at right angles to this part of their length make a map that keeps angles.
const ALIKE: f64 = 1e-14;

impl<S: Surface> TransformedSurface<S> {
    /// `surface` moved by `placement`. A mirrored surface is traversed with u reversed, so that outside stays outside.
    pub fn new(surface: S, placement: DAffine3) -> TransformedSurface<S> {
        let is_mirrored = placement.matrix3.determinant() < 0.0;
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = placement.matrix3;
        let squared = x.length_squared();
        let gaps = [y.length_squared() - squared, z.length_squared() - squared, x.dot(y), y.dot(z), z.dot(x)];
        let keeps_angles = squared > 0.0 && gaps.iter().all(|gap| gap.abs() <= ALIKE * squared);
        let back = keeps_angles.then(|| placement.inverse());
        TransformedSurface { surface, placement, normals: normal_matrix(placement.matrix3), is_mirrored, back }
    }

    /// The parameters of the inner surface for `uv`, or the other way round.
    fn inner(&self, uv: DVec2) -> DVec2 {
        let [low, high] = self.surface.domain();
        if self.is_mirrored { DVec2::new(low.x + (high.x - uv.x), uv.y) } else { uv }
    }
}

impl<S: Surface> Surface for TransformedSurface<S> {
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

    fn point_and_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let [point, du, dv] = self.surface.point_and_derivatives(self.inner(uv));
        let [du, dv] = [if self.is_mirrored { -du } else { du }, dv].map(|d| self.placement.transform_vector3(d));
        [self.placement.transform_point3(point), du, dv]
    }

    fn normal(&self, uv: DVec2) -> DVec3 {
        (self.normals * self.surface.normal(self.inner(uv))).normalize_or_zero()
    }

    fn line(&self, v: f64) -> ParameterLine<'_> {
        let line = self.surface.line(v);
        Box::new(move |u| {
            let [point, normal] = line(self.inner(DVec2::new(u, v)).x);
            [self.placement.transform_point3(point), (self.normals * normal).normalize_or_zero()]
        })
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        match &self.back {
            Some(back) => self.inner(self.surface.nearest(back.transform_point3(point), self.inner(guess))),
            None => nearest_from(self, point, guess),
        }
    }
}

impl<S: Curved> Curved for TransformedSurface<S> {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        let [uu, both, vv] = self.surface.second_derivatives(self.inner(uv));
        let both = if self.is_mirrored { -both } else { both };
        [uu, both, vv].map(|d| self.placement.transform_vector3(d))
    }
}
