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
/// Outlines of values that went go, too, if all take more than one of so many parts of the limit.
const OUTLINES: u64 = 8;
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
///
/// Of each that went, an outline stays, which may tell that it is not wanted.
pub(super) struct DetailCache<K, V, O> {
    tables: Vec<RwLock<Table<K, V, O>>>,
    most_bytes: u64,
    /// Of the values.
    bytes: AtomicU64,
    /// Places in the tables.
    slots: AtomicU64,
    /// How often something was made.
    made: AtomicU64,
    /// Seconds a byte, times uses, of what went last: the bits of a number that only grows.
    passed: AtomicU64,
    tidying: Mutex<()>,
}

/// The places of values by their keys.
type Table<K, V, O> = FxHashMap<K, Arc<Slot<V, O>>>;

/// A value that was made.
pub(super) struct MadeValue<V, O> {
    pub(super) value: V,
    /// What stays of it.
    pub(super) outline: O,
    /// What it takes while it is kept, bytes.
    pub(super) bytes: u64,
    /// What it took to make it, seconds.
    pub(super) seconds: f64,
}

/// The place of a value.
struct Slot<V, O> {
    value: OnceLock<SlotValue<V, O>>,
    /// What stayed of it when it went before.
    outline: Option<O>,
    /// How often something had been made when it was used last.
    used: AtomicU64,
    /// How often it was used, where uses count once until something else is made.
    uses: AtomicU64,
    /// What had passed when it was used last: the bits of a number.
    passed: AtomicU64,
}

struct SlotValue<V, O> {
    value: Arc<V>,
    outline: O,
    bytes: u64,
    seconds: f64,
}

impl<K: Copy + Eq + Hash, V, O: Copy> DetailCache<K, V, O> {
    /// What a place in a table takes with its outline, bytes.
    const SLOT_BYTES: u64 = (size_of::<K>() + size_of::<Slot<V, O>>() + size_of::<Arc<V>>()) as u64;

    pub(super) fn new(most_bytes: u64) -> DetailCache<K, V, O> {
        DetailCache {
            tables: (0..TABLES).map(|_| RwLock::default()).collect(),
            most_bytes,
            bytes: AtomicU64::new(0),
            slots: AtomicU64::new(0),
            made: AtomicU64::new(0),
            passed: AtomicU64::new(0),
            tidying: Mutex::new(()),
        }
    }

    /// A value; if it is not there, it is made. Who asks for it meanwhile waits. None if it is not there, and its outline
    /// tells that it is not wanted.
    pub(super) fn get(
        &self,
        key: K,
        is_wanted: impl FnOnce(&O) -> bool,
        make: impl FnOnce() -> MadeValue<V, O>,
    ) -> Option<Arc<V>> {
        let slot = self.slot(key);
        if slot.value.get().is_none() && slot.outline.as_ref().is_some_and(|outline| !is_wanted(outline)) {
            return None;
        }
        let mut is_new = false;
        let SlotValue { value, .. } = slot.value.get_or_init(|| {
            is_new = true;
            let MadeValue { value, outline, bytes, seconds } = make();
            // Counted before it is seen: whoever sees it may let it go.
            let now = self.made.fetch_add(1, Ordering::Relaxed) + 1;
            self.note_use(&slot, now);
            self.bytes.fetch_add(bytes, Ordering::Relaxed);
            SlotValue { value: Arc::new(value), outline, bytes, seconds }
        });
        let now = self.made.load(Ordering::Relaxed);
        if is_new {
            self.tidy();
        } else if slot.used.load(Ordering::Relaxed) != now {
            // Written only when it changes: all threads read it.
            self.note_use(&slot, now);
        }
        Some(value.clone())
    }

    /// - `now`: how often something was made by now.
    fn note_use(&self, slot: &Slot<V, O>, now: u64) {
        slot.used.store(now, Ordering::Relaxed);
        slot.uses.fetch_add(1, Ordering::Relaxed);
        slot.passed.store(self.passed.load(Ordering::Relaxed), Ordering::Relaxed);
    }

