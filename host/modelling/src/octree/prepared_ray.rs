//! A ray as the cells see it: in local coordinates, from where it enters the cube, in single precision.

use super::clip::FAT;
use super::code::{LocationalCode, MAX_DEPTH};
use super::cube::Cube;
use crate::numeric::ray::Ray;
use crate::numeric::triangle::{Shear, four};
use wide::f64x4;

/// Rounding of a point on the ray and of what it is compared with in single precision, twice what it can be.
///
/// A corner of a triangle and the length to it are each off by 2^-25, the slope by as much, what is taken from it by
/// 2^-24, the difference by 2^-24 and the product by 2^-25: 2^-22 in all. A side of a box is off by 2^-25, and the
/// length to it by two roundings and one of each product: less than 2^-22 too.
const SINGLE_TOLERANCE: f64 = 1.0 / (1_u32 << 21) as f64;

/// Rounding of a point on the ray in double precision, as a share of the distance from origin to cube.
const DOUBLE_TOLERANCE: f64 = 1.0 / (1_u64 << 48) as f64;

/// A ray that begins farther from the cube than this many of its sides misses: rounding moves it by a quarter of one.
pub const MAX_DISTANCE: f64 = (1_u64 << 46) as f64;

/// One over a slope counts as this above it in the box test; the ray leaves its line by less than 1e-19 of the cube.
const MOST_INVERSE: f64 = 1e20;

/// How far before its entry a ray is taken to begin, in tolerances.
const MARGIN: f64 = 4.0;

/// A ray prepared for what is in a cube.
#[derive(Clone, Debug)]
pub struct PreparedRay {
    /// The shear, which decides the triangles that it hits.
    pub shear: Shear,
    /// The part that counts.
    pub chord: Chord,
    /// The ray as tests in single precision need it.
    pub single: SinglePrecisionRay,
}

impl PreparedRay {
    /// `None` if the ray misses the cube between `t_min` and `t_max`, or is none.
    #[inline(always)]
    pub fn new(ray: &Ray, cube: &Cube, t_min: f64, t_max: f64) -> Option<Self> {
        let shear = Shear::new(ray, cube.unit())?;
        let chord = Chord::new(ray, &shear, cube, t_min, t_max)?;
        let frame = SinglePrecisionRay::new(&shear, &chord);
        Some(Self { shear, chord, single: frame })
    }
}

/// The part of a ray that is in the cube, as a line in local coordinates.
#[derive(Clone, Debug)]
pub struct Chord {
    origin: f64x4,
    /// One over the slope, by axis, bounded.
    inverse: f64x4,
    tolerance: f64,
    rate: f64,
    enter: f64,
    exit: f64,
}

impl Chord {
    /// `None` if a ray that was sheared before misses the cube between `t_min` and `t_max`.
    #[inline(always)]
    pub fn new(ray: &Ray, shear: &Shear, cube: &Cube, t_min: f64, t_max: f64) -> Option<Self> {
        let unit = cube.unit();
        let origin = four((ray.origin - cube.origin) * unit);
        let [x, y, z, _] = origin.abs().to_array();
        let reach = greater(greater(x, y), greater(z, 1.0));
        // Written so that what is not a number ends here.
        let near = reach <= MAX_DISTANCE;
        if !near {
            return None;
        }
        let tolerance = SINGLE_TOLERANCE + reach * DOUBLE_TOLERANCE;
        let rate = shear.longest() * unit;
        let direction = four(ray.direction);
        let steep = (f64x4::splat(shear.longest()) / direction.abs()).fast_min(f64x4::splat(MOST_INVERSE));
        let inverse = steep.copysign(direction);
        let margin = MARGIN * tolerance;
        // The middle of the cube, and how far it is from there to its sides.
        let middle = (f64x4::HALF - origin) * inverse;
        let half = f64x4::splat(0.5 + margin) * steep;
        let ([x, y, z, _], [to_x, to_y, to_z, _]) = ((middle - half).to_array(), (middle + half).to_array());
        let enter = greater(greater(x, y), greater(z, t_min * rate));
        let exit = lesser(lesser(to_x, to_y), lesser(to_z, t_max * rate));
        let meets = enter <= exit + margin && enter.is_finite() && exit.is_finite();
        meets.then_some(Self { origin, inverse, tolerance, rate, enter, exit })
    }

    /// Length of the ray in the cube, or to `t_max`.
    pub fn length(&self) -> f64 {
        self.exit - self.enter
    }

