//! The pipeline after the matrix: clip in homogeneous coordinates, project, map to the viewport.

use super::Stroke;
use crate::structure::State;
use glam::{DMat4, DVec4};

/// A w below which its reciprocal may be beyond the numbers.
const TINY: f64 = 1e-300;

/// From clip space to the screen, with depth cueing.
///
/// A coordinate c of -1..=1 is on the screen at `middle + c half`, a depth d of 0..=1 the light `front - d fall`.
#[derive(Clone, Copy, Debug)]
pub struct ScreenMap {
    /// Middle and half the size of the viewport, x and y.
    middle: [f64; 2],
    half: [f64; 2],
    /// Intensity at the front, and how much less it is at the back.
    front: f64,
    fall: f64,
}

/// Clips the vectors of one data node and turns them into strokes.
#[derive(Clone, Copy, Debug)]
pub struct Clipper {
    screen: ScreenMap,
    depth_clipping: bool,
    color: [f32; 3],
}

impl Clipper {
    /// The clipper for data in a state.
    pub fn new(state: &State) -> Clipper {
        Clipper { screen: ScreenMap::new(state), depth_clipping: state.depth_clipping, color: state.color }
    }

    /// This clipper without depth cueing.
    pub fn at_full_intensity(mut self) -> Clipper {
        (self.screen.front, self.screen.fall) = (1.0, 0.0);
        self
    }

    /// This clipper for data of another linear colour.
    pub fn in_color(mut self, color: [f32; 3]) -> Clipper {
        self.color = color;
        self
    }

    /// Transforms points (x, y, z, intensity) into clip space; appends (x', y', z', w') to `clip`.
    pub fn transform(matrix: &DMat4, points: &[[f32; 4]], clip: &mut Vec<DVec4>) {
        let (cx, cy, cz, cw) = (matrix.x_axis, matrix.y_axis, matrix.z_axis, matrix.w_axis);
        clip.extend(points.iter().map(|p| cx * f64::from(p[0]) + cy * f64::from(p[1]) + cz * f64::from(p[2]) + cw));
    }

    /// Clips the line from `a` to `b` (clip space) with the intensities of its ends; none if nothing of it
    /// is seen.
    ///
    /// Points with w <= 0 are never seen: they lie behind the eye, or (w = 0) nowhere.
    // Inlined, with what it calls for a line that is inside: a stroke that is returned through memory waits there
    // for its parts, and that took two thirds of the time.
    #[inline(always)]
    pub fn line(&self, a: DVec4, b: DVec4, intensity: [f64; 2]) -> Option<Stroke> {
        let (mut ends, mut intensity) = ([a, b], intensity);
        if !(self.inside(a) & self.inside(b)) {
            (ends, intensity) = self.cut(a, b, intensity)?;
        }
        self.screen.stroke(ends, intensity, self.color)
    }

    /// The ends and intensities of the part of a line that is inside, none if there is none.
    fn cut(&self, a: DVec4, b: DVec4, intensity: [f64; 2]) -> Option<([DVec4; 2], [f64; 2])> {
        if self.outcode(a) & self.outcode(b) != 0 {
            return None;
        }
        let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
        let mut against = |p: f64, q: f64| {
            // The boundary coordinate runs from p at a to q at b; inside is where it is not negative.
            if p < 0.0 && q < 0.0 || p.is_nan() || q.is_nan() {
                t0 = 2.0;
            } else if p < 0.0 {
                t0 = t0.max(p / (p - q));
            } else if q < 0.0 {
                t1 = t1.min(p / (p - q));
            }
        };
        against(a.w + a.x, b.w + b.x);
        against(a.w - a.x, b.w - b.x);
        against(a.w + a.y, b.w + b.y);
        against(a.w - a.y, b.w - b.y);
        if self.depth_clipping {
            against(a.z, b.z);
            against(a.w - a.z, b.w - b.z);
        }
        if t0 > t1 {
            return None;
        }
        // A cut of a line that comes from far away may miss the boundary by a rounding.
        let onto = |c: f64, w: f64| if c.abs() > w { w.copysign(c) } else { c };
        let at = |t: f64| {
            let p = if t == 1.0 { b } else { a + (b - a) * t };
            DVec4::new(onto(p.x, p.w), onto(p.y, p.w), p.z, p.w)
        };
        let shade = |t: f64| intensity[0] + (intensity[1] - intensity[0]) * t;
        Some(([at(t0), at(t1)], [shade(t0), shade(t1)]))
    }

    /// A dot at `a` (clip space).
    pub fn dot(&self, a: DVec4, intensity: f64) -> Option<Stroke> {
        if !self.inside(a) {
            return None;
        }
        self.screen.stroke([a, a], [intensity; 2], self.color)
    }

