//! Solids with flat faces: block, wedge, pyramid, prism.

use std::f64::consts::TAU;

use super::PrimitiveError;
use super::error::{count, length, length_or_zero, points};
use crate::polygon::{TriangulationKind, triangulate};
use crate::solid::{Body, Face};
use crate::surface::{Parallelogram, Surface, box_faces};
use glam::{DVec2, DVec3};

/// Most corners of a base.
const MAX_CORNERS: usize = 1 << 20;

/// A block around the origin.
pub fn block(size: DVec3) -> Result<Body, PrimitiveError> {
    check_size(size)?;
    let face = |face: &Parallelogram| {
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|uv| face.point(uv));
        Face::convex(corners.to_vec())
    };
    Ok(Body::new(Vec::new(), box_faces(size * -0.5, size * 0.5).iter().map(face).collect()))
}

fn check_size(size: DVec3) -> Result<(), PrimitiveError> {
    let sides = [("length", size.x), ("height", size.y), ("depth", size.z)];
    sides.into_iter().try_for_each(|(what, value)| length(what, value).map(|_| ()))
}

/// A block around the origin of which the top, at the greatest y, has the length `top` along x and lies over the side of
/// least x; 0 makes an edge of it.
pub fn wedge(size: DVec3, top: f64) -> Result<Body, PrimitiveError> {
    check_size(size)?;
    length_or_zero("top", top)?;
    let [low, high] = [size * -0.5, size * 0.5];
    // The outline seen from the front, once around.
    let ridge = if top == size.x { high.x } else { low.x + top };
    let mut outline = vec![DVec2::new(low.x, low.y), DVec2::new(high.x, low.y), DVec2::new(ridge, high.y)];
    if top > 0.0 {
        outline.push(DVec2::new(low.x, high.y));
    }
    prism(&[outline], [low.z, high.z])
}

/// A pyramid with its tip over the middle of a regular base; its height is along y and its middle at the origin. A
/// corner of the base is on the z axis.
pub fn pyramid(sides: usize, radius: f64, height: f64) -> Result<Body, PrimitiveError> {
    count("sides", sides, 3, MAX_CORNERS)?;
    length("radius", radius)?;
    let half = length("height", height)? * 0.5;
    let corner = |k: usize| {
        let (sine, cosine) = (TAU * (k % sides) as f64 / sides as f64).sin_cos();
        DVec3::new(radius * sine, -half, radius * cosine)
    };
    let tip = DVec3::Y * half;
    let mut faces: Vec<Face> = (0..sides).map(|k| Face::convex(vec![corner(k), corner(k + 1), tip])).collect();
    faces.push(Face::convex((0..sides).rev().map(corner).collect()));
    Ok(Body::new(Vec::new(), faces))
}

/// A polygon in the plane of x and y, moved from the first z to the second, which is greater.
///
/// Contours may run either way; what lies in an odd number of them is inside.
pub fn prism<C: AsRef<[DVec2]>>(contours: &[C], [low, high]: [f64; 2]) -> Result<Body, PrimitiveError> {
    length("height", high - low)?;
    let corners: Vec<DVec2> = contours.iter().flat_map(|contour| contour.as_ref()).copied().collect();
    count("corners", corners.len(), 3, MAX_CORNERS)?;
    points(corners.iter().map(|corner| corner.extend(0.0)))?;
    let base = triangulate(contours, TriangulationKind::Delaunay)?;
    let lifted = |z: f64| corners.iter().map(|corner| corner.extend(z)).collect::<Vec<_>>();
    let turned = base.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let mut faces = vec![Face::new(lifted(low), turned), Face::new(lifted(high), base.triangles.clone())];
    for edge in base.border() {
        let [a, b] = edge.map(|corner| corners[corner as usize]);
        faces.push(Face::convex(vec![a.extend(low), b.extend(low), b.extend(high), a.extend(high)]));
    }
    Ok(Body::new(Vec::new(), faces))
}
