//! One stroke on its way over the pixels.

use super::FAR;
use super::spot::{self, REACH};
use crate::traversal::Stroke;

/// Pixels are written in multiples of this number, into room beyond the last one if need be.
pub(super) const LANES: usize = 8;
/// Below this length, in spots, a stroke is the moments of its current around its middle: the difference of
/// two error functions would be all rounding. The first term left out is 1e-7 of the stroke's light here.
const SHORT: f64 = 0.25;

/// The pixels and the spot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    /// Width and height in pixels.
    pub size: usize,
    /// Half of it.
    pub half: f64,
    /// Standard deviation of the spot in pixels.
    pub spot: f64,
    /// Length, in spots, that takes as long to write as a dot.
    pub dwell: f64,
}

impl Screen {
    /// First and last row, counted from the top, that the light of a stroke can reach; `None` if it reaches
    /// no row, or is not drawn at all.
    pub fn rows_touched(&self, stroke: &Stroke) -> Option<(usize, usize)> {
        let drawable = [stroke.start, stroke.end].iter().flatten().all(|place| place.abs() <= FAR)
            && stroke.intensity.iter().chain(&stroke.color).all(|part| part.is_finite())
            && (stroke.intensity[0] > 0.0 || stroke.intensity[1] > 0.0);
        if !drawable {
            return None;
        }
        let reach = f64::from(REACH) * std::f64::consts::SQRT_2 * self.spot;
        let (start, end) = (self.place(stroke.start)[1], self.place(stroke.end)[1]);
        let (top, bottom) = (start.min(end) - reach - 0.5, start.max(end) + reach - 0.5);
        let last = self.size as f64 - 1.0;
        (bottom >= 0.0 && top <= last).then(|| (top.max(0.0) as usize, bottom.min(last) as usize))
    }

    /// A place on the screen in pixels from the upper left corner.
    fn place(&self, [x, y]: [f32; 2]) -> [f64; 2] {
        [(f64::from(x) + 1.0) * self.half, (1.0 - f64::from(y)) * self.half]
    }
}

/// A stroke in pixels, ready to be written.
///
/// u is the distance along it from its start, v that across, both in spots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    size: usize,
    start: [f64; 2],
    /// Growth of u for one pixel to the right and one downwards: the direction over the spot.
    step: [f64; 2],
    /// Pixels to the right for a growth of one spot of u, and of -v; 0 if there is none.
    widths: [f64; 2],
    /// In spots.
    length: f64,
    current: Current,
    color: [f32; 3],
    rows: (usize, usize),
}

/// How the light depends on u.
#[derive(Clone, Copy, Debug)]
enum Current {
    /// A dot, or a stroke so short that it is one: times this polynomial of the distance from the middle.
    Point([f32; 5]),
    /// Both ends may act on the same pixel. Current at the start, gain per spot.
    Both(f32, f32),
    /// At least two reaches long, so that only the nearer end acts.
    Nearer(f32, f32),
}

impl Track {
    /// Prepares a stroke; `None` if it leaves no light on the screen.
    pub fn new(screen: &Screen, stroke: &Stroke) -> Option<Self> {
        let rows = screen.rows_touched(stroke)?;
        let (start, end) = (screen.place(stroke.start), screen.place(stroke.end));
        let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
        let pixels = (dx * dx + dy * dy).sqrt();
        let length = pixels / screen.spot;
        let step = if pixels > 0.0 {
            [dx / pixels / screen.spot, dy / pixels / screen.spot]
        } else {
            [1.0 / screen.spot, 0.0]
        };
        let [first, last] = stroke.intensity.map(|intensity| f64::from(intensity.max(0.0)));
        let gain = (last - first) / length;
        let current = if stroke.is_dot() {
            Current::Point([(screen.dwell * (first + last) / 2.0) as f32, 0.0, 0.0, 0.0, 0.0])
        } else if length < SHORT {
            Current::Point(moments(length, first, last))
        } else if length < 2.0 * f64::from(REACH) {
            Current::Both(first as f32, gain as f32)
        } else {
            Current::Nearer(first as f32, gain as f32)
        };
        let widths = step.map(|step| if step.abs() > 1e-9 { step.recip() } else { 0.0 });
        let color = stroke.color.map(|part| part.max(0.0));
        Some(Self { size: screen.size, start, step, widths, length, current, color, rows })
    }

