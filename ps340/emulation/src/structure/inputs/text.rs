//! Inputs of CHARACTERS.

use crate::structure::{
    NodeFault,
    value::{count, position, wrong_kind},
};
use protocol::{
    Value,
    command::{Characters, Input},
    value::MAX_STRING,
};

/// Gives `value` to `input` of a text; returns by how many bytes it grew.
pub(super) fn accept(characters: &mut Characters, input: Input, value: &Value) -> Result<isize, NodeFault> {
    let before = characters.text.len();
    match (input, value) {
        (Input::Position, _) => characters.position = position(value, input)?,
        (Input::Step, Value::Vector2(step)) => characters.step = *step,
        (Input::Clear, _) => characters.text = Box::default(),
        (Input::Delete, _) => {
            let keep = before.saturating_sub(count(value, input)? as usize);
            characters.text = characters.text[..keep].into();
        }
        (Input::Substitute, Value::String(new)) if new.len() <= MAX_STRING => characters.text = new.clone(),
        (Input::Append, Value::String(new)) => write_over(characters, before, new, input)?,
        (Input::Last, Value::String(new)) => write_over(characters, before.saturating_sub(1), new, input)?,
        (Input::Number(n), Value::String(new)) => {
            let at = (n as usize).checked_sub(1).filter(|at| *at <= before);
            write_over(characters, at.ok_or(NodeFault::Range { input })?, new, input)?;
        }
        (Input::Substitute, Value::String(_)) => return Err(NodeFault::Range { input }),
        _ => return Err(wrong_kind(input, value)),
    }
    Ok(characters.text.len() as isize - before as isize)
}

/// Writes `new` over the text from `at` on; the text grows if need be.
fn write_over(characters: &mut Characters, at: usize, new: &[u8], input: Input) -> Result<(), NodeFault> {
    if at + new.len() > MAX_STRING {
        return Err(NodeFault::Range { input });
    }
    let mut text = std::mem::take(&mut characters.text).into_vec();
    let end = (at + new.len()).min(text.len());
    text.splice(at..end, new.iter().copied());
    characters.text = text.into();
    Ok(())
}
