//! One stroke on its way over the pixels of a tile.

use super::optics::Optics;
use super::spot::{self, REACH, greater, lesser};
use super::tile::{LANES, PLANE, STRIDE, TILE_HEIGHT, TILE_WIDTH};
use crate::traversal::Stroke;

/// How many of these multiples, from any rows, are computed together: the widest instructions hold two.
const TOGETHER: usize = 2;
/// Rows that are looked at together.
const BLOCK: usize = 16;
/// Capacity for the rows of a tile, for a block of them that begins at the last, and, as the very last, one without
/// light.
const ROWS: usize = 2 * TILE_HEIGHT;
/// Below this length, in spots, a stroke is the moments of its current around its middle: the difference of
/// two error functions would be all rounding. The first term left out is 1e-7 of the stroke's light here.
const SHORT: f64 = 0.25;
/// Most groups of eight pixels of a tile, and some that are not counted.
const MAX_GROUPS: usize = TILE_HEIGHT * TILE_WIDTH / LANES + TOGETHER;
/// What a row counts in an entry of the list; more than its columns.
const ROW: u16 = 256;
/// Stands for the pixels per spot along a row where the direction makes them infinitely many.
const ENDLESS: f32 = 1e9;

/// A stroke as a tile sees it, ready to be written.
///
/// u is the distance along it from its start, v that across, both in spots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    /// u at the centre of the tile's first pixel.
    pub u: f32,
    /// Distance from there to the end.
    pub to_end: f32,
    /// v there.
    pub v: f32,
    /// Growth of u for one pixel to the right and one downwards: the direction over the spot.
    pub step: [f32; 2],
    /// In spots.
    length: f32,
    pub current: Current,
    pub color: [f32; 3],
    /// First and last row of the tile that light can reach.
    rows: [usize; 2],
}

/// How the light depends on u.
#[derive(Clone, Copy, Debug)]
pub(super) enum Current {
    /// A dot, or a stroke so short that it is one: times this polynomial of the distance from the middle.
    Point([f32; 5]),
    /// Both ends may act on the same pixel. Current at the start, gain per spot.
    Both(f32, f32),
    /// At least two reaches long, so that only the nearer end acts.
    Nearer(f32, f32),
}

impl Track {
    /// Prepares a stroke for the tile whose upper left corner is at a pixel; `None` if no light reaches it.
    #[inline(always)]
    pub fn new(optics: &Optics, stroke: &Stroke, [left, top]: [usize; 2]) -> Option<Self> {
        let (start, end, [first, last]) = optics.beam(stroke)?;
        let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
        let pixels = (dx * dx + dy * dy).sqrt();
        let per_pixel = 1.0 / optics.spot;
        let length = pixels * per_pixel;
        let step = if pixels > 0.0 {
            let unit = per_pixel / pixels;
            [dx * unit, dy * unit]
        } else {
            [per_pixel, 0.0]
        };
        let current = if stroke.is_dot() {
            Current::Point([(optics.dwell * (first + last) / 2.0) as f32, 0.0, 0.0, 0.0, 0.0])
        } else if length < SHORT {
            Current::Point(moments(length, first, last))
        } else {
            let (current, gain) = (first as f32, ((last - first) / length) as f32);
            let near = length < 2.0 * f64::from(REACH);
            if near { Current::Both(current, gain) } else { Current::Nearer(current, gain) }
        };
        // In double precision: the ends may be far away.
        let (across, down) = (left as f64 + 0.5 - start[0], top as f64 + 0.5 - start[1]);
        let u = across * step[0] + down * step[1];
        let v = down * step[0] - across * step[1];
        let (high, low) = if dy < 0.0 { (end[1], start[1]) } else { (start[1], end[1]) };
        let (first_row, last_row) = (high - optics.reach - top as f64 - 0.5, low + optics.reach - top as f64 - 0.5);
        if last_row < 0.0 || first_row > (TILE_HEIGHT - 1) as f64 {
            return None;
        }
        let color = |gun: usize| lesser(greater(stroke.color[gun], 0.0), super::STRONGEST);
        Some(Self {
            u: u as f32,
            to_end: (length - u) as f32,
            v: v as f32,
            step: [step[0] as f32, step[1] as f32],
            length: length as f32,
            current,
            color: [color(0), color(1), color(2)],
            rows: [first_row.max(0.0) as usize, last_row.min((TILE_HEIGHT - 1) as f64) as usize],
        })
    }

    /// Notes the pixels that light can reach.
    #[inline(always)]
    pub fn find(&self, scratch: &mut Scratch) {
        self.compute_rows(&mut scratch.rows);
        scratch.count = self.list(&scratch.rows, &mut scratch.groups);
    }

    /// Adds the light to the planes of a tile, one, or three for red, green and blue, after [`Track::find`].
    #[inline(always)]
    pub fn write(&self, scratch: &Scratch, planes: &mut [f32]) {
        let (planes, _) = planes.as_chunks_mut();
        if let [plane] = planes {
            self.draw(scratch, std::array::from_mut(plane));
        } else if let Some(planes) = planes.first_chunk_mut::<3>() {
            self.draw(scratch, planes);
        }
    }

