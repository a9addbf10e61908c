//! Interval arithmetic with derivatives: the reference for bounds, slow and simple.

use super::form::Form;
use super::grid::HeightGrid;
use super::octave_sum::OctaveSum;
use super::octaves::{LANES, NoiseLattice, Octaves, remaining};
use std::ops::{Add, Mul, Sub};

/// All numbers between two, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Interval {
    /// A single number.
    pub fn point(value: f64) -> Interval {
        Interval { low: value, high: value }
    }

    /// All numbers between two.
    pub fn new(low: f64, high: f64) -> Interval {
        Interval { low, high }
    }

    /// Rounds both ends outwards.
    fn wider(self) -> Interval {
        let out = |end: f64| end.abs() * f64::EPSILON + f64::MIN_POSITIVE;
        Interval { low: self.low - out(self.low), high: self.high + out(self.high) }
    }

    /// Whether a number is in it.
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The middle.
    pub fn middle(&self) -> f64 {
        self.low + 0.5 * (self.high - self.low)
    }

    /// The smallest interval around both.
    pub fn hull(self, other: Interval) -> Interval {
        Interval { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What both have in common, if they have something; else the first one.
    pub fn common(self, other: Interval) -> Interval {
        let both = Interval { low: self.low.max(other.low), high: self.high.min(other.high) };
        if both.low <= both.high { both } else { self }
    }

    fn square(self) -> Interval {
        let (a, b) = (self.low * self.low, self.high * self.high);
        Interval { low: if self.contains(0.0) { 0.0 } else { a.min(b) }, high: a.max(b) }.wider()
    }

    /// An increasing function that rounds correctly.
    fn increasing(self, of: impl Fn(f64) -> f64) -> Interval {
        Interval { low: of(self.low), high: of(self.high) }
    }

    fn abs(self) -> Interval {
        let (a, b) = (self.low.abs(), self.high.abs());
        Interval { low: if self.contains(0.0) { 0.0 } else { a.min(b) }, high: a.max(b) }
    }
}

impl Add for Interval {
    type Output = Interval;

    fn add(self, other: Interval) -> Interval {
        Interval { low: self.low + other.low, high: self.high + other.high }.wider()
    }
}

impl Sub for Interval {
    type Output = Interval;

    fn sub(self, other: Interval) -> Interval {
        Interval { low: self.low - other.high, high: self.high - other.low }.wider()
    }
}

impl Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        let [a, b] = [self.low * other.low, self.low * other.high];
        let [c, d] = [self.high * other.low, self.high * other.high];
        Interval { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }.wider()
    }
}

/// A function over a rectangle: bounds of its values and of its derivatives by x and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundedSlopes {
    /// Its values.
    pub value: Interval,
    /// Its derivatives.
    pub slopes: [Interval; 2],
}

impl BoundedSlopes {
    /// The coordinates of a rectangle, as functions of the plane.
    pub fn rectangle(x: Interval, z: Interval) -> [BoundedSlopes; 2] {
        let [zero, one] = [0.0, 1.0].map(Interval::point);
        [BoundedSlopes { value: x, slopes: [one, zero] }, BoundedSlopes { value: z, slopes: [zero, one] }]
    }

    fn map(self, value: impl Fn(Interval) -> Interval, rate: Interval) -> BoundedSlopes {
        BoundedSlopes { value: value(self.value), slopes: self.slopes.map(|slope| slope * rate) }
    }

    /// A function of a place whose values and derivatives there are known, as one of the plane.
    fn chained(place: &[BoundedSlopes; 2], value: Interval, slopes: [Interval; 2]) -> BoundedSlopes {
        let along = |axis: usize| place[0].slopes[axis] * slopes[0] + place[1].slopes[axis] * slopes[1];
        BoundedSlopes { value, slopes: [along(0), along(1)] }
    }
}

