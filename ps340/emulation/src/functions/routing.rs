//! Routing and choosing: where a message goes on, which message goes on, and messages that wait for each other.

use super::{Family, FunctionExample, FunctionRow, Rule, Source};
use crate::port::{
    Firing, KindSet,
    Literal::{B, I, R, S},
    PortSpec, Problem,
};
use protocol::Value;

const ANY: PortSpec = PortSpec::active(KindSet::ANY, "message");
const HELD: PortSpec = PortSpec::constant(KindSet::ANY, "message");

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "NOP",
        summary: "the message as it is; also a drain for outputs that are not wanted",
        source: Source::confirmed("clients drain unused outputs with it"),
        inputs: &[ANY],
        outputs: &["message"],
        behaviour: |f| pass(f, 1, 1),
        examples: &[
            FunctionExample::of(&[(1, S("A")), (1, I(2))], &[(1, S("A")), (1, I(2))]),
            FunctionExample::of(&[(1, B(false)), (1, R(0.5))], &[(1, B(false)), (1, R(0.5))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PASSTHRU",
        summary: "n independent channels, each as F:NOP",
        source: Source::manual(""),
        inputs: &[ANY],
        outputs: &["message"],
        family: Family::Channels,
        rule: Rule::Any,
        behaviour: |f| {
            for channel in 1..=f.size() {
                if f.optional(channel).is_some() {
                    pass(f, channel, channel)?;
                }
            }
            Ok(())
        },
        examples: &[
            FunctionExample::of(&[(2, I(7)), (1, R(1.0)), (2, I(8))], &[(2, I(7)), (1, R(1.0)), (2, I(8))]).sized(3),
            FunctionExample::of(&[(1, S("A")), (1, S("B")), (2, S("C"))], &[(1, S("A")), (1, S("B")), (2, S("C"))])
                .sized(2),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CONSTANT",
        summary: "the constant <2>, whenever a trigger arrives",
        source: Source::confirmed("clients answer the end of a rendering with it"),
        inputs: &[PortSpec::active(KindSet::ANY, "trigger"), HELD],
        outputs: &["<2>"],
        behaviour: |f| pass(f, 2, 1),
        examples: &[
            FunctionExample::of(&[(1, B(true)), (2, I(0)), (1, S("GO"))], &[(1, I(0)), (1, I(0))]),
            FunctionExample::of(&[(2, I(1)), (2, S("LAST")), (1, I(0))], &[(1, S("LAST"))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "BROUTE",
        summary: "the message <2> to output 1 for TRUE, 2 for FALSE",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "selector"), ANY],
        outputs: &["<2> if TRUE", "<2> if FALSE"],
        behaviour: route_by_boolean,
        examples: &[
            FunctionExample::of(&[(1, B(true)), (2, I(1)), (2, I(2)), (1, B(false))], &[(1, I(1)), (2, I(2))]),
            FunctionExample::of(&[(1, I(1)), (1, B(true)), (2, S("A"))], &[(1, S("A"))]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "BROUTEC",
        summary: "a constant message to output 1 for TRUE, 2 for FALSE",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "selector"), HELD],
        outputs: &["<2> if TRUE", "<2> if FALSE"],
        behaviour: route_by_boolean,
        examples: &[
            FunctionExample::of(&[(2, I(5)), (1, B(false)), (1, B(true))], &[(2, I(5)), (1, I(5))]),
            FunctionExample::of(&[(2, S("A")), (2, S("B")), (1, B(true))], &[(1, S("B"))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CBROUTE",
        summary: "each message <2> to output 1 or 2, by a constant Boolean: a gate",
        source: Source::manual(""),
        inputs: &[PortSpec::constant(KindSet::BOOLEAN, "selector"), ANY],
        outputs: &["<2> if TRUE", "<2> if FALSE"],
        behaviour: route_by_boolean,
        examples: &[
            FunctionExample::of(&[(1, B(false)), (2, I(5)), (2, I(6))], &[(2, I(5)), (2, I(6))]),
            FunctionExample::of(&[(1, B(true)), (2, I(1)), (1, B(false)), (2, I(2))], &[(1, I(1)), (2, I(2))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "BOOLEAN_CHOOSE",
        summary: "the constant <2> for TRUE, <3> for FALSE",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "selector"), HELD, HELD],
        outputs: &["<2> or <3>"],
        behaviour: |f| {
            let chosen = if f.boolean(1)? { 2 } else { 3 };
            pass(f, chosen, 1)
        },
        examples: &[
            FunctionExample::of(&[(2, S("YES")), (3, I(0)), (1, B(true)), (1, B(false))], &[(1, S("YES")), (1, I(0))]),
            FunctionExample::of(&[(3, I(3)), (1, B(true)), (1, B(false)), (2, I(2))], &[(1, I(2)), (1, I(3))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ROUTE",
        summary: "the message <2> to the output that <1> says",
        source: Source::confirmed("clients sort the buttons of the puck with it; a wrong number loses the message"),
        inputs: &[PortSpec::active(KindSet::INTEGER, "output, 1 to n"), ANY],
        outputs: &["<2>"],
        family: Family::Outputs,
        behaviour: route_by_integer,
        examples: &[
            FunctionExample::of(&[(1, I(9)), (2, I(9)), (1, I(2)), (2, I(2))], &[(9, I(9)), (2, I(2))]).sized(9),
            FunctionExample::of(
                &[(1, I(0)), (2, S("A")), (1, I(4)), (2, S("B")), (1, I(3)), (2, S("C"))],
                &[(3, S("C"))],
            )
            .sized(3)
            .faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ROUTEC",
        summary: "a constant message to the output that <1> says",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::INTEGER, "output, 1 to n"), HELD],
        outputs: &["<2>"],
        family: Family::Outputs,
        behaviour: route_by_integer,
        examples: &[
            FunctionExample::of(&[(2, S("X")), (1, I(2)), (1, I(3))], &[(2, S("X"))]).sized(2).faults(&[6]),
            FunctionExample::of(&[(1, I(1)), (2, S("A")), (1, I(-1)), (1, I(2))], &[(1, S("A")), (2, S("A"))])
                .sized(2)
                .faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CROUTE",
        summary: "each message <2> to the output that a constant says: a switch",
        source: Source::manual(""),
        inputs: &[PortSpec::constant(KindSet::INTEGER, "output, 1 to n"), ANY],
        outputs: &["<2>"],
        family: Family::Outputs,
        behaviour: route_by_integer,
        examples: &[
            FunctionExample::of(&[(1, I(2)), (2, S("X")), (2, S("Y"))], &[(2, S("X")), (2, S("Y"))]).sized(2),
            FunctionExample::of(&[(1, I(3)), (2, S("A")), (1, I(1)), (2, S("B"))], &[(1, S("B"))])
                .sized(2)
                .faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "INPUTS_CHOOSE",
        summary: "the constant input that the integer at the last input says",
        source: Source::manual("n counts the selector: ours"),
        inputs: &[HELD, PortSpec::active(KindSet::INTEGER, "input, 1 to n - 1")],
        outputs: &["the chosen constant"],
        family: Family::Inputs,
        behaviour: |f| {
            let selector = f.size();
            match u16::try_from(f.integer(selector)?) {
                Ok(input) if (1..selector).contains(&input) => pass(f, input, 1),
                _ => Err(Problem::Range(selector)),
            }
        },
        examples: &[
            FunctionExample::of(
                &[(1, S("A")), (2, S("B")), (3, I(2)), (3, I(3)), (3, I(1))],
                &[(1, S("B")), (1, S("A"))],
            )
            .sized(3)
            .faults(&[6]),
            FunctionExample::of(&[(1, I(7)), (2, I(0)), (2, I(1))], &[(1, I(7))]).sized(2).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "RANGE_SELECT",
        summary: "the number to output 1 if it lies in a range, else to output 2",
        source: Source::uncertain("inputs and outputs; the limits belong to the range"),
        inputs: &[
            PortSpec::active(KindSet::NUMBER, "number"),
            PortSpec::constant(KindSet::NUMBER, "lower limit"),
            PortSpec::constant(KindSet::NUMBER, "upper limit"),
        ],
        outputs: &["<1> if inside", "<1> if outside", "whether it is inside"],
        behaviour: |f| {
            let (number, low, high) = (f.number(1)?, f.number(2)?, f.number(3)?);
            if low > high {
                return Err(Problem::Range(3));
            }
            let inside = (low..=high).contains(&number);
            pass(f, 1, if inside { 1 } else { 2 })?;
            f.emit(3, Value::Boolean(inside))
        },
        examples: &[
            FunctionExample::of(
                &[(2, I(1)), (3, I(3)), (1, I(3)), (1, R(3.5))],
                &[(1, I(3)), (3, B(true)), (2, R(3.5)), (3, B(false))],
            ),
            FunctionExample::of(
                &[(2, R(1.0)), (3, R(1.0)), (1, I(1)), (2, R(2.0)), (1, I(1))],
                &[(1, I(1)), (3, B(true))],
            )
            .faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SYNC",
        summary: "one message of each input, all at once, when all are there",
        source: Source::manual(""),
        inputs: &[ANY],
        outputs: &["message"],
        family: Family::Channels,
        behaviour: |f| (1..=f.size()).try_for_each(|channel| pass(f, channel, channel)),
        examples: &[
            FunctionExample::of(&[(1, I(1)), (1, I(2)), (2, S("A"))], &[(1, I(1)), (2, S("A"))]).sized(2),
            FunctionExample::of(&[(3, I(3)), (2, I(2)), (1, I(1))], &[(1, I(1)), (2, I(2)), (3, I(3))]).sized(3),
        ],
        ..FunctionRow::PLAIN
    },
];

fn pass(f: &mut Firing, input: u16, output: u16) -> Result<(), Problem> {
    f.pass(input, output)
}

fn route_by_boolean(f: &mut Firing) -> Result<(), Problem> {
    let output = if f.boolean(1)? { 1 } else { 2 };
    pass(f, 2, output)
}

fn route_by_integer(f: &mut Firing) -> Result<(), Problem> {
    match u16::try_from(f.integer(1)?) {
        Ok(output) if (1..=f.size()).contains(&output) => pass(f, 2, output),
        _ => Err(Problem::Range(1)),
    }
}
