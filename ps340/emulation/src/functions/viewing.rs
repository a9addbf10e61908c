//! Viewing: matrices for the nodes LOOK, WINDOW and FIELD_OF_VIEW.

use super::{FunctionExample, FunctionRow, Source};
use crate::{
    matrices::{field_of_view, look, window},
    port::{
        Firing, KindSet,
        Literal::{B, I, M4, M43, R, V3},
        PortSpec, Problem,
    },
};
use glam::DVec3;
use protocol::Value;

const POINT: KindSet = KindSet::VECTOR2.or(KindSet::VECTOR3);
const UP: PortSpec = PortSpec::constant(POINT, "UP: a point above AT, or a direction if it equals AT");
const UP_NOTE: Source = Source::confirmed("UP as a point is our reading: for AT in the origin it is a direction too");
const NO_SHIFT: FunctionExample = FunctionExample::of(
    &[(2, V3([0.0, 0.0, -10.0])), (3, V3([0.0, 1.0, 0.0])), (1, V3([0.0; 3]))],
    &[(1, M43([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0]]))],
);

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "LOOKAT",
        summary: "view of a point that moves, from a constant one",
        source: UP_NOTE,
        inputs: &[PortSpec::active(POINT, "AT"), PortSpec::constant(POINT, "FROM"), UP],
        outputs: &["4x3 matrix"],
        behaviour: |f| {
            let (at, from) = (f.point(1)?, f.point(2)?);
            view(f, at, from)
        },
        examples: &[
            NO_SHIFT,
            FunctionExample::of(&[(2, V3([1.0; 3])), (3, V3([0.0, 1.0, 0.0])), (1, V3([1.0; 3]))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LOOKFROM",
        summary: "view from a point that moves, of a constant one",
        source: Source::manual("UP as in F:LOOKAT"),
        inputs: &[PortSpec::active(POINT, "FROM"), PortSpec::constant(POINT, "AT"), UP],
        outputs: &["4x3 matrix"],
        behaviour: |f| {
            let (from, at) = (f.point(1)?, f.point(2)?);
            view(f, at, from)
        },
        examples: &[
            FunctionExample::of(
                &[(2, V3([0.0; 3])), (3, V3([0.0, 1.0, 0.0])), (1, V3([-5.0, 0.0, 0.0]))],
                &[(1, M43([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 5.0]]))],
            ),
            FunctionExample::of(&[(2, V3([1.0; 3])), (3, V3([0.0, 1.0, 0.0])), (1, V3([1.0; 3]))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "WINDOW",
        summary: "orthographic view of a box, made at a trigger",
        source: Source::confirmed("any kind of trigger; an empty range is a fault: ours"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::NUMBER, "xmin"),
            PortSpec::constant(KindSet::NUMBER, "xmax"),
            PortSpec::constant(KindSet::NUMBER, "ymin"),
            PortSpec::constant(KindSet::NUMBER, "ymax"),
            PortSpec::constant(KindSet::NUMBER, "front"),
            PortSpec::constant(KindSet::NUMBER, "back"),
        ],
        outputs: &["4x4 matrix"],
        behaviour: |f| {
            let matrix =
                window([f.number(2)?, f.number(3)?], [f.number(4)?, f.number(5)?], [f.number(6)?, f.number(7)?])
                    .ok_or(Problem::Degenerate)?;
            f.emit(1, Value::Matrix4(Box::new(matrix)))
        },
        examples: &[
            FunctionExample::of(
                &[(2, I(0)), (3, I(4)), (4, I(-1)), (5, I(1)), (6, R(2.0)), (7, R(4.0)), (1, R(1.0))],
                &[(1, M4([[0.5, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0], [-1.0, 0.0, -1.0, 1.0]]))],
            ),
            FunctionExample::of(
                &[(2, R(-1.0)), (3, R(1.0)), (4, R(-1.0)), (5, R(1.0)), (6, R(1e-15)), (7, R(1e15)), (1, B(true))],
                &[(
                    1,
                    M4([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1e-15, 0.0], [0.0, 0.0, -1e-30, 1.0]]),
                )],
            ),
            FunctionExample::of(
                &[(2, I(1)), (3, I(1)), (4, I(-1)), (5, I(1)), (6, I(0)), (7, I(1)), (1, B(true))],
                &[],
            )
            .faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FOV",
        summary: "perspective view from the origin, made at a trigger",
        source: Source::confirmed("any kind of trigger; an angle outside 0 to 180 is a fault: ours"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::NUMBER, "full angle, degrees"),
            PortSpec::constant(KindSet::NUMBER, "front"),
            PortSpec::constant(KindSet::NUMBER, "back"),
        ],
        outputs: &["4x4 matrix"],
        behaviour: |f| {
            let angle = f.number(2)?;
            if !(angle > 0.0 && angle < 180.0) {
                return Err(Problem::Range(2));
            }
            let matrix = field_of_view(angle, [f.number(3)?, f.number(4)?]).ok_or(Problem::Degenerate)?;
            f.emit(1, Value::Matrix4(Box::new(matrix)))
        },
        examples: &[
            FunctionExample::of(
                &[(2, R(90.0)), (3, R(1.0)), (4, R(3.0)), (1, B(true))],
                &[(1, M4([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.5, 1.0], [0.0, 0.0, -1.5, 0.0]]))],
            ),
            FunctionExample::of(&[(2, R(180.0)), (3, R(1.0)), (4, R(3.0)), (1, B(true))], &[]).faults(&[6]),
            FunctionExample::of(&[(2, R(30.0)), (3, R(3.0)), (4, R(3.0)), (1, B(true))], &[]).faults(&[7]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn view(f: &mut Firing, at: DVec3, from: DVec3) -> Result<(), Problem> {
    let matrix = look(at, from, f.point(3)?).ok_or(Problem::Degenerate)?;
    f.emit(1, Value::Matrix4x3(Box::new(matrix)))
}
