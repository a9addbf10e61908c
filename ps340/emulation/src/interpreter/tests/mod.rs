//! Tests of commands: text in, pictures and messages out.

mod extremes;
mod insertions;
mod names;
mod objects;
mod service;
mod values;

use super::*;
use crate::{
    memory::MassMemory,
    port::{Effect, ObjectId},
    structure::Node,
    traversal::{self, Requests},
};
use protocol::{Value, command::CommandReader};

/// An interpreter with a memory of its own, and the messages of both.
struct Desk {
    interpreter: Interpreter,
    memory: MassMemory,
    messages: Vec<Message>,
}

/// An interpreter that has carried out `text`, all of it without a message.
fn told(text: &str) -> Desk {
    let mut desk = Desk { interpreter: Interpreter::default(), memory: MassMemory::default(), messages: Vec::new() };
    let said = desk.tell(text);
    assert!(said.is_empty(), "{said:?}");
    desk
}

impl Desk {
    /// Carries out commands; returns the messages.
    fn tell(&mut self, text: &str) -> Vec<String> {
        let mut reader = CommandReader::default();
        reader.push(text.as_bytes());
        for read in reader {
            let command = read.unwrap_or_else(|error| panic!("{error} in {text}")).command;
            self.interpreter.execute(command, &mut self.memory, &mut self.messages);
        }
        std::mem::take(&mut self.messages).iter().map(Message::to_string).collect()
    }

    /// Where the strokes of an update begin, rounded to 1/1000.
    fn picture(&self) -> Vec<[f32; 2]> {
        let update = traversal::update(&self.memory.structures, 0, &Requests::default());
        assert_eq!(update.fault, None);
        update.strokes.iter().map(|s| s.start.map(|c| (c * 1000.0).round() / 1000.0)).collect()
    }

    fn id(&self, name: &str) -> ObjectId {
        self.memory.objects.find(name).unwrap_or_else(|| panic!("{name} is unknown"))
    }

    fn node(&self, name: &str) -> &Node {
        self.memory.structures.node(self.id(name)).unwrap_or_else(|| panic!("{name} is undefined"))
    }

    /// The points of a vector list.
    fn points(&self, name: &str) -> Vec<[f32; 3]> {
        match self.node(name) {
            Node::Vectors(v) => v.list.points.iter().map(|p| [p[0], p[1], p[2]]).collect(),
            other => panic!("{name} is {other:?}"),
        }
    }

    /// The vectors of a list that are lines.
    fn lines(&self, name: &str) -> Vec<bool> {
        match self.node(name) {
            Node::Vectors(v) => (0..v.list.points.len()).map(|i| v.list.is_line(i)).collect(),
            other => panic!("{name} is {other:?}"),
        }
    }

    /// What was delivered to `<1>` of nodes by the network so far.
    fn delivered(&mut self) -> Vec<Value> {
        self.memory.network.run(1000, &mut self.memory.effects);
        let effects = std::mem::take(&mut self.memory.effects);
        effects
            .into_iter()
            .filter_map(|e| if let Effect::Deliver { value, .. } = e { Some(value) } else { None })
            .collect()
    }
}

/// A dot in the middle of the right half.
const DOT: &str = "D := VECTOR_LIST DOTS 0.5,0,0;";
