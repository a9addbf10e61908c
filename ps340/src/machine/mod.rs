//! The whole machine: owns the parts, wires them, and moves in steps. No thread, window or wall clock here.

mod carry;
mod counters;
mod describe;
mod devices;
mod dials;
mod host_line;
mod initial;
mod inspection;
mod keyboard;
mod outgoing;
mod parallel;
mod panel;
mod relief;
mod renderings;
mod requests;
mod sight;
mod speech;
mod streams;
mod tablet;
mod tube;
mod watch;

pub use counters::Counters;
pub use devices::Event;
pub use host_line::PlainText;
pub use keyboard::{Key, KeyboardMode};
pub use outgoing::Output;
pub use panel::Panel;
pub use speech::REPORTS_PER_FRAME;
pub use tablet::TabletEvent;

use crate::{
    disk::Disk, functions::devices::initial, interpreter::Message, line::LineId, memory::MassMemory, port::Effect,
    raster::FrameBuffer, terminal::Terminal, traversal::Update,
};
use devices::Devices;
use host_line::HostLine;
use keyboard::Keyboard;
use outgoing::Outgoing;
use parallel::{Mailbox, ParallelLine};
use protocol::wire::{MessageForm, MessageWriter};
use relief::Relief;
use renderings::Renderings;
use requests::Waiting;
use sight::Sight;
use speech::Kept;
use std::collections::{BTreeMap, VecDeque};
use streams::Streams;
use tube::Tube;
use watch::Watch;

/// Frames a second: the nominal refresh rate, as remembered from the manuals.
pub const FRAMES_PER_SECOND: u64 = 60;
/// Messages that functions deliver in one step of the machine: a frame, or some input (at least one a firing). What is
/// left waits for the next step, so that a network that never rests stops neither the display nor the lines. Ours.
pub const WORK_PER_STEP: u64 = 200_000;

/// Microseconds since the machine was made.
pub type Micros = u64;

/// What comes into the machine.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A host line opens.
    Attach(LineId),
    /// A host line opens that speaks the words of the parallel interface.
    AttachParallel(LineId),
    /// Bytes from a host.
    Bytes(LineId, Vec<u8>),
    /// A host line closes.
    Detach(LineId),
    /// Something that a person does.
    Event(Event),
}

/// Settings that do not change while the machine runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings {
    /// Who gets text that arrives outside packets.
    pub plain_text: PlainText,
    /// The mode of the keyboard at the start.
    pub keyboard: KeyboardMode,
}

/// The PS 340.
#[derive(Debug)]
pub struct Machine {
    settings: Settings,
    memory: MassMemory,
    lines: BTreeMap<LineId, HostLine>,
    parallels: BTreeMap<LineId, ParallelLine>,
    /// Messages for the hosts of `parallels`.
    mailboxes: BTreeMap<LineId, Mailbox>,
    /// How messages go to each host.
    writers: BTreeMap<LineId, MessageWriter>,
    /// The line whose commands are carried out, if it asked for messages of its own.
    speaking: Option<LineId>,
    devices: Devices,
    keyboard: Keyboard,
    terminal: Terminal,
    tube: Tube,
    sight: Sight,
    watch: Watch,
    panel: Panel,
    frame_buffer: FrameBuffer,
    frame: u64,
    work_left: u64,
    /// Messages of the machine since the latest frame: all, those given to ERROR, WARNING or INFORMATION, and those that
    /// were too many for these.
    reported: u64,
    emitted: u64,
    unheard: u64,
    network_idle: bool,
    update: Update,
    /// Version of the structure that `update` shows; none before the first.
    updated: Option<u64>,
    /// What functions want of the next update.
    waiting: Waiting,
    renderings: Renderings,
    relief: Relief,
    streams: Streams,
    disk: Disk,
    messages: Vec<Message>,
    log: VecDeque<String>,
    to_host: Kept,
    outputs: Outgoing,
    counters: Counters,
}

impl Machine {
    /// A machine as after its start: the initial function instances exist, nothing is displayed.
    pub fn new(settings: Settings) -> Machine {
        let mut machine = Machine {
            settings,
            memory: initial_memory(),
            lines: BTreeMap::new(),
            parallels: BTreeMap::new(),
            mailboxes: BTreeMap::new(),
            writers: BTreeMap::new(),
            speaking: None,
            devices: Devices::default(),
            keyboard: Keyboard::default(),
            terminal: Terminal::default(),
            tube: Tube::default(),
            sight: Sight::default(),
            watch: Watch::default(),
            panel: Panel::default(),
            frame_buffer: FrameBuffer::default(),
            frame: 0,
            work_left: WORK_PER_STEP,
            reported: 0,
            emitted: 0,
            unheard: 0,
            network_idle: true,
            update: Update::default(),
            updated: None,
            waiting: Waiting::default(),
            renderings: Renderings::default(),
            relief: Relief::default(),
            streams: Streams::default(),
            disk: Disk::default(),
            messages: Vec::new(),
            log: VecDeque::new(),
            to_host: Kept::default(),
            outputs: Outgoing::default(),
            counters: Counters::default(),
        };
        machine.switch_keyboard(settings.keyboard);
        machine
    }

