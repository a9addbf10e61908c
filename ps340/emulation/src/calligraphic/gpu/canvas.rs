//! The picture that a graphics processor draws on, and its way back into tiles.

use super::{
    device::Device,
    instance::StrokeInstance,
    pipeline::{floats, format},
};
use crate::calligraphic::{
    ScreenLight,
    tile::{PLANE, STRIDE, TILE_HEIGHT, TILE_WIDTH, Tile},
};
use rayon::prelude::*;
use std::sync::mpsc;
use wgpu::{BufferUsages, Color, LoadOp, TextureUsages};

/// Strokes that are drawn at once.
pub(super) const BATCH: usize = 1 << 16;
/// Bytes that are read back at once, unless a row of tiles has more.
const BAND: usize = 32 << 20;

/// A picture of light in the memory of the graphics processor.
pub(super) struct Canvas {
    size: [usize; 2],
    guns: usize,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    screen: wgpu::Buffer,
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
    instances: wgpu::Buffer,
    /// Takes some rows of tiles on their way back.
    band: wgpu::Buffer,
    /// Rows of pixels of it.
    band_rows: usize,
    /// Bytes of a row of pixels in it.
    row_bytes: usize,
}

impl Canvas {
    /// A canvas of some pixels for a tube of some guns.
    pub fn new(device: &wgpu::Device, pipeline: &wgpu::RenderPipeline, size: [usize; 2], guns: usize) -> Self {
        let align = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize;
        let row_bytes = (size[0] * floats(guns) * size_of::<f32>()).next_multiple_of(align);
        let tile_rows = (BAND / (row_bytes * TILE_HEIGHT)).clamp(1, size[1].div_ceil(TILE_HEIGHT));
        let band_rows = tile_rows * TILE_HEIGHT;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0] as u32, height: size[1] as u32, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: format(guns),
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let buffer = |size: usize, usage| {
            let size = size as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let screen = buffer(4 * size_of::<f32>(), BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: screen.as_entire_binding() }],
        });
        Self {
            size,
            guns,
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            screen,
            group,
            pipeline: pipeline.clone(),
            instances: buffer(BATCH * size_of::<StrokeInstance>(), BufferUsages::VERTEX | BufferUsages::COPY_DST),
            band: buffer(band_rows * row_bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            band_rows,
            row_bytes,
        }
    }

    /// Whether it has this size and is for so many guns.
    pub fn fits(&self, size: [usize; 2], guns: usize) -> bool {
        self.size == size && self.guns == guns
    }

    /// Takes away the light, and sets the spot for what comes.
    pub fn clear(&self, on: &Device, spot: f64) {
        let [width, height] = self.size.map(|pixels| pixels as f32);
        on.queue.write_buffer(&self.screen, 0, bytemuck::cast_slice(&[width, height, spot as f32, 0.0]));
        let mut encoder = on.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pass(&mut encoder, LoadOp::Clear(Color::TRANSPARENT));
        on.queue.submit([encoder.finish()]);
    }

    /// Adds the light of strokes, at most [`BATCH`], in their order.
    pub fn draw(&self, on: &Device, instances: &[StrokeInstance]) -> wgpu::SubmissionIndex {
        on.queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(instances));
        let mut encoder = on.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = self.pass(&mut encoder, LoadOp::Load);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.instances.slice(..));
        pass.draw(0..4, 0..instances.len() as u32);
        drop(pass);
        on.queue.submit([encoder.finish()])
    }

    fn pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder, load: LoadOp<Color>) -> wgpu::RenderPass<'a> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        })
    }

    /// Reads the light back into tiles, some rows of them at a time.
    ///
    /// # Errors
    /// What the device complains about.
    pub fn read(&self, on: &Device, light: &mut ScreenLight) -> Result<(), String> {
        let columns = light.columns();
        let bands = light.tiles.chunks_mut(columns * self.band_rows / TILE_HEIGHT).enumerate();
        for (index, tiles) in bands {
            let top = index * self.band_rows;
            let rows = self.band_rows.min(self.size[1] - top);
            let mapped = self.fetch(on, top, rows)?;
            let pixels: &[f32] = bytemuck::try_cast_slice(&mapped).map_err(|error| error.to_string())?;
            let rows = pixels.par_chunks(self.row_bytes / size_of::<f32>() * TILE_HEIGHT);
            rows.zip(tiles.par_chunks_mut(columns)).for_each(|(pixels, tiles)| {
                for (column, tile) in tiles.iter_mut().enumerate() {
                    self.fill(tile, pixels, column * TILE_WIDTH);
                }
            });
            drop(mapped);
            self.band.unmap();
        }
        Ok(())
    }

    /// Maps rows of pixels.
    fn fetch(&self, on: &Device, top: usize, rows: usize) -> Result<wgpu::BufferView, String> {
        let mut encoder = on.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut source = self.texture.as_image_copy();
        source.origin.y = top as u32;
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.row_bytes as u32), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            source,
            wgpu::TexelCopyBufferInfo { buffer: &self.band, layout },
            wgpu::Extent3d { width: self.size[0] as u32, height: rows as u32, depth_or_array_layers: 1 },
        );
        let sent = on.queue.submit([encoder.finish()]);
        let bytes = self.band.slice(..(rows * self.row_bytes) as u64);
        let (sender, answer) = mpsc::channel();
        bytes.map_async(wgpu::MapMode::Read, move |mapped| drop(sender.send(mapped)));
        on.wait(sent)?;
        match answer.try_recv() {
            Ok(Ok(())) => bytes.get_mapped_range().map_err(|error| error.to_string()),
            Ok(Err(error)) => Err(error.to_string()),
            Err(_) => Err("the picture was not read back".into()),
        }
    }

    /// Fills a tile from rows of pixels, from a column on.
    fn fill(&self, tile: &mut Tile, pixels: &[f32], left: usize) {
        let (guns, floats) = (self.guns, floats(self.guns));
        let across = TILE_WIDTH.min(self.size[0] - left);
        let part = floats * left..floats * (left + across);
        let rows = || pixels.chunks_exact(self.row_bytes / size_of::<f32>()).map(|row| &row[part.clone()]);
        // Most of a picture is dark as a rule.
        tile.lit = rows().any(|row| row.iter().fold(0, |bits, light| bits | light.to_bits()) != 0);
        if !tile.lit {
            return;
        }
        tile.planes.clear();
        tile.planes.resize(guns * PLANE, 0.0);
        for (gun, plane) in tile.planes.chunks_exact_mut(PLANE).enumerate() {
            for (row, plane) in rows().zip(plane.chunks_exact_mut(STRIDE)) {
                plane.iter_mut().zip(row.chunks_exact(floats)).for_each(|(light, pixel)| *light = pixel[gun]);
            }
        }
    }
}
