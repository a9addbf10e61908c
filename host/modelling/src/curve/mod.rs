//! Curves that are known exactly: Bezier curves, B-splines, Beta-splines, and the BBB-splines that contain them.
//!
//! A [`Basis`] says how control points become Bezier curves; a [`SplineCurve`] is control points over a basis. The same
//! bases make surfaces, one in each direction.

mod basis;
mod bbb;
mod bezier;
mod control;
mod error;
mod form;
mod knots;
mod spline;

pub use basis::Basis;
pub(crate) use basis::Refinement;
pub use bezier::{BezierCurve, MAX_DEGREE};
pub(crate) use bezier::{bernstein, casteljau};
pub use control::ControlPoint;
pub(crate) use control::{check_control, control_net};
pub use error::SplineError;
pub(crate) use form::apply;
pub use spline::SplineCurve;

use glam::DVec3;

/// A piece of a curve over an interval of a parameter.
pub trait Curve: Sync {
    /// The lowest and the highest parameter.
    fn domain(&self) -> [f64; 2];

    /// The point at `t`, which is in the domain; model units.
    fn point(&self, t: f64) -> DVec3;

    /// The first and the second derivative of the point; at a joint those of the span after it.
    fn derivatives(&self, t: f64) -> [DVec3; 2];
}

#[cfg(test)]
mod tests;
