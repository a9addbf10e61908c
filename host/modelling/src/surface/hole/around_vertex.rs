//! N four-sided patches that meet at a vertex.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::jet::{Jet, Polynomial};
use super::n_sided::twist;
use super::ribbon::Ribbon;
use super::{HoleError, HoleSide, MAX_SIDES, check, parts_of};
use crate::surface::bezier::casteljau;
use crate::surface::curvature::Curved;
use crate::surface::{Surface, nearest_from};

/// A patch with a curve and a derivative across it on each of its four sides, u and v in 0..=1.
///
/// # Source
/// Coons 1967; the twists after Gregory 1974, so that the derivatives across two sides need not agree on the twist at
/// their corner.
#[derive(Clone, Debug)]
pub struct FourSidedPatch {
    /// The curves where u is 0 and 1, by v, with the derivative by u; and where v is 0 and 1, by u, with that by v.
    sides: [[Ribbon; 2]; 2],
    /// Bezier points of the same curves.
    curves: [[[DVec3; 4]; 2]; 2],
}

/// The values of the cubics that are 1, or have the derivative 1, at one end, and are flat elsewhere.
fn hermite(t: Jet<f64>) -> [Jet<f64>; 4] {
    let x = t.value;
    [
        t.into([(1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x), 6.0 * x * (x - 1.0), 12.0 * x - 6.0]),
        t.into([x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x), 6.0 - 12.0 * x]),
        t.into([x * (1.0 - x) * (1.0 - x), (1.0 - x) * (1.0 - 3.0 * x), 6.0 * x - 4.0]),
        t.into([x * x * (x - 1.0), x * (3.0 * x - 2.0), 6.0 * x - 2.0]),
    ]
}

impl FourSidedPatch {
    fn jet(&self, uv: DVec2) -> Jet<DVec3> {
        let (u, v) = (Jet::parameter(uv.x, 0), Jet::parameter(uv.y, 1));
        let [in_u, in_v] = [hermite(u), hermite(v)];
        let strip = |[low, high]: &[Ribbon; 2], t: Jet<f64>, h: &[Jet<f64>; 4]| {
            low.curve.of(t) * h[0] + high.curve.of(t) * h[1] + low.across.of(t) * h[2] + high.across.of(t) * h[3]
        };
        let [of_u, of_v] = &self.sides;
        let mut sum = strip(of_u, v, &in_u) + strip(of_v, u, &in_v);
        let constant = |value: DVec3| Jet { value, first: [DVec3::ZERO; 2], second: [DVec3::ZERO; 3] };
        let one = Jet::constant(1.0);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let [end_u, end_v] = [i, j].map(|end| end as f64);
            let (point, by_u, by_v) = (of_u[i].curve.at(end_v), of_u[i].across.at(end_v), of_v[j].across.at(end_u));
            let corner = constant(point) * (in_u[i] * in_v[j])
                + constant(by_u) * (in_u[i + 2] * in_v[j])
                + constant(by_v) * (in_u[i] * in_v[j + 2]);
            // The twist as the mean that is asked for at the corner, seen from there.
            let [from_u, from_v] = [if i == 0 { u } else { one - u }, if j == 0 { v } else { one - v }];
            let twists = [of_u[i].across.derivative().at(end_v), of_v[j].across.derivative().at(end_u)];
            // What `twist` multiplies by the distances from the corner becomes a multiple of the two cubics.
            let rest =
                |t: Jet<f64>, end: usize| if end == 0 { (one - t) * (one - t) } else { t * t * Jet::constant(-1.0) };
            sum = sum - corner - twist(twists, from_u, from_v) * (rest(u, i) * rest(v, j));
        }
        sum
    }
}

impl Surface for FourSidedPatch {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::ZERO, DVec2::ONE]
    }

    /// On the sides that of the curves, to the bit.
    fn point(&self, uv: DVec2) -> DVec3 {
        for axis in 0..2 {
            for (end, curve) in self.curves[axis].iter().enumerate() {
                if uv[axis] == end as f64 {
                    return casteljau(*curve, uv[1 - axis]);
                }
            }
        }
        self.jet(uv).value
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        self.jet(uv).first
    }

    fn normal(&self, uv: DVec2) -> DVec3 {
        let [du, dv] = self.jet(uv).first;
        du.cross(dv).normalize_or_zero()
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}

impl Curved for FourSidedPatch {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        self.jet(uv).second
    }
}

/// A curve from the rim to the vertex.
struct Spoke {
    bezier: [DVec3; 4],
    /// The derivatives where it leaves the rim and where it arrives.
    ends: [DVec3; 2],
    /// The derivative at the vertex, a quarter turn ahead of the way outwards.
    quarter_turned: DVec3,
}

