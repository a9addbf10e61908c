//! Where light is sent so that it meets what mirrors or refracts: at balls around it.

use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{disk, sphere};
use crate::scene::Prepared;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Balls at the most.
const MOST_BALLS: usize = 16;
/// A ball of whose disc more than this part is empty is divided, if there may be more balls.
const LOOSE: f64 = 0.7;
/// By how much balls are larger than they need be, so that rounding does not lose their rims.
const WIDER: f64 = 1.0 + 1e-9;

/// A ball around something that mirrors or refracts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl Ball {
    /// A direction towards it from a point, even in solid angle; every direction from inside.
    pub(super) fn direction(&self, from: DVec3, uniform: [f64; 2]) -> DVec3 {
        let offset = self.center - from;
        let Some(cap) = self.cap(offset) else { return sphere(uniform) };
        let [x, y] = disk(uniform);
        let square = x * x + y * y;
        let height = cap * square;
        // The sine of the angle over the distance from the middle of the disc.
        let scale = (cap * (2.0 - height)).max(0.0).sqrt();
        let axis = offset.normalize();
        let (u, v) = axis.any_orthonormal_pair();
        ((u * x + v * y) * scale + axis * (1.0 - height)).normalize()
    }

    /// The density of [`Ball::direction`], 1/sr.
    pub(super) fn density(&self, from: DVec3, direction: DVec3) -> f64 {
        let offset = self.center - from;
        let Some(cap) = self.cap(offset) else { return 0.5 / TAU };
        let along = offset.dot(direction);
        let aside = (offset - direction * along).length();
        if along > 0.0 && aside <= self.radius * WIDER { (TAU * cap).recip() } else { 0.0 }
    }

    /// A point on a line that goes in a direction and meets the ball, even in area across the direction.
    pub(super) fn line(&self, direction: DVec3, uniform: [f64; 2]) -> DVec3 {
        let (u, v) = direction.any_orthonormal_pair();
        let [x, y] = disk(uniform);
        self.center + (u * x + v * y) * self.radius
    }

    /// The density of [`Ball::line`], one over an area.
    pub(super) fn line_density(&self, direction: DVec3, on: DVec3) -> f64 {
        let offset = self.center - on;
        let aside = offset - direction * offset.dot(direction);
        let square = self.radius * self.radius;
        // Its own lines count to the last digit.
        if aside.length_squared() <= square * WIDER { (PI * square).recip() } else { 0.0 }
    }

    /// 1 − cos of the half angle under which it is seen from the other end of an offset; none from inside.
    fn cap(&self, offset: DVec3) -> Option<f64> {
        let sine = self.radius / offset.length();
        (sine < 1.0).then(|| sine * sine / (1.0 + (1.0 - sine * sine).sqrt()))
    }
}

/// Balls around all triangles that a test chooses, as tight as so many allow.
pub(super) fn balls(prepared: &Prepared, is_meant: impl Fn(u32) -> bool) -> Vec<Ball> {
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
    parts.into_iter().map(|part| part.ball).filter(|ball| ball.radius > 0.0 && ball.radius.is_finite()).collect()
}

/// Some triangles in a ball.
struct Part {
    triangles: Vec<u32>,
    ball: Ball,
    /// How much of the disc of the ball they leave empty, as seen from all sides in the mean, square units.
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
        Part { triangles, ball: Ball { center, radius }, empty: PI * radius * radius - seen }
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
    use crate::numeric::sequence::Sequence;

    #[test]
    fn directions_and_lines_to_a_ball_are_even_and_all_of_them() {
        let ball = Ball { center: DVec3::new(1.0, 2.0, 3.0), radius: 0.5 };
        let sequence = Sequence::new(2, 2);
        let from = DVec3::new(-1.0, 0.5, 2.0);
        let axis = (ball.center - from).normalize();
        let mean: DVec3 = (0..4096).map(|i| ball.direction(from, sequence.point(i, 0))).sum::<DVec3>() / 4096.0;
        let cosine = (1.0 - (0.5 / ball.center.distance(from)).powi(2)).sqrt();
        assert!((mean - axis * (0.5 * (1.0 + cosine))).length() < 1e-4);
        let solid_angle = TAU * (1.0 - cosine);
        for i in 0..4096 {
            let direction = ball.direction(from, sequence.point(i, 1));
            assert!((direction.length() - 1.0).abs() < 1e-12);
            let density = ball.density(from, direction);
            assert!((density * solid_angle - 1.0).abs() < 1e-9 || (direction.dot(axis) - cosine).abs() < 1e-12);
            let on = ball.line(direction, sequence.point(i, 2));
            assert!((ball.line_density(direction, on) * PI * 0.25 - 1.0).abs() < 1e-12);
        }
        assert_eq!(ball.density(from, -axis), 0.0);
        assert_eq!(ball.density(ball.center, axis), 0.5 / TAU);
        assert_eq!(ball.line_density(DVec3::Z, ball.center + DVec3::X), 0.0);
    }
}
