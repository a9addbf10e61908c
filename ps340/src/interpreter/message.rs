//! The numbered messages of the machine.

use crate::{
    disk::DiskFault, memory::Refusal, port::Fault, rendering::RenderingFault, structure::NodeFault, traversal::Trouble,
};
use protocol::{Name, command::CommandError, record::BinaryError};

/// Which of the three instances ERROR, WARNING and INFORMATION passes a message on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Something was not done.
    Error,
    /// Something was done that may not be meant.
    Warning,
    /// Nothing is wrong.
    Information,
}

/// A message of the machine: `E 1 *** Syntax error near 'FOO'`.
///
/// # Source
/// The form is remembered from the manuals; numbers and texts are ours, since those of the machine are not known.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// E 1: a command that cannot be read.
    Syntax(CommandError),
    /// E 1: a binary command that cannot be read.
    Binary(BinaryError),
    /// W 3: a name got a new definition.
    Redefined(Name),
    /// E 4: structure commands in the wrong place.
    Structure(String),
    /// E 5 and on: a message that a function cannot take, or a result that it cannot give.
    Function {
        /// Which function.
        name: String,
        /// What is wrong.
        fault: Fault,
    },
    /// E 5 and on, W 9: a message that a node does not take.
    Node {
        /// Which node.
        name: String,
        /// What is wrong.
        fault: NodeFault,
    },
    /// E 6: numbers of a definition that go together to nothing, or are out of range.
    Range {
        /// Of which name, if it has one.
        name: Option<Name>,
        /// What is wrong.
        text: String,
    },
    /// E 2, E 4, E 6, E 8, E 9: an operation on the mass memory that was refused.
    Refused(Refusal),
    /// I 11: an answer to COMMAND STATUS, SHOW INTERFACE and the like.
    Information(String),
    /// E 8: an update could not show everything.
    Update(Trouble),
    /// W 12: bytes on a line that were not a packet.
    Line(String),
    /// I 13: a packet on the diagnostic route.
    Diagnostic(String),
    /// E 8, E 10: a rendering that was not made.
    Rendering {
        /// Of which node.
        name: String,
        /// Why not.
        fault: RenderingFault,
    },
    /// W 30 to 33, E 550 to 558: a raster operation.
    Raster(crate::raster::RasterFault),
    /// E 2, E 8: a file of the disk.
    Disk(DiskFault),
}

impl Message {
    /// Error, warning or information.
    pub fn class(&self) -> Class {
        match self {
            Message::Redefined(_) | Message::Line(_) => Class::Warning,
            Message::Function { fault, .. } if fault.class() == 'W' => Class::Warning,
            Message::Node { fault, .. } if fault.is_warning() => Class::Warning,
            Message::Raster(fault) if fault.is_warning() => Class::Warning,
            Message::Diagnostic(_) | Message::Information(_) => Class::Information,
            _ => Class::Error,
        }
    }

    /// The number of the message.
    pub fn number(&self) -> u16 {
        match self {
            Message::Syntax(_) | Message::Binary(_) => 1,
            Message::Redefined(_) => 3,
            Message::Structure(_) => 4,
            Message::Function { fault, .. } => fault.number(),
            Message::Node { fault, .. } => fault.number(),
            Message::Range { .. } => 6,
            Message::Refused(refusal) => refusal.number(),
            Message::Update(_) => 8,
            Message::Information(_) => 11,
            Message::Line(_) => 12,
            Message::Diagnostic(_) => 13,
            Message::Rendering { fault, .. } => fault.number(),
            Message::Raster(fault) => fault.number(),
            Message::Disk(fault) => fault.number(),
        }
    }
}

impl std::fmt::Display for Message {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Message::Function { name, fault } = self {
            return f.write_str(&fault.text(name));
        }
        let letter = match self.class() {
            Class::Error => 'E',
            Class::Warning => 'W',
            Class::Information => 'I',
        };
        write!(f, "{letter} {} *** ", self.number())?;
        match self {
            Message::Syntax(error) => write!(f, "{error}"),
            Message::Binary(error) => write!(f, "{error}"),
            Message::Range { name: Some(name), text } => write!(f, "Value out of range in {name}: {text}"),
            Message::Range { name: None, text } => write!(f, "Value out of range: {text}"),
            Message::Information(text) => f.write_str(text),
            Message::Redefined(name) => write!(f, "{name} redefined"),
            Message::Structure(text) => f.write_str(text),
            Message::Function { .. } => Ok(()),
            Message::Node { name, fault } => f.write_str(&fault.text(name)),
            Message::Refused(refusal) => write!(f, "{refusal}"),
            Message::Update(trouble) => write!(f, "Picture incomplete: {trouble}"),
            Message::Line(text) => f.write_str(text),
            Message::Diagnostic(text) => write!(f, "Host says: {text}"),
            Message::Rendering { name, fault } => f.write_str(&fault.text(name)),
            Message::Raster(fault) => write!(f, "{fault}"),
            Message::Disk(fault) => write!(f, "{fault}"),
        }
    }
}

impl From<Refusal> for Message {
    fn from(refusal: Refusal) -> Message {
        Message::Refused(refusal)
    }
}
