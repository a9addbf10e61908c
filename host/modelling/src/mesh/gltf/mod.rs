//! glTF 2.0: triangles of meshes that nodes place, as JSON (.gltf) or binary (.glb); lengths are metres.
//!
//! Read are triangles, strips and fans with positions, normals and the first texture coordinates, of all component types,
//! interleaved and sparse, in the default scene, else in the first one. Vertices at the same position become one. A mesh
//! that nodes or EXT_mesh_gpu_instancing place more than once can be read once, with its places; where a map flattens it,
//! it is copied, and a zero scale leaves nothing. Written are meshes with a primitive for each surface, which a material
//! names, and a node for each place of a mesh, or one with that extension where there are many.
//!
//! Not modelled: textures, colours, skins, morph targets, animations, cameras, lights; compressed meshes are refused.
//!
//! # Source
//! Khronos Group, glTF 2.0 Specification, 2021 (ISO/IEC 12113:2022); EXT_mesh_gpu_instancing, 2020.

mod base64;
mod document;
mod accessor;
mod nodes;
mod meshes;
mod read;
mod written_nodes;
mod write;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod places_tests;

pub(super) use read::{parse, parse_placed};
pub(super) use write::{Written, print_binary, print_text};

/// The first bytes of a binary file.
const MAGIC: &[u8; 4] = b"glTF";
/// Kinds of chunks of a binary file.
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
