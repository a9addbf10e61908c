//! Where an instance stands, and how few bytes say so.

use super::super::cube::Cube;
use crate::numeric::bounds::Bounds;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// An instance: something that is placed, and how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instance {
    /// Number of what is placed, in the list of prototypes.
    pub prototype: u16,
    /// A number by which instances of one prototype may differ: in hue, age or phase.
    pub variation: u16,
    /// From coordinates of the prototype to those of the instance tree.
    pub placement: DAffine3,
}

/// How exactly placements are kept, and in how many bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlacementForm {
    /// A rotation, a scale and a position, in 24 bytes: for what is scattered.
    ///
    /// Positions are rounded to 2^-32 of the cube around all, angles to 1e-4, scales to a part in 2,900; no rotation and
    /// the scale 1 are exact. Only the rotation and the mean scale of a placement are kept, and whether it is mirrored.
    Similar,
    /// Any affine map, in 52 bytes: positions are rounded to 2^-32 of the cube around all, the inverse of the rest to
    /// single precision.
    Affine,
    /// Any affine map as it is, in 104 bytes: for the few that hold many.
    Exact,
}

impl PlacementForm {
    /// Bytes of one placement, of which eight stand together.
    pub const fn bytes(self) -> usize {
        match self {
            PlacementForm::Similar => 24,
            PlacementForm::Affine => 52,
            PlacementForm::Exact => 104,
        }
    }
}

/// Positions in the cube, by axis: so many parts of it.
const POSITIONS: f64 = 4_294_967_296.0;
/// Components of a rotation are kept in so many steps on both sides of 0.
const STEPS: f64 = 16_383.0;
/// Bits of one of them, with its sign.
const STEP_BITS: u32 = 15;
/// Scales are kept in so many steps of an octave, 2^10.
const OCTAVE_STEPS: usize = 1 << 10;
const OCTAVE: f64 = OCTAVE_STEPS as f64;
/// The root of 2, of which this many steps make an octave.
const STEP_OF_OCTAVE: f64 = 1.000_677_130_693_066_4;
/// Scales lie within so many octaves on both sides of 1.
pub(super) const MOST_OCTAVES: f64 = 31.0;

fn packed_position(cube: &Cube, at: DVec3) -> [u32; 3] {
    (cube.local(at) * POSITIONS).round().to_array().map(|x| x.clamp(0.0, POSITIONS - 1.0) as u32)
}

fn position(cube: &Cube, [x, y, z]: [u32; 3]) -> DVec3 {
    cube.origin + DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * (cube.side / POSITIONS)
}

/// The sphere around a prototype, in its coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrototypeSphere {
    pub(super) center: DVec3,
    /// Rounded up.
    pub(super) radius: f32,
}

/// A sphere is so much larger than it would be without rounding.
const SPHERE_ROUNDING: f64 = 1e-9;

impl PrototypeSphere {
    /// The sphere of a radius about the centre of a box.
    pub(super) fn new(bounds: &Bounds, radius: f64) -> PrototypeSphere {
        match bounds.is_empty() {
            true => PrototypeSphere { center: DVec3::ZERO, radius: 0.0 },
            false => PrototypeSphere {
                center: bounds.center(),
                radius: ((radius * (1.0 + SPHERE_ROUNDING)) as f32).next_up(),
            },
        }
    }
}

/// A placement by position, rotation and scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SimilarPlacement {
    /// Of the centre of the prototype.
    pub(super) position: [u32; 3],
    /// Three components of a unit quaternion, 15 bits each; then which one is left out, and whether it is mirrored.
    pub(super) rotation: [u16; 3],
    /// The logarithm of the scale.
    pub(super) scale: i16,
    pub(super) prototype: u16,
    pub(super) variation: u16,
}

/// A placement by an affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AffinePlacement {
    /// Of the centre of the prototype.
    pub(super) position: [u32; 3],
    /// The columns of the inverse map, which rays ask for.
    pub(super) inverse: [f32; 9],
    pub(super) prototype: u16,
    pub(super) variation: u16,
}

/// A placement as rays need it: where the centre of the prototype is, and the inverse of the map about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct OwnFrame {
    pub(super) center: DVec3,
    pub(super) inverse: DMat3,
}

