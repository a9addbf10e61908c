//! Files of pictures, pixel by pixel: whoever reads one decides what it keeps, and knows the size before.

mod texel;
mod exr;
mod hdr;
mod png;

pub use texel::{Texel, TexelFormat};

use super::{Picture, PictureError};
use image::ImageFormat;
use std::io::BufReader;
use std::path::Path;

/// A picture file that is open, whose pixels are not read yet.
pub struct PictureReader<'a> {
    path: &'a Path,
    /// Columns and rows.
    size: [u32; 2],
    file: Format,
}

enum Format {
    Png(Box<png::Png>),
    Exr(Box<exr::Exr>),
    Hdr(Box<hdr::Hdr>),
}

impl<'a> PictureReader<'a> {
    /// Opens a PNG, EXR or HDR file.
    ///
    /// # Errors
    /// [`PictureError`] for a file that is missing, broken, of another format or too large.
    pub fn open(path: &'a Path) -> Result<PictureReader<'a>, PictureError> {
        let format = format_of(path)?;
        let file = files::open(path).map_err(|source| PictureError::Open { path: path.into(), source })?;
        let file = BufReader::new(file);
        let broken = |problem: String| PictureError::Broken { path: path.into(), problem };
        let (size, file) = match format {
            ImageFormat::Png => {
                let png = png::Png::open(file).map_err(broken)?;
                (png.size(), Format::Png(Box::new(png)))
            }
            ImageFormat::Hdr => {
                let hdr = hdr::Hdr::open(file).map_err(broken)?;
                (hdr.size(), Format::Hdr(Box::new(hdr)))
            }
            _ => {
                let exr = exr::Exr::open(file).map_err(broken)?;
                (exr.size(), Format::Exr(Box::new(exr)))
            }
        };
        Picture::pixels_of(size[0], size[1])?;
        Ok(PictureReader { path, size, file })
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How pixels are told.
    pub fn precision(&self) -> TexelFormat {
        match &self.file {
            Format::Png(png) => png.precision(),
            Format::Exr(exr) => TexelFormat::Float { grey: exr.is_grey() },
            Format::Hdr(_) => TexelFormat::Float { grey: false },
        }
    }

    /// Whether there is a depth for each pixel.
    pub fn has_depth(&self) -> bool {
        matches!(&self.file, Format::Exr(exr) if exr.has_depth())
    }

    /// Reads every pixel, in the order of the file: column from the left, row from the top.
    ///
    /// # Errors
    /// [`PictureError::Broken`]; some pixels may have been told then.
    pub fn each(self, mut tell: impl FnMut(u32, u32, Texel)) -> Result<(), PictureError> {
        let read = match self.file {
            Format::Png(png) => png.each(&mut tell),
            Format::Exr(exr) => exr.each(&mut tell),
            Format::Hdr(hdr) => hdr.each(&mut tell),
        };
        read.map_err(|problem| PictureError::Broken { path: self.path.into(), problem })
    }
}

/// The format of the name of a picture that is read.
pub(super) fn format_of(path: &Path) -> Result<ImageFormat, PictureError> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("png") => Ok(ImageFormat::Png),
        Some("exr") => Ok(ImageFormat::OpenExr),
        Some("hdr" | "pic") => Ok(ImageFormat::Hdr),
        _ => Err(PictureError::Format { path: path.into(), endings: ".png, .exr or .hdr" }),
    }
}
