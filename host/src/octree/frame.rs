//! A ray as the cells see it: in local coordinates, from where it enters the cube, in single precision.

use super::clip::FAT;
use super::code::{LocationalCode, MAX_DEPTH};
use super::cube::Cube;
use crate::numeric::ray::Ray;
use crate::numeric::triangle::Shear;

/// Rounding of a point on the ray and of what it is compared with in single precision, twice what it can be.
///
/// A corner of a triangle and the length to it are each off by 2^-25, the slope by as much, what is taken from it by
/// 2^-24, the difference by 2^-24 and the product by 2^-25: 2^-22 in all. A side of a box is off by 2^-25, and the length
/// to it by two roundings and one of each product: less than 2^-22 too.
const SINGLE_TOLERANCE: f64 = 1.0 / (1_u32 << 21) as f64;

/// Rounding of a point on the ray in double precision, as a share of the distance from origin to cube.
const DOUBLE_TOLERANCE: f64 = 1.0 / (1_u64 << 48) as f64;

/// A ray that begins farther from the cube than this many of its sides misses: rounding moves it by a quarter of one.
pub const MAX_DISTANCE: f64 = (1_u64 << 46) as f64;

/// Slopes below this count as this in the box test; the ray leaves its line by less than 1e-19 of the cube.
const LEAST_SLOPE: f64 = 1e-20;

/// A ray in the cube. Its points are `entry + s slope`, where s counts sides of the cube along the longest axis.
///
/// Lengths in single precision are counted from a little before the entry, so that none that matters is negative.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The longest axis last, the others in cyclic order.
    pub axes: [usize; 3],
    /// Slopes over the longest axis as coordinates grow, of the other two.
    pub shear: [f32; 2],
    /// Where the line of the ray meets zero of the longest axis, along the other two; then the sign of its direction along
    /// the longest times where it begins.
    pub base: [f32; 3],
    /// 1 or -1: direction along the longest axis.
    pub sign_z: f32,
    /// By how much a coordinate may be off, sides of the cube.
    pub tolerance: f32,
    /// What a tolerance and a size make of an edge function's error.
    pub error_scale: f32,
    /// One over the slope, by axis.
    pub inverse: [f32; 3],
    /// What is to be taken from a coordinate times the inverse to get the length to the near side of a box, which is moved
    /// towards the ray by the tolerance; by axis.
    pub near: [f32; 3],
    /// The same for the far sides.
    pub far: [f32; 3],
    /// Whether the ray goes down, by axis.
    pub down: [bool; 3],
    /// Length of the ray in the cube, or to `t_max`.
    pub length: f64,
    /// Local coordinates where the ray enters the cube, or of its first point, by axis.
    pub entry: [f64; 3],
    /// Slopes in double precision, by axis; 1 or -1 along the longest.
    pub slopes: [f64; 3],
    /// Tolerance in double precision, apart from the single-precision part.
    pub double_tolerance: f64,
    rate: f64,
    offset: f64,
}