impl SimilarPlacement {
    /// - `center`: of the prototype, in its coordinates.
    pub(super) fn new(cube: &Cube, instance: &Instance, center: DVec3) -> SimilarPlacement {
        let map = instance.placement.matrix3;
        let determinant = map.determinant();
        let scale = determinant.abs().cbrt();
        let octaves = scale.log2().clamp(-MOST_OCTAVES, MOST_OCTAVES);
        // A mirrored placement is one through the origin, rotated.
        let turned = DQuat::from_mat3(&(map * (determinant.signum() / scale))).normalize();
        let all = turned.to_array();
        let left_out = (0..4).fold(0, |most, i| if all[i].abs() > all[most].abs() { i } else { most });
        let sign = if all[left_out] < 0.0 { -1.0 } else { 1.0 };
        let step = |component: f64| (component * sign * std::f64::consts::SQRT_2 * STEPS).round() as i64;
        let mut bits = left_out as u64 | u64::from(determinant < 0.0) << 2;
        for component in (0..4).filter(|i| *i != left_out).map(|i| all[i]) {
            bits = bits << STEP_BITS | (step(component) + STEPS as i64) as u64;
        }
        SimilarPlacement {
            position: packed_position(cube, instance.placement.transform_point3(center)),
            rotation: [0, 16, 32].map(|shift| (bits >> shift) as u16),
            scale: (octaves * OCTAVE).round() as i16,
            prototype: instance.prototype,
            variation: instance.variation,
        }
    }

    /// The rotation, and 1 or, where it is mirrored, -1.
    #[inline(always)]
    fn rotation_and_sign(&self) -> (DQuat, f64) {
        let mut bits = self.rotation.iter().rev().fold(0_u64, |bits, part| bits << 16 | u64::from(*part));
        const MASK: u64 = (1 << STEP_BITS) - 1;
        const STEP: f64 = std::f64::consts::FRAC_1_SQRT_2 / STEPS;
        let component = |bits: u64| ((bits & MASK) as f64 - STEPS) * STEP;
        let (c, b, a) = (component(bits), component(bits >> STEP_BITS), component(bits >> (2 * STEP_BITS)));
        bits >>= 3 * STEP_BITS;
        let largest = (1.0 - (a * a + b * b + c * c)).max(0.0).sqrt();
        // Looked up, since which one it is cannot be foreseen: a branch would be taken wrong most of the time.
        let (parts, order) = ([a, b, c, largest], &ORDER[(bits & 3) as usize]);
        let all = order.map(|place| parts[usize::from(place & 3)]);
        let sign = f64::from_bits(1.0_f64.to_bits() | (bits & 4) << 61);
        (DQuat::from_array(all), sign)
    }

    pub(super) fn instance(&self, cube: &Cube, center: DVec3) -> Instance {
        let (rotation, sign) = self.rotation_and_sign();
        let matrix3 = DMat3::from_quat(rotation) * (sign * power(self.scale));
        placed(matrix3, position(cube, self.position), center, self.prototype, self.variation)
    }

    #[inline(always)]
    pub(super) fn frame(&self, cube: &Cube) -> OwnFrame {
        let (rotation, sign) = self.rotation_and_sign();
        let inverse = DMat3::from_quat(rotation).transpose() * (sign * power(-self.scale));
        OwnFrame { center: position(cube, self.position), inverse }
    }
}

impl AffinePlacement {
    /// - `center`: of the prototype, in its coordinates.
    pub(super) fn new(cube: &Cube, instance: &Instance, center: DVec3) -> AffinePlacement {
        AffinePlacement {
            position: packed_position(cube, instance.placement.transform_point3(center)),
            inverse: instance.placement.matrix3.inverse().to_cols_array().map(|x| x as f32),
            prototype: instance.prototype,
            variation: instance.variation,
        }
    }

    pub(super) fn instance(&self, cube: &Cube, center: DVec3) -> Instance {
        let OwnFrame { center: at, inverse } = self.frame(cube);
        placed(inverse.inverse(), at, center, self.prototype, self.variation)
    }

