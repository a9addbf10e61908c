//! Picking: asked for, and what was picked taken apart.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{B, I, Pick, R, S, V2, V3},
    PickLiteral, PortSpec, Problem,
};
use protocol::{
    Name, Value,
    value::{MAX_STRING, PickList},
};

const PLAIN: PickLiteral = PickLiteral {
    index: 7,
    identifiers: &["I00F", "GROUP", "WORLD"],
    node: "WORLD.DATA",
    type_code: 1,
    point: None,
    parameter: None,
};
const FLAT: PickLiteral = PickLiteral { point: Some(([0.5, -1.0, 0.0], 2)), ..PLAIN };
const ON_CURVE: PickLiteral =
    PickLiteral { type_code: 2, point: Some(([0.5, -1.0, 2.0], 3)), parameter: Some(0.25), node: "", ..PLAIN };

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "PICK",
        summary: "what is drawn first inside the pick box, at the next update; the initial instance PICK is one",
        source: Source::confirmed(
            "inputs <1> and <2> and output 1 as clients use them; the time in <3> and FALSE from output 2 are ours",
        ),
        inputs: &[
            PortSpec::active(KindSet::VECTOR2, "trigger: position of the puck"),
            PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: with the picked point"),
            PortSpec::default(KindSet::INTEGER, I(1), "frames to wait for a hit"),
        ],
        outputs: &["pick list", "FALSE if nothing was hit in time"],
        behaviour: pick,
        examples: &[
            FunctionExample::of(&[(1, V2([0.25, -0.125]))], &[]),
            FunctionExample::of(&[(3, I(0)), (1, V2([0.0; 2]))], &[]).faults(&[6]),
            FunctionExample::of(&[(1, V3([0.0; 3]))], &[]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PICKINFO",
        summary: "the parts of a pick list, one an output",
        source: Source::confirmed(
            "nine outputs, identifiers from 2; 4 to 9 are uncertain, and that 3 and 4 are silent without coordinates, 8 \
             without a curve",
        ),
        inputs: &[
            PortSpec::active(KindSet::PICK, "pick list"),
            PortSpec::constant(KindSet::INTEGER, "depth: how many identifiers leave output 2"),
        ],
        outputs: &[
            "index",
            "pick identifiers, nearest first, separated by commas",
            "picked point, 2D or 3D",
            "dimension of the point",
            "whether there is a point",
            "kind of data: 1 vectors, 2 curve, 3 characters, 4 labels, 5 polygons",
            "name of the data node",
            "parameter of a curve",
            "the other identifiers",
        ],
        behaviour: take_apart,
        examples: &[
            FunctionExample::of(
                &[(2, I(50)), (1, Pick(PLAIN))],
                &[(1, I(7)), (2, S("I00F,GROUP,WORLD")), (5, B(false)), (6, I(1)), (7, S("WORLD.DATA")), (9, S(""))],
            ),
            FunctionExample::of(
                &[(2, I(1)), (1, Pick(FLAT))],
                &[
                    (1, I(7)),
                    (2, S("I00F")),
                    (3, V2([0.5, -1.0])),
                    (4, I(2)),
                    (5, B(true)),
                    (6, I(1)),
                    (7, S("WORLD.DATA")),
                    (9, S("GROUP,WORLD")),
                ],
            ),
            FunctionExample::of(
                &[(2, I(0)), (1, Pick(ON_CURVE))],
                &[
                    (1, I(7)),
                    (2, S("")),
                    (3, V3([0.5, -1.0, 2.0])),
                    (4, I(3)),
                    (5, B(true)),
                    (6, I(2)),
                    (7, S("")),
                    (8, R(0.25)),
                    (9, S("I00F,GROUP,WORLD")),
                ],
            ),
            FunctionExample::of(&[(2, I(-1)), (1, Pick(PLAIN)), (1, S("I00F"))], &[]).faults(&[6, 5]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn pick(f: &mut Firing) -> Result<(), Problem> {
    let frames = u32::try_from(f.integer(3)?).ok().filter(|frames| *frames > 0).ok_or(Problem::Range(3))?;
    let (at, coordinates) = (f.vector2(1)?, f.boolean(2)?);
    f.effect(Effect::RequestPick { function: f.object(), at, coordinates, frames });
    Ok(())
}

fn take_apart(f: &mut Firing) -> Result<(), Problem> {
    let Value::Pick(pick) = f.take(1) else { return Err(Problem::Kind(1)) };
    let PickList { index, identifiers, node, type_code, coordinates: place } = *pick;
    let depth = usize::try_from(f.integer(2)?).map_err(|_| Problem::Range(2))?;
    let (near, far) = identifiers.split_at(depth.min(identifiers.len()));
    f.emit(1, Value::Integer(index.try_into().unwrap_or(i32::MAX)))?;
    f.emit(2, joined(near)?)?;
    if let Some(place) = &place {
        let point =
            if place.dimension == 2 { Value::Vector2(place.point.truncate()) } else { Value::Vector3(place.point) };
        f.emit(3, point)?;
        f.emit(4, Value::Integer(place.dimension.into()))?;
    }
    f.emit(5, Value::Boolean(place.is_some()))?;
    f.emit(6, Value::Integer(type_code))?;
    f.emit(7, Value::string(node.as_ref().map_or("", Name::as_str)))?;
    if let Some(parameter) = place.and_then(|place| place.parameter) {
        f.emit(8, Value::Real(parameter))?;
    }
    f.emit(9, joined(far)?)
}

fn joined(identifiers: &[Name]) -> Result<Value, Problem> {
    let text = identifiers.iter().map(Name::as_str).collect::<Vec<_>>().join(",");
    if text.len() > MAX_STRING { Err(Problem::TooLong) } else { Ok(Value::string(text)) }
}
