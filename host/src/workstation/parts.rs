//! The vectors or polygons of an object, for each of its materials.

use super::{
    Drawing, DrawnEdges, WorkstationError,
    facets::{self, mirrored},
    names::name,
    structure_commands::StructureCommands,
};
use crate::{
    illumination::Material,
    mesh::{EdgeSelection, Polylines, Viewer, polylines_of_groups},
    scene::Object,
    surface::Tolerance,
};
use glam::{DAffine3, DVec3};
use protocol::command::{Command, Object as Node, VectorClass, VectorList};

/// What an object has of one material.
pub(super) struct MaterialPart {
    /// The material.
    pub(super) material: Material,
    /// Vectors or polygons.
    pub(super) data: Node,
}

/// How finely an object is drawn, and for whom.
pub(super) struct Fineness {
    /// Between curved surfaces and triangles, in the object's own coordinates.
    pub(super) tolerance: Tolerance,
    /// From where outlines are seen, in the coordinates that the object is placed in.
    pub(super) eye: DVec3,
    /// Triangles to which a mesh of no exact surface is simplified; all stay without it.
    pub(super) most_triangles: Option<usize>,
}

/// The vectors or polygons of one object as it is placed, those of each of its materials; what its polygons look like is
/// defined on the way.
///
/// - `surfaces`: what the names of the ATTRIBUTES of its materials begin with. `out`: counts lines and points.
///
/// # Errors
/// [`WorkstationError::Scene`], if it cannot be tessellated, or lies too far away.
pub(super) fn parts(
    object: &Object,
    surfaces: &str,
    fineness: &Fineness,
    drawing: &Drawing,
    out: &mut StructureCommands,
) -> Result<Vec<MaterialPart>, WorkstationError> {
    let failed = |e: String| WorkstationError::Scene(format!("{}: {e}", object.name));
    let mut made = object.shape.tessellate(fineness.tolerance).map_err(|e| failed(e.to_string()))?;
    let is_too_fine = fineness.most_triangles.is_some_and(|most| made.mesh.triangles.len() > most);
    if let Some(most) = fineness.most_triangles.filter(|_| is_too_fine && object.shape.extent().is_none()) {
        made.mesh = made.mesh.simplified(most);
        made.operand_of.clear();
    }
    let mesh = made.mesh.transformed(&DAffine3::from_mat4(object.transform));
    let (materials, material_of) = object.materials(&made.operand_of);
    let selection = match drawing.lines {
        DrawnEdges::Grid => EdgeSelection::grid(drawing.crease_degrees),
        // The machine finds the outline of polygons itself, from wherever they are seen.
        DrawnEdges::Outline if drawing.facets => EdgeSelection::creases(drawing.crease_degrees),
        DrawnEdges::Outline => EdgeSelection::drawing(drawing.crease_degrees, Viewer::Point(fineness.eye)),
        DrawnEdges::All => EdgeSelection::ALL,
    };
    let mut lines = made.lines;
    if !drawing.facets || !lines.points.is_empty() {
        let to_place = |point: &mut DVec3| *point = object.transform.transform_point3(*point);
        lines.points.iter_mut().for_each(to_place);
        let mut runs = polylines_of_groups(&mesh, &selection, &material_of, materials.len());
        if let Some(first) = runs.first_mut() {
            first.extend(lines);
        }
        let part = |(material, runs): (Material, &Polylines)| {
            let data = vectors(runs, out).map(Node::VectorList).map_err(failed)?;
            Ok(MaterialPart { material, data })
        };
        return materials.into_iter().zip(&runs).map(part).collect();
    }
    let surface = |k: usize| if k == 0 { surfaces.to_owned() } else { format!("{surfaces}_{}", k + 1) };
    let surfaces: Vec<String> = (0..materials.len()).map(surface).collect();
    let groups = facets::polygons(&mesh, &selection, &material_of, &surfaces).map_err(failed)?;
    for (surface, material) in surfaces.iter().zip(&materials) {
        out.commands.push(attributes(surface, material));
    }
    let corners = 3 * groups.iter().map(Vec::len).sum::<usize>();
    out.points += corners;
    out.lines += corners;
    Ok(materials
        .into_iter()
        .zip(groups)
        .map(|(material, group)| MaterialPart { material, data: Node::Polygons(group) })
        .collect())
}

/// Defines what polygons of a material look like.
pub(super) fn attributes(surface: &str, material: &Material) -> Command {
    Command::Define { name: Some(name(surface)), object: Node::Attributes(facets::attributes(material)) }
}

/// Runs of lines in the coordinates of the scene, or of what they are part of.
///
/// # Errors
/// A point is too far away for single precision.
pub(super) fn vectors(runs: &Polylines, out: &mut StructureCommands) -> Result<VectorList, String> {
    let mut list = VectorList {
        block_normalized: false,
        fourth: protocol::command::Fourth::Intensity,
        internal_units: false,
        class: VectorClass::Itemized,
        dimension: 3,
        estimate: u32::try_from(runs.points.len()).ok(),
        points: Vec::with_capacity(runs.points.len()),
        lines: Vec::with_capacity(runs.points.len()),
    };
    for run in runs.runs() {
        for (i, p) in run.iter().enumerate() {
            let point = mirrored(*p).as_vec3();
            if !point.is_finite() {
                return Err(format!("the point {p} is too far away for the workstation"));
            }
            list.points.push([point.x, point.y, point.z, 1.0]);
            list.lines.push(i > 0);
        }
    }
    out.lines += runs.lines();
    out.points += list.points.len();
    Ok(list)
}
