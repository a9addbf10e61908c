//! The beam on a graphics processor: the light of a refresh, by the closed forms that the processor uses.
//!
//! # Model
//! Each stroke is an instance of a rectangle: as much of it as the picture can see, and 4.5 standard deviations more on
//! all sides. The fragment shader (`beam.wgsl`) evaluates the formulas of `spot` and `track`; blending adds. What needs
//! double precision is done before by the same code as for the processor's tiles: a stroke's distances are reckoned at
//! an anchor in the picture (`instance`), so that 32 bits suffice, however long the stroke is.
//!
//! # Why the light is read back
//! Only the light is made here. It is read back into [`Light`], and phosphor, glow and exposure go on from there on their
//! one path. That costs 16 MB over the bus for each changed picture of 1024 by 1024 (4 MB with a single gun): a copy of
//! some milliseconds, while making all of it here would double the code that decides what a picture looks like.
//!
//! # Which adapters
//! Light adds up in 32 bits. An adapter that cannot blend such pixels is refused: in 16 bits, weak strokes upon strong
//! ones would be lost, and light beyond 65504 too.
//!
//! # Failure
//! Nothing here panics or waits for ever. When a device is lost, has no memory left or does not answer within
//! [`PATIENCE`], that is logged once, and the processor draws from then on, beginning with the same picture.

mod canvas;
mod instance;

use super::Light;
use crate::traversal::Stroke;
use canvas::{BATCH, Canvas};
use instance::{Instance, NUMBERS};
use rayon::prelude::*;
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, OnceLock, PoisonError},
    time::Duration,
};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, DeviceType, PollType, TextureFormat};

/// How long the device may take for a part of a picture.
const PATIENCE: Duration = Duration::from_secs(30);
/// The kinds of adapter, the one to be taken first.
const KINDS: [DeviceType; 5] =
    [DeviceType::DiscreteGpu, DeviceType::IntegratedGpu, DeviceType::VirtualGpu, DeviceType::Other, DeviceType::Cpu];
/// Kinds that are no software: they draw faster than the processor.
const REAL: usize = 3;

/// Why no graphics processor draws.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// There is none, or no driver for it.
    #[error(
        "no graphics adapter with Vulkan (or Metal, or DirectX 12); on Debian and Ubuntu: apt install libvulkan1 \
         mesa-vulkan-drivers"
    )]
    None,
    /// None of those that are there will do.
    #[error("no graphics adapter that can draw light: {0}")]
    Unfit(String),
    /// It refused to begin.
    #[error("{name} cannot be used: {why}")]
    Refused {
        /// The name of the adapter.
        name: String,
        /// What it says.
        why: String,
    },
}

/// A graphics processor that writes light.
pub struct Gpu {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// For one gun and for three.
    pipelines: [wgpu::RenderPipeline; 2],
    canvas: Mutex<Room>,
    /// What the device complained about, at any time.
    trouble: Arc<OnceLock<String>>,
    /// Whether it is not asked any more.
    given_up: OnceLock<()>,
}

/// What is kept from picture to picture.
#[derive(Default)]
struct Room {
    canvas: Option<Canvas>,
    instances: Vec<Instance>,
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Gpu {
    /// Opens the best adapter there is; `software` allows one that is the processor itself.
    ///
    /// # Errors
    /// Why there is none.
    pub fn open(software: bool) -> Result<Gpu, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let kinds = &KINDS[..if software { KINDS.len() } else { REAL }];
        let rank = |adapter: &wgpu::Adapter| kinds.iter().position(|kind| *kind == adapter.get_info().device_type);
        let mut ranked: Vec<_> =
            adapters.into_iter().filter_map(|adapter| rank(&adapter).map(|rank| (rank, adapter))).collect();
        ranked.sort_by_key(|(rank, _)| *rank);
        let mut error = GpuError::None;
        for (_, adapter) in ranked {
            match Gpu::with(&adapter) {
                Ok(gpu) => return Ok(gpu),
                Err(why) => error = why,
            }
        }
        Err(error)
    }

