//! OpenEXR files, block by block.

use super::texel::{Buffered, Texel};
use exr::block::reader::{ChunksReader, Reader};
use exr::block::{self, UncompressedBlock};
use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Vec2, f16};
use std::mem::size_of;

/// Most bytes of a block: 256 lines of the widest picture with four bands of 32 bits.
const MOST_OF_BLOCK: usize = 64 << 20;
/// What stands for the channels of a pixel, in the order of [`Texel::Float`].
const CHANNELS: [&str; 5] = ["R", "G", "B", "A", "Z"];
/// The number of a pixel in a channel that the file does not have: black, covered, infinitely far.
const MISSING: [f32; 5] = [0.0, 0.0, 0.0, 1.0, f32::INFINITY];
/// The channel that stands for three where there is only light without color.
const LUMINANCE: &str = "Y";

/// An EXR file that is open.
pub(super) struct Exr {
    reader: Reader<Buffered>,
    /// The layer that is read: the first with color or luminance.
    layer: usize,
    /// What each channel of the layer stands for: places in a pixel.
    meanings: Vec<Vec<usize>>,
}

impl Exr {
    pub(super) fn open(file: Buffered) -> Result<Exr, String> {
        let reader = block::read(file, false).map_err(|error| error.to_string())?;
        let layers = reader.headers().iter().map(meanings_of).enumerate();
        let (layer, meanings) = layers
            .filter_map(|(layer, meanings)| Some((layer, meanings?)))
            .next()
            .ok_or("no layer has the channels R, G and B, or Y")?;
        let header = &reader.headers()[layer];
        if header.deep {
            return Err("deep data cannot be read".into());
        }
        if let Some(channel) = header.channels.list.iter().find(|channel| channel.sampling != Vec2(1, 1)) {
            return Err(format!("channel {} does not have a number for each pixel", channel.name));
        }
        let Vec2(width, height) = header.max_block_pixel_size();
        let bytes = width.saturating_mul(height).saturating_mul(header.channels.bytes_per_pixel);
        if bytes > MOST_OF_BLOCK {
            return Err(format!("its blocks of {width} x {height} pixels are larger than {MOST_OF_BLOCK} bytes"));
        }
        Ok(Exr { reader, layer, meanings })
    }

    fn header(&self) -> &Header {
        &self.reader.headers()[self.layer]
    }

    pub(super) fn size(&self) -> [u32; 2] {
        let Vec2(width, height) = self.header().layer_size;
        [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX))
    }

    pub(super) fn is_grey(&self) -> bool {
        self.meanings.iter().any(|places| places.len() == 3)
    }

    pub(super) fn has_depth(&self) -> bool {
        self.meanings.iter().any(|places| places.contains(&4))
    }

    pub(super) fn each(self, tell: &mut impl FnMut(u32, u32, Texel)) -> Result<(), String> {
        let Exr { reader, layer, meanings } = self;
        let channels = reader.headers()[layer].channels.list.clone();
        let wanted =
            reader.filter_chunks(false, |_, tile, block| block.layer == layer && tile.is_largest_resolution_level());
        let mut blocks = wanted.map_err(|error| error.to_string())?.sequential_decompressor(false);
        let mut row = Vec::new();
        while let Some(block) = blocks.decompress_next_block() {
            let block = block.map_err(|error| error.to_string())?;
            emit_block(&block, &channels, &meanings, &mut row, tell);
        }
        Ok(())
    }
}

/// What each channel of a layer stands for; none where there is no color.
fn meanings_of(header: &Header) -> Option<Vec<Vec<usize>>> {
    let has = |name: &str| header.channels.list.iter().any(|channel| channel.name.eq(name));
    let is_grey = match ["R", "G", "B"].map(has) {
        [true, true, true] => false,
        _ if has(LUMINANCE) => true,
        _ => return None,
    };
    let meaning = |channel: &ChannelDescription| match CHANNELS.iter().position(|name| channel.name.eq(name)) {
        Some(band @ 0..3) if !is_grey => vec![band],
        Some(beside @ 3..) => vec![beside],
        _ if is_grey && channel.name.eq(LUMINANCE) => vec![0, 1, 2],
        _ => Vec::new(),
    };
    Some(header.channels.list.iter().map(meaning).collect())
}

/// Tells the pixels of a block, whose rows hold channel after channel.
fn emit_block(
    block: &UncompressedBlock,
    channels: &[ChannelDescription],
    meanings: &[Vec<usize>],
    row: &mut Vec<[f32; 5]>,
    emit: &mut impl FnMut(u32, u32, Texel),
) {
    let (Vec2(left, top), Vec2(width, height)) = (block.index.pixel_position, block.index.pixel_size);
    let mut rest = &block.data[..];
    for y in top..top + height {
        row.clear();
        row.resize(width, MISSING);
        for (channel, places) in channels.iter().zip(meanings) {
            let size = width * channel.sample_type.bytes_per_sample();
            let Some((line, behind)) = rest.split_at_checked(size) else { return };
            rest = behind;
            if !places.is_empty() {
                let numbers = numbers_of(line, channel.sample_type);
                row.iter_mut()
                    .zip(numbers)
                    .for_each(|(pixel, number)| places.iter().for_each(|at| pixel[*at] = number));
            }
        }
        for (x, pixel) in row.iter().enumerate() {
            emit((left + x) as u32, y as u32, Texel::Float(*pixel));
        }
    }
}

/// The numbers of a line, which are in the order of bytes of this machine.
fn numbers_of(line: &[u8], kind: SampleType) -> Box<dyn Iterator<Item = f32> + '_> {
    match kind {
        SampleType::F16 => Box::new(words(line).map(|word| f16::from_ne_bytes(word).to_f32())),
        SampleType::F32 => Box::new(words(line).map(f32::from_ne_bytes)),
        SampleType::U32 => Box::new(words(line).map(|word| u32::from_ne_bytes(word) as f32)),
    }
}

fn words<const N: usize>(line: &[u8]) -> impl Iterator<Item = [u8; N]> + '_ {
    debug_assert!(size_of::<[u8; N]>() == N && line.len().is_multiple_of(N));
    line.as_chunks::<N>().0.iter().copied()
}
