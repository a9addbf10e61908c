//! One program: what its commands define, use, connect and send.

use super::source_file::{Location, first_offset, last_offset};
use crate::{
    functions::{self, FunctionRow, Shape},
    structure::Operation,
};
use protocol::{
    Name, Value,
    command::{
        Command, Destination, Input, Object, Operate,
        token::{Lexer, TokenKind},
    },
};
use std::collections::BTreeMap;

/// Everything between two INITIALIZE.
#[derive(Debug, Default)]
pub(super) struct Program {
    pub(super) definitions: BTreeMap<Name, Definition>,
    pub(super) uses: Vec<Use>,
    pub(super) arcs: Vec<Arc>,
    pub(super) sends: Vec<SentMessage>,
    /// Names that were defined again, and where.
    pub(super) again: Vec<(Name, Location, Location)>,
    /// Inputs that SETUP CNESS named.
    pub(super) set_up: Vec<(Name, Input)>,
    /// Functions of a type that does not exist, and the location of the type.
    pub(super) no_functions: Vec<(Name, Location)>,
    /// Structures that are open: full name and location of the BEGIN.
    open: Vec<(Name, Location)>,
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    pub(super) location: Location,
    pub(super) kind: DefinitionKind,
}

/// Kinds of definition.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum DefinitionKind {
    /// An instance of a function.
    Function(Function),
    /// Something that could not be made: a function that does not exist, a definition that cannot be read.
    NoFunction,
    /// BEGIN_STRUCTURE or INSTANCE OF, which take no messages.
    Structure,
    /// Any other node.
    Node,
    /// A name that stands for another one.
    Alias(Name),
}

/// An instance of a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    pub(super) row: &'static FunctionRow,
    pub(super) size: Option<u16>,
    pub(super) shape: Shape,
}

impl PartialEq for Function {
    fn eq(&self, other: &Function) -> bool {
        self.row.name == other.row.name && self.size == other.size
    }
}

/// A name that is used.
#[derive(Clone, Debug)]
pub(super) struct Use {
    pub(super) name: Name,
    /// The full name of the structure in which it is used.
    pub(super) scope: Option<Name>,
    /// By what: `INSTANCE OF`.
    pub(super) by: &'static str,
    pub(super) location: Location,
}

/// A connection.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub(super) source: Name,
    pub(super) output: u16,
    pub(super) to: Name,
    pub(super) input: Input,
    pub(super) location: Location,
    /// Of the destination.
    pub(super) to_location: Location,
}

/// A message that a command sends.
#[derive(Clone, Debug)]
pub(super) struct SentMessage {
    pub(super) to: Name,
    pub(super) input: Input,
    /// The message; none if it is not known, as that of a variable.
    pub(super) value: Option<Value>,
}

impl Program {
    /// Takes a command in.
    ///
    /// - `text`: the command as it stands in the file, and where that begins.
    pub(super) fn add(&mut self, command: &Command, text: &[u8], location: Location) {
        let at = |offset: usize| Location { at: location.at + offset, ..location };
        let first = |name: &Name| at(first_offset(text, name.as_str()));
        let last = |name: &Name| at(last_offset(text, name.as_str()));
        match command {
            Command::Define { name, object } => self.define(name.as_ref(), object, text, location),
            Command::EndStructure => {
                self.open.pop();
            }
            Command::Display(name) => self.used(name, "DISPLAY", last(name)),
            Command::Include { name, into } => {
                self.used(name, "INCLUDE", first(name));
                let what = DefinitionKind::Structure;
                self.definitions.entry(into.clone()).or_insert(Definition { location: last(into), kind: what });
            }
            Command::Prefix { name, operate } => {
                self.used(name, "PREFIX", first(name));
                self.operate(operate, text, location);
            }
            Command::Follow { name, operate } => {
                self.used(name, "FOLLOW", first(name));
                self.operate(operate, text, location);
            }
            Command::PatternWith { name, pattern } => {
                self.used(name, "PATTERN", first(name));
                self.used(pattern, "PATTERN WITH", last(pattern));
            }
            Command::Connect(arc) => self.connect(&arc.source, arc.output, &arc.destination, text, location),
            Command::ConnectSeveral { source, output, destinations } => {
                for destination in destinations {
                    self.connect(source, *output, destination, text, location);
                }
            }
            Command::Send { value, destination } => {
                self.sent(destination, Some(value.clone()), last(&destination.name))
            }
            Command::SendVectors { list, destination } => {
                self.used(list, "SEND VL", first(list));
                self.sent(destination, None, last(&destination.name));
            }
            Command::SendMarks { destination, .. } => self.sent(destination, None, last(&destination.name)),
            Command::SendVariable { variable, destination } => {
                self.used(variable, "SEND VALUE", first(variable));
                self.sent(destination, None, last(&destination.name));
            }
            Command::SetupCness { destination, .. } => {
                self.used(&destination.name, "SETUP CNESS", last(&destination.name));
                self.set_up.push((destination.name.clone(), destination.input));
            }
            Command::Variable(names) => {
                for name in names {
                    self.set(name.clone(), Definition { location: first(name), kind: DefinitionKind::Node });
                }
            }
            _ => {}
        }
    }

    /// Takes in a statement that cannot be read: what it would define is not held against those who use it.
    pub(super) fn fail(&mut self, text: &[u8], location: Location) {
        let mut lexer = Lexer::new(text, 0);
        let (first, second) = (lexer.token(), lexer.token());
        let name = (second.kind == TokenKind::Assign).then(|| Name::new(&text[first.span()]).ok()).flatten();
        if let Some(full) = name.and_then(|name| self.full(&name)) {
            self.definitions.entry(full).or_insert(Definition { location, kind: DefinitionKind::NoFunction });
        }
    }

