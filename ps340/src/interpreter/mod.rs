//! Commands become edits of objects, network and structure.

mod draft;
mod message;

pub use message::{Class, Message};

use crate::{
    memory::{MASS_MEMORY, MassMemory, Refusal},
    network::Destination,
    port::{Cause, ObjectId},
    structure::{Node, Operation},
};
use draft::Draft;
use protocol::{
    Name,
    command::{self, Command, Initialize, NamePattern, Object},
};

/// How deep BEGIN_STRUCTURE may nest.
pub const MAX_NESTING: usize = 64;

/// The command interpreter of one line: it holds the structures that are open there.
#[derive(Debug, Default)]
pub struct Interpreter {
    open: Vec<Draft>,
    /// Bytes in the open structures.
    open_bytes: usize,
}

impl Interpreter {
    /// Gives up what is open, as when the line closes. Returns the name of the outermost open structure.
    pub fn abandon(&mut self) -> Option<String> {
        let name = self.open.first().map(|d| d.title());
        self.open.clear();
        self.open_bytes = 0;
        name
    }

    /// Carries out one command; what it has to say goes to `messages`.
    pub fn execute(&mut self, command: Command, memory: &mut MassMemory, messages: &mut Vec<Message>) {
        if let Err(message) = self.try_execute(command, memory, messages) {
            messages.push(message);
        }
    }

