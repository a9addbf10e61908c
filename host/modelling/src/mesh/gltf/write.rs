//! Meshes and their places as a glTF file.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::super::groups::{Grouped, MetallicRoughness, has_groups, name_of};
use super::super::{Fault, FaultLocation, Mesh, MeshPlaces, MeshProblem, RepeatedMesh};
use super::nodes::INSTANCING;
use super::written_nodes::{Tables, WrittenNodes};
use super::{BINARY_CHUNK, JSON_CHUNK, MAGIC, base64};

/// Types of components.
const U32: u32 = 5125;
const F32: u32 = 5126;
/// What buffer views are for.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The text form, with its buffer in itself.
///
/// # Errors
/// If a coordinate is too large for single precision.
pub fn print_text(content: &Written<'_>) -> Result<Vec<u8>, Fault> {
    let (mut document, binary) = document(content)?;
    let uri = format!("data:application/octet-stream;base64,{}", base64::encode(&binary));
    document["buffers"][0]["uri"] = Value::from(uri);
    Ok(format!("{document:#}\n").into_bytes())
}

/// The binary form.
///
/// # Errors
/// If a coordinate is too large for single precision, or the file would be too long.
pub fn print_binary(content: &Written<'_>) -> Result<Vec<u8>, Fault> {
    let (document, mut binary) = document(content)?;
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let whole = 12 + 8 + json.len() + 8 + binary.len();
    let length = |length: usize| {
        let too_long = || {
            FaultLocation::Mesh.fault(MeshProblem::TooMany {
                what: "bytes",
                count: whole as u64,
                limit: u32::MAX.into(),
            })
        };
        u32::try_from(length).map_err(|_| too_long())
    };
    let mut bytes = MAGIC.to_vec();
    for word in [2, length(whole)?, length(json.len())?, JSON_CHUNK] {
        bytes.extend_from_slice(&word.to_le_bytes());
    }
    bytes.extend_from_slice(&json);
    for word in [length(binary.len())?, BINARY_CHUNK] {
        bytes.extend_from_slice(&word.to_le_bytes());
    }
    bytes.extend_from_slice(&binary);
    Ok(bytes)
}

/// What is written.
pub struct Written<'w> {
    /// What stands where it is.
    pub alone: &'w Grouped,
    /// Meshes that are placed.
    pub repeated: &'w [RepeatedMesh],
    /// Where.
    pub places: &'w MeshPlaces,
}

/// What is different at a corner: position, normal and parameters, in single precision.
type Corner = ([u32; 3], [u32; 3], [u32; 2]);

/// The document without its buffer, and the buffer.
fn document(content: &Written<'_>) -> Result<(Value, Vec<u8>), Fault> {
    let Written { alone, repeated, places } = content;
    let mut file = File::default();
    let mut nodes = WrittenNodes::default();
    if !alone.mesh.triangles.is_empty() {
        let mesh = file.mesh(alone, "")?;
        nodes.push(json!({ "mesh": mesh }));
    }
    let mut numbers = Vec::with_capacity(repeated.len());
    for RepeatedMesh { name, grouped } in *repeated {
        numbers.push(match grouped.mesh.triangles.is_empty() {
            true => None,
            false => Some(file.mesh(grouped, name)?),
        });
    }
    nodes.place(&mut file, places, &numbers)?;
    if file.meshes.is_empty() {
        return Err(FaultLocation::Mesh.fault(MeshProblem::NoTriangles));
    }
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "PERIS" },
        "scene": 0, "scenes": [{ "nodes": nodes.roots }], "nodes": nodes.all,
        "meshes": file.meshes,
        "accessors": file.accessors, "bufferViews": file.views, "buffers": [{ "byteLength": file.binary.len() }],
    });
    if !file.materials.is_empty() {
        document["materials"] = Value::from(file.materials);
    }
    if nodes.uses_extension {
        // Without it there would be one where many are.
        (document["extensionsUsed"], document["extensionsRequired"]) = (json!([INSTANCING]), json!([INSTANCING]));
    }
    Ok((document, file.binary))
}

/// A material of this name.
fn material(name: &str, look: Option<MetallicRoughness>) -> Value {
    let Some(MetallicRoughness { base, metallic, roughness }) = look else { return json!({ "name": name }) };
    let [r, g, b] = base.to_array();
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness,
        },
    })
}