    /// Takes the inputs, in order, at the time of the machine; then lets time run to `until` (a time in the
    /// past changes nothing). Returns what goes to the hosts.
    pub fn step(&mut self, inputs: impl IntoIterator<Item = Input>, until: Micros) -> Vec<Output> {
        self.work_left = WORK_PER_STEP;
        for input in inputs {
            match input {
                Input::Attach(line) => {
                    self.lines.insert(line, HostLine::new(line, self.settings.plain_text));
                    self.writers.insert(line, MessageWriter::default());
                }
                Input::AttachParallel(line) => {
                    let mut bytes = Vec::new();
                    let parallel = ParallelLine::new(line, self.settings.plain_text, &mut bytes);
                    self.parallels.insert(line, parallel);
                    self.outputs.push(line, bytes);
                }
                Input::Bytes(line, bytes) => self.receive(line, &bytes),
                Input::Detach(line) => self.detach(line),
                Input::Event(event) => self.event(event),
            }
        }
        self.settle();
        while time_of_frame(self.frame + 1) <= until {
            self.next_frame();
        }
        self.with_parallels(|parallel, machine, out| parallel.serve_mail(machine, out));
        self.outputs.take()
    }

    /// Something that a person does. Dials speak at the next frame, everything else at once.
    pub fn event(&mut self, event: Event) {
        self.work_left = WORK_PER_STEP;
        self.activity();
        match event {
            Event::Type(text) => self.type_characters(&text),
            Event::Press(key) => self.press(key),
            Event::Mode(mode) => self.switch_keyboard(mode),
            event => {
                let emissions = self.devices.event(&event);
                self.emit(emissions);
            }
        }
        self.settle();
    }

    /// Lets one frame pass: dials and clocks speak, the network runs, the picture is updated.
    pub fn next_frame(&mut self) {
        self.frame += 1;
        self.work_left = WORK_PER_STEP;
        self.account_for_reports();
        let emissions = self.devices.frame(self.frame);
        self.emit(emissions);
        self.watch();
        self.memory.structures.set_frame(self.frame);
        self.memory.network.advance(self.frame, centiseconds(self.frame), &mut self.memory.effects);
        self.settle();
        self.with_parallels(|parallel, machine, out| parallel.frame(machine, out));
        self.advance_renderings();
        self.settle();
        self.update_sight();
        self.follow_frame();
        self.relieve();
    }

    /// The number of frames that have passed.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Whether nothing is left to do until something comes in, or a clock ticks.
    pub fn is_idle(&self) -> bool {
        self.network_rests()
            && self.devices.is_quiet()
            && self.updated == Some(self.memory.structures.version())
            && self.overlay_is_current()
    }

    /// Whether no function is ready to fire.
    pub fn network_rests(&self) -> bool {
        self.network_idle && self.waiting.is_empty() && self.renderings.are_done() && self.streams.are_quiet()
    }

    /// Makes the picture of now, with all its strokes.
    pub fn renew_picture(&mut self) {
        self.draw_picture();
        self.settle();
        self.update_overlay();
    }

    /// Brings the picture, and what is drawn over it, up to date as a frame does.
    fn update_sight(&mut self) {
        self.update_picture();
        self.settle();
        self.update_overlay();
    }

    fn emit(&mut self, emissions: Vec<devices::Emission>) {
        for (instance, output, value) in emissions {
            if let Some(id) = self.memory.objects.find(instance) {
                self.memory.network.note_speech(id);
                self.memory.network.emit(id, output, value, &mut self.memory.effects);
            }
        }
        self.network_idle = false;
    }

    fn receive(&mut self, line: LineId, bytes: &[u8]) {
        self.activity();
        self.counters.bytes_in += bytes.len() as u64;
        self.speak_for(line);
        if let Some(mut host) = self.lines.remove(&line) {
            host.receive(bytes, self);
            self.lines.insert(line, host);
        } else if let Some(mut parallel) = self.parallels.remove(&line) {
            let mut answer = Vec::new();
            parallel.receive(bytes, self, &mut answer);
            self.parallels.insert(line, parallel);
            self.answer(line, answer);
        }
        self.speaking = None;
    }

