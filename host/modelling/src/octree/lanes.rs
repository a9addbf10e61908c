//! Eight numbers at a time, with the widest instructions of the processor.

/// Numbers in [`Lanes`].
pub const LANES: usize = 8;

/// Eight numbers at the beginning of a line of the cache.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Eight(pub [f32; LANES]);

/// One of 2^24 parts.
pub const PART: f32 = 1.0 / (1_u32 << 24) as f32;
/// The bits of the number 1.
const ONE: i32 = 127 << 23;

/// Arithmetic on eight numbers in single precision. Comparisons give one bit a lane.
///
/// Products that are added to may be rounded once or twice, so that no result may depend on the last digit.
pub trait Lanes: Copy {
    /// What proves that the processor has the instructions; only with it are there such numbers.
    type Proof: Copy;

    /// One number in every lane.
    fn splat(proof: Self::Proof, x: f32) -> Self;
    /// Eight numbers.
    fn load(proof: Self::Proof, x: &Eight) -> Self;
    /// Parts of 2^32, rounded down to 2^-24.
    fn parts(proof: Self::Proof, x: &[u32; LANES]) -> Self;
    /// For parts x of an octave, counted in 2^10 parts, 2^x and up to 6.2 % more: it is linear from octave to octave.
    fn powers(proof: Self::Proof, x: &[i16; LANES]) -> Self;
    /// The numbers lane by lane.
    fn store(self) -> Eight;
    /// Sum.
    fn plus(self, other: Self) -> Self;
    /// Difference.
    fn minus(self, other: Self) -> Self;
    /// Product.
    fn times(self, other: Self) -> Self;
    /// `self other + more`.
    fn times_plus(self, other: Self, more: Self) -> Self;
    /// `self other - less`.
    fn times_minus(self, other: Self, less: Self) -> Self;
    /// `from - self other`.
    fn times_from(self, other: Self, from: Self) -> Self;
    /// The lesser; either one if one is not a number.
    fn least(self, other: Self) -> Self;
    /// The greater; either one if one is not a number.
    fn most(self, other: Self) -> Self;
    /// This number where the other is positive, and its negative elsewhere.
    fn signed_by(self, other: Self) -> Self;
    /// Lanes where `self <= other`.
    fn is_at_most(self, other: Self) -> u32;
}

/// Asks for all lines of the cache that something lies in, before they are read one after the other.
#[inline(always)]
pub fn prefetch<T>(thing: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let begin = std::ptr::from_ref(thing).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(LINE) {
            // SAFETY: Every processor of this kind has the instruction, which changes nothing but the cache.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(begin.wrapping_add(line * LINE)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = thing;
}

/// Whatever the processor.
#[derive(Clone, Copy)]
pub struct ScalarLanes([f32; LANES]);

impl ScalarLanes {
    #[inline(always)]
    fn each(self, other: Self, of: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|lane| of(self.0[lane], other.0[lane])))
    }
}

impl Lanes for ScalarLanes {
    type Proof = ();

