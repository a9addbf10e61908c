//! Shapes in their own coordinates: whether their measures are sound, their sizes, and their triangles.

use super::object::{MAX_NESTING, Object, RoundedSolid, Shape};
use super::object_intersection::intersect_shapes;
use super::settings::check_tolerance;
use super::shape_mesh::ShapeMesh;
use super::stretch::largest_stretch;
use super::{SceneError, ShapeError};
use crate::database::{Library, RecordContent, RecordKind};
use crate::intersection::CurvePrecision;
use crate::memory;
use crate::mesh::{self, Mesh, NoBunny, edges::EdgeTable};
use crate::octree::{self, Octree};
use crate::solid::{EdgeChoice, ExactSolid, PrimitiveError, RoundingError, retain};
use crate::surface::{self, Surface, Tolerance, chord_error, ground, tessellate};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Steps along the sides of a triangle at which its distance to the exact surface is measured.
const MEASURED_STEPS: usize = 6;
/// Diagonal of the box around the teapot: 6.525 long, 3.15 high, 4 wide.
const TEAPOT_DIAGONAL: f64 = 8.28;

impl Shape {
    /// Checks the measures.
    ///
    /// # Errors
    /// The problem in words.
    pub fn check(&self) -> Result<(), String> {
        match self {
            // What sculptured surfaces are made of was checked; whether they can be tessellated is seen then.
            Shape::Teapot | Shape::Mesh { .. } | Shape::Stored { .. } | Shape::Sculpture(_) | Shape::Made(_) => Ok(()),
            Shape::Bunny if cfg!(feature = "bunny") => Ok(()),
            Shape::Bunny => Err(NoBunny.to_string()),
            Shape::Subdivision(cage) => cage.polyhedron().map(|_| ()).map_err(|error| error.to_string()),
            Shape::Terrain(terrain) => terrain.field().map(|_| ()).map_err(|error| error.to_string()),
            Shape::Solid(solid) => solid.body().map(|_| ()).map_err(|error| error.to_string()),
            Shape::HalfSpace { normal, .. } if normal.try_normalize().is_some() => Ok(()),
            Shape::HalfSpace { normal, .. } => Err(format!("normal {normal} has no length")),
            Shape::Ground { size } if size.is_finite() && *size > 0.0 => Ok(()),
            Shape::Ground { size } => Err(format!("size {size} is not a length above 0")),
            Shape::Composite(composite) if composite.nesting > MAX_NESTING => {
                Err(format!("solids are nested more than {MAX_NESTING} deep"))
            }
            Shape::Composite(composite) => {
                composite.operands.iter().try_for_each(|o| o.check(false).map_err(|error| error.to_string()))
            }
            Shape::Curve(objects) => objects.iter().try_for_each(|o| o.check(false).map_err(|error| error.to_string())),
            Shape::Rounded(rounded) => rounded.object.check(false).map_err(|error| error.to_string()),
            Shape::Instances(instances) => instances.check(),
            // It was checked when it was made.
            Shape::Procedural(_) => Ok(()),
        }
    }

    /// Whether it is tessellated from a curved surface that is known exactly.
    pub fn is_exact_and_curved(&self) -> bool {
        match self {
            Shape::Composite(composite) => composite.operands.iter().any(|o| o.shape.is_exact_and_curved()),
            Shape::Curve(_) | Shape::Rounded(_) | Shape::Instances(_) | Shape::Procedural(_) => false,
            _ => self.extent().is_some(),
        }
    }

    /// Whether triangles stand for a curved surface that is known, exactly or as a limit.
    pub(super) fn is_approximated(&self) -> bool {
        match self {
            Shape::Composite(composite) => composite.operands.iter().any(|o| o.shape.is_approximated()),
            Shape::Rounded(_) => true,
            _ => self.is_exact_and_curved(),
        }
    }

    /// Length of the diagonal in own coordinates, for curved shapes of known size.
    pub fn extent(&self) -> Option<f64> {
        match self {
            Shape::Teapot => Some(TEAPOT_DIAGONAL),
            Shape::Solid(solid) => solid.body().ok()?.curved_extent(),
            Shape::Sculpture(sculpture) => Some(sculpture.extent()),
            Shape::Subdivision(cage) => Some(cage.extent()),
            Shape::Terrain(terrain) => Some(terrain.extent()),
            Shape::Composite(composite) => composite.extent(),
            Shape::Curve(objects) => objects.iter().filter_map(Object::extent).reduce(f64::max),
            Shape::Rounded(rounded) => {
                let extent = || {
                    Some(
                        rounded
                            .object
                            .shape
                            .tessellate(Tolerance::new(f64::MAX, 180.0))
                            .ok()?
                            .mesh
                            .bounds()?
                            .diagonal(),
                    )
                };
                rounded.object.extent().or_else(|| Some(extent()? * largest_stretch(&rounded.object.transform)))
            }
            Shape::HalfSpace { .. } | Shape::Ground { .. } | Shape::Bunny | Shape::Procedural(_) => None,
            Shape::Mesh { .. } | Shape::Made(_) | Shape::Stored { .. } | Shape::Instances(_) => None,
        }
    }

