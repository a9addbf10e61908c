//! Profiles: curves in the half plane beside an axis, which make surfaces when they revolve about it.

use std::f64::consts::TAU;

use glam::DVec2;

use super::between;
use super::sphere::sine_and_cosine;
use crate::curve::{Curve, SplineCurve};

/// Steps of the search for the nearest point at most.
const MAX_STEPS: usize = 64;
/// Below this part of the size of a spline, a derivative is taken for zero.
const VANISHING: f64 = 1e-10;

/// A piece of a curve in the half plane: x is the distance from the axis (0 or more), y the place along it.
///
/// It is followed from v = 0 to v = 1; ranges may run either way.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A straight piece.
    Line {
        /// Where it begins.
        from: DVec2,
        /// Where it ends.
        to: DVec2,
    },
    /// A piece of a circle, center + radius (cos t, sin t).
    Arc {
        /// Its center.
        center: DVec2,
        /// Its radius.
        radius: f64,
        /// t at the beginning and at the end, turns.
        turns: [f64; 2],
    },
    /// A piece of a parabola around the axis, (t, apex + rise t^2).
    Parabola {
        /// Where it meets the axis.
        apex: f64,
        /// How fast it rises, 1 / model unit.
        rise: f64,
        /// t at the beginning and at the end, model units.
        reach: [f64; 2],
    },
    /// A piece of the hyperbola of one sheet, (across cosh t, along sinh t): it turns its side to the axis, and never
    /// meets it.
    HyperbolaOneSheet {
        /// Its least distance from the axis.
        across: f64,
        /// Its half axis along the axis of revolution.
        along: f64,
        /// t at the beginning and at the end.
        reach: [f64; 2],
    },
    /// A piece of the hyperbola of two sheets, which meets the axis, (across sinh t, along cosh t).
    HyperbolaTwoSheets {
        /// Its half axis across the axis of revolution.
        across: f64,
        /// Where it meets the axis.
        along: f64,
        /// t at the beginning and at the end.
        reach: [f64; 2],
    },
    /// A spline in the plane z = 0.
    Spline(SplineCurve),
}

impl Profile {
    /// The straight piece between two points.
    pub fn line(from: DVec2, to: DVec2) -> Profile {
        Profile::Line { from, to }
    }

    /// This curve from the other end.
    pub fn reversed(self) -> Profile {
        let turned = |[a, b]: [f64; 2]| [b, a];
        match self {
            Profile::Line { from, to } => Profile::Line { from: to, to: from },
            Profile::Arc { center, radius, turns } => Profile::Arc { center, radius, turns: turned(turns) },
            Profile::Parabola { apex, rise, reach } => Profile::Parabola { apex, rise, reach: turned(reach) },
            Profile::HyperbolaOneSheet { across, along, reach } => {
                Profile::HyperbolaOneSheet { across, along, reach: turned(reach) }
            }
            Profile::HyperbolaTwoSheets { across, along, reach } => {
                Profile::HyperbolaTwoSheets { across, along, reach: turned(reach) }
            }
            Profile::Spline(curve) => Profile::Spline(curve.reversed()),
        }
    }

    /// The point at `v`, 0..=1; model units. The same bits from either end.
    pub fn point(&self, v: f64) -> DVec2 {
        match self {
            // Of a spline, the point alone costs far less.
            Profile::Spline(curve) => {
                let [low, high] = curve.domain();
                curve.point(between(low, high, v)).truncate()
            }
            _ => self.jet(v)[0],
        }
    }

    /// The first and the second derivative of the point by v.
    pub fn derivatives(&self, v: f64) -> [DVec2; 2] {
        let [_, first, second] = self.jet(v);
        [first, second]
    }

    /// The unit tangent; where the derivative vanishes, its limit from the middle of the curve.
    pub fn direction(&self, v: f64) -> DVec2 {
        self.point_and_direction(v)[1]
    }

    /// The point, and the direction as [`Profile::direction`] tells it.
    pub(super) fn point_and_direction(&self, v: f64) -> [DVec2; 2] {
        let [point, first, second] = self.jet(v);
        [point, Profile::direction_of([point, first, second], v)]
    }

