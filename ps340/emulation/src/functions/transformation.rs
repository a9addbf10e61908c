//! Transformation: rotations and scales from numbers, at once or accumulated from the turns of a dial.

use super::{FunctionExample, FunctionRow, Source};
use crate::{
    matrices::{rotation, scale},
    port::{
        Firing, KindSet,
        Literal::{I, M2, M3, R, V2, V3},
        PortSpec, Problem,
    },
};
use glam::{DMat2, DVec2, DVec3};
use protocol::{Value, command::Axis};

const DEGREES: &[PortSpec] = &[PortSpec::active(KindSet::NUMBER, "degrees")];
const DIAL_ROTATION: &[PortSpec] = &[
    PortSpec::active(KindSet::NUMBER, "change"),
    PortSpec::default(KindSet::NUMBER, R(0.0), "accumulated degrees; sending replaces them"),
    PortSpec::default(KindSet::NUMBER, R(1.0), "degrees per unit of change"),
];
const DIAL_NOTE: Source =
    Source::confirmed("inputs as clients use them; output 2, the default of <3> and degrees modulo 360 are ours");
const DIAL_OUTPUTS: &[&str] = &["3x3 rotation", "accumulated degrees, -360 to 360"];

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "XROTATE",
        summary: "rotation about x",
        source: Source::manual(""),
        inputs: DEGREES,
        outputs: &["3x3 rotation"],
        behaviour: |f| rotate(f, Axis::X),
        examples: &[
            FunctionExample::of(&[(1, R(90.0))], &[(1, M3([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))]),
            FunctionExample::of(
                &[(1, V2([1.0, 0.0])), (1, I(360))],
                &[(1, M3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "YROTATE",
        summary: "rotation about y",
        source: Source::manual(""),
        inputs: DEGREES,
        outputs: &["3x3 rotation"],
        behaviour: |f| rotate(f, Axis::Y),
        examples: &[
            FunctionExample::of(&[(1, I(-270))], &[(1, M3([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]))]),
            FunctionExample::of(
                &[(1, V2([1.0, 0.0])), (1, I(360))],
                &[(1, M3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ZROTATE",
        summary: "rotation about z",
        source: Source::confirmed("clients feed a ROTATE node with it"),
        inputs: DEGREES,
        outputs: &["3x3 rotation"],
        behaviour: |f| rotate(f, Axis::Z),
        examples: &[
            FunctionExample::of(&[(1, R(180.0))], &[(1, M3([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]))]),
            FunctionExample::of(
                &[(1, V2([1.0, 0.0])), (1, I(360))],
                &[(1, M3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DXROTATE",
        summary: "rotation about x, accumulated from a dial",
        source: DIAL_NOTE,
        inputs: DIAL_ROTATION,
        outputs: DIAL_OUTPUTS,
        behaviour: |f| rotate_by_dial(f, Axis::X),
        examples: &[
            FunctionExample::of(
                &[(2, R(0.0)), (3, R(200.0)), (1, R(0.1)), (1, R(-0.1))],
                &[
                    (
                        1,
                        M3([
                            [1.0, 0.0, 0.0],
                            [0.0, 0.9396926207859084, 0.3420201433256687],
                            [0.0, -0.3420201433256687, 0.9396926207859084],
                        ]),
                    ),
                    (2, R(20.0)),
                    (1, M3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])),
                    (2, R(0.0)),
                ],
            ),
            FunctionExample::of(
                &[(2, R(300.0)), (1, R(150.0))],
                &[(1, M3([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])), (2, R(90.0))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DYROTATE",
        summary: "rotation about y, accumulated from a dial",
        source: DIAL_NOTE,
        inputs: DIAL_ROTATION,
        outputs: DIAL_OUTPUTS,
        behaviour: |f| rotate_by_dial(f, Axis::Y),
        examples: &[
            FunctionExample::of(
                &[(2, R(45.0)), (1, R(45.0))],
                &[(1, M3([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])), (2, R(90.0))],
            ),
            FunctionExample::of(
                &[(1, R(90.0)), (2, R(0.0)), (1, R(0.0))],
                &[
                    (1, M3([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])),
                    (2, R(90.0)),
                    (1, M3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])),
                    (2, R(0.0)),
                ],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DZROTATE",
        summary: "rotation about z, accumulated from a dial",
        source: DIAL_NOTE,
        inputs: DIAL_ROTATION,
        outputs: DIAL_OUTPUTS,
        behaviour: |f| rotate_by_dial(f, Axis::Z),
        examples: &[
            FunctionExample::of(
                &[(3, I(100)), (1, R(4.5))],
                &[(1, M3([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])), (2, R(90.0))],
            ),
            FunctionExample::of(
                &[(1, V3([0.0; 3])), (1, R(-90.0))],
                &[(1, M3([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])), (2, R(-90.0))],
            )
            .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SCALE",
        summary: "scale by one factor or by one an axis",
        source: Source::confirmed("clients send a 3D vector; a 2D vector leaves z: ours"),
        inputs: &[PortSpec::active(KindSet::NUMBER.or(KindSet::VECTOR2).or(KindSet::VECTOR3), "factors")],
        outputs: &["3x3 scale"],
        behaviour: |f| {
            let factors = match f.value(1) {
                Value::Vector2(v) => v.extend(1.0),
                Value::Vector3(v) => *v,
                _ => DVec3::splat(f.number(1)?),
            };
            f.emit(1, Value::Matrix3(Box::new(scale(factors))))
        },
        examples: &[
            FunctionExample::of(&[(1, R(2.0))], &[(1, M3([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]))]),
            FunctionExample::of(
                &[(1, V2([2.0, 3.0]))],
                &[(1, M3([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]]))],
            ),
            FunctionExample::of(
                &[(1, V3([2.0, 3.0, 4.0]))],
                &[(1, M3([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DSCALE",
        summary: "uniform scale, accumulated from a dial: scale + change x factor within limits",
        source: Source::confirmed("inputs as clients use them; additive growth, the defaults and output 2 are ours"),
        inputs: &[
            PortSpec::active(KindSet::NUMBER, "change"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "accumulated scale; sending replaces it"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "scale per unit of change"),
            PortSpec::optional(KindSet::NUMBER, "greatest scale"),
            PortSpec::optional(KindSet::NUMBER, "least scale"),
        ],
        outputs: &["3x3 scale", "accumulated scale"],
        behaviour: scale_by_dial,
        examples: &[
            FunctionExample::of(
                &[(2, R(1.0)), (3, R(0.2)), (4, R(1000.0)), (5, R(0.01)), (1, R(0.5))],
                &[(1, M3([[1.1, 0.0, 0.0], [0.0, 1.1, 0.0], [0.0, 0.0, 1.1]])), (2, R(1.1))],
            ),
            FunctionExample::of(
                &[(4, R(2.0)), (1, R(5.0)), (1, R(-0.5))],
                &[
                    (1, M3([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]])),
                    (2, R(2.0)),
                    (1, M3([[1.5, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 1.5]])),
                    (2, R(1.5)),
                ],
            ),
            FunctionExample::of(&[(4, R(1.0)), (5, R(2.0)), (1, R(0.0))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CROTATE",
        summary: "rotation of characters",
        source: Source::manual(""),
        inputs: DEGREES,
        outputs: &["2x2 rotation"],
        behaviour: |f| {
            let turned = rotation(Axis::Z, f.number(1)?);
            f.emit(1, Value::Matrix2(Box::new(DMat2::from_mat3(turned))))
        },
        examples: &[
            FunctionExample::of(&[(1, R(90.0))], &[(1, M2([[0.0, 1.0], [-1.0, 0.0]]))]),
            FunctionExample::of(&[(1, R(-450.0))], &[(1, M2([[0.0, -1.0], [1.0, 0.0]]))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CSCALE",
        summary: "scale of characters",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::NUMBER.or(KindSet::VECTOR2), "factors")],
        outputs: &["2x2 scale"],
        behaviour: |f| {
            let factors = match f.value(1) {
                Value::Vector2(v) => *v,
                _ => DVec2::splat(f.number(1)?),
            };
            f.emit(1, Value::Matrix2(Box::new(DMat2::from_diagonal(factors))))
        },
        examples: &[
            FunctionExample::of(
                &[(1, I(2)), (1, V2([1.0, 3.0]))],
                &[(1, M2([[2.0, 0.0], [0.0, 2.0]])), (1, M2([[1.0, 0.0], [0.0, 3.0]]))],
            ),
            FunctionExample::of(&[(1, V3([1.0; 3])), (1, R(0.0))], &[(1, M2([[0.0; 2]; 2]))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn rotate(f: &mut Firing, axis: Axis) -> Result<(), Problem> {
    let matrix = rotation(axis, f.number(1)?);
    f.emit(1, Value::Matrix3(Box::new(matrix)))
}

/// The angle is kept modulo 360 degrees, so that years of turning lose no precision.
fn rotate_by_dial(f: &mut Firing, axis: Axis) -> Result<(), Problem> {
    let degrees = (f.number(2)? + f.number(1)? * f.number(3)?) % 360.0;
    f.accumulate(2, Value::Real(degrees))?;
    f.emit(1, Value::Matrix3(Box::new(rotation(axis, degrees))))?;
    f.emit(2, Value::Real(degrees))
}

fn scale_by_dial(f: &mut Firing) -> Result<(), Problem> {
    let greatest = f.optional_number(4)?.unwrap_or(f64::MAX);
    let least = f.optional_number(5)?.unwrap_or(f64::MIN);
    if least > greatest {
        return Err(Problem::Range(5));
    }
    let grown = f.number(2)? + f.number(1)? * f.number(3)?;
    if !grown.is_finite() {
        return Err(Problem::Overflow);
    }
    let factor = grown.clamp(least, greatest);
    f.accumulate(2, Value::Real(factor))?;
    f.emit(1, Value::Matrix3(Box::new(scale(DVec3::splat(factor)))))?;
    f.emit(2, Value::Real(factor))
}
