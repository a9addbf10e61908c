//! Encoders of pictures, and what they say: mostly what the file system says.

use files::Writer;
use image::{ColorType, ImageError, ImageFormat};
use std::io::Error;

/// Writes eight-bit sRGB as a PNG file.
///
/// - `bytes`: three a pixel, row by row from the top.
pub(crate) fn png(file: &mut Writer<'_>, bytes: &[u8], width: u32, height: u32) -> Result<(), Error> {
    let written = image::write_buffer_with_format(file, bytes, width, height, ColorType::Rgb8, ImageFormat::Png);
    written.map_err(|error| match error {
        ImageError::IoError(error) => error,
        other => Error::other(other),
    })
}

/// The error of an encoder of EXR files.
pub(crate) fn exr_error(error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => Error::other(other),
    }
}
