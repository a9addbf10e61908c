//! Receivers: the neighbour of each cell to which its water flows.

use super::ground::BAND;
use crate::numeric::sampling::mix;
use rayon::prelude::*;
use std::f64::consts::SQRT_2;

/// A cell without a receiver: at the edge, the base level, or the bottom of a pit.
pub(super) const NONE: u8 = 8;
/// Steps along x and z to the neighbours, by the numbers that directions have.
pub(super) const STEPS: [[isize; 2]; 8] = [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, 1], [-1, -1], [1, -1]];

/// The direction in which each cell of a grid drains; those at its edge do not.
#[derive(Clone, Debug)]
pub(super) struct Receivers {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Direction of the receiver, or [`NONE`].
    pub(super) directions: Vec<u8>,
    /// What is added to the number of a cell for each direction.
    offsets: [isize; 9],
    /// How much chance decides, 0..=1.
    wander: f64,
}

impl Receivers {
    /// No receivers yet.
    ///
    /// - `wander`: how much chance decides which of the ways down is taken, 0 for the steepest, to 1.
    pub(super) fn new([columns, rows]: [usize; 2], wander: f64) -> Receivers {
        let mut offsets = [0; 9];
        for (offset, [x, z]) in offsets.iter_mut().zip(STEPS) {
            *offset = z * columns as isize + x;
        }
        Receivers { columns, rows, directions: vec![NONE; columns * rows], offsets, wander }
    }

    /// Whether a cell is at the edge, the base level.
    #[inline]
    pub(super) fn is_base(&self, cell: usize) -> bool {
        let (column, row) = (cell % self.columns, cell / self.columns);
        column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
    }

    /// The receiver of a cell; the cell itself if it has none.
    #[inline]
    pub(super) fn of(&self, cell: usize) -> usize {
        cell.wrapping_add_signed(self.offsets[self.directions[cell] as usize])
    }

    /// The neighbour in a direction of a cell that is not at the edge.
    #[inline]
    pub(super) fn neighbour(&self, cell: usize, direction: usize) -> usize {
        cell.wrapping_add_signed(self.offsets[direction])
    }

    /// Distance to a receiver, spacings.
    #[inline]
    pub(super) fn distance(direction: u8) -> f64 {
        if direction < 4 { 1.0 } else { SQRT_2 }
    }

    /// Finds the steepest way down from every cell, the first of those that are as steep.
    ///
    /// Of few directions the steepest one leads straight along an axis or a diagonal for as long as a slope faces about
    /// the same way. So slopes are multiplied by a random number of the cell and the direction, always the same, 1 -
    /// wander / 2 to 1 + wander / 2.
    ///
    /// - Returns how many pits there are.
    ///
    /// # Source
    /// O'Callaghan and Mark 1984; chance against the grain of the grid: Fairfield and Leymarie 1991.
    pub(super) fn find(&mut self, heights: &[f64]) -> usize {
        let (columns, rows, wander) = (self.columns, self.rows, self.wander);
        let pits: Vec<usize> = self
            .directions
            .par_chunks_mut(BAND * columns)
            .enumerate()
            .map(|(band, directions)| {
                let mut pits = 0;
                for (offset, directions) in directions.chunks_mut(columns).enumerate() {
                    let row = band * BAND + offset;
                    directions.fill(NONE);
                    if row == 0 || row + 1 == rows || columns < 3 {
                        continue;
                    }
                    let of = |row: usize| &heights[row * columns..(row + 1) * columns];
                    let rows = [of(row - 1), of(row), of(row + 1)];
                    if wander > 0.0 {
                        steepest(rows, directions, |column| weights(row * columns + column, wander));
                    } else {
                        steepest(rows, directions, |_| [1.0; 8]);
                    }
                    let inner = &directions[1..columns - 1];
                    pits += inner.iter().filter(|direction| **direction == NONE).count();
                }
                pits
            })
            .collect();
        pits.iter().sum()
    }
}

/// Random numbers of a cell, one for each direction, 1 on average.
#[inline(always)]
fn weights(cell: usize, wander: f64) -> [f64; 8] {
    let bytes = mix(cell as u64).to_le_bytes();
    bytes.map(|byte| 1.0 + wander * (f64::from(byte) / 255.0 - 0.5))
}

/// Directions of the steepest ways down from the inner cells of a row.
///
/// - `weights`: by what the slopes in all directions are multiplied, for a column.
#[inline(always)]
fn steepest([north, own, south]: [&[f64]; 3], directions: &mut [u8], weights: impl Fn(usize) -> [f64; 8]) {
    const DIAGONAL: f64 = 1.0 / SQRT_2;
    let inner = own.len() - 2;
    let [nw, n, ne] = [0, 1, 2].map(|from| &north[from..from + inner]);
    let [w, here, e] = [0, 1, 2].map(|from| &own[from..from + inner]);
    let [sw, s, se] = [0, 1, 2].map(|from| &south[from..from + inner]);
    let directions = &mut directions[1..=inner];
    for cell in 0..inner {
        let (h, weights) = (here[cell], weights(cell + 1));
        let (mut best, mut direction) = (0.0, NONE);
        let mut compare = |slope: f64, number: u8| {
            let slope = slope * weights[number as usize];
            direction = if slope > best { number } else { direction };
            best = if slope > best { slope } else { best };
        };
        compare(h - e[cell], 0);
        compare(h - s[cell], 1);
        compare(h - w[cell], 2);
        compare(h - n[cell], 3);
        compare((h - se[cell]) * DIAGONAL, 4);
        compare((h - sw[cell]) * DIAGONAL, 5);
        compare((h - nw[cell]) * DIAGONAL, 6);
        compare((h - ne[cell]) * DIAGONAL, 7);
        directions[cell] = direction;
    }
}
