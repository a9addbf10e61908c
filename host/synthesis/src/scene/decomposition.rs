//! The camera behind a matrix: from where somebody looks who has turned a scene with dials.

use super::view::{Camera, FRAMING_FIELD_OF_VIEW, Parallel, Projection};
use glam::{DMat3, DVec2, DVec3, DVec4};

/// A matrix whose axes are so far from being at right angles, or of equal scale, is no camera's.
const SKEW: f64 = 1e-3;
/// A matrix whose lines of sight turn by less than this over the scene is that of a parallel view.
const PARALLEL: f64 = 1e-9;

impl Projection {
    /// The camera that sees what the matrix shows; none for a matrix that no camera has, such as one of unequal scales.
    ///
    /// What it looks at is the point of its middle line of sight that is nearest to the middle of the scene. It has front and
    /// back depths only where these cut off.
    ///
    /// - `center`: the middle of the scene. `diagonal`: the length of the scene's diagonal, scene units.
    pub fn camera(&self, center: DVec3, diagonal: f64) -> Option<Camera> {
        let rows = self.to_clip.transpose();
        let across = rows.x_axis.truncate().length();
        let depth = rows.w_axis.truncate().length() * diagonal;
        let camera = if depth > PARALLEL * rows.w_axis.dot(center.extend(1.0)).abs() && across > 0.0 {
            self.perspective(center)
        } else {
            self.parallel(center, diagonal)
        };
        camera.filter(|camera| camera.check().is_ok())
    }

    fn perspective(&self, center: DVec3) -> Option<Camera> {
        let [x, y, z, w] = self.rows();
        let scale = 1.0 / w.truncate().length();
        let [x, y, z, w] = [x, y, z, w].map(|row| row * scale);
        let forward = w.truncate();
        let half_tangents = [x, y].map(|row| 1.0 / row.truncate().length());
        let [right, up] = [x.truncate() * half_tangents[0], y.truncate() * half_tangents[1]];
        let is_square = (half_tangents[0] / half_tangents[1] - 1.0).abs() < SKEW;
        if !is_square || !are_axes(right, up, forward) {
            return None;
        }
        let planes = DMat3::from_cols(x.truncate(), y.truncate(), w.truncate()).transpose();
        let from = planes.inverse() * -DVec3::new(x.w, y.w, w.w);
        let ahead = (center - from).dot(forward);
        let distance = if ahead > 0.0 { ahead } else { (center - from).length() };
        // z = slope depth + begin, which is cut off at 0 and at the depth.
        let (slope, begin) = (z.truncate().dot(forward), z.dot(from.extend(1.0)));
        let near = if self.depth_clipping { (-begin / slope).max(0.0) } else { 0.0 };
        let far = Some(begin / (1.0 - slope)).filter(|far| self.depth_clipping && *far > near && far.is_finite());
        let field_of_view = 2.0 * half_tangents[1].atan().to_degrees();
        let at = from + distance * forward;
        Some(Camera { from, at, up, field_of_view, near, far, lens: None, parallel: None, motion: None })
    }

    fn parallel(&self, center: DVec3, diagonal: f64) -> Option<Camera> {
        let [x, y, z, w] = self.rows();
        let [x, y, z] = [x, y, z].map(|row| row / w.w);
        let depths = z.truncate().length();
        let forward = z.truncate() / depths;
        let aside = |row: DVec4| row.truncate() - forward * row.truncate().dot(forward);
        let scales = [x, y].map(|row| aside(row).length());
        let [right, up] = [aside(x) / scales[0], aside(y) / scales[1]];
        if (scales[0] / scales[1] - 1.0).abs() >= SKEW || !are_axes(right, up, forward) {
            return None;
        }
        let oblique = -DVec2::new(x.truncate().dot(forward) / scales[0], y.truncate().dot(forward) / scales[1]);
        let off = [x, y].map(|row| row.dot(center.extend(1.0)));
        let at = center - right * (off[0] / scales[0]) - up * (off[1] / scales[1]);
        // Where the front and the back are, seen from `at`.
        let (slope, begin) = (depths, z.dot(at.extend(1.0)));
        let [front, back] = [-begin / slope, (1.0 - begin) / slope];
        let distance = if self.depth_clipping { diagonal.max(-front) } else { diagonal };
        let near = if self.depth_clipping { (distance + front).max(0.0) } else { 0.0 };
        let far = self.depth_clipping.then_some(distance + back);
        let parallel = Some(Parallel { height: 2.0 / scales[1], oblique });
        let from = at - distance * forward;
        Some(Camera {
            from,
            at,
            up,
            field_of_view: FRAMING_FIELD_OF_VIEW,
            near,
            far,
            lens: None,
            parallel,
            motion: None,
        })
    }

