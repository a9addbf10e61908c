//! The frame of a surface element, in which distributions have their directions.

use glam::{DMat3, DVec3};

/// The frame of a surface element: z is its normal, x and y lie along the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingFrame {
    axes: DMat3,
}

impl ShadingFrame {
    /// A frame about a normal, unit length; x is any direction along the surface.
    #[inline]
    pub fn from_normal(normal: DVec3) -> ShadingFrame {
        let (x, y) = normal.any_orthonormal_pair();
        ShadingFrame { axes: DMat3::from_cols(x, y, normal) }
    }

    /// A frame about a normal, unit length, whose x is as near as can be to a direction: that of brushing, say.
    ///
    /// - `along`: any length; parallel to the normal or 0, it is not heeded.
    pub fn brushed(normal: DVec3, along: DVec3) -> ShadingFrame {
        match (along - normal * along.dot(normal)).try_normalize() {
            Some(x) if x.dot(normal).abs() < 1e-6 => {
                ShadingFrame { axes: DMat3::from_cols(x, normal.cross(x), normal) }
            }
            _ => ShadingFrame::from_normal(normal),
        }
    }

    /// A direction of the world in the frame.
    #[inline]
    pub fn local(&self, direction: DVec3) -> DVec3 {
        DVec3::new(self.axes.x_axis.dot(direction), self.axes.y_axis.dot(direction), self.axes.z_axis.dot(direction))
    }

    /// A direction of the frame in the world.
    #[inline]
    pub fn world(&self, direction: DVec3) -> DVec3 {
        self.axes * direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_turns_there_and_back() {
        let normal = DVec3::new(1.0, -2.0, 0.5).normalize();
        for frame in [
            ShadingFrame::from_normal(normal),
            ShadingFrame::brushed(normal, DVec3::Y),
            ShadingFrame::brushed(normal, normal * 3.0),
        ] {
            assert!((frame.local(normal) - DVec3::Z).length() < 1e-15);
            let direction = DVec3::new(0.3, 0.4, -0.2);
            assert!((frame.world(frame.local(direction)) - direction).length() < 1e-15);
        }
        assert!(ShadingFrame::brushed(DVec3::Z, DVec3::new(0.0, 2.0, 5.0)).local(DVec3::Y).x > 0.999);
    }
}
