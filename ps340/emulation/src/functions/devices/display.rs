//! Labels, lights, the message line, the terminal emulator, and the switches of the screen.

use super::{
    super::{Family, FunctionExample, FunctionRow, Source, printing::print},
    common::{TEXT, TRIGGER, request},
};
use crate::port::{
    Effect, Firing, KindSet, Label,
    Literal::{B, I, R},
    PortSpec, Problem,
};

const LABEL: &[PortSpec] = &[PortSpec::active(KindSet::STRING.or(KindSet::NUMBER), "text; longer text is cut")];
const LIGHT: &[PortSpec] = &[PortSpec::active(KindSet::INTEGER, "1 to 32, 0 for all")];
const CONFIRMED: Source = Source::confirmed("");

/// The rows of what shows something.
pub static ROWS: &[FunctionRow] = &[
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
        behaviour: |f| request(f, Effect::ClearLabels),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "ONBUTTONLIGHTS",
        summary: "switches lights of the button box on",
        source: Source::manual(""),
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
            request(f, Effect::Message(text))
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
            request(f, Effect::Terminal(text))
        },
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TECOLOR",
        summary: "colour of the terminal emulator's text",
        source: Source::manual("the saturation at <2> is ours"),
        inputs: &[
            PortSpec::active(KindSet::NUMBER, "hue in degrees, 0 blue, 120 red, 240 green"),
            PortSpec::default(KindSet::NUMBER, R(1.0), "saturation, 0 white to 1 pure"),
        ],
        behaviour: color,
        examples: &[
            FunctionExample::of(&[(1, R(120.0)), (2, R(0.5)), (1, I(-120))], &[]),
            FunctionExample::of(&[(2, R(1.5)), (1, R(120.0))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TSCSM",
        summary: "TRUE: the terminal emulator's text is in colour, FALSE: white",
        source: Source::uncertain("the meaning is ours"),
        inputs: &[PortSpec::active(KindSet::BOOLEAN, "whether the text is in colour")],
        behaviour: |f| {
            let on = f.boolean(1)?;
            request(f, Effect::TerminalCsm(on))
        },
        examples: &[FunctionExample::of(&[(1, B(false)), (1, B(true))], &[])],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TURNONDISPLAY",
        summary: "switches the vector display on again after a static picture",
        source: CONFIRMED,
        inputs: TRIGGER,
        behaviour: |f| request(f, Effect::TurnOnDisplay),
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SCREENSAVE",
        summary: "blanks the screen when nobody has done anything for some minutes",
        source: Source::manual("off at the start is ours; so is that devices and hosts wake the screen too"),
        inputs: &[
            PortSpec::active(KindSet::ANY, "somebody is there"),
            PortSpec::default(KindSet::NUMBER, I(0), "minutes until the screen is blanked; 0 or less: never"),
        ],
        behaviour: |f| request(f, Effect::Activity),
        examples: &[FunctionExample::of(&[(2, I(10)), (1, B(true))], &[])],
        ..FunctionRow::PLAIN
    },
];

const OUT_OF_RANGE: FunctionExample = FunctionExample::of(&[(1, I(33)), (1, I(-1)), (1, I(32))], &[]).faults(&[6, 6]);

fn label(f: &mut Firing, label: Label) -> Result<(), Problem> {
    let mut text = print(f.value(1), false);
    text.truncate(label.width());
    request(f, Effect::Label { label, text: text.into() })
}

fn light(f: &mut Firing, on: bool) -> Result<(), Problem> {
    match u8::try_from(f.integer(1)?) {
        Ok(button @ 0..=32) => request(f, Effect::Light { button, on }),
        _ => Err(Problem::Range(1)),
    }
}

fn color(f: &mut Firing) -> Result<(), Problem> {
    let (hue, saturation) = (f.number(1)?, f.number(2)?);
    if !(0.0..=1.0).contains(&saturation) {
        return Err(Problem::Range(2));
    }
    request(f, Effect::TerminalColor { hue: hue.rem_euclid(360.0), saturation })
}
