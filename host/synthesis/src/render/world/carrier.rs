//! How what a ray hits was brought to where it is: by its motion, and by the instances that place it.

use crate::numeric::ray::Ray;
use crate::octree::PlacedSurface;
use crate::scene::Displacement;
use glam::{DAffine3, DMat3, DVec3};

/// The map from where triangles are kept to where they are at a time.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Carrier {
    to_scene: DAffine3,
    to_own: DAffine3,
    /// Carries normals to normals, of some length.
    normals: DMat3,
    /// The largest coordinate that the map computes with, for what rounding does to a point.
    largest: f64,
    /// By which instances of one kind differ.
    pub(in crate::render) variation: u16,
}

impl Carrier {
    /// What moves.
    pub(in crate::render) fn moved(moved: &Displacement) -> Carrier {
        Carrier::new(DAffine3::from_mat4(moved.matrix()), moved.largest(), 0)
    }

    /// What instances place, and what moves then, if it does.
    pub(in crate::render) fn placed(placed: &PlacedSurface, moved: Option<&Displacement>) -> Carrier {
        let PlacedSurface { placement, variation, largest } = *placed;
        match moved {
            None => Carrier::new(placement, largest, variation),
            Some(moved) => {
                let placement = DAffine3::from_mat4(moved.matrix()) * placement;
                Carrier::new(placement, largest + moved.largest(), variation)
            }
        }
    }

    fn new(to_scene: DAffine3, largest: f64, variation: u16) -> Carrier {
        let to_own = to_scene.inverse();
        Carrier { to_scene, to_own, normals: to_own.matrix3.transpose(), largest, variation }
    }

    /// Where a point comes to.
    pub(in crate::render) fn point(&self, own: DVec3) -> DVec3 {
        self.to_scene.transform_point3(own)
    }

    /// Where a tangent comes to.
    pub(in crate::render) fn vector(&self, own: DVec3) -> DVec3 {
        self.to_scene.transform_vector3(own)
    }

    /// The tangent that comes to one.
    pub(in crate::render) fn own_vector(&self, there: DVec3) -> DVec3 {
        self.to_own.transform_vector3(there)
    }

    /// The unit normal that a unit normal becomes, on the same side.
    pub(in crate::render) fn normal(&self, own: DVec3) -> DVec3 {
        (self.normals * own).try_normalize().unwrap_or(own)
    }

    /// How far apart two planes come to be that are 1 apart, square to a unit normal.
    pub(in crate::render) fn height(&self, own: DVec3) -> f64 {
        (self.normals * own).length().recip()
    }

    /// A ray as what is carried would see it where it is kept; its lengths stay.
    pub(in crate::render) fn own_ray(&self, ray: &Ray) -> Ray {
        let origin = self.to_own.transform_point3(ray.origin);
        Ray { origin, direction: self.to_own.transform_vector3(ray.direction) }
    }

    /// The largest coordinate that there and back a point is rounded by.
    ///
    /// - `there`: the point, carried.
    pub(in crate::render) fn largest_at(&self, there: DVec3) -> f64 {
        let norm = |map: &DMat3| map.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        // The way back is longer for a map that shortens, and an error on it becomes longer there: the condition, which
        // is 3 for rotations by this norm.
        let condition = norm(&self.to_scene.matrix3) * norm(&self.to_own.matrix3) / 3.0;
        (there.abs().max_element() + self.largest) * condition
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn carrier(matrix3: DMat3) -> Carrier {
        let placement = DAffine3 { matrix3, translation: DVec3::new(3.0, -1.0, 2.0) };
        Carrier::placed(&PlacedSurface { placement, variation: 5, largest: 4.0 }, None)
    }

    #[test]
    fn normals_stay_square_to_tangents_and_on_their_side() {
        let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0));
        for stretch in [DVec3::new(1.0, 4.0, 0.2), DVec3::new(-1.0, 1.0, 1.0), DVec3::splat(1e-6), DVec3::splat(1e6)] {
            let carrier = carrier(turn * DMat3::from_diagonal(stretch));
            let normal = DVec3::new(0.48, 0.6, 0.64);
            let [one, other] = [normal.any_orthonormal_pair().0, normal.any_orthonormal_pair().1];
            let carried = carrier.normal(normal);
            assert!((carried.length() - 1.0).abs() < 1e-14);
            for tangent in [one, other] {
                assert!(carried.dot(carrier.vector(tangent).normalize()).abs() < 1e-14);
            }
            assert!((carried.dot(carrier.vector(normal)) / carrier.height(normal) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_ray_meets_the_same_points_at_the_same_lengths() {
        let carrier = carrier(DMat3::from_diagonal(DVec3::new(1.0, 4.0, -0.2)));
        let ray = Ray { origin: DVec3::new(0.3, -1.0, 5.0), direction: DVec3::new(0.2, 0.4, -2.0) };
        let own = carrier.own_ray(&ray);
        for t in [0.0, 1.0, 2.5] {
            assert!((carrier.point(own.at(t)) - ray.at(t)).length() < 1e-14);
        }
    }
}
