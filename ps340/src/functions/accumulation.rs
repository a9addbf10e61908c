//! Accumulation and change: sums of the turns of a dial, and messages that pass only when something changed.

use super::{
    Example, FunctionRow, Source,
    algebra::{distance, limited, product, sum},
};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I, R, V2, V3},
    PortSpec, Problem,
};
use protocol::Value;

const AMOUNT: KindSet = KindSet::NUMBER.or(KindSet::VECTOR);

/// The memory cell with the value that left the function last.
const LAST: u8 = 0;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "ACCUMULATE",
        summary: "sum of all changes, scaled and limited",
        source: Source::confirmed(
            "inputs <1>, <2>, <4> to <6> as clients use them; the first message always leaves: ours",
        ),
        inputs: &[
            PortSpec::active(AMOUNT, "change"),
            PortSpec::optional(AMOUNT, "accumulated value, zero of the kind of <1> at first; sending replaces it"),
            PortSpec::default(KindSet::NUMBER, R(0.0), "least movement since the last output"),
            PortSpec::optional(KindSet::NUMBER, "factor of the change, 1 at first"),
            PortSpec::optional(KindSet::NUMBER, "upper limit of each component"),
            PortSpec::optional(KindSet::NUMBER, "lower limit of each component"),
        ],
        outputs: &["accumulated value"],
        memory: 1,
        behaviour: accumulate,
        examples: &[
            Example::of(
                &[(2, V3([0.0; 3])), (4, R(5.0)), (5, R(100.0)), (6, R(-100.0)), (1, V3([0.1, 0.0, 0.0]))],
                &[(1, V3([0.5, 0.0, 0.0]))],
            ),
            Example::of(&[(1, V2([1.0, 2.0])), (1, V2([1.0, 2.0]))], &[(1, V2([1.0, 2.0])), (1, V2([2.0, 4.0]))]),
            Example::of(&[(1, I(2)), (1, I(3)), (2, I(10)), (1, I(0))], &[(1, I(2)), (1, I(5)), (1, I(10))]),
            Example::of(&[(3, R(1.0)), (1, R(0.6)), (1, R(0.6)), (1, R(0.6))], &[(1, R(0.6)), (1, R(1.8))]),
            Example::of(
                &[(5, R(1.0)), (6, R(-1.0)), (1, V2([3.0, -0.5])), (1, V2([-0.5, -3.0]))],
                &[(1, V2([1.0, -0.5])), (1, V2([0.5, -1.0]))],
            ),
            Example::of(&[(2, V3([1.0; 3])), (1, R(1.0)), (1, V3([1.0, 0.0, 0.0]))], &[(1, V3([2.0, 1.0, 1.0]))])
                .faults(&[5]),
            Example::of(&[(5, R(-1.0)), (6, R(1.0)), (1, R(0.0))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DELTA",
        summary: "the message if it differs enough from the last one that passed",
        source: Source::confirmed("clients pass each change of the puck's buttons once, the first included"),
        inputs: &[PortSpec::active(AMOUNT, "value"), PortSpec::constant(KindSet::NUMBER, "least difference")],
        outputs: &["value"],
        memory: 1,
        behaviour: |f| {
            let least = f.number(2)?;
            let changed = moved(f, f.value(1), least);
            if changed {
                let value = f.take(1);
                f.remember(LAST, value.clone());
                f.emit(1, value)?;
            }
            Ok(())
        },
        examples: &[
            Example::of(&[(2, I(1)), (1, I(1)), (1, I(1)), (1, I(0)), (1, I(1))], &[(1, I(1)), (1, I(0)), (1, I(1))]),
            Example::of(
                &[(2, R(1.0)), (1, V2([0.0, 0.0])), (1, V2([0.6, 0.0])), (1, V2([0.6, 0.8]))],
                &[(1, V2([0.0, 0.0])), (1, V2([0.6, 0.8]))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "EDGE_DETECT",
        summary: "the message when it changes to the value of <2>",
        source: Source::manual("the first message counts as a change: ours"),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "value"), PortSpec::constant(KindSet::BOOLEAN, "wanted value")],
        outputs: &["<2>"],
        memory: 1,
        behaviour: |f| {
            let value = Value::Boolean(f.boolean(1)?);
            let edge = value == *f.value(2) && f.memory(LAST) != Some(&value);
            f.remember(LAST, value.clone());
            if edge { f.emit(1, value) } else { Ok(()) }
        },
        examples: &[Example::of(
            &[(2, B(true)), (1, B(true)), (1, B(true)), (1, B(false)), (1, B(true))],
            &[(1, B(true)), (1, B(true))],
        )],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "LIMIT",
        summary: "the value within limits, each component for itself",
        source: Source::uncertain("order of the limits as in F:ACCUMULATE"),
        inputs: &[
            PortSpec::active(AMOUNT, "value"),
            PortSpec::constant(KindSet::NUMBER, "upper limit"),
            PortSpec::constant(KindSet::NUMBER, "lower limit"),
        ],
        outputs: &["limited value"],
        behaviour: |f| {
            let value = within(f.value(1), f.number(2)?, f.number(3)?, 3)?;
            f.emit(1, value)
        },
        examples: &[
            Example::of(
                &[(2, R(1.0)), (3, R(-1.0)), (1, R(3.0)), (1, I(-2)), (1, R(0.5))],
                &[(1, R(1.0)), (1, I(-1)), (1, R(0.5))],
            ),
            Example::of(&[(2, R(-1.0)), (3, R(1.0)), (1, R(3.0))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
];

/// A value within limits; a fault at input `blamed` if the limits are in the wrong order.
fn within(value: &Value, high: f64, low: f64, blamed: u16) -> Result<Value, Problem> {
    if low > high {
        return Err(Problem::Range(blamed));
    }
    limited(value, low, high).ok_or(Problem::Mismatch)
}

/// Whether a value is at least `least` away from the last one that left. One of another kind is; so is the first.
fn moved(f: &Firing, value: &Value, least: f64) -> bool {
    f.memory(LAST).and_then(|last| distance(value, last)).is_none_or(|distance| distance >= least)
}

fn accumulate(f: &mut Firing) -> Result<(), Problem> {
    let change = match f.optional(4) {
        Some(factor) => product(f.value(1), factor).ok_or(Problem::Mismatch)?,
        None => f.value(1).clone(),
    };
    let total = match f.optional(2) {
        Some(value) => sum(value, &change).ok_or(Problem::Mismatch)?,
        None => change,
    };
    if !total.is_finite() {
        return Err(Problem::Overflow);
    }
    let high = f.optional_number(5)?.unwrap_or(f64::MAX);
    let low = f.optional_number(6)?.unwrap_or(f64::MIN);
    let total = within(&total, high, low, 6)?;
    let leaves = moved(f, &total, f.number(3)?);
    f.accumulate(2, total.clone())?;
    if leaves {
        f.remember(LAST, total.clone());
        f.emit(1, total)?;
    }
    Ok(())
}
