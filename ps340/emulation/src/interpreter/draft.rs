//! A structure between BEGIN_STRUCTURE and END_STRUCTURE.
//!
//! Nothing of it is in the mass memory before its END, so that a picture never shows half of it. What was read is kept
//! as a flat list, and carried out with a stack of its own: the depth of a structure takes no stack of the computer.

use super::{
    Message,
    definition::{Content, Scope, define, node},
};
use crate::{
    memory::MassMemory,
    structure::{Member, Node},
};
use protocol::Name;
use std::collections::HashSet;

/// How deep BEGIN_STRUCTURE may nest. Ours.
pub const MAX_NESTING: usize = 4096;

/// An open structure, with the structures inside it.
#[derive(Debug)]
pub(super) struct Draft {
    steps: Vec<Step>,
    /// The full names of the structures that are open, the outermost first; one without a name has that of the
    /// structure around it.
    open: Vec<Name>,
    /// The full names of everything named inside.
    names: HashSet<Name>,
    /// Structures that were refused because they are too deep, and whose END_STRUCTURE is still to come.
    refused: usize,
    bytes: usize,
}

#[derive(Debug)]
enum Step {
    Begin { path: Name, named: bool },
    Member(Option<Name>, Content),
    End,
}

impl Draft {
    /// BEGIN_STRUCTURE outside of others.
    pub(super) fn new(name: Name) -> Draft {
        let begin = Step::Begin { path: name.clone(), named: true };
        Draft { steps: vec![begin], open: vec![name], names: HashSet::new(), refused: 0, bytes: 0 }
    }

    /// The names of the structures that are open, the outermost first.
    pub(super) fn open(&self) -> &[Name] {
        &self.open
    }

    /// What to call it in messages.
    pub(super) fn title(&self) -> String {
        self.open.first().map_or_else(String::new, Name::to_string)
    }

    /// The full name of something that was named inside and not made yet: `name` as it stands, or as it would be read
    /// in the innermost open structure.
    pub(super) fn member(&self, name: &Name) -> Option<Name> {
        let path = self.open.last()?;
        let full = Scope::Inside { path, names: &self.names }.full(name);
        self.names.contains(&full).then_some(full)
    }

    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        self.bytes
    }

    /// The full name of something named inside.
    fn inner_name(&self, name: Option<Name>) -> Result<Option<Name>, Message> {
        let (Some(name), Some(outer)) = (name, self.open.last()) else { return Ok(None) };
        let full = outer.join(&name).map_err(|e| Message::Structure(e.to_string()))?;
        Ok(Some(full))
    }

    /// BEGIN_STRUCTURE inside. One that is too deep is left out, its members come to the structure around it.
    pub(super) fn begin(&mut self, name: Option<Name>) -> Result<(), Message> {
        if self.open.len() >= MAX_NESTING {
            self.refused += 1;
            return Err(Message::Structure(format!("structures nest at most {MAX_NESTING} deep")));
        }
        let full = self.inner_name(name)?;
        let named = full.is_some();
        let Some(path) = full.or_else(|| self.open.last().cloned()) else { return Ok(()) };
        if named {
            self.names.insert(path.clone());
        }
        self.open.push(path.clone());
        self.add(Step::Begin { path, named }, 0);
        Ok(())
    }

    /// Adds a member to the innermost open structure.
    pub(super) fn push(&mut self, name: Option<Name>, content: Content) -> Result<(), Message> {
        let name = self.inner_name(name)?;
        self.names.extend(name.clone());
        let bytes = content.bytes();
        self.add(Step::Member(name, content), bytes);
        Ok(())
    }

    /// END_STRUCTURE. Returns whether the outermost structure is complete.
    pub(super) fn end(&mut self) -> bool {
        if self.refused > 0 {
            self.refused -= 1;
            return false;
        }
        self.open.pop();
        self.add(Step::End, 0);
        self.open.is_empty()
    }

    fn add(&mut self, step: Step, bytes: usize) {
        self.bytes += size_of::<Step>() + bytes;
        self.steps.push(step);
    }

    /// Brings the whole structure into the mass memory.
    ///
    /// A reference to `X` made inside `A.B` means `A.B.X` if that is named in this structure, else `A.X`,
    /// else the global `X`. A member that cannot be made is reported and left out; the rest of the structure stands.
    pub(super) fn commit(self, memory: &mut MassMemory, messages: &mut Vec<Message>) {
        let mut open: Vec<(Name, bool, Vec<Member>)> = Vec::new();
        let mut made: HashSet<Name> = HashSet::new();
        let known = |name: &Name, memory: &MassMemory| {
            memory.objects.find(name.as_str()).is_some_and(|id| memory.is_defined(id))
        };
        for step in self.steps {
            let member = match step {
                Step::Begin { path, named } => {
                    open.push((path, named, Vec::new()));
                    continue;
                }
                Step::Member(name, content) => {
                    let Some((path, ..)) = open.last() else { continue };
                    let scope = Scope::Inside { path, names: &self.names };
                    match name {
                        Some(name) => {
                            let id = define(&name, content, scope, memory).map(Member::Named);
                            if !made.insert(name.clone()) {
                                messages.push(Message::Redefined(name));
                            }
                            id
                        }
                        None => node(content, scope, memory).map(Member::Unnamed),
                    }
                }
                Step::End => {
                    let Some((path, named, members)) = open.pop() else { continue };
                    let group = Node::Group(members);
                    if !named {
                        memory.add_anonymous(group).map(Member::Named).map_err(Message::from)
                    } else {
                        let again = if open.is_empty() { known(&path, memory) } else { !made.insert(path.clone()) };
                        let id = memory.define_node(&path, group);
                        if again && id.is_ok() {
                            messages.push(Message::Redefined(path));
                        }
                        id.map(Member::Named).map_err(Message::from)
                    }
                }
            };
            match (member, open.last_mut()) {
                (Ok(member), Some((.., members))) => members.push(member),
                (Ok(_), None) => {}
                (Err(message), _) => messages.push(message),
            }
        }
    }
}
