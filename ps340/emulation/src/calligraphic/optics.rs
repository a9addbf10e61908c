//! From strokes to positions, spot and current of the beam in pixels.

use super::spot::REACH;
use super::{Beam, FAR, MAX_SIZE, SPOT_CEILING, SPOT_FLOOR, STRONGEST};
use crate::traversal::Stroke;

/// A stroke in pixels: its start and end from the upper left corner of the picture, and the current at both.
pub(super) type Deflection = ([f64; 2], [f64; 2], [f64; 2]);

/// The pixels, the spot and the drive of the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Optics {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Pixels of a screen unit.
    pub half: f64,
    /// Centre of the screen in pixels.
    pub center: [f64; 2],
    /// Standard deviation of the spot in pixels.
    pub spot: f64,
    /// Pixels around the middle of a stroke that its light can reach.
    pub reach: f64,
    /// Length, in spots, that takes as long to write as a dot.
    pub dwell: f64,
    /// Light at the centre of a long stroke of intensity 1: less than 1 out of focus.
    pub peak: f64,
    /// How far intensities lie apart: 1 as they are.
    pub contrast: f64,
}

impl Optics {
    /// Brings the settings of a beam into their limits.
    pub fn new(beam: &Beam) -> Self {
        let size = [beam.width, beam.height].map(|pixels| pixels.clamp(1, MAX_SIZE) as usize);
        let half = size[0].min(size[1]) as f64 / 2.0;
        let number =
            |value: f32, low: f64, high: f64| if value.is_nan() { low } else { f64::from(value).clamp(low, high) };
        // The floor comes last: it wins on a screen of a few pixels.
        let pixels = |radius: f64| (radius.min(SPOT_CEILING) * half).max(SPOT_FLOOR);
        let radius = number(beam.spot_radius, 0.0, SPOT_CEILING);
        let spot = pixels(radius * number(beam.blur, 1.0, 1e3));
        Self {
            size,
            half,
            center: size.map(|pixels| pixels as f64 / 2.0),
            spot,
            reach: f64::from(REACH) * std::f64::consts::SQRT_2 * spot,
            dwell: number(beam.dot_length, 0.0, 1e3) * half / spot,
            peak: pixels(radius) / spot,
            contrast: number(beam.contrast, 0.0, 10.0),
        }
    }

    /// Where the beam goes for a stroke; `None` if it stays dark, or the stroke is not finite or too far away.
    #[inline(always)]
    pub fn beam(&self, stroke: &Stroke) -> Option<Deflection> {
        let near = |[x, y]: [f32; 2]| x.abs() <= FAR && y.abs() <= FAR;
        let [red, green, blue] = stroke.color;
        let all = stroke.intensity[0].is_finite() & stroke.intensity[1].is_finite();
        let finite = all & red.is_finite() & green.is_finite() & blue.is_finite();
        if !(near(stroke.start) && near(stroke.end) && finite) {
            return None;
        }
        let (mut start, mut end) = (self.in_pixels(stroke.start), self.in_pixels(stroke.end));
        let (mut first, mut last) = (self.current(stroke.intensity[0]), self.current(stroke.intensity[1]));
        if first <= 0.0 && last <= 0.0 {
            return None;
        }
        // The part of the stroke where the beam is cut off is left out.
        let toward =
            |from: [f64; 2], to: [f64; 2], part: f64| [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        if first < 0.0 {
            (start, first) = (toward(start, end, first / (first - last)), 0.0);
        } else if last < 0.0 {
            (end, last) = (toward(end, start, last / (last - first)), 0.0);
        }
        Some((start, end, [first, last]))
    }

    /// First and last column and row of the picture that the light of a stroke can reach; `None` if it reaches none.
    #[inline(always)]
    pub fn touched(&self, stroke: &Stroke) -> Option<[[usize; 2]; 2]> {
        let (start, end, _) = self.beam(stroke)?;
        let range = |axis: usize| {
            let (low, high) = if start[axis] < end[axis] { (start[axis], end[axis]) } else { (end[axis], start[axis]) };
            self.pixels(axis, low - self.reach, high + self.reach)
        };
        Some([range(0)?, range(1)?])
    }

    /// The columns of pixels that light of a stroke reaches, of that part of the stroke whose light can reach rows from
    /// `top` to `bottom`.
    pub fn columns_touched(&self, stroke: &Stroke, top: usize, bottom: usize) -> Option<[usize; 2]> {
        let (start, end, _) = self.beam(stroke)?;
        let dx = end[0] - start[0];
        let (high, low) = (top as f64 - self.reach, bottom as f64 + 1.0 + self.reach);
        let mut parts = [0.0, 1.0];
        between([start[1], end[1]], [high, low], &mut parts)?;
        let ends = parts.map(|part| start[0] + part * dx);
        self.pixels(0, ends[0].min(ends[1]) - self.reach, ends[0].max(ends[1]) + self.reach)
    }

    /// First and last position of the part of a stroke whose light can reach the picture; `None` if there is none.
    #[cfg(feature = "window")]
    pub fn clipped_to_picture(&self, start: [f64; 2], end: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let mut parts = [0.0, 1.0];
        for axis in [0, 1] {
            between([start[axis], end[axis]], [-self.reach, self.size[axis] as f64 + self.reach], &mut parts)?;
        }
        Some(parts.map(|part| [0, 1].map(|axis| start[axis] + part * (end[axis] - start[axis]))))
    }

    /// The pixels with centres from `low` to `high`, as far as the picture goes.
    #[inline(always)]
    fn pixels(&self, axis: usize, low: f64, high: f64) -> Option<[usize; 2]> {
        let end = (self.size[axis] - 1) as f64;
        let (low, high) = (low - 0.5, high - 0.5);
        (high >= 0.0 && low <= end).then(|| [low.max(0.0) as usize, high.min(end) as usize])
    }

    /// A position on the screen in pixels from the upper left corner of the picture.
    #[inline(always)]
    fn in_pixels(&self, [x, y]: [f32; 2]) -> [f64; 2] {
        [f64::from(x).mul_add(self.half, self.center[0]), f64::from(-y).mul_add(self.half, self.center[1])]
    }

    /// The current for an intensity: the full intensity stays, contrast moves the others.
    #[inline(always)]
    fn current(&self, intensity: f32) -> f64 {
        let intensity = f64::from(intensity.clamp(0.0, STRONGEST));
        let current = if self.contrast == 1.0 { intensity } else { 1.0 + self.contrast * (intensity - 1.0) };
        self.peak * current
    }
}

/// Narrows parts of a stroke, 0..=1, to those that lie between two bounds; `None` if none does.
///
/// - `ends`: a coordinate of its start and end; `bounds`: of the lower and the upper bound.
fn between(ends: [f64; 2], bounds: [f64; 2], parts: &mut [f64; 2]) -> Option<()> {
    let way = ends[1] - ends[0];
    if way == 0.0 {
        return (bounds[0] <= ends[0] && ends[0] <= bounds[1]).then_some(());
    }
    let cuts = bounds.map(|bound| (bound - ends[0]) / way);
    *parts = [parts[0].max(cuts[0].min(cuts[1])), parts[1].min(cuts[0].max(cuts[1]))];
    (parts[0] <= parts[1]).then_some(())
}
