//! Implicit points, known by the lines and planes that they lie on, and exact predicates of them.
//!
//! Where an edge meets a face, or three faces meet, no floating-point number says exactly where that is. Such a point
//! is kept as what defines it, with a rounded place and a bound on its error; predicates ask the rounded places first
//! and the definitions only if those leave a doubt.
//!
//! # Source
//! Attene 2020, "Indirect predicates for geometric constructions"; the numbers are ours.

use super::bounds::Bounds;
use super::exact::{Arithmetic, DoubleDouble, ExactNumber, RoundedNumber, cross, dot, minus};
use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::cmp::Ordering;
use std::sync::OnceLock;

/// The definition of a point.
#[derive(Clone, Debug, PartialEq)]
pub enum PointDefinition {
    /// Its coordinates.
    Given(DVec3),
    /// A line through two points, and a plane through three, which meet in one point.
    LineAndPlane([DVec3; 2], [DVec3; 3]),
    /// Three planes, each through three points, which meet in one point.
    Planes([[DVec3; 3]; 3]),
    /// The middle of three points.
    Middle(Box<[PointDefinition; 3]>),
}

impl PointDefinition {
    /// The crossing of two lines of one plane; they must not be parallel.
    pub fn crossing(one: [DVec3; 2], two: [DVec3; 2]) -> PointDefinition {
        // A plane through the second along an axis: one along which the lines are seen to cross, the more squarely the
        // better.
        let [p, q] = two;
        let (d, e) = (one[1] - one[0], q - p);
        let normal = (d / d.abs().max_element()).cross(e / e.abs().max_element()).abs();
        let mut axis = (0..3).max_by(|&i, &j| normal[i].total_cmp(&normal[j])).unwrap_or(0);
        if normal[axis] < 1e-14 {
            // That may be all roundings.
            let normal = cross(&step::<ExactNumber>(one[1], one[0]), &step(q, p));
            let slopes = normal.map(|slope| slope.over(&ExactNumber::from(1.0)).abs());
            axis = (0..3).max_by(|&i, &j| slopes[i].total_cmp(&slopes[j])).unwrap_or(0);
        }
        let mut third = p;
        third[axis] += p.abs().max_element().max(e.abs().max_element());
        PointDefinition::LineAndPlane(one, [p, q, third])
    }
}

/// An implicit point with its rounded place.
#[derive(Clone, Debug)]
pub struct ImplicitPoint {
    definition: PointDefinition,
    near: DVec3,
    /// How far each coordinate of `near` is from the true one at most.
    errors: DVec3,
    /// The exact coordinates, once someone asked for them.
    exact: OnceLock<Box<Homogeneous>>,
}

/// Homogeneous coordinates x, y, z, w with w > 0.
pub type Homogeneous = [ExactNumber; 4];

impl ImplicitPoint {
    /// Makes a point; the line and the plane, or the three planes, must meet in one point.
    pub fn new(definition: PointDefinition) -> ImplicitPoint {
        let (near, errors) = match &definition {
            &PointDefinition::Given(at) => return ImplicitPoint::known(definition, at, DVec3::ZERO),
            &PointDefinition::LineAndPlane(line, plane) => place(
                on_line(line, plane, RoundedNumber::over),
                on_line(line, plane, DoubleDouble::over),
                [&line, &plane],
            ),
            &PointDefinition::Planes(planes) => {
                let [a, b, c] = planes.each_ref();
                place(on_planes(planes, RoundedNumber::over), on_planes(planes, DoubleDouble::over), [a, b, c])
            }
            PointDefinition::Middle(points) => {
                let [a, b, c] = points.each_ref().map(|point| ImplicitPoint::new(point.clone()));
                let near = (a.near + b.near + c.near) / 3.0;
                let size = a.near.abs().max(b.near.abs()).max(c.near.abs());
                let errors = a.errors.max(b.errors).max(c.errors) + size * (4.0 * f64::EPSILON);
                return ImplicitPoint::known(definition, near, errors);
            }
        };
        if errors == DVec3::ZERO {
            return ImplicitPoint::known(PointDefinition::Given(near), near, errors);
        }
        // Where a line grazes a plane even double-double numbers may not do.
        if errors.max_element() <= 4.0 * f64::EPSILON * near.abs().max_element() {
            return ImplicitPoint::known(definition, near, errors);
        }
        let exact = homogeneous(&definition);
        let near = DVec3::from([0, 1, 2].map(|axis| exact[axis].over(&exact[3])));
        let error = f64::EPSILON * near.abs().max_element() + f64::MIN_POSITIVE;
        ImplicitPoint {
            exact: OnceLock::from(Box::new(exact)),
            ..ImplicitPoint::known(definition, near, DVec3::splat(error))
        }
    }

