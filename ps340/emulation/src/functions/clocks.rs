//! Clocks: sequences of values, one at each interval of frames, hundredths of a second or system ticks; and a time-out.
//!
//! A clock has only constant inputs: it never fires on a message, but as time passes. The first output comes one
//! interval after the clock began to run. The numbering of the inputs is uncertain.
//!
//! - While <4> is FALSE the clock stands still; when it runs again, a whole interval passes first.
//! - With <3> FALSE it sends <2> outputs, then TRUE from output 2, and waits for a new <2>, <5>, or TRUE at <4>.
//! - A new <5> restarts the sequence and the count; a new <1> takes effect at the next interval.
//! - Without <5> and <6> it sends the integer 1; without <5>, the sequence starts at zero of the kind of <6>.
//! - A fault stops the clock (<4> becomes FALSE), so that it does not come again at each frame.

use super::{
    FunctionExample, FunctionRow, Source,
    algebra::{difference, sum},
};
use crate::port::{
    Elapsed, Firing, KindSet,
    Literal::{B, I, S},
    PortSpec, Problem,
};
use protocol::Value;

/// Most outputs of a clock for one advance of time; more are left out and reported. Ours.
pub const MAX_OUTPUTS_AT_ONCE: u64 = 1_000;

const AMOUNT: KindSet = KindSet::NUMBER.or(KindSet::VECTOR);
const INPUTS: &[PortSpec] = &[
    PortSpec::optional(KindSet::INTEGER, "interval between outputs"),
    PortSpec::optional(KindSet::INTEGER, "number of outputs before it stops"),
    PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: for ever, without regard to <2>"),
    PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: run, FALSE: stand still"),
    PortSpec::optional(AMOUNT, "first value"),
    PortSpec::optional(AMOUNT, "increment"),
];
const CLOCK: FunctionRow = FunctionRow {
    source: Source::uncertain("shape of the inputs remembered, their numbers and defaults ours"),
    inputs: INPUTS,
    outputs: &["next value of the sequence", "TRUE when the count is exhausted"],
    memory: 3,
    ..FunctionRow::PLAIN
};

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "CLFRAMES",
        summary: "clock that counts refresh frames",
        clock: Some(|f, elapsed| advance(f, elapsed.frames)),
        ..CLOCK
    },
    FunctionRow {
        name: "CLCSECONDS",
        summary: "clock that counts hundredths of a second",
        clock: Some(|f, elapsed| advance(f, elapsed.centiseconds)),
        ..CLOCK
    },
    FunctionRow {
        name: "CLTICKS",
        summary: "clock that counts ticks of the system clock, twentieths of a second",
        clock: Some(|f, elapsed: &Elapsed| advance(f, elapsed.ticks)),
        ..CLOCK
    },
    FunctionRow {
        name: "TIMEOUT",
        summary: "the constant <3> when no message came for a while after one",
        source: Source::uncertain("hundredths of a second, and that the first message starts the watch: ours"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "message: the time begins anew"),
            PortSpec::constant(KindSet::INTEGER, "time, hundredths of a second"),
            PortSpec::constant(KindSet::ANY, "what is sent then, once"),
        ],
        outputs: &["<3>"],
        memory: 1,
        behaviour: |f| {
            let time = f.integer(2)?;
            if time < 1 {
                return Err(Problem::Range(2));
            }
            f.remember(REMAINING, Value::Integer(time));
            Ok(())
        },
        clock: Some(time_out),
        examples: &[
            FunctionExample::of(&[(2, I(50)), (3, S("LATE")), (1, B(true))], &[]),
            FunctionExample::of(&[(2, I(0)), (3, S("LATE")), (1, B(true))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
];

const INTERVAL: u16 = 1;
const COUNT: u16 = 2;
const FOR_EVER: u16 = 3;
const RUN: u16 = 4;
const START: u16 = 5;
const INCREMENT: u16 = 6;

/// Memory: units until the next output.
const REMAINING: u8 = 0;
/// Memory: the next value.
const NEXT: u8 = 1;
/// Memory: how many outputs are left of the count.
const LEFT: u8 = 2;

/// Sends the constant of F:TIMEOUT when its time has passed.
fn time_out(f: &mut Firing, elapsed: &Elapsed) -> Result<u64, Problem> {
    let Some(remaining) = cell(f, REMAINING) else { return Ok(0) };
    match i32::try_from(elapsed.centiseconds) {
        Ok(passed) if passed < remaining => f.remember(REMAINING, Value::Integer(remaining - passed)),
        _ => {
            f.forget(REMAINING);
            if let Some(value) = f.optional(3).cloned() {
                f.emit(1, value)?;
            }
        }
    }
    Ok(0)
}

/// Lets a clock advance; returns how many outputs were left out.
fn advance(f: &mut Firing, elapsed: u64) -> Result<u64, Problem> {
    let outcome = advance_or_fail(f, elapsed);
    if outcome.is_err() {
        f.accumulate(RUN, Value::Boolean(false))?;
        f.forget(REMAINING);
    }
    outcome
}

fn advance_or_fail(f: &mut Firing, elapsed: u64) -> Result<u64, Problem> {
    if f.take_fresh(START) {
        f.forget(NEXT);
        f.forget(LEFT);
    }
    let (counted_anew, started) = (f.take_fresh(COUNT), f.take_fresh(RUN));
    if counted_anew || (started && cell(f, LEFT) == Some(0)) {
        f.forget(LEFT);
    }
    let for_ever = f.boolean(FOR_EVER)?;
    let left = cell(f, LEFT).or(integer(f, COUNT)?).unwrap_or(0).max(0);
    let interval = match integer(f, INTERVAL)? {
        Some(interval) if f.boolean(RUN)? && (for_ever || left > 0) => interval,
        _ => {
            f.forget(REMAINING);
            return Ok(0);
        }
    };
    if interval < 1 {
        return Err(Problem::Range(INTERVAL));
    }
    let (length, remaining) = (i128::from(interval), i128::from(cell(f, REMAINING).unwrap_or(interval)));
    let overdue = i128::from(elapsed) - remaining;
    let due = if overdue < 0 { 0 } else { overdue / length + 1 };
    f.remember(REMAINING, Value::Integer((due * length - overdue) as i32));
    let outputs = if for_ever { due } else { due.min(i128::from(left)) };
    let outputs = u64::try_from(outputs).unwrap_or(u64::MAX);
    let sent = outputs.min(MAX_OUTPUTS_AT_ONCE);
    for _ in 0..sent {
        send_next(f)?;
    }
    if !for_ever {
        let left = left - outputs as i32;
        f.remember(LEFT, Value::Integer(left));
        if left == 0 {
            f.emit(2, Value::Boolean(true))?;
        }
    }
    Ok(outputs - sent)
}

/// Sends the next value of the sequence and works out the one after it.
fn send_next(f: &mut Firing) -> Result<(), Problem> {
    let (start, increment) = (f.optional(START), f.optional(INCREMENT));
    let value = match (f.memory(NEXT).or(start), increment) {
        (Some(value), _) => value.clone(),
        (None, Some(increment)) => difference(increment, increment).ok_or(Problem::Kind(INCREMENT))?,
        (None, None) => return f.emit(1, Value::Integer(1)),
    };
    if let Some(increment) = increment {
        let next = sum(&value, increment).ok_or(Problem::Kind(INCREMENT))?;
        if !next.is_finite() {
            return Err(Problem::Overflow);
        }
        f.remember(NEXT, next);
    }
    f.emit(1, value)
}

fn integer(f: &Firing, input: u16) -> Result<Option<i32>, Problem> {
    f.optional(input).map(|_| f.integer(input)).transpose()
}

fn cell(f: &Firing, cell: u8) -> Option<i32> {
    match f.memory(cell) {
        Some(Value::Integer(i)) => Some(*i),
        _ => None,
    }
}
