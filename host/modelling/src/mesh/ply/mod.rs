//! Stanford polygon files: a header that describes tables, then the tables as text or binary.
//!
//! Read are the elements `vertex` (x y z; nx ny nz; s t, u v or texture_u texture_v), `face` (vertex_indices or
//! vertex_index) and `tristrips` (the same; -1 ends a strip); all others are skipped. The property `surface` of a face is
//! the number of its group; comments `surface NUMBER NAME` name the groups, in order from 0.
//!
//! Not modelled: colours, materials.
//!
//! # Source
//! Greg Turk, The PLY Polygon File Format, 1994.

mod header;
mod table;

use glam::{DVec2, DVec3};

use self::header::{Encoding, Header, PlyElement, Property, Scalar};
use self::table::{Binary, Table, Text};
use super::fan::{fan, strip};
use super::groups::{Grouped, has_groups, name_of};
use super::triangles::MAX_COUNT;
use super::{Fault, FaultLocation, Mesh, MeshProblem};

/// Understands a PLY file.
pub(super) fn parse(bytes: &[u8]) -> Result<Grouped, Fault> {
    let header = header::parse(bytes)?;
    let body = &bytes[header.bytes..];
    match header.encoding {
        Encoding::Text => tables(&header, Text::new(body, header.lines)),
        Encoding::LittleEndian => tables(&header, Binary::new(body, header.bytes, false)),
        Encoding::BigEndian => tables(&header, Binary::new(body, header.bytes, true)),
    }
}

fn tables<T: Table>(header: &Header, mut table: T) -> Result<Grouped, Fault> {
    let mut content = Content::default();
    for element in header.elements.iter().filter(|element| !element.properties.is_empty()) {
        check_count(element, &table)?;
        match element.name.as_str() {
            "vertex" => content.read_vertices(element, &mut table)?,
            "face" => content.read_faces(element, &mut table)?,
            "tristrips" => content.read_strips(element, &mut table)?,
            _ => skip(element, &mut table)?,
        }
    }
    let mesh = content.into_mesh(&table)?;
    let names = if mesh.surfaces.is_empty() { Vec::new() } else { header.surfaces.clone() };
    Ok(Grouped { mesh, names, ..Grouped::default() })
}

/// Refuses a count that the rest of the file cannot hold, before anything is reserved for it.
fn check_count<T: Table>(element: &PlyElement, table: &T) -> Result<(), Fault> {
    let row = element.properties.iter().map(|property| table.least_bytes(property)).sum::<u64>();
    let limit = (table.bytes_left() / row.max(1)).min(MAX_COUNT as u64);
    if element.count > limit {
        let problem = MeshProblem::TooMany { what: "rows announced", count: element.count, limit };
        return Err(table.location().fault(problem));
    }
    Ok(())
}

fn skip<T: Table>(element: &PlyElement, table: &mut T) -> Result<(), Fault> {
    for _ in 0..element.count {
        for property in &element.properties {
            table.skip(property)?;
        }
    }
    Ok(())
}

#[derive(Default)]
struct Content {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    parameters: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    /// The group of each triangle, if faces tell.
    surfaces: Vec<u32>,
}

