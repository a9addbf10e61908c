//! What both programs ask of the system about themselves: signals, parents, memory; and the widest instructions of the
//! processor.

pub mod widest;

use std::io;

/// Whether the process ignores a signal. One that was started by `nohup` ignores a hang-up, which then is no reason to
/// end.
///
/// - `signal`: its number, 1 to 64.
///
/// Returns false where the system does not tell.
pub fn is_ignored(signal: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    // Signal n is bit n - 1.
    signal.checked_sub(1).and_then(|bit| mask.checked_shr(bit)).is_some_and(|rest| rest & 1 == 1)
}

/// From now on the system kills this process when the thread that started it ends, however that ends, even if this
/// process is stopped. Files of sockets stay.
///
/// A parent that ended before this call is not noticed. Only Linux knows such a thing; elsewhere nothing is done.
///
/// # Errors
/// Those of the system.
pub fn end_with_parent() -> io::Result<()> {
    #[cfg(target_os = "linux")]
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL))?;
    Ok(())
}

/// Gives memory that was freed back to the system, where the allocator would keep it for later.
pub fn return_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: malloc_trim takes a number, locks the heaps as malloc does, and touches only memory that is free.
    unsafe {
        libc::malloc_trim(0);
    }
}

#[cfg(test)]
mod tests {
    /// Resident memory of this process, bytes.
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn resident() -> usize {
        let pages = std::fs::read_to_string("/proc/self/statm").expect("the system tells");
        pages.split(' ').nth(1).expect("two numbers").parse::<usize>().expect("a number") * 4096
    }

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn freed_memory_goes_back_although_some_of_it_is_kept() {
        const COUNT: usize = 100_000;
        let mut pieces: Vec<Vec<u8>> = (0..COUNT).map(|_| vec![1; 1000]).collect();
        // The last piece keeps the heap from shrinking by itself.
        pieces.drain(..COUNT - 1);
        let before = resident();
        super::return_memory();
        let after = resident();
        assert!(after + COUNT * 900 < before, "{before} bytes, then {after}; {} piece left", pieces.len());
    }
}
