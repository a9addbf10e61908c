//! From a point of the picture to a ray into the scene, for cameras and for matrices.

use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::disk;
use crate::scene::{Camera, Lens, Motion, Projection, View};
use glam::{DMat3, DVec3, DVec4};

/// A ray from the origin into the picture, in the place of one that an eye does not have.
pub(in crate::render) const AHEAD: Ray = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z };

/// Rounding errors of the largest coordinate within which an eye is on a surface: it sees what is beyond.
const ON_SURFACE_ULPS: f64 = 32.0;

/// A ray with the part of it in which something can be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::render) struct BoundedRay {
    pub(in crate::render) ray: Ray,
    pub(in crate::render) t_min: f64,
    pub(in crate::render) t_max: f64,
    /// Its ray cone.
    pub(in crate::render) cone: RayCone,
}

/// The width of a ray cone, scene units.
///
/// # Source
/// Amanatides 1984, ray tracing with cones; as Akenine-Möller and others 2021 use them to filter textures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::render) struct RayCone {
    /// The width where the ray begins.
    pub(in crate::render) width: f64,
    /// Growth of the width in each unit of length.
    pub(in crate::render) growth: f64,
}

impl RayCone {
    /// At a distance.
    pub(in crate::render) fn at(&self, distance: f64) -> f64 {
        self.width + self.growth * distance
    }
}

/// Makes the rays of a view.
pub(in crate::render) struct CameraRays {
    /// Clip coordinates of the left upper corner of the picture.
    corner: [f64; 2],
    /// Clip coordinates a pixel to the right and a pixel down.
    step: [f64; 2],
    kind: Kind,
    /// How the camera moves while the shutter is open.
    motion: Option<Motion>,
    /// Part of a pixel that a ray stands for, as a side of a square; 0 where no one asks for it.
    part: f64,
}

enum Kind {
    /// A camera: origin, right and up scaled to the field of view, forward, near, far.
    Camera { from: DVec3, right: DVec3, up: DVec3, forward: DVec3, near: f64, far: f64, lens: Option<Lens> },
    /// The rows of a matrix, relative to the `base` point.
    Matrix { rows: [DVec4; 4], base: DVec3, radius: f64, depth_clipping: bool },
}

impl CameraRays {
    /// The rays of `view` for a picture of `width` by `height`; none if the view is degenerate.
    pub(in crate::render) fn new(view: &View, width: u32, height: u32, bounds: &Bounds) -> Option<CameraRays> {
        let [x_min, x_max, y_min, y_max] = View::window(width, height);
        let kind = match view {
            View::Camera(camera) if camera.parallel.is_some() => {
                camera.check().ok()?;
                Kind::of_matrix(&camera.projection()?, bounds)?
            }
            View::Camera(camera) => Kind::of_camera(camera, bounds)?,
            View::Projection(projection) => Kind::of_matrix(projection, bounds)?,
        };
        let step = [(x_max - x_min) / f64::from(width), (y_min - y_max) / f64::from(height)];
        let motion = match view {
            View::Camera(camera) => camera.motion,
            View::Projection(_) => None,
        };
        Some(CameraRays { corner: [x_min, y_max], step, kind, motion, part: 0.0 })
    }

    /// The position of a camera; none for views along parallel lines and by matrices.
    pub(in crate::render) fn place(&self) -> Option<DVec3> {
        match self.kind {
            Kind::Camera { from, .. } => Some(from),
            Kind::Matrix { .. } => None,
        }
    }

    /// Whether the rays of a point of the picture differ from time to time.
    pub(in crate::render) fn moves(&self) -> bool {
        self.motion.is_some()
    }

