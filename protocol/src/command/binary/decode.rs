//! Binary records to commands.

use super::{FLAG_BLOCK, FLAG_ESTIMATE, FLAG_INTERNAL, FOURTH_BIT, Opcode, PART_POINTS};
use crate::{
    Kind, Name, Value,
    command::{
        MAX_POINTS, MAX_STATEMENT,
        matrix::from_four_by_three,
        parse,
        syntax::{
            Arc, Characters, Command, Destination, Fourth, Initialize, Input, NamePattern, Object, VectorClass,
            VectorList,
        },
    },
    name::is_name_character,
    record::{BinaryError, BinaryProblem, Reader, Witness},
};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

/// Capacity that is reserved when a list begins, whatever length it announces, in vectors.
const INITIAL_CAPACITY: usize = 1 << 16;

/// How many times what was received may be reserved for what was announced. Large, because moving a long list is
/// dear.
const GROWTH: usize = 7;

/// Vectors of each part that are reported to the witness one by one.
const LISTED_POINTS: usize = 4;

/// Makes commands out of the bodies of binary packets.
///
/// It remembers a vector list, or a command as text, that was begun in one packet and goes on in the next.
#[derive(Clone, Debug, Default)]
pub struct BinaryDecoder {
    open: Option<Open>,
}

/// What was begun and not ended.
#[derive(Clone, Debug)]
enum Open {
    List(OpenList),
    Text(Vec<u8>),
}

#[derive(Clone, Debug)]
struct OpenList {
    name: Option<Name>,
    announced: usize,
    list: VectorList,
}

impl BinaryDecoder {
    /// The commands in the body of a packet. An error ends the packet unless the next record can still be found.
    ///
    /// What the iterator did not reach when it is dropped is lost.
    pub fn push<'a>(&'a mut self, body: &'a [u8]) -> Commands<'a> {
        Commands { decoder: self, body, at: 0 }
    }

    /// Whether a vector list or a text was begun and its end is still to come.
    pub fn is_unfinished(&self) -> bool {
        self.open.is_some()
    }

    /// Forgets an unfinished vector list or text.
    pub fn reset(&mut self) {
        self.open = None;
    }

    /// Reads one record of `body` from `at` on and moves `at` past it; none if it completes no command. After an
    /// error `at` is the end of the body, or where the next record can be read.
    ///
    /// # Errors
    /// [`BinaryError`] with the offset in `body`.
    pub fn record<W: Witness>(
        &mut self,
        body: &[u8],
        at: &mut usize,
        witness: &mut W,
    ) -> Result<Option<Command>, BinaryError> {
        let mut reader = Reader::new(body, *at, witness);
        *at = body.len();
        let code = reader.take(1, "opcode")?[0];
        let Some(opcode) = Opcode::from_code(code) else {
            return Err(reader.error(1, "opcode", BinaryProblem::Unknown(code.into())));
        };
        reader.report(1, "opcode", format_args!("{}", opcode.word()));
        match opcode {
            Opcode::VectorsBegin => {
                let begun = begin_list(&mut reader)?;
                *at = reader.at();
                match self.open.replace(Open::List(begun)) {
                    Some(_) => Err(BinaryError { offset: *at, field: "opcode", problem: BinaryProblem::StillOpen }),
                    None => Ok(None),
                }
            }
            Opcode::VectorsPart => match &mut self.open {
                Some(Open::List(open)) => {
                    let result = part(open, &mut reader);
                    if result.is_err() {
                        self.open = None;
                    }
                    result?;
                    *at = reader.at();
                    Ok(None)
                }
                // Without the list its class is not known, and so neither is the length of the part.
                _ => {
                    self.open = None;
                    Err(reader.error(1, "opcode", BinaryProblem::NotOpen))
                }
            },
            Opcode::VectorsEnd => {
                *at = reader.at();
                let Some(Open::List(open)) = self.open.take() else {
                    return Err(reader.error(1, "opcode", BinaryProblem::NotOpen));
                };
                let (announced, received) = (open.announced, open.list.points.len());
                if announced != received {
                    return Err(reader.error(1, "opcode", BinaryProblem::Count { announced, received }));
                }
                Ok(Some(Command::Define { name: open.name, object: Object::VectorList(open.list) }))
            }
            Opcode::Text if !matches!(self.open, Some(Open::List(_))) => self.text(&mut reader, at),
            // What is still open is given up; the record itself is good and is read again.
            _ if self.open.take().is_some() => {
                *at = reader.at() - 1;
                Err(reader.error(1, "opcode", BinaryProblem::StillOpen))
            }
            opcode => {
                let command = single(opcode, &mut reader)?;
                *at = reader.at();
                Ok(Some(command))
            }
        }
    }

