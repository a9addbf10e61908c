//! The numbered messages of the machine.

use crate::{
    disk::DiskFault,
    functions::{self, Family},
    memory::{MassMemory, Refusal},
    port::{Cause, Fault, ObjectId},
    rendering::RenderingFault,
    structure::{Node, NodeFault},
    traversal::UpdateFault,
};
use protocol::{Name, command::CommandError, record::BinaryError};

/// The one of the three instances ERROR, WARNING and INFORMATION that passes a message on.
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
    /// W 1: a command of which something was left out.
    LeftOut(CommandError),
    /// E 1: a binary command that cannot be read.
    Binary(BinaryError),
    /// W 3: a name got a new definition.
    Redefined(Name),
    /// E 4: structure commands out of place.
    Structure(String),
    /// E 5 and on: a message that a function cannot take, or a result that it cannot give.
    Function {
        /// The function.
        name: String,
        /// What is wrong.
        fault: Fault,
    },
    /// E 5 and on, W 9: a message that a node does not take.
    Node {
        /// The node.
        name: String,
        /// What is wrong.
        fault: NodeFault,
        /// What it takes, in words that follow the fault; may be empty.
        hint: String,
    },
    /// E 6: numbers of a definition that go together to nothing, or are out of range.
    Range {
        /// Of what: a name, or `a SET RATE inside ROBOT`.
        of: String,
        /// What is wrong.
        text: String,
    },
    /// W 6: numbers of a definition that are taken, and are probably not meant.
    Doubtful {
        /// Of what: a name, or `a SET COLOR inside ROBOT`.
        of: String,
        /// What becomes of them.
        text: String,
    },
    /// W 9: an arc with an end that the node there does not have; it is kept for another definition of the name.
    NoPort(String),
    /// E 2, E 4, E 6, E 8, E 9: an operation on the mass memory that was refused.
    Refused(Refusal),
    /// I 11: an answer to COMMAND STATUS, SHOW INTERFACE and the like.
    Information(String),
    /// E 8: an update could not show everything.
    Update(UpdateFault),
    /// W 12: bytes on a line that were not a packet.
    Line(String),
    /// I 13: a packet on the diagnostic route.
    Diagnostic(String),
    /// E 8, E 10: a rendering that was not made.
    Rendering {
        /// Of which node.
        name: String,
        /// The reason.
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
            Message::LeftOut(_)
            | Message::Redefined(_)
            | Message::Doubtful { .. }
            | Message::NoPort(_)
            | Message::Line(_) => Class::Warning,
            Message::Function { fault, .. } if fault.class() == 'W' => Class::Warning,
            Message::Node { fault, .. } if fault.is_warning() => Class::Warning,
            Message::Raster(fault) if fault.is_warning() => Class::Warning,
            Message::Diagnostic(_) | Message::Information(_) => Class::Information,
            _ => Class::Error,
        }
    }

    /// A message that a node did not take.
    pub fn of_node(node: ObjectId, fault: NodeFault, memory: &MassMemory) -> Message {
        let name = memory.title(node);
        let hint = memory.structures.node(node).and_then(|node| match fault {
            NodeFault::Kind { input, .. } => node.takes(input).map(|takes| format!("it takes {takes}")),
            NodeFault::NoSuchInput { input } if node.takes(input).is_none() => Some(inputs_of(node, &name)),
            _ => None,
        });
        Message::Node { name, fault, hint: hint.map_or(String::new(), |hint| format!("; {hint}")) }
    }

    /// The name that was used and has no definition, of a function with `F:` before it.
    pub fn unknown(&self) -> Option<String> {
        match self {
            Message::Refused(Refusal::NotFound(name)) => Some(name.to_string()),
            Message::Refused(Refusal::NoFunction(name)) => Some(format!("F:{name}")),
            Message::Node { name, fault: NodeFault::Undefined { .. }, .. } => Some(name.clone()),
            _ => None,
        }
    }

    /// The number of the message.
    pub fn number(&self) -> u16 {
        match self {
            Message::Syntax(_) | Message::LeftOut(_) | Message::Binary(_) => 1,
            Message::Redefined(_) => 3,
            Message::Structure(_) => 4,
            Message::Function { fault, .. } => fault.number(),
            Message::Node { fault, .. } => fault.number(),
            Message::Range { .. } | Message::Doubtful { .. } => 6,
            Message::NoPort(_) => 9,
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
            return write!(f, "{}{}", fault.text(name), expected(fault));
        }
        let letter = match self.class() {
            Class::Error => 'E',
            Class::Warning => 'W',
            Class::Information => 'I',
        };
        write!(f, "{letter} {} *** ", self.number())?;
        match self {
            Message::Syntax(error) | Message::LeftOut(error) => write!(f, "{error}"),
            Message::Binary(error) => write!(f, "{error}"),
            Message::Range { of, text } | Message::Doubtful { of, text } => {
                write!(f, "Value out of range in {of}: {text}")
            }
            Message::Information(text) => f.write_str(text),
            Message::Redefined(name) => write!(f, "{name} redefined"),
            Message::Structure(text) | Message::NoPort(text) => f.write_str(text),
            Message::Function { .. } => Ok(()),
            Message::Node { name, fault, hint } => write!(f, "{}{hint}", fault.text(name)),
            Message::Refused(refusal) => write!(f, "{refusal}"),
            Message::Update(fault) => write!(f, "Picture incomplete: {fault}"),
            Message::Line(text) => f.write_str(text),
            Message::Diagnostic(text) => write!(f, "Host says: {text}"),
            Message::Rendering { name, fault } => f.write_str(&fault.text(name)),
            Message::Raster(fault) => write!(f, "{fault}"),
            Message::Disk(fault) => write!(f, "{fault}"),
        }
    }
}

/// The inputs that a node has, for somebody who named another.
pub(super) fn inputs_of(node: &Node, name: &str) -> String {
    match node {
        Node::Group(_) => format!("a structure has no inputs, nodes that are named inside it do, such as {name}.NODE"),
        node => {
            let word = node.word();
            let article = if word.starts_with(['A', 'E', 'I', 'O', 'U']) { "an" } else { "a" };
            format!("{article} {word} has {}", node.inputs())
        }
    }
}

/// What a function expects at the input where the fault is, as its row says; empty where that is no help.
fn expected(fault: &Fault) -> String {
    let Some(row) = functions::find(fault.function) else { return String::new() };
    let spec = |input: u16| match row.family {
        Family::Inputs | Family::Channels => row.inputs.first().filter(|_| row.inputs.len() == 1),
        _ => row.inputs.get(usize::from(input).wrapping_sub(1)),
    };
    match fault.cause {
        Cause::Kind { input, kind } => spec(input).map_or(String::new(), |spec| match spec.kinds.contains(kind) {
            true => ", which does not go with the other inputs".into(),
            false => format!("; it takes {}", spec.kinds),
        }),
        Cause::Range { input } => spec(input).map_or(String::new(), |spec| format!(" ({})", spec.summary)),
        Cause::NoSuchInput(_) if row.family == Family::Single => match row.inputs.len() {
            0 => "; it has no inputs".into(),
            1 => "; its only input is <1>".into(),
            n => format!("; its inputs are <1> to <{n}>"),
        },
        Cause::NoSuchOutput(_) if row.family == Family::Single => match row.outputs.len() {
            0 => "; it has no outputs".into(),
            1 => "; its only output is <1>".into(),
            n => format!("; its outputs are <1> to <{n}>"),
        },
        _ => String::new(),
    }
}

impl From<Refusal> for Message {
    fn from(refusal: Refusal) -> Message {
        Message::Refused(refusal)
    }
}
