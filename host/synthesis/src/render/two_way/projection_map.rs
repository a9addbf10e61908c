//! Photon targets: bounding spheres around what mirrors or refracts, and the projection maps of the cells that are
//! worth photons.

use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{cap, disk, disk_across, part_of, sphere};
use crate::scene::Prepared;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Bounding spheres at the most.
const MOST_BALLS: usize = 16;
/// A bounding sphere of whose disc more than this part is empty is divided, if there may be more of them.
const LOOSE: f64 = 0.7;
/// By how much bounding spheres are larger than they need be, so that rounding does not lose their rims.
const WIDER: f64 = 1.0 + 1e-9;
const BELOW_ONE: f64 = 1.0_f64.next_down();

/// The pdf of a direction or line, and the point of the square that gives it.
pub(super) type DirectionPdf = (f64, [f64; 2]);

/// A bounding sphere around something that mirrors or refracts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoundingSphere {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl BoundingSphere {
    /// The bounding sphere that fills a cone.
    ///
    /// - `way`: from the tip to the middle of the bounding sphere. `cosine`: of the half angle, which is known to the
    ///   last digit of it.
    pub(super) fn in_cone(tip: DVec3, way: DVec3, cosine: f64) -> BoundingSphere {
        let off = 1.0 - cosine + 2.0 * f64::EPSILON;
        BoundingSphere { center: tip + way, radius: way.length() * (off * (2.0 - off)).sqrt() }
    }

    /// A direction towards it from a point, even in solid angle; every direction from inside.
    pub(super) fn direction(&self, from: DVec3, uniform: [f64; 2]) -> DVec3 {
        let offset = self.center - from;
        let Some(cap) = cap(offset, self.radius) else { return sphere(uniform) };
        let [x, y] = disk(uniform);
        let square = x * x + y * y;
        let height = cap * square;
        // The sine of the angle over the distance from the middle of the disc.
        let scale = (cap * (2.0 - height)).max(0.0).sqrt();
        let axis = offset.normalize();
        let (u, v) = axis.any_orthonormal_pair();
        ((u * x + v * y) * scale + axis * (1.0 - height)).normalize()
    }

    /// The solid angle under which it is seen from a point, sr; 0 where all of it is below a plane through the point.
    ///
    /// - `above`: the normal of the plane, unit length.
    pub(super) fn solid_angle(&self, from: DVec3, above: DVec3) -> f64 {
        let offset = self.center - from;
        match cap(offset, self.radius) {
            Some(_) if offset.dot(above) <= -self.radius => 0.0,
            Some(cap) => TAU * cap,
            None => 2.0 * TAU,
        }
    }

    /// Whether a ray from a point in a direction, unit length, hits it; from inside, whether at all.
    pub(super) fn is_hit(&self, from: DVec3, direction: DVec3) -> bool {
        let offset = self.center - from;
        let Some(cap) = cap(offset, self.radius) else { return true };
        // 1 − cos of the angle to the middle, without the loss of digits of a difference.
        0.5 * (direction - offset.normalize()).length_squared() <= cap * WIDER
    }

    /// The pdf of [`BoundingSphere::direction`], 1/sr, and the point of the square that gives a direction; none beside
    /// the bounding sphere.
    pub(super) fn pdf(&self, from: DVec3, direction: DVec3) -> Option<DirectionPdf> {
        let offset = self.center - from;
        let Some(cap) = cap(offset, self.radius) else { return Some((0.5 / TAU, sphere_inverse(direction))) };
        let along = offset.dot(direction);
        let aside = (offset - direction * along).length();
        if along <= 0.0 || aside > self.radius * WIDER {
            return None;
        }
        let axis = offset.normalize();
        let (u, v) = axis.any_orthonormal_pair();
        let scale = (cap * (1.0 + direction.dot(axis))).sqrt();
        let place = disk_inverse([u, v].map(|side| direction.dot(side) / scale));
        Some(((TAU * cap).recip(), place))
    }

    /// A point on a line that goes in a direction and hits the bounding sphere, even in area across the direction.
    pub(super) fn line(&self, direction: DVec3, uniform: [f64; 2]) -> DVec3 {
        self.center + disk_across(direction, uniform) * self.radius
    }

    /// The pdf of [`BoundingSphere::line`], one over an area, and the point of the square that gives a line; none
    /// beside the bounding sphere.
    pub(super) fn line_pdf(&self, direction: DVec3, on: DVec3) -> Option<DirectionPdf> {
        let offset = on - self.center;
        let aside = offset - direction * offset.dot(direction);
        let square = self.radius * self.radius;
        // Its own lines count to the last digit.
        if aside.length_squared() > square * WIDER {
            return None;
        }
        let (u, v) = direction.any_orthonormal_pair();
        let place = disk_inverse([u, v].map(|side| aside.dot(side) / self.radius));
        Some(((PI * square).recip(), place))
    }
}

