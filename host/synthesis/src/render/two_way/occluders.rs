//! Occluders of lines along a plane: walls that stand on it.

use super::smooth_surfaces::{LEAST_PART, beyond, part_of_disc};
use crate::numeric::bounds::Bounds;
use glam::{DVec2, DVec3, Vec2};
use std::f64::consts::TAU;

/// Farther than any disc reaches, in radii.
const FAR: f64 = 1e6;

/// Walls are longer by this part of the disc at both ends, so that rounding leaves no gap where two of them meet.
const OVERLAP: f64 = 1e-6;

/// A disc on a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanarDisc {
    middle: DVec3,
    above: DVec3,
    /// Two axes of the plane, unit length.
    pub(super) axes: [DVec3; 2],
    radius: f64,
}

/// A segment that hides what is behind it from the middle of the disc, which has radius 1 here.
#[derive(Clone, Copy, Debug)]
pub(super) struct OccluderSegment {
    /// The middle is on the left of the direction from one to the other.
    ends: [Vec2; 2],
}

impl PlanarDisc {
    /// - `above`: the normal of its side, unit length. `axes`: of the plane. `radius`: scene units.
    pub(super) fn new(middle: DVec3, above: DVec3, axes: [DVec3; 2], radius: f64) -> PlanarDisc {
        PlanarDisc { middle, above, axes, radius }
    }

    /// A box that holds the disc.
    pub(super) fn bounds(&self) -> Bounds {
        let [x, y] = self.axes.map(|axis| axis * axis);
        let reach = (x + y).map(f64::sqrt) * self.radius;
        Bounds { min: self.middle - reach, max: self.middle + reach }
    }

    /// The segment in which a triangle cuts the disc; none if it does not, or only touches it from below.
    pub(super) fn cut(&self, corners: [DVec3; 3]) -> Option<OccluderSegment> {
        let offsets = corners.map(|corner| corner - self.middle);
        let heights = offsets.map(|offset| offset.dot(self.above));
        let is_above = heights.map(|height| height > 0.0);
        let mut ends = [DVec2::ZERO; 2];
        let mut found = 0;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            if is_above[i] == is_above[j] {
                continue;
            }
            // From below, whichever triangle the edge belongs to.
            let (i, j) = if is_above[i] { (j, i) } else { (i, j) };
            let at = offsets[i].lerp(offsets[j], heights[i] / (heights[i] - heights[j]));
            ends[found] = DVec2::new(at.dot(self.axes[0]), at.dot(self.axes[1])) / self.radius;
            found += 1;
        }
        if found < 2 {
            return None;
        }
        let [a, b] = ends;
        let way = b - a;
        let nearest = a + way * (-a.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        if nearest.length_squared() >= 1.0 {
            return None;
        }
        let over = way.normalize_or_zero() * OVERLAP;
        let ends = [a - over, b + over].map(|end| end.as_vec2());
        Some(OccluderSegment { ends: if a.perp_dot(b) < 0.0 { [ends[1], ends[0]] } else { ends } })
    }
}

impl OccluderSegment {
    /// Whether it occludes a place, as seen from the middle.
    #[inline]
    pub(super) fn hides(&self, place: Vec2) -> bool {
        let [a, b] = self.ends;
        a.perp_dot(place) >= 0.0 && place.perp_dot(b) >= 0.0 && (b - a).perp_dot(place - a) <= 0.0
    }
}

/// The visible part of discs around a place: what is on its surface and in sight of it, disc by disc.
pub(super) struct VisibleParts {
    parts: Vec<Part>,
    /// For each part those borders that are before its wall; without walls all of them.
    borders: Vec<[DVec2; 2]>,
}

/// The visible part of a disc between two angles where no end and no crossing is.
struct Part {
    /// The nearest wall.
    wall: Option<[DVec2; 2]>,
    /// The begin of the borders of the next part.
    end: usize,
}

