//! The solids of the book as data.

use super::*;
use crate::curve::SplineCurve;
use crate::solid::Body;
use crate::surface::TwistAndTaper;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Makes the enumeration of solids. A row is the word for a kind, its measures, and the function that makes its body; in
/// that, measures are references.
macro_rules! primitives {
    ($($(#[doc = $doc:literal])* $kind:ident $word:literal {
        $($(#[doc = $help:literal])* $measure:ident: $type:ty,)*
    } => $body:expr,)*) => {
        /// A solid of a few measures, as data; its [`Primitive::body`] has the exact surfaces.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Primitive {
            $($(#[doc = $doc])* #[serde(rename = $word)] $kind {
                $($(#[doc = $help])* $measure: $type,)*
            },)*
        }

        impl Primitive {
            /// The words for all kinds.
            pub const WORDS: &[&str] = &[$($word),*];

            /// The word for the kind.
            pub fn word(&self) -> &'static str {
                match self {
                    $(Primitive::$kind { .. } => $word,)*
                }
            }

            /// Its exact surfaces.
            ///
            /// # Errors
            /// [`PrimitiveError`] if there is no such solid.
            pub fn body(&self) -> Result<Body, PrimitiveError> {
                match self {
                    $(Primitive::$kind { $($measure),* } => $body,)*
                }
            }
        }
    };
}

primitives! {
    /// A sphere around the origin.
    Sphere "sphere" {
        /// Its radius.
        radius: f64,
    } => sphere(*radius),
    /// A box around the origin.
    Box "box" {
        /// Its sides along x, y and z.
        size: DVec3,
    } => block(*size),
    /// A box of which the top is shorter; see [`wedge`].
    Wedge "wedge" {
        /// Its sides along x, y and z.
        size: DVec3,
        /// Length of the top along x; 0 for an edge.
        top: f64,
    } => wedge(*size, *top),
    /// A pyramid over a regular base; see [`pyramid`].
    Pyramid "pyramid" {
        /// Sides of the base, 3 or more.
        sides: usize,
        /// From the middle of the base to its corners.
        radius: f64,
        /// Its height along y.
        height: f64,
    } => pyramid(*sides, *radius, *height),
    /// A polygon of the plane of x and y that was moved along z, from z = 0 on; see [`prism`].
    Prism "prism" {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// How far it was moved.
        height: f64,
    } => prism(contours, [0.0, *height]),
    /// An ellipsoid around the origin.
    Ellipsoid "ellipsoid" {
        /// Its half axes along x, y and z.
        radii: DVec3,
    } => ellipsoid(*radii),
    /// A cylinder around the origin.
    Cylinder "cylinder" {
        /// Its radius.
        radius: f64,
        /// Its height along y.
        height: f64,
    } => cylinder(*radius, *height),
    /// A cone or a frustum; see [`frustum`].
    Cone "cone" {
        /// Radius below.
        radius: f64,
        /// Radius above; 0 for a tip.
        top: f64,
        /// Its height along y.
        height: f64,
    } => frustum(*radius, *top, *height),
    /// A paraboloid with its tip up; see [`paraboloid`].
    Paraboloid "paraboloid" {
        /// Radius of the disc below.
        radius: f64,
        /// Its height along y.
        height: f64,
    } => paraboloid(*radius, *height),
    /// A hyperboloid of one sheet; see [`hyperboloid_of_one_sheet`].
    HyperboloidOfOneSheet "hyperboloid" {
        /// Its least radius.
        waist: f64,
        /// Radius of its discs.
        radius: f64,
        /// Its height along y.
        height: f64,
    } => hyperboloid_of_one_sheet(*waist, *radius, *height),
    /// A hyperboloid of two sheets; see [`hyperboloid_of_two_sheets`].
    HyperboloidOfTwoSheets "bowls" {
        /// Between the tips.
        gap: f64,
        /// Radius of its discs.
        radius: f64,
        /// Of both together, along y.
        height: f64,
    } => hyperboloid_of_two_sheets(*gap, *radius, *height),
    /// A torus around the origin, its axis along y.
    Torus "torus" {
        /// Radius of the circle in the middle of the tube.
        ring: f64,
        /// Radius of the tube.
        tube: f64,
    } => torus(*ring, *tube),
    /// A profile of lines and arcs that was revolved about the y axis; see [`revolution`].
    Revolution "revolution" {
        /// Points (r, y, bulge).
        profile: Vec<DVec3>,
    } => revolution(profile),
    /// A smooth profile that was revolved about the y axis; see [`smooth_revolution`].
    SmoothRevolution "lathe" {
        /// Control points (r, y).
        profile: Vec<DVec2>,
    } => smooth_revolution(profile),
    /// A polygon that was revolved about the y axis; see [`revolved_polygon`].
    RevolvedPolygon "turning" {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// How far it was revolved; turns.
        turn: f64,
    } => revolved_polygon(contours, *turn),
    /// A polygon that was swept along a curve; see [`sweep`].
    Sweep "sweep" {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// The curve.
        path: Box<SplineCurve>,
        /// How far the polygon was twisted about the curve; turns.
        twist: f64,
        /// How much wider it was at the end.
        taper: f64,
    } => sweep(contours, SplineCurve::clone(path), TwistAndTaper { twist_turns: *twist, scale: *taper }),
}
