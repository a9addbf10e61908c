//! Large pages.

/// Asks the system for large pages under memory that is about to be written for the first time.
///
/// Without, each page of 4 KiB is a fault of its own: an eighth of the time of a large picture by scan line. Nothing but time
/// depends on it; systems other than Linux do without.
pub fn prefer_large_pages<T>(memory: &mut [T]) {
    #[cfg(target_os = "linux")]
    {
        /// Advice is given about whole pages.
        const PAGE: usize = 4096;
        let begin = memory.as_mut_ptr().cast::<u8>();
        let skipped = begin.align_offset(PAGE);
        let size = size_of_val(memory).saturating_sub(skipped) / PAGE * PAGE;
        if size > 0 {
            // SAFETY: The pages lie within the slice, and what they hold stays the same. Where the system does not know
            // large pages, it says so and nothing has happened.
            let _ = unsafe { rustix::mm::madvise(begin.add(skipped).cast(), size, rustix::mm::Advice::LinuxHugepage) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = memory;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_memory_holds_stays_the_same() {
        for size in [0, 1, 5000, 3 << 20] {
            let mut numbers: Vec<u32> = (0..size).collect();
            prefer_large_pages(&mut numbers);
            assert!(numbers.iter().zip(0..).all(|(number, expected)| *number == expected));
            prefer_large_pages(&mut numbers[size as usize / 3..]);
            assert_eq!(numbers.len(), size as usize);
        }
    }
}