impl Content {
    fn read_vertices<T: Table>(&mut self, element: &PlyElement, table: &mut T) -> Result<(), Fault> {
        let slot = |names: &[&str]| {
            let is_named = |property: &Property| names.contains(&property.name.as_str()) && property.length.is_none();
            element.properties.iter().position(is_named)
        };
        let all = |slots: [Option<usize>; 3]| slots.into_iter().collect::<Option<Vec<_>>>();
        let missing = || table.location().fault(MeshProblem::Ends("the vertex properties x, y and z"));
        let position = all([slot(&["x"]), slot(&["y"]), slot(&["z"])]).ok_or_else(missing)?;
        let normal = all([slot(&["nx"]), slot(&["ny"]), slot(&["nz"])]);
        let (s, t) = (slot(&["s", "u", "texture_u"]), slot(&["t", "v", "texture_v"]));
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            let place = table.location();
            for (value, property) in row.iter_mut().zip(&element.properties) {
                match property.length {
                    None => *value = table.number(property.scalar)?,
                    Some(_) => table.skip(property)?,
                }
            }
            let point = |slots: &[usize]| DVec3::new(row[slots[0]], row[slots[1]], row[slots[2]]);
            let point_here = point(&position);
            if !point_here.is_finite() {
                return Err(place.fault(MeshProblem::NotFinite));
            }
            self.positions.push(point_here);
            self.normals.extend(normal.as_deref().map(|slots| point(slots).normalize_or_zero()));
            self.parameters.extend(s.zip(t).map(|(s, t)| DVec2::new(row[s], row[t])));
        }
        Ok(())
    }

    fn read_faces<T: Table>(&mut self, element: &PlyElement, table: &mut T) -> Result<(), Fault> {
        let mut polygon: Vec<u32> = Vec::new();
        for _ in 0..element.count {
            let (first, mut surface) = (self.triangles.len(), None);
            for property in &element.properties {
                if property.name == "surface" && property.length.is_none() {
                    surface = Some(index(table, property, u32::MAX as usize, "surfaces")?);
                    continue;
                }
                let Some(length) = length_of_indices(property) else {
                    table.skip(property)?;
                    continue;
                };
                let place = table.location();
                let corners = table.count(length)?;
                if corners < 3 {
                    return Err(place.fault(MeshProblem::FewCorners(corners as usize)));
                }
                polygon.clear();
                for _ in 0..corners {
                    polygon.push(index(table, property, self.positions.len(), "vertices")?);
                }
                self.triangles.extend(fan(&polygon));
            }
            if let Some(surface) = surface {
                self.surfaces.resize(first, 0);
                self.surfaces.resize(self.triangles.len(), surface);
            }
        }
        Ok(())
    }

    fn read_strips<T: Table>(&mut self, element: &PlyElement, table: &mut T) -> Result<(), Fault> {
        let mut corners: Vec<u32> = Vec::new();
        for _ in 0..element.count {
            for property in &element.properties {
                let Some(length) = length_of_indices(property) else {
                    table.skip(property)?;
                    continue;
                };
                corners.clear();
                for _ in 0..table.count(length)? {
                    let place = table.location();
                    let number = table.number(property.scalar)?;
                    if number == -1.0 {
                        self.triangles.extend(strip(&corners));
                        corners.clear();
                    } else {
                        corners.push(as_index(number, place, self.positions.len(), "vertices")?);
                    }
                }
                self.triangles.extend(strip(&corners));
            }
        }
        Ok(())
    }

    fn into_mesh<T: Table>(self, table: &T) -> Result<Mesh, Fault> {
        let count = self.positions.len();
        // Faces may stand before the vertices, so that indices can only be checked here.
        if let Some(&index) = self.triangles.iter().flatten().find(|&&index| index as usize >= count) {
            return Err(table.location().fault(MeshProblem::Index { index: index.into(), count, table: "vertices" }));
        }
        let parameters_are_finite = self.parameters.iter().all(|parameter| parameter.is_finite());
        let parameters = if parameters_are_finite { self.parameters } else { Vec::new() };
        Ok(Mesh {
            corner_normals: per_corner(&self.triangles, &self.normals, count),
            corner_parameters: per_corner(&self.triangles, &parameters, count),
            vertices: self.positions,
            triangles: self.triangles,
            surfaces: self.surfaces,
        })
    }
}

/// The type of the length of a list of vertices; `None` for another property.
fn length_of_indices(property: &Property) -> Option<Scalar> {
    property.length.filter(|_| matches!(property.name.as_str(), "vertex_indices" | "vertex_index"))
}

/// A whole number from 0; `count` entries of `what` are known for the message.
fn index<T: Table>(table: &mut T, property: &Property, count: usize, what: &'static str) -> Result<u32, Fault> {
    let place = table.location();
    as_index(table.number(property.scalar)?, place, count, what)
}

fn as_index(number: f64, place: FaultLocation, count: usize, what: &'static str) -> Result<u32, Fault> {
    if !(0.0..=f64::from(u32::MAX)).contains(&number) || number.fract() != 0.0 {
        return Err(place.fault(MeshProblem::Index { index: number as i64, count, table: what }));
    }
    Ok(number as u32)
}

/// A table per vertex as a table per corner; empty unless all `vertices` have an entry.
fn per_corner<T: Copy>(triangles: &[[u32; 3]], per_vertex: &[T], vertices: usize) -> Vec<[T; 3]> {
    if per_vertex.len() != vertices {
        return Vec::new();
    }
    triangles.iter().map(|triangle| triangle.map(|vertex| per_vertex[vertex as usize])).collect()
}

