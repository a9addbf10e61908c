//! The meshes of a glTF file, and what becomes of them: one mesh, or each once.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::fan::strip;
use super::super::groups::{Grouped, Groups, MetallicRoughness};
use super::super::placed::{MOST_REPEATED, MeshPlace, MeshPlaces, PlacedMeshes, RepeatedMesh, is_flat};
use super::super::triangles::MAX_COUNT;
use super::super::{Fault, Mesh, MeshProblem};
use super::accessor::Buffers;
use super::document::LocatedValue;
use super::nodes::{self, MeshUse};
use crate::memory;

/// Bytes of a triangle while vertices at the same position become one: corners, normals, parameters, numbers and three
/// vertices, all of them twice.
const TRIANGLE_BYTES: u64 = 420;

/// So many triangles may come of meshes that are placed many times, even if the file is small and memory has no limit.
const MOST_SHARED: u64 = 1 << 22;

/// The meshes of a file, and where they are.
pub struct MeshReader<'a> {
    buffers: Buffers<'a>,
    /// What the nodes place, in the order in which triangles are told.
    uses: Vec<MeshUse>,
    /// How many triangles each mesh has; 0 for those that no node places.
    triangles: Vec<u64>,
}

/// The triangles of one primitive.
struct Part<'a> {
    mesh: Mesh,
    /// What its material is called.
    material: &'a str,
    look: Option<MetallicRoughness>,
}

impl<'a> MeshReader<'a> {
    /// Looks at the nodes; zero scales leave nothing of what they place.
    pub fn new(buffers: Buffers<'a>) -> Result<MeshReader<'a>, Fault> {
        let uses = nodes::uses(&buffers)?;
        let triangles = vec![0; buffers.root.list("meshes")?.len()];
        let mut reader = MeshReader { buffers, uses, triangles };
        let mut used = vec![false; reader.triangles.len()];
        reader.uses.iter().for_each(|of| used[of.mesh] = true);
        for number in (0..used.len()).filter(|mesh| used[*mesh]) {
            let mut count = 0_u64;
            for primitive in reader.mesh(number)?.list("primitives")? {
                count = count.saturating_add(reader.triangles_of(primitive)?);
            }
            reader.triangles[number] = count;
        }
        reader.uses.retain(|of| reader.triangles[of.mesh] > 0);
        Ok(reader)
    }

    /// All triangles where they are, as one mesh.
    pub fn together(&self) -> Result<Grouped, Fault> {
        self.copied(|_, _| true)
    }

    /// Each mesh that is placed more than once as it is, and all others as one mesh.
    pub fn placed(self) -> Result<PlacedMeshes, Fault> {
        let mut counts = vec![0_u64; self.triangles.len()];
        for of in &self.uses {
            counts[of.mesh] += of.placements().filter(|placement| !is_flat(&placement.matrix3)).count() as u64;
        }
        let mut number_of: HashMap<usize, u32> = HashMap::new();
        let mut repeated = Vec::new();
        for of in &self.uses {
            if counts[of.mesh] < 2 || number_of.contains_key(&of.mesh) || repeated.len() == MOST_REPEATED {
                continue;
            }
            number_of.insert(of.mesh, repeated.len() as u32);
            let mesh = self.mesh(of.mesh)?;
            let name = mesh.text_of("name")?.unwrap_or_default();
            let mut whole = Assembly::default();
            whole.add(mesh, name, &self.parts(mesh)?, None)?;
            repeated.push(RepeatedMesh { name: name.to_owned(), grouped: whole.into_grouped() });
        }
        let is_copied = |mesh: usize, map: &DMat3| !number_of.contains_key(&mesh) || is_flat(map);
        let alone = self.copied(is_copied)?;
        let (mut places, mut batches) = (MeshPlaces::default(), Vec::new());
        for MeshUse { mesh, to_file, rows, .. } in self.uses {
            let Some(&mesh) = number_of.get(&mesh) else { continue };
            match rows {
                Some(mut rows) => {
                    rows.retain(|row| !is_flat(&(to_file * row.placement()).matrix3));
                    batches.push((mesh, to_file, rows));
                }
                None if !is_flat(&to_file.matrix3) => places.push(MeshPlace { mesh, placement: to_file }),
                None => {}
            }
        }
        batches.into_iter().for_each(|(mesh, to_file, rows)| places.extend(mesh, to_file, rows));
        Ok(PlacedMeshes { alone, repeated, places })
    }

    /// Those of the placed meshes that count, as one mesh.
    ///
    /// - `counts`: told the number of the mesh and how it is placed.
    fn copied(&self, counts: impl Fn(usize, &DMat3) -> bool) -> Result<Grouped, Fault> {
        let copies = || {
            let copies = self.uses.iter().flat_map(|of| of.placements().map(move |placement| (of, placement)));
            copies.filter(|(of, placement)| placement.matrix3 != DMat3::ZERO && counts(of.mesh, &placement.matrix3))
        };
        // Where nobody tells how much memory there is, a small file does not become a huge mesh.
        let unlimited = || (self.buffers.total as u64).max(MOST_SHARED);
        let most = if memory::limit().is_some() { MAX_COUNT as u64 } else { unlimited().min(MAX_COUNT as u64) };
        let (mut meshes, mut triangles) = (0_u64, 0_u64);
        let mut left = vec![0_u64; self.triangles.len()];
        for (of, _) in copies() {
            meshes += 1;
            left[of.mesh] += 1;
            triangles = triangles.saturating_add(self.triangles[of.mesh]);
            if triangles > most {
                let problem = MeshProblem::TooMany { what: "triangles", count: triangles, limit: most };
                return Err(self.mesh(of.mesh)?.fault(problem));
            }
        }
        let what = || format!("placing {meshes} meshes of {triangles} triangles");
        memory::reserve(triangles * TRIANGLE_BYTES, what).map_err(|excess| self.buffers.root.fault(excess.into()))?;
        let mut whole = Assembly::default();
        let mut known: HashMap<usize, Rc<Vec<Part<'a>>>> = HashMap::new();
        for (of, placement) in copies() {
            let mesh = self.mesh(of.mesh)?;
            let parts = match known.remove(&of.mesh) {
                Some(parts) => parts,
                None => Rc::new(self.parts(mesh)?),
            };
            let node = of.node.and_then(|node| self.buffers.root.element("nodes", node));
            let node = node.map(|node| node.text_of("name")).transpose()?.flatten();
            let name = mesh.text_of("name")?.or(node).unwrap_or_default();
            whole.add(mesh, name, &parts, Some(&placement))?;
            left[of.mesh] -= 1;
            if left[of.mesh] > 0 {
                known.insert(of.mesh, parts);
            }
        }
        Ok(whole.into_grouped())
    }

    /// A mesh by its number, which was checked.
    fn mesh(&self, number: usize) -> Result<LocatedValue<'a>, Fault> {
        let root = self.buffers.root;
        root.element("meshes", number).ok_or_else(|| root.fault(MeshProblem::Missing))
    }