    /// Reads a part of a command as text, and parses the text if it is the last.
    fn text<W: Witness>(
        &mut self,
        reader: &mut Reader<'_, '_, W>,
        at: &mut usize,
    ) -> Result<Option<Command>, BinaryError> {
        let mut text = match self.open.take() {
            Some(Open::Text(text)) => text,
            _ => Vec::new(),
        };
        let more = reader.boolean("more follows")?;
        let part = reader.string("text")?;
        let (before, found) = (text.len(), text.len() + part.len());
        if found > MAX_STATEMENT {
            return Err(reader.error(part.len(), "text", BinaryProblem::TooMany { found, limit: MAX_STATEMENT }));
        }
        text.extend_from_slice(part);
        *at = reader.at();
        if more {
            self.open = Some(Open::Text(text));
            return Ok(None);
        }
        parse(&text).map(Some).map_err(|error| {
            // The position in this packet, if it is in the last part.
            let offset = *at - part.len() + error.span.start.saturating_sub(before);
            BinaryError { offset, field: "text", problem: BinaryProblem::Text(error.to_string()) }
        })
    }
}

/// The commands in the body of one packet.
#[derive(Debug)]
pub struct Commands<'a> {
    decoder: &'a mut BinaryDecoder,
    body: &'a [u8],
    at: usize,
}

impl Iterator for Commands<'_> {
    type Item = Result<Command, BinaryError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.at < self.body.len() {
            let result = self.decoder.record(self.body, &mut self.at, &mut ());
            if let Some(item) = result.transpose() {
                return Some(item);
            }
        }
        None
    }
}

fn begin_list<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<OpenList, BinaryError> {
    let unknown = |code: u8| BinaryProblem::Unknown(code.into());
    let name = reader.optional_name("name")?;
    let flags = reader.u8("flags")?;
    let fourth = Fourth::ALL.get(usize::from(flags >> FOURTH_BIT)).copied();
    let fourth = fourth.ok_or_else(|| reader.error(1, "flags", unknown(flags)))?;
    let code = reader.u8("class")?;
    let class = VectorClass::from_code(code).ok_or_else(|| reader.error(1, "class", unknown(code)))?;
    let dimension = reader.u8("dimension")?;
    if !(2..=3).contains(&dimension) {
        return Err(reader.error(1, "dimension", unknown(dimension)));
    }
    let estimate = reader.u32("estimate")?;
    let announced = reader.u32("count")? as usize;
    if announced > MAX_POINTS {
        let problem = BinaryProblem::TooMany { found: announced, limit: MAX_POINTS };
        return Err(reader.error(4, "count", problem));
    }
    let list = VectorList {
        block_normalized: flags & FLAG_BLOCK != 0,
        fourth,
        internal_units: flags & FLAG_INTERNAL != 0,
        class,
        dimension,
        estimate: (flags & FLAG_ESTIMATE != 0).then_some(estimate),
        points: Vec::with_capacity(announced.min(INITIAL_CAPACITY)),
        lines: Vec::new(),
    };
    Ok(OpenList { name, announced, list })
}