fn sums(a: [Interval; 2], b: [Interval; 2]) -> [Interval; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

impl Add for BoundedSlopes {
    type Output = BoundedSlopes;

    fn add(self, other: BoundedSlopes) -> BoundedSlopes {
        BoundedSlopes { value: self.value + other.value, slopes: sums(self.slopes, other.slopes) }
    }
}

impl Mul for BoundedSlopes {
    type Output = BoundedSlopes;

    fn mul(self, other: BoundedSlopes) -> BoundedSlopes {
        let one = other.slopes.map(|slope| self.value * slope);
        let two = self.slopes.map(|slope| other.value * slope);
        BoundedSlopes { value: self.value * other.value, slopes: sums(one, two) }
    }
}

impl Form for BoundedSlopes {
    type Place = [BoundedSlopes; 2];

    fn constant(_: &Self::Place, value: f64) -> BoundedSlopes {
        BoundedSlopes { value: Interval::point(value), slopes: [Interval::point(0.0); 2] }
    }

    fn scaled(self, by: f64) -> BoundedSlopes {
        let by = Interval::point(by);
        self.map(|value| value * by, by)
    }

    fn abs(self) -> BoundedSlopes {
        let sign = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
        let rate = Interval::new(sign(self.value.low), sign(self.value.high));
        self.map(Interval::abs, rate)
    }

    fn at_least(self, least: f64) -> BoundedSlopes {
        let is_above = |value: f64| f64::from(u8::from(value >= least));
        let rate = Interval::new(is_above(self.value.low), is_above(self.value.high));
        self.map(|value| value.increasing(|value| value.max(least)), rate)
    }

    fn at_most(self, most: f64) -> BoundedSlopes {
        let is_below = |value: f64| f64::from(u8::from(value <= most));
        let rate = Interval::new(is_below(self.value.high), is_below(self.value.low));
        self.map(|value| value.increasing(|value| value.min(most)), rate)
    }

    fn noise(octaves: &Octaves, first: usize, place: &Self::Place) -> [BoundedSlopes; LANES] {
        std::array::from_fn(|lane| {
            let octave = first + lane;
            if octave < octaves.count() {
                noise_of(&octaves.lattice(octave), place)
            } else {
                BoundedSlopes::constant(place, 0.0)
            }
        })
    }

    fn octave_sum(sum: &OctaveSum, place: &Self::Place, footprint: f64) -> BoundedSlopes {
        let octaves = &sum.octaves;
        let one = |octave: usize| {
            let left = if footprint > 0.0 { remaining(footprint * octaves.frequencies[octave]) } else { 1.0 };
            noise_of(&octaves.lattice(octave), place).scaled(sum.amplitudes[octave] * left)
        };
        (0..octaves.count()).map(one).fold(BoundedSlopes::constant(place, 0.0), |a, b| a + b)
    }

    fn grid(grid: &HeightGrid, place: &Self::Place) -> BoundedSlopes {
        let [x, z] = [place[0].value, place[1].value];
        let (value, slopes) = grid.over([x.low, z.low], [x.high, z.high]);
        let interval = |[low, high]: [f64; 2]| Interval::new(low, high);
        BoundedSlopes::chained(place, interval(value), slopes.map(interval))
    }

    fn moved(place: &Self::Place, by: [BoundedSlopes; 2]) -> Self::Place {
        [place[0] + by[0], place[1] + by[1]]
    }

    fn of_plane(self, _: &Self::Place) -> BoundedSlopes {
        self
    }
}

/// Noise over a place that functions moved, cell by cell where it lies over few of them.
fn noise_of(lattice: &NoiseLattice, place: &[BoundedSlopes; 2]) -> BoundedSlopes {
    const MOST_CELLS: f64 = 3.0;
    let [x, z] = [place[0].value, place[1].value];
    let [cosine, sine] = [lattice.cosine, lattice.sine].map(Interval::point);
    let p = [
        x * cosine - z * sine + Interval::point(lattice.shift.x),
        x * sine + z * cosine + Interval::point(lattice.shift.y),
    ];
    let width = p.map(|axis| axis.high - axis.low);
    let (value, along) = if width[0].max(width[1]) > MOST_CELLS {
        // Weights of corners times lengths of gradients, and what their slopes may add.
        (Interval::new(-1.001, 1.001), [Interval::new(-3.0, 3.0); 2])
    } else {
        let floors = p.map(|axis| [axis.low.floor(), axis.high.floor()]);
        let mut all: Option<[Interval; 3]> = None;
        let mut row = floors[1][0];
        while row <= floors[1][1] {
            let mut column = floors[0][0];
            while column <= floors[0][1] {
                let within = |axis: Interval, cell: f64| (axis - Interval::point(cell)).common(Interval::new(0.0, 1.0));
                let found = noise_in_cell(
                    lattice.gradients([column as i64, row as i64]),
                    [within(p[0], column), within(p[1], row)],
                );
                all = Some(all.map_or(found, |all| std::array::from_fn(|k| all[k].hull(found[k]))));
                column += 1.0;
            }
            row += 1.0;
        }
        let [value, a, b] = all.unwrap_or([Interval::point(0.0); 3]);
        (value, [a, b])
    };
    let slopes = [cosine * along[0] + sine * along[1], cosine * along[1] - sine * along[0]];
    BoundedSlopes::chained(place, value, slopes)
}

/// Values and slopes of noise over a part of a cell, as they are and by the slopes from the middle.
fn noise_in_cell(gradients: [[f64; 2]; 4], [x, z]: [Interval; 2]) -> [Interval; 3] {
    let over = noise_plainly(gradients, [x, z]);
    let (mx, mz) = (Interval::point(x.middle()), Interval::point(z.middle()));
    let middle = noise_plainly(gradients, [mx, mz])[0];
    let by_slopes = middle + over[1] * (x - mx) + over[2] * (z - mz);
    [over[0].common(by_slopes), over[1], over[2]]
}

/// The formula of the noise: corners by their weights, which are products of one function of each axis.
fn noise_plainly(gradients: [[f64; 2]; 4], [x, z]: [Interval; 2]) -> [Interval; 3] {
    let n = Interval::point;
    let fade = |t: Interval| {
        // It rises: its ends are those of the interval.
        let at = |t: f64| {
            let t = n(t);
            t * t * t * (t * (t * n(6.0) - n(15.0)) + n(10.0))
        };
        at(t.low).hull(at(t.high))
    };
    let fade_slope = |t: Interval| n(30.0) * (t * (n(1.0) - t)).common(n(0.25) - (t - n(0.5)).square()).square();
    let weights = |t: Interval| [n(1.0) - fade(t), fade(t)];
    let rates = |t: Interval| [n(0.0) - fade_slope(t), fade_slope(t)];
    let (wx, wz, rx, rz) = (weights(x), weights(z), rates(x), rates(z));
    let mut sums = [n(0.0); 3];
    for (corner, gradient) in gradients.iter().enumerate() {
        let (i, j) = (corner % 2, corner / 2);
        let height = n(gradient[0]) * (x - n(i as f64)) + n(gradient[1]) * (z - n(j as f64));
        let weight = wx[i] * wz[j];
        sums[0] = sums[0] + weight * height;
        sums[1] = sums[1] + rx[i] * wz[j] * height + weight * n(gradient[0]);
        sums[2] = sums[2] + wx[i] * rz[j] * height + weight * n(gradient[1]);
    }
    sums
}
