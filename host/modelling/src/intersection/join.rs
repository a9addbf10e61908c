//! From polylines of triangles and places where surfaces touch to ordered curves.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use super::critical::CriticalPoint;
use super::follow::{End, follow};
use super::newton::{NewtonPoint, NewtonSolver};
use super::point::{Branch, CurvePoint, Intersection, IntersectionCounts, Mark};
use super::polyline::{TrianglePolyline, TrianglePolylines};
use super::refine::between;
use super::zone::{Valley, Zone, ZoneKind, Zones};

/// A curve that comes into a branching point leaves along one of its directions within this cosine.
const ALIKE: f64 = 0.5;

/// Steps beside a point that curves pass, as a part of the distance from it.
const BEND: f64 = 0.25;
/// How far behind the end of a polyline the border of its surface is looked for, as a part of the reach.
const BEHIND: f64 = 0.05;

/// A part of a curve.
#[derive(Default)]
struct Arc {
    points: Vec<CurvePoint>,
    /// The zones in which it was cut off.
    zones: [Option<usize>; 2],
    is_closed: bool,
}

/// An end of an arc: which arc, and 0 for its beginning.
type Tip = (usize, usize);

/// Makes the curves.
pub fn branches(solver: &NewtonSolver<'_>, raw: &TrianglePolylines, zones: &Zones) -> Intersection {
    let mut joiner = Joiner { solver, arcs: Vec::new(), goes_on: HashMap::new() };
    for polyline in &raw.polylines {
        joiner.cut(polyline, zones);
    }
    let cut = joiner.arcs.len();
    let mut tips: Vec<Vec<Tip>> = vec![Vec::new(); zones.all.len()];
    for (index, arc) in joiner.arcs.iter().enumerate() {
        for (end, zone) in arc.zones.iter().enumerate() {
            zone.iter().for_each(|&zone| tips[zone].push((index, end)));
        }
    }
    let mut touching = Vec::new();
    for (zone, tips) in zones.all.iter().zip(tips) {
        match zone.kind {
            ZoneKind::Touching => touching.push(zone.center.point(Mark::Tangent, DVec3::ZERO, solver.tolerance)),
            ZoneKind::Branching => joiner.branch(zone, &tips),
            ZoneKind::Around => joiner.around(&zone.center),
            ZoneKind::Passing => joiner.pass(zone, &tips),
            ZoneKind::Valley => {}
        }
    }
    zones.valleys.iter().for_each(|valley| joiner.valley(valley));
    let raw_points = joiner.arcs[..cut].iter().map(|arc| arc.points.len()).sum();
    let work = IntersectionCounts {
        pairs: raw.pairs,
        coincident: raw.coincident,
        raw: raw_points,
        ..IntersectionCounts::default()
    };
    Intersection { branches: joiner.joined(), touching, counts: work }
}

struct Joiner<'a> {
    solver: &'a NewtonSolver<'a>,
    arcs: Vec<Arc>,
    /// The end that follows each end.
    goes_on: HashMap<Tip, Tip>,
}