impl VisibleParts {
    /// - `borders`: of the surface, which is on their left; the unit is that of walls.
    ///
    /// # Source
    /// Ours: as [`part_of_disc`], from angle to angle between the ends of all segments. Behind the first wall nothing
    /// counts, and a border gives or takes only what is before the wall.
    pub(super) fn new(walls: &[OccluderSegment], borders: &[[DVec2; 2]]) -> VisibleParts {
        if walls.is_empty() {
            return VisibleParts { parts: Vec::new(), borders: borders.to_vec() };
        }
        let walls: Vec<[DVec2; 2]> = walls.iter().map(|wall| wall.ends.map(|end| end.as_dvec2())).collect();
        let mut angles: Vec<f64> = walls.iter().chain(borders).flatten().map(|end| end.to_angle()).collect();
        // The nearer of two changes where they cross.
        for (number, wall) in walls.iter().enumerate() {
            let others = walls[number + 1..].iter().chain(borders);
            angles.extend(others.filter_map(|other| crossing(*wall, *other)).map(DVec2::to_angle));
        }
        angles.sort_by(f64::total_cmp);
        let first = angles[0] + TAU;
        angles.push(first);
        let mut seen = VisibleParts { parts: Vec::with_capacity(angles.len()), borders: Vec::new() };
        for pair in angles.windows(2).filter(|pair| pair[0] < pair[1]) {
            let [from, to] = [pair[0], pair[1]].map(DVec2::from_angle);
            let middle = DVec2::from_angle(0.5 * (pair[0] + pair[1]));
            let distance = |segment: &[DVec2; 2]| along(*segment, middle);
            let between = |[a, b]: [DVec2; 2]| {
                let ends = if a.perp_dot(b) >= 0.0 { [from, to] } else { [to, from] };
                ends.map(|way| way * along_line([a, b], way).clamp(0.0, FAR))
            };
            let nearest = walls.iter().filter_map(|wall| Some((distance(wall)?, wall)));
            let nearest = nearest.min_by(|a, b| a.0.total_cmp(&b.0));
            let end = nearest.map_or(f64::INFINITY, |(end, _)| end);
            let before = borders.iter().filter(|border| distance(border).is_some_and(|distance| distance < end));
            seen.borders.extend(before.map(|border| between(*border)));
            seen.parts.push(Part { wall: nearest.map(|(_, wall)| between(*wall)), end: seen.borders.len() });
        }
        seen
    }

    /// Part of a weighted disc that is on the surface and in sight of its middle.
    ///
    /// - `radius`: where the disc within which walls are known has 1.
    pub(super) fn part(&self, radius: f64) -> f64 {
        if self.parts.is_empty() {
            return part_of_disc(&self.borders, radius);
        }
        let mut missing = 0.0;
        let mut first = 0;
        for Part { wall, end } in &self.parts {
            let hidden = wall.map_or(0.0, |wall| beyond(wall, radius).abs());
            missing += hidden;
            for border in &self.borders[first..*end] {
                let beyond = beyond(*border, radius);
                missing += (beyond.abs() - hidden).max(0.0).copysign(beyond);
            }
            first = *end;
        }
        (1.0 - missing / TAU).clamp(LEAST_PART, 1.0)
    }
}

/// The crossing of two segments, if they cross.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (s, t) = (side(c, d, a), side(c, d, b));
    let is_between = (s > 0.0) != (t > 0.0) && (side(a, b, c) > 0.0) != (side(a, b, d) > 0.0);
    is_between.then(|| a.lerp(b, s / (s - t)))
}

/// The distance at which a ray from the origin hits a segment, in lengths of its direction, if it does.
fn along([a, b]: [DVec2; 2], way: DVec2) -> Option<f64> {
    let is_between = (a.perp_dot(way) >= 0.0) == (way.perp_dot(b) >= 0.0);
    let distance = along_line([a, b], way);
    (is_between && distance > 0.0).then_some(distance)
}

