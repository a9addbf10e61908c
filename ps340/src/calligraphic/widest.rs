//! Running numeric work with the widest instructions of the processor.

/// Work that is compiled for plain and for wide instructions.
///
/// The bits of the result are the same, because no operation is reordered, and what is fused is fused in both: where
/// the processor cannot fuse, the mathematical library computes the same bits, some twenty times slower.
pub(super) trait Work {
    /// Does the work; to be marked `#[inline(always)]`, as all that it calls.
    fn run(self);
}

/// Does the work with AVX2 and fused multiply-adds if the processor has them.
pub(super) fn run(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn run_wide(work: impl Work) {
            work.run();
        }
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
            // SAFETY: the processor has AVX2 and FMA, all that this safe function asks for.
            unsafe { run_wide(work) };
            return;
        }
    }
    work.run();
}
