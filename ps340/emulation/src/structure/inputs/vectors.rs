//! Inputs of vector lists.

use crate::structure::{
    NodeFault,
    value::{boolean, count, element, wrong_kind},
};
use protocol::{
    Value,
    command::{Fourth, Input, VectorClass, VectorList},
};

/// Gives `value` to `input` of a vector list; returns by how many bytes it grew.
pub(super) fn accept(list: &mut VectorList, input: Input, value: &Value) -> Result<isize, NodeFault> {
    let before = bytes(list);
    match input {
        Input::Append => {
            let point = point(value, list, input, None)?;
            push(list, point, true);
        }
        Input::Delete => {
            let keep = list.points.len().saturating_sub(count(value, input)? as usize);
            list.points.truncate(keep);
            list.lines.truncate(keep);
        }
        Input::Clear => {
            list.points.clear();
            list.lines.clear();
        }
        Input::Step | Input::Position | Input::Substitute => return Err(NodeFault::NoSuchInput { input }),
        Input::Number(_) | Input::Last => {
            let index = element(input, list.points.len())?.ok_or(NodeFault::NoSuchInput { input })?;
            match value {
                Value::Boolean(_) => mark_range(list, index..index + 1, boolean(value, input)?, input)?,
                _ => list.points[index] = point(value, list, input, Some(list.points[index][3]))?,
            }
        }
    }
    Ok(bytes(list) - before)
}

/// SEND number*mode: marks `count` vectors from the one that `input` names as lines or positions; returns by how
/// many bytes the list grew.
///
/// # Errors
/// A range that is not all inside the list, an input that names no vector; a list of dots has neither lines nor
/// positions.
pub fn mark(list: &mut VectorList, input: Input, count: u32, lines: bool) -> Result<isize, NodeFault> {
    let before = bytes(list);
    let start = element(input, list.points.len())?.ok_or(NodeFault::NoSuchInput { input })?;
    let end = start.saturating_add(count as usize);
    if end > list.points.len() {
        return Err(NodeFault::Range { input });
    }
    mark_range(list, start..end, lines, input)?;
    Ok(bytes(list) - before)
}

/// SEND VL: the vectors of `source` take the positions from `input` on, or come after the last for `<append>`; the
/// list grows if need be. Returns by how many bytes it grew.
///
/// # Errors
/// A position past the one after the last, an input that names no position.
pub fn overwrite(list: &mut VectorList, input: Input, source: &VectorList) -> Result<isize, NodeFault> {
    let before = bytes(list);
    let len = list.points.len();
    let start = match input {
        Input::Append => len,
        Input::Last => len.checked_sub(1).ok_or(NodeFault::Range { input })?,
        Input::Number(n) => (n as usize).checked_sub(1).filter(|i| *i <= len).ok_or(NodeFault::Range { input })?,
        _ => return Err(NodeFault::NoSuchInput { input }),
    };
    // Lists whose class says the same of every vector keep it, others say it of each.
    if list.class != source.class || list.class == VectorClass::Separate {
        itemize(list);
    }
    for (offset, point) in source.points.iter().enumerate() {
        let mut point = *point;
        if list.dimension == 2 {
            point[2] = 0.0;
        }
        let line = source.is_line(offset);
        match list.points.get_mut(start + offset) {
            Some(place) => *place = point,
            None => push(list, point, line),
        }
        if list.class == VectorClass::Itemized {
            list.lines[start + offset] = line;
        }
    }
    Ok(bytes(list) - before)
}

fn bytes(list: &VectorList) -> isize {
    (size_of_val(list.points.as_slice()) + list.lines.len()) as isize
}

fn push(list: &mut VectorList, point: [f32; 4], line: bool) {
    list.points.push(point);
    if list.class == VectorClass::Itemized {
        list.lines.push(line);
    }
}

fn mark_range(list: &mut VectorList, range: std::ops::Range<usize>, line: bool, input: Input) -> Result<(), NodeFault> {
    if list.class == VectorClass::Dots {
        return Err(NodeFault::Dots { input });
    }
    itemize(list);
    list.lines[range].fill(line);
    Ok(())
}

/// Makes the list mark for each vector whether it is a line.
fn itemize(list: &mut VectorList) {
    if list.class != VectorClass::Itemized {
        list.lines = (0..list.points.len()).map(|i| list.is_line(i)).collect();
        list.class = VectorClass::Itemized;
    }
}

/// The components of a vector for `list`: a 2D vector gets z = 0, a 2D list drops z. The fourth component is that
/// of a 4D vector, else the one that the vector had, else the default of the list.
fn point(value: &Value, list: &VectorList, input: Input, fourth: Option<f32>) -> Result<[f32; 4], NodeFault> {
    let default = if list.fourth == Fourth::Intensity { 1.0 } else { 0.0 };
    let kept = f64::from(fourth.unwrap_or(default));
    let (v, fourth) = match value {
        Value::Vector2(v) => (v.extend(0.0), kept),
        Value::Vector3(v) => (*v, kept),
        Value::Vector4(v) => (v.truncate(), v.w),
        _ => return Err(wrong_kind(input, value)),
    };
    let z = if list.dimension == 3 { v.z } else { 0.0 };
    let point = [v.x as f32, v.y as f32, z as f32, fourth as f32];
    if point.iter().all(|c| c.is_finite()) { Ok(point) } else { Err(NodeFault::Range { input }) }
}
