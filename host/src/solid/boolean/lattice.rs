//! The numbers that an operation can be exact with, and the way there and back for those that it cannot.
//!
//! Predicates multiply three differences of coordinates. Where such products fall below the least number, nothing is exact
//! any more: neighbours disagree, and what depends on them breaks. So the coordinates of all operands together are on a
//! lattice: multiples of 2^-256 of the power of two above the largest of them, which is between 2^-100 and 2^100.
//!
//! - Models that are larger or smaller are multiplied by a power of two first, and divided by it again.
//! - Coordinates of at least 2^-203, or 8e-62, of the largest are on the lattice as they are. Those below it are rounded to
//!   it, and a solid of which corners were rounded is made simple again: it stays closed and oriented, and what is thinner
//!   than the lattice is gone.

use super::operand::Operand;
use super::result::{Outcome, Tables};
use super::simple::{Resolution, resolve};
use super::{Expression, evaluate_on_lattice, mates};
use crate::mesh::Mesh;
use crate::octree::Sorted;
use glam::DVec3;
use rayon::prelude::*;

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
    pub fn place(&self, point: DVec3) -> DVec3 {
        point.to_array().map(|x| times(x, -self.power)).into()
    }

    /// The volume that one on the lattice stands for.
    pub fn volume(&self, volume: f64) -> f64 {
        (0..3).fold(volume, |volume, _| times(volume, -self.power))
    }

    /// Brings a mesh back to where it belongs.
    pub fn bring_back(&self, mesh: &mut Mesh) {
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = self.place(*vertex));
    }

    /// The surface of a solid on the lattice, with the triangles of the solid that its triangles are part of.
    fn laid(&self, mesh: &Mesh) -> (Mesh, Vec<u32>) {
        let mut laid = Outcome { mesh: mesh.clone(), ..Outcome::default() };
        laid.sources = (0..mesh.triangles.len() as u32).map(|triangle| [0, triangle]).collect();
        if self.lay(&mut laid.mesh) {
            laid.clean();
            let Resolution { mut outcome, is_same, .. } = resolve(&laid.mesh);
            if !is_same {
                outcome.sources.iter_mut().for_each(|source| *source = laid.sources[source[1] as usize]);
                laid = outcome;
            }
        }
        (laid.mesh, laid.sources.into_iter().map(|[_, triangle]| triangle).collect())
    }

    /// Evaluates an expression over solids that are put on the lattice.
    pub fn evaluate(&self, solids: &[Operand<'_>], expression: &Expression) -> Outcome {
        let laid: Vec<(Mesh, Vec<u32>)> = solids.par_iter().map(|solid| self.laid(solid.mesh)).collect();
        let filed = laid.par_iter().map(|(mesh, _)| (Sorted::new(&mesh.vertices, &mesh.triangles), mates(mesh)));
        let filed: Vec<(Sorted, Vec<u32>)> = filed.collect();
        let operands = laid.iter().zip(&filed).map(|((mesh, _), (sorted, mates))| Operand { mesh, sorted, mates });
        let mut outcome = evaluate_on_lattice(operands.collect(), expression);
        let source = |[operand, triangle]: [u32; 2]| [operand, laid[operand as usize].1[triangle as usize]];
        outcome.sources.iter_mut().for_each(|of| *of = source(*of));
        let meshes: Vec<&Mesh> = solids.iter().map(|solid| solid.mesh).collect();
        Tables::of(&meshes).name_surfaces(&mut outcome, &meshes);
        self.bring_back(&mut outcome.mesh);
        outcome
    }
}
