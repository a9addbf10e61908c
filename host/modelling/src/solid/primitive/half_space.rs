//! The half-space: all that lies behind a plane.

use super::PrimitiveError;
use super::error::points;
use crate::numeric::bounds::Bounds;
use crate::solid::{Body, Face};
use glam::DVec3;

/// How much farther than what it must cover a half-space reaches.
const OVERSIZE: f64 = 8.0;

/// The part of a half-space behind the plane through `at` that covers `bounds`: a tetrahedron with one face in the plane.
///
/// - `normal`: towards the empty side, any length above 0.
/// - `at`: a point of the plane.
pub fn half_space(normal: DVec3, at: DVec3, bounds: &Bounds) -> Result<Body, PrimitiveError> {
    points([normal, at])?;
    let range = "a length above 0";
    let normal = normal.try_normalize().ok_or(PrimitiveError::Measure {
        what: "the length of the normal",
        value: normal.length(),
        range,
    })?;
    // Seen from the foot of the middle of the bounds, nothing to be covered is farther away than `size`.
    let middle = if bounds.is_empty() { at } else { bounds.center() };
    let height = (middle - at).dot(normal);
    // Summed in this order, planes across an axis stay where they are to the bit.
    let foot = at + (middle - at - normal * height);
    let near = if bounds.is_empty() { 1.0 } else { bounds.diagonal() + height.abs() };
    let size = if near > 0.0 { near * OVERSIZE } else { OVERSIZE };
    let (along, across) = normal.any_orthonormal_pair();
    let corner = |x: f64, y: f64| foot + along * (x * size) + across * (y * size);
    let [a, b, c] = [corner(-1.0, -1.0), corner(2.0, 0.0), corner(-1.0, 1.0)];
    let tip = foot - normal * size;
    let faces = [[a, b, c], [b, a, tip], [c, b, tip], [a, c, tip]];
    Ok(Body::new(Vec::new(), faces.map(|corners| Face::convex(corners.to_vec())).to_vec()))
}
