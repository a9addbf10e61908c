//! Shadow volumes in the scene: in how many of them a point lies.
//!
//! From the point, a straight line goes along an axis to infinity. Each time it comes through the side of a volume or
//! through a triangle, it leaves or enters; so many it was in. One rule for each side, in the plane across that axis,
//! decides which it intersects; the results cancel out between neighbours whatever the rounding, so that the sum is
//! always a whole and consistent number.

use super::casters::{Casters, Silhouette};
use super::lamp::LightPosition;
use super::sorted_groups::SortedGroups;
use glam::{DVec2, DVec3};

/// Cells along each side of the grid in which triangles and silhouettes are sorted, at the most.
const MOST_CELLS: f64 = 192.0;

/// The shadow volumes of one light.
pub(super) struct ShadowVolumes<'a> {
    casters: &'a Casters<'a>,
    light: LightPosition,
    silhouettes: &'a [Silhouette],
    facing: &'a [i8],
    /// The axis of the line, and the two across.
    axes: [usize; 3],
    /// The number of volumes around what is infinitely far up, by group.
    above: Vec<i32>,
    grid: Option<Grid>,
}

/// Triangles and silhouettes that may be intersected from each square of the plane.
struct Grid {
    least: DVec2,
    most: DVec2,
    cells: usize,
    silhouettes: SortedGroups<u32>,
    triangles: SortedGroups<u32>,
}

