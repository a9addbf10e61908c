//! The function networks that PERIS sets up on the workstation: dials, keys and the way back of the view.

use super::instancing::CHOSEN_LEVEL;
use super::names::{DETAIL, ROOT, name};
use glam::DVec3;
use protocol::{
    Value,
    command::{Arc, Command, Destination, Input, Object},
};

/// Degrees that one turn of a dial rotates: what clients of the time used.
pub const DEGREES_PER_TURN: f64 = 200.0;
/// How many times dial 4 is squared: the scale is `(1 + x / 2^n)^(2^n)`, nearly the exponential of its turns x.
pub const SCALE_SQUARINGS: u32 = 4;
/// Least and greatest turns of dial 4 that count: scales of 0.01 and 657.
pub const SCALE_LIMITS: [f64; 2] = [-4.0, 8.0];

/// What a message to the host begins with when a function key was pressed; the number follows.
pub const KEY_PREFIX: &str = "KEY ";
/// A question to a network on the workstation.
pub(super) struct Question {
    /// What is asked for, in words.
    pub(super) what: &'static str,
    /// The function that answers when it gets TRUE at `<1>`.
    trigger: &'static str,
    /// The function that gives the answer as text.
    text: &'static str,
    /// What the first message of the answer begins with.
    pub(super) prefix: &'static str,
    /// Messages of the answer.
    pub(super) messages: usize,
}

/// The function that gives the matrix of the view when it gets TRUE at `<1>`.
const VIEW_TRIGGER: &str = "PERIS_VIEW";
/// The function that gives the matrix as text.
const VIEW_TEXT: &str = "PERIS_PRINT";

/// Asks for the matrix of the view: its kind, and its rows.
pub(super) const VIEW: Question =
    Question { messages: 5, ..Question::new("the matrix of the view", VIEW_TRIGGER, VIEW_TEXT, "MATRIX_4X4") };

/// The function that asks for a shaded picture when no message came for a while.
const IDLE_TIMER: &str = "PERIS_QUIET";
/// How long dials stand still before the picture is shaded, hundredths of a second.
const IDLE_CENTISECONDS: i32 = 30;
/// The rendering that takes colours as they are.
const WASH_SHADED: i32 = 5;

/// What the function keys do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionKey {
    /// The host renders the view that is set, and shows the image on the raster screen.
    Render,
    /// The dials go back to where they began.
    Reset,
    /// The host prints the view that is set, as a camera.
    Camera,
    /// The host stops rendering; what it has rendered stays.
    Cancel,
    /// The host ends.
    End,
}

/// Number, label and meaning of each function key in use.
pub const KEYS: [(i32, &str, FunctionKey); 5] = [
    (1, "RENDER", FunctionKey::Render),
    (2, "RESET", FunctionKey::Reset),
    (3, "CAMERA", FunctionKey::Camera),
    (4, "CANCEL", FunctionKey::Cancel),
    (12, "END", FunctionKey::End),
];

/// Labels over the dials.
const DIAL_LABELS: [&str; 8] = ["ROT X", "ROT Y", "ROT Z", "SCALE", "TRAN X", "TRAN Y", "TRAN Z", ""];
/// The dial that sets the level of detail of instances, and its label.
const DETAIL_DIAL: (u16, &str) = (8, "DETAIL");
/// Levels of detail that one turn of it changes.
const LEVELS_PER_TURN: f64 = 4.0;
/// The function that sums its turns.
const DETAIL_SUM: &str = "PERIS_D";

/// A small builder: names of ours are known to be legal.
#[derive(Debug, Default)]
pub(super) struct Build {
    pub(super) commands: Vec<Command>,
}

impl Build {
    pub(super) fn function(&mut self, instance: &str, function: &str) {
        let object = Object::Function { function: name(function), size: None };
        self.commands.push(Command::Define { name: Some(name(instance)), object });
    }

    pub(super) fn connect(&mut self, source: &str, output: u16, input: u32, to: &str) {
        let destination = Destination { input: Input::Number(input), name: name(to) };
        self.commands.push(Command::Connect(Arc { source: name(source), output, destination }));
    }

    pub(super) fn send(&mut self, value: Value, input: u32, to: &str) {
        self.commands.push(send(value, input, to));
    }