    /// The rows of the matrix: what a point is multiplied with for x, y, z and w.
    fn rows(&self) -> [DVec4; 4] {
        let rows = self.to_clip.transpose();
        [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis]
    }
}

/// Whether vectors are the axes of a picture: of length 1, at right angles, right, up and forward.
fn are_axes(right: DVec3, up: DVec3, forward: DVec3) -> bool {
    right.cross(up).distance(-forward) < SKEW && right.dot(up).abs() < SKEW
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;

    fn cameras() -> Vec<Camera> {
        let plain = Camera {
            from: DVec3::new(3.0, 2.0, 7.0),
            at: DVec3::new(0.5, 1.0, -0.5),
            up: DVec3::new(0.1, 1.0, 0.0),
            field_of_view: 34.0,
            near: 0.0,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        };
        let parallel = |oblique| Some(Parallel { height: 3.0, oblique });
        vec![
            plain,
            Camera { near: 2.0, far: Some(30.0), ..plain },
            Camera { field_of_view: 120.0, from: DVec3::new(0.0, 9.0, 0.1), ..plain },
            Camera { parallel: parallel(DVec2::ZERO), ..plain },
            Camera { parallel: parallel(DVec2::new(0.3, 0.4)), near: 1.0, far: Some(20.0), ..plain },
        ]
    }

    /// Where both show points, and which of these they cut off.
    fn assert_same(one: &Projection, two: &Projection) {
        for number in 0..60 {
            let point = DVec3::new(f64::from(number % 5), f64::from(number / 5 % 4), f64::from(number / 20)) - 1.5;
            let [a, b] = [one, two].map(|projection| projection.to_clip * point.extend(1.0));
            let [shown, again] = [a, b].map(|clip| clip.truncate() / clip.w);
            assert!((shown - again).truncate().length() < 1e-9, "{shown} {again}");
            let is_cut = |clip: DVec4, by: &Projection| by.depth_clipping && !(0.0..=clip.w).contains(&clip.z);
            assert_eq!(is_cut(a, one), is_cut(b, two), "{point}");
        }
    }

    #[test]
    fn the_camera_behind_the_matrix_of_a_camera_sees_the_same() {
        for camera in cameras() {
            let matrix = camera.projection().expect("a view");
            let found = matrix.camera(DVec3::new(0.5, 0.5, 0.5), 6.0).expect("a camera");
            assert_same(&matrix, &found.projection().expect("a view"));
            assert_eq!(
                (found.far.is_some(), found.parallel.is_some()),
                (camera.far.is_some(), camera.parallel.is_some())
            );
        }
    }

    #[test]
    fn turned_moved_and_scaled_scenes_are_seen_by_a_camera_elsewhere() {
        let dials = DMat4::from_translation(DVec3::new(0.4, -0.2, 0.3))
            * DMat4::from_rotation_x(0.3)
            * DMat4::from_rotation_y(-1.0)
            * DMat4::from_rotation_z(0.2)
            * DMat4::from_scale(DVec3::splat(1.7));
        for camera in cameras() {
            let seen = camera.projection().expect("a view");
            let matrix = Projection { to_clip: seen.to_clip * dials, ..seen };
            let found = matrix.camera(DVec3::ZERO, 6.0).expect("a camera");
            assert_same(&matrix, &found.projection().expect("a view"));
        }
    }

    #[test]
    fn a_matrix_that_no_camera_has_has_none() {
        let seen = cameras()[0].projection().expect("a view");
        let odd = [
            seen.to_clip * DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0)),
            seen.to_clip * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)),
            DMat4::ZERO,
            DMat4::from_cols_array(&[f64::NAN; 16]),
        ];
        for to_clip in odd {
            assert_eq!(Projection { to_clip, ..seen }.camera(DVec3::ZERO, 6.0), None, "{to_clip}");
        }
    }
}
