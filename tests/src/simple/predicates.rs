//! Signs of determinants of the coordinates of some points, always right: rounded if that leaves no doubt, else with
//! integers.

use super::integer::{Integer, parts};
use glam::DVec3;

/// Points whose coordinates are whole numbers of some power of 2.
pub struct Points<'a> {
    /// Where they are.
    pub at: &'a [DVec3],
    /// All coordinates times 2 to this power are whole.
    places: i32,
}

/// A rounded determinant is certain beyond this part of the sum of its terms, all taken as positive.
const CERTAIN: f64 = 1e-14;
/// Below this, terms may be so small that rounding is not in proportion.
const SMALL: f64 = 1e-200;

impl Points<'_> {
    /// Takes points.
    pub fn of(at: &[DVec3]) -> Points<'_> {
        let coordinates = at.iter().flat_map(|p| p.to_array()).filter(|x| *x != 0.0);
        let lowest = coordinates.map(|x| parts(x).1).min().unwrap_or(0);
        Points { at, places: -lowest }
    }

    /// The coordinates of a point, in units of which they are whole numbers.
    pub fn whole(&self, point: u32) -> [Integer; 3] {
        self.at[point as usize].to_array().map(|x| Integer::of(x, self.places))
    }

    /// On which side of the plane through three points a fourth is: 1 where these are counter-clockwise, -1, or 0 on
    /// it.
    pub fn side(&self, [a, b, c]: [u32; 3], d: u32) -> i32 {
        let at = |point: u32| self.at[point as usize];
        let rows = [a, b, c].map(|p| (at(d) - at(p)).to_array());
        rounded_determinant(rows).unwrap_or_else(|| {
            let d = self.whole(d);
            determinant([a, b, c].map(|p| difference(&d, &self.whole(p)))).sign()
        })
    }

    /// Whether three points turn left (1), right (-1) or not (0), seen against an axis.
    pub fn turn(&self, axis: usize, [a, b, c]: [u32; 3]) -> i32 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let at = |point: u32| self.at[point as usize];
        let (p, q) = (at(b) - at(a), at(c) - at(a));
        let (one, two) = (p[u] * q[v], p[v] * q[u]);
        let all = one.abs() + two.abs();
        if all > SMALL && (one - two).abs() > CERTAIN * all {
            return (one - two).signum() as i32;
        }
        let [a, b, c] = [a, b, c].map(|point| self.whole(point));
        let (p, q) = (difference(&b, &a), difference(&c, &a));
        (&(&p[u] * &q[v]) - &(&p[v] * &q[u])).sign()
    }
}

/// The coordinates of one point less those of another.
pub fn difference(one: &[Integer; 3], two: &[Integer; 3]) -> [Integer; 3] {
    [&one[0] - &two[0], &one[1] - &two[1], &one[2] - &two[2]]
}

/// The cross product.
pub fn cross(a: &[Integer; 3], b: &[Integer; 3]) -> [Integer; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|[u, v]| &(&a[u] * &b[v]) - &(&a[v] * &b[u]))
}

/// The scalar product.
pub fn dot(a: &[Integer; 3], b: &[Integer; 3]) -> Integer {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// The determinant of three rows.
pub fn determinant([a, b, c]: [[Integer; 3]; 3]) -> Integer {
    dot(&a, &cross(&b, &c))
}

/// The sign of the determinant of three rounded differences, if that leaves no doubt.
fn rounded_determinant([a, b, c]: [[f64; 3]; 3]) -> Option<i32> {
    let (mut sum, mut all) = (0.0, 0.0);
    for (k, factor) in a.into_iter().enumerate() {
        let (u, v) = ((k + 1) % 3, (k + 2) % 3);
        let (one, two) = (b[u] * c[v], b[v] * c[u]);
        sum += factor * (one - two);
        all += factor.abs() * (one.abs() + two.abs());
    }
    (all > SMALL && sum.abs() > CERTAIN * all).then(|| sum.signum() as i32)
}
