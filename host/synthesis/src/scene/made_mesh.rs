//! Triangles that a model made, as the shape of an object.

use crate::mesh::Mesh;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;
use std::sync::Arc;

/// Triangles that a procedural model made. As text only their number is shown and a checksum.
#[derive(Clone, PartialEq)]
pub struct MadeMesh(pub Arc<Mesh>);

impl fmt::Debug for MadeMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sum = crc32fast::Hasher::new();
        for vertex in &self.0.vertices {
            sum.update(bytemuck::cast_slice(&vertex.to_array()));
        }
        sum.update(bytemuck::cast_slice(&self.0.triangles));
        write!(f, "{} triangles, {:08x}", self.0.triangles.len(), sum.finalize())
    }
}

impl Serialize for MadeMesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        format!("{self:?}").serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MadeMesh {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<MadeMesh, D::Error> {
        Err(de::Error::custom("triangles of a procedural model cannot be read back: its script makes them"))
    }
}
