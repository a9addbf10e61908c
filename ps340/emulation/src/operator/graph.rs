//! The network and the structure as graphs, for programs that draw them (DOT) or read them (JSON).

use crate::{
    machine::Machine,
    memory::MassMemory,
    network::{Destination, FunctionView},
    port::ObjectId,
    structure::{Member, Node},
};
use serde_json::{Value as Json, json};
use std::{collections::BTreeSet, fmt::Write};

/// Characters of the description of a node that are shown.
const SHOWN: usize = 60;

/// What a graph shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Functions and the arcs between them.
    Network,
    /// Nodes and their descendants.
    Structure,
}

/// The language of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// DOT, as graphviz reads it.
    Dot,
    /// JSON.
    Json,
}

/// The graph as text.
pub(super) fn graph(machine: &Machine, subject: Subject, language: Language) -> String {
    match (subject, language) {
        (Subject::Network, Language::Dot) => network_dot(machine),
        (Subject::Network, Language::Json) => format!("{:#}", network_json(machine)),
        (Subject::Structure, Language::Dot) => structure_dot(machine),
        (Subject::Structure, Language::Json) => format!("{:#}", structure_json(machine)),
    }
}

/// What an object is called: its name, whose instance it is, or its number if it has no name.
pub fn title(memory: &MassMemory, id: ObjectId) -> String {
    match memory.objects.name(id) {
        "?" if memory.line_of(id).is_some() => memory.title(id),
        "?" => format!("#{}", id.0),
        name => name.into(),
    }
}

/// The functions of the user, and those of the system to or from which an arc leads.
fn functions(memory: &MassMemory) -> Vec<FunctionView<'_>> {
    let reached: BTreeSet<ObjectId> =
        memory.network.snapshot().flat_map(|f| f.arcs().map(|(_, to)| to.object).collect::<Vec<_>>()).collect();
    let shown = |f: &FunctionView<'_>| {
        let used = reached.contains(&f.object()) || f.arcs().next().is_some();
        used || !memory.objects.is_system(f.object())
    };
    memory.network.snapshot().filter(shown).collect()
}

/// `F:ROUTE(3)`, or the name of an initial instance.
fn type_of(memory: &MassMemory, view: &FunctionView<'_>) -> String {
    let name = view.row().name;
    match view.size() {
        _ if memory.objects.is_system(view.object()) || memory.line_of(view.object()).is_some() => name.into(),
        0 => format!("F:{name}"),
        size => format!("F:{name}({size})"),
    }
}

fn network_dot(machine: &Machine) -> String {
    let memory = machine.memory();
    let mut text = "digraph network {\n  rankdir=LR;\n  node [shape=box];\n".to_string();
    let functions = functions(memory);
    let mut sinks = BTreeSet::new();
    for view in &functions {
        let name = title(memory, view.object());
        let waiting: Vec<String> = view
            .inputs()
            .filter(|input| input.is_active() && !input.is_empty())
            .map(|input| format!("\n<{}>: {} waiting", input.number(), input.len()))
            .collect();
        let label = format!("{name}\n{}{}", type_of(memory, view), waiting.concat());
        let style = if memory.objects.is_system(view.object()) { ", style=dashed" } else { "" };
        let _ = writeln!(text, "  {} [label={}{style}];", quoted(&name), quoted(&label));
        for (output, to) in view.arcs() {
            let end = title(memory, to.object);
            if memory.network.function(to.object).is_none() {
                sinks.insert(to.object);
            }
            let label = format!("{output} > {}", input_word(to));
            let _ = writeln!(text, "  {} -> {} [label={}];", quoted(&name), quoted(&end), quoted(&label));
        }
    }
    for id in sinks {
        let label = machine.describe(memory.objects.name(id)).map_or_else(|| title(memory, id), |text| cut(&text));
        let _ = writeln!(text, "  {} [shape=ellipse, label={}];", quoted(&title(memory, id)), quoted(&label));
    }
    text + "}\n"
}

