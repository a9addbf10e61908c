//! Functions of height, and how they are put together.

use super::error::TerrainError;
use super::form::Form;
use super::fractal::{Fractal, FractalKind};
use super::grid::HeightGrid;
use super::parameters::{FractalParameters, in_range};
use std::sync::Arc;

/// Functions may be within functions so many times over.
pub const MOST_NESTED: usize = 16;
/// Most that heights are scaled by.
const MOST_SCALE: f64 = 1e9;

/// Height over the plane: y as a function of x and z.
#[derive(Clone, Debug)]
pub enum HeightFunction {
    /// A plane.
    Constant(f64),
    /// A fractal of octaves of noise.
    Fractal(FractalKind, FractalParameters),
    /// Heights on a grid, with a smooth surface through them.
    Grid(Arc<HeightGrid>),
    /// The sum of functions.
    Sum(Vec<HeightFunction>),
    /// The product of two functions.
    Product(Box<[HeightFunction; 2]>),
    /// A function times a number.
    Scaled(Box<HeightFunction>, f64),
    /// A function that is kept between two heights.
    Clamped(Box<HeightFunction>, [f64; 2]),
    /// Domain warping: the function at places that others move along x and z.
    ///
    /// # Source
    /// Perlin 1985, turbulence that moves places; Quilez 2002, domain warping.
    Warped {
        /// What is moved.
        of: Box<HeightFunction>,
        /// How far along x and z, units of length.
        by: Box<[HeightFunction; 2]>,
    },
}

/// A function whose lattices are made.
#[derive(Clone, Debug)]
pub(super) enum PreparedHeights {
    Constant(f64),
    Fractal(Box<Fractal>),
    Grid(Arc<HeightGrid>),
    Sum(Vec<PreparedHeights>),
    Product(Box<[PreparedHeights; 2]>),
    Scaled(Box<PreparedHeights>, f64),
    Clamped(Box<PreparedHeights>, [f64; 2]),
    Warped(Box<PreparedHeights>, Box<[PreparedHeights; 2]>),
}

impl HeightFunction {
    /// A fractal.
    pub fn fractal(kind: FractalKind, parameters: FractalParameters) -> HeightFunction {
        HeightFunction::Fractal(kind, parameters)
    }

    /// The function at places that others move along x and z.
    pub fn warped(self, along_x: HeightFunction, along_z: HeightFunction) -> HeightFunction {
        HeightFunction::Warped { of: Box::new(self), by: Box::new([along_x, along_z]) }
    }

    /// Checks all numbers and makes the lattices.
    ///
    /// - `reach`: the largest coordinate at which it is asked.
    ///
    /// # Errors
    /// [`TerrainError`] for a number out of range.
    pub(super) fn prepare(&self, reach: f64, level: usize) -> Result<PreparedHeights, TerrainError> {
        if level > MOST_NESTED {
            return Err(TerrainError::TooDeep { most: MOST_NESTED });
        }
        let below = |function: &HeightFunction| function.prepare(reach, level + 1);
        let both = |[a, b]: &[HeightFunction; 2]| Ok::<_, TerrainError>(Box::new([below(a)?, below(b)?]));
        let height = |name, height: f64| in_range(name, height, [-MOST_SCALE, MOST_SCALE]);
        Ok(match self {
            HeightFunction::Constant(value) => {
                height("height", *value)?;
                PreparedHeights::Constant(*value)
            }
            HeightFunction::Fractal(kind, parameters) => {
                PreparedHeights::Fractal(Box::new(Fractal::new(*kind, *parameters, reach)?))
            }
            HeightFunction::Grid(grid) => PreparedHeights::Grid(grid.clone()),
            HeightFunction::Sum(of) => PreparedHeights::Sum(of.iter().map(below).collect::<Result<_, _>>()?),
            HeightFunction::Product(of) => PreparedHeights::Product(both(of)?),
            HeightFunction::Scaled(of, by) => {
                in_range("factor", *by, [-MOST_SCALE, MOST_SCALE])?;
                PreparedHeights::Scaled(Box::new(below(of)?), *by)
            }
            HeightFunction::Clamped(of, [low, high]) => {
                height("lower limit", *low)?;
                in_range("upper limit", *high, [*low, MOST_SCALE])?;
                PreparedHeights::Clamped(Box::new(below(of)?), [*low, *high])
            }
            HeightFunction::Warped { of, by } => {
                let by = both(by)?;
                let farthest: f64 = by.iter().map(|by| by.most_absolute()).sum();
                let of = of.prepare(reach + farthest, level + 1)?;
                PreparedHeights::Warped(Box::new(of), by)
            }
        })
    }
}