    /// Dial 4 scales by a factor, whatever the scale is: its turns are summed, and squared often enough.
    fn scale(&mut self) {
        self.function("PERIS_S", "ACCUMULATE");
        self.send(Value::Real(SCALE_LIMITS[1]), 5, "PERIS_S");
        self.send(Value::Real(SCALE_LIMITS[0]), 6, "PERIS_S");
        self.connect("DIALS", 4, 1, "PERIS_S");
        self.function("PERIS_S0", "MULC");
        self.send(Value::Real(1.0 / f64::from(1 << SCALE_SQUARINGS)), 2, "PERIS_S0");
        self.connect("PERIS_S", 1, 1, "PERIS_S0");
        self.function("PERIS_S1", "ADDC");
        self.send(Value::Real(1.0), 2, "PERIS_S1");
        self.connect("PERIS_S0", 1, 1, "PERIS_S1");
        for number in 1..=SCALE_SQUARINGS {
            let [from, to] = [number, number + 1].map(|number| format!("PERIS_S{number}"));
            self.function(&to, "MUL");
            self.connect(&from, 1, 1, &to);
            self.connect(&from, 1, 2, &to);
        }
        let last = format!("PERIS_S{}", SCALE_SQUARINGS + 1);
        self.function("PERIS_SCALE", "SCALE");
        self.connect(&last, 1, 1, "PERIS_SCALE");
        self.connect("PERIS_SCALE", 1, 1, &format!("{ROOT}.S"));
    }
}

/// `SEND value TO <input>to;`
pub(super) fn send(value: Value, input: u32, to: &str) -> Command {
    Command::Send { value, destination: Destination { input: Input::Number(input), name: name(to) } }
}

/// Dials that rotate, scale and move the scene, with their labels; keys; and the way back of the view.
///
/// - `movement`: what a turn of dials 5 to 7 moves, scene units.
pub fn commands(movement: f64) -> Vec<Command> {
    let mut build = Build::default();
    for (dial, axis) in (1..).zip(["X", "Y", "Z"]) {
        let function = format!("PERIS_R{axis}");
        build.function(&function, &format!("D{axis}ROTATE"));
        build.send(Value::Real(DEGREES_PER_TURN), 3, &function);
        build.connect("DIALS", dial, 1, &function);
        build.connect(&function, 1, 1, &format!("{ROOT}.R{axis}"));
    }
    build.scale();
    build.function("PERIS_T", "ACCUMULATE");
    build.send(Value::Real(movement), 4, "PERIS_T");
    build.connect("PERIS_T", 1, 1, &format!("{ROOT}.T"));
    for (dial, axis) in (5..).zip(["X", "Y", "Z"]) {
        let function = format!("PERIS_V{axis}");
        build.function(&function, &format!("{axis}VECTOR"));
        build.connect("DIALS", dial, 1, &function);
        build.connect(&function, 1, 1, "PERIS_T");
    }
    build.commands.extend(reset());
    for (dial, label) in (1..).zip(DIAL_LABELS) {
        build.send(Value::string(label), 1, &format!("DLABEL{dial}"));
    }
    build.function("PERIS_KEY", "CCONCATENATE");
    build.function("PERIS_NUMBER", "PRINT");
    build.send(Value::string(KEY_PREFIX), 1, "PERIS_KEY");
    build.connect("FKEYS", 1, 1, "PERIS_NUMBER");
    build.connect("PERIS_NUMBER", 1, 2, "PERIS_KEY");
    build.connect("PERIS_KEY", 1, 1, "HOST_MESSAGE");
    for (number, label, _) in KEYS {
        build.commands.push(self::label(number, label));
    }
    build.function(VIEW_TRIGGER, "XFORMDATA");
    build.function("PERIS_LIST", "LIST");
    build.function(VIEW_TEXT, "PRINT");
    build.send(Value::string(format!("{ROOT}.MATRIX")), 2, VIEW_TRIGGER);
    build.connect(VIEW_TRIGGER, 1, 1, "PERIS_LIST");
    build.connect("PERIS_LIST", 1, 1, VIEW_TEXT);
    build.commands
}

/// A text for the message line.
pub fn message(text: &str) -> Command {
    send(Value::string(text), 1, "MESSAGE_DISPLAY")
}

/// A text for the label over a function key.
pub fn label(key: i32, text: &str) -> Command {
    send(Value::string(text), 1, &format!("FLABEL{key}"))
}

impl Question {
    /// A question whose answer is one message.
    ///
    /// - `what`: is asked for, in words. `trigger`: the function that answers when it gets TRUE at `<1>`. `text`: that
    ///   gives the answer. `prefix`: what this begins with.
    pub(super) const fn new(
        what: &'static str,
        trigger: &'static str,
        text: &'static str,
        prefix: &'static str,
    ) -> Question {
        Question { what, trigger, text, prefix, messages: 1 }
    }

