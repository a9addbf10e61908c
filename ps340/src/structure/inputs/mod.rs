//! Nodes as message sinks: what each kind of node takes at which input.

mod labels;
mod operate;
mod takes;
mod text;
mod vectors;

pub(super) use vectors::{mark, overwrite};

use super::{Node, NodeFault};
use glam::DVec3;
use protocol::{
    Value,
    command::{Illumination, Input},
};

const FIRST: Input = Input::Number(1);
const SECOND: Input = Input::Number(2);
const THIRD: Input = Input::Number(3);
const FOURTH: Input = Input::Number(4);

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
        Node::Operate { operation, .. } => operate::accept(operation, input, &value, frame).map(|()| 0),
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

/// The fault of a message of the wrong kind.
fn wrong_kind(input: Input, value: &Value) -> NodeFault {
    NodeFault::Kind { input, kind: value.kind() }
}

/// An integer or a real.
fn number(value: &Value, input: Input) -> Result<f64, NodeFault> {
    value.number().ok_or_else(|| wrong_kind(input, value))
}

/// TRUE or FALSE.
fn boolean(value: &Value, input: Input) -> Result<bool, NodeFault> {
    if let Value::Boolean(on) = value { Ok(*on) } else { Err(wrong_kind(input, value)) }
}

/// An integer; a real is refused, so that a lost fraction is not overlooked.
fn integer(value: &Value, input: Input) -> Result<i32, NodeFault> {
    if let Value::Integer(i) = value { Ok(*i) } else { Err(wrong_kind(input, value)) }
}

/// An integer that is not negative.
fn count(value: &Value, input: Input) -> Result<u32, NodeFault> {
    u32::try_from(integer(value, input)?).map_err(|_| NodeFault::Range { input })
}

/// A place in two or three dimensions; z is 0 in two.
fn place(value: &Value, input: Input) -> Result<DVec3, NodeFault> {
    match value {
        Value::Vector2(v) => Ok(v.extend(0.0)),
        Value::Vector3(v) => Ok(*v),
        _ => Err(wrong_kind(input, value)),
    }
}

/// The index, from 0, of an element that an input names; none for the inputs that name no element.
///
/// # Errors
/// An index that is 0 or past the end.
fn element(input: Input, len: usize) -> Result<Option<usize>, NodeFault> {
    let index = match input {
        Input::Number(n) => (n as usize).checked_sub(1),
        Input::Last => len.checked_sub(1),
        _ => return Ok(None),
    };
    index.filter(|i| *i < len).map(Some).ok_or(NodeFault::Range { input })
}