    /// Local coordinates where the ray enters the cube, or of its first point, by axis.
    #[inline(always)]
    pub fn entry(&self, shear: &Shear) -> f64x4 {
        self.origin + shear.slopes() * f64x4::splat(self.enter)
    }

    /// By how much a coordinate may be off in double precision, sides of the cube.
    pub fn double_tolerance(&self) -> f64 {
        self.tolerance - SINGLE_TOLERANCE
    }

    /// Whether the ray may hit a cube of the octree, in double precision; in doubt it may.
    pub fn may_meet(&self, shear: &Shear, cube: LocationalCode) -> bool {
        let voxel = 1.0 / f64::from(1_u32 << MAX_DEPTH);
        let margin = FAT + 4.0 * self.double_tolerance();
        let (mut enter, mut exit) = (-margin, self.length() + margin);
        let entry = self.entry(shear);
        for (axis, corner) in cube.corner().into_iter().enumerate() {
            let low = f64::from(corner) * voxel;
            let high = low + f64::from(cube.side()) * voxel;
            let along = |plane: f64| (plane - entry.as_array()[axis]) * self.inverse.as_array()[axis];
            let [to_low, to_high] = [low - margin, high + margin].map(along);
            enter = enter.max(to_low.min(to_high));
            exit = exit.min(to_low.max(to_high));
        }
        enter <= exit + margin
    }
}

/// A ray in the cube, for tests in single precision. Its points are `entry + s slope`, where s counts sides of the cube
/// along the longest axis.
///
/// Lengths in single precision are counted from a little before the entry, so that none that matters is negative.
#[derive(Clone, Debug)]
pub struct SinglePrecisionRay {
    /// The longest axis last, the others in cyclic order.
    pub axes: [usize; 3],
    /// Slopes over the longest axis as coordinates grow, by axis.
    pub shear: [f32; 4],
    /// Where the line of the ray hits the plane of zero of the longest axis, by axis.
    pub beside: [f32; 4],
    /// The sign of its direction along the longest axis times where it begins there.
    pub base_z: f32,
    /// 1 or -1: direction along the longest axis.
    pub sign_z: f32,
    /// By how much a coordinate may be off, sides of the cube.
    pub tolerance: f32,
    /// Factor from a tolerance and a size to the error of an edge function.
    pub error_scale: f32,
    /// One over the slope, by axis.
    pub inverse: [f32; 4],
    /// Summand that makes a coordinate times the inverse the length to the near side of a box, which is moved towards
    /// the ray by the tolerance; by axis.
    pub near: [f32; 4],
    /// Summand that makes a coordinate times the inverse the length to the far side of a box, which is moved away by
    /// the tolerance; by axis.
    pub far: [f32; 4],
    /// Whether the ray goes down, by axis.
    pub down: [bool; 3],
    /// Length of the ray in the cube, or to `t_max`.
    length: f64,
    rate: f64,
    offset: f64,
}

impl SinglePrecisionRay {
    /// Prepares a part of a ray that was sheared before.
    #[inline(always)]
    pub fn new(shear: &Shear, chord: &Chord) -> Self {
        let Chord { origin, inverse, tolerance, enter, .. } = *chord;
        let (slopes, axes) = (shear.slopes(), shear.axes());
        let sign_z = 1.0_f64.copysign(shear.length_z());
        let origin_z = origin.as_array()[axes[2]] * sign_z;
        // Where lengths are counted from.
        let first = enter - MARGIN * tolerance;
        let (length, aside) = (origin * inverse, inverse.abs() * f64x4::splat(tolerance));
        let [x, y, z, _] = inverse.to_array();
        Self {
            axes,
            shear: single(slopes * f64x4::splat(sign_z)),
            beside: single(origin - slopes * f64x4::splat(origin_z)),
            base_z: (origin_z + first) as f32,
            sign_z: sign_z as f32,
            tolerance: tolerance as f32,
            error_scale: (16.0 * tolerance) as f32,
            inverse: single(inverse),
            near: single(f64x4::splat(-first) - (length + aside)),
            far: single(f64x4::splat(-first) - (length - aside)),
            down: [x.is_sign_negative(), y.is_sign_negative(), z.is_sign_negative()],
            length: chord.length(),
            rate: chord.rate,
            offset: chord.enter,
        }
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

/// The lesser of two numbers, or the second if the first is none.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// In single precision.
#[inline(always)]
fn single(numbers: f64x4) -> [f32; 4] {
    let [x, y, z, w] = numbers.to_array();
    [x as f32, y as f32, z as f32, w as f32]
}
