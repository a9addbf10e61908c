//! From where a scene is seen: a camera, or the matrix that a workstation reads back.

use super::SceneError;
use super::motion::Motion;
use crate::numeric::bounds::Bounds;
use glam::{DMat4, DQuat, DVec2, DVec3, DVec4};
use serde::{Deserialize, Serialize};

/// How steeply the automatic camera looks down.
const FRAMING_DIRECTION: DVec3 = DVec3::new(0.35, 0.45, 1.0);
/// Field of view of the automatic camera, degrees.
pub(super) const FRAMING_FIELD_OF_VIEW: f64 = 30.0;

/// The part of the shorter side of the picture that what is framed takes at most.
const FRAMED: f64 = 0.9;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// The eye.
    pub from: DVec3,
    /// What is in the middle of the picture.
    pub at: DVec3,
    /// What is up in the picture; not along the view.
    pub up: DVec3,
    /// Full angle across the *shorter* side of the picture, degrees, between 0 and 180. A square screen in the
    /// middle of the picture, such as that of a PS 340, shows just this angle.
    pub field_of_view: f64,
    /// Depth along the view before which nothing is seen, scene units, 0 and more.
    pub near: f64,
    /// Depth along the view behind which nothing is seen; without one, there is no end.
    pub far: Option<f64>,
    /// A lens in place of a pinhole, which is sharp at one depth only.
    pub lens: Option<Lens>,
    /// Parallel lines of sight, in place of those through the eye.
    pub parallel: Option<Parallel>,
    /// How it moves while the shutter is open, in the middle of which it is where it is: the time 0 of the motion.
    #[serde(default)]
    pub motion: Option<Motion>,
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lens {
    /// Its radius, scene units.
    pub radius: f64,
    /// Depth along the view at which points are sharp, scene units, above 0.
    pub focus: f64,
}

/// A parallel projection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parallel {
    /// What the *shorter* side of the picture shows, scene units, above 0.
    pub height: f64,
    /// Oblique lines of sight: by how much a point moves right and up in the picture for each unit that it is nearer to the
    /// viewer than `at`; 0 for an orthographic view.
    pub oblique: DVec2,
}

impl Camera {
    /// Checks that the camera can see.
    ///
    /// # Errors
    /// [`SceneError::Camera`].
    pub fn check(&self) -> Result<(), SceneError> {
        let failed = |problem: String| Err(SceneError::Camera(problem));
        if !(self.from.is_finite() && self.at.is_finite() && self.up.is_finite()) {
            return failed("from, at and up must be finite".into());
        }
        if (self.at - self.from).try_normalize().is_none() {
            return failed(format!("from and at are the same point {}", self.at));
        }
        if self.axes().is_none() {
            return failed(format!("up {} lies along the view", self.up));
        }
        if !(self.field_of_view > 0.0 && self.field_of_view < 180.0) {
            return failed(format!("field of view {} is not between 0 and 180 degrees", self.field_of_view));
        }
        if let Some(Lens { radius, focus }) = self.lens
            && !(radius >= 0.0 && radius.is_finite() && focus > 0.0 && focus.is_finite())
        {
            return failed(format!(
                "a lens of radius {radius} that is sharp at {focus}: it must be at 0 and more, above 0"
            ));
        }
        if let Some(Parallel { height, oblique }) = self.parallel {
            if !(height > 0.0 && height.is_finite() && oblique.is_finite()) {
                return failed(format!("a parallel view of height {height}, oblique by {oblique}"));
            }
            if self.lens.is_some() {
                return failed("a parallel view has no lens".into());
            }
        }
        if let Some(Err(problem)) = self.motion.map(|motion| motion.check()) {
            return failed(problem);
        }
        let far = self.far.unwrap_or(f64::INFINITY);
        if !(self.near >= 0.0 && self.near < far) {
            return failed(format!("near {} and far {far} do not enclose anything", self.near));
        }
        Ok(())
    }

