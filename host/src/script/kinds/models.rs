//! Kinds of what procedural models take.

use super::numbers::number;
use super::vectors::vector;
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::script::parameter::{HasDefault, ParameterKind};
use rhai::{Array, Dynamic, FnPtr, Map};

/// A function of the script that makes objects.
#[derive(Clone, Copy)]
pub(in crate::script) struct ModelFunction;

/// A box along the axes that has a size.
#[derive(Clone, Copy)]
pub(in crate::script) struct BoundsKind;

/// A number that differs from one kind of a model to the next.
#[derive(Clone, Copy)]
pub(in crate::script) struct VariedKind;

/// Values by name, each of which may differ from one kind of a model to the next; see [`VariedKind`].
#[derive(Clone, Copy)]
pub(in crate::script) struct VariedMap;

impl ParameterKind for ModelFunction {
    type Value = FnPtr;

    fn words(&self) -> String {
        "a function of one parameter, as |p| { ... } or Fn(\"name\")".into()
    }

    fn read(&self, value: &Dynamic) -> Option<FnPtr> {
        value.read_lock::<FnPtr>().map(|function| function.clone())
    }
}

impl ParameterKind for BoundsKind {
    type Value = Bounds;

    fn words(&self) -> String {
        "two corners of a box [[x, y, z], [x, y, z]], first that of the least coordinates".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Bounds> {
        match value.read_lock::<Array>()?.as_slice() {
            [min, max] => Some(Bounds { min: vector(min)?, max: vector(max)? })
                .filter(|Bounds { min, max }| min.cmple(*max).all() && min != max),
            _ => None,
        }
    }
}

impl ParameterKind for VariedKind {
    type Value = Varied;

    fn words(&self) -> String {
        "a number, or two [mean, deviation] of which the deviation is not below 0".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Varied> {
        if let Some(mean) = number(value) {
            return Some(Varied { mean, deviation: 0.0 });
        }
        match value.read_lock::<Array>()?.as_slice() {
            [mean, deviation] => Some(Varied { mean: number(mean)?, deviation: number(deviation)? })
                .filter(|varied| varied.check().is_ok()),
            _ => None,
        }
    }
}

impl ParameterKind for VariedMap {
    type Value = Vec<(String, Dynamic)>;

    fn words(&self) -> String {
        "a map of numbers and of pairs #{ size: 2, lean: [mean, deviation] }".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<(String, Dynamic)>> {
        let map = value.read_lock::<Map>()?;
        Some(map.iter().map(|(name, value)| (name.to_string(), value.clone())).collect())
    }
}

impl HasDefault for VariedKind {
    type Default = [f64; 2];

    fn of_default(&self, [mean, deviation]: [f64; 2]) -> Varied {
        Varied { mean, deviation }
    }

    fn shown(&self, default: [f64; 2]) -> String {
        format!("{default:?}")
    }
}
