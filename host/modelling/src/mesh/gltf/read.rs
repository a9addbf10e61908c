//! The triangles of a glTF file.

use glam::{DAffine3, DMat4, DQuat, DVec2, DVec3, DVec4};
use serde_json::Value;

use super::super::fan::strip;
use super::super::groups::{Grouped, Groups, MetallicRoughness};
use super::super::{Fault, FaultLocation, Mesh, MeshProblem};
use super::accessor::Buffers;
use super::document::LocatedValue;
use super::{BINARY_CHUNK, JSON_CHUNK, MAGIC, base64};

/// Extensions without which the triangles are the same, or which need nothing further.
const SUPPORTED_EXTENSIONS: [&str; 2] = ["KHR_mesh_quantization", "KHR_texture_transform"];
/// So many triangles may come of nodes that share meshes, even if the file is small.
const MOST_SHARED: usize = 1 << 22;
/// The deepest tree of nodes.
const MAX_DEPTH: usize = 1000;

/// Understands a glTF file, text or binary.
///
/// - `neighbour`: the content of a file beside it, or why there is none.
pub fn parse(bytes: &[u8], neighbour: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<Grouped, Fault> {
    let (json, binary) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
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
    let mut scene = Scene {
        buffers: Buffers { root, bytes: buffers, total },
        root,
        mesh: Mesh::default(),
        lacks: [false; 2],
        groups: Groups::default(),
        most: total.max(MOST_SHARED),
    };
    scene.collect()?;
    Ok(scene.into_grouped())
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

/// What is read.
struct Scene<'a> {
    buffers: Buffers<'a>,
    root: LocatedValue<'a>,
    mesh: Mesh,
    /// Whether normals or texture coordinates are missing somewhere.
    lacks: [bool; 2],
    groups: Groups,
    /// The most triangles.
    most: usize,
}

impl<'a> Scene<'a> {
    /// Walks over the nodes of the default scene, or of the first one; without any, over all meshes.
    fn collect(&mut self) -> Result<(), Fault> {
        let scene = match self.root.get("scene") {
            Some(at) => Some(at.named(&self.root, "scenes")?),
            None => self.root.element("scenes", 0),
        };
        let Some(scene) = scene else {
            for mesh in self.root.list("meshes")? {
                self.add(mesh, None, &DAffine3::IDENTITY)?;
            }
            return Ok(());
        };
        let mut waiting: Vec<(LocatedValue<'a>, DAffine3, usize)> = Vec::new();
        let mut is_reached = vec![false; self.root.list("nodes")?.len()];
        for at in scene.list("nodes")?.into_iter().rev() {
            waiting.push((at, DAffine3::IDENTITY, 0));
        }
        while let Some((at, to_scene, depth)) = waiting.pop() {
            let node = at.named(&self.root, "nodes")?;
            if depth > MAX_DEPTH || std::mem::replace(&mut is_reached[at.count()?], true) {
                return Err(at.expected("a node that is reached only once"));
            }
            let placed = to_scene * placement(node)?;
            if !placed.is_finite() {
                return Err(node.fault(MeshProblem::NotFinite));
            }
            if let Some(mesh) = node.get("mesh") {
                self.add(mesh.named(&self.root, "meshes")?, node.text_of("name")?, &placed)?;
            }
            for child in node.list("children")?.into_iter().rev() {
                waiting.push((child, placed, depth + 1));
            }
        }
        Ok(())
    }

    /// Adds the triangles of a mesh.
    fn add(&mut self, mesh: LocatedValue<'a>, node: Option<&str>, placement: &DAffine3) -> Result<(), Fault> {
        let own = mesh.text_of("name")?.or(node).unwrap_or_default();
        for primitive in mesh.list("primitives")? {
            let Some(part) = self.primitive(primitive)? else { continue };
            let material = primitive.get("material").map(|at| at.named(&self.root, "materials")).transpose()?;
            let called = material.map(|at| at.text_of("name")).transpose()?.flatten();
            let look = material.map(material_of).transpose()?.flatten();
            let name = [own, called.unwrap_or_default()];
            let name = name.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("/");
            let triangles = self.mesh.triangles.len() + part.triangles.len();
            if triangles > self.most {
                let (count, limit) = (triangles as u64, self.most as u64);
                return Err(mesh.fault(MeshProblem::TooMany { what: "triangles", count, limit }));
            }
            let lacks = [part.corner_normals.is_empty(), part.corner_parameters.is_empty()];
            self.lacks = [0, 1].map(|k| self.lacks[k] || lacks[k] && !part.triangles.is_empty());
            self.mesh.append(&part.transformed(placement), 0);
            if self.mesh.vertices.iter().rev().take(part.vertices.len()).any(|vertex| !vertex.is_finite()) {
                return Err(mesh.fault(MeshProblem::NotFinite));
            }
            self.groups.extend(&name, look, triangles);
        }
        Ok(())
    }

    /// The triangles of a primitive; none if it is made of points or lines.
    fn primitive(&self, primitive: LocatedValue<'a>) -> Result<Option<Mesh>, Fault> {
        let mode = primitive.count_or("mode", 4)?;
        let attributes = primitive.need("attributes")?;
        let Some(position) = attributes.get("POSITION").filter(|_| (4..=6).contains(&mode)) else {
            return Ok(None);
        };
        let vertices: Vec<DVec3> =
            self.buffers.table::<3>(position, "VEC3")?.into_iter().map(DVec3::from_array).collect();
        if vertices.iter().any(|vertex| !vertex.is_finite()) {
            return Err(position.fault(MeshProblem::NotFinite));
        }
        let indices = match primitive.get("indices") {
            Some(at) => self.buffers.indices(at)?,
            None => (0..vertices.len() as u32).collect(),
        };
        let count = vertices.len();
        if let Some(&index) = indices.iter().find(|index| **index as usize >= count) {
            let problem = MeshProblem::Index { index: index.into(), count, table: "vertices" };
            return Err(primitive.get("indices").unwrap_or(primitive).fault(problem));
        }
        let triangles: Vec<[u32; 3]> = match mode {
            4 => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
            5 => strip(&indices).collect(),
            _ => indices.windows(2).skip(1).map(|pair| [pair[0], pair[1], indices[0]]).collect(),
        };
        let mut mesh = Mesh { vertices, triangles, ..Mesh::default() };
        if let Some(at) = attributes.get("NORMAL") {
            let normals = self.buffers.table::<3>(at, "VEC3")?;
            let normal = |normal: &[f64; 3]| DVec3::from_array(*normal).normalize_or_zero();
            mesh.corner_normals = per_corner(&mesh.triangles, &normals, count, normal).ok_or_else(|| short(at))?;
        }
        if let Some(at) = attributes.get("TEXCOORD_0") {
            let parameters = self.buffers.table::<2>(at, "VEC2")?;
            let parameter =
                |uv: &[f64; 2]| Some(DVec2::from_array(*uv)).filter(|uv| uv.is_finite()).unwrap_or_default();
            mesh.corner_parameters =
                per_corner(&mesh.triangles, &parameters, count, parameter).ok_or_else(|| short(at))?;
        }
        Ok(Some(mesh))
    }

    fn into_grouped(self) -> Grouped {
        let mut mesh = self.mesh;
        if self.lacks[0] {
            mesh.corner_normals.clear();
        }
        if self.lacks[1] {
            mesh.corner_parameters.clear();
        }
        let grouped = self.groups.on(mesh);
        Grouped { mesh: grouped.mesh.welded(), ..grouped }
    }
}

/// The metallic-roughness material of a file, textures left out; none if it does not say.
fn material_of(material: LocatedValue<'_>) -> Result<Option<MetallicRoughness>, Fault> {
    let Some(at) = material.get("pbrMetallicRoughness") else { return Ok(None) };
    let factor = |key| Ok::<f64, Fault>(at.number(key)?.unwrap_or(1.0).clamp(0.0, 1.0));
    let [r, g, b, _] = at.numbers::<4>("baseColorFactor")?.unwrap_or([1.0; 4]);
    let base = DVec3::new(r, g, b).clamp(DVec3::ZERO, DVec3::ONE);
    Ok(Some(MetallicRoughness { base, metallic: factor("metallicFactor")?, roughness: factor("roughnessFactor")? }))
}

fn short(at: LocatedValue<'_>) -> Fault {
    at.expected("as many rows as positions")
}

/// A table per vertex as a table per corner; none unless there is an entry for each of `count` vertices.
fn per_corner<T, const N: usize>(
    triangles: &[[u32; 3]],
    table: &[[f64; N]],
    count: usize,
    entry: impl Fn(&[f64; N]) -> T,
) -> Option<Vec<[T; 3]>> {
    let corner = |vertex: u32| entry(&table[vertex as usize]);
    (table.len() == count).then(|| triangles.iter().map(|triangle| triangle.map(corner)).collect())
}

/// Where a node stands in its parent.
fn placement(node: LocatedValue<'_>) -> Result<DAffine3, Fault> {
    if let Some(matrix) = node.numbers::<16>("matrix")? {
        let matrix = DMat4::from_cols_array(&matrix);
        if matrix.row(3) != DVec4::W {
            return Err(node.need("matrix")?.expected("an affine matrix"));
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let translation = node.numbers("translation")?.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.numbers("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = node.numbers::<4>("rotation")?.map_or(DQuat::IDENTITY, DQuat::from_array);
    let length = rotation.length();
    if !(length > 0.0 && length.is_finite()) {
        return Err(node.need("rotation")?.expected("a unit quaternion"));
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}