/// Appends a part to an open list.
fn part<W: Witness>(open: &mut OpenList, reader: &mut Reader<'_, '_, W>) -> Result<(), BinaryError> {
    let count = usize::from(reader.u16("count")?);
    let list = &mut open.list;
    let limit = PART_POINTS.min(open.announced - list.points.len());
    if count > limit {
        return Err(reader.error(2, "count", BinaryProblem::TooMany { found: count, limit }));
    }
    let flags: &[u8] = if list.class == VectorClass::Itemized {
        let flags = reader.take(count.div_ceil(8), "line flags")?;
        reader.report(flags.len(), "line flags", format_args!("bit 0 of the first byte for the first vector"));
        flags
    } else {
        &[]
    };
    let bytes = reader.take(count * POINT, "vectors")?;
    let first = list.points.len();
    if list.points.capacity() < first + count {
        list.points.reserve_exact(count.max((first * GROWTH).min(open.announced - first)));
    }
    list.points.extend(bytes.as_chunks::<POINT>().0.iter().map(|chunk| {
        let components: [[u8; 4]; 4] = bytemuck::cast(*chunk);
        components.map(f32::from_le_bytes)
    }));
    let points = &mut list.points[first..];
    if list.dimension == 2 {
        points.iter_mut().for_each(|point| point[2] = 0.0);
    }
    if !all_finite(points) {
        let at = points.iter().position(|point| !point.iter().all(|c| c.is_finite())).unwrap_or(0);
        return Err(reader.error((count - at) * POINT, "vectors", BinaryProblem::NotFinite));
    }
    let told = count.min(LISTED_POINTS);
    let place = reader.at() - bytes.len();
    let word = match list.fourth {
        Fourth::Intensity => "intensity",
        Fourth::Hue => "hue",
        Fourth::Table => "table index",
    };
    for (index, [x, y, z, i]) in points[..told].iter().enumerate() {
        reader.report_at(place + index * POINT, POINT, "vector", format_args!("{x}, {y}, {z}, {word} {i}"));
    }
    if count > told {
        let rest = (count - told) * POINT;
        reader.report(rest, "vectors", format_args!("{} more", count - told));
    }
    if list.class == VectorClass::Itemized {
        list.lines.resize(first + count, false);
        for (lines, flags) in list.lines[first..].chunks_mut(8).zip(flags) {
            lines.iter_mut().enumerate().for_each(|(bit, line)| *line = flags >> bit & 1 != 0);
        }
    }
    Ok(())
}

/// Bytes of a vector: four single-precision reals.
const POINT: usize = 16;

/// Whether no component is infinite or not a number; without a branch, so that it runs on whole vectors.
fn all_finite(points: &[[f32; 4]]) -> bool {
    const EXPONENT: u32 = 0x7f80_0000;
    let bad = |component: &f32| u32::from(component.to_bits() & EXPONENT == EXPONENT);
    points.as_flattened().iter().fold(0, |any, component| any | bad(component)) == 0
}

/// A command that is one record.
fn single<W: Witness>(opcode: Opcode, reader: &mut Reader<'_, '_, W>) -> Result<Command, BinaryError> {
    Ok(match opcode {
        Opcode::EndStructure => Command::EndStructure,
        Opcode::Display => Command::Display(reader.name("name")?),
        Opcode::Remove => Command::Remove(reader.name("name")?),
        Opcode::Include => Command::Include { name: reader.name("name")?, into: reader.name("into")? },
        Opcode::RemoveFrom => Command::RemoveFrom { name: reader.name("name")?, from: reader.name("from")? },
        Opcode::Forget => Command::Forget(reader.name("name")?),
        Opcode::Delete => {
            let count = reader.u16("count")?;
            let patterns = (0..count).map(|_| pattern(reader)).collect::<Result<_, _>>()?;
            Command::Delete(patterns)
        }
        Opcode::Initialize => Command::Initialize(match reader.u8("what")? {
            0 => Initialize::All,
            1 => Initialize::Connections,
            2 => Initialize::Displays,
            3 => Initialize::Names,
            other => return Err(reader.error(1, "what", BinaryProblem::Unknown(other.into()))),
        }),
        Opcode::Connect => {
            let source = reader.name("source")?;
            let output = reader.u16("output")?;
            if output == 0 {
                return Err(reader.error(2, "output", BinaryProblem::Unknown(0)));
            }
            Command::Connect(Arc { source, output, destination: destination(reader)? })
        }
        Opcode::Disconnect => {
            let source = reader.name("source")?;
            let output = Some(reader.u16("output, 0 for all")?).filter(|output| *output != 0);
            let destination = if reader.boolean("destination given")? { Some(destination(reader)?) } else { None };
            Command::Disconnect { source, output, destination }
        }
        Opcode::Send => {
            let destination = destination(reader)?;
            Command::Send { value: value(reader)?, destination }
        }
        opcode => {
            let name = reader.optional_name("name")?;
            Command::Define { name, object: object(opcode, reader)? }
        }
    })
}

