//! Volume, centre of mass and inertia of what a closed mesh bounds.

use super::Solid;
use glam::{DMat3, DVec3};

/// What a solid of density 1 has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Cubic units.
    pub volume: f64,
    /// Centre of mass; the origin for an empty solid.
    pub centroid: DVec3,
    /// Moments of inertia about the centre of mass: the integral of |r|^2 I - r r^T.
    pub inertia: DMat3,
}

impl Mass {
    /// That of an empty solid.
    pub const ZERO: Mass = Mass { volume: 0.0, centroid: DVec3::ZERO, inertia: DMat3::ZERO };
}

/// Sums over pieces of a closed surface, about the origin.
///
/// By the theorem of Gauss each piece counts for the cone from the origin over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

fn outer(p: DVec3) -> DMat3 {
    DMat3::from_cols(p * p.x, p * p.y, p * p.z)
}

impl Moments {
    /// Those of nothing.
    pub const ZERO: Moments = Moments { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };

    /// Adds a triangle, counter-clockwise from outside.
    ///
    /// # Source
    /// Tonon 2004 for the second moments of a tetrahedron.
    pub fn add_triangle(&mut self, [a, b, c]: [DVec3; 3]) {
        let sixfold = a.dot(b.cross(c));
        let sum = a + b + c;
        self.volume += sixfold / 6.0;
        self.first += sum * (sixfold / 24.0);
        self.second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (sixfold / 120.0);
    }

    /// Adds an element of a surface at `point`; `area` is along its outward normal and as long as its area.
    pub fn add_element(&mut self, point: DVec3, area: DVec3) {
        let threefold = point.dot(area);
        self.volume += threefold / 3.0;
        self.first += point * (threefold / 4.0);
        self.second += outer(point) * (threefold / 5.0);
    }

    /// What the whole surface bounds, where the origin stands for `origin`.
    pub fn mass(self, origin: DVec3) -> Mass {
        let Moments { volume, first, second } = self;
        if volume == 0.0 {
            return Mass::ZERO;
        }
        let offset = first / volume;
        let second = second - outer(offset) * volume;
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        Mass { volume, centroid: origin + offset, inertia: DMat3::IDENTITY * trace - second }
    }
}

impl Solid {
    /// Volume, centre of mass and inertia, for the density 1.
    ///
    /// Sums tetrahedra from the middle of the bounds to each triangle, so that a solid far from the origin loses no
    /// digits. Exact for the triangles, but for rounding; surfaces that they approximate are not asked.
    pub fn mass(&self) -> Mass {
        let mesh = self.mesh();
        let Some(bounds) = mesh.bounds() else { return Mass::ZERO };
        let middle = bounds.center();
        let mut moments = Moments::ZERO;
        for triangle in 0..mesh.triangles.len() {
            moments.add_triangle(mesh.corners(triangle).map(|corner| corner - middle));
        }
        moments.mass(middle)
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
