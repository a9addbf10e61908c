//! What functions ask of the rest of the machine, and what they get: variables, files, picks, transformed data.

use super::Machine;
use crate::{
    functions::selection::lines,
    interpreter::{Interpreter, Message},
    port::{Cause, Effect, Fault, ObjectId},
};
use protocol::{Name, Value, command::CommandReader, value::MAX_STRING};
use std::sync::Arc;

/// Most requests for transformed data that wait for an update; more are lost and reported. Ours.
const MAX_TRANSFORMS: usize = 1_000;

/// A function that waits for transformed data of the next update.
#[derive(Clone, Debug)]
pub(super) struct TransformRequest {
    /// The function.
    pub(super) function: ObjectId,
    /// The path of the node.
    pub(super) node: Name,
    destination: Option<Name>,
    first: u32,
    count: u32,
}

impl Machine {
    /// Answers a function that asks for something. Returns other effects.
    pub(super) fn answer(&mut self, effect: Effect) -> Option<Effect> {
        match effect {
            Effect::RequestTransform { function, .. } if self.transforms.len() >= MAX_TRANSFORMS => {
                let name = self.memory.objects.name(function).to_string();
                let fault = Fault { function: "XFORMDATA", cause: Cause::Flood { input: 1, lost: 1 } };
                self.report(Message::Function { name, fault });
            }
            Effect::RequestTransform { function, node, destination, first, count } => {
                self.transforms.push(TransformRequest { function, node, destination, first, count });
            }
            // No update of this machine looks for what is picked: nothing is.
            Effect::RequestPick { function, .. } => self.reply(function, 2, Value::Boolean(false)),
            // There are neither variables nor labels in this machine.
            Effect::Fetch { name, .. } | Effect::ExtractLabel { name, .. } => self.report(Message::NotFound(name)),
            Effect::SendTo { name, input, value } => self.send_to(name, input, value),
            Effect::ReadDisk { function, name } => match self.disk.read(&name) {
                Ok([]) => self.reply(function, 1, Value::string("")),
                Ok(contents) => {
                    let parts: Vec<Value> = contents.chunks(MAX_STRING).map(Value::string).collect();
                    parts.into_iter().for_each(|part| self.reply(function, 1, part));
                }
                Err(fault) => self.report(Message::Disk(fault)),
            },
            Effect::WriteDisk { name, bytes, append } => {
                if let Err(fault) = self.disk.write(name, &bytes, append) {
                    self.report(Message::Disk(fault));
                }
            }
            Effect::Interpret { function, stream, bytes, fresh } => self.queue_stream(function, stream, bytes, fresh),
            other => return Some(other),
        }
        None
    }

    /// A message from an output of a function.
    pub(super) fn reply(&mut self, function: ObjectId, output: u16, value: Value) {
        self.memory.network.emit(function, output, value, &mut self.memory.effects);
    }

    /// Gives a function the data that it asked for, and makes the object that it named.
    pub(super) fn give_data(&mut self, request: TransformRequest, data: Value) {
        let data = match data {
            // The whole is shared, not copied.
            Value::Vectors(all) if request.first == 1 && request.count as usize >= all.ends.len() => {
                Value::Vectors(all)
            }
            Value::Vectors(all) => Value::Vectors(Arc::new(all.part(request.first, request.count))),
            other => other,
        };
        if let (Some(name), Some(lines)) = (request.destination, lines(&data)) {
            let mut reader = CommandReader::default();
            reader.push(format!("{name} := {}", lines.join(" ")).as_bytes());
            for read in reader {
                match read {
                    Ok(read) => {
                        Interpreter::default().execute(read.command, &mut self.memory, &mut self.messages);
                    }
                    Err(error) => self.report(Message::Syntax(error)),
                }
            }
        }
        self.reply(request.function, 1, data);
    }

    fn send_to(&mut self, name: Name, input: protocol::command::Input, value: Value) {
        let to = self.memory.objects.find(name.as_str()).filter(|id| self.memory.is_defined(*id));
        let Some(to) = to else { return self.report(Message::NotFound(name)) };
        if let Err(fault) = self.memory.send(to, input, value) {
            self.report(Message::Node { name: name.to_string(), fault });
        }
    }
}
