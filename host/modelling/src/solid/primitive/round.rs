//! The quadrics and the torus, around the origin with their axis along y.

use super::PrimitiveError;
use super::error::{above, length, length_or_zero};
use crate::solid::Body;
use crate::surface::{Profile, Sphere, Surface, SurfaceOfRevolution};
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

/// The solid that pieces of a closed profile make when they revolve about the y axis. Pieces on the axis make nothing.
///
/// Each piece begins where the one before it ends, to the bit; the inside is on the left.
pub(super) fn turned(pieces: impl IntoIterator<Item = Profile>) -> Body {
    let pieces = pieces.into_iter().filter(|piece| !piece.is_on_axis());
    Body::new(pieces.map(|piece| Arc::new(SurfaceOfRevolution::whole(piece)) as Arc<dyn Surface>).collect(), Vec::new())
}

/// A curve between two flat discs; where it meets the axis there is none.
fn capped(side: Profile) -> Body {
    let (low, high) = (side.point(0.0), side.point(1.0));
    let on_axis = |point: DVec2| DVec2::new(0.0, point.y);
    turned([Profile::line(on_axis(low), low), side, Profile::line(high, on_axis(high))])
}

/// A sphere.
pub fn sphere(radius: f64) -> Result<Body, PrimitiveError> {
    Ok(Body::new(vec![Arc::new(Sphere::new(DVec3::ZERO, length("radius", radius)?))], Vec::new()))
}

/// An ellipsoid with its axes along x, y and z.
pub fn ellipsoid(radii: DVec3) -> Result<Body, PrimitiveError> {
    for (what, value) in [("radius along x", radii.x), ("radius along y", radii.y), ("radius along z", radii.z)] {
        length(what, value)?;
    }
    Ok(sphere(1.0)?.transformed(DAffine3::from_scale(radii)))
}

/// A cylinder.
pub fn cylinder(radius: f64, height: f64) -> Result<Body, PrimitiveError> {
    length("radius", radius)?;
    frustum(radius, radius, height)
}

/// A piece of a cone between discs; one of them may be a point.
pub fn frustum(bottom: f64, top: f64, height: f64) -> Result<Body, PrimitiveError> {
    length_or_zero("bottom radius", bottom)?;
    length_or_zero("top radius", top)?;
    length("the greater radius", bottom.max(top))?;
    let half = length("height", height)? * 0.5;
    Ok(capped(Profile::line(DVec2::new(bottom, -half), DVec2::new(top, half))))
}

/// A paraboloid with its tip up and a disc below.
pub fn paraboloid(radius: f64, height: f64) -> Result<Body, PrimitiveError> {
    length("radius", radius)?;
    let half = length("height", height)? * 0.5;
    Ok(capped(Profile::Parabola { apex: half, rise: -height / radius / radius, reach: [radius, 0.0] }))
}

/// A hyperboloid of one sheet between discs of equal radius.
pub fn hyperboloid_of_one_sheet(waist: f64, radius: f64, height: f64) -> Result<Body, PrimitiveError> {
    length("waist", waist)?;
    length("height", height)?;
    above("radius", length("radius", radius)?, "greater than the waist", waist)?;
    // sinh t at the rim, where cosh t = radius / waist.
    let slope = ((radius - waist) / waist * ((radius + waist) / waist)).sqrt();
    let reach = slope.asinh();
    Ok(capped(Profile::HyperbolaOneSheet { across: waist, along: height * 0.5 / slope, reach: [-reach, reach] }))
}

/// A hyperboloid of two sheets: two sheets with their tips towards each other, `gap` apart, with discs outside;
/// together as high as `height`.
pub fn hyperboloid_of_two_sheets(gap: f64, radius: f64, height: f64) -> Result<Body, PrimitiveError> {
    length("gap", gap)?;
    length("radius", radius)?;
    above("height", length("height", height)?, "greater than the gap", gap)?;
    let slope = ((height - gap) / gap * ((height + gap) / gap)).sqrt();
    let (across, along, reach) = (radius / slope, gap * 0.5, slope.asinh());
    let upper = Profile::HyperbolaTwoSheets { across, along, reach: [0.0, reach] };
    let lower = Profile::HyperbolaTwoSheets { across, along: -along, reach: [reach, 0.0] };
    let disc = |rim: DVec2| Profile::line(rim, DVec2::new(0.0, rim.y));
    let (top, bottom) = (disc(upper.point(1.0)), disc(lower.point(0.0)).reversed());
    Ok(turned([bottom, lower, upper, top]))
}

/// A torus: a tube of radius `tube` around a circle of radius `ring`, which is greater.
pub fn torus(ring: f64, tube: f64) -> Result<Body, PrimitiveError> {
    length("tube", tube)?;
    above("ring", length("ring", ring)?, "greater than the tube", tube)?;
    Ok(turned([Profile::Arc { center: DVec2::new(ring, 0.0), radius: tube, turns: [0.0, 1.0] }]))
}
