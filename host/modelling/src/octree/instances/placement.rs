//! Where an instance stands, and how few bytes say so.

use super::super::cube::Cube;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

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
    /// Any affine map, in 52 bytes: positions are rounded to 2^-32 of the cube around all, the rest to single precision.
    Affine,
    /// Any affine map as it is, in 104 bytes: for the few that hold many.
    Exact,
}

impl PlacementForm {
    /// Bytes of one placement.
    pub const fn bytes(self) -> usize {
        match self {
            PlacementForm::Similar => size_of::<SimilarPlacement>(),
            PlacementForm::Affine => size_of::<AffinePlacement>(),
            PlacementForm::Exact => size_of::<Instance>(),
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
/// Scales lie within so many octaves on both sides of 1.
pub(super) const MOST_OCTAVES: f64 = 31.0;

fn packed_position(cube: &Cube, at: DVec3) -> [u32; 3] {
    (cube.local(at) * POSITIONS).round().to_array().map(|x| x.clamp(0.0, POSITIONS - 1.0) as u32)
}

fn position(cube: &Cube, [x, y, z]: [u32; 3]) -> DVec3 {
    cube.origin + DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * (cube.side / POSITIONS)
}

/// A placement by position, rotation and scale.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct SimilarPlacement {
    position: [u32; 3],
    /// Three components of a unit quaternion, 15 bits each; then which one is left out, and whether it is mirrored.
    rotation: [u16; 3],
    /// The logarithm of the scale.
    scale: i16,
    prototype: u16,
    variation: u16,
}

/// A placement by an affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct AffinePlacement {
    position: [u32; 3],
    columns: [f32; 9],
    prototype: u16,
    variation: u16,
}

impl SimilarPlacement {
    fn new(cube: &Cube, instance: &Instance) -> SimilarPlacement {
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
            position: packed_position(cube, instance.placement.translation),
            rotation: [0, 16, 32].map(|shift| (bits >> shift) as u16),
            scale: (octaves * OCTAVE).round() as i16,
            prototype: instance.prototype,
            variation: instance.variation,
        }
    }

    fn rotation_and_sign(&self) -> (DQuat, f64) {
        let mut bits = self.rotation.iter().rev().fold(0_u64, |bits, part| bits << 16 | u64::from(*part));
        let mut others = [0.0; 3];
        for other in others.iter_mut().rev() {
            let step = (bits & ((1 << STEP_BITS) - 1)) as f64 - STEPS;
            *other = step / (STEPS * std::f64::consts::SQRT_2);
            bits >>= STEP_BITS;
        }
        let left_out = bits as usize & 3;
        let largest = (1.0 - others.iter().map(|other| other * other).sum::<f64>()).max(0.0).sqrt();
        let mut all = [0.0; 4];
        all[left_out] = largest;
        (0..4).filter(|i| *i != left_out).zip(others).for_each(|(i, other)| all[i] = other);
        (DQuat::from_array(all).normalize(), if bits & 4 == 0 { 1.0 } else { -1.0 })
    }

    fn scale(&self) -> f64 {
        let (octaves, part) = (i32::from(self.scale >> 10), self.scale as usize & (OCTAVE_STEPS - 1));
        SCALES[part] * f64::from_bits(((octaves + 1023) as u64) << 52)
    }

    fn instance(&self, cube: &Cube) -> Instance {
        let (rotation, sign) = self.rotation_and_sign();
        let matrix3 = DMat3::from_quat(rotation) * (sign * self.scale());
        let placement = DAffine3 { matrix3, translation: position(cube, self.position) };
        Instance { prototype: self.prototype, variation: self.variation, placement }
    }
}

impl AffinePlacement {
    fn new(cube: &Cube, instance: &Instance) -> AffinePlacement {
        AffinePlacement {
            position: packed_position(cube, instance.placement.translation),
            columns: instance.placement.matrix3.to_cols_array().map(|x| x as f32),
            prototype: instance.prototype,
            variation: instance.variation,
        }
    }

