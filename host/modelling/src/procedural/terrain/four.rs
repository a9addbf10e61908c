//! Four numbers side by side.

use std::ops::{Add, Mul, Sub};

/// Four numbers, on which compilers use wide instructions.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct Four(pub(super) [f64; 4]);

impl Four {
    #[inline(always)]
    pub(super) fn splat(value: f64) -> Four {
        Four([value; 4])
    }

    /// Entries `first..first + 4` of a table.
    #[inline(always)]
    pub(super) fn of<const N: usize>(table: &[f64; N], first: usize) -> Four {
        let entries = &table[first..first + 4];
        Four([entries[0], entries[1], entries[2], entries[3]])
    }

    /// The sum of all four.
    #[inline(always)]
    pub(super) fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
}

/// An operation lane by lane.
macro_rules! by_lane {
    ($operator:ident, $function:ident, $sign:tt) => {
        impl $operator for Four {
            type Output = Four;

            #[inline(always)]
            fn $function(self, other: Four) -> Four {
                let (a, b) = (self.0, other.0);
                Four([a[0] $sign b[0], a[1] $sign b[1], a[2] $sign b[2], a[3] $sign b[3]])
            }
        }
    };
}

by_lane!(Add, add, +);
by_lane!(Sub, sub, -);
by_lane!(Mul, mul, *);

impl Mul<f64> for Four {
    type Output = Four;

    #[inline(always)]
    fn mul(self, by: f64) -> Four {
        self * Four::splat(by)
    }
}

impl Add<f64> for Four {
    type Output = Four;

    #[inline(always)]
    fn add(self, other: f64) -> Four {
        self + Four::splat(other)
    }
}
