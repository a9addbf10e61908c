//! Locational codes: which cube of the octree.

use std::fmt;

/// Largest resolution: the modelling cube has at most 2^19 voxels a side.
pub const MAX_DEPTH: u32 = 19;

const DIGITS_SHIFT: u32 = 64 - 3 * MAX_DEPTH;
const LEVEL_MASK: u64 = 0x1f;

/// The code of a cube: octal digits q1 q2 ... qi, then F to the end.
///
/// Digit q = i + 2 j + 4 k takes one bit of each coordinate, the most significant first, so that q1 names the octant
/// of the modelling cube. A cube with i digits has side 2^(N - i) voxels; one with N digits is a voxel.
///
/// Bits: q1 in 63..=61, q2 in 60..=58, and so on to bit 7; bits 6 and 5 are zero; bits 4..=0 hold i, the number of
/// digits before the F tail. The F digits themselves are stored as zero bits. Order of the numbers is order along
/// the cubes, a cube before what it contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LocationalCode(u64);

impl LocationalCode {
    /// The whole modelling cube: no digit, all F.
    pub const ROOT: Self = Self(0);

    /// The code of the cube of a level that holds a voxel.
    ///
    /// - `voxel`: coordinates at resolution [`MAX_DEPTH`], each below 2^19; higher bits are ignored.
    /// - `level`: number of digits, at most [`MAX_DEPTH`] (larger counts as that).
    pub fn containing(voxel: [u32; 3], level: u32) -> Self {
        let level = level.min(MAX_DEPTH);
        let digits = spread(voxel[0]) | spread(voxel[1]) << 1 | spread(voxel[2]) << 2;
        let kept = if level == 0 { 0 } else { (digits << DIGITS_SHIFT) & (u64::MAX << (64 - 3 * level)) };
        Self(kept | u64::from(level))
    }

    /// Number of digits before the F tail: 0 for the modelling cube.
    pub fn level(self) -> u32 {
        (self.0 & LEVEL_MASK) as u32
    }

    /// One digit, 0..=7; `position` counts from 1. `None` where the F tail begins.
    pub fn digit(self, position: u32) -> Option<u8> {
        (1..=self.level()).contains(&position).then(|| ((self.0 >> (64 - 3 * position)) & 7) as u8)
    }

    /// All bits; see the type for their meaning.
    pub fn bits(self) -> u64 {
        self.0
    }

    /// Lowest corner of the cube, in voxels of resolution [`MAX_DEPTH`].
    pub fn corner(self) -> [u32; 3] {
        let digits = self.0 >> DIGITS_SHIFT;
        [gather(digits), gather(digits >> 1), gather(digits >> 2)]
    }

    /// Side of the cube, in voxels of resolution [`MAX_DEPTH`].
    pub fn side(self) -> u32 {
        1 << (MAX_DEPTH - self.level())
    }

    /// The eighth of this cube with a digit 0..=7; `None` at [`MAX_DEPTH`].
    pub fn child(self, digit: u8) -> Option<Self> {
        let level = self.level() + 1;
        (level <= MAX_DEPTH)
            .then(|| Self((self.0 & !LEVEL_MASK) | u64::from(digit & 7) << (64 - 3 * level) | u64::from(level)))
    }

    /// The cube that this one is an eighth of; `None` for the modelling cube.
    pub fn parent(self) -> Option<Self> {
        self.level().checked_sub(1).map(|level| self.ancestor(level))
    }

    /// The cube of a lower level that contains this one (itself from its own level on).
    pub fn ancestor(self, level: u32) -> Self {
        if level >= self.level() {
            return self;
        }
        let kept = if level == 0 { 0 } else { self.0 & (u64::MAX << (64 - 3 * level)) };
        Self(kept | u64::from(level))
    }

    /// Whether another cube lies in this one, or is it.
    pub fn contains(self, other: Self) -> bool {
        other.level() >= self.level() && other.ancestor(self.level()) == self
    }

    /// Number of leading digits that two codes share, F not counted.
    pub fn common_digits(self, other: Self) -> u32 {
        let difference = (self.0 ^ other.0) & !LEVEL_MASK;
        (difference.leading_zeros() / 3).min(self.level()).min(other.level())
    }
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

/// Moves bit n of a number below 2^19 to bit 3n.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x) & 0x7_ffff;
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
    ((x | x >> 32) & 0x7_ffff) as u32
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
                x >> 13
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
}
