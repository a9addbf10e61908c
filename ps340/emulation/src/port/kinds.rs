//! Sets of kinds of message, for the tables of inputs.

use protocol::Kind;
use std::fmt;

/// A set of kinds of message.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct KindSet(u16);

impl KindSet {
    /// No kind; the input of a hidden port.
    pub const NONE: KindSet = KindSet(0);
    /// Every kind.
    pub const ANY: KindSet = KindSet::of(&Kind::ALL);
    /// TRUE and FALSE.
    pub const BOOLEAN: KindSet = KindSet::of(&[Kind::Boolean]);
    /// Integers only.
    pub const INTEGER: KindSet = KindSet::of(&[Kind::Integer]);
    /// Integers and reals.
    pub const NUMBER: KindSet = KindSet::of(&[Kind::Integer, Kind::Real]);
    /// Strings.
    pub const STRING: KindSet = KindSet::of(&[Kind::String]);
    /// Kinds whose values are as large as the user makes them; the network keeps an account of their bytes.
    pub const HEAVY: KindSet = KindSet::of(&[Kind::String, Kind::Vectors, Kind::Pick, Kind::Label]);
    /// 2D vectors.
    pub const VECTOR2: KindSet = KindSet::of(&[Kind::Vector2]);
    /// 3D vectors.
    pub const VECTOR3: KindSet = KindSet::of(&[Kind::Vector3]);
    /// 4D vectors.
    pub const VECTOR4: KindSet = KindSet::of(&[Kind::Vector4]);
    /// Vectors of two to four components.
    pub const VECTOR: KindSet = KindSet::of(&[Kind::Vector2, Kind::Vector3, Kind::Vector4]);
    /// Square matrices.
    pub const SQUARE: KindSet = KindSet::of(&[Kind::Matrix2, Kind::Matrix3, Kind::Matrix4]);
    /// All matrices.
    pub const MATRIX: KindSet = KindSet::SQUARE.or(KindSet::of(&[Kind::Matrix4x3]));
    /// Transformed data: a matrix or vectors.
    pub const TRANSFORM: KindSet = KindSet::of(&[Kind::Transform, Kind::Vectors]);
    /// Transformed vectors.
    pub const VECTORS: KindSet = KindSet::of(&[Kind::Vectors]);
    /// Pick lists.
    pub const PICK: KindSet = KindSet::of(&[Kind::Pick]);
    /// Labels.
    pub const LABEL: KindSet = KindSet::of(&[Kind::Label]);

    /// The set of some kinds.
    pub const fn of(kinds: &[Kind]) -> KindSet {
        let mut set = 0;
        let mut i = 0;
        while i < kinds.len() {
            set |= 1 << kinds[i] as u16;
            i += 1;
        }
        KindSet(set)
    }

    /// Either set.
    pub const fn or(self, other: KindSet) -> KindSet {
        KindSet(self.0 | other.0)
    }

    /// One bit for each kind, by its index in [`Kind::ALL`]; 16 at most.
    pub(super) const fn bits(self) -> u32 {
        self.0 as u32
    }

    /// Whether a kind is in the set.
    pub const fn contains(self, kind: Kind) -> bool {
        self.0 & (1 << kind as u16) != 0
    }

    /// The kinds of the set, in the order of [`Kind::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Kind> {
        Kind::ALL.into_iter().filter(move |&kind| self.contains(kind))
    }
}

impl fmt::Display for KindSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == KindSet::ANY {
            return f.write_str("any");
        }
        for (i, kind) in self.iter().enumerate() {
            if i > 0 {
                f.write_str(" or ")?;
            }
            write!(f, "{kind}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for KindSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_hold_what_they_were_made_of_and_read_as_words() {
        assert!(Kind::ALL.into_iter().all(|k| KindSet::ANY.contains(k) && !KindSet::NONE.contains(k)));
        assert_eq!(KindSet::MATRIX.iter().count(), 4);
        assert_eq!(KindSet::NUMBER.to_string(), "integer or real");
        assert_eq!(KindSet::ANY.to_string(), "any");
    }
}
