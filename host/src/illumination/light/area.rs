//! Rectangles as a point sees them.

use glam::DVec3;
use std::f64::consts::TAU;

/// A rectangle as a point at the origin sees it, of which directions are drawn evenly.
///
/// # Source
/// Ureña, Fajardo and King 2013, "An area-preserving parametrization for spherical rectangles".
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    axes: [DVec3; 3],
    /// Least and greatest coordinate along the first axis, and along the second.
    x: [f64; 2],
    y: [f64; 2],
    /// Coordinate along the third; below 0.
    z: f64,
    /// Third coordinates of the normals of the planes through two opposite sides.
    b: [f64; 2],
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// - `corner`: from the point to a corner. `across`, `up`: the sides there, square to each other.
    ///
    /// None where the rectangle is seen from its edge.
    pub(super) fn new(corner: DVec3, across: DVec3, up: DVec3) -> Option<SphericalRectangle> {
        let (first, second) = (across.try_normalize()?, up.try_normalize()?);
        let third = first.cross(second);
        let height = corner.dot(third);
        let (third, z) = if height > 0.0 { (-third, -height) } else { (third, height) };
        if z == 0.0 {
            return None;
        }
        let x = [corner.dot(first), corner.dot(first) + across.length()];
        let y = [corner.dot(second), corner.dot(second) + up.length()];
        let point = |i: usize, j: usize| DVec3::new(x[i], y[j], z);
        let corners = [point(0, 0), point(1, 0), point(1, 1), point(0, 1)];
        let mut normals = [DVec3::ZERO; 4];
        for (side, normal) in normals.iter_mut().enumerate() {
            *normal = corners[side].cross(corners[(side + 1) % 4]).try_normalize()?;
        }
        let angle = |i: usize| (-normals[i].dot(normals[(i + 1) % 4])).clamp(-1.0, 1.0).acos();
        let k = TAU - angle(2) - angle(3);
        let solid_angle = angle(0) + angle(1) - k;
        let b = [normals[0].z, normals[2].z];
        Some(SphericalRectangle { axes: [first, second, third], x, y, z, b, k, solid_angle })
    }

    /// Its solid angle, sr.
    pub(super) fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// A point of the rectangle, from the lit point.
    pub(super) fn draw(&self, [u, v]: [f64; 2]) -> DVec3 {
        let angle = u * self.solid_angle + self.k;
        let slope = (angle.cos() * self.b[0] - self.b[1]) / angle.sin();
        let cosine = (slope.signum() / slope.hypot(self.b[0])).clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let x = if sine > 0.0 { -(cosine * self.z) / sine } else { self.x[0] }.clamp(self.x[0], self.x[1]);
        let distance = x.hypot(self.z);
        let [low, high] = self.y.map(|y| y / distance.hypot(y));
        let height = low + v * (high - low);
        let square = height * height;
        let y = if square < 1.0 { height * distance / (1.0 - square).sqrt() } else { self.y[1] };
        let y = y.clamp(self.y[0], self.y[1]);
        self.axes[0] * x + self.axes[1] * y + self.axes[2] * self.z
    }
}
