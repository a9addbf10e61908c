//! The header of a polygon file.

use super::super::error::shortened;
use super::super::{Fault, FaultLocation, MeshProblem};

/// The most elements, and the most properties of an element, that a header may declare.
const MAX_DECLARED: usize = 1000;

/// The encoding of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// What a header says.
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<PlyElement>,
    /// Bytes of the header, and so where the tables begin.
    pub bytes: usize,
    /// Lines of the header.
    pub lines: usize,
    /// Names of surfaces.
    pub surfaces: Vec<String>,
}

/// A table.
pub(super) struct PlyElement {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

/// A column of a table.
pub(super) struct Property {
    pub name: String,
    pub scalar: Scalar,
    /// The type of the length, if the property is a list.
    pub length: Option<Scalar>,
}

/// Reads the header at the beginning of `bytes`.
pub(super) fn parse(bytes: &[u8]) -> Result<Header, Fault> {
    let mut header =
        Header { encoding: Encoding::Text, elements: Vec::new(), bytes: 0, lines: 0, surfaces: Vec::new() };
    let mut has_format = false;
    while header.bytes < bytes.len() {
        let rest = &bytes[header.bytes..];
        let length = rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |end| end + 1);
        header.bytes += length;
        header.lines += 1;
        let place = FaultLocation::Line(header.lines);
        let text = String::from_utf8_lossy(&rest[..length]);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let expected = |expected| place.fault(MeshProblem::Expected { expected, found: shortened(text.trim()) });
        match words[..] {
            ["ply"] if header.lines == 1 => {}
            _ if header.lines == 1 => return Err(expected("ply")),
            ["end_header"] if !has_format => return Err(expected("format before end_header")),
            ["end_header"] => return Ok(header),
            ["format", format, "1.0"] => {
                has_format = true;
                header.encoding = match format {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return Err(expected("ascii, binary_little_endian or binary_big_endian")),
                };
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| expected("element NAME COUNT"))?;
                header.elements.push(PlyElement { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref declaration @ ..] => {
                let property = property(declaration).map_err(|problem| place.fault(problem))?;
                let element = header.elements.last_mut().ok_or_else(|| expected("element before property"))?;
                element.properties.push(property);
            }
            ["comment", "surface", number, ref name @ ..] => {
                if number.parse() == Ok(header.surfaces.len()) {
                    header.surfaces.push(name.join(" "));
                }
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(expected("format, element, property, comment or end_header")),
        }
        let declared = header.elements.last().map_or(0, |element| element.properties.len()).max(header.elements.len());
        if declared > MAX_DECLARED {
            let (count, limit) = (declared as u64, MAX_DECLARED as u64);
            return Err(place.fault(MeshProblem::TooMany { what: "declarations", count, limit }));
        }
    }
    Err(FaultLocation::Line(header.lines + 1).fault(MeshProblem::Ends("end_header")))
}

fn property(words: &[&str]) -> Result<Property, MeshProblem> {
    match *words {
        ["list", length, item, name] => {
            Ok(Property { name: name.to_owned(), scalar: scalar(item)?, length: Some(scalar(length)?) })
        }
        [item, name] => Ok(Property { name: name.to_owned(), scalar: scalar(item)?, length: None }),
        _ => {
            let expected = "property TYPE NAME or property list TYPE TYPE NAME";
            Err(MeshProblem::Expected { expected, found: shortened(&words.join(" ")) })
        }
    }
}

fn scalar(word: &str) -> Result<Scalar, MeshProblem> {
    match word {
        "char" | "int8" => Ok(Scalar::I8),
        "uchar" | "uint8" => Ok(Scalar::U8),
        "short" | "int16" => Ok(Scalar::I16),
        "ushort" | "uint16" => Ok(Scalar::U16),
        "int" | "int32" => Ok(Scalar::I32),
        "uint" | "uint32" => Ok(Scalar::U32),
        "float" | "float32" => Ok(Scalar::F32),
        "double" | "float64" => Ok(Scalar::F64),
        _ => Err(MeshProblem::Expected { expected: "a number type", found: shortened(word) }),
    }
}
