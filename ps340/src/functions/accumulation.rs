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
        name: "AVERAGE",
        summary: "mean of each n consecutive values",
        source: Source::manual("a value of another kind, or a new n, begins anew: ours"),
        inputs: &[PortSpec::active(AMOUNT, "value"), PortSpec::constant(KindSet::INTEGER, "n, at least 1")],
        outputs: &["mean, real or vector"],
        memory: 2,
        behaviour: average,
        examples: &[
            Example::of(&[(2, I(2)), (1, I(1)), (1, I(2)), (1, R(5.0)), (1, I(6))], &[(1, R(1.5)), (1, R(5.5))]),
            Example::of(&[(2, I(1)), (1, V2([1.0, 2.0]))], &[(1, V2([1.0, 2.0]))]),
            Example::of(&[(2, I(2)), (1, R(1.0)), (1, V2([1.0, 2.0])), (1, V2([3.0, 4.0]))], &[(1, V2([2.0, 3.0]))]),
            Example::of(&[(2, I(0)), (1, R(1.0))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ATSCALE",
        summary: "the value scaled by its own size, so that large turns count for more",
        source: Source::uncertain("value times its length times <2>: ours"),
        inputs: &[PortSpec::active(AMOUNT, "value"), PortSpec::default(KindSet::NUMBER, R(1.0), "factor")],
        outputs: &["scaled value, real or vector"],
        behaviour: |f| {
            let value = real(f.value(1));
            let size = match &value {
                Value::Real(r) => r.abs(),
                Value::Vector2(v) => v.length(),
                Value::Vector3(v) => v.length(),
                Value::Vector4(v) => v.length(),
                _ => return Err(Problem::Kind(1)),
            };
            let scaled = product(&value, &Value::Real(size * f.number(2)?)).ok_or(Problem::Mismatch)?;
            f.emit(1, scaled)
        },
        examples: &[
            Example::of(&[(1, R(-0.5)), (2, R(4.0)), (1, I(2))], &[(1, R(-0.25)), (1, R(16.0))]),
            Example::of(&[(1, V2([3.0, 4.0]))], &[(1, V2([15.0, 20.0]))]),
            Example::of(&[(1, R(1e200))], &[]).faults(&[7]),
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

/// A value with reals in the place of integers.
fn real(value: &Value) -> Value {
    value.number().map_or_else(|| value.clone(), Value::Real)
}

fn average(f: &mut Firing) -> Result<(), Problem> {
    const SUM: u8 = 0;
    const COUNT: u8 = 1;
    let wanted = f.integer(2)?;
    if wanted < 1 {
        return Err(Problem::Range(2));
    }
    let value = real(f.value(1));
    let begins = f.take_fresh(2);
    let so_far = match (f.memory(SUM).and_then(|before| sum(before, &value)), f.memory(COUNT)) {
        (Some(total), Some(Value::Integer(count))) if !begins => (total, count + 1),
        _ => (value, 1),
    };
    let (total, count) = so_far;
    if !total.is_finite() {
        f.forget(COUNT);
        return Err(Problem::Overflow);
    }
    if count < wanted {
        f.remember(SUM, total);
        f.remember(COUNT, Value::Integer(count));
        return Ok(());
    }
    f.forget(COUNT);
    let mean = product(&total, &Value::Real(1.0 / f64::from(count))).ok_or(Problem::Mismatch)?;
    f.emit(1, mean)
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
