//! How a scene is seen on the workstation before dials turn it: its camera, and the point that it is turned about.

use super::WorkstationError;
use crate::scene::{Camera, Prepared, Settings};
use glam::{DMat3, DVec3};

/// The view that dials begin from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialView {
    /// The camera.
    pub camera: Camera,
    /// The point that dials turn and scale the scene about: what the camera looks at.
    pub center: DVec3,
    /// The longer side of the picture over the shorter one.
    ///
    /// The square screen of the workstation shows the whole picture: its sides are the longer side, and a wide picture
    /// takes a band across its middle. The field of view of a camera is that of the shorter side.
    pub elongation: f64,
}

impl InitialView {
    /// The view of a scene by its camera, or by one that frames it.
    ///
    /// # Errors
    /// [`WorkstationError::Scene`] for a camera that cannot see.
    pub fn of(prepared: &Prepared) -> Result<InitialView, WorkstationError> {
        let camera = prepared.camera;
        camera.check().map_err(|e| WorkstationError::Scene(e.to_string()))?;
        Ok(InitialView { camera, center: camera.at, elongation: elongation(&prepared.settings) })
    }

    /// The axes that dials turn the scene about, as columns: that of dial 1 points to the right in the picture, that of dial
    /// 2 along the camera's upward direction, so that a scene that stands upright goes round as on a turntable; that of dial
    /// 3 is square to both, towards the viewer.
    pub fn axes(&self) -> DMat3 {
        let [right, ..] = self.picture_axes();
        let upward = self.camera.up.normalize_or(DVec3::Y);
        DMat3::from_cols(right, upward, right.cross(upward))
    }

    /// Unit vectors to the right, up and forward in the picture.
    pub fn picture_axes(&self) -> [DVec3; 3] {
        self.camera.axes().unwrap_or([DVec3::X, DVec3::Y, DVec3::NEG_Z])
    }

    /// How far a turn of dials 5 to 7 moves the scene: by the side of the screen, as it is at the depth of the centre. Scene
    /// units, above 0.
    pub fn movement(&self) -> f64 {
        let half = match self.camera.parallel {
            Some(parallel) => parallel.height / 2.0,
            // Of a view that was kept, the eye may have the centre behind it.
            None => self.depth(self.center).abs() * self.camera.half_tangent(),
        };
        (2.0 * half * self.elongation).max(f64::MIN_POSITIVE)
    }

    /// Depth of a point along the view, scene units; below 0 behind the eye.
    pub fn depth(&self, point: DVec3) -> f64 {
        let [.., forward] = self.picture_axes();
        (point - self.camera.from).dot(forward)
    }
}

/// The longer side of a scene's picture over the shorter one.
fn elongation(settings: &Settings) -> f64 {
    let (width, height) = (f64::from(settings.image.width), f64::from(settings.image.height));
    width.max(height) / width.min(height)
}
