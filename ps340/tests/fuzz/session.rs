//! Target: the whole machine, with two hosts, a host on the parallel interface, a person, and time.
//!
//! An input is what comes in on the line of the first host, and between it acts, which [`MARK`] begins.

use crate::{campaign::Target, pool::Features, seeds, vocabulary::pairs};
use protocol::command::{CommandReader, reference::name_of};
use ps340::{
    line::LineId,
    machine::{HostOutput, Input, Machine, Settings, WORK_PER_STEP},
    memory::MASS_MEMORY,
    operator::{CommandOutcome, DisplayCommand, OperatorCommand, parse, perform},
};

pub static SESSION: Target = Target { name: "session", seeds: seeds::sessions, run };

/// Begins an act.
pub const MARK: u8 = 0xFE;
/// A frame passes.
pub const FRAME: u8 = b'f';
/// What follows up to the end of the line is an operator command.
pub const ORDER: u8 = b'o';
/// What follows comes from the host on the parallel interface.
pub const PARALLEL: u8 = b'p';
/// What follows comes from the first host.
const FIRST: u8 = b'a';
/// What follows comes from the second host.
const SECOND: u8 = b'b';
/// The current line closes and opens again.
const AGAIN: u8 = b'd';
/// Ten frames pass in one step.
const LATER: u8 = b't';
/// Every act.
pub const ACTS: &[u8] = &[FRAME, ORDER, PARALLEL, FIRST, SECOND, AGAIN, LATER];

const FIRST_LINE: LineId = LineId(1);
const SECOND_LINE: LineId = LineId(2);
const PARALLEL_LINE: LineId = LineId(3);
const LAST_LINE: LineId = LineId(4);

/// Frames that a session has for itself.
const FRAMES: u64 = 60;
/// Firings after which a session gets no more frames, so that loops do not fill the time.
const FIRINGS: u64 = 600_000;
/// Frames after which the machine rests once everything is deleted.
const REST: u64 = 30;
/// More memory than this is a leak: the mass memory, and one value that may pass its end.
const MEMORY: u64 = MASS_MEMORY as u64 + (1 << 20);

/// The initial instance through which hosts are answered.
const ANSWERS: &str = "HOST_MESSAGE";

struct Session {
    machine: Machine,
    line: LineId,
    outputs: Vec<HostOutput>,
    frames: u64,
}

fn run(input: &[u8], features: &mut Features) {
    let mut session = play(input);
    observe(&session, input, features);
    if input.len() % 16 == 3 {
        let again = play(input);
        assert_eq!(session.outputs, again.outputs, "the same session gives the same answers");
        assert_eq!(session.machine.counters(), again.machine.counters(), "the same session counts the same");
    }
    session.look(input.len());
    session.end();
}

fn play(input: &[u8]) -> Session {
    let mut machine = Machine::new(Settings::default());
    let mut outputs = machine.step([FIRST_LINE, SECOND_LINE].map(Input::Attach), 0);
    outputs.extend(machine.step([Input::AttachParallel(PARALLEL_LINE)], 0));
    let mut session = Session { machine, line: FIRST_LINE, outputs, frames: 0 };
    let mut pieces = input.split(|byte| *byte == MARK);
    session.receive(pieces.next().unwrap_or_default());
    for piece in pieces {
        if let Some((act, bytes)) = piece.split_first() {
            session.act(*act, bytes);
        }
    }
    (0..2).for_each(|_| session.frame());
    session
}

