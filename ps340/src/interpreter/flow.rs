//! Commands about functions, arcs and messages.

use super::Message;
use crate::{
    memory::{MassMemory, Refusal},
    network::Destination,
    port::{Cause, ObjectId},
    structure::{Node, NodeFault},
};
use protocol::{Name, Value, command};

/// `name := F:function`.
pub(super) fn instance(
    name: Name,
    function: &Name,
    size: Option<u16>,
    memory: &mut MassMemory,
    messages: &mut Vec<Message>,
) -> Result<(), Message> {
    let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
    memory.define_function(&name, function, size)?;
    if known {
        messages.push(Message::Redefined(name));
    }
    Ok(())
}

/// The object that sends or receives under a name, made if need be.
fn endpoint(name: &Name, memory: &mut MassMemory) -> Result<ObjectId, Refusal> {
    let id = memory.object(name)?;
    Ok(memory.structures.follow(id))
}

pub(super) fn connect(
    source: &Name,
    output: u16,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let (from, to) = (endpoint(source, memory)?, endpoint(&destination.name, memory)?);
    let connected = memory.network.connect(from, output, to, destination.input);
    connected.map_err(|fault| {
        let blamed = if let Cause::NoSuchInput(_) = fault.cause { &destination.name } else { source };
        Message::Function { name: blamed.to_string(), fault }
    })
}

/// Makes the arcs that it can, and says which it cannot.
pub(super) fn connect_several(
    source: &Name,
    output: u16,
    destinations: &[command::Destination],
    memory: &mut MassMemory,
    messages: &mut Vec<Message>,
) {
    for destination in destinations {
        if let Err(message) = connect(source, output, destination, memory) {
            messages.push(message);
        }
    }
}

/// Takes arcs away. Those that are not there are no matter: the clients of the time do that all along.
pub(super) fn disconnect(
    source: &Name,
    output: Option<u16>,
    destination: Option<&command::Destination>,
    memory: &mut MassMemory,
) {
    let Some(id) = memory.target(source) else { return };
    let to = match destination {
        None => None,
        Some(d) => match memory.target(&d.name) {
            Some(object) => Some(Destination { object, input: d.input }),
            None => return,
        },
    };
    memory.network.disconnect(id, output, to);
}

/// The object that a message is for.
fn receiver(name: &Name, memory: &MassMemory) -> Result<ObjectId, Message> {
    let id = memory.target(name).filter(|id| memory.is_defined(*id));
    id.ok_or_else(|| Refusal::NotFound(name.clone()).into())
}

fn at(name: &Name) -> impl Fn(NodeFault) -> Message {
    move |fault| Message::Node { name: name.to_string(), fault }
}

pub(super) fn send(value: Value, destination: &command::Destination, memory: &mut MassMemory) -> Result<(), Message> {
    let to = receiver(&destination.name, memory)?;
    memory.send(to, destination.input, value).map_err(at(&destination.name))
}

pub(super) fn send_variable(
    variable: &Name,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let value = memory.variable(variable)?.cloned().ok_or_else(|| Refusal::NoValue(variable.clone()))?;
    send(value, destination, memory)
}

/// SEND VL: copies the vectors of a list into another.
pub(super) fn send_vectors(
    list: &Name,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let source = receiver(list, memory)?;
    let to = receiver(&destination.name, memory)?;
    let Some(Node::Vectors(source)) = memory.structures.node(source) else {
        return Err(Refusal::Misfit(list.clone(), "no vector list").into());
    };
    let source = source.list.clone();
    if memory.is_full() {
        return Err(Refusal::Full.into());
    }
    memory.structures.overwrite(to, destination.input, &source).map_err(at(&destination.name))
}

/// SEND number*P or number*L.
pub(super) fn send_marks(
    count: u32,
    lines: bool,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let to = receiver(&destination.name, memory)?;
    memory.structures.mark(to, destination.input, count, lines).map_err(at(&destination.name))
}

/// SETUP CNESS.
pub(super) fn setup_cness(
    constant: bool,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let to = receiver(&destination.name, memory)?;
    // A host must not silence the system for all others.
    if memory.objects.is_system(to) && !memory.privileged {
        return Err(Refusal::System(destination.name.clone()).into());
    }
    let done = memory.network.setup_cness(to, destination.input, constant);
    done.map_err(|fault| Message::Function { name: destination.name.to_string(), fault })
}

/// VARIABLE: makes variables without a value, at once and with full names, also while a structure is open.
pub(super) fn variables(names: Vec<Name>, memory: &mut MassMemory, messages: &mut Vec<Message>) {
    for name in names {
        let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
        match memory.define_node(&name, Node::Variable(None)) {
            Ok(_) if known => messages.push(Message::Redefined(name)),
            Ok(_) => {}
            Err(refusal) => messages.push(refusal.into()),
        }
    }
}
