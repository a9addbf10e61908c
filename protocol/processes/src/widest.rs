//! Running numeric work with the widest instructions of the processor.

/// Work that is compiled for plain and for wide instructions.
///
/// The bits of the result are the same, because no operation is reordered, and what is fused is fused in all: where
/// the processor cannot fuse, the mathematical library computes the same bits, some twenty times slower.
pub trait Work {
    /// Does the work; to be marked `#[inline(always)]`, as all that it calls.
    fn run(self);
}

/// Does the work with AVX-512 if the processor has it, else with AVX2 and fused multiply-adds, else with plain
/// instructions.
pub fn run(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    {
        if has_avx512() {
            // SAFETY: the processor has all that this safe function asks for.
            unsafe { run_avx512(work) };
            return;
        }
        if has_avx2() {
            // SAFETY: as above.
            unsafe { run_avx2(work) };
            return;
        }
    }
    work.run();
}

/// Whether there is AVX-512 with what all processors but the first had with it: without that, registers are wasted.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    use std::arch::is_x86_feature_detected as has;
    has!("avx512f") && has!("avx512bw") && has!("avx512dq") && has!("avx512vl") && has!("fma")
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,fma")]
fn run_avx512(work: impl Work) {
    work.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_avx2(work: impl Work) {
    work.run();
}

/// Every way that this processor has, the widest first; for tests that they agree.
pub fn ways<W: Work>() -> Vec<fn(W)> {
    let mut ways: Vec<fn(W)> = vec![run];
    #[cfg(target_arch = "x86_64")]
    if has_avx2() {
        // SAFETY: the processor has all that this safe function asks for.
        ways.push(|work| unsafe { run_avx2(work) });
    }
    ways.push(W::run);
    ways
}
