//! Mesh files: the format by the extension, the limits, and the way in and out.

use crate::memory;
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

use files::Destination;

use super::gltf::Written;
use super::{
    Fault, FaultLocation, Grouped, Mesh, MeshError, MeshPlaces, MeshProblem, PlacedMeshes, compact, gltf, obj, ply, stl,
};

/// The longest file that is read, bytes.
pub(super) const MAX_BYTES: u64 = 4 << 30;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: text; positions, normals, texture coordinates, polygons.
    Obj,
    /// Stereolithography: triangles in single precision; text and binary are read, binary is written.
    Stl,
    /// Stanford polygon file: text and binary of both byte orders are read, little-endian double precision is written.
    Ply,
    /// glTF 2.0 as JSON: single precision, metres; buffers in the file or beside it are read, one in the file is
    /// written.
    Gltf,
    /// glTF 2.0, binary.
    Glb,
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
            "gltf" => Some(Format::Gltf),
            "glb" => Some(Format::Glb),
            "cmesh" => Some(Format::Compact),
            _ => None,
        }
    }

    /// Whether files of the format place meshes, one of them many times.
    pub fn has_places(self) -> bool {
        matches!(self, Format::Gltf | Format::Glb)
    }
}

/// Reads a mesh; see [`read_grouped`].
///
/// # Errors
/// [`MeshError`] if the file cannot be read, or holds no mesh of its format; see [`read_grouped`].
pub fn read(path: impl AsRef<Path>) -> Result<Mesh, MeshError> {
    Ok(read_grouped(path)?.mesh)
}

/// Reads a mesh and the names of its groups; the extension of `path` names the format.
///
/// Polygons become fans of triangles around their first corner, which is right for convex polygons and for those that
/// are star-shaped from that corner; other concave polygons come out with overlapping triangles. Vertices of STL and
/// glTF files that have the same bits become one. Groups are those of OBJ files (`o`, `g` and `usemtl` together), the
/// property `surface` of the faces of PLY files, and the primitives of glTF files.
///
/// # Errors
/// [`MeshError`], with the line or byte where the content is wrong. Whatever is returned has finite vertices and
/// indices in range; it may be open or hold degenerate triangles.
pub fn read_grouped(path: impl AsRef<Path>) -> Result<Grouped, MeshError> {
    read_by(path.as_ref(), |bytes, format, neighbour| {
        let grouped = parse_beside(bytes, format, neighbour)?;
        // Bytes of any kind can pass for an OBJ file without a face.
        if grouped.mesh.triangles.is_empty() { Err(nothing()) } else { Ok(grouped) }
    })
}

/// Reads meshes and where they are: those of a glTF file that nodes place more than once, with nodes of their own or by
/// EXT_mesh_gpu_instancing, are stored once; everything else stands alone, as [`read_grouped`] gives it.
///
/// # Errors
/// [`MeshError`], with the line, the byte or the member where the content is wrong.
pub fn read_placed(path: impl AsRef<Path>) -> Result<PlacedMeshes, MeshError> {
    read_by(path.as_ref(), |bytes, format, neighbour| {
        let placed = placed_beside(bytes, format, neighbour)?;
        let is_empty = placed.alone.mesh.triangles.is_empty() && placed.places.count() == 0;
        if is_empty { Err(nothing()) } else { Ok(placed) }
    })
}

/// The content of a file beside a mesh file, or why there is none.
type Neighbour<'n> = &'n dyn Fn(&str) -> Result<Vec<u8>, String>;

