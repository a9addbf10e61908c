//! The state of the machine: use of memory, and the messages of the machine.

use super::{
    super::{FunctionExample, FunctionRow, Source},
    common::TEXT,
};
use crate::port::{
    Effect, Elapsed, Firing, KindSet,
    Literal::{I, S},
    PortSpec, Problem,
};
use protocol::Value;

/// Longest time between two lines about memory, in seconds: a day.
const MAX_INTERVAL: f64 = 86_400.0;

/// What the alarms of memory have in common.
const ALERT: FunctionRow = FunctionRow {
    name: "MEMORY_ALERT",
    summary: "speaks once when memory is nearly used up",
    source: Source::manual("the text, the limit and its input are ours"),
    inputs: &[PortSpec::default(KindSet::NUMBER, I(90), "percent of memory in use at which it speaks")],
    outputs: &["string with the use of memory"],
    ..FunctionRow::PLAIN
};

/// What the three classes of message have in common.
const MESSAGES: FunctionRow = FunctionRow {
    source: Source::manual(""),
    inputs: TEXT,
    outputs: &["string"],
    behaviour: pass,
    examples: PASS_THROUGH_EXAMPLES,
    ..FunctionRow::PLAIN
};

/// The rows of the state.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "MEMORY_MONITOR",
        summary: "a line about the use of memory, now and every <3> seconds",
        source: Source::confirmed("clients send FIX(1) to <3> and connect output 1; that <3> counts seconds is ours"),
        inputs: &[
            PortSpec::optional(KindSet::ANY, "unused"),
            PortSpec::optional(KindSet::ANY, "unused"),
            PortSpec::active(KindSet::NUMBER, "seconds from line to line, to 86400; 0: only one now"),
        ],
        outputs: &["string"],
        memory: 2,
        behaviour: begin_monitor,
        clock: Some(advance_monitor),
        examples: &[FunctionExample::of(&[(3, I(-1)), (3, I(86_401))], &[]).faults(&[6, 6])],
        ..FunctionRow::PLAIN
    },
    ALERT,
    FunctionRow {
        name: "WRITEBACK",
        summary: "the picture as data: what WRITEBACK nodes were asked for, or all that is displayed",
        source: Source::uncertain("records and text are ours"),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "TRUE: all that is displayed")],
        outputs: &[
            "records of eight bytes, many in a message",
            "the same as the text of a vector list, a line a message",
        ],
        behaviour: |f| {
            if f.boolean(1)? {
                f.effect(crate::port::Effect::RequestWriteBack { node: None });
            }
            Ok(())
        },
        ..FunctionRow::PLAIN
    },
    FunctionRow { name: "MEMALERT", summary: "the same as MEMORY_ALERT", ..ALERT },
    FunctionRow { name: "ERROR", summary: "text of every error, for whatever is connected", ..MESSAGES },
    FunctionRow { name: "WARNING", summary: "text of every warning, for whatever is connected", ..MESSAGES },
    FunctionRow { name: "INFORMATION", summary: "text of every information, for whatever is connected", ..MESSAGES },
];

const PASS_THROUGH_EXAMPLES: &[FunctionExample] =
    &[FunctionExample::of(&[(1, S("E 5 *** text"))], &[(1, S("E 5 *** text"))])];

/// Memory: hundredths of a second from line to line; nothing if there is no next one.
const INTERVAL: u8 = 0;
/// Memory: hundredths of a second until the next line.
const REMAINING: u8 = 1;

fn begin_monitor(f: &mut Firing) -> Result<(), Problem> {
    let seconds = f.number(3)?;
    if !(0.0..=MAX_INTERVAL).contains(&seconds) {
        return Err(Problem::Range(3));
    }
    let centiseconds = (seconds * 100.0).round() as i32;
    if centiseconds > 0 {
        f.remember(INTERVAL, Value::Integer(centiseconds));
        f.remember(REMAINING, Value::Integer(centiseconds));
    } else {
        f.forget(INTERVAL);
    }
    f.effect(Effect::ReportMemory { function: f.object() });
    Ok(())
}

/// One line at most, also if more than one interval has passed.
fn advance_monitor(f: &mut Firing, elapsed: &Elapsed) -> Result<u64, Problem> {
    let (Some(Value::Integer(interval)), Some(Value::Integer(remaining))) = (f.memory(INTERVAL), f.memory(REMAINING))
    else {
        return Ok(0);
    };
    let (interval, left) = (*interval, i64::from(*remaining) - i64::try_from(elapsed.centiseconds).unwrap_or(i64::MAX));
    if left > 0 {
        f.remember(REMAINING, Value::Integer(left as i32));
    } else {
        f.remember(REMAINING, Value::Integer(interval));
        f.effect(Effect::ReportMemory { function: f.object() });
    }
    Ok(0)
}

fn pass(f: &mut Firing) -> Result<(), Problem> {
    let text = f.take(1);
    f.emit(1, text)
}
