//! Encoders of pictures, and what they say: mostly what the file system says.

use super::provenance::{Provenance, SOFTWARE};
use crate::color::srgb;
use exr::image::write::channels::WritableChannels;
use exr::image::{Encoding, Image, Layer};
use exr::meta::attribute::{Chromaticities, LineOrder, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::{Compression, Vec2};
use files::Writer;
use glam::DVec2;
use png::{BitDepth, ColorType, EncodingError, SrgbRenderingIntent};
use std::io::Error;

/// Chromaticity x, y of the white of sRGB.
const D65: DVec2 = DVec2::new(0.3127, 0.3290);

/// Writes eight-bit sRGB as a PNG file.
///
/// - `bytes`: three a pixel, row by row from the top.
pub fn png(
    file: &mut Writer<'_>,
    bytes: &[u8],
    [width, height]: [u32; 2],
    provenance: &Provenance,
) -> Result<(), Error> {
    let written = |file: &mut Writer<'_>| -> Result<(), EncodingError> {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.add_text_chunk("Software".into(), SOFTWARE.into())?;
        for (key, value) in provenance.rows() {
            match value.is_ascii() {
                true => encoder.add_text_chunk((*key).into(), value.clone())?,
                false => encoder.add_itxt_chunk((*key).into(), value.clone())?,
            }
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        writer.finish()
    };
    written(file).map_err(encoding_error)
}

/// The error of an encoder of PNG files.
pub(super) fn encoding_error(error: EncodingError) -> Error {
    match error {
        EncodingError::IoError(error) => error,
        other => Error::other(other),
    }
}

/// Linear sRGB as an EXR file, compressed by ZIP, its lines in order: the same bytes however many threads compress.
pub fn exr<'c, C: WritableChannels<'c> + 'c>(
    [width, height]: [u32; 2],
    channels: C,
    provenance: &Provenance,
) -> Image<Layer<C>> {
    let vector = |at: DVec2| Vec2(at.x as f32, at.y as f32);
    let comments = provenance.text();
    let attributes = LayerAttributes {
        software_name: Text::new_or_none(SOFTWARE),
        comments: Text::new_or_none(&comments).filter(|_| !comments.is_empty()),
        adopted_neutral: Some(vector(provenance.white.unwrap_or(D65))),
        ..LayerAttributes::default()
    };
    let encoding =
        Encoding { compression: Compression::ZIP16, line_order: LineOrder::Increasing, ..Encoding::UNCOMPRESSED };
    let layer = Layer::new(Vec2(width as usize, height as usize), attributes, encoding, channels);
    let mut image = Image::from_layer(layer);
    let [red, green, blue] = srgb::PRIMARIES.map(vector);
    image.attributes.chromaticities = Some(Chromaticities { red, green, blue, white: vector(D65) });
    image
}

/// The error of an encoder of EXR files.
pub fn exr_error(error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => Error::other(other),
    }
}
