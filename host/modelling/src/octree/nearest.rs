//! The point of a surface that is nearest to a point in space.

use glam::DVec3;
use rayon::prelude::*;

use super::TriangleBvh;
use crate::mesh::Mesh;
use crate::numeric::{bounds::Bounds, triangle};

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The triangle; of several as near, the one that was found first.
    pub triangle: u32,
    /// The point.
    pub point: DVec3,
    /// Distance to the point, model units.
    pub distance: f64,
}

impl TriangleBvh {
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
                let place = triangle::nearest(point, corners(triangle));
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

/// The Hausdorff distance of two surfaces, as far as some of their points tell: how far a point of either can be from
/// the other, in units of the positions. 0 if one of them has no triangles.
///
/// - `one`, `two`: all of their vertices count.
/// - `most`: of each at most so many points are measured, vertices and middles of triangles, evenly chosen.
pub fn hausdorff(one: &Mesh, two: &Mesh, most: usize) -> f64 {
    let from = |of: &Mesh, other: &Mesh| {
        let sorted = TriangleBvh::new(&other.vertices, &other.triangles);
        let vertices = of.vertices.len();
        let point = |index: usize| match index.checked_sub(vertices) {
            Some(triangle) => of.corners(triangle).into_iter().sum::<DVec3>() / 3.0,
            None => of.vertices[index],
        };
        let far = |index| Some(sorted.nearest(point(index), |triangle| other.corners(triangle as usize))?.distance);
        let count = vertices + of.triangles.len();
        let chosen: Vec<usize> = (0..count).step_by(count.div_ceil(most.max(1)).max(1)).collect();
        chosen.into_par_iter().filter_map(far).reduce(|| 0.0, f64::max)
    };
    from(one, two).max(from(two, one))
}

fn distance_to_box(point: DVec3, bounds: Bounds) -> f64 {
    point.clamp(bounds.min, bounds.max).distance(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::{RandomStream, sphere};

    #[test]
    fn the_nearest_point_is_what_a_search_of_all_finds() {
        let mut stream = RandomStream::new(91, 0);
        let vertices: Vec<DVec3> = (0..600).map(|_| sphere(stream.point()) * stream.uniform()).collect();
        let triangles: Vec<[u32; 3]> = (0..200).map(|i| [3 * i, 3 * i + 1, 3 * i + i % 3]).collect();
        let corners = |t: u32| triangles[t as usize].map(|v| vertices[v as usize]);
        let sorted = TriangleBvh::new(&vertices, &triangles);
        for _ in 0..300 {
            let point = sphere(stream.point()) * 3.0 * stream.uniform();
            let found = sorted.nearest(point, corners).expect("there are triangles");
            let all =
                (0..200).map(|t| triangle::nearest(point, corners(t)).distance(point)).fold(f64::INFINITY, f64::min);
            assert_eq!(found.distance, all);
            // No point of a lattice on the triangle is nearer.
            let [a, b, c] = corners(found.triangle);
            for k in 0..66 {
                let (u, v) = (f64::from(k % 11) / 10.0, f64::from(k / 11) / 10.0);
                let other = a + (b - a) * u + (c - a) * v * (1.0 - u);
                assert!(other.distance(point) >= found.distance - 1e-12);
            }
        }
        assert_eq!(TriangleBvh::default().nearest(DVec3::ZERO, |_| [DVec3::ZERO; 3]), None);
    }

    /// A square in the plane z = height, as two triangles.
    fn square(half: f64, height: f64) -> Mesh {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let vertices = corners.map(|[x, y]| DVec3::new(x * half, y * half, height)).to_vec();
        Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
    }

    #[test]
    fn the_hausdorff_distance_is_that_of_the_side_from_which_it_is_farther() {
        let [small, large] = [square(1.0, 0.0), square(2.0, 1.0)];
        // Every point of the small square is 1 from the large one, whose corners are farther from it.
        for (one, two) in [(&small, &large), (&large, &small)] {
            assert_eq!(hausdorff(one, two, 100), 3.0_f64.sqrt());
        }
        assert_eq!(hausdorff(&small, &small, 100), 0.0);
        assert_eq!(hausdorff(&small, &Mesh::default(), 100), 0.0);
    }
}
