//! Places where surfaces touch, or nearly do, and what they are.

use glam::DVec3;
use rayon::prelude::*;

use super::critical::CriticalPoint;
use super::follow::along_valley;
use super::newton::{NewtonPoint, NewtonSolver};
use super::point::{CurvePoint, Inaccuracy, Mark};
use super::polyline::TrianglePolylines;

/// Triangles are trusted from where the surfaces part by so many times what the triangles are away from them.
const TRUST: f64 = 16.0;
/// Below this times what the reach makes of it, a curvature is none: the surfaces coincide.
const COINCIDENT: f64 = 1e-7;
/// Critical points nearer to each other than this part of the reach are one.
const SAME: f64 = 1e-3;

/// The kind of a critical point of the distance, for the curves around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneKind {
    /// The surfaces touch, and part all around.
    Touching,
    /// The surfaces touch, and two curves cross.
    Branching,
    /// The surfaces do not touch: a small curve goes around it, or they part.
    Around,
    /// The surfaces do not touch: two curves pass it.
    Passing,
    /// A part of a curve along which the distance does not change.
    Valley,
}

/// A critical point, and how far around it triangles are not trusted.
#[derive(Clone, Debug)]
pub struct Zone {
    pub center: CriticalPoint,
    pub kind: ZoneKind,
    /// Distance between the surfaces, model units, from half of which on triangles are trusted.
    level: f64,
    /// The distance of the triangles from the surfaces, or of the surfaces from each other.
    pub error: f64,
    /// How far it reaches at most.
    pub extent: f64,
    /// The reach of the triangles.
    pub reach: f64,
}

/// A curve along which the distance does not change.
#[derive(Clone, Debug)]
pub struct Valley {
    pub points: Vec<CriticalPoint>,
    pub is_closed: bool,
    pub reach: f64,
}

/// All places where surfaces touch, or nearly do.
#[derive(Clone, Debug, Default)]
pub struct Zones {
    pub all: Vec<Zone>,
    pub valleys: Vec<Valley>,
}

impl Zone {
    fn new(found: &ZoneCandidate, kind: ZoneKind, tolerance: f64) -> Zone {
        let error = found.error.max(found.critical.gap.abs()).max(100.0 * tolerance);
        let (level, extent) = (TRUST * error, 4.0 * found.reach);
        Zone { center: found.critical, kind, level, error, extent, reach: found.reach }
    }

    /// Whether it holds a point.
    pub fn contains(&self, point: DVec3) -> bool {
        let offset = point - self.center.at;
        let [a, b] = self.center.curvatures.map(f64::abs);
        let [x, y] = self.center.directions.map(|direction| direction.dot(offset).powi(2));
        let rise = a * x + b * y + a * (offset.length_squared() - x - y).max(0.0);
        rise <= self.level && offset.length() <= self.extent
    }

    /// How far it goes along a direction of the tangent plane.
    pub fn radius(&self, direction: DVec3) -> f64 {
        let rise = |k: usize| self.center.curvatures[k].abs() * self.center.directions[k].dot(direction).powi(2);
        (self.level / (rise(0) + rise(1))).sqrt().min(self.extent)
    }

    /// The directions of the four curves that begin in a branching point; the third and fourth are opposite to the
    /// first and second.
    pub fn branches(&self) -> [DVec3; 4] {
        let [a, b] = self.center.curvatures.map(|curvature| curvature.abs().sqrt());
        let [x, y] = self.center.directions;
        let [one, two] = [x * b + y * a, x * b - y * a].map(DVec3::normalize_or_zero);
        [one, two, -one, -two]
    }
}

impl CriticalPoint {
    /// The point of a curve.
    pub fn point(&self, mark: Mark, tangent: DVec3, tolerance: f64) -> CurvePoint {
        let residual = self.gap.abs();
        let failure = (residual > tolerance).then_some(Inaccuracy::Parallel);
        CurvePoint { tangent, ..NewtonPoint { inaccuracy: failure, residual, ..self.newton_point() }.point(mark) }
    }

