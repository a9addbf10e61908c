//! How the program ends.

use crate::database::DatabaseError;
use crate::mesh::MeshError;
use crate::picture::PictureError;
use crate::production::ProductionError;
use crate::render::{RenderError, StateError};
use crate::scene::SceneError;
use crate::script::ScriptError;
use crate::study::{PlotError, StudyError};
use crate::workstation::WorkstationError;
use std::process::ExitCode;

/// Exit codes of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// All went well.
    Done = 0,
    /// The work failed.
    Failed = 1,
    /// The command line is wrong.
    Usage = 2,
    /// The script or the scene is wrong.
    Scene = 3,
    /// The line to the workstation, or the other process, failed.
    Line = 4,
    /// There is a picture, but the error that was asked for is not reached everywhere; or time ran out before there was
    /// one.
    Missed = 5,
    /// Interrupted; what was finished is kept.
    Interrupted = 130,
}

impl Exit {
    /// Every exit code.
    pub const ALL: [Exit; 7] =
        [Exit::Done, Exit::Failed, Exit::Usage, Exit::Scene, Exit::Line, Exit::Missed, Exit::Interrupted];

    /// What it means.
    pub fn meaning(self) -> &'static str {
        match self {
            Exit::Done => "all went well",
            Exit::Failed => "the work failed",
            Exit::Usage => "the command line is wrong",
            Exit::Scene => "the script or the scene is wrong",
            Exit::Line => "the line to the workstation, or the other process, failed",
            Exit::Missed => "the error or the time that was asked for was not enough for every pixel",
            Exit::Interrupted => "interrupted; what was finished is kept",
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// An error with its causes, without those that it tells itself.
pub(super) fn story(error: &anyhow::Error) -> String {
    error.chain().skip(1).fold(error.to_string(), |text, cause| {
        let cause = cause.to_string();
        if text.contains(&cause) { text } else { format!("{text}: {cause}") }
    })
}

/// The exit codes, for the end of each help text.
pub(super) fn table() -> String {
    let line = |e: &Exit| format!("\n  {:<3}  {}", *e as u8, e.meaning());
    format!("Exit codes:{}", Exit::ALL.iter().map(line).collect::<String>())
}

/// The reason for which a command ends early, and its exit code.
#[derive(Debug)]
pub struct CommandFailure {
    /// The code.
    pub exit: Exit,
    /// What happened.
    pub error: anyhow::Error,
}

impl CommandFailure {
    /// A failure with this code.
    pub fn new(exit: Exit, error: impl Into<anyhow::Error>) -> CommandFailure {
        CommandFailure { exit, error: error.into() }
    }
}

macro_rules! failures {
    ($($error:ty => $exit:ident),* $(,)?) => {
        $(impl From<$error> for CommandFailure {
            fn from(error: $error) -> CommandFailure {
                CommandFailure::new(Exit::$exit, error)
            }
        })*
    };
}

failures! {
    anyhow::Error => Failed,
    clap::Error => Usage,
    std::io::Error => Failed,
    files::WriteError => Failed,
    serde_json::Error => Failed,
    crate::octree::OctreeError => Failed,
    crate::octree::FileError => Failed,
    PlotError => Failed,
    RenderError => Failed,
    SceneError => Scene,
    ScriptError => Scene,
    WorkstationError => Line,
}

impl From<MeshError> for CommandFailure {
    fn from(error: MeshError) -> CommandFailure {
        let exit = if let MeshError::Format { .. } = error { Exit::Usage } else { Exit::Failed };
        CommandFailure::new(exit, error)
    }
}

impl From<PictureError> for CommandFailure {
    fn from(error: PictureError) -> CommandFailure {
        let exit = if let PictureError::Format { .. } = error { Exit::Usage } else { Exit::Failed };
        CommandFailure::new(exit, error)
    }
}

impl From<StateError> for CommandFailure {
    fn from(error: StateError) -> CommandFailure {
        let exit = if let StateError::Other { .. } = error { Exit::Usage } else { Exit::Failed };
        CommandFailure::new(exit, error)
    }
}

impl From<DatabaseError> for CommandFailure {
    fn from(error: DatabaseError) -> CommandFailure {
        let exit = match error {
            DatabaseError::Unknown { .. } | DatabaseError::Exists { .. } | DatabaseError::Name(_) => Exit::Usage,
            _ => Exit::Failed,
        };
        CommandFailure::new(exit, error)
    }
}

impl From<ProductionError> for CommandFailure {
    fn from(error: ProductionError) -> CommandFailure {
        match error {
            ProductionError::Scene(e) => e.into(),
            ProductionError::Workstation(e) => e.into(),
            ProductionError::Render(e) => e.into(),
            ProductionError::Thread(_) => CommandFailure::new(Exit::Failed, error),
        }
    }
}

impl From<StudyError> for CommandFailure {
    fn from(error: StudyError) -> CommandFailure {
        let exit = match error {
            StudyError::Interrupted => Exit::Interrupted,
            StudyError::Distribution(_) => Exit::Usage,
            StudyError::Scene(_) | StudyError::Nothing(_) => Exit::Scene,
            _ => Exit::Failed,
        };
        CommandFailure::new(exit, error)
    }
}
