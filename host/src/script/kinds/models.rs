//! Kinds of what procedural models take.

use super::numbers::number;
use super::vectors::vector;
use super::words::TextKind;
use crate::numeric::bounds::Bounds;
use crate::procedural::Varied;
use crate::procedural::plant::{STEM_PARAMETERS, TREE_PARAMETERS, TreeParameter};
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

/// The name of something that ships with the program, or a file.
#[derive(Clone, Copy)]
pub(in crate::script) struct NameOrFile {
    /// The names.
    pub(in crate::script) names: fn() -> Vec<&'static str>,
    /// How the names of files end.
    pub(in crate::script) ending: &'static str,
}

/// Numbers of plants by name, each of which may differ from one kind to the next.
#[derive(Clone, Copy)]
pub(in crate::script) struct PlantNumbers;

impl ParameterKind for NameOrFile {
    type Value = String;

    fn words(&self) -> String {
        format!("a file that ends in {}, or one of {}", self.ending, (self.names)().join(", "))
    }

    fn read(&self, value: &Dynamic) -> Option<String> {
        TextKind.read(value)
    }
}

impl ParameterKind for PlantNumbers {
    type Value = Vec<(String, Dynamic)>;

    fn words(&self) -> String {
        let names = |rows: &[TreeParameter]| rows.iter().map(|row| row.name).collect::<Vec<_>>().join(", ");
        format!(
            "a map #{{ height: [12, 2], length_1: 0.4 }} of {}, and of each level of stems, with its number behind the \
             name, {}",
            names(TREE_PARAMETERS),
            names(STEM_PARAMETERS)
        )
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<(String, Dynamic)>> {
        VariedMap.read(value)
    }
}

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
