//! How the machine moves: inputs, events and frames; the network runs until it rests.

use super::{
    Event, HostOutput, Input, Machine, Micros, Panel, WORK_PER_STEP,
    device_message::DeviceMessage,
    devices::Devices,
    host_line::HostLine,
    initial::initial_memory,
    keyboard::Keyboard,
    latest_update::LatestUpdate,
    monitor::Monitor,
    parallel_line::ParallelLine,
    renderings::Renderings,
    streams::Streams,
    time::{centiseconds, time_of_frame},
};
use crate::{interpreter::Message, line::LineId, port::Effect, raster::FrameBuffer, terminal::Terminal};

impl Machine {
    /// Takes the inputs, in order, at the time of the machine; then lets time run to `until` (a time in the
    /// past changes nothing). Returns what goes to the hosts.
    pub fn step(&mut self, inputs: impl IntoIterator<Item = Input>, until: Micros) -> Vec<HostOutput> {
        self.work_left = WORK_PER_STEP;
        for input in inputs {
            match input {
                Input::Attach(line) => self.lines.attach(line, self.settings.plain_text),
                Input::AttachParallel(line) => {
                    let bytes = self.lines.attach_parallel(line, self.settings.plain_text);
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

    /// Something that a person does. Dials send at the next frame, everything else at once.
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

    /// Lets one frame pass: dials and clocks send, the network runs, the picture is updated.
    pub fn next_frame(&mut self) {
        self.frame += 1;
        self.work_left = WORK_PER_STEP;
        self.account_for_reports();
        let emissions = self.devices.frame(self.frame);
        self.emit(emissions);
        self.monitor();
        self.memory.structures.set_frame(self.frame);
        self.memory.network.advance(self.frame, centiseconds(self.frame), &mut self.memory.effects);
        self.settle();
        self.with_parallels(|parallel, machine, out| parallel.frame(machine, out));
        self.advance_renderings();
        self.settle();
        self.update_display();
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
            && self.latest.version == Some(self.memory.structures.version())
            && self.overlay_is_current()
    }

    /// Whether no function is ready to fire.
    pub fn network_rests(&self) -> bool {
        self.network_idle && self.latest.pending.is_empty() && self.renderings.are_done() && self.streams.are_empty()
    }

    /// Makes the picture of now, with all its strokes.
    pub fn renew_picture(&mut self) {
        self.draw_picture();
        self.settle();
        self.update_overlay();
    }

    /// Brings the picture, and what is drawn over it, up to date as a frame does.
    pub(super) fn update_display(&mut self) {
        self.update_picture();
        self.settle();
        self.update_overlay();
    }

    pub(super) fn emit(&mut self, emissions: Vec<DeviceMessage>) {
        for (instance, output, value) in emissions {
            if let Some(id) = self.memory.objects.find(instance) {
                self.memory.network.note_emission(id);
                self.memory.network.emit(id, output, value, &mut self.memory.effects);
            }
        }
        self.network_idle = false;
    }

    fn receive(&mut self, line: LineId, bytes: &[u8]) {
        self.activity();
        self.counters.bytes_in += bytes.len() as u64;
        self.lines.report_to(line);
        if let Some(mut host) = self.lines.hosts.remove(&line) {
            host.receive(bytes, self);
            self.lines.hosts.insert(line, host);
        } else if let Some(mut parallel) = self.lines.parallels.remove(&line) {
            let mut answer = Vec::new();
            parallel.receive(bytes, self, &mut answer);
            self.lines.parallels.insert(line, parallel);
            self.answer(line, answer);
        }
        self.lines.reporting_to = None;
    }

    /// Does something with every host on the parallel interface, and sends what it answers.
    fn with_parallels(&mut self, action: impl Fn(&mut ParallelLine, &mut Machine, &mut Vec<u8>)) {
        for (line, mut parallel) in std::mem::take(&mut self.lines.parallels) {
            let mut answer = Vec::new();
            action(&mut parallel, self, &mut answer);
            self.lines.parallels.insert(line, parallel);
            self.answer(line, answer);
        }
    }

    fn answer(&mut self, line: LineId, bytes: Vec<u8>) {
        if !bytes.is_empty() {
            self.outputs.push(line, bytes);
        }
    }

    fn detach(&mut self, line: LineId) {
        self.lines.report_to(line);
        self.keyboard.detach(line);
        self.lines.mailboxes.remove(&line);
        let host = self.lines.hosts.remove(&line).and_then(|mut host| host.abandon(&mut self.memory));
        let parallel = self.lines.parallels.remove(&line).and_then(|mut parallel| parallel.abandon(&mut self.memory));
        if let Some(open) = host.or(parallel) {
            self.report(Message::Structure(format!("the line closed while {open} was open")));
        }
        self.lines.reporting_to = None;
        self.lines.writers.remove(&line);
        self.memory.close_line(line);
    }

    /// Runs the network until it rests or has used up its share of this frame, and does what it wants.
    pub(super) fn settle(&mut self) {
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

    pub(super) fn carry_effects(&mut self) {
        while !self.memory.effects.is_empty() || !self.reports.pending.is_empty() {
            for effect in std::mem::take(&mut self.memory.effects) {
                if effect == Effect::Restart {
                    self.restart();
                    break; // the others are of objects that are gone
                }
                self.carry(effect);
            }
            for message in std::mem::take(&mut self.reports.pending) {
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
        self.lines.hosts.values_mut().for_each(HostLine::restart);
        for line in self.lines.with_own_messages() {
            let made = self.memory.open_line(line);
            debug_assert!(made.is_ok(), "nothing else is there");
        }
        self.devices = Devices::default();
        self.panel = Panel::default();
        self.frame_buffer = FrameBuffer::default();
        self.latest = LatestUpdate::default();
        self.renderings = Renderings::default();
        self.streams = Streams::default();
        self.keyboard = Keyboard::default();
        self.terminal = Terminal::default();
        self.tube = self.tube.restarted();
        self.monitor = Monitor::default();
        self.switch_keyboard(self.settings.keyboard);
        self.reports.push(Message::Information("the machine was started again".into()));
    }

    /// Releases the memory of what has gone, if that is much.
    fn relieve(&mut self) {
        if self.memory_release.is_needed(self.memory.bytes() + size_of_val(self.latest.update.strokes.as_slice())) {
            self.memory.shrink();
            self.latest.update.strokes.shrink_to_fit();
            self.shrink_display();
        }
    }

    /// Whether much memory was freed since this was asked last, so that the process may give it back to the system.
    pub fn was_relieved(&mut self) -> bool {
        self.memory_release.take_due()
    }
}