/// The distance at which it hits the line of the segment.
fn along_line([a, b]: [DVec2; 2], way: DVec2) -> f64 {
    a.perp_dot(b - a) / way.perp_dot(b - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::RandomStream;

    #[test]
    fn what_a_wall_hides_is_what_rays_along_the_plane_do_not_reach() {
        let mut stream = RandomStream::new(9, 1);
        let mut coordinate = move || 2.0 * stream.uniform() - 1.0;
        let mut hidden = 0;
        for _ in 0..20_000 {
            let mut vector = || DVec3::new(coordinate(), coordinate(), coordinate());
            let (middle, normal, corners) = (vector(), vector().normalize(), [vector(), vector(), vector()]);
            let (x, y) = normal.any_orthonormal_pair();
            let flat = PlanarDisc::new(middle, normal, [x, y], 0.8);
            let wall = flat.cut(corners);
            let at = DVec2::new(coordinate(), coordinate()) * 0.7;
            let end = middle + (flat.axes[0] * at.x + flat.axes[1] * at.y) * 0.8;
            // By signs of volumes: the ends are on both sides of the triangle, and the line goes through it.
            let volume = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (b - a).cross(c - a).dot(d - a);
            let [a, b, c] = corners;
            let (s, t) = (volume(a, b, c, middle), volume(a, b, c, end));
            let round = [(a, b), (b, c), (c, a)].map(|(p, q)| volume(middle, end, p, q));
            let clear = [s, t].iter().chain(&round).all(|v| v.abs() > 1e-4);
            let crosses = s * t < 0.0 && (round.iter().all(|v| *v > 0.0) || round.iter().all(|v| *v < 0.0));
            if clear {
                assert_eq!(wall.is_some_and(|wall| wall.hides(at.as_vec2())), crosses);
                hidden += u32::from(crosses);
            }
        }
        assert!(hidden > 100);
    }

    #[test]
    fn the_part_in_sight_is_what_a_grid_of_places_sees() {
        let segment = |a: [f64; 2], b: [f64; 2]| [DVec2::from_array(a), DVec2::from_array(b)];
        let wall = |a, b| {
            let [a, b] = segment(a, b);
            OccluderSegment { ends: if a.perp_dot(b) < 0.0 { [b, a] } else { [a, b] }.map(|end| end.as_vec2()) }
        };
        let corner = [wall([-3.0, 0.3], [3.0, 0.3]), wall([-0.2, -2.0], [-0.2, 2.0])];
        let behind = [wall([0.2, -0.3], [0.25, 0.4]), wall([0.5, -0.2], [0.45, 0.1])];
        // The surface is below a line, and has a hole.
        let line = [segment([2.0, 0.6], [-2.0, 0.6])];
        let hole = [[0.1, -0.5], [0.1, -0.2], [0.4, -0.2], [0.4, -0.5]];
        let hole: Vec<[DVec2; 2]> = (0..4).map(|i| segment(hole[i], hole[(i + 1) % 4])).collect();
        let is_on = |p: DVec2, has_line: bool, has_hole: bool| {
            (!has_line || p.y < 0.6) && !(has_hole && p.x > 0.1 && p.x < 0.4 && p.y > -0.5 && p.y < -0.2)
        };
        for walls in [&corner[..1], &corner[..], &behind[..]] {
            for (has_line, has_hole) in [(false, false), (true, false), (false, true), (true, true)] {
                let lines = line.iter().filter(|_| has_line);
                let borders: Vec<[DVec2; 2]> = lines.chain(hole.iter().filter(|_| has_hole)).copied().collect();
                for radius in [1.0, 0.7, 0.35] {
                    let (mut all, mut part) = (0.0, 0.0);
                    for i in 0..600 {
                        for j in 0..600 {
                            let p = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / 300.0 - 1.0;
                            let weight = (1.0 - p.length_squared() / (radius * radius)).max(0.0);
                            let is_seen = !walls.iter().any(|wall| wall.hides(p.as_vec2()));
                            all += weight;
                            part += if is_seen && is_on(p, has_line, has_hole) { weight } else { 0.0 };
                        }
                    }
                    let found = VisibleParts::new(walls, &borders).part(radius);
                    assert!(
                        (found - part / all).abs() < 4e-3,
                        "{radius} {has_line} {has_hole}: {found} {}",
                        part / all
                    );
                }
            }
        }
    }

    #[test]
    fn nothing_is_seen_between_two_walls_that_meet() {
        let flat = PlanarDisc::new(DVec3::new(3.0, -7.0, 1e-9), DVec3::Z, [DVec3::X, DVec3::Y], 2.0);
        let corner = |x: f64, z: f64| DVec3::new(3.0 + x, -6.0, z);
        // One face of a box, its diagonal from below to above.
        let walls = [
            [corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, 2.0)],
            [corner(-1.0, 0.0), corner(1.0, 2.0), corner(-1.0, 2.0)],
        ];
        let walls: Vec<OccluderSegment> = walls.into_iter().filter_map(|corners| flat.cut(corners)).collect();
        assert_eq!(walls.len(), 2);
        for i in 0..10_000 {
            let x = (i as f32 / 5000.0 - 1.0) * 0.999;
            assert!(walls.iter().any(|wall| wall.hides(Vec2::new(0.5 * x, 0.55))), "{x}");
        }
    }

    #[test]
    fn what_touches_the_plane_from_below_or_is_far_is_no_wall() {
        let flat = PlanarDisc::new(DVec3::ZERO, DVec3::Z, [DVec3::X, DVec3::Y], 1.0);
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        assert!(flat.cut([at(-1.0, 0.5, 0.0), at(1.0, 0.5, 0.0), at(0.0, 0.5, -1.0)]).is_none());
        assert!(flat.cut([at(-1.0, 0.5, 0.0), at(1.0, 0.5, 0.0), at(0.0, 0.5, 1.0)]).is_some());
        assert!(flat.cut([at(-1.0, 1.5, 0.0), at(1.0, 1.5, 0.0), at(0.0, 1.5, 1.0)]).is_none());
        assert!(flat.cut([at(0.0, 0.5, 1.0); 3]).is_none());
    }
}