impl Frame {
    /// Prepares a ray that was sheared before; `None` if it misses the cube between `t_min` and `t_max`.
    #[inline(always)]
    pub fn new(ray: &Ray, shear: &Shear, cube: &Cube, t_min: f64, t_max: f64) -> Option<Self> {
        let axes = shear.axes();
        let [x, y, z] = axes;
        let [slope_x, slope_y] = shear.slopes();
        let length_z = ray.direction[z];
        let sign_z = 1.0_f64.copysign(length_z);
        let mut slopes = [0.0; 3];
        (slopes[x], slopes[y], slopes[z]) = (slope_x * sign_z, slope_y * sign_z, sign_z);
        let unit = cube.unit();
        let origin = ((ray.origin - cube.origin) * unit).to_array();
        let reach = greater(greater(origin[0].abs(), origin[1].abs()), greater(origin[2].abs(), 1.0));
        // Written so that what is not a number ends here.
        let near = reach <= MAX_DISTANCE;
        if !near {
            return None;
        }
        let double_tolerance = reach * DOUBLE_TOLERANCE;
        let tolerance = SINGLE_TOLERANCE + double_tolerance;

        let rate = length_z.abs() * unit;
        let inverse = [inverse(slopes[0]), inverse(slopes[1]), inverse(slopes[2])];
        let margin = 4.0 * tolerance;
        let (mut enter, mut exit) = (t_min * rate, t_max * rate);
        for axis in 0..3 {
            // The middle of the cube, and how far it is from there to its sides.
            let middle = (0.5 - origin[axis]) * inverse[axis];
            let half = (0.5 + margin) * inverse[axis].abs();
            enter = greater(enter, middle - half);
            exit = -greater(-exit, -(middle + half));
        }
        let meets = enter <= exit + margin && enter.is_finite() && exit.is_finite();
        if !meets {
            return None;
        }
        let (mut entry, mut first) = ([0.0; 3], [0.0; 3]);
        let (mut near, mut far) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            entry[axis] = origin[axis] + slopes[axis] * enter;
            first[axis] = entry[axis] - slopes[axis] * margin;
            let (length, aside) = (first[axis] * inverse[axis], tolerance * inverse[axis].abs());
            (near[axis], far[axis]) = ((length + aside) as f32, (length - aside) as f32);
        }
        Some(Self {
            axes,
            shear: [slope_x as f32, slope_y as f32],
            base: [
                (first[x] - slope_x * first[z]) as f32,
                (first[y] - slope_y * first[z]) as f32,
                (first[z] * sign_z) as f32,
            ],
            sign_z: sign_z as f32,
            tolerance: tolerance as f32,
            error_scale: (16.0 * tolerance) as f32,
            inverse: [inverse[0] as f32, inverse[1] as f32, inverse[2] as f32],
            near,
            far,
            down: [slopes[0].is_sign_negative(), slopes[1].is_sign_negative(), slopes[2].is_sign_negative()],
            length: exit - enter,
            entry,
            slopes,
            double_tolerance,
            rate,
            offset: enter,
        })
    }

    /// Whether the ray may meet a cube of the octree, in double precision; in doubt it may.
    pub fn may_meet(&self, cube: LocationalCode) -> bool {
        let voxel = 1.0 / f64::from(1_u32 << MAX_DEPTH);
        let margin = FAT + 4.0 * self.double_tolerance;
        let (mut enter, mut exit) = (-margin, self.length + margin);
        for (axis, corner) in cube.corner().into_iter().enumerate() {
            let low = f64::from(corner) * voxel;
            let high = low + f64::from(cube.side()) * voxel;
            let inverse = inverse(self.slopes[axis]);
            let [to_low, to_high] = [low - margin, high + margin].map(|plane| (plane - self.entry[axis]) * inverse);
            enter = enter.max(to_low.min(to_high));
            exit = exit.min(to_low.max(to_high));
        }
        enter <= exit + margin
    }

    /// A bound for the parameter s of a hit at `t`, rounded up.
    #[inline]
    pub fn limit(&self, t: f64) -> f32 {
        self.limit_of(self.along(t).min(self.length))
    }

    /// The parameter s at `t`.
    #[inline]
    pub fn along(&self, t: f64) -> f64 {
        t * self.rate - self.offset
    }

    /// Lengths in single precision that certainly stand for `t_min < t < t_max` from the first to the second.
    #[inline]
    pub fn within(&self, t_min: f64, t_max: f64) -> [f32; 2] {
        let slack = 8.0 * f64::from(self.tolerance);
        [(t_min * self.rate - self.offset + slack) as f32, (t_max * self.rate - self.offset) as f32]
    }

    /// A bound for single-precision lengths that stand for `s`, rounded up.
    #[inline]
    pub fn limit_of(&self, s: f64) -> f32 {
        (s + 8.0 * f64::from(self.tolerance)) as f32 * (1.0 + 4.0 * f32::EPSILON)
    }
}

/// The greater of two numbers, or the second if the first is none; one instruction, unlike `max`.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// One over a slope, bounded.
#[inline(always)]
fn inverse(slope: f64) -> f64 {
    greater(slope.abs(), LEAST_SLOPE).copysign(slope).recip()
}