/// The point of the square that [`disk`] maps to a point.
fn disk_inverse([x, y]: [f64; 2]) -> [f64; 2] {
    let radius = x.hypot(y);
    let [a, b] = if radius == 0.0 {
        [0.0; 2]
    } else if x.abs() > y.abs() {
        let a = radius.copysign(x);
        [a, a * (y / x).atan() / FRAC_PI_4]
    } else {
        let b = radius.copysign(y);
        [b * (x / y).atan() / FRAC_PI_4, b]
    };
    [a, b].map(|c| (0.5 * (c + 1.0)).clamp(0.0, BELOW_ONE))
}

/// The point of the square that [`sphere`] maps to a direction.
fn sphere_inverse(direction: DVec3) -> [f64; 2] {
    let turn = direction.y.atan2(direction.x) / TAU;
    [0.5 * (1.0 - direction.z), turn - turn.floor()].map(|c| c.clamp(0.0, BELOW_ONE))
}

/// A projection map: cells of the square of a photon target, each of them worth photons or not.
///
/// Those that are not get few, but never none, so that what was overlooked still counts in the mean.
///
/// # Source
/// Jensen 2001, projection maps; found by tracing photons instead of by projection.
#[derive(Clone, Debug)]
pub(super) struct ProjectionMap {
    /// The part of all up to each row.
    rows: Vec<f64>,
    /// In each row, the part of it up to each cell.
    columns: Vec<f64>,
}

impl ProjectionMap {
    /// Cells along each side.
    const SIDE: usize = 32;
    /// How often a cell that is not worth photons is sampled, for each time that one is that is.
    const UNWANTED: f64 = 0.03;

    /// Every cell alike.
    pub(super) fn even() -> ProjectionMap {
        ProjectionMap::of(&[true; ProjectionMap::SIDE * ProjectionMap::SIDE])
    }

    /// - `used`: points of the square that stored photons; cells beside theirs are worth photons, too.
    pub(super) fn around(used: &[[f64; 2]]) -> ProjectionMap {
        let mut wanted = [false; ProjectionMap::SIDE * ProjectionMap::SIDE];
        for place in used {
            let [column, row] = place.map(|c| (c * ProjectionMap::SIDE as f64) as usize);
            for row in row.saturating_sub(1)..(row + 2).min(ProjectionMap::SIDE) {
                for column in column.saturating_sub(1)..(column + 2).min(ProjectionMap::SIDE) {
                    wanted[row * ProjectionMap::SIDE + column] = true;
                }
            }
        }
        ProjectionMap::of(&wanted)
    }

    fn of(wanted: &[bool]) -> ProjectionMap {
        let mut map =
            ProjectionMap { rows: Vec::with_capacity(ProjectionMap::SIDE), columns: Vec::with_capacity(wanted.len()) };
        let mut all = 0.0;
        for row in wanted.chunks(ProjectionMap::SIDE) {
            let mut below = 0.0;
            let first = map.columns.len();
            for wanted in row {
                below += if *wanted { 1.0 } else { ProjectionMap::UNWANTED };
                map.columns.push(below);
            }
            map.columns[first..].iter_mut().for_each(|part| *part /= below);
            all += below;
            map.rows.push(all);
        }
        map.rows.iter_mut().for_each(|part| *part /= all);
        map
    }