impl PreparedHeights {
    /// Heights over a place.
    ///
    /// - `footprint`: what is finer is left out, with smooth edges.
    pub(super) fn heights<F: Form>(&self, place: &F::Place, footprint: f64) -> F {
        match self {
            PreparedHeights::Constant(value) => F::constant(place, *value).of_plane(place),
            PreparedHeights::Fractal(fractal) => fractal.heights::<F>(place, footprint).of_plane(place),
            PreparedHeights::Grid(grid) => F::grid(grid, place).of_plane(place),
            PreparedHeights::Sum(of) => of
                .iter()
                .map(|part| part.heights::<F>(place, footprint))
                .reduce(|a, b| a + b)
                .unwrap_or_else(|| F::constant(place, 0.0).of_plane(place)),
            PreparedHeights::Product(of) => of[0].heights::<F>(place, footprint) * of[1].heights::<F>(place, footprint),
            PreparedHeights::Scaled(of, by) => of.heights::<F>(place, footprint).scaled(*by),
            PreparedHeights::Clamped(of, [low, high]) => {
                of.heights::<F>(place, footprint).at_least(*low).at_most(*high)
            }
            PreparedHeights::Warped(of, by) => {
                let by = [&by[0], &by[1]].map(|by| by.heights::<F>(place, footprint));
                of.heights::<F>(&F::moved(place, by), footprint)
            }
        }
    }

    /// No height is farther from 0.
    fn most_absolute(&self) -> f64 {
        let everywhere = super::form::Disc::everywhere();
        let [low, high] = self.heights::<super::enclosure::Enclosure>(&everywhere, 0.0).range();
        low.abs().max(high.abs())
    }

    /// Points in a unit of length of a lattice that shows every part, however coarsely: two in a cell of the first octave,
    /// those of grids.
    pub(super) fn coarsest(&self) -> f64 {
        match self {
            PreparedHeights::Constant(_) => 0.0,
            PreparedHeights::Fractal(fractal) => 2.0 * fractal.coarsest(),
            PreparedHeights::Grid(grid) => 1.0 / grid.spacing(),
            PreparedHeights::Sum(of) => of.iter().map(PreparedHeights::coarsest).fold(0.0, f64::max),
            PreparedHeights::Product(of) => of[0].coarsest().max(of[1].coarsest()),
            PreparedHeights::Scaled(of, _) | PreparedHeights::Clamped(of, _) => of.coarsest(),
            PreparedHeights::Warped(of, by) => of.coarsest().max(by[0].coarsest()).max(by[1].coarsest()),
        }
    }

    /// Lattice points of the finest octave in a unit of length, those of grids among them.
    pub(super) fn finest(&self) -> f64 {
        match self {
            PreparedHeights::Constant(_) => 0.0,
            PreparedHeights::Fractal(fractal) => fractal.finest(),
            PreparedHeights::Grid(grid) => 1.0 / grid.spacing(),
            PreparedHeights::Sum(of) => of.iter().map(PreparedHeights::finest).fold(0.0, f64::max),
            PreparedHeights::Product(of) => of[0].finest().max(of[1].finest()),
            PreparedHeights::Scaled(of, _) | PreparedHeights::Clamped(of, _) => of.finest(),
            PreparedHeights::Warped(of, by) => of.finest().max(by[0].finest()).max(by[1].finest()),
        }
    }
}
