//! The inside test against closed forms and the winding of the whole surface.

use super::*;
use crate::octree::{Containment, TriangleBvh};

/// The octree and the triangle BVH of a shape, which must agree.
struct Both<'a> {
    shape: &'a Shape,
    octree: Octree,
    sorted: TriangleBvh,
}

impl Both<'_> {
    fn new(shape: &Shape) -> Both<'_> {
        Both { shape, octree: shape.octree(), sorted: TriangleBvh::new(&shape.vertices, &shape.triangles) }
    }

    fn side(&self, point: DVec3) -> Containment {
        let side = self.octree.containment(point);
        assert_eq!(self.sorted.containment(point, |triangle| self.shape.corners(triangle as usize)), side, "{point}");
        side
    }
}

/// Solid angle of the whole surface over 4 pi.
///
/// # Source
/// Van Oosterom and Strackee 1983.
fn winding(shape: &Shape, point: DVec3) -> f64 {
    let angle = |triangle| {
        let [a, b, c] = shape.corners(triangle).map(|p| p - point);
        let (x, y, z) = (a.length(), b.length(), c.length());
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    (0..shape.triangles.len()).map(angle).sum::<f64>() / (2.0 * TAU)
}

/// The surface of the cube from -1 to 1, each side turned outwards.
fn outward_block(n: u32) -> Shape {
    outward(block(n), |p| p)
}

/// Each triangle turned along a field.
fn outward(mut shape: Shape, field: impl Fn(DVec3) -> DVec3) -> Shape {
    for t in 0..shape.triangles.len() {
        let [a, b, c] = shape.corners(t);
        if (b - a).cross(c - a).dot(field((a + b + c) / 3.0)) < 0.0 {
            shape.triangles[t].swap(1, 2);
        }
    }
    shape
}

#[test]
fn points_of_a_grid_lie_inside_a_cube_on_it_or_outside() {
    // The grid runs through corners, edges and faces of cells, of triangles and of the cube.
    for (scale, offset) in [(1.0, 0.0), (1e-200, 0.0), (1e140, 0.0), (1.0, 1_048_576.0)] {
        let place = |p: DVec3| p * scale + DVec3::splat(offset);
        let shape = outward_block(4).moved(place);
        let both = Both::new(&shape);
        let mut counts = [0; 3];
        for i in 0..13_i32.pow(3) {
            let steps = [i % 13 - 6, i / 13 % 13 - 6, i / 169 - 6];
            let point = DVec3::from_array(steps.map(f64::from)) * 0.25;
            let expected = match steps.iter().map(|s| s.abs()).max() {
                Some(4) => Containment::Surface,
                Some(0..4) => Containment::Inside,
                _ => Containment::Outside,
            };
            assert_eq!(both.side(place(point)), expected, "{point} times {scale} and {offset}");
            counts[expected as usize] += 1;
        }
        assert_eq!(counts, [343, 13 * 13 * 13 - 729, 729 - 343]);
    }
}

#[test]
fn the_side_is_that_of_the_solid_angle() {
    let mut stream = RandomStream::new(81, 0);
    let golden = outward(ball(3), |p| p);
    let shell = golden.clone().joined(&outward(ball(2).moved(|p| p * 0.5), |p| -p));
    let twice = golden.clone().joined(&golden.clone().moved(|p| p + DVec3::X * 0.7));
    let ring = outward(torus(9), |p| p - DVec3::new(p.x, 0.0, p.z).normalize());
    for shape in [golden, shell, twice, ring] {
        let both = Both::new(&shape);
        let mut counts = [0; 2];
        for i in 0..1500 {
            let corner = shape.vertices[stream.below(shape.vertices.len())];
            // Half of the points are as high as a corner: the ray through them hits corners and edges.
            let random = sphere(stream.point()) * 1.6 * stream.uniform();
            let point = if i % 2 == 0 { corner.with_x(random.x) } else { random };
            let winding = winding(&shape, point);
            if (winding - winding.round()).abs() > 1e-6 {
                continue;
            }
            let expected = if winding.round() == 0.0 { Containment::Outside } else { Containment::Inside };
            let side = both.side(point);
            if side != Containment::Surface {
                assert_eq!(side, expected, "{point}: {winding}");
                counts[side as usize] += 1;
            }
        }
        assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
    }
}

#[test]
fn corners_and_middles_of_edges_lie_on_the_surface_and_a_last_digit_beside_it() {
    let shape = outward(ball(3), |p| p);
    let both = Both::new(&shape);
    for &corner in &shape.vertices {
        assert_eq!(both.side(corner), Containment::Surface);
        // The ball is convex and has its centre at the origin.
        let pressed =
            |toward: f64| DVec3::from_array(corner.to_array().map(|x| if x.abs() > 0.5 { x * toward } else { x }));
        assert_eq!(both.side(pressed(1.0 + f64::EPSILON * 2.0)), Containment::Outside);
        assert_eq!(both.side(pressed(1.0 - f64::EPSILON * 2.0)), Containment::Inside);
    }
    let block = outward_block(5);
    let both = Both::new(&block);
    for triangle in 0..block.triangles.len() {
        let [a, b, c] = block.corners(triangle);
        // Coordinates of one side are equal, so that the middle lies in its plane exactly.
        for point in [(a + b) * 0.5, (b + c) * 0.5, a * 0.25 + b * 0.25 + c * 0.5] {
            assert_eq!(both.side(point), Containment::Surface);
        }
    }
}

#[test]
fn without_a_surface_everything_is_outside() {
    let nothing = Octree::build(&[], &[], &OctreeSettings::default()).expect("nothing is fine");
    let both = ball(2);
    let octree = both.octree();
    for point in [DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::INFINITY, DVec3::splat(1e300)] {
        assert_eq!(nothing.containment(point), Containment::Outside);
        assert_eq!(TriangleBvh::default().containment(point, |_| [DVec3::ZERO; 3]), Containment::Outside);
        assert_eq!(octree.containment(point) == Containment::Outside, point != DVec3::ZERO);
    }
}
