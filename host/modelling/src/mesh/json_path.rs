//! Places in JSON documents.

use std::fmt;

/// The longest path that is kept.
const MAX_STEPS: usize = 5;
/// No index.
const NONE: u32 = u32::MAX;

/// The members that paths go through; a path keeps their numbers, so that errors stay small.
const KEYS: [&str; 48] = [
    "member",
    "asset",
    "version",
    "extensionsRequired",
    "scene",
    "scenes",
    "nodes",
    "children",
    "matrix",
    "translation",
    "rotation",
    "scale",
    "mesh",
    "meshes",
    "primitives",
    "mode",
    "attributes",
    "POSITION",
    "NORMAL",
    "TEXCOORD_0",
    "indices",
    "material",
    "materials",
    "name",
    "pbrMetallicRoughness",
    "baseColorFactor",
    "metallicFactor",
    "roughnessFactor",
    "accessors",
    "componentType",
    "count",
    "type",
    "normalized",
    "sparse",
    "values",
    "bufferView",
    "bufferViews",
    "byteOffset",
    "byteLength",
    "byteStride",
    "buffer",
    "buffers",
    "uri",
    "extensions",
    "EXT_mesh_gpu_instancing",
    "TRANSLATION",
    "ROTATION",
    "SCALE",
];

/// A place in a JSON document, such as `meshes[0].primitives[1].indices`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JsonPath {
    keys: [u8; MAX_STEPS],
    indices: [u32; MAX_STEPS],
    length: u8,
}

impl JsonPath {
    /// The path of a member of what is here, or of an element of it.
    pub(super) fn with(mut self, key: &str, index: Option<usize>) -> JsonPath {
        let step = usize::from(self.length);
        let known = KEYS.iter().position(|known| *known == key);
        debug_assert!(known.is_some(), "{key} is not among the keys");
        if step < MAX_STEPS {
            self.keys[step] = known.unwrap_or_default() as u8;
            self.indices[step] = index.and_then(|index| u32::try_from(index).ok()).unwrap_or(NONE);
            self.length += 1;
        }
        self
    }
}

impl fmt::Display for JsonPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.length == 0 {
            return write!(f, "the document");
        }
        for step in 0..usize::from(self.length) {
            let (dot, key) = (if step > 0 { "." } else { "" }, KEYS[usize::from(self.keys[step])]);
            match self.indices[step] {
                NONE => write!(f, "{dot}{key}")?,
                index => write!(f, "{dot}{key}[{index}]")?,
            }
        }
        Ok(())
    }
}
