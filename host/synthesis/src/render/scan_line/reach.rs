//! The reach of shadow polygons in the picture: what lies beyond all that is seen need not be drawn.

use super::screen::{Screen, Viewpoint, cut};
use super::spans::PictureRegion;
use crate::numeric::bounds::Bounds;
use glam::{DVec3, DVec4};

/// By how much the box round the scene is widened, as a fraction of its diagonal.
const WIDER: f64 = 1e-6;
/// Most corners of a side that was cut by the six sides of the box.
const MOST_CORNERS: usize = 4 + 6;

/// The half spaces that hold the eye and the scene.
///
/// They are convex: nothing outside of them stands between the eye and what it sees.
pub(super) struct Reach<'a> {
    screen: &'a Screen,
    /// Normals inwards, and the height of the origin above.
    planes: Vec<DVec4>,
}

impl<'a> Reach<'a> {
    /// - `bounds`: round all that is seen.
    pub(super) fn new(bounds: &Bounds, screen: &'a Screen) -> Reach<'a> {
        let eye = match screen.viewpoint {
            Viewpoint::At(eye) => eye.extend(1.0),
            Viewpoint::Towards(direction) => direction.extend(0.0),
        };
        let wider = WIDER * bounds.diagonal();
        let side = |axis: usize| {
            let normal = DVec3::AXES[axis];
            [normal.extend(wider - bounds.min[axis]), (-normal).extend(wider + bounds.max[axis])]
        };
        let planes = (0..3).flat_map(side).filter(|plane| plane.is_finite() && plane.dot(eye) >= 0.0).collect();
        Reach { screen, planes }
    }

    /// The part of the picture in which the infinite strip behind a silhouette may stand before something; none if
    /// there is no such part.
    ///
    /// - `away`: from each end the direction in which light continues, of any length.
    pub(super) fn region(&self, ends: [DVec3; 2], away: [DVec3; 2]) -> Option<PictureRegion> {
        let mut polygon = [DVec4::ZERO; MOST_CORNERS];
        polygon[..4].copy_from_slice(&[
            ends[0].extend(1.0),
            ends[1].extend(1.0),
            away[1].extend(0.0),
            away[0].extend(0.0),
        ]);
        let mut count = 4;
        for plane in &self.planes {
            let heights = polygon.map(|corner| plane.dot(corner));
            if heights[..count].iter().all(|height| *height >= 0.0) {
                continue;
            }
            // Rounding may dent it so that it has too many corners: then it is drawn as a whole.
            let Some(inside) = cut(&polygon[..count], &heights, |a, b, t| a + (b - a) * t) else {
                return Some(PictureRegion::ALL);
            };
            (polygon, count) = inside;
            if count == 0 {
                return None;
            }
        }
        Some(self.around(&polygon[..count]))
    }

    /// The part of the picture round a polygon, with a line and a column to spare.
    fn around(&self, polygon: &[DVec4]) -> PictureRegion {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for corner in polygon {
            let [x, y, _, w, ..] = self.screen.homogeneous(*corner);
            let at = [x / w, y / w];
            if !(w > 0.0 && at[0].is_finite() && at[1].is_finite()) {
                return PictureRegion::ALL;
            }
            for i in 0..2 {
                (low[i], high[i]) = (low[i].min(at[i]), high[i].max(at[i]));
            }
        }
        let range = |i: usize| (low[i] - 1.0).max(0.0) as usize..(high[i] + 2.0).max(0.0) as usize;
        PictureRegion { columns: range(0), lines: range(1) }
    }
}
