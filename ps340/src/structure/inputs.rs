//! Nodes as message sinks: what each kind of node takes at which input.

use super::{Node, NodeFault, Operation};
use protocol::{
    Value,
    command::{Characters, Input, VectorClass, VectorList},
    value::MAX_STRING,
};

const FIRST: Input = Input::Number(1);
const SECOND: Input = Input::Number(2);

/// Gives `value` to `input` of `node`.
///
/// # Errors
/// A fault if there is no such input, or it does not take that value; the node is then as before.
pub(super) fn accept(node: &mut Node, input: Input, value: Value) -> Result<(), NodeFault> {
    match node {
        Node::Operate { operation, .. } => operate(operation, input, value),
        Node::Vectors(node) => vectors(&mut node.list, input, value),
        Node::Characters(characters) => text(characters, input, value),
        _ => Err(NodeFault::NoSuchInput { input }),
    }
}

fn operate(operation: &mut Operation, input: Input, value: Value) -> Result<(), NodeFault> {
    let kind = value.kind();
    let refused = Err(NodeFault::Kind { input, kind });
    if !value.is_finite() {
        return Err(NodeFault::Range { input });
    }
    match (operation, input, value) {
        (Operation::Character(m), FIRST, Value::Matrix2(new)) => *m = *new,
        (Operation::Linear(m), FIRST, Value::Matrix3(new)) => *m = *new,
        (Operation::Translate(by), FIRST, Value::Vector3(new)) => *by = new,
        (Operation::Translate(by), FIRST, Value::Vector2(new)) => *by = new.extend(0.0),
        (Operation::Affine(m), FIRST, Value::Matrix4x3(new)) => *m = *new,
        (Operation::Projective(m), FIRST, Value::Matrix4(new)) => *m = *new,
        (Operation::Viewport { horizontal, vertical, intensity }, FIRST, Value::Matrix3(m)) => {
            *horizontal = [m.x_axis.x, m.x_axis.y];
            *vertical = [m.y_axis.x, m.y_axis.y];
            *intensity = Some([m.z_axis.x, m.z_axis.y]);
        }
        (Operation::Viewport { horizontal, vertical, .. }, FIRST, Value::Matrix2(m)) => {
            *horizontal = m.x_axis.to_array();
            *vertical = m.y_axis.to_array();
        }
        (Operation::Color { hue, .. }, FIRST, value) => *hue = value.number().ok_or(NodeFault::Kind { input, kind })?,
        (Operation::Color { saturation, .. }, SECOND, value) => {
            *saturation = value.number().ok_or(NodeFault::Kind { input, kind })?.clamp(0.0, 1.0);
        }
        (Operation::Intensity { range, .. }, FIRST, Value::Vector2(new)) => *range = new.to_array(),
        (Operation::Intensity { on, .. }, FIRST, Value::Boolean(new)) => *on = new,
        (Operation::DepthClipping(on), FIRST, Value::Boolean(new)) => *on = new,
        (Operation::PickLocation { center, .. }, FIRST, Value::Vector2(new)) => *center = new,
        (Operation::PickLocation { size, .. }, SECOND, Value::Vector2(new)) => *size = new,
        (Operation::XformMatrix, _, _) => return Err(NodeFault::NoSuchInput { input }),
        (_, FIRST, _) => return refused,
        _ => return Err(NodeFault::NoSuchInput { input }),
    }
    Ok(())
}

/// The components of a vector for a list of `dimension`: a 2D vector gets z = 0, a 2D list drops z; the
/// fourth component of a 4D vector is the intensity.
fn point(value: &Value, dimension: u8, input: Input) -> Result<Option<[f32; 4]>, NodeFault> {
    let (v, intensity) = match value {
        Value::Vector2(v) => (v.extend(0.0), 1.0),
        Value::Vector3(v) => (*v, 1.0),
        Value::Vector4(v) => (v.truncate(), v.w),
        _ => return Ok(None),
    };
    let z = if dimension == 3 { v.z } else { 0.0 };
    let p = [v.x as f32, v.y as f32, z as f32, intensity as f32];
    if p.iter().all(|c| c.is_finite()) { Ok(Some(p)) } else { Err(NodeFault::Range { input }) }
}

fn vectors(list: &mut VectorList, input: Input, value: Value) -> Result<(), NodeFault> {
    let bad = NodeFault::Kind { input, kind: value.kind() };
    let index = match input {
        Input::Number(n) => (n as usize).checked_sub(1),
        Input::Last => list.points.len().checked_sub(1),
        Input::Append => {
            let p = point(&value, list.dimension, input)?.ok_or(bad)?;
            list.points.push(p);
            if list.class == VectorClass::Itemized {
                list.lines.push(true);
            }
            return Ok(());
        }
        Input::Delete => {
            let Value::Integer(n) = value else { return Err(bad) };
            let keep = list.points.len().saturating_sub(usize::try_from(n).unwrap_or(0));
            list.points.truncate(keep);
            list.lines.truncate(keep);
            return Ok(());
        }
        Input::Clear => {
            list.points.clear();
            list.lines.clear();
            return Ok(());
        }
        Input::Step | Input::Position | Input::Substitute => return Err(NodeFault::NoSuchInput { input }),
    };
    let index = index.filter(|i| *i < list.points.len()).ok_or(NodeFault::Range { input })?;
    match value {
        Value::Boolean(line) => {
            if list.class != VectorClass::Itemized {
                list.lines = (0..list.points.len()).map(|i| list.is_line(i)).collect();
                list.class = VectorClass::Itemized;
            }
            list.lines[index] = line;
        }
        value => list.points[index] = point(&value, list.dimension, input)?.ok_or(bad)?,
    }
    Ok(())
}

fn text(characters: &mut Characters, input: Input, value: Value) -> Result<(), NodeFault> {
    let bad = NodeFault::Kind { input, kind: value.kind() };
    if !value.is_finite() {
        return Err(NodeFault::Range { input });
    }
    let mut text = std::mem::take(&mut characters.text).into_vec();
    let end = text.len();
    let result = match (input, value) {
        (Input::Position, Value::Vector3(v)) => {
            characters.position = v;
            Ok(())
        }
        (Input::Position, Value::Vector2(v)) => {
            characters.position = v.extend(0.0);
            Ok(())
        }
        (Input::Step, Value::Vector2(v)) => {
            characters.step = v;
            Ok(())
        }
        (Input::Clear, _) => {
            text.clear();
            Ok(())
        }
        (Input::Delete, Value::Integer(n)) => {
            text.truncate(end.saturating_sub(usize::try_from(n).unwrap_or(0)));
            Ok(())
        }
        (Input::Substitute, Value::String(new)) => splice(&mut text, 0, &new, input).map(|()| text.truncate(new.len())),
        (Input::Append, Value::String(new)) => splice(&mut text, end, &new, input),
        (Input::Last, Value::String(new)) => splice(&mut text, end.saturating_sub(1), &new, input),
        (Input::Number(n), Value::String(new)) => match (n as usize).checked_sub(1).filter(|i| *i <= end) {
            Some(at) => splice(&mut text, at, &new, input),
            None => Err(NodeFault::Range { input }),
        },
        _ => Err(bad),
    };
    characters.text = text.into();
    result
}

/// Writes `new` over `text` from `at` on; the text grows if need be.
fn splice(text: &mut Vec<u8>, at: usize, new: &[u8], input: Input) -> Result<(), NodeFault> {
    if at + new.len() > MAX_STRING {
        return Err(NodeFault::Range { input });
    }
    let end = (at + new.len()).min(text.len());
    text.splice(at..end, new.iter().copied());
    Ok(())
}
