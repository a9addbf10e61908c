//! What flows on the arcs of a function network and in SEND: values and their kinds.

use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use std::fmt;

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
    /// Transformed data.
    Transform,
}

impl Kind {
    /// Every kind, in the order of the enumeration.
    pub const ALL: [Kind; 12] = [
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
            Value::Matrix4x3(m) | Value::Matrix4(m) | Value::Transform(m) => all_finite(m),
        }
    }
}

/// Whether every element is finite: then all of them times zero are zero, and so is the sum.
fn all_finite(m: &DMat4) -> bool {
    (m.x_axis * 0.0 + m.y_axis * 0.0) + (m.z_axis * 0.0 + m.w_axis * 0.0) == DVec4::ZERO
}
