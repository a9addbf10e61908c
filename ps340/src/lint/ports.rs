//! Inputs and outputs that do not exist.

use super::{
    Level, Note,
    program::{Arc, DefinitionKind, Program},
};
use crate::{functions::FunctionRow, machine::Machine, port::KindSet, structure::Node};
use protocol::{Name, command::Input};

/// Nodes of a structure that a message names.
const NAMED: usize = 3;

/// Looks at both ends of every arc.
pub(super) fn check(program: &Program, machine: &Machine) -> Vec<Note> {
    program
        .arcs
        .iter()
        .flat_map(|arc| [source(arc, program, machine), destination(arc, program, machine)])
        .flatten()
        .collect()
}

fn source(arc: &Arc, program: &Program, machine: &Machine) -> Option<Note> {
    let name = program.target(&arc.source);
    let (row, outputs) = match program.definitions.get(name).map(|d| &d.kind) {
        Some(DefinitionKind::Function(function)) => (function.row, function.shape.outputs),
        Some(DefinitionKind::Structure) => {
            let text = format!("{name} is a structure; it sends no messages");
            return Some(Note { location: arc.location, level: Level::Error, text });
        }
        Some(DefinitionKind::Node) => {
            let node = node(name, machine).filter(|node| !node.has_output())?;
            let text = format!("{name} is a {}; it sends no messages", node.word());
            return Some(Note { location: arc.location, level: Level::Error, text });
        }
        Some(_) => return None,
        None => system(name, machine).map(|row| (row, row.outputs.len() as u16))?,
    };
    if (1..=outputs).contains(&arc.output) {
        return None;
    }
    let text = format!(
        "{name} ({}) has no output <{}>; {}",
        word(row, program, name),
        arc.output,
        numbered("output", outputs)
    );
    Some(Note { location: arc.location, level: Level::Error, text })
}

fn destination(arc: &Arc, program: &Program, machine: &Machine) -> Option<Note> {
    let name = program.target(&arc.to);
    let error = |text| Some(Note { location: arc.to_location, level: Level::Error, text });
    let no_input = |row: &FunctionRow, inputs: u16| {
        let exists = matches!(arc.input, Input::Number(n) if (1..=u32::from(inputs)).contains(&n));
        if exists {
            return None;
        }
        error(format!(
            "{name} ({}) has no input {}; {}",
            word(row, program, name),
            arc.input,
            numbered("input", inputs)
        ))
    };
    match program.definitions.get(name).map(|d| &d.kind) {
        Some(DefinitionKind::Function(function)) => no_input(function.row, function.shape.inputs),
        Some(DefinitionKind::Structure) => error(format!("{name} takes no messages{}", inside(program, name))),
        Some(DefinitionKind::Node) => match accepted(arc, program, machine)? {
            KindSet::NONE => {
                let node = node(name, machine)?;
                error(format!("{name} is a {} and has no input {}; it has {}", node.word(), arc.input, node.inputs()))
            }
            _ => None,
        },
        Some(_) => None,
        None => {
            let row = system(name, machine)?;
            no_input(row, row.inputs.len() as u16)
        }
    }
}

/// The kinds that the input at the end of an arc takes; none if that is not known.
pub(super) fn accepted(arc: &Arc, program: &Program, machine: &Machine) -> Option<KindSet> {
    let name = program.target(&arc.to);
    let input = match arc.input {
        Input::Number(n) => u16::try_from(n).ok(),
        _ => None,
    };
    match program.definitions.get(name).map(|d| &d.kind) {
        Some(DefinitionKind::Function(function)) => function.row.input(function.shape, input?).map(|spec| spec.kinds),
        Some(DefinitionKind::Node) => Some(node(name, machine)?.takes(arc.input).unwrap_or(KindSet::NONE)),
        Some(_) => None,
        None => system(name, machine)?.inputs.get(usize::from(input?).checked_sub(1)?).map(|spec| spec.kinds),
    }
}

/// The row of a function of the system.
pub(super) fn system(name: &Name, machine: &Machine) -> Option<&'static FunctionRow> {
    let memory = machine.memory();
    let id = memory.objects.find(name.as_str()).filter(|id| memory.objects.is_system(*id))?;
    memory.network.function(id)
}

/// `F:ADD`, or what an initial instance is.
fn word(row: &FunctionRow, program: &Program, name: &Name) -> String {
    if program.definitions.contains_key(name) { format!("F:{}", row.name) } else { row.summary.into() }
}

fn numbered(what: &str, count: u16) -> String {
    match count {
        0 => format!("it has no {what}s"),
        1 => format!("its only {what} is <1>"),
        n => format!("its {what}s are <1> to <{n}>"),
    }
}

/// A hint which nodes of a structure may be meant.
fn inside(program: &Program, name: &Name) -> String {
    let prefix = format!("{name}.");
    let nodes =
        program.definitions.iter().filter(|(n, d)| n.as_str().starts_with(&prefix) && d.kind == DefinitionKind::Node);
    let nodes: Vec<String> = nodes.take(NAMED).map(|(n, _)| n.to_string()).collect();
    if nodes.is_empty() {
        "; name a node inside it".into()
    } else {
        format!("; nodes inside it do: {}", nodes.join(", "))
    }
}

/// The node of a name.
fn node<'m>(name: &Name, machine: &'m Machine) -> Option<&'m Node> {
    let memory = machine.memory();
    memory.target(name).and_then(|id| memory.structures.node(id))
}
