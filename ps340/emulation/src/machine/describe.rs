//! One line about an object, for people who look into the machine.

use crate::{
    memory::MassMemory,
    port::ObjectId,
    structure::{Member, Node, Operation, Rendered},
};
use protocol::Value;
use std::fmt::Write;

/// Members, names and labels that are shown of each object.
const SHOWN: usize = 20;

/// What the object is.
pub(super) fn describe(memory: &MassMemory, id: ObjectId) -> String {
    let name = memory.objects.name(id);
    if let Some(row) = memory.network.function(id) {
        return match memory.line_of(id) {
            Some(_) => memory.title(id),
            None => format!("{name} := F:{}", row.name),
        };
    }
    let target = memory.structures.follow(id);
    if target != id {
        return format!("{name} := {}", memory.objects.name(target));
    }
    match memory.structures.node(id) {
        None => format!("{name} is not defined"),
        Some(node) => format!("{name} := {}", of_node(memory, node)),
    }
}

fn of_node(memory: &MassMemory, node: &Node) -> String {
    match node {
        Node::Nil => "NIL".into(),
        Node::Instance(members) => format!("INSTANCE OF {}", names(memory, members)),
        Node::Group(members) => group(memory, members),
        Node::Vectors(v) => {
            let mut text = format!("VECTOR_LIST {:?}, {} vectors", v.list.class, v.list.points.len());
            if let Some([first, last]) = v.parameters {
                let _ = write!(text, ", a curve over {first}:{last}");
            }
            if let Some((_, dashes)) = &v.dashed {
                let _ = write!(text, ", in {} vectors of a pattern", dashes.points.len());
            }
            text
        }
        Node::Characters(c) => format!("CHARACTERS '{}'", String::from_utf8_lossy(&c.text)),
        Node::Labels(block) => {
            let texts = block.labels.iter().take(SHOWN).map(|(l, _)| format!("'{}'", String::from_utf8_lossy(&l.text)));
            format!("LABELS, {}: {}", block.labels.len(), texts.collect::<Vec<_>>().join(" "))
        }
        Node::Operate { operation, descendant, rendered } => {
            let mut text = of_operation(memory, operation, rendered.as_deref());
            if let Some(below) = descendant {
                let _ = write!(text, " APPLIED TO {}", of_descendant(memory, *below));
            }
            text
        }
        Node::Polygons(p) => {
            let vertices: usize = p.polygons.iter().map(|p| p.vertices.len()).sum();
            format!("POLYGON, {} polygons, {vertices} vertices", p.polygons.len())
        }
        Node::Attributes(a) => {
            let [hue, saturation, intensity] = a.front.color;
            format!(
                "ATTRIBUTES COLOR {hue},{saturation},{intensity} DIFFUSE {} SPECULAR {} OPAQUE {}{}",
                a.front.diffuse,
                a.front.specular,
                a.front.opaque,
                if a.back.is_some() { " AND others at the back" } else { "" }
            )
        }
        Node::Illumination(light) => {
            let ([hue, saturation, intensity], d) = (light.color, light.direction);
            let ambient = light.ambient;
            format!("ILLUMINATION {},{},{} COLOR {hue},{saturation},{intensity} AMBIENT {ambient}", d.x, d.y, d.z)
        }
        Node::Font(font) => format!("BEGIN_FONT, {} characters", font.len()),
        Node::Pattern(pattern) => {
            let lengths = pattern.segments.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            let around = if pattern.around_corners { " AROUND_CORNERS" } else { "" };
            let matched = if pattern.matched { " MATCH" } else { " NOMATCH" };
            format!("PATTERN {lengths}{around}{matched} LENGTH {}", pattern.length)
        }
        Node::RawBlock(bytes) => format!("RAWBLOCK {}", bytes.len()),
        Node::Variable(None) => "VARIABLE without a value".into(),
        Node::Variable(Some(value)) => match value {
            Value::Boolean(b) => format!("VARIABLE, {}", if *b { "TRUE" } else { "FALSE" }),
            Value::Integer(i) => format!("VARIABLE, FIX({i})"),
            Value::Real(r) => format!("VARIABLE, {r}"),
            Value::String(text) => format!("VARIABLE, '{}'", String::from_utf8_lossy(text)),
            value => format!("VARIABLE, a {}", value.kind()),
        },
    }
}

fn group(memory: &MassMemory, members: &[Member]) -> String {
    let mut text = format!("BEGIN_STRUCTURE, {} members:", members.len());
    for member in members.iter().take(SHOWN) {
        let _ = match member {
            Member::Named(id) if memory.objects.is_anonymous(*id) => write!(text, " {}", of_descendant(memory, *id)),
            Member::Named(id) | Member::Included(id) => write!(text, " {}", memory.title(*id)),
            Member::Unnamed(Node::Operate { operation, .. }) => write!(text, " ({})", operation.word()),
            Member::Unnamed(_) => write!(text, " (data)"),
        };
    }
    text
}

/// The name of an object, or what kind of node one without a name is.
fn of_descendant(memory: &MassMemory, id: ObjectId) -> String {
    match memory.structures.node(id) {
        Some(node) if memory.objects.is_anonymous(id) => match node {
            Node::Operate { operation, .. } => format!("({})", operation.word()),
            Node::Group(_) => "(structure)".into(),
            _ => "(data)".into(),
        },
        _ => memory.objects.name(id).to_owned(),
    }
}

fn names(memory: &MassMemory, ids: &[ObjectId]) -> String {
    ids.iter().take(SHOWN).map(|id| memory.title(*id)).collect::<Vec<_>>().join(", ")
}

/// The word of an operation with its values, or with what it refers to or shows.
fn of_operation(memory: &MassMemory, operation: &Operation, rendered: Option<&Rendered>) -> String {
    let values = match (operation.reference(), rendered) {
        (Some(object), _) => memory.objects.name(object).to_owned(),
        (None, Some(Rendered { shown: true, .. })) => "shows its rendering".into(),
        (None, Some(_)) => "shows the original, has a rendering".into(),
        (None, None) => operation.values(),
    };
    let word = operation.word();
    if values.is_empty() { word.into() } else { format!("{word} {values}") }
}
