//! An allocator that counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicI64, Ordering};

/// Bytes that a thread takes or gives back before the common count hears of them.
const BATCH: i64 = 16 << 10;
/// Bytes that the system's allocator keeps beside each block, and the steps of its sizes.
const BESIDE: usize = 8;
const STEP: usize = 16;
/// Its smallest block, bytes.
const LEAST: usize = 32;

static HELD: AtomicI64 = AtomicI64::new(0);
static PEAK: AtomicI64 = AtomicI64::new(0);
static LIMIT: AtomicI64 = AtomicI64::new(i64::MAX);
static EXCEEDED: OnceLock<fn(u64) -> !> = OnceLock::new();

thread_local! {
    /// What the common count has not heard of.
    static UNREPORTED: Cell<i64> = const { Cell::new(0) };
}

/// The system's allocator with a count of what is held, and a limit.
///
/// A program makes it its own by `#[global_allocator]`. Where nobody did, nothing is counted and nothing refused.
/// Each thread tells the common count after every 16 KiB: so much for each thread the count may be wrong.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counted;

// SAFETY: All memory comes from the system's allocator and goes back to it with its own layout. Counting takes no memory.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(size_of_block(layout.size()));
        // SAFETY: The caller's promises are those that are needed.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(size_of_block(layout.size()));
        // SAFETY: The caller's promises are those that are needed.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-size_of_block(layout.size()));
        // SAFETY: The memory came from the system's allocator with this layout.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size_of_block(size) - size_of_block(layout.size()));
        // SAFETY: The memory came from the system's allocator with this layout.
        unsafe { System.realloc(memory, layout, size) }
    }
}

/// What a block takes with all that is beside it.
fn size_of_block(size: usize) -> i64 {
    (size.saturating_add(BESIDE).saturating_add(STEP - 1) / STEP * STEP).max(LEAST) as i64
}

fn count(bytes: i64) {
    let told = UNREPORTED.try_with(|untold| {
        let sum = untold.get().saturating_add(bytes);
        let is_much = sum.abs() >= BATCH;
        untold.set(if is_much { 0 } else { sum });
        if is_much { sum } else { 0 }
    });
    // A thread that ends has no place of its own any more.
    let bytes = told.unwrap_or(bytes);
    if bytes == 0 {
        return;
    }
    let held = HELD.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
    if bytes < 0 {
        return;
    }
    if held > LIMIT.load(Ordering::Relaxed) {
        // What ends the process needs memory of its own.
        if LIMIT.swap(i64::MAX, Ordering::Relaxed) != i64::MAX
            && let Some(exceeded) = EXCEEDED.get()
        {
            exceeded(bytes.unsigned_abs());
        }
    }
    PEAK.fetch_max(held, Ordering::Relaxed);
}

/// Bytes that the process holds, as far as they are counted.
pub fn held() -> u64 {
    HELD.load(Ordering::Relaxed).max(0).unsigned_abs()
}

/// Most bytes that were counted at once.
pub(super) fn most_held() -> u64 {
    PEAK.load(Ordering::Relaxed).max(0).unsigned_abs()
}

/// From now on, whoever would hold more than `limit` bytes calls `exceeded` with what was wanted at last, once.
pub(super) fn refuse_beyond(limit: u64, exceeded: fn(u64) -> !) {
    // The first one stands: there is one program in a process.
    let _ = EXCEEDED.set(exceeded);
    LIMIT.store(i64::try_from(limit).unwrap_or(i64::MAX), Ordering::Relaxed);
}

/// The limit of what is counted; none where nothing is refused.
pub(super) fn most_allowed() -> Option<u64> {
    let limit = LIMIT.load(Ordering::Relaxed);
    (limit != i64::MAX).then_some(limit.max(0).unsigned_abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_grows_in_place_and_goes_back_is_counted() {
        // This test is not a program whose allocator counts: it asks one itself.
        let (before, megabytes) = (held(), 1 << 20);
        let layout = Layout::from_size_align(megabytes, 8).expect("a layout");
        // SAFETY: The layouts fit each other, and the memory goes back once.
        unsafe {
            let memory = Counted.alloc(layout);
            assert!(held() >= before + megabytes as u64 - 2 * BATCH as u64);
            let memory = Counted.realloc(memory, layout, 3 * megabytes);
            assert!(most_held() >= before + 3 * megabytes as u64 - 2 * BATCH as u64);
            Counted.dealloc(memory, Layout::from_size_align(3 * megabytes, 8).expect("a layout"));
            let memory = Counted.alloc_zeroed(layout);
            assert_eq!(*memory, 0);
            Counted.dealloc(memory, layout);
        }
        assert!(held() <= before + 2 * BATCH as u64);
        assert_eq!(most_allowed(), None, "nobody asked for a limit");
    }

    #[test]
    fn a_block_takes_what_the_system_gives() {
        assert_eq!([0, 1, 24, 25, 1 << 20].map(size_of_block), [32, 32, 32, 48, (1 << 20) + 16]);
    }
}