impl<'a> ShadowVolumes<'a> {
    /// - `groups`: how many groups of casters there are.
    pub(super) fn new(
        casters: &'a Casters<'a>,
        light: LightPosition,
        facing: &'a [i8],
        silhouettes: &'a [Silhouette],
        groups: usize,
    ) -> ShadowVolumes<'a> {
        let offset = match light {
            LightPosition::Point(at) => {
                (at - casters.prepared.bounds.center())
                    / casters.prepared.bounds.size().max(DVec3::splat(f64::MIN_POSITIVE))
            }
            LightPosition::Direction(towards) => towards,
        };
        // Across the light, so that volumes are wide in the plane.
        let up = (0..3).min_by(|a, b| offset[*a].abs().total_cmp(&offset[*b].abs())).unwrap_or(2);
        let axes = [(up + 1) % 3, (up + 2) % 3, up];
        let mut enclosed =
            ShadowVolumes { casters, light, silhouettes, facing, axes, above: vec![0; groups], grid: None };
        enclosed.above = enclosed.above(groups);
        enclosed
    }

    /// Sorts triangles and silhouettes into the grid, for many points.
    pub(super) fn sorted(mut self) -> ShadowVolumes<'a> {
        self.grid = Some(self.sort());
        self
    }

    fn turned(&self, point: DVec3) -> DVec3 {
        DVec3::new(point[self.axes[0]], point[self.axes[1]], point[self.axes[2]])
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.turned(self.casters.prepared.vertices[index as usize])
    }

    /// Away from the light at a vertex.
    fn away(&self, vertex: DVec3) -> DVec3 {
        match self.light {
            LightPosition::Point(at) => vertex - self.turned(at),
            LightPosition::Direction(towards) => -self.turned(towards),
        }
    }

    /// The numbers of volumes around what is infinitely far up: those of the triangles above the light.
    fn above(&self, groups: usize) -> Vec<i32> {
        let mut counts = vec![0; groups];
        if let LightPosition::Point(at) = self.light {
            let at = self.turned(at);
            for &triangle in &self.casters.triangles {
                counts[usize::from(self.casters.group(triangle))] -= self.through(triangle, at);
            }
        }
        counts
    }

    /// How often the line up from a point leaves the volume of a triangle through the triangle: 1, 0, or -1 to enter
    /// it.
    fn through(&self, triangle: u32, point: DVec3) -> i32 {
        let facing = i32::from(self.facing[triangle as usize]);
        if facing == 0 {
            return 0;
        }
        let [a, b, c] = self.casters.prepared.triangles[triangle as usize];
        let [p, q, r] = [a, b, c].map(|i| self.vertex(i));
        if point.x > p.x.max(q.x).max(r.x) {
            return 0;
        }
        let winds = self.crosses(a, b, point) + self.crosses(b, c, point) + self.crosses(c, a, point);
        if winds == 0 || !is_above((q - p).cross(r - p), p, point).unwrap_or(false) {
            return 0;
        }
        facing * winds
    }

    /// How often the line up from a point leaves volumes through the side behind a silhouette.
    fn beside(&self, silhouette: &Silhouette, point: DVec3) -> i32 {
        let [a, b] = silhouette.ends;
        let [p, q] = [self.vertex(a), self.vertex(b)];
        let [away_p, away_q] = [self.away(p), self.away(q)];
        let mut winds = ray_crosses(p, away_p, point) - ray_crosses(q, away_q, point) - self.crosses(a, b, point);
        if let LightPosition::Point(at) = self.light {
            winds += self.crosses(a, b, self.turned(at));
        }
        if winds == 0 {
            return 0;
        }
        let above = is_above((q - p).cross(away_p), p, point).unwrap_or(away_p.z + away_q.z > 0.0);
        if above { winds * silhouette.weight } else { 0 }
    }

    /// How often a side crosses the line from a point to the right, upwards less downwards.
    fn crosses(&self, a: u32, b: u32, point: DVec3) -> i32 {
        if a > b {
            return -self.crosses(b, a, point);
        }
        let [p, q] = [self.vertex(a), self.vertex(b)];
        let turn = || (q.x - p.x) * (point.y - p.y) - (q.y - p.y) * (point.x - p.x);
        if p.y <= point.y && point.y < q.y {
            i32::from(turn() > 0.0)
        } else if q.y <= point.y && point.y < p.y {
            -i32::from(turn() < 0.0)
        } else {
            0
        }
    }

    /// In how many volumes of each group a point is: how many triangles stand between it and the light.
    pub(super) fn counts(&self, point: DVec3) -> Vec<i32> {
        let point = self.turned(point);
        let mut counts = self.above.clone();
        let mut add = |group: u8, count: i32| counts[usize::from(group)] += count;
        match self.grid.as_ref().and_then(|grid| Some((grid, grid.cell(point.truncate())?))) {
            Some((grid, cell)) => {
                for &number in grid.silhouettes.of(cell) {
                    let silhouette = &self.silhouettes[number as usize];
                    add(silhouette.group, self.beside(silhouette, point));
                }
                for &triangle in grid.triangles.of(cell) {
                    add(self.casters.group(triangle), self.through(triangle, point));
                }
            }
            None => {
                self.silhouettes.iter().for_each(|silhouette| add(silhouette.group, self.beside(silhouette, point)));
                // Beside the scene, no triangle is above.
                if self.grid.is_none() {
                    let triangles = &self.casters.triangles;
                    triangles.iter().for_each(|&t| add(self.casters.group(t), self.through(t, point)));
                }
            }
        }
        counts
    }

    fn sort(&self) -> Grid {
        let bounds = self.casters.prepared.bounds;
        // Curved surfaces may bulge beyond their triangles.
        let margin = DVec3::splat(0.01 * bounds.diagonal());
        let (least, most) = (self.turned(bounds.min - margin).truncate(), self.turned(bounds.max + margin).truncate());
        let size = self.casters.triangles.len() + self.silhouettes.len();
        let cells = ((size as f64).sqrt() / 2.0).clamp(1.0, MOST_CELLS) as usize;
        let (silhouettes, triangles) = Default::default();
        let mut grid = Grid { least, most, cells, silhouettes, triangles };
        let silhouettes = self.silhouettes.iter().zip(0..).flat_map(|(silhouette, number)| {
            let grid = &grid;
            self.squares(grid, silhouette).into_iter().map(move |cell| (cell, number))
        });
        let silhouettes: Vec<(usize, u32)> = silhouettes.collect();
        let silhouettes = SortedGroups::new(cells * cells, silhouettes.iter().copied());
        let triangles =
            self.casters.triangles.iter().filter(|t| self.facing[**t as usize] != 0).flat_map(|&triangle| {
                let [a, b, c] = self.casters.prepared.triangles[triangle as usize].map(|i| self.vertex(i).truncate());
                let (low, high) = (grid.place(a.min(b).min(c)), grid.place(a.max(b).max(c)));
                (low[1]..=high[1]).flat_map(move |y| (low[0]..=high[0]).map(move |x| (y * cells + x, triangle)))
            });
        let triangles: Vec<(usize, u32)> = triangles.collect();
        let triangles = SortedGroups::new(cells * cells, triangles.iter().copied());
        (grid.silhouettes, grid.triangles) = (silhouettes, triangles);
        grid
    }

    /// The squares that the side behind a silhouette may come over.
    fn squares(&self, grid: &Grid, silhouette: &Silhouette) -> Vec<usize> {
        let [p, q] = silhouette.ends.map(|i| self.vertex(i));
        let [away_p, away_q] = [self.away(p), self.away(q)];
        let far = 4.0 * (grid.most - grid.least).length().max(f64::MIN_POSITIVE);
        let end = |from: DVec3, away: DVec3| from.truncate() + away.truncate().normalize_or_zero() * far;
        let lines = [[p.truncate(), q.truncate()], [p.truncate(), end(p, away_p)], [q.truncate(), end(q, away_q)]];
        // Where it opens to the left or right, lines of the grid have no end.
        let wide = away_p.y * away_q.y <= 0.0;
        let low = lines.iter().flatten().fold(f64::INFINITY, |least, point| least.min(point.y));
        let high = lines.iter().flatten().fold(f64::NEG_INFINITY, |most, point| most.max(point.y));
        let (first, last) = (grid.place(DVec2::splat(low))[1], grid.place(DVec2::splat(high))[1]);
        let height = (grid.most.y - grid.least.y) / grid.cells as f64;
        let mut squares = Vec::new();
        for y in first..=last {
            let (bottom, top) = (grid.least.y + y as f64 * height, grid.least.y + (y + 1) as f64 * height);
            let (bottom, top) = (bottom - 1e-6 * height, top + 1e-6 * height);
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for [from, to] in lines {
                let (from, to) = if from.y <= to.y { (from, to) } else { (to, from) };
                if from.y > top || to.y < bottom {
                    continue;
                }
                let at = |y: f64| {
                    if to.y > from.y { from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y) } else { from.x }
                };
                let ends = if to.y > from.y { [at(bottom.max(from.y)), at(top.min(to.y))] } else { [from.x, to.x] };
                (left, right) = (left.min(ends[0]).min(ends[1]), right.max(ends[0]).max(ends[1]));
            }
            if wide || left > right {
                (left, right) = (grid.least.x, grid.most.x);
            }
            let margin = 1e-6 * (grid.most.x - grid.least.x);
            if right + margin < grid.least.x || left - margin > grid.most.x {
                continue;
            }
            let (from, to) = (grid.place(DVec2::splat(left - margin))[0], grid.place(DVec2::splat(right + margin))[0]);
            squares.extend((from..=to).map(|x| y * grid.cells + x));
        }
        squares
    }
}

