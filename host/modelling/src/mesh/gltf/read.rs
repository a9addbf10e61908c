//! The document of a glTF file, and its buffers.

use serde_json::Value;

use super::super::groups::Grouped;
use super::super::placed::PlacedMeshes;
use super::super::{Fault, FaultLocation, MeshProblem};
use super::accessor::Buffers;
use super::document::LocatedValue;
use super::meshes::MeshReader;
use super::nodes::INSTANCING;
use super::{BINARY_CHUNK, JSON_CHUNK, MAGIC, base64};
use crate::memory;

/// Bytes of an object of JSON, which has room for eleven members, and of another value.
const OBJECT_BYTES: u64 = 640;
const VALUE_BYTES: u64 = 32;
/// Extensions that are followed, or without which the triangles are the same.
const SUPPORTED_EXTENSIONS: [&str; 3] = ["KHR_mesh_quantization", "KHR_texture_transform", INSTANCING];

/// The triangles of a glTF file, text or binary, where they are.
///
/// - `neighbour`: the content of a file beside it, or why there is none.
pub fn parse(bytes: &[u8], neighbour: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<Grouped, Fault> {
    understood(bytes, neighbour, |meshes| meshes.together())
}

/// The meshes of a glTF file, text or binary, and where they are.
///
/// - `neighbour`: the content of a file beside it, or why there is none.
pub fn parse_placed(bytes: &[u8], neighbour: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<PlacedMeshes, Fault> {
    understood(bytes, neighbour, |meshes| meshes.placed())
}

/// What is made of the meshes of a file.
fn understood<T>(
    bytes: &[u8],
    neighbour: &dyn Fn(&str) -> Result<Vec<u8>, String>,
    then: impl FnOnce(MeshReader<'_>) -> Result<T, Fault>,
) -> Result<T, Fault> {
    let (json, binary) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let what = || format!("a document of {} bytes", json.len());
    memory::reserve(document_bytes(json), what).map_err(|excess| FaultLocation::Mesh.fault(excess.into()))?;
    let document: Value = serde_json::from_slice(json).map_err(|error| {
        let problem = MeshProblem::Syntax(error.to_string());
        if binary.is_some() || bytes.starts_with(MAGIC) {
            FaultLocation::Byte(20 + error.column())
        } else {
            FaultLocation::Line(error.line())
        }
        .fault(problem)
    })?;
    let root = LocatedValue::root(&document);
    let version = root.need("asset")?.need("version")?;
    if !version.text()?.starts_with("2.") {
        return Err(version.expected("version 2"));
    }
    for extension in root.list("extensionsRequired")? {
        let name = extension.text()?;
        if !SUPPORTED_EXTENSIONS.contains(&name) && !name.starts_with("KHR_materials_") {
            return Err(extension.expected("no extension that changes meshes"));
        }
    }
    let mut total = json.len();
    let mut buffers = Vec::new();
    for (index, buffer) in root.list("buffers")?.into_iter().enumerate() {
        let content = content_of(buffer, index, binary, neighbour)?;
        total = total.saturating_add(content.len());
        buffers.push(content);
    }
    then(MeshReader::new(Buffers { root, bytes: buffers, total })?)
}

/// About how many bytes a document takes once it is understood: by its objects, and by all else that it lists.
fn document_bytes(json: &[u8]) -> u64 {
    let of = |byte: &u8| match byte {
        b'{' => OBJECT_BYTES,
        b',' => VALUE_BYTES,
        _ => 0,
    };
    json.iter().map(of).sum()
}

/// The JSON and the binary chunk of a binary file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let ends = |at: usize, what| FaultLocation::Byte(at).fault(MeshProblem::Ends(what));
    let word = |at: usize| {
        let field = bytes.get(at..at + 4).and_then(|field| field.try_into().ok());
        field.map(u32::from_le_bytes).ok_or_else(|| ends(bytes.len(), "a header"))
    };
    if word(4)? != 2 {
        return Err(
            FaultLocation::Byte(4).fault(MeshProblem::Expected { expected: "version 2", found: word(4)?.to_string() })
        );
    }
    let mut found = [None, None];
    let mut at = 12;
    while at + 8 <= bytes.len() {
        let length = word(at)? as usize;
        let content = bytes.get(at + 8..).and_then(|rest| rest.get(..length)).ok_or_else(|| ends(at, "a chunk"))?;
        let kind = word(at + 4)?;
        for (slot, wanted) in found.iter_mut().zip([JSON_CHUNK, BINARY_CHUNK]) {
            if kind == wanted && slot.is_none() {
                *slot = Some(content);
            }
        }
        at += 8 + length;
    }
    let [json, binary] = found;
    Ok((json.ok_or_else(|| ends(bytes.len(), "a chunk of JSON"))?, binary))
}

/// The bytes of a buffer.
fn content_of(
    buffer: LocatedValue<'_>,
    index: usize,
    binary: Option<&[u8]>,
    neighbour: &dyn Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Vec<u8>, Fault> {
    let length = buffer.need("byteLength")?.count()?;
    let mut content = match (buffer.get("uri"), binary) {
        (None, Some(binary)) if index == 0 => binary.to_vec(),
        (None, _) => return Err(buffer.need("uri").err().unwrap_or_else(|| buffer.fault(MeshProblem::Missing))),
        (Some(uri), _) => {
            let text = uri.text()?;
            match text.strip_prefix("data:") {
                Some(data) => {
                    let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
                    let encoded = encoded.ok_or_else(|| uri.expected("base64"))?;
                    base64::decode(encoded).map_err(|_| uri.expected("base64"))?
                }
                None => {
                    let name = unescaped(text).ok_or_else(|| uri.expected("a file beside this one"))?;
                    neighbour(&name).map_err(|why| uri.fault(MeshProblem::Neighbour { name, why }))?
                }
            }
        }
    };
    if content.len() < length {
        return Err(buffer.fault(MeshProblem::Outside { length: content.len() }));
    }
    content.truncate(length);
    Ok(content)
}

/// The name of a file in the same folder or below it, without escapes; none for one elsewhere.
fn unescaped(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, behind @ ..] = rest {
        let escaped = (*first == b'%').then(|| behind.get(..2)).flatten();
        let escaped = escaped.and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok());
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &behind[2..] } else { behind };
    }
    let name = String::from_utf8(bytes).ok()?;
    let is_elsewhere =
        name.starts_with(['/', '\\']) || name.contains(':') || name.split(['/', '\\']).any(|p| p == "..");
    (!is_elsewhere).then_some(name)
}
