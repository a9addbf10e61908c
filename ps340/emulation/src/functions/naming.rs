//! The rest of the machine by name: variables, inputs of any object, files of the disk.

use super::{FunctionExample, FunctionRow, Source};
use crate::port::{
    Effect, FileName, Firing, KindSet,
    Literal::{B, I, R, S, V2},
    PortSpec, Problem,
};
use protocol::{Name, command::Input};

/// The functions of this family.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "FETCH",
        summary: "the value of a VARIABLE, whenever a trigger arrives",
        source: Source::manual("a variable without a value gives an error and no output"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "trigger"),
            PortSpec::constant(KindSet::STRING, "name of the variable"),
        ],
        outputs: &["its value"],
        behaviour: |f| {
            let name = name(f, 2)?;
            f.effect(Effect::Fetch { function: f.object(), name });
            Ok(())
        },
        examples: &[
            FunctionExample::of(&[(2, S("ANGLE")), (1, B(true))], &[]),
            FunctionExample::of(&[(2, S("1 2")), (1, B(true))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SEND",
        summary: "a message to an input of an object that is known by name, as the command SEND",
        source: Source::manual("codes of the inputs with words as in the library: 0 append, -1 delete and so on"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "message"),
            PortSpec::active(KindSet::STRING, "name of the object"),
            PortSpec::active(KindSet::INTEGER, "number of its input"),
        ],
        behaviour: send,
        examples: &[
            FunctionExample::of(&[(1, R(1.0)), (2, S("ROTATION")), (3, I(1))], &[]),
            FunctionExample::of(&[(1, V2([0.0; 2])), (2, S("TEXT")), (3, I(-4))], &[]),
            FunctionExample::of(&[(1, B(true)), (2, S("A")), (3, I(-7))], &[]).faults(&[6]),
            FunctionExample::of(&[(1, B(true)), (2, S("")), (3, I(1))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "READDISK",
        summary: "the contents of a file of the disk",
        source: Source::manual("a file longer than a message leaves in several: ours"),
        inputs: &[PortSpec::active(KindSet::STRING, "name of the file")],
        outputs: &["contents"],
        behaviour: |f| {
            let name = file(f, 1)?;
            f.effect(Effect::ReadDisk { function: f.object(), name });
            Ok(())
        },
        examples: &[
            FunctionExample::of(&[(1, S("SITE.DAT"))], &[]),
            FunctionExample::of(&[(1, S("../SECRET")), (1, S(""))], &[]).faults(&[6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "WRITEDISK",
        summary: "strings into a file of the disk",
        source: Source::uncertain("the inputs are ours, and that a message replaces the file unless <3> is TRUE"),
        inputs: &[
            PortSpec::active(KindSet::STRING, "contents"),
            PortSpec::constant(KindSet::STRING, "name of the file"),
            PortSpec::default(KindSet::BOOLEAN, B(false), "TRUE: to the end of the file, FALSE: instead of it"),
        ],
        behaviour: |f| {
            let (name, append) = (file(f, 2)?, f.boolean(3)?);
            let bytes = f.string(1)?.into();
            f.effect(Effect::WriteDisk { name, bytes, append });
            Ok(())
        },
        examples: &[
            FunctionExample::of(&[(2, S("SITE.DAT")), (1, S("SEND 1 TO <1>A;"))], &[]),
            FunctionExample::of(&[(2, S("C:\\SITE")), (1, S("X"))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
];

fn name(f: &Firing, input: u16) -> Result<Name, Problem> {
    Name::new(f.string(input)?.trim_ascii()).map_err(|_| Problem::Range(input))
}

fn file(f: &Firing, input: u16) -> Result<FileName, Problem> {
    FileName::new(f.string(input)?).ok_or(Problem::Range(input))
}

fn send(f: &mut Firing) -> Result<(), Problem> {
    let name = name(f, 2)?;
    let input = Input::from_code(f.integer(3)?.into()).ok_or(Problem::Range(3))?;
    let value = f.take(1);
    f.effect(Effect::SendTo { name, input, value });
    Ok(())
}
