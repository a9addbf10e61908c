//! Who writes the light of the strokes: the processor, or a graphics processor.

#[cfg(feature = "window")]
use super::gpu::{Gpu, GpuError};
use super::{ScreenLight, bins::Bins};
use crate::traversal::Stroke;
#[cfg(feature = "window")]
use std::sync::Arc;

/// Who writes the light of the strokes.
///
/// Both write the same light, within 1/255 of what is seen of it. That of the processor is the same to the bit
/// everywhere.
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
    pub(super) fn write(&self, light: &mut ScreenLight, bins: &mut Bins, strokes: &[Stroke]) {
        #[cfg(feature = "window")]
        if let Drawer::Gpu(gpu) = self
            && gpu.write(light, strokes)
        {
            return;
        }
        light.write(bins, strokes);
    }
}

/// Who is to write the light of the strokes.
#[cfg(feature = "window")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Choice {
    /// A graphics processor, if there is one that is no software, and a window that it is worth while for; else the
    /// processor.
    Auto,
    /// The processor: the same picture to the bit everywhere.
    Cpu,
    /// A graphics processor, even one that is software.
    Gpu,
}

#[cfg(feature = "window")]
impl Choice {
    /// Who writes the light.
    ///
    /// - `has_window`: whether somebody waits for pictures. Without a window few are made, in files, and these are to
    ///   be the same everywhere.
    ///
    /// # Errors
    /// The reason why a graphics processor that is required is not there.
    pub fn drawer(self, has_window: bool) -> Result<Drawer, GpuError> {
        let opened = match (self, has_window) {
            (Choice::Gpu, _) => Gpu::open(true)?,
            (Choice::Auto, true) => match Gpu::open(false) {
                Ok(gpu) => gpu,
                Err(error) => {
                    tracing::debug!("{error}");
                    return Ok(Drawer::Processor);
                }
            },
            (Choice::Auto, false) | (Choice::Cpu, _) => return Ok(Drawer::Processor),
        };
        Ok(Drawer::Gpu(Arc::new(opened)))
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