    fn slot(&self, key: K) -> Arc<Slot<V, O>> {
        let mut hasher = FxHasher::default();
        key.hash(&mut hasher);
        let table = &self.tables[(hasher.finish() >> 32) as usize % TABLES];
        if let Some(slot) = table.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return slot.clone();
        }
        let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
        let new = || {
            self.slots.fetch_add(1, Ordering::Relaxed);
            Arc::new(Slot::new(None))
        };
        table.entry(key).or_insert_with(new).clone()
    }

    /// Lets go of what is worth the least, if there is too much.
    fn tidy(&self) {
        let is_much = || self.all_bytes() > self.most_bytes;
        if !is_much() {
            return;
        }
        let _tidying = self.tidying.lock().unwrap_or_else(PoisonError::into_inner);
        if !is_much() {
            return;
        }
        if self.slots.load(Ordering::Relaxed) * Self::SLOT_BYTES > self.most_bytes / OUTLINES {
            self.forget_outlines();
        }
        let goal = (self.most_bytes as f64 * KEPT) as u64;
        let mut all = Vec::new();
        for (place, table) in self.tables.iter().enumerate() {
            let table = table.read().unwrap_or_else(PoisonError::into_inner);
            let known = |(key, slot): (&K, &Arc<Slot<V, O>>)| {
                Some(Candidate { used: slot.used.load(Ordering::Relaxed), worth: slot.worth()?, place, key: *key })
            };
            all.extend(table.iter().filter_map(known));
        }
        all.sort_by_key(|candidate| candidate.used);
        all.truncate(all.len().saturating_sub(ALWAYS_KEPT));
        all.sort_by(|a, b| a.worth.total_cmp(&b.worth).then(a.used.cmp(&b.used)));
        for Candidate { worth, place, key, .. } in all {
            if self.all_bytes() <= goal {
                break;
            }
            let mut table = self.tables[place].write().unwrap_or_else(PoisonError::into_inner);
            let Some(gone) = table.get_mut(&key) else { continue };
            let Some(SlotValue { outline, bytes, .. }) = gone.value.get() else { continue };
            let (outline, bytes) = (*outline, *bytes);
            *gone = Arc::new(Slot::new(Some(outline)));
            drop(table);
            self.bytes.fetch_sub(bytes, Ordering::Relaxed);
            // Of numbers that are not negative the bits have their order.
            self.passed.fetch_max(worth.to_bits(), Ordering::Relaxed);
        }
    }

    /// Forgets the outlines of values that went.
    fn forget_outlines(&self) {
        for table in &self.tables {
            let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
            let before = table.len();
            // Whoever else has one may be about to give it a value.
            table.retain(|_, slot| slot.value.get().is_some() || Arc::strong_count(slot) > 1);
            self.slots.fetch_sub((before - table.len()) as u64, Ordering::Relaxed);
        }
    }

    /// Bytes of all values and places.
    fn all_bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed) + self.slots.load(Ordering::Relaxed) * Self::SLOT_BYTES
    }

    /// What it costs by now.
    pub(super) fn costs(&self) -> DetailCosts {
        let kept = |table: &RwLock<Table<K, V, O>>| {
            table.read().unwrap_or_else(PoisonError::into_inner).values().filter(|s| s.value.get().is_some()).count()
        };
        DetailCosts {
            made: self.made.load(Ordering::Relaxed),
            kept: self.tables.iter().map(kept).sum(),
            bytes: self.all_bytes(),
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

impl<V, O> Slot<V, O> {
    fn new(outline: Option<O>) -> Slot<V, O> {
        let zero = || AtomicU64::new(0);
        Slot { value: OnceLock::new(), outline, used: zero(), uses: zero(), passed: zero() }
    }

    /// What its value is worth; none before it is made.
    fn worth(&self) -> Option<f64> {
        let SlotValue { bytes, seconds, .. } = self.value.get()?;
        let uses = self.uses.load(Ordering::Relaxed) as f64;
        Some(f64::from_bits(self.passed.load(Ordering::Relaxed)) + uses * seconds.max(0.0) / (*bytes).max(1) as f64)
    }
}

impl<K, V, O> fmt::Debug for DetailCache<K, V, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a cache of {} bytes", self.most_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    /// Bytes of a value, far more than a place of the cache takes.
    const MIB: u64 = 1 << 20;

    type Values = DetailCache<u64, u64, u64>;

    fn made(value: u64, bytes: u64, seconds: f64) -> MadeValue<u64, u64> {
        MadeValue { value, outline: value, bytes, seconds }
    }

    /// Asks for a value of a mebibyte that takes a second, as one who wants it in any case.
    fn ask(cache: &Values, key: u64) -> Arc<u64> {
        cache.get(key, |_| true, || made(key, MIB, 1.0)).expect("it is wanted")
    }

    #[test]
    fn values_are_those_of_their_keys_whatever_is_kept_and_no_more_is_kept_than_may_be() {
        for most in [0, 10 * MIB, 1 << 40] {
            let cache = Values::new(most);
            let ask = |number: u64| {
                let key = number * number % 257;
                let value = cache.get(key, |_| true, || made(key * 3, MIB, key as f64));
                assert_eq!(value.as_deref(), Some(&(key * 3)));
            };
            (0..20_000_u64).into_par_iter().for_each(ask);
            let costs = cache.costs();
            // Those that are used last stay, and each thread may have one more in its hands.
            let threads = rayon::current_num_threads() as u64;
            assert!(costs.bytes <= most.max(2 * MIB) + MIB * (threads + 1), "{costs:?}");
            assert_eq!(costs.bytes / MIB, costs.kept as u64, "places take less than one value");
            let is_enough = most == 1 << 40;
            assert_eq!(costs.made == costs.kept as u64, is_enough, "{costs:?}");
        }
    }

    #[test]
    fn what_went_is_not_made_again_where_its_outline_tells_that_it_is_not_wanted() {
        let cache = Values::new(4 * MIB);
        (0..20).for_each(|key| _ = ask(&cache, key));
        let before = cache.costs();
        assert!(!keeps(&cache, 3) && before.kept <= 4, "{before:?}");
        assert_eq!(cache.get(3, |outline| *outline != 3, || unreachable!()), None);
        assert_eq!(cache.costs(), before);
        assert_eq!(cache.get(19, |_| false, || unreachable!()).as_deref(), Some(&19), "it is there");
        assert_eq!(cache.get(20, |_| false, || made(20, MIB, 1.0)).as_deref(), Some(&20), "it has no outline yet");
        assert_eq!(cache.get(3, |outline| *outline == 3, || made(3, MIB, 1.0)).as_deref(), Some(&3));
    }

    #[test]
    fn outlines_take_a_part_of_the_limit_at_the_most() {
        let most = 800 * Values::SLOT_BYTES;
        let cache = Values::new(most);
        for key in 0..10_000 {
            cache.get(key, |_| true, || made(key, Values::SLOT_BYTES, 1.0));
            assert!(cache.costs().bytes <= most + 2 * Values::SLOT_BYTES, "{:?}", cache.costs());
        }
    }

    /// Whether a value is kept.
    fn keeps(cache: &Values, key: u64) -> bool {
        cache.slot(key).value.get().is_some()
    }

    #[test]
    fn what_is_used_often_outlives_what_is_seen_once() {
        let cache = Values::new(10 * MIB);
        for key in 1..100 {
            ask(&cache, key);
            ask(&cache, 0);
        }
        assert!(keeps(&cache, 0) && keeps(&cache, 99) && !keeps(&cache, 50));
        assert_eq!(cache.costs().made, 100);
    }

    #[test]
    fn what_takes_long_to_make_for_its_bytes_outlives_what_is_soon_made_again_but_not_for_ever() {
        let cache = Values::new(10 * MIB);
        cache.get(0, |_| true, || made(0, MIB, 10.0));
        cache.get(1, |_| true, || made(1, 5 * MIB, 10.0));
        (2..40).for_each(|key| _ = ask(&cache, key));
        assert!(keeps(&cache, 0) && !keeps(&cache, 1));
        (40..400).for_each(|key| _ = ask(&cache, key));
        assert!(!keeps(&cache, 0), "it was not used for long");
    }
}
