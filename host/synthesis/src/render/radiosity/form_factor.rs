//! Form factors of flat polygons that nothing stands between, as exchange areas: A F, the same from both sides.
//!
//! Far apart, a product of Gauss rules over both polygons; near or touching, Lambert's and Stokes' contour integral, of
//! which one half is known in closed form and the other is found adaptively.

use crate::numeric::cubature::GAUSS;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// Halvings of an edge of the contour at the most.
const MOST_HALVINGS: u32 = 20;
/// Halvings of an edge at the most where no more than a rough value is asked for, and how rough that is.
const FEW_HALVINGS: u32 = 5;
const ROUGH: f64 = 1e-3;
/// Rounding error of the integral over an edge, in units of the square of the size of the polygons.
const ROUNDING: f64 = 1e-14;

/// Points of the rule of degree 5 in a triangle, as weights of two corners, with the part of the area that each stands
/// for.
///
/// # Source
/// Radon 1948.
const SEVEN: [(f64, f64, f64); 7] = [
    (1.0 / 3.0, 1.0 / 3.0, 0.225),
    (NEAR, NEAR, NEAR_PART),
    (NEAR, 1.0 - 2.0 * NEAR, NEAR_PART),
    (1.0 - 2.0 * NEAR, NEAR, NEAR_PART),
    (FAR, FAR, FAR_PART),
    (FAR, 1.0 - 2.0 * FAR, FAR_PART),
    (1.0 - 2.0 * FAR, FAR, FAR_PART),
];
const NEAR: f64 = 0.101_286_507_323_456_34;
const NEAR_PART: f64 = 0.125_939_180_544_827_15;
const FAR: f64 = 0.470_142_064_105_115_1;
const FAR_PART: f64 = 0.132_394_152_788_506_2;

/// A convex polygon of a few corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Convex {
    corners: [DVec3; Convex::MOST],
    count: usize,
}

impl Convex {
    const MOST: usize = 8;

    /// A polygon, counter-clockwise about the side that exchanges light. Corners beyond the eighth are left out.
    pub(super) fn new(corners: &[DVec3]) -> Convex {
        let mut convex = Convex { corners: [DVec3::ZERO; Convex::MOST], count: 0 };
        corners.iter().take(Convex::MOST).for_each(|corner| convex.push(*corner));
        convex
    }

    fn push(&mut self, corner: DVec3) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let corners = self.corners();
        (0..corners.len()).map(move |i| [corners[i], corners[(i + 1) % corners.len()]])
    }

    /// The normal, as long as twice the area.
    fn area_vector(&self) -> DVec3 {
        let [first, rest @ ..] = self.corners() else { return DVec3::ZERO };
        rest.windows(2).map(|pair| (pair[0] - *first).cross(pair[1] - *first)).sum()
    }

    fn middle(&self) -> DVec3 {
        self.corners().iter().sum::<DVec3>() / self.count.max(1) as f64
    }

    /// From the middle to the farthest corner.
    fn radius(&self) -> f64 {
        let middle = self.middle();
        self.corners().iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max)
    }

    /// The part of it before a plane.
    fn before(&self, point: DVec3, normal: DVec3) -> Convex {
        let height = |corner: DVec3| (corner - point).dot(normal);
        let mut part = Convex::new(&[]);
        for [from, to] in self.edges() {
            let (low, high) = (height(from), height(to));
            if low > 0.0 {
                part.push(from);
            }
            if (low > 0.0) != (high > 0.0) {
                part.push(from + (to - from) * (low / (low - high)));
            }
        }
        part
    }

    /// Points that stand for it, with the area of each.
    fn points(&self, rule: &[(f64, f64, f64)], mut give: impl FnMut(DVec3, f64)) {
        let [first, rest @ ..] = self.corners() else { return };
        for pair in rest.windows(2) {
            let (a, b) = (pair[0] - *first, pair[1] - *first);
            let area = 0.5 * a.cross(b).length();
            rule.iter().for_each(|(u, v, part)| give(*first + a * *u + b * *v, area * part));
        }
    }
}

/// The form factor from an element at a point to a polygon, 0..=1, without what is below the element's horizon.
///
/// F = 1/2π Σ β n·Γ over the edges, β the angle under which an edge is seen and Γ the unit normal of the plane through
/// it.
///
/// - `normal`: unit length. The polygon counts from both sides.
///
/// # Source
/// Lambert 1760, in the form of Baum, Rushmeier and Winget 1989.
pub(super) fn from_point(point: DVec3, normal: DVec3, polygon: &Convex) -> f64 {
    let above = polygon.before(point, normal);
    let edge = |[from, to]: [DVec3; 2]| {
        let (from, to) = (from - point, to - point);
        let cross = from.cross(to);
        let sine = cross.length();
        if sine > 0.0 { sine.atan2(from.dot(to)) * normal.dot(cross) / sine } else { 0.0 }
    };
    (above.edges().map(edge).sum::<f64>().abs() / TAU).min(1.0)
}