    /// Unit vectors to the right, up and forward in the picture; none if the camera cannot see.
    pub fn axes(&self) -> Option<[DVec3; 3]> {
        let forward = (self.at - self.from).try_normalize()?;
        let right = forward.cross(self.up.try_normalize()?).try_normalize()?;
        Some([right, right.cross(forward), forward])
    }

    /// Where it is and how it is turned: from coordinates to its right, up and back, to those of the scene; none if the
    /// camera cannot see.
    pub fn placement(&self) -> Option<DMat4> {
        let [right, up, forward] = self.axes()?;
        Some(DMat4::from_cols(right.extend(0.0), up.extend(0.0), -forward.extend(0.0), self.from.extend(1.0)))
    }

    /// The camera, moving as others like it are placed when the shutter opens and when it closes; standing still if they
    /// differ in more than their places.
    ///
    /// - `duration`: from the one to the other, above 0.
    pub fn moving(self, [begin, end]: [Camera; 2], duration: f64) -> Camera {
        let like = |other: &Camera| Camera { from: self.from, at: self.at, up: self.up, ..*other } == self;
        let placements = [begin, self, end].map(|camera| camera.placement());
        let motion = match placements {
            [Some(first), Some(middle), Some(last)] if like(&begin) && like(&end) && first != last => {
                Motion::through(&[first, middle, last], duration)
            }
            _ => None,
        };
        Camera { motion, ..self }
    }

    /// The camera after it went round what it looks at.
    ///
    /// - `angle`: about its upward direction, radians, to the right as it sees itself go.
    pub fn turned(&self, angle: f64) -> Camera {
        let turn = DQuat::from_axis_angle(self.up.normalize_or(DVec3::Y), angle);
        let motion = self.motion.map(|motion| motion.turned(turn, self.at));
        Camera { from: self.at + turn * (self.from - self.at), motion, ..*self }
    }

    /// Tangent of half the field of view.
    pub fn half_tangent(&self) -> f64 {
        (self.field_of_view.to_radians() / 2.0).tan()
    }

    /// A camera that frames `bounds` from the front, a little from the right and from above: all of their corners lie within
    /// nine tenths of the shorter side of the picture.
    pub fn framing(bounds: &Bounds) -> Camera {
        let (at, back, up) = (bounds.center(), FRAMING_DIRECTION.normalize(), DVec3::Y);
        let right = up.cross(back).normalize();
        let half = (FRAMING_FIELD_OF_VIEW.to_radians() / 2.0).tan() * FRAMED;
        let distance = bounds.corners().map(|corner| {
            let corner = corner - at;
            let aside = right.dot(corner).abs().max(back.cross(right).dot(corner).abs());
            back.dot(corner) + aside / half
        });
        let distance = distance.into_iter().fold(f64::MIN_POSITIVE.sqrt(), f64::max);
        Camera {
            from: at + back * distance,
            at,
            up,
            field_of_view: FRAMING_FIELD_OF_VIEW,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        }
    }

    /// The view as a matrix: scene coordinates to clip coordinates, as LOOK and FIELD_OF_VIEW make it.
    ///
    /// Without a far depth, depths are scaled to the tenfold distance to `at`, and not clipped.
    pub fn projection(&self) -> Option<Projection> {
        let [right, up, forward] = self.axes()?;
        if let Some(parallel) = self.parallel {
            return Some(self.parallel_projection(parallel, [right, up, forward]));
        }
        let t = self.half_tangent();
        let back = self.far.unwrap_or(10.0 * (self.at - self.from).length().max(self.near));
        let row = |v: DVec3| v.extend(-v.dot(self.from));
        let depth = row(forward);
        let z = (depth - DVec4::new(0.0, 0.0, 0.0, self.near)) * (back / (back - self.near));
        let rows = [row(right) / t, row(up) / t, z, depth];
        let to_clip = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        Some(Projection { to_clip, depth_clipping: self.far.is_some() || self.near > 0.0 })
    }
}

