//! The numbers that an operation can be exact with, and the way there and back for those that it cannot.
//!
//! Predicates multiply three differences of coordinates. Where such products fall below the least number, nothing is
//! exact any more: neighbours disagree, and what depends on them breaks. So the coordinates of all operands together
//! are on a lattice: multiples of 2^-256 of the power of two above the largest of them, which is between 2^-100 and
//! 2^100.
//!
//! - Models that are larger or smaller are multiplied by a power of two first, and divided by it again.
//! - Coordinates of at least 2^-203, or 8e-62, of the largest are on the lattice as they are. Those below it are
//!   rounded to it, and a solid of which corners were rounded is freed of self-intersections: it stays closed and
//!   oriented, and what is thinner than the lattice is gone.

use crate::mesh::Mesh;
use crate::solid::SolidError;
use glam::DVec3;

/// Binary digits of the largest coordinate.
const DIGITS: i32 = 256;
/// Those of a number.
const MANTISSA: i32 = f64::MANTISSA_DIGITS as i32;
/// Powers of two that the largest coordinate may be below without being multiplied.
const RANGE: std::ops::RangeInclusive<i32> = -100..=100;

/// A lattice for meshes of which some coordinates are not on one as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Coordinates are multiplied by this power of two.
    power: i32,
    /// Then they are below this power of two.
    reach: i32,
}

/// The least power of two above a positive number.
fn power_above(x: f64) -> i32 {
    (x.to_bits() >> 52) as i32 - 1022
}

/// A number times a power of two, which may lie outside the range of numbers where the product does not.
fn times(x: f64, power: i32) -> f64 {
    let half = power / 2;
    x * f64::exp2(half.into()) * f64::exp2((power - half).into())
}

impl Lattice {
    /// A lattice for the finite coordinates of some meshes together; `None` if they are on one as they are.
    pub fn of<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Option<Lattice> {
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for vertex in meshes.flat_map(|mesh| &mesh.vertices) {
            for size in vertex.abs().to_array() {
                largest = largest.max(size);
                least = least.min(if size == 0.0 { f64::INFINITY } else { size });
            }
        }
        let reach = power_above(largest);
        let is_on = RANGE.contains(&reach) && power_above(least) >= reach - (DIGITS - MANTISSA);
        let is_in_range = RANGE.contains(&reach);
        let lattice =
            Lattice { power: if is_in_range { 0 } else { -reach }, reach: if is_in_range { reach } else { 0 } };
        (largest > 0.0 && !is_on).then_some(lattice)
    }

    /// Puts the corners of a mesh on the lattice; whether one of them was rounded.
    pub fn lay(&self, mesh: &mut Mesh) -> bool {
        let (step, fine) = (times(1.0, self.reach - DIGITS), times(1.0, self.reach - (DIGITS - MANTISSA)));
        let mut is_rounded = false;
        for coordinate in mesh.vertices.iter_mut().flat_map(AsMut::<[f64; 3]>::as_mut) {
            let at = times(*coordinate, self.power);
            let on = if at.abs() < fine { (at / step).round() * step } else { at };
            is_rounded |= on != at || (at == 0.0) != (*coordinate == 0.0);
            *coordinate = on;
        }
        is_rounded
    }

    /// The place that a point of the lattice stands for.
    pub fn position(&self, point: DVec3) -> DVec3 {
        point.to_array().map(|x| times(x, -self.power)).into()
    }

    /// The length that one on the lattice stands for.
    pub fn length(&self, length: f64) -> f64 {
        times(length, -self.power)
    }

    /// The volume that one on the lattice stands for.
    pub fn volume(&self, volume: f64) -> f64 {
        (0..3).fold(volume, |volume, _| times(volume, -self.power))
    }

    /// Brings a mesh back to where it belongs.
    pub fn bring_back(&self, mesh: &mut Mesh) {
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = self.position(*vertex));
    }
}

