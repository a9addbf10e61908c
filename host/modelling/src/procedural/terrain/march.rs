//! Rays on height fields: the first crossing, found from the beginning of the ray by bounds along it.

use super::enclosure::Enclosure;
use super::field::{HeightField, normal_of};
use crate::numeric::ray::Ray;
use glam::{DVec2, DVec3};

/// Where a ray crosses a height field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainHit {
    /// Parameter along the ray.
    pub t: f64,
    /// The point of the ray there.
    pub point: DVec3,
    /// Unit normal of the surface, which points up.
    pub normal: DVec3,
}

/// What a ray asked of a height field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TerrainWork {
    /// How often heights were computed, with however few octaves.
    pub evaluations: u64,
}

/// A ray that asks more often than this has crossings, or comes as near as rounding, all along: steps become longer
/// then.
const MANY: u64 = 1 << 14;
/// Rounding of heights along the ray: of the place and of its height, as a part of the coordinates.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl HeightField {
    /// The first crossing of a ray with the surface, from above or from below.
    ///
    /// Between the beginning of the interval and the hit the ray crosses nowhere, and there its sign over the surface
    /// changes: both are proved by bounds, so that no peak is missed however thin. Where rounding leaves the sign open
    /// all along a contact, it counts as a hit if the ray is on the other side after it. A ray that begins on the
    /// surface leaves it without a hit.
    ///
    /// - `interval`: the least and the greatest t.
    /// - `footprint`: width of what the ray sees as one, units of length; 0 for all octaves.
    pub fn intersect(&self, ray: &Ray, interval: [f64; 2], footprint: f64) -> Option<TerrainHit> {
        self.intersect_and_count(ray, interval, footprint, &mut TerrainWork::default())
    }

    /// The first crossing, as [`HeightField::intersect`] finds it; adds the work.
    pub fn intersect_and_count(
        &self,
        ray: &Ray,
        interval: [f64; 2],
        footprint: f64,
        work: &mut TerrainWork,
    ) -> Option<TerrainHit> {
        if !(ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO) {
            return None;
        }
        let [from, to] = ray.within(&self.bounds(), interval)?;
        let mut line = Line::new(self, ray, footprint);
        let found = line.first_crossing(from, to);
        work.evaluations += line.evaluations;
        found.map(|(t, slope)| TerrainHit { t, point: ray.at(t), normal: normal_of(slope) })
    }
}

/// A ray above a height field.
pub(super) struct Line<'a> {
    field: &'a HeightField,
    ray: &'a Ray,
    footprint: f64,
    place: DVec2,
    direction: DVec2,
    /// Length along the ground for each t.
    speed: f64,
    /// Steps in t below this are below the finest cells by far.
    small: f64,
    pub(super) evaluations: u64,
}

/// The height of a ray above the surface around a t: `value + slope (s - t)`, off by at most `error`, with derivatives
/// off `slope` by at most `slope_error`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Above {
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) error: f64,
    pub(super) slope_error: f64,
    pub(super) ground: DVec2,
}

