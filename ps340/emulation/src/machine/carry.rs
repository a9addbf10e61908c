//! Carrying out what the function network wants of the rest of the machine.

use super::{
    Machine,
    pending::{PendingRequests, Pick, TransformRequest},
    renderings::Renderings,
};
use crate::{
    interpreter::Message,
    memory::Refusal,
    port::{Cause, Effect, Fault, FileName, ObjectId},
    structure::Node,
    terminal::Ink,
};
use protocol::{
    Name, Value, command,
    raster::{RASTER_HEIGHT, RASTER_WIDTH},
    value::MAX_STRING,
};

impl Machine {
    /// Carries out one effect.
    pub(super) fn carry(&mut self, effect: Effect) {
        match effect {
            Effect::Deliver { object, input, value } => self.deliver(object, input, value),
            Effect::Fault { object, fault } => {
                let name = self.memory.title(object);
                self.reports.push(Message::Function { name, fault });
            }
            Effect::RequestTransform { function, node, destination, first, count } => {
                let request = TransformRequest { function, node, destination, first, count };
                let room = self.latest.pending.add_transform(request);
                self.lose_without(room, function, "XFORMDATA");
            }
            Effect::RequestPick { function, at, coordinates, frames } => {
                let room = self.latest.pending.add_pick(Pick { function, at, coordinates, frames });
                self.lose_without(room, function, "PICK");
            }
            Effect::ForgetRequests => {
                self.latest.pending = PendingRequests::default();
                self.renderings = Renderings::default();
                // The identities of objects are given out again: a fault of a new object is no old fault.
                self.latest.update.fault = None;
            }
            Effect::RequestWriteBack { node } => self.latest.pending.add_write_back(node),
            Effect::Fetch { function, name } => self.fetch(function, &name),
            Effect::ExtractLabel { function, name, index } => self.extract_label(function, name, index),
            Effect::SendTo { name, input, value } => match self.memory.target(&name) {
                Some(object) if self.memory.is_defined(object) => self.deliver(object, input, value),
                _ => self.reports.push(Refusal::NotFound(name).into()),
            },
            Effect::ReadDisk { function, name } => self.read_disk(function, &name),
            Effect::WriteDisk { name, bytes, append } => {
                if let Err(fault) = self.disk.write(name, &bytes, append) {
                    self.reports.push(Message::Disk(fault));
                }
            }
            Effect::Interpret { function, stream, bytes, fresh } => self.queue_stream(function, stream, bytes, fresh),
            Effect::ReportMemory { function } => {
                let text = Value::string(self.memory_line());
                self.memory.network.emit(function, 1, text, &mut self.memory.effects);
            }
            Effect::Host { object, bytes, binary } => self.send_to_host(object, &bytes, binary),
            Effect::HostCharacters { object, bytes } => {
                let hearers = self.recipients(object);
                hearers.into_iter().for_each(|(line, _)| self.outputs.push(line, bytes.to_vec()));
            }
            Effect::Terminal(text) => self.show_text(None, &text),
            Effect::TerminalColor { hue, saturation } => {
                self.terminal.set_ink(Ink { hue, saturation, ..*self.terminal.ink() });
            }
            Effect::TerminalCsm(csm) => self.terminal.set_ink(Ink { csm, ..*self.terminal.ink() }),
            Effect::TurnOnDisplay => self.tube.graphics = true,
            Effect::WashScreen { color, part } => {
                let [left, bottom, width, height] = part.unwrap_or([0, 0, RASTER_WIDTH, RASTER_HEIGHT]);
                self.frame_buffer.paint(left, bottom, width, &vec![color; (width * height) as usize]);
            }
            Effect::RequestRendering { node, request } => self.request_rendering(node, request),
            Effect::Activity => self.activity(),
            Effect::Dial { dial, setting } => self.devices.set_dial(dial, setting),
            Effect::Tablet(command) => {
                let emissions = self.devices.command_tablet(command);
                self.emit(emissions);
            }
            effect => self.panel.carry(effect),
        }
    }

    fn deliver(&mut self, object: ObjectId, input: command::Input, value: Value) {
        if let Err(fault) = self.memory.accept(object, input, value) {
            self.reports.push(Message::of_node(object, fault, &self.memory));
        }
    }

    /// A request for which the queue had no space is lost, and reported as of a full queue.
    fn lose_without(&mut self, room: bool, function: ObjectId, row: &'static str) {
        if !room {
            let fault = Fault { function: row, cause: Cause::Flood { input: 1, lost: 1 } };
            let name = self.memory.title(function);
            self.reports.push(Message::Function { name, fault });
        }
    }

    fn fetch(&mut self, function: ObjectId, name: &Name) {
        match self.memory.variable(name) {
            Ok(Some(value)) => {
                let value = value.clone();
                self.memory.network.emit(function, 1, value, &mut self.memory.effects);
            }
            Ok(None) => {
                let text = "the variable has no value yet".into();
                self.reports.push(Message::Range { of: name.to_string(), text });
            }
            Err(refusal) => self.reports.push(refusal.into()),
        }
    }

    fn extract_label(&mut self, function: ObjectId, name: Name, index: u32) {
        let node = self.memory.target(&name).and_then(|id| self.memory.structures.node(id));
        let block = match node {
            Some(Node::Labels(block)) => block,
            Some(_) => return self.reports.push(Refusal::Misfit(name, "no LABELS").into()),
            None => return self.reports.push(Refusal::NotFound(name).into()),
        };
        let place = usize::try_from(index).ok().and_then(|index| index.checked_sub(1));
        let Some((label, shown)) = place.and_then(|place| block.labels.get(place)) else {
            let text = format!("there is no label {index}");
            return self.reports.push(Message::Range { of: name.to_string(), text });
        };
        let parts = [Value::String(label.text.clone()), Value::Vector3(label.position), Value::Boolean(*shown)];
        for (output, part) in (1..).zip(parts) {
            self.memory.network.emit(function, output, part, &mut self.memory.effects);
        }
    }

    fn read_disk(&mut self, function: ObjectId, name: &FileName) {
        match self.disk.read(name) {
            Ok([]) => self.memory.network.emit(function, 1, Value::string(""), &mut self.memory.effects),
            Ok(contents) => {
                for part in contents.chunks(MAX_STRING) {
                    self.memory.network.emit(function, 1, Value::string(part), &mut self.memory.effects);
                }
            }
            Err(fault) => self.reports.push(Message::Disk(fault)),
        }
    }

    /// A message from an output of a function.
    pub(super) fn reply(&mut self, function: ObjectId, output: u16, value: Value) {
        self.memory.network.emit(function, output, value, &mut self.memory.effects);
    }
}