impl Joiner<'_> {
    /// Cuts the zones out of a polyline, and makes the rest accurate.
    fn cut(&mut self, polyline: &TrianglePolyline, zones: &Zones) {
        let count = polyline.points.len();
        let within: Vec<Option<usize>> = polyline.points.par_iter().map(|point| zones.holding(*point)).collect();
        let solver = self.solver;
        let accurate =
            |index: usize| if within[index].is_none() { accurate(solver, polyline, index) } else { Vec::new() };
        let points: Vec<Vec<CurvePoint>> = (0..count).into_par_iter().map(accurate).collect();
        if within.iter().all(Option::is_none) {
            self.arcs.push(Arc { points: points.concat(), is_closed: polyline.is_closed, ..Arc::default() });
            return;
        }
        // A closed polyline is read from a zone on.
        let first = if polyline.is_closed { within.iter().position(Option::is_some).unwrap_or(0) } else { 0 };
        let (mut arc, mut last) = (Arc::default(), None);
        for step in 0..count + usize::from(polyline.is_closed) {
            let index = (first + step) % count;
            if let Some(zone) = within[index] {
                arc.zones[1] = Some(zone);
                self.end(std::mem::take(&mut arc));
                last = Some(zone);
                continue;
            }
            if arc.points.is_empty() {
                arc.zones[0] = last;
            }
            arc.points.extend(&points[index]);
        }
        self.end(arc);
    }

    fn end(&mut self, arc: Arc) {
        if !arc.points.is_empty() {
            self.arcs.push(arc);
        }
    }

    fn tip(&self, (arc, end): Tip) -> &CurvePoint {
        let points = &self.arcs[arc].points;
        if end == 0 { &points[0] } else { &points[points.len() - 1] }
    }

    /// Lets the arcs that were cut off around a branching point go through it.
    fn branch(&mut self, zone: &Zone, tips: &[Tip]) {
        let directions = zone.branches();
        let mut fits: Vec<(f64, usize, Tip)> = Vec::new();
        for &tip in tips {
            let way = (self.tip(tip).position - zone.center.at).normalize_or_zero();
            fits.extend(directions.iter().enumerate().map(|(slot, direction)| (direction.dot(way), slot, tip)));
        }
        fits.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut slots: [Option<Tip>; 4] = [None; 4];
        for (cosine, slot, tip) in fits {
            if cosine > ALIKE && slots[slot].is_none() && !slots.contains(&Some(tip)) {
                slots[slot] = Some(tip);
                let point = zone.center.point(Mark::Branching, directions[slot], self.solver.tolerance);
                // Lines are as near to the curve here as where triangles tell.
                let mut inner = between(self.solver, zone.error, [&point, self.tip(tip)]);
                let points = &mut self.arcs[tip.0].points;
                inner.insert(0, point);
                if tip.1 == 0 {
                    points.splice(0..0, inner);
                } else {
                    points.extend(inner.into_iter().rev());
                }
            }
        }
        for slot in 0..2 {
            if let (Some(one), Some(two)) = (slots[slot], slots[slot + 2]) {
                self.join(one, two);
            }
        }
    }

    fn join(&mut self, one: Tip, two: Tip) {
        self.goes_on.insert(one, two);
        self.goes_on.insert(two, one);
    }

    /// The small curve around a point where the surfaces nearly touch.
    fn around(&mut self, center: &CriticalPoint) {
        let Some(distance) = center.crossing() else { return };
        self.closed_curve(center, center.directions[0] * distance, 0.5 * distance, usize::MAX);
    }

    /// A curve that passes a critical point at some offset.
    fn closed_curve(&mut self, center: &CriticalPoint, offset: DVec3, step: f64, most: usize) {
        let along = center.directions[1];
        let start = self.solver.solve(center.coordinates, center.at + offset, Some(along), offset.length());
        let mut points = vec![start.point(Mark::Regular)];
        let mut is_closed = false;
        if start.inaccuracy.is_none() {
            let tangent = start.tangent();
            let direction = if tangent.dot(along) < 0.0 { -tangent } else { tangent };
            let mut count = 0;
            let mut goes_on = |_: &NewtonPoint| {
                count += 1;
                count < most
            };
            let (ahead, end) = follow(self.solver, &start, direction, |_| step, &mut goes_on);
            is_closed = end == End::Closed;
            points.extend(ahead.iter().map(|newton_point| newton_point.point(Mark::Regular)));
            if !is_closed {
                let (behind, _) = follow(self.solver, &start, -direction, |_| step, &mut goes_on);
                points.splice(0..0, behind.iter().rev().map(|newton_point| newton_point.point(Mark::Regular)));
            }
        }
        self.arcs.push(Arc { points, is_closed, ..Arc::default() });
    }

    /// Follows the curves that pass a point where the surfaces nearly touch.
    fn pass(&mut self, zone: &Zone, tips: &[Tip]) {
        let step = zone.branches()[..2].iter().map(|d| zone.radius(*d)).fold(f64::INFINITY, f64::min) / 4.0;
        // So far from the middle the curves turn; a longer step would jump straight across to the other curve.
        let bend = (2.0 * zone.center.gap / zone.center.curvatures[0]).abs().sqrt();
        let mut open: Vec<Tip> = tips.to_vec();
        while let Some(tip) = open.pop() {
            let start = *self.tip(tip);
            if start.inaccuracy.is_some() || open.is_empty() {
                continue;
            }
            let inwards = zone.center.at - start.position;
            let direction = if start.tangent.dot(inwards) < 0.0 { -start.tangent } else { start.tangent };
            let from = self.solver.solve(start.coordinates, start.position, Some(direction), zone.reach);
            let ends: Vec<DVec3> = open.iter().map(|&tip| self.tip(tip).position).collect();
            // It ends beside the first of the other ends that it passes.
            let mut last = start.position;
            let mut arrived = None;
            let longest = |at: DVec3| step.min(at.distance(zone.center.at).max(bend) * BEND);
            let (points, _) = follow(self.solver, &from, direction, longest, |newton_point| {
                let way = newton_point.at - last;
                let passed = |end: &DVec3| (*end - last).dot(way) > 0.0 && (*end - newton_point.at).dot(way) <= 0.0;
                let beside = |end: &DVec3| (*end - last).reject_from(way).length() <= 0.5 * step;
                arrived = ends.iter().position(|end| passed(end) && beside(end));
                last = newton_point.at;
                arrived.is_none() && newton_point.at.distance(zone.center.at) <= 2.0 * zone.extent
            });
            let Some(arrived) = arrived else { continue };
            let points = points.iter().map(|newton_point| newton_point.point(Mark::Regular)).collect::<Vec<_>>();
            let other = open.remove(arrived);
            if points.is_empty() {
                self.join(tip, other);
                continue;
            }
            self.arcs.push(Arc { points, ..Arc::default() });
            self.join(tip, (self.arcs.len() - 1, 0));
            self.join((self.arcs.len() - 1, 1), other);
        }
    }

    /// A curve along which the surfaces touch, or the two beside one along which they nearly do.
    fn valley(&mut self, valley: &Valley) {
        let Valley { points, is_closed, reach } = valley;
        let Some(first) = points.first() else { return };
        if first.gap.abs() > self.solver.tolerance {
            let Some(distance) = first.crossing() else { return };
            for side in [1.0, -1.0] {
                self.closed_curve(first, first.directions[0] * (side * distance), reach / 6.0, points.len() * 8);
            }
            return;
        }
        let point =
            |critical: &CriticalPoint| critical.point(Mark::Tangent, critical.directions[1], self.solver.tolerance);
        let arc = Arc { points: points.iter().map(point).collect(), is_closed: *is_closed, ..Arc::default() };
        self.arcs.push(arc);
    }

    /// The arcs one after the other.
    fn joined(mut self) -> Vec<Branch> {
        let mut branches = Vec::new();
        let count = self.arcs.len();
        let mut is_used = vec![false; count];
        // Open curves from their ends first.
        let ends = (0..count).flat_map(|arc| [(arc, 0), (arc, 1)]);
        let begins: Vec<Tip> = ends.filter(|tip| !self.goes_on.contains_key(tip)).collect();
        for begin in begins.into_iter().chain((0..count).map(|arc| (arc, 0))) {
            let mut branch = Branch { is_closed: self.arcs[begin.0].is_closed, ..Branch::default() };
            let mut tip = begin;
            while !std::mem::replace(&mut is_used[tip.0], true) {
                let mut points = std::mem::take(&mut self.arcs[tip.0].points);
                if tip.1 == 1 {
                    points.reverse();
                }
                // A branching point ends one arc and begins the next.
                let again = branch.points.last().zip(points.first()).is_some_and(|(a, b)| a.position == b.position);
                branch.points.extend(points.drain(usize::from(again)..));
                match self.goes_on.get(&(tip.0, 1 - tip.1)) {
                    Some(next) if *next == begin => branch.is_closed = true,
                    Some(next) => tip = *next,
                    None => break,
                }
            }
            let ends = branch.points.first().zip(branch.points.last()).map(|(a, b)| a.position == b.position);
            if branch.is_closed && branch.points.len() > 1 && ends == Some(true) {
                branch.points.pop();
            }
            if !branch.points.is_empty() {
                branches.push(branch);
            }
        }
        branches
    }
}

