//! How much memory the process may hold.

use super::counted::{self, held};
use std::sync::atomic::{AtomicU64, Ordering};

/// Part of the limit that is left to what is not counted: gaps between blocks, stacks.
const UNCOUNTED: u64 = 32;

/// What the process may hold, bytes.
static LIMIT: AtomicU64 = AtomicU64::new(u64::MAX);

/// Something would take more memory than is left.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{what} would take {} of memory, and {} of {} are left (--memory SIZE sets how much there is)",
    readable(*bytes), readable(*left), readable(*limit)
)]
pub struct MemoryExceeded {
    /// What was to be done.
    pub what: String,
    /// Bytes that it would take.
    pub bytes: u64,
    /// Bytes that are left.
    pub left: u64,
    /// Bytes that the process may hold.
    pub limit: u64,
}

/// From now on the process may hold this many bytes, code, stacks and gaps between blocks included. Memory beyond is
/// refused before it is taken: see [`reserve`].
///
/// It counts only in a program whose global allocator is [`super::Counted`].
///
/// - `exceeded`: called where memory is wanted all the same, with the bytes that were wanted at last; it may take memory,
///   but not wait for the thread that calls it.
pub fn limit_to(limit: u64, exceeded: fn(u64) -> !) {
    LIMIT.store(limit, Ordering::Relaxed);
    let beside = resident().unwrap_or(0).saturating_sub(held());
    counted::refuse_beyond(limit.saturating_sub(beside + limit / UNCOUNTED), exceeded);
}

/// Bytes that the process may hold; none without a limit.
pub fn limit() -> Option<u64> {
    Some(LIMIT.load(Ordering::Relaxed)).filter(|limit| *limit != u64::MAX)
}

/// Bytes that are left; more than there can be without a limit.
pub fn left() -> u64 {
    counted::most_allowed().map_or(u64::MAX, |most| most.saturating_sub(held()))
}

/// Asks whether there are so many bytes, before they are taken.
///
/// - `what`: the subject of the sentence that refuses them.
///
/// # Errors
/// [`MemoryExceeded`] where fewer are left.
pub fn reserve(bytes: u64, what: impl FnOnce() -> String) -> Result<(), MemoryExceeded> {
    let left = left();
    if bytes <= left {
        return Ok(());
    }
    Err(MemoryExceeded { what: what(), bytes, left, limit: limit().unwrap_or(left) })
}

/// Most bytes that the process held at once, as the system saw it: code and stacks are in it. On systems that do not tell,
/// what was counted.
pub fn peak() -> u64 {
    status("VmHWM:").unwrap_or_else(counted::most_held)
}

/// Bytes of the machine, or fewer where its operator gives the process less; none where the system does not tell.
pub fn machine() -> Option<u64> {
    let first_number = |text: String| text.split_whitespace().find_map(|word| word.parse::<u64>().ok());
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let all = read("/proc/meminfo").and_then(first_number).map(|kibibytes| kibibytes << 10);
    let group = read("/sys/fs/cgroup/memory.max").and_then(first_number);
    all.into_iter().chain(group).min()
}

/// Bytes that the process holds now, as the system sees it.
fn resident() -> Option<u64> {
    status("VmRSS:")
}

/// A line of what the system tells of the process, in bytes.
fn status(line: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes = text.lines().find_map(|found| found.strip_prefix(line))?.trim().strip_suffix("kB")?;
    kibibytes.trim().parse::<u64>().ok().map(|kibibytes| kibibytes << 10)
}

/// Bytes in words, with three digits at least: `812 MiB`, `5.37 GiB`.
pub fn readable(bytes: u64) -> String {
    const UNITS: [&str; 7] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let unit = (bytes.max(1).ilog2() / 10) as usize;
    let number = bytes as f64 / 2f64.powi(10 * unit as i32);
    let digits = if unit == 0 || number >= 99.95 {
        0
    } else if number >= 9.995 {
        1
    } else {
        2
    };
    format!("{number:.digits$} {}", UNITS[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_bytes_are_readable() {
        let of = [0, 1023, 1024, 10 << 10, 1 << 20, 812 << 20, 5_766_000_000, u64::MAX].map(readable);
        let expected = ["0 bytes", "1023 bytes", "1.00 KiB", "10.0 KiB", "1.00 MiB", "812 MiB", "5.37 GiB", "16.0 EiB"];
        assert_eq!(of, expected);
    }

    #[test]
    fn without_a_limit_everything_is_granted() {
        assert_eq!((limit(), left()), (None, u64::MAX));
        assert_eq!(reserve(u64::MAX, || unreachable!("granted")), Ok(()));
    }

    #[test]
    fn a_refusal_says_what_would_be_needed() {
        let excess = MemoryExceeded { what: "a.png".into(), bytes: 5 << 30, left: 200 << 20, limit: 256 << 20 };
        let text = "a.png would take 5.00 GiB of memory, and 200 MiB of 256 MiB are left (--memory SIZE sets how much there is)";
        assert_eq!(excess.to_string(), text);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_system_tells_what_there_is() {
        let (peak, resident, machine) = (peak(), resident().expect("told"), machine().expect("told"));
        assert!(peak >= resident && resident > 1 << 20 && machine > peak);
    }
}
