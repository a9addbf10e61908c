//! The triangles around a vertex, and the neighbours onto which it may be moved without moving the surface.

use super::operand::Operands;
use super::overlap::NamedTriangle;
use super::result::Outcome;
use crate::mesh::Mesh;
use glam::DVec3;
use robust::{Coord3D, orient3d};

/// How far from the faces of the operands the surface may come, in units in the last place of the largest coordinate of
/// theirs.
const UNITS: f64 = 4.0;
/// How far normals and parameters may be from each other and count as the same.
const ALIKE: f64 = 1e-9;
/// Faces at a smaller angle than this count as one plane, in which a border stays where it is.
const LEAST_SINE: f64 = 1e-4;
/// Triangles around a vertex that is looked at, at most.
const MOST: usize = 256;

/// Triangles at a vertex, up to which a quick look is taken.
const QUICK: usize = 16;

/// A triangle at a vertex.
#[derive(Clone, Copy, Debug)]
struct FanTriangle {
    /// Its number.
    triangle: u32,
    /// Its second corner, if the vertex is the first.
    second: u32,
    /// Whether what lies between it and the triangle before it must stay where it is.
    is_border: bool,
}

/// All triangles around a vertex: disks, each counter-clockwise from outside, in which each triangle has an edge in
/// common with the next.
#[derive(Clone, Debug)]
pub struct Fan {
    vertex: u32,
    /// Several where surfaces touch each other.
    disks: Vec<Vec<FanTriangle>>,
}

impl Fan {
    fn triangles(&self) -> impl Iterator<Item = &FanTriangle> {
        self.disks.iter().flatten()
    }
}

/// A vertex moved onto a neighbour.
#[derive(Clone, Debug)]
pub struct Collapse {
    /// The vertex.
    pub vertex: u32,
    /// The neighbour.
    pub onto: u32,
    /// The triangles between the two, which go.
    pub gone: Vec<u32>,
    /// The triangles that stay, with their new corners; the neighbour is the first.
    pub stay: Vec<(u32, [u32; 3])>,
    /// For each triangle that stays one of those that go, of which it takes what its new corner has; if there is one.
    pub like: Vec<Option<u32>>,
}

/// The criteria of collapses.
#[derive(Clone, Copy)]
pub struct CollapseCriteria<'a> {
    /// The operands.
    pub operands: &'a Operands<'a>,
    /// The result.
    pub outcome: &'a Outcome,
    /// The largest coordinate of the operands, or more.
    pub largest: f64,
}

