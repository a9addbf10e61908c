//! Locational codes: which cube of the octree.

use std::cmp::Ordering;
use std::fmt;

/// Largest resolution: the modelling cube has at most 2^21 voxels a side. 21 digits of three bits leave one bit.
pub const MAX_DEPTH: u32 = 21;

/// The code of a cube: octal digits q1 q2 ... qi, then F to the end.
///
/// Digit q = i + 2 j + 4 k takes one bit of each coordinate, the most significant first, so that q1 names the octant
/// of the modelling cube. A cube with i digits has side 2^(N - i) voxels; one with N digits is a voxel.
///
/// Bits: q1 in 63..=61, q2 in 60..=58, and so on; behind the last digit one set bit, the mark, and zeros to the end.
/// The place of the mark tells the number of digits, so that 21 of them fit. Codes are ordered by their digits, F
/// counting as zeros, and a cube comes before what it contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LocationalCode(u64);

impl PartialOrd for LocationalCode {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for LocationalCode {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        // With the same digits the larger number has the earlier mark.
        self.digits().cmp(&other.digits()).then(other.0.cmp(&self.0))
    }
}

impl LocationalCode {
    /// The whole modelling cube: no digit, all F.
    pub const ROOT: Self = Self(1 << 63);

    /// The code of the cube of a level that holds a voxel.
    ///
    /// - `voxel`: coordinates at resolution [`MAX_DEPTH`], each below 2^21; higher bits are ignored.
    /// - `level`: number of digits, at most [`MAX_DEPTH`] (larger counts as that).
    pub fn containing(voxel: [u32; 3], level: u32) -> Self {
        let digits = spread(voxel[0]) | spread(voxel[1]) << 1 | spread(voxel[2]) << 2;
        Self::cut(digits << 1, level.min(MAX_DEPTH))
    }

    /// The cube of a level with the first digits of some bits.
    fn cut(bits: u64, level: u32) -> Self {
        let mark = 1 << (63 - 3 * level);
        Self(bits & !tail(mark) | mark)
    }

    /// The code with some bits; `None` if there is none.
    pub fn from_bits(bits: u64) -> Option<Self> {
        (bits != 0 && bits.trailing_zeros().is_multiple_of(3)).then_some(Self(bits))
    }

    /// All bits; see the type for their meaning.
    pub fn bits(self) -> u64 {
        self.0
    }

    /// The digits without the mark: the bits of the first voxel in the cube.
    #[inline]
    fn digits(self) -> u64 {
        self.0 & (self.0 - 1)
    }

    /// Says whether the cube begins in the order before another one ends; then it lies before it, or in it, or around
    /// it.
    #[inline]
    pub fn begins_before_end_of(self, other: Self) -> bool {
        self.digits() <= other.digits() | tail(other.mark())
    }

    fn mark(self) -> u64 {
        self.0 & self.0.wrapping_neg()
    }

    /// Number of digits before the F tail: 0 for the modelling cube.
    #[inline]
    pub fn level(self) -> u32 {
        (63 - self.0.trailing_zeros()) / 3
    }

    /// One digit, 0..=7; `position` counts from 1. `None` where the F tail begins.
    pub fn digit(self, position: u32) -> Option<u8> {
        (1..=self.level()).contains(&position).then(|| ((self.0 >> (64 - 3 * position)) & 7) as u8)
    }

    /// Lowest corner of the cube, in voxels of resolution [`MAX_DEPTH`].
    pub fn corner(self) -> [u32; 3] {
        let digits = self.digits() >> 1;
        [gather(digits), gather(digits >> 1), gather(digits >> 2)]
    }

    /// Side of the cube, in voxels of resolution [`MAX_DEPTH`].
    pub fn side(self) -> u32 {
        1 << (MAX_DEPTH - self.level())
    }

    /// The octant of this cube with a digit 0..=7; `None` at [`MAX_DEPTH`].
    pub fn child(self, digit: u8) -> Option<Self> {
        let level = self.level() + 1;
        (level <= MAX_DEPTH).then(|| Self::cut(self.digits() | u64::from(digit & 7) << (64 - 3 * level), level))
    }

    /// The cube that this one is an octant of; `None` for the modelling cube.
    pub fn parent(self) -> Option<Self> {
        self.level().checked_sub(1).map(|level| self.ancestor(level))
    }

    /// The cube of a lower level that contains this one (itself from its own level on).
    pub fn ancestor(self, level: u32) -> Self {
        if level >= self.level() { self } else { Self::cut(self.0, level) }
    }

    /// The cube of the same size that lies so many sides away along each axis; `None` beyond the modelling cube.
    pub fn shifted(self, sides: [i8; 3]) -> Option<Self> {
        let (corner, side) = (self.corner(), i64::from(self.side()));
        let mut voxel = [0; 3];
        for axis in 0..3 {
            let place = i64::from(corner[axis]) + i64::from(sides[axis]) * side;
            voxel[axis] = u32::try_from(place).ok().filter(|&x| x < 1 << MAX_DEPTH)?;
        }
        Some(Self::containing(voxel, self.level()))
    }

