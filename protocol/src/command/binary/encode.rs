//! Commands to binary records.

use super::{FLAG_BLOCK, FLAG_ESTIMATE, FLAG_INTERNAL, FOURTH_BIT, Opcode, PART_POINTS, PART_TEXT};
use crate::{
    Name, Value,
    command::{
        MAX_POINTS, MAX_STATEMENT, MAX_TEXT,
        matrix::four_by_three,
        print::print,
        syntax::{Arc, Command, Destination, Initialize, NamePattern, Object, VectorClass, VectorList},
    },
    record::{EncodeError, MAX_RECORD, Writer, within},
};

/// Appends all records of a command.
///
/// # Errors
/// [`EncodeError`] if the command exceeds a limit of the records; `out` is then as it was.
pub fn encode(command: &Command, out: &mut Vec<u8>) -> Result<(), EncodeError> {
    let before = out.len();
    let result = records(command, &mut Vec::new(), &mut |record| out.extend_from_slice(record));
    if result.is_err() {
        out.truncate(before);
    }
    result
}

/// Gives the records of a command to `emit`, one after the other; `scratch` is overwritten.
///
/// # Errors
/// [`EncodeError`] if the command exceeds a limit of the records; nothing was emitted then.
pub fn records(command: &Command, scratch: &mut Vec<u8>, emit: &mut dyn FnMut(&[u8])) -> Result<(), EncodeError> {
    records_in_parts(command, PART_POINTS, scratch, emit)
}

/// Gives the records of a command as [`records`] does, with at most `part_points` vectors in a part (at least 1, at
/// most [`PART_POINTS`]), for packets that hold no more.
///
/// # Errors
/// Those of [`records`].
pub fn records_in_parts(
    command: &Command,
    part_points: usize,
    scratch: &mut Vec<u8>,
    emit: &mut dyn FnMut(&[u8]),
) -> Result<(), EncodeError> {
    scratch.clear();
    if let Command::Define { name, object: Object::VectorList(list) } = command {
        return vector_list(name.as_ref(), list, part_points.clamp(1, PART_POINTS), scratch, emit);
    }
    if !single(command, &mut Writer::new(scratch))? {
        return text(command, scratch, emit);
    }
    within("the record", scratch.len(), MAX_RECORD)?;
    emit(scratch);
    Ok(())
}

/// A command that has no record of its own, as text.
fn text(command: &Command, scratch: &mut Vec<u8>, emit: &mut dyn FnMut(&[u8])) -> Result<(), EncodeError> {
    if let Command::Define { object: Object::Labels(labels), .. } = command {
        for label in &labels.labels {
            within("the text of a label", label.text.len(), MAX_TEXT)?;
        }
    }
    let mut printed = Vec::new();
    print(command, &mut printed);
    within("the text", printed.len(), MAX_STATEMENT)?;
    let mut parts = printed.chunks(PART_TEXT).peekable();
    while let Some(part) = parts.next() {
        scratch.clear();
        let mut writer = Writer::new(scratch);
        writer.u8(Opcode::Text.code());
        writer.u8(parts.peek().is_some().into());
        writer.string("a part of the text", part)?;
        emit(scratch);
    }
    Ok(())
}

fn vector_list(
    name: Option<&Name>,
    list: &VectorList,
    part_points: usize,
    scratch: &mut Vec<u8>,
    emit: &mut dyn FnMut(&[u8]),
) -> Result<(), EncodeError> {
    within("the number of vectors", list.points.len(), MAX_POINTS)?;
    let mut writer = Writer::new(scratch);
    writer.u8(Opcode::VectorsBegin.code());
    writer.optional_name(name);
    let block = if list.block_normalized { FLAG_BLOCK } else { 0 };
    let estimate = if list.estimate.is_some() { FLAG_ESTIMATE } else { 0 };
    let internal = if list.internal_units { FLAG_INTERNAL } else { 0 };
    writer.u8(block | estimate | internal | (list.fourth as u8) << FOURTH_BIT);
    writer.u8(list.class.code());
    writer.u8(list.dimension);
    writer.u32(list.estimate.unwrap_or(0));
    writer.u32(list.points.len() as u32);
    emit(scratch);
    for (index, points) in list.points.chunks(part_points).enumerate() {
        scratch.clear();
        let mut writer = Writer::new(scratch);
        writer.u8(Opcode::VectorsPart.code());
        writer.u16(points.len() as u16);
        if list.class == VectorClass::Itemized {
            let first = (index * part_points).min(list.lines.len());
            let lines = &list.lines[first..list.lines.len().min(first + points.len())];
            let mut flags = vec![0_u8; points.len().div_ceil(8)];
            for (flags, lines) in flags.iter_mut().zip(lines.chunks(8)) {
                *flags = lines.iter().rev().fold(0, |bits, line| bits << 1 | u8::from(*line)); // the first is bit 0
            }
            writer.bytes(&flags);
        }
        if cfg!(target_endian = "little") {
            writer.bytes(bytemuck::cast_slice(points));
        } else {
            points.iter().flatten().for_each(|component| writer.bytes(&component.to_le_bytes()));
        }
        emit(scratch);
    }
    emit(&[Opcode::VectorsEnd.code()]);
    Ok(())
}

