//! Commands about functions, arcs and messages.

use super::{Message, message::inputs_of};
use crate::{
    memory::{MassMemory, Refusal},
    network::Destination,
    port::{Cause, ObjectId},
    structure::Node,
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
    Ok(memory.resolve(id))
}

/// Makes an arc. The message about a display node without such a port is a warning; the arc is there all the same.
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
    })?;
    match no_port(source, from, destination, to, memory) {
        Some(text) => Err(Message::NoPort(text)),
        None => Ok(()),
    }
}

/// What is odd about an arc that begins or ends at a display node. It stays: the name may get another definition.
fn no_port(
    source: &Name,
    from: ObjectId,
    destination: &command::Destination,
    to: ObjectId,
    memory: &MassMemory,
) -> Option<String> {
    let node = |id| memory.structures.node(id).filter(|_| memory.network.function(id).is_none());
    if let Some(node) = node(from).filter(|node| !node.has_output()) {
        return Some(format!("{source} is a {} and sends no messages", node.word()));
    }
    let node = node(to).filter(|node| node.takes(destination.input).is_none())?;
    let (input, name) = (destination.input, &destination.name);
    Some(format!("No such input {input} of {name}; {}", inputs_of(node, name.as_str())))
}

/// Makes the arcs that it can, and reports which it cannot.
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

pub(super) fn send(value: Value, destination: &command::Destination, memory: &mut MassMemory) -> Result<(), Message> {
    let to = receiver(&destination.name, memory)?;
    memory.send(to, destination.input, value).map_err(|fault| Message::of_node(to, fault, memory))
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
    memory.structures.overwrite(to, destination.input, &source).map_err(|fault| Message::of_node(to, fault, memory))
}

/// SEND number*P or number*L.
pub(super) fn send_marks(
    count: u32,
    lines: bool,
    destination: &command::Destination,
    memory: &mut MassMemory,
) -> Result<(), Message> {
    let to = receiver(&destination.name, memory)?;
    memory.structures.mark(to, destination.input, count, lines).map_err(|fault| Message::of_node(to, fault, memory))
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