fn pattern<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<NamePattern, BinaryError> {
    if !reader.boolean("prefix")? {
        return Ok(NamePattern::Name(reader.name("name")?));
    }
    let prefix = reader.string("prefix")?;
    match prefix.iter().find(|b| !is_name_character(**b)) {
        Some(bad) => Err(reader.error(prefix.len(), "prefix", BinaryProblem::Unknown((*bad).into()))),
        None => Ok(NamePattern::Prefix(String::from_utf8_lossy(prefix).to_ascii_uppercase())),
    }
}

fn destination<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<Destination, BinaryError> {
    let code = reader.i64("input")?;
    let input = Input::from_code(code).ok_or_else(|| reader.error(8, "input", BinaryProblem::Unknown(code)))?;
    Ok(Destination { input, name: reader.name("name")? })
}

fn matrix4x3<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<DMat4, BinaryError> {
    Ok(from_four_by_three(&reader.reals("row by row")?))
}

fn value<W: Witness>(reader: &mut Reader<'_, '_, W>) -> Result<Value, BinaryError> {
    let code = reader.take(1, "kind")?[0];
    let Some(&kind) = Kind::ALL.get(usize::from(code)) else {
        return Err(reader.error(1, "kind", BinaryProblem::Unknown(code.into())));
    };
    reader.report(1, "kind", format_args!("{kind}"));
    Ok(match kind {
        Kind::Boolean => Value::Boolean(reader.boolean("value")?),
        Kind::Integer => Value::Integer(reader.i32("value")?),
        Kind::Real => Value::Real(reader.f64("value")?),
        Kind::String => Value::string(reader.string("value")?),
        Kind::Vector2 => Value::Vector2(DVec2::from_array(reader.reals("component")?)),
        Kind::Vector3 => Value::Vector3(DVec3::from_array(reader.reals("component")?)),
        Kind::Vector4 => Value::Vector4(DVec4::from_array(reader.reals("component")?)),
        Kind::Matrix2 => Value::Matrix2(Box::new(DMat2::from_cols_array(&reader.reals("row by row")?))),
        Kind::Matrix3 => Value::Matrix3(Box::new(DMat3::from_cols_array(&reader.reals("row by row")?))),
        Kind::Matrix4x3 => Value::Matrix4x3(Box::new(matrix4x3(reader)?)),
        Kind::Matrix4 => Value::Matrix4(Box::new(DMat4::from_cols_array(&reader.reals("row by row")?))),
        Kind::Transform => Value::Transform(Box::new(DMat4::from_cols_array(&reader.reals("row by row")?))),
        // Only functions make these.
        Kind::Pick | Kind::Label | Kind::Vectors => {
            return Err(reader.error(1, "kind", BinaryProblem::Unknown(code.into())));
        }
    })
}

/// The fields after the name of a definition.
fn object<W: Witness>(opcode: Opcode, reader: &mut Reader<'_, '_, W>) -> Result<Object, BinaryError> {
    Ok(match opcode {
        Opcode::Nil => Object::Nil,
        Opcode::BeginStructure => Object::BeginStructure,
        Opcode::Instance => {
            let count = reader.u16("count")?;
            Object::Instance((0..count).map(|_| reader.name("descendant")).collect::<Result<_, _>>()?)
        }
        Opcode::Characters => Object::Characters(Characters {
            position: DVec3::from_array(reader.reals("position")?),
            step: DVec2::from_array(reader.reals("step")?),
            text: reader.string("text")?.into(),
        }),
        Opcode::Function => {
            let function = reader.name("type")?;
            let given = reader.boolean("size given")?;
            let size = reader.u16("size")?;
            Object::Function { function, size: given.then_some(size) }
        }
        Opcode::Operate(kind) => {
            let applied_to = reader.optional_name("applied to")?;
            Object::Operate { operate: kind.decode(reader)?, applied_to }
        }
        other => return Err(reader.error(1, "opcode", BinaryProblem::Unknown(other.code().into()))),
    })
}