    fn instance(&self, cube: &Cube) -> Instance {
        let matrix3 = DMat3::from_cols_array(&self.columns.map(f64::from));
        let placement = DAffine3 { matrix3, translation: position(cube, self.position) };
        Instance { prototype: self.prototype, variation: self.variation, placement }
    }
}

/// The scales of one octave from 1 on: a table, since a ray asks for those of many instances.
static SCALES: LazyLock<[f64; OCTAVE_STEPS]> =
    LazyLock::new(|| std::array::from_fn(|step| (step as f64 / OCTAVE).exp2()));

/// A bound of where an instance is, which is found sooner than its placement.
pub(super) struct InstanceBound {
    pub(super) prototype: u16,
    /// Where the origin of the prototype is.
    pub(super) origin: DVec3,
    /// No vector becomes more times as long.
    pub(super) longer: f64,
}

/// Placements in a cube around their positions, in the order in which they were added.
#[derive(Clone, Debug)]
pub(super) enum Placements {
    Similar(Vec<SimilarPlacement>),
    Affine(Vec<AffinePlacement>),
    Exact(Vec<Instance>),
}

impl Placements {
    /// None yet, with memory for so many.
    pub(super) fn with_capacity(form: PlacementForm, count: usize) -> Placements {
        match form {
            PlacementForm::Similar => Placements::Similar(Vec::with_capacity(count)),
            PlacementForm::Affine => Placements::Affine(Vec::with_capacity(count)),
            PlacementForm::Exact => Placements::Exact(Vec::with_capacity(count)),
        }
    }

    pub(super) fn push(&mut self, cube: &Cube, instance: &Instance) {
        match self {
            Placements::Similar(all) => all.push(SimilarPlacement::new(cube, instance)),
            Placements::Affine(all) => all.push(AffinePlacement::new(cube, instance)),
            Placements::Exact(all) => all.push(*instance),
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Placements::Similar(all) => all.len(),
            Placements::Affine(all) => all.len(),
            Placements::Exact(all) => all.len(),
        }
    }

    /// An instance as it was rounded.
    #[inline]
    pub(super) fn get(&self, cube: &Cube, number: usize) -> Instance {
        match self {
            Placements::Similar(all) => all[number].instance(cube),
            Placements::Affine(all) => all[number].instance(cube),
            Placements::Exact(all) => all[number],
        }
    }

    /// A bound of where an instance is.
    #[inline]
    pub(super) fn bound(&self, cube: &Cube, number: usize) -> InstanceBound {
        match self {
            Placements::Similar(all) => {
                let placement = &all[number];
                let (origin, longer) = (position(cube, placement.position), placement.scale());
                InstanceBound { prototype: placement.prototype, origin, longer }
            }
            Placements::Affine(all) => {
                let AffinePlacement { columns, prototype, .. } = all[number];
                let origin = position(cube, all[number].position);
                let longer = longest(&DMat3::from_cols_array(&columns.map(f64::from)));
                InstanceBound { prototype, origin, longer }
            }
            Placements::Exact(all) => {
                let Instance { prototype, placement, .. } = all[number];
                InstanceBound { prototype, origin: placement.translation, longer: longest(&placement.matrix3) }
            }
        }
    }
}

/// An instance as it is kept.
pub(super) fn rounded(form: PlacementForm, cube: &Cube, instance: &Instance) -> Instance {
    match form {
        PlacementForm::Similar => SimilarPlacement::new(cube, instance).instance(cube),
        PlacementForm::Affine => AffinePlacement::new(cube, instance).instance(cube),
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
    fn placements_take_as_many_bytes_as_their_form_tells() {
        let forms = [PlacementForm::Similar, PlacementForm::Affine, PlacementForm::Exact];
        assert_eq!(forms.map(PlacementForm::bytes), [24, 52, 104]);
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
                let kept = rounded(form, &cube(), &given);
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
            let kept = rounded(PlacementForm::Similar, &cube(), &Instance { prototype: 0, variation: 0, placement });
            assert_eq!(kept.placement.matrix3, matrix3);
        }
    }
}
