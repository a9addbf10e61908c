//! Triangles: where a ray hits one, decided exactly on the sheared plane, and the weights of its corners.

use glam::DVec3;
use wide::f64x4;

use super::predicates::cross_sign;
use super::ray::Ray;

/// Largest magnitude of an origin or a direction component that is looked at; beyond it a ray misses.
pub const MAX_MAGNITUDE: f64 = 1e150;

/// Slopes below this count as zero, so that no product of slopes and lengths falls below the normal numbers.
const LEAST_SLOPE: f64 = 1e-100;

/// For each axis, the two that follow in cyclic order.
static OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// A ray prepared for many triangles: its longest axis, and the shear that makes it that axis.
///
/// A vertex p becomes q = (p - origin) scaled, with q_x - (d_x/d_z) q_z and q_y - (d_y/d_z) q_z, where z is the
/// longest axis of the direction. One function of the vertex alone: two triangles that share an edge see the same
/// two points, and since the sign of their cross product is exact, the ray is on one side of the edge, on the other,
/// or on it, for both. On the edge counts as inside, so nothing passes between them.
///
/// # Source
/// Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", with exact signs in place of the fall-back.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    origin: [f64; 3],
    scale: f64,
    unscale: f64,
    axes: [usize; 3],
    slopes: f64x4,
    longest: f64,
    shear_x: f64,
    shear_y: f64,
    length_z: f64,
}

/// The hit of a sheared ray on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleIntersection {
    /// Parameter along the ray.
    pub t: f64,
    /// Barycentric weight of the second corner, 0..=1.
    pub u: f64,
    /// Barycentric weight of the third corner, 0..=1.
    pub v: f64,
}

impl Shear {
    /// Prepares a ray.
    ///
    /// - `scale`: a power of two by which lengths are multiplied, so that neither small nor large scenes leave the
    ///   range of the numbers; it changes no digit of the result. About one over the size of the scene.
    /// - Returns `None` for a direction that is zero or not finite, and for components beyond [`MAX_MAGNITUDE`].
    #[inline(always)]
    pub fn new(ray: &Ray, scale: f64) -> Option<Self> {
        let (origin, direction) = (four(ray.origin), four(ray.direction));
        let lengths = direction.abs();
        // Comparisons also refuse what is not a number.
        let sane = lengths.simd_le(f64x4::splat(f64::MAX)) & origin.abs().simd_le(f64x4::splat(MAX_MAGNITUDE));
        // Without branches, since no processor can foresee them.
        let magnitude = lengths.to_array();
        // Not looked up by the axis, which is known later.
        let xy_longest = if magnitude[1] > magnitude[0] { magnitude[1] } else { magnitude[0] };
        let longest = if magnitude[2] > xy_longest { magnitude[2] } else { xy_longest };
        let xy = usize::from(magnitude[1] > magnitude[0]);
        let z = if (magnitude[2] > magnitude[0]) & (magnitude[2] > magnitude[1]) { 2 } else { xy };
        if !sane.all() || longest == 0.0 {
            return None;
        }
        let [x, y] = OTHERS[z];
        let slopes = direction / f64x4::splat(longest);
        let slopes = slopes.abs().simd_lt(f64x4::splat(LEAST_SLOPE)).select(f64x4::ZERO, slopes);
        let by_axis = slopes.to_array();
        let length_z = direction.as_array()[z];
        let sign_z = 1.0_f64.copysign(length_z);
        Some(Self {
            origin: ray.origin.to_array(),
            scale,
            unscale: scale.recip(),
            axes: [x, y, z],
            slopes,
            longest,
            shear_x: by_axis[x] * sign_z,
            shear_y: by_axis[y] * sign_z,
            length_z,
        })
    }

    /// The axis of the longest component of the direction, 0..3, and before it the other two in cyclic order.
    pub fn axes(&self) -> [usize; 3] {
        self.axes
    }

    /// The direction in lengths of its longest component, by axis, each -1..=1; then zero.
    pub fn slopes(&self) -> f64x4 {
        self.slopes
    }

    /// Length of the longest component of the direction.
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// The longest component of the direction.
    pub fn length_z(&self) -> f64 {
        self.length_z
    }

    #[inline(always)]
    fn place(&self, p: DVec3) -> [f64; 3] {
        let p = p.to_array();
        let [x, y, z] = self.axes;
        let qz = (p[z] - self.origin[z]) * self.scale;
        [
            (p[x] - self.origin[x]) * self.scale - self.shear_x * qz,
            (p[y] - self.origin[y]) * self.scale - self.shear_y * qz,
            qz,
        ]
    }

