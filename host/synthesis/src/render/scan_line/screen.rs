//! From the scene to the samples of the picture: columns, lines of samples, and nearness.

use crate::numeric::bounds::Bounds;
use crate::render::world::plane_intersection;
use crate::scene::{Projection, View};
use glam::{DVec3, DVec4};

/// Nothing is seen nearer to the eye than this fraction of the distance to the farthest corner of a polygon.
const NEAREST: f64 = 1e-12;
/// How far beyond the picture polygons are drawn without being clipped, as a fraction of its size.
const MARGIN: f64 = 0.5;
/// Planes at which polygons are clipped: four sides of the window, the eye, near and far.
const PLANES: usize = 7;
/// How many of them clip shadow polygons, which begin at the eye and end nowhere.
const WITHOUT_DEPTH: usize = 5;
/// Most corners of a clipped polygon of four corners.
pub(super) const MOST_CORNERS: usize = 4 + PLANES;

/// A point in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ScreenPoint {
    /// Columns from the left border.
    pub(super) x: f64,
    /// Lines of samples: the first is at 0.
    pub(super) y: f64,
    /// Nearness, which is linear over the picture and greater for what is nearer: one over the depth, or less the depth
    /// where lines of sight are parallel.
    pub(super) near: f64,
}

/// A point, or a direction, before the division: columns, lines, nearness, divisor, and how far it is behind the near
/// and before the far plane.
pub(super) type ClipCorner = [f64; 6];

/// The eye, or the direction to it where lines of sight are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Viewpoint {
    At(DVec3),
    Towards(DVec3),
}

/// A polygon that was clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedPolygon {
    corners: [ScreenPoint; MOST_CORNERS],
    count: usize,
}

impl ClippedPolygon {
    /// - `corners`: [`MOST_CORNERS`] at the most.
    pub(super) fn new(corners: &[ScreenPoint]) -> ClippedPolygon {
        let mut outline =
            ClippedPolygon { corners: [ScreenPoint::default(); MOST_CORNERS], count: corners.len().min(MOST_CORNERS) };
        outline.corners[..outline.count].copy_from_slice(&corners[..outline.count]);
        outline
    }

    /// This outline, nearer than everything.
    pub(super) fn brought_near(mut self) -> ClippedPolygon {
        self.corners.iter_mut().for_each(|corner| corner.near = f64::MAX);
        self
    }

    /// Its corners.
    pub(super) fn corners(&self) -> &[ScreenPoint] {
        &self.corners[..self.count]
    }
}

/// Places points of the scene in the picture.
pub(super) struct Screen {
    /// Rows of the matrix to a [`ClipCorner`], for points relative to `base`.
    rows: [DVec4; 6],
    base: DVec3,
    pub(super) viewpoint: Viewpoint,
    /// Columns and lines.
    size: [f64; 2],
    clips_near: bool,
}