    /// The critical point as a beginning of other points.
    pub fn newton_point(&self) -> NewtonPoint {
        NewtonPoint {
            at: self.at,
            coordinates: self.coordinates,
            normals: self.normals,
            residual: self.gap.abs(),
            inaccuracy: None,
        }
    }

    /// The distances from it along the direction of the greater curvature at which the surfaces cross; none if they do
    /// not.
    pub fn crossing(&self) -> Option<f64> {
        let square = -2.0 * self.gap / self.curvatures[0];
        (square > 0.0).then(|| square.sqrt())
    }
}

/// A critical point, with what its triangles are.
struct ZoneCandidate {
    critical: CriticalPoint,
    /// The distance of the triangles from the surfaces.
    error: f64,
    reach: f64,
}

/// Finds zones from pairs of triangles.
pub fn find(solver: &NewtonSolver<'_>, raw: &TrianglePolylines) -> Zones {
    let search = |pair: &[u32; 2]| {
        let [one, two] = [0, 1].map(|k| solver.sheets[k].reach(pair[k]));
        let small = usize::from(one > two);
        let corners = solver.sheets[small].sheet.mesh.corners(pair[small] as usize);
        let start = corners.iter().sum::<DVec3>() / 3.0;
        let places = [0, 1].map(|k| solver.sheets[k].coordinates(pair[k], start));
        let (reach, error) =
            (3.0 * one.min(two), solver.sheets[0].sagitta(pair[0]) + solver.sheets[1].sagitta(pair[1]));
        let critical = solver.critical(places, start, reach)?;
        let is_near = critical.gap.abs() <= 2.0 * error + solver.tolerance;
        let is_bent = critical.curvatures[0].abs() * reach > COINCIDENT;
        (is_near && is_bent).then_some(ZoneCandidate { critical, error, reach })
    };
    let found: Vec<ZoneCandidate> = raw.near.par_iter().filter_map(search).collect();
    let mut zones = Zones::default();
    for found in &found {
        zones.add(solver, found);
    }
    zones.part();
    zones
}

impl Zones {
    fn add(&mut self, solver: &NewtonSolver<'_>, found: &ZoneCandidate) {
        let ZoneCandidate { critical, reach, .. } = found;
        let near = |at: DVec3, part: f64| at.distance(critical.at) <= part * reach;
        let is_known =
            self.all.iter().any(|zone| near(zone.center.at, if zone.kind == ZoneKind::Valley { 0.3 } else { SAME }));
        if is_known {
            return;
        }
        if critical.is_flat() {
            let (points, is_closed) = along_valley(solver, critical, reach / 6.0);
            let zone = |critical: &CriticalPoint| {
                Zone::new(&ZoneCandidate { critical: *critical, ..*found }, ZoneKind::Valley, solver.tolerance)
            };
            self.all.extend(points.iter().map(zone));
            self.valleys.push(Valley { points, is_closed, reach: *reach });
            return;
        }
        let touches = critical.gap.abs() <= solver.tolerance;
        let kind = match (critical.curvatures[0] * critical.curvatures[1] > 0.0, touches) {
            (true, true) => ZoneKind::Touching,
            (true, false) => ZoneKind::Around,
            (false, true) => ZoneKind::Branching,
            (false, false) => ZoneKind::Passing,
        };
        self.all.push(Zone::new(found, kind, solver.tolerance));
    }

    /// Keeps zones apart.
    fn part(&mut self) {
        let centers: Vec<(DVec3, bool)> =
            self.all.iter().map(|zone| (zone.center.at, zone.kind == ZoneKind::Valley)).collect();
        for (index, zone) in self.all.iter_mut().enumerate().filter(|(_, zone)| zone.kind != ZoneKind::Valley) {
            let others = centers.iter().enumerate().filter(|(other, (_, in_valley))| *other != index && !in_valley);
            let nearest = others.map(|(_, (at, _))| at.distance(zone.center.at)).fold(f64::INFINITY, f64::min);
            zone.extent = zone.extent.min(0.45 * nearest);
        }
    }

    /// The zone that holds a point, if any.
    pub fn holding(&self, point: DVec3) -> Option<usize> {
        self.all.iter().position(|zone| zone.contains(point))
    }
}
