//! Rays and where they hit.

use glam::DVec3;

/// A half line; its points are `origin + t direction` for `t >= 0`.
///
/// The direction need not have unit length, but must be finite and not zero; `t` counts in its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where the ray begins.
    pub origin: DVec3,
    /// The direction of the ray, of any length.
    pub direction: DVec3,
}

impl Ray {
    /// The point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// A hit of a ray on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter along the ray.
    pub t: f64,
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric weight of the second corner, 0..=1.
    pub u: f64,
    /// Barycentric weight of the third corner, 0..=1; the first has `1 - u - v`.
    pub v: f64,
}
