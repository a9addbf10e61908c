//! Kinds of curves, and of what lies along surfaces.

use super::lists::{PointsKind, each};
use crate::curve::SplineCurve;
use crate::script::handle::Handle;
use crate::script::parameter::ParameterKind;
use crate::script::spline::{ControlMeaning, side};
use crate::solid::primitive::path;
use crate::surface::SurfaceSide;
use glam::DVec3;
use rhai::{Array, Dynamic, ImmutableString};

/// What control points mean in one direction.
#[derive(Clone, Copy)]
pub(in crate::script) struct Spline;

/// A curve, or the control points of a path.
#[derive(Clone, Copy)]
pub(in crate::script) struct CurveKind;

/// A closed loop of curves, or several.
#[derive(Clone, Copy)]
pub(in crate::script) struct Loops;

/// A list of objects, each with the name of a side.
#[derive(Clone, Copy)]
pub(in crate::script) struct SidesKind;

/// What a curve or a list of points becomes.
pub(in crate::script) enum CurveValue {
    Curve(SplineCurve),
    Points(Vec<DVec3>),
}

impl CurveValue {
    /// The curve; of points, the path through their controls.
    ///
    /// - `is_closed`: whether the last point is followed by the first; a curve is as it is.
    pub(in crate::script) fn curve(self, is_closed: bool) -> Result<SplineCurve, String> {
        match self {
            CurveValue::Curve(curve) => Ok(curve),
            CurveValue::Points(points) => path(&points, is_closed).map_err(|error| error.to_string()),
        }
    }
}

impl ParameterKind for Spline {
    type Value = ControlMeaning;

    fn words(&self) -> String {
        "what bezier(), b_spline(), beta_spline() or bbb_spline() return".into()
    }

    fn read(&self, value: &Dynamic) -> Option<ControlMeaning> {
        value.read_lock::<ControlMeaning>().map(|spline| spline.clone())
    }
}

impl ParameterKind for CurveKind {
    type Value = CurveValue;

    fn words(&self) -> String {
        "a curve, or a list of points [[x, y, z], ...]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<CurveValue> {
        curve(value).map(CurveValue::Curve).or_else(|| PointsKind.read(value).map(CurveValue::Points))
    }
}

impl ParameterKind for Loops {
    type Value = Vec<Vec<SplineCurve>>;

    fn words(&self) -> String {
        "a list of loops, each a closed curve, a list of curves, or a list of corners [[u, v], ...]".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<Vec<SplineCurve>>> {
        let is_list_of_curves = each(value, curve).is_some_and(|curves| !curves.is_empty());
        let one = if is_list_of_curves { None } else { ring(value) };
        one.map(|one| vec![one]).or_else(|| each(value, ring))
    }
}

impl ParameterKind for SidesKind {
    type Value = Vec<(Handle, SurfaceSide)>;

    fn words(&self) -> String {
        "a list of pairs of an object and one of \"low u\", \"high u\", \"low v\", \"high v\"".into()
    }

    fn read(&self, value: &Dynamic) -> Option<Vec<(Handle, SurfaceSide)>> {
        each(value, |pair| {
            let pair = pair.read_lock::<Array>()?;
            let [object, name] = pair.as_slice() else { return None };
            let name = name.read_lock::<ImmutableString>()?;
            let object = *object.read_lock::<Handle>()?;
            Some((object, side(&name)?))
        })
    }
}

fn curve(value: &Dynamic) -> Option<SplineCurve> {
    value.read_lock::<SplineCurve>().map(|curve| curve.clone())
}

/// A closed loop: a curve, curves that follow one another, or the corners of a polygon.
fn ring(value: &Dynamic) -> Option<Vec<SplineCurve>> {
    let polygon = |value: &Dynamic| {
        let mut corners = PointsKind.read(value).filter(|corners| corners.len() > 2)?;
        corners.push(corners[0]);
        let straight = ControlMeaning::BSpline { degree: 1, is_closed: false, is_clamped: true, knots: Vec::new() };
        Some(vec![straight.curve(&corners, &[]).ok()?])
    };
    curve(value).map(|one| vec![one]).or_else(|| polygon(value)).or_else(|| each(value, curve))
}
