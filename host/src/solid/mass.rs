//! Volume, centre of mass and inertia of what a closed mesh bounds.

use super::Solid;
use glam::{DMat3, DVec3};

/// What a solid of density 1 has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Cubic units.
    pub volume: f64,
    /// Centre of mass; the origin for an empty solid.
    pub centroid: DVec3,
    /// Moments of inertia about the centre of mass: the integral of |r|^2 I - r r^T.
    pub inertia: DMat3,
}

impl Solid {
    /// Volume, centre of mass and inertia, for the density 1.
    ///
    /// Sums tetrahedra from the middle of the bounds to each triangle, so that a solid far from the origin loses no
    /// digits. Exact for the triangles, but for rounding; surfaces that they approximate are not asked.
    ///
    /// # Source
    /// Tonon 2004 for the second moments of a tetrahedron.
    pub fn mass(&self) -> Mass {
        let mesh = self.mesh();
        let Some(bounds) = mesh.bounds() else { return Mass::default() };
        let middle = bounds.center();
        let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle).map(|corner| corner - middle);
            let sixfold = a.dot(b.cross(c));
            let sum = a + b + c;
            volume += sixfold;
            first += sum * sixfold;
            let outer = |p: DVec3| DMat3::from_cols(p * p.x, p * p.y, p * p.z);
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * sixfold;
        }
        if volume == 0.0 {
            return Mass::default();
        }
        let offset = first / (4.0 * volume);
        let volume = volume / 6.0;
        let outer = DMat3::from_cols(offset * offset.x, offset * offset.y, offset * offset.z);
        let second = second * (1.0 / 120.0) - outer * volume;
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        Mass { volume, centroid: middle + offset, inertia: DMat3::IDENTITY * trace - second }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Tolerance, box_faces, tessellate};

    #[test]
    fn a_box_far_from_the_origin_has_the_moments_of_the_book() {
        let (low, size) = (DVec3::new(1e6, -3.0, 7.0), DVec3::new(2.0, 3.0, 5.0));
        let mesh = tessellate(&box_faces(low, low + size), Tolerance::new(1.0, 90.0)).unwrap();
        let mass = Solid::new(mesh).unwrap().mass();
        assert!((mass.volume - 30.0).abs() < 1e-12 && mass.centroid.distance(low + size / 2.0) < 1e-9);
        let squares = size * size;
        let expected = DVec3::new(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y) * 30.0 / 12.0;
        for (axis, column) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            assert!((mass.inertia.col(axis) - column * expected[axis]).length() < 1e-11);
        }
    }
}
