//! The pixels that a graphics processor draws on, and its pipelines for them.

use super::instance::NUMBERS;
use wgpu::{BlendComponent, BlendFactor, BlendOperation, TextureFormat};

/// Pixels of a tube with some guns: a float for the only gun, or one each for red, green and blue.
pub(super) fn format(guns: usize) -> TextureFormat {
    if guns == 1 { TextureFormat::R32Float } else { TextureFormat::Rgba32Float }
}

/// Floats of such a pixel.
pub(super) fn floats(guns: usize) -> usize {
    if guns == 1 { 1 } else { 4 }
}

/// The pipelines for one gun and for three.
pub(super) fn pipelines(device: &wgpu::Device) -> [wgpu::RenderPipeline; 2] {
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