    #[inline(always)]
    pub(super) fn frame(&self, cube: &Cube) -> OwnFrame {
        OwnFrame {
            center: position(cube, self.position),
            inverse: DMat3::from_cols_array(&self.inverse.map(f64::from)),
        }
    }
}

/// The instance that brings the centre of a prototype to a place.
fn placed(matrix3: DMat3, at: DVec3, center: DVec3, prototype: u16, variation: u16) -> Instance {
    Instance { prototype, variation, placement: DAffine3 { matrix3, translation: at - matrix3 * center } }
}

/// Where the components of a rotation stand among those that are kept and the largest, by which one is left out.
const ORDER: [[u8; 4]; 4] = [[3, 0, 1, 2], [0, 3, 1, 2], [0, 1, 3, 2], [0, 1, 2, 3]];

/// The scale that so many steps make.
#[inline(always)]
fn power(steps: i16) -> f64 {
    let (octaves, part) = (i32::from(steps >> 10), steps as usize & (OCTAVE_STEPS - 1));
    SCALES[part] * f64::from_bits(((octaves + 1023) as u64) << 52)
}

/// The scales of one octave from 1 on: a table, since a ray asks for those of many instances.
static SCALES: [f64; OCTAVE_STEPS] = {
    let mut scales = [1.0; OCTAVE_STEPS];
    let mut step = 1;
    while step < OCTAVE_STEPS {
        scales[step] = scales[step - 1] * STEP_OF_OCTAVE;
        step += 1;
    }
    scales
};

/// An instance as it is kept.
///
/// - `center`: of its prototype.
pub(super) fn rounded(form: PlacementForm, cube: &Cube, instance: &Instance, center: DVec3) -> Instance {
    match form {
        PlacementForm::Similar => SimilarPlacement::new(cube, instance, center).instance(cube, center),
        PlacementForm::Affine => AffinePlacement::new(cube, instance, center).instance(cube, center),
        PlacementForm::Exact => *instance,
    }
}

/// No vector becomes more times as long by a map: the Frobenius norm.
pub(super) fn longest(map: &DMat3) -> f64 {
    (map.x_axis.length_squared() + map.y_axis.length_squared() + map.z_axis.length_squared()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::{RandomStream, sphere};

    fn cube() -> Cube {
        Cube::around(DVec3::splat(-1000.0), DVec3::splat(3000.0))
    }

    #[test]
    fn placements_are_kept_within_the_rounding_that_their_form_tells() {
        let mut random = RandomStream::new(7, 0);
        for case in 0..2000 {
            let axis = sphere(random.point());
            let rotation = DQuat::from_axis_angle(axis, random.uniform() * 7.0);
            let scale = (random.uniform() * 40.0 - 20.0).exp2() * if case % 2 == 0 { 1.0 } else { -1.0 };
            let translation = DVec3::new(random.uniform(), random.uniform(), random.uniform()) * 4000.0 - 1000.0;
            let placement = DAffine3 { matrix3: DMat3::from_quat(rotation) * scale, translation };
            let given = Instance { prototype: 3, variation: case, placement };
            for (form, most) in
                [(PlacementForm::Similar, 4e-4), (PlacementForm::Affine, 1e-7), (PlacementForm::Exact, 0.0)]
            {
                let kept = rounded(form, &cube(), &given, DVec3::ZERO);
                assert_eq!((kept.prototype, kept.variation), (3, case));
                assert!((kept.placement.translation - translation).abs().max_element() <= 4096.0 / POSITIONS);
                let off = kept.placement.matrix3 - placement.matrix3;
                let largest = off.to_cols_array().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                assert!(largest <= most * scale.abs(), "{form:?} {case}: {}", largest / scale.abs());
            }
        }
    }

    #[test]
    fn no_rotation_and_the_scale_one_are_exact() {
        for matrix3 in [DMat3::IDENTITY, DMat3::IDENTITY * 2.0, DMat3::IDENTITY * -0.5] {
            let placement = DAffine3 { matrix3, translation: DVec3::ZERO };
            let kept = rounded(
                PlacementForm::Similar,
                &cube(),
                &Instance { prototype: 0, variation: 0, placement },
                DVec3::ZERO,
            );
            assert_eq!(kept.placement.matrix3, matrix3);
        }
    }
}
