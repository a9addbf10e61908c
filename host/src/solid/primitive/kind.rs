//! The solids of the book as data.

use super::*;
use crate::curve::SplineCurve;
use crate::solid::Body;
use crate::surface::TwistAndTaper;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A solid of a few measures, as data; its [`Primitive::body`] has the exact surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Primitive {
    /// A sphere around the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A box around the origin.
    Box {
        /// Its sides along x, y and z.
        size: DVec3,
    },
    /// A box of which the top is shorter; see [`wedge`].
    Wedge {
        /// Its sides along x, y and z.
        size: DVec3,
        /// Length of the top along x; 0 for an edge.
        top: f64,
    },
    /// A pyramid over a regular base; see [`pyramid`].
    Pyramid {
        /// Sides of the base, 3 or more.
        sides: usize,
        /// From the middle of the base to its corners.
        radius: f64,
        /// Its height along y.
        height: f64,
    },
    /// A polygon of the plane of x and y that was moved along z, from z = 0 on; see [`prism`].
    Prism {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// How far it was moved.
        height: f64,
    },
    /// An ellipsoid around the origin.
    Ellipsoid {
        /// Its half axes along x, y and z.
        radii: DVec3,
    },
    /// A cylinder around the origin.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its height along y.
        height: f64,
    },
    /// A cone or a frustum; see [`frustum`].
    Cone {
        /// Radius below.
        radius: f64,
        /// Radius above; 0 for a tip.
        top: f64,
        /// Its height along y.
        height: f64,
    },
    /// A paraboloid with its tip up; see [`paraboloid`].
    Paraboloid {
        /// Radius of the disc below.
        radius: f64,
        /// Its height along y.
        height: f64,
    },
    /// A hyperboloid of one sheet; see [`hyperboloid_of_one_sheet`].
    #[serde(rename = "hyperboloid")]
    HyperboloidOfOneSheet {
        /// Its least radius.
        waist: f64,
        /// Radius of its discs.
        radius: f64,
        /// Its height along y.
        height: f64,
    },
    /// A hyperboloid of two sheets; see [`hyperboloid_of_two_sheets`].
    #[serde(rename = "bowls")]
    HyperboloidOfTwoSheets {
        /// Between the tips.
        gap: f64,
        /// Radius of its discs.
        radius: f64,
        /// Of both together, along y.
        height: f64,
    },
    /// A torus around the origin, its axis along y.
    Torus {
        /// Radius of the circle in the middle of the tube.
        ring: f64,
        /// Radius of the tube.
        tube: f64,
    },
    /// A profile of lines and arcs that was revolved about the y axis; see [`revolution`].
    Revolution {
        /// Points (r, y, bulge).
        profile: Vec<DVec3>,
    },
    /// A smooth profile that was revolved about the y axis; see [`smooth_revolution`].
    #[serde(rename = "lathe")]
    SmoothRevolution {
        /// Control points (r, y).
        profile: Vec<DVec2>,
    },
    /// A polygon that was revolved about the y axis; see [`revolved_polygon`].
    #[serde(rename = "turning")]
    RevolvedPolygon {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// How far it was revolved; turns.
        turn: f64,
    },
    /// A polygon that was swept along a curve; see [`sweep`].
    Sweep {
        /// Corners of the polygon.
        contours: Vec<Vec<DVec2>>,
        /// The curve.
        path: Box<SplineCurve>,
        /// How far the polygon was twisted about the curve; turns.
        twist: f64,
        /// How much wider it was at the end.
        taper: f64,
    },
}

impl Primitive {
    /// The word for the kind.
    pub fn word(&self) -> &'static str {
        match self {
            Primitive::Sphere { .. } => "sphere",
            Primitive::Box { .. } => "box",
            Primitive::Wedge { .. } => "wedge",
            Primitive::Pyramid { .. } => "pyramid",
            Primitive::Prism { .. } => "prism",
            Primitive::Ellipsoid { .. } => "ellipsoid",
            Primitive::Cylinder { .. } => "cylinder",
            Primitive::Cone { .. } => "cone",
            Primitive::Paraboloid { .. } => "paraboloid",
            Primitive::HyperboloidOfOneSheet { .. } => "hyperboloid",
            Primitive::HyperboloidOfTwoSheets { .. } => "bowls",
            Primitive::Torus { .. } => "torus",
            Primitive::Revolution { .. } => "revolution",
            Primitive::SmoothRevolution { .. } => "lathe",
            Primitive::RevolvedPolygon { .. } => "turning",
            Primitive::Sweep { .. } => "sweep",
        }
    }

    /// Its exact surfaces.
    ///
    /// # Errors
    /// [`PrimitiveError`] if there is no such solid.
    pub fn body(&self) -> Result<Body, PrimitiveError> {
        match self {
            Primitive::Sphere { radius } => sphere(*radius),
            Primitive::Box { size } => block(*size),
            Primitive::Wedge { size, top } => wedge(*size, *top),
            Primitive::Pyramid { sides, radius, height } => pyramid(*sides, *radius, *height),
            Primitive::Prism { contours, height } => prism(contours, [0.0, *height]),
            Primitive::Ellipsoid { radii } => ellipsoid(*radii),
            Primitive::Cylinder { radius, height } => cylinder(*radius, *height),
            Primitive::Cone { radius, top, height } => frustum(*radius, *top, *height),
            Primitive::Paraboloid { radius, height } => paraboloid(*radius, *height),
            Primitive::HyperboloidOfOneSheet { waist, radius, height } => {
                hyperboloid_of_one_sheet(*waist, *radius, *height)
            }
            Primitive::HyperboloidOfTwoSheets { gap, radius, height } => {
                hyperboloid_of_two_sheets(*gap, *radius, *height)
            }
            Primitive::Torus { ring, tube } => torus(*ring, *tube),
            Primitive::Revolution { profile } => revolution(profile),
            Primitive::SmoothRevolution { profile } => smooth_revolution(profile),
            Primitive::RevolvedPolygon { contours, turn } => revolved_polygon(contours, *turn),
            Primitive::Sweep { contours, path, twist, taper } => {
                sweep(contours, SplineCurve::clone(path), TwistAndTaper { twist_turns: *twist, scale: *taper })
            }
        }
    }
}