impl SolidError {
    /// An error of the mesh that was put on a lattice, in the coordinates that the mesh had before.
    pub(in crate::solid) fn brought_back(mut self, lattice: &Lattice) -> SolidError {
        match &mut self {
            SolidError::Mesh(_) | SolidError::TooManyIntersections { .. } | SolidError::BoundsNothing => {}
            SolidError::NotClosed { edges, .. } => {
                edges.iter_mut().flatten().for_each(|end| *end = lattice.position(*end));
            }
            SolidError::Open { loops } => {
                for open in loops {
                    open.near = lattice.position(open.near);
                    open.length = lattice.length(open.length);
                }
            }
            SolidError::InsideOut { volume, near, .. } => {
                *volume = lattice.volume(*volume);
                *near = lattice.position(*near);
            }
            SolidError::Crossing { near, .. } | SolidError::SelfIntersecting { near, .. } => {
                *near = lattice.position(*near)
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::{Expression, Primitive, Solid, SolidError};
    use crate::surface::{Tolerance, box_faces, tessellate};
    use glam::DVec2;

    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
        let mut mesh = tessellate(&box_faces(DVec3::ZERO, DVec3::ONE), Tolerance::new(1.0, 90.0)).unwrap();
        for vertex in &mut mesh.vertices {
            *vertex = DVec3::from([0, 1, 2].map(|axis| if vertex[axis] == 0.0 { low[axis] } else { high[axis] }));
        }
        mesh
    }

    fn block(low: [f64; 3], high: [f64; 3]) -> Solid {
        Solid::new(cuboid(low, high)).unwrap()
    }

    fn turned(contour: [[f64; 2]; 3]) -> Solid {
        let contours = vec![contour.map(DVec2::from).to_vec()];
        let body = Primitive::RevolvedPolygon { contours, turn: 1.0 }.body().unwrap();
        Solid::resolved(body.tessellate(Tolerance::new(0.02, 90.0)).unwrap()).unwrap().0
    }

    fn scaled(mesh: &Mesh, size: f64) -> Mesh {
        let mut mesh = mesh.clone();
        mesh.vertices.iter_mut().for_each(|vertex| *vertex *= size);
        mesh
    }

    #[test]
    fn usual_coordinates_are_on_the_lattice_as_they_are() {
        let of = |sizes: [f64; 3]| Lattice::of([cuboid([0.0; 3], sizes)].iter());
        for sizes in [[1.0; 3], [1e-12, 1e7, 1.0], [1e-6, 1e6, 6e-17], [1e-30; 3], [1e30, 1e-30, 1.0]] {
            assert_eq!(of(sizes), None, "{sizes:?}");
        }
        assert_eq!(Lattice::of([Mesh::default()].iter()), None);
        assert_eq!(of([1.0, 1.0, 1e-62]), Some(Lattice { power: 0, reach: 1 }));
        assert_eq!(of([1.0, 1e300, 1.0]).map(|lattice| lattice.reach), Some(0));
        assert_eq!([1.0, 1.5, 0.5, f64::MAX].map(power_above), [1, 1, 0, 1024]);
        assert_eq!(times(5e-324, 1074), 1.0);
    }

    #[test]
    fn corners_that_nearly_touch_an_axis_do_no_harm() {
        let one = turned([[1.0, 3.0], [0.5, 0.25], [0.25, 1.5]]);
        let on_axis = one.union(&turned([[3.0, 3.0], [1.0, 3.0], [0.0, 1.5]])).unwrap().mesh().signed_volume();
        for x in [1e-17, 1e-40, 1e-60, 1e-70, 1e-77, 1e-100, 1e-200, 1e-300, 5e-324] {
            let both = one.union(&turned([[3.0, 3.0], [1.0, 3.0], [x, 1.5]])).unwrap();
            assert!((both.mesh().signed_volume() / on_axis - 1.0).abs() < 1e-12, "{x}");
            assert!(Solid::new(both.into_mesh()).is_ok(), "{x}");
        }
    }

    #[test]
    fn sizes_of_all_kinds_may_be_mixed() {
        let one = block([0.0; 3], [1.0; 3]);
        for [x, y, z] in [[1e-300, -1e-200, 5e-324], [1e-100, 1e-70, -1e-62], [-1e-310, 1e-17, 0.0]] {
            let two = block([x, y, z], [2.0, 1.0 + y, 0.5]);
            let all = Expression::Union(vec![Expression::Operand(0), Expression::Operand(1)]);
            for (operation, volume) in
                [(all, 1.5), (Expression::difference(Expression::Operand(0), Expression::Operand(1)), 0.5)]
            {
                let (result, outcome) = Solid::evaluate(&[&one, &two], &operation).unwrap();
                assert!((result.mesh().signed_volume() - volume).abs() < 1e-12, "{x} {y} {z}");
                assert!(Solid::new(result.mesh().clone()).is_ok());
                assert_eq!(outcome.sources.len(), result.mesh().triangles.len());
            }
        }
    }

    #[test]
    fn what_is_thinner_than_the_lattice_is_gone() {
        let one = block([-1.0; 3], [1.0; 3]);
        let speck = block([0.0; 3], [1e-300; 3]);
        assert_eq!(one.difference(&speck).unwrap().mesh().signed_volume(), 8.0);
        assert_eq!(one.union(&speck).unwrap().mesh().triangles.len(), 12);
        assert!(one.intersection(&speck).unwrap().mesh().triangles.is_empty());
        let vast = block([-1e300; 3], [1e300; 3]);
        assert_eq!(vast.union(&one).unwrap().mesh().vertices.len(), 8);
        assert_eq!(Solid::new(cuboid([0.0; 3], [1.0, 1.0, 1e-300])), Err(SolidError::BoundsNothing));
    }

    #[test]
    fn models_of_any_size_are_alike() {
        let meshes = [cuboid([0.0; 3], [1.0; 3]), cuboid([0.3, 0.2, 0.1], [1.7, 0.9, 1.3])];
        let difference = |size: f64| {
            let [one, two] = meshes.each_ref().map(|mesh| Solid::new(scaled(mesh, size)).unwrap());
            one.difference(&two).unwrap().into_mesh()
        };
        let usual = difference(1.0);
        for power in [-900, -400, -101, 99, 300, 1000] {
            let size = f64::exp2(power.into());
            assert_eq!(difference(size), scaled(&usual, size), "{power}");
        }
    }

    #[test]
    fn errors_name_places_of_the_model_and_not_of_the_lattice() {
        let size = f64::exp2(-500.0);
        let Mesh { vertices, mut triangles, .. } = scaled(&cuboid([0.0; 3], [1.0; 3]), size);
        triangles.pop();
        let open = Mesh { vertices, triangles, ..Mesh::default() };
        let Err(SolidError::NotClosed { edges, .. }) = Solid::new(open) else { panic!("it is open") };
        assert!(edges.as_flattened().iter().all(|end| end.max_element() <= size) && edges.len() == 3);
    }
}