    /// A point of the square, more often in cells that are worth photons.
    pub(super) fn sample(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (row, y) = part_of(&self.rows, y);
        let (column, x) = part_of(&self.columns[row * ProjectionMap::SIDE..(row + 1) * ProjectionMap::SIDE], x);
        [(column as f64 + x) / ProjectionMap::SIDE as f64, (row as f64 + y) / ProjectionMap::SIDE as f64]
    }

    /// The pdf of [`ProjectionMap::sample`].
    pub(super) fn pdf(&self, place: [f64; 2]) -> f64 {
        let [column, row] = place.map(|c| (c * ProjectionMap::SIDE as f64) as usize);
        let part = |below: &[f64], i: usize| below[i] - if i == 0 { 0.0 } else { below[i - 1] };
        let columns = &self.columns[row * ProjectionMap::SIDE..(row + 1) * ProjectionMap::SIDE];
        part(&self.rows, row) * part(columns, column) * (ProjectionMap::SIDE * ProjectionMap::SIDE) as f64
    }
}

/// Bounding spheres around all triangles that a test chooses, as tight as so many allow.
pub(super) fn bounding_spheres(prepared: &Prepared, is_meant: impl Fn(u32) -> bool) -> Vec<BoundingSphere> {
    let mut parts: Vec<Part> = Vec::new();
    for object in &prepared.objects {
        let triangles = object.first..object.first + object.count;
        let meant: Vec<u32> = triangles.filter(|triangle| is_meant(*triangle)).collect();
        if !meant.is_empty() {
            parts.push(Part::new(prepared, meant));
        }
    }
    while parts.len() < MOST_BALLS {
        let worst = (0..parts.len())
            .filter(|i| parts[*i].is_loose())
            .max_by(|a, b| parts[*a].empty.total_cmp(&parts[*b].empty));
        let Some(worst) = worst else { break };
        let halves = halves(prepared, parts.swap_remove(worst).triangles);
        parts.extend(halves.map(|triangles| Part::new(prepared, triangles)));
    }
    parts.into_iter().map(|part| part.ball).filter(|sphere| sphere.radius > 0.0 && sphere.radius.is_finite()).collect()
}

/// The bounding sphere around all triangles that a test chooses; none if there are none.
pub(super) fn bounding_sphere(prepared: &Prepared, is_meant: impl Fn(u32) -> bool) -> Option<BoundingSphere> {
    let meant: Vec<u32> = (0..prepared.triangles.len() as u32).filter(|triangle| is_meant(*triangle)).collect();
    (!meant.is_empty()).then(|| Part::new(prepared, meant).ball).filter(|sphere| sphere.radius > 0.0)
}

/// Some triangles in a bounding sphere.
struct Part {
    triangles: Vec<u32>,
    ball: BoundingSphere,
    /// How much of the disc of the bounding sphere they leave empty, as seen from all sides in the mean, square units.
    empty: f64,
}

impl Part {
    fn new(prepared: &Prepared, triangles: Vec<u32>) -> Part {
        let corners = || triangles.iter().flat_map(|t| prepared.corners(*t));
        let center = Bounds::of(corners()).center();
        let radius = corners().map(|p| p.distance(center)).fold(0.0, f64::max) * WIDER;
        let area = |t: &u32| {
            let [a, b, c] = prepared.corners(*t);
            0.5 * (b - a).cross(c - a).length()
        };
        // Of a closed and convex surface a quarter is seen in the mean.
        let seen = 0.25 * triangles.iter().map(area).sum::<f64>();
        Part { triangles, ball: BoundingSphere { center, radius }, empty: PI * radius * radius - seen }
    }

    fn is_loose(&self) -> bool {
        self.triangles.len() > 1 && self.empty > LOOSE * PI * self.ball.radius * self.ball.radius
    }
}