    fn known(definition: PointDefinition, near: DVec3, errors: DVec3) -> ImplicitPoint {
        ImplicitPoint { definition, near, errors, exact: OnceLock::new() }
    }

    /// The nearest place with floating-point coordinates, within a few roundings.
    pub fn near(&self) -> DVec3 {
        self.near
    }

    /// Whether that is its place exactly.
    pub fn is_exact(&self) -> bool {
        self.errors == DVec3::ZERO
    }

    /// The definition of the point.
    pub fn definition(&self) -> &PointDefinition {
        &self.definition
    }

    /// The middle of three points.
    pub fn middle(points: [&ImplicitPoint; 3]) -> ImplicitPoint {
        ImplicitPoint::new(PointDefinition::Middle(Box::new(points.map(|point| point.definition.clone()))))
    }

    /// A box that holds it.
    pub fn bounds(&self) -> Bounds {
        let reach = self.errors * (1.0 + 1e-9);
        let near = self.near;
        Bounds { min: near - reach, max: near + reach }
    }

    /// The exact coordinates times a common denominator, which comes last and is positive.
    pub fn homogeneous(&self) -> &Homogeneous {
        self.exact.get_or_init(|| Box::new(homogeneous(&self.definition)))
    }

    fn coordinate(&self, axis: usize) -> RoundedNumber {
        RoundedNumber { value: self.near[axis], error: self.errors[axis] }
    }
}

/// Coordinates that all points of a line or a plane share.
type Level = [Option<f64>; 3];

fn level(points: &[DVec3]) -> Level {
    [0, 1, 2].map(|axis| points.iter().all(|p| p[axis] == points[0][axis]).then_some(points[0][axis]))
}

fn either(one: Level, two: Level) -> Level {
    [0, 1, 2].map(|axis| one[axis].or(two[axis]))
}

/// A place to the last bit, in which some coordinates are known, and how far each is off at most.
///
/// - `rounded`: the place by a formula with its error.
/// - `twofold`: the same in double-double numbers, whose error is that of the other times 2^-51 or so.
/// - `on`: points of lines and planes that it is on.
fn place<const N: usize>(rounded: [RoundedNumber; 3], twofold: [DoubleDouble; 3], on: [&[DVec3]; N]) -> (DVec3, DVec3) {
    let known = on.into_iter().fold(Level::default(), |known, points| either(known, level(points)));
    let value = |axis: usize| known[axis].unwrap_or(twofold[axis].value());
    let error = |axis: usize| match known[axis] {
        Some(_) => 0.0,
        // No number where the divisor vanishes among the roundings.
        None if !rounded[axis].error.is_finite() => f64::INFINITY,
        None => rounded[axis].error * f64::exp2(-40.0) + twofold[axis].value().abs() * (0.5 * f64::EPSILON),
    };
    (DVec3::from([0, 1, 2].map(value)), DVec3::from([0, 1, 2].map(error)))
}

fn vector<N: Arithmetic>(v: DVec3) -> [N; 3] {
    v.to_array().map(N::from)
}

/// The difference of two given points.
fn step<N: Arithmetic>(to: DVec3, from: DVec3) -> [N; 3] {
    minus(&vector(to), &vector(from))
}

fn normal<N: Arithmetic>([a, b, c]: [DVec3; 3]) -> [N; 3] {
    cross(&step(b, a), &step(c, a))
}

/// For the line p + t (q - p) and the plane n (x - r) = 0: t as a fraction, n (r - p) over n (q - p).
fn fraction<N: Arithmetic>([p, q]: [DVec3; 2], plane: [DVec3; 3]) -> [N; 2] {
    let n = normal::<N>(plane);
    [dot(&n, &step(plane[0], p)), dot(&n, &step(q, p))]
}

