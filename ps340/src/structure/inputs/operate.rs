//! Inputs of operate nodes.

use super::value::{FIRST, FOURTH, SECOND, THIRD, boolean, count, integer, number, place, wrong_kind};
use crate::structure::{NodeFault, Operation, operation::MAX_LEVEL};
use protocol::{Value, command::Input};

/// Most frames of a phase of SET RATE and of SET BLINK RATE: half a day. Ours.
pub const MAX_PHASE: u32 = 60 * 60 * 60 * 12;

/// The matrix of a kind, at the first input.
macro_rules! matrix {
    ($kind:ident, $input:expr, $value:expr) => {
        match (first($input)?, $value) {
            (_, Value::$kind(new)) => **new,
            (input, value) => return Err(wrong_kind(input, value)),
        }
    };
}

/// Gives `value` to `input` of an operate node.
pub(super) fn accept(operation: &mut Operation, input: Input, value: &Value, frame: u64) -> Result<(), NodeFault> {
    match operation {
        Operation::Character(m) => *m = matrix!(Matrix2, input, value),
        Operation::Linear(m) => *m = matrix!(Matrix3, input, value),
        Operation::Affine(m) => *m = matrix!(Matrix4x3, input, value),
        Operation::Projective(m) => *m = matrix!(Matrix4, input, value),
        Operation::Translate(by) => *by = place(value, first(input)?)?,
        Operation::Viewport { horizontal, vertical, intensity }
        | Operation::LoadViewport { horizontal, vertical, intensity } => {
            let limits = viewport(first(input)?, value)?;
            (*horizontal, *vertical) = (limits.0, limits.1);
            *intensity = limits.2.or(*intensity);
        }
        Operation::TextSize(size) => *size = text_size(first(input)?, value)?,
        // A colour as F:COLOR makes it is both.
        Operation::Color { hue, saturation } if input == FIRST => match value {
            Value::Vector2(color) => (*hue, *saturation) = (color.x, color.y.clamp(0.0, 1.0)),
            value => *hue = number(value, input)?,
        },
        Operation::Color { saturation, .. } if input == SECOND => *saturation = unit(value, input)?,
        Operation::ColorBlending(saturation) => *saturation = unit(value, first(input)?)?,
        Operation::Contrast(contrast) => *contrast = unit(value, first(input)?)?,
        Operation::Intensity { on, range } => match (first(input)?, value) {
            (_, Value::Boolean(new)) => *on = *new,
            (_, Value::Vector2(new)) => *range = new.to_array(),
            _ => return Err(wrong_kind(input, value)),
        },
        Operation::DepthClipping(on)
        | Operation::Csm(on)
        | Operation::Picking(on)
        | Operation::ExternalRate(on)
        | Operation::Blinking(on)
        | Operation::Plotter(on)
        | Operation::Displays { on, .. }
        | Operation::ConditionalBit { on, .. } => *on = boolean(value, first(input)?)?,
        Operation::PickLocation { center, .. } if input == FIRST => *center = place(value, input)?.truncate(),
        Operation::PickLocation { size, .. } if input == SECOND => {
            *size = place(value, input)?.truncate().abs();
        }
        Operation::LevelOfDetail(level) | Operation::IfLevel { level, .. } => {
            *level = integer(value, first(input)?)?.clamp(0, i32::from(MAX_LEVEL)) as u16;
        }
        Operation::Rate { .. } => rate(operation, input, value, frame)?,
        Operation::BlinkRate(frames) => *frames = count(value, first(input)?)?.clamp(1, MAX_PHASE),
        Operation::Priority(priority) => *priority = integer(value, first(input)?)?,
        Operation::LineTexture { texture, .. } => *texture = count(value, first(input)?)?,
        // Renderings and write-backs ask for more than their node can do: the mass memory takes their messages.
        Operation::Rendering { solid, .. } if input == SECOND => *solid = boolean(value, input)?,
        Operation::Color { .. }
        | Operation::PickLocation { .. }
        | Operation::Rendering { .. }
        | Operation::WriteBack
        | Operation::XformMatrix
        | Operation::XformVector
        | Operation::CancelXform
        | Operation::Font(_)
        | Operation::Orientation(_)
        | Operation::PickIdentifier(_)
        | Operation::ChangeLevelOfDetail(_)
        | Operation::IfBit { .. }
        | Operation::IfPhase(_)
        | Operation::SectioningPlane => return Err(NodeFault::NoSuchInput { input }),
    }
    Ok(())
}

/// `input`, if it is the first.
fn first(input: Input) -> Result<Input, NodeFault> {
    if input == FIRST { Ok(input) } else { Err(NodeFault::NoSuchInput { input }) }
}

/// A number, brought into 0..=1.
fn unit(value: &Value, input: Input) -> Result<f64, NodeFault> {
    Ok(number(value, input)?.clamp(0.0, 1.0))
}

type Limits = ([f64; 2], [f64; 2], Option<[f64; 2]>);

/// The limits in the rows of a 3x3 matrix, or of a 2x2 one without intensity.
fn viewport(input: Input, value: &Value) -> Result<Limits, NodeFault> {
    match value {
        Value::Matrix3(m) => Ok(([m.x_axis.x, m.x_axis.y], [m.y_axis.x, m.y_axis.y], Some([m.z_axis.x, m.z_axis.y]))),
        Value::Matrix2(m) => Ok((m.x_axis.to_array(), m.y_axis.to_array(), None)),
        _ => Err(wrong_kind(input, value)),
    }
}

/// A size, or the size that a 2x2 matrix has: the side of the square that it makes of the unit square. Ours.
fn text_size(input: Input, value: &Value) -> Result<f64, NodeFault> {
    match value {
        Value::Matrix2(m) => Ok(m.determinant().abs().sqrt()),
        _ => number(value, input),
    }
}

/// `<1>` and `<2>` change the phases and let them go on; `<3>`, the state at the beginning, and `<4>`, the frames
/// before it, begin anew. Ours.
fn rate(operation: &mut Operation, input: Input, value: &Value, frame: u64) -> Result<(), NodeFault> {
    let Operation::Rate { rate, since } = operation else { return Err(NodeFault::NoSuchInput { input }) };
    match input {
        FIRST => rate.on = count(value, input)?.min(MAX_PHASE),
        SECOND => rate.off = count(value, input)?.min(MAX_PHASE),
        THIRD => (rate.initial, *since) = (boolean(value, input)?, frame),
        FOURTH => (rate.delay, *since) = (count(value, input)?.min(MAX_PHASE), frame),
        _ => return Err(NodeFault::NoSuchInput { input }),
    }
    Ok(())
}
