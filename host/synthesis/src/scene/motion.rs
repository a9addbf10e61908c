//! Rigid motion while the shutter is open.

use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use glam::{DMat3, DMat4, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// A map whose axes are so far from being at right angles, or of unit length, is no rigid motion.
const SKEW: f64 = 1e-9;
/// About an axis that stays, nothing turns by less, radians: the axis would be too far away to be known.
const LEAST_TURN: f64 = 1e-5;

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

    /// The motion of what is at three places, one after the other, in the middle of which is its time 0; none if no rigid
    /// motion brings it from the first to the last, or if it stands still.
    ///
    /// Two motions do: about an axis that stays, as of a door, and about the object's own origin, which moves straight on,
    /// as of a wheel. The one that comes nearer to the place in the middle is taken. It turns by less than half a turn.
    ///
    /// - `places`: own coordinates to those of the scene, affine.
    /// - `duration`: from the first to the last, above 0.
    pub fn through(places: &[DMat4; 3], duration: f64) -> Option<Motion> {
        let [first, middle, last] = places;
        let whole = *last * first.inverse();
        let turn = DMat3::from_mat4(whole);
        let skew = (turn * turn.transpose() - DMat3::IDENTITY).to_cols_array();
        let is_rigid = skew.iter().all(|part| part.abs() < SKEW) && turn.determinant() > 0.0;
        if !is_rigid || !whole.is_finite() || whole == DMat4::IDENTITY {
            return None;
        }
        let rotation = DQuat::from_mat3(&turn).normalize();
        let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
        // The arc cosine of w would not know small angles.
        let angle = 2.0 * rotation.xyz().length().atan2(rotation.w);
        let axis = rotation.xyz().try_normalize().unwrap_or(DVec3::Y);
        let origin = first.w_axis.truncate();
        let of_wheel =
            Motion { by: (last.w_axis.truncate() - origin) / duration, through: origin, axis, angle: angle / duration };
        let shift = whole.w_axis.truncate();
        let along = axis * shift.dot(axis);
        let across = shift - along;
        let of_door = (angle > LEAST_TURN).then(|| Motion {
            by: along / duration,
            through: 0.5 * (across + axis.cross(across) / (0.5 * angle).tan()),
            ..of_wheel
        });
        let error = |motion: &Motion| {
            let there = motion.at(0.5 * duration).matrix() * *first;
            (there.w_axis - middle.w_axis).length()
        };
        let nearest = of_door.filter(|door| error(door) < error(&of_wheel)).unwrap_or(of_wheel);
        Some(nearest.since(0.5 * duration))
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
    fn what_is_at_three_places_moves_through_them() {
        let shape = DMat4::from_scale_rotation_translation(
            DVec3::new(1.0, 2.0, -0.5),
            DQuat::from_rotation_x(0.7),
            DVec3::new(3.0, 1.0, 2.0),
        );
        let door = Motion { by: DVec3::Y * 0.2, through: DVec3::new(-4.0, 0.0, 1.0), axis: DVec3::Y, angle: 1.3 };
        let wheel = Motion { through: shape.w_axis.truncate(), ..rolling() };
        let lift = Motion { angle: 0.0, ..rolling() };
        for (motion, tolerance) in [(door, 1e-13), (wheel, 1e-13), (lift, 1e-14)] {
            for duration in [1e-3, 0.4] {
                let at = |time: f64| motion.at(time).matrix() * shape;
                let places = [at(1.0), at(1.0 + 0.5 * duration), at(1.0 + duration)];
                let found = Motion::through(&places, duration).expect("it moves");
                for (time, place) in [-0.5, -0.2, 0.0, 0.5].map(|t| (t * duration, at(1.0 + (t + 0.5) * duration))) {
                    let off = found.at(time).matrix() * places[1] - place;
                    let largest = off.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
                    assert!(largest < tolerance / duration.min(1e-1), "{motion:?} {duration} {time}: {largest:e}");
                }
            }
        }
        let still = [shape; 3];
        let grows = [shape, shape, shape * DMat4::from_scale(DVec3::splat(1.1))];
        let mirrored = [shape, shape, shape * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))];
        for places in [still, grows, mirrored] {
            assert_eq!(Motion::through(&places, 1.0), None);
        }
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
