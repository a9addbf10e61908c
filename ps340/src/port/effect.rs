//! What the function network wants of the rest of the machine.

use super::{Fault, ObjectId};
use glam::DVec2;
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
    /// The raster screen is filled with a colour.
    WashScreen {
        /// Red, green, blue.
        color: [u8; 3],
    },
    /// Characters to the host line, without any frame.
    HostCharacters(Box<[u8]>),
    /// How a dial is sampled from now on.
    Dial {
        /// 1..=8.
        dial: u8,
        /// What changes.
        setting: DialSetting,
    },
    /// A command to the tablet.
    Tablet(TabletCommand),
    /// The colour of the terminal's text.
    TerminalColor {
        /// Degrees, 0 is blue.
        hue: f64,
        /// 0 white, 1 pure.
        saturation: f64,
    },
    /// Whether the terminal's text is in colour.
    TerminalCsm(bool),
    /// Somebody is there: the screen is not blanked.
    Activity,
    /// The accumulated matrix or the vectors of an XFORM node are wanted at the next update. The answer is a message
    /// [`Value::Transform`] or [`Value::Vectors`] from output 1 of the function.
    RequestTransform {
        /// The function that asks.
        function: ObjectId,
        /// The path of the node.
        node: Name,
        /// What gets the data as its definition, besides the message.
        destination: Option<Name>,
        /// The first vector that is wanted, from 1, and how many.
        vectors: [Option<i32>; 2],
    },
    /// What is drawn in the pick box is wanted. The answer is a message [`Value::Pick`] from output 1 of the function,
    /// or FALSE from output 2.
    RequestPick {
        /// The function that asks.
        function: ObjectId,
        /// The centre of the box; that of PICK_LOCATION if none.
        at: Option<DVec2>,
        /// Whether the place on the vector is wanted too.
        coordinates: bool,
        /// How many updates are tried, at least 1.
        frames: u32,
    },
    /// The picture is wanted after the next update, from the outputs of the instance WRITEBACK.
    RequestWriteBack {
        /// The WRITEBACK node below which; none for all that is displayed.
        node: Option<ObjectId>,
    },
    /// The value of a VARIABLE is wanted, as a message from output 1 of the function.
    Fetch {
        /// The function that asks.
        function: ObjectId,
        /// The variable.
        name: Name,
    },
    /// A label of a LABELS node is wanted: text, position and whether it is shown, from outputs 1 to 3.
    ExtractLabel {
        /// The function that asks.
        function: ObjectId,
        /// The node.
        name: Name,
        /// Which label, from 1.
        index: i32,
    },
    /// A message for an object by its name.
    SendTo {
        /// The object.
        name: Name,
        /// Which input of it.
        input: Input,
        /// The message.
        value: Value,
    },
    /// A file of the disk is wanted, as messages from output 1 of the function.
    ReadDisk {
        /// The function that asks.
        function: ObjectId,
        /// The name of the file.
        file: Box<[u8]>,
    },
    /// A file of the disk is written.
    WriteDisk {
        /// The function that writes.
        function: ObjectId,
        /// The name of the file.
        file: Box<[u8]>,
        /// What is added at its end; none makes the file empty.
        text: Option<Box<[u8]>>,
    },
    /// Bytes for a command interpreter that belongs to the function.
    Interpret {
        /// The function.
        function: ObjectId,
        /// The bytes.
        bytes: Box<[u8]>,
        /// What they are.
        stream: Stream,
    },
    /// The machine starts again: REBOOT.
    Restart,
    /// A line about the use of memory is wanted, as a string from output 1 of the function.
    ReportMemory {
        /// The function that asks.
        function: ObjectId,
    },
}

/// What a function gives to an interpreter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stream {
    /// Commands as text.
    Commands,
    /// Binary records of commands.
    Binary,
    /// Records of the raster screen.
    Raster,
}

/// One setting of a dial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DialSetting {
    /// Whether it sends its position, not its change.
    Absolute(bool),
    /// Steps that it must turn before it sends.
    MinimumChange(u32),
    /// Samples a second, 1..=60.
    SamplesPerSecond(u8),
    /// Its position is this number of turns.
    Reset(f64),
}

/// A command to the tablet: when it sends the position from output 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TabletCommand {
    /// While the stylus or puck is in range.
    #[default]
    Stream,
    /// While a switch is down.
    SwitchStream,
    /// Once at a press.
    Point,
    /// On demand only.
    Remote,
    /// Now, once.
    Trigger,
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
