//! The pipeline after the matrix: clip in homogeneous coordinates, project, map to the viewport.

use super::{State, Stroke};
use glam::{DMat4, DVec4};

/// From clip space to the screen, with depth cueing.
#[derive(Clone, Copy, Debug)]
pub struct ScreenMap {
    horizontal: [f64; 2],
    vertical: [f64; 2],
    cue: [f64; 2],
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
        Clipper {
            screen: ScreenMap { horizontal: state.horizontal, vertical: state.vertical, cue: state.depth_cue() },
            depth_clipping: state.depth_clipping,
            color: state.color,
        }
    }

    /// The same without depth cueing.
    pub fn at_full_intensity(mut self) -> Clipper {
        self.screen.cue = [1.0; 2];
        self
    }

    /// The same in another linear colour.
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
    pub fn line(&self, a: DVec4, b: DVec4, intensity: [f64; 2]) -> Option<Stroke> {
        let (code_a, code_b) = (self.outcode(a), self.outcode(b));
        if code_a & code_b != 0 {
            return None;
        }
        if code_a | code_b == 0 {
            return self.screen.stroke([a, b], intensity, self.color);
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
        let at = |t: f64| if t == 1.0 { b } else { a + (b - a) * t };
        let shade = |t: f64| intensity[0] + (intensity[1] - intensity[0]) * t;
        self.screen.stroke([at(t0), at(t1)], [shade(t0), shade(t1)], self.color)
    }

    /// A dot at `a` (clip space).
    pub fn dot(&self, a: DVec4, intensity: f64) -> Option<Stroke> {
        if self.outcode(a) != 0 {
            return None;
        }
        self.screen.stroke([a, a], [intensity; 2], self.color)
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
    /// The stroke between two points of clip space that are inside; none if they have no place on the screen.
    fn stroke(&self, ends: [DVec4; 2], intensity: [f64; 2], color: [f32; 3]) -> Option<Stroke> {
        let mut screen = [[0.0_f32; 2]; 2];
        let mut bright = [0.0_f32; 2];
        for (k, p) in ends.iter().enumerate() {
            let (x, y) = ((p.x / p.w).clamp(-1.0, 1.0), (p.y / p.w).clamp(-1.0, 1.0));
            let depth = (p.z / p.w).clamp(0.0, 1.0);
            let [back, front] = self.cue;
            let place = |range: [f64; 2], c: f64| (range[0] + (c + 1.0) * (range[1] - range[0]) / 2.0) as f32;
            screen[k] = [place(self.horizontal, x), place(self.vertical, y)];
            bright[k] = ((front - depth * (front - back)) * intensity[k].clamp(0.0, 1.0)).clamp(0.0, 1.0) as f32;
        }
        let finite = screen.iter().flatten().chain(&bright).all(|c| c.is_finite());
        finite.then_some(Stroke { start: screen[0], end: screen[1], intensity: bright, color })
    }
}
