//! One line about an object, for people who look into the machine.

use crate::{
    memory::MassMemory,
    port::ObjectId,
    structure::{Member, Node, Operation},
};
use std::fmt::Write;

/// What the object is.
pub(super) fn describe(memory: &MassMemory, id: ObjectId) -> String {
    let name = memory.objects.name(id);
    if let Some(row) = memory.network.function(id) {
        return format!("{name} := F:{}", row.name);
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
        Node::Group(members) => {
            let mut text = format!("BEGIN_STRUCTURE, {} members:", members.len());
            for member in members.iter().take(20) {
                let _ = match member {
                    Member::Named(id) | Member::Included(id) => write!(text, " {}", memory.objects.name(*id)),
                    Member::Unnamed(Node::Operate { operation, .. }) => write!(text, " ({})", word(operation)),
                    Member::Unnamed(_) => write!(text, " (data)"),
                };
            }
            text
        }
        Node::Vectors(v) => format!("VECTOR_LIST {:?}, {} vectors", v.list.class, v.list.points.len()),
        Node::Characters(c) => format!("CHARACTERS '{}'", String::from_utf8_lossy(&c.text)),
        Node::Operate { operation, descendant } => {
            let mut text = format!("{} {}", word(operation), values(operation));
            if let Some(below) = descendant {
                let _ = write!(text, " APPLIED TO {}", memory.objects.name(*below));
            }
            text
        }
        _ => "a node".into(),
    }
}

fn names(memory: &MassMemory, ids: &[ObjectId]) -> String {
    ids.iter().take(20).map(|id| memory.objects.name(*id)).collect::<Vec<_>>().join(", ")
}

fn word(operation: &Operation) -> &'static str {
    match operation {
        Operation::Character(_) => "MATRIX_2X2",
        Operation::Linear(_) => "MATRIX_3X3",
        Operation::Translate(_) => "TRANSLATE",
        Operation::Affine(_) => "MATRIX_4X3",
        Operation::Projective(_) => "MATRIX_4X4",
        Operation::Viewport { .. } => "VIEWPORT",
        Operation::Color { .. } => "SET COLOR",
        Operation::Intensity { .. } => "SET INTENSITY",
        Operation::DepthClipping(_) => "SET DEPTH_CLIPPING",
        Operation::XformMatrix => "XFORM MATRIX",
        _ => "operate node",
    }
}

/// The values, matrices row by row as the machine has them.
fn values(operation: &Operation) -> String {
    let rows = |columns: &[&[f64]]| {
        let row = |c: &&[f64]| c.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        columns.iter().map(row).collect::<Vec<_>>().join("  ")
    };
    match operation {
        Operation::Character(m) => rows(&[&m.x_axis.to_array(), &m.y_axis.to_array()]),
        Operation::Linear(m) => rows(&[&m.x_axis.to_array(), &m.y_axis.to_array(), &m.z_axis.to_array()]),
        Operation::Affine(m) => {
            let c = m.to_cols_array_2d();
            rows(&[&c[0][..3], &c[1][..3], &c[2][..3], &c[3][..3]])
        }
        Operation::Projective(m) => {
            let c = m.to_cols_array_2d();
            rows(&[&c[0], &c[1], &c[2], &c[3]])
        }
        Operation::Translate(by) => rows(&[&by.to_array()]),
        Operation::Viewport { horizontal, vertical, intensity } => {
            rows(&[horizontal, vertical, intensity.as_ref().map_or(&[], |i| &i[..])])
        }
        Operation::Color { hue, saturation } => rows(&[&[*hue, *saturation]]),
        Operation::Intensity { on, range } => format!("{} {}", if *on { "ON" } else { "OFF" }, rows(&[range])),
        Operation::DepthClipping(on) => if *on { "ON" } else { "OFF" }.into(),
        _ => String::new(),
    }
}