    fn direction_of([point, first, second]: [DVec2; 3], v: f64) -> DVec2 {
        let size = second.length() + point.length();
        if first.length() > VANISHING * size {
            return first.normalize();
        }
        let inwards = if v < 0.5 { 1.0 } else { -1.0 };
        (second * inwards).normalize_or(first.normalize_or_zero())
    }

    /// Whether no point is away from the axis.
    pub fn is_on_axis(&self) -> bool {
        [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|v| self.point(*v).x == 0.0)
    }

    /// The point and its derivative by v.
    pub(super) fn point_and_derivative(&self, v: f64) -> [DVec2; 2] {
        let [point, first, _] = self.jet(v);
        [point, first]
    }

    /// The point and its derivatives by v.
    fn jet(&self, v: f64) -> [DVec2; 3] {
        let ([low, high], jet): (_, fn(&Profile, f64) -> [DVec2; 3]) = match self {
            Profile::Line { from, to } => {
                let at = |k: usize| between(from[k], to[k], v);
                return [DVec2::new(at(0), at(1)), *to - *from, DVec2::ZERO];
            }
            Profile::Arc { turns, .. } => (*turns, Profile::arc),
            Profile::Parabola { reach, .. }
            | Profile::HyperbolaOneSheet { reach, .. }
            | Profile::HyperbolaTwoSheets { reach, .. } => (*reach, Profile::conic),
            Profile::Spline(curve) => (curve.domain(), Profile::spline),
        };
        let [point, first, second] = jet(self, between(low, high, v));
        [point, first * (high - low), second * (high - low) * (high - low)]
    }

    fn arc(&self, t: f64) -> [DVec2; 3] {
        let Profile::Arc { center, radius, .. } = self else { return [DVec2::ZERO; 3] };
        let [sine, cosine] = sine_and_cosine(t);
        let out = DVec2::new(cosine, sine) * *radius;
        [*center + out, out.perp() * TAU, out * -(TAU * TAU)]
    }

    fn conic(&self, t: f64) -> [DVec2; 3] {
        match *self {
            Profile::Parabola { apex, rise, .. } => {
                [DVec2::new(t, apex + rise * t * t), DVec2::new(1.0, 2.0 * rise * t), DVec2::new(0.0, 2.0 * rise)]
            }
            Profile::HyperbolaOneSheet { across, along, .. } => {
                let point = DVec2::new(across * t.cosh(), along * t.sinh());
                [point, DVec2::new(across * t.sinh(), along * t.cosh()), point]
            }
            Profile::HyperbolaTwoSheets { across, along, .. } => {
                let point = DVec2::new(across * t.sinh(), along * t.cosh());
                [point, DVec2::new(across * t.cosh(), along * t.sinh()), point]
            }
            _ => [DVec2::ZERO; 3],
        }
    }

    fn spline(&self, t: f64) -> [DVec2; 3] {
        let Profile::Spline(curve) = self else { return [DVec2::ZERO; 3] };
        let [first, second] = curve.derivatives(t);
        [curve.point(t), first, second].map(|vector| vector.truncate())
    }

    /// The parameter of the point that is nearest to `point`, near `guess` if there are several.
    ///
    /// In closed form for lines and circles, by Newton's method for the others.
    pub fn nearest(&self, point: DVec2, guess: f64) -> f64 {
        match self {
            Profile::Line { from, to } => {
                let along = *to - *from;
                let length = along.length();
                if length == 0.0 { guess } else { ((point - *from) / length).dot(along / length).clamp(0.0, 1.0) }
            }
            Profile::Arc { center, turns: [low, high], .. } => {
                let offset = point - *center;
                if offset == DVec2::ZERO || low == high {
                    return guess;
                }
                let angle = offset.y.atan2(offset.x) / TAU;
                let near = |t: f64| angle + (t - angle).round();
                let part = |t: f64| (t - low) / (high - low);
                let found = part(near(between(*low, *high, guess)));
                if (0.0..=1.0).contains(&found) {
                    return found;
                }
                // The angle one turn on may be there; else the nearer end is nearest.
                let found = part(near((low + high) * 0.5));
                if (0.0..=1.0).contains(&found) {
                    found
                } else {
                    f64::from(self.point(1.0).distance_squared(point) < self.point(0.0).distance_squared(point))
                }
            }
            _ => self.nearest_by_newton(point, guess),
        }
    }

