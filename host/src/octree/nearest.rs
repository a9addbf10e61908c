//! The point of a surface that is nearest to a point in space.

use glam::DVec3;

use super::Sorted;
use crate::numeric::bounds::Bounds;

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The triangle; of several as near, the one that was found first.
    pub triangle: u32,
    /// The point.
    pub point: DVec3,
    /// Its distance, model units.
    pub distance: f64,
}

impl Sorted {
    /// The point of the triangles that is nearest to a point; `None` without triangles.
    ///
    /// - `corners`: the corners of a triangle.
    ///
    /// Cost: about a logarithm of the number of triangles for points near the surface.
    pub fn nearest(&self, point: DVec3, corners: impl Fn(u32) -> [DVec3; 3]) -> Option<Nearest> {
        let mut best: Option<Nearest> = None;
        self.search(
            |bounds: Bounds| distance_to_box(point, bounds),
            |triangle| {
                let place = nearest_in(point, corners(triangle));
                let distance = place.distance(point);
                if best.is_none_or(|best| distance < best.distance) {
                    best = Some(Nearest { triangle, point: place, distance });
                }
                best.map_or(f64::INFINITY, |best| best.distance)
            },
        );
        best
    }
}

fn distance_to_box(point: DVec3, bounds: Bounds) -> f64 {
    point.clamp(bounds.min, bounds.max).distance(point)
}

/// The point of a triangle, or of a segment where it has no area, that is nearest to a point.
///
/// # Source
/// Ericson 2005, section 5.1.5: by the regions of the plane in which the nearest point is a corner, on a side, or inside.
fn nearest_in(point: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
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
    use crate::numeric::sampling::{Stream, sphere};

    #[test]
    fn the_nearest_point_is_what_a_search_of_all_finds() {
        let mut stream = Stream::new(91, 0);
        let vertices: Vec<DVec3> = (0..600).map(|_| sphere(stream.point()) * stream.uniform()).collect();
        let triangles: Vec<[u32; 3]> = (0..200).map(|i| [3 * i, 3 * i + 1, 3 * i + i % 3]).collect();
        let corners = |t: u32| triangles[t as usize].map(|v| vertices[v as usize]);
        let sorted = Sorted::new(&vertices, &triangles);
        for _ in 0..300 {
            let point = sphere(stream.point()) * 3.0 * stream.uniform();
            let found = sorted.nearest(point, corners).expect("there are triangles");
            let all = (0..200).map(|t| nearest_in(point, corners(t)).distance(point)).fold(f64::INFINITY, f64::min);
            assert_eq!(found.distance, all);
            // No point of a lattice on the triangle is nearer.
            let [a, b, c] = corners(found.triangle);
            for k in 0..66 {
                let (u, v) = (f64::from(k % 11) / 10.0, f64::from(k / 11) / 10.0);
                let other = a + (b - a) * u + (c - a) * v * (1.0 - u);
                assert!(other.distance(point) >= found.distance - 1e-12);
            }
        }
        assert_eq!(Sorted::default().nearest(DVec3::ZERO, |_| [DVec3::ZERO; 3]), None);
    }
}