/// The little-endian form of the positions, triangles and surfaces of `mesh`, in double precision.
pub(super) fn print(mesh: &Mesh, names: &[String]) -> Vec<u8> {
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    let surfaces = if has_groups(mesh, names) { mesh.surfaces.as_slice() } else { &[] };
    let count = surfaces.iter().max().map_or(0, |last| (*last as usize + 1).min(names.len()) as u32);
    let comments: String = (0..count).map(|k| format!("comment surface {k} {}\n", name_of(names, k))).collect();
    let property = if surfaces.is_empty() { "" } else { "property uint surface\n" };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment by PERIS\n{comments}\
         element vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {triangles}\nproperty list uchar uint vertex_indices\n{property}end_header\n"
    );
    let mut bytes = header.into_bytes();
    bytes.reserve(vertices * 24 + triangles * 13);
    for value in mesh.vertices.iter().flat_map(|position| position.to_array()) {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    for (k, triangle) in mesh.triangles.iter().enumerate() {
        bytes.push(3);
        triangle.iter().for_each(|vertex| bytes.extend_from_slice(&vertex.to_le_bytes()));
        bytes.extend(surfaces.get(k).iter().flat_map(|surface| surface.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::super::samples::tetrahedron;
    use super::*;

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property list uchar int extra\nproperty float confidence\nelement face 2\nproperty uchar flags\n\
        property list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n\
        0 0 0 0 9\n1 0 0 2 7 7 9\n1 1 0 0 9\n0 1 0 1 5 9\n1 4 0 1 2 3\n1 3 0 1 2\n5\n";

    #[test]
    fn text_with_lists_polygons_and_foreign_elements_is_read() {
        let mesh = parse(TEXT.as_bytes()).unwrap().mesh;
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
        assert_eq!(mesh.vertices[2], DVec3::new(1.0, 1.0, 0.0));
    }

    #[test]
    fn both_byte_orders_give_the_same_mesh() {
        let little = print(&tetrahedron(), &[]);
        let header = little.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
        let mut big = String::from_utf8(little[..header].to_vec()).unwrap().replace("little", "big").into_bytes();
        for value in little[header..header + 96].chunks(8) {
            big.extend(value.iter().rev());
        }
        for face in little[header + 96..].chunks(13) {
            big.push(face[0]);
            face[1..].chunks(4).for_each(|index| big.extend(index.iter().rev()));
        }
        assert_eq!(parse(&little).unwrap().mesh, tetrahedron());
        assert_eq!(parse(&big).unwrap().mesh, tetrahedron());
    }

    #[test]
    fn strips_are_read() {
        // Two strips in one list, the second with a corner twice, which turns what follows.
        let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
            element tristrips 2\nproperty list int int vertex_indices\nend_header\n\
            0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 1 3 2 2\n3 2 3 4\n";
        let triangles = [[0, 1, 2], [1, 3, 2], [1, 3, 2], [2, 3, 4]];
        assert_eq!(parse(text.as_bytes()).unwrap().mesh.triangles, triangles);
        let fault = |to: &str| parse(text.replace("3 2 3 4", to).as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("3 2 3 -2"), "line 16: index -2 is outside the 5 vertices");
        assert_eq!(fault("3 2 3 5"), "line 17: index 5 is outside the 5 vertices");
        assert_eq!(fault("4 2 3 4"), "line 17: ends where a number is expected");
    }

    #[test]
    fn normals_and_texture_coordinates_go_to_the_corners() {
        let text = "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nproperty float nx\r\n\
            property float ny\r\nproperty float nz\r\nproperty float s\r\nproperty float t\r\nelement face 1\r\n\
            property list uchar int vertex_index\r\nend_header\r\n0 0 0 0 0 2 0 0\r\n1 0 0 0 0 1 1 0\r\n0 1 0 0 0 1 0 1\r\n3 0 1 2\r\n";
        let mesh = parse(text.as_bytes()).unwrap().mesh;
        assert_eq!(mesh.corner_normals, [[DVec3::Z; 3]]);
        assert_eq!(mesh.corner_parameters, [[DVec2::ZERO, DVec2::X, DVec2::Y]]);
    }

    #[test]
    fn surfaces_of_faces_come_back_with_their_names() {
        let mesh = Mesh { surfaces: vec![0, 2, 2, 1], ..tetrahedron() };
        let names = ["lid", "the  side\n", ""].map(String::from);
        let back = parse(&print(&mesh, &names)).unwrap();
        assert_eq!(
            (&back.mesh, back.names.as_slice()),
            (&mesh, ["lid", "the side", "surface 2"].map(String::from).as_slice())
        );
        let absurd = TEXT.replace("comment c", "comment surface 4000000000 x").replace("uchar flags", "uchar surface");
        let read = parse(absurd.as_bytes()).unwrap();
        assert_eq!((read.mesh.surfaces, read.names.len()), (vec![1, 1, 1], 0));
    }

    #[test]
    fn faults_name_line_or_byte() {
        let fault = |text: &str| parse(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("plx\n"), "line 1: expected ply, found `plx`");
        assert_eq!(fault(&TEXT.replace("float y", "quad y")), "line 6: expected a number type, found `quad`");
        assert_eq!(
            fault(&TEXT.replace("property float z\n", "")),
            "line 15: ends where the vertex properties x, y and z is expected"
        );
        assert_eq!(
            fault(&TEXT.replace("1 0 0 2 7 7 9", "1 zero 0 2 7 7 9")),
            "line 17: expected a number, found `zero`"
        );
        assert_eq!(
            fault(&TEXT.replace("1 3 0 1 2\n", "1 2 0 1\n")),
            "line 21: a face needs at least 3 corners, this one has 2"
        );
        assert_eq!(fault(&TEXT.replace("1 3 0 1 2\n", "1 3 0 1 -2\n")), "line 21: index -2 is outside the 4 vertices");
        assert_eq!(fault("ply\nformat ascii 1.0\nelement vertex 3\n"), "line 4: ends where end_header is expected");
        let short = print(&tetrahedron(), &[]);
        let fault = parse(&short[..short.len() - 1]).unwrap_err();
        assert_eq!(fault.to_string(), format!("byte {}: ends where a number is expected", short.len() - 4));
    }

    #[test]
    fn absurd_counts_are_refused_before_anything_is_reserved() {
        for absurd in ["4294967295", "18446744073709551615"] {
            let fault = parse(TEXT.replace("vertex 4", &format!("vertex {absurd}")).as_bytes()).unwrap_err();
            assert!(matches!(fault.problem, MeshProblem::TooMany { .. }), "{fault}");
        }
    }
}
