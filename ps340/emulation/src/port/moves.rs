//! Moves of messages between the slots where they lie.
//!
//! A [`Value`] is large, and most are reals. A real that goes where a real lay before is one store of 8 bytes. To move
//! a whole value would make the processor wait, since it would load as one what was stored in pieces: the kind and
//! the number. So each kind moves for itself, and what is of no use any more stays where it is, unless it holds more
//! memory than a 4x4 matrix.

use glam::DMat4;
use protocol::Value;

/// The placeholder that lies where a message was taken out.
pub(super) const PLACEHOLDER: Value = Value::Boolean(false);

/// Moves a message from one slot to another. What stays behind is of no use.
#[inline(always)]
pub(super) fn shift(from: &mut Value, to: &mut Value) {
    match (from, to) {
        (Value::Real(new), Value::Real(old)) => *old = *new,
        // The memory of the old matrix goes the other way, to be used again.
        (Value::Matrix4(new), Value::Matrix4(old)) => std::mem::swap(new, old),
        (Value::Matrix4(new), to) => shift_matrix(new, to),
        (from, to) => shift_any(from, to),
    }
}

/// Puts a real into a slot.
#[inline(always)]
pub(super) fn put_real(number: f64, to: &mut Value) {
    match to {
        Value::Real(old) => *old = number,
        to => *to = Value::Real(number),
    }
}

/// Moves a matrix to a slot where none lay before. New memory stays behind, for the next one.
#[cold]
fn shift_matrix(from: &mut Box<DMat4>, to: &mut Value) {
    *to = Value::Matrix4(std::mem::take(from));
}

/// Moves a message of any kind.
#[inline(never)]
fn shift_any(from: &mut Value, to: &mut Value) {
    match from {
        Value::Boolean(truth) => *to = Value::Boolean(*truth),
        Value::Integer(number) => *to = Value::Integer(*number),
        Value::Real(number) => *to = Value::Real(*number),
        Value::Vector2(vector) => *to = Value::Vector2(*vector),
        Value::Vector3(vector) => *to = Value::Vector3(*vector),
        Value::Vector4(vector) => *to = Value::Vector4(*vector),
        from => *to = std::mem::replace(from, PLACEHOLDER),
    }
}

/// Frees the memory of a message that is of no use any more. That of a 4x4 matrix stays for the next one.
#[inline(always)]
pub(super) fn clear(place: &mut Value) {
    let plain = matches!(
        place,
        Value::Real(_)
            | Value::Integer(_)
            | Value::Boolean(_)
            | Value::Vector2(_)
            | Value::Vector3(_)
            | Value::Vector4(_)
            | Value::Matrix4(_)
    );
    if !plain {
        *place = PLACEHOLDER;
    }
}