/// The exchange of a unit area at one point with a unit area at another: cos cos / (π r²), 0 where one is behind the
/// other.
pub(super) fn kernel([a, a_normal]: [DVec3; 2], [b, b_normal]: [DVec3; 2]) -> f64 {
    let offset = b - a;
    let square = offset.length_squared();
    let (cos_a, cos_b) = (offset.dot(a_normal), -offset.dot(b_normal));
    if cos_a > 0.0 && cos_b > 0.0 { FRAC_1_PI * (cos_a / square) * (cos_b / square) } else { 0.0 }
}

/// The exchange area A F of two polygons, square units: what leaves one with a radiosity of 1 and comes to the other.
///
/// The parts of each that are behind the other are left out exactly.
///
/// - `tolerance`: error, as a part of the smaller area; of far polygons, about as a part of the result.
pub(super) fn exchange(a: &Convex, b: &Convex, tolerance: f64) -> f64 {
    let [a_normal, b_normal] = [a, b].map(|polygon| polygon.area_vector().normalize_or_zero());
    if a_normal == DVec3::ZERO || b_normal == DVec3::ZERO {
        return 0.0;
    }
    let (a, b) = (&a.before(b.corners[0], b_normal), &b.before(a.corners[0], a_normal));
    if a.count < 3 || b.count < 3 {
        return 0.0;
    }
    let ratio = (a.radius() + b.radius()) / a.middle().distance(b.middle());
    let rule = if ratio.powi(2) < tolerance {
        &[(1.0 / 3.0, 1.0 / 3.0, 1.0)][..]
    } else if 30.0 * ratio.powi(6) < tolerance {
        &SEVEN[..]
    } else {
        return lambert((a, a_normal), (b, b_normal), tolerance).unwrap_or_else(|| near(a, b, tolerance));
    };
    let mut sum = 0.0;
    a.points(rule, |from, from_area| {
        b.points(rule, |to, to_area| sum += kernel([from, a_normal], [to, b_normal]) * from_area * to_area);
    });
    sum
}

/// The mean over the smaller polygon of the form factors from its points to the larger; none where they vary too much.
fn lambert(a: (&Convex, DVec3), b: (&Convex, DVec3), tolerance: f64) -> Option<f64> {
    let distance = a.0.middle().distance(b.0.middle());
    let ((small, normal), (large, _)) = if a.0.radius() <= b.0.radius() { (a, b) } else { (b, a) };
    let gap = distance - large.radius();
    if gap <= 0.0 || 10.0 * (small.radius() / gap).powi(6) > tolerance {
        return None;
    }
    let mut sum = 0.0;
    small.points(&SEVEN, |point, area| sum += from_point(point, normal, large) * area);
    Some(sum)
}

/// A F = 1/2π ∮∮ ln r da·db over both contours.
fn near(a: &Convex, b: &Convex, tolerance: f64) -> f64 {
    // No length is squared or taken the logarithm of but in a unit of about its own size.
    let scale = a.radius().max(b.radius()).recip();
    let area = 0.5 * a.area_vector().length().min(b.area_vector().length()) * scale * scale;
    let unit = |polygon: &Convex| {
        let origin = a.corners[0];
        Convex { corners: polygon.corners.map(|corner| (corner - origin) * scale), count: polygon.count }
    };
    let (a, b) = (unit(a), unit(b));
    let halvings = if tolerance < ROUGH { MOST_HALVINGS } else { FEW_HALVINGS };
    let tolerance = (tolerance * TAU * area / a.count as f64).max(1e-15);
    let edge = |[from, to]: [DVec3; 2]| {
        let along = to - from;
        let value = |part: f64| b.edges().map(|edge| potential(from + along * part, along, edge)).sum::<f64>();
        halved(&value, [0.0, 1.0], gauss(&value, [0.0, 1.0]), tolerance, halvings)
    };
    let sum: f64 = a.edges().map(edge).sum();
    (sum / (TAU * scale * scale)).max(0.0)
}

/// ∫ ln r db along an edge as seen from a point, times a direction; without what adds up to 0 over a closed contour.
fn potential(point: DVec3, along: DVec3, [from, to]: [DVec3; 2]) -> f64 {
    let length = from.distance(to);
    let direction = (to - from) / length;
    let cosine = along.dot(direction);
    if length == 0.0 || cosine == 0.0 {
        return 0.0;
    }
    let offset = from - point;
    let (begin, height) = (offset.dot(direction), offset.cross(direction).length());
    let end = begin + length;
    let term = |t: f64| {
        let square = height * height + t * t;
        if square > 0.0 { 0.5 * t * square.ln() } else { 0.0 }
    };
    let angle = (height * length).atan2(height * height + begin * end);
    cosine * (term(end) - term(begin) + height * angle)
}

