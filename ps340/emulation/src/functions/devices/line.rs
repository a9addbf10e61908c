//! The host line: messages and characters to the host.

use super::{
    super::{Family, FunctionRow, Source},
    common::{TEXT, request},
};
use crate::port::{Effect, Firing, Problem};

/// The rows of the host line.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "HOST_MESSAGE",
        summary: "a message to the host, one line",
        source: Source::confirmed(""),
        inputs: TEXT,
        behaviour: |f| host(f, false),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "HOST_MESSAGEB",
        summary: "a message to the host without an end of line",
        source: Source::manual(""),
        inputs: TEXT,
        behaviour: |f| host(f, true),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "HOSTOUT",
        summary: "characters to the host line as they are, in no packet and counted as no message",
        source: Source::manual(""),
        inputs: TEXT,
        behaviour: |f| {
            let bytes = f.string(1)?.into();
            request(f, Effect::HostCharacters { object: f.object(), bytes })
        },
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CHANNEL",
        summary: "data of a packet that the host sent on route 3 to 7, one string a packet",
        source: Source::uncertain("the routes are believed to be channels of the site; the instances are ours"),
        outputs: &["string"],
        family: Family::Device,
        ..FunctionRow::PLAIN
    },
];

fn host(f: &mut Firing, binary: bool) -> Result<(), Problem> {
    let bytes = f.string(1)?.into();
    request(f, Effect::Host { object: f.object(), bytes, binary })
}
