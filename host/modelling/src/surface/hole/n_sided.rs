//! One patch with N sides.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::jet::{Jet, Polynomial};
use super::ribbon::Ribbon;
use super::{HoleError, HoleSide, MAX_SIDES, check};
use crate::surface::bezier::casteljau;
use crate::surface::curvature::Curved;
use crate::surface::{Surface, nearest_from};

/// A sector of a patch with N sides: u runs along one side, v from there to the middle, both 0..=1.
///
/// The patch is one function over the regular polygon around the unit circle. At each corner the two strips beside it are
/// joined into a surface that has both of them; the patch is the mean of these N surfaces, weighted by the products of the
/// squared distances from the other sides. So it has the curves and the tangent planes of all sides, and it is smooth in
/// between. Sectors meet as smoothly as the function is.
///
/// # Source
/// Charrot and Gregory 1984, with variable twists after Gregory 1974.
#[derive(Clone, Debug)]
pub struct NSidedPatch {
    patch: Arc<PolygonPatch>,
    sector: usize,
}

#[derive(Debug)]
struct PolygonPatch {
    /// For each corner the strip along the side that begins there, and the one along the side that ends there, reversed.
    corners: Vec<[Ribbon; 2]>,
    curves: Vec<[DVec3; 4]>,
    /// The outward unit normals of the polygon's sides.
    normals: Vec<DVec2>,
    middle: DVec3,
}

/// Fills a hole by one patch, given as a sector for each side.
///
/// - `sides`: 3 to [`MAX_SIDES`], in order with the hole on the left.
/// - Returns the sectors, in the order of the sides; outside out. They agree with the sides and each other to the bit.
///
/// # Errors
/// [`HoleError`]: sides that do not follow one another, a corner without a common tangent plane, a hole that is folded.
pub fn n_sided_patch(sides: &[HoleSide]) -> Result<Vec<NSidedPatch>, HoleError> {
    let count = sides.len();
    if !(3..=MAX_SIDES).contains(&count) {
        return Err(HoleError::Count { count, expected: "3 to 256" });
    }
    check(sides)?;
    let tangents: Vec<Polynomial> = sides.iter().map(|side| Polynomial::cubic(side.curve).derivative()).collect();
    let ribbon = |k: usize| {
        let (before, after) = ((k + count - 1) % count, (k + 1) % count);
        Ribbon::inside(&sides[k], k, [-tangents[before].at(1.0), tangents[after].at(0.0)])
    };
    let ribbons = (0..count).map(ribbon).collect::<Result<Vec<_>, _>>().map_err(|error| error.among(count))?;
    let normal = |k: usize| DVec2::from_angle((k as f64 + 0.5) / count as f64 * TAU);
    let mut whole = PolygonPatch {
        corners: (0..count).map(|k| [ribbons[k], ribbons[(k + count - 1) % count].reversed()]).collect(),
        curves: sides.iter().map(|side| side.curve).collect(),
        normals: (0..count).map(normal).collect(),
        middle: DVec3::ZERO,
    };
    whole.middle = whole.at([Jet::parameter(0.0, 0), Jet::parameter(0.0, 1)]).value;
    let whole = Arc::new(whole);
    Ok((0..count).map(|sector| NSidedPatch { patch: whole.clone(), sector }).collect())
}

impl PolygonPatch {
    /// The point over a point of the polygon.
    fn at(&self, [x, y]: [Jet<f64>; 2]) -> Jet<DVec3> {
        let count = self.normals.len();
        let scaled = |jet: Jet<f64>, by: f64| jet * Jet::constant(by);
        // Distances from the sides, not below 0 by rounding.
        let distance = |normal: &DVec2| {
            let distance = Jet::constant(1.0) - scaled(x, normal.x) - scaled(y, normal.y);
            Jet { value: distance.value.max(0.0), ..distance }
        };
        let distances: Vec<Jet<f64>> = self.normals.iter().map(distance).collect();
        // Products of the squares of the first distances, and of the last ones.
        let one = Jet::constant(1.0);
        let mut first = vec![one];
        let mut last = vec![one];
        for k in 0..count {
            first.push(first[k] * distances[k] * distances[k]);
            let other = distances[count - 1 - k];
            last.push(last[k] * other * other);
        }
        let (mut sum, mut weights): (Option<Jet<DVec3>>, Jet<f64>) = (None, Jet::constant(0.0));
        for k in 0..count {
            // All but sides k - 1 and k.
            let weight = if k == 0 {
                (1..count - 1).fold(one, |product, i| product * distances[i] * distances[i])
            } else {
                first[k - 1] * last[count - 1 - k]
            };
            if weight.value == 0.0 && weight.first == [0.0; 2] && weight.second == [0.0; 3] {
                continue;
            }
            let at = |i: usize| distances[i % count];
            let (own, before) = (at(k), at(k + count - 1));
            let (across_u, across_v) = (before + at(k + 1), own + at(k + count - 2));
            // In a triangle, both are 0 at a corner, where the weight of the others is flat.
            if across_u.value == 0.0 || across_v.value == 0.0 {
                continue;
            }
            let (u, v) = (before * across_u.recip(), own * across_v.recip());
            let term = corner_surface(&self.corners[k], u, v) * weight;
            sum = Some(sum.map_or(term, |sum| sum + term));
            weights = weights + weight;
        }
        let zero = Jet { value: DVec3::ZERO, first: [DVec3::ZERO; 2], second: [DVec3::ZERO; 3] };
        sum.unwrap_or(zero) * weights.recip()
    }
}

