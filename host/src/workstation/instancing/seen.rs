//! How large something is on the screen before dials turn the scene.

use crate::workstation::InitialView;
use glam::DVec3;

/// What is out of the picture counts as so many times smaller: dials may bring it in.
const OUTSIDE: f64 = 256.0;
/// The largest size: what the eye is in.
const LARGEST: f64 = 1e3;

/// The screen as the initial view shows it.
pub(super) struct SeenFrom {
    from: DVec3,
    /// To the right, up and forward.
    axes: [DVec3; 3],
    /// Half the side of the screen in scene units: at a depth of 1, or at any depth of a parallel view.
    half: f64,
    is_parallel: bool,
}

impl SeenFrom {
    pub(super) fn new(initial: &InitialView) -> SeenFrom {
        let camera = &initial.camera;
        let half = camera.parallel.map_or(camera.half_tangent(), |parallel| parallel.height / 2.0);
        SeenFrom {
            from: camera.from,
            axes: initial.picture_axes(),
            half: half * initial.elongation,
            is_parallel: camera.parallel.is_some(),
        }
    }

    /// The eye.
    pub(super) fn eye(&self) -> DVec3 {
        self.from
    }

    /// The radius of a ball on the screen, in halves of its side, and its middle there, -1 to 1. What has its middle out
    /// of the picture counts as smaller, down to a 256th of that; what is out of it altogether has no place. An oblique
    /// view is taken as if it were none.
    pub(super) fn size(&self, center: DVec3, radius: f64) -> (f64, Option<[f32; 2]>) {
        let [x, y, depth] = self.axes.map(|axis| axis.dot(center - self.from));
        let aside = x.abs().max(y.abs());
        let (border, reach) = match self.is_parallel {
            true => (self.half, radius),
            false => (depth.max(0.0) * self.half, radius * (1.0 + self.half * self.half).sqrt()),
        };
        // 1 as long as the middle is in the picture, 0 where the ball only touches it.
        let inside = ((border - aside) / reach + 1.0).min(1.0);
        let is_in = inside > 0.0 && (self.is_parallel || depth + radius > 0.0);
        let distance = match self.is_parallel {
            true => 1.0,
            // Whatever is behind the eye is as far as it is.
            false => if is_in { depth } else { center.distance(self.from) }.max(radius / LARGEST),
        };
        let scale = 1.0 / (distance * self.half);
        let size = if (radius * scale).is_finite() { (radius * scale).min(LARGEST) } else { 0.0 };
        if is_in {
            (size * inside.max(1.0 / OUTSIDE), Some([x, y].map(|side| (side * scale) as f32)))
        } else {
            (size / OUTSIDE, None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Parallel};
    use glam::DVec2;

    #[test]
    fn sizes_fall_with_depth_and_what_is_outside_counts_less() {
        let bounds = crate::numeric::bounds::Bounds::of([DVec3::splat(-1.0), DVec3::splat(1.0)]);
        let camera = Camera { from: DVec3::Z * 10.0, at: DVec3::ZERO, field_of_view: 90.0, ..Camera::framing(&bounds) };
        let initial = InitialView { camera, center: DVec3::ZERO, elongation: 2.0 };
        let seen = SeenFrom::new(&initial);
        let (size, at) = seen.size(DVec3::new(5.0, -10.0, 0.0), 1.0);
        assert!((size - 0.05).abs() < 1e-12 && at == Some([0.25, -0.5]));
        assert!((seen.size(DVec3::Z * -10.0, 1.0).0 - 0.025).abs() < 1e-12);
        assert!((seen.size(DVec3::Y * 20.0, 1.0).0 - 0.05).abs() < 1e-12, "the screen is square");
        let half_out = seen.size(DVec3::Y * (20.0 + 0.5 * 5.0_f64.sqrt()), 1.0).0;
        assert!((half_out - 0.025).abs() < 1e-12, "{half_out}");
        let (aside, nowhere) = seen.size(DVec3::Y * 40.0, 1.0);
        assert!((aside * OUTSIDE - 0.5 / 1700.0_f64.sqrt()).abs() < 1e-12 && nowhere.is_none(), "as far as it is");
        assert!((seen.size(DVec3::Z * 20.0, 1.0).0 - 0.05 / OUTSIDE).abs() < 1e-12, "behind the eye");
        assert!((seen.size(DVec3::Z * 10.0, 1.0).0 - LARGEST / 2.0).abs() < 1e-9, "around the eye");
        let parallel = Some(Parallel { height: 4.0, oblique: DVec2::ZERO });
        let initial = InitialView { camera: Camera { parallel, ..camera }, elongation: 1.0, ..initial };
        let seen = SeenFrom::new(&initial);
        assert_eq!([0.0, -50.0].map(|z| seen.size(DVec3::Z * z, 1.0).0), [0.5; 2]);
    }
}
