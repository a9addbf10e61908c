//! The initial instances: devices, labels, lights, the screen's text and the host, as functions that exist at start.
//!
//! Sources have outputs only; the machine sends from them what a person does. Sinks ask the machine for an effect.

use super::{Example, Family, FunctionRow, Source, printing::print};
use crate::port::{Effect, Firing, KindSet, Label, Literal::S, PortSpec, Problem};

/// A function that exists at start under a name of its own.
#[derive(Clone, Debug)]
pub struct Initial {
    /// The name of the instance, such as `DLABEL3`.
    pub name: String,
    /// What it is.
    pub function: &'static FunctionRow,
    /// Which of several equal devices: 1..=8 for a dial label; none for a single one.
    pub device: Option<u16>,
}

const TEXT: &[PortSpec] = &[PortSpec::active(KindSet::STRING, "text")];
const TRIGGER: &[PortSpec] = &[PortSpec::active(KindSet::ANY, "trigger")];
const LABEL: &[PortSpec] = &[PortSpec::active(KindSet::STRING.or(KindSet::NUMBER), "text; longer text is cut")];
const LIGHT: &[PortSpec] = &[PortSpec::active(KindSet::INTEGER, "1 to 32, 0 for all")];
const CONFIRMED: Source = Source::confirmed("");
const MANUAL: Source = Source::manual("");