    fn try_execute(
        &mut self,
        command: Command,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<(), Message> {
        match command {
            Command::Define { name, object } => self.define(name, object, memory, messages)?,
            Command::EndStructure => self.end_structure(memory, messages)?,
            Command::Display(name) => {
                let id = memory.object(&name)?;
                memory.structures.display(id);
            }
            Command::Remove(name) => {
                if let Some(id) = memory.objects.find(name.as_str()) {
                    memory.structures.remove(id);
                }
            }
            Command::Include { name, into } => {
                if !memory.include(&name, &into)? {
                    return Err(Message::Structure(format!("{into} is no instance that could include {name}")));
                }
            }
            Command::RemoveFrom { name, from } => {
                // Removing what is not there is normal for the clients of the time.
                if let (Some(member), Some(group)) =
                    (memory.objects.find(name.as_str()), memory.objects.find(from.as_str()))
                {
                    memory.structures.exclude(member, group);
                }
            }
            Command::Delete(patterns) => {
                for pattern in patterns {
                    delete(&pattern, memory)?;
                }
            }
            Command::Forget(name) => {
                let id = user_object(&name, memory)?.ok_or(Message::NotFound(name.clone()))?;
                debug_assert!(memory.objects.find(name.as_str()) == Some(id));
                memory.objects.forget(name.as_str());
            }
            Command::Connect(arc) => connect(&arc, memory)?,
            Command::Disconnect { source, output, destination } => {
                disconnect(&source, output, destination.as_ref(), memory);
            }
            Command::Send { value, destination } => {
                let to = memory.objects.find(destination.name.as_str()).filter(|id| memory.is_defined(*id));
                let to = to.ok_or_else(|| Message::NotFound(destination.name.clone()))?;
                let sent = memory.send(to, destination.input, value);
                sent.map_err(|fault| Message::Node { name: destination.name.to_string(), fault })?;
            }
            Command::Initialize(what) => self.initialize(what, memory),
            _ => return Err(Message::Structure("this command is not there yet".into())),
        }
        Ok(())
    }

    fn end_structure(&mut self, memory: &mut MassMemory, messages: &mut Vec<Message>) -> Result<(), Message> {
        let without = || Message::Structure("END_STRUCTURE without BEGIN_STRUCTURE".into());
        let done = self.open.pop().ok_or_else(without)?;
        match self.open.last_mut() {
            Some(outer) => outer.push_structure(done),
            None => {
                self.open_bytes = 0;
                done.commit(memory, messages)?;
            }
        }
        Ok(())
    }

    fn define(
        &mut self,
        name: Option<Name>,
        object: Object,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<(), Message> {
        if let Object::BeginStructure = object {
            if self.open.len() >= MAX_NESTING {
                return Err(Message::Structure(format!("structures nest at most {MAX_NESTING} deep")));
            }
            if self.open.is_empty() && name.is_none() {
                return Err(Message::Structure("BEGIN_STRUCTURE needs a name".into()));
            }
            let path = match (self.open.last(), &name) {
                (Some(outer), Some(inner)) => outer.inner_name(inner)?,
                (Some(outer), None) => outer.path().clone(),
                (None, Some(name)) => name.clone(),
                (None, None) => return Ok(()),
            };
            self.open.push(Draft::new(path, name.is_some()));
            return Ok(());
        }
        if let Object::Function { function, size } = object {
            // A function is made at once, also while a structure is open: its name is a full path.
            let name = name.ok_or_else(|| Message::Structure("a function needs a name".into()))?;
            let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
            memory.define_function(&name, &function, size)?;
            if known {
                messages.push(Message::Redefined(name));
            }
            return Ok(());
        }
        if let Some(draft) = self.open.last_mut() {
            self.open_bytes += draft::bytes(&object);
            if memory.bytes() + self.open_bytes > MASS_MEMORY {
                return Err(Refusal::Full.into());
            }
            return draft.push(name, object);
        }
        let name = name.ok_or_else(|| Message::Structure("only a structure holds objects without names".into()))?;
        let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
        let node = node(object, &mut |reference| memory.object(reference))?;
        memory.define_node(&name, node)?;
        if known {
            messages.push(Message::Redefined(name));
        }
        Ok(())
    }

    fn initialize(&mut self, what: Initialize, memory: &mut MassMemory) {
        match what {
            Initialize::All => {
                self.abandon();
                memory.initialize();
            }
            Initialize::Connections => memory.restore_arcs(),
            Initialize::Displays => memory.structures.clear_displayed(),
            Initialize::Names => {
                let users = memory.objects.user_objects("");
                memory.undefine_all(users);
                memory.restore_structures();
            }
        }
    }
}

/// The node of a command object; `resolve` finds what its references mean.
fn node(object: Object, resolve: &mut dyn FnMut(&Name) -> Result<ObjectId, Refusal>) -> Result<Node, Message> {
    Ok(match object {
        Object::Nil => Node::Nil,
        Object::Instance(names) => Node::Instance(names.iter().map(resolve).collect::<Result<_, _>>()?),
        Object::VectorList(list) => Node::Vectors(Box::new(list.into())),
        Object::Characters(characters) => Node::Characters(Box::new(characters)),
        Object::Operate { operate, applied_to } => Node::Operate {
            operation: Operation::new(&operate).map_err(|e| Message::Structure(e.into()))?,
            descendant: applied_to.as_ref().map(resolve).transpose()?,
        },
        _ => {
            return Err(Message::Structure("this object cannot stand here".into()));
        }
    })
}

/// The object of a name that is known and not the system's.
fn user_object(name: &Name, memory: &MassMemory) -> Result<Option<ObjectId>, Message> {
    match memory.objects.find(name.as_str()) {
        Some(id) if memory.objects.is_system(id) => Err(Refusal::System(name.clone()).into()),
        found => Ok(found),
    }
}

fn delete(pattern: &NamePattern, memory: &mut MassMemory) -> Result<(), Message> {
    match pattern {
        NamePattern::Name(name) => {
            // An initial structure is as it was at the start.
            if memory.objects.find(name.as_str()).is_some_and(|id| memory.restore(id)) {
                return Ok(());
            }
            let id = user_object(name, memory)?.filter(|id| memory.is_defined(*id));
            memory.undefine_all(vec![id.ok_or_else(|| Message::NotFound(name.clone()))?]);
        }
        NamePattern::Prefix(prefix) => {
            let found = memory.objects.user_objects(prefix);
            memory.undefine_all(found);
        }
    }
    Ok(())
}

/// Takes arcs away. Those that are not there are no matter: the clients of the time do that all along.
fn disconnect(source: &Name, output: Option<u16>, destination: Option<&command::Destination>, memory: &mut MassMemory) {
    let Some(id) = memory.objects.find(source.as_str()) else { return };
    let to = match destination {
        None => None,
        Some(d) => match memory.objects.find(d.name.as_str()) {
            Some(object) => Some(Destination { object, input: d.input }),
            None => return,
        },
    };
    memory.network.disconnect(id, output, to);
}

fn connect(arc: &command::Arc, memory: &mut MassMemory) -> Result<(), Message> {
    let (from, to) = (memory.object(&arc.source)?, memory.object(&arc.destination.name)?);
    let connected = memory.network.connect(from, arc.output, to, arc.destination.input);
    connected.map_err(|fault| {
        let blamed = if let Cause::NoSuchInput(_) = fault.cause { &arc.destination.name } else { &arc.source };
        Message::Function { name: blamed.to_string(), fault }
    })
}

impl From<Refusal> for Message {
    fn from(refusal: Refusal) -> Message {
        Message::Refused(refusal)
    }
}