impl<'a> Line<'a> {
    pub(super) fn new(field: &'a HeightField, ray: &'a Ray, footprint: f64) -> Line<'a> {
        const PART: f64 = 1e-5;
        let direction = DVec2::new(ray.direction.x, ray.direction.z);
        let speed = direction.length();
        let small = field.finest_cell() / speed * PART;
        let place = DVec2::new(ray.origin.x, ray.origin.z);
        Line { field, ray, footprint, place, direction, speed, small, evaluations: 0 }
    }

    /// Bounds over `t - half..=t + half`.
    #[inline]
    pub(super) fn above(&mut self, t: f64, half: f64) -> Above {
        self.evaluations += 1;
        let at = self.place + self.direction * t;
        let Enclosure { value, slope, error, slope_error, .. } =
            self.field.enclosure(at, self.speed * half, self.footprint);
        let height = self.ray.origin.y + self.ray.direction.y * t;
        let steep = slope.x.abs() + slope.y.abs() + slope_error;
        let far = at.x.abs() + at.y.abs() + self.place.x.abs() + self.place.y.abs();
        let rounding = ROUNDING * (height.abs() + self.ray.origin.y.abs() + value.abs() + steep * far);
        Above {
            value: height - value,
            slope: self.ray.direction.y - slope.dot(self.direction),
            error: error + rounding,
            slope_error: slope_error * self.speed * (1.0 + ROUNDING) + ROUNDING * steep * self.speed,
            ground: slope,
        }
    }

    /// The first crossing in a range of t, and the slope of the ground there.
    fn first_crossing(&mut self, from: f64, to: f64) -> Option<(f64, DVec2)> {
        let begin = self.above(from, 0.0);
        let mut side = if begin.value.abs() > begin.error { begin.value.signum() } else { 0.0 };
        let mut t = from;
        let mut step = self.first_step(&begin, to - from);
        // Where an open contact began, if nothing clear came after it.
        let mut contact = None;
        while t < to {
            let (middle, half) =
                if to - t <= step { (t + 0.5 * (to - t), 0.5 * (to - t)) } else { (t + 0.5 * step, 0.5 * step) };
            let end = if to - t <= step { to } else { t + step };
            if end <= t {
                step = t.abs().max(f64::MIN_POSITIVE) * f64::EPSILON * 2.0;
                continue;
            }
            let above = self.above(middle, half * (1.0 + ROUNDING) + ROUNDING * t.abs());
            let (clear, open) = split(&above, half);
            if clear > 0.0 {
                let sign = (above.value - above.slope * half).signum();
                if side * sign < 0.0 {
                    return self.crossing_of_contact(contact.unwrap_or(from), t, side);
                }
                (side, contact) = (sign, None);
            }
            let Some(open) = open else {
                t = end;
                step = next_step(&above, half, 2.0 * half, [0.5, GROWTH]);
                continue;
            };
            if above.slope.abs() > above.slope_error {
                // There is one crossing at the most, and none if the ray goes away from the surface.
                if side * above.slope < 0.0
                    && let Some(found) = self.crossing([t + clear, end], middle, half, &above, side)
                {
                    return Some(found);
                }
                side = if side == 0.0 { above.slope.signum() } else { side };
                t = end;
                step *= 2.0;
                continue;
            }
            if step <= self.small || self.evaluations > MANY {
                let exact = self.above(middle, 0.0);
                let is_many = self.evaluations > MANY && step < (to - from) / MANY as f64;
                if above.error <= 2.0 * exact.error || is_many || step <= 4.0 * f64::EPSILON * t.abs() {
                    contact = contact.or(Some(t));
                    t = end;
                    step *= 2.0;
                    continue;
                }
            }
            if clear > 0.0 {
                t += clear;
            }
            step = next_step(&above, clear - half, 2.0 * half, [SHRINK, 0.5]).min(open + f64::EPSILON * t.abs());
        }
        None
    }

    /// How far the first step goes.
    fn first_step(&self, begin: &Above, most: f64) -> f64 {
        if self.speed == 0.0 {
            return most;
        }
        let falls = (begin.slope.abs() + begin.slope_error).max(self.speed);
        (begin.value.abs() / falls).max(self.small * 64.0).min(most)
    }

    /// The crossing in a range in which the height above the surface is monotonous, if there is one.
    ///
    /// - `side`: the sign at the beginning of the range.
    fn crossing(
        &mut self,
        [mut low, mut high]: [f64; 2],
        middle: f64,
        half: f64,
        above: &Above,
        side: f64,
    ) -> Option<(f64, DVec2)> {
        if side * (above.value + above.slope * (high - middle)) > -above.error {
            let end = self.above(high, 0.0);
            if side * end.value > 0.0 {
                return None;
            }
        }
        // Bounds of the second derivative over the first.
        let bend = above.slope_error / half / (above.slope.abs() - above.slope_error);
        let (mut last, mut one) = (None, (middle, above.value, above.slope));
        let mut ground = above.ground;
        for _ in 0..200 {
            let newton = one.0 - one.1 / one.2;
            let guess = last.map_or(newton, |last| inverse(last, one));
            let is_within = guess > low && guess < high;
            let next = if is_within {
                guess
            } else if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let moved = (next - one.0).abs();
            let precise = f64::EPSILON * (next.abs() + (self.place.x.abs() + self.place.y.abs()) / self.speed);
            let is_guess = next == guess || next == newton;
            if high - low <= precise || is_guess && bend * moved * moved <= precise || next <= low || next >= high {
                return Some((next, ground));
            }
            let found = self.above(next, 0.0);
            ground = found.ground;
            if side * found.value > 0.0 {
                low = next;
            } else {
                high = next;
            }
            if found.value == 0.0 {
                return Some((next, ground));
            }
            (last, one) = (Some(one), (next, found.value, found.slope));
        }
        Some((0.5 * (low + high), ground))
    }

    /// The crossing in a contact whose sign rounding left open, before which the ray was on one side and is on the
    /// other after it.
    fn crossing_of_contact(&mut self, mut low: f64, mut high: f64, side: f64) -> Option<(f64, DVec2)> {
        for _ in 0..200 {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                break;
            }
            if side * self.above(middle, 0.0).value > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some((high, self.above(high, 0.0).ground))
    }
}

