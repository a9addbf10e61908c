//! Who writes the light of the strokes: the processor, or a graphics processor.

#[cfg(feature = "window")]
use super::gpu::Gpu;
use super::{Light, bins::Bins};
use crate::traversal::Stroke;
#[cfg(feature = "window")]
use std::sync::Arc;

/// Who writes the light of the strokes.
///
/// Both write the same light, within 1/255 of what is seen of it. That of the processor is the same to the bit everywhere.
#[derive(Clone, Debug, Default)]
pub enum Drawer {
    /// The processor.
    #[default]
    Processor,
    /// A graphics processor; where it fails or the picture is too large for it, the processor.
    #[cfg(feature = "window")]
    Gpu(Arc<Gpu>),
}

impl Drawer {
    /// Writes strokes in place of what was written before.
    pub(super) fn write(&self, light: &mut Light, bins: &mut Bins, strokes: &[Stroke]) {
        #[cfg(feature = "window")]
        if let Drawer::Gpu(gpu) = self
            && gpu.write(light, strokes)
        {
            return;
        }
        light.write(bins, strokes);
    }
}

impl std::fmt::Display for Drawer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            #[cfg(feature = "window")]
            Drawer::Gpu(gpu) if gpu.works() => write!(f, "{}", gpu.name()),
            #[cfg(feature = "window")]
            Drawer::Gpu(gpu) => write!(f, "the processor, as {} failed", gpu.name()),
            Drawer::Processor => write!(f, "the processor"),
        }
    }
}