/// Fills a hole by patches that meet at a vertex, each with two sides of the hole.
///
/// - `sides`: an even number, 6 to [`MAX_SIDES`], in order with the hole on the left; the first patch has the last side
///   and the first. Curves to the vertex begin between the first and the second side, between the third and the fourth,
///   ...
/// - Returns half as many patches, outside out.
///
/// # Errors
/// [`HoleError`]: sides that do not follow one another, a corner without a common tangent plane, a hole that is folded.
pub fn patches_around_vertex(sides: &[HoleSide]) -> Result<Vec<FourSidedPatch>, HoleError> {
    let count = sides.len();
    if !(6..=MAX_SIDES).contains(&count) || !count.is_multiple_of(2) {
        return Err(HoleError::Count { count, expected: "an even number, 6 to 256" });
    }
    check(sides)?;
    let spokes = spokes(sides)?;
    let valence = spokes.len();
    let patch = |k: usize| {
        let (own, before) = (2 * k, (2 * k + count - 1) % count);
        let (spoke, last) = (&spokes[k], &spokes[(k + valence - 1) % valence]);
        let tangent = |side: usize, t: f64| Polynomial::cubic(sides[side].curve).derivative().at(t);
        let along = Ribbon::inside(&sides[own], own, [-tangent(before, 1.0), spoke.ends[0]])?;
        let beside = Ribbon::inside(&sides[before], before, [last.ends[0], tangent(own, 0.0)])?.reversed();
        let turn = TAU / valence as f64;
        // On the curve to the vertex ahead, by u; and on the one behind, by v.
        let ahead = spoke.ribbon(tangent(own, 1.0), tangent(own, 1.0), turn.sin_cos())?;
        let behind = {
            let (arriving, leaving) = (tangent((2 * k + count - 2) % count, 1.0), -tangent(before, 0.0));
            let (sin, cos) = turn.sin_cos();
            last.ribbon(arriving, leaving, (-sin, cos))?
        };
        let mut reversed = sides[before].curve;
        reversed.reverse();
        Ok(FourSidedPatch {
            sides: [[beside, ahead], [along, behind]],
            curves: [[reversed, spoke.bezier], [sides[own].curve, last.bezier]],
        })
    };
    (0..valence).map(patch).collect::<Result<_, HoleError>>().map_err(|error| error.among(count))
}

/// The curves to the vertex: where it lies, and in which plane, follows from their ends.
fn spokes(sides: &[HoleSide]) -> Result<Vec<Spoke>, HoleError> {
    let valence = sides.len() / 2;
    let starts: Vec<DVec3> = (0..valence).map(|k| sides[2 * k].curve[3]).collect();
    let mean = |points: &[DVec3]| points.iter().sum::<DVec3>() / valence as f64;
    let middle = mean(&starts);
    // As fast as would bring it to the middle.
    let leaving: Vec<DVec3> =
        (0..valence).map(|k| sides[2 * k].across[3].normalize_or_zero() * starts[k].distance(middle)).collect();
    // As cubics through the vertex would do from one side to the other.
    let lifted: Vec<DVec3> = starts.iter().zip(&leaving).map(|(start, way)| *start + *way * 0.5).collect();
    let vertex = mean(&lifted);
    let outward = |k: usize| (starts[k] - vertex) * 1.5 + leaving[k] * 0.5;
    let angle = |k: usize| DVec2::from_angle(k as f64 / valence as f64 * TAU);
    let wave = |axis: usize| (0..valence).map(|k| outward(k) * angle(k)[axis]).sum::<DVec3>() * (2.0 / valence as f64);
    let [x, y] = [wave(0), wave(1)];
    if x.cross(y).length() <= 1e-9 * x.length() * y.length() || !x.cross(y).is_finite() || x.cross(y) == DVec3::ZERO {
        return Err(HoleError::Flat);
    }
    let spoke = |k: usize| {
        let (direction, start) = (angle(k), starts[k]);
        let out = x * direction.x + y * direction.y;
        let bezier = [start, start + leaving[k] / 3.0, vertex + out / 3.0, vertex];
        Spoke { bezier, ends: [leaving[k], -out], quarter_turned: y * direction.x - x * direction.y }
    };
    Ok((0..valence).map(spoke).collect())
}

impl Spoke {
    /// The curve with the derivative across it that a patch beside it has: `own` at the rim.
    ///
    /// All along it is a combination of the curve's own derivative and of a vector that runs from `reference`, at the
    /// rim, to `quarter_turned`, at the vertex: the same two for the patches on both sides, which therefore have one
    /// tangent plane.
    ///
    /// - `(sin, cos)`: of the angle at the vertex.
    fn ribbon(&self, reference: DVec3, own: DVec3, (sin, cos): (f64, f64)) -> Result<Ribbon, HoleError> {
        let curve = Polynomial::cubic(self.bezier);
        let parts = parts_of(own, [reference, self.ends[0]]).ok_or(HoleError::Flat)?;
        if parts.x * sin <= 0.0 {
            return Err(HoleError::Flat);
        }
        let ahead = Polynomial::line(reference, self.quarter_turned);
        let across = ahead.times([parts.x, sin]).plus(&curve.derivative().times([parts.y, cos]));
        Ok(Ribbon { curve, across })
    }
}
