//! What flows on the arcs of a function network and in SEND: values and their kinds.

use crate::Name;
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use std::{fmt, sync::Arc};

/// A message: one typed value.
///
/// Matrices are in the row-vector convention of the machine (`p' = p M`). glam stores columns, so
/// *row* `i` of the machine's matrix is *column* `i` of the glam matrix: `p M` is `glam * p`, and the
/// product `A B` of the machine is `glam_b * glam_a`.
///
/// Reals are held in double precision; the machine's own format was of single-precision class.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// TRUE or FALSE.
    Boolean(bool),
    /// `FIX(i)`.
    Integer(i32),
    /// A bare number.
    Real(f64),
    /// Bytes, not necessarily ASCII. At most [`MAX_STRING`] where a command or a function makes one.
    String(Box<[u8]>),
    /// `V2D(x,y)`.
    Vector2(DVec2),
    /// `V3D(x,y,z)`.
    Vector3(DVec3),
    /// `V4D(x,y,z,w)`.
    Vector4(DVec4),
    /// `M2D(...)`, rows as columns of the glam matrix.
    Matrix2(Box<DMat2>),
    /// `M3D(...)`, rows as columns of the glam matrix.
    Matrix3(Box<DMat3>),
    /// What F:LOOKAT emits: four rows of three, the last the translation. The glam form is 4x4 with a
    /// last component of 0, 0, 0, 1 in the columns.
    Matrix4x3(Box<DMat4>),
    /// `M4D(...)`, rows as columns of the glam matrix.
    Matrix4(Box<DMat4>),
    /// What F:XFORMDATA emits and F:LIST turns into lines: the accumulated matrix of an XFORM MATRIX node.
    Transform(Box<DMat4>),
    /// What F:PICK emits: what was picked. No command can express it.
    Pick(Box<PickList>),
    /// What F:LABEL emits: a label for a LABELS node. No command can express it.
    Label(Box<Label>),
    /// What F:XFORMDATA emits for an XFORM VECTOR node. Shared, since it may be long. No command can express it.
    Vectors(Arc<TransformedVectors>),
}

/// What was picked: the first thing that was drawn inside the pick box.
///
/// # Source
/// Contents as remembered from the manuals; that the index counts from 1 and the codes of the types are ours.
#[derive(Clone, Debug, PartialEq)]
pub struct PickList {
    /// Number of the vector, character, label or polygon in its data node, from 1.
    pub index: u32,
    /// The pick identifiers on the way from the data up to the root, nearest first.
    pub identifiers: Vec<Name>,
    /// The name of the data node, if it has one.
    pub node: Option<Name>,
    /// What kind of data: 1 vectors, 2 curve, 3 characters, 4 labels, 5 polygons.
    pub type_code: i32,
    /// Where it was picked, in coordinate picking.
    pub coordinates: Option<PickCoordinates>,
}

/// Where something was picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickCoordinates {
    /// The picked point, in the coordinates of the data node; z is 0 for 2D data.
    pub point: DVec3,
    /// 2 or 3: components that the data has.
    pub dimension: u8,
    /// The parameter of a curve there.
    pub parameter: Option<f64>,
}

/// One label of a LABELS node.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Lower left corner of its first cell.
    pub position: DVec3,
    /// Its text.
    pub text: Box<[u8]>,
    /// Whether it is shown.
    pub on: bool,
}

/// The vectors below an XFORM VECTOR node, after the accumulated matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransformedVectors {
    /// Each end point, in order.
    pub ends: Vec<VectorEnd>,
}

/// One end point of a list of vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VectorEnd {
    /// Whether the vector *to* the point is drawn (L) or a move (P).
    pub line: bool,
    /// The point.
    pub point: DVec3,
}

