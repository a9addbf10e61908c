//! What can go wrong between the host and the workstation.

use protocol::address::Address;
use std::path::PathBuf;

/// A failure on the way to, at or from the workstation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorkstationError {
    /// The emulator's program does not start.
    #[error("cannot start the workstation {}: {reason}", program.display())]
    Start {
        /// The program that was to be started.
        program: PathBuf,
        /// What is wrong, in words.
        reason: String,
    },
    /// Nobody listens at the line.
    #[error("cannot attach to the workstation at {line}: {reason}")]
    Attach {
        /// The address of the line.
        line: Address,
        /// What is wrong, in words.
        reason: String,
    },
    /// The line closed.
    #[error("the workstation closed the line{}", if reason.is_empty() { String::new() } else { format!(": {reason}") })]
    Closed {
        /// The reason; empty for a plain end.
        reason: String,
    },
    /// Timed out: no answer in time.
    #[error("the workstation did not answer within {seconds} s; waited for {what} (--patience gives it more time)")]
    Timeout {
        /// What was waited for.
        what: String,
        /// How long.
        seconds: u64,
    },
    /// An answer that cannot be understood.
    #[error("the workstation answered '{answer}'; expected {expected}")]
    Answer {
        /// What came.
        answer: String,
        /// What should have.
        expected: &'static str,
    },
    /// The process of the emulator is gone.
    #[error("the workstation process ended")]
    Ended,
    /// An operator command was refused.
    #[error("the workstation's operator line refused '{command}': {reason}")]
    OperatorCommand {
        /// The command, as it was sent.
        command: String,
        /// What is wrong, in words.
        reason: String,
    },
    /// The scene cannot be shown.
    #[error("cannot show the scene: {0}")]
    Scene(String),
}
