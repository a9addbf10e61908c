//! Spline curves of every kind.

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

use super::basis::{Basis, Refinement};
use super::bezier::BezierCurve;
use super::control::{ControlPoint, check_control, control_row};
use super::form::apply;
use super::{Curve, SplineError};

/// A curve of control points over a [`Basis`], polynomial or rational; evaluated through the Bezier curves of its spans.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SplineData", into = "SplineData")]
pub struct SplineCurve {
    basis: Basis,
    control: Vec<ControlPoint>,
    pieces: Vec<BezierCurve>,
}

/// What a curve is made of.
#[derive(Serialize, Deserialize)]
struct SplineData {
    basis: Basis,
    control: Vec<ControlPoint>,
}

impl TryFrom<SplineData> for SplineCurve {
    type Error = SplineError;

    fn try_from(SplineData { basis, control }: SplineData) -> Result<SplineCurve, SplineError> {
        let (found, needed) = (control.len(), basis.control_count());
        if found != needed {
            return Err(SplineError::Count { what: "control points", found, needed });
        }
        check_control(&control)?;
        Ok(SplineCurve::of(basis, control))
    }
}

impl From<SplineCurve> for SplineData {
    fn from(curve: SplineCurve) -> SplineData {
        SplineData { basis: curve.basis, control: curve.control }
    }
}

impl SplineCurve {
    /// The curve over `basis` with a control point for each that it needs; no `weights` at all stand for weights of 1.
    ///
    /// # Errors
    /// [`SplineError`] if the numbers do not fit, or a point or weight is out of range.
    pub fn new(basis: Basis, points: &[DVec3], weights: &[f64]) -> Result<SplineCurve, SplineError> {
        let (found, needed) = (points.len(), basis.control_count());
        if found != needed {
            return Err(SplineError::Count { what: "control points", found, needed });
        }
        let control = control_row(0, points, weights)?;
        Ok(SplineCurve::of(basis, control))
    }

    fn of(basis: Basis, control: Vec<ControlPoint>) -> SplineCurve {
        let form = basis.form();
        let points = apply(&form.rows, &control);
        let piece = |span: usize| BezierCurve::of((0..=form.degree).map(|k| points[form.index(span, k)]).collect());
        SplineCurve { pieces: (0..form.spans()).map(piece).collect(), basis, control }
    }

    /// What the curve is built over.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// The control points.
    pub fn control(&self) -> &[ControlPoint] {
        &self.control
    }

    /// The Bezier curves of the spans, in order; neighbours share a control point.
    pub fn pieces(&self) -> &[BezierCurve] {
        &self.pieces
    }

    fn refined(&self, refinement: Refinement) -> SplineCurve {
        let control = refinement.control(&self.control);
        SplineCurve::of(refinement.basis, control)
    }

    /// This curve with another joint at `t`, and one control point more.
    ///
    /// # Errors
    /// [`SplineError`] if `t` is outside the domain or there is no room for another joint.
    pub fn with_joint(&self, t: f64) -> Result<SplineCurve, SplineError> {
        Ok(self.refined(self.basis.inserted(t)?))
    }

    /// The curves before and after `t`, parameters unchanged; a closed curve becomes one that begins and ends there.
    ///
    /// # Errors
    /// [`SplineError::Outside`] if `t` is not inside the domain.
    pub fn subdivided(&self, t: f64) -> Result<Vec<SplineCurve>, SplineError> {
        Ok(self.basis.subdivided(t)?.into_iter().map(|part| self.refined(part)).collect())
    }

    /// This curve with a degree higher by one. A BBB-spline becomes the B-spline of its Bezier points first.
    ///
    /// # Errors
    /// [`SplineError::Degree`] if it is too high.
    pub fn elevated(&self) -> Result<SplineCurve, SplineError> {
        Ok(self.refined(self.basis.elevated()?))
    }

    /// This curve from the other end.
    pub fn reversed(&self) -> SplineCurve {
        self.refined(self.basis.reversed())
    }

    /// The curve moved by `placement`.
    pub fn transformed(&self, placement: &DAffine3) -> SplineCurve {
        SplineCurve::of(self.basis.clone(), self.control.iter().map(|point| point.transformed(placement)).collect())
    }
}

impl Curve for SplineCurve {
    fn domain(&self) -> [f64; 2] {
        self.basis.domain()
    }

    fn point(&self, t: f64) -> DVec3 {
        let (span, t) = self.basis.form().locate(t);
        self.pieces[span].point(t)
    }

    fn derivatives(&self, t: f64) -> [DVec3; 2] {
        let (span, t) = self.basis.form().locate(t);
        let length = self.basis.breaks()[span + 1] - self.basis.breaks()[span];
        let [first, second] = self.pieces[span].derivatives(t);
        [first / length, second / length / length]
    }
}
