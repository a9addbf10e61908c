//! The host line inside the network: packets, interpreters, the terminal, and files on the disk.

use super::{Example, Family, FunctionRow, Source};
use crate::port::{
    Effect, Firing, KindSet,
    Literal::{I, S},
    PortSpec, Problem, Stream,
};
use protocol::{
    Value,
    value::MAX_STRING,
    wire::{Frame, FrameDecoder, PacketForm, Route, write_packet_as},
};

const TEXT: PortSpec = PortSpec::active(KindSet::STRING, "bytes");
const FILE: PortSpec = PortSpec::active(KindSet::STRING, "name of the file");
/// The memory cell with the beginning of a packet.
const PENDING: u8 = 0;
/// Code of the first routing byte, as remembered.
const FIRST_ROUTE: i32 = 48;

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "DEPACKET",
        summary: "packets out of a stream of bytes",
        source: Source::manual("start bytes are those of the host line and cannot be changed; the outputs are ours"),
        inputs: &[TEXT],
        outputs: &["routing byte and data of each packet", "text between packets"],
        memory: 1,
        behaviour: depacket,
        examples: &[
            Example::of(
                &[(1, S("A\u{1c}")), (1, S(" $0B;C")), (1, S("D"))],
                &[(2, S("A")), (1, S("0B;C")), (2, S("D"))],
            ),
            Example::of(&[(1, S("\u{1c}\u{1}A"))], &[(2, S("\u{1}A"))]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "PACKET",
        summary: "the string as a count packet",
        source: Source::uncertain("form and inputs are ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "data"),
            PortSpec::default(KindSet::STRING, S("0"), "routing byte"),
        ],
        outputs: &["packet"],
        behaviour: |f| {
            let [route] = *f.string(2)? else { return Err(Problem::Range(2)) };
            let mut packet = Vec::new();
            let written = write_packet_as(PacketForm::Count, Route::from(route), f.string(1)?, &mut packet);
            written.map_err(|_| Problem::TooLong)?;
            f.emit(1, Value::String(packet.into()))
        },
        examples: &[
            Example::of(&[(1, S("A;")), (2, S("1")), (1, S(""))], &[(1, S("\u{1c} #0A;")), (1, S("\u{1c} !1"))]),
            Example::of(&[(2, S("")), (1, S("A"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CIROUTE",
        summary: "the data of a packet to the output that its routing byte says",
        source: Source::manual("output = byte - base + 2; what has no such output goes whole to output 1: ours"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "routing byte and data"),
            PortSpec::default(KindSet::INTEGER, I(FIRST_ROUTE), "code of the routing byte of output 2"),
        ],
        outputs: &["data; output 1: what has no output of its own"],
        family: Family::Outputs,
        behaviour: |f| {
            let base = f.integer(2)?;
            let text = f.string(1)?;
            let output = text.first().map(|route| i64::from(*route) - i64::from(base) + 2);
            match output.and_then(|o| u16::try_from(o).ok()).filter(|o| (2..=f.size()).contains(o)) {
                Some(output) => {
                    let data = Value::string(&text[1..]);
                    f.emit(output, data)
                }
                None => {
                    let whole = f.take(1);
                    f.emit(1, whole)
                }
            }
        },
        examples: &[Example::of(
            &[(1, S("0A;")), (1, S("2B")), (1, S("")), (1, S("/X")), (2, I(65)), (1, S("AY"))],
            &[(2, S("A;")), (1, S("2B")), (1, S("")), (1, S("/X")), (2, S("Y"))],
        )
        .sized(3)],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CI",
        summary: "a command interpreter: carries out commands in strings, however they are cut",
        source: Source::manual("it has structures of its own that are open; its status is ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "text of commands")],
        outputs: &["whether all commands that ended in the message could be read"],
        behaviour: |f| interpret(f, Stream::Commands),
        examples: &[Example::of(&[(1, S("DISPLAY A;")), (1, S("DISP"))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "READSTREAM",
        summary: "an interpreter of the binary command stream",
        source: Source::manual("each string holds whole records: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "binary records")],
        outputs: &["whether all records could be read"],
        behaviour: |f| interpret(f, Stream::Binary),
        examples: &[Example::of(&[(1, S("")), (1, S("A"))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "RASTERSTREAM",
        summary: "an interpreter of the stream of the raster screen",
        source: Source::uncertain("each string holds whole records: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "raster records")],
        outputs: &["whether all records could be read"],
        behaviour: |f| interpret(f, Stream::Raster),
        examples: &[Example::of(&[(1, S("")), (1, S("A"))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "GATHER_GENFCN",
        summary: "code of a user-written function; the emulator cannot run it",
        source: Source::manual("code for the machine's processor is refused: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "object code")],
        behaviour: |_| Err(Problem::Range(1)),
        examples: &[Example::of(&[(1, S("S00600004844521B"))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TEC",
        summary: "characters to the terminal on the screen",
        source: Source::manual(""),
        inputs: &[PortSpec::active(KindSet::STRING, "characters")],
        behaviour: |f| {
            let text = f.string(1)?.into();
            f.effect(Effect::Terminal(text));
            Ok(())
        },
        examples: &[Example::of(&[(1, S("READY")), (1, S("\r"))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "READDISK",
        summary: "the contents of a file of the disk",
        source: Source::manual("a long file comes in several messages; a file that is not there is an error: ours"),
        inputs: &[FILE],
        outputs: &["contents"],
        behaviour: |f| {
            let file = f.string(1)?.trim_ascii().into();
            f.effect(Effect::ReadDisk { function: f.object(), file });
            Ok(())
        },
        examples: &[Example::of(&[(1, S("SITE.DAT")), (1, S("SITE.DAT"))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "WRITEDISK",
        summary: "adds to a file of the disk, which is kept as long as the machine runs",
        source: Source::manual("a new name at <2> begins the file anew: ours"),
        inputs: &[TEXT, PortSpec::constant(KindSet::STRING, "name of the file")],
        behaviour: |f| {
            let file: Box<[u8]> = f.string(2)?.trim_ascii().into();
            if file.is_empty() {
                return Err(Problem::Range(2));
            }
            let function = f.object();
            if f.take_fresh(2) {
                f.effect(Effect::WriteDisk { function, file: file.clone(), text: None });
            }
            let text = Some(f.string(1)?.into());
            f.effect(Effect::WriteDisk { function, file, text });
            Ok(())
        },
        examples: &[Example::of(&[(2, S(" ")), (1, S("A"))], &[]).faults(&[6])],
        ..FunctionRow::PLAIN
    },
];

fn interpret(f: &mut Firing, stream: Stream) -> Result<(), Problem> {
    let bytes = f.string(1)?.into();
    f.effect(Effect::Interpret { function: f.object(), bytes, stream });
    Ok(())
}

fn depacket(f: &mut Firing) -> Result<(), Problem> {
    let mut bytes = match f.memory(PENDING) {
        Some(Value::String(pending)) => pending.to_vec(),
        _ => Vec::new(),
    };
    bytes.extend_from_slice(f.string(1)?);
    let (mut found, mut taken) = (Vec::new(), 0);
    FrameDecoder::default().feed(&bytes, |frame| {
        taken += frame.stream_length();
        match frame {
            Frame::Packet { route, payload, .. } => {
                let mut packet = vec![route.code()];
                packet.extend_from_slice(payload);
                found.push((1, packet));
            }
            Frame::Text(text) => found.push((2, text.to_vec())),
            Frame::Empty(_) | Frame::Noise { .. } => {}
        }
    });
    if bytes.len() - taken > MAX_STRING || found.iter().any(|(_, text)| text.len() > MAX_STRING) {
        f.forget(PENDING);
        return Err(Problem::TooLong);
    }
    f.remember(PENDING, Value::string(&bytes[taken..]));
    found.into_iter().try_for_each(|(output, text)| f.emit(output, Value::String(text.into())))
}
