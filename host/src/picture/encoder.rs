//! What encoders of pictures say while they write: mostly what the file system says.

use std::io::Error;

/// The error of an encoder of PNG or EXR files.
pub(crate) fn image_error(error: image::ImageError) -> Error {
    match error {
        image::ImageError::IoError(error) => error,
        other => Error::other(other),
    }
}

/// The error of an encoder of EXR files with layers.
pub(crate) fn exr_error(error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => Error::other(other),
    }
}
