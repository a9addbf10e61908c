//! Newton's method for points on two or three surfaces.

use glam::DVec3;

use super::point::{CurvePoint, CurvePrecision, Inaccuracy, Mark, SheetCoordinates};
use super::sheet::{Foot, PreparedSheet};

/// Steps at most; five are usual.
const MOST_STEPS: usize = 40;
/// Steps without a residual of half the size, after which no better one is expected.
const MOST_STALE: usize = 3;
/// Steps end at residuals of this part of the tolerance: the last one squares what is left.
const ENOUGH: f64 = 1e-3;
/// The sine of the angle below which surfaces count as touching, where no more accurate answer was found.
const NEARLY_PARALLEL: f64 = 1e-5;
/// The determinant of three unit normals from which on they determine a point well.
const INDEPENDENT: f64 = 1e-3;
/// Residuals this many roundings of the coordinates high cannot be avoided.
const ROUNDINGS: f64 = 16.0;
/// Distance of a foot point beside its point, along the surface, as a part of the reach, where it lies on a border.
const BESIDE: f64 = 1e-9;

/// Finds points on the surfaces of two sheets.
pub struct NewtonSolver<'a> {
    pub sheets: &'a [PreparedSheet<'a>; 2],
    /// The residual at which a point counts as found, model units.
    pub tolerance: f64,
}

/// A point that was found, or at which an iteration ended.
#[derive(Clone, Copy, Debug)]
pub struct NewtonPoint {
    pub at: DVec3,
    pub coordinates: [SheetCoordinates; 2],
    pub normals: [DVec3; 2],
    pub residual: f64,
    pub inaccuracy: Option<Inaccuracy>,
}

impl NewtonPoint {
    /// Along the curve; zero where the surfaces touch.
    pub fn tangent(&self) -> DVec3 {
        self.normals[0].cross(self.normals[1]).normalize_or_zero()
    }

    /// The point of a curve, whose direction is not known yet.
    pub fn point(&self, mark: Mark) -> CurvePoint {
        let [n, m] = self.normals;
        CurvePoint {
            position: self.at,
            coordinates: self.coordinates,
            residual: self.residual,
            tangent: self.tangent(),
            angle: n.cross(m).length().atan2(n.dot(m).abs()).to_degrees(),
            mark,
            inaccuracy: self.inaccuracy,
        }
    }
}