    /// Asks, whoever set up the network that answers.
    pub(super) fn ask(&self) -> Vec<Command> {
        let mut build = Build::default();
        build.connect(self.text, 1, 1, "HOST_MESSAGE");
        build.send(Value::Boolean(true), 1, self.trigger);
        build.commands
    }

    /// Ends the question: the answers to others who ask do not come here.
    pub(super) fn leave(&self) -> Command {
        let destination = Some(Destination { input: Input::Number(1), name: name("HOST_MESSAGE") });
        Command::Disconnect { source: name(self.text), output: Some(1), destination }
    }
}

/// Shades the light of a solution on the raster screen when the dials have stood still for a while: the vectors turn
/// with them, the picture follows. The vector screen goes on when a picture is done.
pub fn shading() -> Vec<Command> {
    let mut build = Build::default();
    build.function(IDLE_TIMER, "TIMEOUT");
    build.send(Value::Integer(IDLE_CENTISECONDS), 2, IDLE_TIMER);
    build.send(Value::Integer(WASH_SHADED), 3, IDLE_TIMER);
    build.connect(IDLE_TIMER, 1, 1, &format!("{ROOT}.SHADE"));
    for dial in 1..8 {
        build.connect("DIALS", dial, 1, IDLE_TIMER);
    }
    build.function("PERIS_SHOWN", "CONSTANT");
    build.send(Value::Integer(0), 2, "PERIS_SHOWN");
    build.connect(&format!("{ROOT}.SHADE"), 1, 1, "PERIS_SHOWN");
    build.connect("PERIS_SHOWN", 1, 1, "TURNONDISPLAY");
    build.commands.extend(shade());
    build.commands
}

/// The dial for the detail of instances, with its label: to the right there is more.
pub fn detail() -> Vec<Command> {
    let mut build = Build::default();
    let (dial, label) = DETAIL_DIAL;
    let chosen = f64::from(CHOSEN_LEVEL);
    build.function(DETAIL_SUM, "ACCUMULATE");
    build.send(Value::Real(-LEVELS_PER_TURN), 4, DETAIL_SUM);
    build.send(Value::Real(2.0 * chosen), 5, DETAIL_SUM);
    build.send(Value::Real(0.0), 6, DETAIL_SUM);
    build.connect("DIALS", dial, 1, DETAIL_SUM);
    build.function("PERIS_LEVEL", "ROUND");
    build.connect(DETAIL_SUM, 1, 1, "PERIS_LEVEL");
    build.connect("PERIS_LEVEL", 1, 1, &format!("{ROOT}.{DETAIL}"));
    build.commands.extend(reset_detail());
    build.send(Value::string(label), 1, &format!("DLABEL{dial}"));
    build.commands
}

/// Draws instances as they were chosen, wherever their dial is.
pub fn reset_detail() -> Vec<Command> {
    vec![send(Value::Real(f64::from(CHOSEN_LEVEL)), 2, DETAIL_SUM), send(Value::Real(0.0), 1, DETAIL_SUM)]
}

/// Asks for a picture of the light of a solution.
pub fn shade() -> Vec<Command> {
    vec![send(Value::Boolean(true), 1, IDLE_TIMER)]
}

/// Makes a scene that takes the place of another stand as dials have turned that: they are turned by nothing, so that
/// what sums their turns fires.
///
/// - `movement`: what a turn of dials 5 to 7 moves from now on, scene units.
pub fn zero_dials(movement: f64) -> Vec<Command> {
    let mut build = Build::default();
    build.send(Value::Real(movement), 4, "PERIS_T");
    for function in ["PERIS_RX", "PERIS_RY", "PERIS_RZ", "PERIS_S"] {
        build.send(Value::Real(0.0), 1, function);
    }
    build.send(Value::Vector3(DVec3::ZERO), 1, "PERIS_T");
    build.commands
}

/// Puts the dials back to where they began: the accumulators first, then a delta of nothing, which makes the
/// functions fire.
pub fn reset() -> Vec<Command> {
    let mut build = Build::default();
    for axis in ["X", "Y", "Z"] {
        let function = format!("PERIS_R{axis}");
        build.send(Value::Real(0.0), 2, &function);
        build.send(Value::Real(0.0), 1, &function);
    }
    build.send(Value::Real(0.0), 2, "PERIS_S");
    build.send(Value::Real(0.0), 1, "PERIS_S");
    build.send(Value::Vector3(DVec3::ZERO), 2, "PERIS_T");
    build.send(Value::Vector3(DVec3::ZERO), 1, "PERIS_T");
    build.commands
}
