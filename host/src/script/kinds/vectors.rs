//! Kinds of three numbers.

use super::numbers::{number, shown};
use crate::script::parameter::{HasDefault, ParameterKind};
use glam::DVec3;
use rhai::{Array, Dynamic, ImmutableString};

/// Three numbers `[x, y, z]`; in a list of values also without brackets.
#[derive(Clone, Copy)]
pub(in crate::script) struct Vector;

/// One number for all directions or three numbers; none is 0.
#[derive(Clone, Copy)]
pub(in crate::script) struct Factors;

/// Three lengths above 0, or one for all.
#[derive(Clone, Copy)]
pub(in crate::script) struct Lengths;

/// Sides of a rectangle along x and z, above 0, or one for both.
#[derive(Clone, Copy)]
pub(in crate::script) struct RectangleKind;

/// Powers 0 and more: `[red, green, blue]`, or one number for all.
#[derive(Clone, Copy)]
pub(in crate::script) struct Powers;

/// "x", "y", "z" or a vector `[x, y, z]`; becomes a unit vector.
#[derive(Clone, Copy)]
pub(in crate::script) struct AxisKind;

/// An axis of the coordinates.
#[derive(Clone, Copy)]
pub(in crate::script) enum NamedAxis {
    X,
    Y,
    Z,
}

impl ParameterKind for Vector {
    type Value = DVec3;
    const TAKES_THREE: bool = true;

    fn words(&self) -> String {
        "three numbers [x, y, z]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DVec3> {
        vector(value)
    }
}

impl ParameterKind for Factors {
    type Value = DVec3;
    const TAKES_THREE: bool = true;

    fn words(&self) -> String {
        "a number or three [x, y, z], none of them 0".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DVec3> {
        vector_or_number(value).filter(|v| v.abs().min_element() > 0.0)
    }
}

impl ParameterKind for Lengths {
    type Value = DVec3;
    const TAKES_THREE: bool = true;

    fn words(&self) -> String {
        "a length above 0, or three [x, y, z]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DVec3> {
        vector_or_number(value).filter(|v| v.min_element() > 0.0)
    }
}

impl ParameterKind for RectangleKind {
    type Value = [f64; 2];

    fn words(&self) -> String {
        "a length above 0, or two [x, z]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<[f64; 2]> {
        let two = || match value.read_lock::<Array>()?.as_slice() {
            [x, z] => Some([number(x)?, number(z)?]),
            _ => None,
        };
        number(value).map(|side| [side; 2]).or_else(two).filter(|sides| sides[0].min(sides[1]) > 0.0)
    }
}

impl ParameterKind for Powers {
    type Value = DVec3;
    const TAKES_THREE: bool = true;

    fn words(&self) -> String {
        "a number not below 0, or three [red, green, blue]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DVec3> {
        vector_or_number(value).filter(|v| v.min_element() >= 0.0)
    }
}

impl ParameterKind for AxisKind {
    type Value = DVec3;

    fn words(&self) -> String {
        "\"x\", \"y\", \"z\" or a vector [x, y, z]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<DVec3> {
        let named = value
            .read_lock::<ImmutableString>()
            .and_then(|name| NamedAxis::ALL.into_iter().find(|axis| axis.name() == *name));
        named.map(NamedAxis::vector).or_else(|| vector(value)?.try_normalize())
    }
}

impl HasDefault for Vector {
    type Default = [f64; 3];

    fn of_default(&self, default: [f64; 3]) -> DVec3 {
        default.into()
    }

    fn shown(&self, default: [f64; 3]) -> String {
        format!("[{}]", default.map(shown).join(", "))
    }
}

impl HasDefault for Lengths {
    type Default = f64;

    fn of_default(&self, default: f64) -> DVec3 {
        DVec3::splat(default)
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl HasDefault for RectangleKind {
    type Default = f64;

    fn of_default(&self, default: f64) -> [f64; 2] {
        [default; 2]
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl HasDefault for Powers {
    type Default = f64;

    fn of_default(&self, default: f64) -> DVec3 {
        DVec3::splat(default)
    }

    fn shown(&self, default: f64) -> String {
        shown(default)
    }
}

impl HasDefault for AxisKind {
    type Default = NamedAxis;

    fn of_default(&self, default: NamedAxis) -> DVec3 {
        default.vector()
    }

    fn shown(&self, default: NamedAxis) -> String {
        format!("{:?}", default.name())
    }
}

impl NamedAxis {
    const ALL: [NamedAxis; 3] = [NamedAxis::X, NamedAxis::Y, NamedAxis::Z];

    fn name(self) -> &'static str {
        match self {
            NamedAxis::X => "x",
            NamedAxis::Y => "y",
            NamedAxis::Z => "z",
        }
    }

    fn vector(self) -> DVec3 {
        DVec3::AXES[self as usize]
    }
}

/// Three numbers.
pub(super) fn vector(value: &Dynamic) -> Option<DVec3> {
    let array = value.read_lock::<Array>()?;
    match array.as_slice() {
        [x, y, z] => Some(DVec3::new(number(x)?, number(y)?, number(z)?)),
        _ => None,
    }
}

/// A vector, or one number for all three components.
pub(super) fn vector_or_number(value: &Dynamic) -> Option<DVec3> {
    number(value).map(DVec3::splat).or_else(|| vector(value))
}
