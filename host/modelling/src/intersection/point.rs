//! Curves of intersection, their points, and how accurate they are.

use crate::mesh::Polylines;
use glam::{DVec2, DVec3};

/// How accurate a curve is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePrecision {
    /// The residual at which a point counts as found, as a part of the size of the bodies.
    pub newton: f64,
    /// Points are added until the curve is so near to the lines between them, model units; none are without a number.
    pub chord: Option<f64>,
}

impl Default for CurvePrecision {
    /// 10^-12 of the size, and no points added.
    fn default() -> CurvePrecision {
        CurvePrecision { newton: 1e-12, chord: None }
    }
}

/// The place of a point on a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetCoordinates {
    /// A triangle that is near.
    pub triangle: u32,
    /// The surface that the triangle names; none where only the triangle is known.
    pub surface: Option<u32>,
    /// The parameters on the surface; without one, the weights of the second and the third corner of the triangle.
    pub uv: DVec2,
}

impl SheetCoordinates {
    /// Whether two places are on one surface.
    pub fn is_beside(&self, other: &SheetCoordinates) -> bool {
        self.surface == other.surface && (self.surface.is_some() || self.triangle == other.triangle)
    }
}

/// A mark of a special point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// An ordinary point.
    Regular,
    /// The curve goes over from one surface of a sheet to another. The point stands there twice, once on either.
    Corner,
    /// The curve ends at the border of a sheet.
    End,
    /// The surfaces have one tangent plane and do not cross.
    Tangent,
    /// The surfaces have one tangent plane, and curves cross here.
    Branching,
}

impl Mark {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Mark::Regular => "regular",
            Mark::Corner => "corner",
            Mark::End => "end",
            Mark::Tangent => "tangent",
            Mark::Branching => "branching",
        }
    }
}

/// A reason for which a point is not accurate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Inaccuracy {
    /// The planes that touch the surfaces are nearly one.
    #[error("the surfaces have nearly one tangent plane here")]
    Parallel,
    /// A surface ends before the other.
    #[error("a surface ends here before it meets the other")]
    Beyond,
    /// The iteration went farther than the triangles allow.
    #[error("the surfaces do not meet near their triangles")]
    Astray,
    /// The iteration did not converge.
    #[error("the iteration did not converge")]
    Slow,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The position, model units: the middle between the points of both surfaces.
    pub position: DVec3,
    /// The parameters on both.
    pub coordinates: [SheetCoordinates; 2],
    /// The distance between the points of both surfaces, model units.
    pub residual: f64,
    /// The direction in which the branch continues, unit length.
    pub tangent: DVec3,
    /// The angle between the tangent planes of the surfaces, degrees, 0..=90.
    pub angle: f64,
    /// The mark of the point.
    pub mark: Mark,
    /// The reason for which it is not accurate, if it is not.
    pub inaccuracy: Option<Inaccuracy>,
}

/// A connected curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// The points in order.
    pub points: Vec<CurvePoint>,
    /// Whether the last point is joined to the first.
    pub is_closed: bool,
}

impl Branch {
    /// The length as a polyline, model units.
    pub fn length(&self) -> f64 {
        self.positions().windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// The positions; if it is closed, the first once more at the end.
    pub fn positions(&self) -> Vec<DVec3> {
        let again = self.points.first().filter(|_| self.is_closed);
        self.points.iter().chain(again).map(|point| point.position).collect()
    }
}

/// Work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IntersectionCounts {
    /// Pairs of triangles whose boxes touch, or nearly do.
    pub pairs: usize,
    /// Pairs of triangles that overlap in one plane; curves are found only where such regions end.
    pub coincident: usize,
    /// Points of the polylines of the triangles.
    pub raw: usize,
    /// Points that were added to come near to the curve.
    pub added: usize,
    /// Gaps that were to get a point, but got none, because the iteration failed there.
    pub unfilled: usize,
}

/// In what two sheets meet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intersection {
    /// The curves. Where two cross, each continues straight.
    pub branches: Vec<Branch>,
    /// Points in which the surfaces touch and have no others in common nearby.
    pub touching: Vec<CurvePoint>,
    /// Work done.
    pub counts: IntersectionCounts,
}

impl Intersection {
    /// All points of all branches, and those in which the surfaces touch.
    pub fn points(&self) -> impl Iterator<Item = &CurvePoint> {
        self.branches.iter().flat_map(|branch| &branch.points).chain(&self.touching)
    }

    /// The curves as runs of lines.
    pub fn polylines(&self) -> Polylines {
        let mut lines = Polylines::default();
        for mut run in self.branches.iter().map(Branch::positions) {
            run.dedup();
            if run.len() > 1 {
                lines.starts.push(lines.points.len());
                lines.points.extend(run);
            }
        }
        lines
    }
}