/// How far from its beginning an interval is proved to be without a crossing, and how long the part after that is in
/// which there may be some; none where there are none.
fn split(above: &Above, half: f64) -> (f64, Option<f64>) {
    let Above { value, slope, error, .. } = *above;
    let (begin, end) = (value - slope * half, value + slope * half);
    let is_clear = begin.abs() > error;
    if is_clear && end.abs() > error && begin * end > 0.0 {
        return (2.0 * half, None);
    }
    let clear =
        if is_clear { ((begin.abs() - error) / slope.abs() * (1.0 - 1e-9)).clamp(0.0, 2.0 * half) } else { 0.0 };
    let open_to = if end.abs() > error { 2.0 * half - (end.abs() - error) / slope.abs() } else { 2.0 * half };
    (clear, Some((open_to - clear).max(0.0)))
}

/// How long the next step is, so that it is likely to be clear: errors grow about as steps do.
///
/// - `from`: where it begins, beside the middle of the last one. `step`: how long that was.
/// - `limits`: of how much longer it becomes.
fn next_step(above: &Above, from: f64, step: f64, limits: [f64; 2]) -> f64 {
    let begin = above.value + above.slope * from;
    let closing = (-above.slope * begin.signum()).max(0.0);
    let next = begin.abs() / (above.error / step + closing) * PART_OF_HEIGHT;
    next.clamp(step * limits[0], step * limits[1])
}

/// Steps become shorter by this at the most, and longer by that.
const SHRINK: f64 = 1.0 / 16.0;
const GROWTH: f64 = 8.0;
/// Part of what the height allows that they take: the best of a few for rays on mountains.
const PART_OF_HEIGHT: f64 = 0.75;

/// Where the cubic through two points with slopes, as a function of the value, is at 0.
///
/// # Source
/// Inverse interpolation by Hermite's polynomial: Traub 1964.
fn inverse(a: (f64, f64, f64), b: (f64, f64, f64)) -> f64 {
    let width = b.1 - a.1;
    if width == 0.0 {
        return f64::NAN;
    }
    let s = -a.1 / width;
    let r = 1.0 - s;
    let (h00, h10) = ((1.0 + 2.0 * s) * r * r, s * r * r);
    let h11 = s * s * (s - 1.0);
    // Relative to the newer point, which is the nearer one.
    b.0 + h00 * (a.0 - b.0) + width * (h10 / a.2 + h11 / b.2)
}