/// Divides triangles by the middles along the longest side of their box.
fn halves(prepared: &Prepared, mut triangles: Vec<u32>) -> [Vec<u32>; 2] {
    let middle = |t: u32| {
        let [a, b, c] = prepared.corners(t);
        (a + b + c) / 3.0
    };
    let size = Bounds::of(triangles.iter().map(|t| middle(*t))).size();
    let axis = if size.x >= size.y.max(size.z) {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    triangles.sort_by(|a, b| middle(*a)[axis].total_cmp(&middle(*b)[axis]).then(a.cmp(b)));
    let rest = triangles.split_off(triangles.len() / 2);
    [triangles, rest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sequence::SobolSequence;

    #[test]
    fn directions_and_lines_to_a_sphere_are_even_and_all_of_them() {
        let sphere = BoundingSphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 0.5 };
        let sequence = SobolSequence::new(2, 2);
        let from = DVec3::new(-1.0, 0.5, 2.0);
        let axis = (sphere.center - from).normalize();
        let mean: DVec3 = (0..4096).map(|i| sphere.direction(from, sequence.point(i, 0))).sum::<DVec3>() / 4096.0;
        let cosine = (1.0 - (0.5 / sphere.center.distance(from)).powi(2)).sqrt();
        assert!((mean - axis * (0.5 * (1.0 + cosine))).length() < 1e-4);
        let solid_angle = TAU * (1.0 - cosine);
        for i in 0..4096 {
            let direction = sphere.direction(from, sequence.point(i, 1));
            assert!((direction.length() - 1.0).abs() < 1e-12);
            let (pdf, place) = sphere.pdf(from, direction).expect("towards the sphere");
            assert!((pdf * solid_angle - 1.0).abs() < 1e-9);
            assert!((sphere.direction(from, place) - direction).length() < 1e-9);
            let on = sphere.line(direction, sequence.point(i, 2));
            let (pdf, place) = sphere.line_pdf(direction, on).expect("through the sphere");
            assert!((pdf * PI * 0.25 - 1.0).abs() < 1e-12);
            assert!((sphere.line(direction, place) - on).length() < 1e-9);
            let (pdf, place) = sphere.pdf(sphere.center, direction).expect("from inside");
            assert!(pdf == 0.5 / TAU && (sphere.direction(sphere.center, place) - direction).length() < 1e-9);
        }
        assert_eq!(sphere.pdf(from, -axis), None);
        assert_eq!(sphere.line_pdf(DVec3::Z, sphere.center + DVec3::X), None);
    }

    #[test]
    fn a_projection_map_samples_what_is_wanted_and_knows_how_often() {
        let map = ProjectionMap::around(&[[0.1, 0.2], [0.11, 0.99], [0.0, 0.0]]);
        let sequence = SobolSequence::new(3, 3);
        let count = 1 << 14;
        // The mean of what is sampled over its pdf is the integral over the square.
        let drawn = || (0..count).map(|i| map.sample(sequence.point(i, 0)));
        let mean = |of: &dyn Fn([f64; 2]) -> f64| {
            drawn().map(|place| of(place) / map.pdf(place)).sum::<f64>() / f64::from(count)
        };
        assert!((mean(&|_| 1.0) - 1.0).abs() < 2e-2 && (mean(&|[x, y]| x + 2.0 * y) - 1.5).abs() < 3e-2);
        let wanted = drawn().filter(|[x, y]| *x < 0.16 && (*y < 0.06 || (0.15..0.26).contains(y) || *y > 0.93)).count();
        assert!(wanted as f64 > 0.1 * f64::from(count), "{wanted}");
        let even = ProjectionMap::even();
        assert!(drawn().all(|place| (even.pdf(place) - 1.0).abs() < 1e-9));
        let there = even.sample([0.3, 0.7]);
        assert!((there[0] - 0.3).abs() < 1e-12 && (there[1] - 0.7).abs() < 1e-12);
    }
}