    /// Whether another cube lies in this one, or is it.
    pub fn contains(self, other: Self) -> bool {
        other.level() >= self.level() && (self.0 ^ other.0) & !tail(self.mark()) == 0
    }

    /// Number of leading digits that two codes share, F not counted.
    pub fn common_digits(self, other: Self) -> u32 {
        let difference = self.digits() ^ other.digits();
        (difference.leading_zeros() / 3).min(self.level()).min(other.level())
    }
}

/// The bits from a mark to the end.
#[inline]
fn tail(mark: u64) -> u64 {
    mark | (mark - 1)
}

impl fmt::Display for LocationalCode {
    /// Writes the digits, and one F for the tail if there is one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for position in 1..=self.level() {
            write!(f, "{}", self.digit(position).unwrap_or(0))?;
        }
        if self.level() < MAX_DEPTH { f.write_str("F") } else { Ok(()) }
    }
}

/// Moves bit n of a number below 2^21 to bit 3n.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x) & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// The inverse of [`spread`].
fn gather(x: u64) -> u32 {
    let mut x = x & 0x1249_2492_4924_9249;
    x = (x | x >> 2) & 0x10c3_0c30_c30c_30c3;
    x = (x | x >> 4) & 0x100f_00f0_0f00_f00f;
    x = (x | x >> 8) & 0x001f_0000_ff00_00ff;
    x = (x | x >> 16) & 0x001f_0000_0000_ffff;
    ((x | x >> 32) & 0x1f_ffff) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_interleave_i_then_j_then_k() {
        let top = 1 << (MAX_DEPTH - 1);
        for digit in 0..8_u32 {
            let voxel = [(digit & 1) * top, (digit >> 1 & 1) * top, (digit >> 2) * top];
            let code = LocationalCode::containing(voxel, MAX_DEPTH);
            assert_eq!(code.digit(1), Some(digit as u8));
            assert_eq!(code.corner(), voxel);
            assert_eq!(LocationalCode::containing(voxel, 1).to_string(), format!("{digit}F"));
        }
    }

    #[test]
    fn corner_and_code_are_inverse() {
        let mut x = 12345_u32;
        for level in 0..=MAX_DEPTH {
            let mut next = || {
                x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                x >> 11
            };
            let voxel = [next(), next(), next()];
            let code = LocationalCode::containing(voxel, level);
            let mask = !(code.side() - 1);
            assert_eq!(code.corner(), voxel.map(|c| c & mask));
            assert_eq!(LocationalCode::containing(code.corner(), level), code);
        }
    }

    #[test]
    fn children_lie_in_their_parent_in_order() {
        let cube = LocationalCode::containing([77_000, 5, 300_000], 7);
        let children: Vec<_> = (0..8).filter_map(|digit| cube.child(digit)).collect();
        assert_eq!(children.len(), 8);
        assert!(children.is_sorted());
        for (digit, child) in children.iter().enumerate() {
            assert_eq!(child.parent(), Some(cube));
            assert_eq!(child.digit(8), Some(digit as u8));
            assert!(cube.contains(*child) && !child.contains(cube) && cube < *child);
            assert_eq!(child.common_digits(children[0]), if digit == 0 { 8 } else { 7 });
        }
        assert_eq!(LocationalCode::ROOT.parent(), None);
        assert_eq!(LocationalCode::containing([0; 3], MAX_DEPTH).child(0), None);
    }

    #[test]
    fn a_shifted_cube_lies_beside_the_first() {
        let cube = LocationalCode::containing([1_500_000, 3, 700_000], 9);
        let side = cube.side();
        let beside = cube.shifted([1, 0, -2]).expect("inside the modelling cube");
        assert_eq!(beside.corner(), [cube.corner()[0] + side, 0, cube.corner()[2] - 2 * side]);
        assert_eq!(beside.level(), 9);
        assert_eq!(beside.shifted([-1, 0, 2]), Some(cube));
        assert_eq!(cube.shifted([0, -1, 0]), None);
        assert_eq!(LocationalCode::ROOT.shifted([0, 0, 1]), None);
    }

    #[test]
    fn only_codes_have_bits_that_are_taken() {
        let voxel = [2_097_151, 1, 1_048_576];
        for level in 0..=MAX_DEPTH {
            let code = LocationalCode::containing(voxel, level);
            assert_eq!(LocationalCode::from_bits(code.bits()), Some(code));
            assert_eq!(code.level(), level);
        }
        assert_eq!([0, 2, 4, 1 << 62].map(LocationalCode::from_bits), [None; 4]);
    }
}