fn on_line<N: Arithmetic + Copy>(line: [DVec3; 2], plane: [DVec3; 3], divide: fn(N, N) -> N) -> [N; 3] {
    let [over, under] = fraction::<N>(line, plane);
    let t = divide(over, under);
    let (start, along) = (vector::<N>(line[0]), step::<N>(line[1], line[0]));
    [0, 1, 2].map(|axis| start[axis] + along[axis] * &t)
}

/// Offset of the meeting point of three planes from the first point of the first, times the second result.
fn meeting<N: Arithmetic>(planes: [[DVec3; 3]; 3]) -> ([N; 3], N) {
    let n = planes.map(normal::<N>);
    let level = |index: usize| dot(&n[index], &step(planes[index][0], planes[0][0]));
    let [second, third] = [level(1), level(2)];
    let (a, b) = (cross(&n[2], &n[0]), cross(&n[0], &n[1]));
    let offset = [0, 1, 2].map(|axis| a[axis].clone() * &second + b[axis].clone() * &third);
    (offset, dot(&n[2], &b))
}

fn on_planes<N: Arithmetic + Copy>(planes: [[DVec3; 3]; 3], divide: fn(N, N) -> N) -> [N; 3] {
    let (offset, under) = meeting::<N>(planes);
    let start = vector::<N>(planes[0][0]);
    [0, 1, 2].map(|axis| start[axis] + divide(offset[axis], under))
}

fn homogeneous(definition: &PointDefinition) -> Homogeneous {
    let (start, offset, under) = match definition {
        &PointDefinition::Given(at) => {
            let [x, y, z] = vector(at);
            return [x, y, z, ExactNumber::from(1.0)];
        }
        &PointDefinition::LineAndPlane(line, plane) => {
            let [over, under] = fraction::<ExactNumber>(line, plane);
            (line[0], step::<ExactNumber>(line[1], line[0]).map(|c| c * &over), under)
        }
        &PointDefinition::Planes(planes) => {
            let (offset, under) = meeting::<ExactNumber>(planes);
            (planes[0][0], offset, under)
        }
        PointDefinition::Middle(points) => return middle(points.each_ref().map(homogeneous)),
    };
    let [x, y, z] = vector::<ExactNumber>(start);
    let [dx, dy, dz] = offset;
    let coordinates = [x * &under + dx, y * &under + dy, z * &under + dz, under];
    if coordinates[3].sign() < 0.0 { coordinates.map(ExactNumber::negated) } else { coordinates }
}

fn middle([a, b, c]: [Homogeneous; 3]) -> Homogeneous {
    let weights = [b[3].clone() * &c[3], c[3].clone() * &a[3], a[3].clone() * &b[3]];
    let sum =
        |axis: usize| a[axis].clone() * &weights[0] + b[axis].clone() * &weights[1] + c[axis].clone() * &weights[2];
    let under = weights[0].clone() * &a[3] * &ExactNumber::from(3.0);
    [sum(0), sum(1), sum(2), under]
}

/// The two axes that are left when one is left out, in cyclic order.
pub fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// Direction in which a, b, c turn, seen along `axis` with the other two in cyclic order: 1.0 counter-clockwise, -1.0
/// clockwise, 0.0 on one line.
pub fn turn(axis: usize, a: &ImplicitPoint, b: &ImplicitPoint, c: &ImplicitPoint) -> f64 {
    let [x, y] = others(axis);
    if let (PointDefinition::Given(a), PointDefinition::Given(b), PointDefinition::Given(c)) =
        (&a.definition, &b.definition, &c.definition)
    {
        let coord = |p: &DVec3| Coord { x: p[x], y: p[y] };
        return sign_of(orient2d(coord(a), coord(b), coord(c)));
    }
    let difference = |p: &ImplicitPoint, axis: usize| p.coordinate(axis) - c.coordinate(axis);
    let rounded = difference(a, x) * &difference(b, y) - difference(a, y) * &difference(b, x);
    rounded.sign().unwrap_or_else(|| turn_exactly([x, y], [a, b, c]))
}

#[cold]
fn turn_exactly([x, y]: [usize; 2], points: [&ImplicitPoint; 3]) -> f64 {
    let [a, b, c] = points.map(ImplicitPoint::homogeneous);
    // The determinant of (x, y, w), all w positive.
    let minor = |p: &Homogeneous, q: &Homogeneous| p[x].clone() * &q[y] - p[y].clone() * &q[x];
    (minor(a, b) * &c[3] + minor(b, c) * &a[3] + minor(c, a) * &b[3]).sign()
}

