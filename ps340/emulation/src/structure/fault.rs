//! The reason why a node does not take a message, or cannot be edited.

use protocol::{Kind, command::Input};

/// A message that a node did not take; the node is as before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NodeFault {
    /// The input takes other kinds.
    #[error("Bad message type at {input}")]
    Kind {
        /// The input.
        input: Input,
        /// What came.
        kind: Kind,
    },
    /// Vectors came to a node that is no vector list.
    #[error("Bad message type at {input}: vectors")]
    Vectors {
        /// The input.
        input: Input,
    },
    /// Lines or positions in a list of dots.
    #[error("Bad message type at {input}: dots are neither lines nor positions")]
    Dots {
        /// The input.
        input: Input,
    },
    /// The message is for a name without a definition.
    #[error("Name not found at {input}")]
    Undefined {
        /// The input.
        input: Input,
    },
    /// The node has no such input.
    #[error("No such input {input}")]
    NoSuchInput {
        /// The input.
        input: Input,
    },
    /// The mass memory is full.
    #[error("Insufficient memory at {input}")]
    Full {
        /// The input.
        input: Input,
    },
    /// An index past the end, a number that is not finite or too large, a string that is too long.
    #[error("Value out of range at {input}")]
    Range {
        /// The input.
        input: Input,
    },
}

impl NodeFault {
    /// The number of the message: those of the same faults of functions.
    pub fn number(&self) -> u16 {
        match self {
            NodeFault::Undefined { .. } => 2,
            NodeFault::Kind { .. } | NodeFault::Vectors { .. } | NodeFault::Dots { .. } => 5,
            NodeFault::Range { .. } => 6,
            NodeFault::Full { .. } => 8,
            NodeFault::NoSuchInput { .. } => 9,
        }
    }

    /// Whether the message is a warning, as that about the same fault of functions is.
    pub const fn is_warning(&self) -> bool {
        matches!(self, NodeFault::NoSuchInput { .. })
    }

    /// The text after the number.
    ///
    /// - `name`: the name of the node.
    pub fn text(&self, name: &str) -> String {
        match self {
            NodeFault::Kind { input, kind } => format!("Bad message type at {input}{name}: {kind}"),
            NodeFault::Vectors { input } => format!("Bad message type at {input}{name}: vectors"),
            NodeFault::Dots { input } => {
                format!("Bad message type at {input}{name}: dots are neither lines nor positions")
            }
            NodeFault::Undefined { input } => format!("Name not found: {name}, for a message at {input}"),
            NodeFault::NoSuchInput { input } => format!("No such input {input} of {name}"),
            NodeFault::Full { input } => format!("Insufficient memory at {input}{name}"),
            NodeFault::Range { input } => format!("Value out of range at {input}{name}"),
        }
    }
}
