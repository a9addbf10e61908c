//! Hillslopes: diffusion of heights between the rivers, the edge of the grid kept.

use super::super::error::TerrainError;
use super::ground::{BAND, ErodibleGround};
use rayon::prelude::*;

/// Largest part of a difference that neighbours exchange at once: with less than 1/4 the new height of a cell grows
/// with all old ones, and none leaves their range.
const MOST_PART: f64 = 0.2;
/// Most parts of a step.
const MOST_PARTS: f64 = 1e4;

/// Diffusion in as many parts of a step as it takes to be stable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hillslopes {
    parts: usize,
    /// Part of a difference that is exchanged.
    part: f64,
}

impl Hillslopes {
    /// Diffusion over a time.
    ///
    /// - `diffusivity`: length^2 over time. `spacing`: length.
    ///
    /// # Errors
    /// [`TerrainError::Parameter`] if it would take more than 10 000 parts.
    pub(super) fn new(diffusivity: f64, time: f64, spacing: f64) -> Result<Hillslopes, TerrainError> {
        let number = diffusivity * time / (spacing * spacing);
        let parts = (number / MOST_PART).ceil();
        if parts > MOST_PARTS {
            let most = MOST_PARTS * MOST_PART * spacing * spacing / time;
            return Err(TerrainError::Parameter { name: "diffusivity", value: diffusivity, range: [0.0, most] });
        }
        Ok(Hillslopes { parts: parts as usize, part: if parts > 0.0 { number / parts } else { 0.0 } })
    }

    /// Whether anything diffuses.
    pub(super) fn is_any(&self) -> bool {
        self.parts > 0
    }

    /// Diffuses the heights.
    ///
    /// - `is_cancelled`: asked for each part; what is cancelled has no meaning.
    /// - Returns what left over the edge, as heights of cells.
    pub(super) fn step(&self, ground: &mut ErodibleGround, is_cancelled: &(dyn Fn() -> bool + Sync)) -> f64 {
        let (columns, rows) = (ground.columns, ground.rows);
        if columns < 3 || rows < 3 {
            return 0.0;
        }
        let mut left = 0.0;
        for _ in 0..self.parts {
            if is_cancelled() {
                break;
            }
            let bed = &ground.bed;
            left += self.part * lost(bed, [columns, rows]);
            ground.next.par_chunks_mut(BAND * columns).enumerate().for_each(|(band, next)| {
                for (offset, next) in next.chunks_mut(columns).enumerate() {
                    let row = band * BAND + offset;
                    let of = |row: usize| &bed[row * columns..(row + 1) * columns];
                    next.copy_from_slice(of(row));
                    if row > 0 && row + 1 < rows {
                        self.inner_row([of(row - 1), of(row), of(row + 1)], next);
                    }
                }
            });
            ground.step();
        }
        left
    }

    fn inner_row(&self, [north, own, south]: [&[f64]; 3], next: &mut [f64]) {
        let inner = own.len() - 2;
        let [west, here, east] = [0, 1, 2].map(|from| &own[from..from + inner]);
        let (north, south, next) = (&north[1..=inner], &south[1..=inner], &mut next[1..=inner]);
        for cell in 0..inner {
            let h = here[cell];
            let sum = ((west[cell] - h) + (east[cell] - h)) + ((north[cell] - h) + (south[cell] - h));
            next[cell] = h + self.part * sum;
        }
    }
}

/// Sum of the differences of height between inner cells and those beside them at the edge.
fn lost(bed: &[f64], [columns, rows]: [usize; 2]) -> f64 {
    let drop = |inner: usize, edge: usize| bed[inner] - bed[edge];
    let (bottom, right) = ((rows - 1) * columns, columns - 1);
    let along: f64 = (1..right)
        .map(|column| drop(columns + column, column) + drop(bottom - columns + column, bottom + column))
        .sum();
    let across: f64 = (1..rows - 1)
        .map(|row| row * columns)
        .map(|first| drop(first + 1, first) + drop(first + right - 1, first + right))
        .sum();
    along + across
}