    /// Whether `p` lies inside of all boundaries, without a branch for each.
    #[inline(always)]
    fn inside(&self, p: DVec4) -> bool {
        let lateral = (p.x.abs() <= p.w) & (p.y.abs() <= p.w) & (p.w > 0.0);
        lateral & (!self.depth_clipping | ((p.z >= 0.0) & (p.z <= p.w)))
    }

    /// A bit for each boundary that `p` lies outside of: sides, w > 0, front and back.
    fn outcode(&self, p: DVec4) -> u8 {
        // Asked for inside, so that a NaN counts as outside.
        let outside = |inside: bool, bit: u8| u8::from(!inside) << bit;
        let lateral = outside(p.x >= -p.w, 0)
            | outside(p.x <= p.w, 1)
            | outside(p.y >= -p.w, 2)
            | outside(p.y <= p.w, 3)
            | outside(p.w > 0.0, 4);
        if self.depth_clipping { lateral | outside(p.z >= 0.0, 5) | outside(p.z <= p.w, 6) } else { lateral }
    }
}

impl ScreenMap {
    fn new(state: &State) -> ScreenMap {
        let [back, front] = state.depth_cue();
        let sides = [state.horizontal, state.vertical];
        ScreenMap {
            middle: sides.map(|[low, high]| low + (high - low) / 2.0),
            half: sides.map(|[low, high]| (high - low) / 2.0),
            front,
            fall: front - back,
        }
    }

    /// The stroke between two points of clip space that are inside; none if they have no position on the screen.
    #[inline(always)]
    fn stroke(&self, ends: [DVec4; 2], intensity: [f64; 2], color: [f32; 3]) -> Option<Stroke> {
        let [a, b] = [self.screen_point(ends[0], intensity[0]), self.screen_point(ends[1], intensity[1])];
        // One sum instead of six questions: all are small if they are numbers at all.
        if !(a[0] + a[1] + a[2] + b[0] + b[1] + b[2]).is_finite() {
            return None;
        }
        Some(Stroke { start: [a[0], a[1]], end: [b[0], b[1]], intensity: [a[2], b[2]], color })
    }

    /// x, y on the screen and the light of a point of clip space with w > 0.
    #[inline(always)]
    fn screen_point(&self, p: DVec4, intensity: f64) -> [f32; 3] {
        // One division for three quotients; its rounding vanishes in that of the result, also at the edge.
        let p = if p.w < TINY { p / TINY } else { p };
        let part = 1.0 / p.w;
        let x = self.middle[0] + p.x * part * self.half[0];
        let y = self.middle[1] + p.y * part * self.half[1];
        let depth = (p.z * part).clamp(0.0, 1.0);
        let light = ((self.front - depth * self.fall) * intensity.clamp(0.0, 1.0)).clamp(0.0, 1.0);
        [x as f32, y as f32, light as f32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_from_far_away_ends_on_the_edge() {
        let clipper = Clipper::new(&State::default());
        let end = DVec4::new(0.25, 0.5, 0.5, 1.0);
        for size in [1.0, 1e3, 1e6] {
            let start = DVec4::new(-3.0 * size, 0.5, 0.5, 1.0);
            let stroke = clipper.line(start, end, [1.0; 2]).expect("it is seen");
            assert_eq!((stroke.start, stroke.end), ([-1.0, 0.5], [0.25, 0.5]), "{size}");
        }
    }

    #[test]
    fn the_size_of_w_does_not_matter() {
        let clipper = Clipper::new(&State::default());
        let points = [DVec4::new(0.0, 0.75, 0.5, 1.0), DVec4::new(-0.5, -1.0, 0.25, 1.0)];
        let stroke = clipper.line(points[0], points[1], [1.0; 2]);
        assert!(stroke.is_some());
        for scale in [2.0_f64.powi(-1040), 2.0_f64.powi(-1000), 2.0_f64.powi(1000)] {
            assert_eq!(clipper.line(points[0] * scale, points[1] * scale, [1.0; 2]), stroke, "{scale}");
        }
    }

    #[test]
    fn points_that_are_not_numbers_draw_nothing() {
        let clipper = Clipper::new(&State::default());
        let good = DVec4::new(0.0, 0.0, 0.5, 1.0);
        for axis in 0..4 {
            let mut bad = good;
            bad[axis] = f64::NAN;
            assert_eq!(clipper.line(good, bad, [1.0; 2]), None, "axis {axis}");
            assert_eq!(clipper.line(bad, good, [1.0; 2]), None, "axis {axis}");
            assert_eq!(clipper.dot(bad, 1.0), None, "axis {axis}");
        }
    }
}
