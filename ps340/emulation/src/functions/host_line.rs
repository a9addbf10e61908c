//! The host line as functions: packets, their routes, and interpreters of what they carry.
//!
//! The machine reads its own lines with fixed parts; these functions let a network do the same with strings from
//! anywhere. Used: the packets of count mode and the routing bytes as remembered. Modelled: a packet on an arc is a
//! string, its routing byte first. *Not modelled*: packets of escape mode.

use super::{Family, FunctionExample, FunctionRow, Rule, Source};
use crate::port::{
    Cause, Effect, Fault, Firing, KindSet,
    Literal::{I, S},
    PortSpec, Problem, StreamKind,
};
use protocol::{
    Value,
    wire::{COUNT_BIAS, COUNT_RADIX, MAX_COUNT_DATA, Route, count_header},
};

/// Bytes before the routing byte of a count packet: start and two characters of the count.
const HEAD: usize = 3;

/// The memory cell with a packet that is not yet complete.
const PART: u8 = 0;
/// The memory cell that is filled once an interpreter was given bytes.
const BEGUN: u8 = 0;

const START: PortSpec = PortSpec::default(KindSet::INTEGER, I(28), "code of the character that starts a packet");

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "DEPACKET",
        summary: "packets of count mode found in a stream of characters",
        source: Source::manual(
            "the count as in F:PACKET; a start character without a count passes as text, a packet of nothing is left \
             out: ours",
        ),
        inputs: &[PortSpec::active(KindSet::STRING, "characters"), START],
        outputs: &["packets: routing byte, then data", "text outside packets"],
        memory: 1,
        behaviour: unpack,
        examples: &[
            FunctionExample::of(
                &[(1, S("HI\u{1c} $0ABC!")), (1, S("\u{1c} !1"))],
                &[(1, S("0ABC")), (2, S("HI!")), (1, S("1"))],
            ),
            FunctionExample::of(
                &[(1, S("\u{1c}")), (1, S(" ")), (1, S("#0A")), (1, S("BC"))],
                &[(1, S("0AB")), (2, S("C"))],
            ),
            FunctionExample::of(&[(2, I(2)), (1, S("\u{2}\u{2} \"0X\u{1c}"))], &[(1, S("0X")), (2, S("\u{2}\u{1c}"))]),
            FunctionExample::of(&[(2, I(256)), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PACKET",
        summary: "a string as packets of count mode",
        source: Source::uncertain("a long string becomes several packets: ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "data"),
            PortSpec::constant(KindSet::STRING, "routing byte, one character"),
            START,
        ],
        outputs: &["packets as they stand on a line"],
        behaviour: pack,
        examples: &[
            FunctionExample::of(
                &[(2, S("0")), (1, S("ABC")), (1, S(""))],
                &[(1, S("\u{1c} $0ABC")), (1, S("\u{1c} !0"))],
            ),
            FunctionExample::of(&[(2, S("01")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CIROUTE",
        summary: "the data of packets to the outputs that their routing bytes say, text to output 1",
        source: Source::manual("byte '0' belongs to output 2, '1' to 3 and so on; input 2 is ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "packet: routing byte, then data"),
            PortSpec::active(KindSet::STRING, "text outside packets"),
            PortSpec::default(KindSet::INTEGER, I(48), "code of the routing byte that belongs to output 2"),
        ],
        outputs: &["text outside packets on output 1, data of packets on the others"],
        family: Family::Outputs,
        rule: Rule::Any,
        behaviour: route,
        examples: &[
            FunctionExample::of(
                &[(1, S("0ABC")), (2, S("TEXT")), (1, S("1"))],
                &[(2, S("ABC")), (1, S("TEXT")), (3, S(""))],
            )
            .sized(3),
            FunctionExample::of(&[(1, S("2A")), (1, S("/A")), (1, S(""))], &[]).sized(3).faults(&[6, 6, 6]),
            FunctionExample::of(&[(3, I(65)), (1, S("A0"))], &[(2, S("0"))]).sized(2),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CI",
        summary: "command interpreter: carries out the text of commands",
        source: Source::manual("n has no effect, and the output is ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "text; a command may go on in the next message")],
        outputs: COMPLETED,
        family: Family::Device,
        memory: 1,
        behaviour: |f| interpret(f, StreamKind::Text),
        examples: &[
            FunctionExample::of(&[(1, S("SEND 1 TO "))], &[]),
            FunctionExample::of(&[(1, I(1)), (1, S("<1>A;"))], &[]).sized(2).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "READSTREAM",
        summary: "carries out binary commands",
        source: Source::manual("the records are ours, see protocol/PROTOCOL.md; a message holds whole records"),
        inputs: &[PortSpec::active(KindSet::STRING, "records")],
        outputs: COMPLETED,
        memory: 1,
        behaviour: |f| interpret(f, StreamKind::Binary),
        examples: RECORDS,
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "RASTERSTREAM",
        summary: "carries out raster commands",
        source: Source::uncertain("the records are ours, see protocol/PROTOCOL.md; a message holds whole records"),
        inputs: &[PortSpec::active(KindSet::STRING, "records")],
        outputs: COMPLETED,
        memory: 1,
        behaviour: |f| interpret(f, StreamKind::Raster),
        examples: RECORDS,
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "GATHER_GENFCN",
        summary: "would take functions of the user; they are code for the processor of the machine, so each is refused",
        source: Source::manual("its text is read up to the end record (S7, S8, S9), then one error says so: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "S-records")],
        behaviour: refuse_user_code,
        examples: &[
            FunctionExample::of(&[(1, S("S1130000285F245F2212226A000424290008237C2A"))], &[]),
            FunctionExample::of(&[(1, S("S1070000AABBCCDDEA\r\nS9030000FC\r\n"))], &[]).faults(&[10]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TEC",
        summary: "characters to the terminal emulator",
        source: Source::manual("other inputs and outputs, if there were any, are unknown"),
        inputs: &[PortSpec::active(KindSet::STRING, "characters")],
        behaviour: |f| {
            let text = f.string(1)?.into();
            f.effect(Effect::Terminal(text));
            Ok(())
        },
        examples: &[
            FunctionExample::of(&[(1, S("\u{1b}[H\u{1b}[J"))], &[]),
            FunctionExample::of(&[(1, I(13)), (1, S("\r"))], &[]).faults(&[5]),
        ],
        ..FunctionRow::PLAIN
    },
];

const COMPLETED: &[&str] = &["how many commands the message completed"];
const RECORDS: &[FunctionExample] =
    &[FunctionExample::of(&[(1, S(""))], &[]), FunctionExample::of(&[(1, I(0))], &[]).faults(&[5])];

/// The character that starts a packet, at an input.
fn start(f: &Firing, input: u16) -> Result<u8, Problem> {
    u8::try_from(f.integer(input)?).map_err(|_| Problem::Range(input))
}

fn unpack(f: &mut Firing) -> Result<(), Problem> {
    let start = start(f, 2)?;
    let mut stream = match f.memory(PART) {
        Some(Value::String(part)) => part.to_vec(),
        _ => Vec::new(),
    };
    stream.extend_from_slice(f.string(1)?);
    let (mut packets, mut text, mut rest) = (Vec::new(), Vec::new(), &stream[..]);
    while let Some(at) = rest.iter().position(|&byte| byte == start) {
        text.extend_from_slice(&rest[..at]);
        rest = &rest[at..];
        let [high, low] = [1, 2].map(|i| rest.get(i).map(|&digit| count_digit(digit)));
        match (high, low) {
            (None, _) | (Some(Some(_)), None) => break,
            (Some(Some(high)), Some(Some(low))) => {
                let end = HEAD + high * COUNT_RADIX + low;
                let Some(packet) = rest.get(HEAD..end) else { break };
                packets.push(packet);
                rest = &rest[end..];
            }
            _ => {
                text.push(start);
                rest = &rest[1..];
            }
        }
    }
    if rest.first() != Some(&start) {
        text.extend_from_slice(rest);
        rest = &[];
    }
    f.remember(PART, Value::string(rest));
    packets.into_iter().filter(|p| !p.is_empty()).try_for_each(|packet| f.emit(1, Value::string(packet)))?;
    if text.is_empty() { Ok(()) } else { f.emit(2, Value::String(text.into())) }
}

/// The value of a character of a count; none if it cannot stand in one.
fn count_digit(byte: u8) -> Option<usize> {
    byte.checked_sub(COUNT_BIAS).map(usize::from).filter(|digit| *digit < COUNT_RADIX)
}

fn pack(f: &mut Firing) -> Result<(), Problem> {
    let (route, start) = (f.string(2)?, start(f, 3)?);
    let &[route] = route else { return Err(Problem::Range(2)) };
    let data = f.string(1)?.to_vec();
    let parts = data.chunks(MAX_COUNT_DATA).chain(data.is_empty().then_some(&data[..]));
    for part in parts {
        let mut packet = count_header(Route::from(route), part.len()).to_vec();
        packet[0] = start;
        packet.extend_from_slice(part);
        f.emit(1, Value::String(packet.into()))?;
    }
    Ok(())
}

fn route(f: &mut Firing) -> Result<(), Problem> {
    let base = f.integer(3)?;
    if f.optional(1).is_some() {
        let Value::String(packet) = f.take(1) else { return Err(Problem::Kind(1)) };
        let output = |byte: u8| u16::try_from(i64::from(byte) - i64::from(base) + 2).ok();
        let known = |output: &u16| (2..=f.size()).contains(output);
        match packet.split_first().and_then(|(&byte, data)| Some((output(byte).filter(known)?, data))) {
            Some((output, data)) => f.emit(output, Value::string(data))?,
            // No failure of the firing, since a text may wait at input 2.
            None => {
                let fault = Fault { function: "CIROUTE", cause: Cause::Range { input: 1 } };
                f.effect(Effect::Fault { object: f.object(), fault });
            }
        }
    }
    if f.optional(2).is_some() {
        let text = f.take(2);
        f.emit(1, text)?;
    }
    Ok(())
}

fn interpret(f: &mut Firing, stream: StreamKind) -> Result<(), Problem> {
    let Value::String(bytes) = f.take(1) else { return Err(Problem::Kind(1)) };
    let fresh = f.memory(BEGUN).is_none();
    f.remember(BEGUN, Value::Boolean(true));
    f.effect(Effect::Interpret { function: f.object(), stream, bytes, fresh });
    Ok(())
}

fn refuse_user_code(f: &mut Firing) -> Result<(), Problem> {
    let is_end = |line: &[u8]| matches!(line.trim_ascii_start(), [b'S', b'7'..=b'9', ..]);
    if f.string(1)?.split(|byte| matches!(byte, b'\r' | b'\n')).any(is_end) {
        let fault = Fault { function: "GATHER_GENFCN", cause: Cause::UserCode };
        f.effect(Effect::Fault { object: f.object(), fault });
    }
    Ok(())
}
