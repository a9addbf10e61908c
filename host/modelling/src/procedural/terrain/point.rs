//! Heights at single places: numbers alone, without bounds.

use super::form::Form;
use super::grid::HeightGrid;
use super::octave_sum::OctaveSum;
use super::octaves::{LANES, Octaves};
use glam::DVec2;
use std::ops::{Add, Mul};

/// A number at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointHeight(pub(super) f64);

impl Add for PointHeight {
    type Output = PointHeight;

    fn add(self, other: PointHeight) -> PointHeight {
        PointHeight(self.0 + other.0)
    }
}

impl Mul for PointHeight {
    type Output = PointHeight;

    fn mul(self, other: PointHeight) -> PointHeight {
        PointHeight(self.0 * other.0)
    }
}

impl Form for PointHeight {
    type Place = DVec2;

    fn constant(_: &DVec2, value: f64) -> PointHeight {
        PointHeight(value)
    }

    fn scaled(self, by: f64) -> PointHeight {
        PointHeight(self.0 * by)
    }

    fn abs(self) -> PointHeight {
        PointHeight(self.0.abs())
    }

    fn at_least(self, least: f64) -> PointHeight {
        PointHeight(self.0.max(least))
    }

    fn at_most(self, most: f64) -> PointHeight {
        PointHeight(self.0.min(most))
    }

    fn noise(octaves: &Octaves, first: usize, place: &DVec2) -> [PointHeight; LANES] {
        octaves.values_at(first, *place).0.map(PointHeight)
    }

    fn octave_sum(sum: &OctaveSum, place: &DVec2, footprint: f64) -> PointHeight {
        PointHeight(sum.value(*place, footprint))
    }

    fn grid(grid: &HeightGrid, place: &DVec2) -> PointHeight {
        PointHeight(grid.height(*place))
    }

    fn moved(place: &DVec2, by: [PointHeight; 2]) -> DVec2 {
        *place + DVec2::new(by[0].0, by[1].0)
    }

    fn of_plane(self, _: &DVec2) -> PointHeight {
        self
    }
}
