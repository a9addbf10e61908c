//! A cache of values that are functions of their keys, with a limit to what they take.
//!
//! When there is too much, those go first whose return would cost the least for the room that they give: of each value the
//! time to make it, over its bytes, times how often it was used, counted on top of what that was for those that had gone when
//! it was used last. So what is used now and then, is small or takes long to make outlives what was seen once.
//!
//! # Source
//! Cherkasova, "Improving WWW Proxies Performance with Greedy-Dual-Size-Frequency Caching Policy", HP Labs 1998.

use rustc_hash::{FxHashMap, FxHasher};
use serde::Serialize;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

/// Threads seldom ask the same one of so many tables.
const TABLES: usize = 32;
/// When there is too much, values go until so much of the limit is taken.
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
    /// Seconds a byte, times uses, of what went last: the bits of a number that only grows.
    passed: AtomicU64,
    tidying: Mutex<()>,
}

/// A value that was made.
pub(super) struct MadeValue<V> {
    pub(super) value: V,
    /// What it takes while it is kept, bytes.
    pub(super) bytes: u64,
    /// What it took to make it, seconds.
    pub(super) seconds: f64,
}

/// The place of a value.
struct Slot<V> {
    value: OnceLock<SlotValue<V>>,
    /// How often something had been made when it was used last.
    used: AtomicU64,
    /// How often it was used, where uses count once until something else is made.
    uses: AtomicU64,
    /// What had passed when it was used last: the bits of a number.
    passed: AtomicU64,
}

struct SlotValue<V> {
    value: Arc<V>,
    bytes: u64,
    seconds: f64,
}

impl<K: Copy + Eq + Hash, V> DetailCache<K, V> {
    pub(super) fn new(most_bytes: u64) -> DetailCache<K, V> {
        DetailCache {
            tables: (0..TABLES).map(|_| RwLock::default()).collect(),
            most_bytes,
            bytes: AtomicU64::new(0),
            made: AtomicU64::new(0),
            passed: AtomicU64::new(0),
            tidying: Mutex::new(()),
        }
    }

    /// A value; if it is not there, it is made. Who asks for it meanwhile waits.
    ///
    pub(super) fn get(&self, key: K, make: impl FnOnce() -> MadeValue<V>) -> Arc<V> {
        let slot = self.slot(key);
        let mut is_new = false;
        let SlotValue { value, .. } = slot.value.get_or_init(|| {
            is_new = true;
            let MadeValue { value, bytes, seconds } = make();
            // Counted before it is seen: whoever sees it may let it go.
            let now = self.made.fetch_add(1, Ordering::Relaxed) + 1;
            self.note_use(&slot, now);
            self.bytes.fetch_add(bytes, Ordering::Relaxed);
            SlotValue { value: Arc::new(value), bytes, seconds }
        });
        let now = self.made.load(Ordering::Relaxed);
        if is_new {
            self.tidy();
        } else if slot.used.load(Ordering::Relaxed) != now {
            // Written only when it changes: all threads read it.
            self.note_use(&slot, now);
        }
        value.clone()
    }

    /// - `now`: how often something was made by now.
    fn note_use(&self, slot: &Slot<V>, now: u64) {
        slot.used.store(now, Ordering::Relaxed);
        slot.uses.fetch_add(1, Ordering::Relaxed);
        slot.passed.store(self.passed.load(Ordering::Relaxed), Ordering::Relaxed);
    }

    fn slot(&self, key: K) -> Arc<Slot<V>> {
        let mut hasher = FxHasher::default();
        key.hash(&mut hasher);
        let table = &self.tables[(hasher.finish() >> 32) as usize % TABLES];
        if let Some(slot) = table.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return slot.clone();
        }
        let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
        let new = || Arc::new(Slot::new());
        table.entry(key).or_insert_with(new).clone()
    }

    /// Lets go of what is worth the least, if there is too much.
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
            let known = |(key, slot): (&K, &Arc<Slot<V>>)| {
                Some(Candidate { used: slot.used.load(Ordering::Relaxed), worth: slot.worth()?, place, key: *key })
            };
            all.extend(table.iter().filter_map(known));
        }
        all.sort_by_key(|candidate| candidate.used);
        all.truncate(all.len().saturating_sub(ALWAYS_KEPT));
        all.sort_by(|a, b| a.worth.total_cmp(&b.worth).then(a.used.cmp(&b.used)));
        for Candidate { worth, place, key, .. } in all {
            if self.bytes.load(Ordering::Relaxed) <= goal {
                break;
            }
            let gone = self.tables[place].write().unwrap_or_else(PoisonError::into_inner).remove(&key);
            let bytes = gone.as_ref().and_then(|slot| slot.value.get()).map_or(0, |made| made.bytes);
            self.bytes.fetch_sub(bytes, Ordering::Relaxed);
            // Of numbers that are not negative the bits have their order.
            self.passed.fetch_max(worth.to_bits(), Ordering::Relaxed);
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

/// A value that may go.
struct Candidate<K> {
    used: u64,
    worth: f64,
    /// Number of its table.
    place: usize,
    key: K,
}

impl<V> Slot<V> {
    fn new() -> Slot<V> {
        let zero = || AtomicU64::new(0);
        Slot { value: OnceLock::new(), used: zero(), uses: zero(), passed: zero() }
    }

    /// What its value is worth; none before it is made.
    fn worth(&self) -> Option<f64> {
        let SlotValue { bytes, seconds, .. } = self.value.get()?;
        let uses = self.uses.load(Ordering::Relaxed) as f64;
        Some(f64::from_bits(self.passed.load(Ordering::Relaxed)) + uses * seconds.max(0.0) / (*bytes).max(1) as f64)
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

    fn made(value: u64, bytes: u64, seconds: f64) -> MadeValue<u64> {
        MadeValue { value, bytes, seconds }
    }

    #[test]
    fn values_are_those_of_their_keys_whatever_is_kept_and_no_more_is_kept_than_may_be() {
        for most in [0, 1_000, 1 << 40] {
            let cache: DetailCache<u64, u64> = DetailCache::new(most);
            let ask = |number: u64| {
                let key = number * number % 257;
                let value = cache.get(key, || made(key * 3, 100, key as f64));
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

    /// Whether a value is kept.
    fn keeps(cache: &DetailCache<u64, u64>, key: u64) -> bool {
        cache.slot(key).value.get().is_some()
    }

    #[test]
    fn what_is_used_often_outlives_what_is_seen_once() {
        let cache = DetailCache::new(1_000);
        for key in 1..100 {
            cache.get(key, || made(key, 100, 1.0));
            cache.get(0, || made(0, 100, 1.0));
        }
        assert!(keeps(&cache, 0) && keeps(&cache, 99) && !keeps(&cache, 50));
        assert_eq!(cache.costs().made, 100);
    }

    #[test]
    fn what_takes_long_to_make_for_its_bytes_outlives_what_is_soon_made_again_but_not_for_ever() {
        let cache = DetailCache::new(1_000);
        cache.get(0, || made(0, 100, 10.0));
        cache.get(1, || made(1, 500, 10.0));
        for key in 2..40 {
            cache.get(key, || made(key, 100, 1.0));
        }
        assert!(keeps(&cache, 0) && !keeps(&cache, 1));
        for key in 40..400 {
            cache.get(key, || made(key, 100, 1.0));
        }
        assert!(!keeps(&cache, 0), "it was not used for long");
    }
}
