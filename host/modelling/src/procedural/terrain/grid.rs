//! Heights on a grid, with a smooth surface through them and bounds of its parts.

use super::enclosure::Enclosure;
use super::error::TerrainError;
use super::parameters::in_range;
use crate::memory;
use glam::DVec2;
use rayon::prelude::*;

/// Bytes that a height takes with the bounds of all sizes of cells.
const BYTES_EACH: u64 = 56;
/// Heights are lower than this, and higher than less it.
const MOST_HEIGHT: f64 = 1e15;
/// Rounding of heights as a part of the largest.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Heights on a square grid and the bicubic surface through them, whose slopes are continuous; beyond the grid it goes
/// on as at its edge.
///
/// # Source
/// Catmull and Rom 1974. Bounds of parts in a pyramid: Tevs, Ihrke and Seidel 2008.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    columns: usize,
    rows: usize,
    corner: DVec2,
    spacing: f64,
    heights: Vec<f64>,
    /// Bounds of cells, of squares of four cells, and so on to one of all. The cells are those between heights and one
    /// more all around.
    levels: Vec<GridLevel>,
    /// The largest absolute value of a height.
    largest: f64,
}

/// Bounds of cells of one size.
#[derive(Clone, Debug, PartialEq)]
struct GridLevel {
    columns: usize,
    rows: usize,
    cells: Vec<CellBounds>,
}

/// Bounds of the surface over a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellBounds {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Longest gradient, height per length.
    pub(super) steepest: f64,
    /// Largest second derivative along a line, one over length.
    bend: f64,
}

impl HeightGrid {
    /// A grid of heights.
    ///
    /// - `size`: heights along x and z, 2 and more each.
    /// - `corner`: x and z of the first height.
    /// - `spacing`: distance of neighbours, above 0.
    /// - `heights`: row by row along x, units of length.
    ///
    /// # Errors
    /// [`TerrainError`] for another number of heights, numbers out of range, or too little memory.
    pub fn new(size: [usize; 2], corner: DVec2, spacing: f64, heights: Vec<f64>) -> Result<HeightGrid, TerrainError> {
        let [columns, rows] = size;
        if columns < 2 || rows < 2 || columns.checked_mul(rows) != Some(heights.len()) {
            return Err(TerrainError::GridSize { columns, rows, heights: heights.len() });
        }
        in_range("spacing", spacing, [1e-9, 1e9])?;
        if !corner.is_finite() {
            return Err(TerrainError::NotFinite);
        }
        if let Some(cell) = heights.iter().position(|height| height.is_nan() || height.abs() >= MOST_HEIGHT) {
            let (column, row, value) = (cell % columns, cell / columns, heights[cell]);
            return Err(TerrainError::Cell { what: "a height", column, row, value });
        }
        memory::reserve(heights.len() as u64 * BYTES_EACH, || format!("bounds of {} heights", heights.len()))?;
        let largest = heights.iter().fold(0.0, |largest: f64, height| largest.max(height.abs()));
        let mut grid = HeightGrid { columns, rows, corner, spacing, heights, levels: Vec::new(), largest };
        grid.bound();
        Ok(grid)
    }

    /// Heights along x and z.
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Distance of neighbours.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The heights, row by row along x.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// x and z of the first height.
    pub fn corner(&self) -> DVec2 {
        self.corner
    }

    /// Makes the bounds of all sizes of cells.
    fn bound(&mut self) {
        let (columns, rows) = (self.columns + 1, self.rows + 1);
        let of = |cell: usize| self.cell_bounds([cell % columns, cell / columns]);
        let cells = (0..columns * rows).into_par_iter().map(of).collect();
        self.levels.push(GridLevel { columns, rows, cells });
        while let Some(fine) = self.levels.last().filter(|level| level.columns > 1 || level.rows > 1) {
            let (columns, rows) = (fine.columns.div_ceil(2), fine.rows.div_ceil(2));
            let of = |cell: usize| {
                let (x, z) = (2 * (cell % columns), 2 * (cell / columns));
                fine.bounds([x, z], [x + 1, z + 1])
            };
            let cells = (0..columns * rows).map(of).collect();
            self.levels.push(GridLevel { columns, rows, cells });
        }
    }

