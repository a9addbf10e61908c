//! The option that says how long the workstation may take.

use crate::workstation::Timeouts;
use clap::Args;

/// How long the workstation may take.
#[derive(Args, Clone, Debug)]
pub(super) struct TimeoutArguments {
    /// Seconds that the workstation may take to open its line, to answer, and to carry out an operator command
    /// [default: 30, 30 and 120]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=86_400))]
    patience: Option<u32>,
}

impl TimeoutArguments {
    /// What the option says, or the default.
    pub(super) fn timeouts(&self) -> Timeouts {
        self.patience.map_or_else(Timeouts::default, Timeouts::of)
    }
}