    /// The innermost structure that is open, and where it was begun.
    pub(super) fn open(&self) -> Option<&(Name, Location)> {
        self.open.last()
    }

    /// Gives up what is open.
    pub(super) fn close(&mut self) {
        self.open.clear();
    }

    /// What a name stands for in the end, by whatever name.
    pub(super) fn target<'p>(&'p self, name: &'p Name) -> &'p Name {
        let mut name = name;
        // A circle of names has no end.
        for _ in 0..self.definitions.len() {
            match self.definitions.get(name).map(|d| &d.kind) {
                Some(DefinitionKind::Alias(next)) => name = next,
                _ => break,
            }
        }
        name
    }

    /// The function of a name, if the files define one.
    pub(super) fn function(&self, name: &Name) -> Option<&Function> {
        match self.definitions.get(name).map(|d| &d.kind) {
            Some(DefinitionKind::Function(function)) => Some(function),
            _ => None,
        }
    }

    /// Whether a name is that of a function that could not be made.
    pub(super) fn is_undefined(&self, name: &str) -> bool {
        self.definitions.get(name).is_some_and(|definition| definition.kind == DefinitionKind::NoFunction)
    }

    fn define(&mut self, name: Option<&Name>, object: &Object, text: &[u8], location: Location) {
        let at = |offset: usize| Location { at: location.at + offset, ..location };
        let last = |name: &Name| at(last_offset(text, name.as_str()));
        let what = match object {
            Object::BeginStructure => {
                let outer = self.open.last().map(|(path, _)| path.clone());
                let path = name.and_then(|n| self.full(n)).or(outer);
                self.open.extend(path.map(|path| (path, location)));
                if let (Some(_), Some((path, _))) = (name, self.open.last().cloned()) {
                    self.set(path, Definition { location, kind: DefinitionKind::Structure });
                }
                return;
            }
            Object::Instance(members) => {
                members.iter().for_each(|member| self.used(member, "INSTANCE OF", last(member)));
                DefinitionKind::Structure
            }
            Object::Operate { operate, applied_to } => {
                self.operate(operate, text, location);
                if let Some(below) = applied_to {
                    self.used(below, "APPLIED TO", last(below));
                }
                DefinitionKind::Node
            }
            Object::Polygons(polygons) => {
                for attributes in polygons.iter().filter_map(|polygon| polygon.attributes.as_ref()) {
                    self.used(attributes, "WITH ATTRIBUTES", at(first_offset(text, attributes.as_str())));
                }
                DefinitionKind::Node
            }
            Object::Copy { source, .. } => {
                self.used(source, "COPY", last(source));
                DefinitionKind::Node
            }
            Object::Alias(of) => {
                self.used(of, ":=", last(of));
                DefinitionKind::Alias(of.clone())
            }
            Object::Function { function, size } => {
                let Some(name) = name else { return };
                let what = self.function_of(function, *size, last(function));
                // A new instance has no connections of its own, and nothing was sent to it.
                self.arcs.retain(|arc| arc.source != *name);
                self.sends.retain(|sent| sent.to != *name);
                self.set_up.retain(|(to, _)| to != name);
                return self.set(name.clone(), Definition { location, kind: what });
            }
            _ => DefinitionKind::Node,
        };
        if let Some(full) = name.and_then(|n| self.full(n)) {
            self.set(full, Definition { location, kind: what });
        }
    }

    fn function_of(&mut self, function: &Name, size: Option<u16>, location: Location) -> DefinitionKind {
        let Some(row) = functions::find(function.as_str()) else {
            self.no_functions.push((function.clone(), location));
            return DefinitionKind::NoFunction;
        };
        // A wrong size is reported by the machine itself.
        row.shape(size)
            .map_or(DefinitionKind::NoFunction, |shape| DefinitionKind::Function(Function { row, size, shape }))
    }

    fn operate(&mut self, operate: &Operate, text: &[u8], location: Location) {
        if let Some(name) = Operation::named_in(operate) {
            self.used(
                name,
                operate.kind().name(),
                Location { at: location.at + last_offset(text, name.as_str()), ..location },
            );
        }
    }

    fn connect(&mut self, source: &Name, output: u16, destination: &Destination, text: &[u8], location: Location) {
        let at = |offset: usize| Location { at: location.at + offset, ..location };
        let to_place = at(last_offset(text, destination.name.as_str()));
        let from_place = at(first_offset(text, source.as_str()));
        self.used(source, "CONNECT", from_place);
        self.used(&destination.name, "CONNECT", to_place);
        self.arcs.push(Arc {
            source: source.clone(),
            output,
            to: destination.name.clone(),
            input: destination.input,
            location: from_place,
            to_location: to_place,
        });
    }

    fn sent(&mut self, destination: &Destination, value: Option<Value>, location: Location) {
        self.used(&destination.name, "SEND", location);
        self.sends.push(SentMessage { to: destination.name.clone(), input: destination.input, value });
    }

    fn used(&mut self, name: &Name, by: &'static str, location: Location) {
        // Commands about messages use full names also while a structure is open.
        let messages = matches!(by, "SEND" | "CONNECT" | "SEND VALUE" | "SEND VL" | "SETUP CNESS");
        let scope = self.open.last().filter(|_| !messages).map(|(path, _)| path.clone());
        self.uses.push(Use { name: name.clone(), scope, by, location });
    }

    fn full(&self, name: &Name) -> Option<Name> {
        match self.open.last() {
            Some((outer, _)) => outer.join(name).ok(),
            None => Some(name.clone()),
        }
    }

    fn set(&mut self, name: Name, definition: Definition) {
        let place = definition.location;
        if let Some(before) = self.definitions.insert(name.clone(), definition) {
            self.again.push((name, place, before.location));
        }
    }
}