    /// The sixteen heights around a cell; those beyond the edge are those at it.
    pub(super) fn around(&self, [column, row]: [usize; 2]) -> [[f64; 4]; 4] {
        // Cell 0 is the one before the first height.
        let along = |cell: usize, k: usize, count: usize| (cell + k).saturating_sub(2).min(count - 1);
        std::array::from_fn(|z| {
            std::array::from_fn(|x| {
                self.heights[along(row, z, self.rows) * self.columns + along(column, x, self.columns)]
            })
        })
    }

    /// Bounds by the control points of the surface over a cell as a patch of Bézier.
    fn cell_bounds(&self, cell: [usize; 2]) -> CellBounds {
        let controls = |p: [f64; 4]| [p[1], p[1] + (p[2] - p[0]) / 6.0, p[2] - (p[3] - p[1]) / 6.0, p[2]];
        let rows = self.around(cell).map(controls);
        let columns: [[f64; 4]; 4] = std::array::from_fn(|x| controls(std::array::from_fn(|z| rows[z][x])));
        let all = || columns.iter().flatten().copied();
        let most = |first: fn(usize, usize) -> bool, of: &dyn Fn(usize, usize) -> f64| {
            let at = (0..16).filter(|k| first(k % 4, k / 4));
            at.map(|k| of(k % 4, k / 4).abs()).fold(0.0, f64::max)
        };
        let b = &columns;
        let steep_x = most(|x, _| x < 3, &|x, z| 3.0 * (b[x + 1][z] - b[x][z]));
        let steep_z = most(|_, z| z < 3, &|x, z| 3.0 * (b[x][z + 1] - b[x][z]));
        let xx = most(|x, _| x < 2, &|x, z| 6.0 * ((b[x + 2][z] - b[x + 1][z]) - (b[x + 1][z] - b[x][z])));
        let zz = most(|_, z| z < 2, &|x, z| 6.0 * ((b[x][z + 2] - b[x][z + 1]) - (b[x][z + 1] - b[x][z])));
        let xz = most(|x, z| x < 3 && z < 3, &|x, z| 9.0 * ((b[x + 1][z + 1] - b[x][z + 1]) - (b[x + 1][z] - b[x][z])));
        let rounding = ROUNDING * self.largest;
        CellBounds {
            low: all().fold(f64::INFINITY, f64::min) - rounding,
            high: all().fold(f64::NEG_INFINITY, f64::max) + rounding,
            steepest: (steep_x.hypot(steep_z) + rounding) / self.spacing,
            bend: ((xx * xx + zz * zz + 2.0 * xz * xz).sqrt() + if xx + zz + xz > 0.0 { rounding } else { 0.0 })
                / (self.spacing * self.spacing),
        }
    }

    /// A place in cells from the outer edge of the cell before the first height, kept within the cells.
    pub(super) fn in_cells(&self, at: DVec2) -> DVec2 {
        let most = DVec2::new((self.columns + 1) as f64, (self.rows + 1) as f64);
        ((at - self.corner) / self.spacing + 1.0).clamp(DVec2::ZERO, most)
    }

    /// Bounds over a rectangle of places in cells.
    pub(super) fn bounds_within(&self, low: DVec2, high: DVec2) -> CellBounds {
        let index = |at: DVec2| [(at.x as usize).min(self.columns), (at.y as usize).min(self.rows)];
        let (low, high) = (index(low), index(high));
        let mut level = 0;
        while (high[0] >> level) - (low[0] >> level) > 1 || (high[1] >> level) - (low[1] >> level) > 1 {
            level += 1;
        }
        self.levels[level].bounds(low.map(|k| k >> level), high.map(|k| k >> level))
    }

