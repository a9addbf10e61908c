//! Flat pieces: parallelograms, the faces of a box, the ground.

use glam::{DVec2, DVec3};

use super::curvature::Curved;
use super::{Surface, between};

/// A flat four-sided piece with parallel opposite sides; parameters 0..=1.
#[derive(Clone, Debug, PartialEq)]
pub struct Parallelogram {
    /// The points at (0, 0), (1, 0), (0, 1) and (1, 1).
    corners: [DVec3; 4],
}

impl Parallelogram {
    /// The piece with a corner at `origin` and the sides `along_u` and `along_v`; its outside is where
    /// `along_u` x `along_v` points.
    pub fn new(origin: DVec3, along_u: DVec3, along_v: DVec3) -> Parallelogram {
        Parallelogram { corners: [origin, origin + along_u, origin + along_v, origin + along_u + along_v] }
    }

    fn sides(&self) -> [DVec3; 2] {
        [self.corners[1] - self.corners[0], self.corners[2] - self.corners[0]]
    }
}

impl Surface for Parallelogram {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::ZERO, DVec2::ONE]
    }

    fn point(&self, uv: DVec2) -> DVec3 {
        let row = |a: DVec3, b: DVec3| DVec3::from_array([0, 1, 2].map(|k| between(a[k], b[k], uv.x)));
        let (low, high) = (row(self.corners[0], self.corners[1]), row(self.corners[2], self.corners[3]));
        DVec3::from_array([0, 1, 2].map(|k| between(low[k], high[k], uv.y)))
    }

    fn derivatives(&self, _: DVec2) -> [DVec3; 2] {
        self.sides()
    }

    fn normal(&self, _: DVec2) -> DVec3 {
        let [u, v] = self.sides();
        u.normalize_or_zero().cross(v.normalize_or_zero()).normalize_or_zero()
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        let ([u, v], offset) = (self.sides(), point - self.corners[0]);
        let (uu, vv, shared) = (u.dot(u), v.dot(v), u.dot(v));
        let determinant = uu * vv - shared * shared;
        let foot = DVec2::new(vv * u.dot(offset) - shared * v.dot(offset), uu * v.dot(offset) - shared * u.dot(offset));
        let foot = foot / determinant;
        let is_inside = foot.cmpge(DVec2::ZERO).all() && foot.cmple(DVec2::ONE).all();
        if is_inside { foot } else { super::nearest_from(self, point, guess) }
    }
}

impl Curved for Parallelogram {
    fn second_derivatives(&self, _: DVec2) -> [DVec3; 3] {
        [DVec3::ZERO; 3]
    }
}

/// The six faces of an axis-parallel box, outside out: -x, +x, -y, +y, -z, +z. They share corners bit by bit.
///
/// `low` and `high` are opposite corners, each coordinate of `low` below that of `high`.
pub fn box_faces(low: DVec3, high: DVec3) -> [Parallelogram; 6] {
    let at = |x: u8, y: u8, z: u8| {
        let pick = |high_side: u8, low: f64, high: f64| if high_side == 1 { high } else { low };
        DVec3::new(pick(x, low.x, high.x), pick(y, low.y, high.y), pick(z, low.z, high.z))
    };
    let face = |corners: [[u8; 3]; 4]| Parallelogram { corners: corners.map(|[x, y, z]| at(x, y, z)) };
    [
        face([[0, 0, 0], [0, 0, 1], [0, 1, 0], [0, 1, 1]]),
        face([[1, 0, 1], [1, 0, 0], [1, 1, 1], [1, 1, 0]]),
        face([[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]),
        face([[0, 1, 1], [1, 1, 1], [0, 1, 0], [1, 1, 0]]),
        face([[1, 0, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]]),
        face([[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]),
    ]
}

/// A horizontal square that faces up, `size` wide, around `center`.
pub fn ground(center: DVec3, size: f64) -> Parallelogram {
    let corner = center + DVec3::new(-0.5, 0.0, 0.5) * size;
    Parallelogram::new(corner, DVec3::X * size, DVec3::NEG_Z * size)
}

#[cfg(test)]
mod tests {
    use super::super::{Tolerance, tessellate};
    use super::*;

    #[test]
    fn a_box_is_twelve_triangles_over_eight_vertices_with_flat_normals() {
        let (low, high) = (DVec3::new(-0.1, 0.3, 2.0), DVec3::new(1.7, 0.9, 2.3));
        let mesh = tessellate(&box_faces(low, high), Tolerance::new(1e-9, 1.0)).unwrap();
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
        assert!(mesh.is_closed());
        let size = high - low;
        assert!((mesh.signed_volume() - size.element_product()).abs() < 1e-14);
        for (triangle, normals) in mesh.corner_normals.iter().enumerate() {
            let flat = mesh.face_normal(triangle).unwrap();
            assert!(normals.iter().all(|normal| (*normal - flat).length() < 1e-14));
        }
    }

    #[test]
    fn the_ground_faces_up() {
        assert_eq!(ground(DVec3::ONE, 4.0).normal(DVec2::ZERO), DVec3::Y);
        assert_eq!(ground(DVec3::ONE, 4.0).point(DVec2::splat(0.5)), DVec3::ONE);
    }
}
