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
    /// 1 where the ray goes down, by axis.
    pub down: [usize; 3],
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
    #[inline]
    pub fn new(ray: &Ray, shear: &Shear, cube: &Cube, t_min: f64, t_max: f64) -> Option<Self> {
        let axes = shear.axes();
        let [x, y, z] = axes;
        let [slope_x, slope_y] = shear.slopes();
        let length_z = ray.direction[z];
        let sign_z = 1.0_f64.copysign(length_z);
        let mut slopes = [0.0; 3];
        (slopes[x], slopes[y], slopes[z]) = (slope_x * sign_z, slope_y * sign_z, sign_z);
        let unit = cube.side.recip();
        let origin = ((ray.origin - cube.origin) * unit).to_array();
        let reach = origin.iter().fold(1.0_f64, |reach, x| reach.max(x.abs()));
        // Written so that what is not a number ends here.
        let near = reach <= MAX_DISTANCE;
        if !near {
            return None;
        }
        let double_tolerance = reach * DOUBLE_TOLERANCE;
        let tolerance = SINGLE_TOLERANCE + double_tolerance;

        let rate = length_z.abs() * unit;
        let inverse = slopes.map(inverse);
        let margin = 4.0 * tolerance;
        let (mut enter, mut exit) = (t_min * rate, t_max * rate);
        for axis in 0..3 {
            let to_low = (-margin - origin[axis]) * inverse[axis];
            let to_high = (1.0 + margin - origin[axis]) * inverse[axis];
            enter = enter.max(to_low.min(to_high));
            exit = exit.min(to_low.max(to_high));
        }
        let meets = enter <= exit + margin && enter.is_finite() && exit.is_finite();
        if !meets {
            return None;
        }
        let entry = [0, 1, 2].map(|axis| origin[axis] + slopes[axis] * enter);
        let first = [0, 1, 2].map(|axis| entry[axis] - slopes[axis] * margin);
        let side = |towards: f64| {
            let moved = |axis: usize| first[axis] + tolerance.copysign(slopes[axis]) * towards;
            [0, 1, 2].map(|axis| (moved(axis) * inverse[axis]) as f32)
        };
        let base = [first[x] - slope_x * first[z], first[y] - slope_y * first[z], first[z] * sign_z];
        Some(Self {
            axes,
            shear: [slope_x as f32, slope_y as f32],
            base: base.map(|x| x as f32),
            sign_z: sign_z as f32,
            tolerance: tolerance as f32,
            error_scale: (16.0 * tolerance) as f32,
            inverse: inverse.map(|x| x as f32),
            near: side(1.0),
            far: side(-1.0),
            down: slopes.map(|slope| usize::from(slope.is_sign_negative())),
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
        self.limit_of((t * self.rate - self.offset).min(self.length))
    }

    /// A bound for single-precision lengths that stand for `s`, rounded up.
    #[inline]
    pub fn limit_of(&self, s: f64) -> f32 {
        (s + 8.0 * f64::from(self.tolerance)) as f32 * (1.0 + 4.0 * f32::EPSILON)
    }
}

/// One over a slope, bounded.
fn inverse(slope: f64) -> f64 {
    if slope.abs() < LEAST_SLOPE { LEAST_SLOPE.recip().copysign(slope) } else { slope.recip() }
}
