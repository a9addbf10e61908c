//! What a height function is computed with: numbers with bounds, of one kind or another.

use super::enclosure::Enclosure;
use super::grid::HeightGrid;
use super::octave_sum::OctaveSum;
use super::octaves::{LANES, MOST_BEND, MOST_NOISE, MOST_SLOPE, NOISE_ROUNDING, Octaves, PLACE_ROUNDING, WIDEST};
use glam::DVec2;
use std::ops::{Add, Mul};

/// Numbers with bounds that hold over a part of the plane. The formulas of all kinds of terrain are written once for
/// all of these.
pub(super) trait Form: Copy + Add<Output = Self> + Mul<Output = Self> {
    /// The part of the plane, perhaps moved by functions.
    type Place;

    /// A number.
    fn constant(place: &Self::Place, value: f64) -> Self;

    /// The product with a number.
    fn scaled(self, by: f64) -> Self;

    /// The absolute value.
    fn abs(self) -> Self;

    /// It, but not below a number.
    fn at_least(self, least: f64) -> Self;

    /// It, but not above a number.
    fn at_most(self, most: f64) -> Self;

    /// Noise of the octaves `first..first + 4`, as functions of the coordinates of the place.
    fn noise(octaves: &Octaves, first: usize, place: &Self::Place) -> [Self; LANES];

    /// Octaves of noise, each times its amplitude.
    fn octave_sum(sum: &OctaveSum, place: &Self::Place, footprint: f64) -> Self;

    /// A grid of heights.
    fn grid(grid: &HeightGrid, place: &Self::Place) -> Self;

    /// The place, moved along x and z.
    fn moved(place: &Self::Place, by: [Self; 2]) -> Self::Place;

    /// A function of the coordinates of a place as one of the plane.
    fn of_plane(self, place: &Self::Place) -> Self;
}

/// A disc of the plane and where functions move it.
#[derive(Clone, Debug)]
pub(super) struct Disc {
    /// Where its middle comes to be.
    pub(super) at: DVec2,
    /// Its points come to be within this distance of that.
    pub(super) reach: f64,
    /// The coordinates where it is moved, as functions of the plane; none where they are those of the plane.
    moved: Option<[Enclosure; 2]>,
    radius: f64,
}

impl Disc {
    pub(super) fn new(at: DVec2, radius: f64) -> Disc {
        Disc { at, reach: radius, moved: None, radius }
    }

    /// A disc so large that no octave of noise is known over it.
    pub(super) fn everywhere() -> Disc {
        const RADIUS: f64 = 1e12;
        Disc::new(DVec2::ZERO, RADIUS)
    }
}

impl Form for Enclosure {
    type Place = Disc;

    fn constant(place: &Disc, value: f64) -> Enclosure {
        Enclosure::constant(value, place.reach)
    }

    fn scaled(self, by: f64) -> Enclosure {
        Enclosure::scaled(self, by)
    }

    fn abs(self) -> Enclosure {
        Enclosure::abs(self)
    }

    fn at_least(self, least: f64) -> Enclosure {
        Enclosure::at_least(self, least)
    }

    fn at_most(self, most: f64) -> Enclosure {
        Enclosure::at_most(self, most)
    }

    fn noise(octaves: &Octaves, first: usize, place: &Disc) -> [Enclosure; LANES] {
        let radius = place.reach;
        let unknown = |frequency: f64| Enclosure {
            value: 0.0,
            slope: DVec2::ZERO,
            error: MOST_NOISE,
            slope_error: MOST_SLOPE * frequency,
            radius,
        };
        let frequencies = &octaves.frequencies[first..first + LANES];
        if frequencies[0] * radius > WIDEST {
            return std::array::from_fn(|lane| unknown(frequencies[lane]));
        }
        let noise = octaves.noise_at(first, place.at);
        let far = place.at.x.abs() + place.at.y.abs();
        std::array::from_fn(|lane| {
            let frequency = frequencies[lane];
            let part = frequency * radius;
            if part > WIDEST {
                return unknown(frequency);
            }
            Enclosure {
                value: noise.value.0[lane],
                slope: DVec2::new(noise.slopes[0].0[lane], noise.slopes[1].0[lane]),
                error: 0.5 * MOST_BEND * part * part + NOISE_ROUNDING + PLACE_ROUNDING * frequency * far,
                slope_error: MOST_BEND * frequency * part
                    + frequency * (NOISE_ROUNDING + frequency * far * PLACE_ROUNDING) * 8.0,
                radius,
            }
        })
    }

    fn octave_sum(sum: &OctaveSum, place: &Disc, footprint: f64) -> Enclosure {
        sum.enclosure(place.at, place.reach, footprint)
    }

    fn grid(grid: &HeightGrid, place: &Disc) -> Enclosure {
        grid.enclosure(place.at, place.reach)
    }

    fn moved(place: &Disc, by: [Enclosure; 2]) -> Disc {
        let radius = place.radius;
        let own = || {
            let of = |value: f64, slope: DVec2| Enclosure { slope, ..Enclosure::constant(value, radius) };
            [of(place.at.x, DVec2::X), of(place.at.y, DVec2::Y)]
        };
        let [x, z] = place.moved.unwrap_or_else(own);
        let moved = [x + by[0], z + by[1]];
        let [x, z] = moved;
        // The larger singular value of the matrix of both slopes.
        let sum = DVec2::new(x.slope.x + z.slope.y, z.slope.x - x.slope.y);
        let difference = DVec2::new(x.slope.x - z.slope.y, x.slope.y + z.slope.x);
        let stretch = 0.5 * (sum.length() + difference.length()) * (1.0 + 8.0 * f64::EPSILON);
        let reach = stretch * radius + x.error.hypot(z.error);
        Disc { at: DVec2::new(x.value, z.value), reach, moved: Some(moved), radius }
    }

    fn of_plane(self, place: &Disc) -> Enclosure {
        let Some([x, z]) = place.moved else {
            return self;
        };
        let steep = self.slope.length();
        let (off, turn) = (x.error.hypot(z.error), x.slope_error.hypot(z.slope_error));
        let stretch = x.slope.length().hypot(z.slope.length());
        Enclosure {
            value: self.value,
            slope: x.slope * self.slope.x + z.slope * self.slope.y,
            error: self.error + steep * off + 4.0 * f64::EPSILON * steep * stretch * place.radius,
            slope_error: stretch * self.slope_error + turn * (steep + self.slope_error),
            radius: place.radius,
        }
    }
}