impl Screen {
    /// The places of `view`; none if the view is degenerate. A lens is taken for a pinhole.
    ///
    /// - `samples`: lines of samples in each row of pixels.
    pub(super) fn new(view: &View, [width, height]: [u32; 2], samples: u32, bounds: &Bounds) -> Option<Screen> {
        let [left, right, bottom, top] = View::window(width, height);
        let (x, y, near, far, w, clips, eye);
        match view {
            View::Camera(camera) if camera.parallel.is_none() => {
                camera.check().ok()?;
                let [to_right, up, forward] = camera.axes()?;
                let t = camera.half_tangent();
                (x, y, w) = ((to_right / t).extend(0.0), (up / t).extend(0.0), forward.extend(0.0));
                near = w - DVec4::W * camera.near;
                far = camera.far.map_or(DVec4::W, |far| DVec4::W * far - w);
                (clips, eye) = (camera.near > 0.0 || camera.far.is_some(), Some(camera.from));
            }
            _ => {
                if let View::Camera(camera) = view {
                    camera.check().ok()?;
                }
                let Projection { to_clip, depth_clipping } = view.projection()?;
                if !to_clip.is_finite() {
                    return None;
                }
                let rows = [0, 1, 2, 3].map(|i| to_clip.row(i));
                let along = (rows[0].truncate().cross(rows[1].truncate())).try_normalize()?;
                let is_perspective = rows[3].truncate().length() * bounds.diagonal().max(f64::MIN_POSITIVE)
                    > f64::EPSILON * rows[3].dot(bounds.center().extend(1.0)).abs();
                eye = if is_perspective { Some(plane_intersection(rows[0], rows[1], rows[3])?) } else { None };
                let base = eye.unwrap_or(bounds.center()).extend(1.0);
                let relative =
                    |row: DVec4, at_base: Option<f64>| row.truncate().extend(at_base.unwrap_or_else(|| row.dot(base)));
                let at_eye = eye.map(|_| 0.0);
                (x, y, w) = (relative(rows[0], at_eye), relative(rows[1], at_eye), relative(rows[3], at_eye));
                let z = relative(rows[2], None);
                (near, far) = if depth_clipping { (z, w - z) } else { (DVec4::W, DVec4::W) };
                clips = depth_clipping;
                if eye.is_none() {
                    let forward = if rows[2].truncate().dot(along) * w.w < 0.0 { -along } else { along };
                    return (w.w > 0.0).then(|| {
                        let rows = in_picture([x, y, w], [left, right, bottom, top], [width, height], samples);
                        Screen {
                            rows: [rows[0], rows[1], (-forward * w.w).extend(0.0), w.w * DVec4::W, near, far],
                            base: base.truncate(),
                            viewpoint: Viewpoint::Towards(-forward),
                            size: [f64::from(width), f64::from(height) * f64::from(samples)],
                            clips_near: clips,
                        }
                    });
                }
            }
        }
        let eye = eye?;
        let rows = in_picture([x, y, w], [left, right, bottom, top], [width, height], samples);
        Some(Screen {
            rows: [rows[0], rows[1], DVec4::W, w, near, far],
            base: eye,
            viewpoint: Viewpoint::At(eye),
            size: [f64::from(width), f64::from(height) * f64::from(samples)],
            clips_near: clips,
        })
    }

    /// 1, or -1 where the picture is a mirror image.
    pub(super) fn handed(&self) -> i32 {
        let forward = match self.viewpoint {
            Viewpoint::At(_) => self.rows[3].truncate(),
            Viewpoint::Towards(back) => -back,
        };
        if self.rows[0].truncate().cross(self.rows[1].truncate()).dot(forward) < 0.0 { -1 } else { 1 }
    }

    /// Whether something may be hidden because it is too near.
    pub(super) fn clips_near(&self) -> bool {
        self.clips_near
    }

    /// A point of the scene.
    pub(super) fn corner(&self, point: DVec3) -> ClipCorner {
        let point = (point - self.base).extend(1.0);
        self.rows.map(|row| row.dot(point))
    }

    /// The corner of a point infinitely far away in a direction.
    pub(super) fn direction(&self, direction: DVec3) -> ClipCorner {
        self.rows.map(|row| row.truncate().dot(direction))
    }

    /// A point, or a direction, whose last number is 0.
    pub(super) fn homogeneous(&self, point: DVec4) -> ClipCorner {
        let point = (point.truncate() - self.base * point.w).extend(point.w);
        self.rows.map(|row| row.dot(point))
    }

    /// Beside which planes a corner lies: one bit for each.
    pub(super) fn outside(&self, corner: &ClipCorner) -> u8 {
        (0..PLANES)
            .filter(|&plane| self.height(plane, corner, f64::MIN_POSITIVE) < 0.0)
            .fold(0, |bits, p| bits | 1 << p)
    }

    /// The point of a corner in the picture, if no plane cuts it off.
    pub(super) fn point(corner: &ClipCorner) -> ScreenPoint {
        ScreenPoint { x: corner[0] / corner[3], y: corner[1] / corner[3], near: corner[2] / corner[3] }
    }

