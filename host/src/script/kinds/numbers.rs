//! Kinds of numbers.

use crate::script::parameter::{HasDefault, ParameterKind};
use rhai::{Array, Dynamic};
use std::fmt::Display;

/// A number within limits, the least and the greatest; infinite ones are none.
#[derive(Clone, Copy)]
pub(in crate::script) struct NumberKind(pub(in crate::script) f64, pub(in crate::script) f64);

/// Two numbers within limits, the first not above the second; one number stands for both.
#[derive(Clone, Copy)]
pub(in crate::script) struct RangeKind(pub(in crate::script) f64, pub(in crate::script) f64);

/// A length above 0.
#[derive(Clone, Copy)]
pub(in crate::script) struct Length;

/// A whole number within limits, the least and the greatest.
#[derive(Clone, Copy)]
pub(in crate::script) struct Integer<T>(pub(in crate::script) T, pub(in crate::script) T);

/// Any finite number.
pub(in crate::script) const ANY_NUMBER: NumberKind = NumberKind(f64::NEG_INFINITY, f64::INFINITY);

impl ParameterKind for NumberKind {
    type Value = f64;

    fn words(&self) -> String {
        match *self {
            NumberKind(min, max) if max.is_infinite() && min.is_infinite() => "a number".into(),
            NumberKind(min, max) if max.is_infinite() => format!("a number not below {min}"),
            NumberKind(min, max) => format!("a number from {min} to {max}"),
        }
    }

    fn read(&self, value: &Dynamic) -> Option<f64> {
        number(value).filter(|x| (self.0..=self.1).contains(x))
    }
}

impl ParameterKind for RangeKind {
    type Value = [f64; 2];

    fn words(&self) -> String {
        format!("{}, or two [least, most]", NumberKind(self.0, self.1).words())
    }

    fn read(&self, value: &Dynamic) -> Option<[f64; 2]> {
        let kind = NumberKind(self.0, self.1);
        if let Some(both) = kind.read(value) {
            return Some([both; 2]);
        }
        match value.read_lock::<Array>()?.as_slice() {
            [least, most] => Some([kind.read(least)?, kind.read(most)?]).filter(|[least, most]| least <= most),
            _ => None,
        }
    }
}

impl ParameterKind for Length {
    type Value = f64;

    fn words(&self) -> String {
        "a length above 0".into()
    }

    fn read(&self, value: &Dynamic) -> Option<f64> {
        number(value).filter(|x| *x > 0.0)
    }
}

impl<T: TryFrom<i64> + PartialOrd + Copy + Display> ParameterKind for Integer<T> {
    type Value = T;

    fn words(&self) -> String {
        format!("a whole number from {} to {}", self.0, self.1)
    }

    fn read(&self, value: &Dynamic) -> Option<T> {
        let whole = T::try_from(value.as_int().ok()?).ok();
        whole.filter(|whole| (self.0..=self.1).contains(whole))
    }
}

impl HasDefault for NumberKind {
    type Default = f64;

    fn of_default(&self, default: f64) -> f64 {
        default
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl HasDefault for RangeKind {
    type Default = [f64; 2];

    fn of_default(&self, default: [f64; 2]) -> [f64; 2] {
        default
    }

    fn shown(&self, [least, most]: [f64; 2]) -> String {
        if least == most { shown(least) } else { format!("[{}, {}]", shown(least), shown(most)) }
    }
}

impl HasDefault for Length {
    type Default = f64;

    fn of_default(&self, default: f64) -> f64 {
        default
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl<T: TryFrom<i64> + PartialOrd + Copy + Display> HasDefault for Integer<T> {
    type Default = T;

    fn of_default(&self, default: T) -> T {
        default
    }

    fn shown(&self, default: T) -> String {
        default.to_string()
    }
}

/// A finite number.
pub(in crate::script) fn number(value: &Dynamic) -> Option<f64> {
    value.as_float().ok().or_else(|| value.as_int().ok().map(|i| i as f64)).filter(|x| x.is_finite())
}

/// A number as a script would write it.
pub(super) fn shown(number: f64) -> String {
    match number {
        std::f64::consts::PI => "pi".into(),
        small if small != 0.0 && small.abs() < 1e-4 => format!("{small:e}"),
        number => format!("{number}"),
    }
}