fn network_json(machine: &Machine) -> Json {
    let memory = machine.memory();
    let mut arcs = Vec::new();
    let functions: Vec<Json> = functions(memory)
        .iter()
        .map(|view| {
            let name = title(memory, view.object());
            arcs.extend(view.arcs().map(|(output, to)| {
                json!({ "from": name, "output": output, "to": title(memory, to.object), "input": input_word(to) })
            }));
            let inputs = view.inputs().map(|input| {
                json!({
                    "input": input.number(),
                    "active": input.is_active(),
                    "waiting": input.len(),
                    "first": input.first().map(ToString::to_string),
                    "lost": input.lost(),
                })
            });
            json!({
                "name": name,
                "type": view.row().name,
                "size": view.size(),
                "system": memory.objects.is_system(view.object()),
                "ready": view.is_ready(),
                "inputs": inputs.collect::<Vec<_>>(),
                "outputs": view.outputs(),
            })
        })
        .collect();
    json!({ "functions": functions, "arcs": arcs })
}

fn input_word(to: Destination) -> String {
    to.input.to_string().trim_matches(['<', '>']).to_string()
}

/// A node of the structure with what it refers to.
struct GraphNode {
    id: ObjectId,
    name: String,
    text: String,
    descendants: Vec<ObjectId>,
    /// Fonts and attributes, which are not drawn themselves.
    references: Vec<ObjectId>,
}

/// The nodes that have a definition, by number; those of the system if something refers to them or they are shown.
fn graph_nodes(machine: &Machine) -> Vec<GraphNode> {
    let memory = machine.memory();
    let ids = (0..memory.structures.extent()).map(ObjectId::new);
    let mut places: Vec<GraphNode> = ids
        .filter_map(|id| {
            let node = memory.structures.node(id)?;
            let (mut descendants, mut references) = (Vec::new(), Vec::new());
            refer(node, &mut descendants, &mut references);
            let name = title(memory, id);
            let text = machine.describe(&name).map_or_else(|| name.clone(), |text| cut(&text));
            Some(GraphNode { id, name, text, descendants, references })
        })
        .collect();
    let reached: BTreeSet<ObjectId> = places.iter().flat_map(|p| p.descendants.iter().copied()).collect();
    let displayed: BTreeSet<ObjectId> = memory.structures.displayed().collect();
    places.retain(|p| !memory.objects.is_system(p.id) || reached.contains(&p.id) || displayed.contains(&p.id));
    places
}

fn refer(node: &Node, descendants: &mut Vec<ObjectId>, references: &mut Vec<ObjectId>) {
    match node {
        Node::Instance(members) => descendants.extend(members),
        Node::Group(members) => {
            for member in members {
                match member {
                    Member::Named(id) | Member::Included(id) => descendants.push(*id),
                    // A group inside is an object of its own, so that this goes one deep.
                    Member::Unnamed(inner) => refer(inner, descendants, references),
                }
            }
        }
        Node::Operate { operation, descendant, .. } => {
            descendants.extend(descendant);
            references.extend(operation.reference());
        }
        Node::Polygons(polygons) => references.extend(polygons.attributes.iter().flatten()),
        _ => {}
    }
    references.sort_unstable();
    references.dedup();
}

fn structure_dot(machine: &Machine) -> String {
    let memory = machine.memory();
    let mut text = "digraph structure {\n  node [shape=box];\n".to_string();
    for place in graph_nodes(machine) {
        let _ = writeln!(text, "  {} [label={}];", quoted(&place.name), quoted(&place.text));
        for (style, ends) in [("", &place.descendants), (" [style=dashed]", &place.references)] {
            for end in ends {
                let _ = writeln!(text, "  {} -> {}{style};", quoted(&place.name), quoted(&title(memory, *end)));
            }
        }
    }
    for id in memory.structures.displayed() {
        let _ = writeln!(text, "  \"the display\" -> {};", quoted(&title(memory, id)));
    }
    text + "}\n"
}

fn structure_json(machine: &Machine) -> Json {
    let memory = machine.memory();
    let names = |ids: &[ObjectId]| ids.iter().map(|id| title(memory, *id)).collect::<Vec<_>>();
    let nodes: Vec<Json> = graph_nodes(machine)
        .iter()
        .map(|place| {
            json!({
                "name": place.name,
                "text": place.text,
                "descendants": names(&place.descendants),
                "references": names(&place.references),
            })
        })
        .collect();
    json!({ "displayed": names(&memory.structures.displayed().collect::<Vec<_>>()), "nodes": nodes })
}

fn cut(text: &str) -> String {
    let short: String = text.chars().take(SHOWN).collect();
    if short.len() < text.len() { short + "..." } else { short }
}

/// A string of DOT.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"))
}