    #[inline(always)]
    fn draw<const GUNS: usize>(&self, scratch: &Scratch, planes: &mut [[f32; PLANE]; GUNS]) {
        match self.current {
            Current::Point(terms) => self.fill(scratch, planes, Point { terms }),
            Current::Both(current, 0.0) => self.fill(scratch, planes, EvenBetween { current }),
            Current::Both(current, gain) => self.fill(scratch, planes, Between { current, gain }),
            Current::Nearer(current, 0.0) => self.fill(scratch, planes, EvenLong { current }),
            Current::Nearer(current, gain) => self.fill(scratch, planes, Long { current, gain }),
        }
    }

    #[inline(always)]
    fn fill<const GUNS: usize>(
        &self,
        Scratch { rows, groups: places, count }: &Scratch,
        planes: &mut [[f32; PLANE]; GUNS],
        profile: impl Profile,
    ) {
        let (together, _) = places[..count.next_multiple_of(TOGETHER)].as_chunks::<TOGETHER>();
        for groups in together {
            let [mut u, mut rest, mut v] = [[[0.0; LANES]; TOGETHER]; 3];
            for (eight, packed) in groups.iter().enumerate() {
                // The remainders change nothing and spare the checks of what follows.
                let (y, column) = (usize::from(packed / ROW) % ROWS, usize::from(packed % ROW) % TILE_WIDTH);
                let (row_u, row_rest, row_v) = (rows.u[y], rows.rest[y], rows.v[y]);
                for (lane, right) in COLUMNS[column..column + LANES].iter().enumerate() {
                    u[eight][lane] = right.mul_add(self.step[0], row_u);
                    rest[eight][lane] = right.mul_add(-self.step[0], row_rest);
                    v[eight][lane] = right.mul_add(-self.step[1], row_v);
                }
            }
            let mut light = [[0.0; LANES]; TOGETHER];
            let distances = u.as_flattened().iter().zip(rest.as_flattened()).zip(v.as_flattened());
            for (light, ((u, rest), v)) in light.as_flattened_mut().iter_mut().zip(distances) {
                *light = profile.light(*u, *rest, *v);
            }
            for (packed, light) in groups.iter().zip(&light) {
                let (y, column) = (usize::from(packed / ROW) % TILE_HEIGHT, usize::from(packed % ROW) % TILE_WIDTH);
                let place = y * STRIDE + column;
                for (plane, color) in planes.iter_mut().zip(self.color) {
                    // A single gun draws every colour alike.
                    let strength = if GUNS == 1 { 1.0 } else { color };
                    for (sum, light) in plane[place..place + LANES].iter_mut().zip(light) {
                        *sum = light.mul_add(strength, *sum);
                    }
                }
            }
        }
    }

    /// Notes row (times [`ROW`]) and column of the first of every eight pixels that light can reach; returns how many
    /// eights there are.
    ///
    /// A list, because the processor can foresee the way through it, and not where in each row the light ends.
    #[inline(always)]
    fn list(&self, rows: &Rows, groups: &mut [u16; MAX_GROUPS]) -> usize {
        let mut count = 0;
        let range = self.rows[0]..self.rows[1] + 1;
        for (first, eights) in rows.first[range.clone()].iter().zip(&rows.eights[range]) {
            // Two are noted always, and counted if they are there.
            let Some([one, other]) = groups[count..].first_chunk_mut() else { break };
            (*one, *other) = (*first as u16, *first as u16 + LANES as u16);
            let eights = *eights as usize;
            for eight in 2..eights {
                groups[count + eight] = *first as u16 + (eight * LANES) as u16;
            }
            count += eights;
        }
        // What is missing in the last of those computed together lies where no light is.
        if let Some(rest) = groups[count..].first_chunk_mut::<{ TOGETHER - 1 }>() {
            *rest = [(ROWS as u16 - 1) * ROW; TOGETHER - 1];
        }
        count
    }