    /// The place in the picture, in pixels from the left upper corner, of clip coordinates, divided by the fourth.
    pub(in crate::render) fn pixel(&self, clip: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| (clip[i] - self.corner[i]) / self.step[i])
    }

    /// Gives rays cones that are a part of a pixel wide.
    pub(in crate::render) fn with_cones(self, part: f64) -> CameraRays {
        CameraRays { part, ..self }
    }

    /// The ray through a point of the picture in pixels from the left upper corner; none if nothing is seen there.
    ///
    /// - `through`: a point of the unit square, which chooses the point of the lens.
    #[inline]
    pub(in crate::render) fn ray(&self, at: [f64; 2], through: [f64; 2]) -> Option<BoundedRay> {
        let bounded = self.line(at, through)?;
        if self.part == 0.0 {
            return Some(bounded);
        }
        let aside = self.line([at[0] + 1.0, at[1]], through).unwrap_or(bounded);
        let [one, two] = [bounded.ray, aside.ray].map(|ray| Ray { direction: ray.direction.normalize(), ..ray });
        let apart = two.origin - one.origin;
        let width = (apart - one.direction * apart.dot(one.direction)).length() * self.part;
        let growth = (two.direction - one.direction).length() * self.part;
        Some(BoundedRay { cone: RayCone { width, growth }, ..bounded })
    }

    /// The ray through a point of the picture at a time.
    ///
    /// - `time`: from the middle of the time in which the shutter is open.
    #[inline]
    pub(in crate::render) fn ray_at(&self, at: [f64; 2], through: [f64; 2], time: f64) -> Option<BoundedRay> {
        let bounded = self.ray(at, through)?;
        let Some(motion) = self.motion else { return Some(bounded) };
        Some(BoundedRay { ray: motion.at(time).carried(&bounded.ray), ..bounded })
    }

    /// The ray without its cone.
    #[inline]
    fn line(&self, at: [f64; 2], through: [f64; 2]) -> Option<BoundedRay> {
        let [x, y] = [0, 1].map(|i| self.corner[i] + at[i] * self.step[i]);
        match &self.kind {
            Kind::Camera { from, right, up, forward, near, far, lens } => {
                let direction = *forward + *right * x + *up * y;
                let ray = match lens {
                    None => Ray { origin: *from, direction },
                    Some(Lens { radius, focus }) => {
                        let [a, b] = disk(through);
                        let aside = (right.normalize() * a + up.normalize() * b) * *radius;
                        // All rays of a point of the picture meet in the plane that is sharp.
                        Ray { origin: *from + aside, direction: direction - aside / *focus }
                    }
                };
                Some(BoundedRay { ray, t_min: *near, t_max: *far, cone: RayCone::default() })
            }
            Kind::Matrix { rows, base, radius, depth_clipping } => {
                let mut bounded = line(rows, x, y, *radius, *depth_clipping)?;
                bounded.ray.origin += *base;
                Some(bounded)
            }
        }
    }
}

impl Kind {
    fn of_camera(camera: &Camera, bounds: &Bounds) -> Option<Kind> {
        camera.check().ok()?;
        let [right, up, forward] = camera.axes()?;
        let t = camera.half_tangent();
        let places = [bounds.min, bounds.max, camera.from].map(|place| place.abs().max_element());
        let largest = places.into_iter().filter(|place| place.is_finite()).fold(0.0, f64::max);
        let near = camera.near.max(ON_SURFACE_ULPS * f64::EPSILON * largest);
        let far = camera.far.unwrap_or(f64::INFINITY);
        Some(Kind::Camera { from: camera.from, right: right * t, up: up * t, forward, near, far, lens: camera.lens })
    }

    fn of_matrix(projection: &Projection, bounds: &Bounds) -> Option<Kind> {
        if !projection.to_clip.is_finite() {
            return None;
        }
        // Relative to the middle of the scene, so that a scene far from the origin keeps its digits.
        let base = bounds.center();
        let rows = [0, 1, 2, 3].map(|i| {
            let row = projection.to_clip.row(i);
            row.truncate().extend(row.dot(base.extend(1.0)))
        });
        let depth_clipping = projection.depth_clipping;
        let kind = Kind::Matrix { rows, base, radius: bounds.diagonal(), depth_clipping };
        DVec3::cross(rows[0].truncate(), rows[1].truncate()).try_normalize().map(|_| kind)
    }
}