fn gauss(value: &impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
    GAUSS.iter().map(|(at, weight)| value(from + (to - from) * at) * weight).sum::<f64>() * (to - from)
}

/// An integral, halved until both halves together agree with the whole.
fn halved(value: &impl Fn(f64) -> f64, [from, to]: [f64; 2], whole: f64, tolerance: f64, left: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]];
    let parts = halves.map(|range| gauss(value, range));
    let sum = parts[0] + parts[1];
    // Below that, halves differ by rounding errors only.
    if left == 0 || (sum - whole).abs() <= tolerance.max(ROUNDING * (to - from)) {
        return sum;
    }
    let tolerance = 0.6 * tolerance;
    (0..2).map(|i| halved(value, halves[i], parts[i], tolerance, left - 1)).sum()
}

/// The most that two areas can exchange.
///
/// - `cosines`: the most that the product of the cosines at both can be. `distance`: at the least.
pub(super) fn limit(a_area: f64, b_area: f64, cosines: f64, distance: f64) -> f64 {
    let far = a_area * b_area * cosines / (PI * distance * distance);
    a_area.min(b_area).min(if far.is_finite() { far } else { f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::cubature::unit_square;

    fn rectangle(corner: DVec3, across: DVec3, up: DVec3) -> Convex {
        Convex::new(&[corner, corner + across, corner + across + up, corner + up])
    }

    /// Two equal rectangles opposite each other: Howell's catalogue, C-11.
    fn parallel(width: f64, height: f64, distance: f64) -> f64 {
        let (x, y) = (width / distance, height / distance);
        let (xx, yy) = (1.0 + x * x, 1.0 + y * y);
        let sum = (xx * yy / (1.0 + x * x + y * y)).sqrt().ln()
            + x * yy.sqrt() * (x / yy.sqrt()).atan()
            + y * xx.sqrt() * (y / xx.sqrt()).atan()
            - x * x.atan()
            - y * y.atan();
        2.0 * sum / (PI * x * y)
    }

    /// Two rectangles with a common edge, square to each other: Howell's catalogue, C-14. From that of a height `h` to
    /// that of a width `w`, per unit of the common edge.
    fn perpendicular(h: f64, w: f64) -> f64 {
        let (hh, ww) = (h * h, w * w);
        let r = (hh + ww).sqrt();
        let logarithm = ((1.0 + ww) * (1.0 + hh) / (1.0 + ww + hh)).ln()
            + ww * (ww * (1.0 + ww + hh) / ((1.0 + ww) * (ww + hh))).ln()
            + hh * (hh * (1.0 + hh + ww) / ((1.0 + hh) * (hh + ww))).ln();
        let sum = w * w.recip().atan() + h * h.recip().atan() - r * r.recip().atan() + 0.25 * logarithm;
        sum / (PI * w)
    }

    #[test]
    fn parallel_rectangles_have_their_published_form_factor() {
        for (width, height, distance) in [(1.0, 1.0, 1.0), (2.0, 0.3, 0.5), (1.0, 5.0, 0.1), (1.0, 1.0, 7.0)] {
            let [across, up] = [DVec3::X * width, DVec3::Y * height];
            let floor = rectangle(DVec3::ZERO, across, up);
            let ceiling = rectangle(DVec3::Z * distance, up, across);
            let found = exchange(&floor, &ceiling, 1e-10) / (width * height);
            let exact = parallel(width, height, distance);
            assert!((found - exact).abs() < 1e-8, "{width} {height} {distance}: {found} {exact}");
        }
    }

    #[test]
    fn perpendicular_rectangles_with_a_common_edge_have_theirs() {
        for (h, w) in [(1.0, 1.0), (0.2, 3.0), (10.0, 0.1)] {
            let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y * w);
            let wall = rectangle(DVec3::ZERO, DVec3::Z * h, DVec3::X);
            let found = exchange(&floor, &wall, 1e-9) / w;
            let exact = perpendicular(h, w);
            assert!((found - exact).abs() < 1e-7 * exact, "{h} {w}: {found} {exact}");
        }
    }

    #[test]
    fn plates_at_any_distance_exchange_what_the_closed_form_tells() {
        for power in -6..=6 {
            let distance = 10f64.powi(power);
            let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
            let ceiling = rectangle(DVec3::Z * distance, DVec3::Y, DVec3::X);
            let found = exchange(&floor, &ceiling, 1e-9);
            // Far away the closed form loses all digits, and the first term of its series remains.
            let exact = if distance > 100.0 { 1.0 / (PI * distance * distance) } else { parallel(1.0, 1.0, distance) };
            assert!((found - exact).abs() < 2e-4 * exact.min(1e-3 + distance), "{distance}: {found:e} {exact:e}");
        }
    }

    #[test]
    fn long_thin_patches_and_patches_that_touch_at_any_angle_agree_with_lamberts_formula() {
        for (angle, width) in [(1e-3, 1.0), (0.1, 1.0), (1.0, 1e-3), (2.0, 100.0), (3.0, 1.0), (3.13, 1.0), (PI, 1.0)] {
            let floor = rectangle(DVec3::ZERO, DVec3::X * width, DVec3::Y);
            let (sin, cos) = f64::sin_cos(angle);
            let wall = rectangle(DVec3::ZERO, DVec3::new(0.0, cos, sin), DVec3::X * width);
            let found = exchange(&floor, &wall, 1e-8);
            let at = |[x, y]: [f64; 2]| {
                // Points gather at the common edge.
                let y = y * y;
                let point = DVec3::new(x * width, y, 0.0);
                2.0 * y.sqrt() * from_point(point, DVec3::Z, &wall) * width
            };
            let lambert = unit_square(at, 1e-6 * width, 2_000_000);
            assert!(
                (found - lambert.value).abs() < 1e-5 * width.max(1e-3) + lambert.error,
                "{angle}: {found} {lambert:?}"
            );
            if width == 100.0 {
                // Endless strips.
                assert!((found / width - (1.0 - (0.5 * angle).sin())).abs() < 0.01);
            }
        }
    }

    #[test]
    fn what_is_behind_is_left_out_and_both_directions_agree() {
        let floor = Convex::new(&[DVec3::ZERO, DVec3::X, DVec3::Y]);
        let through = Convex::new(&[DVec3::new(0.2, 0.2, -1.0), DVec3::new(1.2, 0.1, 0.8), DVec3::new(0.1, 1.3, 0.9)]);
        let (one, other) = (exchange(&floor, &through, 1e-10), exchange(&through, &floor, 1e-10));
        assert!((one - other).abs() < 1e-9 && one >= 0.0, "{one} {other}");
        let below = Convex::new(&[DVec3::NEG_Z, DVec3::X - DVec3::Z, DVec3::Y - DVec3::Z]);
        assert_eq!(exchange(&floor, &below, 1e-6), 0.0);
        let flat = Convex::new(&[DVec3::Z, DVec3::Z, DVec3::Z]);
        assert_eq!(exchange(&floor, &flat, 1e-6), 0.0);
    }

    #[test]
    fn a_point_before_a_polygon_sees_it_as_lambert_tells() {
        // A quarter of an endless plane, half above the horizon of a wall.
        let far = 1e6;
        let wall = rectangle(DVec3::new(-far, -far, 1.0), DVec3::X * 2.0 * far, DVec3::Y * 2.0 * far);
        assert!((from_point(DVec3::ZERO, DVec3::Z, &wall) - 1.0).abs() < 1e-5);
        assert!((from_point(DVec3::ZERO, DVec3::X, &wall) - 0.5).abs() < 1e-5);
        assert_eq!(from_point(DVec3::ZERO, DVec3::NEG_Z, &wall), 0.0);
    }

    #[test]
    fn the_mean_of_lamberts_formula_agrees_with_the_contours() {
        use crate::numeric::sequence::SobolSequence;
        let sequence = SobolSequence::new(3, 1);
        let mut number = 0;
        let mut draw = || {
            number += 1;
            let ([x, y], z) = (sequence.point(number, 0), sequence.number(number, 1));
            DVec3::new(x, y, z) * 2.0 - 1.0
        };
        let mut compared = 0;
        for _ in 0..3000 {
            let [a, b] = [DVec3::ZERO, draw() * 6.0].map(|at| Convex::new(&[at + draw(), at + draw(), at + draw()]));
            let [a_normal, b_normal] = [&a, &b].map(|polygon| polygon.area_vector().normalize_or_zero());
            let (a, b) = (a.before(b.corners[0], b_normal), b.before(a.corners[0], a_normal));
            if a.count < 3 || b.count < 3 {
                continue;
            }
            let Some(quick) = lambert((&a, a_normal), (&b, b_normal), 1e-3) else { continue };
            compared += 1;
            let (exact, area) = (near(&a, &b, 1e-9), a.area_vector().length().min(b.area_vector().length()) * 0.5);
            assert!((quick - exact).abs() < 1e-3 * area, "{quick} {exact} {area}");
        }
        assert!(compared > 20, "{compared}");
    }
}
