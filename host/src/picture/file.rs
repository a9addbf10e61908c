//! Pictures as files: PNG with eight bits sRGB, OpenEXR with linear 32-bit floats.

use super::{Picture, Pixel, encoder};
use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};
use files::{Destination, WriteError};
use image::{DynamicImage, ImageFormat, ImageReader, Limits};
use protocol::raster::linear_from_srgb;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Most bytes that reading a picture may allocate.
const MAX_READ_BYTES: u64 = 8 << 30;

/// What can go wrong with a picture.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// An empty side, or too many pixels.
    #[error("a picture of {width} x {height} pixels is empty or larger than {} pixels", super::MAX_PIXELS)]
    Size {
        /// Columns asked for.
        width: u32,
        /// Rows asked for.
        height: u32,
    },
    /// The file with layers cannot be read.
    #[error("{}: {problem}", path.display())]
    Layers {
        /// The file.
        path: PathBuf,
        /// Why.
        problem: String,
    },
    /// A file holds a number that is infinite or none.
    #[error("{}: pixel {x},{y} holds something that is no finite number", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// Column, from the left.
        x: u32,
        /// Row, from the top.
        y: u32,
    },
    /// Two pictures that were to be compared or combined differ in size.
    #[error("pictures of different size: {0} x {1} and {2} x {3} pixels")]
    Mismatch(u32, u32, u32, u32),
    /// The name ends in something else than the formats known.
    #[error("{}: a picture's name ends in .png or .exr", path.display())]
    Format {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: image::ImageError,
    },
    /// The file cannot be opened.
    #[error("{}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

fn format_of(path: &Path) -> Result<ImageFormat, PictureError> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("png") => Ok(ImageFormat::Png),
        Some("exr") => Ok(ImageFormat::OpenExr),
        _ => Err(PictureError::Format { path: path.into() }),
    }
}

impl Picture {
    /// Whether a name is that of an EXR file.
    pub fn is_exr(path: &Path) -> bool {
        matches!(format_of(path), Ok(ImageFormat::OpenExr))
    }

    /// Whether a name ends as that of a picture.
    pub fn is_picture(path: &Path) -> bool {
        format_of(path).is_ok()
    }

    /// Where a picture will be written, tested before a long computation.
    ///
    /// # Errors
    /// [`PictureError::Format`] for a name that does not end in .png or .exr, [`PictureError::Write`] where no file can be
    /// written.
    pub fn destination(path: &Path) -> Result<Destination, PictureError> {
        format_of(path)?;
        Ok(Destination::of(path)?)
    }

    /// Writes the picture: `.png` as opaque eight-bit sRGB, `.exr` as linear 32-bit RGB with the coverage as alpha.
    ///
    /// # Errors
    /// [`PictureError::Format`] for another name, [`PictureError::Write`] if the file cannot be written; it may be kept
    /// elsewhere then.
    pub fn write(&self, destination: &Destination) -> Result<(), PictureError> {
        let (width, height) = (self.width, self.height);
        match format_of(destination.path())? {
            ImageFormat::Png => {
                let bytes = self.to_srgb8();
                destination.write_or_keep(|file| encoder::png(file, &bytes, width, height))?;
            }
            _ => {
                let pixel = |at: Vec2<usize>| {
                    let Pixel { radiance: [r, g, b], coverage } = self.pixels[at.y() * width as usize + at.x()];
                    (r, g, b, coverage)
                };
                let size = (width as usize, height as usize);
                let image = Image::from_channels(size, SpecificChannels::rgba(pixel));
                destination.write_or_keep(|file| image.write().to_buffered(file).map_err(encoder::exr_error))?;
            }
        }
        Ok(())
    }