/// The surface that has both strips at a corner.
fn corner_surface([along, beside]: &[Ribbon; 2], u: Jet<f64>, v: Jet<f64>) -> Jet<DVec3> {
    let constant = |value: DVec3| Jet { value, first: [DVec3::ZERO; 2], second: [DVec3::ZERO; 3] };
    let (corner, by_u, by_v) = (along.curve.at(0.0), beside.across.at(0.0), along.across.at(0.0));
    let twists = [beside.across.derivative().at(0.0), along.across.derivative().at(0.0)];
    let common = constant(corner) + constant(by_u) * u + constant(by_v) * v + twist(twists, u, v);
    along.curve.of(u) + along.across.of(u) * v + beside.curve.of(v) + beside.across.of(v) * u - common
}

/// u v times a mean of two twists: the first counts where v is 0, the second where u is 0.
pub(super) fn twist([at_v0, at_u0]: [DVec3; 2], u: Jet<f64>, v: Jet<f64>) -> Jet<DVec3> {
    let constant = |value: DVec3| Jet { value, first: [DVec3::ZERO; 2], second: [DVec3::ZERO; 3] };
    let sum = u + v;
    let mean = if sum.value > 0.0 {
        constant(at_v0) * (u * sum.recip()) + constant(at_u0) * (v * sum.recip())
    } else {
        constant((at_v0 + at_u0) * 0.5)
    };
    mean * (u * v)
}

impl NSidedPatch {
    /// A point of the polygon, as it depends on itself.
    fn domain_point(&self, uv: DVec2) -> DVec2 {
        let count = self.patch.normals.len() as f64;
        let corner = |k: usize| DVec2::from_angle(k as f64 / count * TAU) / (0.5 * TAU / count).cos();
        (corner(self.sector) * (1.0 - uv.x) + corner(self.sector + 1) * uv.x) * (1.0 - uv.y)
    }

    /// The point and its derivatives by u and v, and before that by the coordinates of the polygon.
    fn jets(&self, uv: DVec2) -> [Jet<DVec3>; 2] {
        let [u, v] = [Jet::parameter(uv.x, 0), Jet::parameter(uv.y, 1)];
        let ends = [DVec2::ZERO, DVec2::X].map(|end| self.domain_point(end));
        let blend = |axis: usize| {
            let [from, to] = ends.map(|end| Jet::constant(end[axis]));
            (from + (to - from) * u) * (Jet::constant(1.0) - v)
        };
        let place = self.domain_point(uv);
        let by_uv = self.patch.at([blend(0), blend(1)]);
        [by_uv, self.patch.at([Jet::parameter(place.x, 0), Jet::parameter(place.y, 1)])]
    }
}

impl Surface for NSidedPatch {
    fn domain(&self) -> [DVec2; 2] {
        [DVec2::ZERO, DVec2::ONE]
    }

    /// On the side that of the curve, to the bit; between sectors the same from both.
    fn point(&self, uv: DVec2) -> DVec3 {
        let count = self.patch.normals.len();
        if uv.y == 0.0 {
            return casteljau(self.patch.curves[self.sector], uv.x);
        }
        if uv.y == 1.0 {
            return self.patch.middle;
        }
        // The last side of a sector is looked at as the first of the next.
        if uv.x == 1.0 {
            let next = NSidedPatch { patch: self.patch.clone(), sector: (self.sector + 1) % count };
            return next.jets(DVec2::new(0.0, uv.y))[0].value;
        }
        self.jets(uv)[0].value
    }

    fn derivatives(&self, uv: DVec2) -> [DVec3; 2] {
        self.jets(uv)[0].first
    }

    /// Of the function over the polygon, so that the middle has one.
    fn normal(&self, uv: DVec2) -> DVec3 {
        let [x, y] = self.jets(uv)[1].first;
        x.cross(y).normalize_or_zero()
    }

    fn nearest(&self, point: DVec3, guess: DVec2) -> DVec2 {
        nearest_from(self, point, guess)
    }
}

impl Curved for NSidedPatch {
    fn second_derivatives(&self, uv: DVec2) -> [DVec3; 3] {
        self.jets(uv)[0].second
    }
}
