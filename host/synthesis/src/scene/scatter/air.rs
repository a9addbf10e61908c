//! The wind over the cells of a ground: found at the points of a lattice, and interpolated between them.
//!
//! What is in cells is drawn anew for each ray, and the wind at each place would take most of the time. Points of the
//! lattice are remembered by each thread; what they remember is a function of the lattice and of the point alone, so that
//! nothing depends on how many threads there are.

use super::super::object::Sway;
use crate::numeric::debug_hash;
use crate::numeric::sampling::mix;
use glam::{DAffine3, DVec2, DVec3};
use std::cell::RefCell;

/// So many points are remembered at a time.
const REMEMBERED: usize = 1 << 13;
/// Steps of the lattice over the smallest eddies.
const FINENESS: f64 = 2.0;

thread_local! {
    static POINTS: RefCell<Vec<LatticePoint>> = const { RefCell::new(Vec::new()) };
}

/// A point of a lattice, and the velocity there.
#[derive(Clone, Copy, Default)]
struct LatticePoint {
    lattice: u64,
    number: [i64; 2],
    velocity: DVec3,
}

/// The wind at a time over a level ground, as a lattice of points on it.
#[derive(Clone, Debug)]
pub(super) struct AirLattice {
    sway: Sway,
    /// From coordinates of the ground to those of the instances.
    to_instances: DAffine3,
    /// From point to point.
    step: f64,
    /// Tells it from other lattices; not 0.
    key: u64,
}

impl AirLattice {
    pub(super) fn new(sway: &Sway, to_instances: DAffine3) -> AirLattice {
        let wind = &sway.wind;
        let smallest = wind.eddy_size * 0.5_f64.powi(wind.octaves as i32 - 1);
        // Without turbulence there are gusts alone.
        let step = if wind.turbulence > 0.0 { smallest.min(wind.gust_size) } else { wind.gust_size } / FINENESS;
        let key = debug_hash(&(sway, to_instances, step)) | 1;
        AirLattice { sway: sway.clone(), to_instances, step, key }
    }

    /// The velocity over a place of the ground, in coordinates of the instances.
    pub(super) fn velocity(&self, at: DVec3) -> DVec3 {
        let place = DVec2::new(at.x, at.z) / self.step;
        let first = place.floor();
        let part = place - first;
        let [x, z] = [first.x as i64, first.y as i64];
        let along = |x: i64| self.point([x, z]).lerp(self.point([x, z.saturating_add(1)]), part.y);
        along(x).lerp(along(x.saturating_add(1)), part.x)
    }

    fn point(&self, number: [i64; 2]) -> DVec3 {
        let slot = mix(self.key ^ mix(number[0] as u64 ^ (number[1] as u64).rotate_left(32))) as usize % REMEMBERED;
        POINTS.with_borrow_mut(|points| {
            if points.is_empty() {
                points.resize(REMEMBERED, LatticePoint::default());
            }
            let known = &mut points[slot];
            if (known.lattice, known.number) != (self.key, number) {
                let at = DVec3::new(number[0] as f64, 0.0, number[1] as f64) * self.step;
                let velocity = self.sway.wind.at(self.to_instances.transform_point3(at), self.sway.time);
                *known = LatticePoint { lattice: self.key, number, velocity };
            }
            known.velocity
        })
    }
}
