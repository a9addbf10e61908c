//! Drawings as triangles.

use super::error::DrawingError;
use super::plant_drawing::{CrossSection, DrawnPolygon, PlacedPredefined, PlantDrawing};
use super::predefined::{PredefinedPart, PredefinedSurface};
use super::ribbons::{append_ribbon, ribbon_triangles};
use super::tubes::{Tube, append_sphere, push, sphere_triangles, tubes};
use crate::memory::{self, MemoryExceeded};
use crate::mesh::{Mesh, normal_matrix};
use crate::polygon::{TriangulationKind, triangulate_in_space};
use crate::surface::{Tolerance, tessellate};
use glam::{DVec2, DVec3};

/// Largest angle between the normals at neighbouring vertices of a patch, degrees.
const ANGLE: f64 = 30.0;
/// Coarsest tessellation of a patch in parts of its size.
const COARSEST: f64 = 0.05;
/// Bytes of a triangle with what is known at its corners, and of a vertex.
const TRIANGLE_BYTES: usize = 12 + 72 + 48 + 4;
const VERTEX_BYTES: usize = 24;

/// Asks for the memory of triangles and vertices, and makes room for them.
fn make_room(mesh: &mut Mesh, triangles: usize, vertices: usize) -> Result<(), MemoryExceeded> {
    let bytes = triangles.saturating_mul(TRIANGLE_BYTES).saturating_add(vertices.saturating_mul(VERTEX_BYTES));
    memory::reserve(bytes as u64, || format!("{triangles} triangles of a plant"))?;
    mesh.triangles.reserve(triangles);
    mesh.corner_normals.reserve(triangles);
    mesh.corner_parameters.reserve(triangles);
    mesh.surfaces.reserve(triangles);
    mesh.vertices.reserve(vertices);
    Ok(())
}

impl PlantDrawing {
    /// All that was drawn as triangles; the surface of each triangle is the number of its colour.
    ///
    /// - `detail`: largest distance between triangles and what they stand for, units of length, above 0.
    ///
    /// # Errors
    /// A detail that is no such length, and less memory than the triangles take.
    pub fn mesh(&self, detail: f64) -> Result<Mesh, DrawingError> {
        let mut mesh = self.unplaced_mesh(detail)?;
        self.append_placed(&mut mesh, detail)?;
        Ok(mesh)
    }

    /// What was drawn as triangles, without the surfaces that are placed; the surface of each triangle is the number of
    /// its colour.
    ///
    /// - `detail`: largest distance between triangles and what they stand for, units of length, above 0.
    ///
    /// # Errors
    /// A detail that is no such length, and less memory than the triangles take.
    pub fn unplaced_mesh(&self, detail: f64) -> Result<Mesh, DrawingError> {
        let mut mesh = self.stroke_mesh(detail)?;
        self.append_polygons(&mut mesh)?;
        self.append_spheres(&mut mesh, detail)?;
        Ok(mesh)
    }

    /// The strokes as tubes, each of them closed: flat where it begins, round where it ends; flat ones as blades. Strokes
    /// without width give nothing. Tubes are mitred at bends of up to 120 degrees; at sharper ones they end, and others begin.
    ///
    /// - `detail`: largest distance between triangles and tubes, units of length, above 0; no tube has more than 256
    ///   sides.
    ///
    /// # Errors
    /// A detail that is no such length, and less memory than the triangles take.
    pub fn stroke_mesh(&self, detail: f64) -> Result<Mesh, DrawingError> {
        if !(detail > 0.0 && detail.is_finite()) {
            return Err(DrawingError::Detail(detail));
        }
        let mut mesh = Mesh::default();
        let (mut triangles, mut vertices) = (0, 0);
        let strokes = || self.strokes.iter().map(|stroke| stroke.section).zip(self.strokes());
        for (section, nodes) in strokes() {
            if let CrossSection::Flat { .. } = section {
                triangles += ribbon_triangles(nodes);
                vertices += 2 * nodes.len();
                continue;
            }
            for tube in tubes(nodes, section, detail) {
                triangles += Tube::triangles(&tube);
                vertices += tube.vertices();
            }
        }
        make_room(&mut mesh, triangles, vertices)?;
        for (section, nodes) in strokes() {
            match section {
                CrossSection::Flat { across } => append_ribbon(&mut mesh, nodes, across),
                _ => tubes(nodes, section, detail).iter().for_each(|tube| tube.append_to(&mut mesh)),
            }
        }
        Ok(mesh)
    }

