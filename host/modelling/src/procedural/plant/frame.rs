//! A place on a stem, with the directions there.

use glam::{DMat3, DVec3};

/// A place with directions: x to the right, y ahead along the stem, z up from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct StemFrame {
    pub at: DVec3,
    pub axes: DMat3,
}

impl StemFrame {
    /// The direction of the stem.
    pub fn ahead(&self) -> DVec3 {
        self.axes.y_axis
    }

    /// Bent about x: what lies ahead moves towards z.
    ///
    /// - `angle`: degrees.
    pub fn pitched(self, angle: f64) -> StemFrame {
        StemFrame { axes: self.axes * DMat3::from_rotation_x(angle.to_radians()), ..self }
    }

    /// Turned about the direction of the stem.
    ///
    /// - `angle`: degrees.
    pub fn rolled(self, angle: f64) -> StemFrame {
        StemFrame { axes: self.axes * DMat3::from_rotation_y(angle.to_radians()), ..self }
    }

    /// Turned about an axis of the scene.
    ///
    /// - `axis`: of length 1.
    /// - `angle`: degrees.
    pub fn turned(self, axis: DVec3, angle: f64) -> StemFrame {
        StemFrame { axes: DMat3::from_axis_angle(axis, angle.to_radians()) * self.axes, ..self }
    }

    /// With another direction ahead, turned as little as possible.
    pub fn heading(self, ahead: DVec3) -> StemFrame {
        let turn = glam::DQuat::from_rotation_arc(self.ahead(), ahead);
        let axes = DMat3::from_quat(turn) * self.axes;
        StemFrame { axes, ..self }
    }

    /// The angle between the direction of the stem and up, degrees.
    pub fn declination(&self) -> f64 {
        self.ahead().y.clamp(-1.0, 1.0).acos().to_degrees()
    }
}