    /// Adds the light to `rows` of `row` floats each, the first of which is row `top` of the screen.
    #[inline(always)]
    pub fn write(&self, rows: &mut [f32], row: usize, top: usize) {
        let first = self.rows.0.max(top) - top;
        for (offset, pixels) in rows.chunks_exact_mut(row).enumerate().skip(first) {
            let y = top + offset;
            if y > self.rows.1 {
                break;
            }
            // u and v at the centre of the pixel in column 0, in double precision: columns may be far away.
            let (across, down) = (0.5 - self.start[0], y as f64 + 0.5 - self.start[1]);
            let u = across * self.step[0] + down * self.step[1];
            let v = down * self.step[0] - across * self.step[1];
            let Some((mut column, last)) = self.columns(u, v) else { continue };
            while column <= last {
                let from_start = u + column as f64 * self.step[0];
                let lanes = Lanes {
                    u: from_start as f32,
                    rest: (self.length - from_start) as f32,
                    v: (v - column as f64 * self.step[1]) as f32,
                    along: self.step[0] as f32,
                    down: self.step[1] as f32,
                };
                self.add(&lanes, pixels, column);
                column += LANES;
            }
        }
    }

    /// Adds the light of eight pixels to a row, from `column` on.
    #[inline(always)]
    fn add(&self, lanes: &Lanes, row: &mut [f32], column: usize) {
        match self.current {
            Current::Point(terms) => self.add_profile(Point { terms }, lanes, row, column),
            Current::Both(current, gain) => self.add_profile(Between { current, gain }, lanes, row, column),
            Current::Nearer(current, gain) if lanes.clear_of_ends() => {
                self.add_profile(Interior { current, gain }, lanes, row, column);
            }
            Current::Nearer(current, gain) => self.add_profile(NearEnd { current, gain }, lanes, row, column),
        }
    }

    /// Adds the light of a profile in the stroke's colour.
    #[inline(always)]
    fn add_profile(&self, profile: impl Profile, lanes: &Lanes, row: &mut [f32], column: usize) {
        let light = lanes.light(profile);
        let stride = row.len() / 3;
        add_channel(&light, self.color[0], &mut row[column..]);
        add_channel(&light, self.color[1], &mut row[stride + column..]);
        add_channel(&light, self.color[2], &mut row[2 * stride + column..]);
    }

    /// First and last column of a row whose column 0 has these u and v that light can reach.
    #[inline(always)]
    fn columns(&self, u: f64, v: f64) -> Option<(usize, usize)> {
        let reach = f64::from(REACH);
        let (mut low, mut high) = (0.0, self.size as f64 - 1.0);
        // -reach <= u + step[0] x <= length + reach, and -reach <= step[1] x - v <= reach.
        for (value, width, length) in [(u, self.widths[0], self.length), (-v, self.widths[1], 0.0)] {
            let (nearest, farthest) = (-reach - value, length + reach - value);
            if width != 0.0 {
                let (one, other) = (nearest * width, farthest * width);
                let (left, right) = if width > 0.0 { (one, other) } else { (other, one) };
                low = if left > low { left } else { low };
                high = if right < high { right } else { high };
            } else if nearest > 0.0 || farthest < 0.0 {
                return None;
            }
        }
        if high < low {
            return None;
        }
        // Inwards to whole pixels; 0 <= low <= high < size.
        let (first, last) = (low as usize, high as usize);
        let first = if (first as f64) < low { first + 1 } else { first };
        (first <= last).then_some((first, last))
    }
}

/// Adds light in one colour to the first eight pixels of a channel.
#[inline(always)]
fn add_channel(light: &[f32; LANES], color: f32, channel: &mut [f32]) {
    if let Some(pixels) = channel.first_chunk_mut::<LANES>() {
        let mut sum = *pixels;
        for (sum, light) in sum.iter_mut().zip(light) {
            *sum += light * color;
        }
        *pixels = sum;
    }
}

