//! A cache of values that are functions of their keys, with a limit to what they take.

use rustc_hash::{FxHashMap, FxHasher};
use serde::Serialize;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

/// Threads seldom ask the same one of so many tables.
const TABLES: usize = 32;
/// When there is too much, what was not used for the longest time goes until so much of the limit is taken.
const KEPT: f64 = 7.0 / 8.0;
/// What was used last stays, however much it takes: so many values.
const ALWAYS_KEPT: usize = 2;

/// What detail on demand costs by now.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DetailCosts {
    /// How often something was made, also again.
    pub made: u64,
    /// How many of these are kept.
    pub kept: usize,
    /// Bytes of those that are kept.
    pub bytes: u64,
    /// The most bytes that may be kept.
    pub most_bytes: u64,
}

/// Values by their keys. Each is made when it is first asked for; it goes when there is too much, and is made again.
pub(super) struct DetailCache<K, V> {
    tables: Vec<RwLock<FxHashMap<K, Arc<Slot<V>>>>>,
    most_bytes: u64,
    bytes: AtomicU64,
    /// How often something was made.
    made: AtomicU64,
    tidying: Mutex<()>,
}

/// The place of a value.
struct Slot<V> {
    value: OnceLock<SlotValue<V>>,
    /// How often something had been made when it was used last.
    used: AtomicU64,
}

struct SlotValue<V> {
    value: Arc<V>,
    bytes: u64,
}

impl<K: Copy + Eq + Hash, V> DetailCache<K, V> {
    pub(super) fn new(most_bytes: u64) -> DetailCache<K, V> {
        DetailCache {
            tables: (0..TABLES).map(|_| RwLock::default()).collect(),
            most_bytes,
            bytes: AtomicU64::new(0),
            made: AtomicU64::new(0),
            tidying: Mutex::new(()),
        }
    }

    /// A value; if it is not there, it is made. Who asks for it meanwhile waits.
    ///
    /// - `make`: gives it, and how many bytes it takes.
    pub(super) fn get(&self, key: K, make: impl FnOnce() -> (V, u64)) -> Arc<V> {
        let slot = self.slot(key);
        let now = self.made.load(Ordering::Relaxed);
        // Written only when it changes: all threads read it.
        if slot.used.load(Ordering::Relaxed) != now {
            slot.used.store(now, Ordering::Relaxed);
        }
        let mut is_new = false;
        let SlotValue { value, .. } = slot.value.get_or_init(|| {
            is_new = true;
            let (value, bytes) = make();
            // Counted before it is seen: whoever sees it may let it go.
            let now = self.made.fetch_add(1, Ordering::Relaxed) + 1;
            slot.used.store(now, Ordering::Relaxed);
            self.bytes.fetch_add(bytes, Ordering::Relaxed);
            SlotValue { value: Arc::new(value), bytes }
        });
        if is_new {
            self.tidy();
        }
        value.clone()
    }

    fn slot(&self, key: K) -> Arc<Slot<V>> {
        let mut hasher = FxHasher::default();
        key.hash(&mut hasher);
        let table = &self.tables[(hasher.finish() >> 32) as usize % TABLES];
        if let Some(slot) = table.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return slot.clone();
        }
        let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
        let new = || Arc::new(Slot { value: OnceLock::new(), used: AtomicU64::new(0) });
        table.entry(key).or_insert_with(new).clone()
    }

    /// Lets go of what was not used for the longest time, if there is too much.
    fn tidy(&self) {
        let is_much = || self.bytes.load(Ordering::Relaxed) > self.most_bytes;
        if !is_much() {
            return;
        }
        let _tidying = self.tidying.lock().unwrap_or_else(PoisonError::into_inner);
        if !is_much() {
            return;
        }
        let goal = (self.most_bytes as f64 * KEPT) as u64;
        let mut all = Vec::new();
        for (place, table) in self.tables.iter().enumerate() {
            let table = table.read().unwrap_or_else(PoisonError::into_inner);
            let there = table.iter().filter(|(_, slot)| slot.value.get().is_some());
            all.extend(there.map(|(key, slot)| (slot.used.load(Ordering::Relaxed), place, *key)));
        }
        all.sort_by_key(|(used, ..)| *used);
        all.truncate(all.len().saturating_sub(ALWAYS_KEPT));
        for (_, place, key) in all {
            if self.bytes.load(Ordering::Relaxed) <= goal {
                break;
            }
            let gone = self.tables[place].write().unwrap_or_else(PoisonError::into_inner).remove(&key);
            let bytes = gone.as_ref().and_then(|slot| slot.value.get()).map_or(0, |made| made.bytes);
            self.bytes.fetch_sub(bytes, Ordering::Relaxed);
        }
    }

    /// What it costs by now.
    pub(super) fn costs(&self) -> DetailCosts {
        let kept = |table: &RwLock<FxHashMap<K, Arc<Slot<V>>>>| {
            table.read().unwrap_or_else(PoisonError::into_inner).values().filter(|s| s.value.get().is_some()).count()
        };
        DetailCosts {
            made: self.made.load(Ordering::Relaxed),
            kept: self.tables.iter().map(kept).sum(),
            bytes: self.bytes.load(Ordering::Relaxed),
            most_bytes: self.most_bytes,
        }
    }
}

impl<K, V> fmt::Debug for DetailCache<K, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a cache of {} bytes", self.most_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn values_are_those_of_their_keys_whatever_is_kept_and_no_more_is_kept_than_may_be() {
        for most in [0, 1_000, 1 << 40] {
            let cache: DetailCache<u64, u64> = DetailCache::new(most);
            let ask = |number: u64| {
                let key = number * number % 257;
                let value = cache.get(key, || (key * 3, 100));
                assert_eq!(*value, key * 3);
            };
            (0..20_000_u64).into_par_iter().for_each(ask);
            let costs = cache.costs();
            // Those that are used last stay, and each thread may have one more in its hands.
            let threads = rayon::current_num_threads() as u64;
            assert!(costs.bytes <= most.max(200) + 100 * threads, "{costs:?}");
            assert_eq!(costs.bytes, 100 * costs.kept as u64);
            let is_enough = most == 1 << 40;
            assert_eq!(costs.made == costs.kept as u64, is_enough, "{costs:?}");
        }
    }

    #[test]
    fn what_was_used_last_is_kept() {
        let cache: DetailCache<u32, u32> = DetailCache::new(1_000);
        let make = |key: u32| cache.get(key, || (key, 100));
        for key in 0..10 {
            make(key);
            make(0);
        }
        let before = cache.costs().made;
        make(10);
        make(0);
        assert_eq!(cache.costs().made, before + 1, "0 is still there");
        make(1);
        assert_eq!(cache.costs().made, before + 2, "1 is gone");
    }
}