    #[inline(always)]
    fn splat((): (), x: f32) -> Self {
        Self([x; LANES])
    }
    #[inline(always)]
    fn load((): (), x: &Eight) -> Self {
        Self(x.0)
    }
    #[inline(always)]
    fn parts((): (), x: &[u32; LANES]) -> Self {
        Self(x.map(|x| (x >> 8) as f32 * PART))
    }
    #[inline(always)]
    fn powers((): (), x: &[i16; LANES]) -> Self {
        Self(x.map(|x| f32::from_bits((i32::from(x) << 13).wrapping_add(ONE) as u32)))
    }
    #[inline(always)]
    fn store(self) -> Eight {
        Eight(self.0)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.each(other, |a, b| a + b)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.each(other, |a, b| a - b)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self.each(other, |a, b| a * b)
    }
    #[inline(always)]
    fn times_plus(self, other: Self, more: Self) -> Self {
        self.times(other).plus(more)
    }
    #[inline(always)]
    fn times_minus(self, other: Self, less: Self) -> Self {
        self.times(other).minus(less)
    }
    #[inline(always)]
    fn times_from(self, other: Self, from: Self) -> Self {
        from.minus(self.times(other))
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.each(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.each(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn signed_by(self, other: Self) -> Self {
        self.each(other, |a, b| f32::from_bits(a.to_bits() ^ (b.to_bits() & 1 << 31)))
    }
    #[inline(always)]
    fn is_at_most(self, other: Self) -> u32 {
        (0..LANES).fold(0, |bits, lane| bits | u32::from(self.0[lane] <= other.0[lane]) << lane)
    }
}

#[cfg(target_arch = "x86_64")]
pub use wide::{Avx, AvxLanes};

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{Eight, LANES, Lanes, ONE, PART};
    use std::arch::x86_64::*;

    /// The processor has AVX2 and fused multiply-adds: whoever has one of these has asked it.
    #[derive(Clone, Copy)]
    pub struct Avx(());

    impl Avx {
        /// None where the processor has not.
        #[inline]
        pub fn detected() -> Option<Avx> {
            let has = std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma");
            has.then_some(Avx(()))
        }
    }

    /// For processors with AVX2 and fused multiply-adds.
    #[derive(Clone, Copy)]
    pub struct AvxLanes(__m256);

    /// An instruction of AVX2 or FMA on values, none on memory.
    macro_rules! instruction {
        ($call:expr) => {
            // SAFETY: numbers of this kind are made with an `Avx` only, and so the processor has the instruction.
            unsafe { $call }
        };
    }

    impl Lanes for AvxLanes {
        type Proof = Avx;

        #[inline(always)]
        fn splat(_: Avx, x: f32) -> Self {
            Self(instruction!(_mm256_set1_ps(x)))
        }
        #[inline(always)]
        fn load(_: Avx, x: &Eight) -> Self {
            // SAFETY: the `Avx` proves that there is the instruction; eight numbers are as large and aligned as it asks for.
            Self(unsafe { _mm256_load_ps(x.0.as_ptr()) })
        }
        #[inline(always)]
        fn parts(proof: Avx, x: &[u32; LANES]) -> Self {
            // SAFETY: the `Avx` proves that there are the instructions; there are eight numbers of 32 bits, at any place.
            let parts = unsafe {
                let bits = _mm256_loadu_si256(x.as_ptr().cast());
                _mm256_cvtepi32_ps(_mm256_srli_epi32::<8>(bits))
            };
            Self(parts).times(Self::splat(proof, PART))
        }
        #[inline(always)]
        fn powers(_: Avx, x: &[i16; LANES]) -> Self {
            // SAFETY: the `Avx` proves that there are the instructions; there are eight numbers of 16 bits, at any place.
            Self(unsafe {
                let wide = _mm256_cvtepi16_epi32(_mm_loadu_si128(x.as_ptr().cast()));
                _mm256_castsi256_ps(_mm256_add_epi32(_mm256_slli_epi32::<13>(wide), _mm256_set1_epi32(ONE)))
            })
        }
        #[inline(always)]
        fn store(self) -> Eight {
            let mut eight = Eight([0.0; 8]);
            // SAFETY: as numbers of this kind there is the instruction; eight numbers are as large and aligned as it asks for.
            unsafe { _mm256_store_ps(eight.0.as_mut_ptr(), self.0) };
            eight
        }
        #[inline(always)]
        fn plus(self, other: Self) -> Self {
            Self(instruction!(_mm256_add_ps(self.0, other.0)))
        }
        #[inline(always)]
        fn minus(self, other: Self) -> Self {
            Self(instruction!(_mm256_sub_ps(self.0, other.0)))
        }
        #[inline(always)]
        fn times(self, other: Self) -> Self {
            Self(instruction!(_mm256_mul_ps(self.0, other.0)))
        }
        #[inline(always)]
        fn times_plus(self, other: Self, more: Self) -> Self {
            Self(instruction!(_mm256_fmadd_ps(self.0, other.0, more.0)))
        }
        #[inline(always)]
        fn times_minus(self, other: Self, less: Self) -> Self {
            Self(instruction!(_mm256_fmsub_ps(self.0, other.0, less.0)))
        }
        #[inline(always)]
        fn times_from(self, other: Self, from: Self) -> Self {
            Self(instruction!(_mm256_fnmadd_ps(self.0, other.0, from.0)))
        }
        #[inline(always)]
        fn least(self, other: Self) -> Self {
            Self(instruction!(_mm256_min_ps(self.0, other.0)))
        }
        #[inline(always)]
        fn most(self, other: Self) -> Self {
            Self(instruction!(_mm256_max_ps(self.0, other.0)))
        }
        #[inline(always)]
        fn signed_by(self, other: Self) -> Self {
            Self(instruction!(_mm256_xor_ps(self.0, _mm256_and_ps(other.0, _mm256_set1_ps(-0.0)))))
        }
        #[inline(always)]
        fn is_at_most(self, other: Self) -> u32 {
            instruction!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0))) as u32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_powers_are_near_below_and_above_whatever_the_processor() {
        let parts = [0, 1, 255, 256, 1 << 31, u32::MAX - 255, u32::MAX, 0x1234_5678];
        let steps = [0, 1, 512, 1023, -1, -1024, 31 * 1024, -31 * 1024];
        let scalar = [ScalarLanes::parts((), &parts), ScalarLanes::powers((), &steps)].map(|lanes| lanes.store().0);
        for lane in 0..LANES {
            let off = f64::from(parts[lane]) / 4_294_967_296.0 - f64::from(scalar[0][lane]);
            assert!((0.0..1.0 / f64::from(1 << 24)).contains(&off), "{lane}: {off}");
            let more = f64::from(scalar[1][lane]) / (f64::from(steps[lane]) / 1024.0).exp2();
            assert!((1.0..1.062).contains(&more), "{lane}: {more}");
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(avx) = Avx::detected() {
            let wide = [AvxLanes::parts(avx, &parts), AvxLanes::powers(avx, &steps)].map(|lanes| lanes.store().0);
            assert_eq!(wide, scalar);
        }
    }
}