    /// Does something with every host on the parallel interface, and sends what it answers.
    fn with_parallels(&mut self, action: impl Fn(&mut ParallelLine, &mut Machine, &mut Vec<u8>)) {
        for (line, mut parallel) in std::mem::take(&mut self.parallels) {
            let mut answer = Vec::new();
            action(&mut parallel, self, &mut answer);
            self.parallels.insert(line, parallel);
            self.answer(line, answer);
        }
    }

    fn answer(&mut self, line: LineId, bytes: Vec<u8>) {
        if !bytes.is_empty() {
            self.outputs.push(line, bytes);
        }
    }

    fn mailbox(&mut self, line: LineId) -> &mut Mailbox {
        self.mailboxes.entry(line).or_default()
    }

    fn detach(&mut self, line: LineId) {
        self.speak_for(line);
        self.keyboard.detach(line);
        self.mailboxes.remove(&line);
        let host = self.lines.remove(&line).and_then(|mut host| host.abandon(&mut self.memory));
        let parallel = self.parallels.remove(&line).and_then(|mut parallel| parallel.abandon(&mut self.memory));
        if let Some(open) = host.or(parallel) {
            self.report(Message::Structure(format!("the line closed while {open} was open")));
        }
        self.speaking = None;
        self.writers.remove(&line);
        self.memory.close_line(line);
    }

    /// Runs the network until it rests or has used up its share of this frame, and does what it wants.
    fn settle(&mut self) {
        loop {
            self.carry_effects();
            if self.work_left == 0 {
                self.network_idle = false;
                return;
            }
            let ran = self.memory.network.run(self.work_left, &mut self.memory.effects);
            self.work_left = self.work_left.saturating_sub(ran.work);
            self.counters.firings += ran.firings;
            self.network_idle = ran.idle;
            if self.memory.effects.is_empty() && !self.interpret_next() {
                return;
            }
        }
    }

    fn carry_effects(&mut self) {
        while !self.memory.effects.is_empty() || !self.messages.is_empty() {
            for effect in std::mem::take(&mut self.memory.effects) {
                if effect == Effect::Restart {
                    self.restart();
                    break; // the others are of objects that are gone
                }
                self.carry(effect);
            }
            for message in std::mem::take(&mut self.messages) {
                self.report(message);
            }
        }
    }

    /// REBOOT: everything is as after the start, but for the time, the lines, what was counted and the password.
    fn restart(&mut self) {
        let password = self.memory.system.password.take();
        self.memory = initial_memory();
        self.memory.system.password = password;
        self.memory.structures.set_frame(self.frame);
        self.memory.network.advance(self.frame, centiseconds(self.frame), &mut self.memory.effects);
        self.lines.values_mut().for_each(HostLine::restart);
        let own = self.writers.iter().filter(|(_, writer)| writer.form() == MessageForm::Own);
        for line in own.map(|(line, _)| *line) {
            let made = self.memory.open_line(line);
            debug_assert!(made.is_ok(), "nothing else is there");
        }
        self.devices = Devices::default();
        self.panel = Panel::default();
        self.frame_buffer = FrameBuffer::default();
        self.update = Update::default();
        self.updated = None;
        self.waiting = Waiting::default();
        self.renderings = Renderings::default();
        self.streams = Streams::default();
        self.keyboard = Keyboard::default();
        self.terminal = Terminal::default();
        self.tube = self.tube.restarted();
        self.watch = Watch::default();
        self.switch_keyboard(self.settings.keyboard);
        self.messages.push(Message::Information("the machine was started again".into()));
    }
}

/// The mass memory after the start: the initial function instances exist.
fn initial_memory() -> MassMemory {
    let mut memory = MassMemory::default();
    for initial in initial() {
        let made = memory.define_initial(&initial);
        debug_assert!(made.is_ok(), "{initial:?}: {made:?}");
    }
    let structures = initial::define_structures(&mut memory);
    debug_assert!(structures.is_ok(), "{structures:?}");
    memory.objects.seal_system();
    memory
}

/// The time of a frame, for clocks.
const fn centiseconds(frame: u64) -> u64 {
    frame * 100 / FRAMES_PER_SECOND
}

/// When a frame begins.
pub fn time_of_frame(frame: u64) -> Micros {
    frame * 1_000_000 / FRAMES_PER_SECOND
}

#[cfg(test)]
mod answer_tests;
#[cfg(test)]
mod device_tests;
#[cfg(test)]
mod line_tests;
#[cfg(test)]
mod rendering_tests;
#[cfg(test)]
mod sight_tests;
#[cfg(test)]
mod tests;