/// Whether a plane is above a point; none if it is upright.
///
/// - `normal`: of the plane, any length. `on`: a point of it.
fn is_above(normal: DVec3, on: DVec3, point: DVec3) -> Option<bool> {
    (normal.z != 0.0).then(|| (normal.dot(point - on) < 0.0) == (normal.z > 0.0))
}

/// How often a half line crosses the line from a point to the right, upwards less downwards.
fn ray_crosses(from: DVec3, away: DVec3, point: DVec3) -> i32 {
    let turn = || away.x * (point.y - from.y) - away.y * (point.x - from.x);
    if away.y > 0.0 {
        i32::from(from.y <= point.y && turn() > 0.0)
    } else {
        -i32::from(point.y < from.y && turn() < 0.0)
    }
}

impl Grid {
    /// Column and row of a point, or of what is nearest to it in the grid.
    fn place(&self, point: DVec2) -> [usize; 2] {
        let at =
            (point - self.least) / (self.most - self.least).max(DVec2::splat(f64::MIN_POSITIVE)) * self.cells as f64;
        [at.x, at.y].map(|x| (x.max(0.0) as usize).min(self.cells - 1))
    }

    /// The square of a point; none beyond the scene.
    fn cell(&self, point: DVec2) -> Option<usize> {
        let inside = point.cmpge(self.least).all() && point.cmple(self.most).all();
        inside.then(|| {
            let [x, y] = self.place(point);
            y * self.cells + x
        })
    }
}