/// The line of the points that a matrix maps to (x, y), as far as they can be seen.
///
/// The planes `row_x - x row_w = 0` and `row_y - y row_w = 0` meet in it. Along it, depth and w are linear, so that
/// its visible part `0 <= depth <= w`, `w > 0` is an interval.
fn line(rows: &[DVec4; 4], x: f64, y: f64, radius: f64, depth_clipping: bool) -> Option<BoundedRay> {
    let [row_x, row_y, row_z, row_w] = rows;
    let (a, b) = (*row_x - *row_w * x, *row_y - *row_w * y);
    let direction = a.truncate().cross(b.truncate()).try_normalize()?;
    let w_slope = row_w.truncate().dot(direction);
    let (direction, origin) = if w_slope.abs() > f64::EPSILON * row_w.truncate().length() {
        // Perspective: all lines meet where w = 0, and continue to where it is positive.
        let eye = plane_intersection(a, b, *row_w)?;
        (if w_slope > 0.0 { direction } else { -direction }, eye)
    } else {
        let z_slope = row_z.truncate().dot(direction) * row_w.w;
        let nearest = plane_intersection(a, b, direction.extend(0.0))?;
        let forward = if z_slope < 0.0 { -direction } else { direction };
        // From before the whole scene.
        (forward, nearest - forward * (2.0 * radius))
    };
    let at = |row: DVec4| [row.truncate().dot(direction), row.dot(origin.extend(1.0))];
    let mut range = [0.0, f64::INFINITY];
    if depth_clipping {
        let (depth, w) = (at(*row_z), at(*row_w));
        clip(&mut range, depth);
        clip(&mut range, [w[0] - depth[0], w[1] - depth[1]]);
    }
    (range[0] < range[1] && origin.is_finite()).then_some(BoundedRay {
        ray: Ray { origin, direction },
        t_min: range[0],
        t_max: range[1],
        cone: RayCone::default(),
    })
}

/// Cuts a range of t to where `slope t + value >= 0`.
fn clip(range: &mut [f64; 2], [slope, value]: [f64; 2]) {
    if slope > 0.0 {
        range[0] = range[0].max(-value / slope);
    } else if slope < 0.0 {
        range[1] = range[1].min(-value / slope);
    } else if value < 0.0 {
        range[1] = f64::NEG_INFINITY;
    }
}