    /// Reads a PNG or EXR file back into linear light. Without an alpha channel, everything counts as covered.
    ///
    /// PNG files hold colours beside their alpha; these are premultiplied by it here, as EXR files hold them.
    ///
    /// # Errors
    /// [`PictureError`] for a file that is missing, broken, of another format or too large.
    pub fn read(path: &Path) -> Result<Picture, PictureError> {
        let format = format_of(path)?;
        let file = files::open(path).map_err(|source| PictureError::Open { path: path.into(), source })?;
        let mut reader = ImageReader::new(BufReader::new(file));
        reader.set_format(format);
        let mut limits = Limits::default();
        limits.max_alloc = Some(MAX_READ_BYTES);
        reader.limits(limits);
        let decoded = reader.decode().map_err(|source| PictureError::File { path: path.into(), source })?;
        let mut picture = Picture::new(decoded.width(), decoded.height())?;
        let linear = matches!(decoded, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
        if linear {
            for (pixel, p) in picture.pixels.iter_mut().zip(decoded.to_rgba32f().pixels()) {
                *pixel = Pixel { radiance: [p[0], p[1], p[2]], coverage: p[3] };
            }
        } else {
            for (pixel, p) in picture.pixels.iter_mut().zip(decoded.to_rgba8().pixels()) {
                let coverage = f32::from(p[3]) / 255.0;
                *pixel = Pixel { radiance: [p[0], p[1], p[2]].map(|c| coverage * linear_from_srgb(c)), coverage };
            }
        }
        Ok(picture)
    }

    /// Reads a PNG or EXR file as [`Picture::read`] does, in which every number must be finite.
    ///
    /// # Errors
    /// Those of [`Picture::read`], and [`PictureError::Number`] for the first pixel with another number.
    pub fn read_finite(path: &Path) -> Result<Picture, PictureError> {
        let picture = Picture::read(path)?;
        picture.check_finite(path)?;
        Ok(picture)
    }

    /// [`PictureError::Number`] for the first pixel that is not finite.
    pub(super) fn check_finite(&self, path: &Path) -> Result<(), PictureError> {
        let is_wrong = |p: &Pixel| !p.coverage.is_finite() || p.radiance.iter().any(|c| !c.is_finite());
        match self.pixels.iter().position(is_wrong) {
            None => Ok(()),
            Some(at) => {
                let (x, y) = (at as u32 % self.width, at as u32 / self.width);
                Err(PictureError::Number { path: path.into(), x, y })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Picture {
        let mut picture = Picture::new(5, 3).expect("small");
        for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
            let x = i as f32 / 15.0;
            *pixel = Pixel { radiance: [x, 1.5 * x, 3.0 - x], coverage: x };
        }
        picture
    }

    #[test]
    fn an_exr_file_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        sample().write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert_eq!(Picture::read(&path).expect("read"), sample());
    }

    #[test]
    fn a_png_file_reads_back_within_half_a_step() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.png");
        sample().write(&Picture::destination(&path).expect("a destination")).expect("written");
        let back = Picture::read(&path).expect("read");
        assert_eq!(back.to_srgb8(), sample().to_srgb8());
        assert!(back.pixels().iter().all(|p| p.coverage == 1.0));
    }

    #[test]
    fn colours_of_a_png_file_are_premultiplied_by_its_alpha() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.png");
        image::save_buffer(&path, &[255, 255, 255, 51, 9, 9, 9, 0], 2, 1, image::ColorType::Rgba8).expect("written");
        let read = Picture::read_finite(&path).expect("read");
        assert_eq!(read.get(0, 0), Some(Pixel { radiance: [0.2; 3], coverage: 0.2 }));
        assert!(read.get(1, 0) == Some(Pixel::default()) && read.is_matte() && !sample().is_matte());
    }

    #[test]
    fn a_number_that_is_not_finite_is_found() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        let mut picture = sample();
        picture.pixels_mut()[7].radiance[1] = f32::NAN;
        picture.write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert!(matches!(Picture::read_finite(&path), Err(PictureError::Number { x: 2, y: 1, .. })));
    }

    #[test]
    fn other_names_and_broken_files_are_errors() {
        let folder = tempfile::tempdir().expect("folder");
        assert!(matches!(Picture::destination(&folder.path().join("a.gif")), Err(PictureError::Format { .. })));
        assert!(matches!(Picture::destination(&folder.path().join("none/a.png")), Err(PictureError::Write(_))));
        let path = folder.path().join("broken.png");
        std::fs::write(&path, b"no picture").expect("written");
        assert!(matches!(Picture::read(&path), Err(PictureError::File { .. })));
        assert!(matches!(Picture::read(&folder.path().join("none.png")), Err(PictureError::Open { .. })));
        assert!(matches!(Picture::new(0, 5), Err(PictureError::Size { .. })));
        assert!(matches!(Picture::new(u32::MAX, u32::MAX), Err(PictureError::Size { .. })));
    }
}
