//! Boxes along the axes.

use glam::{DMat4, DVec3};

/// A closed box along the axes; empty when a minimum exceeds its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub min: DVec3,
    /// The greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Bounds {
        points.into_iter().fold(Bounds::EMPTY, |b, p| Bounds { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether both have a point in common; those on their sides count.
    pub fn touches(self, other: Bounds) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x || self.min.y > self.max.y || self.min.z > self.max.z
    }

    /// The middle; the origin for the empty box.
    pub fn center(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.min + (self.max - self.min) * 0.5 }
    }

    /// Lengths of the sides; 0 for the empty box.
    pub fn size(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.max - self.min }
    }

    /// Length of the diagonal; 0 for the empty box.
    pub fn diagonal(&self) -> f64 {
        self.size().length()
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        let pick = |i: usize, bit: usize, min: f64, max: f64| if i >> bit & 1 == 0 { min } else { max };
        std::array::from_fn(|i| {
            DVec3::new(
                pick(i, 0, self.min.x, self.max.x),
                pick(i, 1, self.min.y, self.max.y),
                pick(i, 2, self.min.z, self.max.z),
            )
        })
    }

    /// Whether a projection places the whole box outside one of the four sides of a window, or behind the eye.
    ///
    /// - `to_clip`: column-vector matrix to clip coordinates.
    /// - `window`: x min, x max, y min, y max in clip coordinates.
    pub fn is_outside(&self, to_clip: &DMat4, window: [f64; 4]) -> bool {
        let corners = self.corners().map(|c| *to_clip * c.extend(1.0));
        self.is_empty()
            || corners.iter().all(|c| c.w <= 0.0)
            || corners.iter().all(|c| c.x < window[0] * c.w)
            || corners.iter().all(|c| c.x > window[1] * c.w)
            || corners.iter().all(|c| c.y < window[2] * c.w)
            || corners.iter().all(|c| c.y > window[3] * c.w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_outside_only_if_one_side_of_the_window_excludes_it() {
        let window = [-1.0, 1.0, -1.0, 1.0];
        let cube = |x: f64| Bounds { min: DVec3::splat(x), max: DVec3::splat(x + 0.5) };
        assert!(!cube(0.0).is_outside(&DMat4::IDENTITY, window));
        assert!(!cube(0.9).is_outside(&DMat4::IDENTITY, window));
        assert!(cube(1.1).is_outside(&DMat4::IDENTITY, window));
        assert!(Bounds::EMPTY.is_outside(&DMat4::IDENTITY, window));
    }
}
