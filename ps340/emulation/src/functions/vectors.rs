//! Vectors and rows: built from components, and taken apart.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{I, M2, M3, M43, R, V2, V3, V4},
    PortSpec, Problem,
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use protocol::Value;

const HEAD: KindSet = KindSet::NUMBER.or(KindSet::VECTOR2).or(KindSet::VECTOR3);
const AXIS_NOTE: Source = Source::confirmed("clients feed a translation from a dial; a vector sent to it is a fault");

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "VEC",
        summary: "one more component: two numbers make a 2D vector, and so on up to 4D",
        source: Source::manual(""),
        inputs: &[PortSpec::active(HEAD, "first components"), PortSpec::active(KindSet::NUMBER, "last component")],
        outputs: &["vector"],
        behaviour: append,
        examples: &[
            FunctionExample::of(&[(1, I(1)), (2, R(2.5))], &[(1, V2([1.0, 2.5]))]),
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, I(3))], &[(1, V3([1.0, 2.0, 3.0]))]),
            FunctionExample::of(&[(1, V3([1.0, 2.0, 3.0])), (2, I(4))], &[(1, V4([1.0, 2.0, 3.0, 4.0]))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "VECC",
        summary: "one more component, a constant",
        source: Source::manual(""),
        inputs: &[PortSpec::active(HEAD, "first components"), PortSpec::constant(KindSet::NUMBER, "last component")],
        outputs: &["vector"],
        behaviour: append,
        examples: &[
            FunctionExample::of(&[(2, R(0.0)), (1, V2([1.0, 2.0]))], &[(1, V3([1.0, 2.0, 0.0]))]),
            FunctionExample::of(
                &[(2, I(4)), (1, I(3)), (1, V3([1.0, 2.0, 3.0])), (1, V4([0.0; 4]))],
                &[(1, V2([3.0, 4.0])), (1, V4([1.0, 2.0, 3.0, 4.0]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CVEC",
        summary: "one more component after constant ones",
        source: Source::manual(""),
        inputs: &[PortSpec::constant(HEAD, "first components"), PortSpec::active(KindSet::NUMBER, "last component")],
        outputs: &["vector"],
        behaviour: append,
        examples: &[
            FunctionExample::of(&[(1, R(1.0)), (2, R(2.0)), (2, R(3.0))], &[(1, V2([1.0, 2.0])), (1, V2([1.0, 3.0]))]),
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, V2([0.0; 2])), (2, I(3))], &[(1, V3([1.0, 2.0, 3.0]))])
                .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "XVECTOR",
        summary: "3D vector along x",
        source: AXIS_NOTE,
        inputs: &[PortSpec::active(KindSet::NUMBER, "x")],
        outputs: &["3D vector"],
        behaviour: |f| along(f, DVec3::X),
        examples: &[
            FunctionExample::of(&[(1, R(0.1))], &[(1, V3([0.1, 0.0, 0.0]))]),
            FunctionExample::of(&[(1, V3([0.0; 3])), (1, R(2.0))], &[(1, V3([2.0, 0.0, 0.0]))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "YVECTOR",
        summary: "3D vector along y",
        source: AXIS_NOTE,
        inputs: &[PortSpec::active(KindSet::NUMBER, "y")],
        outputs: &["3D vector"],
        behaviour: |f| along(f, DVec3::Y),
        examples: &[
            FunctionExample::of(&[(1, I(-3))], &[(1, V3([0.0, -3.0, 0.0]))]),
            FunctionExample::of(&[(1, V3([0.0; 3])), (1, R(2.0))], &[(1, V3([0.0, 2.0, 0.0]))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ZVECTOR",
        summary: "3D vector along z",
        source: AXIS_NOTE,
        inputs: &[PortSpec::active(KindSet::NUMBER, "z")],
        outputs: &["3D vector"],
        behaviour: |f| along(f, DVec3::Z),
        examples: &[
            FunctionExample::of(&[(1, R(1.0))], &[(1, V3([0.0, 0.0, 1.0]))]),
            FunctionExample::of(&[(1, V3([0.0; 3])), (1, R(2.0))], &[(1, V3([0.0, 0.0, 2.0]))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MATRIX2",
        summary: "2x2 matrix from two rows",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::VECTOR2, "row 1"), PortSpec::active(KindSet::VECTOR2, "row 2")],
        outputs: &["2x2 matrix"],
        behaviour: |f| {
            let matrix = DMat2::from_cols(f.vector2(1)?, f.vector2(2)?);
            f.emit(1, Value::Matrix2(Box::new(matrix)))
        },
        examples: &[
            FunctionExample::of(&[(1, V2([1.0, 2.0])), (2, V2([3.0, 4.0]))], &[(1, M2([[1.0, 2.0], [3.0, 4.0]]))]),
            FunctionExample::of(
                &[(1, V2([1.0, 0.0])), (2, V3([0.0; 3])), (2, V2([0.0, 1.0]))],
                &[(1, M2([[1.0, 0.0], [0.0, 1.0]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MATRIX3",
        summary: "3x3 matrix from three rows",
        source: Source::confirmed("clients feed a VIEWPORT node with it"),
        inputs: &[
            PortSpec::active(KindSet::VECTOR3, "row 1"),
            PortSpec::active(KindSet::VECTOR3, "row 2"),
            PortSpec::active(KindSet::VECTOR3, "row 3"),
        ],
        outputs: &["3x3 matrix"],
        behaviour: |f| {
            let matrix = DMat3::from_cols(f.point(1)?, f.point(2)?, f.point(3)?);
            f.emit(1, Value::Matrix3(Box::new(matrix)))
        },
        examples: &[
            FunctionExample::of(
                &[(3, V3([0.5, 1.0, 0.0])), (1, V3([-0.9, 0.9, 0.0])), (2, V3([-0.8, 0.8, 0.0]))],
                &[(1, M3([[-0.9, 0.9, 0.0], [-0.8, 0.8, 0.0], [0.5, 1.0, 0.0]]))],
            ),
            FunctionExample::of(
                &[(1, V3([1.0; 3])), (1, V3([9.0; 3])), (2, V3([2.0; 3])), (3, V3([3.0; 3]))],
                &[(1, M3([[1.0; 3], [2.0; 3], [3.0; 3]]))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MATRIX4",
        summary: "4x4 matrix from four rows",
        source: Source::manual(""),
        inputs: &[
            PortSpec::active(KindSet::VECTOR4, "row 1"),
            PortSpec::active(KindSet::VECTOR4, "row 2"),
            PortSpec::active(KindSet::VECTOR4, "row 3"),
            PortSpec::active(KindSet::VECTOR4, "row 4"),
        ],
        outputs: &["4x4 matrix"],
        behaviour: |f| {
            let matrix = DMat4::from_cols(vector4(f, 1)?, vector4(f, 2)?, vector4(f, 3)?, vector4(f, 4)?);
            f.emit(1, Value::Matrix4(Box::new(matrix)))
        },
        examples: &[
            FunctionExample::of(
                &[(1, V4([1.0; 4])), (2, V4([2.0; 4])), (3, V4([3.0; 4])), (4, V4([4.0; 4]))],
                &[(1, crate::port::Literal::M4([[1.0; 4], [2.0; 4], [3.0; 4], [4.0; 4]]))],
            ),
            FunctionExample::of(
                &[(1, V4([1.0; 4])), (2, V3([0.0; 3])), (2, V4([2.0; 4])), (3, V4([3.0; 4])), (4, V4([4.0; 4]))],
                &[(1, crate::port::Literal::M4([[1.0; 4], [2.0; 4], [3.0; 4], [4.0; 4]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PARTS",
        summary: "the components of a vector or the rows of a matrix, one an output",
        source: Source::manual("a 4x3 matrix gives four 3D rows"),
        inputs: &[PortSpec::active(KindSet::VECTOR.or(KindSet::MATRIX), "vector or matrix")],
        outputs: &["part 1", "part 2", "part 3", "part 4"],
        behaviour: parts,
        examples: &[
            FunctionExample::of(&[(1, V3([1.0, 2.0, 3.0]))], &[(1, R(1.0)), (2, R(2.0)), (3, R(3.0))]),
            FunctionExample::of(&[(1, M2([[1.0, 2.0], [3.0, 4.0]]))], &[(1, V2([1.0, 2.0])), (2, V2([3.0, 4.0]))]),
            FunctionExample::of(
                &[(1, M43([[1.0; 3], [2.0; 3], [3.0; 3], [4.0; 3]]))],
                &[(1, V3([1.0; 3])), (2, V3([2.0; 3])), (3, V3([3.0; 3])), (4, V3([4.0; 3]))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
];

fn append(f: &mut Firing) -> Result<(), Problem> {
    let last = f.number(2)?;
    let vector = match f.value(1) {
        Value::Vector2(v) => Value::Vector3(v.extend(last)),
        Value::Vector3(v) => Value::Vector4(v.extend(last)),
        _ => Value::Vector2(DVec2::new(f.number(1)?, last)),
    };
    f.emit(1, vector)
}

fn along(f: &mut Firing, axis: DVec3) -> Result<(), Problem> {
    let vector = axis * f.number(1)?;
    f.emit(1, Value::Vector3(vector))
}

fn vector4(f: &Firing, input: u16) -> Result<DVec4, Problem> {
    match f.value(input) {
        Value::Vector4(v) => Ok(*v),
        _ => Err(Problem::Kind(input)),
    }
}

fn parts(f: &mut Firing) -> Result<(), Problem> {
    let parts: Vec<Value> = match f.value(1) {
        Value::Vector2(v) => v.to_array().map(Value::Real).into(),
        Value::Vector3(v) => v.to_array().map(Value::Real).into(),
        Value::Vector4(v) => v.to_array().map(Value::Real).into(),
        Value::Matrix2(m) => [m.x_axis, m.y_axis].map(Value::Vector2).into(),
        Value::Matrix3(m) => [m.x_axis, m.y_axis, m.z_axis].map(Value::Vector3).into(),
        Value::Matrix4x3(m) => {
            [m.x_axis, m.y_axis, m.z_axis, m.w_axis].map(|row| Value::Vector3(row.truncate())).into()
        }
        Value::Matrix4(m) => [m.x_axis, m.y_axis, m.z_axis, m.w_axis].map(Value::Vector4).into(),
        _ => return Err(Problem::Kind(1)),
    };
    for (output, part) in (1..).zip(parts) {
        f.emit(output, part)?;
    }
    Ok(())
}
