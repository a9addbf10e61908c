//! Labels and colours for display nodes.

use super::{Example, FunctionRow, Source, names::name};
use crate::port::{
    Effect, KindSet,
    Literal::{I, R, S, V2},
    PortSpec,
};
use glam::DVec2;
use protocol::{Value, value::LabelData};
use std::sync::Arc;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "LABEL",
        summary: "a label for a LABELS node: a text at a place",
        source: Source::manual(""),
        inputs: &[
            PortSpec::active(KindSet::VECTOR2.or(KindSet::VECTOR3), "place of the lower left corner"),
            PortSpec::active(KindSet::STRING, "text"),
            PortSpec::default(KindSet::BOOLEAN, crate::port::Literal::B(true), "whether it is shown"),
        ],
        outputs: &["label"],
        behaviour: |f| {
            let label = LabelData { position: f.point(1)?, text: f.string(2)?.into(), shown: f.boolean(3)? };
            f.emit(1, Value::Label(Arc::new(label)))
        },
        examples: &[Example::of(&[(2, S("A")), (2, S("B")), (1, I(1))], &[]).faults(&[5])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LBL_EXTRACT",
        summary: "text, place and state of a label of a LABELS node",
        source: Source::uncertain("which output gives what is ours"),
        inputs: &[
            PortSpec::active(KindSet::INTEGER, "which label, from 1"),
            PortSpec::constant(KindSet::STRING, "name of the LABELS node"),
        ],
        outputs: &["text", "place", "whether it is shown"],
        behaviour: |f| {
            let (index, name) = (f.integer(1)?, name(f, 2)?);
            f.effect(Effect::ExtractLabel { function: f.object(), name, index });
            Ok(())
        },
        examples: &[Example::of(&[(2, S("1X")), (1, I(1))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "COLOR",
        summary: "a colour for SET COLOR: hue and saturation as a 2D vector",
        source: Source::uncertain("inputs beyond the hue and the form of the colour are ours"),
        inputs: &[
            PortSpec::active(KindSet::NUMBER, "hue in degrees, 0 blue; it wraps"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "saturation, 0 white to 1 pure; limited to that"),
        ],
        outputs: &["V2D(hue, saturation)"],
        behaviour: |f| {
            let color = DVec2::new(f.number(1)?.rem_euclid(360.0), f.number(2)?.clamp(0.0, 1.0));
            f.emit(1, Value::Vector2(color))
        },
        examples: &[Example::of(
            &[(1, R(480.0)), (2, R(3.0)), (1, I(-60)), (2, R(0.0)), (1, R(7.0))],
            &[(1, V2([120.0, 1.0])), (1, V2([300.0, 1.0])), (1, V2([7.0, 0.0]))],
        )],
        ..FunctionRow::PLAIN
    },
];
