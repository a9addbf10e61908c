//! Kinds of what is placed many times, and where.

use super::lists::each;
use super::numbers::{Integer, NumberKind, number};
use super::vectors::{AxisKind, Factors, Vector, vector};
use super::words::ObjectKind;
use crate::script::handle::Handle;
use crate::script::parameter::ParameterKind;
use glam::{DAffine3, DMat3, DVec3};
use rhai::{Array, Dynamic, Map};

/// An object, or a list of objects that stay together, or a list of such lists.
#[derive(Clone, Copy)]
pub(in crate::script) struct ObjectGroups;

/// Places: points, or maps of how to place.
#[derive(Clone, Copy)]
pub(in crate::script) struct PlacesKind;

/// A place as a script tells it.
pub(in crate::script) struct PlaceValue {
    pub(in crate::script) placement: DAffine3,
    /// The number of its group, where there are several.
    pub(in crate::script) which: u16,
    /// 0 to 1; none where it is drawn.
    pub(in crate::script) variation: Option<f64>,
}

impl ParameterKind for ObjectGroups {
    type Value = Vec<Vec<Handle>>;

    fn words(&self) -> String {
        "an object, a list of objects that stay together, or a list of such lists".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Vec<Handle>>> {
        let group = |value: &Dynamic| {
            let alone = ObjectKind.read(value).map(|alone| vec![alone]);
            alone.or_else(|| each(value, |object| ObjectKind.read(object))).filter(|group| !group.is_empty())
        };
        let one = group(value).map(|one| vec![one]);
        one.or_else(|| each(value, group)).filter(|groups| !groups.is_empty())
    }
}

impl ParameterKind for PlacesKind {
    type Value = Vec<PlaceValue>;

    fn words(&self) -> String {
        "a list of points [x, y, z], or of maps #{ at: [x, y, z], axis: \"y\", turn: degrees, scale: factor, \
         matrix: [three columns], which: number of the group, variation: 0 to 1 }"
            .into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<PlaceValue>> {
        each(value, place)
    }
}

fn place(value: &Dynamic) -> Option<PlaceValue> {
    if let Some(at) = vector(value) {
        return Some(PlaceValue { placement: DAffine3::from_translation(at), which: 0, variation: None });
    }
    let map = value.read_lock::<Map>()?;
    let (mut at, mut axis, mut turn, mut scale) = (DVec3::ZERO, DVec3::Y, 0.0, DVec3::ONE);
    let (mut matrix, mut which, mut variation) = (DMat3::IDENTITY, 0, None);
    for (name, value) in map.iter() {
        match name.as_str() {
            "at" => at = Vector.read(value)?,
            "axis" => axis = AxisKind.read(value)?,
            "turn" => turn = number(value)?,
            "scale" => scale = Factors.read(value)?,
            "matrix" => matrix = columns(value)?,
            "which" => which = Integer(0, u16::MAX).read(value)?,
            "variation" => variation = Some(NumberKind(0.0, 1.0).read(value)?),
            _ => return None,
        }
    }
    let matrix3 = matrix * DMat3::from_axis_angle(axis, turn.to_radians()) * DMat3::from_diagonal(scale);
    Some(PlaceValue { placement: DAffine3 { matrix3, translation: at }, which, variation })
}

fn columns(value: &Dynamic) -> Option<DMat3> {
    match value.read_lock::<Array>()?.as_slice() {
        [x, y, z] => Some(DMat3::from_cols(vector(x)?, vector(y)?, vector(z)?)),
        _ => None,
    }
}
