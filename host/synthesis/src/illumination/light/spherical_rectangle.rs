//! Rectangles as a point sees them, sampled evenly by solid angle.

use glam::DVec3;
use std::f64::consts::TAU;

/// A rectangle as a point at the origin sees it, of which directions are sampled evenly.
///
/// # Source
/// Ureña, Fajardo and King 2013, "An area-preserving parametrization for spherical rectangles".
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    axes: [DVec3; 3],
    /// Unit of length of what follows: no square of it is lost.
    scale: f64,
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
        let (left, low) = (corner.dot(first), corner.dot(second));
        let [x, y] = [[left, left + across.length()], [low, low + up.length()]];
        let scale = x.into_iter().chain(y).fold(-z, |most, at| most.max(at.abs()));
        let ([x, y], z) = ([x, y].map(|at| at.map(|at| at / scale)), z / scale);
        // Of the normals of the planes through the point and a side two coordinates are not 0, of neighbours the last
        // only.
        let normal = |at: f64| at / (z * z + at * at).sqrt();
        let normals = [normal(-y[0]), normal(x[1]), normal(y[1]), normal(-x[0])];
        let angle = |i: usize| (-normals[i] * normals[(i + 1) % 4]).clamp(-1.0, 1.0).acos();
        let k = TAU - angle(2) - angle(3);
        let solid_angle = angle(0) + angle(1) - k;
        let b = [normals[0], normals[2]];
        let possible = scale.is_finite() && z != 0.0;
        possible.then_some(SphericalRectangle { axes: [first, second, third], scale, x, y, z, b, k, solid_angle })
    }

    /// Its solid angle, sr.
    pub(super) fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// A point of the rectangle, from the lit point.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let angle = u * self.solid_angle + self.k;
        let (sin, cos) = angle.sin_cos();
        let slope = (cos * self.b[0] - self.b[1]) / sin;
        let cosine = (slope.signum() / length(slope, self.b[0])).clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let x = if sine > 0.0 { -(cosine * self.z) / sine } else { self.x[0] }.clamp(self.x[0], self.x[1]);
        let distance = length(x, self.z);
        let [low, high] = self.y.map(|y| y / length(distance, y));
        let height = low + v * (high - low);
        let square = height * height;
        let y = if square < 1.0 { height * distance / (1.0 - square).sqrt() } else { self.y[1] };
        let y = y.clamp(self.y[0], self.y[1]);
        (self.axes[0] * x + self.axes[1] * y + self.axes[2] * self.z) * self.scale
    }
}

/// The length of a vector of two coordinates that are neither huge nor tiny.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}
