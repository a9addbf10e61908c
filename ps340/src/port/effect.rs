//! What the function network wants of the rest of the machine.

use super::{Fault, ObjectId};
use protocol::{Name, Value, command::Input};

/// One thing that the network asks for. The machine carries it out, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// A message for an object that is no function: a display node, or a name without a definition.
    Deliver {
        /// The object.
        object: ObjectId,
        /// Which input of it.
        input: Input,
        /// The message.
        value: Value,
    },
    /// A fault of a function, for the instances ERROR and WARNING.
    Fault {
        /// The function.
        object: ObjectId,
        /// What went wrong.
        fault: Fault,
    },
    /// A message to the host.
    Host {
        /// Its bytes, without an end of line.
        bytes: Box<[u8]>,
        /// Whether it goes out as it is (HOST_MESSAGEB), or as a line of text (HOST_MESSAGE).
        binary: bool,
    },
    /// Text on a label of the dials or of the function keys.
    Label {
        /// Which one.
        label: Label,
        /// At most [`Label::width`] bytes.
        text: Box<[u8]>,
    },
    /// All labels go blank.
    ClearLabels,
    /// A light of the button box.
    Light {
        /// 1..=32, or 0 for all.
        button: u8,
        /// On or off.
        on: bool,
    },
    /// The line of text on the screen; a blank clears it.
    Message(Box<[u8]>),
    /// Characters for the terminal emulator.
    Terminal(Box<[u8]>),
    /// The vector display goes on again after a static picture.
    TurnOnDisplay,
    /// The accumulated matrix of an XFORM node is wanted at the next update. The answer is a message
    /// [`Value::Transform`] from output 1 of the function.
    RequestTransform {
        /// The function that asks.
        function: ObjectId,
        /// The path of the node.
        node: Name,
    },
    /// The machine starts again: REBOOT.
    Restart,
    /// A line about the use of memory is wanted, as a string from output 1 of the function.
    ReportMemory {
        /// The function that asks.
        function: ObjectId,
    },
}

/// A place for text on the control devices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Label {
    /// Over dial 1..=8.
    Dial(u8),
    /// Over function key 1..=12.
    Key(u8),
    /// The whole strip over the function keys.
    Strip,
}

impl Label {
    /// Width of the place in characters; longer text is cut.
    pub const fn width(self) -> usize {
        match self {
            Label::Dial(_) | Label::Key(_) => 8,
            Label::Strip => 96,
        }
    }
}