impl CollapseCriteria<'_> {
    fn mesh(&self) -> &Mesh {
        &self.outcome.mesh
    }

    fn at(&self, vertex: u32) -> DVec3 {
        self.mesh().vertices[vertex as usize]
    }

    /// The triangle of an operand that a triangle is part of.
    fn source(&self, triangle: u32) -> [DVec3; 3] {
        let [operand, source] = self.outcome.sources[triangle as usize];
        self.operands.meshes()[operand as usize].corners(source as usize)
    }

    /// The operand that a triangle is of, and the surface of that.
    fn kind(&self, triangle: u32) -> (u32, Option<u32>) {
        (self.outcome.sources[triangle as usize][0], self.mesh().surfaces.get(triangle as usize).copied())
    }

    /// Whether a neighbour of a vertex may lie in all faces that meet there, as far as a quick look tells.
    pub fn may_collapse(&self, vertex: u32, triangles: &[u32]) -> bool {
        let mut near = [DVec3::ZERO; QUICK];
        if triangles.len() > QUICK {
            return true;
        }
        for (slot, &triangle) in near.iter_mut().zip(triangles) {
            let corners = self.mesh().triangles[triangle as usize];
            let k = corners.iter().position(|corner| *corner == vertex).unwrap_or(0);
            *slot = self.at(corners[(k + 1) % 3]);
        }
        let unit = self.largest * f64::EPSILON;
        let mut count = triangles.len();
        let mut last = [u32::MAX; 2];
        for &triangle in triangles {
            let source = self.outcome.sources[triangle as usize];
            if source == last {
                continue;
            }
            last = source;
            let [a, b, c] = self.source(triangle);
            let [d, e] = [b - a, c - a];
            let normal = d.cross(e);
            // The normal of a long and thin face is known badly; roots of sums of squares are left out.
            let most = unit
                * unit
                * (8.0 * UNITS * UNITS * normal.length_squared() + 512.0 * d.length_squared() * e.length_squared());
            let mut left = 0;
            for k in 0..count {
                let height = (near[k] - a).dot(normal);
                near[left] = near[k];
                left += usize::from(height * height <= most);
            }
            count = left;
            if count == 0 {
                return false;
            }
        }
        true
    }

    /// Orders the triangles around a vertex; `None` if they are no disks.
    pub fn fan(&self, vertex: u32, triangles: &[u32]) -> Option<Fan> {
        if !(3..=MOST).contains(&triangles.len()) {
            return None;
        }
        let ends = |&triangle: &u32| {
            let corners = self.mesh().triangles[triangle as usize];
            let k = corners.iter().position(|corner| *corner == vertex)?;
            Some((corners[(k + 1) % 3], triangle, corners[(k + 2) % 3]))
        };
        let mut left: Vec<(u32, u32, u32)> = triangles.iter().map(ends).collect::<Option<_>>()?;
        left.sort_unstable();
        let mut disks = Vec::new();
        while let Some(&start) = left.first() {
            let mut disk: Vec<FanTriangle> = Vec::with_capacity(left.len());
            let mut next = start.0;
            while disk.is_empty() || next != start.0 {
                let from = left.partition_point(|(second, ..)| *second < next);
                let to = left.partition_point(|(second, ..)| *second <= next);
                // Where surfaces touch each other, the next one is beyond what is inside.
                let place = match disk.last() {
                    Some(leaf) if to - from > 1 => {
                        let angle = |place: &usize| self.angle(vertex, leaf.second, next, left[*place].2);
                        (from..to).min_by(|a, b| angle(a).total_cmp(&angle(b))).unwrap_or(from)
                    }
                    _ => from,
                };
                if place == to || disk.iter().any(|leaf| leaf.second == next) {
                    return None;
                }
                let (second, triangle, third) = left.remove(place);
                disk.push(FanTriangle { triangle, second, is_border: false });
                next = third;
            }
            disks.push(disk);
        }
        Some(Fan { vertex, disks })
    }

    /// The angle from the triangle between a vertex, `second` and `third`, through what is behind it, to another one
    /// beyond the side to `third`, with the corner `other`; 0..2 pi.
    fn angle(&self, vertex: u32, second: u32, third: u32, other: u32) -> f64 {
        let [from, axis, to] = [second, third, other].map(|end| self.at(end) - self.at(vertex));
        let inward = axis.cross(from);
        let along = inward.cross(axis).normalize_or_zero();
        let angle = to.dot(inward.normalize_or_zero()).atan2(to.dot(along));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    }

    /// The best of the neighbours of a vertex onto which it may be moved, unless `is_refused`.
    pub fn collapse(&self, mut fan: Fan, is_refused: impl Fn(u32) -> bool) -> Option<Collapse> {
        let mut sources: Vec<[u32; 2]> =
            fan.triangles().map(|leaf| self.outcome.sources[leaf.triangle as usize]).collect();
        sources.sort_unstable();
        sources.dedup();
        let planes: Vec<[DVec3; 3]> = sources
            .iter()
            .map(|[operand, source]| self.operands.meshes()[*operand as usize].corners(*source as usize))
            .collect();
        let around = fan.triangles().map(|leaf| self.at(leaf.second)).chain([self.at(fan.vertex)]);
        let reach = UNITS * f64::EPSILON * size_of(around.chain(planes.iter().copied().flatten()), 0.0);
        // What lies exactly in a face that is square to an axis stays there.
        let own = self.at(fan.vertex);
        let is_level = |[a, b, c]: &[DVec3; 3]| (0..3).any(|k| [a[k], b[k], c[k]] == [own[k]; 3]);
        let of_plane = |plane: &[DVec3; 3]| if is_level(plane) { 0.0 } else { reach };
        let reaches: Vec<f64> = planes.iter().map(of_plane).collect();
        let is_near = |onto: &u32| {
            let is_in = |disk: &Vec<FanTriangle>| disk.iter().any(|leaf| leaf.second == *onto);
            fan.disks[1..].iter().all(is_in)
                && planes.iter().zip(&reaches).all(|(plane, reach)| is_on_plane(*plane, self.at(*onto), *reach))
        };
        let near: Vec<u32> = fan.disks[0].iter().map(|leaf| leaf.second).filter(is_near).collect();
        if near.is_empty() {
            return None;
        }
        self.mark_borders(&mut fan);
        let all = near.into_iter().filter(|onto| !is_refused(*onto)).filter_map(|onto| self.onto(&fan, onto, reach));
        all.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, collapse)| collapse)
    }

    fn mark_borders(&self, fan: &mut Fan) {
        let mut seconds: Vec<u32> = fan.triangles().map(|leaf| leaf.second).collect();
        seconds.sort_unstable();
        let is_common = |second: u32| seconds.iter().filter(|other| **other == second).count() > 1;
        for disk in &mut fan.disks {
            let mut before = disk[disk.len() - 1].triangle;
            for leaf in disk {
                let ends = [fan.vertex, leaf.second];
                leaf.is_border = self.kind(before) != self.kind(leaf.triangle)
                    || is_common(leaf.second)
                    || ends.into_iter().any(|end| !self.agree(end, before, leaf.triangle));
                before = leaf.triangle;
            }
        }
    }

    /// Whether two triangles have the same normal and parameters at a common corner, but for roundings.
    fn agree(&self, corner: u32, one: u32, two: u32) -> bool {
        let mesh = self.mesh();
        let [a, b] = [one, two].map(|t| (t as usize, mesh.triangles[t as usize].iter().position(|c| *c == corner)));
        let ((one, Some(a)), (two, Some(b))) = (a, b) else { return false };
        let has_normals = !mesh.corner_normals.is_empty();
        let has_parameters = !mesh.corner_parameters.is_empty();
        (!has_normals || mesh.corner_normals[one][a].distance(mesh.corner_normals[two][b]) < ALIKE)
            && (!has_parameters || {
                let [p, q] = [mesh.corner_parameters[one][a], mesh.corner_parameters[two][b]];
                p.distance(q) <= ALIKE * (1.0 + p.length()) + self.parameter_error(one) + self.parameter_error(two)
            })
    }

    /// What roundings of corners may make of the parameters in a triangle: much where it is part of a long and thin
    /// one.
    fn parameter_error(&self, triangle: usize) -> f64 {
        let [operand, source] = self.outcome.sources[triangle];
        let corners = self.source(triangle as u32);
        let [a, b, c] = corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let [p, q, r] = self.operands.meshes()[operand as usize].corner_parameters[source as usize];
        let span = p.distance(q).max(q.distance(r)).max(r.distance(p));
        let height = (b - a).cross(c - a).length() / longest;
        UNITS * f64::EPSILON * size_of(corners.into_iter(), 0.0) * span / height
    }

    /// Whether the borders in a disk stay where they are if the vertex is moved onto neighbour `k`.
    fn preserves_borders(&self, vertex: u32, disk: &[FanTriangle], k: usize, reach: f64) -> bool {
        let [from, to] = [vertex, disk[k].second].map(|vertex| self.at(vertex));
        let borders: Vec<usize> = (0..disk.len()).filter(|&j| disk[j].is_border).collect();
        match borders[..] {
            [] => true,
            [one, two] if one == k || two == k => {
                let other = if one == k { two } else { one };
                let start = self.at(disk[other].second);
                let d = to - start;
                let t = (from - start).dot(d) / d.length_squared();
                let beside = [disk[(other + disk.len() - 1) % disk.len()], disk[other]].map(|leaf| leaf.triangle);
                (0.0..=1.0).contains(&t) && (start + d * t).distance(from) * self.sine(beside) <= reach
            }
            _ => false,
        }
    }

    /// The sine of the angle between the faces that two triangles are part of, by which the line in which they meet is
    /// known worse than they are; 1 if it is so small that they count as one plane.
    fn sine(&self, triangles: [u32; 2]) -> f64 {
        let [one, two] = triangles.map(|triangle| {
            let [a, b, c] = self.source(triangle);
            (b - a).cross(c - a).normalize_or_zero()
        });
        let sine = one.cross(two).length();
        if sine < LEAST_SINE { 1.0 } else { sine }
    }

    /// The vertex moved onto a neighbour, and how well shaped the worst triangle then is; `None` if one is turned over
    /// or a border is moved.
    fn onto(&self, fan: &Fan, onto: u32, reach: f64) -> Option<(f64, Collapse)> {
        let is_short = self.at(fan.vertex).distance(self.at(onto)) <= reach;
        let mut worst = f64::INFINITY;
        let (mut gone, mut stay, mut like) = (Vec::new(), Vec::new(), Vec::new());
        for disk in &fan.disks {
            let (count, k) = (disk.len(), disk.iter().position(|leaf| leaf.second == onto)?);
            if !is_short && !self.preserves_borders(fan.vertex, disk, k, reach) {
                return None;
            }
            // From the neighbour on, all around to it again.
            let leaf = |step: usize| disk[(k + step) % count];
            let ends = [leaf(0).triangle, leaf(count - 1).triangle];
            gone.extend(ends);
            let all = (1..count).filter(|&step| leaf(step).is_border).count();
            let mut borders = 0;
            for step in 1..count - 1 {
                let FanTriangle { triangle, second, is_border } = leaf(step);
                borders += usize::from(is_border);
                let corners = [onto, second, leaf(step + 1).second];
                worst = worst.min(self.shape(fan, triangle, corners, is_short)?);
                // What can be reached from one of those that go without crossing a border is like that one.
                like.push(match [borders == 0, borders == all] {
                    [true, true] => Some(ends[usize::from(2 * step > count)]),
                    [true, false] => Some(ends[0]),
                    [false, true] => Some(ends[1]),
                    [false, false] => None,
                });
                stay.push((triangle, corners));
            }
        }
        Some((worst, Collapse { vertex: fan.vertex, onto, gone, stay, like }))
    }

    /// How well shaped a triangle is with other corners; `None` if it has no area then, faces another way, or becomes
    /// thin.
    ///
    /// - `is_short`: whether the vertex is moved by roundings only, for which what is thin may stay so.
    fn shape(&self, fan: &Fan, triangle: u32, corners: [u32; 3], is_short: bool) -> Option<f64> {
        let tile = |names: [u32; 3]| NamedTriangle { names, corners: names.map(|vertex| self.at(vertex)) }.with_plane();
        let new = tile(corners);
        if new.is_thin() {
            // Which way such a one faces is a matter of roundings.
            let was_thin = || tile(self.mesh().triangles[triangle as usize]).is_thin();
            return (is_short && !new.is_flat() && was_thin()).then_some(0.0);
        }
        let normal = self.normal(fan, triangle)?;
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let area = (b - a).cross(c - a);
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        (area.dot(normal) > 0.5 * area.length() * normal.length()).then_some(area.length() / longest)
    }

    /// The normal of the face that a triangle is part of, as the triangle is oriented, as far as that is known.
    fn normal(&self, fan: &Fan, triangle: u32) -> Option<DVec3> {
        let [a, b, c] = self.source(triangle);
        let normal = (b - a).cross(c - a);
        let turn = |triangle: u32| {
            let area = self.mesh().area_vector(triangle as usize);
            let turn = area.dot(normal) / (area.length() * normal.length());
            (turn.abs() > 0.5).then_some(turn)
        };
        let source = self.outcome.sources[triangle as usize];
        let is_other = |other: &u32| *other != triangle && self.outcome.sources[*other as usize] == source;
        let others = || fan.triangles().map(|leaf| leaf.triangle).filter(is_other).find_map(turn);
        turn(triangle).or_else(others).map(|turn| normal * turn.signum())
    }
}

/// The largest coordinate of some points, or a larger number.
fn size_of(points: impl Iterator<Item = DVec3>, size: f64) -> f64 {
    points.fold(size, |size, point| size.max(point.abs().max_element()))
}

/// Whether a point is on a plane through three others but for a distance.
fn is_on_plane([a, b, c]: [DVec3; 3], p: DVec3, reach: f64) -> bool {
    if p == a || p == b || p == c {
        return true;
    }
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    let sixfold = orient3d(coord(a), coord(b), coord(c), coord(p));
    sixfold.abs() <= reach * (b - a).cross(c - a).length()
}