/// Writes a command that is one record; false, and nothing is written, if it has none of its own.
fn single(command: &Command, writer: &mut Writer<'_>) -> Result<bool, EncodeError> {
    match command {
        Command::Define { name, object } => return definition(name.as_ref(), object, writer),
        Command::EndStructure => writer.u8(Opcode::EndStructure.code()),
        Command::Display(name) => names(Opcode::Display, &[name], writer),
        Command::Remove(name) => names(Opcode::Remove, &[name], writer),
        Command::Include { name, into } => names(Opcode::Include, &[name, into], writer),
        Command::RemoveFrom { name, from } => names(Opcode::RemoveFrom, &[name, from], writer),
        Command::Forget(name) => names(Opcode::Forget, &[name], writer),
        Command::Delete(patterns) => {
            writer.u8(Opcode::Delete.code());
            count("the number of patterns", patterns.len(), writer)?;
            for pattern in patterns {
                let (kind, text) = match pattern {
                    NamePattern::Name(name) => (0, name.as_str()),
                    NamePattern::Prefix(prefix) => (1, prefix.as_str()),
                };
                writer.u8(kind);
                writer.string("a pattern", text.as_bytes())?;
            }
        }
        Command::Initialize(what) => {
            writer.u8(Opcode::Initialize.code());
            writer.u8(match what {
                Initialize::All => 0,
                Initialize::Connections => 1,
                Initialize::Displays => 2,
                Initialize::Names => 3,
            });
        }
        Command::Connect(Arc { source, output, destination: to }) => {
            names(Opcode::Connect, &[source], writer);
            writer.u16(*output);
            destination(to, writer);
        }
        Command::Disconnect { source, output, destination: to } => {
            names(Opcode::Disconnect, &[source], writer);
            writer.u16(output.unwrap_or(0));
            match to {
                Some(to) => {
                    writer.u8(1);
                    destination(to, writer);
                }
                None => writer.u8(0),
            }
        }
        Command::Send { value, destination: to } => {
            writer.u8(Opcode::Send.code());
            destination(to, writer);
            send_value(value, writer)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

fn names(opcode: Opcode, names: &[&Name], writer: &mut Writer<'_>) {
    writer.u8(opcode.code());
    names.iter().for_each(|name| writer.name(name));
}

fn count(what: &'static str, count: usize, writer: &mut Writer<'_>) -> Result<(), EncodeError> {
    within(what, count, u16::MAX.into())?;
    writer.u16(count as u16);
    Ok(())
}

fn destination(destination: &Destination, writer: &mut Writer<'_>) {
    writer.bytes(&destination.input.code().to_le_bytes());
    writer.name(&destination.name);
}

fn send_value(value: &Value, writer: &mut Writer<'_>) -> Result<(), EncodeError> {
    writer.u8(value.kind() as u8);
    match value {
        Value::Boolean(b) => writer.u8((*b).into()),
        Value::Integer(i) => writer.bytes(&i.to_le_bytes()),
        Value::Real(r) => writer.reals(&[*r]),
        Value::String(text) => writer.string("the text", text)?,
        Value::Vector2(v) => writer.reals(&v.to_array()),
        Value::Vector3(v) => writer.reals(&v.to_array()),
        Value::Vector4(v) => writer.reals(&v.to_array()),
        Value::Matrix2(m) => writer.reals(&m.to_cols_array()),
        Value::Matrix3(m) => writer.reals(&m.to_cols_array()),
        Value::Matrix4x3(m) => writer.reals(&four_by_three(m)),
        Value::Matrix4(m) | Value::Transform(m) => writer.reals(&m.to_cols_array()),
        Value::Pick(_) => return within("pick lists, which no command sends", 1, 0),
        Value::Label(_) => return within("labels, which no command sends", 1, 0),
        Value::Vectors(_) => return within("transformed vectors, which no command sends", 1, 0),
    }
    Ok(())
}

/// A definition that is one record; false if it has none of its own.
fn definition(name: Option<&Name>, object: &Object, writer: &mut Writer<'_>) -> Result<bool, EncodeError> {
    let opcode = match object {
        Object::Nil => Opcode::Nil,
        Object::BeginStructure => Opcode::BeginStructure,
        Object::Instance(_) => Opcode::Instance,
        Object::Characters(_) => Opcode::Characters,
        Object::Function { .. } => Opcode::Function,
        Object::Operate { operate, .. } if operate.kind().code().is_some() => Opcode::Operate(operate.kind()),
        _ => return Ok(false),
    };
    writer.u8(opcode.code());
    writer.optional_name(name);
    match object {
        Object::Instance(names) => {
            count("the number of names", names.len(), writer)?;
            names.iter().for_each(|name| writer.name(name));
        }
        Object::Characters(characters) => {
            writer.reals(&characters.position.to_array());
            writer.reals(&characters.step.to_array());
            writer.string("the text", &characters.text)?;
        }
        Object::Function { function, size } => {
            writer.name(function);
            writer.u8(size.is_some().into());
            writer.u16(size.unwrap_or(0));
        }
        Object::Operate { operate, applied_to } => {
            writer.optional_name(applied_to.as_ref());
            operate.encode(writer);
        }
        // NIL and BEGIN_STRUCTURE have a name only.
        _ => {}
    }
    Ok(true)
}