impl TransformedVectors {
    /// Some of the vectors; the first one becomes a move, since it begins a list.
    ///
    /// - `first`: number of the first vector, from 1.
    /// - `count`: how many; those beyond the end are left out.
    pub fn part(&self, first: u32, count: u32) -> TransformedVectors {
        let from = (first.max(1) as usize - 1).min(self.ends.len());
        let rest = &self.ends[from..];
        let mut ends = rest[..rest.len().min(count as usize)].to_vec();
        if let Some(start) = ends.first_mut() {
            start.line = false;
        }
        TransformedVectors { ends }
    }
}

/// Longest string that a command or a function may make, in bytes.
///
/// The manuals limit strings in commands to 240 characters; longer ones travel between functions as
/// several blocks. Ours: one limit for all.
pub const MAX_STRING: usize = 65_535;

/// The kinds of value, for port tables and messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// TRUE or FALSE.
    Boolean,
    /// A 32-bit signed integer.
    Integer,
    /// A real.
    Real,
    /// A string of bytes.
    String,
    /// A 2D vector.
    Vector2,
    /// A 3D vector.
    Vector3,
    /// A 4D vector.
    Vector4,
    /// A 2x2 matrix.
    Matrix2,
    /// A 3x3 matrix.
    Matrix3,
    /// A 4x3 matrix.
    Matrix4x3,
    /// A 4x4 matrix.
    Matrix4,
    /// Transformed data: a matrix.
    Transform,
    /// A pick list.
    Pick,
    /// A label.
    Label,
    /// Transformed data: vectors.
    Vectors,
}

impl Kind {
    /// Every kind, in the order of the enumeration.
    pub const ALL: [Kind; 15] = [
        Kind::Boolean,
        Kind::Integer,
        Kind::Real,
        Kind::String,
        Kind::Vector2,
        Kind::Vector3,
        Kind::Vector4,
        Kind::Matrix2,
        Kind::Matrix3,
        Kind::Matrix4x3,
        Kind::Matrix4,
        Kind::Transform,
        Kind::Pick,
        Kind::Label,
        Kind::Vectors,
    ];

    /// The word for the kind in messages and tables.
    pub const fn word(self) -> &'static str {
        match self {
            Kind::Boolean => "Boolean",
            Kind::Integer => "integer",
            Kind::Real => "real",
            Kind::String => "string",
            Kind::Vector2 => "2D vector",
            Kind::Vector3 => "3D vector",
            Kind::Vector4 => "4D vector",
            Kind::Matrix2 => "2x2 matrix",
            Kind::Matrix3 => "3x3 matrix",
            Kind::Matrix4x3 => "4x3 matrix",
            Kind::Matrix4 => "4x4 matrix",
            Kind::Transform => "transformed data",
            Kind::Pick => "pick list",
            Kind::Label => "label",
            Kind::Vectors => "transformed vectors",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl Value {
    /// The kind of the value.
    pub const fn kind(&self) -> Kind {
        match self {
            Value::Boolean(_) => Kind::Boolean,
            Value::Integer(_) => Kind::Integer,
            Value::Real(_) => Kind::Real,
            Value::String(_) => Kind::String,
            Value::Vector2(_) => Kind::Vector2,
            Value::Vector3(_) => Kind::Vector3,
            Value::Vector4(_) => Kind::Vector4,
            Value::Matrix2(_) => Kind::Matrix2,
            Value::Matrix3(_) => Kind::Matrix3,
            Value::Matrix4x3(_) => Kind::Matrix4x3,
            Value::Matrix4(_) => Kind::Matrix4,
            Value::Transform(_) => Kind::Transform,
            Value::Pick(_) => Kind::Pick,
            Value::Label(_) => Kind::Label,
            Value::Vectors(_) => Kind::Vectors,
        }
    }

    /// A string value.
    pub fn string(text: impl AsRef<[u8]>) -> Value {
        Value::String(text.as_ref().into())
    }

    /// The number in an integer or a real.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Integer(i) => Some(f64::from(*i)),
            Value::Real(r) => Some(*r),
            _ => None,
        }
    }