/// Order of two points along an axis.
pub fn compare(axis: usize, a: &ImplicitPoint, b: &ImplicitPoint) -> Ordering {
    let rounded = a.coordinate(axis) - b.coordinate(axis);
    let sign = rounded.sign().unwrap_or_else(|| {
        let [p, q] = [a, b].map(ImplicitPoint::homogeneous);
        (p[axis].clone() * &q[3] - q[axis].clone() * &p[3]).sign()
    });
    sign.total_cmp(&0.0)
}

/// Whether two points are the same.
pub fn coincide(a: &ImplicitPoint, b: &ImplicitPoint) -> bool {
    (0..3).all(|axis| compare(axis, a, b) == Ordering::Equal)
}

/// On which side of the plane through a, b, c the point lies: 1.0 where they turn clockwise as seen from it, that is
/// behind a counter-clockwise face, -1.0 in front of it, 0.0 on the plane. All points given.
pub fn side(a: DVec3, b: DVec3, c: DVec3, point: DVec3) -> f64 {
    sign_of(orient3d(coord(a), coord(b), coord(c), coord(point)))
}

/// On which side of a plane through three given points any point lies: 1.0 behind the plane, -1.0 in front of it, 0.0
/// on it; see [`side`].
pub fn side_of(plane: [DVec3; 3], point: &ImplicitPoint) -> f64 {
    if let &PointDefinition::Given(point) = &point.definition {
        return side(plane[0], plane[1], plane[2], point);
    }
    let n = normal::<RoundedNumber>(plane);
    let offset = [0, 1, 2].map(|axis| point.coordinate(axis) - RoundedNumber::from(plane[0][axis]));
    let rounded = dot(&n, &offset);
    -rounded.sign().unwrap_or_else(|| {
        let [x, y, z, w] = point.homogeneous();
        let start = vector::<ExactNumber>(plane[0]).map(|c| c * w);
        dot(&normal::<ExactNumber>(plane), &minus(&[x.clone(), y.clone(), z.clone()], &start)).sign()
    })
}

/// The axis to leave out so that a triangle keeps an area, and how it then turns; `None` if its corners are on one
/// line.
pub fn projection([a, b, c]: [DVec3; 3]) -> Option<(usize, f64)> {
    let size = (b - a).cross(c - a).abs();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| size[j].total_cmp(&size[i]));
    axes.into_iter().find_map(|axis| {
        let [x, y] = others(axis);
        let coord = |p: DVec3| Coord { x: p[x], y: p[y] };
        let turn = sign_of(orient2d(coord(a), coord(b), coord(c)));
        (turn != 0.0).then_some((axis, turn))
    })
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

