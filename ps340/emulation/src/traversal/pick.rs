//! Picking: which vector is drawn inside the pick box first, and what is known about it.
//!
//! # Source
//! As remembered from the manuals: traversal order decides, only data below SET PICKING ON is considered, the
//! identifiers are listed from the data upward. That a pick needs at least one identifier is uncertain.

use super::outline::LineSegment;
use crate::{port::ObjectId, structure::State};
use glam::{DVec2, DVec3, DVec4};
use protocol::{Name, value::PickCoordinates};

/// What is to be picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickRequest {
    /// Centre of the pick box on the screen, -1..=1.
    pub center: DVec2,
    /// Half its width and height.
    pub half_size: DVec2,
    /// Whether pick coordinates are requested too.
    pub coordinates: bool,
}

/// The first thing that was drawn inside the pick box.
#[derive(Clone, Debug, PartialEq)]
pub struct PickHit {
    /// Number of the vector, character, label or polygon in its node, from 1.
    pub index: u32,
    /// The pick identifiers on the way, nearest first.
    pub identifiers: Vec<Name>,
    /// The data node, if it is an object.
    pub node: Option<ObjectId>,
    /// What kind of data.
    pub kind: PickedKind,
    /// Where it was picked, if that was requested: the point of the vector that is nearest to the centre of the box.
    pub coordinates: Option<PickCoordinates>,
}

/// The kind of data that was picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PickedKind {
    /// VECTOR_LIST.
    Vectors,
    /// BSPLINE, POLYNOMIAL.
    Curve,
    /// CHARACTERS.
    Characters,
    /// LABELS.
    Labels,
    /// POLYGON.
    Polygons,
}

impl PickedKind {
    /// The code for functions; ours, that of the machine is not known.
    pub const fn code(self) -> i32 {
        match self {
            PickedKind::Vectors => 1,
            PickedKind::Curve => 2,
            PickedKind::Characters => 3,
            PickedKind::Labels => 4,
            PickedKind::Polygons => 5,
        }
    }
}

/// The pick box in clip space, for data in one state.
pub(super) struct PickBox {
    /// Planes whose coordinate is not negative inside, as (x, y, z, w) coefficients.
    planes: [DVec4; 11],
    count: usize,
    /// From clip coordinates over w to the screen, and the centre there.
    half: DVec2,
    middle: DVec2,
    center: DVec2,
}

impl PickBox {
    pub(super) fn new(request: &PickRequest, state: &State) -> PickBox {
        let [center, half_size] = state.pick_box.unwrap_or([request.center, request.half_size]);
        let span = |[low, high]: [f64; 2]| ((low + high) / 2.0, (high - low) / 2.0);
        let ((mx, hx), (my, hy)) = (span(state.horizontal), span(state.vertical));
        let (low, high) = (center - half_size.abs(), center + half_size.abs());
        let planes = [
            // w > 0, as far as a closed half space can express it.
            DVec4::W,
            DVec4::new(1.0, 0.0, 0.0, 1.0),
            DVec4::new(-1.0, 0.0, 0.0, 1.0),
            DVec4::new(0.0, 1.0, 0.0, 1.0),
            DVec4::new(0.0, -1.0, 0.0, 1.0),
            // low <= m + h x / w <= high
            DVec4::new(hx, 0.0, 0.0, mx - low.x),
            DVec4::new(-hx, 0.0, 0.0, high.x - mx),
            DVec4::new(0.0, hy, 0.0, my - low.y),
            DVec4::new(0.0, -hy, 0.0, high.y - my),
            DVec4::Z,
            DVec4::new(0.0, 0.0, -1.0, 1.0),
        ];
        let count = if state.depth_clipping { 11 } else { 9 };
        PickBox { planes, count, half: DVec2::new(hx, hy), middle: DVec2::new(mx, my), center }
    }

    /// The part of a segment inside the box, as parameters 0..=1 along it; none if nothing of it is inside.
    pub(super) fn inside(&self, [a, b]: [DVec4; 2]) -> Option<[f64; 2]> {
        let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
        for plane in &self.planes[..self.count] {
            let (p, q) = (plane.dot(a), plane.dot(b));
            if !(p >= 0.0 || q >= 0.0) {
                return None;
            }
            if p < 0.0 {
                t0 = t0.max(p / (p - q));
            } else if q < 0.0 {
                t1 = t1.min(p / (p - q));
            }
        }
        let seen = (a + (b - a) * t0).w > 0.0 || (a + (b - a) * t1).w > 0.0;
        (t0 <= t1 && seen).then_some([t0, t1])
    }

    /// The parameter along a segment, between two, whose position on the screen is nearest to the centre of the box.
    fn nearest(&self, [a, b]: [DVec4; 2], [t0, t1]: [f64; 2]) -> f64 {
        let at = |t: f64| a + (b - a) * t;
        let screen = |p: DVec4| self.middle + self.half * p.truncate().truncate() / p.w;
        let (p, q) = (at(t0), at(t1));
        let (from, along) = (screen(p), screen(q) - screen(p));
        let length = along.length_squared();
        let s = if length > 0.0 { ((self.center - from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        // Equal steps on the screen are not equal steps along the line: undo the division by w.
        let fraction = s * p.w / ((1.0 - s) * q.w + s * p.w);
        if fraction.is_finite() { t0 + (t1 - t0) * fraction } else { t0 }
    }

    /// The pick coordinates on a segment that was hit, and how far along it they are.
    pub(super) fn coordinates_on(&self, piece: &LineSegment, span: [f64; 2]) -> (DVec3, f64) {
        let t = self.nearest(piece.ends, span);
        (piece.source[0].lerp(piece.source[1], t), t)
    }
}
