//! The nodes of a glTF file: which meshes they place, and where.

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::super::{Fault, MeshProblem, PlaceRow};
use super::accessor::Buffers;
use super::document::LocatedValue;
use crate::memory;

/// What a node places many times.
pub const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// Why a row cannot be.
const NOT_FINITE: &str = "a coordinate is not finite";

/// A mesh as a node places it.
pub struct MeshUse {
    /// Number of the mesh.
    pub mesh: usize,
    /// Number of the node; none where a file has no scene.
    pub node: Option<usize>,
    /// From coordinates of the node to those of the file.
    pub to_file: DAffine3,
    /// Where in coordinates of the node it is; none where it is only at the node itself.
    pub rows: Option<Vec<PlaceRow>>,
}

impl MeshUse {
    /// How often the mesh is there.
    pub fn count(&self) -> usize {
        self.rows.as_ref().map_or(1, Vec::len)
    }

    /// Where in the file the mesh is.
    pub fn placements(&self) -> impl Iterator<Item = DAffine3> + '_ {
        let at =
            |number: usize| self.rows.as_ref().map_or(self.to_file, |rows| self.to_file * rows[number].placement());
        (0..self.count()).map(at)
    }
}

/// What the nodes of the default scene place, or those of the first one; without any, all meshes where they are. The
/// order is that of the file, a node before its children.
pub fn uses<'a>(buffers: &Buffers<'a>) -> Result<Vec<MeshUse>, Fault> {
    let root = buffers.root;
    let scene = match root.get("scene") {
        Some(at) => Some(at.named(&root, "scenes")?),
        None => root.element("scenes", 0),
    };
    let Some(scene) = scene else {
        let count = root.list("meshes")?.len();
        let whole = |mesh| MeshUse { mesh, node: None, to_file: DAffine3::IDENTITY, rows: None };
        return Ok((0..count).map(whole).collect());
    };
    let mut waiting: Vec<(LocatedValue<'a>, DAffine3)> = Vec::new();
    let mut is_reached = vec![false; root.list("nodes")?.len()];
    let mut uses = Vec::new();
    for at in scene.list("nodes")?.into_iter().rev() {
        waiting.push((at, DAffine3::IDENTITY));
    }
    while let Some((at, outer)) = waiting.pop() {
        let (node, number) = (at.named(&root, "nodes")?, at.count()?);
        if std::mem::replace(&mut is_reached[number], true) {
            return Err(at.expected("a node that is reached only once"));
        }
        let to_file = outer * placement(node)?;
        if !to_file.is_finite() {
            return Err(node.fault(MeshProblem::NotFinite));
        }
        if let Some(mesh) = node.get("mesh") {
            mesh.named(&root, "meshes")?;
            let rows = rows(buffers, node, &to_file)?;
            uses.push(MeshUse { mesh: mesh.count()?, node: Some(number), to_file, rows });
        }
        for child in node.list("children")?.into_iter().rev() {
            waiting.push((child, to_file));
        }
    }
    Ok(uses)
}

/// Where a node stands in its parent.
fn placement(node: LocatedValue<'_>) -> Result<DAffine3, Fault> {
    if let Some(matrix) = node.numbers::<16>("matrix")? {
        let matrix = DMat4::from_cols_array(&matrix);
        if matrix.row(3) != DVec4::W {
            return Err(node.need("matrix")?.expected("an affine matrix"));
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let translation = node.numbers("translation")?.map_or(DVec3::ZERO, DVec3::from_array);
    let scale = node.numbers("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = node.numbers::<4>("rotation")?.map_or(DQuat::IDENTITY, DQuat::from_array);
    let length = rotation.length();
    if !(length > 0.0 && length.is_finite()) {
        return Err(node.need("rotation")?.expected("a unit quaternion"));
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}

/// Where a node has its mesh by the extension; tables of other names are left out.
///
/// # Source
/// Khronos Group, EXT_mesh_gpu_instancing, 2020: each instance has a translation, a rotation and a scale below the node,
/// and all tables have as many rows.
fn rows<'a>(buffers: &Buffers<'a>, node: LocatedValue<'a>, to_file: &DAffine3) -> Result<Option<Vec<PlaceRow>>, Fault> {
    let Some(extension) = node.get("extensions").and_then(|all| all.get(INSTANCING)) else { return Ok(None) };
    let attributes = extension.need("attributes")?;
    let known = ["TRANSLATION", "ROTATION", "SCALE"].into_iter().find_map(|key| attributes.get(key));
    let first = known.or_else(|| attributes.any_member()).ok_or_else(|| attributes.expected("a table"))?;
    let count = buffers.count(first)?;
    memory::reserve((count * size_of::<PlaceRow>()) as u64, || format!("reading {count} instances"))
        .map_err(|excess| attributes.fault(excess.into()))?;
    let mut rows = vec![PlaceRow::IDENTITY; count];
    if let Some(at) = attributes.get("TRANSLATION") {
        for (row, value) in rows.iter_mut().zip(table(buffers, at, "VEC3", count)?) {
            row.translation = value;
        }
    }
    if let Some(at) = attributes.get("ROTATION") {
        let rotations = table::<4>(buffers, at, "VEC4", count)?;
        let has_length = |of: &[f32; 4]| of.iter().any(|x| *x != 0.0);
        if let Some(row) = rotations.iter().position(|rotation| !has_length(rotation)) {
            return Err(at.fault(MeshProblem::Row { row, what: "expected a unit quaternion" }));
        }
        for (row, value) in rows.iter_mut().zip(rotations) {
            row.rotation = value;
        }
    }
    if let Some(at) = attributes.get("SCALE") {
        for (row, value) in rows.iter_mut().zip(table(buffers, at, "VEC3", count)?) {
            row.scale = value;
        }
    }
    match rows.iter().position(|row| !(*to_file * row.placement()).is_finite()) {
        Some(row) => Err(attributes.fault(MeshProblem::Row { row, what: NOT_FINITE })),
        None => Ok(Some(rows)),
    }
}

/// A table of instances, of finite numbers.
fn table<'a, const N: usize>(
    buffers: &Buffers<'a>,
    at: LocatedValue<'a>,
    kind: &'static str,
    count: usize,
) -> Result<Vec<[f32; N]>, Fault> {
    let table = buffers.table::<N>(at, kind)?;
    if table.len() != count {
        return Err(at.fault(MeshProblem::Rows { rows: table.len(), count }));
    }
    let single: Vec<[f32; N]> = table.into_iter().map(|row| row.map(|x| x as f32)).collect();
    match single.iter().position(|row| row.iter().any(|x| !x.is_finite())) {
        Some(row) => Err(at.fault(MeshProblem::Row { row, what: NOT_FINITE })),
        None => Ok(single),
    }
}
