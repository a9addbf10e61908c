//! The graphics processor as the beam: it writes strokes batch by batch, until it fails.

use super::{
    GpuError,
    canvas::{BATCH, Canvas},
    device::Device,
    instance::StrokeInstance,
};
use crate::{calligraphic::ScreenLight, traversal::Stroke};
use rayon::prelude::*;
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Mutex, OnceLock, PoisonError},
};

/// A graphics processor that writes light.
pub struct Gpu {
    device: Device,
    canvas: Mutex<GpuScratch>,
    /// Whether it is not asked any more.
    given_up: OnceLock<()>,
}

/// Scratch that is reused from picture to picture.
#[derive(Default)]
struct GpuScratch {
    canvas: Option<Canvas>,
    instances: Vec<StrokeInstance>,
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu").field("name", &self.device.name).finish_non_exhaustive()
    }
}

impl Gpu {
    /// Opens the best adapter there is; `software` allows one that is the processor itself.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn open(software: bool) -> Result<Gpu, GpuError> {
        Ok(Gpu { device: Device::open(software)?, canvas: Mutex::default(), given_up: OnceLock::new() })
    }

    /// Its name and interface.
    pub fn name(&self) -> &str {
        &self.device.name
    }

    /// Whether it still draws.
    pub fn works(&self) -> bool {
        self.given_up.get().is_none()
    }

    /// Writes strokes in place of what was written before. Returns false if it cannot: then the light is not touched,
    /// or partly, and the processor must write it.
    pub(in crate::calligraphic) fn write(&self, light: &mut ScreenLight, strokes: &[Stroke]) -> bool {
        let most = self.device.device.limits().max_texture_dimension_2d as usize;
        if !self.works() || light.optics.size.iter().any(|pixels| *pixels > most) {
            return false;
        }
        // Where a device is lost, the library may panic.
        let written = catch_unwind(AssertUnwindSafe(|| self.try_write(light, strokes)));
        let written = written.unwrap_or_else(|_| Err("the graphics library failed".into()));
        let Err(why) = written else { return true };
        if self.given_up.set(()).is_ok() {
            let why = self.device.failure.get().unwrap_or(&why);
            tracing::warn!("{} failed: {why}; the processor draws the vector screen from now on", self.device.name);
        }
        false
    }

    fn try_write(&self, light: &mut ScreenLight, strokes: &[Stroke]) -> Result<(), String> {
        let mut room = self.canvas.lock().unwrap_or_else(PoisonError::into_inner);
        let GpuScratch { canvas, instances } = &mut *room;
        let (optics, guns) = (light.optics, light.guns);
        if canvas.as_ref().is_none_or(|canvas| !canvas.fits(optics.size, guns)) {
            *canvas = None;
            *canvas = Some(Canvas::new(
                &self.device.device,
                &self.device.pipelines[usize::from(guns > 1)],
                optics.size,
                guns,
            ));
        }
        let Some(canvas) = canvas else { return Err("no canvas".into()) };
        canvas.clear(&self.device, optics.spot);
        let mut latest = None;
        for batch in strokes.chunks(BATCH) {
            batch.par_iter().map(|stroke| StrokeInstance::new(&optics, guns, stroke)).collect_into_vec(instances);
            let sent = canvas.draw(&self.device, instances);
            // One batch is drawn while the next is made ready: no more, so that memory stays bounded.
            if let Some(before) = latest.replace(sent) {
                self.device.wait(before)?;
            }
        }
        canvas.read(&self.device, light)?;
        self.device.failure.get().map_or(Ok(()), |why| Err(why.clone()))
    }

    /// Destroys the device, as when it is lost.
    #[cfg(test)]
    pub(super) fn lose(&self) {
        self.device.device.destroy();
    }
}