    /// Intersects the line of the ray with a triangle, from either side and for any sign of `t`.
    ///
    /// Corners and edges belong to the triangle. A triangle that the ray sees exactly edge-on, and one without area, is
    /// not hit: in a closed surface its neighbours are.
    #[inline(always)]
    pub fn intersection(&self, [a, b, c]: [DVec3; 3]) -> Option<TriangleIntersection> {
        let (a, b, c) = (self.place(a), self.place(b), self.place(c));
        let first = cross_sign([c[0], c[1]], [b[0], b[1]]);
        let second = cross_sign([a[0], a[1]], [c[0], c[1]]);
        if (first < 0.0 && second > 0.0) || (first > 0.0 && second < 0.0) {
            return None;
        }
        let third = cross_sign([b[0], b[1]], [a[0], a[1]]);
        let any_negative = first < 0.0 || second < 0.0 || third < 0.0;
        let any_positive = first > 0.0 || second > 0.0 || third > 0.0;
        if any_negative == any_positive {
            return None;
        }
        let whole = first + second + third;
        // Adding zero turns -0 into 0.
        let (u, v) = (second / whole + 0.0, third / whole + 0.0);
        let z = (first * a[2] + second * b[2] + third * c[2]) / whole;
        Some(TriangleIntersection { t: z * self.unscale / self.length_z, u, v })
    }
}

/// The three numbers of a vector, and zero.
#[inline(always)]
pub fn four(vector: DVec3) -> f64x4 {
    let [x, y, z] = vector.to_array();
    f64x4::new([x, y, z, 0.0])
}

/// Weights of the corners of a triangle that give a point of it, each 0..=1 and their sum 1. For a point off its plane
/// they are those of the nearest point of the plane, held within the triangle.
pub fn weights([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part =
        |p: DVec3, q: DVec3| ((p - point).cross(q - point).dot(normal) / normal.length_squared()).clamp(0.0, 1.0);
    let (u, v) = (part(c, a), part(a, b));
    let v = v.min(1.0 - u);
    [1.0 - u - v, u, v]
}

/// The point of a triangle, or of a segment where it has no area, that is nearest to a point.
///
/// # Source
/// Ericson 2005, section 5.1.5: by the regions of the plane in which the nearest point is a corner, on a side, or
/// inside.
pub fn nearest(point: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal);
    let area = normal.length_squared();
    if area > 0.0 && weight(a, b) >= 0.0 && weight(b, c) >= 0.0 && weight(c, a) >= 0.0 {
        return point - normal * ((point - a).dot(normal) / area);
    }
    let on_side = |from: DVec3, to: DVec3| {
        let way = to - from;
        let length = way.length_squared();
        let part = if length > 0.0 { ((point - from).dot(way) / length).clamp(0.0, 1.0) } else { 0.0 };
        from + way * part
    };
    let nearer = |p: DVec3, q: DVec3| if q.distance_squared(point) < p.distance_squared(point) { q } else { p };
    nearer(nearer(on_side(a, b), on_side(b, c)), on_side(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::{RandomStream, sphere, triangle};

    #[test]
    fn a_hit_lies_where_its_weights_say() {
        let mut stream = RandomStream::new(5, 0);
        for _ in 0..2000 {
            let corners = [0; 3].map(|_: i32| sphere(stream.point()));
            let [u, v] = triangle(stream.point());
            let target = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
            let origin = sphere(stream.point()) * 3.0;
            let ray = Ray { origin, direction: (target - origin) * 0.25 };
            let edge = u.min(v).min(1.0 - u - v);
            match Shear::new(&ray, 1.0).and_then(|shear| shear.intersection(corners)) {
                Some(crossing) => {
                    let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
                    let tilt = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(ray.direction).abs() / area;
                    let close = |a: f64, b: f64| (a - b).abs() < 1e-12 / (area * tilt);
                    assert!(close(crossing.t, 4.0) && close(crossing.u, u) && close(crossing.v, v), "{crossing:?}");
                }
                None => assert!(edge < 1e-9, "lost a hit at {u} {v}"),
            }
        }
    }

    #[test]
    fn an_edge_belongs_to_both_triangles() {
        let [a, b, c, d] = [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::X, DVec3::Z * 4.0];
        let ray = Ray { origin: DVec3::new(0.5, 1.0, 9.5), direction: DVec3::NEG_Z };
        let shear = Shear::new(&ray, 1.0).expect("a sound ray");
        let one = shear.intersection([a, b, c]).expect("on the edge");
        assert_eq!((one.t, one.u, one.v), (8.0, 0.5, 0.0));
        assert_eq!(shear.intersection([c, a, b]).map(|hit| hit.t), Some(8.0));
        assert_eq!(shear.intersection([d, a, a]), None);
    }

    #[test]
    fn a_triangle_seen_edge_on_is_not_hit() {
        let ray = Ray { origin: DVec3::new(-1.0, 0.25, 0.0), direction: DVec3::X };
        let shear = Shear::new(&ray, 1.0).expect("a sound ray");
        assert_eq!(shear.intersection([DVec3::ZERO, DVec3::X, DVec3::Y]), None);
    }
}
