//! Accumulation and change: sums and means, limits, and messages that pass only when something changed.

use super::{
    FunctionExample, FunctionRow, Source,
    algebra::{difference, distance, limited, product, quotient, sum},
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
            FunctionExample::of(
                &[(2, V3([0.0; 3])), (4, R(5.0)), (5, R(100.0)), (6, R(-100.0)), (1, V3([0.1, 0.0, 0.0]))],
                &[(1, V3([0.5, 0.0, 0.0]))],
            ),
            FunctionExample::of(
                &[(1, V2([1.0, 2.0])), (1, V2([1.0, 2.0]))],
                &[(1, V2([1.0, 2.0])), (1, V2([2.0, 4.0]))],
            ),
            FunctionExample::of(&[(1, I(2)), (1, I(3)), (2, I(10)), (1, I(0))], &[(1, I(2)), (1, I(5)), (1, I(10))]),
            FunctionExample::of(&[(3, R(1.0)), (1, R(0.6)), (1, R(0.6)), (1, R(0.6))], &[(1, R(0.6)), (1, R(1.8))]),
            FunctionExample::of(
                &[(5, R(1.0)), (6, R(-1.0)), (1, V2([3.0, -0.5])), (1, V2([-0.5, -3.0]))],
                &[(1, V2([1.0, -0.5])), (1, V2([0.5, -1.0]))],
            ),
            FunctionExample::of(
                &[(2, V3([1.0; 3])), (1, R(1.0)), (1, V3([1.0, 0.0, 0.0]))],
                &[(1, V3([2.0, 1.0, 1.0]))],
            )
            .faults(&[5]),
            FunctionExample::of(&[(5, R(-1.0)), (6, R(1.0)), (1, R(0.0))], &[]).faults(&[6]),
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
            FunctionExample::of(
                &[(2, I(1)), (1, I(1)), (1, I(1)), (1, I(0)), (1, I(1))],
                &[(1, I(1)), (1, I(0)), (1, I(1))],
            ),
            FunctionExample::of(
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
        examples: &[
            FunctionExample::of(
                &[(2, B(true)), (1, B(true)), (1, B(true)), (1, B(false)), (1, B(true))],
                &[(1, B(true)), (1, B(true))],
            ),
            FunctionExample::of(
                &[(2, B(false)), (1, B(true)), (1, B(false)), (1, B(false)), (2, B(true)), (1, B(true))],
                &[(1, B(false)), (1, B(true))],
            ),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "AVERAGE",
        summary: "mean of each <2> messages that follow each other",
        source: Source::manual("the mean of integers is a real: ours"),
        inputs: &[PortSpec::active(AMOUNT, "value"), PortSpec::constant(KindSet::INTEGER, "how many")],
        outputs: &["mean"],
        memory: 2,
        behaviour: average,
        examples: &[
            FunctionExample::of(
                &[(2, I(2)), (1, I(1)), (1, I(2)), (1, R(5.0)), (2, I(1)), (1, I(7)), (1, I(4))],
                &[(1, R(1.5)), (1, R(6.0)), (1, R(4.0))],
            ),
            FunctionExample::of(
                &[(2, I(2)), (1, V2([1.0, 2.0])), (1, V3([1.0; 3])), (1, V2([3.0, 4.0]))],
                &[(1, V2([2.0, 3.0]))],
            )
            .faults(&[5]),
            FunctionExample::of(&[(2, I(0)), (1, I(1))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ATSCALE",
        summary: "the value scaled, large ones more than small ones: fine and coarse control with one dial",
        source: Source::uncertain(
            "only that the gain grows with the value is remembered; the rule and <2>, <3> are ours",
        ),
        inputs: &[
            PortSpec::active(AMOUNT, "value"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "factor of small values"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "size above which the factor grows in proportion to the size"),
        ],
        outputs: &["<1> x <2> x the larger of 1 and |<1>| / <3>"],
        behaviour: scale_by_size,
        examples: &[
            FunctionExample::of(
                &[(2, R(10.0)), (3, R(0.5)), (1, R(0.25)), (1, R(-2.0))],
                &[(1, R(2.5)), (1, R(-80.0))],
            ),
            FunctionExample::of(&[(1, V2([3.0, 4.0])), (1, I(1))], &[(1, V2([15.0, 20.0])), (1, R(1.0))]),
            FunctionExample::of(&[(3, R(0.0)), (1, R(1.0))], &[]).faults(&[6]),
        ],
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
            FunctionExample::of(
                &[(2, R(1.0)), (3, R(-1.0)), (1, R(3.0)), (1, I(-2)), (1, R(0.5))],
                &[(1, R(1.0)), (1, I(-1)), (1, R(0.5))],
            ),
            FunctionExample::of(&[(2, R(-1.0)), (3, R(1.0)), (1, R(3.0))], &[]).faults(&[6]),
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

/// Memory of F:AVERAGE: the sum, and how many values it has.
const SUM: u8 = 0;
const SUMMED: u8 = 1;

fn average(f: &mut Firing) -> Result<(), Problem> {
    let wanted = f.integer(2)?;
    if wanted < 1 {
        return Err(Problem::Range(2));
    }
    let total = match f.memory(SUM) {
        Some(before) => sum(before, f.value(1)).ok_or(Problem::Mismatch)?,
        // As a real, so that a sum of integers cannot wrap.
        None => quotient(f.value(1), 1.0).ok_or(Problem::Kind(1))?,
    };
    if !total.is_finite() {
        return Err(Problem::Overflow);
    }
    let count = 1 + match f.memory(SUMMED) {
        Some(Value::Integer(count)) => *count,
        _ => 0,
    };
    if count < wanted {
        f.remember(SUM, total);
        f.remember(SUMMED, Value::Integer(count));
        return Ok(());
    }
    f.forget(SUM);
    f.forget(SUMMED);
    let mean = quotient(&total, count.into()).ok_or(Problem::Kind(1))?;
    f.emit(1, mean)
}

fn scale_by_size(f: &mut Firing) -> Result<(), Problem> {
    let (gain, threshold) = (f.number(2)?, f.number(3)?);
    if threshold <= 0.0 {
        return Err(Problem::Range(3));
    }
    let value = f.value(1);
    let zero = difference(value, value).ok_or(Problem::Kind(1))?;
    let size = distance(value, &zero).ok_or(Problem::Kind(1))?;
    let factor = gain * (size / threshold).max(1.0);
    let scaled = product(value, &Value::Real(factor)).ok_or(Problem::Kind(1))?;
    f.emit(1, scaled)
}