    /// Over a plane, 0 and more inside.
    ///
    /// - `least`: the divisor at the eye.
    fn height(&self, plane: usize, corner: &ClipCorner, least: f64) -> f64 {
        let [x, y, _, w, near, far] = *corner;
        let [width, lines] = self.size;
        match plane {
            0 => x + w * (MARGIN * width),
            1 => w * ((1.0 + MARGIN) * width) - x,
            2 => y + w * (MARGIN * lines),
            3 => w * ((1.0 + MARGIN) * lines) - y,
            4 => w - least,
            5 => near,
            _ => far,
        }
    }

    /// Clips a convex polygon; none if nothing is left.
    ///
    /// Two polygons that share a side keep sharing it, bit by bit.
    ///
    /// - `depths`: 0 clips at the window and the eye only, 1 also what is before the near or behind the far plane, and
    ///   -1 what is behind the near plane.
    pub(super) fn clip(&self, corners: &[ClipCorner], depths: i32) -> Option<ClippedPolygon> {
        let mut polygon = [[0.0; 6]; MOST_CORNERS];
        let mut count = corners.len();
        polygon[..count].copy_from_slice(corners);
        let least = NEAREST * corners.iter().fold(0.0, |most, corner| f64::max(most, corner[3].abs()));
        let planes = match depths {
            0 => WITHOUT_DEPTH,
            1 => PLANES,
            _ => PLANES - 1,
        };
        for plane in 0..planes {
            let sign = if plane == 5 && depths < 0 { -1.0 } else { 1.0 };
            let heights = polygon.map(|corner| sign * self.height(plane, &corner, least));
            if heights[..count].iter().all(|height| *height >= 0.0) {
                continue;
            }
            let between = |a: ClipCorner, b: ClipCorner, t: f64| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t);
            (polygon, count) = cut(&polygon[..count], &heights, between)?;
            if count < 3 {
                return None;
            }
        }
        let mut outline = ClippedPolygon { corners: [ScreenPoint::default(); MOST_CORNERS], count };
        for (point, corner) in outline.corners.iter_mut().zip(&polygon[..count]) {
            *point = Screen::point(corner);
            if !(point.x.is_finite() && point.y.is_finite() && point.near.is_finite()) {
                return None;
            }
        }
        Some(outline)
    }
}

/// The part of a convex polygon that is inside a plane, and how many corners it has; none if there is no room for them.
///
/// - `heights`: of the corners, 0 and more inside. `between`: a point between one corner and another.
pub(super) fn cut<T: Copy + Default, const N: usize>(
    polygon: &[T],
    heights: &[f64; N],
    between: impl Fn(T, T, f64) -> T,
) -> Option<([T; N], usize)> {
    let mut kept = [T::default(); N];
    let mut n = 0;
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if heights[i] >= 0.0 {
            *kept.get_mut(n)? = polygon[i];
            n += 1;
        }
        if (heights[i] >= 0.0) != (heights[j] >= 0.0) {
            // Always from the inner end, so that both neighbours find the same point.
            let (inner, outer) = if heights[i] >= 0.0 { (i, j) } else { (j, i) };
            let t = heights[inner] / (heights[inner] - heights[outer]);
            *kept.get_mut(n)? = between(polygon[inner], polygon[outer], t);
            n += 1;
        }
    }
    Some((kept, n))
}

/// The rows that give columns and lines, before the division.
fn in_picture(
    [x, y, w]: [DVec4; 3],
    [left, right, bottom, top]: [f64; 4],
    [width, height]: [u32; 2],
    samples: u32,
) -> [DVec4; 2] {
    let columns = (x - w * left) * (f64::from(width) / (right - left));
    let lines = (w * top - y) * (f64::from(height) * f64::from(samples) / (top - bottom)) - w * 0.5;
    [columns, lines]
}