    /// Newton's method on (C - point) . C' = 0. Long steps must come nearer; short ones, where distances do not differ
    /// by their digits any more, must become shorter.
    fn nearest_by_newton(&self, point: DVec2, guess: f64) -> f64 {
        const SHORT: f64 = 1e-6;
        let mut v = guess.clamp(0.0, 1.0);
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let [at, first, second] = self.jet(v);
            let offset = at - point;
            let slope = offset.dot(first);
            let (flat, bend) = (first.length_squared(), offset.dot(second));
            let curvature = if flat + bend > 0.1 * flat { flat + bend } else { flat };
            if curvature <= 0.0 {
                break;
            }
            let mut next = (v - slope / curvature).clamp(0.0, 1.0);
            if (next - v).abs() > SHORT {
                let nearer = |next: f64| (self.point(next) - point).length_squared() < offset.length_squared();
                let mut halvings = 0;
                while !nearer(next) && halvings < 30 {
                    next = (next + v) * 0.5;
                    halvings += 1;
                }
            } else if (next - v).abs() >= last {
                break;
            }
            last = (next - v).abs();
            v = next;
            if last == 0.0 {
                break;
            }
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Basis;
    use glam::DVec3;

    pub(super) fn members() -> Vec<Profile> {
        let points = [[1.0, 0.0], [2.0, 0.5], [0.5, 1.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        vec![
            Profile::line(DVec2::new(1.0, -1.0), DVec2::new(0.5, 2.0)),
            Profile::Arc { center: DVec2::new(3.0, 1.0), radius: 2.0, turns: [-0.2, 0.6] },
            Profile::Arc { center: DVec2::new(3.0, 1.0), radius: 1.0, turns: [1.5, 0.9] },
            Profile::Parabola { apex: 1.0, rise: -3.0, reach: [0.0, 2.0] },
            Profile::HyperbolaOneSheet { across: 0.5, along: 2.0, reach: [-1.5, 1.0] },
            Profile::HyperbolaTwoSheets { across: 0.5, along: -2.0, reach: [1.5, 0.0] },
            Profile::Spline(SplineCurve::new(Basis::clamped(3, 4).unwrap(), &points, &[1.0, 2.0, 1.0, 3.0]).unwrap()),
        ]
    }

    #[test]
    fn the_nearest_point_of_a_point_beside_the_curve_is_its_foot_to_twelve_digits() {
        for profile in members() {
            for k in 1..40 {
                let v = f64::from(k) / 40.0;
                for height in [-0.02, 0.0, 1e-9, 0.02] {
                    let point = profile.point(v) + profile.direction(v).perp() * height;
                    let found = profile.nearest(point, (v + 0.04).min(1.0));
                    assert!((found - v).abs() < 1e-12, "{profile:?} at {v}: {found} for {height}");
                }
            }
        }
    }

    #[test]
    fn reversed_profiles_have_the_same_points_to_the_bit() {
        for profile in members() {
            let turned = profile.clone().reversed();
            for v in [0.0, 0.125, 0.25, 0.5, 1.0] {
                assert_eq!(profile.point(v), turned.point(1.0 - v));
                assert!((profile.direction(v) + turned.direction(1.0 - v)).length() < 1e-14);
            }
        }
    }

    #[test]
    fn beyond_the_ends_the_nearer_end_is_nearest() {
        let quarter = Profile::Arc { center: DVec2::ZERO, radius: 1.0, turns: [0.0, 0.25] };
        assert_eq!(quarter.nearest(DVec2::new(1.0, -0.5), 0.4), 0.0);
        assert_eq!(quarter.nearest(DVec2::new(-1.0, 0.5), 0.4), 1.0);
        assert_eq!(quarter.nearest(DVec2::ZERO, 0.4), 0.4);
        assert_eq!(members()[0].nearest(DVec2::new(0.0, 9.0), 0.0), 1.0);
    }
}