    /// Triangles within `tolerance` of the shape and the exact surfaces that they stand for, in own coordinates. Limits
    /// of subdivision take the chord only.
    ///
    /// # Errors
    /// [`ShapeError`] if the file cannot be read, the tolerance asks for too many triangles, or there is no such solid.
    pub fn tessellate(&self, tolerance: Tolerance) -> Result<ShapeMesh, ShapeError> {
        let known = |mesh: Mesh, surfaces: Vec<Arc<dyn Surface>>| {
            let surfaces = surfaces.into_iter().map(Some).collect();
            ShapeMesh { mesh, surfaces, ..ShapeMesh::default() }
        };
        match self {
            Shape::Composite(composite) => composite.tessellate(tolerance),
            Shape::Sculpture(sculpture) => {
                let (mesh, surfaces) = sculpture.tessellated(tolerance)?;
                Ok(ShapeMesh { mesh, surfaces: surfaces.into_iter().map(Some).collect(), ..ShapeMesh::default() })
            }
            Shape::Subdivision(cage) => {
                let mesh = cage.polyhedron()?.tessellated(tolerance.chord)?;
                Ok(ShapeMesh { mesh, ..ShapeMesh::default() })
            }
            Shape::Terrain(terrain) => Ok(terrain.tessellate(tolerance.chord)?),
            Shape::Made(made) => Ok(ShapeMesh { mesh: (*made.0).clone(), ..ShapeMesh::default() }),
            Shape::Curve(objects) => {
                let precision = CurvePrecision { chord: Some(tolerance.chord), ..CurvePrecision::default() };
                let lines = intersect_shapes([&objects[0], &objects[1]], tolerance, &precision)?.polylines();
                Ok(ShapeMesh { lines, ..ShapeMesh::default() })
            }
            Shape::Rounded(rounded) => rounded.tessellate(tolerance),
            Shape::Instances(instances) => instances.tessellate(tolerance, 0),
            Shape::Procedural(model) => {
                let chord = (tolerance.chord < f64::MAX).then_some(tolerance.chord);
                model.tessellate(0, model.detail_within(chord))
            }
            Shape::Bunny => Ok(ShapeMesh { mesh: mesh::bunny()?, ..ShapeMesh::default() }),
            Shape::Mesh { path } => Ok(ShapeMesh { mesh: mesh_of(path)?, ..ShapeMesh::default() }),
            Shape::Stored { database, name } => {
                let (record, _) = Library::of(database.as_deref())?.record(RecordKind::Geometry, name)?;
                match record.content {
                    RecordContent::Geometry(grouped) => Ok(ShapeMesh { mesh: grouped.mesh, ..ShapeMesh::default() }),
                    _ => Ok(ShapeMesh::default()),
                }
            }
            Shape::HalfSpace { .. } => Err(PrimitiveError::Endless.into()),
            Shape::Solid(solid) => {
                let body = solid.body()?;
                Ok(known(body.tessellate(tolerance)?, body.surfaces()))
            }
            Shape::Teapot => {
                let patches = surface::teapot().into_iter().map(|patch| Arc::new(patch) as Arc<dyn Surface>);
                let patches: Vec<_> = patches.collect();
                Ok(known(tessellate(&patches, tolerance)?, patches))
            }
            Shape::Ground { size } => {
                let square: Vec<Arc<dyn Surface>> = vec![Arc::new(ground(DVec3::ZERO, *size))];
                Ok(known(tessellate(&square, tolerance)?, square))
            }
        }
    }

    /// Largest measured distance between the triangles for a tolerance and the exact surfaces or the limit surface, in
    /// own coordinates; of a composite that of the triangles whose exact surfaces are known; 0 where none are.
    ///
    /// # Errors
    /// [`ShapeError`] if the file cannot be read, the tolerance asks for too many triangles, or there is no such solid.
    pub(super) fn chord_error(&self, tolerance: Tolerance) -> Result<f64, ShapeError> {
        let ShapeMesh { mesh, surfaces, .. } = self.tessellate(tolerance)?;
        match self {
            Shape::Subdivision(cage) => Ok(cage.polyhedron()?.distance(&mesh, tolerance.chord)?),
            Shape::Terrain(terrain) => Ok(terrain.chord_error(&mesh, MEASURED_STEPS)?),
            Shape::Rounded(rounded) => rounded.distance(&mesh, tolerance),
            _ => distance_to_known(mesh, &surfaces),
        }
    }
}

