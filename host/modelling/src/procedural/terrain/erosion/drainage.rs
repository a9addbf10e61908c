//! Drainage: the order in which cells drain, and the area that drains through each of them.

use super::super::error::TerrainError;
use super::depressions::carve;
use super::receivers::{NONE, Receivers, STEPS};
use rayon::prelude::*;

/// The network of rivers of a terrain: receivers, their order, and drainage areas.
#[derive(Clone, Debug)]
pub(super) struct Drainage {
    pub(super) receivers: Receivers,
    /// All cells, each before its receiver.
    pub(super) order: Vec<u32>,
    /// Cells that drain through each cell, itself among them.
    pub(super) counts: Vec<u32>,
    /// Neighbours that drain to each cell and were not yet passed.
    waiting: Vec<u8>,
    labels: Vec<u32>,
}

impl Drainage {
    /// Bytes that it takes for each cell: directions, order, counts, waiting, labels.
    pub(super) const BYTES: u64 = 1 + 4 + 4 + 1 + 4;

    /// A network of no rivers yet.
    ///
    /// - `wander`: how much chance decides which of the ways down water takes, 0..=1.
    pub(super) fn new(size: [usize; 2], wander: f64) -> Drainage {
        let count = size[0] * size[1];
        Drainage {
            receivers: Receivers::new(size, wander),
            order: vec![0; count],
            counts: vec![0; count],
            waiting: vec![0; count],
            labels: Vec::new(),
        }
    }

    /// Finds receivers, order and areas for heights. Every cell drains to the edge: out of pits over their lowest
    /// passes.
    ///
    /// - `is_cancelled`: asked several times.
    ///
    /// # Errors
    /// [`TerrainError::Cancelled`].
    pub(super) fn find(
        &mut self,
        heights: &[f64],
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), TerrainError> {
        let stopped = || if is_cancelled() { Err(TerrainError::Cancelled) } else { Ok(()) };
        let pits = self.receivers.find(heights);
        stopped()?;
        if pits > 0 {
            self.sort();
            self.label();
            stopped()?;
            carve(&mut self.receivers, heights, &self.labels, pits);
            stopped()?;
        }
        self.sort();
        stopped()?;
        let Drainage { receivers, order, counts, .. } = self;
        counts.fill(1);
        for cell in order.iter().map(|cell| *cell as usize) {
            let receiver = receivers.of(cell);
            if receiver != cell {
                counts[receiver] += counts[cell];
            }
        }
        Ok(())
    }

    /// Puts the cells in an order in which each is before its receiver: from every source down, as far as all that
    /// drains there has been passed. What drains along a river lies together in it.
    fn sort(&mut self) {
        self.count_donors();
        let Drainage { receivers, order, waiting, .. } = self;
        let mut place = 0;
        for source in 0..order.len() {
            // What was passed on the way down from another source is marked.
            let mut cell = source;
            while waiting[cell] == 0 {
                waiting[cell] = u8::MAX;
                order[place] = cell as u32;
                place += 1;
                let receiver = receivers.of(cell);
                if receiver == cell {
                    break;
                }
                waiting[receiver] -= 1;
                cell = receiver;
            }
        }
    }

    /// Counts the neighbours that drain to each cell.
    fn count_donors(&mut self) {
        let (receivers, columns) = (&self.receivers, self.receivers.columns);
        let directions = &receivers.directions;
        self.waiting.par_chunks_mut(columns).enumerate().for_each(|(row, waiting)| {
            waiting.fill(0);
            for (opposite, [x, z]) in STEPS.iter().enumerate() {
                // The neighbour whose way here has this direction.
                let Some(row) = row.checked_add_signed(-z).filter(|row| *row < receivers.rows) else { continue };
                let neighbours = &directions[row * columns..(row + 1) * columns];
                let [first, from] = [x, &-x].map(|x| x.max(&0).unsigned_abs());
                let count = columns.saturating_sub(first + from);
                let pairs = waiting[first..first + count].iter_mut().zip(&neighbours[from..from + count]);
                pairs.for_each(|(waiting, direction)| *waiting += u8::from(*direction == opposite as u8));
            }
        });
    }

    /// Labels each cell by the pit to which it drains, 1 and more by their order; 0 for those that drain to the edge.
    fn label(&mut self) {
        let Drainage { receivers, order, labels, .. } = self;
        labels.resize(order.len(), 0);
        let mut pits = 0;
        for (cell, direction) in receivers.directions.iter().enumerate() {
            if *direction == NONE {
                let is_base = receivers.is_base(cell);
                pits += u32::from(!is_base);
                labels[cell] = if is_base { 0 } else { pits };
            }
        }
        for cell in order.iter().rev().map(|cell| *cell as usize) {
            labels[cell] = labels[receivers.of(cell)];
        }
    }
}