/// The accurate point for a point of a polyline: twice where it goes over a border.
fn accurate(solver: &NewtonSolver<'_>, polyline: &TrianglePolyline, index: usize) -> Vec<CurvePoint> {
    let at = polyline.points[index];
    let lines = polyline.lines.len();
    let before = if index > 0 { Some(index - 1) } else { polyline.is_closed.then(|| lines - 1) };
    let behind = Some(index).filter(|index| *index < lines);
    let on = |line: usize| [0, 1].map(|side| solver.sheets[side].coordinates(polyline.lines[line][side], at));
    let reach = |line: usize| solver.reach(polyline.lines[line]);
    if let (Some(before), Some(behind)) = (before, behind) {
        let (first, second) = (on(before), on(behind));
        let is_corner = (0..2).any(|side| !first[side].is_beside(&second[side]));
        let far = reach(before).max(reach(behind));
        if is_corner && let Some(both) = solver.corner([0, 1].map(|side| [first[side], second[side]]), at, far) {
            return both.map(|newton_point| newton_point.point(Mark::Corner)).to_vec();
        }
    }
    let line = behind.or(before).unwrap_or(0);
    if before.is_none() || behind.is_none() {
        let neighbour = polyline.points[if before.is_some() { index - 1 } else { 1 }];
        let start = at + (at - neighbour).normalize_or_zero() * (BEHIND * reach(line));
        if let Some(newton_point) = solver.border(on(line), start, reach(line)) {
            return vec![newton_point.point(Mark::End)];
        }
    }
    vec![solver.solve(on(line), at, None, reach(line)).point(Mark::Regular)]
}