    /// Whether every component is finite. Strings, integers and Booleans always are.
    pub fn is_finite(&self) -> bool {
        match self {
            Value::Boolean(_) | Value::Integer(_) | Value::String(_) => true,
            Value::Real(r) => r.is_finite(),
            Value::Vector2(v) => v.is_finite(),
            Value::Vector3(v) => v.is_finite(),
            Value::Vector4(v) => v.is_finite(),
            Value::Matrix2(m) => m.is_finite(),
            Value::Matrix3(m) => m.is_finite(),
            Value::Matrix4x3(m) | Value::Matrix4(m) | Value::Transform(m) => is_finite(m),
            Value::Pick(pick) => pick
                .coordinates
                .is_none_or(|place| place.point.is_finite() && place.parameter.is_none_or(f64::is_finite)),
            Value::Label(label) => label.position.is_finite(),
            Value::Vectors(vectors) => vectors.ends.iter().all(|end| end.point.is_finite()),
        }
    }

    /// Bytes of the value on the heap whose number the user decides: texts, names and vectors.
    pub fn heap_bytes(&self) -> usize {
        match self {
            Value::String(text) => text.len(),
            Value::Label(label) => label.text.len(),
            Value::Pick(pick) => pick.identifiers.iter().map(|name| name.as_str().len() + size_of::<Name>()).sum(),
            Value::Vectors(vectors) => size_of_val(vectors.ends.as_slice()),
            _ => 0,
        }
    }
}

impl fmt::Display for PickList {
    /// Index, identifiers joined by commas, name of the node: `3 LEAF,PARENT WORLD.DATA`.
    ///
    /// # Source
    /// Ours: the machine's own text is not known.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ", self.index)?;
        for (i, identifier) in self.identifiers.iter().enumerate() {
            write!(f, "{}{identifier}", if i > 0 { "," } else { "" })?;
        }
        match &self.node {
            Some(node) => write!(f, " {node}"),
            None => Ok(()),
        }
    }
}

/// Whether every element of a matrix is finite: no exponent has all bits set, so that none overflows into the sign.
#[inline]
pub fn is_finite(m: &DMat4) -> bool {
    const EXPONENT: u64 = f64::INFINITY.to_bits();
    const LAST: u64 = EXPONENT & EXPONENT.wrapping_neg();
    m.to_cols_array().iter().fold(0, |any, number| any | ((number.to_bits() & EXPONENT) + LAST)) >> 63 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_small_whatever_it_holds() {
        assert!(size_of::<Value>() <= 40, "{}", size_of::<Value>());
    }

    #[test]
    fn a_part_of_vectors_begins_with_a_move() {
        let end = |x: f64, line| VectorEnd { line, point: DVec3::new(x, 0.0, 0.0) };
        let all = TransformedVectors { ends: vec![end(0.0, false), end(1.0, true), end(2.0, true)] };
        assert_eq!(all.part(2, 9).ends, [end(1.0, false), end(2.0, true)]);
        assert_eq!(all.part(1, 1).ends, [end(0.0, false)]);
        assert_eq!(all.part(1, u32::MAX), all);
        assert!(
            all.part(4, 1).ends.is_empty() && all.part(u32::MAX, 1).ends.is_empty() && all.part(1, 0).ends.is_empty()
        );
    }

    #[test]
    fn what_holds_a_number_that_is_not_finite_is_not_finite() {
        let nan = DVec3::new(0.0, f64::NAN, 0.0);
        let place = Some(PickCoordinates { point: DVec3::ZERO, dimension: 3, parameter: Some(f64::INFINITY) });
        let pick = PickList { index: 1, identifiers: Vec::new(), node: None, type_code: 1, coordinates: place };
        assert!(!Value::Pick(Box::new(pick.clone())).is_finite());
        assert!(Value::Pick(Box::new(PickList { coordinates: None, ..pick })).is_finite());
        assert!(!Value::Label(Box::new(Label { position: nan, text: [].into(), on: true })).is_finite());
        let vectors = TransformedVectors { ends: vec![VectorEnd { line: true, point: nan }] };
        assert!(!Value::Vectors(Arc::new(vectors)).is_finite());
    }
}
