//! Mesh files: the format by the extension, the limits, and the way in and out.

use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::{Fault, Mesh, MeshError, Place, Problem, compact, obj, ply, stl};

/// The longest file that is read, bytes.
pub(super) const MAX_BYTES: u64 = 4 << 30;
/// The most vertices or triangles of a mesh; indices leave room for marks.
pub(super) const MAX_COUNT: usize = (u32::MAX / 4) as usize;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: text; positions, normals, texture coordinates, polygons.
    Obj,
    /// Stereolithography: triangles in single precision; text and binary are read, binary is written.
    Stl,
    /// Stanford polygon file: text and binary of both byte orders are read, little-endian double precision is written.
    Ply,
    /// The compact form of a closed mesh that PERIS ships data in: quantised positions, about two bytes a triangle.
    Compact,
}

impl Format {
    /// The format that the extension of `path` names, in either case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension().and_then(OsStr::to_str)?.to_ascii_lowercase();
        match extension.as_str() {
            "obj" => Some(Format::Obj),
            "stl" => Some(Format::Stl),
            "ply" => Some(Format::Ply),
            "cmesh" => Some(Format::Compact),
            _ => None,
        }
    }
}

/// Reads a mesh; the extension of `path` names the format.
///
/// Polygons become fans of triangles around their first corner, which is right for convex polygons and for those that
/// are star-shaped from that corner; other concave polygons come out with overlapping triangles. Vertices of STL files
/// that have the same bits become one.
///
/// # Errors
/// [`MeshError`], with the line or byte where the content is wrong. Whatever is returned has finite vertices and
/// indices in range; it may be open or hold degenerate triangles.
pub fn read(path: impl AsRef<Path>) -> Result<Mesh, MeshError> {
    let path = path.as_ref();
    let format = Format::of(path).ok_or_else(|| MeshError::Format { path: path.to_owned() })?;
    let in_file = |source| MeshError::File { path: path.to_owned(), source };
    let in_content = |fault| MeshError::Content { path: path.to_owned(), fault };
    let mut bytes = Vec::new();
    File::open(path).map_err(in_file)?.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(in_file)?;
    if bytes.len() as u64 > MAX_BYTES {
        let problem = Problem::TooMany { what: "bytes", count: bytes.len() as u64, limit: MAX_BYTES };
        return Err(in_content(Place::Mesh.fault(problem)));
    }
    let mesh = parse(&bytes, format).map_err(in_content)?;
    // Bytes of any kind can pass for an OBJ file without a face.
    if mesh.triangles.is_empty() { Err(in_content(Place::Mesh.fault(Problem::NoTriangles))) } else { Ok(mesh) }
}

/// Writes a mesh; the extension of `path` names the format.
///
/// OBJ keeps positions to the last bit, corner normals and parameters; PLY keeps positions to the last bit; STL rounds
/// positions to single precision; the compact form rounds them to 1/65535 of the longest side.
///
/// # Errors
/// [`MeshError`] if the mesh is not valid, does not fit the format, or the file cannot be written.
pub fn write(mesh: &Mesh, path: impl AsRef<Path>) -> Result<(), MeshError> {
    let path = path.as_ref();
    let format = Format::of(path).ok_or_else(|| MeshError::Format { path: path.to_owned() })?;
    let bytes = print(mesh, format).map_err(|fault| MeshError::Content { path: path.to_owned(), fault })?;
    std::fs::write(path, bytes).map_err(|source| MeshError::File { path: path.to_owned(), source })
}

/// Understands the bytes of a mesh file.
///
/// # Errors
/// What is wrong, and the line or byte where.
pub fn parse(bytes: &[u8], format: Format) -> Result<Mesh, Fault> {
    let mesh = match format {
        Format::Obj => obj::parse(bytes),
        Format::Stl => stl::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Compact => compact::parse(bytes),
    }?;
    mesh.validate()?;
    Ok(mesh)
}

/// The bytes of a mesh file.
///
/// # Errors
/// If the mesh is not valid, or the format cannot hold it.
pub fn print(mesh: &Mesh, format: Format) -> Result<Vec<u8>, Fault> {
    mesh.validate()?;
    match format {
        Format::Obj => Ok(obj::print(mesh)),
        Format::Stl => stl::print(mesh),
        Format::Ply => Ok(ply::print(mesh)),
        Format::Compact => compact::print(mesh),
    }
}

/// Divides a polygon into a fan of triangles around its first corner.
pub(super) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> + '_ {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]])
}
