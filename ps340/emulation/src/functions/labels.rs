//! Labels: made for a LABELS node, and read from one.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{B, I, Label as L, S, V2, V3},
    PortSpec, Problem,
};
use protocol::{Name, Value, value::Label};

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "LABEL",
        summary: "a label for a LABELS node",
        source: Source::manual("shown unless <3> is FALSE: ours"),
        inputs: &[
            PortSpec::active(KindSet::VECTOR2.or(KindSet::VECTOR3), "position"),
            PortSpec::active(KindSet::STRING, "text"),
            PortSpec::default(KindSet::BOOLEAN, B(true), "whether it is shown"),
        ],
        outputs: &["label"],
        behaviour: |f| {
            let label = Label { position: f.point(1)?, text: f.string(2)?.into(), on: f.boolean(3)? };
            f.emit(1, Value::Label(Box::new(label)))
        },
        examples: &[
            FunctionExample::of(&[(1, V3([1.0, 2.0, 3.0])), (2, S("CA"))], &[(1, L([1.0, 2.0, 3.0], "CA", true))]),
            FunctionExample::of(
                &[(3, B(false)), (2, S("")), (1, V2([1.0, 2.0]))],
                &[(1, L([1.0, 2.0, 0.0], "", false))],
            ),
            FunctionExample::of(&[(2, I(1)), (1, V2([0.0; 2])), (2, S("A"))], &[(1, L([0.0; 3], "A", true))])
                .faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LBL_EXTRACT",
        summary: "text, position and visibility of one label of a LABELS node",
        source: Source::uncertain("the order of the outputs"),
        inputs: &[
            PortSpec::active(KindSet::INTEGER, "number of the label, from 1"),
            PortSpec::constant(KindSet::STRING, "name of the LABELS node"),
        ],
        outputs: &["text", "position, 3D", "whether it is shown"],
        behaviour: extract,
        examples: &[
            FunctionExample::of(&[(2, S("ATOMS")), (1, I(1))], &[]),
            FunctionExample::of(&[(2, S("ATOMS")), (1, I(0))], &[]).faults(&[6]),
            FunctionExample::of(&[(2, S("NO NAME")), (1, I(1))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn extract(f: &mut Firing) -> Result<(), Problem> {
    let index = u32::try_from(f.integer(1)?).ok().filter(|index| *index > 0).ok_or(Problem::Range(1))?;
    let name = Name::new(f.string(2)?.trim_ascii()).map_err(|_| Problem::Range(2))?;
    f.effect(Effect::ExtractLabel { function: f.object(), name, index });
    Ok(())
}
