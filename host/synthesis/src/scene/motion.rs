//! Rigid motion while the shutter is open.

use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use glam::{DMat4, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// How something turns and moves on evenly: after the time t it is turned by t `angle`, and moved by t `by`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// How far it moves in a unit of time, scene units.
    pub by: DVec3,
    /// A point of the axis about which it turns, and that moves with it, at the time 0.
    pub through: DVec3,
    /// The direction of the axis, unit length.
    pub axis: DVec3,
    /// How far it turns in a unit of time, radians; any number of turns.
    pub angle: f64,
}

/// Where something is at a time of its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    turn: DQuat,
    through: DVec3,
    by: DVec3,
}

impl Motion {
    /// The problem in words, if it is none.
    pub(super) fn check(&self) -> Result<(), String> {
        if !(self.by.is_finite() && self.through.is_finite() && self.angle.is_finite()) {
            return Err("its motion is not finite".into());
        }
        if (self.axis.length() - 1.0).abs() > 1e-9 {
            return Err(format!("the axis {} about which it turns has not the length 1", self.axis));
        }
        Ok(())
    }

    /// Where it is after a time.
    pub fn at(&self, time: f64) -> Displacement {
        let turn = DQuat::from_axis_angle(self.axis, self.angle * time);
        Displacement { turn, through: self.through, by: self.by * time }
    }

    /// The motion of what stands where this one has brought it after a time.
    pub fn since(&self, time: f64) -> Motion {
        Motion { through: self.through + self.by * time, ..*self }
    }

    /// A box around all places of what is in a box, from the one time to the other.
    pub(super) fn swept(&self, bounds: &Bounds, [from, to]: [f64; 2]) -> Bounds {
        if bounds.is_empty() {
            return *bounds;
        }
        let around = if self.angle == 0.0 {
            *bounds
        } else {
            // Wherever it turns, it stays as far from the point of the axis as its farthest corner.
            let farthest = bounds.corners().map(|corner| corner.distance(self.through)).into_iter().fold(0.0, f64::max);
            let reach = DVec3::splat(farthest);
            Bounds { min: self.through - reach, max: self.through + reach }
        };
        let moved = |time: f64| Bounds { min: around.min + self.by * time, max: around.max + self.by * time };
        moved(from).union(moved(to))
    }
}

impl Displacement {
    /// Where a point comes to.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.through + self.turn * (point - self.through) + self.by
    }

    /// How a direction is turned.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.turn * vector
    }

    /// A ray as what moves would see it if it stood still; its lengths stay.
    pub fn still(&self, ray: &Ray) -> Ray {
        let back = self.turn.conjugate();
        let origin = self.through + back * (ray.origin - self.by - self.through);
        Ray { origin, direction: back * ray.direction }
    }

    /// The largest coordinate that it computes with, for what rounding does to a point.
    pub fn largest(&self) -> f64 {
        self.through.abs().max_element() + self.by.abs().max_element()
    }

    /// The displacement as a matrix.
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_rotation_translation(self.turn, self.by + self.through - self.turn * self.through)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn rolling() -> Motion {
        Motion { by: DVec3::X * 3.0, through: DVec3::new(1.0, 2.0, 0.5), axis: DVec3::NEG_Z, angle: 0.75 * TAU }
    }

    #[test]
    fn a_point_of_the_axis_moves_straight_and_others_about_it() {
        let motion = rolling();
        for k in 0..=20 {
            let time = f64::from(k) / 10.0 - 1.0;
            let moved = motion.at(time);
            assert!((moved.point(motion.through) - motion.through - DVec3::X * 3.0 * time).length() < 1e-14);
            let angle = -0.75 * TAU * time;
            let rim = moved.point(motion.through + DVec3::X) - moved.point(motion.through);
            assert!((rim - DVec3::new(angle.cos(), angle.sin(), 0.0)).length() < 1e-14);
            assert!((moved.matrix().transform_point3(DVec3::ONE) - moved.point(DVec3::ONE)).length() < 1e-14);
        }
    }

    #[test]
    fn a_ray_in_the_frame_of_what_moves_meets_the_same_points() {
        let moved = rolling().at(0.37);
        let ray = Ray { origin: DVec3::new(0.3, -1.0, 5.0), direction: DVec3::new(0.2, 0.4, -2.0) };
        let still = moved.still(&ray);
        for t in [0.0, 1.0, 2.5] {
            assert!((moved.point(still.at(t)) - ray.at(t)).length() < 1e-14);
        }
    }

    #[test]
    fn a_motion_may_begin_at_any_of_its_places() {
        let motion = rolling();
        let middle = motion.at(0.4);
        let point = DVec3::new(2.0, 1.0, -1.0);
        let later = motion.since(0.4).at(0.25).point(middle.point(point));
        assert!((later - motion.at(0.65).point(point)).length() < 1e-14);
    }

    #[test]
    fn a_swept_box_holds_the_box_at_all_times() {
        let bounds = Bounds { min: DVec3::new(0.5, 1.0, 0.0), max: DVec3::new(2.0, 3.5, 1.0) };
        let swept = rolling().swept(&bounds, [-0.5, 0.5]);
        for k in 0..=40 {
            let moved = rolling().at(f64::from(k) / 40.0 - 0.5);
            for corner in bounds.corners().map(|corner| moved.point(corner)) {
                assert!(corner.cmpge(swept.min - 1e-12).all() && corner.cmple(swept.max + 1e-12).all());
            }
        }
    }
}