/// The largest distance of triangles whose exact surfaces are known from these.
fn distance_to_known(mut mesh: Mesh, surfaces: &[Option<Arc<dyn Surface>>]) -> Result<f64, ShapeError> {
    let known: Vec<Arc<dyn Surface>> = surfaces.iter().flatten().cloned().collect();
    if known.is_empty() || mesh.surfaces.len() != mesh.triangles.len() {
        return Ok(0.0);
    }
    // The number of each surface among those that are known.
    let numbers: Vec<Option<u32>> = surfaces
        .iter()
        .scan(0, |next, surface| {
            let number = surface.as_ref().map(|_| *next);
            *next += u32::from(number.is_some());
            Some(number)
        })
        .collect();
    let number = |surface: &u32| numbers.get(*surface as usize).copied().flatten();
    let is_known: Vec<bool> = mesh.surfaces.iter().map(|surface| number(surface).is_some()).collect();
    retain(&mut mesh, &is_known);
    mesh.surfaces = mesh.surfaces.iter().filter_map(number).collect();
    Ok(chord_error(&mesh, &known, MEASURED_STEPS)?.maximum)
}

impl Object {
    /// Checks every number of it.
    ///
    /// - `is_shape_known`: whether its shape was checked before.
    pub(super) fn check(&self, is_shape_known: bool) -> Result<(), SceneError> {
        let failed = |problem: String| SceneError::Object { object: self.name.clone(), problem };
        if !is_shape_known {
            self.shape.check().map_err(failed)?;
        }
        if !self.transform.is_finite() {
            return Err(failed("its transformation is not finite".into()));
        }
        if self.transform.row(3) != glam::DVec4::W {
            return Err(failed("its transformation is not affine".into()));
        }
        let determinant = self.transform.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return Err(failed("its transformation is singular: it flattens the object".into()));
        }
        if let Some(tolerance) = self.tolerance {
            check_tolerance(tolerance).map_err(failed)?;
        }
        self.material
            .as_ref()
            .map_or(Ok(()), |material| material.check().map_err(|problem| failed(problem.to_string())))
    }
}

impl RoundedSolid {
    fn tessellate(&self, tolerance: Tolerance) -> Result<ShapeMesh, ShapeError> {
        let (solid, operands) = self.solid(tolerance)?;
        let rounded = solid.rounded(&self.choice(), self.radius, tolerance.chord).map_err(|e| self.failed(e))?;
        let (mesh, surfaces) = rounded.into_parts();
        let operand_of = if operands.is_empty() { Vec::new() } else { operands_beside(&mesh, operands) };
        Ok(ShapeMesh { mesh, surfaces, operand_of, ..ShapeMesh::default() })
    }

    /// How far triangles are from the rounded surface.
    fn distance(&self, mesh: &Mesh, tolerance: Tolerance) -> Result<f64, ShapeError> {
        let (solid, _) = self.solid(tolerance)?;
        let distance = solid.distance_of_rounded(mesh, &self.choice(), self.radius, tolerance.chord);
        distance.map_err(|e| self.failed(e))
    }

    /// The solid with sharp edges, and the operand of each surface.
    fn solid(&self, tolerance: Tolerance) -> Result<(ExactSolid, HashMap<u32, u32>), ShapeError> {
        let object = &self.object;
        let chord = tolerance.chord / largest_stretch(&object.transform);
        let ShapeMesh { mesh, surfaces, operand_of, .. } =
            object.in_place(object.shape.tessellate(Tolerance { chord, ..tolerance })?);
        let operands: HashMap<u32, u32> = mesh.surfaces.iter().copied().zip(operand_of).collect();
        let solid = ExactSolid::new(mesh, surfaces)
            .map_err(|source| ShapeError::Solid { object: object.name.clone(), source })?;
        Ok((solid, operands))
    }

    fn choice(&self) -> EdgeChoice {
        if self.edges.is_empty() { EdgeChoice::All } else { EdgeChoice::Nearest(self.edges.clone()) }
    }

    fn failed(&self, source: RoundingError) -> ShapeError {
        ShapeError::Rounding { object: self.object.name.clone(), source }
    }
}

/// The mesh of a file: of a mesh file, or of an octree that was kept.
fn mesh_of(path: &Path) -> Result<Mesh, ShapeError> {
    if !Octree::is_file(path) {
        return Ok(mesh::read(path)?);
    }
    let failed = |problem: String| ShapeError::Octree { path: path.into(), problem };
    let bytes = memory::read(path, octree::MAX_BYTES).map_err(|error| failed(error.to_string()))?;
    Ok(Octree::from_bytes(&bytes).map_err(|error| failed(error.to_string()))?.mesh())
}

/// For each triangle the operand of its surface; what is rounded is of an operand beside it.
fn operands_beside(mesh: &Mesh, mut operands: HashMap<u32, u32>) -> Vec<u32> {
    let table = EdgeTable::of(mesh);
    for edge in &table.edges {
        let surfaces: Vec<u32> = table.uses(edge).iter().map(|place| mesh.surfaces[place.triangle as usize]).collect();
        if let Some(operand) = surfaces.iter().find_map(|surface| operands.get(surface).copied()) {
            surfaces.iter().for_each(|surface| _ = operands.entry(*surface).or_insert(operand));
        }
    }
    mesh.surfaces.iter().map(|surface| operands.get(surface).copied().unwrap_or(0)).collect()
}
