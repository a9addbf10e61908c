//! What the process is to do, and why it ended.

use crate::{
    calligraphic::Drawer,
    line::{Address, LineAddress},
    machine::Settings,
};
use std::path::PathBuf;

/// Where the time of the machine comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum TimeSource {
    /// Sixty frames in each second of the wall clock.
    Real,
    /// Frames pass only while an operator waits for them, as fast as they can.
    Virtual,
}

/// Who gives operator commands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Nobody.
    None,
    /// Standard input; the machine ends with it.
    Stdio,
    /// Whoever connects.
    Socket(Address),
}

/// What the process is to do.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where hosts attach.
    pub listen: Vec<LineAddress>,
    /// A file that takes what passes on the host lines.
    pub capture: Option<PathBuf>,
    /// Who gives operator commands.
    pub operator: Operator,
    /// Where time comes from.
    pub clock: TimeSource,
    /// Whether captures that are played may give operator commands that write files or end the machine.
    pub replays_operator: bool,
    /// The folder below which operator commands write files.
    pub files: PathBuf,
    /// Whether it may listen where other computers reach it.
    pub public: bool,
    /// Of the machine.
    pub settings: Settings,
    /// Who writes the light of the vector screen.
    pub drawer: Drawer,
}

/// The reason why the process ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExitReason {
    /// By the operator command `quit`, with the operator on standard input, or with the last host that could come.
    Quit,
    /// By a signal.
    Interrupted,
}
