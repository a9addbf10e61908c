//! Stereolithography: triangles without connections, as text or binary; equal vertices become one.
//!
//! # Source
//! 3D Systems, StereoLithography Interface Specification, 1988.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::error::shortened;
use super::obj::number;
use super::{Fault, FaultLocation, Mesh, MeshProblem};

/// Bytes before the count of a binary file.
const TITLE_BYTES: usize = 80;
/// Bytes before the first triangle of a binary file.
const HEADER_BYTES: usize = TITLE_BYTES + 4;
/// Bytes of a triangle: normal, three corners, attributes.
const TRIANGLE_BYTES: usize = 4 * 12 + 2;

/// Understands an STL file. A file that is as long as its count says is binary; else one that begins with "solid" is
/// text. The normals of the file are not used.
pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    let announced =
        bytes.get(TITLE_BYTES..HEADER_BYTES).and_then(|field| field.try_into().ok()).map(u32::from_le_bytes);
    let is_length_of =
        |count: u32| bytes.len() as u64 == HEADER_BYTES as u64 + u64::from(count) * TRIANGLE_BYTES as u64;
    if !announced.is_some_and(is_length_of) && bytes.trim_ascii_start().starts_with(b"solid") {
        return parse_text(bytes);
    }
    parse_binary(bytes, announced)
}

fn parse_binary(bytes: &[u8], announced: Option<u32>) -> Result<Mesh, Fault> {
    let count =
        announced.ok_or_else(|| FaultLocation::Byte(bytes.len()).fault(MeshProblem::Ends("the header")))? as usize;
    let whole = bytes[HEADER_BYTES..].chunks_exact(TRIANGLE_BYTES);
    if whole.len() < count {
        return Err(FaultLocation::Byte(bytes.len()).fault(MeshProblem::Ends("a triangle")));
    }
    let mut collector = Collector::default();
    for (index, record) in whole.take(count).enumerate() {
        let corners = [12, 24, 36].map(|offset| {
            let field = |k: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| record[offset + 4 * k + byte]));
            Vec3::new(field(0), field(1), field(2)).as_dvec3()
        });
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(FaultLocation::Byte(HEADER_BYTES + index * TRIANGLE_BYTES).fault(MeshProblem::NotFinite));
        }
        collector.add(corners);
    }
    Ok(collector.mesh)
}

fn parse_text(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut collector = Collector::default();
    let mut corners: Vec<DVec3> = Vec::with_capacity(3);
    let mut last_line = 0;
    let mut expected: &'static str = "solid";
    for (index, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_ascii_whitespace();
        let Some(first) = words.next() else { continue };
        last_line = index + 1;
        let unexpected = || MeshProblem::Expected { expected, found: shortened(text.trim()) };
        let step = || -> Result<&'static str, MeshProblem> {
            match (expected, first.to_ascii_lowercase().as_str()) {
                ("solid", "solid") => Ok("facet or endsolid"),
                ("facet or endsolid", "endsolid") => Ok("solid"),
                ("facet or endsolid", "facet") => Ok("outer loop"),
                ("outer loop", "outer") => Ok("vertex"),
                ("vertex", "vertex") => {
                    let mut coordinate = || number(words.next().ok_or(MeshProblem::Ends("a number"))?);
                    corners.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
                    Ok(if corners.len() == 3 { "endloop" } else { "vertex" })
                }
                ("endloop", "endloop") => Ok("endfacet"),
                ("endfacet", "endfacet") => {
                    collector.add([corners[0], corners[1], corners[2]]);
                    corners.clear();
                    Ok("facet or endsolid")
                }
                _ => Err(unexpected()),
            }
        };
        expected = { step }().map_err(|problem| FaultLocation::Line(index + 1).fault(problem))?;
    }
    match expected {
        "solid" => Ok(collector.mesh),
        missing => Err(FaultLocation::Line(last_line).fault(MeshProblem::Ends(missing))),
    }
}

/// A mesh in the making, with one vertex for each position.
#[derive(Default)]
struct Collector {
    mesh: Mesh,
    index_at: HashMap<[u64; 3], u32>,
}

impl Collector {
    fn add(&mut self, corners: [DVec3; 3]) {
        let triangle = corners.map(|corner| {
            let fresh = self.mesh.vertices.len() as u32;
            let index = *self.index_at.entry(super::measure::bits(corner)).or_insert(fresh);
            if index == fresh {
                self.mesh.vertices.push(corner);
            }
            index
        });
        self.mesh.triangles.push(triangle);
    }
}

/// The binary form of `mesh`.
///
/// # Errors
/// If a coordinate is too large for single precision.
pub(super) fn print(mesh: &Mesh) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::with_capacity(HEADER_BYTES + mesh.triangles.len() * TRIANGLE_BYTES);
    bytes.extend_from_slice(b"binary STL of PERIS");
    bytes.resize(TITLE_BYTES, b' ');
    bytes.extend_from_slice(&(mesh.triangles.len() as u32).to_le_bytes());
    for (vertex, position) in mesh.vertices.iter().enumerate() {
        if let Some(&value) = position.to_array().iter().find(|value| !(**value as f32).is_finite()) {
            return Err(FaultLocation::Vertex(vertex).fault(MeshProblem::Range { value }));
        }
    }
    for triangle in 0..mesh.triangles.len() {
        let normal = mesh.face_normal(triangle).unwrap_or_default();
        for vector in [[normal].as_slice(), &mesh.corners(triangle)].concat() {
            for value in vector.as_vec3().to_array() {
                bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
        bytes.extend_from_slice(&[0; 2]);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::samples::tetrahedron;
    use super::*;

    const TEXT: &str = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid a b\n";

    #[test]
    fn text_is_read_and_its_vertices_are_shared() {
        let twice = TEXT.repeat(2);
        let mesh = parse(twice.as_bytes()).unwrap();
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (3, 2));
    }

    #[test]
    fn a_binary_file_whose_title_begins_with_solid_is_binary() {
        let mut bytes = print(&tetrahedron()).unwrap();
        bytes[..5].copy_from_slice(b"solid");
        let mesh = parse(&bytes).unwrap();
        assert!(mesh.is_closed());
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn faults_name_line_or_byte() {
        let fault = |bytes: &[u8]| parse(bytes).unwrap_err().to_string();
        assert_eq!(
            fault(TEXT.replace("vertex 1 0 0", "vertex 1 nan 0").as_bytes()),
            "line 5: a coordinate is not finite"
        );
        assert_eq!(fault(TEXT.replace("  endloop\n", "").as_bytes()), "line 7: expected endloop, found `endfacet`");
        assert_eq!(fault(&TEXT.as_bytes()[..78]), "line 5: ends where vertex is expected");
        let bytes = print(&tetrahedron()).unwrap();
        assert_eq!(fault(&bytes[..83]), "byte 83: ends where the header is expected");
        assert_eq!(fault(&bytes[..283]), "byte 283: ends where a triangle is expected");
        let mut poisoned = bytes;
        poisoned[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert_eq!(fault(&poisoned), "byte 134: a coordinate is not finite");
    }

    #[test]
    fn coordinates_beyond_single_precision_are_refused() {
        let far = tetrahedron().transformed(&glam::DAffine3::from_scale(DVec3::splat(1e300)));
        assert!(matches!(print(&far).unwrap_err().problem, MeshProblem::Range { .. }));
    }
}
