//! Slides: ground that is steeper than the angle of repose moves to lower neighbours.

use super::ground::{BAND, ErodibleGround, uncover};
use rayon::prelude::*;
use std::f64::consts::SQRT_2;

/// Neighbours of a cell: what is moved to each of them may be as much as one part in so many of the excess, so that all
/// together never overshoot.
const NEIGHBOURS: f64 = 8.0;

/// How ground slides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slides {
    /// Steepest drop to the four nearest neighbours.
    drop: f64,
    /// Part of an excess that moves in a step, 0..=1/8.
    part: f64,
}

impl Slides {
    /// Slides to an angle.
    ///
    /// - `angle`: degrees, 0 to below 90. `rate`: 0..=1. `spacing`: of neighbours, in the unit of the heights.
    pub(super) fn new(angle: f64, rate: f64, spacing: f64) -> Slides {
        let slope = if angle > 0.0 { angle.to_radians().tan() } else { 0.0 };
        Slides { drop: slope * spacing, part: rate / NEIGHBOURS }
    }

    /// Lets ground slide for a step.
    ///
    /// A pair of neighbours with the difference of height x at the distance d exchanges part * (|x| - d tan(repose)),
    /// if that is positive. As no part is above 1/8, the new height of a cell grows with each of the nine old ones:
    /// none leaves their range, whatever the terrain. The edge of the grid is a wall.
    ///
    /// - `is_cancelled`: asked for each band; what is cancelled has no meaning.
    ///
    /// # Source
    /// Talus slopes: Musgrave, Kolb and Mace 1989; the limit of the exchange is ours.
    pub(super) fn step(&self, ground: &mut ErodibleGround, is_cancelled: &(dyn Fn() -> bool + Sync)) {
        let columns = ground.columns;
        let (bed, rows) = (&ground.bed, ground.rows);
        let rock = ground.rock.par_chunks_mut(BAND * columns);
        ground.next.par_chunks_mut(BAND * columns).zip(rock).enumerate().for_each(|(band, (next, rock))| {
            if is_cancelled() {
                return;
            }
            for (offset, (next, rock)) in next.chunks_mut(columns).zip(rock.chunks_mut(columns)).enumerate() {
                let row = band * BAND + offset;
                let of = |row: usize| &bed[row * columns..(row + 1) * columns];
                if row > 0 && row + 1 < rows {
                    self.inner_row([of(row - 1), of(row), of(row + 1)], next);
                    for column in [0, columns - 1] {
                        next[column] = self.edge_cell(bed, [columns, rows], [column, row]);
                    }
                } else {
                    for (column, next) in next.iter_mut().enumerate() {
                        *next = self.edge_cell(bed, [columns, rows], [column, row]);
                    }
                }
                uncover(rock, next);
            }
        });
        ground.step();
    }

    /// Heights of a row after a step, without the first and the last of them.
    fn inner_row(&self, [north, own, south]: [&[f64]; 3], next: &mut [f64]) {
        let Some(inner) = own.len().checked_sub(2) else { return };
        let (near, far) = (self.drop, self.drop * SQRT_2);
        let [nw, n, ne] = [0, 1, 2].map(|from| &north[from..from + inner]);
        let [w, here, e] = [0, 1, 2].map(|from| &own[from..from + inner]);
        let [sw, s, se] = [0, 1, 2].map(|from| &south[from..from + inner]);
        let next = &mut next[1..=inner];
        for cell in 0..inner {
            let h = here[cell];
            let nearest = (excess(w[cell] - h, near) + excess(e[cell] - h, near))
                + (excess(n[cell] - h, near) + excess(s[cell] - h, near));
            let diagonal = (excess(nw[cell] - h, far) + excess(se[cell] - h, far))
                + (excess(ne[cell] - h, far) + excess(sw[cell] - h, far));
            next[cell] = h + self.part * (nearest + diagonal);
        }
    }

    /// The height of a cell after a step, with those neighbours that it has, in the same order of sums.
    fn edge_cell(&self, bed: &[f64], [columns, rows]: [usize; 2], [column, row]: [usize; 2]) -> f64 {
        let h = bed[row * columns + column];
        let (near, far) = (self.drop, self.drop * SQRT_2);
        let of = |x: isize, z: isize, drop: f64| {
            let at = (column.checked_add_signed(x), row.checked_add_signed(z));
            let (Some(column), Some(row)) = at else { return 0.0 };
            if column < columns && row < rows { excess(bed[row * columns + column] - h, drop) } else { 0.0 }
        };
        let nearest = (of(-1, 0, near) + of(1, 0, near)) + (of(0, -1, near) + of(0, 1, near));
        let diagonal = (of(-1, -1, far) + of(1, 1, far)) + (of(1, -1, far) + of(-1, 1, far));
        h + self.part * (nearest + diagonal)
    }
}

/// By how much a difference of height goes beyond a drop, up or down.
#[inline(always)]
fn excess(difference: f64, drop: f64) -> f64 {
    let (up, down) = (difference - drop, difference + drop);
    (if up > 0.0 { up } else { 0.0 }) + if down < 0.0 { down } else { 0.0 }
}
