//! How closely the triangles of an object follow its surface: its own tolerance, that of the scene, or a part of its size.

use super::object::{Object, Shape};
use super::shape_mesh::ShapeMesh;
use super::stretch::largest_stretch;
use super::{SceneError, ShapeError};
use crate::surface::Tolerance;

/// Tolerance of an object for which none is given, as a fraction of the diagonal of its bounds.
const RELATIVE_TOLERANCE: f64 = 1.0 / 2000.0;
/// That of terrain, which is rough: rays meet it exactly, and a distance a quarter as far takes ten times the triangles.
const TERRAIN_TOLERANCE: f64 = 1.0 / 500.0;

impl Object {
    /// Length of the diagonal of a curved shape of known size, as it is placed.
    pub(super) fn extent(&self) -> Option<f64> {
        Some(self.shape.extent()? * largest_stretch(&self.transform))
    }

    /// The triangles in own coordinates.
    pub(super) fn tessellate(&self, scene_tolerance: Option<f64>, angle: f64) -> Result<ShapeMesh, SceneError> {
        let tolerance = self.own_tolerance(scene_tolerance, angle);
        self.shape.tessellate(tolerance).map_err(|source| self.failed(source))
    }

    /// The tolerance in own coordinates; none for flat shapes.
    fn own_chord(&self, scene_tolerance: Option<f64>) -> Option<f64> {
        Some(self.chord_of(self.shape.extent()?, scene_tolerance))
    }

    /// The tolerance in own coordinates of a curved shape.
    ///
    /// - `extent`: that of the shape.
    pub(super) fn chord_of(&self, extent: f64, scene_tolerance: Option<f64>) -> f64 {
        let given = self.tolerance.or(scene_tolerance);
        let relative = if matches!(self.shape, Shape::Terrain(_)) { TERRAIN_TOLERANCE } else { RELATIVE_TOLERANCE };
        given.map_or(extent * relative, |given| given / largest_stretch(&self.transform))
    }

    /// In own coordinates; a flat shape fits any.
    pub(super) fn own_tolerance(&self, scene_tolerance: Option<f64>, angle: f64) -> Tolerance {
        let chord = match self.shape {
            // Each of the objects that are placed may have one of its own.
            Shape::Instances(_) | Shape::Procedural(_) => {
                self.tolerance.or(scene_tolerance).map(|given| given / largest_stretch(&self.transform))
            }
            _ => self.own_chord(scene_tolerance),
        };
        Tolerance::new(chord.unwrap_or(f64::MAX), angle)
    }

    /// Largest distance between the exact surface and the triangles as they are written, scene units; an upper bound for skewed
    /// objects. Of a composite, its own triangles are measured, and the operands whose surfaces are limits.
    pub(super) fn chord_error(&self, scene_tolerance: Option<f64>, angle: f64) -> Result<f64, SceneError> {
        let stretch = largest_stretch(&self.transform);
        let limits = match self.shape {
            Shape::Composite(_) => self.limit_error(scene_tolerance, angle)?,
            _ => 0.0,
        };
        let tolerance = self.own_tolerance(scene_tolerance, angle);
        let error = self.shape.chord_error(tolerance).map_err(|source| self.failed(source))?;
        Ok((error * stretch).max(limits))
    }

    /// Largest distance between limit surfaces, also those of operands, and the triangles that are made for them; scene units.
    fn limit_error(&self, scene_tolerance: Option<f64>, angle: f64) -> Result<f64, SceneError> {
        match &self.shape {
            Shape::Rounded(_) | Shape::Subdivision(_) | Shape::Terrain(_) => self.chord_error(scene_tolerance, angle),
            Shape::Composite(composite) => {
                let own = self.own_chord(scene_tolerance);
                let mut largest = 0.0;
                for operand in &composite.operands {
                    largest = f64::max(largest, operand.limit_error(own, angle)?);
                }
                Ok(largest * largest_stretch(&self.transform))
            }
            _ => Ok(0.0),
        }
    }

    pub(super) fn failed(&self, source: ShapeError) -> SceneError {
        SceneError::Shape { object: self.name.clone(), source: Box::new(source) }
    }
}
