//! Lists in the values of a call: points, numbers, indices, curves, sides.

use super::handle::Handle;
use super::spline::{ControlMeaning, side};
use crate::curve::SplineCurve;
use crate::surface::SurfaceSide;
use glam::DVec3;
use rhai::{Array, Dynamic};

/// What `read` makes of every element of a list.
fn each<T>(value: &Dynamic, read: impl Fn(&Dynamic) -> Option<T>) -> Option<Vec<T>> {
    value.read_lock::<Array>()?.iter().map(read).collect()
}

/// Three numbers.
pub(super) fn vector(value: &Dynamic) -> Option<DVec3> {
    let array = value.read_lock::<Array>()?;
    match array.as_slice() {
        [x, y, z] => Some(DVec3::new(number(x)?, number(y)?, number(z)?)),
        _ => None,
    }
}

/// Points with two or three coordinates.
pub(super) fn points(value: &Dynamic) -> Option<Vec<DVec3>> {
    each(value, |point| {
        let array = point.read_lock::<Array>()?;
        match array.as_slice() {
            [x, y] => Some(DVec3::new(number(x)?, number(y)?, 0.0)),
            _ => vector(point),
        }
    })
}

/// One list of points or several.
pub(super) fn contours(value: &Dynamic) -> Option<Vec<Vec<DVec3>>> {
    points(value).map(|one| vec![one]).or_else(|| each(value, points))
}

/// A number, a list of numbers, or several lists.
pub(super) fn numbers(value: &Dynamic) -> Option<Vec<Vec<f64>>> {
    let row = |value: &Dynamic| each(value, number);
    let one = number(value).map(|one| vec![one]).or_else(|| row(value));
    one.map(|one| vec![one]).or_else(|| each(value, row))
}

/// A list of whole numbers from 0, or several lists.
pub(super) fn indices(value: &Dynamic) -> Option<Vec<Vec<u32>>> {
    let index = |value: &Dynamic| value.as_int().ok().and_then(|index| u32::try_from(index).ok());
    let row = |value: &Dynamic| each(value, index);
    row(value).map(|one| vec![one]).or_else(|| each(value, row))
}

/// Some objects.
pub(super) fn objects(value: &Dynamic) -> Option<Vec<Handle>> {
    let object = |value: &Dynamic| value.read_lock::<Handle>().map(|handle| *handle);
    object(value).map(|one| vec![one]).or_else(|| each(value, object))
}

/// Objects, each with the name of a side.
pub(super) fn sides(value: &Dynamic) -> Option<Vec<(Handle, SurfaceSide)>> {
    each(value, |pair| {
        let pair = pair.read_lock::<Array>()?;
        let [object, name] = pair.as_slice() else { return None };
        let name = name.read_lock::<rhai::ImmutableString>()?;
        let object = *object.read_lock::<Handle>()?;
        Some((object, side(&name)?))
    })
}

/// A curve.
pub(super) fn curve(value: &Dynamic) -> Option<SplineCurve> {
    value.read_lock::<SplineCurve>().map(|curve| curve.clone())
}

/// A closed loop: a curve, curves that follow one another, or the corners of a polygon.
fn ring(value: &Dynamic) -> Option<Vec<SplineCurve>> {
    let polygon = |value: &Dynamic| {
        let mut corners = points(value).filter(|corners| corners.len() > 2)?;
        corners.push(corners[0]);
        let straight = ControlMeaning::BSpline { degree: 1, is_closed: false, is_clamped: true, knots: Vec::new() };
        Some(vec![straight.curve(&corners, &[]).ok()?])
    };
    curve(value).map(|one| vec![one]).or_else(|| polygon(value)).or_else(|| each(value, curve))
}

/// One loop, or several.
pub(super) fn loops(value: &Dynamic) -> Option<Vec<Vec<SplineCurve>>> {
    let is_list_of_curves = each(value, curve).is_some_and(|curves| !curves.is_empty());
    let one = if is_list_of_curves { None } else { ring(value) };
    one.map(|one| vec![one]).or_else(|| each(value, ring))
}

/// A finite number.
pub(super) fn number(value: &Dynamic) -> Option<f64> {
    value.as_float().ok().or_else(|| value.as_int().ok().map(|i| i as f64)).filter(|x| x.is_finite())
}
