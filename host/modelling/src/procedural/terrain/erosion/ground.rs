//! The ground that all kinds of erosion work on.

use rayon::prelude::*;

/// Rows that a thread works on at once. Nothing that is computed depends on it.
pub(super) const BAND: usize = 64;

/// Heights of cells, and what is rock of them.
#[derive(Clone, Debug)]
pub(super) struct ErodibleGround {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Heights, row by row along x.
    pub(super) bed: Vec<f64>,
    /// Place for the heights after a step.
    pub(super) next: Vec<f64>,
    /// The top of what was never moved: what lies above is deposit.
    pub(super) rock: Vec<f64>,
}

impl ErodibleGround {
    pub(super) fn new([columns, rows]: [usize; 2], heights: &[f64]) -> ErodibleGround {
        ErodibleGround { columns, rows, bed: heights.to_vec(), next: heights.to_vec(), rock: heights.to_vec() }
    }

    /// Multiplies all lengths.
    pub(super) fn scale(&mut self, by: f64) {
        for heights in [&mut self.bed, &mut self.rock] {
            heights.par_iter_mut().for_each(|height| *height *= by);
        }
    }

    /// The next heights become the heights.
    pub(super) fn step(&mut self) {
        std::mem::swap(&mut self.bed, &mut self.next);
    }

    /// Ground that was dug away uncovers rock, and is rock no more.
    pub(super) fn uncover(&mut self) {
        const PART: usize = 4096;
        let parts = self.rock.par_chunks_mut(PART).zip(self.bed.par_chunks(PART));
        parts.for_each(|(rock, bed)| uncover(rock, bed));
    }
}

/// Lowers rock to the ground above it.
pub(super) fn uncover(rock: &mut [f64], bed: &[f64]) {
    for (rock, bed) in rock.iter_mut().zip(bed) {
        *rock = if *bed < *rock { *bed } else { *rock };
    }
}
