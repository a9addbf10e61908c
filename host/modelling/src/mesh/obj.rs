//! Wavefront OBJ: positions, normals, texture coordinates, polygons and groups of a text file.
//!
//! Triangles with the same object, group and material (`o`, `g` and `usemtl`) are a group.
//!
//! Not modelled: free-form curves and surfaces, properties of materials, lines and points; their statements are
//! skipped.
//!
//! # Source
//! Wavefront Technologies, Advanced Visualizer manual, appendix B1.

use std::collections::HashMap;
use std::fmt::Write;

use glam::{DVec2, DVec3};

use super::error::shortened;
use super::fan::fan;
use super::groups::{Grouped, Groups, has_groups, name_of};
use super::measure::bits;
use super::{Fault, FaultLocation, Mesh, MeshProblem};

/// A corner of a face: indices into positions, texture coordinates and normals.
type Corner = (u32, Option<u32>, Option<u32>);

#[derive(Default)]
struct Content {
    positions: Vec<DVec3>,
    parameters: Vec<DVec2>,
    normals: Vec<DVec3>,
    triangles: Vec<[Corner; 3]>,
    groups: Groups,
    /// The current object, group and material.
    names: [String; 3],
}

/// Understands an OBJ file.
pub(super) fn parse(bytes: &[u8]) -> Result<Grouped, Fault> {
    let mut content = Content::default();
    let mut lines = bytes.split(|&byte| byte == b'\n').enumerate();
    let mut corners = Vec::new();
    while let Some((index, line)) = lines.next() {
        let mut text = String::from_utf8_lossy(line).into_owned();
        while let Some(kept) = text.trim_end().strip_suffix('\\').map(str::len) {
            text.truncate(kept);
            match lines.next() {
                Some((_, more)) => text.push_str(&String::from_utf8_lossy(more)),
                None => break,
            }
        }
        let text = text.split('#').next().unwrap_or_default();
        statement(text, &mut content, &mut corners).map_err(|problem| FaultLocation::Line(index + 1).fault(problem))?;
    }
    Ok(content.into_grouped())
}

fn statement(text: &str, content: &mut Content, corners: &mut Vec<Corner>) -> Result<(), MeshProblem> {
    let mut words = text.split_ascii_whitespace();
    match words.next() {
        Some("v") => content.positions.push(DVec3::from_array(numbers(&mut words)?)),
        Some("vn") => content.normals.push(unit(DVec3::from_array(numbers(&mut words)?))),
        Some("vt") => {
            let [u] = numbers(&mut words)?;
            let v = if text.split_ascii_whitespace().count() > 2 { numbers::<1>(&mut words)?[0] } else { 0.0 };
            content.parameters.push(DVec2::new(u, v));
        }
        Some("f") => {
            corners.clear();
            for word in words {
                corners.push(corner(word, content)?);
            }
            if corners.len() < 3 {
                return Err(MeshProblem::FewCorners(corners.len()));
            }
            content.triangles.extend(fan(corners));
            let count = content.triangles.len();
            content.groups.extend(&content.group(), None, count);
        }
        Some(word @ ("o" | "g" | "usemtl")) => {
            let which = usize::from(word != "o") + usize::from(word == "usemtl");
            content.names[which] = words.collect::<Vec<_>>().join(" ");
        }
        _ => {}
    }
    Ok(())
}

/// `normal` with unit length; one that has it up to rounding keeps its bits.
fn unit(normal: DVec3) -> DVec3 {
    let is_unit = (normal.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON;
    if is_unit { normal } else { normal.normalize_or_zero() }
}

fn numbers<'a, const N: usize>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f64; N], MeshProblem> {
    let mut result = [0.0; N];
    for value in &mut result {
        let word = words.next().ok_or(MeshProblem::Ends("a number"))?;
        *value = number(word)?;
    }
    Ok(result)
}

/// A finite number.
pub(super) fn number(word: &str) -> Result<f64, MeshProblem> {
    let value: f64 =
        word.parse().map_err(|_| MeshProblem::Expected { expected: "a number", found: shortened(word) })?;
    if value.is_finite() { Ok(value) } else { Err(MeshProblem::NotFinite) }
}

