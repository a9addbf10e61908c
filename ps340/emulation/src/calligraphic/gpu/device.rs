//! The device that draws: which adapter is taken, what it complains about, and how long it is waited for.

use super::pipeline::{format, pipelines};
use std::{
    sync::{Arc, OnceLock},
    time::Duration,
};
use wgpu::{DeviceType, PollType};

/// How long the device may take for a part of a picture.
const DEVICE_TIMEOUT: Duration = Duration::from_secs(30);
/// The kinds of adapter, the one to be taken first.
const KINDS: [DeviceType; 5] =
    [DeviceType::DiscreteGpu, DeviceType::IntegratedGpu, DeviceType::VirtualGpu, DeviceType::Other, DeviceType::Cpu];
/// Kinds that are no software: they draw faster than the processor.
const REAL: usize = 3;

/// The reason why no graphics processor draws.
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
        /// Its reason.
        why: String,
    },
}

/// An adapter that was opened.
pub(super) struct Device {
    /// The name of the adapter, and its interface.
    pub(super) name: String,
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    /// For one gun and for three.
    pub(super) pipelines: [wgpu::RenderPipeline; 2],
    /// The failure that the device reported, at any time.
    pub(super) failure: Arc<OnceLock<String>>,
}

impl Device {
    /// Opens the best adapter there is; `software` allows one that is the processor itself.
    ///
    /// # Errors
    /// The reason why there is none.
    pub(super) fn open(software: bool) -> Result<Device, GpuError> {
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
            match Device::with(&adapter) {
                Ok(device) => return Ok(device),
                Err(why) => error = why,
            }
        }
        Err(error)
    }

    fn with(adapter: &wgpu::Adapter) -> Result<Device, GpuError> {
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
        let failure = Arc::new(OnceLock::new());
        let (noted, lost) = (failure.clone(), failure.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| drop(noted.set(error.to_string()))));
        device.set_device_lost_callback(move |reason, text| drop(lost.set(format!("lost ({reason:?}) {text}"))));
        let pipelines = pipelines(&device);
        let opened = Device { name, device, queue, pipelines, failure };
        match opened.failure.get() {
            Some(why) => Err(GpuError::Refused { name: opened.name, why: why.clone() }),
            None => Ok(opened),
        }
    }

    /// Waits until something is done.
    pub(super) fn wait(&self, sent: wgpu::SubmissionIndex) -> Result<(), String> {
        let waited = self.device.poll(PollType::Wait { submission_index: Some(sent), timeout: Some(DEVICE_TIMEOUT) });
        match (waited, self.failure.get()) {
            (_, Some(why)) => Err(why.clone()),
            (Err(error), None) => Err(error.to_string()),
            (Ok(_), None) => Ok(()),
        }
    }
}
