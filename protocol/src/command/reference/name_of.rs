//! The row of the table that a command belongs to.

use crate::command::syntax::{Command, Object, Operate};

/// The name of the row that describes a command.
pub const fn name_of(command: &Command) -> &'static str {
    match command {
        Command::Define { object, .. } => name_of_object(object),
        Command::EndStructure => "BEGIN_STRUCTURE",
        Command::Display(_) => "DISPLAY",
        Command::Remove(_) => "REMOVE",
        Command::Include { .. } => "INCLUDE",
        Command::RemoveFrom { .. } => "REMOVE FROM",
        Command::Delete(_) => "DELETE",
        Command::Forget(_) | Command::ForgetUnit(_) => "FORGET",
        Command::Connect(_) | Command::ConnectSeveral { .. } => "CONNECT",
        Command::Disconnect { .. } => "DISCONNECT",
        Command::Send { .. } | Command::SendVariable { .. } => "SEND",
        Command::SendVectors { .. } => "SEND VL",
        Command::SendMarks { .. } => "SEND NUMBER*MODE",
        Command::Initialize(_) => "INITIALIZE",
        Command::Begin | Command::End => "BEGIN",
        Command::FontCharacter(_) | Command::EndFont => "BEGIN_FONT",
        Command::Prefix { .. } => "PREFIX",
        Command::Follow { .. } => "FOLLOW",
        Command::RemovePrefix(_) => "REMOVE PREFIX",
        Command::RemoveFollower(_) => "REMOVE FOLLOWER",
        Command::OptimizeStructure | Command::EndOptimize => "OPTIMIZE STRUCTURE",
        Command::OptimizeMemory => "OPTIMIZE MEMORY",
        Command::ReserveWorkingStorage(_) => "RESERVE_WORKING_STORAGE",
        Command::PatternWith { .. } => "PATTERN WITH",
        Command::ErasePattern(_) => "ERASE PATTERN",
        Command::Variable(_) => "VARIABLE",
        Command::SetupCness { .. } => "SETUP CNESS",
        Command::CommandStatus => "COMMAND STATUS",
        Command::Reboot(_) => "REBOOT",
        Command::Configure(_) | Command::FinishConfiguration => "CONFIGURE",
        Command::SetupPassword(_) => "SETUP PASSWORD",
        Command::SetupInterface { .. } => "SETUP INTERFACE",
        Command::ShowInterface(_) => "SHOW INTERFACE",
        Command::ShowInterrupts => "SHOW INTERRUPTS",
        Command::GiveUpCpu => "GIVE_UP_CPU",
        Command::AllowVecnorm => "ALLOW_VECNORM",
        Command::Reset => "!RESET",
    }
}

/// The name of the row of the command that makes an object.
pub const fn name_of_object(object: &Object) -> &'static str {
    match object {
        Object::Nil => "NIL",
        Object::BeginStructure => "BEGIN_STRUCTURE",
        Object::Instance(_) => "INSTANCE OF",
        Object::VectorList(_) => "VECTOR_LIST",
        Object::Characters(_) => "CHARACTERS",
        Object::Operate { operate, .. } => name_of_operate(operate),
        Object::Function { .. } => "F:",
        Object::Alias(_) => "ALIAS",
        Object::Polygons(_) => "POLYGON",
        Object::Attributes(_) => "ATTRIBUTES",
        Object::Illumination(_) => "ILLUMINATION",
        Object::Bspline(_) => "BSPLINE",
        Object::Polynomial(_) => "POLYNOMIAL",
        Object::Labels(_) => "LABELS",
        Object::BeginFont => "BEGIN_FONT",
        Object::Pattern(_) => "PATTERN",
        Object::RawBlock(_) => "RAWBLOCK",
        Object::Copy { .. } => "COPY",
    }
}

/// The name of the row of an operate command.
pub const fn name_of_operate(operate: &Operate) -> &'static str {
    operate.kind().name()
}
