//! Drawings of plants as objects: a mesh for each material of strokes, instances for what is placed.

use super::made_mesh::MadeMesh;
use super::object::{Instances, Object, PlacementList, Placing, Shape};
use crate::illumination::Material;
use crate::mesh::Mesh;
use crate::numeric::sampling::mix;
use crate::octree::Instance;
use crate::procedural::drawing::{DrawingError, PlantDrawing};
use glam::DMat4;
use std::sync::Arc;

/// Of what a pixel spans, the part by which triangles may be off.
const CHORD: f64 = 0.25;

/// The objects of a drawing: of each colour that it has, its triangles, and instances of what it places.
///
/// - `name`: of an object of a colour. `material`: of a colour; none for what has that of the whole.
/// - `detail`: what a pixel spans, units of length.
///
/// # Errors
/// What is wrong with the drawing.
pub fn drawn_objects(
    drawing: &PlantDrawing,
    name: impl Fn(u32) -> String,
    material: impl Fn(u32) -> Option<Material>,
    detail: f64,
) -> Result<Vec<Object>, DrawingError> {
    let object = |colour: u32, shape: Shape| Object {
        name: name(colour),
        shape,
        transform: DMat4::IDENTITY,
        material: material(colour),
        tolerance: None,
    };
    let mut objects = Vec::new();
    for (colour, mesh) in by_colour(&drawing.unplaced_mesh(CHORD * detail)?) {
        objects.push(object(colour, Shape::Made(MadeMesh(Arc::new(mesh)))));
    }
    let mut colours: Vec<u32> = drawing.placed.iter().map(|placed| placed.colour).collect();
    colours.sort_unstable();
    colours.dedup();
    for colour in colours {
        let placed = || drawing.placed.iter().filter(move |placed| placed.colour == colour);
        let mut surfaces: Vec<usize> = placed().map(|placed| placed.surface).collect();
        surfaces.sort_unstable();
        surfaces.dedup();
        let mut prototypes = Vec::with_capacity(surfaces.len());
        for surface in &surfaces {
            let largest = placed().filter(|placed| placed.surface == *surface);
            let largest = largest.map(|placed| placed.placement.matrix3.x_axis.length()).fold(0.0, f64::max);
            let mut mesh = drawing.surfaces[*surface].mesh(CHORD * detail / largest.max(f64::MIN_POSITIVE))?;
            mesh.surfaces.fill(0);
            prototypes.push(vec![object(colour, Shape::Made(MadeMesh(Arc::new(mesh))))]);
        }
        let instance = |(number, placed): (usize, &crate::procedural::drawing::PlacedPredefined)| Instance {
            prototype: surfaces.partition_point(|surface| *surface < placed.surface) as u16,
            variation: mix(number as u64) as u16,
            placement: placed.placement,
        };
        let places = placed().enumerate().filter(|(_, placed)| placed.placement.matrix3.determinant() != 0.0);
        let placing = Placing::Listed(PlacementList(places.map(instance).collect()));
        objects.push(object(colour, Shape::Instances(Box::new(Instances { prototypes, placing }))));
    }
    Ok(objects)
}

/// The triangles of each colour, as meshes.
fn by_colour(mesh: &Mesh) -> Vec<(u32, Mesh)> {
    let mut colours = mesh.surfaces.clone();
    colours.sort_unstable();
    colours.dedup();
    let of = |colour: u32| {
        let mut own = Mesh::default();
        let mut numbers = vec![u32::MAX; mesh.vertices.len()];
        for (number, corners) in mesh.triangles.iter().enumerate().filter(|(at, _)| mesh.surfaces[*at] == colour) {
            let corners = corners.map(|corner| {
                let number = &mut numbers[corner as usize];
                if *number == u32::MAX {
                    *number = own.vertices.len() as u32;
                    own.vertices.push(mesh.vertices[corner as usize]);
                }
                *number
            });
            own.triangles.push(corners);
            own.corner_normals.push(mesh.corner_normals[number]);
            own.corner_parameters.push(mesh.corner_parameters[number]);
            own.surfaces.push(0);
        }
        (colour, own)
    };
    colours.into_iter().map(of).collect()
}