    /// Appends the filled polygons. Those that cross themselves, or do not lie on a plane and cross themselves when
    /// they are seen along an axis, become a fan around their first corner.
    fn append_polygons(&self, mesh: &mut Mesh) -> Result<(), DrawingError> {
        let corners: usize = self.polygons.iter().map(|polygon| polygon.corners.len()).sum();
        make_room(mesh, corners, corners)?;
        for DrawnPolygon { corners, colour } in &self.polygons {
            let corners = &self.corners[corners.clone()];
            let filled = triangulate_in_space(&[corners], TriangulationKind::Delaunay).map(|filled| filled.triangles);
            let fan = || (1..corners.len() as u32 - 1).map(|second| [0, second, second + 1]).collect();
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(corners);
            let across = (corners[1] - corners[0]).normalize_or_zero();
            for triangle in filled.unwrap_or_else(|_| fan()) {
                let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
                let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
                let along = normal.cross(across);
                let from_first = |corner: DVec3| corner - corners[0];
                let parameters =
                    [a, b, c].map(|corner| DVec2::new(from_first(corner).dot(across), from_first(corner).dot(along)));
                push(mesh, triangle.map(|corner| first + corner), [normal; 3], parameters, *colour);
            }
        }
        Ok(())
    }

    fn append_spheres(&self, mesh: &mut Mesh, detail: f64) -> Result<(), DrawingError> {
        let spheres = || self.spheres.iter().filter(|sphere| sphere.radius > 0.0);
        let triangles: usize = spheres().map(|sphere| sphere_triangles(sphere, detail)).sum();
        make_room(mesh, triangles, triangles)?;
        spheres().for_each(|sphere| append_sphere(mesh, sphere, detail));
        Ok(())
    }

    /// Appends predefined surfaces; each is tessellated once, for the largest of its places.
    fn append_placed(&self, mesh: &mut Mesh, detail: f64) -> Result<(), DrawingError> {
        let scale = |place: &PlacedPredefined| place.placement.matrix3.x_axis.length();
        let mut prototypes = Vec::new();
        for (number, surface) in self.surfaces.iter().enumerate() {
            let places = self.placed.iter().filter(|place| place.surface == number);
            let largest = places.clone().map(scale).fold(0.0, f64::max);
            let prototype = if largest > 0.0 { surface.mesh(detail / largest)? } else { Mesh::default() };
            let count = places.count();
            make_room(mesh, count * prototype.triangles.len(), count * prototype.vertices.len())?;
            prototypes.push(prototype);
        }
        for place in self.placed.iter().filter(|place| scale(place) > 0.0) {
            let prototype = &prototypes[place.surface];
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(prototype.vertices.iter().map(|vertex| place.placement.transform_point3(*vertex)));
            let normals = normal_matrix(place.placement.matrix3);
            for (triangle, corners) in prototype.triangles.iter().enumerate() {
                let turned = prototype.corner_normals[triangle].map(|normal| (normals * normal).normalize_or(normal));
                let parameters = prototype.corner_parameters[triangle];
                push(mesh, corners.map(|corner| first + corner), turned, parameters, place.colour);
            }
        }
        Ok(())
    }
}

impl PredefinedSurface {
    /// The surface as triangles in its own coordinates; all of surface 0. Parameters are those of patches, and x and y
    /// of polygons.
    ///
    /// - `detail`: largest distance between triangles and patches, in its own units, above 0. Patches are never coarser
    ///   than a twentieth of their size.
    ///
    /// # Errors
    /// A detail that is no such length, and less memory than the triangles take.
    pub fn mesh(&self, detail: f64) -> Result<Mesh, DrawingError> {
        let mut mesh = Mesh::default();
        for part in &self.parts {
            match part {
                PredefinedPart::Polygon { corners, triangles } => append_flat(&mut mesh, corners, triangles)?,
                PredefinedPart::Triangles(made) => {
                    make_room(&mut mesh, made.triangles.len(), made.vertices.len())?;
                    append(&mut mesh, made);
                }
                PredefinedPart::Patch(patch) => {
                    let control = patch.control().as_flattened();
                    let size = control.iter().map(|point| point.distance(control[0])).fold(0.0, f64::max);
                    let tolerance = Tolerance::new(detail.min(COARSEST * size), ANGLE);
                    let made = tessellate(std::slice::from_ref(patch.as_ref()), tolerance)?;
                    make_room(&mut mesh, made.triangles.len(), made.vertices.len())?;
                    append(&mut mesh, &made);
                }
            }
        }
        Ok(mesh)
    }
}

/// Appends triangles, all of surface 0.
fn append(mesh: &mut Mesh, made: &Mesh) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(&made.vertices);
    for (number, corners) in made.triangles.iter().enumerate() {
        let (normals, parameters) = (made.corner_normals[number], made.corner_parameters[number]);
        push(mesh, corners.map(|corner| first + corner), normals, parameters, 0);
    }
}

/// Appends a polygon of a predefined surface.
fn append_flat(mesh: &mut Mesh, corners: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), DrawingError> {
    make_room(mesh, triangles.len(), corners.len())?;
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(corners);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        push(mesh, triangle.map(|corner| first + corner), [normal; 3], [a, b, c].map(DVec3::truncate), 0);
    }
    Ok(())
}
