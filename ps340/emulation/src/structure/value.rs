//! What the kinds of node have in common as message sinks: their inputs, and values as numbers, switches, positions.

use super::NodeFault;
use crate::port::KindSet;
use glam::DVec3;
use protocol::{Value, command::Input};

/// The first input.
pub(super) const FIRST: Input = Input::Number(1);
/// The second input.
pub(super) const SECOND: Input = Input::Number(2);
/// The third input.
pub(super) const THIRD: Input = Input::Number(3);
/// The fourth input.
pub(super) const FOURTH: Input = Input::Number(4);

/// The kinds of a position in two or three dimensions.
pub(super) const POSITION: KindSet = KindSet::VECTOR2.or(KindSet::VECTOR3);

/// The fault of a message of the wrong kind.
pub(super) fn wrong_kind(input: Input, value: &Value) -> NodeFault {
    NodeFault::Kind { input, kind: value.kind() }
}

/// An integer or a real.
pub(super) fn number(value: &Value, input: Input) -> Result<f64, NodeFault> {
    value.number().ok_or_else(|| wrong_kind(input, value))
}

/// TRUE or FALSE.
pub(super) fn boolean(value: &Value, input: Input) -> Result<bool, NodeFault> {
    if let Value::Boolean(on) = value { Ok(*on) } else { Err(wrong_kind(input, value)) }
}

/// An integer; a real is refused, so that a lost fraction is not overlooked.
pub(super) fn integer(value: &Value, input: Input) -> Result<i32, NodeFault> {
    if let Value::Integer(i) = value { Ok(*i) } else { Err(wrong_kind(input, value)) }
}

/// An integer that is not negative.
pub(super) fn count(value: &Value, input: Input) -> Result<u32, NodeFault> {
    u32::try_from(integer(value, input)?).map_err(|_| NodeFault::Range { input })
}

/// A position in two or three dimensions; z is 0 in two.
pub(super) fn position(value: &Value, input: Input) -> Result<DVec3, NodeFault> {
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
pub(super) fn element(input: Input, len: usize) -> Result<Option<usize>, NodeFault> {
    let index = match input {
        Input::Number(n) => (n as usize).checked_sub(1),
        Input::Last => len.checked_sub(1),
        _ => return Ok(None),
    };
    index.filter(|i| *i < len).map(Some).ok_or(NodeFault::Range { input })
}