fn corner(word: &str, content: &Content) -> Result<Corner, MeshProblem> {
    let mut parts = word.split('/');
    let position = index(parts.next().unwrap_or_default(), content.positions.len(), "vertices")?;
    let mut optional = |count, table| match parts.next() {
        None | Some("") => Ok(None),
        Some(part) => index(part, count, table).map(Some),
    };
    let parameter = optional(content.parameters.len(), "texture coordinates")?;
    let normal = optional(content.normals.len(), "normals")?;
    match parts.next() {
        None => Ok((position, parameter, normal)),
        Some(_) => Err(MeshProblem::Expected { expected: "a corner v/vt/vn", found: shortened(word) }),
    }
}

/// An index from 1, or backwards from -1 (the last entry so far).
fn index(word: &str, count: usize, table: &'static str) -> Result<u32, MeshProblem> {
    let index: i64 =
        word.parse().map_err(|_| MeshProblem::Expected { expected: "an index", found: shortened(word) })?;
    let from_zero = if index > 0 { index - 1 } else { index.saturating_add(count as i64) };
    match u32::try_from(from_zero) {
        Ok(entry) if index != 0 && (entry as usize) < count => Ok(entry),
        _ => Err(MeshProblem::Index { index, count, table }),
    }
}

impl Content {
    /// What the current group is called: the different ones of its names.
    fn group(&self) -> String {
        let mut names: Vec<&str> = self.names.iter().map(String::as_str).filter(|name| !name.is_empty()).collect();
        names.dedup();
        names.join("/")
    }

    fn into_grouped(self) -> Grouped {
        let per_corner = |(_, parameter, _): Corner| parameter.map(|index| self.parameters[index as usize]);
        let corner_parameters = all_corners(&self.triangles, per_corner);
        let per_corner = |(_, _, normal): Corner| normal.map(|index| self.normals[index as usize]);
        let corner_normals = all_corners(&self.triangles, per_corner);
        let triangles = self.triangles.iter().map(|corners| corners.map(|(position, ..)| position)).collect();
        let surfaces = Vec::new();
        self.groups.on(Mesh { vertices: self.positions, triangles, corner_normals, corner_parameters, surfaces })
    }
}

/// A table per corner, empty unless every corner has its entry.
fn all_corners<T>(triangles: &[[Corner; 3]], entry: impl Fn(Corner) -> Option<T>) -> Vec<[T; 3]> {
    let row = |&[a, b, c]: &[Corner; 3]| Some([entry(a)?, entry(b)?, entry(c)?]);
    triangles.iter().map(row).collect::<Option<_>>().unwrap_or_default()
}

/// The text of `mesh`; every number reads back to the same bits. Groups and materials are the names of surfaces, in
/// which spaces become underscores.
pub(super) fn print(mesh: &Mesh, names: &[String]) -> Vec<u8> {
    let mut text = String::with_capacity(mesh.vertices.len() * 48 + mesh.triangles.len() * 24);
    let mut line = |arguments: std::fmt::Arguments<'_>| text.write_fmt(arguments).expect("a string takes any text");
    for p in &mesh.vertices {
        line(format_args!("v {} {} {}\n", p.x, p.y, p.z));
    }
    let parameters =
        distinct(&mesh.corner_parameters, |p| bits(p.extend(0.0)), |p| line(format_args!("vt {} {}\n", p.x, p.y)));
    let normals = distinct(&mesh.corner_normals, |n| bits(*n), |n| line(format_args!("vn {} {} {}\n", n.x, n.y, n.z)));
    let (mut group, is_grouped) = (None, has_groups(mesh, names));
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let surface = mesh.surfaces.get(triangle).copied().filter(|_| is_grouped);
        if surface != group {
            let name = name_of(names, surface.unwrap_or_default()).replace([' ', '#', '\\'], "_");
            line(format_args!("g {name}\nusemtl {name}\n"));
            group = surface;
        }
        line(format_args!("f"));
        for k in 0..3 {
            let vertex = corners[k] + 1;
            match (parameters.get(triangle), normals.get(triangle)) {
                (None, None) => line(format_args!(" {vertex}")),
                (Some(t), None) => line(format_args!(" {vertex}/{}", t[k])),
                (None, Some(n)) => line(format_args!(" {vertex}//{}", n[k])),
                (Some(t), Some(n)) => line(format_args!(" {vertex}/{}/{}", t[k], n[k])),
            }
        }
        line(format_args!("\n"));
    }
    text.into_bytes()
}