    /// The triangles of a mesh.
    fn parts(&self, mesh: LocatedValue<'a>) -> Result<Vec<Part<'a>>, Fault> {
        let mut parts = Vec::new();
        for primitive in mesh.list("primitives")? {
            let Some(mesh) = self.primitive(primitive)? else { continue };
            let material = primitive.get("material").map(|at| at.named(&self.buffers.root, "materials")).transpose()?;
            let called = material.map(|at| at.text_of("name")).transpose()?.flatten();
            let look = material.map(material_of).transpose()?.flatten();
            parts.push(Part { mesh, material: called.unwrap_or_default(), look });
        }
        Ok(parts)
    }

    /// How many triangles a primitive has, by the lengths of its tables.
    fn triangles_of(&self, primitive: LocatedValue<'a>) -> Result<u64, Fault> {
        let Some((mode, position)) = surface_of(primitive)? else { return Ok(0) };
        let corners = self.buffers.count(primitive.get("indices").unwrap_or(position))? as u64;
        Ok(if mode == 4 { corners / 3 } else { corners.saturating_sub(2) })
    }

    /// The triangles of a primitive; none if it is made of points or lines.
    fn primitive(&self, primitive: LocatedValue<'a>) -> Result<Option<Mesh>, Fault> {
        let Some((mode, position)) = surface_of(primitive)? else { return Ok(None) };
        let bytes = self.triangles_of(primitive)? * TRIANGLE_BYTES;
        memory::reserve(bytes, || "reading its triangles".into()).map_err(|excess| primitive.fault(excess.into()))?;
        let attributes = primitive.need("attributes")?;
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
        // Few triangles of a long table leave its other vertices behind.
        let is_sparse = mesh.vertices.len() > 3 * mesh.triangles.len();
        Ok(Some(if is_sparse { mesh.welded() } else { mesh }))
    }
}

/// How the corners of a primitive make triangles, and the table of their positions; none if it is made of points or lines.
fn surface_of(primitive: LocatedValue<'_>) -> Result<Option<(usize, LocatedValue<'_>)>, Fault> {
    let mode = primitive.count_or("mode", 4)?;
    let position = primitive.need("attributes")?.get("POSITION");
    Ok(position.filter(|_| (4..=6).contains(&mode)).map(|position| (mode, position)))
}

/// A mesh in the making.
#[derive(Default)]
struct Assembly {
    mesh: Mesh,
    /// Whether there are normals anywhere.
    has_normals: bool,
    /// Whether texture coordinates are missing somewhere.
    lacks_parameters: bool,
    groups: Groups,
}

impl Assembly {
    /// Adds the triangles of a mesh, placed or as they are.
    ///
    /// - `name`: what it is called.
    fn add(
        &mut self,
        mesh: LocatedValue<'_>,
        name: &str,
        parts: &[Part<'_>],
        placement: Option<&DAffine3>,
    ) -> Result<(), Fault> {
        for Part { mesh: part, material, look } in parts {
            let group = [name, material].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("/");
            self.has_normals |= !part.corner_normals.is_empty();
            self.lacks_parameters |= part.corner_parameters.is_empty() && !part.triangles.is_empty();
            let mut part = placement.map_or_else(|| part.clone(), |placement| part.transformed(placement));
            if part.corner_normals.is_empty() {
                // Without normals, a mesh has flat faces, whatever others have.
                let flat = |triangle| [part.face_normal(triangle).unwrap_or_default(); 3];
                part.corner_normals = (0..part.triangles.len()).map(flat).collect();
            }
            self.mesh.append(&part, 0);
            if self.mesh.vertices.iter().rev().take(part.vertices.len()).any(|vertex| !vertex.is_finite()) {
                return Err(mesh.fault(MeshProblem::NotFinite));
            }
            self.groups.extend(&group, *look, self.mesh.triangles.len());
        }
        Ok(())
    }

    fn into_grouped(self) -> Grouped {
        let mut mesh = self.mesh;
        if !self.has_normals {
            mesh.corner_normals = Vec::new();
        }
        if self.lacks_parameters {
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
