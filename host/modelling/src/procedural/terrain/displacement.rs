//! Midpoint displacement: terrain by subdivision of squares, any region of it at any level.

use super::error::TerrainError;
use super::grid::HeightGrid;
use super::parameters::in_range;
use crate::memory;
use crate::numeric::sampling::mix;
use glam::DVec2;

/// Levels at which squares are divided.
const MOST_LEVELS: u32 = 32;
/// Largest number of a square of the coarsest level along an axis.
const MOST_SQUARES: i64 = 1 << 24;
/// Most heights of a region along an axis.
const MOST_SIDE: usize = 1 << 15;

/// Terrain by recursive subdivision of squares: the middle of each square gets the mean of its corners and a random
/// displacement, then the middle of each side the mean of its four neighbours and another one. What is displaced falls
/// by 2^(-H/2) with each of these steps.
///
/// The random number of a point is a function of its place, its level and the seed: a region at a level is a function
/// of these alone, and regions that touch agree bit by bit along what they share, without cracks.
///
/// # Source
/// Fournier, Fussell and Carpenter 1982, "Computer rendering of stochastic models": subdivision of squares and numbers
/// tied to places; middles of sides by four neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MidpointDisplacement {
    /// Exponent H, 0 to 1: the lower, the rougher. The fractal dimension is 3 - H.
    pub hurst: f64,
    /// Side of the squares of level 0, units of length, above 0.
    pub scale: f64,
    /// Standard deviation of heights at the corners of level 0, units of length, 0 and more.
    pub height: f64,
    /// Another terrain for each.
    pub seed: u64,
}

/// Heights of one level over a rectangle of its lattice.
struct HeightLattice {
    /// Number of the first point along x and z.
    first: [i64; 2],
    size: [usize; 2],
    heights: Vec<f64>,
}

impl MidpointDisplacement {
    /// Checks every number.
    ///
    /// # Errors
    /// [`TerrainError::Parameter`] names the first that is out of range.
    pub fn check(&self) -> Result<(), TerrainError> {
        in_range("hurst", self.hurst, [0.0, 1.0])?;
        in_range("scale", self.scale, [1e-9, 1e9])?;
        in_range("height", self.height, [0.0, 1e9])
    }

    /// Heights of a region at a level.
    ///
    /// - `level`: how often squares are divided; neighbours are `scale / 2^level` apart.
    /// - `first`: number of the first point along x and z on the lattice of the level; point (0, 0) is the origin.
    /// - `size`: heights along x and z, 2 to 32768 each.
    ///
    /// # Errors
    /// [`TerrainError`] for numbers out of range, or too little memory.
    pub fn region(&self, level: u32, first: [i64; 2], size: [usize; 2]) -> Result<HeightGrid, TerrainError> {
        self.check()?;
        in_range("level", f64::from(level), [0.0, f64::from(MOST_LEVELS)])?;
        for axis in 0..2 {
            in_range("size", size[axis] as f64, [2.0, MOST_SIDE as f64])?;
            let most = (MOST_SQUARES << level) as f64;
            in_range("first point", first[axis] as f64, [-most, most])?;
        }
        memory::reserve((size[0] * size[1]) as u64 * 32, || format!("{} by {} heights", size[0], size[1]))?;
        let lattice = self.lattice(level, first, size);
        let spacing = self.scale / (1_u64 << level) as f64;
        let corner = DVec2::new(first[0] as f64, first[1] as f64) * spacing;
        HeightGrid::new(size, corner, spacing, lattice.heights)
    }

    /// Heights of a level, from those of the one before over a region that is a little larger than half as large.
    fn lattice(&self, level: u32, first: [i64; 2], size: [usize; 2]) -> HeightLattice {
        if level == 0 {
            let heights = points(first, size).map(|at| self.height * self.deviate(at, 0)).collect();
            return HeightLattice { first, size, heights };
        }
        // The middle of a side needs middles of squares a step beyond, and these corners a step beyond that.
        const MARGIN: i64 = 2;
        let from = first.map(|first| (first - MARGIN).div_euclid(2));
        let to = [0, 1].map(|axis| (first[axis] + size[axis] as i64 - 1 + MARGIN).div_euclid(2) + 1);
        let coarse = self.lattice(level - 1, from, [0, 1].map(|axis| (to[axis] - from[axis] + 1) as usize));
        // By products of roots, which are the same on every machine.
        let fall = half_power(self.hurst);
        let at_corners = (1..level).fold(self.height, |size, _| size * fall * fall);
        let [of_squares, of_sides] = [at_corners * fall, at_corners * fall * fall];
        let corner = |x: i64, z: i64| coarse.at([x.div_euclid(2), z.div_euclid(2)]);
        let square = |x: i64, z: i64| {
            let mean =
                0.25 * ((corner(x - 1, z - 1) + corner(x + 1, z + 1)) + (corner(x + 1, z - 1) + corner(x - 1, z + 1)));
            mean + of_squares * self.deviate([x, z], level)
        };
        let of = |[x, z]: [i64; 2]| match (x.rem_euclid(2), z.rem_euclid(2)) {
            (0, 0) => corner(x, z),
            (1, 1) => square(x, z),
            (1, _) => {
                let mean = 0.25 * ((corner(x - 1, z) + corner(x + 1, z)) + (square(x, z - 1) + square(x, z + 1)));
                mean + of_sides * self.deviate([x, z], level)
            }
            _ => {
                let mean = 0.25 * ((corner(x, z - 1) + corner(x, z + 1)) + (square(x - 1, z) + square(x + 1, z)));
                mean + of_sides * self.deviate([x, z], level)
            }
        };
        HeightLattice { first, size, heights: points(first, size).map(of).collect() }
    }

    /// A number of a point, of mean 0 and variance 1: the sum of eight even ones, which is close to the normal
    /// distribution.
    fn deviate(&self, at: [i64; 2], level: u32) -> f64 {
        const PARTS: u32 = 4;
        let place = mix(mix(self.seed ^ mix(u64::from(level))) ^ at[0] as u64) ^ (at[1] as u64).rotate_left(32);
        let mut sum = 0_u64;
        for number in [mix(place), mix(!place)] {
            sum += (0..PARTS).map(|part| number >> (16 * part) & 0xffff).sum::<u64>();
        }
        // Of eight numbers 0..=65535: mean 4 times 65535, variance 8 (65536^2 - 1) / 12.
        (sum as f64 - 4.0 * 65535.0) / 53_509.921_2
    }
}

impl HeightLattice {
    fn at(&self, [x, z]: [i64; 2]) -> f64 {
        self.heights[(z - self.first[1]) as usize * self.size[0] + (x - self.first[0]) as usize]
    }
}

/// The points of a rectangle of a lattice, row by row.
fn points(first: [i64; 2], size: [usize; 2]) -> impl Iterator<Item = [i64; 2]> {
    (0..size[1] as i64).flat_map(move |z| (0..size[0] as i64).map(move |x| [first[0] + x, first[1] + z]))
}

/// 2^(-H/2), to 2^-30, by square roots alone.
fn half_power(hurst: f64) -> f64 {
    const BITS: u32 = 30;
    let bits = (0.5 * hurst * f64::from(1_u32 << BITS)).round() as u64;
    let (mut root, mut power) = (2.0_f64, 1.0);
    for bit in (0..BITS).rev() {
        root = root.sqrt();
        power *= if bits >> bit & 1 == 1 { root } else { 1.0 };
    }
    1.0 / power
}
