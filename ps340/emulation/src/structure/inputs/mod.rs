//! Nodes as message sinks: what each kind of node takes at which input.

mod labels;
mod takes;
mod text;
mod vectors;

pub(super) use vectors::{mark, overwrite};

use super::{
    Node, NodeFault,
    operation::Given,
    value::{FIRST, SECOND, THIRD, number, wrong_kind},
};
use glam::DVec3;
use protocol::{
    Value,
    command::{Illumination, Input},
};

/// Gives `value` to `input` of `node`.
///
/// - `frame`: the frame of the display, from which SET RATE counts.
/// - Returns by how many bytes the node grew.
///
/// # Errors
/// A fault if there is no such input, or it does not take that value; the node is then as before. A number that
/// is not finite is taken nowhere.
pub(super) fn accept(node: &mut Node, input: Input, value: Value, frame: u64) -> Result<isize, NodeFault> {
    if !value.is_finite() {
        return Err(NodeFault::Range { input });
    }
    match node {
        Node::Operate { operation, .. } => operation.accept(Given { input, value: &value, frame }).map(|()| 0),
        Node::Vectors(node) => vectors::accept(&mut node.list, input, &value),
        Node::Characters(characters) => text::accept(characters, input, &value),
        Node::Labels(block) => labels::accept(block, input, &value),
        Node::Illumination(light) => illumination(light, input, &value).map(|()| 0),
        Node::Variable(kept) if input == FIRST => {
            let before = kept.replace(value);
            Ok(string_bytes(kept.as_ref()) - string_bytes(before.as_ref()))
        }
        Node::Nil
        | Node::Instance(_)
        | Node::Group(_)
        | Node::Polygons(_)
        | Node::Attributes(_)
        | Node::Font(_)
        | Node::Pattern(_)
        | Node::RawBlock(_)
        | Node::Variable(_) => Err(NodeFault::NoSuchInput { input }),
    }
}

fn string_bytes(value: Option<&Value>) -> isize {
    if let Some(Value::String(text)) = value { text.len() as isize } else { 0 }
}

/// `<1>` direction, `<2>` hue, saturation and intensity, `<3>` share in the ambient light. Ours.
fn illumination(light: &mut Illumination, input: Input, value: &Value) -> Result<(), NodeFault> {
    let unit = |x: f64| x.clamp(0.0, 1.0);
    match (input, value) {
        (FIRST, Value::Vector3(DVec3::ZERO)) => return Err(NodeFault::Range { input }),
        (FIRST, Value::Vector3(direction)) => light.direction = *direction,
        (SECOND, Value::Vector3(color)) => light.color = [color.x, unit(color.y), unit(color.z)],
        (THIRD, Value::Real(_) | Value::Integer(_)) => light.ambient = unit(number(value, input)?),
        (FIRST | SECOND | THIRD, _) => return Err(wrong_kind(input, value)),
        _ => return Err(NodeFault::NoSuchInput { input }),
    }
    Ok(())
}
