//! A structure between BEGIN_STRUCTURE and END_STRUCTURE.
//!
//! Nothing of it is in the mass memory before its END, so that a picture never shows half of it.

use super::{Message, node};
use crate::{
    memory::MassMemory,
    port::ObjectId,
    structure::{Member, Node},
};
use protocol::{Name, command::Object};
use std::collections::HashSet;

/// An open structure.
#[derive(Debug)]
pub(super) struct Draft {
    /// The full name; for a structure without a name, that of the structure around it.
    path: Name,
    named: bool,
    members: Vec<Item>,
}

#[derive(Debug)]
enum Item {
    /// A node; the name is the full one.
    Object(Option<Name>, Object),
    Structure(Draft),
}

impl Draft {
    pub(super) fn new(path: Name, named: bool) -> Draft {
        Draft { path, named, members: Vec::new() }
    }

    pub(super) fn path(&self) -> &Name {
        &self.path
    }

    /// What to call it in messages.
    pub(super) fn title(&self) -> String {
        self.path.to_string()
    }

    /// The full name of something named inside.
    pub(super) fn inner_name(&self, inner: &Name) -> Result<Name, Message> {
        self.path.join(inner).map_err(|e| Message::Structure(e.to_string()))
    }

    /// Adds a member.
    pub(super) fn push(&mut self, name: Option<Name>, object: Object) -> Result<(), Message> {
        let name = name.map(|n| self.inner_name(&n)).transpose()?;
        self.members.push(Item::Object(name, object));
        Ok(())
    }

    /// Adds an inner structure that has come to its end.
    pub(super) fn push_structure(&mut self, inner: Draft) {
        self.members.push(Item::Structure(inner));
    }

    /// Brings the whole structure into the mass memory.
    ///
    /// A reference to `X` made inside `A.B` means `A.B.X` if that is named in this structure, else `A.X`,
    /// else the global `X`.
    pub(super) fn commit(self, memory: &mut MassMemory, messages: &mut Vec<Message>) -> Result<(), Message> {
        let mut names = HashSet::new();
        self.collect_names(&mut names);
        let name = self.path.clone();
        let known = memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id));
        self.define(&names, memory, messages)?;
        if known {
            messages.push(Message::Redefined(name));
        }
        Ok(())
    }

    fn collect_names(&self, names: &mut HashSet<Name>) {
        for item in &self.members {
            match item {
                Item::Object(Some(name), _) => {
                    names.insert(name.clone());
                }
                Item::Object(None, _) => {}
                Item::Structure(inner) => {
                    if inner.named {
                        names.insert(inner.path.clone());
                    }
                    inner.collect_names(names);
                }
            }
        }
    }

    fn define(
        self,
        names: &HashSet<Name>,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<ObjectId, Message> {
        let path = self.path.clone();
        let group = self.group(names, memory, messages)?;
        Ok(memory.define_node(&path, group)?)
    }

    fn group(
        self,
        names: &HashSet<Name>,
        memory: &mut MassMemory,
        messages: &mut Vec<Message>,
    ) -> Result<Node, Message> {
        let mut members = Vec::with_capacity(self.members.len());
        for item in self.members {
            let member = match item {
                Item::Structure(inner) if inner.named => inner.define(names, memory, messages).map(Member::Named),
                Item::Structure(inner) => inner.group(names, memory, messages).map(Member::Unnamed),
                Item::Object(name, object) => {
                    let made = node(object, &mut |reference| memory.object(&scoped(&self.path, reference, names)));
                    match (made, name) {
                        (Ok(node), Some(name)) => {
                            memory.define_node(&name, node).map(Member::Named).map_err(Message::from)
                        }
                        (made, _) => made.map(Member::Unnamed),
                    }
                }
            };
            // A member that cannot be made is reported and left out; the rest of the structure stands.
            match member {
                Ok(member) => members.push(member),
                Err(message) => messages.push(message),
            }
        }
        Ok(Node::Group(members))
    }
}

/// Bytes that an object takes while its structure is open.
pub(super) fn bytes(object: &Object) -> usize {
    size_of::<Item>()
        + match object {
            Object::VectorList(list) => list.points.len() * size_of::<[f32; 4]>() + list.lines.len(),
            Object::Characters(characters) => characters.text.len(),
            Object::Instance(names) => names.len() * size_of::<Name>(),
            _ => 0,
        }
}

/// What a reference made inside the structure `path` means.
fn scoped(path: &Name, reference: &Name, names: &HashSet<Name>) -> Name {
    let mut scope = Some(path.as_str());
    while let Some(outer) = scope {
        let inner = Name::new(outer).and_then(|o| o.join(reference));
        if let Some(found) = inner.ok().and_then(|n| names.get(&n)) {
            return found.clone();
        }
        scope = outer.rsplit_once('.').map(|(rest, _)| rest);
    }
    reference.clone()
}