/// How the light of a pixel follows from its distances from the start, from the end and across, in spots.
///
/// A trait and not a closure, which could not be told to be inlined everywhere.
trait Profile {
    /// Light for the colour 1.
    fn light(&self, u: f32, rest: f32, v: f32) -> f32;
}

/// A dot or a short stroke with the coefficients of [`moments`].
struct Point {
    terms: [f32; 5],
}

impl Profile for Point {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        let middle = (u - rest) * 0.5;
        let square = middle * middle;
        let even = self.terms[0] + (self.terms[2] + self.terms[4] * square) * square;
        let odd = self.terms[1] + self.terms[3] * square;
        spot::dot(middle, v) * (even + odd * middle)
    }
}

/// A stroke of any length.
struct Between {
    current: f32,
    gain: f32,
}

impl Profile for Between {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        let (since_start, rise_start) = spot::along(u);
        let (until_end, rise_end) = spot::along(rest);
        // written(-rest) = 1 - written(rest), rise(-rest) = rise(rest).
        let written = since_start + until_end - 1.0;
        let light = (self.current + self.gain * u) * written + self.gain * (rise_start - rise_end);
        spot::greater(light, 0.0) * spot::across(v)
    }
}

/// A stroke at least two reaches long: only the nearer end acts.
struct NearEnd {
    current: f32,
    gain: f32,
}

impl Profile for NearEnd {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        let (written, rise) = spot::along(spot::lesser(u, rest));
        // Towards the end it is a fall.
        let fall = -rise;
        let rise = if u < rest { rise } else { fall };
        let light = (self.current + self.gain * u) * written + self.gain * rise;
        spot::greater(light, 0.0) * spot::across(v)
    }
}

/// A stroke whose ends are out of reach.
struct Interior {
    current: f32,
    gain: f32,
}

impl Profile for Interior {
    #[inline(always)]
    fn light(&self, u: f32, _rest: f32, v: f32) -> f32 {
        (self.current + self.gain * u) * spot::across(v)
    }
}

/// Eight neighbouring pixels of a row.
struct Lanes {
    /// Of the first pixel, in spots: distance from the start, from the end (both positive inside), and across.
    u: f32,
    rest: f32,
    v: f32,
    /// Growth of u for a pixel to the right, and fall of v.
    along: f32,
    down: f32,
}

impl Lanes {
    /// Light of each pixel.
    #[inline(always)]
    fn light(&self, profile: impl Profile) -> [f32; LANES] {
        let mut lights = [0.0; LANES];
        for (lane, value) in lights.iter_mut().enumerate() {
            let right = lane as f32;
            let (along, down) = (right * self.along, right * self.down);
            *value = profile.light(self.u + along, self.rest - along, self.v - down);
        }
        lights
    }

    /// Whether no end of the stroke reaches any of the pixels.
    #[inline(always)]
    fn clear_of_ends(&self) -> bool {
        let along = (LANES - 1) as f32 * self.along;
        spot::lesser(self.u, self.u + along) >= REACH && spot::lesser(self.rest, self.rest - along) >= REACH
    }
}

/// Coefficients, in the distance m from the middle, of the light of a short stroke over that of a dot.
///
/// Taylor series of the Gaussian around the middle, integrated over the stroke of length l with the current
/// c + k t, t = -l/2..l/2:
/// c l (1 + l^2 (m^2 - 1) / 24 + l^4 (m^4 - 6 m^2 + 3) / 1920) + k (l^3 m / 12 + l^5 (m^3 - 3 m) / 480).
fn moments(length: f64, first: f64, last: f64) -> [f32; 5] {
    let square = length * length;
    let even = length * (first + last) / 2.0;
    let odd = square * (last - first);
    [
        even * (1.0 - square / 24.0 + square * square / 640.0),
        odd * (1.0 / 12.0 - square / 160.0),
        even * (square / 24.0 - square * square / 320.0),
        odd * square / 480.0,
        even * square * square / 1920.0,
    ]
    .map(|term| term as f32)
}
