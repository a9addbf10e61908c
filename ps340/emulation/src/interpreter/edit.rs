//! Commands that edit names and the display structure.

use super::{
    Message,
    definition::{self, Scope},
};
use crate::{
    memory::{MassMemory, Refusal},
    port::ObjectId,
    structure::{Node, Operation},
};
use protocol::{
    Name,
    command::{NamePattern, Operate},
};

pub(super) fn display(name: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    let id = memory.object(name)?;
    memory.structures.display(id);
    Ok(())
}

pub(super) fn remove(name: &Name, memory: &mut MassMemory) {
    if let Some(id) = memory.objects.find(name.as_str()) {
        memory.structures.remove(id);
    }
}

pub(super) fn include(name: &Name, into: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    if memory.include(name, into)? {
        Ok(())
    } else {
        Err(Message::Structure(format!(
            "{into} is {} and cannot include {name}: only INSTANCE OF and structures can",
            kind(into, memory)
        )))
    }
}

/// What a name stands for, such as `a VECTOR_LIST`.
fn kind(name: &Name, memory: &MassMemory) -> String {
    let id = memory.target(name);
    let function = id.and_then(|id| memory.network.function(id)).map(|row| format!("F:{}", row.name));
    let node = || id.and_then(|id| memory.structures.node(id)).map(|node| format!("a {}", node.word()));
    function.or_else(node).unwrap_or_else(|| "not defined".into())
}

/// Removing what is not there is normal for the clients of the time.
pub(super) fn remove_from(name: &Name, from: &Name, memory: &mut MassMemory) {
    if let (Some(member), Some(group)) = (memory.objects.find(name.as_str()), memory.target(from)) {
        memory.structures.exclude(member, group);
    }
}

/// The object of a name that is known and not the system's.
fn user_object(name: &Name, memory: &MassMemory) -> Result<Option<ObjectId>, Message> {
    match memory.objects.find(name.as_str()) {
        Some(id) if memory.objects.is_system(id) && !memory.privileged => Err(Refusal::System(name.clone()).into()),
        found => Ok(found),
    }
}

/// Deletes what it can, and reports what it cannot.
pub(super) fn delete(patterns: &[NamePattern], memory: &mut MassMemory, messages: &mut Vec<Message>) {
    let mut gone = Vec::new();
    for pattern in patterns {
        match pattern {
            // An initial structure is then as it was at the start.
            NamePattern::Name(name) if memory.objects.find(name.as_str()).is_some_and(|id| memory.restore(id)) => {}
            NamePattern::Name(name) => match user_object(name, memory) {
                Ok(Some(id)) if memory.is_defined(id) => gone.push(id),
                Ok(_) => messages.push(Refusal::NotFound(name.clone()).into()),
                Err(message) => messages.push(message),
            },
            NamePattern::Prefix(prefix) => gone.extend(memory.objects.user_objects(prefix)),
        }
    }
    memory.delete(gone);
}

pub(super) fn forget(name: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    user_object(name, memory)?.ok_or_else(|| Refusal::NotFound(name.clone()))?;
    memory.objects.forget(name.as_str());
    Ok(())
}

/// FORGET (unit): a unit is a name with all that is named inside it. Ours.
pub(super) fn forget_unit(unit: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    let names = memory.objects.unit(unit.as_str());
    if names.is_empty() {
        return Err(Refusal::NotFound(unit.clone()).into());
    }
    names.iter().try_for_each(|name| forget(name, memory))
}

/// The operation of a PREFIX or FOLLOW, whose references are full names.
fn operation(name: &Name, operate: &Operate, memory: &mut MassMemory) -> Result<Operation, Message> {
    definition::operation(name.as_str(), operate, Scope::Outside, memory)
}

pub(super) fn prefix(name: &Name, operate: &Operate, memory: &mut MassMemory) -> Result<(), Message> {
    let operation = operation(name, operate, memory)?;
    Ok(memory.prefix(name, operation)?)
}

pub(super) fn follow(name: &Name, operate: &Operate, memory: &mut MassMemory) -> Result<(), Message> {
    let operation = operation(name, operate, memory)?;
    Ok(memory.follow(name, operation)?)
}

/// The node that a name denotes.
fn found(name: &Name, memory: &MassMemory) -> Result<ObjectId, Refusal> {
    let id = memory.target(name).filter(|id| memory.is_defined(*id));
    id.ok_or_else(|| Refusal::NotFound(name.clone()))
}

pub(super) fn pattern_with(name: &Name, pattern: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    let (list, source) = (found(name, memory)?, found(pattern, memory)?);
    let Some(Node::Pattern(applied)) = memory.structures.node(source) else {
        return Err(Refusal::Misfit(pattern.clone(), "no pattern").into());
    };
    let applied = applied.clone();
    if memory.is_full() {
        return Err(Refusal::Full.into());
    }
    memory.structures.set_pattern(list, applied).map_err(|fault| match fault {
        Some(fault) => Message::Range { of: name.to_string(), text: fault.to_string() },
        None => Refusal::Misfit(name.clone(), "no vector list or curve").into(),
    })
}

pub(super) fn erase_pattern(name: &Name, memory: &mut MassMemory) -> Result<(), Message> {
    let list = found(name, memory)?;
    if memory.structures.erase_pattern(list) {
        Ok(())
    } else {
        Err(Refusal::Misfit(name.clone(), "a name without a pattern").into())
    }
}
