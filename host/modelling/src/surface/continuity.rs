//! How well surfaces meet along their sides.

use glam::DVec3;
use rayon::prelude::*;

use super::curvature::{Curved, normal_curvature};
use super::shared_curves::{SharedCurves, along_side};

/// A side of the rectangle of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceSide {
    /// The lowest v; u rises along it.
    LowV,
    /// The highest v; u rises along it.
    HighV,
    /// The lowest u; v rises along it.
    LowU,
    /// The highest u; v rises along it.
    HighU,
}

impl SurfaceSide {
    /// All four, in the order of their numbers.
    pub(super) const ALL: [SurfaceSide; 4] =
        [SurfaceSide::LowV, SurfaceSide::HighV, SurfaceSide::LowU, SurfaceSide::HighU];

    /// The side across.
    pub fn opposite(self) -> SurfaceSide {
        match self {
            SurfaceSide::LowV => SurfaceSide::HighV,
            SurfaceSide::HighV => SurfaceSide::LowV,
            SurfaceSide::LowU => SurfaceSide::HighU,
            SurfaceSide::HighU => SurfaceSide::LowU,
        }
    }

    /// Whether it lies at the high end of the direction across it.
    pub(super) fn is_high(self) -> bool {
        matches!(self, SurfaceSide::HighV | SurfaceSide::HighU)
    }
}

/// The continuity that holds along a side in which two surfaces meet: the largest differences found there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// The surfaces, and the sides with which they meet.
    pub sides: [(usize, SurfaceSide); 2],
    /// The distance between points of the two at equal parts of their sides, model units.
    pub gap: f64,
    /// The angle between the normals, degrees; 180 where the surfaces meet with opposite outsides.
    pub angle: f64,
    /// The difference between the curvatures of the sections across the joint, 1 / model unit. Where there is no angle,
    /// it is the largest difference between all sections.
    pub curvature_difference: f64,
    /// The largest of these curvatures, without sign.
    pub curvature: f64,
}

/// Measures how side `sides[0]` of `a` meets side `sides[1]` of `b`, at `samples` points (>= 2) along them; the sides
/// may run in opposite directions. Points where a derivative vanishes have no curvature and are left out of that.
pub fn joint<A: Curved + ?Sized, B: Curved + ?Sized>(a: &A, b: &B, sides: [SurfaceSide; 2], samples: usize) -> Joint {
    let fraction = |k: usize| k as f64 / (samples.max(2) - 1) as f64;
    let at_a = |fraction| along_side(a.domain(), sides[0] as usize, fraction);
    let at_b = |fraction| along_side(b.domain(), sides[1] as usize, fraction);
    let total = |turned: bool| -> f64 {
        let gap = |f: f64| a.point(at_a(f)).distance(b.point(at_b(if turned { 1.0 - f } else { f })));
        (0..5).map(|k| gap(f64::from(k) / 4.0)).sum()
    };
    let is_turned = total(true) < total(false);
    let places = sides.map(|side| (0, side));
    let mut joint = Joint { sides: places, gap: 0.0, angle: 0.0, curvature_difference: 0.0, curvature: 0.0 };
    for k in 0..samples.max(2) {
        let (in_a, in_b) = (at_a(fraction(k)), at_b(if is_turned { 1.0 - fraction(k) } else { fraction(k) }));
        joint.gap = joint.gap.max(a.point(in_a).distance(b.point(in_b)));
        let (normal, other) = (a.normal(in_a), b.normal(in_b));
        joint.angle = joint.angle.max(normal.cross(other).length().atan2(normal.dot(other)).to_degrees());
        let along = a.derivatives(in_a)[usize::from((sides[0] as usize) > 1)];
        let across: DVec3 = normal.cross(along);
        if let (Some(x), Some(y)) = (normal_curvature(a, in_a, across), normal_curvature(b, in_b, across)) {
            joint.curvature_difference = joint.curvature_difference.max((x - y).abs());
            joint.curvature = joint.curvature.max(x.abs()).max(y.abs());
        }
    }
    joint
}

/// The continuity along every side that two of `surfaces` share, measured at `samples` points of each.
///
/// Sides are shared if they agree as [`super::tessellate`] asks. Where more than two surfaces meet in a side, each is
/// compared with the next. The order is that of the surfaces.
pub fn continuity<S: Curved>(surfaces: &[S], samples: usize) -> Vec<Joint> {
    let borders = SharedCurves::of(surfaces);
    let mut last: Vec<Option<(usize, SurfaceSide)>> = vec![None; borders.first.len()];
    let mut pairs = Vec::new();
    for (surface, sides) in borders.sides.iter().enumerate() {
        for (side, kind) in sides.iter().zip(SurfaceSide::ALL).filter(|(side, _)| !side.is_point) {
            if let Some(before) = last[side.curve].replace((surface, kind)) {
                pairs.push([before, (surface, kind)]);
            }
        }
    }
    let measure = |sides: &[(usize, SurfaceSide); 2]| {
        let [(a, side_a), (b, side_b)] = *sides;
        Joint { sides: *sides, ..joint(&surfaces[a], &surfaces[b], [side_a, side_b], samples) }
    };
    pairs.par_iter().map(measure).collect()
}