impl<'a> NewtonSolver<'a> {
    /// Prepares for two `sheets`.
    pub fn new(sheets: &'a [PreparedSheet<'a>; 2], precision: &CurvePrecision) -> NewtonSolver<'a> {
        let bounds = sheets.each_ref().map(|ground| ground.sheet.mesh.bounds());
        let size = bounds.iter().flatten().map(|bounds| bounds.diagonal()).fold(0.0, f64::max);
        let farthest = bounds.iter().flatten().map(|b| b.min.abs().max(b.max.abs()).max_element()).fold(0.0, f64::max);
        let newton = if precision.newton > 0.0 { precision.newton } else { 0.0 };
        NewtonSolver { sheets, tolerance: (newton * size).max(ROUNDINGS * f64::EPSILON * farthest) }
    }

    /// The foot point of a point on a sheet, and its place there: beyond the border of the surface if a neighbour is
    /// nearer.
    pub fn foot(&self, side: usize, place: SheetCoordinates, at: DVec3, reach: f64) -> (SheetCoordinates, Foot) {
        let ground = &self.sheets[side];
        let foot = ground.foot(&place, at);
        if beside(&foot, at) > BESIDE * reach
            && let Some(next) = ground.beyond(&place, at)
        {
            let other = ground.foot(&next, at);
            // On the neighbour, it need not only be nearer, but lie within.
            if other.point.distance(at) < foot.point.distance(at) && beside(&other, at) < 0.5 * beside(&foot, at) {
                return (SheetCoordinates { uv: other.uv, ..next }, other);
            }
        }
        (SheetCoordinates { uv: foot.uv, ..place }, foot)
    }

    /// The point near `start` on both surfaces.
    ///
    /// - `across`: a direction in which the point stays level; without one, each step is the shortest.
    /// - `reach`: how far the point may be, model units.
    pub fn solve(&self, places: [SheetCoordinates; 2], start: DVec3, across: Option<DVec3>, reach: f64) -> NewtonPoint {
        let newton_point = self.iterate(places, start, across, reach);
        if newton_point.inaccuracy != Some(Inaccuracy::Beyond) {
            return newton_point;
        }
        // The other surface may meet what lies behind the border, even if that bends away.
        let mut best = newton_point;
        for side in [0, 1] {
            let Some(next) = self.sheets[side].beyond(&newton_point.coordinates[side], newton_point.at) else {
                continue;
            };
            let mut places = newton_point.coordinates;
            places[side] = next;
            let other = self.iterate(places, start, across, reach);
            if other.residual < best.residual {
                best = other;
            }
        }
        best
    }

    fn iterate(
        &self,
        mut places: [SheetCoordinates; 2],
        start: DVec3,
        across: Option<DVec3>,
        reach: f64,
    ) -> NewtonPoint {
        let mut at = start;
        let mut best: Option<NewtonPoint> = None;
        let (mut stale, mut is_beside) = (0, false);
        for _ in 0..MOST_STEPS {
            let feet = [0, 1].map(|side| self.foot(side, places[side], at, reach));
            places = feet.map(|(place, _)| place);
            let [(_, one), (_, two)] = feet;
            let residual = one.point.distance(two.point);
            let last = best.map_or(f64::INFINITY, |newton_point| newton_point.residual);
            if residual < last {
                is_beside = feet.iter().any(|(_, foot)| beside(foot, at) > self.tolerance);
                let middle = one.point.midpoint(two.point);
                best = Some(NewtonPoint {
                    at: middle,
                    coordinates: places,
                    normals: [one.normal, two.normal],
                    residual,
                    inaccuracy: None,
                });
            }
            stale = if residual < 0.5 * last { 0 } else { stale + 1 };
            if residual <= ENOUGH * self.tolerance || stale > 0 && last <= self.tolerance || stale >= MOST_STALE {
                break;
            }
            let (n, m) = (one.normal, two.normal);
            let third = across.unwrap_or(n.cross(m).normalize_or_zero());
            let level = across.map_or(0.0, |across| across.dot(start - at));
            let heights = [n.dot(one.point - at), m.dot(two.point - at), level];
            let Some(step) = plane_intersection([n, m, third], heights) else { break };
            at += step.clamp_length_max(0.5 * reach);
            if !at.is_finite() {
                break;
            }
        }
        self.with_inaccuracy(best, places, start, reach, is_beside)
    }

    /// Says what is wrong with a point, if anything is.
    fn with_inaccuracy(
        &self,
        best: Option<NewtonPoint>,
        places: [SheetCoordinates; 2],
        start: DVec3,
        reach: f64,
        is_beside: bool,
    ) -> NewtonPoint {
        let nowhere = NewtonPoint {
            at: start,
            coordinates: places,
            normals: [DVec3::ZERO; 2],
            residual: f64::MAX,
            inaccuracy: None,
        };
        let mut newton_point = best.filter(|newton_point| newton_point.residual.is_finite()).unwrap_or(nowhere);
        newton_point.inaccuracy = if newton_point.residual > self.tolerance {
            let sine = newton_point.normals[0].cross(newton_point.normals[1]).length();
            Some(match () {
                () if is_beside => Inaccuracy::Beyond,
                () if sine < NEARLY_PARALLEL => Inaccuracy::Parallel,
                () => Inaccuracy::Slow,
            })
        } else if newton_point.at.distance(start) > reach {
            Some(Inaccuracy::Astray)
        } else {
            None
        };
        newton_point
    }

    /// The point near `start` where two surfaces of one sheet and one of the other meet; none if they touch there, or
    /// do not meet.
    ///
    /// - `places`: on the first sheet before and behind the border, on the second before and behind.
    /// - Returns what was found before and behind.
    pub fn corner(&self, places: [[SheetCoordinates; 2]; 2], start: DVec3, reach: f64) -> Option<[NewtonPoint; 2]> {
        let [before, behind] = [0, 1].map(|k| [places[0][k], places[1][k]]);
        let side = usize::from(before[0].is_beside(&behind[0]));
        let mut three = [(side, before[side]), (side, behind[side]), (1 - side, before[1 - side])];
        let mut at = start;
        let mut smallest = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let feet = three.each_ref().map(|(side, place)| self.sheets[*side].foot(place, at));
            three.iter_mut().zip(&feet).for_each(|((_, place), foot)| place.uv = foot.uv);
            let normals = feet.map(|foot| foot.normal);
            let [a, b, c] = normals;
            if a.dot(b.cross(c)).abs() < INDEPENDENT {
                return None;
            }
            let step = plane_intersection(normals, feet.map(|foot| foot.normal.dot(foot.point - at)))?;
            if step.length() >= smallest {
                break;
            }
            smallest = step.length();
            at += step;
            if at.distance(start) > reach || !at.is_finite() {
                return None;
            }
        }
        let ends = [before, behind].map(|places| self.unrefined(places, at));
        ends.iter().all(|newton_point| newton_point.inaccuracy.is_none()).then_some(ends)
    }

    /// The point near `start` at which a surface ends on the other surface; none if neither ends there.
    pub fn border(&self, mut places: [SheetCoordinates; 2], start: DVec3, reach: f64) -> Option<NewtonPoint> {
        let mut at = start;
        let mut outwards = None;
        let mut smallest = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let feet = [0, 1].map(|side| self.sheets[side].foot(&places[side], at));
            (0..2).for_each(|side| places[side].uv = feet[side].uv);
            let side = usize::from(beside(&feet[0], at) < beside(&feet[1], at));
            let offset = at - feet[side].point;
            // From a border, the nearest point inside is straight across it.
            if beside(&feet[side], at) > BESIDE * reach {
                outwards = Some((side, offset.reject_from_normalized(feet[side].normal).normalize_or_zero()));
            }
            let (side, outwards) = outwards?;
            let [n, m] = feet.map(|foot| foot.normal);
            let heights = [n.dot(feet[0].point - at), m.dot(feet[1].point - at), outwards.dot(feet[side].point - at)];
            let step = plane_intersection([n, m, outwards], heights)?;
            if step.length() >= smallest {
                break;
            }
            smallest = step.length();
            at += step;
            if at.distance(start) > reach {
                return None;
            }
        }
        Some(self.unrefined(places, at)).filter(|newton_point| newton_point.inaccuracy.is_none())
    }

    /// The unrefined point: how far its foot points are apart.
    fn unrefined(&self, places: [SheetCoordinates; 2], at: DVec3) -> NewtonPoint {
        let feet = [0, 1].map(|side| self.sheets[side].foot(&places[side], at));
        let [one, two] = feet;
        let places = [SheetCoordinates { uv: one.uv, ..places[0] }, SheetCoordinates { uv: two.uv, ..places[1] }];
        let residual = one.point.distance(two.point).max(one.point.distance(at)).max(two.point.distance(at));
        let failure = (residual > self.tolerance).then_some(Inaccuracy::Slow);
        NewtonPoint { at, coordinates: places, normals: [one.normal, two.normal], residual, inaccuracy: failure }
    }

    /// How far a point near two triangles may be from where the triangles meet.
    pub fn reach(&self, triangles: [u32; 2]) -> f64 {
        2.0 * self.sheets[0].reach(triangles[0]).max(self.sheets[1].reach(triangles[1]))
    }
}

/// How far a foot point is beside its point, along the surface.
pub fn beside(foot: &Foot, at: DVec3) -> f64 {
    let offset = at - foot.point;
    (offset - foot.normal * offset.dot(foot.normal)).length()
}

/// The vector with given heights over three planes through the origin, of unit normals; none if they do not determine
/// it.
fn plane_intersection([a, b, c]: [DVec3; 3], heights: [f64; 3]) -> Option<DVec3> {
    let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
    let determinant = a.dot(bc);
    let step = (bc * heights[0] + ca * heights[1] + ab * heights[2]) / determinant;
    step.is_finite().then_some(step)
}