/// The point that three planes share.
pub(in crate::render) fn plane_intersection(a: DVec4, b: DVec4, c: DVec4) -> Option<DVec3> {
    let unit = |p: DVec4| {
        let length = p.truncate().length();
        (length > 0.0).then(|| p / length)
    };
    let (a, b, c) = (unit(a)?, unit(b)?, unit(c)?);
    let matrix = DMat3::from_cols(a.truncate(), b.truncate(), c.truncate()).transpose();
    let point = matrix.inverse() * -DVec3::new(a.w, b.w, c.w);
    point.is_finite().then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let (from, at) = (DVec3::new(3.0, 2.0, 9.0), DVec3::new(0.5, 1.0, -1.0));
        Camera {
            from,
            at,
            up: DVec3::Y,
            field_of_view: 35.0,
            near: 2.0,
            far: Some(30.0),
            lens: None,
            parallel: None,
            motion: None,
        }
    }

    #[test]
    fn a_camera_and_its_matrix_see_the_same_rays() {
        let camera = camera();
        let bounds = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(3.0) };
        let by_camera = CameraRays::new(&View::Camera(camera), 64, 48, &bounds).expect("sees");
        let projection = camera.projection().expect("sees");
        let by_matrix = CameraRays::new(&View::Projection(projection), 64, 48, &bounds).expect("sees");
        for at in [[0.0, 0.0], [31.3, 17.0], [64.0, 48.0], [10.0, 40.0]] {
            let (a, b) = (by_camera.ray(at, [0.5; 2]).expect("ray"), by_matrix.ray(at, [0.5; 2]).expect("ray"));
            for (t_a, t_b) in [(a.t_min, b.t_min), (a.t_max, b.t_max)] {
                assert!((a.ray.at(t_a) - b.ray.at(t_b)).length() < 1e-10, "{at:?}");
            }
        }
    }

    #[test]
    fn a_window_looks_along_z_and_clips_at_its_boundaries() {
        // WINDOW of a PS 340: z into the screen, so the scene's -z after its sign is undone.
        let rows = [DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, 0.5, 0.5), DVec4::W];
        let matrix = glam::DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        for depth_clipping in [true, false] {
            let view = View::Projection(Projection::from_workstation(&matrix, depth_clipping));
            let bounded = CameraRays::new(&view, 2, 2, &bounds).expect("sees").ray([0.5, 0.5], [0.5; 2]).expect("ray");
            assert_eq!(bounded.ray.direction, DVec3::NEG_Z);
            let front = bounded.ray.at(bounded.t_min);
            assert_eq!((front.x, front.y), (-0.5, 0.5));
            if depth_clipping {
                assert!((front.z - 1.0).abs() < 1e-12 && (bounded.ray.at(bounded.t_max).z + 1.0).abs() < 1e-12);
            } else {
                assert!(front.z > 1.0 && bounded.t_max == f64::INFINITY);
            }
        }
    }

    #[test]
    fn extreme_boundaries_do_not_disturb_the_rays() {
        let matrix = |front: f64, back: f64| {
            let z = DVec4::new(0.0, 0.0, 1.0, -front) / (back - front);
            glam::DMat4::from_cols(DVec4::X, DVec4::Y, z, DVec4::W).transpose()
        };
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        let view = View::Projection(Projection::from_workstation(&matrix(1e-15, 1e15), true));
        let bounded = CameraRays::new(&view, 10, 10, &bounds).expect("sees").ray([2.5, 2.5], [0.5; 2]).expect("ray");
        assert!((bounded.ray.at(bounded.t_min) - DVec3::new(-0.5, 0.5, 0.0)).length() < 1e-12);
        assert!(bounded.t_max > 9e14);
    }

    #[test]
    fn cones_are_as_wide_as_the_pixels_at_every_distance() {
        let bounds = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(3.0) };
        let parallel =
            Camera { parallel: Some(crate::scene::Parallel { height: 6.0, oblique: glam::DVec2::ZERO }), ..camera() };
        for camera in [camera(), parallel] {
            let eye = CameraRays::new(&View::Camera(camera), 400, 300, &bounds).expect("sees").with_cones(1.0);
            for at in [[200.0, 150.0], [30.0, 270.0]] {
                let [one, two] = [at, [at[0] + 0.5, at[1] + 0.5]].map(|at| eye.ray(at, [0.5; 2]).expect("ray"));
                for distance in [1.0, 10.0, 1000.0] {
                    let point = |bounded: &BoundedRay| bounded.ray.at(distance / bounded.ray.direction.length());
                    // Half a diagonal of a pixel.
                    let apart = point(&one).distance(point(&two)) * 2.0_f64.sqrt();
                    let part = one.cone.at(distance) / apart;
                    assert!((part - 1.0).abs() < 0.15, "{at:?} {distance}: {part}");
                }
            }
        }
    }

    #[test]
    fn degenerate_views_are_refused() {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
        let flat = Projection { to_clip: glam::DMat4::ZERO, depth_clipping: false };
        assert!(CameraRays::new(&View::Projection(flat), 4, 4, &bounds).is_none());
        let infinite = Projection { to_clip: glam::DMat4::from_scale(DVec3::INFINITY), depth_clipping: false };
        assert!(CameraRays::new(&View::Projection(infinite), 4, 4, &bounds).is_none());
        let blind = Camera { at: camera().from, ..camera() };
        assert!(CameraRays::new(&View::Camera(blind), 4, 4, &bounds).is_none());
    }
}
