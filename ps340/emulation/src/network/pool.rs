//! Storage for short runs of equal things, one run an instance, close together in memory.

use std::{collections::BTreeMap, ops::Range};

/// Runs of items in one vector; a run that was given back serves the next one of its length.
#[derive(Debug)]
pub(super) struct Pool<T> {
    items: Vec<T>,
    free: BTreeMap<u16, Vec<u32>>,
}

/// Where a run lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    start: u32,
    length: u16,
}

impl Run {
    /// No items.
    pub(super) const EMPTY: Run = Run { start: 0, length: 0 };

    /// The indices of the items.
    #[inline]
    pub(super) fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + usize::from(self.length)
    }
}

impl<T> Pool<T> {
    /// An empty pool.
    pub(super) const fn new() -> Pool<T> {
        Pool { items: Vec::new(), free: BTreeMap::new() }
    }

    /// Stores a run.
    ///
    /// - Returns none if there is no more space for so many items.
    pub(super) fn store(&mut self, items: impl ExactSizeIterator<Item = T>) -> Option<Run> {
        let length = u16::try_from(items.len()).ok()?;
        if let Some(start) = self.free.get_mut(&length).and_then(Vec::pop) {
            let run = Run { start, length };
            self.items[run.range()].iter_mut().zip(items).for_each(|(place, item)| *place = item);
            return Some(run);
        }
        let start = u32::try_from(self.items.len()).ok()?;
        self.items.extend(items);
        Some(Run { start, length })
    }

    /// Gives a run back, with something in each slot that holds no memory.
    pub(super) fn release(&mut self, run: Run, nothing: impl Fn() -> T) {
        if run.length > 0 {
            self.items[run.range()].fill_with(nothing);
            self.free.entry(run.length).or_default().push(run.start);
        }
    }

    /// The items of a run.
    #[inline]
    pub(super) fn get(&self, run: Run) -> &[T] {
        &self.items[run.range()]
    }

    /// The items of all runs, at their indices.
    #[inline]
    pub(super) fn items(&mut self) -> &mut [T] {
        &mut self.items
    }

    /// The items of a run.
    #[inline]
    pub(super) fn get_mut(&mut self, run: Run) -> &mut [T] {
        &mut self.items[run.range()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_given_back_serves_the_next_of_its_length_only() {
        let mut pool = Pool::new();
        let a = pool.store([1, 2].into_iter()).unwrap();
        let b = pool.store([3, 4, 5].into_iter()).unwrap();
        pool.release(a, || 0);
        let c = pool.store([6].into_iter()).unwrap();
        let d = pool.store([7, 8].into_iter()).unwrap();
        assert_eq!((d, pool.get(b), pool.get(c), pool.get(d)), (a, &[3, 4, 5][..], &[6][..], &[7, 8][..]));
    }
}