fn read_by<T>(
    path: &Path,
    parse: impl FnOnce(&[u8], Format, Neighbour<'_>) -> Result<T, Fault>,
) -> Result<T, MeshError> {
    let format = Format::of(path).ok_or_else(|| MeshError::Format { path: path.to_owned() })?;
    let bytes = memory::read(path, MAX_BYTES).map_err(|source| MeshError::File { path: path.to_owned(), source })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let neighbour = |name: &str| memory::read(&folder.join(name), MAX_BYTES).map_err(|error| error.to_string());
    parse(&bytes, format, &neighbour).map_err(|fault| MeshError::Content { path: path.to_owned(), fault })
}

fn nothing() -> Fault {
    FaultLocation::Mesh.fault(MeshProblem::NoTriangles)
}

/// Where a mesh will be written, tested before a long computation.
///
/// # Errors
/// [`MeshError::Format`] for a name whose extension is not known, [`MeshError::Write`] where no file can be written.
pub fn destination(path: impl AsRef<Path>) -> Result<Destination, MeshError> {
    let path = path.as_ref();
    Format::of(path).ok_or_else(|| MeshError::Format { path: path.to_owned() })?;
    Ok(Destination::of(path)?)
}

/// Writes a mesh; the extension of the file names the format.
///
/// OBJ keeps positions to the last bit, corner normals, parameters and surfaces; PLY keeps positions to the last bit
/// and surfaces; glTF keeps all of them but in single precision; STL rounds positions to single precision; the compact
/// form rounds them to 1/65535 of the longest side.
///
/// # Errors
/// [`MeshError`] if the mesh is not valid, does not fit the format, or the file cannot be written; it may be kept
/// elsewhere then.
pub fn write(mesh: &Mesh, destination: &Destination) -> Result<(), MeshError> {
    write_grouped(&Grouped::from(mesh.clone()), destination)
}

/// Writes a mesh with names for its surfaces, as [`write()`] does; glTF keeps their materials, too.
///
/// # Errors
/// [`MeshError`] if the mesh is not valid, does not fit the format, or the file cannot be written.
pub fn write_grouped(grouped: &Grouped, destination: &Destination) -> Result<(), MeshError> {
    write_by(destination, |format| print_grouped(grouped, format))
}

/// Writes meshes and where they are as a glTF file: a node for each place of a mesh, or, for many, one with
/// EXT_mesh_gpu_instancing, whose places are in single precision.
///
/// # Errors
/// [`MeshError`] if a mesh is not valid, the format places no meshes, or the file cannot be written.
pub fn write_placed(placed: &PlacedMeshes, destination: &Destination) -> Result<(), MeshError> {
    write_by(destination, |format| print_placed(placed, format))
}

fn write_by(destination: &Destination, print: impl FnOnce(Format) -> Result<Vec<u8>, Fault>) -> Result<(), MeshError> {
    let path = destination.path();
    let format = Format::of(path).ok_or_else(|| MeshError::Format { path: path.to_owned() })?;
    let bytes = print(format).map_err(|fault| MeshError::Content { path: path.to_owned(), fault })?;
    Ok(destination.write_or_save_elsewhere(|file| file.write_all(&bytes))?)
}

/// Understands the bytes of a mesh file.
///
/// # Errors
/// What is wrong, and the line or byte where.
pub fn parse(bytes: &[u8], format: Format) -> Result<Mesh, Fault> {
    Ok(parse_grouped(bytes, format)?.mesh)
}

/// Understands the bytes of a mesh file that stands alone.
///
/// # Errors
/// What is wrong, and the line, byte or member where.
pub fn parse_grouped(bytes: &[u8], format: Format) -> Result<Grouped, Fault> {
    parse_beside(bytes, format, &|_| Err("there is no folder".into()))
}

/// Understands the bytes of a mesh file that stands alone, with each mesh that it places more than once only once.
///
/// # Errors
/// What is wrong, and the line, byte or member where.
pub fn parse_placed(bytes: &[u8], format: Format) -> Result<PlacedMeshes, Fault> {
    placed_beside(bytes, format, &|_| Err("there is no folder".into()))
}

fn placed_beside(bytes: &[u8], format: Format, neighbour: Neighbour<'_>) -> Result<PlacedMeshes, Fault> {
    if !format.has_places() {
        let alone = parse_beside(bytes, format, neighbour)?;
        return Ok(PlacedMeshes { alone, ..PlacedMeshes::default() });
    }
    let placed = gltf::parse_placed(bytes, neighbour)?;
    let meshes = placed.repeated.iter().map(|repeated| &repeated.grouped.mesh);
    std::iter::once(&placed.alone.mesh).chain(meshes).try_for_each(Mesh::validate)?;
    Ok(placed)
}

fn parse_beside(bytes: &[u8], format: Format, neighbour: Neighbour<'_>) -> Result<Grouped, Fault> {
    let grouped = match format {
        Format::Obj => obj::parse(bytes)?,
        Format::Stl => stl::parse(bytes)?.into(),
        Format::Ply => ply::parse(bytes)?,
        Format::Gltf | Format::Glb => gltf::parse(bytes, neighbour)?,
        Format::Compact => compact::parse(bytes)?.into(),
    };
    grouped.mesh.validate()?;
    Ok(grouped)
}

/// The bytes of a mesh file.
///
/// # Errors
/// [`Fault`] if the mesh is not valid, or the format cannot hold it.
pub fn print(mesh: &Mesh, format: Format) -> Result<Vec<u8>, Fault> {
    print_grouped(&Grouped::from(mesh.clone()), format)
}

/// The bytes of a mesh file with names for its surfaces.
///
/// # Errors
/// [`Fault`] if the mesh is not valid, or the format cannot hold it.
pub fn print_grouped(grouped: &Grouped, format: Format) -> Result<Vec<u8>, Fault> {
    let Grouped { mesh, names, .. } = grouped;
    mesh.validate()?;
    match format {
        Format::Obj => Ok(obj::print(mesh, names)),
        Format::Stl => stl::print(mesh),
        Format::Ply => Ok(ply::print(mesh, names)),
        Format::Gltf | Format::Glb => {
            print_gltf(&Written { alone: grouped, repeated: &[], places: &MeshPlaces::default() }, format)
        }
        Format::Compact => compact::print(mesh),
    }
}

/// The bytes of a glTF file of meshes and their places.
///
/// # Errors
/// [`Fault`] if a mesh is not valid, a place is not finite or of no mesh, or the format places no meshes.
pub fn print_placed(placed: &PlacedMeshes, format: Format) -> Result<Vec<u8>, Fault> {
    let PlacedMeshes { alone, repeated, places } = placed;
    if !format.has_places() {
        return Err(FaultLocation::Mesh.fault(MeshProblem::Unsuited("only glTF files place meshes")));
    }
    let meshes = repeated.iter().map(|repeated| &repeated.grouped.mesh);
    std::iter::once(&alone.mesh).chain(meshes).try_for_each(Mesh::validate)?;
    print_gltf(&Written { alone, repeated, places }, format)
}

fn print_gltf(content: &Written<'_>, format: Format) -> Result<Vec<u8>, Fault> {
    if format == Format::Gltf { gltf::print_text(content) } else { gltf::print_binary(content) }
}