/// Writes each different entry of a table per corner once; returns their numbers, from 1.
fn distinct<T>(table: &[[T; 3]], key: impl Fn(&T) -> [u64; 3], mut write: impl FnMut(&T)) -> Vec<[u32; 3]> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let mut number = |entry: &T| {
        let fresh = numbers.len() as u32 + 1;
        *numbers.entry(key(entry)).or_insert_with(|| {
            write(entry);
            fresh
        })
    };
    table.iter().map(|corners| corners.each_ref().map(&mut number)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_negative_indices_comments_and_continued_lines_are_understood() {
        let text = "# a square\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 \\\n 0\nvt 0.5\nvn 0 0 2\ng x\nf -4//1 2//1 3//-1 -1//1 # face\n";
        let Grouped { mesh, names, .. } = parse(text.as_bytes()).unwrap();
        assert_eq!((mesh.surfaces.as_slice(), names), ([0; 2].as_slice(), vec!["x".to_owned()]));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.vertices[3], DVec3::Y);
        assert_eq!(mesh.corner_normals, [[DVec3::Z; 3]; 2]);
        assert!(mesh.corner_parameters.is_empty());
    }

    #[test]
    fn a_table_that_some_corner_lacks_is_dropped() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nf 1/1 2/2 3\n";
        assert!(parse(text.as_bytes()).unwrap().mesh.corner_parameters.is_empty());
    }

    #[test]
    fn groups_come_back_with_their_names() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no a\ng a\nf 1 2 3\nusemtl red\nf 2 3 1\ng a\nf 1 2 3\no\ng\nusemtl\nf 3 1 2\n";
        let Grouped { mesh, names, .. } = parse(text.as_bytes()).unwrap();
        assert_eq!(
            (mesh.surfaces.as_slice(), &names),
            ([0, 1, 2, 2, 0].as_slice(), &["", "a", "a/red"].map(String::from).to_vec())
        );
        let back = parse(&print(&mesh, &names)).unwrap();
        assert_eq!(
            (&back.mesh, back.names.as_slice()),
            (&mesh, ["surface_0", "a", "a/red"].map(String::from).as_slice())
        );
        let ungrouped = Mesh { surfaces: Vec::new(), ..mesh };
        assert!(!String::from_utf8(print(&ungrouped, &[])).unwrap().contains("\ng"));
    }

    #[test]
    fn faults_name_their_line() {
        let fault = |text: &str| parse(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(fault("v 0 0 0\nv 1 x 0\n"), "line 2: expected a number, found `x`");
        assert_eq!(fault("\n\nv 1 2"), "line 3: ends where a number is expected");
        assert_eq!(fault("v 0 0 inf"), "line 1: a coordinate is not finite");
        assert_eq!(fault("v 0 0 0\nf 1 1 2\n"), "line 2: index 2 is outside the 1 vertices");
        assert_eq!(fault("v 0 0 0\nf 1 1 0\n"), "line 2: index 0 is outside the 1 vertices");
        assert_eq!(fault("v 0 0 0\nf 1 1\n"), "line 2: a face needs at least 3 corners, this one has 2");
        assert_eq!(fault("v 0 0 0\nf 1 1 1/1/1/1\n"), "line 2: index 1 is outside the 0 texture coordinates");
        assert_eq!(fault("v 0 0 0\nf 1 1 1///1\n"), "line 2: expected a corner v/vt/vn, found `1///1`");
    }
}