fn sign_of(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        // Few values, so that points coincide and line up.
        let coordinate = prop_oneof![-4..5, -4..5].prop_map(|k| f64::from(k) * 0.1);
        [coordinate.clone(), coordinate.clone(), coordinate].prop_map(DVec3::from)
    }

    #[test]
    fn sides_are_those_of_the_counter_clockwise_face() {
        assert_eq!(side(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z), -1.0);
        let above = ImplicitPoint::new(PointDefinition::LineAndPlane(
            [DVec3::ZERO, DVec3::ONE],
            [DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z],
        ));
        assert_eq!(above.near(), DVec3::ONE);
        assert_eq!(side_of([DVec3::ZERO, DVec3::X, DVec3::Y], &above), -1.0);
        assert_eq!(side_of([DVec3::ONE, DVec3::new(2.0, 1.0, 1.0), DVec3::new(1.0, 2.0, 1.0)], &above), 0.0);
    }

    #[test]
    fn lines_that_are_almost_parallel_cross_where_they_do() {
        let one = [
            DVec3::new(-1.0, -1.2325951644078307e-32, -5.551115123125784e-17),
            DVec3::new(-1.0, -2.4651903288156648e-33, -9.992007221626407e-17),
        ];
        let two = [
            DVec3::new(-1.0, -2.4651903288156627e-33, -9.992007221626408e-17),
            DVec3::new(-1.0, -1.2325951644078312e-32, -5.5511151231257815e-17),
        ];
        let point = ImplicitPoint::new(PointDefinition::crossing(one, two));
        assert!(point.near().is_finite() && point.near().x == -1.0 && point.homogeneous()[3].sign() > 0.0);
        for [a, b] in [one, two] {
            let [a, b] = [a, b].map(|p| ImplicitPoint::new(PointDefinition::Given(p)));
            assert_eq!([turn(0, &a, &b, &point), turn(1, &a, &b, &point)], [0.0; 2]);
        }
        let far = ImplicitPoint::new(PointDefinition::crossing(
            [DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)],
            [DVec3::X, DVec3::Y],
        ));
        assert_eq!(far.near(), DVec3::new(0.5, 0.5, 0.0));
    }

    #[test]
    fn a_line_that_grazes_a_plane_still_has_its_point_to_the_last_bit() {
        let e = 1e-12;
        let line = [DVec3::new(0.0, 0.0, -e), DVec3::new(1.0, 0.0, e * 3.0)];
        let plane = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let point = ImplicitPoint::new(PointDefinition::LineAndPlane(line, plane));
        let exact = {
            let z = [ExactNumber::from(-e), ExactNumber::from(e * 3.0)];
            z[0].clone().negated().over(&(z[1].clone() - z[0].clone()))
        };
        assert_eq!(point.near(), DVec3::new(exact, 0.0, 0.0));
        assert!(point.errors.max_element() < 1e-15);
    }

    #[test]
    fn a_line_that_grazes_a_plane_of_hardly_any_area_intersects_it_somewhere() {
        let line = [DVec3::new(0.0, 0.0, 0.1), DVec3::new(0.0, 0.1, 0.0)];
        let plane = [DVec3::new(0.0, -0.4, 0.1), DVec3::new(0.30000000000000004, 0.2, 0.1), DVec3::new(0.1, -0.2, 0.1)];
        let point = ImplicitPoint::new(PointDefinition::LineAndPlane(line, plane));
        assert_eq!(point.near(), line[0]);
        assert!(point.errors.is_finite());
        assert!(coincide(&point, &ImplicitPoint::new(PointDefinition::Given(line[0]))));
    }

    proptest! {
        #[test]
        fn implicit_points_lie_on_what_defines_them(p in point(), q in point(), a in point(), b in point(), c in point()) {
            prop_assume!(side(a, b, c, p) != side(a, b, c, q));
            let point = ImplicitPoint::new(PointDefinition::LineAndPlane([p, q], [a, b, c]));
            prop_assert_eq!(side_of([a, b, c], &point), 0.0);
            for axis in 0..3 {
                prop_assert_eq!(turn(axis, &ImplicitPoint::new(PointDefinition::Given(p)), &ImplicitPoint::new(PointDefinition::Given(q)), &point), 0.0);
            }
            let exact = point.homogeneous();
            for axis in 0..3 {
                let gap = exact[axis].clone() - ExactNumber::from(point.near[axis]) * &exact[3];
                prop_assert!(gap.over(&exact[3]).abs() <= point.errors[axis] * (1.0 + 1e-9));
            }
        }

        #[test]
        fn three_planes_meet_where_the_line_of_two_meets_the_third(n in [point(), point(), point()], r in point()) {
            // Three planes through r.
            let planes = n.map(|n| { let u = n.any_orthogonal_vector(); [r, r + u, r + n.cross(u)] });
            let u = planes.map(|[a, b, c]| normal::<ExactNumber>([a, b, c]));
            prop_assume!(dot(&u[0], &cross(&u[1], &u[2])).sign() != 0.0);
            let point = ImplicitPoint::new(PointDefinition::Planes(planes));
            prop_assert!(coincide(&point, &ImplicitPoint::new(PointDefinition::Given(r))));
            prop_assert!(planes.iter().all(|plane| side_of(*plane, &point) == 0.0));
        }

        #[test]
        fn turns_are_those_of_the_exact_formula(n in [point(), point(), point(), point(), point()], axis in 0..3usize) {
            let [p, q, a, b, c] = n;
            prop_assume!(side(a, b, c, p) != side(a, b, c, q));
            let [x, y] = [p, a].map(|at| ImplicitPoint::new(PointDefinition::Given(at)));
            let point = ImplicitPoint::new(PointDefinition::LineAndPlane([p, q], [a, b, c]));
            prop_assert_eq!(turn(axis, &x, &y, &point), turn_exactly(others(axis), [&x, &y, &point]));
            prop_assert_eq!(turn(axis, &x, &point, &y), -turn(axis, &x, &y, &point));
        }
    }
}