    /// Finds what is the same for all pixels of a row, many rows at a time, for the rows that light can reach.
    #[inline(always)]
    fn compute_rows(&self, rows: &mut Rows) {
        // -reach <= u + step[0] x <= length + reach, and -reach <= v - step[1] x <= reach.
        let width = |step: f32| if step.abs() > 1.0 / ENDLESS { step.recip() } else { ENDLESS };
        let (along, across) = (width(self.step[0]), width(self.step[1]));
        for top in (self.rows[0]..self.rows[1] + 1).step_by(BLOCK) {
            let [mut us, mut rests, mut vs] = [[0.0; BLOCK]; 3];
            let [mut firsts, mut counts] = [[0; BLOCK]; 2];
            for lane in 0..BLOCK {
                let y = (top + lane) as i32;
                let down = y as f32;
                let u = down.mul_add(self.step[1], self.u);
                let v = down.mul_add(self.step[0], self.v);
                let (one, other) = ((-REACH - u) * along, (self.length + REACH - u) * along);
                let (third, fourth) = ((v - REACH) * across, (v + REACH) * across);
                let low = greater(lesser(one, other), lesser(third, fourth));
                let high = lesser(greater(one, other), greater(third, fourth));
                // Inwards to whole pixels.
                let begin = whole(greater(lesser(low, TILE_WIDTH as f32), 0.0) + 0.499);
                let end = whole(greater(lesser(high, (TILE_WIDTH - 1) as f32), -1.0) - 0.499);
                let eights = (end - begin + LANES as i32) >> LANES.ilog2();
                firsts[lane] = y * i32::from(ROW) + begin;
                counts[lane] = if eights > 0 { eights } else { 0 };
                us[lane] = u;
                rests[lane] = down.mul_add(-self.step[1], self.to_end);
                vs[lane] = v;
            }
            rows.first[top..top + BLOCK].copy_from_slice(&firsts);
            rows.eights[top..top + BLOCK].copy_from_slice(&counts);
            rows.u[top..top + BLOCK].copy_from_slice(&us);
            rows.rest[top..top + BLOCK].copy_from_slice(&rests);
            rows.v[top..top + BLOCK].copy_from_slice(&vs);
        }
    }
}

/// The numbers of the columns of a tile, and of the padding beyond.
const COLUMNS: [f32; STRIDE] = {
    let mut columns = [0.0; STRIDE];
    let mut column = 0;
    while column < STRIDE {
        columns[column] = column as f32;
        column += 1;
    }
    columns
};

/// Scratch for what is noted of a stroke before it is written; what was noted before does not matter.
pub(super) struct Scratch {
    rows: Rows,
    groups: [u16; MAX_GROUPS],
    /// How many of them count.
    count: usize,
}

impl Scratch {
    /// Nothing noted.
    pub const fn new() -> Self {
        let rows = Rows { first: [0; ROWS], eights: [0; ROWS], u: [0.0; ROWS], rest: [0.0; ROWS], v: [ENDLESS; ROWS] };
        Self { rows, groups: [0; MAX_GROUPS], count: 0 }
    }
}

/// What is the same for all pixels of a row of a tile, row after row.
struct Rows {
    /// Where the light begins, as in [`Track::list`].
    first: [i32; ROWS],
    /// How many times eight pixels it can reach from there.
    eights: [i32; ROWS],
    /// u at the first pixel, distance from there to the end, and v.
    u: [f32; ROWS],
    rest: [f32; ROWS],
    v: [f32; ROWS],
}

/// The whole number next to one that is much less than 2^22. One addition, unlike a cast.
#[inline(always)]
fn whole(x: f32) -> i32 {
    /// 1.5 * 2^23: adding it rounds to a whole number and leaves that in the low bits.
    const ROUND: f32 = 12_582_912.0;
    (x + ROUND).to_bits() as i32 - ROUND.to_bits() as i32
}

/// How the light of a pixel follows from its distances from the start, from the end and across, in spots.
///
/// A trait and not a closure, which could not be forced inline everywhere.
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
        let even = self.terms[4].mul_add(square, self.terms[2]).mul_add(square, self.terms[0]);
        let odd = self.terms[3].mul_add(square, self.terms[1]);
        greater(spot::dot(middle, v) * odd.mul_add(middle, even), 0.0)
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
        // written(-rest) = 1 - written(rest), rise(-rest) = rise(rest).
        let (start, end) = (spot::within(u), spot::within(rest));
        let written = spot::half_written(start) + spot::half_written(end);
        let rise = spot::rise(start) - spot::rise(end);
        let light = self.gain.mul_add(rise, self.gain.mul_add(u, self.current) * written);
        greater(light, 0.0) * spot::across(v)
    }
}

/// A stroke of any length with an even current.
struct EvenBetween {
    current: f32,
}

impl Profile for EvenBetween {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        let written = spot::half_written(spot::within(u)) + spot::half_written(spot::within(rest));
        greater(self.current * written, 0.0) * spot::across(v)
    }
}

/// A stroke at least two reaches long: only the nearer end acts.
struct Long {
    current: f32,
    gain: f32,
}

impl Profile for Long {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        let nearer = spot::within(lesser(u, rest));
        // Towards the end it is a fall.
        let gain = if u < rest { self.gain } else { -self.gain };
        let light =
            gain.mul_add(spot::rise(nearer), self.gain.mul_add(u, self.current) * (0.5 + spot::half_written(nearer)));
        greater(light, 0.0) * spot::across(v)
    }
}

/// A stroke at least two reaches long with an even current: only the nearer end acts.
struct EvenLong {
    current: f32,
}

impl Profile for EvenLong {
    #[inline(always)]
    fn light(&self, u: f32, rest: f32, v: f32) -> f32 {
        greater(self.current * (0.5 + spot::half_written(spot::within(lesser(u, rest)))), 0.0) * spot::across(v)
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
