//! Entries sorted into numbered groups by counting.

/// Entries of each group, one group after the other, those of a group in the order in which they were given.
#[derive(Default)]
pub(super) struct SortedGroups<T> {
    /// Where each group begins, and where the last one ends.
    begins: Vec<u32>,
    entries: Vec<T>,
}

impl<T: Copy + Default> SortedGroups<T> {
    /// - `groups`: how many there are. `all`: the entries, each with its group; they are gone through twice.
    pub(super) fn new(groups: usize, all: impl Iterator<Item = (usize, T)> + Clone) -> SortedGroups<T> {
        let mut begins = vec![0u32; groups + 1];
        all.clone().for_each(|(group, _)| begins[group] += 1);
        let mut sum = 0;
        for begin in &mut begins {
            sum += std::mem::replace(begin, sum);
        }
        let mut ends = begins.clone();
        let mut entries = vec![T::default(); sum as usize];
        all.for_each(|(group, entry)| {
            entries[ends[group] as usize] = entry;
            ends[group] += 1;
        });
        SortedGroups { begins, entries }
    }

    /// The entries of a group.
    pub(super) fn of(&self, group: usize) -> &[T] {
        &self.entries[self.begins[group] as usize..self.begins[group + 1] as usize]
    }
}