    fn with(adapter: &wgpu::Adapter) -> Result<Gpu, GpuError> {
        let info = adapter.get_info();
        let name = format!("{} ({:?})", info.name, info.backend);
        let blends = |format| {
            let allowed = adapter.get_texture_format_features(format).flags;
            allowed.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
        };
        let blendable = wgpu::Features::FLOAT32_BLENDABLE;
        if !adapter.features().contains(blendable) || ![1, 3].into_iter().all(|guns| blends(format(guns))) {
            return Err(GpuError::Unfit(format!("{name} does not blend pixels of 32-bit floating point")));
        }
        let wanted = wgpu::DeviceDescriptor {
            required_features: blendable,
            required_limits: wgpu::Limits {
                max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
                ..wgpu::Limits::default()
            },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted))
            .map_err(|error| GpuError::Refused { name: name.clone(), why: error.to_string() })?;
        let trouble = Arc::new(OnceLock::new());
        let (noted, lost) = (trouble.clone(), trouble.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| drop(noted.set(error.to_string()))));
        device.set_device_lost_callback(move |reason, text| drop(lost.set(format!("lost ({reason:?}) {text}"))));
        let pipelines = pipelines(&device);
        let gpu = Gpu { name, device, queue, pipelines, canvas: Mutex::default(), trouble, given_up: OnceLock::new() };
        match gpu.trouble.get() {
            Some(why) => Err(GpuError::Refused { name: gpu.name, why: why.clone() }),
            None => Ok(gpu),
        }
    }

    /// Its name and how it is spoken to.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it still draws.
    pub fn works(&self) -> bool {
        self.given_up.get().is_none()
    }

    /// Writes strokes in place of what was written before. Returns false if it cannot: then the light is not touched, or
    /// partly, and the processor must write it.
    pub(super) fn write(&self, light: &mut Light, strokes: &[Stroke]) -> bool {
        let most = self.device.limits().max_texture_dimension_2d as usize;
        if !self.works() || light.optics.size.iter().any(|pixels| *pixels > most) {
            return false;
        }
        // Where a device is lost, the library may panic.
        let written = catch_unwind(AssertUnwindSafe(|| self.try_write(light, strokes)));
        let written = written.unwrap_or_else(|_| Err("the graphics library failed".into()));
        let Err(why) = written else { return true };
        if self.given_up.set(()).is_ok() {
            let why = self.trouble.get().unwrap_or(&why);
            tracing::warn!("{} failed: {why}; the processor draws the vector screen from now on", self.name);
        }
        false
    }

    fn try_write(&self, light: &mut Light, strokes: &[Stroke]) -> Result<(), String> {
        let mut room = self.canvas.lock().unwrap_or_else(PoisonError::into_inner);
        let Room { canvas, instances } = &mut *room;
        let (optics, guns) = (light.optics, light.guns);
        if canvas.as_ref().is_none_or(|canvas| !canvas.fits(optics.size, guns)) {
            *canvas = None;
            *canvas = Some(Canvas::new(&self.device, &self.pipelines[usize::from(guns > 1)], optics.size, guns));
        }
        let Some(canvas) = canvas else { return Err("no canvas".into()) };
        canvas.clear(self, optics.spot);
        let mut latest = None;
        for batch in strokes.chunks(BATCH) {
            batch.par_iter().map(|stroke| Instance::new(&optics, guns, stroke)).collect_into_vec(instances);
            let sent = canvas.draw(self, instances);
            // One batch is drawn while the next is made ready: no more, so that memory stays bounded.
            if let Some(before) = latest.replace(sent) {
                self.wait(before)?;
            }
        }
        canvas.read(self, light)?;
        self.trouble.get().map_or(Ok(()), |why| Err(why.clone()))
    }

    /// Waits until something is done.
    fn wait(&self, sent: wgpu::SubmissionIndex) -> Result<(), String> {
        let waited = self.device.poll(PollType::Wait { submission_index: Some(sent), timeout: Some(PATIENCE) });
        match (waited, self.trouble.get()) {
            (_, Some(why)) => Err(why.clone()),
            (Err(error), None) => Err(error.to_string()),
            (Ok(_), None) => Ok(()),
        }
    }

    /// Destroys the device, as when it is lost.
    #[cfg(test)]
    pub(super) fn lose(&self) {
        self.device.destroy();
    }
}

/// Pixels of a tube with some guns: a float for the only gun, or one each for red, green and blue.
fn format(guns: usize) -> TextureFormat {
    if guns == 1 { TextureFormat::R32Float } else { TextureFormat::Rgba32Float }
}

/// Floats of such a pixel.
fn floats(guns: usize) -> usize {
    if guns == 1 { 1 } else { 4 }
}

/// The pipelines for one gun and for three.
fn pipelines(device: &wgpu::Device) -> [wgpu::RenderPipeline; 2] {
    let module = device.create_shader_module(wgpu::include_wgsl!("beam.wgsl"));
    let attributes =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4];
    let instance = wgpu::VertexBufferLayout {
        array_stride: (NUMBERS * size_of::<f32>()) as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &attributes,
    };
    let sum =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Add };
    [1, 3].map(|guns| {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[Some(instance.clone())],
            },
            primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("light"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: format(guns),
                    blend: Some(wgpu::BlendState { color: sum, alpha: sum }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    })
}

#[cfg(test)]
mod tests;