impl Session {
    fn act(&mut self, act: u8, bytes: &[u8]) {
        let mut rest = bytes;
        match act {
            FRAME => self.frame(),
            LATER => (0..10).for_each(|_| self.frame()),
            FIRST => self.line = FIRST_LINE,
            SECOND => self.line = SECOND_LINE,
            PARALLEL => self.line = PARALLEL_LINE,
            AGAIN => {
                let attach = if self.line == PARALLEL_LINE { Input::AttachParallel } else { Input::Attach };
                self.step([Input::Detach(self.line), attach(self.line)]);
            }
            ORDER => {
                let end = bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len());
                self.order(&String::from_utf8_lossy(&bytes[..end]));
                rest = bytes.get(end + 1..).unwrap_or_default();
            }
            _ => rest = bytes,
        }
        self.receive(rest);
    }

    fn receive(&mut self, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.step([Input::Bytes(self.line, bytes.to_vec())]);
        }
    }

    fn step(&mut self, inputs: impl IntoIterator<Item = Input>) {
        self.outputs.extend(self.machine.step(inputs, 0));
    }

    fn order(&mut self, line: &str) {
        match parse(line) {
            // A picture would be a file of a name that chance made.
            Ok(OperatorCommand::Display(DisplayCommand::Picture { .. }) | OperatorCommand::Quit) | Err(_) => {}
            Ok(order) => {
                if let CommandOutcome::Waiting(wait) = perform(&order, &mut self.machine, None) {
                    while wait.poll(&mut self.machine).is_none() && self.may_go_on() {
                        self.frame();
                    }
                }
            }
        }
    }

    fn may_go_on(&self) -> bool {
        self.frames < FRAMES && self.machine.counters().firings < FIRINGS
    }

    /// Lets a frame pass, in which the machine does no more than it may.
    fn frame(&mut self) {
        if !self.may_go_on() {
            return;
        }
        self.frames += 1;
        let before = self.machine.counters().firings;
        self.machine.next_frame();
        let firings = self.machine.counters().firings - before;
        assert!(firings <= WORK_PER_STEP, "{firings} firings in one frame");
        self.step([]);
    }

    /// Looks at everything there is to see, and at the books.
    fn look(&mut self, lot: usize) {
        self.machine.audit().unwrap_or_else(|error| panic!("{error}"));
        for stroke in self.machine.latest_update().strokes.iter().chain(self.machine.overlay()) {
            let mut numbers = stroke.start.iter().chain(&stroke.end).chain(&stroke.intensity).chain(&stroke.color);
            assert!(numbers.all(|number| number.is_finite()), "{stroke:?}");
        }
        let counters = self.machine.counters();
        assert!(counters.bytes <= MEMORY, "{} bytes", counters.bytes);
        assert_eq!(self.machine.vector_picture(Some([32, 32])).width(), 32);
        if lot % 16 == 5 {
            assert!(self.machine.raster_picture().width() > 0);
        }
        for order in [
            OperatorCommand::Panel,
            OperatorCommand::Terminal,
            OperatorCommand::Log,
            OperatorCommand::Counters,
            OperatorCommand::Show("A".into()),
        ] {
            perform(&order, &mut self.machine, None);
        }
    }

    /// A host that comes last brings everything to rest, and is answered.
    fn end(&mut self) {
        let lines = [FIRST_LINE, SECOND_LINE, PARALLEL_LINE].map(Input::Detach);
        self.step(lines.into_iter().chain([Input::Attach(LAST_LINE)]));
        self.step([Input::Bytes(LAST_LINE, b"INITIALIZE;\n".to_vec())]);
        let quiet = (0..REST).any(|_| {
            self.machine.next_frame();
            self.machine.is_idle()
        });
        assert!(quiet, "the machine rests after INITIALIZE: {:?}", self.machine.log().last());
        self.machine.audit().unwrap_or_else(|error| panic!("after INITIALIZE: {error}"));
        if answering(&self.machine) != answering(&Machine::new(Settings::default())) {
            return; // A host in configure mode took it away, or its queue; the machine is to be started again.
        }
        self.outputs.clear();
        let question = b"P := F:PRINT; CONNECT P<1>:<1>HOST_MESSAGE; SEND V2D(0.5,1) TO <1>P;\n";
        self.step([Input::Bytes(LAST_LINE, question.to_vec())]);
        self.machine.next_frame();
        self.step([]);
        let heard = self.outputs.iter().filter(|output| output.line == LAST_LINE).map(|output| &output.bytes[..]);
        let heard: Vec<u8> = heard.collect::<Vec<_>>().concat();
        let answered = heard.windows(3).any(|window| window == b"0.5");
        let log: Vec<_> = self.machine.log().collect();
        assert!(answered, "the last host hears {}; {:?}", heard.escape_ascii(), &log[log.len().saturating_sub(9)..]);
    }
}

/// The instance that answers hosts, and which of its inputs are queues.
fn answering(machine: &Machine) -> (Option<String>, Vec<bool>) {
    let memory = machine.memory();
    let object = memory.objects.find(ANSWERS);
    let view = memory.network.snapshot().find(|view| Some(view.object()) == object);
    let queues = view.iter().flat_map(|view| view.inputs()).map(|input| input.is_active());
    (machine.describe(ANSWERS), queues.collect())
}

fn observe(session: &Session, input: &[u8], features: &mut Features) {
    let machine = &session.machine;
    machine.log().take(200).for_each(|message| features.saw_message(message));
    let counters = machine.counters();
    let amounts = [
        ("firings", counters.firings),
        ("strokes", counters.strokes),
        ("vectors", counters.vectors),
        ("objects", counters.objects),
        ("messages", counters.messages_out),
        ("noise", counters.noise),
        ("updates", counters.updates),
        ("bytes", counters.bytes),
        ("overlay", machine.overlay().len() as u64),
    ];
    amounts.iter().for_each(|(of, amount)| features.saw_amount(of, *amount));
    let mut reader = CommandReader::default();
    reader.push(input);
    let mut before = "";
    for item in reader.flatten() {
        let name = name_of(&item.command);
        features.saw((before, name));
        before = name;
        pairs(&item.command, |_, word| features.saw((name, word)));
    }
}
