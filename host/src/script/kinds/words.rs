//! Kinds of words, flags, objects, and values of several kinds.

use super::numbers::{NumberKind, number};
use crate::script::handle::Handle;
use crate::script::parameter::{HasDefault, ParameterKind};
use rhai::{Dynamic, ImmutableString};

/// An object that another function returned; before the dot in `object.function(...)`.
#[derive(Clone, Copy)]
pub(in crate::script) struct ObjectKind;

/// A string.
#[derive(Clone, Copy)]
pub(in crate::script) struct TextKind;

/// true or false.
#[derive(Clone, Copy)]
pub(in crate::script) struct Flag;

/// A number, a whole number, true or false, or a string.
#[derive(Clone, Copy)]
pub(in crate::script) struct ScalarKind;

/// A number within limits, or a string.
#[derive(Clone, Copy)]
pub(in crate::script) struct NumberOrText(pub(in crate::script) f64, pub(in crate::script) f64);

/// What a number or a string becomes.
pub(in crate::script) enum NumberOrTextValue {
    Number(f64),
    Text(String),
}

/// One of some words, each with what it stands for.
#[derive(Clone, Copy)]
pub(in crate::script) struct Word<T: 'static>(pub(in crate::script) &'static [(&'static str, T)]);

impl ParameterKind for ObjectKind {
    type Value = Handle;
    const IS_OBJECT: bool = true;

    fn words(&self) -> String {
        "an object".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Handle> {
        value.read_lock::<Handle>().map(|handle| *handle)
    }
}

impl ParameterKind for TextKind {
    type Value = String;

    fn words(&self) -> String {
        "a string".into()
    }

    fn read(&self, value: &Dynamic) -> Option<String> {
        value.read_lock::<ImmutableString>().map(|text| text.to_string())
    }
}

impl ParameterKind for Flag {
    type Value = bool;

    fn words(&self) -> String {
        "true or false".into()
    }

    fn read(&self, value: &Dynamic) -> Option<bool> {
        value.as_bool().ok()
    }
}

impl ParameterKind for ScalarKind {
    type Value = Dynamic;

    fn words(&self) -> String {
        "a number, true or false, or a string".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Dynamic> {
        let is_scalar = value.is_bool() || value.is_string() || number(value).is_some();
        is_scalar.then(|| value.clone())
    }
}

impl ParameterKind for NumberOrText {
    type Value = NumberOrTextValue;

    fn words(&self) -> String {
        format!("{} or a string", NumberKind(self.0, self.1).words())
    }

    fn read(&self, value: &Dynamic) -> Option<NumberOrTextValue> {
        let number = NumberKind(self.0, self.1).read(value).map(NumberOrTextValue::Number);
        number.or_else(|| TextKind.read(value).map(NumberOrTextValue::Text))
    }
}

impl<T: Copy> ParameterKind for Word<T> {
    type Value = T;

    fn words(&self) -> String {
        self.0.iter().map(|(word, _)| format!("{word:?}")).collect::<Vec<_>>().join(" or ")
    }

    fn read(&self, value: &Dynamic) -> Option<T> {
        let text = value.read_lock::<ImmutableString>()?;
        self.0.iter().find(|(word, _)| text.as_str() == *word).map(|(_, meant)| *meant)
    }
}

impl HasDefault for TextKind {
    type Default = &'static str;

    fn of_default(&self, default: &'static str) -> String {
        default.into()
    }

    fn shown(&self, default: &'static str) -> String {
        format!("{default:?}")
    }
}

impl HasDefault for Flag {
    type Default = bool;

    fn of_default(&self, default: bool) -> bool {
        default
    }

    fn shown(&self, default: bool) -> String {
        default.to_string()
    }
}

impl<T: Copy + PartialEq> HasDefault for Word<T> {
    type Default = T;

    fn of_default(&self, default: T) -> T {
        default
    }

    fn shown(&self, default: T) -> String {
        let word = self.0.iter().find(|(_, meant)| *meant == default).map(|(word, _)| *word);
        format!("{:?}", word.unwrap_or_default())
    }
}
