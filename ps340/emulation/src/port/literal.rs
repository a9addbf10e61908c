//! Values as constants of a table: defaults of inputs, messages of examples.

use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use protocol::{
    Name, Value,
    value::{Label, PickCoordinates, PickList, TransformedVectors, VectorEnd},
};
use std::{fmt, sync::Arc};

/// A value that can stand in a constant table. Matrices are given by the machine's rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Literal {
    /// A Boolean.
    B(bool),
    /// An integer.
    I(i32),
    /// A real.
    R(f64),
    /// A string.
    S(&'static str),
    /// A 2D vector.
    V2([f64; 2]),
    /// A 3D vector.
    V3([f64; 3]),
    /// A 4D vector.
    V4([f64; 4]),
    /// A 2x2 matrix.
    M2([[f64; 2]; 2]),
    /// A 3x3 matrix.
    M3([[f64; 3]; 3]),
    /// A 4x3 matrix: the last row the translation.
    M43([[f64; 3]; 4]),
    /// A 4x4 matrix.
    M4([[f64; 4]; 4]),
    /// Transformed data.
    T([[f64; 4]; 4]),
    /// A pick list.
    Pick(PickLiteral),
    /// A label: position, text, whether it is shown.
    Label([f64; 3], &'static str, bool),
    /// Transformed vectors: whether each is a line, and its end.
    Vectors(&'static [(bool, [f64; 3])]),
}

/// A pick list that can stand in a constant table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickLiteral {
    /// Number of the element in its data node, from 1.
    pub index: u32,
    /// Pick identifiers, nearest first. What is no name is left out.
    pub identifiers: &'static [&'static str],
    /// The data node.
    pub node: &'static str,
    /// The kind of data.
    pub type_code: i32,
    /// The picked point and the dimension of the data.
    pub point: Option<([f64; 3], u8)>,
    /// The parameter of a curve at that point.
    pub parameter: Option<f64>,
}

impl PickLiteral {
    fn list(&self) -> PickList {
        let place =
            |(point, dimension)| PickCoordinates { point: DVec3::from(point), dimension, parameter: self.parameter };
        PickList {
            index: self.index,
            identifiers: self.identifiers.iter().filter_map(|name| Name::new(name).ok()).collect(),
            node: Name::new(self.node).ok(),
            type_code: self.type_code,
            coordinates: self.point.map(place),
        }
    }
}

impl Literal {
    /// The value as a message.
    pub fn value(&self) -> Value {
        match *self {
            Literal::B(b) => Value::Boolean(b),
            Literal::I(i) => Value::Integer(i),
            Literal::R(r) => Value::Real(r),
            Literal::S(s) => Value::string(s),
            Literal::V2(v) => Value::Vector2(DVec2::from(v)),
            Literal::V3(v) => Value::Vector3(DVec3::from(v)),
            Literal::V4(v) => Value::Vector4(DVec4::from(v)),
            Literal::M2(rows) => Value::Matrix2(Box::new(DMat2::from_cols_array_2d(&rows))),
            Literal::M3(rows) => Value::Matrix3(Box::new(DMat3::from_cols_array_2d(&rows))),
            Literal::M43([a, b, c, t]) => Value::Matrix4x3(Box::new(DMat4::from_cols(
                DVec3::from(a).extend(0.0),
                DVec3::from(b).extend(0.0),
                DVec3::from(c).extend(0.0),
                DVec3::from(t).extend(1.0),
            ))),
            Literal::M4(rows) => Value::Matrix4(Box::new(DMat4::from_cols_array_2d(&rows))),
            Literal::T(rows) => Value::Transform(Box::new(DMat4::from_cols_array_2d(&rows))),
            Literal::Pick(pick) => Value::Pick(Box::new(pick.list())),
            Literal::Label(position, text, on) => {
                Value::Label(Box::new(Label { position: DVec3::from(position), text: text.as_bytes().into(), on }))
            }
            Literal::Vectors(ends) => {
                let ends = ends.iter().map(|&(line, point)| VectorEnd { line, point: DVec3::from(point) }).collect();
                Value::Vectors(Arc::new(TransformedVectors { ends }))
            }
        }
    }
}

impl fmt::Display for Literal {
    /// The text of a command, so far as commands can express it; in a string, characters that cannot be seen as escapes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        match *self {
            Literal::B(b) => f.write_str(if b { "TRUE" } else { "FALSE" }),
            Literal::I(i) => write!(f, "FIX({i})"),
            Literal::R(r) if r.fract() == 0.0 && r.abs() < 1e15 => write!(f, "{r:.1}"),
            Literal::R(r) => write!(f, "{r}"),
            Literal::S(s) => write!(f, "'{}'", s.escape_default()),
            Literal::V2(v) => write!(f, "V2D({})", list(&v)),
            Literal::V3(v) => write!(f, "V3D({})", list(&v)),
            Literal::V4(v) => write!(f, "V4D({})", list(&v)),
            Literal::M2(m) => write!(f, "M2D({})", list(m.as_flattened())),
            Literal::M3(m) => write!(f, "M3D({})", list(m.as_flattened())),
            Literal::M43(m) => write!(f, "4x3 matrix ({})", list(m.as_flattened())),
            Literal::M4(m) => write!(f, "M4D({})", list(m.as_flattened())),
            Literal::T(m) => write!(f, "transformed matrix ({})", list(m.as_flattened())),
            Literal::Pick(pick) => {
                write!(f, "pick list ({}", pick.list())?;
                match pick.point {
                    Some((point, dimension)) => write!(f, " at {})", list(&point[..usize::from(dimension).min(3)])),
                    None => f.write_str(")"),
                }
            }
            Literal::Label(position, text, on) => {
                write!(f, "label ({} '{text}' {})", list(&position), if on { "TRUE" } else { "FALSE" })
            }
            Literal::Vectors(ends) => {
                f.write_str("vectors (")?;
                for (i, (line, point)) in ends.iter().enumerate() {
                    let before = if i > 0 { " " } else { "" };
                    write!(f, "{before}{} {}", if *line { 'L' } else { 'P' }, list(point))?;
                }
                f.write_str(")")
            }
        }
    }
}
