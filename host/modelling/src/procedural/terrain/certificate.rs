//! Proofs of what rays found on height fields, by arithmetic that does not share code with the search.

use super::field::HeightField;
use super::interval::{BoundedSlopes, Interval};
use super::march::Line;
use crate::numeric::ray::Ray;

/// Intervals that one proof may ask for.
const MOST_INTERVALS: u64 = 1 << 22;

/// What became of a proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// There is no crossing before the hit, and one at it; or none at all where none was found.
    Proved,
    /// There is a crossing before the hit, or one where none was found.
    Missed,
    /// There is no change of sign at the hit.
    False,
    /// Rounding leaves it open: the ray comes as near to the surface as that without a proved crossing.
    Open,
}

/// The bounds with which a proof is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProofBy {
    /// Interval arithmetic with outward rounding, formula by formula; slow.
    Intervals,
    /// The bounds of [`HeightField::enclosure`]; fast.
    Enclosures,
}

/// Proves that a ray crosses a height field first where it was found to, or nowhere: every part of the ray before the
/// hit is halved until bounds exclude a crossing in it, and the sign over the surface is another one before the hit
/// than after it.
///
/// - `hit`: the t that was found, if one was.
/// - `tolerance`: how far in t the crossing may be from it; at least some roundings of the coordinates.
/// - Returns the verdict, and how many intervals were asked for.
pub fn certify(
    field: &HeightField,
    ray: &Ray,
    interval: [f64; 2],
    footprint: f64,
    hit: Option<f64>,
    tolerance: f64,
    by: ProofBy,
) -> (Verdict, u64) {
    let mut proof = Proof::new(field, ray, footprint, tolerance, by);
    let Some([from, to]) = ray.within(&field.bounds(), interval) else {
        return (if hit.is_none() { Verdict::Proved } else { Verdict::False }, 0);
    };
    let before = hit.map_or(to, |t| t - tolerance);
    let first = proof.first_crossing(from, before);
    let verdict = match (first, hit) {
        (First::Crossing(_), _) => Verdict::Missed,
        (First::Open, _) => Verdict::Open,
        (First::None, None) => Verdict::Proved,
        (First::None, Some(t)) => {
            let [a, b] = [t - tolerance, t + tolerance].map(|t| proof.sign(t));
            match a * b {
                -1 => Verdict::Proved,
                1 => Verdict::False,
                _ => Verdict::Open,
            }
        }
    };
    (verdict, proof.intervals)
}

/// The first crossing of a ray with a height field by plain subdivision: parts in which interval arithmetic excludes
/// one are dropped, others halved down to the tolerance.
///
/// - Returns a t within `tolerance` of the first change of sign; none where there is none, or rounding leaves it open.
pub fn crossing_by_subdivision(
    field: &HeightField,
    ray: &Ray,
    interval: [f64; 2],
    footprint: f64,
    tolerance: f64,
) -> Option<f64> {
    let [from, to] = ray.within(&field.bounds(), interval)?;
    match Proof::new(field, ray, footprint, tolerance, ProofBy::Intervals).first_crossing(from, to) {
        First::Crossing(t) => Some(t),
        First::None | First::Open => None,
    }
}

/// What is first in a part of a ray.
enum First {
    None,
    Crossing(f64),
    Open,
}

struct Proof<'a> {
    field: &'a HeightField,
    ray: &'a Ray,
    footprint: f64,
    tolerance: f64,
    by: ProofBy,
    intervals: u64,
}

impl<'a> Proof<'a> {
    fn new(field: &'a HeightField, ray: &'a Ray, footprint: f64, tolerance: f64, by: ProofBy) -> Proof<'a> {
        Proof { field, ray, footprint, tolerance, by, intervals: 0 }
    }

    /// Bounds of the height over the surface in a part of the ray.
    fn height(&mut self, t: Interval) -> Interval {
        self.intervals += 1;
        match self.by {
            ProofBy::Intervals => self.by_intervals(t),
            ProofBy::Enclosures => {
                let half = 0.5 * (t.high - t.low);
                let above = Line::new(self.field, self.ray, self.footprint).above(t.middle(), half);
                let spread = above.slope.abs() * half + above.error;
                Interval::new(above.value - spread, above.value + spread)
            }
        }
    }

    fn by_intervals(&self, t: Interval) -> Interval {
        let over = |t: Interval| {
            let along = |origin: f64, rate: f64| Interval::point(origin) + Interval::point(rate) * t;
            let Ray { origin, direction } = *self.ray;
            let place = BoundedSlopes::rectangle(along(origin.x, direction.x), along(origin.z, direction.z));
            let ground: BoundedSlopes = self.field.function().heights(&place, self.footprint);
            let [x, z] = ground.slopes;
            let rate =
                Interval::point(direction.y) - (x * Interval::point(direction.x) + z * Interval::point(direction.z));
            (along(origin.y, direction.y) - ground.value, rate)
        };
        let (plain, rate) = over(t);
        let middle = Interval::point(t.middle());
        plain.common(over(middle).0 + rate * (t - middle))
    }

    /// The sign at a t; 0 where rounding leaves it open.
    fn sign(&mut self, t: f64) -> i32 {
        let height = self.height(Interval::point(t));
        i32::from(height.low > 0.0) - i32::from(height.high < 0.0)
    }

    fn first_crossing(&mut self, from: f64, to: f64) -> First {
        let mut parts = vec![Interval::new(from, to)];
        let mut side = 0;
        while let Some(part) = parts.pop() {
            if part.low >= part.high {
                continue;
            }
            let height = self.height(part);
            let sign = i32::from(height.low > 0.0) - i32::from(height.high < 0.0);
            if sign != 0 {
                if side * sign < 0 {
                    return First::Crossing(part.low);
                }
                side = sign;
            } else if self.intervals > MOST_INTERVALS {
                return First::Open;
            } else if part.high - part.low > 0.25 * self.tolerance {
                let middle = part.middle();
                parts.push(Interval::new(middle, part.high));
                parts.push(Interval::new(part.low, middle));
            }
        }
        // What was left open is no crossing where the sides before and after it are the same.
        First::None
    }
}
