//! Inputs of LABELS.

use crate::structure::{
    Labels, NodeFault,
    value::{count, element, position, wrong_kind},
};
use glam::DVec3;
use protocol::{
    Value,
    command::{Input, LabelText},
    value::MAX_STRING,
};

/// Gives `value` to `input` of a block of labels; returns by how many bytes it grew.
///
/// `<append>` takes a string or a vector too: a label at the origin, or one without text. Ours.
pub(super) fn accept(block: &mut Labels, input: Input, value: &Value) -> Result<isize, NodeFault> {
    if let Value::String(text) = value
        && text.len() > MAX_STRING
    {
        return Err(NodeFault::Range { input });
    }
    match input {
        Input::Step => match value {
            Value::Vector2(step) => block.step = *step,
            _ => return Err(wrong_kind(input, value)),
        },
        Input::Clear => {
            let gone = bytes(&block.labels);
            block.labels = Vec::new();
            return Ok(-gone);
        }
        Input::Delete => {
            let keep = block.labels.len().saturating_sub(count(value, input)? as usize);
            let gone = bytes(&block.labels[keep..]);
            block.labels.truncate(keep);
            return Ok(-gone);
        }
        Input::Append => {
            let label = match value {
                Value::Label(label) => (LabelText { position: label.position, text: label.text.clone() }, label.on),
                Value::String(text) => (LabelText { position: DVec3::ZERO, text: text.clone() }, true),
                _ => (LabelText { position: position(value, input)?, text: Box::default() }, true),
            };
            block.labels.push(label);
            return Ok(bytes(&block.labels[block.labels.len() - 1..]));
        }
        Input::Position | Input::Substitute => return Err(NodeFault::NoSuchInput { input }),
        Input::Number(_) | Input::Last => {
            let index = element(input, block.labels.len())?.ok_or(NodeFault::NoSuchInput { input })?;
            let (label, shown) = &mut block.labels[index];
            match value {
                Value::Boolean(on) => *shown = *on,
                Value::Label(new) => {
                    (label.position, *shown) = (new.position, new.on);
                    let before = std::mem::replace(&mut label.text, new.text.clone());
                    return Ok(new.text.len() as isize - before.len() as isize);
                }
                Value::String(text) => {
                    let before = std::mem::replace(&mut label.text, text.clone());
                    return Ok(text.len() as isize - before.len() as isize);
                }
                _ => label.position = position(value, input)?,
            }
        }
    }
    Ok(0)
}

/// What labels take.
fn bytes(labels: &[(LabelText, bool)]) -> isize {
    labels.iter().map(|(label, _)| (size_of::<LabelText>() + label.text.len()) as isize).sum()
}
