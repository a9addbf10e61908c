//! Dials, keys, buttons, tablet and keyboard: what a person turns, presses and moves.

use super::{
    super::{Family, FunctionExample, FunctionRow, Rule, Source},
    common::request,
};
use crate::port::{
    DialSetting, Effect, Firing, KindSet,
    Literal::{B, I, R, S},
    PortSpec, Problem, TabletCommand,
};
use protocol::Value;

/// Most samples of a dial in a second: one a frame.
const MAX_SAMPLES: i32 = 60;

/// The rows of the control devices.
pub static ROWS: &[FunctionRow] = &[
    FunctionRow {
        name: "DIALS",
        summary: "turns of the dials since the last sample; 1 is a whole turn clockwise",
        source: Source::confirmed("names and outputs; that 1 is a turn is remembered"),
        outputs: &["dial 1", "dial 2", "dial 3", "dial 4", "dial 5", "dial 6", "dial 7", "dial 8"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "DSET",
        summary: "how a dial is sampled: DSET1 to DSET8",
        source: Source::uncertain(
            "the inputs are; a step is 1/1024 of a turn, every change is sent, 60 samples a second at the start: ours",
        ),
        inputs: &[
            PortSpec::active(KindSet::BOOLEAN.or(KindSet::INTEGER), "FALSE or 0: relative, TRUE or 1: absolute"),
            PortSpec::active(KindSet::INTEGER, "smallest change that is sent, steps of 1/1024 of a turn"),
            PortSpec::active(KindSet::INTEGER, "samples a second, 1 to 60"),
            PortSpec::active(KindSet::ANY, "the position becomes this number of turns, or 0"),
        ],
        family: Family::Device,
        rule: Rule::Any,
        behaviour: set_dial,
        examples: &[
            FunctionExample::of(&[(1, B(true)), (2, I(8)), (3, I(20)), (4, R(0.5))], &[]).sized(3),
            FunctionExample::of(&[(1, I(2)), (2, I(-1)), (3, I(0)), (3, I(61))], &[]).sized(3).faults(&[6, 6, 6, 6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "FKEYS",
        summary: "number of the function key: 1 to 12, 13 to 24 with SHIFT, 25 to 36 with CTRL",
        source: Source::manual(""),
        outputs: &["integer"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "BUTTONSIN",
        summary: "number of the button pressed on the button box, 1 to 32",
        source: Source::manual(""),
        outputs: &["integer"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TABLETIN",
        summary: "position and buttons of the stylus or puck; positions are -1 to 1 in x and y",
        source: Source::confirmed("outputs 2, 3, 5, 6; output 4 is uncertain"),
        outputs: &[
            "position while in range, when it changes",
            "TRUE when a button goes down, FALSE up",
            "sum of the buttons that are down: 1, 2, 4, 8; the tip of the stylus is 1",
            "position while a button is down",
            "whether stylus or puck is in range",
            "position once at a press",
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "TABLETOUT",
        summary: "commands to the tablet, one a character: when output 1 of TABLETIN sends",
        source: Source::uncertain("the commands are ours, after the tablets that were usual then"),
        inputs: &[PortSpec::active(
            KindSet::STRING,
            "@ while in range, A while pressed, B once at a press, D on demand, P now",
        )],
        behaviour: command_tablet,
        examples: &[
            FunctionExample::of(&[(1, S("D")), (1, S("PP@"))], &[]),
            FunctionExample::of(&[(1, S("@?")), (1, S(""))], &[]).faults(&[6]),
        ],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "KEYBOARD",
        summary: "characters typed in interactive mode, one a message",
        source: Source::manual("one character a message is ours"),
        outputs: &["string"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "SPECKEYS",
        summary: "special keys in interactive mode: A up, B down, C right, D left, P to S PF1 to PF4, l to y keypad",
        source: Source::uncertain("the codes are ours: the last byte of what the key sends as a terminal's"),
        outputs: &["string of one character"],
        ..FunctionRow::PLAIN
    },
    FunctionRow {
        name: "KBHANDLER",
        summary: "every character typed, one a message: RETURN is 13, rubout 127",
        source: Source::confirmed(
            "clients connect output 4 to the host; in the terminal's mode it takes the characters from the line: ours",
        ),
        outputs: &["unused", "unused", "unused", "string"],
        ..FunctionRow::PLAIN
    },
];

fn set_dial(f: &mut Firing) -> Result<(), Problem> {
    let mut settings = Vec::new();
    if let Some(mode) = f.optional(1) {
        settings.push(DialSetting::Absolute(match mode {
            Value::Boolean(absolute) => *absolute,
            Value::Integer(mode @ 0..=1) => *mode == 1,
            _ => return Err(Problem::Range(1)),
        }));
    }
    if f.optional(2).is_some() {
        let steps = u32::try_from(f.integer(2)?).map_err(|_| Problem::Range(2))?;
        settings.push(DialSetting::MinimumChange(steps));
    }
    if f.optional(3).is_some() {
        match f.integer(3)? {
            samples @ 1..=MAX_SAMPLES => settings.push(DialSetting::SamplesPerSecond(samples as u8)),
            _ => return Err(Problem::Range(3)),
        }
    }
    if let Some(position) = f.optional(4) {
        settings.push(DialSetting::Reset(position.number().unwrap_or(0.0)));
    }
    let dial = f.size() as u8;
    settings.into_iter().for_each(|setting| f.effect(Effect::Dial { dial, setting }));
    Ok(())
}

fn command_tablet(f: &mut Firing) -> Result<(), Problem> {
    let read = |byte: &u8| match byte {
        b'@' => Ok(TabletCommand::Stream),
        b'A' => Ok(TabletCommand::SwitchStream),
        b'B' => Ok(TabletCommand::Point),
        b'D' => Ok(TabletCommand::Remote),
        b'P' => Ok(TabletCommand::Trigger),
        _ => Err(Problem::Range(1)),
    };
    let commands = f.string(1)?.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    commands.into_iter().try_for_each(|command| request(f, Effect::Tablet(command)))
}
