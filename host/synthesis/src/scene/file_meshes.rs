//! Meshes that a file stores once and places many times.

use super::{Object, SceneError, Shape};
use crate::mesh::{self, Format, PlacedMeshes};
use std::path::Path;

impl Object {
    /// The file of the object, if meshes that it places more than once become instances: where none of them emits light.
    pub(super) fn file_of_places(&self) -> Option<&Path> {
        let Shape::Mesh { path } = &self.shape else { return None };
        let emits = self.material.as_ref().is_some_and(|material| !material.emission.is_black());
        Format::of(path).filter(|format| format.has_places() && !emits).map(|_| path.as_path())
    }

    /// What such a file holds; nothing for other objects.
    ///
    /// # Errors
    /// [`SceneError`], if the file cannot be read.
    pub(super) fn placed_meshes(&self) -> Result<Option<PlacedMeshes>, SceneError> {
        let read = |path| mesh::read_placed(path).map_err(|error| self.failed(error.into()));
        self.file_of_places().map(read).transpose()
    }
}