/// Rows of the initial instances.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "DIALS",
        summary: "turns of the dials since the last sample; 1 is a whole turn clockwise",
        source: CONFIRMED,
        outputs: &["dial 1", "dial 2", "dial 3", "dial 4", "dial 5", "dial 6", "dial 7", "dial 8"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FKEYS",
        summary: "number of the function key: 1 to 12, 13 to 24 with SHIFT, 25 to 36 with CTRL",
        source: MANUAL,
        outputs: &["integer"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "BUTTONSIN",
        summary: "number of the button pressed on the button box, 1 to 32",
        source: MANUAL,
        outputs: &["integer"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TABLETIN",
        summary: "position and buttons of the puck; positions are -1 to 1 in x and y",
        source: Source::confirmed("outputs 2, 3, 5, 6; output 4 is uncertain"),
        outputs: &[
            "position while in range",
            "TRUE when a button goes down, FALSE up",
            "sum of the buttons that are down: 1, 2, 4, 8",
            "position while a button is down",
            "whether the puck is in range",
            "position once at a press",
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "KEYBOARD",
        summary: "characters typed in interactive mode, one a message",
        source: MANUAL,
        outputs: &["string"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SPECKEYS",
        summary: "special keys in interactive mode",
        source: Source::uncertain("code of the keys unknown: the machine sends their names"),
        outputs: &["string"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "KBHANDLER",
        summary: "every character typed, one a message: RETURN is 13, rubout 127",
        source: Source::confirmed("clients connect output 4 to the host"),
        outputs: &["unused", "unused", "unused", "string"],
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
    FunctionRow {
        name: "DLABEL",
        summary: "eight characters over a dial",
        source: CONFIRMED,
        inputs: LABEL,
        family: Family::Device,
        behaviour: |f| label(f, Label::Dial(f.size() as u8)),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FLABEL",
        summary: "eight characters over a function key; FLABEL0 is the whole strip of 96",
        source: Source::confirmed("FLABEL0 shows the use of memory"),
        inputs: LABEL,
        family: Family::Device,
        behaviour: |f| label(f, if f.size() == 0 { Label::Strip } else { Label::Key(f.size() as u8) }),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "CLEAR_LABELS",
        summary: "blanks all labels",
        source: CONFIRMED,
        inputs: TRIGGER,
        behaviour: |f| ask(f, Effect::ClearLabels),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ONBUTTONLIGHTS",
        summary: "switches lights of the button box on",
        source: MANUAL,
        inputs: LIGHT,
        behaviour: |f| light(f, true),
        examples: &[OUT_OF_RANGE],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "OFFBUTTONLIGHTS",
        summary: "switches lights of the button box off",
        source: Source::confirmed("clients send 0"),
        inputs: LIGHT,
        behaviour: |f| light(f, false),
        examples: &[OUT_OF_RANGE],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MESSAGE_DISPLAY",
        summary: "one line of text on the screen; a blank clears it",
        source: CONFIRMED,
        inputs: TEXT,
        behaviour: |f| {
            let text = f.string(1)?.into();
            ask(f, Effect::Message(text))
        },
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ES_TE",
        summary: "characters to the terminal emulator",
        source: CONFIRMED,
        inputs: TEXT,
        behaviour: |f| {
            let text = f.string(1)?.into();
            ask(f, Effect::Terminal(text))
        },
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "HOST_MESSAGE",
        summary: "a message to the host, one line",
        source: CONFIRMED,
        inputs: TEXT,
        behaviour: |f| host(f, false),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "HOST_MESSAGEB",
        summary: "a message to the host without an end of line",
        source: MANUAL,
        inputs: TEXT,
        behaviour: |f| host(f, true),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TURNONDISPLAY",
        summary: "switches the vector display on again after a static picture",
        source: CONFIRMED,
        inputs: TRIGGER,
        behaviour: |f| ask(f, Effect::TurnOnDisplay),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "MEMORY_MONITOR",
        summary: "a line about the use of memory",
        source: Source::confirmed(
            "clients send FIX(1) to <3> and connect output 1; a line for each message there is ours",
        ),
        inputs: &[
            PortSpec::optional(KindSet::ANY, "unused"),
            PortSpec::optional(KindSet::ANY, "unused"),
            PortSpec::active(KindSet::ANY, "trigger"),
        ],
        outputs: &["string"],
        behaviour: |f| ask(f, Effect::ReportMemory { function: f.object() }),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ERROR",
        summary: "text of every error, for whatever is connected",
        source: MANUAL,
        inputs: TEXT,
        outputs: &["string"],
        behaviour: pass,
        examples: PASSED,
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "WARNING",
        summary: "text of every warning, for whatever is connected",
        source: MANUAL,
        inputs: TEXT,
        outputs: &["string"],
        behaviour: pass,
        examples: PASSED,
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "INFORMATION",
        summary: "text of every information, for whatever is connected",
        source: MANUAL,
        inputs: TEXT,
        outputs: &["string"],
        behaviour: pass,
        examples: PASSED,
        ..FunctionRow::PLAIN
    },
];

const PASSED: &[Example] = &[Example::of(&[(1, S("E 5 *** text"))], &[(1, S("E 5 *** text"))])];
const OUT_OF_RANGE: Example = Example::of(
    &[(1, crate::port::Literal::I(33)), (1, crate::port::Literal::I(-1)), (1, crate::port::Literal::I(32))],
    &[],
)
.faults(&[6, 6]);

/// The initial instances: each row once, or once a device.
pub fn initial() -> impl Iterator<Item = Initial> {
    ROWS.iter().flat_map(|function| {
        let devices = match (function.family, function.name) {
            (Family::Device, "FLABEL") => 0..=12,
            (Family::Device, "CHANNEL") => 3..=7,
            (Family::Device, _) => 1..=8,
            _ => return vec![Initial { name: function.name.into(), function, device: None }],
        };
        let several = devices.map(|n| Initial { name: format!("{}{n}", function.name), function, device: Some(n) });
        several.collect()
    })
}

fn ask(f: &mut Firing, effect: Effect) -> Result<(), Problem> {
    f.effect(effect);
    Ok(())
}

fn label(f: &mut Firing, label: Label) -> Result<(), Problem> {
    let mut text = print(f.value(1), false);
    text.truncate(label.width());
    ask(f, Effect::Label { label, text: text.into() })
}

fn light(f: &mut Firing, on: bool) -> Result<(), Problem> {
    match u8::try_from(f.integer(1)?) {
        Ok(button @ 0..=32) => ask(f, Effect::Light { button, on }),
        _ => Err(Problem::Range(1)),
    }
}

fn host(f: &mut Firing, binary: bool) -> Result<(), Problem> {
    let bytes = f.string(1)?.into();
    ask(f, Effect::Host { bytes, binary })
}

fn pass(f: &mut Firing) -> Result<(), Problem> {
    let text = f.take(1);
    f.emit(1, text)
}
