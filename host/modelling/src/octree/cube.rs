//! The modelling cube: where the octree lies in the world.

use glam::DVec3;

use super::code::{LocationalCode, MAX_DEPTH};

/// Voxels along the cube at the highest resolution.
const VOXELS: f64 = (1_u32 << MAX_DEPTH) as f64;

/// A cube around all triangles; its side is a power of two, so that local coordinates are scaled without rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    /// Lowest corner, in world units.
    pub origin: DVec3,
    /// Side, in world units; a power of two.
    pub side: f64,
}

impl Cube {
    /// The cube around a box with finite corners, with room to spare on every side.
    pub fn around(low: DVec3, high: DVec3) -> Self {
        let extent = (high - low).max_element();
        // Where the box is a point, the cube is a few units in the last place of its coordinates.
        let resolution = low.abs().max(high.abs()).max_element() * 2.0 * f64::EPSILON;
        let side = power_of_two_above((extent + extent / 512.0).max(resolution));
        Self { origin: low + (high - low) * 0.5 - DVec3::splat(side * 0.5), side }
    }

    /// Whether the numbers are those of a cube: a side that is a power of two as [`Cube::around`] makes it, and a
    /// finite origin.
    pub fn is_sound(&self) -> bool {
        self.origin.is_finite() && self.side > 0.0 && power_of_two_above(self.side * 0.75) == self.side
    }

    /// One over the side, without a division.
    #[inline]
    pub fn unit(&self) -> f64 {
        // The exponent counts from 1023 and there are no other digits.
        f64::from_bits((2046 << 52) - self.side.to_bits())
    }

    /// World to local coordinates, 0..=1 in the cube.
    #[inline]
    pub fn local(&self, point: DVec3) -> DVec3 {
        (point - self.origin) * self.unit()
    }

    /// The voxel that holds a point at the highest resolution, by truncation; `None` outside the cube.
    pub fn voxel(&self, point: DVec3) -> Option<[u32; 3]> {
        let scaled = self.local(point) * VOXELS;
        let inside = scaled.cmpge(DVec3::ZERO).all() && scaled.cmplt(DVec3::splat(VOXELS)).all();
        inside.then(|| scaled.to_array().map(|x| x as u32))
    }

    /// Lowest and highest corner of a cell, in world units.
    pub fn bounds(&self, code: LocationalCode) -> (DVec3, DVec3) {
        let voxel = self.side / VOXELS;
        let low = DVec3::from_array(code.corner().map(f64::from)) * voxel + self.origin;
        (low, low + DVec3::splat(f64::from(code.side()) * voxel))
    }
}

/// The smallest power of two that is larger than a number, within 2^-1000..=2^1000.
fn power_of_two_above(x: f64) -> f64 {
    const BIAS: i64 = 1023;
    let exponent = ((x.to_bits() >> 52) & 0x7ff) as i64 - BIAS + 1;
    f64::from_bits(((exponent.clamp(-1000, 1000) + BIAS) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_is_the_next_power_of_two() {
        for (x, above) in [(0.75, 1.0), (1.0, 2.0), (1.5, 2.0), (1e-300, 2_f64.powi(-996)), (0.0, 2_f64.powi(-1000))] {
            assert_eq!(power_of_two_above(x), above);
        }
    }

    #[test]
    fn every_box_lies_inside_its_cube() {
        for scale in [1e-100, 1e-6, 1.0, 3.0, 1e100] {
            for offset in [0.0, 1.0, 1e7] {
                let low = DVec3::new(offset, -1.0, 0.5) * scale;
                let high = DVec3::new(offset + 1.0, 2.0, 0.5) * scale;
                let cube = Cube::around(low, high);
                for point in [low, high] {
                    let local = cube.local(point);
                    assert!(local.min_element() > 0.0 && local.max_element() < 1.0, "{local} at {scale} {offset}");
                    assert!(cube.voxel(point).is_some());
                }
            }
        }
        let point = DVec3::new(1e7, 3.0, -2.0);
        assert!(Cube::around(point, point).voxel(point).is_some());
    }
}
