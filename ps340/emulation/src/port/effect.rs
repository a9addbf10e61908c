//! Effects: what the function network requests of the rest of the machine.

use super::{Fault, ObjectId, RenderingRequest};
use glam::DVec2;
use protocol::{Name, Value, command::Input};

/// One thing that the network asks for. The machine carries it out, in order.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// A message for an object that is no function: a display node, or a name without a definition.
    Deliver {
        /// The object.
        object: ObjectId,
        /// The input of the object.
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
        /// The instance that sends it: it determines to which lines.
        object: ObjectId,
        /// Its bytes, without an end of line.
        bytes: Box<[u8]>,
        /// Whether it goes out as it is (HOST_MESSAGEB), or as a line of text (HOST_MESSAGE).
        binary: bool,
    },
    /// Text on a label of the dials or of the function keys.
    Label {
        /// The label that shows the text.
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
    /// A part of the raster screen is filled with a colour.
    WashScreen {
        /// Red, green, blue.
        color: [u8; 3],
        /// Left, bottom, width and height in pixels; none for the whole screen.
        part: Option<[u32; 4]>,
    },
    /// A message came to input `<1>` of a rendering node. It is carried out after those before it, at the next frame.
    RequestRendering {
        /// The node.
        node: ObjectId,
        /// The request.
        request: RenderingRequest,
    },
    /// Characters to the host line, without any frame.
    HostCharacters {
        /// The instance that sends them: it determines to which lines.
        object: ObjectId,
        /// The characters.
        bytes: Box<[u8]>,
    },
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
    /// The accumulated matrix of an XFORM MATRIX node, or the vectors of an XFORM VECTOR node, are requested at the
    /// next update. The answer is a message [`Value::Transform`] or [`Value::Vectors`] from output 1 of the function.
    RequestTransform {
        /// The function that asks.
        function: ObjectId,
        /// The path of the node.
        node: Name,
        /// A name that becomes an object with the data.
        destination: Option<Name>,
        /// Of vectors: the number of the first one, from 1.
        first: u32,
        /// Of vectors: how many.
        count: u32,
    },
    /// A request for a pick: the first thing that an update draws inside the pick box. The answer is a message
    /// [`Value::Pick`] from output 1 of the function, or, if nothing is met in time, FALSE from output 2.
    RequestPick {
        /// The function that asks. A new request of it replaces the one before.
        function: ObjectId,
        /// The position that came with the request, -1..=1.
        at: DVec2,
        /// Whether the point on the vector is requested too.
        coordinates: bool,
        /// Refresh frames to wait for a hit, at least 1.
        frames: u32,
    },
    /// A request for the picture after the next update, from the outputs of the instance WRITEBACK.
    RequestWriteBack {
        /// The WRITEBACK node below which; none for all that is displayed.
        node: Option<ObjectId>,
    },
    /// A request for the value of a VARIABLE, from output 1 of the function.
    Fetch {
        /// The function that asks.
        function: ObjectId,
        /// The variable.
        name: Name,
    },
    /// A message for a named object, as by the command SEND.
    SendTo {
        /// The object.
        name: Name,
        /// The input of the object.
        input: Input,
        /// The message.
        value: Value,
    },
    /// A request for a label of a LABELS node: its text from output 1 of the function, its position from 2, whether it
    /// is shown from 3.
    ExtractLabel {
        /// The function that asks.
        function: ObjectId,
        /// The node.
        name: Name,
        /// Number of the label, from 1.
        index: u32,
    },
    /// A request for a file of the disk, from output 1 of the function; a long one in several messages.
    ReadDisk {
        /// The function that asks.
        function: ObjectId,
        /// The file.
        name: FileName,
    },
    /// Bytes for a file of the disk.
    WriteDisk {
        /// The file; it is made if need be.
        name: FileName,
        /// What is written.
        bytes: Box<[u8]>,
        /// Whether the bytes go to the end of the file; otherwise they replace what is there.
        append: bool,
    },
    /// Bytes for an interpreter of the function's own, which remembers what is unfinished. When they are read, the
    /// number of commands that they completed leaves output 1 of the function.
    Interpret {
        /// The function, to which the interpreter belongs.
        function: ObjectId,
        /// What the bytes are.
        stream: StreamKind,
        /// Some of them; a command may go on in the next.
        bytes: Box<[u8]>,
        /// Whether these are the first since the function was instanced: what was unfinished before is forgotten.
        fresh: bool,
    },
    /// Nobody waits for the next update any more: INITIALIZE.
    ForgetRequests,
    /// The machine starts again: REBOOT.
    Restart,
    /// A request for a line about the use of memory, as a string from output 1 of the function.
    ReportMemory {
        /// The function that asks.
        function: ObjectId,
    },
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

/// What bytes for an interpreter are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StreamKind {
    /// Text of commands.
    Text,
    /// Binary records of commands.
    Binary,
    /// Raster records.
    Raster,
}

/// Longest name of a file of the disk, in bytes. Ours.
pub const MAX_FILE_NAME: usize = 64;

/// The name of a file of the disk: 1 to [`MAX_FILE_NAME`] letters, digits, `_`, `$`, `-` and `.`, the first no `.`;
/// always upper case. So it is a plain name in a folder of any computer too.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileName(Box<str>);

impl FileName {
    /// Reads a name, blanks around it left out; none if it is no name of a file.
    pub fn new(text: &[u8]) -> Option<FileName> {
        let text = text.trim_ascii();
        let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"_$-.".contains(byte);
        let is_name = (1..=MAX_FILE_NAME).contains(&text.len()) && text[0] != b'.' && text.iter().all(plain);
        is_name.then(|| FileName(text.iter().map(|byte| char::from(byte.to_ascii_uppercase())).collect()))
    }

    /// The characters, in upper case.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A label: a field for text on the control devices.
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
    /// Width of the label in characters; longer text is cut.
    pub const fn width(self) -> usize {
        match self {
            Label::Dial(_) | Label::Key(_) => 8,
            Label::Strip => 96,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(FileName::new(b" config.dat ").unwrap().as_str(), "CONFIG.DAT");
        for bad in ["", "..", ".HIDDEN", "A/B", "A\\B", "A B", "\u{e4}", &"A".repeat(65)] {
            assert_eq!(FileName::new(bad.as_bytes()), None, "{bad}");
        }
    }
}