    /// The surface over a disc.
    pub(super) fn enclosure(&self, at: DVec2, radius: f64) -> Enclosure {
        let reach = radius / self.spacing * (1.0 + ROUNDING) + ROUNDING * (1.0 + (at / self.spacing).length());
        let place = self.in_cells(at);
        let bounds =
            self.bounds_within(self.in_cells(at - reach * self.spacing), self.in_cells(at + reach * self.spacing));
        let [value, x, z] = self.surface(place);
        let slope = DVec2::new(x, z) / self.spacing;
        let far = (at.length() + self.corner.length()) * 4.0 * f64::EPSILON;
        Enclosure {
            value,
            slope,
            error: 0.5 * bounds.bend * radius * radius + ROUNDING * self.largest + bounds.steepest * far,
            slope_error: bounds.bend * (radius + far) + ROUNDING * self.largest / self.spacing,
            radius,
        }
        .within([bounds.low, bounds.high], bounds.steepest)
    }

    /// Bounds of heights and of their derivatives over a rectangle: of a part of the cells that it touches where they
    /// are few.
    pub(super) fn over(&self, low: [f64; 2], high: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        let [from, to] = [low, high].map(|at| self.in_cells(DVec2::from(at)));
        let off = DVec2::splat(ROUNDING * (1.0 + from.abs().max(to.abs()).max_element()));
        let middle = 0.5 * (from + to);
        let half = (0.5 * (to - from) + off) * self.spacing;
        let bounds = self.bounds_within((from - off).max(DVec2::ZERO), to + off);
        let [value, x, z] = self.surface(middle);
        // By the second derivatives, from the middle.
        let radius = half.length();
        let rounding = ROUNDING * self.largest;
        let turn = bounds.bend * radius + rounding / self.spacing;
        let slopes = [x, z].map(|slope| {
            let slope = slope / self.spacing;
            [(slope - turn).max(-bounds.steepest), (slope + turn).min(bounds.steepest)]
        });
        let spread =
            (DVec2::new(x, z) / self.spacing).length() * radius + 0.5 * bounds.bend * radius * radius + rounding;
        ([(value - spread).max(bounds.low), (value + spread).min(bounds.high)], slopes)
    }

    /// The height of the surface at a place.
    pub(super) fn height(&self, at: DVec2) -> f64 {
        self.surface(self.in_cells(at))[0]
    }

    /// The height at a place in cells, and its derivatives there.
    fn surface(&self, place: DVec2) -> [f64; 3] {
        let cell = [(place.x as usize).min(self.columns), (place.y as usize).min(self.rows)];
        let (x, z) = (place.x - cell[0] as f64, place.y - cell[1] as f64);
        let ([along, along_slope], [across, across_slope]) = (weights(x), weights(z));
        let (mut value, mut slopes) = (0.0, [0.0; 2]);
        for (row, heights) in self.around(cell).iter().enumerate() {
            let sum =
                |weights: &[f64; 4]| heights.iter().zip(weights).map(|(height, weight)| height * weight).sum::<f64>();
            let (height, slope) = (sum(&along), sum(&along_slope));
            value += across[row] * height;
            slopes[0] += across[row] * slope;
            slopes[1] += across_slope[row] * height;
        }
        [value, slopes[0], slopes[1]]
    }
}

impl GridLevel {
    /// Bounds of a rectangle of cells, both ends included; those beyond the edge have no part in it.
    fn bounds(&self, low: [usize; 2], high: [usize; 2]) -> CellBounds {
        let mut all = self.cells[low[1] * self.columns + low[0]];
        for row in low[1]..=high[1].min(self.rows - 1) {
            for column in low[0]..=high[0].min(self.columns - 1) {
                let cell = &self.cells[row * self.columns + column];
                all = CellBounds {
                    low: all.low.min(cell.low),
                    high: all.high.max(cell.high),
                    steepest: all.steepest.max(cell.steepest),
                    bend: all.bend.max(cell.bend),
                };
            }
        }
        all
    }
}

/// Weights of four neighbours between the middle two, and their derivatives.
fn weights(t: f64) -> [[f64; 4]; 2] {
    let (s, t2) = (1.0 - t, t * t);
    [
        [-0.5 * t * s * s, 1.0 + t2 * (1.5 * t - 2.5), t * (0.5 + t * (2.0 - 1.5 * t)), -0.5 * t2 * s],
        [-0.5 * s * (1.0 - 3.0 * t), t * (4.5 * t - 5.0), 0.5 + t * (4.0 - 4.5 * t), t * (1.5 * t - 1.0)],
    ]
}