/// The different corners, in order of their first use, and those of each triangle.
fn corners(mesh: &Mesh) -> (Vec<Corner>, Vec<[u32; 3]>) {
    let bits3 = |p: DVec3| p.as_vec3().to_array().map(f32::to_bits);
    let bits2 = |p: DVec2| p.as_vec2().to_array().map(f32::to_bits);
    let mut number_of: HashMap<Corner, u32> = HashMap::new();
    let mut corners = Vec::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for (triangle, points) in (0..mesh.triangles.len()).map(|triangle| mesh.corners(triangle)).enumerate() {
        let face = mesh.face_normal(triangle).unwrap_or(DVec3::Z);
        triangles.push([0, 1, 2].map(|k| {
            let normal = mesh.corner_normals.get(triangle).map_or(DVec3::ZERO, |normals| {
                // A corner without a normal, as at a pole, takes that of its triangle: files need one.
                normals[k].try_normalize().unwrap_or(face)
            });
            let uv = mesh.corner_parameters.get(triangle).map_or(DVec2::ZERO, |parameters| parameters[k]);
            let corner = (bits3(points[k]), bits3(normal), bits2(uv));
            *number_of.entry(corner).or_insert_with(|| {
                corners.push(corner);
                corners.len() as u32 - 1
            })
        }));
    }
    (corners, triangles)
}

/// The least and the greatest coordinates.
fn range(corners: &[Corner]) -> ([f32; 3], [f32; 3]) {
    let mut range = ([f32::MAX; 3], [f32::MIN; 3]);
    for corner in corners {
        for k in 0..3 {
            let x = f32::from_bits(corner.0[k]);
            (range.0[k], range.1[k]) = (range.0[k].min(x), range.1[k].max(x));
        }
    }
    range
}

/// A file in the making.
#[derive(Default)]
struct File {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
}

impl File {
    /// Adds a mesh; returns its number.
    fn mesh(&mut self, grouped: &Grouped, called: &str) -> Result<usize, Fault> {
        let Grouped { mesh, names, materials: looks } = grouped;
        for (vertex, position) in mesh.vertices.iter().enumerate() {
            if let Some(&value) = position.to_array().iter().find(|value| !(**value as f32).is_finite()) {
                return Err(FaultLocation::Vertex(vertex).fault(MeshProblem::Range { value }));
            }
        }
        let (corners, indices) = corners(mesh);
        let count = corners.len();
        let view = self.view(corners.iter().flat_map(|corner| corner.0), Some(VERTICES));
        let position = self.accessor(view, 0, "VEC3", F32, count);
        let (low, high) = range(&corners);
        (self.accessors[position]["min"], self.accessors[position]["max"]) = (json!(low), json!(high));
        let mut attributes = json!({ "POSITION": position });
        if !mesh.corner_normals.is_empty() {
            let view = self.view(corners.iter().flat_map(|corner| corner.1), Some(VERTICES));
            attributes["NORMAL"] = json!(self.accessor(view, 0, "VEC3", F32, count));
        }
        if !mesh.corner_parameters.is_empty() {
            let view = self.view(corners.iter().flat_map(|corner| corner.2), Some(VERTICES));
            attributes["TEXCOORD_0"] = json!(self.accessor(view, 0, "VEC2", F32, count));
        }
        // The triangles of a surface stand together; within it they keep their order.
        let mut order: Vec<usize> = (0..indices.len()).collect();
        let surface = |triangle: &usize| mesh.surfaces.get(*triangle).copied().unwrap_or(0);
        order.sort_by_key(surface);
        let view = self.view(order.iter().flat_map(|triangle| indices[*triangle]), Some(INDICES));
        let (mut primitives, mut first) = (Vec::new(), 0);
        for part in order.chunk_by(|a, b| surface(a) == surface(b)) {
            let indices = self.accessor(view, 12 * first, "SCALAR", U32, 3 * part.len());
            let mut primitive = json!({ "attributes": attributes, "indices": indices, "mode": 4 });
            if has_groups(mesh, names) {
                primitive["material"] = json!(self.materials.len());
                let surface = surface(&part[0]);
                let look = looks.get(surface as usize).copied().flatten();
                self.materials.push(material(&name_of(names, surface), look));
            }
            primitives.push(primitive);
            first += part.len();
        }
        let mut mesh = json!({ "primitives": primitives });
        if !called.is_empty() {
            mesh["name"] = json!(called);
        }
        self.meshes.push(mesh);
        Ok(self.meshes.len() - 1)
    }

    /// Adds a table of words of four bytes; returns the number of its view.
    fn view(&mut self, words: impl Iterator<Item = u32>, target: Option<u32>) -> usize {
        let begin = self.binary.len();
        words.for_each(|word| self.binary.extend_from_slice(&word.to_le_bytes()));
        let length = self.binary.len() - begin;
        let mut view = json!({ "buffer": 0, "byteOffset": begin, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, offset: usize, kind: &str, component: u32, count: usize) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "byteOffset": offset, "componentType": component, "count": count, "type": kind,
        }));
        self.accessors.len() - 1
    }
}

impl Tables for File {
    fn table<const N: usize>(&mut self, rows: impl ExactSizeIterator<Item = [f32; N]>) -> usize {
        let count = rows.len();
        let view = self.view(rows.flat_map(|row| row.map(f32::to_bits)), None);
        self.accessor(view, 0, if N == 4 { "VEC4" } else { "VEC3" }, F32, count)
    }
}
