//! The operator commands as data, and what a row of their table is.

use super::{Language, OperatorCommandError, Subject, word_reader::WordReader};
use crate::{
    calligraphic::{Knob, Phosphor},
    example::ExampleProgram,
    machine::{Key, KeyboardMode},
};

/// One row of the table of operator commands, from which `help` is made. Rows are the same if their words are.
#[derive(Clone, Copy, Debug)]
pub struct OperatorCommandRow {
    /// The first word.
    pub word: &'static str,
    /// What follows it.
    pub arguments: &'static str,
    /// What it does.
    pub summary: &'static str,
    pub(super) read: fn(&mut WordReader<'_>) -> Result<OperatorCommand, OperatorCommandError>,
}

impl PartialEq for OperatorCommandRow {
    fn eq(&self, other: &OperatorCommandRow) -> bool {
        self.word == other.word
    }
}

/// One of the two screens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The calligraphic display.
    Vector,
    /// The raster display.
    Raster,
}

/// A display command: something that a person sets at the display, or wants of it.
#[derive(Clone, Debug, PartialEq)]
pub enum DisplayCommand {
    /// Turns a knob, or reports how all stand.
    Knob(Option<(&'static Knob, f32)>),
    /// Takes another phosphor, or lists them.
    Phosphor(Option<&'static Phosphor>),
    /// Sets whether a long picture stands still instead of flickering, or reports it.
    Steady(Option<bool>),
    /// Looks at another screen, or reports which is looked at.
    Screen(Option<u8>),
    /// Reports how long the beam needs, and how often it draws the picture.
    Refresh,
    /// The colour of a pixel of the raster screen.
    Pixel {
        /// The column from the left.
        x: u32,
        /// The line from the bottom.
        y: u32,
    },
    /// Writes a picture of a screen, or its strokes.
    Picture {
        /// The screen that is written.
        screen: Screen,
        /// PNG, EXR, SVG or TXT, by extension.
        file: String,
        /// Width and height of the vector screen in pixels.
        size: Option<[u32; 2]>,
    },
}

/// Something that a person wants to know of the machine's inside.
#[derive(Clone, Debug, PartialEq)]
pub enum Inspection {
    /// Takes what was traced.
    Trace,
    /// Traces the messages to and from an object, or all for none; or no longer.
    TraceOf(Option<String>, bool),
    /// Lists the breaks.
    Breaks,
    /// Stops the network before a function fires, or no longer.
    Break(String, bool),
    /// Lets one function fire, and stops the network.
    Step,
    /// Lets the network go on.
    Continue,
    /// Switches the counters of the functions on or off.
    Count(bool),
    /// What a function did.
    Activity(String),
    /// The functions that fired most.
    Top(usize),
    /// The network or the structure as a graph.
    Graph {
        /// What becomes a graph: the network or the structure.
        subject: Subject,
        /// The form of the text.
        language: Language,
        /// Where to; into the reply if none.
        file: Option<String>,
    },
}

/// Something that a person does at the machine, or looks at.
#[derive(Clone, Debug, PartialEq)]
pub enum OperatorCommand {
    /// Turns a dial (1..=8) by a number of turns, clockwise positive.
    Dial {
        /// 1..=8.
        dial: u8,
        /// 1.0 is a full turn.
        turns: f64,
    },
    /// Presses a function key: 1..=12, with SHIFT 13..=24, with CONTROL 25..=36.
    Key(u8),
    /// Presses a key of the keyboard that has a name.
    Press(Key),
    /// Lists the names of the keys.
    Keys,
    /// Gives the keyboard another mode, or reports which it has.
    Mode(Option<KeyboardMode>),
    /// Presses a lighted button, 1..=32.
    Button(u8),
    /// Moves stylus or puck, -1..=1.
    PuckMove([f64; 2]),
    /// Presses puck buttons: 1, 2, 4, 8 or sums; the tip of the stylus is 1.
    PuckPress(u8),
    /// Lets all buttons go.
    PuckRelease,
    /// Takes stylus or puck off the tablet.
    PuckAway,
    /// Types characters on the keyboard.
    Type(Vec<u8>),
    /// Waits for so many frames.
    Frames(u64),
    /// Waits until nothing is left to do, for so many frames at most.
    Idle(u64),
    /// Waits for a message to the host, for so many frames at most.
    Message {
        /// Whether messages that came before the operator command do not count.
        fresh: bool,
        /// For how many frames at most.
        frames: u64,
    },
    /// The messages to the host that nobody took yet.
    Messages,
    /// How replies look on this operator line: with line ends as they are, or as `\n`.
    Lines(bool),
    /// Sets something at the display, or writes a picture of it.
    Display(DisplayCommand),
    /// Describes an object.
    Show(String),
    /// The strokes of the latest update, the first so many.
    Strokes(usize),
    /// The strokes over the picture, the first so many.
    Overlay(usize),
    /// Counters of the machine.
    Counters,
    /// Labels of dials and keys, lights, message line, mode of the keyboard, switches of the screen.
    Panel,
    /// The text on the screen of the terminal emulator.
    Terminal,
    /// Looks into the network or the structure.
    Inspect(Inspection),
    /// The latest numbered messages of the machine.
    Log,
    /// Lists the operator commands, or describes one in full.
    Help(Option<&'static OperatorCommandRow>),
    /// Runs a program that ships with the machine, or lists them.
    Example(Option<&'static ExampleProgram>),
    /// Ends the machine.
    Quit,
}

impl OperatorCommand {
    /// Whether it writes a file or ends the machine, which nobody expects of a file that is played.
    pub fn reaches_out(&self) -> bool {
        match self {
            OperatorCommand::Quit | OperatorCommand::Display(DisplayCommand::Picture { .. }) => true,
            OperatorCommand::Inspect(Inspection::Graph { file, .. }) => file.is_some(),
            _ => false,
        }
    }

    /// Whether somebody does something at the machine, rather than looks at it or waits for it.
    pub fn is_action(&self) -> bool {
        match self {
            OperatorCommand::Dial { .. }
            | OperatorCommand::Key(_)
            | OperatorCommand::Press(_)
            | OperatorCommand::Mode(Some(_))
            | OperatorCommand::Button(_)
            | OperatorCommand::PuckMove(_)
            | OperatorCommand::PuckPress(_)
            | OperatorCommand::PuckRelease
            | OperatorCommand::PuckAway
            | OperatorCommand::Example(Some(_))
            | OperatorCommand::Type(_) => true,
            OperatorCommand::Keys
            | OperatorCommand::Mode(None)
            | OperatorCommand::Frames(_)
            | OperatorCommand::Idle(_)
            | OperatorCommand::Message { .. }
            | OperatorCommand::Messages
            | OperatorCommand::Lines(_)
            | OperatorCommand::Display(_)
            | OperatorCommand::Show(_)
            | OperatorCommand::Strokes(_)
            | OperatorCommand::Overlay(_)
            | OperatorCommand::Counters
            | OperatorCommand::Panel
            | OperatorCommand::Terminal
            | OperatorCommand::Inspect(_)
            | OperatorCommand::Log
            | OperatorCommand::Help(_)
            | OperatorCommand::Example(None)
            | OperatorCommand::Quit => false,
        }
    }
}