impl Camera {
    fn parallel_projection(
        &self,
        Parallel { height, oblique }: Parallel,
        [right, up, forward]: [DVec3; 3],
    ) -> Projection {
        let half = height / 2.0;
        let distance = (self.at - self.from).length();
        let back = self.far.unwrap_or(10.0 * distance.max(self.near));
        let row = |v: DVec3, from: DVec3| v.extend(-v.dot(from));
        // A point nearer than `at` moves by the oblique factors.
        let x = row(right - forward * oblique.x, self.at) / half;
        let y = row(up - forward * oblique.y, self.at) / half;
        let z = (row(forward, self.from) - DVec4::new(0.0, 0.0, 0.0, self.near)) / (back - self.near);
        let to_clip = DMat4::from_cols(x, y, z, DVec4::W).transpose();
        Projection { to_clip, depth_clipping: self.far.is_some() || self.near > 0.0 }
    }
}

/// A general projective view: what a workstation's transformation makes of the scene.
///
/// Clip coordinates are those of a PS 340: -w..w across the square screen in x and y, depth 0 at the front boundary
/// and w at the back one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projection {
    /// Scene coordinates (right-handed) to clip coordinates, for column vectors: `clip = M p`.
    pub to_clip: DMat4,
    /// Whether what lies before the front or behind the back boundary is cut off.
    pub depth_clipping: bool,
}

impl Projection {
    /// The view behind a matrix that a PS 340 reports.
    ///
    /// - `matrix`: object to clip coordinates in the left-handed space of the machine, in the convention of
    ///   `protocol::value`: its row `i` is column `i` of the glam matrix, so that `p M` is `matrix * p`.
    /// - The scene was sent with z negated; this is undone here.
    pub fn from_workstation(matrix: &DMat4, depth_clipping: bool) -> Projection {
        let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
        Projection { to_clip: *matrix * mirror, depth_clipping }
    }
}

/// From where a scene is seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// Through a camera.
    Camera(Camera),
    /// Through a matrix.
    Projection(Projection),
}

impl View {
    /// Whether it is that of a camera that moves while the shutter is open.
    pub fn moves(&self) -> bool {
        matches!(self, View::Camera(Camera { motion: Some(_), .. }))
    }

    /// The view as a matrix; none for a camera that cannot see.
    pub fn projection(&self) -> Option<Projection> {
        match self {
            View::Camera(camera) => camera.projection(),
            View::Projection(projection) => Some(*projection),
        }
    }

    /// What a pixel in the middle of a picture spans, degrees; of a parallel view, as if its shorter side spanned 30.
    pub fn pixel_angle(&self, width: u32, height: u32) -> f64 {
        // A matrix of a perspective divides by the depth; what it divides is as much greater as the field is narrow.
        let half_tangent = self.projection().and_then(|projection| {
            let rows = projection.to_clip.transpose();
            let (across, depth) = (rows.x_axis.truncate().length(), rows.w_axis.truncate().length());
            (depth > 0.0).then_some(depth / across).filter(|tangent| tangent.is_finite())
        });
        let shorter = f64::from(width.min(height).max(1));
        match half_tangent {
            Some(tangent) => (2.0 * tangent / shorter).to_degrees(),
            None => View::parallel_pixel_angle(width, height),
        }
    }

    /// What a pixel spans, degrees, in a picture whose shorter side is seen at an angle of 30 degrees.
    pub fn parallel_pixel_angle(width: u32, height: u32) -> f64 {
        FRAMING_FIELD_OF_VIEW / f64::from(width.min(height).max(1))
    }

    /// What a picture shows in clip coordinates: x min, x max, y min, y max.
    ///
    /// The shorter side spans -1..1; the longer one shows as much more as keeps the pixels square.
    pub fn window(width: u32, height: u32) -> [f64; 4] {
        let shorter = f64::from(width.min(height));
        let (x, y) = (f64::from(width) / shorter, f64::from(height) / shorter);
        [-x, x, -y, y]
    }
}
