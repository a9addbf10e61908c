//! The scene while a script builds it.

use crate::illumination::Material;
use crate::scene::{MAX_OBJECTS, Object, Scene, Shape};
use glam::DMat4;
use std::path::PathBuf;

/// What a script holds of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Handle(usize);

/// The scene so far.
pub(super) struct Builder {
    pub(super) scene: Scene,
    /// Where relative paths begin.
    pub(super) folder: PathBuf,
}

impl Builder {
    /// Adds an object of default material, named after its kind and number.
    pub(super) fn add(&mut self, shape: Shape, tolerance: Option<f64>) -> Result<Handle, String> {
        let index = self.scene.objects.len();
        if index >= MAX_OBJECTS {
            return Err(format!("more than {MAX_OBJECTS} objects"));
        }
        let same = self.scene.objects.iter().filter(|o| o.shape.word() == shape.word()).count();
        let name = match same {
            0 => shape.word().to_owned(),
            n => format!("{} {}", shape.word(), n + 1),
        };
        let (transform, material) = (DMat4::IDENTITY, Material::default());
        self.scene.objects.push(Object { name, shape, transform, material, tolerance });
        Ok(Handle(index))
    }

    /// The object behind a handle.
    pub(super) fn object(&mut self, handle: Option<Handle>) -> Result<&mut Object, String> {
        handle.and_then(|h| self.scene.objects.get_mut(h.0)).ok_or_else(|| "there is no such object".into())
    }

    /// Moves an object by a further transformation, after those before.
    pub(super) fn transform(&mut self, handle: Option<Handle>, by: DMat4) -> Result<Option<Handle>, String> {
        let object = self.object(handle)?;
        let placed = by * object.transform;
        if !placed.is_finite() {
            return Err(format!("{} would be moved out of all bounds", object.name));
        }
        object.transform = placed;
        Ok(handle)
    }
}
