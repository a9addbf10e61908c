//! Kinds of lists: points, numbers, indices, objects.

use super::numbers::{number, shown};
use super::vectors::vector;
use super::words::ObjectKind;
use crate::script::handle::Handle;
use crate::script::parameter::{HasDefault, ParameterKind};
use glam::DVec3;
use rhai::{Array, Dynamic};

/// A list of points `[x, y]` or `[x, y, z]`; a third coordinate that is not given is 0.
#[derive(Clone, Copy)]
pub(in crate::script) struct PointsKind;

/// A list of points, or of several such lists.
#[derive(Clone, Copy)]
pub(in crate::script) struct Contours;

/// A number, a list of numbers, or several such lists: all of them, in turn.
#[derive(Clone, Copy)]
pub(in crate::script) struct Numbers;

/// A number, a list of numbers, or several such lists, each a row.
#[derive(Clone, Copy)]
pub(in crate::script) struct RowsOfNumbers;

/// A list of whole numbers from 0, or several such lists.
#[derive(Clone, Copy)]
pub(in crate::script) struct Indices;

/// A list of objects.
#[derive(Clone, Copy)]
pub(in crate::script) struct Objects;

impl ParameterKind for PointsKind {
    type Value = Vec<DVec3>;

    fn words(&self) -> String {
        "a list of points [[x, y], ...], with a third number where it is used".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<DVec3>> {
        each(value, |point| {
            let array = point.read_lock::<Array>()?;
            match array.as_slice() {
                [x, y] => Some(DVec3::new(number(x)?, number(y)?, 0.0)),
                _ => vector(point),
            }
        })
    }
}

impl ParameterKind for Contours {
    type Value = Vec<Vec<DVec3>>;

    fn words(&self) -> String {
        "a list of points [[x, y], ...] or a list of such lists".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Vec<DVec3>>> {
        let one = PointsKind.read(value).map(|one| vec![one]);
        one.or_else(|| each(value, |contour| PointsKind.read(contour)))
    }
}

impl ParameterKind for RowsOfNumbers {
    type Value = Vec<Vec<f64>>;

    fn words(&self) -> String {
        "a number or a list of numbers, or several lists of them".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Vec<f64>>> {
        let row = |value: &Dynamic| each(value, number);
        let one = number(value).map(|one| vec![one]).or_else(|| row(value));
        one.map(|one| vec![one]).or_else(|| each(value, row))
    }
}

impl ParameterKind for Numbers {
    type Value = Vec<f64>;

    fn words(&self) -> String {
        RowsOfNumbers.words()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<f64>> {
        RowsOfNumbers.read(value).map(|rows| rows.concat())
    }
}

impl ParameterKind for Indices {
    type Value = Vec<Vec<u32>>;

    fn words(&self) -> String {
        "a list of whole numbers from 0, or several such lists".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Vec<u32>>> {
        let index = |value: &Dynamic| value.as_int().ok().and_then(|index| u32::try_from(index).ok());
        let row = |value: &Dynamic| each(value, index);
        row(value).map(|one| vec![one]).or_else(|| each(value, row))
    }
}

impl ParameterKind for Objects {
    type Value = Vec<Handle>;

    fn words(&self) -> String {
        "a list of objects".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Handle>> {
        let one = ObjectKind.read(value).map(|one| vec![one]);
        one.or_else(|| each(value, |object| ObjectKind.read(object)))
    }
}

impl HasDefault for Numbers {
    type Default = f64;

    fn of_default(&self, default: f64) -> Vec<f64> {
        vec![default]
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

/// What `read` makes of every element of a list.
pub(super) fn each<T>(value: &Dynamic, read: impl Fn(&Dynamic) -> Option<T>) -> Option<Vec<T>> {
    value.read_lock::<Array>()?.iter().map(read).collect()
}
